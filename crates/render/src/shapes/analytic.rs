//! Shapes given by a formula: each is written once, for a convenient pose in *canonical space*, and placed by an affine map.
//!
//! Everything is f64, so that a hit is as exact as its f32 ray, and the point found for it lies on the surface to f64
//! rounding. What a ray then must stay clear of is only the rounding of its own f32 origin.

use super::{AreaSample, Detail, Part, ShapeInput, Surface, SurfacePoint};
use crate::lights::Cone;
use crate::textures::SurfacePatch;
use kirkas_accel::{Shape, UserShape};
use kirkas_geometry::elementary::cbrt;
use kirkas_geometry::rounding::gamma;
use kirkas_geometry::transform::{is_invertible, transform_normal};
use kirkas_geometry::{Bounds3, DAffine3, DMat3, DVec3, Ray};
use kirkas_scene::Diagnostic;
use std::sync::Arc;

/// A shape in its own canonical space. Its size there is about 1 and it lies about the origin.
pub trait Canonical: Send + Sync + 'static {
    /// True when all faces are flat: then a ray's f32 origin can be rounded to the right side of the face exactly.
    const FLAT: bool;

    /// The support function: the largest `n . p` over all points `p`; infinite if there is none. Gives tight boxes.
    fn support(&self, n: DVec3) -> f64;

    /// Where the line `o + t d` crosses the surface, for all real `t`, rising. A closed surface is crossed an even number
    /// of times.
    fn crossings(&self, o: DVec3, d: DVec3) -> Crossings;

    /// The point of `face` nearest to `p` (or very near to the nearest), `p` being off by rounding.
    fn project(&self, p: DVec3, face: u8) -> DVec3;

    /// Normal, texture coordinates and tangent at a point of `face`.
    fn local(&self, p: DVec3, face: u8) -> Local;

    /// Derivative of position by `uv[1]` there.
    fn bitangent(&self, p: DVec3, face: u8) -> DVec3;

    /// About the mean curvature of `face`, positive where it bulges along its normal.
    fn curvature(&self, _face: u8) -> f64 {
        0.0
    }

    /// The area after the linear map `m`; `None` if infinite or not known for such a map.
    fn area(&self, m: &DMat3) -> Option<f64>;

    /// A point and its face, uniform by area after the map `m`. Asked only where [`Canonical::area`] answers.
    fn sample(&self, m: &DMat3, u: (f64, f64)) -> (DVec3, u8);
}

/// What is known at a point in canonical space.
#[derive(Clone, Copy, Debug)]
pub struct Local {
    /// Outward, any length but 0.
    pub normal: DVec3,
    /// Texture coordinates.
    pub uv: [f64; 2],
    /// Derivative of position by `uv[0]`.
    pub tangent: DVec3,
}

/// Up to four places along a line, each with its face.
#[derive(Clone, Copy, Debug, Default)]
pub struct Crossings {
    places: [(f64, u8); 4],
    len: usize,
}

impl Crossings {
    /// Add one, not before the last.
    pub fn push(&mut self, t: f64, face: u8) {
        debug_assert!(self.len < 4 && (self.len == 0 || self.places[self.len - 1].0 <= t));
        self.places[self.len] = (t, face);
        self.len += 1;
    }

    /// All, rising.
    pub fn as_slice(&self) -> &[(f64, u8)] {
        &self.places[..self.len]
    }
}

/// A line by its point nearest to the origin and its unit direction: the form in which quadratics and quartics lose nothing
/// when the ray comes from far away.
#[derive(Clone, Copy, Debug)]
pub struct CenteredLine {
    /// Point nearest to the origin.
    pub o: DVec3,
    /// Unit direction.
    pub d: DVec3,
    shift: f64,
    per_length: f64,
}

impl CenteredLine {
    /// The line `o + t d`.
    pub fn new(o: DVec3, d: DVec3) -> Self {
        let per_length = 1.0 / d.length();
        let d = d * per_length;
        let shift = -o.dot(d);
        CenteredLine { o: o + d * shift, d, shift, per_length }
    }

    /// `t` of the original line for the distance `s` along this one.
    pub fn t(&self, s: f64) -> f64 {
        (self.shift + s) * self.per_length
    }

    /// The point at distance `s`.
    pub fn at(&self, s: f64) -> DVec3 {
        self.o + self.d * s
    }
}

/// A canonical shape, placed.
pub struct Placed<C> {
    shape: C,
    part_from_canonical: DAffine3,
    canonical_from_part: DMat3,
    object_from_canonical: DAffine3,
    bounds: Bounds3,
    area: Option<f64>,
    /// The normal, if it is the same everywhere.
    flat_normal: Option<DVec3>,
    /// Bound on f64 rounding, in scene units.
    slack: f64,
}

/// The one part of an analytic shape; `object_from_canonical` holds the object's own parameters.
pub fn place<C: Canonical>(
    shape: C,
    object_from_canonical: DAffine3,
    input: &ShapeInput,
) -> Result<Vec<Part>, Diagnostic> {
    let placed = Arc::new(Placed::new(shape, object_from_canonical, input)?);
    Ok(vec![Part { shape: Shape::User(placed.clone()), surface: placed, own_material: None }])
}

impl<C: Canonical> Placed<C> {
    fn new(shape: C, object_from_canonical: DAffine3, input: &ShapeInput) -> Result<Self, Diagnostic> {
        let part_from_canonical = input.part_from_object * object_from_canonical;
        if !is_invertible(&part_from_canonical) {
            let entity = input.params.entity;
            return Err(Diagnostic::error(
                "degenerate-shape",
                format!("object `{}` is flat or too large to be computed with", entity.name.text),
            )
            .at(entity.name.span, "this one")
            .help("make its sizes differ less from each other, and its transform invertible"));
        }
        let bounds = bounds_of(&shape, &part_from_canonical);
        let reach = |v: DVec3| if v.is_finite() { v.abs().max_element() } else { 0.0 };
        let size =
            reach(part_from_canonical.translation).max(reach(bounds.min.as_dvec3())).max(reach(bounds.max.as_dvec3()));
        let mut placed = Placed {
            area: shape.area(&part_from_canonical.matrix3).filter(|a| a.is_finite() && *a > 0.0),
            shape,
            part_from_canonical,
            canonical_from_part: part_from_canonical.matrix3.inverse(),
            object_from_canonical,
            bounds,
            flat_normal: None,
            slack: F64_SLACK * size,
        };
        let is_in_plane = placed.shape.support(DVec3::Z) == 0.0 && placed.shape.support(DVec3::NEG_Z) == 0.0;
        placed.flat_normal = is_in_plane.then(|| placed.normal(&placed.shape.local(DVec3::ZERO, 0)));
        Ok(placed)
    }

    fn canonical_point(&self, p: DVec3) -> DVec3 {
        // The difference first: it is nearly exact, however far the shape is from the origin.
        self.canonical_from_part * (p - self.part_from_canonical.translation)
    }

    fn object_position(&self, canonical: DVec3, detail: Detail) -> DVec3 {
        match detail {
            Detail::Place => DVec3::ZERO,
            Detail::Texture => self.object_from_canonical.transform_point3(canonical),
        }
    }

    fn normal(&self, local: &Local) -> DVec3 {
        if let Some(normal) = self.flat_normal {
            return normal;
        }
        let inverse = DAffine3 { matrix3: self.canonical_from_part, translation: DVec3::ZERO };
        transform_normal(&inverse, local.normal).normalize()
    }
}

/// Some tens of f64 roundings.
const F64_SLACK: f64 = 1e-14;

fn bounds_of<C: Canonical>(shape: &C, m: &DAffine3) -> Bounds3 {
    let rows = m.matrix3.transpose();
    let reach = |sign: f64| {
        DVec3::new(
            shape.support(rows.x_axis * sign),
            shape.support(rows.y_axis * sign),
            shape.support(rows.z_axis * sign),
        )
    };
    let (low, high) = (m.translation - reach(-1.0), m.translation + reach(1.0));
    if !low.is_finite() || !high.is_finite() {
        return Bounds3::EVERYTHING;
    }
    // Rounding of each axis by what it was summed from. Exact zeros stay exact: a level rectangle has a flat box.
    let sum = m.translation.abs() + reach(1.0).abs() + reach(-1.0).abs();
    let slack = sum * 1e-15;
    Bounds3::around_f64(low - slack, high + slack)
}

impl<C: Canonical> UserShape for Placed<C> {
    fn len(&self) -> usize {
        1
    }

    fn bounds(&self, _primitive: u32) -> Bounds3 {
        self.bounds
    }

    fn intersect(&self, _primitive: u32, ray: &Ray, visit: &mut dyn FnMut(f32, f32, f32) -> bool) {
        let o = self.canonical_point(ray.origin.as_dvec3());
        let d = self.canonical_from_part * ray.direction.as_dvec3();
        for &(t, face) in self.shape.crossings(o, d).as_slice() {
            // Rounding is monotone, so the order stays.
            let t = t as f32;
            if t > ray.t_min && t < ray.t_max && visit(t, f32::from(face), 0.0) {
                return;
            }
        }
    }
}

impl<C: Canonical> Surface for Placed<C> {
    fn point(&self, _primitive: u32, u: f32, _v: f32, t: f32, ray: &Ray, detail: Detail) -> SurfacePoint {
        let face = u as u8;
        let near = ray.origin.as_dvec3() + ray.direction.as_dvec3() * f64::from(t);
        let canonical = self.shape.project(self.canonical_point(near), face);
        let local = self.shape.local(canonical, face);
        let position = self.part_from_canonical.transform_point3(canonical);
        let normal = self.normal(&local);
        let slack = self.slack + F64_SLACK * position.abs().max_element();
        SurfacePoint {
            position,
            error: if C::FLAT { flat_error(position) + slack } else { curved_error(position) + slack },
            normal,
            shading_normal: normal,
            uv: local.uv.map(|x| x as f32),
            tangent: self.part_from_canonical.matrix3 * local.tangent,
            object_position: self.object_position(canonical, detail),
        }
    }

    fn patch(&self, _primitive: u32, u: f32, _v: f32, point: &SurfacePoint) -> SurfacePatch {
        let bitangent = self.shape.bitangent(self.canonical_point(point.position), u as u8);
        SurfacePatch { tangents: [point.tangent, self.part_from_canonical.matrix3 * bitangent], color: [0.0; 4] }
    }

    fn object_from_part(&self) -> DMat3 {
        self.object_from_canonical.matrix3 * self.canonical_from_part
    }

    fn curvature(&self, _primitive: u32, u: f32, _v: f32) -> f64 {
        self.shape.curvature(u as u8) * cbrt(self.canonical_from_part.determinant().abs())
    }

    fn area(&self) -> Option<f64> {
        self.area
    }

    fn sample_area(&self, u: (f32, f32), detail: Detail) -> Option<AreaSample> {
        let area = self.area?;
        let (p, face) = self.shape.sample(&self.part_from_canonical.matrix3, (f64::from(u.0), f64::from(u.1)));
        let local = self.shape.local(p, face);
        let normal = self.normal(&local);
        Some(AreaSample {
            position: self.part_from_canonical.transform_point3(p),
            normal,
            uv: local.uv.map(|x| x as f32),
            object_position: self.object_position(p, detail),
            part_normal: normal,
            color: [0.0; 4],
            pdf_area: 1.0 / area,
        })
    }

    fn bounds(&self) -> Bounds3 {
        self.bounds
    }

    fn normals(&self) -> Cone {
        self.flat_normal.map_or(Cone::ALL, Cone::of)
    }
}

/// Rounding of a point to f32, per axis.
pub fn flat_error(position: DVec3) -> DVec3 {
    position.abs() * f64::from(gamma(1))
}

/// The same for curved surfaces, from which rounding *along* the surface leads away too: as large on all axes.
pub fn curved_error(position: DVec3) -> DVec3 {
    DVec3::splat(position.abs().max_element() * f64::from(gamma(2)))
}

/// The factor of a map that keeps all angles; `None` if it does not.
pub fn similarity_scale(m: &DMat3) -> Option<f64> {
    let (x, y, z) = (m.x_axis, m.y_axis, m.z_axis);
    let s2 = (x.length_squared() + y.length_squared() + z.length_squared()) / 3.0;
    let near = |a: f64, b: f64| (a - b).abs() <= 1e-9 * s2;
    let equal = near(x.length_squared(), s2) && near(y.length_squared(), s2) && near(z.length_squared(), s2);
    let right_angled = near(x.dot(y), 0.0) && near(y.dot(z), 0.0) && near(z.dot(x), 0.0);
    (s2 > 0.0 && equal && right_angled).then(|| s2.sqrt())
}

/// A frame whose z axis is `axis` (unit): right-handed, with x towards `+x` where that is possible and, for an axis along
/// the world's x, towards `+y`.
pub fn frame_around(axis: DVec3) -> DMat3 {
    let lean = if axis.x.abs() < 0.9 { DVec3::X } else { DVec3::Y };
    let x = (lean - axis * axis.dot(lean)).normalize();
    DMat3::from_cols(x, axis.cross(x), axis)
}

/// Angle of `(x, y)` as a part of a turn, in `[0, 1)`.
pub fn turn(y: f64, x: f64) -> f64 {
    let u = kirkas_geometry::elementary::atan2(y, x) / core::f64::consts::TAU;
    if u < 0.0 { (u + 1.0).min(ALMOST_ONE) } else { u }
}

const ALMOST_ONE: f64 = 1.0 - f64::EPSILON;

/// The parameter `name`, which must not be the zero vector, made unit.
pub fn unit_vector(input: &ShapeInput, name: &str) -> Result<DVec3, Diagnostic> {
    let v = DVec3::from_array(input.params.vector(name));
    // Scaled first, so that neither tiny nor huge vectors lose their direction.
    let largest = v.abs().max_element();
    (v / largest).try_normalize().filter(|_| largest > 0.0).ok_or_else(|| {
        degenerate(input, name, format!("`{name}` is the zero vector"), "has no direction")
            .help(format!("write a direction, such as `{name} = [0, 1, 0]`"))
    })
}

/// A [`Diagnostic`] about parameter `name`; the caller adds the cure.
pub fn degenerate(input: &ShapeInput, name: &str, what: String, label: &str) -> Diagnostic {
    let entity = input.params.entity;
    Diagnostic::error("degenerate-shape", format!("{} `{}`: {what}", entity.type_name.text, entity.name.text))
        .at(input.params.span(name), label)
}
