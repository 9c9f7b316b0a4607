//! The normal of a surface where a ray met it.

use crate::accel::Accel;
use crate::curve;
use crate::cylinder::outward;
use crate::hit::Hit;
use crate::moving;
use crate::primitive::{corners, segment};
use crate::quad;
use crate::scene_geometry::Shape;
use crate::triangle::Corners;
use kirkas_geometry::transform::transform_normal;
use kirkas_geometry::{DAffine3, DVec3, Ray};

impl Accel {
    /// The unit normal in world space where `ray` met `hit`: of triangles and quads counter-clockwise (corner 0, 1, then the
    /// others), of disks their own, of round shapes outwards. `None` for user shapes.
    pub fn normal(&self, ray: &Ray, hit: &Hit) -> Option<DVec3> {
        let (mut geometries, mut instances) = (&self.scene.world, &self.scene.instances);
        let mut world_from_object = DAffine3::IDENTITY;
        let (open, close) = self.scene.shutter;
        for index in hit.instance.iter() {
            let instance = &instances[index as usize];
            let time = f64::from(ray.time).clamp(open, close);
            world_from_object *= instance.outer_from_object.at(time);
            let aggregate = &self.scene.aggregates[instance.aggregate];
            (geometries, instances) = (&aggregate.geometries, &aggregate.instances);
        }
        let object_from_world = world_from_object.inverse();
        let point = ray.origin.as_dvec3() + ray.direction.as_dvec3() * f64::from(hit.t);
        let point = object_from_world.transform_point3(point);
        let moment = moving::moment(ray.time, self.scene.shutter);
        let normal = in_object(&geometries[hit.geometry as usize].shape, hit, moment, point)?;
        Some(transform_normal(&object_from_world, normal).normalize_or_zero())
    }
}

/// Of any length.
fn in_object(shape: &Shape, hit: &Hit, moment: f32, point: DVec3) -> Option<DVec3> {
    let p = hit.primitive as usize;
    Some(match shape {
        Shape::Triangles { positions, indices } => across(&corners(positions, indices[p])),
        Shape::MovingTriangles { keys, indices } => across(&moving::corners(keys, indices[p], moment)),
        Shape::Quads { positions, indices } => {
            let [first, second] = quad::halves(&corners(positions, indices[p]));
            across(if hit.u + hit.v <= 1.0 { &first } else { &second })
        }
        Shape::Disks(disks) => disks[p].normal.as_dvec3(),
        Shape::Cylinders(all) => {
            let [a, b] = all[p].ends.map(|e| e.as_dvec3());
            outward(point - a, b - a)
        }
        Shape::Curves { points, segments } => curve::outward(&segment(points, segments[p]), point),
        Shape::Spheres(spheres) => point - spheres[p].center.as_dvec3(),
        Shape::User(_) => return None,
    })
}

fn across(corners: &Corners) -> DVec3 {
    let [a, b, c] = corners.map(|c| DVec3::new(c[0].into(), c[1].into(), c[2].into()));
    (b - a).cross(c - a)
}
