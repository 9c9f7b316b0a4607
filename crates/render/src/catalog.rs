//! Everything that can be said in a scene: the lists of all kinds, put together.

use crate::{background, camera, film, integrators, lights, materials, media, sampler, shapes, textures};
use kirkas_accel::AccelKind;
use kirkas_scene::{Catalog, Kind, TypeSpec};

const BVH2: TypeSpec = TypeSpec {
    kind: Kind::Accelerator,
    name: "bvh2",
    doc: "Binary bounding-volume hierarchy, built by the surface-area heuristic.",
    params: &[],
};
const BVH8: TypeSpec = TypeSpec {
    kind: Kind::Accelerator,
    name: "bvh8",
    doc: "Bounding-volume hierarchy with eight children to a node and eight triangles to a leaf, tested at once; built by the surface-area heuristic. The default for pictures.",
    params: &[],
};
const BVH8_FAST: TypeSpec = TypeSpec {
    kind: Kind::Accelerator,
    name: "bvh8_fast",
    doc: "`bvh8`, built along a Morton curve in a fraction of the time. The default for frames of films in which something moves.",
    params: &[],
};
const BVH8_BEST: TypeSpec = TypeSpec {
    kind: Kind::Accelerator,
    name: "bvh8_best",
    doc: "`bvh8` with spatial splits (Stich, Friedrich & Dietrich 2009), then improved by reinsertion (Meister & Bittner 2018): slower to build, quickest to trace, most of all where triangles are long and thin.",
    params: &[],
};
const BVH8_COMPACT: TypeSpec = TypeSpec {
    kind: Kind::Accelerator,
    name: "bvh8_compact",
    doc: "`bvh8` with leaves that hold numbers instead of corners: about a third of the memory, slower to trace.",
    params: &[],
};
const BRUTE_FORCE: TypeSpec = TypeSpec {
    kind: Kind::Accelerator,
    name: "brute_force",
    doc: "Every ray against every primitive: the test of all others.",
    params: &[],
};
const KD_TREE: TypeSpec = TypeSpec {
    kind: Kind::Accelerator,
    name: "kd_tree",
    doc: "Kd-tree: space is halved by the planes of least expected cost, all of them weighed, in O(n log n) (Wald & Havran 2006). Nodes of 8 bytes; slow to build, quick to trace.",
    params: &[],
};
const KD_TREE_FAST: TypeSpec = TypeSpec {
    kind: Kind::Accelerator,
    name: "kd_tree_fast",
    doc: "Kd-tree of which the planes are chosen among evenly spaced ones (Hunt, Mark & Stoll 2006): built in half the time, for moving scenes.",
    params: &[],
};
const GRID: TypeSpec = TypeSpec {
    kind: Kind::Accelerator,
    name: "grid",
    doc: "Uniform grid, walked from cell to cell (Amanatides & Woo 1987), four cells to a primitive: very quick to build, good for what is small and evenly spread.",
    params: &[],
};
const SPHERE_HIERARCHY: TypeSpec = TypeSpec {
    kind: Kind::Accelerator,
    name: "sphere_hierarchy",
    doc: "Binary hierarchy of bounding spheres (Rubin & Whitted 1980): the comparison that speaks for boxes.",
    params: &[],
};

/// Every accelerator type.
pub const ACCELERATORS: &[(&TypeSpec, AccelKind)] = &[
    (&BVH8, AccelKind::Bvh8),
    (&BVH8_FAST, AccelKind::Bvh8Fast),
    (&BVH8_BEST, AccelKind::Bvh8Best),
    (&BVH8_COMPACT, AccelKind::Bvh8Compact),
    (&BVH2, AccelKind::Bvh2),
    (&KD_TREE, AccelKind::KdTree),
    (&KD_TREE_FAST, AccelKind::KdTreeFast),
    (&GRID, AccelKind::Grid),
    (&SPHERE_HIERARCHY, AccelKind::SphereHierarchy),
    (&BRUTE_FORCE, AccelKind::BruteForce),
];

/// The catalogue of this build.
pub fn catalog() -> Catalog {
    let mut types: Vec<&'static TypeSpec> = vec![&film::SPEC];
    types.extend(sampler::SAMPLERS);
    types.extend(integrators::INTEGRATORS.iter().map(|i| i.spec));
    types.extend(ACCELERATORS.iter().map(|a| a.0));
    types.extend(background::BACKGROUNDS);
    types.extend(camera::CAMERAS.iter().copied());
    types.extend(lights::LIGHTS);
    types.extend(textures::TEXTURES.iter().copied());
    types.extend(kirkas_optics::phase::SPECS);
    types.extend(media::MEDIA.iter().copied());
    types.extend(kirkas_optics::SPECS);
    types.extend(shapes::SHAPES.iter().map(|s| s.spec));
    types.extend([&shapes::GROUP, &shapes::INSTANCE]);
    Catalog {
        types,
        common: vec![
            (Kind::Background, background::COMMON),
            (Kind::Camera, camera::COMMON),
            (Kind::Light, lights::COMMON),
            (Kind::Texture, textures::COMMON),
            (Kind::Medium, media::COMMON),
            (Kind::Material, materials::COMMON),
            (Kind::Object, shapes::COMMON),
        ],
    }
}
