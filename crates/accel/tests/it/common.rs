//! Random numbers, shapes, executors, and the comparison with brute force.

use kirkas_accel::*;
use kirkas_geometry::hash::{combine, unit_f32};
use kirkas_geometry::{Bounds3, Ray, Vec3};
use std::sync::Arc;

/// A stream of numbers that a seed names.
pub struct Random(pub u64, pub u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Random(seed, 0)
    }
    pub fn bits(&mut self) -> u32 {
        self.1 += 1;
        combine(self.0, self.1) as u32
    }
    /// In `[0, 1)`.
    pub fn unit(&mut self) -> f32 {
        unit_f32(self.bits())
    }
    pub fn below(&mut self, n: u32) -> u32 {
        self.bits() % n
    }
    /// In the cube `[-1, 1)^3`.
    pub fn cube(&mut self) -> Vec3 {
        Vec3::new(self.unit(), self.unit(), self.unit()) * 2.0 - 1.0
    }
}

pub fn geometry(shape: Shape) -> Geometry {
    Geometry { shape, opaque: true, mask: u32::MAX }
}

pub fn triangles(corners: &[[Vec3; 3]]) -> Shape {
    let indices = (0..corners.len() as u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Shape::Triangles { positions: Arc::new(corners.concat()), indices: Arc::new(indices) }
}

pub fn world(shapes: Vec<Shape>) -> SceneGeometry {
    SceneGeometry { world: shapes.into_iter().map(geometry).collect(), ..SceneGeometry::default() }
}

pub fn build(kind: AccelKind, scene: &SceneGeometry) -> Accel {
    let accel = Accel::build(kind, scene.clone(), &Serial).unwrap();
    accel.validate().unwrap();
    accel
}

pub fn closest(accel: &Accel, ray: &Ray) -> Option<Hit> {
    accel.closest_hit(ray, Query::ALL, 0, &mut Counters::default())
}

/// All of a hit, to the bit.
pub fn bits(hit: Option<Hit>) -> Option<([u32; 3], PrimitiveId)> {
    hit.map(|h| ([h.t, h.u, h.v].map(f32::to_bits), h.id()))
}

/// Every structure answers as brute force does, to the bit, one ray at a time and in batches, with AVX2 and without. Returns how
/// many rays hit, those of a query with a filter counted too.
pub fn assert_agreement(scene: &SceneGeometry, rays: &[Ray]) -> usize {
    let brute = build(AccelKind::BruteForce, scene);
    let built = AccelKind::ALL.map(|(kind, _)| build(kind, scene));
    let portable = [AccelKind::Bvh8, AccelKind::Bvh8Compact].map(|kind| build(kind, scene).portable());
    let others: Vec<&Accel> = built[1..].iter().chain(&portable).collect();
    let queries = [Query::ALL, Query::filtered(&Coin)];
    let c = &mut Counters::default();
    let expected = queries.map(|query| -> Vec<Option<Hit>> {
        rays.iter().enumerate().map(|(i, ray)| brute.closest_hit(ray, query, i, c)).collect()
    });
    for (i, ray) in rays.iter().enumerate() {
        let (query, expected) = (queries[i % 2], expected[i % 2][i]);
        for other in &others {
            let (kind, got) = (other.kind().name(), other.closest_hit(ray, query, i, c));
            assert_eq!(bits(got), bits(expected), "\n{ray:?}\n {kind}  {got:?}\n brute {expected:?}");
            assert_eq!(other.any_hit(ray, query, i, c), expected.is_some(), "{kind}: any hit of {ray:?}");
        }
    }
    // The others answer batches ray by ray.
    for (k, other) in others.iter().enumerate().filter(|(k, other)| *k == 0 || other.kind().name().starts_with("bvh8"))
    {
        let (query, expected) = (queries[k % 2], &expected[k % 2]);
        assert_same_batches(other, rays, query, expected);
    }
    expected.iter().flatten().flatten().count()
}

/// A batch, a batch of shadow rays and packets: the answers to all of them are these.
pub fn assert_same_batches(accel: &Accel, rays: &[Ray], query: Query, expected: &[Option<Hit>]) {
    let (kind, c) = (accel.kind().name(), &mut Counters::default());
    let (mut hits, mut blocked) = (vec![None; rays.len()], vec![false; rays.len()]);
    accel.closest_hits(rays, query, &mut hits, c);
    accel.any_hits(rays, query, &mut blocked, c);
    let mut coherent = vec![None; rays.len()];
    accel.closest_hits_coherent(rays, query, &mut coherent, c);
    for (i, expected) in expected.iter().enumerate() {
        assert_eq!(bits(coherent[i]), bits(*expected), "a packet in {kind}: {:?}", rays[i]);
        assert_eq!(bits(hits[i]), bits(*expected), "a batch in {kind}: {:?}", rays[i]);
        assert_eq!(blocked[i], expected.is_some(), "a batch in {kind}: {:?}", rays[i]);
    }
}

/// Refuses about half of the hits, by a hash of what was hit.
pub struct Coin;

impl HitFilter for Coin {
    fn accept(&self, ray_index: usize, _: &Ray, h: &Hit) -> bool {
        let place = h.instance.iter().fold(0, |k, i| combine(k, i.into()));
        let ids = combine(combine(place, h.geometry.into()), h.primitive.into());
        combine(combine(ids, h.t.to_bits().into()), ray_index as u64) & 1 == 0
    }
}

/// A new thread for one of each two jobs.
pub struct Threads;

impl Executor for Threads {
    fn join(&self, a: &mut (dyn FnMut() + Send), b: &mut (dyn FnMut() + Send)) {
        std::thread::scope(|s| {
            s.spawn(b);
            a();
        });
    }
}

/// A user shape: axis-aligned boxes with an entry and an exit.
pub struct Boxes(pub Vec<Bounds3>);

impl UserShape for Boxes {
    fn len(&self) -> usize {
        self.0.len()
    }
    fn bounds(&self, primitive: u32) -> Bounds3 {
        self.0[primitive as usize]
    }
    fn intersect(&self, primitive: u32, ray: &Ray, visit: &mut dyn FnMut(f32, f32, f32) -> bool) {
        let b = self.0[primitive as usize];
        let (mut near, mut far) = (f64::NEG_INFINITY, f64::INFINITY);
        for k in 0..3 {
            let at = |plane: f32| (f64::from(plane) - f64::from(ray.origin[k])) / f64::from(ray.direction[k]);
            let (t0, t1) = (at(b.min[k]), at(b.max[k]));
            near = near.max(t0.min(t1));
            far = far.min(t0.max(t1));
        }
        if near > far {
            return;
        }
        for t in [near as f32, far as f32] {
            if t > ray.t_min && t < ray.t_max && visit(t, 0.25, 0.5) {
                return;
            }
        }
    }
}

/// A user shape without bounds: the plane of this height above the xz plane.
pub struct Plane(pub f32);

impl UserShape for Plane {
    fn len(&self) -> usize {
        1
    }
    fn bounds(&self, _: u32) -> Bounds3 {
        let mut b = Bounds3::EVERYTHING;
        (b.min.y, b.max.y) = (self.0, self.0);
        b
    }
    fn intersect(&self, _: u32, ray: &Ray, visit: &mut dyn FnMut(f32, f32, f32) -> bool) {
        let t = ((f64::from(self.0) - f64::from(ray.origin.y)) / f64::from(ray.direction.y)) as f32;
        if t > ray.t_min && t < ray.t_max {
            visit(t, 0.0, 0.0);
        }
    }
}
