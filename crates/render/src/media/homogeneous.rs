//! # homogeneous
//!
//! The same everywhere: fog, murky water, wax.
//!
//! ## Parameters
//!
//! | name | type | unit | default | meaning |
//! |---|---|---|---|---|
//! | `scattering` | colour | 1/scene unit | 0 | light that is scattered, per unit of way |
//! | `absorption` | colour | 1/scene unit | 0 | light that is swallowed, per unit of way |
//! | `emission` | colour | W/m2/sr per scene unit | 0 | radiance that is added, per unit of way |
//! | `phase` | phase function | | evenly | into which directions light is scattered |
//!
//! ## Example
//!
//! ```toml
//! [background]
//! type = "constant"
//! medium = "fog"
//!
//! [media.fog]
//! type = "homogeneous"
//! scattering = 0.05
//! ```
//!
//! ## Limits
//!
//! Where colours differ strongly in how far they reach, deep scattering is noisy in colour.
//!
//! ## References
//!
//! Beer & Lambert's law; the inverse of its distribution function.

use super::{Coefficients, Flight, FlightEnd, dot, fade, mean_way, random, shares};
use kirkas_optics::Light;
use kirkas_scene::{Kind, TypeSpec};

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Medium,
    name: "homogeneous",
    doc: "The same everywhere: fog, murky water, wax.",
    params: &[],
};

/// A flight of at most `length`.
pub(super) fn fly(c: &Coefficients, throughput: Light, length: f64, u: (f32, f32)) -> Flight {
    // What shines on the way is added whole, weakened by what lies before it.
    let emitted = Light(core::array::from_fn(|i| {
        if c.emission[i] > 0.0 { c.emission[i] * mean_way(c.extinction[i], length) } else { 0.0 }
    }));
    let left = fade(c.extinction, length);
    if c.scattering.is_black() {
        return Flight { emitted, end: FlightEnd::Passed(left) };
    }

    // Draw a distance for one lane, chosen by what it carries.
    let q = shares(throughput);
    let t = c.extinction[pick(q, u.0)];
    let distance = if t > 0.0 { f64::from(random::depth(u.1) / t) } else { f64::INFINITY };
    let end = if distance < length {
        let fading = fade(c.extinction, distance);
        let pdf = dot(q, c.extinction * fading);
        FlightEnd::Scattered { distance, weight: c.scattering * fading / pdf }
    } else {
        FlightEnd::Passed(left / dot(q, left))
    };
    Flight { emitted, end }
}

/// The lane that `u` stands for; one without share never is.
fn pick(shares: Light, u: f32) -> usize {
    let (mut below, mut last) = (0.0, 0);
    for (lane, &share) in shares.0.iter().enumerate().filter(|(_, s)| **s > 0.0) {
        last = lane;
        below += share;
        if u < below {
            break;
        }
    }
    last
}
