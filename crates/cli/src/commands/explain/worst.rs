//! `--worst N`: the pixels that most need an explanation.

use super::source::Source;
use super::{Explain, replay};
use crate::output::print_out;
use crate::problem::{Outcome, Problem};
use crate::progress::Progress;
use crate::report;
use indicatif::ProgressBar;
use kirkas_explain::{findings, summary};
use kirkas_images::RgbImage;
use kirkas_render::Control;
use kirkas_render::film::Film;

/// A pixel, and what makes it stand out.
struct Candidate {
    pixel: (u32, u32),
    score: f64,
    why: String,
}

/// Find, explain and print them.
pub fn run(args: &Explain, source: &Source, count: usize) -> Result<Outcome, Problem> {
    let colors = source.image().and_then(|i| Some((i.rgb()?, (i.data.x.max(0) as u32, i.data.y.max(0) as u32))));
    let mut all = match colors {
        Some((colors, corner)) => of_colors(&colors, corner),
        None => of_film(args, source),
    };
    all.sort_by(|a, b| b.score.total_cmp(&a.score).then_with(|| a.pixel.cmp(&b.pixel)));
    all.truncate(count);
    let mut text = String::new();
    for c in &all {
        let samples = source.samples(args, c.pixel)?;
        let e = replay(args, source, c.pixel, samples)?;
        let [r, g, b] = e.value;
        text += &format!("pixel {},{}  {r:.4} {g:.4} {b:.4}  {}\n", c.pixel.0, c.pixel.1, c.why);
        for f in findings(&e) {
            text += &report::wrapped(&format!("  {}: {} ({}).", f.code, f.text, f.cure));
            text.push('\n');
        }
        text += &report::wrapped(&format!("  {}", summary(&e)));
        text += "\n\n";
    }
    print_out(text.as_bytes())?;
    Ok(Outcome::Done)
}

/// By what stands out from the pixels around, of a picture that keeps no variance.
fn of_colors(image: &RgbImage, (x0, y0): (u32, u32)) -> Vec<Candidate> {
    let (w, h) = (image.width as usize, image.height as usize);
    let bright = |x: usize, y: usize| image.pixels[y * w + x].iter().map(|c| f64::from(*c)).sum::<f64>();
    let places = (0..h).flat_map(|y| (0..w).map(move |x| (x, y)));
    places
        .map(|(x, y)| {
            let pixel = (x as u32 + x0, y as u32 + y0);
            let own = bright(x, y);
            let near: Vec<f64> = (y.saturating_sub(1)..(y + 2).min(h))
                .flat_map(|ny| (x.saturating_sub(1)..(x + 2).min(w)).map(move |nx| (nx, ny)))
                .filter(|&n| n != (x, y))
                .map(|(nx, ny)| bright(nx, ny))
                .filter(|v| v.is_finite())
                .collect();
            let middle = median(near);
            if !own.is_finite() {
                return Candidate { pixel, score: f64::INFINITY, why: "not finite".into() };
            }
            // Light and dark spots alike.
            let score = ((own + 1e-3) / (middle + 1e-3)).ln().abs();
            let times = (own + 1e-3) / (middle + 1e-3);
            let why = match times >= 1.0 {
                true => format!("{times:.1} times as bright as the pixels around"),
                false => format!("{:.1} times as dark as the pixels around", 1.0 / times),
            };
            Candidate { pixel, score, why }
        })
        .collect()
}

fn median(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied().unwrap_or(0.0)
}

/// Shows how far a render is.
struct Bar(ProgressBar);

impl Control for Bar {
    fn progress(&self, samples: u64) {
        self.0.inc(samples);
    }
}

/// By the variance of a picture that is rendered for it.
fn of_film(args: &Explain, source: &Source) -> Vec<Candidate> {
    let prepared = &source.prepared;
    let mut film = Film::new(prepared.film.clone());
    let pixels = prepared.film.crop.area() as u64;
    let bar = Bar(Progress::new(args.quiet, None).picture(pixels * u64::from(prepared.samples), 0));
    prepared.renderer(256).render(&mut film, 0..prepared.samples, &bar);
    bar.0.finish_and_clear();
    film.pixels()
        .map(|(x, y, tile, i)| {
            let invalid = tile.counts[i].invalid;
            let (mean, variance) = tile.moments(i);
            let (mean, spread) = (mean.iter().sum::<f64>(), variance.iter().sum::<f64>().sqrt());
            let noise = spread / (mean + 1e-3);
            match invalid {
                0 => Candidate {
                    pixel: (x, y),
                    score: noise,
                    why: format!("noise of {:.0} % of its light", noise * 100.0),
                },
                n => Candidate { pixel: (x, y), score: 1e9 + f64::from(n), why: format!("{n} samples not finite") },
            }
        })
        .collect()
}
