//! # image: a picture of the surroundings
//!
//! An environment map: a PNG, JPEG, HDR or EXR file in latitude and longitude (equirectangular, twice as wide as high) that
//! lights the scene from all around. Directions are drawn in proportion to what the picture holds, so that the sun in it
//! casts its shadow without noise.
//!
//! ## Parameters
//!
//! - `file` (path, required): the picture, relative to the file that names it.
//! - `encoding` (`auto`, `srgb`, `linear`; default `auto`): as for textures: codes are sRGB, floats are linear.
//! - `intensity` (default 1): times the picture's numbers, which then are radiance in W/(m2 sr).
//! - `transform`: steps that turn the surroundings; turns and mirrors only.
//!
//! ## Orientation
//!
//! As seen from inside: the top row is +y (up), the middle of the picture +z, its left and right edge -z; a quarter to the
//! right of the middle is -x. With z up write `transform = [{ rotate = [1, 0, 0, 90] }]`.
//!
//! ## Example
//!
//! ```toml
//! [background]
//! type = "image"
//! file = "garden.hdr"
//! transform = [{ rotate = [0, 1, 0, 30] }]
//! ```
//!
//! ## Limits
//!
//! Texels are not filtered over a pixel's footprint. Negative numbers and those that are not finite count as 0.
//!
//! ## References
//!
//! Pharr, Jakob & Humphreys 2023, "Physically Based Rendering", section 12.5; the density here is bilinear as the lookup is.

use super::map_distribution::{MapDistribution, MapPoint};
use crate::textures::{Picture, read_picture};
use core::f64::consts::PI;
use kirkas_geometry::elementary::{atan2, sin, sin_cos};
use kirkas_geometry::{DMat3, DVec3};
use kirkas_scene::spec::NOT_NEGATIVE;
use kirkas_scene::transforms::read_transform;
use kirkas_scene::{Assets, Diagnostic, Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};
use std::sync::Arc;

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Background,
    name: "image",
    doc: "A picture of the surroundings, in latitude and longitude.",
    params: &[
        ParamSpec::new(
            "file",
            ParamType::Path,
            Fallback::Required,
            "The picture: PNG, JPEG, BMP, TGA, TIFF, HDR or EXR.",
        ),
        ParamSpec::choice(
            "encoding",
            &["auto", "srgb", "linear"],
            "How numbers mean light; auto: codes are sRGB, floats are linear.",
        ),
        ParamSpec::number("intensity", 1.0, "Times the picture's numbers.").unit("W/(m2 sr)").range(NOT_NEGATIVE),
        ParamSpec::new(
            "transform",
            ParamType::Transform,
            Fallback::Absent,
            "Steps that turn it; turns and mirrors only.",
        ),
    ],
};

/// The background.
#[derive(Clone, Debug)]
pub struct ImageBackground {
    map: Arc<SkyMap>,
    intensity: f32,
}

impl ImageBackground {
    /// From its parameters.
    pub fn new(p: &Params, assets: &dyn Assets) -> Result<Self, Diagnostic> {
        let map = SkyMap::new(read_picture(p, assets)?, turn(p)?);
        Ok(ImageBackground { map: Arc::new(map), intensity: p.f32("intensity") })
    }

    /// True when it sends nothing from anywhere.
    pub fn is_black(&self) -> bool {
        self.map.is_black() || self.intensity == 0.0
    }

    /// The integral of radiance over all directions, red, green and blue together, W/m2.
    pub fn total_radiance(&self) -> f64 {
        self.map.total * f64::from(self.intensity)
    }

    /// Linear Rec.709 radiance from a direction.
    pub fn radiance(&self, direction: DVec3) -> [f32; 3] {
        self.shining(self.map.color(direction))
    }

    /// A direction from which light comes, its radiance, and its density per solid angle.
    pub fn sample(&self, u: (f32, f32)) -> Option<(DVec3, [f32; 3], f64)> {
        self.map.sample(u).map(|(direction, color, pdf)| (direction, self.shining(color), pdf))
    }

    /// The radiance from a direction, and the density per solid angle with which [`ImageBackground::sample`] gives it.
    pub fn seen(&self, direction: DVec3) -> ([f32; 3], f64) {
        let (color, pdf) = self.map.seen(direction);
        (self.shining(color), pdf)
    }

    fn shining(&self, color: [f32; 3]) -> [f32; 3] {
        color.map(|c| c * self.intensity)
    }
}

/// The linear part of `transform`, which must keep all angles and sizes.
fn turn(p: &Params) -> Result<DMat3, Diagnostic> {
    let Some(node) = p.entity.params.get("transform") else { return Ok(DMat3::IDENTITY) };
    let m = read_transform(node)?.matrix3;
    let off = m.transpose() * m - DMat3::IDENTITY;
    if off.to_cols_array().iter().any(|x| x.abs() > 1e-6) {
        let message = "the surroundings can be turned and mirrored, not stretched";
        return Err(Diagnostic::error("bad-transform", message)
            .at(node.span, "stretches")
            .help("use `rotate` steps; `intensity` makes it brighter"));
    }
    Ok(m)
}

/// A direction on the map: column and row in texels, and the sine of its polar angle.
struct Place {
    x: f64,
    y: f64,
    sine: f64,
}

/// A picture of all directions that can be looked up and sampled.
#[derive(Clone, Debug)]
pub struct SkyMap {
    picture: Picture,
    world_from_map: DMat3,
    /// `None` for a black picture.
    distribution: Option<MapDistribution>,
    /// Integral over all directions, red, green and blue together.
    total: f64,
}

impl SkyMap {
    /// A map that is turned by `world_from_map`, which is orthonormal.
    pub fn new(mut picture: Picture, world_from_map: DMat3) -> Self {
        for texel in &mut picture.texels {
            *texel = texel.map(|c| if c.is_finite() { c.max(0.0) } else { 0.0 });
        }
        let rows = picture.height;
        let weight = |(i, c): (usize, &[f32; 3])| {
            let theta = PI * ((i / picture.width) as f64 + 0.5) / rows as f64;
            ((f64::from(c[0]) + f64::from(c[1]) + f64::from(c[2])) * sin(theta)) as f32
        };
        let weights: Vec<f32> = picture.texels.iter().enumerate().map(weight).collect();
        let per_texel = 2.0 * PI * PI / (rows * picture.width).max(1) as f64;
        let total = weights.iter().map(|w| f64::from(*w)).sum::<f64>() * per_texel;
        SkyMap { distribution: MapDistribution::new(picture.width, weights), picture, world_from_map, total }
    }

    /// True when no texel shines.
    pub fn is_black(&self) -> bool {
        self.distribution.is_none()
    }

    /// The bilinear interpolation of the texels around a direction (of any length but 0).
    pub fn color(&self, direction: DVec3) -> [f32; 3] {
        self.color_at(&self.place(direction))
    }

    /// The same, and the density of [`SkyMap::sample`], per solid angle.
    pub fn seen(&self, direction: DVec3) -> ([f32; 3], f64) {
        if self.is_black() {
            return ([0.0; 3], 0.0);
        }
        let place = self.place(direction);
        (self.color_at(&place), self.pdf_at(&place))
    }

    /// The density of [`SkyMap::sample`] alone.
    pub fn pdf(&self, direction: DVec3) -> f64 {
        self.pdf_at(&self.place(direction))
    }

    fn pdf_at(&self, place: &Place) -> f64 {
        let Some(distribution) = &self.distribution else { return 0.0 };
        let pdf = distribution.pdf(place.x, place.y) * self.texels_per_steradian(place.sine);
        if pdf.is_finite() { pdf } else { 0.0 }
    }

    /// A direction, its colour, and its density per solid angle.
    pub fn sample(&self, u: (f32, f32)) -> Option<(DVec3, [f32; 3], f64)> {
        let MapPoint { x, y, pdf } = self.distribution.as_ref()?.sample(u);
        let theta = PI * y / self.picture.height as f64;
        let phi = 2.0 * PI * x / self.picture.width as f64;
        let ((sine, cosine), (s, c)) = (sin_cos(theta), sin_cos(phi));
        let direction = DVec3::new(sine * s, cosine, -sine * c);
        let pdf = pdf * self.texels_per_steradian(sine);
        let color = || self.color_at(&Place { x, y, sine });
        (pdf > 0.0 && pdf.is_finite()).then(|| ((self.world_from_map * direction).normalize(), color(), pdf))
    }

    fn color_at(&self, place: &Place) -> [f32; 3] {
        let (x, y) = (place.x - 0.5, place.y - 0.5);
        let (columns, rows) = (self.picture.width, self.picture.height);
        let (i, j) = (x.floor(), y.floor());
        let (s, t) = ((x - i) as f32, (y - j) as f32);
        // Columns go round, rows end at the poles. A place lies half a texel beyond them at most.
        let left = if i < 0.0 { columns - 1 } else { (i as usize).min(columns - 1) };
        let right = if left + 1 == columns { 0 } else { left + 1 };
        let top = j.max(0.0) as usize;
        let bottom = ((j + 1.0) as usize).min(rows - 1);
        let at = |row: usize, column: usize| self.picture.texels[row.min(rows - 1) * columns + column];
        let (a, b, d, e) = (at(top, left), at(top, right), at(bottom, left), at(bottom, right));
        std::array::from_fn(|c| (a[c] * (1.0 - s) + b[c] * s) * (1.0 - t) + (d[c] * (1.0 - s) + e[c] * s) * t)
    }

    fn place(&self, direction: DVec3) -> Place {
        let d = self.world_from_map.transpose() * direction;
        let r = (d.x * d.x + d.z * d.z).sqrt();
        let turns = atan2(d.x, -d.z) / (2.0 * PI);
        let turns = if turns < 0.0 { turns + 1.0 } else { turns };
        let theta = atan2(r, d.y);
        Place { x: turns * self.picture.width as f64, y: theta / PI * self.picture.height as f64, sine: r / d.length() }
    }

    /// How many square texels cover a unit of solid angle, where the polar angle has this sine.
    fn texels_per_steradian(&self, sine: f64) -> f64 {
        (self.picture.width * self.picture.height) as f64 / (2.0 * PI * PI * sine)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kirkas_geometry::Vec3;
    use kirkas_geometry::elementary::cos;
    use kirkas_geometry::transform::rotation;
    use kirkas_testkit::{ChiSquare, Random};

    /// Noise, a dark patch, and a sun of one texel.
    fn picture() -> Picture {
        let mut random = Random::new(3);
        let mut texels: Vec<[f32; 3]> = (0..32 * 16).map(|_| [random.number(), random.number(), 0.2]).collect();
        texels[90..120].fill([0.0; 3]);
        texels[6 * 32 + 31] = [900.0, 700.0, 500.0];
        Picture { width: 32, height: 16, texels }
    }

    fn turned() -> DMat3 {
        rotation(DVec3::new(1.0, -2.0, 0.5), 71.0)
    }

    #[test]
    fn directions_follow_their_density_also_when_the_map_is_turned() {
        let map = SkyMap::new(picture(), turned());
        let sample = |_, u| map.sample(u).map(|s| s.0.as_vec3());
        let test = ChiSquare { rows: 32, columns: 64, ..ChiSquare::default() };
        let result = test.run(sample, |w: Vec3| map.seen(w.as_dvec3()).1 as f32);
        assert!((result.total - 1.0).abs() < 1e-3 && result.p_value > 0.001, "{result:?}");
    }

    #[test]
    fn a_hot_texel_makes_no_fireflies() {
        let map = SkyMap::new(picture(), turned());
        let mut random = Random::new(8);
        let mut estimates = Vec::new();
        for _ in 0..20_000 {
            let Some((direction, color, pdf)) = map.sample(random.pair()) else { continue };
            let (seen, density) = map.seen(direction);
            assert!((density / pdf - 1.0).abs() < 1e-6);
            assert!((0..3).all(|c| (color[c] - seen[c]).abs() <= 1e-4 * (1.0 + color[c])), "{color:?} {seen:?}");
            estimates.push(f64::from(color.iter().sum::<f32>()) / pdf);
        }
        let mean = estimates.iter().sum::<f64>() / estimates.len() as f64;
        let greatest = estimates.iter().fold(0.0, |a: f64, b| a.max(*b));
        // At the poles, where the sine of the polar angle grows threefold from row to row, the density lags behind a little.
        assert!(greatest < 1.6 * mean, "{greatest} of {mean}");
    }

    #[test]
    fn a_turned_map_looks_as_the_map_does_in_the_turned_direction() {
        let (straight, bent) = (SkyMap::new(picture(), DMat3::IDENTITY), SkyMap::new(picture(), turned()));
        let mut random = Random::new(2);
        for _ in 0..1000 {
            let d = kirkas_geometry::warp::square_to_uniform_sphere(random.pair()).as_dvec3();
            let (a, b) = (straight.color(d), bent.color(turned() * d));
            assert!((0..3).all(|c| (a[c] - b[c]).abs() <= 1e-3 * a[c].max(1.0)));
            let (p, q) = (straight.seen(d).1, bent.seen(turned() * d).1);
            assert!((p - q).abs() <= 1e-6 * p.max(1e-3), "{p} {q}");
        }
    }

    #[test]
    fn the_middle_is_plus_z_and_the_top_is_up() {
        let mut texels = vec![[0.0; 3]; 8 * 4];
        texels[..8].fill([0.0, 0.0, 1.0]);
        texels[8 + 3] = [1.0, 0.0, 0.0];
        texels[8 + 4] = [1.0, 0.0, 0.0];
        texels[8 + 6] = [0.0, 1.0, 0.0];
        let map = SkyMap::new(Picture { width: 8, height: 4, texels }, DMat3::IDENTITY);
        assert_eq!(map.color(DVec3::Y), [0.0, 0.0, 1.0]);
        let tilted = |x: f64, z: f64| map.color(DVec3::new(x, 0.414_213_562_373, z));
        assert!((tilted(0.0, 1.0)[0] - 1.0).abs() < 1e-6);
        // The middle of texel 6 is at 292.5 degrees from -z by way of +x.
        let angle = 292.5_f64.to_radians();
        assert!((tilted(sin(angle), -cos(angle))[1] - 1.0).abs() < 1e-6 && sin(angle) < 0.0);
    }
}
