//! A ray that starts on a surface, moved off it by the error bound of the point, never meets that surface again.

use crate::common::{Random, build, closest, triangles, world};
use crate::solids::{curve, cylinder, disk};
use kirkas_accel::{AccelKind, Shape, Sphere};
use kirkas_geometry::rounding::{gamma, offset_origin};
use kirkas_geometry::{DVec3, Ray, Vec3};
use std::sync::Arc;

#[test]
fn a_plane_of_triangles_is_left_for_good() {
    for (seed, scale) in [(1, 1e-6_f32), (2, 1.0), (3, 1e6)] {
        let r = &mut Random::new(seed);
        for _ in 0..200 {
            // A tilted parallelogram, cut into two triangles, somewhere.
            let (p, a, b) = (r.cube() * 3.0 * scale, r.cube() * scale, r.cube() * scale);
            // On a coarse grid, so that its four corners are exactly coplanar.
            let snap = |v: Vec3| (v * (1024.0 / scale)).round() * (scale / 1024.0);
            let (p, a, b) = if scale == 1.0 { (snap(p), snap(a), snap(b)) } else { (p, a, b) };
            let corners = [[p, p + a, p + a + b], [p, p + a + b, p + b]];
            let accel = build(AccelKind::Bvh2, &world(vec![triangles(&corners)]));
            let own = usize::from(scale != 1.0);
            for _ in 0..300 {
                let k = (r.below(2)) as usize;
                let [v0, v1, v2] = corners[k];
                let (mut u, mut v) = (r.unit(), r.unit());
                if u + v > 1.0 {
                    (u, v) = (1.0 - u, 1.0 - v);
                }
                let point = v0 * (1.0 - u - v) + v1 * u + v2 * v;
                let error =
                    ((v0 * (1.0 - u - v)).abs() + (v1 * u).abs() + (v2 * v).abs()).as_dvec3() * f64::from(gamma(7));
                let normal = (v1 - v0).as_dvec3().cross((v2 - v0).as_dvec3()).normalize();
                let mut direction = r.cube();
                if r.below(4) == 0 {
                    // Grazing.
                    direction =
                        (v1 - v0) / scale * (r.unit() - 0.5) + (v2 - v0) / scale * (r.unit() - 0.5) + direction * 1e-6;
                }
                let origin = offset_origin(point.as_dvec3(), error, normal, direction.as_dvec3());
                let hit = closest(&accel, &Ray::new(origin, direction));
                // Where rounding leaves the corners not quite coplanar, only the own triangle counts.
                let again = hit.filter(|h| own == 0 || h.primitive as usize == k);
                assert_eq!(again, None, "scale {scale}: {corners:?} from {origin:?} along {direction:?}");
            }
        }
    }
}

#[test]
fn a_sphere_is_left_for_good_and_met_on_its_far_side() {
    for (seed, scale) in [(4, 1e-6_f32), (5, 1.0), (6, 1e6)] {
        let r = &mut Random::new(seed);
        for _ in 0..20_000 {
            let ball = Sphere { center: r.cube() * 3.0 * scale, radius: (r.unit() + 0.01) * scale };
            let accel = build(AccelKind::Bvh2, &world(vec![Shape::Spheres(Arc::new(vec![ball]))]));
            let normal = r.cube().as_dvec3().normalize();
            let point: DVec3 = ball.center.as_dvec3() + normal * f64::from(ball.radius);
            let error = point.as_vec3().abs().as_dvec3() * f64::from(gamma(5));
            let direction = r.cube();
            let origin = offset_origin(point, error, normal, direction.as_dvec3());
            let hit = closest(&accel, &Ray::new(origin, direction));
            if direction.as_dvec3().dot(normal) > 0.0 {
                assert_eq!(hit, None);
            } else {
                let chord = -2.0 * f64::from(ball.radius) * direction.as_dvec3().dot(normal)
                    / direction.as_dvec3().length_squared();
                // A chord's end moves by as much as sqrt(8 r h) when its start moves by h.
                let radius = f64::from(ball.radius);
                let slack = 1e-6 * radius + 6.0 * (radius * error.max_element()).sqrt() + 9.0 * error.max_element();
                if let Some(h) = hit {
                    assert!((f64::from(h.t) - chord).abs() * f64::from(direction.length()) < slack);
                } else {
                    assert!(chord < slack);
                }
            }
        }
    }
}

#[test]
fn disks_cylinders_and_curves_are_left_for_good() {
    for (seed, scale) in [(8, 1e-6_f32), (9, 1.0), (10, 1e6)] {
        let r = &mut Random::new(seed);
        for _ in 0..20_000 {
            let (a, b) = (r.cube() * 3.0 * scale, r.cube() * scale);
            let (thin, thick) = ((0.01 + 0.3 * r.unit()) * scale, (0.01 + r.unit()) * scale);
            let axis = (b - a).as_dvec3();
            let side = axis.cross(r.cube().as_dvec3()).normalize();
            let along = f64::from(r.unit());
            let sine = f64::from(thick - thin) / axis.length();
            let (shape, point, normal) = match r.below(3) {
                0 => (disk(a, b - a, thick), a.as_dvec3() + side * (f64::from(thick) * along), axis.normalize()),
                1 => (cylinder(a, b, thick), a.as_dvec3() + axis * along + side * f64::from(thick), side),
                _ if sine.abs() < 1.0 => {
                    let normal = side * (1.0 - sine * sine).sqrt() - axis * (sine / axis.length());
                    let radius = f64::from(thin) + f64::from(thick - thin) * along;
                    (curve(&[(a, thin), (b, thick)]), a.as_dvec3() + axis * along + normal * radius, normal)
                }
                _ => continue,
            };
            let is_flat = matches!(shape, Shape::Disks(_));
            let accel = build(AccelKind::Bvh2, &world(vec![shape]));
            let error = (point.abs() + axis.abs()) * f64::from(gamma(5));
            let mut direction = r.cube();
            if r.below(4) == 0 {
                direction = (side.cross(normal) + normal * f64::from(r.unit() * 1e-4)).as_vec3();
            }
            let origin = offset_origin(point, error, normal, direction.as_dvec3());
            if is_flat || direction.as_dvec3().dot(normal) > 0.0 {
                assert_eq!(closest(&accel, &Ray::new(origin, direction)), None, "{scale} {a} {b} {thin} {thick}");
            }
        }
    }
}

#[test]
fn a_ray_from_a_vertex_does_not_meet_that_vertex() {
    let r = &mut Random::new(7);
    for _ in 0..30_000 {
        let corners = [r.cube(), r.cube(), r.cube() * 100.0];
        let accel = build(AccelKind::BruteForce, &world(vec![triangles(&[corners])]));
        for corner in corners {
            let ray = Ray::new(corner, r.cube());
            assert_eq!(closest(&accel, &ray), None, "{corners:?} {ray:?}");
        }
    }
}
