//! The trees of all samples laid over each other, for the terminal: what happened alike is one line, the brightest first.

use crate::record::{Asked, Explanation, Node, Sample};
use crate::story::{percent, plural, total};
use std::collections::BTreeMap;
use std::fmt::Write;

/// How it is written.
#[derive(Clone, Copy, Debug)]
pub struct Style {
    /// With the colours of a terminal.
    pub is_colored: bool,
    /// Branches that bring less than this share of the pixel are folded into one line.
    pub least_share: f64,
    /// Levels below the camera; deeper ones are folded.
    pub depth: usize,
}

impl Default for Style {
    fn default() -> Self {
        Style { is_colored: false, least_share: 0.01, depth: 12 }
    }
}

/// What happened alike in several samples.
#[derive(Default)]
struct Branch {
    /// Red, green and blue that came by it.
    light: f64,
    /// How often.
    count: usize,
    /// Lights that were asked and did not answer, by why.
    unlit: BTreeMap<String, usize>,
    /// Why paths ended here.
    ends: BTreeMap<&'static str, usize>,
    below: BTreeMap<String, Branch>,
}

/// As indented lines.
pub fn tree(e: &Explanation, style: &Style) -> String {
    let mut root = Branch::default();
    for s in e.trees.iter().filter(|s| !s.is_invalid) {
        root.count += 1;
        for c in &s.landed {
            root.bring(&["particles from the lights".into()], c.color().iter().sum());
        }
        let ways = ways(s);
        for (node, way) in s.rays.iter().zip(&ways) {
            root.take_in(node, way);
        }
    }
    root.light = total(e);
    let mut text = String::new();
    let [r, g, b] = e.value;
    let head = format!("pixel {},{}  {r:.4} {g:.4} {b:.4}", e.pixel[0], e.pixel[1]);
    let _ = writeln!(text, "{}  {}", paint(style, BOLD, &head), plural(e.trees.len(), "sample"));
    root.write(&mut text, style, (root.light, 0), "");
    text
}

/// For each ray the names of the lines that lead to it.
fn ways(s: &Sample) -> Vec<Vec<String>> {
    let mut ways: Vec<Vec<String>> = Vec::with_capacity(s.rays.len());
    for node in &s.rays {
        let mut way = node.parent.map_or(Vec::new(), |p| ways[p].clone());
        way.push(line_of(node));
        ways.push(way);
    }
    ways
}

/// A ray in a few words: how it was sent, and what it hit.
fn line_of(node: &Node) -> String {
    let how = match (node.kind, node.sent.as_ref().and_then(|s| s.lobe)) {
        ("camera", _) => "camera",
        ("passed", _) => "passed",
        (_, Some("mirror")) => "mirrored",
        (_, Some("refraction")) => "refracted",
        (_, Some("glossy_reflection")) => "glossy",
        (_, Some("glossy_transmission")) => "blurred",
        (_, Some("diffuse_transmission")) => "translucent",
        (_, Some("medium")) => "scattered",
        _ => "diffuse",
    };
    match &node.hit {
        Some(hit) => {
            format!("{how} -> {} ({}{})", hit.object, hit.material, if hit.is_front { "" } else { ", from within" })
        }
        None => format!("{how} -> background"),
    }
}

/// A light that was asked, and what it answered.
fn answer_of(asked: &Asked) -> String {
    let light = asked.light.as_deref().unwrap_or("no light");
    match asked.answer.what {
        "blocked" => match &asked.answer.blocker {
            Some(b) if b.is_same_surface => format!("{light} blocked by the same face of {}", b.object),
            Some(b) => format!("{light} blocked by {}", b.object),
            None => format!("{light} blocked"),
        },
        "behind" => format!("{light} behind the surface"),
        "dark" => format!("{light} sends nothing here"),
        "black" => format!("{light} not scattered here"),
        _ => "no light to ask".to_string(),
    }
}

impl Branch {
    /// The branch at the end of a way.
    fn at(&mut self, way: &[String]) -> &mut Branch {
        way.iter().fold(self, |b, name| b.below.entry(name.clone()).or_default())
    }

    /// Light that came along a way.
    fn bring(&mut self, way: &[String], light: f64) {
        let mut branch = self;
        for name in way {
            branch = branch.below.entry(name.clone()).or_default();
            branch.light += light;
        }
        branch.count += 1;
    }

    fn take_in(&mut self, node: &Node, way: &[String]) {
        let branch = self.at(way);
        branch.count += 1;
        if let Some(end) = node.ended {
            *branch.ends.entry(end).or_default() += 1;
        }
        for asked in node.asked.iter().filter(|a| a.answer.contribution.is_none()) {
            *branch.unlit.entry(answer_of(asked)).or_default() += 1;
        }
        let sight = |what: &str| match what {
            "surface" => "shines".to_string(),
            "background" => "shines".to_string(),
            "medium" => "a medium on the way shines".to_string(),
            "ambient" => "ambient light".to_string(),
            "photons" => "photons around".to_string(),
            _ => "light without shadows".to_string(),
        };
        let saw = node.saw.iter().map(|s| (format!("* {}", sight(s.what)), &s.contribution));
        let lit = node.asked.iter().filter_map(|a| {
            let light = a.light.as_deref().unwrap_or("a light");
            Some((format!("* lit by {light}"), a.answer.contribution.as_ref()?))
        });
        for (name, contribution) in saw.chain(lit) {
            let way = [way, &[name]].concat();
            self.bring(&way, contribution.color().iter().sum());
        }
    }

    fn write(&self, text: &mut String, style: &Style, (whole, depth): (f64, usize), indent: &str) {
        let share = |light: f64| if whole > 0.0 { light / whole } else { 0.0 };
        let mut below: Vec<(&String, &Branch)> = self.below.iter().collect();
        below.sort_by(|a, b| b.1.light.total_cmp(&a.1.light).then_with(|| b.1.count.cmp(&a.1.count)));
        // Where all is dark, what happened most often is shown.
        let (mut shown, mut folded) = (Vec::new(), Vec::new());
        for b in below {
            let is_told = if whole > 0.0 { share(b.1.light) >= style.least_share } else { shown.len() < 3 };
            if is_told && depth < style.depth { shown.push(b) } else { folded.push(b) }
        }
        let mut lines = self.notes();
        let folded_light: f64 = folded.iter().map(|b| b.1.light).sum();
        if !folded.is_empty() {
            lines.push(format!(
                "... {} with {} in all",
                plural(folded.len(), "other branch").replace("branchs", "branches"),
                percent(share(folded_light))
            ));
        }
        for (i, (name, branch)) in shown.iter().enumerate() {
            let is_last = i + 1 == shown.len() && lines.is_empty();
            let (joint, more) = if is_last { ("└─ ", "   ") } else { ("├─ ", "│  ") };
            let color = if name.starts_with('*') { LIT } else { PLAIN };
            let _ = writeln!(
                text,
                "{indent}{joint}{}  {}  {}",
                paint(style, color, name),
                paint(style, SHARE, &percent(share(branch.light))),
                paint(style, DIM, &format!("{}x", branch.count))
            );
            branch.write(text, style, (whole, depth + 1), &format!("{indent}{more}"));
        }
        for (i, line) in lines.iter().enumerate() {
            let joint = if i + 1 == lines.len() { "└─ " } else { "├─ " };
            let _ = writeln!(text, "{indent}{joint}{}", paint(style, DIM, line));
        }
    }

    /// What brought no light.
    fn notes(&self) -> Vec<String> {
        let mut unlit: Vec<(&String, &usize)> = self.unlit.iter().collect();
        unlit.sort_by(|a, b| b.1.cmp(a.1).then_with(|| a.0.cmp(b.0)));
        let mut lines: Vec<String> = unlit.iter().map(|(what, n)| format!("{what}  {n}x")).collect();
        let told = |(why, n): (&&str, &usize)| match *why {
            "absorbed" | "escaped" => None,
            "depth" => Some(format!("ended at the greatest depth  {n}x")),
            "contribution" => Some(format!("ended: too little left to bring  {n}x")),
            why => Some(format!("ended by {why}  {n}x")),
        };
        lines.extend(self.ends.iter().filter_map(told));
        lines
    }
}

const BOLD: &str = "1";
const LIT: &str = "33";
const SHARE: &str = "1;36";
const DIM: &str = "2";
const PLAIN: &str = "";

fn paint(style: &Style, code: &str, text: &str) -> String {
    if style.is_colored && !code.is_empty() { format!("\x1b[{code}m{text}\x1b[0m") } else { text.to_string() }
}
