//! A drawing as SVG: texts stay texts, pictures are embedded.

use crate::color::Color;
use crate::drawing::{Anchor, Drawing, Item, LOW, Path, Picture, Text};
use base64::Engine;
use base64::engine::general_purpose::STANDARD as BASE64;
use std::fmt::Write;

const FONTS: &str = "Inter, 'Helvetica Neue', Arial, 'Liberation Sans', sans-serif";

/// The whole file.
pub fn write_svg(drawing: &Drawing) -> String {
    let (w, h) = (number(drawing.width), number(drawing.height));
    let mut out = format!(
        "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{w}\" height=\"{h}\" viewBox=\"0 0 {w} {h}\" font-family=\"{FONTS}\">\n"
    );
    for item in &drawing.items {
        match item {
            Item::Path(p) => path(&mut out, p),
            Item::Text(t) => text(&mut out, t),
            Item::Picture(p) => picture(&mut out, p),
        }
    }
    out + "</svg>\n"
}

fn path(out: &mut String, path: &Path) {
    let mut d = String::new();
    for line in path.lines.iter().filter(|l| !l.is_empty()) {
        for (i, at) in line.iter().enumerate() {
            let _ = write!(d, "{}{} {}", if i == 0 { "M" } else { "L" }, number(at[0]), number(at[1]));
        }
        if path.is_closed {
            d.push('Z');
        }
    }
    if d.is_empty() {
        return;
    }
    let _ = write!(out, "<path class=\"{}\" d=\"{d}\"", path.class);
    match path.fill {
        Some(color) => paint(out, "fill", color),
        None => out.push_str(" fill=\"none\""),
    }
    if let Some((color, width, dash)) = path.stroke {
        paint(out, "stroke", color);
        let _ = write!(out, " stroke-width=\"{}\" stroke-linejoin=\"round\"", number(width));
        if !dash.pattern().is_empty() {
            let lengths: Vec<String> = dash.pattern().iter().map(|x| number(x * width)).collect();
            let _ = write!(out, " stroke-dasharray=\"{}\"", lengths.join(" "));
        }
    }
    out.push_str("/>\n");
}

fn text(out: &mut String, text: &Text) {
    let (x, y) = (number(text.at[0]), number(text.at[1]));
    let anchor = match text.anchor {
        Anchor::Start => "start",
        Anchor::Middle => "middle",
        Anchor::End => "end",
    };
    let _ = write!(out, "<text x=\"{x}\" y=\"{y}\" font-size=\"{}\" text-anchor=\"{anchor}\"", number(text.size));
    paint(out, "fill", text.color);
    if text.is_bold {
        out.push_str(" font-weight=\"600\"");
    }
    if text.is_upright {
        let _ = write!(out, " transform=\"rotate(-90 {x} {y})\"");
    }
    out.push('>');
    for (run, is_low) in text.runs() {
        let run = escaped(&run);
        if is_low {
            let (size, down) = (number(text.size * LOW.0), number(text.size * LOW.1));
            let _ = write!(
                out,
                "<tspan dy=\"{down}\" font-size=\"{size}\">{run}</tspan><tspan dy=\"-{down}\">\u{200b}</tspan>"
            );
        } else {
            out.push_str(&run);
        }
    }
    out.push_str("</text>\n");
}

fn picture(out: &mut String, picture: &Picture) {
    let [x, y, w, h] = picture.place.map(number);
    let _ = writeln!(
        out,
        "<image x=\"{x}\" y=\"{y}\" width=\"{w}\" height=\"{h}\" preserveAspectRatio=\"none\" href=\"data:image/png;base64,{}\"/>",
        BASE64.encode(&picture.png)
    );
}

fn paint(out: &mut String, what: &str, Color([r, g, b], opacity): Color) {
    let _ = write!(out, " {what}=\"#{r:02x}{g:02x}{b:02x}\"");
    if opacity < 1.0 {
        let _ = write!(out, " {what}-opacity=\"{}\"", number(f64::from(opacity)));
    }
}

/// To a hundredth.
fn number(x: f64) -> String {
    let text = format!("{x:.2}");
    let text = text.trim_end_matches('0').trim_end_matches('.');
    if text == "-0" { "0".into() } else { text.into() }
}

fn escaped(text: &str) -> String {
    let plain = |c: &char| !c.is_control();
    let mut out = String::new();
    for c in text.chars().filter(plain) {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c => out.push(c),
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_cannot_break_out_of_their_text() {
        assert_eq!(escaped("a<b & \"c\">\u{7}"), "a&lt;b &amp; &quot;c&quot;&gt;");
    }
}
