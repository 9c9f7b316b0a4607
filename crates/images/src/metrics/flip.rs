//! FLIP: the difference a person sees when flipping between two pictures on a screen.
//!
//! Pictures are clipped to `[0, 1]`, blurred as the eye blurs at the given distance, and compared in a uniform
//! colour space; where edges or points differ, the colour error is amplified. Both ways errors lie in `[0, 1]`.
//! Symmetric in the two pictures. Tested against the authors' `flip-evaluator`.
//!
//! Reference: P. Andersson, J. Nilsson, T. Akenine-Moller, M. Oskarsson, K. Astrom, M. Fairchild, "FLIP: A
//! Difference Evaluator for Alternating Images", HPG 2020 (<https://doi.org/10.1145/3406183>). Section numbers
//! below are those of the paper; like the authors' code we use its final constants, with 67.02 pixels per degree
//! for a 0.7 m wide screen of 3840 pixels at 0.7 m.

use super::flip_filters::{Plane, contrast_sensitivity_filters, feature_filters};
use super::{Difference, check_sizes, mean};
use crate::error::{ImageError, Result};
use crate::image::RgbImage;
use kirkas_geometry::elementary::{cbrt, pow};

/// Pixels per degree of visual angle: `0.7 * 3840 / 0.7 * pi / 180`.
pub const DEFAULT_PIXELS_PER_DEGREE: f64 = 67.020_643_276_582_25;

/// Compresses large colour errors (4.1.3, `q_c`).
const COLOUR_EXPONENT: f64 = 0.7;
/// Errors below `0.4 * maximum` take the range up to 0.95 (4.1.3, `p_c` and `p_t`).
const KNEE: [f64; 2] = [0.4, 0.95];
/// Raises small feature errors (4.2.2, `q_f`).
const FEATURE_EXPONENT: f64 = 0.5;

/// Compare two pictures of one size at a viewing distance of 1 to 1000 pixels per degree.
pub fn flip(test: &RgbImage, reference: &RgbImage, pixels_per_degree: f64) -> Result<Difference> {
    check_sizes(test, reference)?;
    if !(1.0..=1000.0).contains(&pixels_per_degree) {
        return Err(ImageError::OutOfRange {
            name: "the number of pixels per degree",
            value: pixels_per_degree.to_string(),
            range: "from 1 to 1000",
        });
    }
    let a = Seen::through_the_eye(test, pixels_per_degree);
    let b = Seen::through_the_eye(reference, pixels_per_degree);
    let scale = ErrorScale::new();

    let error_at = |i: usize| {
        let colour = scale.redistribute(hyab(a.lab[i], b.lab[i]));
        let edge = (a.edge[i] - b.edge[i]).abs();
        let point = (a.point[i] - b.point[i]).abs();
        let feature = pow(edge.max(point) * std::f64::consts::FRAC_1_SQRT_2, FEATURE_EXPONENT);
        // 4.3: no colour error stays none, a full feature error makes any colour error full.
        if colour > 0.0 { pow(colour, 1.0 - feature.min(1.0)) } else { 0.0 }
    };
    let broken = |i: usize| {
        let same = |lane: usize| test.pixels[i][lane].to_bits() == reference.pixels[i][lane].to_bits();
        let finite = |image: &RgbImage| image.pixels[i].iter().all(|value| value.is_finite());
        !(finite(test) && finite(reference) || (0..3).all(same))
    };
    let map: Vec<f64> = (0..a.lab.len()).map(|i| if broken(i) { f64::INFINITY } else { error_at(i) }).collect();
    let score = mean(&map);
    let map = map.into_iter().map(|error| error as f32).collect();
    Ok(Difference { score, width: test.width, height: test.height, map })
}

/// A picture as the metric compares it.
struct Seen {
    /// Blurred, Hunt-adjusted L*a*b*.
    lab: Vec<[f64; 3]>,
    /// Strength of edges, about `[0, 1]`.
    edge: Vec<f64>,
    /// Strength of points and lines, about `[0, 1]`.
    point: Vec<f64>,
}

impl Seen {
    fn through_the_eye(image: &RgbImage, pixels_per_degree: f64) -> Self {
        // Split into an achromatic and two chromatic planes (4.1.1).
        let clip = |value: f32| if value > 0.0 { f64::from(value.min(1.0)) } else { 0.0 };
        let opponent: Vec<[f64; 3]> = image.pixels.iter().map(|rgb| opponent_from_rgb(rgb.map(clip))).collect();
        let plane = |lane: usize| Plane::new(image.size(), opponent.iter().map(|pixel| pixel[lane]).collect());
        let achromatic = plane(0);

        // Blur each as the eye does; what that throws out of gamut is clipped (4.1.1, 4.1.2).
        let filters = contrast_sensitivity_filters(pixels_per_degree);
        let [y, cx, cz] = [0, 1, 2].map(|lane| filters[lane].apply(&plane(lane)));
        let lab = (0..opponent.len())
            .map(|i| hunt_lab_from_rgb(rgb_from_opponent([y[i], cx[i], cz[i]]).map(|v| v.clamp(0.0, 1.0))))
            .collect();

        // Find features in the achromatic plane, scaled to [0, 1] (4.2.1).
        let luminance = achromatic.map(|y| (y + 16.0) / 116.0);
        let [edge, point] = feature_filters(pixels_per_degree).map(|filter| filter.gradient_length(&luminance));
        Self { lab, edge, point }
    }
}

/// Maps colour distances to `[0, 1]` (4.1.3).
struct ErrorScale {
    /// The distance between pure green and pure blue, the farthest colours of a screen.
    maximum: f64,
}

impl ErrorScale {
    fn new() -> Self {
        let farthest = hyab(hunt_lab_from_rgb([0.0, 1.0, 0.0]), hunt_lab_from_rgb([0.0, 0.0, 1.0]));
        Self { maximum: pow(farthest, COLOUR_EXPONENT) }
    }

    fn redistribute(&self, distance: f64) -> f64 {
        let error = pow(distance, COLOUR_EXPONENT);
        let [knee, height] = [KNEE[0] * self.maximum, KNEE[1]];
        if error < knee {
            error * height / knee
        } else {
            height + (error - knee) / (self.maximum - knee) * (1.0 - height)
        }
    }
}

/// City-block distance in lightness, Euclidean in chroma (Abasi et al. 2020).
fn hyab(a: [f64; 3], b: [f64; 3]) -> f64 {
    let [dl, da, db] = [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
    dl.abs() + (da * da + db * db).sqrt()
}

/// Rows X, Y, Z of linear sRGB, from its primaries and white D65 at (0.3127, 0.3290).
const XYZ_FROM_RGB: [[f64; 3]; 3] = [
    [10135552.0 / 24577794.0, 8788810.0 / 24577794.0, 4435075.0 / 24577794.0],
    [2613072.0 / 12288897.0, 8788810.0 / 12288897.0, 887015.0 / 12288897.0],
    [1425312.0 / 73733382.0, 8788810.0 / 73733382.0, 70074185.0 / 73733382.0],
];

/// X, Y, Z over those of white.
fn relative_xyz_from_rgb(rgb: [f64; 3]) -> [f64; 3] {
    XYZ_FROM_RGB.map(|[r, g, b]| (r * rgb[0] + g * rgb[1] + b * rgb[2]) / (r + g + b))
}

/// Y Cx Cz, a linear form of L*a*b*.
fn opponent_from_rgb(rgb: [f64; 3]) -> [f64; 3] {
    let [x, y, z] = relative_xyz_from_rgb(rgb);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

fn rgb_from_opponent([y, cx, cz]: [f64; 3]) -> [f64; 3] {
    let y = (y + 16.0) / 116.0;
    let relative = [y + cx / 500.0, y, y - cz / 200.0];
    // Solve the three equations of `relative_xyz_from_rgb` by Cramer's rule.
    let rows = XYZ_FROM_RGB.map(|row| row.map(|value| value / row.iter().sum::<f64>()));
    let column = |lane: usize| rows.map(|row| row[lane]);
    let [r, g, b] = [column(0), column(1), column(2)];
    let whole = determinant(r, g, b);
    [determinant(relative, g, b) / whole, determinant(r, relative, b) / whole, determinant(r, g, relative) / whole]
}

fn determinant(a: [f64; 3], b: [f64; 3], c: [f64; 3]) -> f64 {
    a[0] * (b[1] * c[2] - b[2] * c[1]) - b[0] * (a[1] * c[2] - a[2] * c[1]) + c[0] * (a[1] * b[2] - a[2] * b[1])
}

/// L*a*b*, chroma fading in the dark as Hunt observed (4.1.2).
fn hunt_lab_from_rgb(rgb: [f64; 3]) -> [f64; 3] {
    let delta: f64 = 6.0 / 29.0;
    let f = |t: f64| if t > delta * delta * delta { cbrt(t) } else { t / (3.0 * delta * delta) + 4.0 / 29.0 };
    let [x, y, z] = relative_xyz_from_rgb(rgb).map(f);
    let lightness = 116.0 * y - 16.0;
    [lightness, 0.01 * lightness * 500.0 * (x - y), 0.01 * lightness * 200.0 * (y - z)]
}
