//! `decode` tells formats apart by their bytes, and linearises exactly.

use crate::samples::{smooth_rgb, valid_files};
use kirkas_images::*;

#[test]
fn formats_are_told_apart_by_their_bytes() {
    for (ending, file) in valid_files() {
        // A wrong hint does no harm where the bytes speak.
        let hint = if ending == "tga" { "TGA" } else { "txt" };
        let image = decode(&file, Some(hint)).unwrap_or_else(|error| panic!("{ending}: {error}"));
        assert!(matches!((image.width, image.height), (40, 33) | (7, 37) | (23, 37)), "{ending}");
    }
    assert_eq!(decode(b"hello", None), Err(ImageError::UnknownFormat));
    assert_eq!(decode(b"", Some("png")), Err(ImageError::UnknownFormat));
    assert!(matches!(decode(b"hello", Some("tga")), Err(ImageError::Damaged { format: "TGA", .. })));
}

#[test]
fn lossless_formats_give_the_codes_that_went_in() {
    let codes = to_srgb8(&smooth_rgb(40, 33), 0.0, ToneCurve::Linear);
    for (ending, file) in valid_files() {
        let image = decode(&file, Some(ending)).unwrap();
        let Pixels::Srgb8(pixels) = &image.pixels else { continue };
        let got: Vec<u8> = pixels.iter().flat_map(|p| [p[0], p[1], p[2]]).collect();
        if ending == "jpg" {
            let near = got.iter().zip(&codes).filter(|(a, b)| a.abs_diff(**b) < 40).count();
            assert!(near * 10 > codes.len() * 9, "the JPEG is another picture: {near} of {}", codes.len());
        } else {
            assert_eq!(got, codes, "{ending}");
            assert_eq!(to_srgb8(&image.rgb(), 0.0, ToneCurve::Linear), codes, "{ending}");
        }
    }
}

#[test]
fn linear_and_raw_numbers() {
    let image = DecodedImage {
        width: 1,
        height: 1,
        pixels: Pixels::Srgb8(vec![[0, 128, 255, 128]]),
        texts: Texts::new(),
        says_linear: false,
    };
    assert_eq!(image.raw(), [[0.0, 128.0 / 255.0, 1.0, 128.0 / 255.0]]);
    assert_eq!(image.linear(), [[0.0, 0.215_860_5, 1.0, 128.0 / 255.0]]);
}

#[test]
fn alpha_of_an_exr_is_kept() {
    let mut image = Image::from_rgb(&smooth_rgb(2, 1), ChannelData::F32);
    image.push("A", ChannelData::F16(vec![0.5, 1.0]));
    let decoded = decode(&write_exr(&image, ExrCompression::Zip).unwrap(), None).unwrap();
    let alpha: Vec<f32> = decoded.linear().iter().map(|pixel| pixel[3]).collect();
    assert_eq!(alpha, [0.5, 1.0]);
    assert_eq!(decoded.rgb(), smooth_rgb(2, 1));
}

#[test]
fn sixteen_bits_and_floats_of_a_tiff_are_kept() {
    use tiff::encoder::{TiffEncoder, TiffValue, colortype};
    fn tiff<C: colortype::ColorType>(samples: &[C::Inner]) -> Vec<u8>
    where
        [C::Inner]: TiffValue,
    {
        let mut file = std::io::Cursor::new(Vec::new());
        TiffEncoder::new(&mut file).unwrap().write_image::<C>(2, 1, samples).unwrap();
        file.into_inner()
    }
    let image = decode(&tiff::<colortype::RGB16>(&[1, 2, 3, 65_535, 0, 1000]), None).unwrap();
    assert_eq!(image.pixels, Pixels::Srgb16(vec![[1, 2, 3, 65_535], [65_535, 0, 1000, 65_535]]));
    assert!(!image.is_linear());
    let image = decode(&tiff::<colortype::RGB32Float>(&[0.5, 2.0, -1.0, 0.0, 7.5, 1.0]), None).unwrap();
    assert_eq!(image.linear(), [[0.5, 2.0, -1.0, 1.0], [0.0, 7.5, 1.0, 1.0]]);
    assert!(image.is_linear());
    let error = decode(&tiff::<colortype::Gray32>(&[1, 2]), None).unwrap_err();
    assert!(matches!(error, ImageError::Unsupported { format: "TIFF", .. }), "{error}");
}

#[test]
fn a_png_that_says_it_is_linear_is_taken_so() {
    let plain = write_png8(1, 1, &[0, 128, 255], &Texts::new()).unwrap();
    assert!(!decode(&plain, None).unwrap().is_linear());
    // Before the pixels, in place of the `sRGB` chunk: `gAMA` of 1.
    let mut linear = Vec::new();
    let mut encoder = png::Encoder::new(&mut linear, 1, 1);
    encoder.set_color(png::ColorType::Rgb);
    encoder.set_source_gamma(png::ScaledFloat::new(1.0));
    encoder.write_header().unwrap().write_image_data(&[0, 128, 255]).unwrap();
    let image = decode(&linear, None).unwrap();
    assert!(image.is_linear());
    assert_eq!(image.linear(), [[0.0, 128.0 / 255.0, 1.0, 1.0]]);
}
