//! Flights through media that are not the same everywhere. The medium is filled up to a bound with particles that do nothing;
//! then collisions are as frequent as in a homogeneous one, and at each a coin says whether the particle was real.
//!
//! Distances: delta tracking (Woodcock et al. 1965, "Techniques Used in the GEM Code for Monte Carlo Neutronics Calculations"),
//! with a bound for each cell of a coarse grid. Transmittances: ratio tracking (Novak, Selle & Jarosz 2014, "Residual Ratio
//! Tracking for Estimating Attenuation in Participating Media"). Where lanes differ, one coin is thrown for all with their mean
//! probability, weighted by what they carry, and each lane is corrected for it (Kutz et al. 2017, "Spectral and Decomposition
//! Tracking for Rendering Heterogeneous Volumes", section 5, history-aware).

use super::grid::Grid;
use super::random::{Stream, depth};
use super::{Coefficients, Flight, FlightEnd, Way, dot, shares};
use kirkas_optics::Light;

/// A flight; see [`Volume::fly`](super::Volume::fly).
pub(super) fn fly(grid: &Grid, c: &Coefficients, throughput: Light, way: &Way, u: (f32, f32), key: u64) -> Flight {
    let mut random = Stream::new(key);
    let mut flight = Flight { emitted: Light::BLACK, end: FlightEnd::Passed(Light::splat(1.0)) };
    let mut weight = Light::splat(1.0);
    let (scatters, shines) = (!c.scattering.is_black(), !c.emission.is_black());
    let (first_depth, mut first_coin) = (depth(u.1), Some(u.0));
    let ended = collide(grid, c, way, first_depth, &mut random, |distance, density, fill, random| {
        let real = c.extinction * (density / fill);
        if shines {
            flight.emitted += weight * c.emission * (density / fill);
        }
        if scatters {
            let chance = dot(shares(throughput * weight), real);
            let coin = first_coin.take().unwrap_or_else(|| random.number());
            if coin < chance {
                let weight = weight * c.scattering * (density / fill / chance);
                flight.end = FlightEnd::Scattered { distance, weight };
                return true;
            }
            weight = weight * (Light::splat(1.0) - real) / (1.0 - chance);
        } else {
            weight *= Light::splat(1.0) - real;
        }
        weight.is_black()
    });
    if !ended || weight.is_black() {
        flight.end = FlightEnd::Passed(weight);
    }
    flight
}

/// What is left of light; see [`Volume::transmittance`](super::Volume::transmittance).
pub(super) fn transmittance(grid: &Grid, c: &Coefficients, way: &Way, key: u64) -> Light {
    /// Below this much a coin decides whether the rest is worth the walk.
    const LITTLE: f32 = 0.1;
    let mut random = Stream::new(key);
    let mut left = Light::splat(1.0);
    let first_depth = random.depth();
    collide(grid, c, way, first_depth, &mut random, |_, density, fill, random| {
        left *= Light::splat(1.0) - c.extinction * (density / fill);
        let most = left.max_component();
        if most < LITTLE && most > 0.0 {
            let survives = random.number() < most / LITTLE;
            left *= if survives { LITTLE / most } else { 0.0 };
        }
        left.is_black()
    });
    left
}

/// Walk from collision to collision, real or not: `at(distance, density, fill, random)` is told the density there and the `fill`
/// by which collisions are as frequent as extinction `fill` makes them; true from it ends the walk, and is what comes back.
fn collide(
    grid: &Grid,
    c: &Coefficients,
    way: &Way,
    first_depth: f32,
    random: &mut Stream,
    mut at: impl FnMut(f64, f32, f32, &mut Stream) -> bool,
) -> bool {
    let most = c.extinction.max_component().max(if c.emission.is_black() { 0.0 } else { EMISSION_ALONE });
    let mut left = f64::from(first_depth);
    for stretch in grid.walk(way) {
        let fill = stretch.bound * most;
        if fill <= 0.0 {
            continue;
        }
        let mut t = stretch.from;
        loop {
            let step = left / f64::from(fill);
            if !(t + step < stretch.to) {
                left -= (stretch.to - t) * f64::from(fill);
                break;
            }
            t += step;
            let density = grid.density(way.at(t)).min(stretch.bound);
            if at(t, density, fill, random) {
                return true;
            }
            left = f64::from(random.depth());
        }
    }
    false
}

/// Collisions per unit of density that look for light where a medium shines but takes nothing away.
const EMISSION_ALONE: f32 = 1.0;
