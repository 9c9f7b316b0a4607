//! A tree as words of a file: its arena, and where its root is. All else follows from the scene.

use super::arena::Line;
use super::node::{MAX_LINES, Place};
use super::numbers::Numbers;
use super::{Tree, has_avx2, motion};
use crate::Serial;
use crate::gather::Gathered;
use crate::gather::gather;
use crate::instance::PlacedInstance;
use crate::saved::{Reader, SavedTreeError, Writer};
use crate::scene_geometry::Geometry;
use std::io;

/// Lines that are read at once: a forged length makes no room for more than comes.
const CHUNK: usize = 1 << 12;

impl Tree {
    pub fn save(&self, to: &mut Writer) -> io::Result<()> {
        to.words(&[self.lines.len() as u64, u64::from(self.root.0), u64::from(self.is_split)])?;
        for lines in self.lines.chunks(CHUNK) {
            let pairs = lines.iter().flat_map(|line| line.0.as_chunks::<2>().0);
            let words: Vec<u64> = pairs.map(|&[low, high]| u64::from(low) | u64::from(high) << 32).collect();
            to.words(&words)?;
        }
        Ok(())
    }

    /// Read a tree over this level. It must not be asked for anything before [`Tree::validate`] found it sound.
    pub fn load(
        geometries: &[Geometry],
        instances: &[PlacedInstance],
        from: &mut Reader,
    ) -> Result<Tree, SavedTreeError> {
        let [count, root, is_split] = from.words()?;
        let (Ok(root), true) = (u32::try_from(root), count <= MAX_LINES as u64 && is_split <= 1) else {
            return Err(SavedTreeError::Damaged("its tree cannot be".into()));
        };
        let mut lines = Vec::new();
        let mut words = vec![0; CHUNK * 8];
        while lines.len() < count as usize {
            let words = &mut words[..8 * CHUNK.min(count as usize - lines.len())];
            from.fill(words)?;
            lines.extend(
                words
                    .as_chunks::<8>()
                    .0
                    .iter()
                    .map(|words| Line(core::array::from_fn(|i| (words[i / 2] >> (32 * (i % 2))) as u32))),
            );
        }
        let Gathered { bounds, unbounded, .. } = gather(geometries, instances, &Serial);
        let mut tree = Tree {
            lines,
            root: Place(root),
            numbers: Numbers::new(geometries),
            unbounded,
            bounds,
            reach: 0.0,
            is_split: is_split == 1,
            is_moving: motion::is_moving(geometries),
            has_avx2: has_avx2(),
        };
        tree.reach = tree.find_reach();
        Ok(tree)
    }
}
