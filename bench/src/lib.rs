//! The ray kernel beside Embree 3: identical rays in one process, passes interleaved, thread-CPU time, medians.
//! `cargo run --release -p kirkas-bench --bin kernel -- --help`.

pub mod options;
pub mod scenes;

pub mod builds;
pub mod growth;
pub mod rays;

pub mod clock;
pub mod embree;
pub mod kirkas;
pub mod report;
pub mod tracer;

use embree::Embree;
use options::Options;

/// Do what the options ask, and write the results.
pub fn run(options: &Options) -> Result<(), String> {
    let embree = if options.embree { Embree::load() } else { Err("not asked for".into()) };
    match &embree {
        Ok(e) => println!("Embree {}", e.version()),
        Err(why) => println!("Embree: {why}"),
    }
    let embree = embree.ok();
    if !options.sizes.is_empty() {
        return report::write(options.json.as_deref(), &growth::measure(options, embree.as_ref())?);
    }
    let (mut rays, mut builds) = (Vec::new(), Vec::new());
    for name in &options.scenes {
        let Some(scene) = scenes::load(name)? else {
            println!("{name}: skipped, it needs the folder that KIRKAS_DATA names");
            continue;
        };
        println!("\n{}: {} triangles", scene.name, scene.indices.len());
        if options.rays {
            rays.extend(rays::measure(&scene, options, embree.as_ref())?);
        }
        if options.builds {
            builds.extend(builds::measure(&scene, options, embree.as_ref())?);
        }
    }
    report::geometric_means(&rays);
    report::write(options.json.as_deref(), &rays)?;
    report::write(options.json.as_deref().map(|f| f.with_extension("builds.json")).as_deref(), &builds)
}
