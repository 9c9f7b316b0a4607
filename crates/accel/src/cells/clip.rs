//! Cuts the region where a primitive can be hit by a cell.

use crate::record::{Record, RecordKind};
use kirkas_geometry::{Bounds3, DVec3};

/// Where a primitive can be hit: within its bounds and, for a triangle, near its plane.
pub(crate) struct Clip {
    bounds: Bounds3,
    slab: Option<Slab>,
}

/// All points with `|normal . (x - corner)| <= half_width`.
struct Slab {
    corner: DVec3,
    normal: DVec3,
    half_width: f64,
}

/// What a rounding in f64 may add to the distance from a plane, in units of the growth, for a triangle of no area.
const SLIVER: f64 = 1.0 / (1 << 22) as f64;

impl Clip {
    /// Of a primitive with these bounds; `growth` is how far hits may lie off a triangle's plane, along each axis.
    pub fn new(record: &Record, bounds: Bounds3, growth: f64) -> Self {
        let slab = (record.kind == RecordKind::Triangle).then(|| {
            let [p, q, r] = record.corners.map(|c| DVec3::new(c[0].into(), c[1].into(), c[2].into()));
            let (e1, e2) = (q - p, r - p);
            let normal = e1.cross(e2);
            let sum = |v: DVec3| v.x.abs() + v.y.abs() + v.z.abs();
            Slab { corner: p, normal, half_width: growth * (sum(normal) + SLIVER * sum(e1) * sum(e2)) }
        });
        Clip { bounds, slab }
    }

    /// The box around the part that lies in a cell; empty where there is none.
    pub fn within(&self, cell: &Bounds3) -> Bounds3 {
        let b = self.bounds.intersection(*cell);
        let Some(Slab { corner, normal, half_width }) = &self.slab else { return b };
        if b.is_empty() {
            return b;
        }
        // One linear inequality on each side: an axis has the room that the two others leave.
        let (at_min, at_max) = (*normal * (b.min.as_dvec3() - *corner), *normal * (b.max.as_dvec3() - *corner));
        let (low, high) = (at_min.min(at_max), at_min.max(at_max));
        let (mut min, mut max) = (DVec3::NEG_INFINITY, DVec3::INFINITY);
        for k in 0..3 {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            let (from, to) = (-half_width - (high[i] + high[j]), half_width - (low[i] + low[j]));
            if from > high[k] || to < low[k] {
                return Bounds3::EMPTY;
            }
            if normal[k] != 0.0 {
                let (a, b) = (corner[k] + from / normal[k], corner[k] + to / normal[k]);
                (min[k], max[k]) = (a.min(b), a.max(b));
            }
        }
        b.intersection(Bounds3::around_f64(min, max))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene_geometry::{Geometry, Shape};
    use crate::triangle;
    use kirkas_geometry::Vec3;
    use kirkas_geometry::hash::{combine, unit_f32};
    use std::sync::Arc;

    fn clip(corners: [Vec3; 3], growth: f64) -> Clip {
        let shape = Shape::Triangles { positions: Arc::new(corners.to_vec()), indices: Arc::new(vec![[0, 1, 2]]) };
        let geometry = Geometry { shape, opaque: true, mask: 1 };
        Clip::new(&Record::new(&[geometry], 0, 0), triangle::bounds(&corners.map(|c| c.to_array())), growth)
    }

    #[test]
    fn no_point_of_a_triangle_is_cut_away() {
        let random = |i: u64, k: u64| unit_f32(combine(i, k) as u32);
        let point = |i: u64, k: u64| Vec3::new(random(i, k), random(i, k + 1), random(i, k + 2));
        for i in 0..20_000 {
            let corners = [point(i, 0), point(i, 3), point(i, 6)];
            let (u, v) = (random(i, 10), random(i, 11));
            let (u, v) = if u + v > 1.0 { (1.0 - u, 1.0 - v) } else { (u, v) };
            let p = corners[0] * (1.0 - u - v) + corners[1] * u + corners[2] * v;
            let cell = Bounds3 { min: p - point(i, 20) * 0.3, max: p + point(i, 23) * 0.3 };
            assert!(clip(corners, 1e-6).within(&cell).contains(p), "{corners:?} {cell:?}");
        }
    }

    #[test]
    fn cells_off_the_plane_are_free_of_it_and_others_hold_a_tight_box() {
        let diagonal = clip([Vec3::ZERO, Vec3::ONE, Vec3::new(1.0, 1.0, 0.0)], 1e-6);
        let cube = |x: f32, y: f32| Bounds3::from_corners(Vec3::new(x, y, 0.0), Vec3::new(x + 0.2, y + 0.2, 0.2));
        assert!(diagonal.within(&cube(0.1, 0.5)).is_empty());
        let cut = diagonal.within(&cube(0.1, 0.2));
        assert!((cut.min - Vec3::new(0.2, 0.2, 0.0)).abs().max_element() < 1e-4);
        assert!((cut.max - Vec3::new(0.3, 0.3, 0.2)).abs().max_element() < 1e-4);
    }
}
