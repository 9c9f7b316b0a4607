//! The surface of spheres that the accelerator holds as they are: one, or many of one object.

use super::analytic::{curved_error, degenerate, similarity_scale};
use super::sphere::{sphere_bitangent, sphere_tangent, sphere_uv, uniform_direction};
use super::{AreaSample, Detail, Part, ShapeInput, Surface, SurfacePoint};
use crate::textures::SurfacePatch;
use core::f64::consts::{PI, TAU};
use kirkas_accel::{Shape, Sphere};
use kirkas_geometry::elementary::sin_cos;
use kirkas_geometry::{Bounds3, DAffine3, DMat3, DVec3, Ray};
use kirkas_scene::Diagnostic;
use std::sync::{Arc, OnceLock};

/// Spheres of one object, its map to part space being a similarity.
pub struct SphereSet {
    spheres: Arc<Vec<Sphere>>,
    /// The sphere where there is one only: at hand, since thousands of lamps are looked up at random.
    only: Option<Sphere>,
    /// The turn (and mirror) of the map, without its scale.
    part_turn: DMat3,
    object_from_part: DAffine3,
    bounds: Bounds3,
    /// Area of the first, of the first two, ...
    cumulative_area: OnceLock<Vec<f64>>,
}

impl SphereSet {
    /// The one part of spheres given by center and radius in object space.
    pub fn parts(in_object: &[(DVec3, f64)], input: &ShapeInput) -> Result<Vec<Part>, Diagnostic> {
        let m = &input.part_from_object;
        let scale = similarity_scale(&m.matrix3).ok_or_else(|| uneven(input))?;
        let mut spheres = Vec::with_capacity(in_object.len());
        let mut bounds = Bounds3::EMPTY;
        for &(center, radius) in in_object {
            let sphere = Sphere { center: m.transform_point3(center).as_vec3(), radius: (radius * scale) as f32 };
            let reach = DVec3::splat(f64::from(sphere.radius));
            let own = Bounds3::around_f64(sphere.center.as_dvec3() - reach, sphere.center.as_dvec3() + reach);
            if !(sphere.radius >= f32::MIN_POSITIVE && own.is_finite()) {
                let what =
                    format!("its radius or place, {} at {}, is beyond what f32 holds", sphere.radius, sphere.center);
                return Err(degenerate(input, "radius", what, "too small or too large")
                    .help("bring the scene's sizes and distances nearer to 1"));
            }
            bounds = bounds.union(own);
            spheres.push(sphere);
        }
        let only = if spheres.len() == 1 { Some(spheres[0]) } else { None };
        let spheres = Arc::new(spheres);
        let surface = Arc::new(SphereSet {
            spheres: spheres.clone(),
            only,
            part_turn: m.matrix3 * (1.0 / scale),
            object_from_part: m.inverse(),
            bounds,
            cumulative_area: OnceLock::new(),
        });
        Ok(vec![Part { shape: Shape::Spheres(spheres), surface, own_material: None }])
    }

    fn cumulative_area(&self) -> &[f64] {
        self.cumulative_area.get_or_init(|| {
            let mut sum = 0.0;
            let area = |s: &Sphere| 4.0 * PI * f64::from(s.radius) * f64::from(s.radius);
            self.spheres.iter().map(|s| (sum += area(s), sum).1).collect()
        })
    }

    fn normal_in_object(&self, normal: DVec3) -> DVec3 {
        (self.object_from_part.matrix3 * normal).normalize()
    }

    fn area_sample(&self, position: DVec3, normal: DVec3, pdf_area: f64, detail: Detail) -> AreaSample {
        let (uv, object_position) = match detail {
            Detail::Place => ([0.0; 2], DVec3::ZERO),
            Detail::Texture => (uv(self.normal_in_object(normal)), self.object_from_part.transform_point3(position)),
        };
        AreaSample { position, normal, uv, object_position, part_normal: normal, color: [0.0; 4], pdf_area }
    }

    /// The cone in which the only sphere is seen from `from`; `None` from within, and from its own surface, where rounding would
    /// decide between the two.
    fn cone(&self, from: DVec3) -> Option<Cone> {
        let sphere = self.only?;
        let (center, radius) = (sphere.center.as_dvec3(), f64::from(sphere.radius));
        let distance = (center - from).length();
        const ROUNDING: f64 = 1e-12;
        if !(distance - radius > ROUNDING * (radius + center.abs().max_element())) {
            return None;
        }
        let sin2 = (radius / distance) * (radius / distance);
        // 1 - cos without cancellation, for narrow cones and for wide ones.
        let cos = ((distance - radius) * (distance + radius)).sqrt() / distance;
        let one_minus_cos = sin2 / (1.0 + cos);
        (one_minus_cos > 0.0).then_some(Cone { center, radius, distance, one_minus_cos })
    }
}

struct Cone {
    center: DVec3,
    radius: f64,
    distance: f64,
    one_minus_cos: f64,
}

impl Cone {
    fn pdf(&self) -> f64 {
        1.0 / (TAU * self.one_minus_cos)
    }
}

impl Surface for SphereSet {
    fn point(&self, primitive: u32, _u: f32, _v: f32, t: f32, ray: &Ray, detail: Detail) -> SurfacePoint {
        let sphere = &self.spheres[primitive as usize];
        let (center, radius) = (sphere.center.as_dvec3(), f64::from(sphere.radius));
        let near = ray.origin.as_dvec3() + ray.direction.as_dvec3() * f64::from(t);
        let normal = (near - center).try_normalize().unwrap_or(DVec3::Y);
        let position = center + normal * radius;
        let n = self.normal_in_object(normal);
        // The second term: roundings of the intersection in f64.
        let error = curved_error(position) + 1e-14 * (center.abs().max_element() + radius);
        SurfacePoint {
            position,
            error,
            normal,
            shading_normal: normal,
            uv: if detail == Detail::Texture { uv(n) } else { [0.0; 2] },
            tangent: self.part_turn * sphere_tangent(n) * radius,
            object_position: match detail {
                Detail::Place => DVec3::ZERO,
                Detail::Texture => self.object_from_part.transform_point3(position),
            },
        }
    }

    fn patch(&self, primitive: u32, _u: f32, _v: f32, point: &SurfacePoint) -> SurfacePatch {
        let n = self.normal_in_object(point.normal);
        let radius = f64::from(self.spheres[primitive as usize].radius);
        SurfacePatch { tangents: [point.tangent, self.part_turn * sphere_bitangent(n) * radius], color: [0.0; 4] }
    }

    fn object_from_part(&self) -> DMat3 {
        self.object_from_part.matrix3
    }

    fn curvature(&self, primitive: u32, _u: f32, _v: f32) -> f64 {
        1.0 / f64::from(self.spheres[primitive as usize].radius)
    }

    fn area(&self) -> Option<f64> {
        self.cumulative_area().last().copied()
    }

    fn sample_area(&self, u: (f32, f32), detail: Detail) -> Option<AreaSample> {
        let areas = self.cumulative_area();
        let total = *areas.last()?;
        let target = f64::from(u.0) * total;
        let i = areas.partition_point(|&a| a <= target).min(areas.len() - 1);
        let before = if i == 0 { 0.0 } else { areas[i - 1] };
        let rest = ((target - before) / (areas[i] - before)).clamp(0.0, 1.0);
        let sphere = &self.spheres[i];
        let normal = uniform_direction((rest, f64::from(u.1)));
        let position = sphere.center.as_dvec3() + normal * f64::from(sphere.radius);
        Some(self.area_sample(position, normal, 1.0 / total, detail))
    }

    fn sample_toward(&self, from: DVec3, u: (f32, f32), detail: Detail) -> Option<(AreaSample, f64)> {
        let cone = self.cone(from)?;

        // Choose a direction in the cone, uniform by solid angle.
        let axis = (cone.center - from) / cone.distance;
        let (x, y) = axis.any_orthonormal_pair();
        let h = cone.one_minus_cos * f64::from(u.0);
        let sin2 = (h * (2.0 - h)).max(0.0);
        let (sine, (s, c)) = (sin2.sqrt(), sin_cos(TAU * f64::from(u.1)));
        let w = axis * (1.0 - h) + x * (sine * c) + y * (sine * s);

        // Find where it meets the near side; at the rim, where it may miss by rounding, it touches.
        let miss2 = cone.distance * cone.distance * sin2;
        let half_chord = (cone.radius * cone.radius - miss2).max(0.0).sqrt();
        let s = cone.distance * (1.0 - h) - half_chord;
        let normal = (from + w * s - cone.center).try_normalize()?;
        let position = cone.center + normal * cone.radius;
        let to_point = position - from;
        let cosine = (-normal.dot(to_point)).max(0.0) / to_point.length();
        let pdf_area = cone.pdf() * cosine / to_point.length_squared();
        Some((self.area_sample(position, normal, pdf_area, detail), cone.pdf()))
    }

    fn pdf_toward(&self, from: DVec3) -> Option<f64> {
        self.cone(from).map(|c| c.pdf())
    }

    fn bounds(&self) -> Bounds3 {
        self.bounds
    }
}

fn uv(normal_in_object: DVec3) -> [f32; 2] {
    sphere_uv(normal_in_object).map(|x| x as f32)
}

fn uneven(input: &ShapeInput) -> Diagnostic {
    let name = &input.params.entity.name;
    let what = format!("{} `{}` is scaled unevenly", input.params.spec().name, name.text);
    Diagnostic::error("uneven-scale", what)
        .at(input.params.span("transform"), "makes ellipsoids of its spheres")
        .help("use the same factor on all axes: `{ scale = 2 }`")
}
