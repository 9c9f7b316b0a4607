//! A garden of everything that can be hit, and every question that can be asked of it:
//! `cargo run --release -p kirkas-accel --example ask`.

use kirkas_accel::*;
use kirkas_geometry::transform::rotation;
use kirkas_geometry::{AnimatedTransform, DAffine3, DVec3, Ray, Vec3};
use std::error::Error;
use std::sync::Arc;

fn main() -> Result<(), Box<dyn Error>> {
    let accel = Accel::build(AccelKind::default(), garden(), &Serial)?;
    accel.validate()?;
    println!("{:?}\n{:?}\n", accel.kind(), accel.statistics());
    let counters = &mut Counters::default();

    // A picture: one ray per character, all in one batch.
    let rays: Vec<Ray> = (0..14).flat_map(|y| (0..78).map(move |x| camera_ray(x, y))).collect();
    let mut hits = vec![None; rays.len()];
    accel.closest_hits(&rays, Query::ALL, &mut hits, counters);
    for row in hits.chunks(78) {
        println!("{}", row.iter().map(symbol).collect::<String>().trim_end());
    }

    // Which of the points that are seen lie in the shade?
    let sun = Vec3::new(0.5, 1.0, 0.3);
    let seen: Vec<(&Ray, Hit)> = rays.iter().zip(&hits).filter_map(|(ray, hit)| Some((ray, (*hit)?))).collect();
    let shadow_rays: Vec<Ray> = seen.iter().map(|(ray, hit)| Ray::new(ray.at(hit.t), sun)).collect();
    let excluded: Vec<Option<PrimitiveId>> = seen.iter().map(|(_, hit)| Some(hit.id())).collect();
    let mut shaded = vec![false; shadow_rays.len()];
    accel.any_hits(&shadow_rays, Query::ALL.excluding(&excluded), &mut shaded, counters);
    println!("\n{} of {} points are in the shade", shaded.iter().filter(|s| **s).count(), shaded.len());

    // Everything along one ray.
    let ray = Ray::new(Vec3::new(-9.0, 0.9, 0.0), Vec3::X);
    println!("\nalong {:?} + t {:?}:", ray.origin, ray.direction);
    accel.all_hits(&ray, Query::ALL, 0, counters, &mut |hit| {
        println!("  t = {:<9} {}", hit.t, name(hit));
        false
    });

    // What is near?
    let from = Vec3::new(0.0, 4.0, 0.0);
    if let Some(near) = accel.closest_point(&PointQuery::new(from, 10.0)) {
        println!("\n{} from {from:?} lies {:?}, geometry {}", near.distance, near.position, near.geometry);
    }
    println!("\n{counters:?}");
    Ok(())
}

/// The world: ground, fence, ball and table top; a flower, placed within a bed that is placed twice.
fn garden() -> SceneGeometry {
    let geometry = |shape| Geometry { shape, opaque: true, mask: u32::MAX };
    let v = Vec3::new;
    let ground = Shape::Quads {
        positions: Arc::new(vec![v(-9.0, 0.0, -9.0), v(9.0, 0.0, -9.0), v(9.0, 0.0, 9.0), v(-9.0, 0.0, 9.0)]),
        indices: Arc::new(vec![[0, 1, 2, 3]]),
    };
    let fence = (-8..=8).map(|x| Cylinder { ends: [v(x as f32, 0.0, -4.0), v(x as f32, 1.5, -4.0)], radius: 0.1 });
    let ball = Sphere { center: v(0.0, 1.0, 0.0), radius: 1.0 };
    let table = Disk { center: v(4.0, 1.2, 0.5), normal: Vec3::Y, radius: 1.3 };
    let stem = [(0.0, 0.0, 0.08), (0.1, 0.5, 0.06), (0.0, 1.0, 0.05), (0.2, 1.4, 0.15)];
    let stem = stem.map(|(x, y, radius)| CurvePoint { position: v(x, y, 0.0), radius });
    let flower = Shape::Curves { points: Arc::new(stem.to_vec()), segments: Arc::new(vec![0, 1, 2]) };
    let place = |x: f64, z: f64, degrees: f64| {
        let turn = rotation(DVec3::Y, degrees);
        AnimatedTransform::still(DAffine3 { matrix3: turn, translation: DVec3::new(x, 0.0, z) })
    };
    let instance = |aggregate, outer_from_object| Instance { aggregate, outer_from_object, mask: u32::MAX };
    let bed = (0..5).map(|k| instance(0, place(0.7 * f64::from(k), 0.0, 70.0 * f64::from(k)))).collect();
    SceneGeometry {
        world: vec![
            geometry(ground),
            geometry(Shape::Cylinders(Arc::new(fence.collect()))),
            geometry(Shape::Spheres(Arc::new(vec![ball]))),
            geometry(Shape::Disks(Arc::new(vec![table]))),
        ],
        aggregates: vec![vec![geometry(flower)].into(), Aggregate { geometries: vec![], instances: bed }],
        instances: vec![instance(1, place(-5.0, 0.0, 0.0)), instance(1, place(-4.5, 2.0, 20.0))],
        shutter: (0.0, 0.0),
    }
}

fn camera_ray(x: i32, y: i32) -> Ray {
    let direction = Vec3::new((x as f32 - 38.5) / 60.0, (1 - y) as f32 / 30.0, -1.0);
    Ray::new(Vec3::new(0.0, 2.5, 10.0), direction)
}

fn symbol(hit: &Option<Hit>) -> char {
    match hit {
        None => ' ',
        Some(hit) if !hit.instance.is_world() => 'Y',
        Some(hit) => ['.', '|', 'O', '='][hit.geometry as usize],
    }
}

fn name(hit: &Hit) -> String {
    match hit.instance.is_world() {
        true => format!("primitive {} of geometry {}", hit.primitive, hit.geometry),
        false => format!(
            "segment {} of a flower, by the instances {:?}",
            hit.primitive,
            hit.instance.iter().collect::<Vec<_>>()
        ),
    }
}
