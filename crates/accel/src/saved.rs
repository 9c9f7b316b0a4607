//! Built trees in files: [`Accel::save`] and [`Accel::load`].
//!
//! A file is a row of 64-bit words in the byte order of the machine that wrote it: a mark, the order of bytes, the version, the
//! kind, a hash of the scene's geometry, the trees of the aggregates and of the world, and a hash of all that.

use crate::checksum::Checksum;
use crate::structure::Structure;
use crate::{Accel, AccelError, AccelKind, SceneGeometry, fingerprint, wide};
use core::fmt;
use std::io::{self, Read, Write};

const MARK: [u8; 8] = *b"kirkacc\n";
const BYTE_ORDER: u64 = 0x0102_0304_0506_0708;
/// To be raised with every change of what lies in an arena.
const VERSION: u64 = 2;

/// Why a tree could not be saved, or a saved one is refused.
#[derive(Debug)]
pub enum SavedTreeError {
    /// Reading or writing failed.
    Io(io::Error),
    /// Structures of this kind cannot be saved.
    NotSavable(AccelKind),
    /// This is no saved tree.
    Foreign,
    /// It was saved on a machine that orders bytes otherwise.
    OtherByteOrder,
    /// It was saved by another version.
    OtherVersion {
        /// The one that saved it.
        found: u64,
        /// The one that is understood.
        wanted: u64,
    },
    /// It was built over other geometry.
    OtherGeometry,
    /// It is cut short or was altered.
    Damaged(String),
    /// What is wrong with the scene.
    Scene(AccelError),
}

impl fmt::Display for SavedTreeError {
    fn fmt(&self, f: &mut fmt::Formatter) -> fmt::Result {
        match self {
            Self::Io(e) => write!(f, "{e}"),
            Self::NotSavable(kind) => {
                write!(
                    f,
                    "a {} cannot be saved; trees of the kinds bvh8, bvh8_fast, bvh8_best and bvh8_compact can",
                    kind.name()
                )
            }
            Self::Foreign => write!(f, "this is no saved tree"),
            Self::OtherByteOrder => {
                write!(f, "the tree was saved on a machine with another order of bytes; build it anew")
            }
            Self::OtherVersion { found, wanted } => {
                write!(
                    f,
                    "the tree was saved in version {found} of the format, and this is version {wanted}; build it anew"
                )
            }
            Self::OtherGeometry => write!(f, "the tree was built over other geometry; build it anew"),
            Self::Damaged(what) => write!(f, "the saved tree is damaged: {what}"),
            Self::Scene(e) => write!(f, "{e}"),
        }
    }
}

impl std::error::Error for SavedTreeError {}

impl From<AccelError> for SavedTreeError {
    fn from(e: AccelError) -> Self {
        Self::Scene(e)
    }
}

impl From<io::Error> for SavedTreeError {
    fn from(e: io::Error) -> Self {
        match e.kind() {
            io::ErrorKind::UnexpectedEof => Self::Damaged("it ends too soon".into()),
            _ => Self::Io(e),
        }
    }
}

impl Accel {
    /// Write the trees, without the scene's own arrays. Only the `bvh8` kinds can be saved.
    ///
    /// ```
    /// # use kirkas_accel::*;
    /// # use kirkas_geometry::Vec3;
    /// # use std::sync::Arc;
    /// let balls = (0..1000).map(|i| Sphere { center: Vec3::X * i as f32, radius: 0.4 }).collect();
    /// let shape = Shape::Spheres(Arc::new(balls));
    /// let scene = SceneGeometry { world: vec![Geometry { shape, opaque: true, mask: u32::MAX }], ..Default::default() };
    /// let built = Accel::build(AccelKind::Bvh8Best, scene.clone(), &Serial)?;
    /// let mut file = Vec::new();
    /// built.save(&mut file)?;
    /// let loaded = Accel::load(scene, &mut &file[..])?;
    /// assert_eq!(loaded.statistics(), built.statistics());
    ///
    /// let other = Accel::load(SceneGeometry::default(), &mut &file[..]);
    /// assert!(matches!(other, Err(SavedTreeError::OtherGeometry)));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn save(&self, to: &mut dyn Write) -> Result<(), SavedTreeError> {
        let order = crate::check::build_order(&self.scene)?.order;
        let mut trees = Vec::with_capacity(order.len() + 1);
        for built in order.iter().map(|&i| &self.aggregates[i]).chain([&self.world]) {
            let Structure::Bvh8(tree) = &built.structure else { return Err(SavedTreeError::NotSavable(self.kind())) };
            trees.push(tree);
        }
        let mut to = Writer { to, checksum: Checksum::new() };
        let kind = AccelKind::ALL.iter().position(|(kind, _)| *kind == self.kind()).unwrap_or(0);
        let head = [u64::from_ne_bytes(MARK), BYTE_ORDER, VERSION, kind as u64, fingerprint::of(&self.scene)];
        to.words(&head)?;
        trees.iter().try_for_each(|tree| tree.save(&mut to))?;
        let sum = to.checksum.value();
        to.words(&[sum])?;
        Ok(to.to.flush()?)
    }

    /// Read what [`Accel::save`] wrote, for the scene that it was built over; masks and opacity may be others. What is not
    /// exactly that is refused, and whatever the bytes, what is accepted has passed [`Accel::validate`].
    pub fn load(scene: SceneGeometry, from: &mut dyn Read) -> Result<Accel, SavedTreeError> {
        crate::check::scene(&scene)?;
        let mut from = Reader { from, checksum: Checksum::new() };
        let mark = from.words::<1>().map_err(|e| match e.kind() {
            io::ErrorKind::UnexpectedEof => SavedTreeError::Foreign,
            _ => e.into(),
        })?;
        if mark[0].to_ne_bytes() != MARK {
            return Err(SavedTreeError::Foreign);
        }
        match from.words()? {
            [BYTE_ORDER] => {}
            [order] if order == BYTE_ORDER.swap_bytes() => return Err(SavedTreeError::OtherByteOrder),
            [_] => return Err(SavedTreeError::Damaged("its order of bytes cannot be".into())),
        }
        let [found] = from.words()?;
        if found != VERSION {
            return Err(SavedTreeError::OtherVersion { found, wanted: VERSION });
        }
        let [kind, geometry] = from.words()?;
        let Some(&(kind, _)) = usize::try_from(kind).ok().and_then(|kind| AccelKind::ALL.get(kind)) else {
            return Err(SavedTreeError::Damaged("there is no such kind of tree".into()));
        };
        if geometry != fingerprint::of(&scene) {
            return Err(SavedTreeError::OtherGeometry);
        }
        let accel = Accel::assemble(kind, scene, |geometries, instances| {
            Ok::<_, SavedTreeError>(Structure::Bvh8(wide::Tree::load(geometries, instances, &mut from)?))
        })?;
        let sum = from.checksum.value();
        if from.words()? != [sum] {
            return Err(SavedTreeError::Damaged("its checksum does not fit".into()));
        }
        accel.validate().map_err(SavedTreeError::Damaged)?;
        Ok(accel)
    }
}

/// Writes words and sums them up.
pub(crate) struct Writer<'a> {
    to: &'a mut dyn Write,
    checksum: Checksum,
}

impl Writer<'_> {
    pub fn words(&mut self, words: &[u64]) -> io::Result<()> {
        let mut bytes = Vec::with_capacity(size_of_val(words));
        for &word in words {
            self.checksum.word(word);
            bytes.extend(word.to_ne_bytes());
        }
        self.to.write_all(&bytes)
    }
}

/// Reads words and sums them up.
pub(crate) struct Reader<'a> {
    from: &'a mut dyn Read,
    checksum: Checksum,
}

impl Reader<'_> {
    pub fn words<const N: usize>(&mut self) -> io::Result<[u64; N]> {
        let mut words = [0; N];
        self.fill(&mut words)?;
        Ok(words)
    }

    pub fn fill(&mut self, words: &mut [u64]) -> io::Result<()> {
        let mut bytes = vec![0; size_of_val(words)];
        self.from.read_exact(&mut bytes)?;
        for (word, bytes) in words.iter_mut().zip(bytes.as_chunks().0) {
            *word = u64::from_ne_bytes(*bytes);
            self.checksum.word(*word);
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Counters, Geometry, Query, Serial, Shape, Sphere};
    use kirkas_geometry::hash::combine;
    use kirkas_geometry::{Ray, Vec3};
    use std::sync::Arc;

    fn scene() -> SceneGeometry {
        let vector =
            |i: u64| Vec3::new(combine(i, 1) as i32 as f32, combine(i, 2) as i32 as f32, combine(i, 3) as i32 as f32);
        let positions = (0..60).map(|i| vector(i) * 1e-9).collect();
        let indices = (0..20).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
        let triangles = Shape::Triangles { positions: Arc::new(positions), indices: Arc::new(indices) };
        let balls = (60..80).map(|i| Sphere { center: vector(i) * 1e-9, radius: 0.2 }).collect();
        let world = [triangles, Shape::Spheres(Arc::new(balls))];
        let geometry = |shape| Geometry { shape, opaque: true, mask: u32::MAX };
        SceneGeometry { world: world.map(geometry).into(), ..SceneGeometry::default() }
    }

    /// Altered, and the checksum made to fit.
    fn forged(file: &[u8], at: usize, change: u8) -> Vec<u8> {
        let mut file = file.to_vec();
        file[at] ^= change;
        let end = file.len() - 8;
        let (words, sum) = file.split_at_mut(end);
        let mut checksum = Checksum::new();
        words.as_chunks().0.iter().for_each(|w| checksum.word(u64::from_ne_bytes(*w)));
        sum.copy_from_slice(&checksum.value().to_ne_bytes());
        file
    }

    #[test]
    fn forged_files_are_refused_or_answer_right() {
        let scene = scene();
        let rays: Vec<Ray> = (0..40)
            .map(|i| {
                let a = |k| (combine(k, i) as i32 as f32) * 1e-9;
                Ray::new(Vec3::new(a(4), a(5), a(6)), Vec3::new(a(7), a(8), a(9)))
            })
            .collect();
        let mut accepted = 0;
        for kind in [AccelKind::Bvh8, AccelKind::Bvh8Compact, AccelKind::Bvh8Best] {
            let built = Accel::build(kind, scene.clone(), &Serial).unwrap();
            let mut file = Vec::new();
            built.save(&mut file).unwrap();
            let c = &mut Counters::default();
            let mut expected = vec![None; rays.len()];
            built.closest_hits(&rays, Query::ALL, &mut expected, c);
            for at in 0..file.len() - 8 {
                for bit in 0..8 {
                    let Ok(loaded) = Accel::load(scene.clone(), &mut &forged(&file, at, 1 << bit)[..]) else {
                        continue;
                    };
                    accepted += 1;
                    let mut hits = vec![None; rays.len()];
                    loaded.closest_hits(&rays, Query::ALL, &mut hits, c);
                    // Where primitives are in parts, it is not known how large the boxes must be.
                    assert!(hits == expected || kind == AccelKind::Bvh8Best, "bit {bit} of byte {at}");
                    for (i, ray) in rays.iter().enumerate() {
                        assert_eq!(loaded.closest_hit(ray, Query::ALL, i, c), hits[i]);
                        assert_eq!(loaded.any_hit(ray, Query::ALL, i, c), hits[i].is_some());
                    }
                }
            }
        }
        // Unused lanes, and boxes that grow within those around them.
        assert!(accepted > 100, "{accepted}");
    }
}
