//! Small pictures and files that several tests use.

use kirkas_images::*;
use std::path::PathBuf;

/// A picture with every kind of channel, a crop window, and metadata.
pub fn rich_image() -> Image {
    let mut image = Image::new(7, 37);
    image.data = Window { x: -3, y: 5, ..image.data };
    image.display = Window { x: -10, y: -20, width: 100, height: 90 };
    let pixels = 7 * 37;
    let floats = |seed: u32| (0..pixels).map(move |i| f32::from_bits(kirkas_hash(seed, i) & 0xbfff_ffff)).collect();
    image.push("R", ChannelData::F32(floats(1)));
    image.push("G", ChannelData::F32(floats(2)));
    image.push("B", ChannelData::F32(floats(3)));
    image.push("A", ChannelData::F16((0..pixels).map(|i| i as f32 / 256.0).collect()));
    image.push(
        "depth.Z",
        ChannelData::F32((0..pixels).map(|i| if i % 3 == 0 { f32::INFINITY } else { -0.0 }).collect()),
    );
    for lane in 0..4 {
        let name = format!("kirkas.sum.R.{lane}");
        image.push(name, ChannelData::U32((0..pixels).map(|i| kirkas_hash(9 + lane, i)).collect()));
    }
    image.push(
        "kirkas.a channel name that is longer than thirty-one bytes",
        ChannelData::U32(vec![u32::MAX; pixels as usize]),
    );
    image.channels.sort_by(|a, b| a.name.cmp(&b.name));
    image.attributes.insert("kirkas.argv".into(), Attribute::Text("kirkas render \"höyry ☁.toml\"\n-o x".into()));
    image.attributes.insert("kirkas.empty".into(), Attribute::Text(String::new()));
    image.attributes.insert("kirkas.seed".into(), Attribute::Number(0.1 + 0.2));
    image.attributes.insert("comments".into(), Attribute::Text("two words".into()));
    image.attributes.insert(
        "kirkas.an attribute name that is longer than thirty-one bytes".into(),
        Attribute::Text("x".repeat(70_000)),
    );
    image
}

/// A smooth picture with bright spots.
pub fn smooth_rgb(width: u32, height: u32) -> RgbImage {
    RgbImage::from_fn(width, height, |x, y| {
        let spot = if (x * 7 + y * 3) % 31 == 0 { 40.0 } else { 0.0 };
        [x as f32 / width as f32 + spot, y as f32 / height as f32, (x + y) as f32 * 0.01]
    })
}

/// Files of every format that can be written here, and of BMP, TGA, TIFF and JPEG by the `image` crate.
pub fn valid_files() -> Vec<(&'static str, Vec<u8>)> {
    let rgb = smooth_rgb(40, 33);
    let codes = to_srgb8(&rgb, 0.0, ToneCurve::Linear);
    let texts = Texts::from([("a".into(), "b".into()), ("argv".into(), "ä".into())]);
    let coded = |format| {
        let mut file = std::io::Cursor::new(Vec::new());
        image::write_buffer_with_format(&mut file, &codes, 40, 33, image::ExtendedColorType::Rgb8, format).unwrap();
        file.into_inner()
    };
    vec![
        ("png", write_png8(40, 33, &codes, &texts).unwrap()),
        ("png", write_png16(40, 33, &to_srgb16(&rgb, 0.0, ToneCurve::Linear), &texts).unwrap()),
        ("exr", write_exr(&rich_image(), ExrCompression::Zip).unwrap()),
        ("exr", write_exr(&Image::from_rgb(&rgb, ChannelData::F16), ExrCompression::None).unwrap()),
        ("exr", foreign_exr(exr::prelude::Compression::PIZ, true)),
        ("exr", foreign_exr(exr::prelude::Compression::DWAA(None), false)),
        ("exr", foreign_exr(exr::prelude::Compression::PXR24, true)),
        ("hdr", write_hdr(&rgb, &texts).unwrap()),
        ("jpg", coded(image::ImageFormat::Jpeg)),
        ("bmp", coded(image::ImageFormat::Bmp)),
        ("tga", coded(image::ImageFormat::Tga)),
        ("tif", coded_tiff(&codes)),
    ]
}

/// A TIFF of 40 x 33 codes, packed.
fn coded_tiff(codes: &[u8]) -> Vec<u8> {
    use tiff::encoder::{TiffEncoder, colortype::RGB8, compression::Lzw};
    let mut file = std::io::Cursor::new(Vec::new());
    TiffEncoder::new(&mut file).unwrap().write_image_with_compression::<RGB8, _>(40, 33, Lzw, codes).unwrap();
    file.into_inner()
}

/// A small EXR file as other programs write them: any compression, lines or tiles, mixed channels.
pub fn foreign_exr(compression: exr::prelude::Compression, tiles: bool) -> Vec<u8> {
    use exr::prelude as x;
    let value = |i: u32| (i % 23) as f32 * 0.04;
    let half = x::FlatSamples::F16((0..23 * 37).map(|i| x::f16::from_f32(value(i))).collect());
    let list = vec![
        x::AnyChannel::new("B", half.clone()),
        x::AnyChannel::new("G", half),
        x::AnyChannel::new("R", x::FlatSamples::F32((0..23 * 37).map(value).collect())),
        x::AnyChannel::new("id", x::FlatSamples::U32((0..23 * 37).collect())),
    ];
    let blocks = if tiles { x::Blocks::Tiles(x::Vec2(16, 16)) } else { x::Blocks::ScanLines };
    let encoding = x::Encoding { compression, blocks, line_order: x::LineOrder::Increasing };
    let channels = x::AnyChannels::sort(list.into());
    let layer = x::Layer::new((23usize, 37usize), x::LayerAttributes::named("main"), encoding, channels);
    let mut file = Vec::new();
    let part = x::Image::from_layer(layer);
    x::WritableImage::write(&part).non_parallel().to_buffered(std::io::Cursor::new(&mut file)).unwrap();
    file
}

/// Bits as if at random (the finaliser of MurmurHash3).
pub fn kirkas_hash(seed: u32, i: u32) -> u32 {
    let mut h = seed.wrapping_mul(0x9e37_79b9) ^ i;
    h = (h ^ (h >> 16)).wrapping_mul(0x85eb_ca6b);
    h = (h ^ (h >> 13)).wrapping_mul(0xc2b2_ae35);
    h ^ (h >> 16)
}

/// The folder of data too large for the repository, or a note that the test was skipped.
pub fn data_folder(test: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("KIRKAS_DATA").map(PathBuf::from);
    if folder.is_none() {
        println!("skipped: {test} (KIRKAS_DATA is not set)");
    }
    folder
}
