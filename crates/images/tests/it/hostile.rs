//! Any bytes are read or refused; none make a panic or take the memory of the machine.

use crate::samples::{kirkas_hash, valid_files};
use kirkas_images::decode;
use proptest::prelude::*;
use std::sync::LazyLock;

static FILES: LazyLock<Vec<(&str, Vec<u8>)>> = LazyLock::new(valid_files);

#[test]
fn truncated_files_are_refused_or_read() {
    for (ending, file) in valid_files() {
        let mut refused = 0;
        for part in 0..50 {
            let cut = &file[..file.len() * part / 50];
            match decode(cut, Some(ending)) {
                Err(error) => {
                    refused += 1;
                    assert!(error.to_string().len() > 20, "{error}");
                }
                Ok(image) => assert_eq!(image.linear().len(), (image.width * image.height) as usize),
            }
        }
        assert!(refused >= 25, "{ending}: only {refused} of 50 truncated files were refused");
    }
}

#[test]
fn flipped_bits_never_panic() {
    for (format, (ending, file)) in valid_files().into_iter().enumerate() {
        // All bits of the first bytes, where headers are; then bits all over the file.
        let head = (0..8 * file.len().min(400)).map(|bit| vec![bit]);
        let spread = (0..1500u32).map(|i| {
            (0..1 + i % 4).map(|j| kirkas_hash(format as u32, 4 * i + j) as usize % (8 * file.len())).collect()
        });
        for bits in head.chain(spread) {
            let mut damaged = file.clone();
            for bit in bits {
                damaged[bit / 8] ^= 1 << (bit % 8);
            }
            if let Ok(image) = decode(&damaged, Some(ending)) {
                assert_eq!(image.linear().len(), image.width as usize * image.height as usize);
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 2000, failure_persistence: None, ..ProptestConfig::default() })]

    #[test]
    fn arbitrary_bytes_never_panic(
        start in prop::sample::select(vec![
            &b"\x89PNG\r\n\x1a\n"[..],
            b"\x76\x2f\x31\x01\x02\0\0\0", b"#?RADIANCE\n", b"#?RGBE\n", b"\xff\xd8\xff", b"BM", b"II*\0\x08\0\0\0", b"MM\0*\0\0\0\x08", b"",
        ]),
        rest in prop::collection::vec(any::<u8>(), 0..600),
    ) {
        let _ = decode(&[start, &rest].concat(), Some("tga"));
    }

    #[test]
    fn spliced_files_never_panic(which in 0usize..11, other in 0usize..11, at in 0.0..1.0f64, from in 0.0..1.0f64) {
        let files = &*FILES;
        let place = |file: &[u8], at: f64| (file.len() as f64 * at) as usize;
        let (a, b) = (&files[which].1, &files[other].1);
        let _ = decode(&[&a[..place(a, at)], &b[place(b, from)..]].concat(), Some("tga"));
    }
}
