//! Choosing one light among many: the one seam between integrators and however lights are weighed.
//!
//! Contract: `pick` draws light n with exactly the probability that `probability` gives for n at the same point and normal, and
//! those sum to 1 over the lights that have any. A light of which something could arrive has a probability above 0.
//! `point` is where light is wanted, in the world; `normal` the unit geometric normal of the side from which it must come, zero
//! where it may come from all around (boundaries that let light through, points in space).

use kirkas_geometry::DVec3;

/// Chooses lights by number.
#[derive(Clone, Debug)]
pub struct LightPicker {
    method: Method,
}

#[derive(Clone, Debug)]
enum Method {
    Uniform { count: u32 },
    Power(Table),
}

/// Of every choice by power, the part that is spread evenly: a weak light may be near, and an estimate of power wrong.
const EVEN_SHARE: f64 = 0.25;

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

    /// A light and the probability with which it was chosen; `None` if there is none. `u` in `[0, 1)`.
    pub fn pick(&self, _point: DVec3, _normal: DVec3, u: f32) -> Option<(u32, f32)> {
        match &self.method {
            Method::Uniform { count: 0 } => None,
            Method::Uniform { count } => Some((((u * *count as f32) as u32).min(count - 1), 1.0 / *count as f32)),
            Method::Power(table) => Some(table.pick(u)),
        }
    }

    /// The probability with which `pick` would have chosen light number `light`.
    pub fn probability(&self, _point: DVec3, _normal: DVec3, light: u32) -> f32 {
        match &self.method {
            Method::Uniform { count } if light < *count => 1.0 / *count as f32,
            Method::Uniform { .. } => 0.0,
            Method::Power(table) => table.probability(light),
        }
    }
}

/// Shares of 1, summed up: found by halving, and neighbours in `u` stay neighbours.
#[derive(Clone, Debug)]
struct Table {
    /// Shares of the first, of the first two, ...; the last is 1.
    sums: Vec<f32>,
}

impl Table {
    fn new(shares: impl Iterator<Item = f64>) -> Self {
        let mut sum = 0.0;
        let mut sums: Vec<f32> = shares.map(|s| (sum += s, sum as f32).1).collect();
        if let Some(last) = sums.last_mut() {
            *last = 1.0;
        }
        Table { sums }
    }

    fn pick(&self, u: f32) -> (u32, f32) {
        let light = self.sums.partition_point(|&s| s <= u).min(self.sums.len() - 1) as u32;
        (light, self.probability(light))
    }

    /// As the rounded sums have it, so that it is exactly what `pick` does.
    fn probability(&self, light: u32) -> f32 {
        let before = |n: usize| n.checked_sub(1).map_or(0.0, |n| self.sums[n]);
        self.sums.get(light as usize).map_or(0.0, |s| s - before(light as usize))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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

    #[test]
    fn strong_lights_are_picked_more_often_and_weak_ones_never_forgotten() {
        let picker = LightPicker::by_power(&[0.0, 1.0, 3.0]);
        let p = |n| picker.probability(DVec3::ZERO, DVec3::Y, n);
        assert!((p(0) - 1.0 / 12.0).abs() < 1e-6);
        assert!((p(2) - (1.0 / 12.0 + 0.75 * 0.75)).abs() < 1e-6);
    }
}
