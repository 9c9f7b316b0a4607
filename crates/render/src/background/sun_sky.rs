//! # sun_sky: the sun and a clear sky
//!
//! Daylight by the sun's place and the haze in the air: the sky of Hosek & Wilkie 2012, the disc of the sun, and below the
//! horizon an endless grey ground that both of them light. Sun and sky are sampled each for itself.
//!
//! ## Parameters
//!
//! - `sun_direction` (default `[0.4, 0.6, 0.7]`): from the scene towards the sun; or `latitude`, `longitude` (degrees, north and
//!   east positive), `date` (`"YYYY-MM-DD"`) and `time` (hours, universal time), which then say where it stands.
//! - `turbidity` (1 to 10, default 3): haze: 2 very clear, 3 clear, 6 hazy, 10 very hazy.
//! - `ground_albedo` (default 0.2): what the ground reflects; it brightens the sky as well.
//! - `sun`, `sky` (default 1): scale the two; 0 leaves one out.
//! - `sun_radius` (degrees, default 0.2666): of the disc; its light stays the same, shadows become softer.
//! - `up`, `north` (default `[0, 1, 0]`, `[0, 0, -1]`): the compass; east is then `[1, 0, 0]`.
//!
//! Radiance is in W/(m2 sr), where 1 is 683 cd/m2: a sunlit white wall has about 40. Set `exposure = -5` or so in `[film]`.
//!
//! ## Example
//!
//! ```toml
//! [background]
//! type = "sun_sky"
//! turbidity = 2.5
//! latitude = 60.17
//! longitude = 24.94
//! date = "2026-06-21"
//! time = 17.5
//! ```
//!
//! ## Limits
//!
//! No clouds, moon or stars. The sky is fitted for a sun above the horizon: below it, the sky of sunset fades by a rule of
//! thumb (a factor of 150 within 6 degrees, as twilight does), without the colours of twilight. The sun's colour comes from
//! another model than the sky's (Preetham, Shirley & Smits 1999), and the ground of `albedo` does not take shadows. Observers
//! stand at sea level. Refraction near the horizon (half a degree) is left out.
//!
//! ## References
//!
//! Hosek & Wilkie 2012, "An Analytic Model for Full Spectral Sky-Dome Radiance"; Preetham, Shirley & Smits 1999, "A Practical
//! Analytic Model for Daylight"; Michalsky 1988 for the place of the sun.

use super::hosek_wilkie::HosekWilkie;
use super::image::SkyMap;
use super::sun::{self, When};
use crate::textures::Picture;
use core::f64::consts::{FRAC_1_PI, FRAC_PI_2, PI};
use kirkas_geometry::elementary::{asin, cos, exp, sin};
use kirkas_geometry::{DMat3, DVec3};
use kirkas_scene::spec::{NOT_NEGATIVE, UNIT};
use kirkas_scene::{Diagnostic, Fallback, Kind, ParamSpec, ParamType, Params, TypeSpec};
use std::sync::Arc;

/// The table.
pub const SPEC: TypeSpec = TypeSpec {
    kind: Kind::Background,
    name: "sun_sky",
    doc: "The sun and a clear sky, by the sun's place and the haze in the air.",
    params: &[
        ParamSpec::vector("sun_direction", [0.4, 0.6, 0.7], "From the scene towards the sun."),
        place("latitude", "North positive; with it, place, date and time say where the sun stands.")
            .range((-90.0, 90.0)),
        place("longitude", "East positive; absent = 0.").range((-180.0, 180.0)),
        ParamSpec::new("date", ParamType::Text, Fallback::Text("2000-06-21"), "YYYY-MM-DD."),
        ParamSpec::number("time", 12.0, "Universal time.").unit("hours").range((0.0, 24.0)),
        ParamSpec::number("turbidity", 3.0, "Haze: 2 very clear, 3 clear, 6 hazy, 10 very hazy.").range((1.0, 10.0)),
        ParamSpec::color("ground_albedo", [0.2, 0.2, 0.2], "What the ground reflects.").range(UNIT),
        ParamSpec::number("sun", 1.0, "Scales the sun.").range(NOT_NEGATIVE),
        ParamSpec::number("sky", 1.0, "Scales the sky.").range(NOT_NEGATIVE),
        ParamSpec::number("sun_radius", sun::RADIUS, "Of the disc; its light stays the same.")
            .unit("degrees")
            .range((0.01, 30.0)),
        ParamSpec::vector("up", [0.0, 1.0, 0.0], "Which way is up."),
        ParamSpec::vector("north", [0.0, 0.0, -1.0], "Which way is north, about."),
    ],
};

const fn place(name: &'static str, doc: &'static str) -> ParamSpec {
    ParamSpec::new(name, ParamType::Number, Fallback::Absent, doc).unit("degrees")
}

/// Rows of the table from which the sky is sampled; even, so that the horizon lies between two.
const ROWS: usize = 128;

/// The background.
#[derive(Clone, Debug)]
pub struct SunSky {
    /// Unit.
    up: DVec3,
    sun: Disc,
    sky: HosekWilkie,
    sky_scale: f64,
    /// Radiance of the ground.
    ground: [f64; 3],
    /// What sky and ground are sampled from; only its density counts.
    map: Arc<SkyMap>,
    /// How often the sun is sampled.
    sun_share: f64,
    /// Integral of radiance over all directions, red, green and blue together, W/m2.
    total: f64,
}

/// The sun in the sky.
#[derive(Clone, Debug)]
struct Disc {
    /// Unit, towards it.
    center: DVec3,
    /// Angular radius, radians.
    radius: f64,
    /// Mean radiance, W/(m2 sr).
    radiance: [f64; 3],
}

impl SunSky {
    /// From its parameters.
    pub fn new(p: &Params) -> Result<Self, Diagnostic> {
        let world_from_compass = compass(p);
        let up = world_from_compass.y_axis;
        let center = world_from_compass * towards_sun(p, &world_from_compass)?;
        let elevation = asin(center.dot(up).clamp(-1.0, 1.0));
        let (turbidity, albedo) = (p.number("turbidity"), p.color("ground_albedo"));
        let radius = p.number("sun_radius").to_radians();
        let solid_angle = 2.0 * PI * one_minus_cos(radius);
        let irradiance = sun::irradiance(turbidity, elevation).map(|e| e * p.number("sun"));
        let sun = Disc { center, radius, radiance: irradiance.map(|e| e / solid_angle) };
        let mut s = SunSky {
            up,
            sun,
            sky: HosekWilkie::new(turbidity, albedo, elevation),
            sky_scale: p.number("sky") * twilight(elevation),
            ground: [0.0; 3],
            map: Arc::new(SkyMap::new(Picture { width: 0, height: 0, texels: Vec::new() }, world_from_compass)),
            sun_share: 0.0,
            total: 0.0,
        };
        s.light_the_ground(irradiance.map(|e| e * center.dot(up).max(0.0)), albedo);
        s.tabulate(world_from_compass, irradiance);
        Ok(s)
    }

    /// Ground of this albedo under the sun's irradiance and the sky.
    fn light_the_ground(&mut self, mut irradiance: [f64; 3], albedo: [f64; 3]) {
        const N: usize = 64;
        let step = FRAC_PI_2 / N as f64;
        let side = self.up.any_orthonormal_vector();
        let other = self.up.cross(side);
        for k in 0..N * 4 * N {
            let (theta, phi) = (((k % N) as f64 + 0.5) * step, ((k / N) as f64 + 0.5) * step);
            let d = self.up * cos(theta) + (side * cos(phi) + other * sin(phi)) * sin(theta);
            let sky = self.without_sun(d);
            (0..3).for_each(|c| irradiance[c] += sky[c] * cos(theta) * sin(theta) * step * step);
        }
        self.ground = std::array::from_fn(|c| irradiance[c] * albedo[c].clamp(0.0, 1.0) * FRAC_1_PI);
    }

    /// Fill in the table and the share of samples that go to the sun.
    fn tabulate(&mut self, world_from_compass: DMat3, irradiance: [f64; 3]) {
        let (rows, columns) = (ROWS, 2 * ROWS);
        let mut total = 0.0;
        let mut texel = |i: usize| {
            let theta = PI * ((i / columns) as f64 + 0.5) / rows as f64;
            let phi = PI * ((i % columns) as f64 + 0.5) / rows as f64;
            let d = DVec3::new(sin(theta) * sin(phi), cos(theta), -sin(theta) * cos(phi));
            let color = self.without_sun(world_from_compass * d);
            total += color.iter().sum::<f64>() * sin(theta) * (PI / rows as f64) * (PI / rows as f64);
            color.map(|c| c as f32)
        };
        let texels = (0..rows * columns).map(&mut texel).collect();
        self.map = Arc::new(SkyMap::new(Picture { width: columns, height: rows, texels }, world_from_compass));
        let sun: f64 = irradiance.iter().sum();
        self.total = sun + total;
        self.sun_share = match (sun > 0.0, total > 0.0) {
            (true, true) => (sun / (sun + total)).clamp(0.1, 0.9),
            (has_sun, _) => f64::from(u8::from(has_sun)),
        };
    }

    /// True when it sends nothing from anywhere.
    pub fn is_black(&self) -> bool {
        self.sun_share == 0.0 && self.map.is_black()
    }

    /// The integral of radiance over all directions, red, green and blue together, W/m2.
    pub fn total_radiance(&self) -> f64 {
        self.total
    }

    /// Linear Rec.709 radiance from a direction (unit), W/(m2 sr).
    pub fn radiance(&self, direction: DVec3) -> [f32; 3] {
        let mut light = self.without_sun(direction);
        if let Some(r) = self.sun.place(direction).filter(|_| direction.dot(self.up) > 0.0) {
            let share = sun::limb_darkening(r);
            (0..3).for_each(|c| light[c] += self.sun.radiance[c] * share);
        }
        light.map(|c| c as f32)
    }

    fn without_sun(&self, direction: DVec3) -> [f64; 3] {
        let cos_theta = direction.dot(self.up);
        if cos_theta <= 0.0 {
            return self.ground;
        }
        let (gamma, cos_gamma) = sun::angle_between(direction, self.sun.center);
        self.sky.radiance(cos_theta, gamma, cos_gamma).map(|c| c * self.sky_scale)
    }

    /// A direction from which light comes, with its density per solid angle.
    pub fn sample(&self, u: (f32, f32)) -> Option<(DVec3, f64)> {
        let first = f64::from(u.0);
        let direction = if first < self.sun_share {
            self.sun.sample((first / self.sun_share, f64::from(u.1)))
        } else {
            let rest = ((first - self.sun_share) / (1.0 - self.sun_share)) as f32;
            self.map.sample((rest.min(1.0_f32.next_down()), u.1))?.0
        };
        let pdf = self.pdf(direction);
        (pdf > 0.0).then_some((direction, pdf))
    }

    /// The density of [`SunSky::sample`], per solid angle.
    pub fn pdf(&self, direction: DVec3) -> f64 {
        let sun = if self.sun.place(direction).is_some() { 1.0 / self.sun.solid_angle() } else { 0.0 };
        let sky = if self.sun_share < 1.0 { self.map.pdf(direction) } else { 0.0 };
        self.sun_share * sun + (1.0 - self.sun_share) * sky
    }
}

impl Disc {
    /// How far from the centre, as a share of the radius; `None` beside the disc.
    fn place(&self, direction: DVec3) -> Option<f64> {
        let r = sun::angle_between(direction, self.center).0 / self.radius;
        (r <= 1.0).then_some(r)
    }

    fn solid_angle(&self) -> f64 {
        2.0 * PI * one_minus_cos(self.radius)
    }

    /// Uniform by solid angle.
    fn sample(&self, u: (f64, f64)) -> DVec3 {
        let h = one_minus_cos(self.radius) * u.0;
        let r = (h * (2.0 - h)).max(0.0).sqrt();
        let (x, y) = self.center.any_orthonormal_pair();
        let phi = 2.0 * PI * u.1;
        (self.center * (1.0 - h) + x * (r * cos(phi)) + y * (r * sin(phi))).normalize()
    }
}

/// `1 - cos(angle)`, exact for small angles.
fn one_minus_cos(angle: f64) -> f64 {
    let s = sin(0.5 * angle);
    2.0 * s * s
}

/// East, up and south in the world.
fn compass(p: &Params) -> DMat3 {
    let up = DVec3::from_array(p.vector("up")).normalize_or(DVec3::Y);
    let south = -DVec3::from_array(p.vector("north"));
    let south = (south - up * up.dot(south)).try_normalize().unwrap_or_else(|| up.any_orthonormal_vector());
    DMat3::from_cols(up.cross(south), up, south)
}

/// Unit, in east, up and south.
fn towards_sun(p: &Params, world_from_compass: &DMat3) -> Result<DVec3, Diagnostic> {
    let Some(latitude) = p.optional_number("latitude") else {
        let written = DVec3::from_array(p.vector("sun_direction")).normalize_or(DVec3::Y);
        return Ok(world_from_compass.transpose() * written);
    };
    let text = p.text("date").unwrap_or_default();
    let date = sun::read_date(text).ok_or_else(|| {
        Diagnostic::error("bad-date", format!("`{text}` is no date"))
            .at(p.span("date"), "here")
            .help("write year, month and day: `date = \"2026-06-21\"`")
    })?;
    let longitude = p.optional_number("longitude").unwrap_or(0.0);
    let (elevation, azimuth) = sun::position(&When { latitude, longitude, date, time: p.number("time") });
    Ok(DVec3::new(cos(elevation) * sin(azimuth), sin(elevation), -cos(elevation) * cos(azimuth)))
}

/// How the sky fades while the sun sinks: by 150 within 6 degrees.
fn twilight(elevation: f64) -> f64 {
    exp(0.835 * elevation.to_degrees().min(0.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalog::catalog;
    use kirkas_geometry::Vec3;
    use kirkas_scene::{Entity, Map, Value};
    use kirkas_testkit::{ChiSquare, Random};

    fn sky(rows: &[(&str, Value)]) -> Result<SunSky, Diagnostic> {
        let mut map = Map::default();
        for (name, value) in rows {
            map = map.with(name, value.clone());
        }
        let entity = Entity::new("", "sun_sky", map);
        SunSky::new(&Params::new(&entity, Kind::Background, &catalog()).unwrap())
    }

    /// A wide sun, so that the grid of the test resolves it.
    fn wide() -> SunSky {
        let up = [0.3, 0.2, -1.0];
        sky(&[("sun_radius", 12.0.into()), ("sun_direction", [0.5, 0.7, -0.4].into()), ("up", up.into())]).unwrap()
    }

    #[test]
    fn directions_follow_their_density() {
        let s = wide();
        let test = ChiSquare { rows: 64, columns: 128, samples: 200_000, seed: 3 };
        let result =
            test.run(|_, u| s.sample(u).map(|x| x.0.as_vec3()), |w: Vec3| s.pdf(w.as_dvec3().normalize()) as f32);
        // The sun's edge is a break of the density, so the quadrature leaves a little.
        assert!((result.total - 1.0).abs() < 2e-3 && result.p_value > 1e-3, "{result:?}");
    }

    #[test]
    fn no_sample_counts_for_much_more_than_the_others() {
        let s = sky(&[]).unwrap();
        let mut random = Random::new(4);
        let estimates: Vec<f64> = (0..20_000)
            .filter_map(|_| s.sample(random.pair()))
            .map(|(d, pdf)| f64::from(s.radiance(d).iter().sum::<f32>()) / pdf)
            .collect();
        let mean = estimates.iter().sum::<f64>() / estimates.len() as f64;
        let greatest = estimates.iter().fold(0.0, |a: f64, b| a.max(*b));
        assert!(greatest < 2.5 * mean, "{greatest} of {mean}");
    }

    #[test]
    fn a_larger_sun_sends_the_same_light() {
        let light = |degrees: f64| {
            let s = sky(&[("sun_radius", degrees.into()), ("sky", 0.0.into()), ("ground_albedo", 0.0.into())]).unwrap();
            let mut random = Random::new(6);
            let n = 20_000;
            (0..n)
                .filter_map(|_| s.sample(random.pair()))
                .map(|(d, pdf)| f64::from(s.radiance(d)[1]) / pdf)
                .sum::<f64>()
                / f64::from(n)
        };
        let (small, large) = (light(0.2666), light(3.0));
        let truth = sun::irradiance(3.0, asin(0.6 / (0.16_f64 + 0.36 + 0.49).sqrt()))[1];
        assert!((small / truth - 1.0).abs() < 0.01 && (large / truth - 1.0).abs() < 0.01, "{small} {large} {truth}");
    }

    #[test]
    fn the_compass_turns_sun_and_sky_together() {
        let towards = [0.2, 0.5, 0.8];
        let a = sky(&[("sun_direction", towards.into())]).unwrap();
        let b = sky(&[("sun_direction", [0.2, -0.8, 0.5].into()), ("up", [0.0, 0.0, 1.0].into())]).unwrap();
        for d in [DVec3::new(0.1, 0.3, 0.9), DVec3::new(-0.4, 0.2, -0.1), DVec3::new(0.3, -0.2, 0.3)] {
            let d = d.normalize();
            let turned = DVec3::new(d.x, -d.z, d.y);
            let (p, q) = (a.radiance(d), b.radiance(turned));
            assert!((0..3).all(|c| (p[c] - q[c]).abs() <= 1e-5 * p[c]), "{p:?} {q:?}");
        }
    }

    #[test]
    fn place_and_date_put_the_sun_where_it_belongs() {
        // Noon in June at the equator: the sun stands 66.6 degrees high in the north, which is -z.
        let s = sky(&[("latitude", 0.0.into()), ("date", "2000-06-21".into()), ("time", 12.03.into())]).unwrap();
        assert!((s.sun.center.y - sin(66.56_f64.to_radians())).abs() < 1e-3, "{:?}", s.sun.center);
        assert!(s.sun.center.z < -0.39 && s.sun.center.x.abs() < 1e-2);
        let error = sky(&[("latitude", 0.0.into()), ("date", "21.6.2000".into())]).unwrap_err();
        assert!(error.message.contains("21.6.2000"));
    }

    #[test]
    fn night_is_dark_and_the_ground_is_lit_by_day() {
        let night = sky(&[("sun_direction", [0.0, -1.0, 0.0].into())]).unwrap();
        assert!(night.radiance(DVec3::Y)[1] < 1e-6);
        let day = sky(&[("sun_direction", [0.0, 1.0, 0.0].into()), ("ground_albedo", 1.0.into())]).unwrap();
        // About 130 klux on white ground, over pi and 683.
        let ground = day.radiance(DVec3::NEG_Y)[1];
        assert!((45.0..75.0).contains(&ground), "{ground}");
        assert!(sky(&[("sun", 0.0.into()), ("sky", 0.0.into())]).unwrap().is_black());
    }
}
