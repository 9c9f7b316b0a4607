//! Which instances a hit lies in.

/// Fills the unused places of an [`InstancePath`].
pub const NO_INSTANCE: u32 = u32::MAX;

/// Instances may stand in instances this deep.
pub const MAX_NESTING: usize = 4;

/// The instances around a primitive, outermost first: an index into `SceneGeometry::instances`, then one into the
/// `Aggregate::instances` of what that instance places, and so on. Paths are ordered as words are, and the world comes after
/// every instance.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct InstancePath([u32; MAX_NESTING]);

impl InstancePath {
    /// The path of what stands in the world itself.
    pub const WORLD: Self = InstancePath([NO_INSTANCE; MAX_NESTING]);

    /// The path of these indices. `None` when there are more than [`MAX_NESTING`] of them or one is [`NO_INSTANCE`].
    pub fn new(indices: &[u32]) -> Option<Self> {
        let mut path = Self::WORLD;
        path.0.get_mut(..indices.len())?.copy_from_slice(indices);
        (!indices.contains(&NO_INSTANCE)).then_some(path)
    }

    /// Index into `SceneGeometry::instances`; [`NO_INSTANCE`] in the world itself.
    #[inline]
    pub fn outermost(&self) -> u32 {
        self.0[0]
    }

    /// True for what stands in the world itself.
    #[inline]
    pub fn is_world(&self) -> bool {
        self.0[0] == NO_INSTANCE
    }

    /// The indices, outermost first.
    pub fn iter(&self) -> impl Iterator<Item = u32> + use<> {
        self.0.into_iter().take_while(|&i| i != NO_INSTANCE)
    }

    /// Number of instances.
    pub fn len(&self) -> usize {
        self.iter().count()
    }

    /// The same as [`InstancePath::is_world`].
    pub fn is_empty(&self) -> bool {
        self.is_world()
    }

    /// The path of an instance within the innermost one; of `self` alone where there is no room.
    #[inline]
    pub(crate) fn then(mut self, index: u32) -> Self {
        if let Some(free) = self.0.iter_mut().find(|i| **i == NO_INSTANCE) {
            *free = index;
        }
        self
    }
}

impl Default for InstancePath {
    fn default() -> Self {
        Self::WORLD
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_ordered_as_words_and_the_world_comes_last() {
        let path = |indices: &[u32]| InstancePath::new(indices).unwrap();
        let mut paths = [path(&[]), path(&[1]), path(&[0, 7]), path(&[0]), path(&[0, 7, 2]), path(&[1, 0])];
        paths.sort();
        let words: Vec<Vec<u32>> = paths.iter().map(|p| p.iter().collect()).collect();
        assert_eq!(words, [vec![0, 7, 2], vec![0, 7], vec![0], vec![1, 0], vec![1], vec![]]);
        assert_eq!((path(&[3, 4]).outermost(), path(&[3, 4]).len(), path(&[]).outermost()), (3, 2, NO_INSTANCE));
        assert_eq!(InstancePath::WORLD.then(3).then(4), path(&[3, 4]));
        assert_eq!(InstancePath::new(&[1, 2, 3, 4, 5]), None);
        assert_eq!(InstancePath::new(&[NO_INSTANCE]), None);
    }
}
