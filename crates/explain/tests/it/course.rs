//! The course's picture of recursion: the same pixel at depths 0, 1, 2 and 3.

use crate::support::scene;
use kirkas_explain::{Style, explain, stories, tree};
use kirkas_render::Prepared;

#[test]
fn each_depth_adds_a_level_to_the_tree_of_the_sphereflake() {
    let at_depth = |depth: u32| {
        let set = format!("integrator.max_depth={depth}");
        scene("sphereflake.toml", &["film.width=200", "film.height=150", "sampler.samples=4", &set])
    };
    let explained = |p: &Prepared, pixel| explain(p, pixel, 0..4, "whitted", "sphereflake.toml", &mut |_| {});
    // Where mirrors face mirrors.
    let p = at_depth(3);
    let places = (40..110).step_by(3).flat_map(|y| (50..150).step_by(3).map(move |x| (x, y)));
    let rays = |&pixel: &(u32, u32)| explained(&p, pixel).trees.iter().map(|s| s.rays.len()).sum::<usize>();
    let pixel = places.max_by_key(rays).expect("a pixel");
    let mut last = 0;
    for depth in 0..4 {
        let p = at_depth(depth);
        let e = explained(&p, pixel);
        for s in &e.trees {
            for n in &s.rays {
                assert!(n.depth <= depth);
                // A mirror sends one ray on; none of these surfaces is clear.
                assert_eq!(n.kind, if n.depth == 0 { "camera" } else { "reflected" });
                let parent = n.parent.map(|p| &s.rays[p]);
                assert_eq!(parent.map(|p| p.depth + 1), (n.depth > 0).then_some(n.depth));
                // It starts where its parent ended, and goes as the law of reflection says.
                if let Some((parent, hit)) = parent.and_then(|p| Some((p, p.hit.as_ref()?))) {
                    let d = |k: usize| f64::from(parent.direction[k]);
                    let along: f64 = (0..3).map(|k| d(k) * hit.shading_normal[k]).sum();
                    for k in 0..3 {
                        assert!((f64::from(n.origin[k]) - hit.position[k]).abs() < 1e-4);
                        let mirrored = d(k) - 2.0 * along * hit.shading_normal[k];
                        assert!((f64::from(n.direction[k]) - mirrored).abs() < 1e-5);
                    }
                }
                // Shadow rays go from every surface that scatters.
                assert_eq!(n.asked.is_empty(), n.hit.is_none());
            }
        }
        let rays: usize = e.trees.iter().map(|s| s.rays.len()).sum();
        assert!(rays > last, "{rays} rays at depth {depth}");
        last = rays;
        let told = stories(&e);
        assert!((told.iter().map(|s| s.share).sum::<f64>() - 1.0).abs() < 1e-9, "{told:#?}");
        let text = tree(&e, &Style { least_share: 0.0, ..Style::default() });
        let deepest = e.trees.iter().flat_map(|s| &s.rays).map(|n| n.depth).max().unwrap();
        assert_eq!(text.matches("mirrored -> ").count() > 0, deepest > 0, "{text}");
    }
}

#[test]
fn a_page_holds_everything_and_loads_nothing() {
    let p = scene("lecture/whitted.toml", &["film.width=120", "film.height=90", "sampler.samples=8"]);
    let mut e = explain(&p, (62, 47), 0..8, "whitted", "</script><b>&", &mut |_| {});
    let html = kirkas_explain::page(&e, &p.scene, Some((b"not a picture", 1, 1)));
    assert!(html.len() < 5_000_000);
    for outside in ["http://", "https://", "src=\"", "href=", "@import", "fetch("] {
        let found = html.replace("http://www.w3.org/2000/svg", "");
        assert!(!found.contains(outside), "{outside}");
    }
    // A name cannot end the script that holds the data.
    assert_eq!(html.matches("</script>").count(), 2);
    assert!(html.contains("bm90IGEgcGljdHVyZQ=="));
    assert!(!html.contains("/*DATA*/") && !html.contains("/*SCRIPT*/") && !html.contains("/*STYLE*/"));
    // Of a great many samples some are left out, and it stays small.
    let trees = e.trees.clone();
    (0..400).for_each(|_| e.trees.extend(trees.iter().cloned()));
    assert!(kirkas_explain::page(&e, &p.scene, None).len() < 5_000_000);
}
