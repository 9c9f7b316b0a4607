//! PNG: codes and texts come back; sizes are checked first.

use kirkas_images::*;

#[test]
fn eight_bit_codes_and_texts_survive() {
    let texts = Texts::from([
        ("Software".into(), "Kirkas".into()),
        ("kirkas.argv".into(), "render \"höyry ☁.toml\"\nline two".into()),
        ("kirkas.empty".into(), String::new()),
    ]);
    let codes: Vec<u8> = (0..=255).flat_map(|code| [code, 255 - code, code / 2]).collect();
    let back = read_png(&write_png8(16, 16, &codes, &texts).unwrap()).unwrap();
    let expected = codes.chunks_exact(3).map(|c| [c[0], c[1], c[2], 255]).collect();
    assert_eq!(
        back,
        DecodedImage { width: 16, height: 16, pixels: Pixels::Srgb8(expected), texts, says_linear: false }
    );
}

#[test]
fn sixteen_bit_codes_survive() {
    let codes: Vec<u16> = (0..4 * 64u16).map(|i| i * 255 + 3).collect();
    let back = read_png(&write_png16(8, 8, &codes, &Texts::new()).unwrap()).unwrap();
    assert_eq!(back.pixels, Pixels::Srgb16(codes.chunks_exact(4).map(|c| [c[0], c[1], c[2], c[3]]).collect()));
}

#[test]
fn grey_and_alpha_are_expanded() {
    let grey = read_png(&write_png8(2, 1, &[10, 20], &Texts::new()).unwrap()).unwrap();
    assert_eq!(grey.pixels, Pixels::Srgb8(vec![[10, 10, 10, 255], [20, 20, 20, 255]]));
    let with_alpha = read_png(&write_png8(1, 1, &[10, 20], &Texts::new()).unwrap()).unwrap();
    assert_eq!(with_alpha.pixels, Pixels::Srgb8(vec![[10, 10, 10, 20]]));
}

#[test]
fn equal_pictures_are_equal_files() {
    let texts = Texts::from([("b".into(), "2".into()), ("a".into(), "1".into())]);
    let write = || write_png8(8, 8, &[77; 192], &texts).unwrap();
    assert_eq!(write(), write());
}

#[test]
fn what_cannot_be_written_is_named() {
    let message = write_png8(2, 2, &[0; 5], &Texts::new()).unwrap_err().to_string();
    assert_eq!(
        message,
        "this picture cannot be written as PNG: 5 samples are not 1, 2, 3 or 4 for each of 2 x 2 pixels"
    );
    let texts = Texts::from([("x".repeat(80), String::new())]);
    assert!(write_png8(1, 1, &[0], &texts).unwrap_err().to_string().contains("1 to 79 bytes"));
    assert!(write_png8(0, 7, &[], &Texts::new()).is_err());
}

#[test]
fn a_size_bomb_is_refused() {
    let mut file = write_png8(8, 8, &[0; 64], &Texts::new()).unwrap();
    for (side, expected) in [(60_000u32, "more than the limit"), (9_000, "bytes can hold")] {
        file[16..20].copy_from_slice(&side.to_be_bytes());
        file[20..24].copy_from_slice(&side.to_be_bytes());
        let sum = crc32(&file[12..29]);
        file[29..33].copy_from_slice(&sum.to_be_bytes());
        let message = read_png(&file).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    }
}

fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0u32, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| (sum >> 1) ^ (0xedb8_8320 & (sum & 1).wrapping_neg()))
    })
}
