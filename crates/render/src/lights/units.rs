//! Units of light. Inside, point lights are W/sr, directional ones W/m2, surfaces W/(m2 sr), per RGB lane.
//!
//! Photometric units are turned into radiometric ones by the luminous efficacy 683 lm/W applied to the luminance of the
//! colour (Rec.709 weights): a film value of 1 is then 683 cd/m2. Powers (W, lm) are those of the whole light with its colour
//! scaled to mean 1 (W) or luminance 1 (lm).
//!
//! `plain` numbers are the course's: a white Lambertian surface that faces the light (at distance 1, for points) appears
//! as bright as the number. Hence the factor pi: it appears with radiance E / pi.

use core::f64::consts::PI;
use kirkas_optics::{Paint, Palette, Spectrum};

/// Photometric efficacy, lm/W.
pub const EFFICACY: f64 = 683.0;

/// How a value in `unit` with `color` shines per `solid_angle`, the effective one that its power goes into (sr; for
/// surfaces: the projected solid angle times area, for directions 1).
pub fn light(palette: &Palette, value: f64, color: &Paint, unit: &str, solid_angle: f64) -> Spectrum {
    let rgb = color.rgb;
    let luminance = 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2];
    let mean = (rgb[0] + rgb[1] + rgb[2]) / 3.0;
    let over = |v: f64, by: f64| if by > 0.0 { v / by } else { 0.0 };
    let scale = match unit {
        "plain" => value * PI,
        "W" => over(value, solid_angle * mean),
        "lm" => over(value, solid_angle * luminance * EFFICACY),
        "cd" | "lux" | "nit" => over(value, luminance * EFFICACY),
        _ => value,
    };
    palette.shine(color, scale)
}

/// Distance falloff `1 / (a r^2 + b r + c)`; `None` stands for the true `1 / r^2`.
pub fn falloff(attenuation: Option<[f64; 3]>, r: f64) -> f64 {
    let [a, b, c] = attenuation.unwrap_or([1.0, 0.0, 0.0]);
    let d = a * r * r + b * r + c;
    if d > 0.0 { 1.0 / d } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_watt_spread_over_the_sphere_is_a_twelfth_of_a_watt_per_steradian() {
        let l = light(&Palette::RGB, 1.0, &[1.0; 3].into(), "W", 4.0 * PI).rgb();
        assert!((l[1] - (1.0 / (4.0 * PI)) as f32).abs() < 1e-7);
    }

    #[test]
    fn a_candela_is_a_683rd_of_a_watt_per_steradian_whatever_the_colour() {
        for c in [[1.0; 3], [1.0, 0.5, 0.1]] {
            let l = light(&Palette::RGB, 683.0, &c.into(), "cd", 1.0).rgb();
            let y = 0.2126 * l[0] + 0.7152 * l[1] + 0.0722 * l[2];
            assert!((y - 1.0).abs() < 1e-6);
        }
        let white = |value, unit, solid_angle| light(&Palette::RGB, value, &[1.0; 3].into(), unit, solid_angle);
        assert_eq!(white(12.57, "lm", 12.57), white(1.0, "cd", 1.0));
    }

    #[test]
    fn falloff_curves() {
        assert_eq!(falloff(None, 2.0), 0.25);
        assert_eq!(falloff(Some([0.0, 0.2, 0.0]), 5.0), 1.0);
        assert_eq!(falloff(Some([0.0, 0.0, 1.0]), 1e9), 1.0);
        assert_eq!(falloff(Some([1.0, 2.0, 4.0]), 2.0), 1.0 / 12.0);
    }
}
