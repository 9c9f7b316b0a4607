//! Ends of the interval, masks, filters, batches, ties, counters, executors.

use crate::common::*;
use crate::meshes::ball;
use kirkas_accel::*;
use kirkas_geometry::{AnimatedTransform, Bounds3, DAffine3, DVec3, Ray, Vec3};
use std::sync::Arc;

fn square(z: f32) -> Shape {
    let p = |x: f32, y: f32| Vec3::new(x, y, z);
    triangles(&[[p(-1.0, -1.0), p(3.0, -1.0), p(-1.0, 3.0)]])
}

fn unit_ball() -> Shape {
    Shape::Spheres(Arc::new(vec![Sphere { center: Vec3::ZERO, radius: 1.0 }]))
}

fn down(z: f32) -> Ray {
    Ray::new(Vec3::new(0.0, 0.0, z), -Vec3::Z)
}

#[test]
fn the_interval_is_open_at_both_ends() {
    for (kind, _) in AccelKind::ALL {
        let flat = build(kind, &world(vec![square(0.0)]));
        let round = build(kind, &world(vec![unit_ball()]));
        let boxed = Boxes(vec![Bounds3::from_corners(Vec3::splat(-1.0), Vec3::splat(1.0))]);
        let boxed = build(kind, &world(vec![Shape::User(Arc::new(boxed))]));
        for (accel, first) in [(&flat, 2.0), (&round, 1.0), (&boxed, 1.0)] {
            let t = |t_min, t_max| closest(accel, &Ray { t_min, t_max, ..down(2.0) }).map(|h| h.t);
            assert_eq!(t(0.0, f32::INFINITY), Some(first));
            assert_eq!(t(0.0, first), None);
            assert_eq!(t(0.0, first.next_up()), Some(first));
            assert_eq!(t(first.next_down(), 9.0), Some(first));
            assert_ne!(t(first, 9.0), Some(first));
        }
        // From within: the far side.
        assert_eq!(closest(&round, &down(0.0)).unwrap().t, 1.0);
        assert_eq!(closest(&round, &Ray { t_min: 1.0, ..down(2.0) }).unwrap().t, 3.0);
        assert_eq!(closest(&flat, &Ray { t_min: -9.0, ..down(-2.0) }).unwrap().t, -2.0);
    }
}

#[test]
fn barycentrics_weigh_vertices_1_and_2() {
    let accel = build(AccelKind::Bvh2, &world(vec![square(0.0)]));
    let hit = closest(&accel, &Ray::new(Vec3::new(1.0, 0.0, 5.0), -Vec3::Z)).unwrap();
    assert_eq!((hit.u, hit.v, hit.instance), (0.5, 0.25, InstancePath::WORLD));
}

#[test]
fn masks_hide_geometry_and_instances() {
    for (kind, _) in AccelKind::ALL {
        let mut scene = world(vec![square(0.0), square(-1.0)]);
        scene.world[0].mask = 1;
        scene.aggregates = vec![vec![Geometry { mask: 6, ..geometry(square(1.0)) }].into()];
        let outer_from_object = AnimatedTransform::still(DAffine3::IDENTITY);
        scene.instances = vec![Instance { aggregate: 0, outer_from_object, mask: 4 }];
        let accel = build(kind, &scene);
        let t = |mask| closest(&accel, &Ray { mask, ..down(2.0) }).map(|h| h.t);
        assert_eq!((t(u32::MAX), t(1), t(2), t(4), t(0)), (Some(1.0), Some(2.0), Some(3.0), Some(1.0), None));
    }
}

struct OnlyBeyond(f32);
impl HitFilter for OnlyBeyond {
    fn accept(&self, _: usize, _: &Ray, hit: &Hit) -> bool {
        hit.t > self.0
    }
}

#[test]
fn filters_are_asked_for_what_is_not_opaque_only_and_see_every_crossing() {
    for (kind, _) in AccelKind::ALL {
        let mut scene = world(vec![unit_ball(), square(-5.0)]);
        let closest = |scene: &SceneGeometry, beyond: f32| {
            let accel = build(kind, scene);
            let (ray, filter, c) = (down(3.0), OnlyBeyond(beyond), &mut Counters::default());
            let hit = accel.closest_hit(&ray, Query::filtered(&filter), 0, c);
            assert_eq!(accel.any_hit(&ray, Query::filtered(&filter), 0, c), hit.is_some());
            hit.map(|h| h.t)
        };
        assert_eq!(closest(&scene, 9.0), Some(2.0), "opaque: not asked");
        scene.world[0].opaque = false;
        assert_eq!(closest(&scene, 1.0), Some(2.0));
        assert_eq!(closest(&scene, 3.0), Some(4.0), "the sphere's far side");
        assert_eq!(closest(&scene, 9.0), Some(8.0), "what stands behind");
        scene.world[1].opaque = false;
        assert_eq!(closest(&scene, 9.0), None);
    }
}

#[test]
fn ties_go_to_the_lowest_ids() {
    for (kind, _) in AccelKind::ALL {
        let twice = |s: Shape| vec![s.clone(), s];
        let mut scene = world(twice(triangles(&[[Vec3::ZERO, Vec3::X, Vec3::Y]; 20])));
        let ray = Ray::new(Vec3::new(0.2, 0.2, 2.0), -Vec3::Z);
        let hit = closest(&build(kind, &scene), &ray).unwrap();
        assert_eq!((hit.instance.outermost(), hit.geometry, hit.primitive), (NO_INSTANCE, 0, 0));
        scene.aggregates = vec![scene.world.clone().into()];
        let place = |z| AnimatedTransform::still(DAffine3::from_translation(DVec3::new(0.0, 0.0, z)));
        scene.instances =
            [-1.0, 0.0, 0.0].map(|z| Instance { aggregate: 0, outer_from_object: place(z), mask: u32::MAX }).into();
        let hit = closest(&build(kind, &scene), &ray).unwrap();
        assert_eq!((hit.instance.outermost(), hit.geometry, hit.primitive), (1, 0, 0));
    }
}

#[test]
fn a_batch_answers_as_single_rays_do() {
    let (positions, indices) = ball(3);
    let shape = Shape::Triangles { positions: Arc::new(positions), indices: Arc::new(indices) };
    let mut scene = world(vec![shape]);
    scene.world[0].opaque = false;
    let r = &mut Random::new(5);
    let rays: Vec<Ray> = (0..5000).map(|_| Ray::new(r.cube() * 2.0, r.cube())).collect();
    for (kind, _) in AccelKind::ALL {
        let accel = build(kind, &scene);
        let (mut hits, mut occluded) = (vec![None; rays.len()], vec![false; rays.len()]);
        let (mut batch, mut single) = (Counters::default(), Counters::default());
        accel.closest_hits(&rays, Query::filtered(&Coin), &mut hits, &mut batch);
        accel.any_hits(&rays, Query::filtered(&Coin), &mut occluded, &mut batch);
        for (i, ray) in rays.iter().enumerate() {
            assert_eq!(bits(hits[i]), bits(accel.closest_hit(ray, Query::filtered(&Coin), i, &mut single)));
            assert_eq!(occluded[i], accel.any_hit(ray, Query::filtered(&Coin), i, &mut single));
        }
        assert_eq!(batch.rays, single.rays);
        assert_eq!(batch.rays, 2 * rays.len() as u64);
        assert!(batch.primitives_tested > 0 && (kind == AccelKind::BruteForce) == (batch.nodes_visited == 0));
    }
}

#[test]
fn the_tree_does_not_depend_on_the_executor() {
    let r = &mut Random::new(9);
    let mut soup = Vec::new();
    for _ in 0..70_000 {
        let p = r.cube();
        soup.push([p, p + r.cube() * 0.01, p + r.cube() * 0.01]);
    }
    let scene = world(vec![triangles(&soup)]);
    for (kind, name) in AccelKind::ALL.into_iter().filter(|(kind, _)| *kind != AccelKind::BruteForce) {
        let serial = Accel::build(kind, scene.clone(), &Serial).unwrap();
        let threaded = Accel::build(kind, scene.clone(), &Threads).unwrap();
        threaded.validate().unwrap();
        assert_eq!(serial.statistics(), threaded.statistics());
        for _ in 0..2_000 {
            let ray = Ray::new(r.cube() * 2.0, r.cube());
            let (mut a, mut b) = (Counters::default(), Counters::default());
            let (x, y) =
                (serial.closest_hit(&ray, Query::ALL, 0, &mut a), threaded.closest_hit(&ray, Query::ALL, 0, &mut b));
            assert_eq!((bits(x), a), (bits(y), b), "{name}");
        }
    }
}

#[test]
fn moving_instances_stand_where_their_time_says() {
    for (kind, _) in AccelKind::ALL {
        let mut scene = world(vec![]);
        let at = |x| DAffine3::from_translation(DVec3::new(x, 0.0, 0.0));
        scene.aggregates = vec![vec![geometry(unit_ball())].into()];
        let outer_from_object = AnimatedTransform::from_keys(&[(0.0, at(0.0)), (2.0, at(20.0))]).unwrap();
        scene.instances = vec![Instance { aggregate: 0, outer_from_object, mask: u32::MAX }];
        scene.shutter = (0.0, 1.0);
        let accel = build(kind, &scene);
        let seen = |x: f32, time| {
            let ray = Ray::new(Vec3::new(x, 0.0, 5.0), -Vec3::Z * 2.0).at_time(time);
            closest(&accel, &ray).map(|h| h.t)
        };
        assert_eq!((seen(0.0, 0.0), seen(5.0, 0.5), seen(10.0, 1.0)), (Some(2.0), Some(2.0), Some(2.0)));
        assert_eq!((seen(0.0, 0.5), seen(10.0, 0.5), seen(10.0, 1.5)), (None, None, Some(2.0)));
        assert!(accel.bounds().contains(Vec3::new(11.0, 0.0, 0.0)));
    }
}

#[test]
fn unusable_rays_hit_nothing() {
    let bad = [
        Ray::new(Vec3::ZERO, Vec3::ZERO),
        Ray::new(Vec3::NAN, Vec3::Z),
        Ray::new(Vec3::ZERO, Vec3::splat(f32::INFINITY)),
        Ray { t_min: f32::NAN, ..down(2.0) },
        Ray { t_max: f32::NAN, ..down(2.0) },
        Ray { t_min: 3.0, t_max: 1.0, ..down(2.0) },
    ];
    for (kind, name) in AccelKind::ALL {
        let accel = build(kind, &world(vec![unit_ball(), Shape::User(Arc::new(Plane(0.0)))]));
        assert!(bad.iter().all(|ray| closest(&accel, ray).is_none()), "{name}");
    }
}

#[test]
fn an_empty_scene_is_no_special_case() {
    for (kind, _) in AccelKind::ALL {
        let mut scene = SceneGeometry { aggregates: vec![Aggregate::default()], ..world(vec![triangles(&[])]) };
        let outer_from_object = AnimatedTransform::still(DAffine3::IDENTITY);
        scene.instances = vec![Instance { aggregate: 0, outer_from_object, mask: u32::MAX }];
        let accel = build(kind, &scene);
        assert_eq!(closest(&accel, &down(2.0)), None);
        assert!(accel.bounds().is_empty());
    }
}

#[test]
fn a_tree_that_peels_off_one_by_one_stays_within_the_stack() {
    let ball = |k: i32| Sphere { center: Vec3::X * 2_f32.powi(k), radius: 2_f32.powi(k - 3) };
    let scene = world(vec![Shape::Spheres(Arc::new((-110..110).map(ball).collect()))]);
    for (kind, name) in AccelKind::ALL {
        let accel = build(kind, &scene);
        let is_deep = accel.statistics().depth > 32;
        assert!(is_deep || kind != AccelKind::Bvh2, "the test is to come near the limit");
        for k in -60..60 {
            let ray = Ray::new(Vec3::new(2_f32.powi(k), 2_f32.powi(k), 0.0), -Vec3::Y);
            assert_eq!(closest(&accel, &ray).unwrap().primitive, (k + 110) as u32, "{name}");
        }
    }
}
