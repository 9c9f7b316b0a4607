//! EXR: what goes in comes out, bit for bit.

use crate::samples::{data_folder, foreign_exr, rich_image, smooth_rgb};
use exr::prelude::Compression;
use kirkas_images::*;

#[test]
fn every_channel_window_and_attribute_survives() {
    let image = rich_image();
    for compression in [ExrCompression::Zip, ExrCompression::None] {
        let back = read_exr(&write_exr(&image, compression).unwrap()).unwrap();
        assert_eq!(bits(&back), bits(&image));
        assert_eq!((back.data, back.display), (image.data, image.display));
        assert_eq!(back.attributes, image.attributes);
    }
}

#[test]
fn equal_images_are_equal_files() {
    let files: Vec<Vec<u8>> = (0..8).map(|_| write_exr(&rich_image(), ExrCompression::Zip).unwrap()).collect();
    assert!(files.iter().all(|file| *file == files[0]));
}

#[test]
fn the_order_of_channels_does_not_matter() {
    let mut shuffled = rich_image();
    shuffled.channels.reverse();
    let write = |image: &Image| write_exr(image, ExrCompression::Zip).unwrap();
    assert_eq!(write(&shuffled), write(&rich_image()));
}

#[test]
fn half_channels_round_to_nearest_and_stay_finite() {
    let given = vec![1.0, 1.0 + 1.0 / 4096.0, 65504.0, 1e9, -1e9, f32::INFINITY, f32::NAN, 6e-8];
    let mut image = Image::new(8, 1);
    image.push("Y", ChannelData::F16(given));
    let back = read_exr(&write_exr(&image, ExrCompression::Zip).unwrap()).unwrap();
    let values = back.channel("Y").unwrap().floats().unwrap();
    assert_eq!(values[..6], [1.0, 1.0, 65504.0, 65504.0, -65504.0, f32::INFINITY]);
    assert!(values[6].is_nan());
    assert_eq!(values[7], 2f32.powi(-24));
}

#[test]
fn colours_are_found_by_name() {
    let rgb = smooth_rgb(9, 5);
    assert_eq!(Image::from_rgb(&rgb, ChannelData::F32).rgb().unwrap(), rgb);

    let mut layered = Image::from_rgb(&rgb, ChannelData::F32);
    for channel in &mut layered.channels {
        channel.name = format!("beauty.{}", channel.name);
    }
    assert_eq!(layered.rgb().unwrap(), rgb);

    let mut grey = Image::new(1, 1);
    grey.push("Y", ChannelData::F16(vec![0.25]));
    assert_eq!(grey.rgb().unwrap().pixels, [[0.25; 3]]);

    let mut counts = Image::new(1, 1);
    counts.push("Y", ChannelData::U32(vec![1]));
    assert_eq!(counts.rgb(), None);
}

#[test]
fn what_cannot_be_written_is_named() {
    let check = |change: fn(&mut Image), expected: &str| {
        let mut image = rich_image();
        change(&mut image);
        let message = write_exr(&image, ExrCompression::Zip).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    };
    check(|image| image.channels[2].data = ChannelData::U32(vec![1]), "has 1 samples for 259 pixels");
    check(|image| image.channels[1].name = image.channels[0].name.clone(), "two channels are named `A`");
    check(|image| image.channels[1].name.clear(), "1 to 255 bytes");
    check(|image| image.channels.clear(), "no channels");
    check(|image| image.data.width = 0, "data window is empty");
    check(|image| image.display.x = i32::MIN, "display window reaches beyond");
    check(|image| drop(image.attributes.insert("type".into(), Attribute::Number(1.0))), "belongs to the format");
    check(|image| drop(image.attributes.insert("a\0b".into(), Attribute::Number(1.0))), "none of them null");
}

#[test]
fn a_size_bomb_is_refused() {
    let mut file = write_exr(&Image::from_rgb(&smooth_rgb(8, 8), ChannelData::F16), ExrCompression::Zip).unwrap();
    let window = file.windows(10).position(|name| name == b"dataWindow").unwrap() + b"dataWindow\0box2i\0....".len();
    for (side, expected) in [(30_000i32, "more than the limit"), (9_000, "bytes can hold")] {
        file[window + 8..window + 12].copy_from_slice(&(side - 1).to_le_bytes());
        file[window + 12..window + 16].copy_from_slice(&(side - 1).to_le_bytes());
        let message = read_exr(&file).unwrap_err().to_string();
        assert!(message.contains(&format!("{side} x {side} pixels")) && message.contains(expected), "{message}");
    }
}

#[test]
fn every_compression_but_b44_is_read() {
    use Compression::*;
    for compression in [Uncompressed, RLE, ZIP1, ZIP16, PIZ, PXR24, DWAA(None), DWAB(None)] {
        for tiles in [false, true] {
            let image = read_exr(&foreign_exr(compression, tiles)).unwrap();
            assert_eq!(image.channel("id").unwrap().integers().unwrap(), (0..23 * 37).collect::<Vec<u32>>());
            for (i, [r, g, b]) in image.rgb().unwrap().pixels.into_iter().enumerate() {
                // DWA keeps what an eye sees, PXR24 24 bits.
                let expected = (i % 23) as f32 * 0.04;
                let near = |value: f32| (value - expected).abs() < 0.02;
                assert!(near(r) && near(g) && near(b), "{compression:?}: {r} {g} {b} for {expected}");
            }
        }
    }
    let message = read_exr(&foreign_exr(B44, false)).unwrap_err().to_string();
    assert!(message.ends_with("save it again with ZIP or PIZ compression"), "{message}");
}

#[test]
fn chunks_that_lie_are_refused() {
    let check = |compression, tiles, at: usize, lie: &[u8], expected: &str| {
        let mut file = foreign_exr(compression, tiles);
        // The table of positions ends where the first chunk begins, and begins with that position.
        let position = |at: usize| u64::from_le_bytes(file[at..at + 8].try_into().unwrap()) as usize;
        let chunks = [37, 6, 2].into_iter();
        let table = |chunks: usize| (8..file.len() - 8).find(|&at| position(at) == at + 8 * chunks);
        let first = chunks.filter_map(table).next().unwrap();
        let start = position(first) + at;
        file[start..start + lie.len()].copy_from_slice(lie);
        let message = read_exr(&file).unwrap_err().to_string();
        assert!(message.contains(expected), "{message}");
    };
    // The row of a line, the level of a tile, and the claimed size in a DWA block (behind row, length and version).
    check(Compression::ZIP1, false, 0, &[1], "in the wrong places");
    check(Compression::ZIP16, true, 8, &[1], "in the wrong places");
    check(Compression::DWAA(None), false, 16, &[0, 0, 0, 0, 0, 0, 0, 1], "larger than it can be");
}

#[test]
fn other_programs_files_are_read() {
    let Some(data) = data_folder("other_programs_files_are_read") else { return };
    for scene in ["coffee", "cornell-box", "staircase2", "veach-mis"] {
        let folder = data.join("pbrt-v4").join(scene);
        let exr = std::fs::read(folder.join("TungstenRender.exr")).unwrap();
        let png = std::fs::read(folder.join("TungstenRender.png")).unwrap();
        let image = read_exr(&exr).unwrap();
        let linear = image.rgb().unwrap();
        let coded = decode(&png, None).unwrap();
        assert_eq!((linear.width, linear.height), (coded.width, coded.height), "{scene}");
        // The PNG beside it is the same picture after Tungsten's tone curve: brightness must rank alike.
        let codes = coded.rgb().pixels;
        let mean = |select: &dyn Fn(f32) -> bool| {
            let chosen: Vec<f32> = linear
                .pixels
                .iter()
                .zip(&codes)
                .filter(|(_, code)| select(code[1]))
                .map(|(p, _)| p[1].min(4.0))
                .collect();
            chosen.iter().sum::<f32>() / chosen.len().max(1) as f32
        };
        assert!(mean(&|code| code < 0.1) < mean(&|code| code > 0.5), "{scene}");
    }
}

/// Everything a sample is, so that NaN and -0 count too.
fn bits(image: &Image) -> Vec<(String, Vec<u32>)> {
    let bits_of = |data: &ChannelData| match data {
        ChannelData::U32(values) => values.clone(),
        ChannelData::F16(values) | ChannelData::F32(values) => values.iter().map(|value| value.to_bits()).collect(),
    };
    image.channels.iter().map(|channel| (channel.name.clone(), bits_of(&channel.data))).collect()
}
