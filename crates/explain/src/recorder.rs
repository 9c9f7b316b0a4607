//! The observer that writes everything down.

use crate::record::{Answered, Asked, Blocker, Contribution, Explanation, Hit, Node, Sample, Saw, Sending, VERSION};
use kirkas_accel::{Counters, Query};
use kirkas_geometry::hash::combine;
use kirkas_geometry::{DVec3, Ray};
use kirkas_optics::{ColorMode, Light, Lobe};
use kirkas_render::integrators::{PathState, RayKind, ShadowRay};
use kirkas_render::observe::{self, Answer, Fate, Note, Observer, PathEnd, SampleId, Shone, Step};
use kirkas_render::scene::{AlphaFilter, Scene, SurfaceHit};
use kirkas_render::{Prepared, Renderer};
use std::collections::{BTreeMap, HashMap, VecDeque};
use std::ops::Range;

/// Replay samples of a pixel and tell what was seen. `done` is told after each sample how many are done.
pub fn explain(
    prepared: &Prepared,
    pixel: (u32, u32),
    samples: Range<u32>,
    integrator: &str,
    scene: &str,
    done: &mut dyn FnMut(u32),
) -> Explanation {
    let renderer = prepared.renderer(1);
    let mut recorder = Recorder::new(&renderer);
    let (mut sums, mut invalid) = ([0_i128; 3], 0);
    for sample in samples.clone() {
        let tile = renderer.replay(pixel.0, pixel.1, sample..sample + 1, &mut recorder);
        for plane in &tile.sums {
            (0..3).for_each(|c| sums[c] += plane[c]);
        }
        if tile.counts[0].invalid > 0 {
            invalid += 1;
            recorder.samples.entry(sample).or_insert_with(|| Open::new(sample)).sample.is_invalid = true;
        }
        done(sample + 1 - samples.start);
    }
    let valid = f64::from((samples.end - samples.start - invalid).max(1));
    let world = &prepared.scene;
    Explanation {
        version: VERSION,
        kirkas: env!("CARGO_PKG_VERSION").to_string(),
        scene: scene.to_string(),
        integrator: integrator.to_string(),
        accelerator: world.accel.kind().name().to_string(),
        color: world.color.name().to_string(),
        seed: prepared.seed,
        pixel: [pixel.0, pixel.1],
        size: [prepared.film.size.0, prepared.film.size.1],
        samples: [samples.start, samples.end],
        invalid_samples: invalid,
        value: crate::record::color(&sums).map(|c| (c / valid) as f32),
        sums,
        groups: world.groups.clone(),
        trees: recorder.finish(),
    }
}

/// Writes down every sample that is replayed before it.
pub struct Recorder<'a> {
    renderer: &'a Renderer<'a>,
    samples: BTreeMap<u32, Open>,
    target: Target,
}

/// A sample under way.
struct Open {
    sample: Sample,
    /// The ray of each branch, by how many boundaries it has passed.
    places: HashMap<(u64, u32), usize>,
    /// The ray that asked lights last, by branch.
    asking: HashMap<u64, usize>,
    /// Shadow rays under way, by ray: the light that each asks, by its place, and its first direction.
    waiting: HashMap<usize, Vec<(usize, DVec3)>>,
}

/// What the next contribution belongs to.
enum Target {
    /// Found by a ray: what it saw, in order.
    Saw(usize, VecDeque<Saw>),
    /// From a light that was asked: which ray, and which of those that it asked.
    Asked(usize, usize),
    Nobody,
}

impl Open {
    fn new(number: u32) -> Self {
        let sample = Sample { sample: number, sums: [0; 3], is_invalid: false, landed: Vec::new(), rays: Vec::new() };
        Open { sample, places: HashMap::new(), asking: HashMap::new(), waiting: HashMap::new() }
    }
}

impl<'a> Recorder<'a> {
    /// For samples of this renderer.
    pub fn new(renderer: &'a Renderer<'a>) -> Self {
        Recorder { renderer, samples: BTreeMap::new(), target: Target::Nobody }
    }

    /// What was seen, sample by sample.
    pub fn finish(self) -> Vec<Sample> {
        self.samples.into_values().map(|open| open.sample).collect()
    }

    fn scene(&self) -> &'a Scene {
        self.renderer.scene
    }

    fn open(&mut self, id: SampleId) -> &mut Open {
        self.samples.entry(id.sample).or_insert_with(|| Open::new(id.sample))
    }

    /// The place of a path's ray in its sample.
    fn place(&mut self, id: SampleId, path: &PathState, parent: Option<(usize, Option<Sending>)>) -> usize {
        let scene = self.scene();
        let open = self.open(id);
        if let Some(i) = open.places.get(&(path.branch, path.passed)) {
            return *i;
        }
        let i = open.sample.rays.len();
        let sent = parent.as_ref().and_then(|p| p.1.clone());
        open.sample.rays.push(node(scene, path, parent.map(|p| p.0), sent));
        open.places.insert((path.branch, path.passed), i);
        i
    }

    /// What a ray that was blocked met first.
    fn blocker(&self, id: SampleId, shadow: &ShadowRay, from: Option<&Hit>) -> Option<Blocker> {
        let scene = self.scene();
        let key = AlphaFilter::shadow_key(&self.renderer.sampler(id), shadow.branch);
        let filter = AlphaFilter { scene, key: |_| key };
        let hit = scene.accel.closest_hit(&shadow.ray, Query::filtered(&filter), 0, &mut Counters::default())?;
        let surface = scene.surface(&shadow.ray, &hit);
        let (object, material) = names(scene, &surface);
        let distance = f64::from(hit.t * shadow.ray.direction.length());
        let is_same_surface = from.is_some_and(|f| f.object == object && f.primitive == hit.primitive);
        Some(Blocker { object, material, primitive: hit.primitive, distance, is_same_surface })
    }

    fn add(&mut self, id: SampleId, contribution: Contribution) {
        let open = self.samples.entry(id.sample).or_insert_with(|| Open::new(id.sample));
        (0..3).for_each(|c| open.sample.sums[c] += contribution.sums[c]);
        match &mut self.target {
            Target::Saw(node, left) => {
                let unknown =
                    Saw { what: "light", radiance: [0.0; 4], mis_weight: 1.0, contribution: Contribution::NONE };
                let saw = left.pop_front().unwrap_or(unknown);
                open.sample.rays[*node].saw.push(Saw { contribution, ..saw });
            }
            Target::Asked(node, asked) => {
                open.sample.rays[*node].asked[*asked].answer.contribution = Some(contribution);
            }
            Target::Nobody => open.sample.landed.push(contribution),
        }
    }
}

impl Observer for Recorder<'_> {
    fn wants_steps(&self) -> bool {
        true
    }

    fn ray(&mut self, id: SampleId, path: &PathState) {
        let place = self.place(id, path, None);
        let scene = self.scene();
        let key = combine(self.renderer.sampler(id).key(), path.branch);
        let filter = AlphaFilter { scene, key: |_| key };
        let mut counters = Counters::default();
        scene.accel.closest_hit(&path.ray, Query::filtered(&filter), 0, &mut counters);
        let ray = &mut self.open(id).sample.rays[place];
        (ray.nodes, ray.primitives) = (counters.nodes_visited, counters.primitives_tested);
    }

    fn hit(&mut self, id: SampleId, path: &PathState, hit: &SurfaceHit) {
        let place = self.place(id, path, None);
        let (object, material) = names(self.scene(), hit);
        let found = Hit {
            distance: f64::from(hit.t * path.ray.direction.length()),
            position: hit.position.to_array(),
            normal: hit.normal.to_array(),
            shading_normal: hit.shading_normal.to_array(),
            is_front: hit.is_front,
            uv: hit.texture.uv,
            object,
            material,
            primitive: hit.hit.primitive,
        };
        self.open(id).sample.rays[place].hit = Some(found);
    }

    fn step(&mut self, id: SampleId, path: &PathState, step: &Step) {
        let scene = self.scene();
        let place = self.place(id, path, None);
        let (mut saw, mut asked, mut sent, mut not_sent) = (VecDeque::new(), Vec::new(), VecDeque::new(), Vec::new());
        for note in step.notes {
            match note {
                Note::Saw(s) => saw.push_back(Saw {
                    what: shone(s.what),
                    radiance: s.radiance.0,
                    mis_weight: s.weight,
                    contribution: Contribution::NONE,
                }),
                Note::Asked(a) => asked.push((light_asked(scene, a), a.direction)),
                Note::Sent(s) if s.fate == Fate::Goes => sent.push_back(sending(s)),
                Note::Sent(s) => not_sent.push(sending(s)),
            }
        }
        let open = self.open(id);
        let waits = |(_, (a, _)): &(usize, &(Asked, DVec3))| a.answer.what == "lit";
        let waiting = asked.iter().enumerate().filter(waits).map(|(i, (_, direction))| (i, *direction)).collect();
        open.waiting.insert(place, waiting);
        if !step.shadow_rays.is_empty() {
            open.asking.insert(path.branch, place);
        }
        let ray = &mut open.sample.rays[place];
        ray.asked = asked.into_iter().map(|a| a.0).collect();
        ray.not_sent = not_sent;
        for child in step.paths {
            // Behind a boundary that is not there goes the same ray.
            let how = if child.branch == path.branch { None } else { sent.pop_front() };
            self.place(id, child, Some((place, how)));
        }
        self.target = Target::Saw(place, saw);
    }

    fn shadow(&mut self, id: SampleId, ray: &ShadowRay, blocked: bool) {
        let open = self.open(id);
        let Some(&place) = open.asking.get(&ray.branch) else { return };
        // Rays that go on behind clear surfaces keep their direction, but for roundings.
        let direction = ray.ray.direction.as_dvec3().normalize();
        let waiting = open.waiting.entry(place).or_default();
        let likeness = |w: &(usize, DVec3)| w.1.dot(direction);
        let best = (0..waiting.len()).max_by(|&a, &b| likeness(&waiting[a]).total_cmp(&likeness(&waiting[b])));
        let Some(best) = best else { return };
        let (asked, _) = waiting.remove(best);
        if blocked {
            let from = open.sample.rays[place].hit.clone();
            let blocker = self.blocker(id, ray, from.as_ref());
            let answer = &mut self.open(id).sample.rays[place].asked[asked].answer;
            *answer = Answered { what: "blocked", blocker, contribution: None };
            self.target = Target::Nobody;
        } else {
            self.target = Target::Asked(place, asked);
        }
    }

    fn contribution(&mut self, id: SampleId, _branch: u64, group: u32, _light: Light, sums: [i128; 3]) {
        self.add(id, Contribution { group, sums, is_invalid: false });
    }

    fn invalid(&mut self, id: SampleId, _branch: u64, group: u32, _light: Light) {
        self.open(id).sample.is_invalid = true;
        self.add(id, Contribution { group, sums: [0; 3], is_invalid: true });
    }

    fn landed(&mut self, id: SampleId, group: u32, sums: [i128; 3]) {
        self.target = Target::Nobody;
        if sums != [0; 3] {
            self.add(id, Contribution { group, sums, is_invalid: false });
        }
    }

    fn end(&mut self, id: SampleId, branch: u64, why: PathEnd) {
        let open = self.open(id);
        let passed = |(key, i): (&(u64, u32), &usize)| (key.0 == branch).then_some((key.1, *i));
        if let Some((_, place)) = open.places.iter().filter_map(passed).max() {
            open.sample.rays[place].ended = Some(match why {
                PathEnd::Escaped => "escaped",
                PathEnd::Absorbed => "absorbed",
                PathEnd::Depth => "depth",
                PathEnd::Contribution => "contribution",
                PathEnd::Roulette => "roulette",
            });
        }
    }
}

fn node(scene: &Scene, path: &PathState, parent: Option<usize>, sent: Option<Sending>) -> Node {
    let Ray { origin, direction, time, .. } = path.ray;
    let kind = match path.kind {
        _ if path.passed > 0 => "passed",
        RayKind::Camera => "camera",
        RayKind::Reflected => "reflected",
        RayKind::Refracted => "refracted",
        RayKind::Glossy => "glossy",
        RayKind::Diffuse => "diffuse",
    };
    let name = |&m: &u32| scene.materials[m as usize].name.clone();
    Node {
        parent,
        kind,
        depth: path.depth,
        origin: origin.to_array(),
        direction: direction.normalize().to_array(),
        time,
        wavelengths: (path.lanes.mode() == ColorMode::Spectral).then(|| path.lanes.nanometres()),
        throughput: path.throughput.0,
        inside: path.media.materials().iter().map(name).collect(),
        sent,
        hit: None,
        saw: Vec::new(),
        asked: Vec::new(),
        not_sent: Vec::new(),
        ended: None,
        nodes: 0,
        primitives: 0,
    }
}

/// Of object and material.
fn names(scene: &Scene, hit: &SurfaceHit) -> (String, String) {
    let object = scene.object_names.get(hit.object as usize).cloned().unwrap_or_default();
    (object, scene.material(hit).name.clone())
}

fn light_asked(scene: &Scene, a: &observe::Asked) -> Asked {
    let what = match a.answer {
        // Until it is answered.
        Answer::Waits => "lit",
        Answer::NoLight => "no_light",
        Answer::Dark => "dark",
        Answer::Behind => "behind",
        Answer::Black => "black",
    };
    Asked {
        light: a.lamp.map(|n| scene.lights[n as usize].name.clone()),
        chance: a.chance,
        direction: a.direction.to_array(),
        distance: a.distance,
        radiance_over_pdf: a.light.0,
        pdf: a.pdf,
        bsdf: a.bsdf.0,
        cosine: a.cosine,
        mis_weight: a.weight,
        answer: Answered { what, blocker: None, contribution: None },
    }
}

fn sending(s: &observe::Sent) -> Sending {
    let lobe = match s.lobe {
        Some(Lobe::DiffuseReflection) => Some("diffuse_reflection"),
        Some(Lobe::GlossyReflection) => Some("glossy_reflection"),
        Some(Lobe::DeltaReflection) => Some("mirror"),
        Some(Lobe::DiffuseTransmission) => Some("diffuse_transmission"),
        Some(Lobe::GlossyTransmission) => Some("glossy_transmission"),
        Some(Lobe::DeltaTransmission) => Some("refraction"),
        None => (s.pdf > 0.0).then_some("medium"),
    };
    let fate = match s.fate {
        Fate::Goes => "goes",
        Fate::Swallowed => "swallowed",
        Fate::WrongSide => "wrong_side",
        Fate::Roulette => "roulette",
        Fate::TooWeak => "too_weak",
    };
    Sending { lobe, bsdf: s.bsdf.0, pdf: s.pdf, cosine: s.cosine, survival: s.survival, fate }
}

fn shone(what: Shone) -> &'static str {
    match what {
        Shone::Surface => "surface",
        Shone::Background => "background",
        Shone::Medium => "medium",
        Shone::Ambient => "ambient",
        Shone::Photons => "photons",
        Shone::Light => "light",
    }
}
