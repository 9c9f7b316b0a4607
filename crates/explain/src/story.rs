//! Which way light came: contributions that came by the same way belong to one story, told in a few words.

use crate::record::{Contribution, Explanation, Node, Sample, color};
use std::collections::BTreeMap;

/// Light that came one way.
#[derive(Clone, Debug, PartialEq)]
pub struct Story {
    /// Such as "`lamp` shining on `floor`, seen in `ball`".
    pub text: String,
    /// Of the pixel, 0 to 1, by the sum of red, green and blue.
    pub share: f64,
    /// Samples that it brought light to.
    pub samples: usize,
}

/// All stories, the brightest first.
pub fn stories(e: &Explanation) -> Vec<Story> {
    let whole = total(e);
    let mut found: BTreeMap<String, (f64, Vec<u32>)> = BTreeMap::new();
    let mut tell = |text: String, sample: u32, c: &Contribution| {
        let entry = found.entry(text).or_default();
        entry.0 += c.color().iter().sum::<f64>();
        if entry.1.last() != Some(&sample) {
            entry.1.push(sample);
        }
    };
    for s in e.trees.iter().filter(|s| !s.is_invalid) {
        for c in &s.landed {
            tell(landed(e, c), s.sample, c);
        }
        for (i, node) in s.rays.iter().enumerate() {
            for saw in node.saw.iter().filter(|saw| saw.contribution.sums != [0; 3]) {
                tell(of_sight(s, i, saw.what), s.sample, &saw.contribution);
            }
            for asked in &node.asked {
                if let Some(c) = asked.answer.contribution.as_ref().filter(|c| c.sums != [0; 3]) {
                    let source = asked.light.as_ref().map_or("a light".into(), |l| format!("`{l}`"));
                    tell(on_the_way(s, i, &source), s.sample, c);
                }
            }
        }
    }
    let story = |(text, (sum, samples)): (String, (f64, Vec<u32>))| Story {
        text,
        share: if whole > 0.0 { sum / whole } else { 0.0 },
        samples: samples.len(),
    };
    let mut all: Vec<Story> = found.into_iter().map(story).collect();
    all.sort_by(|a, b| b.share.total_cmp(&a.share).then_with(|| a.text.cmp(&b.text)));
    all
}

/// Red, green and blue of all samples, added up.
pub(crate) fn total(e: &Explanation) -> f64 {
    color(&e.sums).iter().sum()
}

/// The stories in a sentence or two, and what stood in the way.
pub fn summary(e: &Explanation) -> String {
    let (all, count) = (stories(e), e.trees.len());
    let mut text = String::new();
    if total(e) <= 0.0 {
        text += &format!("This pixel is black: none of its {} found any light.", plural(count, "sample"));
    } else {
        const TOLD: usize = 4;
        let told: Vec<String> = all
            .iter()
            .take(TOLD)
            .filter(|s| s.share >= 0.005)
            .enumerate()
            .map(|(i, s)| format!("{} {}is {}", percent(s.share), if i == 0 { "of this pixel " } else { "" }, s.text))
            .collect();
        text += &told.join("; ");
        let rest = 1.0 - all.iter().take(told.len()).map(|s| s.share).sum::<f64>();
        if rest >= 0.005 {
            let ways = plural(all.len() - told.len(), "other way");
            text += &format!("; the remaining {} came in {ways}", percent(rest));
        }
        text += ".";
    }
    if let Some((blocker, light, samples)) = most_blocking(e) {
        text += &format!(
            " {samples} of {} found no light where the camera looks because `{blocker}` blocks `{light}`.",
            plural(count, "sample")
        );
    }
    if e.invalid_samples > 0 {
        text += &format!(" {} left out: not finite, or absurdly bright.", plural(e.invalid_samples as usize, "sample"));
    }
    text
}

/// The blocker and the light that left most samples without direct light at their first surface that can be lit, and how many.
fn most_blocking(e: &Explanation) -> Option<(String, String, usize)> {
    let mut counts: BTreeMap<(String, String), usize> = BTreeMap::new();
    for s in &e.trees {
        let first = s.rays.iter().find(|n| !n.asked.is_empty());
        let Some(node) = first.filter(|n| n.asked.iter().all(|a| a.answer.what != "lit")) else { continue };
        let blocked = |a: &crate::record::Asked| Some((a.answer.blocker.as_ref()?.object.clone(), a.light.clone()?));
        if let Some(pair) = node.asked.iter().find_map(blocked) {
            *counts.entry(pair).or_default() += 1;
        }
    }
    let ((blocker, light), samples) = counts.into_iter().max_by_key(|(_, n)| *n)?;
    Some((blocker, light, samples))
}

/// A share in words that fit it.
pub(crate) fn percent(share: f64) -> String {
    let p = share * 100.0;
    if p >= 10.0 || p == 0.0 {
        format!("{p:.0} %")
    } else if p >= 0.1 {
        format!("{p:.1} %")
    } else {
        "less than 0.1 %".into()
    }
}

pub(crate) fn plural(n: usize, what: &str) -> String {
    format!("{n} {what}{}", if n == 1 { "" } else { "s" })
}

fn landed(e: &Explanation, c: &Contribution) -> String {
    match e.groups.get(c.group as usize).filter(|_| e.groups.len() > 1) {
        Some(group) => format!("what particles from `{group}` brought here"),
        None => "what particles from the lights brought here".into(),
    }
}

/// The rays from the camera to ray `i`.
fn chain(s: &Sample, i: usize) -> Vec<&Node> {
    let mut way = vec![&s.rays[i]];
    while let Some(parent) = way[way.len() - 1].parent {
        way.push(&s.rays[parent]);
    }
    way.reverse();
    way
}

/// What a ray found shining at its end.
fn of_sight(s: &Sample, i: usize, what: &str) -> String {
    let node = &s.rays[i];
    let object = node.hit.as_ref().map_or("the scene".to_string(), |h| format!("`{}`", h.object));
    match what {
        // These shine at the surface itself, on what scatters there.
        "ambient" | "photons" | "light" => {
            let source = match what {
                "ambient" => "ambient light",
                "photons" => "light that photons brought (indirect, or focused)",
                _ => "light without shadows",
            };
            on_the_way(s, i, source)
        }
        _ => {
            let source = match what {
                "background" => "the background".to_string(),
                "medium" => "a medium that shines".to_string(),
                _ => object,
            };
            match node.parent.filter(|_| node.sent.is_some() || node.kind == "passed") {
                None => format!("{source} itself"),
                Some(parent) => through(s, i, parent, &source),
            }
        }
    }
}

/// A source found by ray `i`, which the end of ray `parent` sent.
fn through(s: &Sample, i: usize, parent: usize, source: &str) -> String {
    let way = chain(s, i);
    let soft = way.iter().position(|n| n.sent.as_ref().is_some_and(|sent| !is_sharp(sent.lobe)));
    match soft {
        None => match seen_in(&way) {
            Some(seen) => format!("{source} seen {seen}"),
            None => format!("{source} itself"),
        },
        // The last ray left a soft surface: the source shines on it.
        Some(_) => on_the_way(s, parent, source),
    }
}

/// A source that shines on what ray `i` hit, from there by way of its ancestors to the camera.
fn on_the_way(s: &Sample, i: usize, source: &str) -> String {
    let way = chain(s, i);
    // Rays before the first soft bounce show the surface that the viewer looks at.
    let first_soft = way.iter().position(|n| n.sent.as_ref().is_some_and(|sent| !is_sharp(sent.lobe)));
    let sharp = &way[..first_soft.unwrap_or(way.len())];
    let looked_at = sharp.iter().rev().find(|n| n.kind != "passed").and_then(|n| n.hit.as_ref());
    let target = match sharp.last().and_then(|n| n.hit.as_ref()).or(looked_at) {
        Some(hit) => format!("`{}`", hit.object),
        None => "a medium".into(),
    };
    let seen = seen_in(sharp).map_or(String::new(), |seen| format!(", seen {seen}"));
    let bounces = way.len() - sharp.len();
    match bounces {
        0 => format!("{source} shining on {target}{seen}"),
        1 => {
            let between = way[way.len() - 1].hit.as_ref().map_or("a medium".into(), |h| format!("`{}`", h.object));
            format!("{source} by way of {between} on {target}{seen}")
        }
        _ => format!("{source} by way of several surfaces on {target}{seen}"),
    }
}

/// By way of which mirrors and clear surfaces the last of these rays was sent.
fn seen_in(way: &[&Node]) -> Option<String> {
    let mut steps: Vec<String> = Vec::new();
    for pair in way.windows(2) {
        let (Some(hit), Some(sent)) = (&pair[0].hit, &pair[1].sent) else { continue };
        let how = if sent.lobe == Some("refraction") { "through" } else { "in" };
        let step = format!("{how} `{}`", hit.object);
        if steps.last() != Some(&step) {
            steps.push(step);
        }
    }
    const TOLD: usize = 3;
    let more = if steps.len() > TOLD { " ..." } else { "" };
    steps.truncate(TOLD);
    (!steps.is_empty()).then(|| steps.join(" ") + more)
}

fn is_sharp(lobe: Option<&str>) -> bool {
    matches!(lobe, Some("mirror" | "refraction"))
}
