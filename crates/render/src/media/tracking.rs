//! Flights through media that are not the same everywhere. The medium is filled up to a bound with particles that do nothing;
//! then collisions are as frequent as in a homogeneous one, and at each a coin says whether the particle was real.
//!
//! Distances: delta tracking (Woodcock et al. 1965, "Techniques Used in the GEM Code for Monte Carlo Neutronics Calculations"),
//! with bounds for each cell of a coarse grid; a particle that the lower bound already makes real needs no look at the density
//! (Kutz et al. 2017, "Spectral and Decomposition Tracking for Rendering Heterogeneous Volumes", section 4). Transmittances:
//! residual ratio tracking (Novak, Selle & Jarosz 2014, "Residual Ratio Tracking for Estimating Attenuation in Participating
//! Media"): what the lower bound takes away is known exactly, only the rest is played for. Where lanes differ, one coin is thrown
//! for all with their mean probability, weighted by what they carry, and each lane is corrected for it (Kutz et al. 2017, section
//! 5, history-aware).

use super::grid::Grid;
use super::random::{Stream, depth};
use super::{Coefficients, Flight, FlightEnd, Way, dot, fade, shares};
use kirkas_optics::Light;

/// A flight; see [`Volume::fly`](super::Volume::fly).
pub(super) fn fly(grid: &Grid, c: &Coefficients, throughput: Light, way: &Way, u: (f32, f32), key: u64) -> Flight {
    let mut random = Stream::new(key);
    let mut emitted = Light::BLACK;
    let mut weight = Light::splat(1.0);
    let (scatters, shines) = (!c.scattering.is_black(), !c.emission.is_black());
    let most = c.extinction.max_component().max(if shines { EMISSION_ALONE } else { 0.0 });
    let crossing = grid.crossing(way);
    let (mut depth_left, mut first_coin) = (f64::from(depth(u.1)), Some(u.0));
    for stretch in crossing.walk() {
        let fill = stretch.most * most;
        let mut t = stretch.from;
        while meets(&mut t, stretch.to, fill, &mut depth_left) {
            depth_left = f64::from(random.depth());
            let coin = if scatters { first_coin.take().unwrap_or_else(|| random.number()) } else { 1.0 };
            // Lanes' mean extinction at density 1, and what a real scattering leaves of the light, at any density.
            let mean = dot(shares(throughput * weight), c.extinction);
            let scattered = |weight| FlightEnd::Scattered { distance: t, weight: weight * c.scattering / mean };
            if scatters && !shines && coin < mean * (stretch.least / fill) {
                return Flight { emitted, end: scattered(weight) };
            }
            let density = crossing.density(t, &stretch);
            let real = c.extinction * (density / fill);
            if shines {
                emitted += weight * c.emission * (density / fill);
            }
            if scatters {
                let chance = mean * (density / fill);
                if coin < chance {
                    return Flight { emitted, end: scattered(weight) };
                }
                weight = weight * (Light::splat(1.0) - real) / (1.0 - chance);
            } else {
                weight *= Light::splat(1.0) - real;
            }
            if weight.is_black() {
                return Flight { emitted, end: FlightEnd::Passed(weight) };
            }
        }
    }
    Flight { emitted, end: FlightEnd::Passed(weight) }
}

/// What is left of light; see [`Volume::transmittance`](super::Volume::transmittance).
pub(super) fn transmittance(grid: &Grid, c: &Coefficients, way: &Way, key: u64) -> Light {
    let mut random = Stream::new(key);
    let mut left = Light::splat(1.0);
    // Density times way below the lower bounds, yet to be taken off.
    let mut known = 0.0;
    let most = c.extinction.max_component();
    let crossing = grid.crossing(way);
    let mut depth_left = f64::from(random.depth());
    for stretch in crossing.walk() {
        let fill = (stretch.most - stretch.least) * most;
        let mut t = stretch.from;
        while meets(&mut t, stretch.to, fill, &mut depth_left) {
            depth_left = f64::from(random.depth());
            let density = crossing.density(t, &stretch) - stretch.least;
            left *= Light::splat(1.0) - c.extinction * (density / fill);
            left = survivors(left, &mut random);
            if left.is_black() {
                return left;
            }
        }
        known += f64::from(stretch.least) * (stretch.to - stretch.from);
        if known * f64::from(most) > MUCH {
            left = survivors(left * fade(c.extinction, known), &mut random);
            known = 0.0;
            if left.is_black() {
                return left;
            }
        }
    }
    left * fade(c.extinction, known)
}

/// Light that is worth the rest of the walk: where little is left a coin decides, and the survivors carry for all.
fn survivors(left: Light, random: &mut Stream) -> Light {
    const LITTLE: f32 = 0.1;
    let most = left.max_component();
    if most >= LITTLE || most <= 0.0 {
        left
    } else if random.number() < most / LITTLE {
        left * (LITTLE / most)
    } else {
        Light::BLACK
    }
}

/// True if the optical depth that is left is used up before `to`, where collisions come `fill` to a unit of way: `t` is moved to
/// the collision. Otherwise the depth is lessened by what lies before `to`.
#[inline]
fn meets(t: &mut f64, to: f64, fill: f32, depth_left: &mut f64) -> bool {
    let fill = f64::from(fill);
    let depth = (to - *t) * fill;
    // Not met where nothing collides: a depth of 0 is left as it is.
    if !(*depth_left < depth) {
        *depth_left -= depth;
        return false;
    }
    *t += *depth_left / fill;
    true
}

/// Collisions per unit of density that look for light where a medium shines but takes nothing away.
const EMISSION_ALONE: f32 = 1.0;

/// Optical depth after which a transmittance is brought up to date, to see whether the walk is worth going on.
const MUCH: f64 = 2.0;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::media::voxels::Voxels;
    use kirkas_geometry::hash::{combine, unit_f32};
    use kirkas_geometry::{DAffine3, DVec3};

    /// Holes, full blocks and all between.
    fn patchy(is_local: bool) -> Grid {
        let value = |i: usize| match (i % 24 / 8, i / 24 % 24 / 8) {
            (0, _) => 0.0,
            (1, 1) => 1.0,
            _ => unit_f32((combine(5, i as u64) >> 32) as u32),
        };
        let voxels = Voxels::new([24; 3], (0..24 * 24 * 24).map(value).collect()).unwrap();
        Grid::new(voxels, DAffine3::IDENTITY, is_local)
    }

    /// Walks by either kind of bounds let through, lane by lane, what the integral of the density says; flights do it too where
    /// as much is scattered as is lost, and where part is swallowed.
    #[test]
    fn light_fades_by_the_integral_of_the_density() {
        let extinction = Light([4.0, 3.0, 1.0, 0.5]);
        let direction = DVec3::new(0.9, 0.35, 0.2).normalize();
        let way = Way { origin: DVec3::new(-0.2, 0.1, 0.3), direction, length: 3.0 };
        for is_local in [true, false] {
            let grid = patchy(is_local);
            let steps = 200_000;
            let depth: f64 = (0..steps)
                .map(|i| f64::from(grid.density(way.at((f64::from(i) + 0.5) * 3.0 / f64::from(steps)))))
                .sum();
            let expected = fade(extinction, depth * 3.0 / f64::from(steps));
            let check = |name: &str, count: u64, draw: &dyn Fn(u64) -> Light| {
                let (mut sum, mut squares) = ([0.0_f64; 4], [0.0_f64; 4]);
                for key in 0..count {
                    for (lane, &x) in draw(key).0.iter().enumerate() {
                        sum[lane] += f64::from(x);
                        squares[lane] += f64::from(x) * f64::from(x);
                    }
                }
                for lane in 0..4 {
                    let mean = sum[lane] / count as f64;
                    let error = ((squares[lane] / count as f64 - mean * mean) / count as f64).sqrt();
                    let z = (mean - f64::from(expected[lane])) / error;
                    assert!(
                        z.abs() < 4.0,
                        "{name}, local {is_local}, lane {lane}: {mean} +- {error}, not {}",
                        expected[lane]
                    );
                }
            };
            let c = Coefficients { scattering: Light::BLACK, extinction, emission: Light::BLACK };
            check("transmittance", 100_000, &|key| transmittance(&grid, &c, &way, combine(1, key)));
            for part in [1.0, 0.6] {
                let c = Coefficients { scattering: extinction * part, ..c };
                check("flight", 100_000, &|key| {
                    let u = |i| unit_f32((combine(combine(2, key), i) >> 32) as u32);
                    match fly(&grid, &c, Light::splat(1.0), &way, (u(0), u(1)), combine(3, key)).end {
                        FlightEnd::Passed(left) => left,
                        FlightEnd::Scattered { .. } => Light::BLACK,
                    }
                });
            }
        }
    }
}
