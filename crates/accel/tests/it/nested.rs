//! Instances of instances against the same things placed one by one.

use crate::common::*;
use kirkas_accel::*;
use kirkas_geometry::transform::rotation;
use kirkas_geometry::{AnimatedTransform, DAffine3, DMat3, DVec3, Ray, Vec3};
use std::sync::Arc;

fn placement(r: &mut Random) -> DAffine3 {
    let size = DVec3::new(0.3 + f64::from(r.unit()), 0.7, -0.3 - f64::from(r.unit()));
    let turn = rotation(r.cube().as_dvec3() + 2.0, f64::from(r.unit()) * 360.0);
    DAffine3 { matrix3: turn * DMat3::from_diagonal(size), translation: r.cube().as_dvec3() * 2.0 }
}

fn instances(r: &mut Random, aggregates: u32) -> Vec<Instance> {
    let one = |r: &mut Random| {
        let first = placement(r);
        let outer_from_object = match r.below(3) {
            0 => AnimatedTransform::from_keys(&[(0.0, first), (1.0, placement(r))]).unwrap(),
            _ => AnimatedTransform::still(first),
        };
        Instance {
            aggregate: r.below(aggregates) as usize,
            outer_from_object,
            mask: [u32::MAX, 3][r.below(2) as usize],
        }
    };
    (0..3).map(|_| one(r)).collect()
}

fn geometries(r: &mut Random) -> Vec<Geometry> {
    let corners = |r: &mut Random| {
        let p = r.cube();
        [p, p + r.cube() * 0.7, p + r.cube() * 0.7]
    };
    let soup: Vec<_> = (0..12).map(|_| corners(r)).collect();
    let balls = (0..3).map(|_| Sphere { center: r.cube(), radius: 0.2 * r.unit() }).collect();
    let all = [triangles(&soup), Shape::Spheres(Arc::new(balls))];
    all.map(|shape| Geometry { mask: [u32::MAX, 6][r.below(2) as usize], ..geometry(shape) }).into()
}

/// Four levels: each aggregate places those before it.
fn nested(r: &mut Random) -> SceneGeometry {
    let mut aggregates: Vec<Aggregate> = vec![geometries(r).into()];
    for held in 1..4 {
        aggregates.push(Aggregate { geometries: geometries(r), instances: instances(r, held) });
    }
    SceneGeometry { world: geometries(r), aggregates, instances: instances(r, 4), shutter: (0.0, 1.0) }
}

/// Places every aggregate's own geometry straight into the world, in the order of the paths.
fn flatten(
    nested: &SceneGeometry,
    list: &[Instance],
    outer: Option<(&AnimatedTransform, u32, &[u32])>,
    flat: &mut Vec<(Instance, InstancePath)>,
) {
    for (i, instance) in list.iter().enumerate() {
        let (mut placed, mut path) = (instance.clone(), vec![i as u32]);
        if let Some((motion, mask, before)) = outer {
            placed.outer_from_object = instance.outer_from_object.within(motion);
            placed.mask &= mask;
            path = [before, &path].concat();
        }
        let inner = Some((&placed.outer_from_object, placed.mask, &path[..]));
        flatten(nested, &nested.aggregates[instance.aggregate].instances, inner, flat);
        flat.push((placed, InstancePath::new(&path).unwrap()));
    }
}

#[test]
fn nested_instances_equal_flattened_ones_to_the_bit() {
    let (mut hits, mut deep) = (0, 0);
    for seed in 0..30 {
        let r = &mut Random::new(seed);
        let scene = nested(r);
        let mut places = Vec::new();
        flatten(&scene, &scene.instances, None, &mut places);
        let mut flat = scene.clone();
        flat.instances = places.iter().map(|p| p.0.clone()).collect();
        flat.aggregates.iter_mut().for_each(|a| a.instances.clear());
        let flat = build(AccelKind::BruteForce, &flat);
        let all = AccelKind::ALL.map(|(kind, _)| build(kind, &scene));
        for _ in 0..300 {
            let origin = r.cube() * 3.0;
            let mask = [u32::MAX, 1, 2, 4][r.below(4) as usize];
            let ray = Ray { time: r.unit(), mask, ..Ray::new(origin, r.cube() - origin) };
            let expected = closest(&flat, &ray).map(|h| match h.instance.is_world() {
                true => h,
                false => Hit { instance: places[h.instance.outermost() as usize].1, ..h },
            });
            for accel in &all {
                assert_eq!(bits(closest(accel, &ray)), bits(expected), "{:?} {ray:?}", accel.kind());
                assert_eq!(accel.any_hit(&ray, Query::ALL, 0, &mut Counters::default()), expected.is_some());
            }
            hits += usize::from(expected.is_some());
            deep += usize::from(expected.is_some_and(|h| h.instance.len() > 2));
        }
    }
    assert!(hits > 2000 && deep > 300, "{hits}, {deep}");
}

#[test]
fn a_small_thing_deep_in_a_large_world_is_hit_to_its_own_precision() {
    let corners = [Vec3::new(-1.0, -1.0, 0.0), Vec3::new(1.0, -1.0, 0.0), Vec3::new(-1.0, 1.0, 0.0)];
    let place = |x: f64, y: f64| {
        let m = DAffine3 { matrix3: rotation(DVec3::Z, 30.0), translation: DVec3::new(x, y, 1e6 / 3.0) };
        AnimatedTransform::still(m)
    };
    let instance =
        |aggregate, m: &AnimatedTransform| Instance { aggregate, outer_from_object: m.clone(), mask: u32::MAX };
    let (outer, middle, inner) = (place(1e6 + 0.1, -3e5 / 7.0), place(-7e5 / 3.0, 9e5 / 7.0), place(0.123, 1e5 / 9.0));
    let scene = SceneGeometry {
        aggregates: vec![
            vec![geometry(triangles(&[corners]))].into(),
            Aggregate { geometries: vec![], instances: vec![instance(0, &inner)] },
            Aggregate { geometries: vec![], instances: vec![instance(1, &middle)] },
        ],
        instances: vec![instance(2, &outer)],
        ..SceneGeometry::default()
    };
    let world_from_object = outer.at(0.0) * middle.at(0.0) * inner.at(0.0);
    let r = &mut Random::new(4);
    for (kind, _) in AccelKind::ALL {
        let accel = build(kind, &scene);
        for _ in 0..500 {
            // Aim at a point of the triangle from a few units away; f32 moves the ray, so where it goes is asked in f64.
            let target = DVec3::new(-0.9 + 0.8 * f64::from(r.unit()), -0.9 + 0.8 * f64::from(r.unit()), 0.0);
            let target = world_from_object.transform_point3(target);
            let way = DVec3::new(f64::from(r.unit()) - 0.5, f64::from(r.unit()) - 0.5, -1.0);
            let ray = Ray::new((target - way * 3.0).as_vec3(), way.as_vec3());
            let object = world_from_object.inverse();
            let (o, d) =
                (object.transform_point3(ray.origin.as_dvec3()), object.transform_vector3(ray.direction.as_dvec3()));
            let t = -o.z / d.z;
            let p = o + d * t;
            let Some(hit) = closest(&accel, &ray) else {
                assert!(p.x < -0.99 || p.y < -0.99 || p.x + p.y > -0.01, "missed at {p}");
                continue;
            };
            let off =
                [f64::from(hit.t) - t, f64::from(hit.u) - (p.x + 1.0) / 2.0, f64::from(hit.v) - (p.y + 1.0) / 2.0];
            assert!(off.iter().all(|x| x.abs() < 3e-6), "{off:?} at {ray:?}");
        }
    }
}

#[test]
fn what_cannot_be_nested_is_an_error_that_names_it() {
    let instance = |aggregate| Instance {
        aggregate,
        outer_from_object: AnimatedTransform::still(DAffine3::IDENTITY),
        mask: u32::MAX,
    };
    let holding = |held: &[usize]| Aggregate {
        geometries: vec![geometry(Shape::Spheres(Arc::new(vec![Sphere { center: Vec3::ZERO, radius: 1.0 }])))],
        instances: held.iter().map(|&a| instance(a)).collect(),
    };
    let built = |aggregates: &[&[usize]], placed: usize| {
        let aggregates = aggregates.iter().map(|held| holding(held)).collect();
        let scene = SceneGeometry { aggregates, instances: vec![instance(placed)], ..SceneGeometry::default() };
        Accel::build(AccelKind::Bvh2, scene, &Serial).map(|_| ()).map_err(|e| e.to_string())
    };
    assert_eq!(built(&[&[0]], 0), Err("aggregate 0 holds an instance of itself".into()));
    assert_eq!(built(&[&[], &[0, 3], &[1], &[0, 2]], 0), Err("aggregate 1 holds an instance of itself".into()));
    assert_eq!(built(&[&[], &[0, 0], &[1, 0], &[2, 2]], 3), Ok(()), "four deep");
    let text = "instance 0 holds instances 5 deep, itself counted; the limit is 4";
    assert_eq!(built(&[&[], &[0, 0], &[1, 0], &[2, 2], &[3]], 4), Err(text.into()));
    assert_eq!(built(&[&[], &[7]], 0), Err("instance 0 in aggregate 1 places aggregate 7, but there are 2".into()));
}
