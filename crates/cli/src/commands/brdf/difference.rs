//! How far two materials are from each other, as numbers.
//!
//! Pairs of directions, both within 80 degrees of the normal, since few measurements reach further (Ngan, Durand & Matusik 2005), are
//! spread by half and difference angle, closer together near the mirrored direction, and weighted by the solid angles that
//! they stand for: `dω_i dω_o = 4 cos(theta_d) dω_h dω_d`.

use super::look::Look;
use super::maps::of_halves;
use core::f64::consts::{FRAC_PI_2, TAU};
use kirkas_geometry::Vec3;
use kirkas_geometry::elementary::{cos, ln, sin};
use kirkas_optics::LobeSet;
use rayon::prelude::*;

/// Steps of theta_h, phi_h, theta_d, phi_d.
const STEPS: [usize; 4] = [64, 8, 24, 24];
/// Cosine of the greatest angle.
const LEAST_COSINE: f64 = 0.173_648_177_666_930_33;

/// The numbers. All are 0 for equal materials.
#[derive(Clone, Copy, Debug, Default)]
pub struct Difference {
    /// Root of the mean square of the differences of f cos(theta_i), in 1/sr (Ngan, Durand & Matusik 2005, equation 1).
    pub rms: f64,
    /// The same, over the root of the mean square of B's f cos(theta_i).
    pub relative_rms: f64,
    /// Root of the mean square of the differences of ln(1 + f cos(theta_i)) (Löw et al. 2012).
    pub log_rms: f64,
    /// The greatest difference of f cos(theta_i) in a channel, in 1/sr.
    pub most: f64,
    /// Where that is: light arrives from here.
    pub most_wi: Vec3,
    /// And leaves to here.
    pub most_wo: Vec3,
}

/// Sums of a part of all pairs.
#[derive(Clone, Copy, Default)]
struct Sums {
    weight: f64,
    square: f64,
    of_b: f64,
    log: f64,
    most: f64,
    at: [Vec3; 2],
}

/// Of A against B.
pub fn difference(a: &Look, b: &Look) -> Difference {
    let parts: Vec<Sums> = (0..STEPS[0]).into_par_iter().map(|i| ring(a, b, i)).collect();
    let mut all = Sums::default();
    for part in parts {
        all.weight += part.weight;
        all.square += part.square;
        all.of_b += part.of_b;
        all.log += part.log;
        if part.most > all.most {
            (all.most, all.at) = (part.most, part.at);
        }
    }
    let mean = |x: f64| (x / all.weight).sqrt();
    Difference {
        rms: mean(all.square),
        relative_rms: if all.square == 0.0 { 0.0 } else { (all.square / all.of_b).sqrt() },
        log_rms: mean(all.log),
        most: all.most,
        most_wi: all.at[0],
        most_wo: all.at[1],
    }
}

/// All pairs of one theta_h.
fn ring(a: &Look, b: &Look, i: usize) -> Sums {
    let mut sums = Sums::default();
    // theta_h grows with the square of the step: finest at 0.
    let [half, turn, tilt, spin] = STEPS.map(|n| n as f64);
    let u = (i as f64 + 0.5) / half;
    let theta_h = FRAC_PI_2 * u * u;
    let width = 2.0 * FRAC_PI_2 * u / half;
    for (j, k, l) in (0..STEPS[1]).flat_map(|j| (0..STEPS[2]).flat_map(move |k| (0..STEPS[3]).map(move |l| (j, k, l))))
    {
        let phi_h = TAU * (j as f64 + 0.5) / turn;
        let theta_d = FRAC_PI_2 * (k as f64 + 0.5) / tilt;
        let phi_d = TAU * (l as f64 + 0.5) / spin;
        let degrees = [theta_h, phi_h, theta_d, phi_d].map(f64::to_degrees);
        let (wi, wo) = of_halves(degrees[0], degrees[1], degrees[2], degrees[3]);
        if f64::from(wi.z.min(wo.z)) < LEAST_COSINE {
            continue;
        }
        let weight = 4.0 * cos(theta_d) * sin(theta_h) * width * sin(theta_d);
        let (fa, fb) = (a.rgb(wi, wo, LobeSet::ALL), b.rgb(wi, wo, LobeSet::ALL));
        for c in 0..3 {
            let (x, y) = (fa[c] * f64::from(wi.z), fb[c] * f64::from(wi.z));
            let logs = ln(1.0 + x.max(0.0)) - ln(1.0 + y.max(0.0));
            sums.weight += weight;
            sums.square += weight * (x - y) * (x - y);
            sums.of_b += weight * y * y;
            sums.log += weight * logs * logs;
            if (x - y).abs() > sums.most {
                (sums.most, sums.at) = ((x - y).abs(), [wi, wo]);
            }
        }
    }
    sums
}
