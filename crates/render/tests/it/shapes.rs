//! Every listed shape against what its surface must be: points on it, normals by finite differences, texture coordinates
//! by their derivatives, crossings that alternate.

use crate::shapes_cases::{Case, Random, Target, cases, is_refused, transforms};
use kirkas_accel::AccelKind;
use kirkas_geometry::{DAffine3, DVec3, Ray};
use kirkas_render::shapes::{COMMON, SHAPES, SurfacePoint};

fn for_each_case(mut check: impl FnMut(&Case, &str, &DAffine3, &Target, &str)) {
    for case in cases() {
        for (name, transform) in transforms() {
            if is_refused(&case, name) {
                assert_eq!(case.build(transform).err().unwrap().code, "uneven-scale");
                continue;
            }
            let target = Target::new(case.build(transform).unwrap(), AccelKind::BruteForce);
            check(&case, name, &transform, &target, &format!("{} under {name}", case.label()));
        }
    }
}

#[test]
fn every_listed_shape_has_a_case_and_a_manual_head() {
    for shape in SHAPES {
        let name = shape.spec.name;
        assert!(cases().iter().any(|c| c.type_name == name), "no case for {name}");
        let path = format!("{}/src/shapes/{name}.rs", source_root());
        let text = std::fs::read_to_string(path).unwrap();
        let head: Vec<&str> = text.lines().take_while(|l| l.starts_with("//!")).collect();
        assert_eq!(head[0], format!("//! # {name}"));
        for title in ["Parameters", "Example", "Limits", "References"] {
            assert!(head.contains(&format!("//! ## {title}").as_str()), "{name} lacks {title}");
        }
        let head = head.join("\n");
        assert!(head.contains(&format!("//! type = \"{name}\"")));
        for row in shape.spec.params {
            assert!(head.contains(&format!("//! - `{}` (", row.name)), "{name} does not explain `{}`", row.name);
            assert!(!COMMON.iter().any(|c| c.name == row.name));
        }
    }
}

fn source_root() -> String {
    let root = std::path::Path::new(file!()).parent().unwrap().join("../..");
    if root.join("src/shapes").exists() {
        return root.to_string_lossy().into_owned();
    }
    env!("CARGO_MANIFEST_DIR").into()
}

#[test]
fn hits_lie_on_the_ray_in_the_bounds_and_face_outward() {
    for_each_case(|case, _, transform, target, label| {
        let (center, radius) = case.ball(transform);
        let mut random = Random(1);
        let mut hit_count = 0;
        for i in 0..3000 {
            let from_inside = i % 3 == 0;
            let mut ray = random.line(center, radius);
            if from_inside {
                ray.origin = random.within(center, radius).as_vec3();
            }
            // Any length of direction will do.
            ray.direction *= [1.0, 0.01, 300.0][i % 3];
            let hits = target.all(&ray);
            hit_count += hits.len();
            let mut outside = hits.len() % 2 == 0;
            assert!(!case.closed || from_inside || outside, "{label}: {} crossings from outside", hits.len());
            let length = f64::from(ray.direction.length());
            for hit in &hits {
                assert!(hit.t > 0.0);
                let s = target.point(hit, &ray);
                let along = ray.origin.as_dvec3() + ray.direction.as_dvec3() * f64::from(hit.t);
                let cosine = s.normal.dot(ray.direction.as_dvec3()) / length;
                // Triangles are hit where their barycentric coordinates say, which slips along the plane.
                let slip = if is_user(case) { 1.0 } else { 1.0 / cosine.abs().max(1e-3) };
                let tolerance = 4e-7 * slip * (f64::from(hit.t) * length + s.position.length() + radius);
                assert!((s.position - along).length() < tolerance, "{label}: {s:?} is not at {along}");
                check_point(&s, target.parts[hit.geometry as usize].surface.bounds(), label);
                let object = transform.inverse().transform_point3(s.position);
                assert!((object - s.object_position).length() < 1e-12 * (1.0 + object.length() + radius));
                if case.closed {
                    assert!(if outside { cosine < 0.0 } else { cosine > 0.0 }, "{label}: wrong side out at {s:?}");
                    outside = !outside;
                }
            }
        }
        assert!(hit_count > 40, "{label}: only {hit_count} hits");
    });
}

fn check_point(s: &SurfacePoint, bounds: kirkas_geometry::Bounds3, label: &str) {
    assert!((s.normal.length() - 1.0).abs() < 1e-12 && (s.shading_normal.length() - 1.0).abs() < 1e-12, "{label}");
    // Interpolated normals of sharp corners may lean over the horizon where an uneven map made them sharper still.
    let may_lean = label.starts_with("mesh") && label.ends_with("uneven");
    assert!(may_lean || s.shading_normal.dot(s.normal) > 0.0, "{label}: {s:?}");
    assert!(s.error.min_element() >= 0.0 && s.error.is_finite());
    assert!(
        s.tangent.dot(s.normal).abs() <= 1e-6 * s.tangent.length(),
        "{label}: tangent {} leaves the surface",
        s.tangent
    );
    let slack = s.error * 2.0;
    let inside =
        s.position.cmpge(bounds.min.as_dvec3() - slack).all() && s.position.cmple(bounds.max.as_dvec3() + slack).all();
    assert!(inside, "{label}: {} is outside {bounds:?}", s.position);
    if !label.starts_with("plane") {
        assert!(s.uv.iter().all(|x| (0.0..=1.0).contains(x)), "{label}: uv {:?}", s.uv);
    }
}

#[test]
fn bounds_are_tight() {
    for_each_case(|case, _, transform, target, label| {
        if case.type_name == "plane" {
            return;
        }
        let (center, radius) = case.ball(transform);
        let mut random = Random(2);
        let mut reached = kirkas_geometry::Bounds3::EMPTY;
        for _ in 0..20_000 {
            let ray = random.line(center, radius);
            for hit in target.all(&ray) {
                reached = reached.with_point(target.point(&hit, &ray).position.as_vec3());
            }
        }
        let bounds = target.parts.iter().fold(kirkas_geometry::Bounds3::EMPTY, |b, p| b.union(p.surface.bounds()));
        let loose = (bounds.extent() - reached.extent()).max_element();
        assert!(loose < 0.12 * radius as f32, "{label}: {bounds:?} around {reached:?}");
    });
}

/// Two neighbouring hits: their chord is at right angles to the mean of their normals, and differs as the tangents and
/// texture coordinates say.
#[test]
fn normals_and_tangents_are_those_of_the_surface() {
    let mut tangents_of = std::collections::BTreeMap::new();
    for_each_case(|case, transform_name, transform, target, label| {
        let (center, radius) = case.ball(transform);
        let mut random = Random(3);
        let (mut checked, mut tangents) = (0, 0);
        for _ in 0..4000 {
            let ray = random.line(center, radius);
            let Some(hit) = target.closest(&ray) else { continue };
            let s = target.point(&hit, &ray);
            if s.normal.dot(ray.direction.as_dvec3()).abs() < 0.2 {
                continue;
            }
            let neighbour = |random: &mut Random| {
                let moved = ray.origin.as_dvec3() + random.direction() * (3e-4 * radius);
                let ray = Ray::new(moved.as_vec3(), ray.direction);
                let other = target.closest(&ray)?;
                let o = target.point(&other, &ray);
                let same = other.primitive == hit.primitive && other.geometry == hit.geometry && other.u == hit.u;
                let same = same || other.primitive == hit.primitive && !is_user(case);
                (same && o.normal.dot(s.normal) > 0.99).then_some(o)
            };
            let (Some(a), Some(b)) = (neighbour(&mut random), neighbour(&mut random)) else { continue };
            checked += 1;
            for o in [&a, &b] {
                let chord = o.position - s.position;
                let bend = (o.normal - s.normal).length();
                let slip = chord.dot(o.normal + s.normal).abs();
                assert!(slip <= 0.05 * chord.length() * bend + 1e-9 * radius, "{label}: {s:?} and {o:?}");
            }
            tangents += check_tangent(&s, &a, &b, transform_name, label) as usize;
        }
        assert!(checked > 10, "{label}: only {checked} pairs");
        *tangents_of.entry(case.type_name).or_insert(0) += tangents;
    });
    assert!(tangents_of.values().all(|n| *n > 20) && tangents_of.len() == SHAPES.len(), "{tangents_of:?}");
}

fn is_user(case: &Case) -> bool {
    !matches!(case.type_name, "sphere" | "sphereflake" | "rectangle" | "triangle" | "mesh")
}

/// False where the three points say nothing about derivatives: across a seam, near a pole, nearly on a line.
fn check_tangent(s: &SurfacePoint, a: &SurfacePoint, b: &SurfacePoint, transform: &str, label: &str) -> bool {
    let d = |o: &SurfacePoint| (f64::from(o.uv[0]) - f64::from(s.uv[0]), f64::from(o.uv[1]) - f64::from(s.uv[1]));
    let (da, db) = (d(a), d(b));
    let determinant = da.0 * db.1 - da.1 * db.0;
    let sizes = (da.0.hypot(da.1), db.0.hypot(db.1));
    if sizes.0 > 0.02 || sizes.1 > 0.02 || determinant.abs() < 0.3 * sizes.0 * sizes.1 || sizes.0.min(sizes.1) < 2e-5 {
        return false;
    }
    let (pa, pb) = (a.position - s.position, b.position - s.position);
    let by_u = (pa * db.1 - pb * da.1) / determinant;
    let by_v = (pb * da.0 - pa * db.0) / determinant;
    let pole = by_u.length().min(by_v.length()) < 0.1 * by_u.length().max(by_v.length());
    if pole {
        return false;
    }
    assert!((by_u - s.tangent).length() < 0.15 * by_u.length(), "{label}: {by_u} against {s:?}");
    if transform != "mirror" && !label.starts_with("mesh") {
        assert!(by_u.cross(by_v).dot(s.normal) > 0.0, "{label}: texture mirrored at {s:?}");
    }
    true
}

#[test]
fn a_mesh_is_split_by_material_and_the_rest_has_none() {
    let case = cases().into_iter().find(|c| c.params.get("file").is_some()).unwrap();
    let parts = case.build(DAffine3::IDENTITY).unwrap();
    let found: Vec<_> = parts.iter().map(|p| (p.own_material.as_deref(), p.shape.len())).collect();
    assert_eq!(found, [(Some("red"), 1), (None, 1), (Some("blue"), 2)]);
}

/// Torus crossings against a march along the ray with 20,000 steps.
#[test]
fn no_torus_crossing_is_missed_or_invented() {
    let (major, minor) = (1.0, 0.25);
    let case = cases().into_iter().find(|c| c.type_name == "torus").unwrap();
    let target = Target::new(case.build(DAffine3::IDENTITY).unwrap(), AccelKind::BruteForce);
    // About the y axis.
    let distance = |p: DVec3| (p.x.hypot(p.z) - major).hypot(p.y) - minor;
    let mut random = Random(4);
    for i in 0..400 {
        let ray = random.line(DVec3::ZERO, 1.3);
        let hits = target.all(&ray);
        let at = |t: f64| distance(ray.origin.as_dvec3() + ray.direction.as_dvec3() * t);
        let steps: Vec<f64> = (0..=20_000).map(|k| at(5.2 * f64::from(k) / 20_000.0)).collect();
        let crossings = steps.windows(2).filter(|w| (w[0] < 0.0) != (w[1] < 0.0)).count();
        let grazing = hits.windows(2).any(|w| w[1].t - w[0].t < 1e-3);
        assert!(grazing || hits.len() == crossings, "ray {i}: {hits:?}, marched {crossings}");
        for hit in hits {
            assert!(at(f64::from(hit.t)).abs() < 1e-6);
        }
    }
}
