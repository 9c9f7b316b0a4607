//! Contributions add up to the pixel's integers, whatever the scene, the integrator and the way in which colour is carried.

use crate::support::{expose, scene, scenes};
use kirkas_explain::explain;
use kirkas_geometry::hash::combine;
use kirkas_render::{Film, Prepared};
use rayon::prelude::*;

/// The stored integers of a pixel, all light groups together.
fn stored(film: &Film, (x, y): (u32, u32)) -> [i128; 3] {
    let (_, _, tile, i) = film.pixels().find(|p| (p.0, p.1) == (x, y)).expect("inside");
    let planes = film.layout.planes();
    std::array::from_fn(|c| (0..planes).map(|p| tile.sums[i * planes + p][c]).sum())
}

/// The sum of everything that was recorded of samples that count, and how many contributions there were.
fn recorded(p: &Prepared, pixel: (u32, u32)) -> ([i128; 3], usize) {
    let e = explain(p, pixel, 0..p.samples, "", "", &mut |_| {});
    let (mut sums, mut count) = ([0; 3], 0);
    for s in e.trees.iter().filter(|s| !s.is_invalid) {
        let mut own = [0; 3];
        for c in s.contributions().map(|c| c.1).chain(&s.landed) {
            (0..3).for_each(|k| own[k] += c.sums[k]);
            count += 1;
        }
        assert_eq!(own, s.sums);
        (0..3).for_each(|k| sums[k] += own[k]);
        // Every ray but the first hangs on one that came before it.
        assert!(s.rays.iter().enumerate().skip(1).all(|(i, n)| n.parent.is_some_and(|p| p < i)));
        assert_eq!(s.rays[0].parent, None);
        // Every light that was asked has its answer.
        assert!(
            s.rays.iter().flat_map(|n| &n.asked).all(|a| (a.answer.what == "lit") == a.answer.contribution.is_some())
        );
    }
    assert_eq!(sums, e.sums);
    (sums, count)
}

fn check(name: &str, integrator: &str, color: &str, pixels: u64) -> usize {
    let integrator_line = format!("integrator.type={integrator}");
    let color_line = format!("film.color={color}");
    let mut set = vec![
        &*integrator_line,
        &color_line,
        "film.width=24",
        "film.height=18",
        "sampler.samples=2",
        "film.light_groups=true",
    ];
    match integrator {
        "photon" => set.push("integrator.photons=500"),
        "light" => set.push("integrator.particles=500"),
        _ => {}
    }
    let p = scene(name, &set);
    let film = expose(&p);
    let mut contributions = 0;
    for k in 0..pixels {
        let at = combine(7, k);
        let pixel = ((at % 24) as u32, (at >> 32) as u32 % 18);
        let (sums, count) = recorded(&p, pixel);
        assert_eq!(sums, stored(&film, pixel), "{name}, {integrator}, {color}, pixel {pixel:?}");
        contributions += count;
    }
    // A replay changes nothing.
    assert!(expose(&p).pixels().zip(film.pixels()).all(|(a, b)| a.2.sums == b.2.sums));
    contributions
}

/// Every scene with every integrator, colour now carried one way and now the other. `KIRKAS_LONG=1`: both ways, and 200 pixels of each.
#[test]
fn contributions_add_up_to_the_stored_integers_in_every_scene_of_the_gallery() {
    let is_long = std::env::var_os("KIRKAS_LONG").is_some();
    let integrators = ["whitted", "path", "path_simple", "photon", "light"];
    let mut cases = Vec::new();
    for (i, scene) in scenes().into_iter().enumerate() {
        for (k, integrator) in integrators.into_iter().enumerate() {
            // For particles every pixel means a pass anew.
            let pixels = if is_long {
                200
            } else if k < 3 {
                40
            } else {
                4
            };
            for (c, color) in ["rgb", "spectral"].into_iter().enumerate() {
                if is_long || (i + k) % 2 == c {
                    cases.push((scene.clone(), integrator, color, pixels));
                }
            }
        }
    }
    assert!(cases.len() >= 190);
    let found: Vec<usize> = cases.par_iter().map(|(s, i, c, n)| check(s, i, c, *n)).collect();
    let is_empty = |(c, n): &(&(String, &str, &str, u64), &usize)| c.1 == "whitted" && **n == 0;
    let empty: Vec<_> = cases.iter().zip(&found).filter(is_empty).map(|(c, _)| c).collect();
    assert!(empty.is_empty(), "without light: {empty:?}");
}
