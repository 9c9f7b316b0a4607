//! Pixel filters: densities, weights, and the shapes that the literature gives.

use kirkas_geometry::low_discrepancy::owen_sobol_2d;
use kirkas_render::film::filter::{FILTERS, Filter};

const N: usize = 512;

fn filter(name: &str) -> Filter {
    Filter::new(name, None).expect("a listed filter")
}

/// Samples of `N * N` well spread places in the unit square.
fn samples(f: &Filter) -> impl Iterator<Item = (f64, f64, f64)> + '_ {
    (0..N * N).map(|k| {
        let s = f.sample(owen_sobol_2d(k as u32, 5));
        (f64::from(s.offset.0), f64::from(s.offset.1), f64::from(s.weight))
    })
}

/// The integral over the filter's square of `value(x, y) * g(x, y)`, by the midpoint rule.
fn integral(f: &Filter, g: impl Fn(f64, f64, f64) -> f64) -> f64 {
    let r = f64::from(f.radius());
    let h = 2.0 * r / N as f64;
    let place = |i: usize| (i as f64 + 0.5) * h - r;
    let cells = (0..N).flat_map(|j| (0..N).map(move |i| (i, j)));
    cells.map(|(i, j)| g(f.value(place(i) as f32, place(j) as f32), place(i), place(j))).sum::<f64>() * h * h
}

#[test]
fn values_integrate_to_one_and_weights_have_mean_one() {
    for name in FILTERS.iter().filter(|n| **n != "point") {
        let f = filter(name);
        let total = integral(&f, |v, _, _| v);
        assert!((total - 1.0).abs() < 1e-5, "{name}: {total}");
        let mean = samples(&f).map(|s| s.2).sum::<f64>() / (N * N) as f64;
        assert!((mean - 1.0).abs() < 1e-4, "{name}: {mean}");
    }
}

#[test]
fn weighted_moments_of_samples_are_those_of_the_filter() {
    for name in FILTERS.iter().filter(|n| **n != "point") {
        let f = filter(name);
        type Moment = fn(f64, f64) -> f64;
        let moments: [Moment; 5] =
            [|x, _| x, |x, _| x * x, |x, y| x * x * y * y, |x, y| x * x * x * x - y, |x, y| (x - 2.0 * y).cos()];
        for (k, g) in moments.iter().enumerate() {
            let sampled = samples(&f).map(|(x, y, w)| w * g(x, y)).sum::<f64>() / (N * N) as f64;
            let exact = integral(&f, |v, x, y| v * g(x, y));
            assert!((sampled - exact).abs() < 1e-4, "{name}, moment {k}: {sampled} is not {exact}");
        }
    }
}

/// Chi-square of hashed samples against the density `abs(value)`, in 16 x 16 cells.
#[test]
fn samples_are_spread_as_the_absolute_value() {
    const CELLS: usize = 16;
    const COUNT: u64 = 400_000;
    for name in FILTERS.iter().filter(|n| **n != "point") {
        let f = filter(name);
        let r = f64::from(f.radius());
        let cell_of = |x: f64| ((x / r * 0.5 + 0.5) * CELLS as f64).clamp(0.0, CELLS as f64 - 1.0) as usize;
        let mut expected = vec![0.0; CELLS * CELLS];
        let fine = 20 * CELLS;
        let place = |i: usize| ((i as f64 + 0.5) / fine as f64 * 2.0 - 1.0) * r;
        for (i, j) in (0..fine).flat_map(|j| (0..fine).map(move |i| (i, j))) {
            expected[i / 20 + CELLS * (j / 20)] += f.value(place(i) as f32, place(j) as f32).abs();
        }
        let scale = COUNT as f64 / expected.iter().sum::<f64>();
        let mut seen = vec![0.0; CELLS * CELLS];
        for k in 0..COUNT {
            let bits = kirkas_geometry::hash::combine(7, k);
            let unit = kirkas_geometry::hash::unit_f32;
            let s = f.sample((unit(bits as u32), unit((bits >> 32) as u32)));
            assert!(f64::from(s.offset.0).abs() <= r && f64::from(s.offset.1).abs() <= r);
            seen[cell_of(s.offset.0.into()) + CELLS * cell_of(s.offset.1.into())] += 1.0;
        }
        // Cells with few expected samples are pooled.
        let (mut chi2, mut degrees, mut rest) = (0.0, -1.0, (0.0, 0.0));
        for (&e, &s) in expected.iter().zip(&seen) {
            let e = e * scale;
            if e < 10.0 {
                rest = (rest.0 + e, rest.1 + s);
            } else {
                chi2 += (s - e) * (s - e) / e;
                degrees += 1.0;
            }
        }
        if rest.0 > 10.0 {
            chi2 += (rest.1 - rest.0) * (rest.1 - rest.0) / rest.0;
            degrees += 1.0;
        }
        // Five standard deviations of a chi-square.
        let limit = degrees + 5.0 * (2.0_f64 * degrees).sqrt();
        assert!(chi2 < limit, "{name}: chi-square {chi2} with {degrees} degrees of freedom");
    }
}

#[test]
fn mitchell_is_negative_where_the_cubic_is_and_its_weights_make_up_for_it() {
    let f = filter("mitchell");
    // k(0) = 8/9, k(1) = 1/18, zero at 8/7, negative to 2 (Mitchell & Netravali 1988, B = C = 1/3).
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{a} is not {b}");
    near(f.value(0.0, 0.0), 64.0 / 81.0);
    near(f.value(1.0, 0.0), 8.0 / 9.0 / 18.0);
    near(f.value(8.0 / 7.0, 0.0), 0.0);
    near(f.value(2.0, 0.0), 0.0);
    assert!(f.value(1.5, 0.0) < 0.0 && f.value(1.5, -1.5) > 0.0);
    let absolute = integral(&f, |v, _, _| v.abs());
    let mut negative = 0.0;
    for (x, y, w) in samples(&f) {
        assert!((w.abs() - absolute).abs() < 1e-5, "{w} is not {absolute}");
        let edge = |x: f64| (x.abs() - 8.0 / 7.0).abs() < 2e-3;
        if !edge(x) && !edge(y) {
            assert_eq!(w < 0.0, (x.abs() > 8.0 / 7.0) != (y.abs() > 8.0 / 7.0), "at {x} {y}");
        }
        negative += if w < 0.0 { 1.0 } else { 0.0 };
    }
    // Of all samples, (1 - 1 / absolute) / 2 must be negative for the mean to be 1.
    assert!((negative / (N * N) as f64 - 0.5 * (1.0 - 1.0 / absolute)).abs() < 1e-4);
}

#[test]
fn shapes_have_their_closed_forms() {
    let near = |a: f64, b: f64| assert!((a - b).abs() < 1e-6, "{a} is not {b}");
    near(filter("box").value(0.3, -0.4), 1.0);
    near(filter("tent").value(0.25, -0.5), 0.75 * 0.5);
    let g = filter("gaussian");
    let shape = |x: f64| (-2.0 * x * x).exp() - (-4.5_f64).exp();
    near(g.value(0.5, 0.0) / g.value(0.0, 0.0), shape(0.5) / shape(0.0));
    let b = filter("blackman_harris");
    // At half the radius the cosines are 0, -1, 0.
    near(b.value(0.75, 0.0) / b.value(0.0, 0.0), 0.35875 - 0.14128);
    for name in FILTERS {
        let f = filter(name);
        assert_eq!(f.value(f.radius() + 0.01, 0.0), 0.0, "{name}");
        assert_eq!(f.value(0.2, 0.3), f.value(-0.2, 0.3), "{name}");
        assert_eq!(f.value(0.2, 0.3), f.value(0.3, -0.2), "{name}");
    }
}

#[test]
fn inverses_of_box_and_tent_are_exact() {
    let at = |name: &str, u: f32| filter(name).sample((u, 0.5)).offset.0;
    for (u, x) in [(0.0, -0.5), (0.25, -0.25), (0.5, 0.0), (0.75, 0.25)] {
        assert_eq!(at("box", u), x);
    }
    // The tent's distribution function is (1 + x)^2 / 2 below 0.
    for (u, x) in [(0.125, -0.5), (0.5, 0.0), (0.875, 0.5), (0.03125, -0.75)] {
        assert!((at("tent", u) - x).abs() < 1e-6, "{} is not {x}", at("tent", u));
    }
}

#[test]
fn a_point_stays_in_the_middle_and_a_radius_scales() {
    let p = filter("point").sample((0.1, 0.9));
    assert_eq!((p.offset, p.weight), ((0.0, 0.0), 1.0));
    let wide = Filter::new("gaussian", Some(3.0)).expect("a listed filter");
    let (a, b) = (wide.sample((0.1, 0.7)), filter("gaussian").sample((0.1, 0.7)));
    assert!((a.offset.0 - 2.0 * b.offset.0).abs() < 1e-6 && (a.offset.1 - 2.0 * b.offset.1).abs() < 1e-6);
    assert!(Filter::new("lanczos", None).is_none());
    for nonsense in [0.0, -1.0, f32::NAN, f32::INFINITY] {
        assert_eq!(Filter::new("box", Some(nonsense)).expect("a listed filter").radius(), 0.5);
    }
}
