//! What both kernels are asked, and whether they answer the same.

use kirkas_geometry::Ray;

/// How rays are handed over.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Way {
    /// One ray a call.
    Single,
    /// All rays in one call, or eight a call: whatever the kernel has for many rays of one camera.
    Packet,
    /// All rays in one call, of any order.
    Batch,
}

impl Way {
    /// Its name in tables and rows.
    pub fn name(self) -> &'static str {
        match self {
            Way::Single => "single",
            Way::Packet => "packet",
            Way::Batch => "batch",
        }
    }
}

/// What a ray hits first; for a ray that asks for any hit, only whether it hits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Answer {
    /// Ray parameter; infinite without a hit.
    pub t: f32,
    /// The triangle; [`Answer::NONE`] without a hit.
    pub primitive: u32,
}

impl Answer {
    /// No triangle.
    pub const NONE: u32 = u32::MAX;
    /// No hit.
    pub const MISS: Answer = Answer { t: f32::INFINITY, primitive: Self::NONE };

    /// Whether anything was hit.
    pub fn is_hit(&self) -> bool {
        self.primitive != Self::NONE
    }

    /// The same triangle, or another at the same distance: neighbours meet in edges.
    fn agrees(&self, other: &Answer, any: bool) -> bool {
        if any || !(self.is_hit() && other.is_hit()) {
            return self.is_hit() == other.is_hit();
        }
        self.primitive == other.primitive || (self.t - other.t).abs() <= 1e-4 * self.t.abs().max(other.t.abs())
    }
}

/// A kernel over a scene.
pub trait Tracer {
    /// Trace `rays` in order. Gives the seconds the thread computed, without making room for the answers.
    fn trace(&self, rays: &[Ray], any: bool, way: Way) -> (f64, Vec<Answer>);
}

/// The part of the answers that agree, 0 to 1.
pub fn agreement(a: &[Answer], b: &[Answer], any: bool) -> f64 {
    let same = a.iter().zip(b).filter(|(a, b)| a.agrees(b, any)).count();
    same as f64 / a.len().max(1) as f64
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_shared_edge_agrees_and_a_lost_hit_does_not() {
        let hit = |t, primitive| Answer { t, primitive };
        let a = [hit(1.0, 7), hit(1.0, 7), hit(1.0, 7), Answer::MISS];
        let b = [hit(1.00005, 8), hit(1.1, 8), Answer::MISS, Answer::MISS];
        assert_eq!(agreement(&a, &b, false), 0.5);
        assert_eq!(agreement(&a, &b, true), 0.75);
    }
}
