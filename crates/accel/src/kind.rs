//! The closed list of structures.

/// Which structure finds the hits. All give the same answers to the bit; they differ in speed and memory.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum AccelKind {
    /// Every ray against every primitive: the test of all others, and right for a handful of primitives.
    BruteForce,
    /// A binary tree of boxes, split by the binned surface-area heuristic.
    Bvh2,
    /// A tree of boxes, eight children to a node and eight triangles to a leaf.
    #[default]
    Bvh8,
    /// The same, built along a Morton curve in a fraction of the time: for scenes that move.
    Bvh8Fast,
    /// The same with spatial splits and reinsertion, built in two to four times the time: for scenes that are looked at for long.
    Bvh8Best,
    /// The same in about a third of the memory, slower to trace.
    Bvh8Compact,
    /// A binary tree of spheres.
    SphereHierarchy,
    /// A kd-tree with the best planes.
    KdTree,
    /// A kd-tree that is built quickly.
    KdTreeFast,
    /// Equal cells.
    Grid,
}

impl AccelKind {
    /// Every kind with its name, in the order of the manual.
    pub const ALL: [(AccelKind, &str); 10] = [
        (AccelKind::BruteForce, "brute_force"),
        (AccelKind::Bvh2, "bvh2"),
        (AccelKind::Bvh8, "bvh8"),
        (AccelKind::Bvh8Fast, "bvh8_fast"),
        (AccelKind::Bvh8Best, "bvh8_best"),
        (AccelKind::Bvh8Compact, "bvh8_compact"),
        (AccelKind::SphereHierarchy, "sphere_hierarchy"),
        (AccelKind::KdTree, "kd_tree"),
        (AccelKind::KdTreeFast, "kd_tree_fast"),
        (AccelKind::Grid, "grid"),
    ];
    /// Every name, in the same order.
    pub const NAMES: [&str; 10] = [
        "brute_force",
        "bvh2",
        "bvh8",
        "bvh8_fast",
        "bvh8_best",
        "bvh8_compact",
        "sphere_hierarchy",
        "kd_tree",
        "kd_tree_fast",
        "grid",
    ];

    /// The kind of this name.
    pub fn parse(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|(_, n)| *n == name).map(|(kind, _)| kind)
    }

    /// The name of this kind.
    pub fn name(self) -> &'static str {
        match self {
            AccelKind::BruteForce => "brute_force",
            AccelKind::Bvh2 => "bvh2",
            AccelKind::Bvh8 => "bvh8",
            AccelKind::Bvh8Fast => "bvh8_fast",
            AccelKind::Bvh8Best => "bvh8_best",
            AccelKind::Bvh8Compact => "bvh8_compact",
            AccelKind::SphereHierarchy => "sphere_hierarchy",
            AccelKind::KdTree => "kd_tree",
            AccelKind::KdTreeFast => "kd_tree_fast",
            AccelKind::Grid => "grid",
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_round_trip() {
        for ((kind, name), listed) in AccelKind::ALL.into_iter().zip(AccelKind::NAMES) {
            assert_eq!(AccelKind::parse(name), Some(kind));
            assert_eq!((kind.name(), listed), (name, name));
        }
        assert_eq!(AccelKind::parse("octree"), None);
    }
}
