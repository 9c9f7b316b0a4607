//! Small hostile scenes that shrink to a readable counterexample.

use crate::common::{assert_agreement, triangles, world};
use kirkas_accel::{Shape, Sphere};
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

fn corners() -> impl Strategy<Value = [Vec3; 3]> {
    prop_oneof![
        3 => [point(), point(), point()],
        2 => [point(), point()].prop_map(|[a, b]| [a, a + Vec3::X, b]),
        1 => [point(), point()].prop_map(|[a, b]| [a, b, a * 0.5 + b * 0.5]),
    ]
}

proptest! {
    #![proptest_config(ProptestConfig {
        cases: 3000, failure_persistence: None, rng_seed: RngSeed::Fixed(6837), ..ProptestConfig::default()
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
}
