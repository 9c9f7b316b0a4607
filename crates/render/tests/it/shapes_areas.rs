//! Areas and points for light sampling, against lines: uniform lines cross a surface in uniform points, twice its area
//! over the ball's times on average (Crofton).

use crate::shapes_cases::{Case, Random, Target, cases, is_refused, similarity, transforms};
use kirkas_accel::AccelKind;
use kirkas_geometry::{DAffine3, DVec3, Ray};
use kirkas_render::shapes::{Detail, Surface};
use kirkas_scene::Map;
use std::f64::consts::{PI, TAU};

#[test]
fn areas_are_those_of_closed_forms() {
    for case in cases() {
        let total = |m: DAffine3| case.build(m).unwrap().iter().map(|p| p.surface.area()).sum::<Option<f64>>();
        let area = total(DAffine3::IDENTITY);
        assert_eq!(area.is_none(), case.type_name == "plane");
        if let (Some(area), Some(expected)) = (area, case.area) {
            assert!((area / expected - 1.0).abs() < 1e-6, "{}: {area} against {expected}", case.label());
            let scaled = total(similarity(1e3, DVec3::ONE)).unwrap();
            assert!((scaled / expected / 1e6 - 1.0).abs() < 1e-6, "{}", case.label());
        }
    }
}

/// Sums of a point's coordinates and their products, to compare two samplers.
#[derive(Default)]
struct Moments {
    n: f64,
    sum: [f64; 9],
    sum_of_squares: [f64; 9],
}

impl Moments {
    fn add(&mut self, p: DVec3) {
        self.n += 1.0;
        let terms = [p.x, p.y, p.z, p.x * p.x, p.y * p.y, p.z * p.z, p.x * p.y, p.y * p.z, p.z * p.x];
        for (i, x) in terms.into_iter().enumerate() {
            self.sum[i] += x;
            self.sum_of_squares[i] += x * x;
        }
    }

    fn mean_and_variance(&self, i: usize) -> (f64, f64) {
        let mean = self.sum[i] / self.n;
        (mean, (self.sum_of_squares[i] / self.n - mean * mean).max(0.0) / self.n)
    }
}

#[test]
fn sampled_points_lie_on_the_surface_and_are_uniform_by_area() {
    for case in cases() {
        for (name, transform) in transforms() {
            if is_refused(&case, name) {
                continue;
            }
            let target = Target::new(case.build(transform).unwrap(), AccelKind::BruteForce);
            let areas: Option<Vec<f64>> = target.parts.iter().map(|p| p.surface.area()).collect();
            let Some(areas) = areas else {
                let p = &target.parts[0].surface;
                assert!(p.sample_area((0.5, 0.5), Detail::Texture).is_none());
                let curved = matches!(case.type_name, "sphere" | "cylinder" | "cone" | "torus");
                assert!(case.type_name == "plane" || curved && name == "uneven", "{} {name}", case.label());
                continue;
            };
            check_area_and_moments(&case, name, &transform, &target, &areas);
        }
    }
}

fn check_area_and_moments(case: &Case, name: &str, transform: &DAffine3, target: &Target, areas: &[f64]) {
    let label = format!("{} under {name}", case.label());
    let total: f64 = areas.iter().sum();
    let (center, radius) = case.ball(transform);
    let local = |p: DVec3| (p - center) / radius;

    // Lines: the number of crossings tells the area, their places the moments.
    let lines = if case.type_name == "sphereflake" { 20_000 } else { 100_000 };
    let mut random = Random(11);
    let (mut by_lines, mut count, mut count_squared) = (Moments::default(), 0.0, 0.0);
    for _ in 0..lines {
        let ray = random.line(center, radius);
        let hits = target.all(&ray);
        count += hits.len() as f64;
        count_squared += (hits.len() * hits.len()) as f64;
        for hit in &hits {
            by_lines.add(local(target.point(hit, &ray).position));
        }
    }
    let n = f64::from(lines);
    let mean = count / n;
    let sigma = ((count_squared / n - mean * mean) / n).sqrt();
    let expected = total / (2.0 * PI * radius * radius);
    assert!((mean - expected).abs() < 4.5 * sigma, "{label}: {mean} crossings a line, area says {expected} +- {sigma}");

    // Samples: on the surface, and with the same moments.
    let mut by_samples = Moments::default();
    for (part, area) in target.parts.iter().zip(areas) {
        for i in 0..(100_000.0 * area / total) as usize {
            let s = part.surface.sample_area(random.pair(), Detail::Texture).unwrap();
            assert!((s.pdf_area * area - 1.0).abs() < 1e-12 && (s.normal.length() - 1.0).abs() < 1e-9);
            by_samples.add(local(s.position));
            if i < 200 && case.type_name != "sphereflake" {
                let from = s.position + s.normal * (0.01 * radius);
                let ray = Ray::new(from.as_vec3(), (-s.normal).as_vec3());
                let hits = target.all(&ray);
                let near = hits
                    .iter()
                    .map(|h| target.point(h, &ray))
                    .find(|h| (h.position - s.position).length() < 1e-5 * radius && h.normal.dot(s.normal) > 0.99);
                // At an edge or apex the ray may pass by.
                assert!(near.is_some() || i % 20 != 0 || hits.is_empty(), "{label}: {s:?} is not on it: {hits:?}");
            }
        }
    }
    for i in 0..9 {
        let ((a, va), (b, vb)) = (by_lines.mean_and_variance(i), by_samples.mean_and_variance(i));
        // Crossings of one line are not independent: up to 4, for the flake more.
        let sigma = (4.0 * va + vb).sqrt();
        assert!((a - b).abs() < 4.5 * sigma + 1e-7, "{label}: moment {i} is {a} by lines, {b} by samples, +- {sigma}");
    }
}

fn ball(center: [f64; 3], radius: f64) -> std::sync::Arc<dyn Surface> {
    let entity = kirkas_scene::Entity::new("b", "sphere", Map::default().with("center", center).with("radius", radius));
    crate::shapes_cases::build(&entity, DAffine3::IDENTITY).unwrap()[0].surface.clone()
}

#[test]
fn a_sphere_is_sampled_uniformly_by_solid_angle_from_near_and_far() {
    let (center, radius) = (DVec3::new(1.0, 2.0, -3.0), 0.5);
    let surface = ball(center.to_array(), radius);
    let mut random = Random(21);
    for height in [1e-5, 1e-2, 0.5, 10.0, 1e3, 1e6] {
        let from = center + DVec3::new(2.0, -1.0, 2.0).normalize() * (radius + height);
        let distance = (center - from).length();
        let one_minus_cos = {
            let sine2 = (radius / distance).powi(2);
            sine2 / (1.0 + (1.0 - sine2).sqrt())
        };
        let pdf = surface.pdf_toward(from).unwrap();
        assert!((pdf * TAU * one_minus_cos - 1.0).abs() < 1e-9, "from {height}");
        let (mut mean, mut solid_angle, n) = (0.0, 0.0, 20_000);
        for _ in 0..n {
            let (s, sample_pdf) = surface.sample_toward(from, random.pair(), Detail::Texture).unwrap();
            assert_eq!(sample_pdf, pdf);
            assert!(((s.position - center).length() - radius).abs() < 1e-14 * 8.0);
            let to = s.position - from;
            assert!(s.normal.dot(to) <= 1e-6 * to.length(), "seen from behind");
            // 1 - cos of the angle to the axis, without cancellation.
            let chord = to.normalize() - (center - from).normalize();
            mean += 0.5 * chord.length_squared() / one_minus_cos / f64::from(n);

            let a = surface.sample_area(random.pair(), Detail::Texture).unwrap();
            let to = a.position - from;
            let cosine = -a.normal.dot(to) / to.length();
            solid_angle += cosine.max(0.0) / to.length_squared() / a.pdf_area / f64::from(n);
        }
        assert!((mean - 0.5).abs() < 0.01, "from {height}: mean {mean}");
        if height >= 0.5 {
            assert!((solid_angle * pdf - 1.0).abs() < 0.05, "from {height}: {solid_angle} steradians");
        }
    }
    assert!(
        surface.sample_toward(center, (0.3, 0.3), Detail::Texture).is_none() && surface.pdf_toward(center).is_none()
    );
}
