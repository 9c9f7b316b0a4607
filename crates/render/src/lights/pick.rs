//! Choosing one light among many: the one seam between integrators and however lights are weighed.
//!
//! Contract: `pick` draws light n with exactly the probability that `probability` gives for n at the same point and normal, and
//! those sum to 1 over the lights that have any. A light of which something could arrive has a probability above 0.
//! `point` is where light is wanted, in the world; `normal` the unit geometric normal of the side from which it must come, zero
//! where it may come from all around (boundaries that let light through, points in space).

use super::LightEntry;
use super::pieces::Pieces;
use super::table::Table;
use super::tree::LightBounds;
use super::tree_and_far::TreeAndFar;
use crate::materials::Material;
use crate::textures::Textures;
use kirkas_geometry::DVec3;
use kirkas_scene::{ParamSpec, Params};

/// How a light reaches the scene.
#[derive(Clone, Copy, Debug)]
pub enum Reach {
    /// From a bounded place.
    Near(LightBounds),
    /// From infinitely far.
    Far {
        /// About what it sends onto a surface that faces it, all lanes together, W/m2.
        irradiance: f64,
        /// Unit, towards the light, where there is only one direction.
        towards: Option<DVec3>,
    },
}

/// How integrators let their users choose.
pub const SELECTION: ParamSpec = ParamSpec::choice(
    "light_selection",
    &["tree", "power", "uniform"],
    "How one light among many is chosen: `tree` by what each could send to the point (Conty Estevez & Kulla 2018); `power` by its power; `uniform` evenly.",
);

/// Chooses lights by number.
#[derive(Clone, Debug)]
pub struct LightPicker {
    method: Method,
}

#[derive(Clone, Debug)]
enum Method {
    Uniform { count: u32 },
    Power(Table),
    Tree(Box<TreeAndFar>),
}

/// Of every choice by power, the part that is spread evenly: a weak light may be near, and an estimate of power wrong.
pub(super) const EVEN_SHARE: f64 = 0.25;

impl LightPicker {
    /// Every light as likely as any other: the plain twin.
    pub fn uniform(count: usize) -> Self {
        LightPicker { method: Method::Uniform { count: count as u32 } }
    }

    /// By the power of each light, in any common unit.
    pub fn by_power(powers: &[f64]) -> Self {
        let usable = |p: f64| if p.is_finite() { p.max(0.0) } else { 0.0 };
        let total: f64 = powers.iter().copied().map(usable).sum();
        if !(total > 0.0 && total.is_finite()) || powers.len() == 1 {
            return Self::uniform(powers.len());
        }
        let even = EVEN_SHARE / powers.len() as f64;
        let shares = powers.iter().map(|&p| even + (1.0 - EVEN_SHARE) * usable(p) / total);
        LightPicker { method: Method::Power(Table::new(shares)) }
    }

    /// As the integrator's parameters have it, for lights with these powers.
    /// Beside it the pieces among which it chooses.
    pub fn new(
        integrator: &Params,
        lights: &[LightEntry],
        (materials, textures): (&[Material], &Textures),
        powers: &[f64],
    ) -> (Self, Pieces) {
        let can_choose = integrator.spec().params.iter().any(|row| row.name == SELECTION.name);
        match can_choose.then(|| integrator.text(SELECTION.name)).flatten() {
            Some("uniform") => (Self::uniform(lights.len()), Pieces::whole(lights.len())),
            Some("power") => (Self::by_power(powers), Pieces::whole(lights.len())),
            _ => {
                let pieces = Pieces::new(lights);
                (Self::by_tree(&pieces.reaches(lights, materials, textures, powers)), pieces)
            }
        }
    }

    /// By what each light could send to the point that asks: near ones by a tree, those infinitely far one by one.
    pub fn by_tree(lights: &[Reach]) -> Self {
        LightPicker { method: Method::Tree(Box::new(TreeAndFar::new(lights))) }
    }

    /// A light and the probability with which it was chosen; `None` if there is none. `u` in `[0, 1)`.
    pub fn pick(&self, point: DVec3, normal: DVec3, u: f32) -> Option<(u32, f32)> {
        match &self.method {
            Method::Uniform { count: 0 } => None,
            Method::Uniform { count } => Some((((u * *count as f32) as u32).min(count - 1), 1.0 / *count as f32)),
            Method::Power(table) => Some(table.pick(u)),
            Method::Tree(tree) => tree.pick(point, normal, u),
        }
    }

    /// The probability with which `pick` would have chosen light number `light`.
    pub fn probability(&self, point: DVec3, normal: DVec3, light: u32) -> f32 {
        match &self.method {
            Method::Uniform { count } if light < *count => 1.0 / *count as f32,
            Method::Uniform { .. } => 0.0,
            Method::Power(table) => table.probability(light),
            Method::Tree(tree) => tree.probability(point, normal, light),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use kirkas_geometry::Bounds3;

    /// Picks with `n` evenly spaced numbers and compares frequencies with what is promised.
    fn check(picker: &LightPicker, lights: u32, n: u32) {
        let mut found = vec![0_u32; lights as usize];
        for i in 0..n {
            let (light, p) = picker.pick(DVec3::ZERO, DVec3::Y, (i as f32 + 0.5) / n as f32).unwrap();
            assert_eq!(p, picker.probability(DVec3::ZERO, DVec3::Y, light));
            found[light as usize] += 1;
        }
        let mut sum = 0.0;
        for (light, &count) in found.iter().enumerate() {
            let p = picker.probability(DVec3::ZERO, DVec3::Y, light as u32);
            assert!((count as f32 - p * n as f32).abs() <= 1.0, "light {light}: {count} of {n}, promised {p}");
            sum += p;
        }
        assert!((sum - 1.0).abs() < 1e-6);
        assert_eq!(picker.probability(DVec3::ZERO, DVec3::Y, lights), 0.0);
    }

    #[test]
    fn lights_are_picked_as_often_as_promised() {
        check(&LightPicker::uniform(7), 7, 4096);
        check(&LightPicker::by_power(&[1.0, 5.0, 0.0, 2.0]), 4, 4096);
        check(&LightPicker::by_power(&[f64::INFINITY, 5.0, f64::NAN]), 3, 4096);
        check(&LightPicker::by_power(&[0.0, 0.0]), 2, 64);
        assert!(LightPicker::uniform(0).pick(DVec3::ZERO, DVec3::Y, 0.5).is_none());
        assert!(LightPicker::by_power(&[]).pick(DVec3::ZERO, DVec3::Y, 0.5).is_none());
    }

    fn near(x: f64) -> Reach {
        let at = DVec3::new(x, 2.0, 0.0);
        Reach::Near(LightBounds::all_around(Bounds3::around_f64(at, at), 5.0))
    }

    fn far(irradiance: f64, towards: Option<DVec3>) -> Reach {
        Reach::Far { irradiance, towards }
    }

    #[test]
    fn near_and_far_lights_are_picked_as_often_as_promised() {
        let (sky, sun) = (far(3.0, None), far(2.0, Some(DVec3::new(0.6, 0.8, 0.0))));
        for lights in [
            vec![sky],
            vec![sun, sky],
            vec![near(0.0), near(1.0)],
            vec![sky, near(0.0), sun, near(1.0), near(5.0), far(0.0, None)],
        ] {
            check(&LightPicker::by_tree(&lights), lights.len() as u32, 65_536);
        }
    }

    #[test]
    fn lights_behind_a_surface_are_not_picked() {
        let lights = [far(2.0, Some(DVec3::NEG_Y)), near(0.0), far(1.0, None)];
        let picker = LightPicker::by_tree(&lights);
        let p = |normal, light| picker.probability(DVec3::ZERO, normal, light);
        assert_eq!(p(DVec3::Y, 0), 0.0);
        assert!(p(DVec3::Y, 1) > 0.1 && p(DVec3::Y, 2) > 0.1);
        assert_eq!(p(DVec3::NEG_Y, 1), 0.0);
        assert!((0..3).all(|light| p(DVec3::ZERO, light) > 0.0));
        assert!(LightPicker::by_tree(&lights[..1]).pick(DVec3::ZERO, DVec3::Y, 0.3).is_none());
        assert!(LightPicker::by_tree(&[]).pick(DVec3::ZERO, DVec3::Y, 0.3).is_none());
    }

    #[test]
    fn strong_lights_are_picked_more_often_and_weak_ones_never_forgotten() {
        let picker = LightPicker::by_power(&[0.0, 1.0, 3.0]);
        let p = |n| picker.probability(DVec3::ZERO, DVec3::Y, n);
        assert!((p(0) - 1.0 / 12.0).abs() < 1e-6);
        assert!((p(2) - (1.0 / 12.0 + 0.75 * 0.75)).abs() < 1e-6);
    }
}
