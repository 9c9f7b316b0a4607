//! One colour everywhere, or radiance by elevation.
//!
//! Sampled exactly in proportion to what is sent (all lanes together): that is linear in the sine of the elevation between
//! stops, and so is the density.

use core::f64::consts::TAU;
use kirkas_geometry::elementary::sin_cos;
use kirkas_geometry::{DVec3, Vec3};
use kirkas_optics::{Lanes, Light, Palette, Spectrum};
use kirkas_scene::params::read_color;
use kirkas_scene::{Fallback, Kind, Node, ParamSpec, ParamType, Params, TypeSpec};

/// One colour everywhere.
pub const CONSTANT: TypeSpec = TypeSpec {
    kind: Kind::Background,
    name: "constant",
    doc: "The same radiance in all directions.",
    params: &[ParamSpec::color("color", [0.0, 0.0, 0.0], "Radiance.")],
};

/// By elevation.
pub const GRADIENT: TypeSpec = TypeSpec {
    kind: Kind::Background,
    name: "gradient",
    doc: "Radiance by elevation, as a simple sky.",
    params: &[
        ParamSpec::new(
            "stops",
            ParamType::Gradient,
            Fallback::Required,
            "[[s, colour], ...] with s the sine of the elevation, rising from -1 (down) to 1 (up).",
        ),
        ParamSpec::vector("up", [0.0, 1.0, 0.0], "Which way is up."),
    ],
};

/// The background.
#[derive(Clone, Debug)]
pub struct GradientBackground {
    up: Vec3,
    /// By sine of elevation, rising; one stop stands for all directions.
    stops: Vec<(f32, Spectrum)>,
    /// Where it shines: pieces in which it is linear, from sine -1 to 1.
    pieces: Vec<Piece>,
}

/// From sine `s0` to `s1` the brightness (all lanes together) goes from `w0` to `w1`.
#[derive(Clone, Copy, Debug)]
struct Piece {
    s0: f64,
    s1: f64,
    w0: f64,
    w1: f64,
    /// Integral over the sine of this piece and those before it.
    sum: f64,
}

impl GradientBackground {
    /// From its parameters.
    pub fn new(p: &Params, palette: &Palette) -> Self {
        let light = |c: [f64; 3]| palette.illuminant(c.map(|x| x as f32));
        if p.spec().name == "constant" {
            return GradientBackground::of(Vec3::Y, vec![(0.0, palette.shine(&palette.light(p, "color"), 1.0))]);
        }
        let stop = |n: &Node| {
            let l = n.list()?;
            Some((l.first()?.number()? as f32, light(read_color(&l.get(1)?.value)?)))
        };
        let stops =
            p.entity.params.get("stops").and_then(|n| n.list()).unwrap_or(&[]).iter().filter_map(stop).collect();
        let up = p.vector("up");
        let up = Vec3::new(up[0] as f32, up[1] as f32, up[2] as f32).normalize_or(Vec3::Y);
        GradientBackground::of(up, stops)
    }

    fn of(up: Vec3, stops: Vec<(f32, Spectrum)>) -> Self {
        // Outside the stops the first and the last go on.
        let known = |s: &&(f32, Spectrum)| s.0 > -1.0 && s.0 < 1.0;
        let mut knots: Vec<(f64, f64)> = stops.iter().filter(known).map(|s| (f64::from(s.0), s.1.sum())).collect();
        let mut background = GradientBackground { up, stops, pieces: Vec::new() };
        knots.insert(0, (-1.0, background.at(&Lanes::RGB, -1.0).sum()));
        knots.push((1.0, background.at(&Lanes::RGB, 1.0_f32.next_down()).sum()));
        let mut sum = 0.0;
        for k in knots.windows(2) {
            let ((s0, w0), (s1, w1)) = (k[0], k[1]);
            sum += 0.5 * (w0 + w1) * (s1 - s0);
            background.pieces.push(Piece { s0, s1, w0, w1, sum });
        }
        background
    }

    /// True when it sends nothing from anywhere.
    pub fn is_black(&self) -> bool {
        self.stops.iter().all(|s| s.1.is_black())
    }

    /// A direction from which light comes, with its density per solid angle. `u` in the unit square.
    pub fn sample(&self, u: (f32, f32)) -> Option<(DVec3, f64)> {
        // Find the piece, and the place in it where the integral of its linear density is reached.
        let target = f64::from(u.0) * self.total();
        let i = self.pieces.partition_point(|p| p.sum <= target).min(self.pieces.len() - 1);
        let p = self.pieces[i];
        let before = i.checked_sub(1).map_or(0.0, |i| self.pieces[i].sum);
        let rest = ((target - before) / (p.sum - before)).clamp(0.0, 1.0);
        let root = (p.w0 * p.w0 + rest * (p.w1 * p.w1 - p.w0 * p.w0)).max(0.0).sqrt();
        let share = rest * (p.w0 + p.w1) / (p.w0 + root);
        let sine = p.s0 + (p.s1 - p.s0) * share.clamp(0.0, 1.0);

        // Turn around the axis.
        let up = self.up.as_dvec3().normalize();
        let (x, y) = up.any_orthonormal_pair();
        let r = (1.0 - sine * sine).max(0.0).sqrt();
        let (s, c) = sin_cos(TAU * f64::from(u.1));
        let direction = (up * sine + x * (r * c) + y * (r * s)).normalize();
        let pdf = self.pdf(direction);
        (pdf > 0.0).then_some((direction, pdf))
    }

    /// Density per solid angle with which [`GradientBackground::sample`] gives `direction` (unit).
    pub fn pdf(&self, direction: DVec3) -> f64 {
        let brightness = self.radiance(&Lanes::RGB, direction.as_vec3()).sum();
        if brightness > 0.0 { brightness / self.total_radiance() } else { 0.0 }
    }

    /// The integral of radiance over all directions, all lanes together, W/m2.
    pub fn total_radiance(&self) -> f64 {
        TAU * self.total()
    }

    fn total(&self) -> f64 {
        self.pieces.last().map_or(0.0, |p| p.sum)
    }

    /// Radiance from `direction` (any length).
    pub fn radiance(&self, lanes: &Lanes, direction: Vec3) -> Light {
        match self.stops.as_slice() {
            [only] => only.1.at(lanes),
            _ => self.at(lanes, direction.normalize_or_zero().dot(self.up)),
        }
    }

    /// Radiance at a sine of elevation.
    fn at(&self, lanes: &Lanes, s: f32) -> Light {
        let next = self.stops.partition_point(|x| x.0 <= s);
        match (next.checked_sub(1).and_then(|i| self.stops.get(i)), self.stops.get(next)) {
            (Some(a), Some(b)) => {
                let w = (s - a.0) / (b.0 - a.0);
                a.1.at(lanes) * (1.0 - w) + b.1.at(lanes) * w
            }
            (Some(only), None) | (None, Some(only)) => only.1.at(lanes),
            (None, None) => Light::BLACK,
        }
    }
}
