//! Angles as the command line takes them, and the directions they stand for.

use kirkas_geometry::elementary::{cos, sin};
use kirkas_geometry::{DVec3, Vec3};

/// The most values that a list may have.
const MOST: usize = 10_000;

/// Values in degrees: `45`, `0,30,60`, `0..90:15`, or a mixture.
#[derive(Clone, Debug, PartialEq)]
pub struct Angles(pub Vec<f64>);

/// Angles from the normal.
pub fn thetas(text: &str) -> Result<Angles, String> {
    let angles = list(text)?;
    match angles.0.iter().find(|a| !(0.0..=180.0).contains(*a)) {
        Some(a) => Err(format!("theta is from 0 to 180 degrees, not {a}")),
        None => Ok(angles),
    }
}

/// Angles from the normal, above the surface.
pub fn upper_thetas(text: &str) -> Result<Angles, String> {
    let angles = list(text)?;
    match angles.0.iter().find(|a| !(0.0..90.0).contains(*a)) {
        Some(a) => Err(format!("light arrives from 0 up to, not including, 90 degrees, not {a}")),
        None => Ok(angles),
    }
}

/// Angles around the normal.
pub fn list(text: &str) -> Result<Angles, String> {
    let mut all = Vec::new();
    for part in text.split(',') {
        match part.split_once("..") {
            None => all.push(number(part)?),
            Some((from, rest)) => {
                let (to, step) = rest.split_once(':').ok_or("a range has a step: FROM..TO:STEP, such as 0..90:15")?;
                let (from, to, step) = (number(from)?, number(to)?, number(step)?);
                if !(step > 0.0 && to >= from) {
                    return Err(format!(
                        "the range {part} runs nowhere: FROM..TO:STEP needs FROM <= TO and a STEP above 0"
                    ));
                }
                let count = ((to - from) / step + 1e-9).floor();
                if count >= MOST as f64 {
                    return Err(format!("the range {part} has more than {MOST} values"));
                }
                all.extend((0..=count as usize).map(|i| from + i as f64 * step));
            }
        }
    }
    if all.len() > MOST { Err(format!("more than {MOST} values")) } else { Ok(Angles(all)) }
}

fn number(text: &str) -> Result<f64, String> {
    let value = text.trim().parse().ok().filter(|v: &f64| v.is_finite());
    value.ok_or_else(|| format!("`{}` is not an angle in degrees", text.trim()))
}

/// The unit vector at these angles, in degrees.
pub fn direction(theta: f64, phi: f64) -> Vec3 {
    let (theta, phi) = (theta.to_radians(), phi.to_radians());
    DVec3::new(sin(theta) * cos(phi), sin(theta) * sin(phi), cos(theta)).as_vec3()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_hold_single_values_and_ranges_with_both_ends() {
        assert_eq!(list("45"), Ok(Angles(vec![45.0])));
        assert_eq!(list("-10, 0..90:30,180"), Ok(Angles(vec![-10.0, 0.0, 30.0, 60.0, 90.0, 180.0])));
        assert_eq!(list("0..1:0.1").map(|a| a.0.len()), Ok(11));
    }

    #[test]
    fn what_is_no_list_of_angles_is_told() {
        for text in ["", "a", "0..90", "0..90:0", "90..0:5", "0..1e9:1", "inf", "1,,2"] {
            assert!(list(text).is_err(), "{text}");
        }
        assert!(thetas("181").is_err() && thetas("-1").is_err() && upper_thetas("90").is_err());
    }

    #[test]
    fn directions_are_of_unit_length_in_the_frame_of_the_head() {
        assert!((direction(90.0, 90.0) - Vec3::Y).length() < 1e-7);
        assert!((direction(30.0, 200.0).length() - 1.0).abs() < 1e-6);
        assert_eq!(direction(0.0, 0.0), Vec3::Z);
    }
}
