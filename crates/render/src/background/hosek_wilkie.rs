//! The clear sky of Hosek & Wilkie 2012, "An Analytic Model for Full Spectral Sky-Dome Radiance": its radiance by direction,
//! fitted to path-traced atmospheres, with their RGB data (`hosek_wilkie/rgb.f32`, release 1.4a of February 2013, under
//! the licence beside it).
//!
//! Per channel (red, green, blue of linear Rec.709) the data hold, as little-endian `f32`: for ground albedo 0 and 1, for
//! turbidity 1 to 10, six control points over the sun's elevation of the nine coefficients A to I; then, in the same
//! order, six of the mean radiance in W/(m2 sr) (a luminance of 683 cd/m2 counts as 1).

use core::f64::consts::FRAC_PI_2;
use kirkas_geometry::elementary::{cbrt, exp};

const DATA: &[u8; 3 * CHANNEL * 4] = include_bytes!("hosek_wilkie/rgb.f32");

const COEFFICIENTS: usize = 9;
const KNOTS: usize = 6;
const TURBIDITIES: usize = 10;
/// Numbers of one channel.
const CHANNEL: usize = 2 * TURBIDITIES * KNOTS * (COEFFICIENTS + 1);

/// A sky for one sun.
#[derive(Clone, Debug)]
pub struct HosekWilkie {
    channels: [Channel; 3],
}

#[derive(Clone, Debug)]
struct Channel {
    coefficients: [f64; COEFFICIENTS],
    /// W/(m2 sr).
    mean: f64,
}

impl HosekWilkie {
    /// For a turbidity of 1 to 10, a ground albedo of 0 to 1 per channel, and a sun at `elevation` from 0 to pi/2; what lies
    /// outside is moved to the nearest end.
    pub fn new(turbidity: f64, albedo: [f64; 3], elevation: f64) -> Self {
        let turbidity = turbidity.clamp(1.0, TURBIDITIES as f64);
        // The fit is closer together where the sun is low.
        let x = cbrt(elevation.clamp(0.0, FRAC_PI_2) / FRAC_PI_2);
        let channel = |c: usize| {
            let start = c * CHANNEL;
            let means = start + 2 * TURBIDITIES * KNOTS * COEFFICIENTS;
            let albedo = albedo[c].clamp(0.0, 1.0);
            Channel {
                coefficients: std::array::from_fn(|k| interpolate(start, COEFFICIENTS, k, turbidity, albedo, x)),
                mean: interpolate(means, 1, 0, turbidity, albedo, x),
            }
        };
        HosekWilkie { channels: [channel(0), channel(1), channel(2)] }
    }

    /// Radiance from a direction above the horizon, by the cosine of its angle from the zenith and its angle from the sun
    /// (radians), W/(m2 sr): equation 8 of the paper, with the glow around the sun as corrected in its release.
    pub fn radiance(&self, cos_theta: f64, gamma: f64, cos_gamma: f64) -> [f64; 3] {
        let up = cos_theta.max(0.0);
        std::array::from_fn(|c| {
            let Channel { coefficients: [a, b, c0, d, e, f, g, h, i], mean } = &self.channels[c];
            let squared = cos_gamma * cos_gamma;
            let base = 1.0 + i * i - 2.0 * i * cos_gamma;
            let glow = (1.0 + squared) / (base * base.sqrt());
            let horizon = 1.0 + a * exp(b / (up + 0.01));
            let sky = c0 + d * exp(e * gamma) + f * squared + g * glow + h * up.sqrt();
            (mean * horizon * sky).max(0.0)
        })
    }
}

fn number(i: usize) -> f64 {
    f64::from(f32::from_le_bytes(std::array::from_fn(|k| DATA[4 * i + k])))
}

/// Linear in turbidity and albedo, a quintic Bezier curve in `x`. `stride` numbers make one knot.
fn interpolate(start: usize, stride: usize, k: usize, turbidity: f64, albedo: f64, x: f64) -> f64 {
    let low = (turbidity as usize).clamp(1, TURBIDITIES - 1);
    let share = turbidity - low as f64;
    let curve = |albedo: usize, turbidity: usize| {
        let at = start + ((albedo * TURBIDITIES + turbidity - 1) * KNOTS) * stride + k;
        // De Casteljau.
        let mut p: [f64; KNOTS] = std::array::from_fn(|i| number(at + i * stride));
        for last in (1..KNOTS).rev() {
            for i in 0..last {
                p[i] = p[i] * (1.0 - x) + p[i + 1] * x;
            }
        }
        p[0]
    };
    let at = |albedo| curve(albedo, low) * (1.0 - share) + curve(albedo, low + 1) * share;
    at(0) * (1.0 - albedo) + at(1) * albedo
}

#[cfg(test)]
mod tests {
    use super::*;
    use core::f64::consts::PI;
    use kirkas_geometry::elementary::{acos, cos, sin};

    /// Luminance of the zenith and illuminance of the ground by the sky alone, in cd/m2 and lux.
    fn measured(turbidity: f64, degrees: f64) -> (f64, f64) {
        let sky = HosekWilkie::new(turbidity, [0.1; 3], degrees.to_radians());
        let sun = FRAC_PI_2 - degrees.to_radians();
        let luminance = |theta: f64, phi: f64| {
            let cos_gamma = sin(theta) * cos(phi) * sin(sun) + cos(theta) * cos(sun);
            let [r, g, b] = sky.radiance(cos(theta), acos(cos_gamma.clamp(-1.0, 1.0)), cos_gamma);
            683.0 * (0.2126 * r + 0.7152 * g + 0.0722 * b)
        };
        const N: usize = 60;
        let step = FRAC_PI_2 / N as f64;
        let mut sum = 0.0;
        for i in 0..N * 4 * N {
            let theta = ((i % N) as f64 + 0.5) * step;
            sum += luminance(theta, ((i / N) as f64 + 0.5) * step) * cos(theta) * sin(theta) * step * step;
        }
        (luminance(0.0, 0.0), sum)
    }

    #[test]
    fn a_clear_sky_lights_the_ground_as_clear_skies_do() {
        // Clear skies without the sun give 8 to 20 klux; haze gives more (CIE 108-1994).
        for (turbidity, degrees, low, high) in
            [(2.0, 10.0, 7e3, 10e3), (3.0, 45.0, 13e3, 18e3), (3.0, 80.0, 15e3, 20e3), (6.0, 60.0, 22e3, 32e3)]
        {
            let lux = measured(turbidity, degrees).1;
            assert!((low..high).contains(&lux), "turbidity {turbidity}, sun at {degrees}: {lux} lux");
        }
        // The zenith of a clear sky, sun at 45 degrees: 2 to 4 kcd/m2.
        assert!((2e3..4e3).contains(&measured(2.5, 45.0).0));
    }

    #[test]
    fn the_zenith_is_blue_and_the_sky_around_a_low_sun_red() {
        let sky = HosekWilkie::new(3.0, [0.1; 3], 5.0_f64.to_radians());
        let zenith = sky.radiance(1.0, 85.0_f64.to_radians(), cos(85.0_f64.to_radians()));
        assert!(zenith[2] > 1.5 * zenith[1] && zenith[1] > zenith[0]);
        let near = 3.0_f64.to_radians();
        let aureole = sky.radiance(cos(85.0_f64.to_radians()), near, cos(near));
        assert!(aureole[0] > aureole[1] && aureole[1] > aureole[2]);
    }

    #[test]
    fn whole_turbidities_are_those_of_the_data() {
        // The first knot of coefficient A, red, albedo 0, turbidity 1, and the last of turbidity 10.
        assert_eq!(interpolate(0, COEFFICIENTS, 0, 1.0, 0.0, 0.0), number(0));
        assert_eq!(interpolate(0, COEFFICIENTS, 0, 10.0, 0.0, 1.0), number(9 * 54 + 5 * 9));
        assert_eq!(interpolate(0, COEFFICIENTS, 8, 4.0, 1.0, 0.0), number(540 + 3 * 54 + 8));
        let half = 0.5 * (number(3 * 54) + number(4 * 54));
        assert!((interpolate(0, COEFFICIENTS, 0, 4.5, 0.0, 0.0) - half).abs() < 1e-12);
    }

    #[test]
    fn no_direction_is_negative_or_infinite() {
        for i in 0..2000 {
            let at = |k: u32| f64::from((i * k) % 101) / 100.0;
            let sky = HosekWilkie::new(at(3) * 12.0, [at(7), at(11), at(13)], at(17) * 2.0 - 0.2);
            let gamma = at(29) * PI;
            assert!(sky.radiance(at(23), gamma, cos(gamma)).iter().all(|x| x.is_finite() && *x >= 0.0));
        }
    }
}
