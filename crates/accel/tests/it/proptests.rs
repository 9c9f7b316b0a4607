//! Small hostile scenes that shrink to a readable counterexample.

use crate::common::{assert_agreement, build, triangles, world};
use kirkas_accel::*;
use kirkas_geometry::{Ray, Vec3};
use proptest::prelude::*;
use proptest::test_runner::RngSeed;
use std::sync::Arc;

fn coordinate() -> impl Strategy<Value = f32> {
    prop_oneof![
        6 => (-4_i8..=4).prop_map(f32::from),
        1 => Just(-0.0),
        3 => -4.0_f32..4.0,
        1 => (-4.0_f32..4.0).prop_map(|x| x * 1e-6),
        1 => (-4.0_f32..4.0).prop_map(|x| x * 1e6),
        1 => prop_oneof![Just(1e-38_f32), Just(-1e-42), Just(3e38), Just(-1e30)],
    ]
}

fn point() -> impl Strategy<Value = Vec3> {
    (coordinate(), coordinate(), coordinate()).prop_map(|(x, y, z)| Vec3::new(x, y, z))
}

fn radius() -> impl Strategy<Value = f32> {
    prop_oneof![2 => 0.0_f32..2.0, 1 => Just(0.0), 1 => Just(1.0), 1 => coordinate().prop_map(f32::abs)]
}

fn corners() -> impl Strategy<Value = [Vec3; 3]> {
    prop_oneof![
        3 => [point(), point(), point()],
        2 => [point(), point()].prop_map(|[a, b]| [a, a + Vec3::X, b]),
        1 => [point(), point()].prop_map(|[a, b]| [a, b, a * 0.5 + b * 0.5]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 1200, failure_persistence: None, rng_seed: RngSeed::Fixed(6837), ..ProptestConfig::default()
    })]

    #[test]
    fn the_tree_equals_brute_force(
        soup in prop::collection::vec(corners(), 1..40),
        balls in prop::collection::vec((point(), 0.0_f32..3.0), 0..6),
        copies in 1_usize..4,
        rays in prop::collection::vec((point(), point(), 0_usize..120, any::<bool>()), 1..30),
    ) {
        let soup: Vec<[Vec3; 3]> = soup.iter().cycle().take(soup.len() * copies).copied().collect();
        let finite = |p: &Vec3| p.is_finite();
        prop_assume!(soup.iter().flatten().all(finite));
        let vertices = soup.concat();
        let spheres = balls.iter().map(|&(center, radius)| Sphere { center, radius }).collect();
        let scene = world(vec![triangles(&soup), Shape::Spheres(Arc::new(spheres))]);
        let aimed = |&(origin, direction, vertex, aim): &(Vec3, Vec3, usize, bool)| {
            Ray::new(origin, if aim { vertices[vertex % vertices.len()] - origin } else { direction })
        };
        let rays: Vec<Ray> = rays.iter().map(aimed).collect();
        assert_agreement(&scene, &rays);
    }

    #[test]
    fn hostile_solids_are_the_same_to_every_structure(
        points in prop::collection::vec((point(), radius()), 2..12),
        normals in prop::collection::vec(point(), 12),
        rays in prop::collection::vec((point(), point(), 0_usize..12, any::<bool>()), 1..20),
    ) {
        let normal = |i: usize| if normals[i] == Vec3::ZERO { Vec3::Z } else { normals[i] };
        let each = || points.iter().enumerate().map(|(i, &(position, radius))| (i, position, radius));
        let positions: Vec<Vec3> = points.iter().map(|p| p.0).collect();
        let disks = each().map(|(i, center, radius)| Disk { center, normal: normal(i), radius }).collect();
        let cylinders = each().map(|(i, a, radius)| Cylinder { ends: [a, normal(i)], radius }).collect();
        let curve = each().map(|(_, position, radius)| CurvePoint { position, radius }).collect();
        let n = points.len() as u32;
        let quads = (0..n).map(|i| [i, (i + 1) % n, (i + 2) % n, (i + 3) % n]).collect();
        let keys = vec![positions.clone(), normals[..positions.len()].to_vec(), positions.clone()];
        let scene = SceneGeometry { shutter: (0.0, 1.0), ..world(vec![
            Shape::Disks(Arc::new(disks)),
            Shape::Cylinders(Arc::new(cylinders)),
            Shape::Curves { points: Arc::new(curve), segments: Arc::new((0..n - 1).collect()) },
            Shape::Quads { positions: Arc::new(positions.clone()), indices: Arc::new(quads) },
            Shape::MovingTriangles { keys: Arc::new(keys), indices: Arc::new((0..n - 2).map(|i| [i, i + 1, i + 2]).collect()) },
        ]) };
        let aimed = |&(origin, direction, vertex, aim): &(Vec3, Vec3, usize, bool)| {
            let ray = Ray::new(origin, if aim { positions[vertex % positions.len()] - origin } else { direction });
            ray.at_time(vertex as f32 / 11.0)
        };
        let rays: Vec<Ray> = rays.iter().map(aimed).collect();
        assert_agreement(&scene, &rays);
        let accels = AccelKind::ALL.map(|(kind, _)| build(kind, &scene));
        for ray in &rays {
            let near = |accel: &Accel| accel.closest_point(&PointQuery { time: ray.time, ..PointQuery::new(ray.origin, f32::INFINITY) });
            let expected = near(&accels[0]).map(|h| (h.distance.to_bits(), h.id()));
            for accel in &accels {
                prop_assert_eq!(near(accel).map(|h| (h.distance.to_bits(), h.id())), expected, "{:?}", accel.kind());
                accel.all_hits(ray, Query::ALL, 0, &mut Counters::default(), &mut |hit| {
                    assert!(hit.t > ray.t_min && hit.t < ray.t_max, "{hit:?}");
                    false
                });
            }
        }
    }
}
