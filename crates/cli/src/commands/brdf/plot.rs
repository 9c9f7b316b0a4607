//! `kirkas brdf plot`: materials as pictures.

use super::FRAME;
use super::angles::{Angles, list, upper_thetas};
use super::look::Channel;
use super::material::{MaterialArgs, Matter};
use super::studio::StudioArgs;
use super::{factors, lobes, maps, rows, sheet, slices};
use crate::problem::{Outcome, Problem};
use kirkas_plot::Drawing;
use std::path::PathBuf;

const EXAMPLES: &str = "Examples:
  kirkas brdf plot phong:specular=0.5 blinn_phong:specular=0.5 -o slice.svg
  kirkas brdf plot rough_conductor:ior.material=gold --vary roughness=0.1,0.3,0.6 --theta-i 60 --kind cartesian --log -o gold.svg
  kirkas brdf plot phong:exponent=80,specular=1 blinn_phong:exponent=320,specular=1 --kind lobes -o lobes.svg
  kirkas brdf plot rough_plastic --vary roughness=0.05,0.1,0.2,0.4 --kind spheres -o row.png
  kirkas brdf plot gold.binary --kind incidence --log -o gold.png";

/// What a plot shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq, clap::ValueEnum)]
pub enum Kind {
    /// Values around the surface, in the plane of incidence
    Polar,
    /// The same over the angle of reflection
    Cartesian,
    /// The shape of highlights: in the plane of incidence, and as seen along the mirrored direction
    Lobes,
    /// Maps: over the angles of incidence and reflection, and over half and difference angle
    Incidence,
    /// The factors of microfacet models: facets D, shadows G, Fresnel's F
    Curves,
    /// Lit spheres
    Spheres,
}

/// Materials as plots
#[derive(Debug, clap::Args)]
#[command(after_help = format!("{FRAME}\n\n{EXAMPLES}"))]
pub struct Plot {
    #[command(flatten)]
    pub materials: MaterialArgs,
    /// What is shown
    #[arg(long, value_name = "NAME", default_value = "polar")]
    kind: Kind,
    /// Plot to write: .svg or .png; may be given several times
    #[arg(short, long, value_name = "FILE", required = true)]
    output: Vec<PathBuf>,
    /// Where light arrives from: angles from the normal [default: 15,45,75]
    #[arg(long, value_name = "DEGREES", value_parser = upper_thetas, allow_hyphen_values = true)]
    theta_i: Option<Angles>,
    /// Where light arrives from: angle around the normal
    #[arg(long, value_name = "DEGREES", default_value_t = 0.0, value_parser = one_angle, allow_hyphen_values = true)]
    pub phi_i: f64,
    /// Show every material with each of these values of a parameter
    #[arg(long, value_name = "NAME=VALUE,...")]
    vary: Option<String>,
    /// Show f cos(theta_i) instead of f
    #[arg(long)]
    pub with_cosine: bool,
    /// Values on a logarithmic scale
    #[arg(long)]
    pub log: bool,
    /// Which number of a colour
    #[arg(long, value_name = "NAME", default_value = "luminance")]
    pub channel: Channel,
    /// Above the plot
    #[arg(long, value_name = "TEXT")]
    pub title: Option<String>,
    /// Size in points; a PNG has two pixels to a point
    #[arg(long, value_name = "WxH", value_parser = size)]
    size: Option<(f64, f64)>,
    #[command(flatten)]
    pub studio: StudioArgs,
}

/// Do it.
pub fn run(args: &Plot) -> Result<Outcome, Problem> {
    sheet::check(&args.output)?;
    let materials = args.open()?;
    sheet::write(&args.draw(&materials)?, &args.output)?;
    Ok(Outcome::Done)
}

impl Plot {
    fn open(&self) -> Result<Vec<Matter>, Problem> {
        let materials = self.materials.open()?;
        let Some(vary) = &self.vary else { return Ok(materials) };
        let (name, values) = vary.split_once('=').unwrap_or((vary, ""));
        let mut all = Vec::new();
        for matter in &materials {
            for value in super::material::parameters(values) {
                let words = format!("{} = {}", name.trim(), value.trim());
                let label = if materials.len() == 1 { words } else { format!("{}, {words}", matter.label) };
                all.push(matter.with(&format!("{name}={value}"), label)?);
            }
        }
        Ok(all)
    }

    fn draw(&self, materials: &[Matter]) -> Result<Drawing, Problem> {
        Ok(match self.kind {
            Kind::Polar => slices::polar(self, materials),
            Kind::Cartesian => slices::cartesian(self, materials),
            Kind::Lobes => lobes::draw(self, materials),
            Kind::Incidence => maps::draw(self, materials),
            Kind::Curves => factors::draw(self, materials)?,
            Kind::Spheres => rows::draw(self, materials)?,
        })
    }

    /// Angles of incidence.
    pub fn incident(&self) -> Vec<f64> {
        self.theta_i.as_ref().map_or(vec![15.0, 45.0, 75.0], |a| a.0.clone())
    }

    /// As asked for, or this.
    pub fn size_or(&self, width: f64, height: f64) -> (f64, f64) {
        self.size.unwrap_or((width, height))
    }

    /// As asked for, or this.
    pub fn title_or(&self, title: String) -> String {
        self.title.clone().unwrap_or(title)
    }

    /// What the numbers are.
    pub fn quantity(&self) -> String {
        let what = if self.with_cosine { "f cos θ~i" } else { "f" };
        format!("{what} in 1/sr{}", self.channel.words())
    }
}

fn one_angle(text: &str) -> Result<f64, String> {
    match list(text)?.0[..] {
        [angle] => Ok(angle),
        _ => Err("one angle is needed".into()),
    }
}

fn size(text: &str) -> Result<(f64, f64), String> {
    let sides = text.split_once('x').and_then(|(w, h)| Some((w.trim().parse().ok()?, h.trim().parse().ok()?)));
    sides
        .filter(|(w, h)| [w, h].into_iter().all(|s: &f64| (200.0..=4000.0).contains(s)))
        .ok_or_else(|| "give width x height in points, such as 720x480, from 200 to 4000 each".into())
}
