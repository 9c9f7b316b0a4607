//! `kirkas diff`: how far two pictures are from each other.

use crate::input::read_file;
use crate::output::{check_no_loss, check_writable, print_out, write_atomically};
use crate::parts::EXR;
use crate::problem::{Outcome, Problem};
use kirkas_images::heat::write_heat_png;
use kirkas_images::metrics::{Difference, Metric, fraction_within, max_difference};
use kirkas_images::{DecodedImage, Image, ImageError, Pixels, RgbImage, ToneCurve, Window, decode, read_exr, to_srgb8};
use kirkas_scene::Diagnostic;
use std::path::{Path, PathBuf};

const EXAMPLES: &str = "Examples:
  kirkas diff a.png b.png --metric flip --max 0.05
  kirkas diff a.exr b.exr --metric mrse -o where.png

The metrics compare linear light; B is the reference. Exit code 3: the difference is over --max.";

/// Say how far two pictures are from each other
#[derive(Debug, clap::Args)]
#[command(after_help = EXAMPLES)]
pub struct Diff {
    /// Picture: PNG, EXR, HDR, JPEG, BMP or TGA
    a: PathBuf,
    /// The reference
    b: PathBuf,
    /// What is measured
    #[arg(long, value_name = "NAME", default_value = "rmse", value_parser = metric_parser())]
    metric: String,
    /// The largest difference that is still well
    #[arg(long, value_name = "X")]
    max: Option<f64>,
    /// Picture of where they differ
    #[arg(short, long, value_name = "HEAT.png")]
    output: Option<PathBuf>,
    /// Also say how many pixels are near, as 8-bit codes
    #[arg(long)]
    verbose: bool,
}

fn metric_parser() -> clap::builder::PossibleValuesParser {
    Metric::ALL.map(|m| clap::builder::PossibleValue::new(m.name()).help(m.doc())).into()
}

/// Do it.
pub fn run(args: &Diff) -> Result<Outcome, Problem> {
    if let Some(path) = &args.output {
        if path.extension().is_none_or(|e| !e.eq_ignore_ascii_case("png")) {
            let message = format!("`{}`: the picture of differences is a `.png`", path.display());
            return Err(Problem::input(
                Diagnostic::error("unknown-format", message).help("give it the extension `.png`"),
            ));
        }
        check_writable(path)?;
        check_no_loss([path.as_path()], &[args.a.clone(), args.b.clone()])?;
    }
    let metric = Metric::from_name(&args.metric).unwrap_or(Metric::Rmse);
    let (mut a, mut b) = (Picture::read(&args.a)?, Picture::read(&args.b)?);
    Picture::meet(&mut a, &mut b);
    let bad = |e: ImageError| Problem::input(Diagnostic::error("cannot-compare", e.to_string()));
    let difference = metric.compare(&a.rgb, &b.rgb).map_err(bad)?;

    let mut text = format!("{} {}\n", metric.name(), difference.score);
    if args.verbose {
        for tolerance in [0, 1, 3, 8] {
            let within = fraction_within(&a.codes, &b.codes, tolerance).map_err(bad)?;
            text += &format!("pixels within {tolerance}/255: {:.4} %\n", within * 100.0);
        }
        text += &format!("largest linear difference: {}\n", max_difference(&a.rgb, &b.rgb).map_err(bad)?);
    }
    print_out(text.as_bytes())?;
    if let Some(path) = &args.output {
        let bytes = write_heat_png(&difference, white(metric, &difference)).map_err(bad)?;
        write_atomically(path, &bytes)?;
    }
    let is_over = args.max.is_some_and(|max| difference.score.is_nan() || difference.score > max);
    Ok(if is_over { Outcome::OverMax } else { Outcome::Done })
}

/// The error that is shown brightest: FLIP has a scale, the others take their largest.
fn white(metric: Metric, difference: &Difference) -> f32 {
    let largest = difference.map.iter().copied().filter(|v| v.is_finite()).fold(0.0, f32::max);
    if metric == Metric::Flip || largest == 0.0 { 1.0 } else { largest }
}

/// A picture to compare.
struct Picture {
    /// Its place in the whole image.
    window: Window,
    whole: Window,
    /// Linear, what is transparent over black.
    rgb: RgbImage,
    /// As 8-bit codes, three to a pixel.
    codes: Vec<u8>,
}

impl Picture {
    fn read(path: &Path) -> Result<Self, Problem> {
        let bad =
            |e: ImageError| Problem::input(Diagnostic::error("bad-picture", format!("`{}`: {e}", path.display())));
        let bytes = read_file(path)?;
        let hint = path.extension().map(|e| e.to_string_lossy().into_owned());
        let image = decode(&bytes, hint.as_deref()).map_err(bad)?;
        let whole = Window { x: 0, y: 0, width: image.width, height: image.height };
        // An EXR also says of which image it is a part, and its colours are multiplied by alpha already.
        let exr: Option<Image> = bytes.starts_with(&EXR).then(|| read_exr(&bytes).ok()).flatten();
        let rgb = if exr.is_some() { image.rgb() } else { over_black(&image) };
        let codes = match &image.pixels {
            Pixels::Srgb8(codes) => codes.iter().flat_map(|c| [c[0], c[1], c[2]]).collect(),
            _ => to_srgb8(&rgb, 0.0, ToneCurve::Linear),
        };
        let (window, whole) = exr.map_or((whole, whole), |e| (e.data, e.display));
        Ok(Picture { window, whole, rgb, codes })
    }

    /// Where one is a crop and the other the whole image, cut the same crop from it.
    fn meet(a: &mut Picture, b: &mut Picture) {
        if a.window == b.window {
            return;
        }
        if b.window == b.whole && (a.whole.width, a.whole.height) == (b.whole.width, b.whole.height) {
            b.cut(a.window);
        } else if a.window == a.whole && (a.whole.width, a.whole.height) == (b.whole.width, b.whole.height) {
            a.cut(b.window);
        }
    }

    fn cut(&mut self, to: Window) {
        let (x, y) = (i64::from(to.x) - i64::from(self.window.x), i64::from(to.y) - i64::from(self.window.y));
        let fits = x >= 0
            && y >= 0
            && x + i64::from(to.width) <= i64::from(self.window.width)
            && y + i64::from(to.height) <= i64::from(self.window.height);
        if !fits {
            return;
        }
        let row = self.window.width as usize;
        let indices: Vec<usize> = (0..to.height as usize)
            .flat_map(|dy| (0..to.width as usize).map(move |dx| (y as usize + dy) * row + x as usize + dx))
            .collect();
        self.codes = indices.iter().flat_map(|&i| self.codes[3 * i..3 * i + 3].to_vec()).collect();
        self.rgb = RgbImage {
            width: to.width,
            height: to.height,
            pixels: indices.iter().map(|&i| self.rgb.pixels[i]).collect(),
        };
        self.window = to;
    }
}

/// Colours weighted by alpha. A picture that is transparent everywhere means nothing by it: old TGA files are so.
fn over_black(image: &DecodedImage) -> RgbImage {
    let pixels = image.linear();
    let means_it = pixels.iter().any(|p| p[3] > 0.0);
    let weigh = |[r, g, b, a]: [f32; 4]| if means_it { [r * a, g * a, b * a] } else { [r, g, b] };
    RgbImage { width: image.width, height: image.height, pixels: pixels.into_iter().map(weigh).collect() }
}
