//! Disks, cylinders, curves and quads against closed forms, and against where they were aimed at.

use crate::common::*;
use kirkas_accel::*;
use kirkas_geometry::{AnimatedTransform, DAffine3, DVec3, Ray, Vec3};
use std::sync::{Arc, Mutex};

pub fn disk(center: Vec3, normal: Vec3, radius: f32) -> Shape {
    Shape::Disks(Arc::new(vec![Disk { center, normal, radius }]))
}

pub fn cylinder(a: Vec3, b: Vec3, radius: f32) -> Shape {
    Shape::Cylinders(Arc::new(vec![Cylinder { ends: [a, b], radius }]))
}

pub fn curve(points: &[(Vec3, f32)]) -> Shape {
    let segments = (0..points.len() as u32 - 1).collect();
    let points = points.iter().map(|&(position, radius)| CurvePoint { position, radius }).collect();
    Shape::Curves { points: Arc::new(points), segments: Arc::new(segments) }
}

pub fn quad(corners: [Vec3; 4]) -> Shape {
    Shape::Quads { positions: Arc::new(corners.to_vec()), indices: Arc::new(vec![[0, 1, 2, 3]]) }
}

/// Notes every crossing and refuses it.
struct Note(Mutex<Vec<Hit>>);

impl HitFilter for Note {
    fn accept(&self, _: usize, _: &Ray, hit: &Hit) -> bool {
        self.0.lock().unwrap().push(*hit);
        false
    }
}

/// Every crossing with one shape, nearest first.
fn crossings(shape: Shape, ray: &Ray) -> Vec<Hit> {
    let mut scene = world(vec![shape]);
    scene.world[0].opaque = false;
    let note = Note(Mutex::default());
    build(AccelKind::BruteForce, &scene).closest_hit(ray, Query::filtered(&note), 0, &mut Counters::default());
    note.0.into_inner().unwrap()
}

fn ts(shape: Shape, ray: &Ray) -> Vec<f32> {
    crossings(shape, ray).iter().map(|h| h.t).collect()
}

#[test]
fn disks_are_hit_within_the_rim_from_both_sides() {
    let flat = || disk(Vec3::new(1.0, 0.0, 0.0), Vec3::Z * -3.0, 2.0);
    let down = |x: f32, z: f32| Ray::new(Vec3::new(x, 0.0, z), Vec3::Z * -z.signum());
    let hit = crossings(flat(), &down(2.0, 4.0))[0];
    assert_eq!((hit.t, hit.u, hit.v), (4.0, 0.5, 0.0));
    assert_eq!(ts(flat(), &down(2.0, -4.0)), [4.0]);
    assert_eq!(ts(flat(), &down(3.0_f32.next_down(), 4.0)), [4.0]);
    assert!(ts(flat(), &down(3.0, 4.0)).is_empty(), "the rim");
    assert!(ts(disk(Vec3::X, Vec3::Z, 0.0), &down(1.0, 4.0)).is_empty(), "a disk without size");
    let within = Ray::new(Vec3::new(-9.0, 0.0, 0.0), Vec3::X);
    assert!(ts(flat(), &within).is_empty(), "in its plane");
    let leaving = Ray { t_min: -1.0, ..Ray::new(Vec3::X, Vec3::new(0.3, 0.2, 1.0)) };
    assert!(ts(flat(), &leaving).is_empty(), "from its plane");
}

#[test]
fn cylinders_are_open_and_hit_from_inside() {
    let tube = || cylinder(Vec3::ZERO, Vec3::Z * 4.0, 1.0);
    let across = Ray::new(Vec3::new(5.0, 0.0, 1.0), -Vec3::X);
    let hits = crossings(tube(), &across);
    assert_eq!(hits.iter().map(|h| (h.t, h.u)).collect::<Vec<_>>(), [(4.0, 0.25), (6.0, 0.25)]);
    assert_eq!(ts(tube(), &Ray::new(Vec3::new(0.0, 0.0, 1.0), Vec3::Y)), [1.0], "from inside");
    assert!(ts(tube(), &Ray::new(Vec3::new(0.5, 0.0, -9.0), Vec3::Z)).is_empty(), "through, along the axis");
    assert!(ts(tube(), &Ray::new(Vec3::new(1.0, 0.0, -9.0), Vec3::Z)).is_empty(), "within the surface");
    assert!(ts(tube(), &Ray::new(Vec3::new(5.0, 1.0, 2.0), -Vec3::X)).is_empty(), "a tangent");
    assert_eq!(ts(tube(), &Ray::new(Vec3::new(5.0, 0.0, 4.5), Vec3::new(-1.0, 0.0, -0.1))), [6.0]);
    let slanted = Ray::new(Vec3::new(3.0, 0.0, 6.0), Vec3::new(-1.0, 0.0, -1.0));
    assert_eq!(ts(tube(), &slanted), [2.0, 4.0]);
    let over_the_end = Ray::new(Vec3::new(3.0, 0.0, 7.0), Vec3::new(-1.0, 0.0, -1.0));
    assert_eq!(ts(tube(), &over_the_end), [4.0], "in at the open end");
    let start = Ray::new(Vec3::new(0.6, 0.8, 1.0) * Vec3::new(5.0, 5.0, 1.0), -Vec3::X);
    assert_eq!(ts(cylinder(Vec3::ZERO, Vec3::Z * 4.0, 5.0), &start), [6.0], "leaves for good, meets the far side");
    assert!(ts(cylinder(Vec3::ONE, Vec3::ONE, 1.0), &across).is_empty(), "without length");
    assert!(ts(cylinder(Vec3::ZERO, Vec3::Z, 0.0), &across).is_empty(), "without radius");
}

#[test]
fn curves_are_hulls_of_balls() {
    let tube = || curve(&[(Vec3::ZERO, 1.0), (Vec3::Z * 4.0, 1.0)]);
    let hit = crossings(tube(), &Ray::new(Vec3::new(5.0, 0.0, 1.0), -Vec3::X))[0];
    assert_eq!((hit.t, hit.u, hit.v), (4.0, 0.25, 0.0));
    assert_eq!(ts(tube(), &Ray::new(Vec3::new(0.0, 0.0, -9.0), Vec3::Z)), [8.0, 14.0], "through both caps");
    assert_eq!(ts(tube(), &Ray::new(Vec3::Z * 2.0, Vec3::Y)), [1.0], "from inside");
    assert!(ts(tube(), &Ray::new(Vec3::new(5.0, 1.0, 2.0), -Vec3::X)).is_empty(), "a tangent");
    let leaving = Ray::new(Vec3::new(1.0, 0.0, 2.0), Vec3::new(1.0, 0.0, 0.5));
    assert!(ts(tube(), &leaving).is_empty(), "from the surface, outwards");
    assert_eq!(ts(tube(), &Ray { direction: -Vec3::X, ..leaving }), [2.0], "from the surface, inwards");
    // The apex half-angle of a cone from radius 3 to nothing over a length of 5 has the sine 3/5.
    let spike = || curve(&[(Vec3::ZERO, 3.0), (Vec3::Z * 5.0, 0.0)]);
    let hit = crossings(spike(), &Ray::new(Vec3::new(9.0, 0.0, 3.4), -Vec3::X))[0];
    assert_eq!((hit.t, hit.u), (7.8, 0.5), "the ball of radius 1.5 touches the cone at (1.2, 0, 3.4)");
    // One ball holds the other.
    let egg = || curve(&[(Vec3::ZERO, 2.0), (Vec3::Z * 0.5, 1.0)]);
    assert_eq!(ts(egg(), &Ray::new(Vec3::Z * 9.0, -Vec3::Z)), [7.0, 11.0]);
    let dot = curve(&[(Vec3::ZERO, 1.0), (Vec3::ZERO, 1.0)]);
    assert_eq!(ts(dot, &Ray::new(Vec3::Z * 9.0, -Vec3::Z)), [8.0, 10.0]);
    let thread = curve(&[(Vec3::ZERO, 0.0), (Vec3::Z, 0.0)]);
    assert!(ts(thread, &Ray::new(Vec3::new(1.0, 0.0, 0.5), -Vec3::X)).is_empty(), "without thickness");
}

#[test]
fn a_start_that_lies_on_the_surface_to_the_bit_is_no_hit() {
    let r = &mut Random::new(21);
    let (bottom, top) = (Vec3::Z * -100.0, Vec3::Z * 100.0);
    let shapes = [cylinder(bottom, top, 5.0), curve(&[(bottom, 5.0), (top, 5.0)])];
    for _ in 0..4000 {
        let side =
            [Vec3::new(3.0, 4.0, 0.0), Vec3::new(-4.0, 3.0, 0.0), Vec3::new(0.0, -5.0, 0.0)][r.below(3) as usize];
        let ray = Ray::new(side + Vec3::Z * (r.unit() - 0.5), r.cube());
        let slant = ray.direction.as_dvec3().dot(side.as_dvec3());
        for shape in &shapes {
            let ts = ts(shape.clone(), &ray);
            if slant > 0.0 {
                assert!(ts.is_empty(), "{ts:?} {ray:?}");
            } else {
                // The chord across the circle, where it ends between the ends.
                let across = ray.direction.truncate().as_dvec2();
                let chord = -2.0 * slant / across.length_squared();
                assert!(
                    ts.len() <= 1
                        && ts
                            .iter()
                            .all(|t| (f64::from(*t) - chord).abs() < 1e-4 * chord + 1e-12 || ray.at(*t).z.abs() > 99.0),
                    "{ts:?} {chord} {ray:?}"
                );
            }
        }
    }
}

#[test]
fn quads_count_u_and_v_from_their_first_corner_and_are_met_once_on_the_fold() {
    let square = || quad([Vec3::ZERO, Vec3::X * 4.0, Vec3::new(4.0, 4.0, 0.0), Vec3::Y * 4.0]);
    for (x, y) in [(1.0, 1.0), (3.0, 2.0), (1.0, 3.0), (3.0, 1.0), (2.0, 2.0), (0.0, 4.0)] {
        let hits = crossings(square(), &Ray::new(Vec3::new(x, y, 2.0), -Vec3::Z));
        assert_eq!(hits.iter().map(|h| (h.t, h.u, h.v)).collect::<Vec<_>>(), [(2.0, x / 4.0, y / 4.0)]);
    }
    let folded = quad([Vec3::new(0.0, 0.0, 2.0), Vec3::X, Vec3::new(1.0, 1.0, 2.0), Vec3::Y]);
    assert_eq!(ts(folded, &Ray::new(Vec3::new(-1.0, -1.0, 1.0), Vec3::new(1.0, 1.0, 0.0))), [1.25, 1.75]);
}

/// A shape of some size and place, and a point of its surface that is off the edges.
pub fn shape_and_point(r: &mut Random, scale: f32) -> (Shape, DVec3) {
    let (a, b) = (r.cube() * scale, r.cube() * scale);
    let (thick, thin) = ((0.05 + r.unit()) * scale, (0.02 + 0.3 * r.unit()) * scale);
    let axis = (b - a).as_dvec3();
    let side = axis.cross(r.cube().as_dvec3()).normalize();
    let along = 0.01 + 0.98 * f64::from(r.unit());
    match r.below(4) {
        0 => (disk(a, b - a, thick), a.as_dvec3() + side * f64::from(thick) * (0.99 * along)),
        1 => (cylinder(a, b, thick), a.as_dvec3() + axis * along + side * f64::from(thick)),
        2 => {
            // Where the ball at `along` touches the surface: the normal leans against the growth.
            let (length, growth) = (axis.length(), f64::from(thick) - f64::from(thin));
            let sine = growth / length;
            if sine.abs() > 0.99 {
                return shape_and_point(r, scale);
            }
            let normal = side * (1.0 - sine * sine).sqrt() - axis * (sine / length);
            let radius = f64::from(thin) + growth * along;
            (curve(&[(a, thin), (b, thick)]), a.as_dvec3() + axis * along + normal * radius)
        }
        _ => {
            let (c, d) = (r.cube() * scale, r.cube() * scale);
            let [p, q, s] = [a, b, d].map(|v| v.as_dvec3());
            let (u, v) = (along * 0.5, 0.01 + 0.48 * f64::from(r.unit()));
            (quad([a, b, c, d]), p + (q - p) * u + (s - p) * v)
        }
    }
}

#[test]
fn what_a_ray_is_aimed_at_it_meets_at_every_scale_and_from_far() {
    let r = &mut Random::new(31);
    let (mut aimed, mut grazing) = (0, 0);
    for _ in 0..40_000 {
        let scale = [1e-12, 1e-3, 1.0, 1e5, 1e12][r.below(5) as usize];
        let (shape, target) = shape_and_point(r, scale);
        let far = [1.0, 30.0, 1000.0][r.below(3) as usize];
        let origin = target.as_vec3() + r.cube() * (scale * far);
        let direction = (target - origin.as_dvec3()).as_vec3();
        let ray = Ray::new(origin, direction);
        // f32 moves the ray sideways by some roundings of its length; at a slant that is more along the ray.
        let hits = crossings(shape.clone(), &ray);
        let met = hits.iter().any(|h| (f64::from(h.t) - 1.0).abs() < 1e-4);
        aimed += 1;
        assert!(met || is_grazing(&shape, &ray, target), "{hits:?}\n{ray:?}\n{target}\n{}", text(&shape));
        grazing += usize::from(!met);
    }
    assert!(grazing * 50 < aimed, "{grazing} of {aimed}");
}

fn text(shape: &Shape) -> String {
    match shape {
        Shape::Disks(all) => format!("{all:?}"),
        Shape::Cylinders(all) => format!("{all:?}"),
        Shape::Curves { points, .. } => format!("{points:?}"),
        Shape::Quads { positions, .. } => format!("{positions:?}"),
        _ => "another".into(),
    }
}

/// True when the surface at `target` is seen at a slant of less than a few thousandths.
fn is_grazing(shape: &Shape, ray: &Ray, target: DVec3) -> bool {
    let d = ray.direction.as_dvec3().normalize();
    let normal = match shape {
        Shape::Disks(disks) => disks[0].normal.as_dvec3(),
        Shape::Cylinders(all) => {
            let [a, b] = all[0].ends.map(|e| e.as_dvec3());
            (target - a) - (b - a) * ((target - a).dot(b - a) / (b - a).dot(b - a))
        }
        Shape::Curves { points, .. } => {
            let [a, b] = [0, 1].map(|i: usize| points[i].position.as_dvec3());
            let axis = (b - a).normalize();
            let out = (target - a) - axis * (target - a).dot(axis);
            let sine = f64::from(points[1].radius - points[0].radius) / (b - a).length();
            out.normalize() * (1.0 - sine * sine).sqrt() - axis * sine
        }
        Shape::Quads { positions, .. } => {
            let [a, b, d] = [0, 1, 3].map(|i: usize| positions[i].as_dvec3());
            (b - a).cross(d - a)
        }
        _ => DVec3::ZERO,
    };
    normal.normalize().dot(d).abs() < 0.02
}

/// The distance from the hull of two balls, by search.
fn distance(p: DVec3, [a, b]: [(Vec3, f32); 2]) -> f64 {
    let at = |s: f64| {
        let center = a.0.as_dvec3() * (1.0 - s) + b.0.as_dvec3() * s;
        (p - center).length() - (f64::from(a.1) * (1.0 - s) + f64::from(b.1) * s)
    };
    let (mut lo, mut hi) = (0.0, 1.0);
    for _ in 0..200 {
        let (x, y) = (lo + (hi - lo) / 3.0, hi - (hi - lo) / 3.0);
        if at(x) < at(y) { hi = y } else { lo = x }
    }
    at(0.5 * (lo + hi))
}

#[test]
fn curves_are_where_their_distance_is_nothing() {
    let r = &mut Random::new(8);
    let (mut hits, mut misses) = (0, 0);
    for _ in 0..4000 {
        let size = [0.0, 0.2, 1.0][r.below(3) as usize];
        let ends = [(r.cube(), r.unit() * size), (r.cube(), r.unit() * 0.5)];
        let origin = r.cube() * 4.0;
        let ray = Ray::new(origin, ends[0].0.lerp(ends[1].0, r.unit()) + r.cube() * 0.7 - origin);
        let (o, d) = (ray.origin.as_dvec3(), ray.direction.as_dvec3());
        // March with steps as long as the distance: never past the surface.
        let inside = distance(o, ends) < 0.0;
        let (mut t, mut least) = (0.0, f64::INFINITY);
        for _ in 0..3000 {
            let off = distance(o + d * t, ends) * if inside { -1.0 } else { 1.0 };
            least = least.min(off);
            t += off.max(0.0) / d.length();
            if off < 1e-10 || t * d.length() > 20.0 {
                break;
            }
        }
        match ts(curve(&ends), &ray).first() {
            Some(&first) => {
                hits += 1;
                assert!((f64::from(first) - t).abs() * d.length() < 1e-3, "{first} {t} {ray:?} {ends:?}");
                assert!(distance(o + d * f64::from(first), ends).abs() < 2e-6, "{first} {t} {ray:?} {ends:?}");
            }
            None => {
                misses += 1;
                assert!(least > 1e-10 || least > -1e-9 && t * d.length() > 20.0, "missed: {least} {ray:?} {ends:?}");
            }
        }
    }
    assert!(hits > 1000 && misses > 1000, "{hits} {misses}");
}

#[test]
fn normals_stand_on_the_surface_and_out_of_it() {
    let r = &mut Random::new(2);
    let mut checked = 0;
    for _ in 0..6000 {
        let shape = match r.below(6) {
            0 => Shape::Spheres(Arc::new(vec![Sphere { center: r.cube(), radius: r.unit() }])),
            1 => triangles(&[[r.cube(), r.cube(), r.cube()]]),
            _ => shape_and_point(r, 1.0).0,
        };
        let is_round = matches!(shape, Shape::Spheres(_) | Shape::Cylinders(_) | Shape::Curves { .. });
        let accel = build(AccelKind::BruteForce, &world(vec![shape.clone()]));
        let origin = r.cube() * 4.0;
        let ray = Ray::new(origin, r.cube() - origin);
        let Some(hit) = closest(&accel, &ray) else { continue };
        let normal = accel.normal(&ray, &hit).unwrap();
        assert!((normal.length() - 1.0).abs() < 1e-12);
        // Rays beside it, a little off, meet the plane through the point across the normal.
        let to = |hit: &Hit, ray: &Ray| ray.origin.as_dvec3() + ray.direction.as_dvec3() * f64::from(hit.t);
        let at = to(&hit, &ray);
        let beside = Ray { origin: ray.origin + r.cube() * 1e-3, ..ray };
        let slant = normal.dot(ray.direction.as_dvec3().normalize());
        if let Some(other) = closest(&accel, &beside).filter(|h| (h.u - hit.u).abs() < 0.05 && slant.abs() > 0.3) {
            let off = to(&other, &beside) - at;
            if off.length() < 0.01 {
                assert!(normal.dot(off).abs() < 0.02 * off.length() + 1e-4, "{normal} {off} {}", text(&shape));
                checked += 1;
            }
        }
        let is_outside = !is_round || crossings(shape, &ray).len() == 2;
        assert!(!is_round || !is_outside || slant < 1e-6, "outwards: {normal} {ray:?}");
    }
    assert!(checked > 1000, "{checked}");
}

#[test]
fn normals_of_instances_are_those_of_the_world() {
    let stretch = DAffine3::from_scale(DVec3::new(1.0, 2.0, 1.0));
    let turn = DAffine3 { matrix3: kirkas_geometry::transform::rotation(DVec3::Z, 90.0), ..DAffine3::IDENTITY };
    let instance = |aggregate, m| Instance { aggregate, outer_from_object: AnimatedTransform::still(m), mask: 1 };
    let ball = Shape::Spheres(Arc::new(vec![Sphere { center: Vec3::ZERO, radius: 1.0 }]));
    let scene = SceneGeometry {
        aggregates: vec![
            vec![geometry(ball)].into(),
            Aggregate { geometries: vec![], instances: vec![instance(0, stretch)] },
        ],
        instances: vec![instance(1, turn)],
        ..SceneGeometry::default()
    };
    // In the world: x^2 / 4 + y^2 + z^2 = 1, of which the gradient at (x, y) is (x / 4, y).
    let ray = Ray::new(Vec3::new(1.2, 5.0, 0.0), -Vec3::Y);
    let accel = build(AccelKind::Bvh2, &scene);
    let normal = accel.normal(&ray, &closest(&accel, &ray).unwrap()).unwrap();
    assert!((normal - DVec3::new(0.3, 0.8, 0.0).normalize()).length() < 1e-6, "{normal}");
}
