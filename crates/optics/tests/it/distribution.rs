//! What is sampled is what the density says, for every listed model.

use crate::models::{Case, cases, outgoing};
use kirkas_geometry::Vec3;
use kirkas_optics::{LobeSet, Mode};
use kirkas_testkit::{ChiSquare, Random, integrate_sphere, sidak};

const LEVEL: f64 = 0.01;

/// Every question that can be put to a case: all lobes, those without deltas, each one alone.
fn lobe_sets(case: &Case) -> Vec<LobeSet> {
    let own = case.bsdf.lobes();
    let mut sets = vec![LobeSet::ALL];
    let scattered = own & LobeSet::NON_DELTA;
    if scattered != own {
        sets.push(LobeSet::NON_DELTA);
    }
    if scattered.iter().count() > 1 {
        sets.extend(scattered.iter().map(LobeSet::of));
    }
    sets
}

/// All directions for all lobes together; one from each side for the rest.
fn directions(lobes: LobeSet) -> Vec<Vec3> {
    let all = outgoing();
    if lobes == LobeSet::ALL { all } else { vec![all[2], all[5]] }
}

#[test]
fn samples_follow_their_density() {
    let questions: Vec<(Case, Vec<LobeSet>)> =
        cases().into_iter().map(|c| (lobe_sets(&c), c)).map(|(s, c)| (c, s)).collect();
    let tests: usize = questions.iter().flat_map(|(_, sets)| sets).map(|&lobes| directions(lobes).len()).sum();
    let threshold = sidak(LEVEL, tests);
    let mut seed = 0;
    for (case, sets) in &questions {
        for &lobes in sets {
            for wo in directions(lobes) {
                seed += 1;
                let test = ChiSquare { rows: 12, columns: 24, samples: 40_000, seed };
                let sample = |u, v| {
                    let s = case.bsdf.sample(wo, u, v, lobes, Mode::Radiance)?;
                    (!s.lobe.is_delta()).then_some(s.wi)
                };
                let r = test.run(sample, |wi| case.bsdf.pdf(wo, wi, lobes, Mode::Radiance));
                let what = format!("{}\n lobes {lobes:?}, wo {wo}: {r:?}", case.label);
                assert!(r.p_value >= threshold, "p below {threshold}: {what}");
                assert!(r.total <= 1.0 + 1e-3, "{what}");
            }
        }
    }
}

#[test]
fn densities_integrate_to_the_part_that_is_scattered() {
    for case in cases() {
        for wo in [outgoing()[2], outgoing()[5]] {
            let total = integrate_sphere(|wi| f64::from(case.bsdf.pdf(wo, wi, LobeSet::ALL, Mode::Importance)));
            let deltas: f64 = (0..1000)
                .filter_map(|i| {
                    case.bsdf.sample(wo, (i as f32 + 0.5) / 1000.0, (0.1, 0.1), LobeSet::ALL, Mode::Importance)
                })
                .filter(|s| s.lobe.is_delta())
                .count() as f64
                / 1000.0;
            assert!(total + deltas <= 1.002, "{} from {wo}: {total} + {deltas}", case.label);
            if case.bsdf.lobes().is_empty() {
                assert_eq!(total, 0.0);
            }
        }
    }
}

/// The sample says what `eval` and `pdf` say about its direction, in both modes; all of it is sane.
#[test]
fn samples_agree_with_eval_and_pdf() {
    for case in cases() {
        for (lobes, mode) in lobe_sets(&case).into_iter().flat_map(|l| [(l, Mode::Radiance), (l, Mode::Importance)]) {
            let mut random = Random::new(17);
            for wo in outgoing().into_iter().cycle().take(700) {
                let Some(s) = case.bsdf.sample(wo, random.number(), random.pair(), lobes, mode) else { continue };
                let what = format!("{} from {wo}, {mode:?}: {s:?}", case.label);
                assert!((s.wi.length() - 1.0).abs() < 1e-5, "{what}");
                assert!(
                    s.pdf > 0.0 && s.pdf.is_finite() && s.f.is_finite() && s.f.0.iter().all(|&x| x >= 0.0),
                    "{what}"
                );
                assert!(lobes.contains(s.lobe) && case.bsdf.lobes().contains(s.lobe), "{what}");
                assert_eq!(s.lobe.is_transmission(), s.wi.z * wo.z < 0.0, "{what}");
                let expected_eta = if s.lobe.is_transmission() { case.eta(s.wi) / case.eta(wo) } else { 1.0 };
                assert!((f64::from(s.eta) - expected_eta).abs() < 1e-6, "{what}");
                if s.lobe.is_delta() {
                    assert!(s.pdf <= 1.0, "{what}");
                    assert_eq!(s.weight(), s.f * (1.0 / s.pdf), "{what}");
                } else {
                    assert_eq!(
                        (s.f, s.pdf),
                        (case.bsdf.eval(wo, s.wi, lobes, mode), case.bsdf.pdf(wo, s.wi, lobes, mode)),
                        "{what}"
                    );
                    assert_eq!(s.weight(), s.f * (s.wi.z.abs() / s.pdf), "{what}");
                }
            }
        }
    }
}

/// Nothing comes out for lobes that are not there, for directions in the surface, or where no lobe was asked for.
#[test]
fn what_is_not_asked_for_is_not_answered() {
    let flat = Vec3::X;
    let mut random = Random::new(5);
    for case in cases() {
        let missing = LobeSet::ALL.without(case.bsdf.lobes());
        for lobes in [LobeSet::NONE, missing] {
            for wo in outgoing() {
                let wi = -wo.cross(Vec3::new(0.3, 0.2, 0.5)).normalize();
                for wi in [wi, -wi, wo] {
                    assert!(case.bsdf.eval(wo, wi, lobes, Mode::Radiance).is_black(), "{}", case.label);
                    assert_eq!(case.bsdf.pdf(wo, wi, lobes, Mode::Radiance), 0.0, "{}", case.label);
                }
                assert!(
                    case.bsdf.sample(wo, random.number(), random.pair(), lobes, Mode::Radiance).is_none(),
                    "{}",
                    case.label
                );
            }
        }
        for mode in [Mode::Radiance, Mode::Importance] {
            assert!(case.bsdf.sample(flat, 0.3, (0.3, 0.7), LobeSet::ALL, mode).is_none(), "{}", case.label);
            assert_eq!(case.bsdf.delta_branches(flat, mode).iter().count(), 0, "{}", case.label);
            for (a, b) in [(flat, Vec3::Z), (Vec3::Z, flat), (flat, flat), (flat, -Vec3::Z)] {
                assert!(case.bsdf.eval(a, b, LobeSet::ALL, mode).is_black(), "{}", case.label);
                assert_eq!(case.bsdf.pdf(a, b, LobeSet::ALL, mode), 0.0, "{}", case.label);
            }
        }
    }
}

/// The corners of the unit square give no NaN, and no unit vector does.
#[test]
fn extreme_random_numbers_are_harmless() {
    let last = 1.0 - f32::EPSILON / 2.0;
    let edge = [0.0, 1e-7, 0.5, last];
    for case in cases() {
        for wo in outgoing().into_iter().chain([Vec3::new(1.0, 0.0, 1e-6), Vec3::new(1.0, 0.0, -1e-6)]) {
            for (a, b, c) in edge.iter().flat_map(|&a| edge.iter().flat_map(move |&b| edge.map(|c| (a, b, c)))) {
                if let Some(s) = case.bsdf.sample(wo, a, (b, c), LobeSet::ALL, Mode::Radiance) {
                    assert!(s.weight().is_finite() && s.wi.is_finite() && s.pdf > 0.0, "{} {wo} {s:?}", case.label);
                }
            }
        }
    }
}
