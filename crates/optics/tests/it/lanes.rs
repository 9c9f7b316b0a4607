//! Light, lanes and lobes: the small change.

use kirkas_optics::{Lanes, Light, Lobe, LobeSet, SPECS};

#[test]
fn light_reckons_lane_by_lane() {
    let (a, b) = (Light([1.0, 2.0, 3.0, 4.0]), Light([0.5, 0.25, 2.0, 8.0]));
    assert_eq!(a + b, Light([1.5, 2.25, 5.0, 12.0]));
    assert_eq!(a - b, Light([0.5, 1.75, 1.0, -4.0]));
    assert_eq!(a * b, Light([0.5, 0.5, 6.0, 32.0]));
    assert_eq!((a * 2.0, 2.0 * a, a / 2.0), (a + a, a + a, Light([0.5, 1.0, 1.5, 2.0])));
    let mut c = a;
    c += b;
    c *= b;
    c *= 2.0;
    assert_eq!(c, (a + b) * b * 2.0);
    assert_eq!([a, b, a].into_iter().sum::<Light>(), a + a + b);
    assert_eq!((a.max_component(), b.max_component(), a[1]), (4.0, 8.0, 2.0));
    for (i, light) in [[9.0, 1.0, 1.0, 1.0], [1.0, 9.0, 1.0, 1.0], [1.0, 1.0, 9.0, 1.0]].into_iter().enumerate() {
        assert_eq!(Light(light).max_component(), 9.0, "{i}");
    }
    assert!(Light::BLACK.is_black() && !a.is_black() && !Light([0.0, 0.0, 0.0, 1e-30]).is_black());
    assert!(a.is_finite() && !Light([0.0, f32::NAN, 0.0, 0.0]).is_finite() && !(a / 0.0).is_finite());
    assert_eq!(Light::splat(2.0).map(|x| x * x), Light([4.0; 4]));
}

#[test]
fn colours_enter_and_leave_unchanged_and_the_fourth_lane_stays_idle() {
    let l = Lanes::RGB;
    let rgb = [0.25, 1.5, -0.5];
    assert_eq!(l.reflectance(rgb), Light([0.25, 1.0, 0.0, 0.0]));
    assert_eq!(l.unbounded(rgb), Light([0.25, 1.5, 0.0, 0.0]));
    assert_eq!(l.illuminant(rgb), Light([0.25, 1.5, 0.0, 0.0]));
    assert_eq!(l.one(), Light([1.0, 1.0, 1.0, 0.0]));
    assert_eq!(l.to_film(l.illuminant([1.0, 2.0, 3.0])), [1.0, 2.0, 3.0]);
    let nan = [f32::NAN; 3];
    assert!(l.reflectance(nan).is_black() && l.unbounded(nan).is_black() && l.illuminant(nan).is_black());
}

#[test]
fn parameters_are_kept_in_their_rows_ranges() {
    let spec = |model: &str| SPECS.iter().find(|s| s.name == model).unwrap();
    let row = |model: &str, name: &str| spec(model).params.iter().find(|p| p.name == name).unwrap();
    let l = Lanes::RGB;
    assert_eq!(l.parameter(row("lambert", "reflectance"), [0.5, 2.0, 0.1]), Light([0.5, 1.0, 0.1, 0.0]));
    assert_eq!(l.parameter(row("phong", "specular"), [0.5, 2.0, 0.1]), Light([0.5, 2.0, 0.1, 0.0]));
    assert_eq!(l.parameter(row("phong", "exponent"), [3.0, 6.0, 9.0]), Light::splat(6.0));
    assert_eq!(l.parameter(row("rough_mirror", "roughness"), [3.0; 3]), Light::splat(1.0));
    assert_eq!(l.parameter(row("rough_mirror", "roughness"), [-3.0; 3]), Light::splat(0.0));
    assert_eq!(l.parameter(row("rough_mirror", "roughness"), [f32::NAN; 3]), Light::splat(0.0));
}

#[test]
fn lobes_form_sets() {
    use Lobe::*;
    let members = |s: LobeSet| s.iter().collect::<Vec<_>>();
    assert_eq!(members(LobeSet::ALL), Lobe::ALL);
    assert_eq!(members(LobeSet::NONE), []);
    assert_eq!(members(LobeSet::DIFFUSE), [DiffuseReflection, DiffuseTransmission]);
    assert_eq!(members(LobeSet::GLOSSY), [GlossyReflection, GlossyTransmission]);
    assert_eq!(members(LobeSet::DELTA), [DeltaReflection, DeltaTransmission]);
    assert_eq!(members(LobeSet::REFLECTION), [DiffuseReflection, GlossyReflection, DeltaReflection]);
    assert_eq!(members(LobeSet::TRANSMISSION), [DiffuseTransmission, GlossyTransmission, DeltaTransmission]);
    assert_eq!(LobeSet::NON_DELTA, LobeSet::DIFFUSE | LobeSet::GLOSSY);
    assert_eq!(LobeSet::ALL.without(LobeSet::DELTA), LobeSet::NON_DELTA);
    assert_eq!(LobeSet::DELTA & LobeSet::REFLECTION, LobeSet::from(DeltaReflection));
    assert!(LobeSet::DELTA.intersects(LobeSet::REFLECTION) && !LobeSet::DELTA.intersects(LobeSet::DIFFUSE));
    assert!(LobeSet::NONE.is_empty() && !LobeSet::of(GlossyReflection).is_empty());
    assert_eq!((LobeSet::DELTA.when(true), LobeSet::DELTA.when(false)), (LobeSet::DELTA, LobeSet::NONE));
    let deltas: Vec<bool> = Lobe::ALL.iter().map(|l| l.is_delta()).collect();
    assert_eq!(deltas, [false, false, true, false, false, true]);
    let passing: Vec<bool> = Lobe::ALL.iter().map(|l| l.is_transmission()).collect();
    assert_eq!(passing, [false, false, false, true, true, true]);
    let names: Vec<&str> = Lobe::ALL.iter().map(|l| l.name()).collect();
    assert_eq!(
        names,
        [
            "diffuse_reflection",
            "glossy_reflection",
            "delta_reflection",
            "diffuse_transmission",
            "glossy_transmission",
            "delta_transmission"
        ]
    );
}
