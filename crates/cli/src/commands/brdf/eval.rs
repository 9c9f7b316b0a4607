//! `kirkas brdf eval`: values, densities and albedos as numbers.

use super::FRAME;
use super::albedo::albedo;
use super::angles::{Angles, list, thetas};
use super::material::{MaterialArgs, Matter};
use super::numbers::{Channels, Pair, short};
use crate::output::print_out;
use crate::problem::{Outcome, Problem};
use crate::report;
use kirkas_geometry::elementary::cos;
use kirkas_optics::ColorMode;
use kirkas_scene::Diagnostic;
use serde_json::{Value as Json, json};

const EXAMPLES: &str = "Examples:
  kirkas brdf eval lambert
  kirkas brdf eval ward:roughness=0.15,anisotropy=0.6 --theta-i 30 --theta-o 0..85:5 --phi-o 180
  kirkas brdf eval scene.toml#paint gold.binary --csv > values.csv
  kirkas brdf eval rough_conductor:ior.material=gold --albedo --theta-i 0..80:20
  kirkas brdf eval conductor:ior.material=copper --albedo --color spectral --wavelengths 400..700:50";

/// The most rows that are printed.
const MOST_ROWS: usize = 1_000_000;

/// Values of materials for given directions
#[derive(Debug, clap::Args)]
#[command(after_help = format!("{FRAME}\n\n{EXAMPLES}"))]
pub struct Eval {
    #[command(flatten)]
    materials: MaterialArgs,
    /// Where light arrives from: angles from the normal
    #[arg(long, value_name = "DEGREES", default_value = "45", value_parser = thetas, allow_hyphen_values = true)]
    theta_i: Angles,
    /// Where light arrives from: angles around the normal
    #[arg(long, value_name = "DEGREES", default_value = "0", value_parser = list, allow_hyphen_values = true)]
    phi_i: Angles,
    /// Where light leaves to: angles from the normal
    #[arg(long, value_name = "DEGREES", default_value = "0..75:15", value_parser = thetas, allow_hyphen_values = true)]
    theta_o: Angles,
    /// Where light leaves to: angles around the normal
    #[arg(long, value_name = "DEGREES", default_value = "180", value_parser = list, allow_hyphen_values = true)]
    phi_o: Angles,
    /// The parts of the arriving light that are reflected and transmitted, over all directions, instead of values
    #[arg(long)]
    albedo: bool,
    /// With --color spectral: at which wavelengths in nm, from 380 to 780
    #[arg(long, value_name = "NM", default_value = "450,550,650", value_parser = wavelengths)]
    wavelengths: Angles,
    /// As JSON
    #[arg(long, conflicts_with = "csv")]
    json: bool,
    /// As comma-separated values, in full precision
    #[arg(long)]
    csv: bool,
}

/// One line of what is printed.
struct Row {
    material: usize,
    angles: Vec<f64>,
    numbers: Vec<f64>,
}

/// Do it.
pub fn run(args: &Eval) -> Result<Outcome, Problem> {
    let materials = args.materials.open()?;
    let channels = Channels::new(args.materials.common.mode(), &args.wavelengths.0);
    let per_material = if args.albedo {
        args.theta_i.0.len() * args.phi_i.0.len()
    } else {
        [&args.theta_i, &args.phi_i, &args.theta_o, &args.phi_o].iter().map(|a| a.0.len()).product()
    };
    if per_material.saturating_mul(materials.len()) > MOST_ROWS {
        let message = format!("these angles make more than {MOST_ROWS} rows");
        return Err(Problem::input(Diagnostic::error("too-many", message).help("give fewer angles, or greater steps")));
    }
    if !args.albedo {
        materials.iter().filter(|m| m.has_delta()).for_each(tell_delta);
    }
    let (angle_names, number_names) = columns(args, &channels);
    let rows: Vec<Row> = materials.iter().enumerate().flat_map(|(i, m)| rows(args, &channels, m, i)).collect();
    let text = if args.json {
        format!("{:#}\n", as_json(args, &channels, &materials, &rows))
    } else if args.csv {
        as_csv(&materials, &angle_names, &number_names, &rows)
    } else {
        as_table(&materials, &angle_names, &number_names, &rows)
    };
    print_out(text.as_bytes())?;
    Ok(Outcome::Done)
}

fn tell_delta(matter: &Matter) {
    let message = format!("`{}` also sends light into single directions, which no value shows", matter.label);
    report::print(
        &Default::default(),
        &[Diagnostic::warning("delta-lobe", message).help("--albedo counts all of its light")],
    );
}

fn columns(args: &Eval, channels: &Channels) -> (Vec<&'static str>, Vec<String>) {
    let named = |what: &str| channels.names.iter().map(|c| format!("{what}_{c}")).collect::<Vec<_>>();
    if args.albedo {
        return (vec!["theta_i", "phi_i"], [named("reflected"), named("transmitted")].concat());
    }
    (vec!["theta_i", "phi_i", "theta_o", "phi_o"], [named("f"), named("f_cos"), vec!["pdf".into()]].concat())
}

fn rows(args: &Eval, channels: &Channels, matter: &Matter, material: usize) -> Vec<Row> {
    let mut rows = Vec::new();
    for (&theta_i, &phi_i) in args.theta_i.0.iter().flat_map(|t| args.phi_i.0.iter().map(move |p| (t, p))) {
        if args.albedo {
            let parts = albedo(matter, channels, theta_i, phi_i);
            let numbers = [parts.reflected, parts.transmitted].concat();
            rows.push(Row { material, angles: vec![theta_i, phi_i], numbers });
            continue;
        }
        let cosine = cos(theta_i.to_radians()).abs();
        for (&theta_o, &phi_o) in args.theta_o.0.iter().flat_map(|t| args.phi_o.0.iter().map(move |p| (t, p))) {
            let value = channels.value(matter, Pair { theta_i, phi_i, theta_o, phi_o });
            let with_cosine: Vec<f64> = value.f.iter().map(|f| f * cosine).collect();
            let numbers = [value.f, with_cosine, vec![value.pdf]].concat();
            rows.push(Row { material, angles: vec![theta_i, phi_i, theta_o, phi_o], numbers });
        }
    }
    rows
}

fn as_table(materials: &[Matter], angles: &[&str], numbers: &[String], rows: &[Row]) -> String {
    let mut text = String::new();
    for (i, matter) in materials.iter().enumerate() {
        let head: Vec<String> = angles.iter().map(|a| a.to_string()).chain(numbers.iter().cloned()).collect();
        let cells = rows.iter().filter(|r| r.material == i);
        let lines = cells.map(|r| r.angles.iter().chain(&r.numbers).map(|x| short(*x)).collect::<Vec<_>>());
        let lines: Vec<Vec<String>> = std::iter::once(head).chain(lines).collect();
        let width = |column: usize| lines.iter().map(|l| l[column].len()).max().unwrap_or(0);
        let widths: Vec<usize> = (0..lines[0].len()).map(width).collect();
        text += &format!("{}{}\n", if i > 0 { "\n" } else { "" }, matter.label);
        for line in &lines {
            let cells: Vec<String> = line.iter().zip(&widths).map(|(c, &w)| format!("{c:>w$}")).collect();
            text += &format!("  {}\n", cells.join("  "));
        }
    }
    text
}

fn as_csv(materials: &[Matter], angles: &[&str], numbers: &[String], rows: &[Row]) -> String {
    let quoted = |t: &str| if t.contains([',', '"']) { format!("\"{}\"", t.replace('"', "\"\"")) } else { t.into() };
    let head: Vec<&str> = angles.iter().copied().chain(numbers.iter().map(String::as_str)).collect();
    let mut text = format!("material,{}\n", head.join(","));
    for row in rows {
        let cells: Vec<String> = row.angles.iter().chain(&row.numbers).map(f64::to_string).collect();
        text += &format!("{},{}\n", quoted(&materials[row.material].label), cells.join(","));
    }
    text
}

fn as_json(args: &Eval, channels: &Channels, materials: &[Matter], rows: &[Row]) -> Json {
    let n = channels.names.len();
    let row = |r: &Row| match args.albedo {
        true => json!({ "theta_i": r.angles[0], "phi_i": r.angles[1],
            "reflected": r.numbers[..n], "transmitted": r.numbers[n..] }),
        false => json!({ "theta_i": r.angles[0], "phi_i": r.angles[1], "theta_o": r.angles[2], "phi_o": r.angles[3],
            "f": r.numbers[..n], "f_cos": r.numbers[n..2 * n], "pdf": r.numbers[2 * n] }),
    };
    let of = |(i, m): (usize, &Matter)| {
        let values: Vec<Json> = rows.iter().filter(|r| r.material == i).map(row).collect();
        json!({ "material": m.label, "type": m.type_name(), "values": values })
    };
    let mode = args.materials.common.mode();
    json!({
        "color": mode.name(),
        "wavelengths": if mode == ColorMode::Spectral { json!(args.wavelengths.0) } else { Json::Null },
        "materials": materials.iter().enumerate().map(of).collect::<Vec<_>>(),
    })
}

fn wavelengths(text: &str) -> Result<Angles, String> {
    let all = list(text).map_err(|e| e.replace("an angle in degrees", "a wavelength in nm"))?;
    match all.0.iter().find(|w| !(380.0..=780.0).contains(*w)) {
        Some(w) => Err(format!("wavelengths are from 380 to 780 nm, not {w}")),
        None => Ok(all),
    }
}
