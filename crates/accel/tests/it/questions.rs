//! All hits along a ray, and hits without the primitive that a ray starts on.

use crate::agreement::{ray, scene_of_everything};
use crate::common::*;
use kirkas_accel::*;
use kirkas_geometry::{Ray, Vec3};
use std::sync::Arc;

fn all(accel: &Accel, ray: &Ray, query: Query, index: usize) -> Vec<Hit> {
    let mut hits = Vec::new();
    accel.all_hits(ray, query, index, &mut Counters::default(), &mut |hit| {
        hits.push(*hit);
        false
    });
    hits
}

#[test]
fn all_hits_are_those_of_brute_force_in_order_and_once() {
    let (mut most, mut total) = (0, 0);
    for seed in 0..24 {
        let r = &mut Random::new(900 + seed);
        let (scene, corners) = scene_of_everything(r, [3, 12, 50][seed as usize % 3]);
        let accels = AccelKind::ALL.map(|(kind, _)| build(kind, &scene));
        for i in 0..150 {
            let ray = ray(r, &corners);
            let query = [Query::ALL, Query::filtered(&Coin)][i % 2];
            let expected = all(&accels[0], &ray, query, i);
            for accel in &accels {
                let got = all(accel, &ray, query, i);
                let to_bits = |hits: &[Hit]| hits.iter().map(|h| bits(Some(*h))).collect::<Vec<_>>();
                assert_eq!(to_bits(&got), to_bits(&expected), "{:?} {ray:?}", accel.kind());
                let closest = accel.closest_hit(&ray, query, i, &mut Counters::default());
                assert_eq!(got.first().map(|h| (h.t, h.id())), closest.map(|h| (h.t, h.id())), "{ray:?}");
            }
            for pair in expected.windows(2) {
                assert!((pair[0].t, pair[0].id()) <= (pair[1].t, pair[1].id()) && pair[0] != pair[1]);
            }
            most = most.max(expected.len());
            total += expected.len();
        }
    }
    assert!(most > 20 && total > 5000, "{most} {total}");
}

#[test]
fn all_hits_end_when_they_are_told_to() {
    let ball = |radius| Sphere { center: Vec3::ZERO, radius };
    let scene = world(vec![Shape::Spheres(Arc::new(vec![ball(1.0), ball(2.0), ball(3.0)]))]);
    let ray = Ray::new(Vec3::Z * 5.0, -Vec3::Z);
    for (kind, _) in AccelKind::ALL {
        let accel = build(kind, &scene);
        let ts = |most: usize| {
            let mut ts = Vec::new();
            accel.all_hits(&ray, Query::ALL, 0, &mut Counters::default(), &mut |hit| {
                ts.push((hit.t, hit.primitive));
                ts.len() == most
            });
            ts
        };
        let expected = [(2.0, 2), (3.0, 1), (4.0, 0), (6.0, 0), (7.0, 1), (8.0, 2)];
        assert_eq!((ts(9), ts(2)), (expected.to_vec(), expected[..2].to_vec()));
    }
}

#[test]
fn an_excluded_primitive_is_not_seen_by_its_ray_alone() {
    let r = &mut Random::new(77);
    let (scene, corners) = scene_of_everything(r, 40);
    let rays: Vec<Ray> = (0..2000).map(|_| ray(r, &corners)).collect();
    for (kind, _) in AccelKind::ALL {
        let accel = build(kind, &scene);
        let lists: Vec<Vec<Hit>> = rays.iter().map(|ray| all(&accel, ray, Query::ALL, 0)).collect();
        // Every second ray leaves out what it would hit first; the last ones have no entry.
        let first = |(i, hits): (usize, &Vec<Hit>)| hits.first().filter(|_| i % 2 == 0).map(Hit::id);
        let excluded: Vec<Option<PrimitiveId>> = lists.iter().enumerate().map(first).take(1500).collect();
        let query = Query::ALL.excluding(&excluded);
        let (mut hits, mut blocked) = (vec![None; rays.len()], vec![false; rays.len()]);
        accel.closest_hits(&rays, query, &mut hits, &mut Counters::default());
        accel.any_hits(&rays, query, &mut blocked, &mut Counters::default());
        let mut changed = 0;
        for (i, (ray, list)) in rays.iter().zip(&lists).enumerate() {
            let out = excluded.get(i).copied().flatten();
            let expected = list.iter().find(|h| Some(h.id()) != out);
            assert_eq!(hits[i].map(|h| (h.t, h.id())), expected.map(|h| (h.t, h.id())), "{ray:?}");
            assert_eq!(bits(hits[i]), bits(accel.closest_hit(ray, query, i, &mut Counters::default())));
            assert_eq!(blocked[i], expected.is_some());
            changed += usize::from(expected.map(Hit::id) != list.first().map(Hit::id));
        }
        assert!(changed > 200, "{changed}");
    }
}
