//! Rays that leave a surface never meet it again where they left it: at any size, near the origin and far from it.

use crate::shapes_cases::{Case, Random, Target, cases, similarity};
use kirkas_accel::AccelKind;
use kirkas_geometry::rounding::offset_origin;
use kirkas_geometry::{DAffine3, DVec3, Ray};

#[test]
fn no_ray_meets_again_the_place_it_left() {
    for case in cases() {
        for scale in [1e-6, 1.0, 1e6] {
            for away in [0.0, 1e4] {
                let far = DVec3::new(0.7, -0.3, 0.6) * (away * scale);
                for m in [
                    similarity(scale, far),
                    DAffine3::from_scale_rotation_translation(DVec3::splat(scale), Default::default(), far),
                ] {
                    check_departures(&case, &m, scale, away);
                }
            }
        }
    }
}

fn check_departures(case: &Case, m: &DAffine3, scale: f64, away: f64) {
    let label = format!("{} at scale {scale}, {away} sizes away", case.label());
    let (center, radius) = case.ball(m);
    let target = Target::new(case.build(*m).unwrap(), AccelKind::Bvh2);
    let mut random = Random(31);
    let (mut departures, mut odd) = (0, 0);
    for _ in 0..1500 {
        let ray = random.line(center, radius);
        let Some(hit) = target.closest(&ray) else { continue };
        let s = target.point(&hit, &ray);
        for outward in [true, false] {
            let d = random.direction();
            // Half of them nearly along the surface.
            let d = if random.number() < 0.5 { (d - s.normal * d.dot(s.normal) * 0.999).normalize() } else { d };
            let d = if (d.dot(s.normal) > 0.0) == outward { d } else { -d };
            let d32 = d.as_vec3();
            let leaving = d32.as_dvec3().dot(s.normal);
            if leaving == 0.0 {
                continue;
            }
            let next = Ray::new(offset_origin(s.position, s.error, s.normal, d32.as_dvec3()), d32);
            departures += 1;
            let hits = target.all(&next);
            let same_side_again = hits.first().is_some_and(|h| {
                let p = target.point(h, &next);
                let near = (p.position - s.position).length() < 0.01 * radius;
                let same = h.geometry == hit.geometry && h.primitive == hit.primitive;
                same && near && p.normal.dot(s.normal) > 0.9 && p.normal.dot(d) * leaving > 0.0
            });
            assert!(!same_side_again, "{label}: left {s:?} by {next:?}, met it again: {:?}", hits[0]);
            if case.closed && hits.len() % 2 == usize::from(outward) {
                odd += 1;
            }
        }
    }
    // Within a rounding of an edge the other side of the edge may be the nearer one: common far away, a chance hit near by.
    let allowed = if away == 0.0 { 1 } else { departures / 50 };
    assert!(departures > 20 && odd <= allowed, "{label}: {odd} of {departures} leaks");
}

/// A floor as large as the world must not push rays away from what stands on it.
#[test]
fn a_level_floor_costs_no_height() {
    let entity = kirkas_scene::Entity::new("floor", "plane", kirkas_scene::Map::default());
    let target = Target::new(crate::shapes_cases::build(&entity, DAffine3::IDENTITY).unwrap(), AccelKind::Bvh2);
    let ray = Ray::new(kirkas_geometry::Vec3::new(900.0, 5.0, 0.0), kirkas_geometry::Vec3::new(0.3, -1.0, 0.1));
    let s = target.point(&target.closest(&ray).unwrap(), &ray);
    assert!(s.normal.abs().dot(s.error) < 1e-9);
}
