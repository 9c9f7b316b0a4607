//! Near lights in a tree, beside lights that shine from infinitely far and are weighed one by one.

use super::pick::{EVEN_SHARE, Reach};
use super::tree::{LightTree, more_digits};
use kirkas_geometry::DVec3;

/// A tree of the near lights, beside the far ones.
#[derive(Clone, Debug)]
pub(super) struct TreeAndFar {
    tree: Option<LightTree>,
    far: Vec<Far>,
}

#[derive(Clone, Copy, Debug)]
struct Far {
    light: u32,
    irradiance: f32,
    towards: Option<DVec3>,
}

impl TreeAndFar {
    pub(super) fn new(lights: &[Reach]) -> Self {
        let near = |r: &Reach| match r {
            Reach::Near(bounds) => Some(*bounds),
            Reach::Far { .. } => None,
        };
        let far = |(i, r): (usize, &Reach)| match *r {
            Reach::Far { irradiance, towards } if irradiance > 0.0 => {
                Some(Far { light: i as u32, irradiance: (irradiance as f32).clamp(f32::MIN_POSITIVE, 1e30), towards })
            }
            _ => None,
        };
        let tree = LightTree::new(&lights.iter().map(near).collect::<Vec<_>>());
        TreeAndFar { tree, far: lights.iter().enumerate().filter_map(far).collect() }
    }

    pub(super) fn pick(&self, point: DVec3, normal: DVec3, u: f32) -> Option<(u32, f32)> {
        if let (Some(tree), []) = (&self.tree, self.far.as_slice()) {
            return Some(match tree.only() {
                Some(light) => (light, 1.0),
                None => tree.pick(point, normal, more_digits(u, point)),
            });
        }
        let u = more_digits(u, point);
        let shares = self.shares(point, normal);
        if !shares.any() {
            return None;
        }
        let mut rest = u;
        let mut last = None;
        for far in &self.far {
            let p = shares.of(far.arriving(normal));
            if p > 0.0 && rest < f64::from(p) {
                return Some((far.light, p));
            }
            rest -= f64::from(p);
            last = if p > 0.0 { Some((far.light, p)) } else { last };
        }
        match &self.tree {
            Some(tree) if shares.near > 0.0 => {
                let p = shares.of(shares.near);
                let (light, within) = tree.pick(point, normal, (rest.max(0.0) / f64::from(p)).min(1.0 - f64::EPSILON));
                Some((light, p * within))
            }
            // Rounding left a crumb.
            _ => last,
        }
    }

    pub(super) fn probability(&self, point: DVec3, normal: DVec3, light: u32) -> f32 {
        match &self.tree {
            Some(tree) if self.far.is_empty() => tree.probability(point, normal, light),
            Some(tree) if tree.holds(light) => {
                let shares = self.shares(point, normal);
                shares.of(shares.near) * tree.probability(point, normal, light)
            }
            _ => match self.far.iter().find(|f| f.light == light) {
                Some(far) => self.shares(point, normal).of(far.arriving(normal)),
                None => 0.0,
            },
        }
    }

    fn shares(&self, point: DVec3, normal: DVec3) -> Shares {
        // From power to irradiance, for a light between all-round and flat.
        const PER_POWER: f32 = 0.16;
        let near = self.tree.as_ref().map_or(0.0, |tree| tree.importance(point, normal) * PER_POWER);
        let mut shares = Shares { near, total: near, count: u32::from(near > 0.0) };
        for far in &self.far {
            let arriving = far.arriving(normal);
            shares.total += arriving;
            shares.count += u32::from(arriving > 0.0);
        }
        shares
    }
}

impl Far {
    /// About how much of it arrives at a surface of this normal; 0 only if nothing can.
    fn arriving(&self, normal: DVec3) -> f32 {
        match self.towards {
            Some(towards) if normal != DVec3::ZERO => {
                let cosine = towards.dot(normal) as f32;
                if cosine > 0.0 { self.irradiance * cosine.max(1e-3) } else { 0.0 }
            }
            _ => self.irradiance,
        }
    }
}

/// What arrives, to be shared out: partly in proportion, partly evenly.
struct Shares {
    near: f32,
    total: f32,
    count: u32,
}

impl Shares {
    fn any(&self) -> bool {
        self.count > 0
    }

    /// The probability of what sends `arriving`.
    fn of(&self, arriving: f32) -> f32 {
        if arriving == 0.0 {
            return 0.0;
        }
        const EVEN: f32 = EVEN_SHARE as f32;
        EVEN / self.count as f32 + (1.0 - EVEN) * (arriving / self.total)
    }
}
