//! Shining surfaces as lights: any shape with an `emitter` material. Sampled by solid angle where the shape knows how
//! (spheres), else by area.

use super::emit::EmittedRay;
use super::tree::LightBounds;
use super::{Cone, LightSample, Target};
use crate::materials::{Emission, Material};
use crate::shapes::{AreaSample, Detail, Surface};
use crate::textures::{Patch, TexturePoint, Textures};
use kirkas_geometry::low_discrepancy::owen_sobol_2d;
use kirkas_geometry::rounding::{gamma, offset_origin};
use kirkas_geometry::transform::transform_normal;
use kirkas_geometry::warp::square_to_cosine_hemisphere;
use kirkas_geometry::{AnimatedTransform, Bounds3, DAffine3, DVec3, Frame};
use kirkas_optics::Lanes;
use std::f64::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

/// One shining part.
#[derive(Clone)]
pub struct AreaLight {
    /// Its shape.
    pub surface: Arc<dyn Surface>,
    /// Where it stands, if it is not in the world itself.
    pub placement: Option<AnimatedTransform>,
    /// Index into `Scene::materials`.
    pub material: u32,
    /// Total area as placed, scene units squared.
    pub area: f64,
}

/// By which factor a map that keeps shapes (a similarity) grows areas; for others, the same from their volume growth.
pub fn area_growth(m: &DAffine3) -> f64 {
    let s = kirkas_geometry::elementary::cbrt(m.matrix3.determinant().abs());
    s * s
}

impl AreaLight {
    /// A point of the surface as seen from `from`.
    pub fn sample(
        &self,
        lanes: &Lanes,
        materials: &[Material],
        textures: &Textures,
        from: DVec3,
        time: f64,
        u: (f32, f32),
    ) -> Option<LightSample> {
        let detail = materials[self.material as usize].detail;
        let seen = |s: &AreaSample, pdf| self.seen(s, pdf, lanes, (materials, textures), from);
        let Some(placement) = &self.placement else {
            return match self.surface.sample_toward(from, u, detail) {
                Some((s, pdf)) => seen(&s, Some(pdf)),
                None => seen(&self.surface.sample_area(u, detail)?, None),
            };
        };
        let m = placement.at(time);
        match self.surface.sample_toward(m.inverse().transform_point3(from), u, detail) {
            // Solid angles survive turning and even scaling only.
            Some((s, pdf)) if is_similarity(&m) => seen(&placed(s, &m), Some(pdf)),
            _ => seen(&placed(self.surface.sample_area(u, detail)?, &m), None),
        }
    }

    /// The light of a point of the surface, chosen in part space by area alone.
    pub fn sample_at(
        &self,
        s: AreaSample,
        lanes: &Lanes,
        things: (&[Material], &Textures),
        from: DVec3,
        time: f64,
    ) -> Option<LightSample> {
        let s = self.placement.as_ref().map_or(s, |p| placed(s, &p.at(time)));
        self.seen(&s, None, lanes, things, from)
    }

    /// What a chosen point, in the world, sends towards `from`; without a density per solid angle that of its area counts.
    fn seen(
        &self,
        s: &AreaSample,
        per_solid_angle: Option<f64>,
        lanes: &Lanes,
        (materials, textures): (&[Material], &Textures),
        from: DVec3,
    ) -> Option<LightSample> {
        let emission = materials[self.material as usize].emission.as_ref()?;
        let to_light = s.position - from;
        let r2 = to_light.length_squared();
        if !(r2 > 0.0) {
            return None;
        }
        let direction = to_light / r2.sqrt();
        let facing = -direction.dot(s.normal);
        let cosine = if emission.two_sided { facing.abs() } else { facing };
        if cosine <= 0.0 {
            return None;
        }
        let pdf = per_solid_angle.unwrap_or(s.pdf_area * r2 / cosine);
        let material = &materials[self.material as usize];
        let at = self.texture_point(textures, s, s.position, s.normal);
        // The shadow ray ends short of the lamp, so the lamp's own opacity counts here.
        let opacity = if material.is_opaque() { 1.0 } else { material.alpha(textures, &at) };
        let radiance = emission.radiance(lanes, textures, &at, || self.per_power()) * opacity;
        let target = Target {
            position: s.position,
            error: s.position.abs() * f64::from(gamma(4)) + from.abs() * f64::from(gamma(2)),
            normal: s.normal,
        };
        (pdf > 0.0 && pdf.is_finite()).then(|| LightSample {
            direction,
            target: Some(target),
            light: radiance * (1.0 / pdf) as f32,
            pdf: pdf as f32,
        })
    }

    /// A ray that leaves it, evenly by area and by the cosine. `u` chooses where it starts, `v` where it goes.
    pub fn emit(
        &self,
        lanes: &Lanes,
        materials: &[Material],
        textures: &Textures,
        time: f64,
        (u, v): ((f32, f32), (f32, f32)),
    ) -> Option<EmittedRay> {
        let material = &materials[self.material as usize];
        let emission = material.emission.as_ref()?;
        let mut s = self.surface.sample_area(u, material.detail)?;
        if let Some(m) = self.placement.as_ref().map(|p| p.at(time)) {
            s = placed(s, &m);
        }
        // One half of the square for each side that shines.
        let (side, x) = match (emission.two_sided, v.0 < 0.5) {
            (false, _) => (1.0, v.0),
            (true, true) => (1.0, 2.0 * v.0),
            (true, false) => (-1.0, 2.0 * v.0 - 1.0),
        };
        let normal = s.normal * side;
        let local = square_to_cosine_hemisphere((x, v.1));
        let direction = Frame::from_z(normal.as_vec3()).to_world(local).as_dvec3().normalize();
        let at = self.texture_point(textures, &s, s.position, s.normal);
        let opacity = if material.is_opaque() { 1.0 } else { material.alpha(textures, &at) };
        let sides = if emission.two_sided { 2.0 } else { 1.0 };
        let power =
            emission.radiance(lanes, textures, &at, || self.per_power()) * (opacity * (PI * sides / s.pdf_area) as f32);
        let error = s.position.abs() * f64::from(gamma(4));
        let origin = offset_origin(s.position, error, s.normal, direction);
        (direction.dot(normal) > 0.0 && power.is_finite()).then(|| EmittedRay::new(origin, direction, time, power))
    }

    /// The density per solid angle with which [`AreaLight::sample`] finds, from `from`, the point at `position` with the unit
    /// outward `normal`.
    pub fn pdf(&self, from: DVec3, position: DVec3, normal: DVec3, time: f64) -> f32 {
        let facing = (from - position).dot(normal);
        let map = self.placement.as_ref().map(|p| p.at(time));
        let local = map.map_or(from, |m| m.inverse().transform_point3(from));
        if let Some(pdf) = self.surface.pdf_toward(local).filter(|_| map.as_ref().is_none_or(is_similarity)) {
            return if facing > 0.0 { pdf as f32 } else { 0.0 };
        }
        self.surface.area().map_or(0.0, |area| self.pdf_by_area(area, from, position, normal, time))
    }

    /// The same where a point is chosen evenly from `area` of part space.
    pub fn pdf_by_area(&self, area: f64, from: DVec3, position: DVec3, normal: DVec3, time: f64) -> f32 {
        let to_light = position - from;
        let r2 = to_light.length_squared();
        let cosine = to_light.dot(normal).abs() / r2.sqrt();
        if cosine.is_nan() || cosine <= 0.0 {
            return 0.0;
        }
        let growth = self.placement.as_ref().map_or(1.0, |p| {
            let m = p.at(time);
            area_element_growth(&m, &m.inverse(), m.matrix3.transpose() * normal)
        });
        (r2 / (area * growth * cosine)) as f32
    }

    /// Where it is at any time, and the ways it faces.
    pub fn reach(&self, power: f64, is_two_sided: bool) -> LightBounds {
        self.reach_of(self.surface.bounds(), self.surface.normals(), power, is_two_sided)
    }

    /// The same of a part with these bounds and normals, in part space.
    pub fn reach_of(&self, bounds: Bounds3, normals: Cone, power: f64, is_two_sided: bool) -> LightBounds {
        let (bounds, normals) = match &self.placement {
            None => (bounds, normals),
            Some(p) if p.is_moving() => {
                let (first, last) = p.key_times().fold((0.0_f64, 0.0_f64), |(a, b), t| (a.min(t), b.max(t)));
                (p.swept_bounds(&bounds, first, last), Cone::ALL)
            }
            Some(p) => {
                let m = p.at(0.0);
                // Only turns keep the angles of a cone; a single normal stays one under any map.
                let keeps = normals.angle == 0.0 || is_similarity(&m);
                let axis = transform_normal(&m.inverse(), normals.axis).normalize();
                (bounds.transformed(&m), if keeps { Cone { axis, ..normals } } else { Cone::ALL })
            }
        };
        let normals = if is_two_sided { Cone::ALL } else { normals };
        LightBounds { bounds, normals, spread: FRAC_PI_2, power }
    }

    /// For emission given as power: 1 / (pi area).
    pub fn per_power(&self) -> f64 {
        1.0 / (PI * self.area)
    }

    /// Its power, all lanes together, W; estimated where a texture glows.
    pub fn power(&self, materials: &[Material], textures: &Textures) -> f64 {
        let Some(emission) = &materials[self.material as usize].emission else { return 0.0 };
        let sides = if emission.two_sided { 2.0 } else { 1.0 };
        let count = if emission.is_textured() { TEXTURE_PROBES } else { 1 };
        let radiance =
            |i| Some(self.glow(emission, textures, &self.surface.sample_area(owen_sobol_2d(i, 0), Detail::Texture)?));
        let mean = (0..count).filter_map(radiance).sum::<f64>() / f64::from(count);
        PI * self.area * sides * mean
    }

    /// True when it may glow differently from place to place.
    pub fn is_textured(&self, materials: &[Material]) -> bool {
        materials[self.material as usize].emission.as_ref().is_some_and(Emission::is_textured)
    }

    /// About the mean radiance of a facet, all lanes together.
    pub fn glow_of_facet(&self, facet: u32, materials: &[Material], textures: &Textures) -> f64 {
        const PROBES: u32 = 4;
        let Some(emission) = &materials[self.material as usize].emission else { return 0.0 };
        let samples =
            (0..PROBES).filter_map(|i| self.surface.sample_facet(facet, owen_sobol_2d(i, 0), Detail::Texture));
        samples.map(|s| self.glow(emission, textures, &s)).sum::<f64>() / f64::from(PROBES)
    }

    /// Where textures look at a sample that stands there in the world.
    fn texture_point(
        &self,
        textures: &Textures,
        s: &AreaSample,
        world_position: DVec3,
        world_normal: DVec3,
    ) -> TexturePoint {
        let patch = match textures.looks_around() {
            false => Patch::POINT,
            true => Patch {
                object_normal: (self.surface.object_from_part().inverse().transpose() * s.part_normal).as_vec3(),
                world_normal: world_normal.as_vec3(),
                color: s.color,
                ..Patch::POINT
            },
        };
        TexturePoint { uv: s.uv, object_position: s.object_position, world_position, patch }
    }

    /// Radiance at a point of part space, all lanes together.
    fn glow(&self, emission: &Emission, textures: &Textures, s: &AreaSample) -> f64 {
        let position = self.placement.as_ref().map_or(s.position, |p| p.at(0.0).transform_point3(s.position));
        let at = self.texture_point(textures, s, position, s.normal);
        emission.radiance(&Lanes::RGB, textures, &at, || self.per_power()).sum()
    }
}

/// A point of a surface that `m` puts elsewhere.
fn placed(s: AreaSample, m: &DAffine3) -> AreaSample {
    let inverse = m.inverse();
    AreaSample {
        pdf_area: s.pdf_area / area_element_growth(m, &inverse, s.normal),
        normal: transform_normal(&inverse, s.normal).normalize(),
        position: m.transform_point3(s.position),
        ..s
    }
}

/// By which factor a small piece of surface with `normal` (of any length, before the map) grows: |det M| |M^-T n|.
fn area_element_growth(m: &DAffine3, inverse: &DAffine3, normal: DVec3) -> f64 {
    m.matrix3.determinant().abs() * transform_normal(inverse, normal.normalize()).length()
}

/// Places where a glowing texture is looked at to guess its power.
const TEXTURE_PROBES: u32 = 64;

fn is_similarity(m: &DAffine3) -> bool {
    let (x, y, z) = (m.matrix3.x_axis, m.matrix3.y_axis, m.matrix3.z_axis);
    let s = x.length_squared();
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * s;
    near(y.length_squared(), s)
        && near(z.length_squared(), s)
        && near(x.dot(y), 0.0)
        && near(y.dot(z), 0.0)
        && near(z.dot(x), 0.0)
}
