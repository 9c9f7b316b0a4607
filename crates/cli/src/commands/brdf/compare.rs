//! `kirkas brdf compare`: two materials side by side, and how far they are from each other.

use super::FRAME;
use super::albedo::albedo;
use super::angles::{Angles, upper_thetas};
use super::difference::{Difference, difference};
use super::look::Look;
use super::material::{CommonArgs, Matter};
use super::numbers::{Channels, luminance, short};
use super::sheet;
use super::slices::overlaid;
use super::studio::{StudioArgs, framed, shown_luminance, spheres};
use crate::output::print_out;
use crate::problem::{Outcome, Problem};
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::{acos, atan2};
use kirkas_images::RgbImage;
use kirkas_plot::{Anchor, Color, Drawing, Picture, legend};
use serde_json::{Value as Json, json};
use std::path::PathBuf;

const EXAMPLES: &str = "Examples:
  kirkas brdf compare gold.binary rough_conductor:ior.material=gold,roughness=0.1 -o gold.png
  kirkas brdf compare scene.toml#paint principled --json

B is the reference. RMS: of the differences of f cos(theta_i) over all pairs of directions within 80 degrees of the normal.
Log RMS: of ln(1 + f cos(theta_i)), in which highlights weigh less.";

/// Two materials side by side, with the difference as numbers
#[derive(Debug, clap::Args)]
#[command(after_help = format!("{FRAME}\n\n{EXAMPLES}"))]
pub struct Compare {
    /// TYPE[:NAME=VALUE,...], SCENE#NAME, or a file of measurements (.binary, .bsdf)
    a: String,
    /// The reference
    b: String,
    #[command(flatten)]
    common: CommonArgs,
    /// Picture to write, .svg or .png: spheres, their difference, slices; may be given several times
    #[arg(short, long, value_name = "FILE")]
    output: Vec<PathBuf>,
    /// Slices: where light arrives from
    #[arg(long, value_name = "DEGREES", default_value = "15,45,75", value_parser = upper_thetas, allow_hyphen_values = true)]
    theta_i: Angles,
    /// The numbers as JSON
    #[arg(long)]
    json: bool,
    #[command(flatten)]
    studio: StudioArgs,
}

/// Angles of incidence at which albedos are told.
const ALBEDOS: [f64; 4] = [0.0, 30.0, 60.0, 80.0];

/// Do it.
pub fn run(args: &Compare) -> Result<Outcome, Problem> {
    sheet::check(&args.output)?;
    let materials = args.common.open(&[args.a.clone(), args.b.clone()])?;
    let looks: Vec<Look> = materials.iter().map(Look::new).collect();
    let found = difference(&looks[0], &looks[1]);
    let albedos: Vec<[f64; 2]> = ALBEDOS.iter().map(|&theta| [0, 1].map(|i| reflected(&materials[i], theta))).collect();
    let text = match args.json {
        true => format!("{:#}\n", as_json(&materials, &found, &albedos)),
        false => as_text(&materials, &found, &albedos),
    };
    if !args.output.is_empty() {
        sheet::write(&draw(args, &materials, &found)?, &args.output)?;
    }
    print_out(text.as_bytes())?;
    Ok(Outcome::Done)
}

/// The part of the light that is reflected: the mean of its luminance.
fn reflected(matter: &Matter, theta: f64) -> f64 {
    let channels = Channels::new(matter.lanes().mode(), &[450.0, 550.0, 650.0]);
    luminance(&albedo(matter, &channels, theta, 0.0).reflected)
}

fn angles(v: Vec3) -> [f64; 2] {
    let v = v.as_dvec3();
    [acos(v.z.clamp(-1.0, 1.0)).to_degrees(), atan2(v.y, v.x).to_degrees()].map(|a| (a * 10.0).round() / 10.0 + 0.0)
}

fn as_text(materials: &[Matter], d: &Difference, albedos: &[[f64; 2]]) -> String {
    let ([ti, pi], [to, po]) = (angles(d.most_wi), angles(d.most_wo));
    let mut text = format!("A: {}\nB: {}\n", materials[0].label, materials[1].label);
    text += &format!("  RMS of f cos(theta_i)   {} 1/sr\n", short(d.rms));
    text += &format!("  over that of B          {}\n", short(d.relative_rms));
    text += &format!("  log RMS                 {}\n", short(d.log_rms));
    text += &format!("  greatest difference     {} 1/sr", short(d.most));
    if d.most > 0.0 {
        text += &format!(", light from ({ti}, {pi}) to ({to}, {po})");
    }
    text += "\n  part reflected          theta_i         A         B\n";
    for (theta, [a, b]) in ALBEDOS.iter().zip(albedos) {
        text += &format!("                          {theta:>7}  {:>8}  {:>8}\n", format!("{a:.4}"), format!("{b:.4}"));
    }
    text
}

fn as_json(materials: &[Matter], d: &Difference, albedos: &[[f64; 2]]) -> Json {
    let ([ti, pi], [to, po]) = (angles(d.most_wi), angles(d.most_wo));
    let row = |(theta, [a, b]): (&f64, &[f64; 2])| json!({ "theta_i": theta, "a": a, "b": b });
    json!({
        "a": materials[0].label,
        "b": materials[1].label,
        "rms": d.rms,
        "relative_rms": d.relative_rms,
        "log_rms": d.log_rms,
        "max": d.most,
        "max_at": { "theta_i": ti, "phi_i": pi, "theta_o": to, "phi_o": po },
        "reflected": ALBEDOS.iter().zip(albedos).map(row).collect::<Vec<_>>(),
    })
}

/// Spheres above, slices below.
fn draw(args: &Compare, materials: &[Matter], found: &Difference) -> Result<Drawing, Problem> {
    const WIDTH: f64 = 780.0;
    const SIDE: f64 = 246.0;
    const TOP: f64 = 14.0;
    let images = spheres(materials, SIDE, &args.studio)?;
    let mut drawing = Drawing::new(WIDTH, TOP + SIDE + 50.0 + 430.0);
    let (shown, scale) = between(&images[0], &images[1]);
    let left = |i: usize| 13.0 + i as f64 * (SIDE + 8.0);
    for (i, image) in images.iter().enumerate() {
        drawing.picture(framed(image, [left(i), TOP, SIDE, SIDE]));
    }
    drawing.picture(Picture { place: [left(2), TOP, SIDE, SIDE], ..shown });
    let captions = [
        legend::fitted(&format!("A: {}", materials[0].label), 12.0, SIDE),
        legend::fitted(&format!("B: {}", materials[1].label), 12.0, SIDE),
        format!("A \u{2212} B: red brighter, blue darker, full at {}", short(scale)),
    ];
    for (i, caption) in captions.into_iter().enumerate() {
        drawing.text(caption, [left(i) + 0.5 * SIDE, TOP + SIDE + 18.0], 12.0, Anchor::Middle, Color::INK);
    }
    let numbers = format!(
        "RMS {} 1/sr, {} of B's; log RMS {}; greatest {} 1/sr",
        short(found.rms),
        short(found.relative_rms),
        short(found.log_rms),
        short(found.most)
    );
    drawing.text(numbers, [0.5 * WIDTH, TOP + SIDE + 38.0], 12.0, Anchor::Middle, Color::GREY);
    drawing.place(overlaid(materials, &args.theta_i.0, (WIDTH, 424.0)), 0.0, TOP + SIDE + 54.0);
    Ok(drawing)
}

/// The difference of what a screen shows, and the one at which its colours are full.
fn between(a: &RgbImage, b: &RgbImage) -> (Picture, f64) {
    let (la, lb) = (shown_luminance(a), shown_luminance(b));
    let differences: Vec<f64> = la.iter().zip(&lb).map(|(a, b)| a - b).collect();
    let most = differences.iter().fold(0.0_f64, |m, d| m.max(d.abs()));
    // A twentieth, a fifth, or all of the range of a screen.
    let scale = [0.05, 0.2].into_iter().find(|s| most <= *s).unwrap_or(1.0);
    let pixels: Vec<u8> = differences.iter().flat_map(|d| Color::of_difference(d / scale).0).collect();
    let png = sheet::pack(a.width, a.height, &pixels);
    (Picture { place: [0.0; 4], width: a.width, height: a.height, pixels, png }, scale)
}
