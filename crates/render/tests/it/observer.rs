//! Replay: an observer sees exactly the rays that made a pixel, and what they brought sums to what is stored.

use crate::support::{expose, prepared, prepared_with};
use kirkas_optics::Light;
use kirkas_render::integrators::{PathState, RayKind, ShadowRay};
use kirkas_render::observe::{Observer, PathEnd, SampleId};
use kirkas_render::scene::SurfaceHit;
use kirkas_render::{Options, Prepared};
use std::collections::BTreeMap;

/// Writes everything down.
#[derive(Default)]
struct Recorder {
    rays: Vec<(SampleId, RayKind, u32, u64)>,
    hits: Vec<(u64, f32, u32)>,
    shadows: Vec<(u64, u32, bool)>,
    /// Per light group.
    sums: BTreeMap<u32, [i128; 3]>,
    lights: Vec<Light>,
    ends: Vec<(u64, PathEnd)>,
}

impl Observer for Recorder {
    fn ray(&mut self, id: SampleId, path: &PathState) {
        self.rays.push((id, path.kind, path.depth, path.branch));
    }
    fn hit(&mut self, _: SampleId, path: &PathState, hit: &SurfaceHit) {
        self.hits.push((path.branch, hit.t, hit.object));
    }
    fn shadow(&mut self, _: SampleId, ray: &ShadowRay, blocked: bool) {
        self.shadows.push((ray.branch, ray.lamp, blocked));
    }
    fn contribution(&mut self, _: SampleId, _: u64, group: u32, light: Light, fixed: [i128; 3]) {
        let sum = self.sums.entry(group).or_default();
        (0..3).for_each(|c| sum[c] += fixed[c]);
        self.lights.push(light);
    }
    fn end(&mut self, _: SampleId, branch: u64, why: PathEnd) {
        self.ends.push((branch, why));
    }
}

fn recorded(p: &Prepared, x: u32, y: u32, samples: u32) -> Recorder {
    let mut recorder = Recorder::default();
    p.renderer(64).replay(x, y, 0..samples, &mut recorder);
    recorder
}

#[test]
fn what_a_replay_records_sums_to_the_stored_integers() {
    let toml = include_str!("scenes/everything.toml");
    let files: [(&str, &[u8]); 2] =
        [("gem.obj", include_bytes!("scenes/gem.obj")), ("leaf.png", include_bytes!("scenes/leaf.png"))];
    let p = prepared_with(toml, &files, &Options::default());
    let (film, _) = expose(&p, 0..16);
    let planes = film.layout.planes();
    for (x, y) in [(20, 20), (3, 30), (39, 35), (12, 8), (25, 27), (33, 15)] {
        let r = recorded(&p, x, y, 16);
        let (_, _, tile, i) = film.pixels().find(|f| (f.0, f.1) == (x, y)).expect("inside");
        for plane in 0..planes {
            let sum = r.sums.get(&(plane as u32)).copied().unwrap_or_default();
            assert_eq!(sum, tile.sums[i * planes + plane], "pixel {x},{y}, group {}", film.layout.groups[plane]);
        }
        assert_eq!(r.rays.iter().filter(|r| r.1 == RayKind::Camera).count(), 16);
        assert!(r.rays.iter().all(|r| (r.0.x, r.0.y) == (x, y) && r.0.sample < 16));
        let replayed = p.renderer(1).replay(x, y, 0..16, &mut ());
        assert_eq!(replayed.sums, tile.sums[i * planes..(i + 1) * planes]);
        assert_eq!(replayed.squares[0], tile.squares[i]);
    }
}

/// Two mirrors face each other, each with a grey coat that one lamp between them lights.
const MIRRORS: &str = r#"
[film]
width = 1
height = 1
filter = "point"
[sampler]
samples = 1
[integrator]
max_depth = 3
[cameras.eye]
type = "perspective"
position = [0, 0, 2.5]
look_at = [0, 0, 0]
[lights.lamp]
type = "point"
position = [0, 1, 5]
[materials.coat]
type = "phong"
diffuse = 0.5
reflect = 0.5
[objects.near]
type = "plane"
material = "coat"
normal = [0, 0, 1]
[objects.far]
type = "plane"
material = "coat"
point = [0, 0, 10]
normal = [0, 0, -1]
"#;

#[test]
fn a_mirror_before_a_mirror_gives_a_chain_of_rays() {
    let r = recorded(&prepared(MIRRORS), 0, 0, 1);
    let kinds: Vec<_> = r.rays.iter().map(|r| (r.1, r.2)).collect();
    let chain = [(RayKind::Camera, 0), (RayKind::Reflected, 1), (RayKind::Reflected, 2), (RayKind::Reflected, 3)];
    assert_eq!(kinds, chain);
    // From the eye to the near plane, then to and fro.
    assert_eq!(
        r.hits.iter().map(|h| (h.1.round(), h.2)).collect::<Vec<_>>(),
        [(3.0, 0), (10.0, 1), (10.0, 0), (10.0, 1)]
    );
    assert_eq!(r.shadows.iter().map(|s| (s.1, s.2)).collect::<Vec<_>>(), [(0, false); 4]);
    assert_eq!(r.lights.len(), 4);
    let (first, last) = (r.lights[0][0], r.lights[3][0]);
    assert!((first / last - 8.0).abs() < 1e-5, "each bounce keeps a half: {first} {last}");
    assert_eq!(r.ends, [(r.rays[3].3, PathEnd::Depth)]);
    let mut branches: Vec<u64> = r.rays.iter().map(|r| r.3).collect();
    assert_eq!(branches[0], 0, "the camera ray is the root");
    branches.sort_unstable();
    branches.dedup();
    assert_eq!(branches.len(), 4, "every ray has a branch of its own");
}

#[test]
fn paths_end_for_the_reason_that_is_told() {
    let why = |toml: &str| recorded(&prepared(toml), 0, 0, 1).ends.into_iter().map(|e| e.1).collect::<Vec<_>>();
    assert_eq!(why(MIRRORS), [PathEnd::Depth]);
    let weak = MIRRORS.replace("max_depth = 3", "max_depth = 3\nmin_contribution = 0.3");
    assert_eq!(why(&weak), [PathEnd::Contribution]);
    assert_eq!(why(&MIRRORS.replace("reflect = 0.5", "")), [PathEnd::Absorbed]);
    let open = MIRRORS.replace("point = [0, 0, 10]", "point = [0, 0, 3]\nvisible = false");
    assert_eq!(why(&open.replace("look_at = [0, 0, 0]", "look_at = [0, 9, 9]")), [PathEnd::Escaped]);
}

/// A pane of glass: every hit sends out two rays until the depth is reached.
#[test]
fn a_pane_of_glass_gives_a_tree() {
    let toml = MIRRORS
        .replace(
            "[materials.coat]\ntype = \"phong\"\ndiffuse = 0.5\nreflect = 0.5",
            "[materials.coat]\ntype = \"dielectric\"",
        )
        .replace("max_depth = 3", "max_depth = 2\nmin_contribution = 0");
    let slab = toml.split("[objects.near]").next().expect("a head").to_string()
        + "[objects.slab]\ntype = \"box\"\nmin = [-9, -9, -1]\nmax = [9, 9, 0]\nmaterial = \"coat\"\n";
    let r = recorded(&prepared(&slab), 0, 0, 1);
    let count = |kind, depth| r.rays.iter().filter(|r| (r.1, r.2) == (kind, depth)).count();
    assert_eq!(count(RayKind::Camera, 0), 1);
    // Outside: one mirrored, one refracted; inside at the back: one mirrored, one that leaves.
    assert_eq!((count(RayKind::Reflected, 1), count(RayKind::Refracted, 1)), (1, 1));
    assert_eq!((count(RayKind::Reflected, 2), count(RayKind::Refracted, 2)), (1, 1));
    assert_eq!(r.rays.len(), 5);
    assert!(r.shadows.is_empty(), "clear glass asks no lamp");
    let mut ends: Vec<_> = r.ends.iter().map(|e| format!("{:?}", e.1)).collect();
    ends.sort_unstable();
    assert_eq!(ends, ["Depth", "Escaped", "Escaped"]);
}

/// Every ray of a tree has its own numbers, so no two may have the same branch.
#[test]
fn no_two_rays_of_a_sample_have_the_same_branch() {
    let rough = MIRRORS
        .replace(
            "[materials.coat]\ntype = \"phong\"\ndiffuse = 0.5\nreflect = 0.5",
            "[materials.coat]\ntype = \"rough_dielectric\"\nroughness = 0.1",
        )
        .replace("max_depth = 3", "max_depth = 3\nmin_contribution = 0\nglossy_samples = 5");
    let r = recorded(&prepared(&rough), 0, 0, 1);
    let mut branches: Vec<u64> = r.rays.iter().map(|r| r.3).collect();
    assert!(branches.len() > 20, "{}", branches.len());
    branches.sort_unstable();
    branches.dedup();
    assert_eq!(branches.len(), r.rays.len());
}
