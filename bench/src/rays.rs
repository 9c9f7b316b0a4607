//! Traversal: every ray set through every structure of ours and theirs, one after the other in each pass.

use crate::clock::{Median, median};
use crate::embree::{Embree, Quality};
use crate::kirkas;
use crate::options::Options;
use crate::report::{RAY_HEAD, RayRow};
use crate::scenes::Scene;
use crate::tracer::{Answer, Tracer, Way, agreement};
use kirkas_accel::Serial;
use kirkas_accel::ray_sets::{self, RaySet, Setup};
use kirkas_geometry::Ray;

/// The seed of every set.
const SEED: u64 = 1;

/// Hits must agree for this part of the rays.
const ENOUGH: f64 = 0.9999;

/// One way of tracing that is timed.
struct Contender<'a> {
    name: &'static str,
    tracer: &'a dyn Tracer,
    way: Way,
}

/// What a contender did.
struct Outcome {
    mrays: Median,
    answers: Vec<Answer>,
}

/// Trace a scene. The first structure makes the rays.
pub fn measure(scene: &Scene, options: &Options, embree: Option<&Embree>) -> Result<Vec<RayRow>, String> {
    let accels =
        options.accels.iter().map(|kind| kirkas::build(*kind, scene, &Serial)).collect::<Result<Vec<_>, _>>()?;
    let prepared = embree.map(|e| e.prepare(scene, 1, options.isa.as_deref())).transpose()?;
    let qualities = [Quality::HIGH, Quality::ROBUST, Quality::MEDIUM];
    let theirs = prepared.iter().flat_map(|p| qualities.map(|q| p.build(q))).collect::<Result<Vec<_>, _>>()?;
    let setup = Setup { camera: scene.camera, bounds: scene.bounds(), side: options.side, seed: SEED };

    println!("{RAY_HEAD}");
    let mut rows = Vec::new();
    for &(set, set_name) in &options.sets {
        let rays = ray_sets::rays(set, &setup, ray_sets::nearest_in(&accels[0]));
        if rays.is_empty() {
            println!("  {set_name:9} no ray stays in the scene");
            continue;
        }
        let mut ways = vec![Way::Single, Way::Batch];
        ways.extend((set == RaySet::Primary).then_some(Way::Packet));
        let ours = accels.iter().flat_map(|accel| {
            let tracer: &dyn Tracer = accel;
            ways.iter().map(move |way| Contender { name: accel.kind().name(), tracer, way: *way })
        });
        let their_ways = ways.iter().filter(|w| **w != Way::Batch);
        let theirs = their_ways.flat_map(|way| {
            let named = theirs.iter().zip(qualities);
            named.map(|(built, q)| Contender { name: q.name, tracer: built, way: *way })
        });
        let contenders: Vec<Contender> = ours.chain(theirs).collect();
        let outcomes = compete(&contenders, &rays, set.asks_any(), options.passes);

        let find = |name: &str, way: Way| {
            contenders.iter().zip(&outcomes).find(|(c, _)| (c.name, c.way) == (name, way)).map(|(_, o)| o)
        };
        for (accel, way) in accels.iter().flat_map(|a| ways.iter().map(move |w| (a, *w))) {
            let Some(outcome) = find(accel.kind().name(), way) else { continue };
            // Theirs has no call for many rays of any order: a batch stands beside single rays.
            let their_way = if way == Way::Batch { Way::Single } else { way };
            let [high, robust, medium] = qualities.map(|q| find(q.name, their_way));
            let agree = |o: &Outcome| agreement(&outcome.answers, &o.answers, set.asks_any());
            let counters = kirkas::counters(accel, &rays, set.asks_any());
            let row = RayRow {
                scene: scene.name.clone(),
                rays: set_name,
                mode: way.name(),
                accel: accel.kind().name(),
                count: rays.len(),
                kirkas: outcome.mrays,
                embree: high.map(|o| o.mrays),
                embree_robust: robust.map(|o| o.mrays),
                embree_default: medium.map(|o| o.mrays),
                agreement: high.map(agree),
                hits_equal: high.map(|o| agree(o) >= ENOUGH),
                nodes_per_ray: counters.nodes_visited as f64 / rays.len() as f64,
                primitives_per_ray: counters.primitives_tested as f64 / rays.len() as f64,
            };
            row.print();
            rows.push(row);
        }
    }
    Ok(rows)
}

/// Every contender once a pass, so that all see the same weather.
fn compete(contenders: &[Contender], rays: &[Ray], any: bool, passes: usize) -> Vec<Outcome> {
    let mut seconds = vec![Vec::new(); contenders.len()];
    let mut answers = vec![Vec::new(); contenders.len()];
    for _ in 0..passes {
        for (k, c) in contenders.iter().enumerate() {
            let (took, found) = c.tracer.trace(rays, any, c.way);
            seconds[k].push(rays.len() as f64 / took.max(1e-9) * 1e-6);
            answers[k] = found;
        }
    }
    seconds.iter().zip(answers).map(|(s, answers)| Outcome { mrays: median(s), answers }).collect()
}
