//! Our side.

use crate::clock::Clock;
use crate::scenes::Scene;
use crate::tracer::{Answer, Tracer, Way};
use kirkas_accel::{Accel, AccelKind, Counters, Executor, Geometry, Hit, Query, SceneGeometry, Shape};
use kirkas_geometry::Ray;
use std::sync::Arc;

/// Build a structure over a scene.
pub fn build(kind: AccelKind, scene: &Scene, executor: &dyn Executor) -> Result<Accel, String> {
    let shape = Shape::Triangles { positions: Arc::clone(&scene.positions), indices: Arc::clone(&scene.indices) };
    let world = vec![Geometry { shape, opaque: true, mask: u32::MAX }];
    Accel::build(kind, SceneGeometry { world, ..SceneGeometry::default() }, executor).map_err(|e| e.to_string())
}

/// What one call for each ray set costs.
pub fn counters(accel: &Accel, rays: &[Ray], any: bool) -> Counters {
    let mut counters = Counters::default();
    if any {
        accel.any_hits(rays, Query::ALL, &mut vec![false; rays.len()], &mut counters);
    } else {
        accel.closest_hits(rays, Query::ALL, &mut vec![None; rays.len()], &mut counters);
    }
    counters
}

impl Tracer for Accel {
    fn trace(&self, rays: &[Ray], any: bool, way: Way) -> (f64, Vec<Answer>) {
        let counters = &mut Counters::default();
        if any {
            let mut hits = vec![true; rays.len()];
            let seconds = Clock::Thread.seconds(|| match way {
                Way::Single => {
                    for (i, (ray, hit)) in rays.iter().zip(&mut hits).enumerate() {
                        *hit = self.any_hit(ray, Query::ALL, i, counters);
                    }
                }
                Way::Packet | Way::Batch => self.any_hits(rays, Query::ALL, &mut hits, counters),
            });
            let answer = |hit: bool| if hit { Answer { t: 0.0, primitive: 0 } } else { Answer::MISS };
            return (seconds, hits.into_iter().map(answer).collect());
        }
        let mut hits: Vec<Option<Hit>> = vec![None; rays.len()];
        let seconds = Clock::Thread.seconds(|| match way {
            Way::Single => {
                for (i, (ray, hit)) in rays.iter().zip(&mut hits).enumerate() {
                    *hit = self.closest_hit(ray, Query::ALL, i, counters);
                }
            }
            Way::Batch => self.closest_hits(rays, Query::ALL, &mut hits, counters),
            Way::Packet => self.closest_hits_coherent(rays, Query::ALL, &mut hits, counters),
        });
        let answer = |hit: Option<Hit>| hit.map_or(Answer::MISS, |h| Answer { t: h.t, primitive: h.primitive });
        (seconds, hits.into_iter().map(answer).collect())
    }
}

/// Threads that a build may use.
pub struct Threads(rayon::ThreadPool);

impl Threads {
    /// A pool of `count` threads.
    pub fn new(count: usize) -> Result<Self, String> {
        rayon::ThreadPoolBuilder::new().num_threads(count).build().map(Threads).map_err(|e| e.to_string())
    }

    /// Run `job` in the pool.
    pub fn run<R: Send>(&self, job: impl FnOnce() -> R + Send) -> R {
        self.0.install(job)
    }
}

impl Executor for Threads {
    fn join(&self, a: &mut (dyn FnMut() + Send), b: &mut (dyn FnMut() + Send)) {
        rayon::join(a, b);
    }
}
