//! How much of the light that arrives from a direction leaves again: by sampling, so that the sharpest lobes and single
//! directions count.

use super::angles::direction;
use super::material::Matter;
use super::numbers::Channels;
use kirkas_optics::{Lanes, Light, LobeSet, Mode};
use rayon::prelude::*;

/// The parts of the light, by channel.
pub struct Albedo {
    /// To the side it came from.
    pub reflected: Vec<f64>,
    /// To the other side.
    pub transmitted: Vec<f64>,
}

/// Samples of each direction.
const SAMPLES: u32 = 1 << 16;
/// Samples that are added up in one go, in order.
const RUN: u32 = 1 << 12;

/// Of light that arrives at these angles, in degrees.
pub fn albedo(matter: &Matter, channels: &Channels, theta: f64, phi: f64) -> Albedo {
    let (mut reflected, mut transmitted) = (Vec::new(), Vec::new());
    for lanes in channels.lanes() {
        let [up, down] = parts(matter, lanes, theta, phi);
        reflected.extend(channels.of_lanes(up.map(|x| x as f32)));
        transmitted.extend(channels.of_lanes(down.map(|x| x as f32)));
    }
    Albedo { reflected, transmitted }
}

fn parts(matter: &Matter, lanes: &Lanes, theta: f64, phi: f64) -> [[f64; 4]; 2] {
    // Light is followed from where it arrives: the adjoint, whose weights are parts of its power.
    let bsdf = matter.at(lanes);
    let from = direction(theta, phi);
    let run = |first: u32| {
        let mut sums = [[0.0_f64; 4]; 2];
        for i in first..first + RUN {
            let (u_lobe, u, v) = point(i);
            let Some(s) = bsdf.sample(from, u_lobe, (u, v), LobeSet::ALL, Mode::Importance) else { continue };
            let Light(weight) = s.weight();
            let side = &mut sums[usize::from(s.wi.z * from.z < 0.0)];
            side.iter_mut().zip(weight).for_each(|(sum, w)| *sum += f64::from(w));
        }
        sums
    };
    let runs: Vec<[[f64; 4]; 2]> = (0..SAMPLES / RUN).into_par_iter().map(|r| run(r * RUN)).collect();
    let mut total = [[0.0; 4]; 2];
    for (side, lane) in (0..2).flat_map(|s| (0..4).map(move |l| (s, l))) {
        total[side][lane] = runs.iter().map(|r| r[side][lane]).sum::<f64>() / f64::from(SAMPLES);
    }
    total
}

/// Point `i` of the sequence of M. Roberts, "The Unreasonable Effectiveness of Quasirandom Sequences", 2018, in three dimensions.
fn point(i: u32) -> (f32, f32, f32) {
    const ROOT: f64 = 1.220_744_084_605_759_5;
    let of = |step: f64| ((0.5 + step * f64::from(i)).fract() as f32).min(1.0 - f32::EPSILON);
    (of(1.0 / ROOT), of(1.0 / (ROOT * ROOT)), of(1.0 / (ROOT * ROOT * ROOT)))
}
