//! What may be wrong with a pixel, and who is to blame. A finding is said only where the record leaves little doubt.

use crate::record::{Explanation, Node, Sample};
use crate::story::{percent, plural, total};
use std::collections::BTreeMap;

/// Something that may be wrong.
#[derive(Clone, Debug, PartialEq)]
pub struct Finding {
    /// A short name for it that does not change.
    pub code: &'static str,
    /// What it is, with the culprit's name.
    pub text: String,
    /// What can be done.
    pub cure: String,
}

/// All that is found, the gravest first.
pub fn findings(e: &Explanation) -> Vec<Finding> {
    [not_finite(e), firefly(e), black(e), acne(e), too_much_energy(e), depth_limit(e)].into_iter().flatten().collect()
}

/// Samples at least, lest chance be taken for a rule.
const FEW: usize = 8;
/// Of so many samples one that alone finds light is no longer mere bad luck.
const MANY: usize = 32;

fn not_finite(e: &Explanation) -> Option<Finding> {
    let bad = |s: &Sample| s.contributions().find(|(_, c)| c.is_invalid).map(|(i, _)| i);
    let (sample, i) = e.trees.iter().find_map(|s| Some((s, bad(s)?)))?;
    // The first surface on the way whose numbers are no longer numbers; or what shines at its end.
    let mut way = vec![i];
    while let Some(parent) = sample.rays[way[way.len() - 1]].parent {
        way.push(parent);
    }
    let is_bad = |v: &[f32; 4]| !v.iter().all(|v| v.is_finite());
    let node = &sample.rays[i];
    let first = way.iter().rev().copied().find(|&i| is_bad(&sample.rays[i].throughput));
    let asked = node.asked.iter().find(|a| a.answer.contribution.as_ref().is_some_and(|c| c.is_invalid));
    let culprit = match (first.and_then(|i| sample.rays[i].parent), asked) {
        (Some(parent), _) => place(&sample.rays[parent]),
        (None, Some(a)) if is_bad(&a.bsdf) => place(node),
        (None, Some(a)) => format!("the light `{}`", a.light.as_deref().unwrap_or("?")),
        (None, None) => place(node),
    };
    Some(Finding {
        code: "not-finite",
        text: format!(
            "{} not finite, or absurdly bright, and left out; in sample {} it begins at {culprit}",
            if e.invalid_samples == 1 { "1 sample is".into() } else { format!("{} samples are", e.invalid_samples) },
            sample.sample
        ),
        cure: "look at that material's values and textures for NaN, infinity, or numbers that are far too large".into(),
    })
}

/// Object and material at a ray's end.
fn place(n: &Node) -> String {
    n.hit.as_ref().map_or("the background".into(), |h| format!("`{}` (material `{}`)", h.object, h.material))
}

fn firefly(e: &Explanation) -> Option<Finding> {
    const MOST: f64 = 0.5;
    let light = |s: &Sample| crate::record::color(&s.sums).iter().sum::<f64>();
    let whole = total(e);
    let brightest = e.trees.iter().filter(|s| !s.is_invalid).max_by(|a, b| light(a).total_cmp(&light(b)))?;
    if e.trees.len() < FEW || whole <= 0.0 || light(brightest) < MOST * whole {
        return None;
    }
    // Of few samples that find a small lamp, one may well carry half: only what towers above others that found light as well is one.
    let mut others: Vec<f64> = e.trees.iter().filter(|s| s.sample != brightest.sample).map(light).collect();
    others.sort_by(f64::total_cmp);
    let lit = others.iter().filter(|l| **l > 0.0).count();
    let is_alone = lit * 4 < others.len() && e.trees.len() < MANY;
    if is_alone || light(brightest) < 10.0 * others[others.len() - 1] {
        return None;
    }
    let (i, _) = brightest
        .contributions()
        .max_by(|a, b| a.1.color().iter().sum::<f64>().total_cmp(&b.1.color().iter().sum()))?;
    // A light that is asked for answers moderately, unless what asks concentrates its light.
    let found_itself = !brightest.rays[i].saw.is_empty();
    let concentrates = |a: &crate::record::Asked| a.bsdf.iter().any(|f| f * a.cosine > 3.0);
    let is_strong = brightest.rays[i].throughput.iter().any(|t| *t > 3.0);
    if !found_itself && !is_strong && !brightest.rays[i].asked.iter().any(concentrates) {
        return None;
    }
    // The least likely step on its way.
    let mut rarest: Option<(f32, &Node)> = None;
    let mut at = Some(i);
    while let Some(i) = at {
        let node = &brightest.rays[i];
        if let (Some(sent), Some(parent)) = (&node.sent, node.parent) {
            let weight = sent.bsdf.iter().fold(0.0_f32, |m, v| m.max(*v)) * sent.cosine / sent.pdf;
            if sent.pdf > 0.0 && rarest.is_none_or(|r| weight > r.0) {
                rarest = Some((weight, &brightest.rays[parent]));
            }
        }
        at = node.parent;
    }
    let node = &brightest.rays[i];
    let source = match (&node.hit, node.saw.is_empty()) {
        (Some(hit), false) => format!("a ray that chanced upon `{}`", hit.object),
        (None, false) => "a ray that chanced upon the background".into(),
        _ => format!("a light asked from {}", place(node)),
    };
    let way = rarest.map_or(String::new(), |(weight, from)| {
        let pdf = node.sent.as_ref().map_or(0.0, |s| s.pdf);
        format!(", sent by {} with weight {weight:.3} and density {pdf:.3e} per steradian", place(from))
    });
    Some(Finding {
        code: "firefly",
        text: format!(
            "sample {} alone brings {} of the pixel: {source}{way}",
            brightest.sample,
            percent(light(brightest) / whole)
        ),
        cure: "make the lamp larger, the surface rougher, or choose an integrator that finds such light (`photon`, `light`)".into(),
    })
}

fn black(e: &Explanation) -> Option<Finding> {
    if total(e) > 0.0 || e.trees.is_empty() || e.invalid_samples as usize == e.trees.len() {
        return None;
    }
    let finding = |text: String, cure: &str| Some(Finding { code: "black", text, cure: cure.into() });
    // What the camera sees first.
    let first = |s: &Sample| s.rays.iter().find(|n| n.hit.is_none() || n.kind != "passed").cloned();
    let firsts: Vec<Node> = e.trees.iter().filter_map(first).collect();
    if firsts.iter().all(|n| n.hit.is_none()) {
        return finding(
            "every ray leaves the scene, and the background is black".into(),
            "give the scene a `[background]`",
        );
    }
    let seen = most(firsts.iter().filter_map(|n| Some(n.hit.as_ref()?.object.clone())))?;
    let all: Vec<&Node> = e.trees.iter().flat_map(|s| &s.rays).collect();
    let material = firsts.iter().find_map(|n| n.hit.as_ref().filter(|h| h.object == seen))?.material.clone();
    let asked: Vec<_> = all.iter().flat_map(|n| &n.asked).collect();
    let ended = |why| firsts.iter().filter(|n| n.ended == Some(why)).count();
    let is_from_behind =
        firsts.iter().filter(|n| n.hit.as_ref().is_some_and(|h| !h.is_front)).count() * 2 > firsts.len();
    if ended("depth") * 2 > firsts.len() {
        return finding(
            format!("the path ends at `{seen}`, since the greatest depth is reached there"),
            "raise `integrator.max_depth`",
        );
    }
    if asked.is_empty() {
        if let Some(body) = firsts.iter().find_map(|n| n.inside.last()) {
            return finding(
                format!("the camera is inside the body of `{body}`, which lets nothing through"),
                "move the camera out of it, or make its absorption less",
            );
        }
        if is_from_behind && ended("absorbed") * 2 > firsts.len() {
            return finding(
                format!("the camera sees the back of `{seen}`, and backs are black here: its normals may point inward"),
                "turn its faces round, or set `shade_back = true`",
            );
        }
        let last = |s: &Sample| s.rays.iter().rev().find(|n| n.ended.is_some()).cloned();
        let lasts: Vec<Node> = e.trees.iter().filter_map(last).collect();
        if lasts.iter().filter(|n| n.ended == Some("depth")).count() * 2 > lasts.len() {
            let object = most(lasts.iter().filter_map(|n| Some(n.hit.as_ref()?.object.clone())))?;
            return finding(
                format!(
                    "the path ends at `{object}`, seen by way of `{seen}`, since the greatest depth is reached there"
                ),
                "raise `integrator.max_depth`",
            );
        }
        if lasts.iter().filter(|n| n.hit.is_none()).count() * 2 > lasts.len() {
            let text = format!("the rays that `{seen}` sends on leave the scene, and the background is black");
            return finding(text, "give the scene a `[background]`, or something for it to show");
        }
        return finding(
            format!("`{seen}` (material `{material}`) swallows all light"),
            "give the material a reflectance above 0",
        );
    }
    let counts = |what| asked.iter().filter(|a| a.answer.what == what).count();
    let of = |what: &'static str| asked.iter().filter(move |a| a.answer.what == what);
    let most_of = [
        ("blocked", counts("blocked")),
        ("behind", counts("behind")),
        ("dark", counts("dark")),
        ("black", counts("black")),
    ]
    .into_iter()
    .max_by_key(|c| c.1)?
    .0;
    if counts("no_light") * 2 > asked.len() {
        return finding(format!("no light shines on `{seen}`"), "give the scene a light, an `emitter` or a background");
    }
    let light = most(of(most_of).filter_map(|a| a.light.clone())).unwrap_or_else(|| "the light".into());
    match most_of {
        "blocked" => {
            let blocker = most(of("blocked").filter_map(|a| Some(a.answer.blocker.as_ref()?.object.clone())))?;
            finding(format!("`{blocker}` blocks `{light}` from `{seen}`"), "move one of them, or add another light")
        }
        "behind" if is_from_behind => finding(
            format!("`{light}` is behind `{seen}`, whose back the camera sees: its normals may point inward"),
            "turn its faces round, or make the material two-sided",
        ),
        "behind" => finding(format!("`{light}` is behind `{seen}`"), "move the light, or turn the surface round"),
        "dark" => finding(
            format!("`{light}` sends nothing to `{seen}`"),
            "look at the light's brightness, its cone, its falloff, and which side of it shines",
        ),
        _ => finding(
            format!("the material `{material}` of `{seen}` scatters nothing from `{light}` to the camera"),
            "give the material a reflectance above 0",
        ),
    }
}

/// What there is most of.
fn most<T: Ord>(of: impl Iterator<Item = T>) -> Option<T> {
    let mut counts: BTreeMap<T, usize> = BTreeMap::new();
    of.for_each(|t| *counts.entry(t).or_default() += 1);
    counts.into_iter().max_by_key(|c| c.1).map(|c| c.0)
}

fn acne(e: &Explanation) -> Option<Finding> {
    let nodes = || e.trees.iter().flat_map(|s| &s.rays);
    let near = |n: &&Node| {
        let Some(hit) = &n.hit else { return false };
        let size = hit.position.iter().fold(hit.distance, |m, v| m.max(v.abs()));
        n.asked.iter().any(|a| a.answer.blocker.as_ref().is_some_and(|b| b.is_same_surface && b.distance < 1e-4 * size))
    };
    let (asked, hurt) = (nodes().filter(|n| !n.asked.is_empty()).count(), nodes().filter(near).count());
    let culprit = nodes().find(near)?.hit.as_ref()?.object.clone();
    (hurt * 10 >= asked).then(|| Finding {
        code: "shadow-acne",
        text: format!("`{culprit}` shades itself: {} of {asked} shadow rays end where they begin", hurt),
        cure: "leave `surface_offset` on; if it is, the scene is too large or too far from the origin for its details"
            .into(),
    })
}

fn too_much_energy(e: &Explanation) -> Option<Finding> {
    // How much light comes off each material for one that arrives, on average over what was sampled.
    let mut sums: BTreeMap<&str, (f64, usize)> = BTreeMap::new();
    for s in &e.trees {
        for n in &s.rays {
            let (Some(sent), Some(parent)) = (&n.sent, n.parent) else { continue };
            let Some(hit) = &s.rays[parent].hit else { continue };
            // Of a refraction radiance grows by the indices' squares; of a sharp lobe in a Whitted tree the share is whole.
            if sent.pdf <= 0.0 || matches!(sent.lobe, Some("refraction" | "glossy_transmission" | "medium")) {
                continue;
            }
            let weight = sent.bsdf.iter().fold(0.0_f32, |m, v| m.max(*v)) * sent.cosine / sent.pdf;
            let entry = sums.entry(&hit.material).or_default();
            entry.0 += f64::from(weight);
            entry.1 += 1;
        }
    }
    let mean = |(sum, n): (f64, usize)| sum / n as f64;
    let (material, sum) =
        sums.into_iter().filter(|(_, s)| s.1 >= FEW).max_by(|a, b| mean(a.1).total_cmp(&mean(b.1)))?;
    (mean(sum) > 1.25).then(|| Finding {
        code: "energy",
        text: format!("`{material}` sends out {:.2} times the light that it receives", mean(sum)),
        cure: "make its reflectances add up to at most 1".into(),
    })
}

fn depth_limit(e: &Explanation) -> Option<Finding> {
    // What a path that was cut could still have brought is not known. It is likely to be much where paths are cut that never
    // found light, or where the last bounces bring hardly less than those before.
    let ends = |s: &Sample| s.rays.iter().any(|n| n.ended == Some("depth") && n.throughput.iter().any(|t| *t > 0.25));
    let cut: Vec<&Sample> = e.trees.iter().filter(|s| ends(s)).collect();
    let in_vain = cut.iter().filter(|s| s.contributions().all(|(_, c)| c.sums == [0; 3])).count();
    let mut by_depth: BTreeMap<u32, f64> = BTreeMap::new();
    for n in e.trees.iter().flat_map(|s| &s.rays) {
        *by_depth.entry(n.depth).or_default() += n.contributions().map(|c| c.color().iter().sum::<f64>()).sum::<f64>();
    }
    let mut last = by_depth.values().rev();
    let (c1, c2, c3) = (last.next()?, last.next().unwrap_or(&0.0), last.next().unwrap_or(&0.0));
    // The last bounces in pairs, against noise: they shrink by this ratio each time, if they go on as they did.
    let ratio = ((c1 + c2) / (c2 + c3)).min(0.99);
    let tail = if c2 + c3 > 0.0 { 0.5 * (c1 + c2) * ratio / (1.0 - ratio) } else { 0.0 };
    let is_cut_often = cut.len() * 4 >= e.trees.len().max(1);
    let is_much = in_vain * 4 >= e.trees.len().max(1) || is_cut_often && tail > 0.1 * total(e);
    // Mirrors and clear surfaces pass on what they see: what they would have shown is gone.
    let is_sharp = |n: &&Node| {
        let lobe = n.sent.as_ref().and_then(|s| s.lobe);
        n.ended == Some("depth")
            && matches!(lobe, Some("mirror" | "refraction"))
            && n.throughput.iter().any(|t| *t > 0.25)
    };
    let unseen = e.trees.iter().filter(|s| s.rays.iter().any(|n| is_sharp(&n))).count();
    let is_much = is_much || unseen * 4 >= e.trees.len().max(1);
    // Where most is lost.
    let mut lost: BTreeMap<(&str, u32), f32> = BTreeMap::new();
    for n in e.trees.iter().flat_map(|s| &s.rays).filter(|n| n.ended == Some("depth")) {
        if let Some(hit) = &n.hit {
            *lost.entry((&hit.object, n.depth)).or_default() += n.throughput.iter().fold(0.0_f32, |m, t| m.max(*t));
        }
    }
    let ((object, depth), _) = lost.into_iter().max_by(|a, b| a.1.total_cmp(&b.1)).filter(|_| is_much)?;
    Some(Finding {
        code: "depth-limit",
        text: format!(
            "{} of {} lose much of their light at the greatest depth, {depth}, most often at `{object}`",
            cut.len(),
            plural(e.trees.len(), "sample")
        ),
        cure: "raise `integrator.max_depth`".into(),
    })
}
