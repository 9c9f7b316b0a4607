//! `NAME=SCALE[,COLOUR]`: what the light of a group is multiplied by.

use crate::problem::Problem;
use kirkas_scene::diagnostic::unknown_name;
use kirkas_scene::params::read_color;
use kirkas_scene::{Diagnostic, Sources, Span, Value};

/// What was asked for, by the names of groups.
#[derive(Debug, Default, PartialEq)]
pub struct LightMix(Vec<(String, [f64; 3])>);

impl LightMix {
    /// The factors for red, green and blue of a group.
    pub fn of(&self, group: &str) -> [f64; 3] {
        self.0.iter().find(|g| g.0 == group).map_or([1.0; 3], |g| g.1)
    }
}

/// Read `lamp=2,#ff8800` and its like; `groups` are the names that exist.
pub fn parse(texts: &[String], groups: &[String]) -> Result<LightMix, Problem> {
    let mut mix = LightMix::default();
    for text in texts {
        let mut sources = Sources::default();
        let source = sources.add("NAME=SCALE", text);
        let fail = |d: Diagnostic| Problem::in_sources(&sources, vec![d]);
        let (name, value) = text.rsplit_once('=').unwrap_or((text, ""));
        let span = Span::new(source, 0, name.len());
        if !groups.iter().any(|g| g == name) {
            return Err(fail(unknown_name("light group", name, span, groups.iter().map(String::as_str))));
        }
        let Some(factors) = factors(value) else {
            let message = format!("`{text}` does not say what the light is multiplied by");
            let help = "write NAME=SCALE, NAME=SCALE,R,G,B or NAME=SCALE,#RRGGBB with numbers of 0 or more, such as `lamp=2,#ffb070`";
            let place = Span::new(source, name.len(), text.len());
            return Err(fail(Diagnostic::error("bad-mix", message).at(place, "not understood").help(help)));
        };
        if mix.0.iter().any(|g| g.0 == name) {
            let error = Diagnostic::error("bad-mix", format!("`{name}` is given twice")).at(span, "again");
            return Err(fail(error.help("give each group once")));
        }
        mix.0.push((name.to_string(), factors));
    }
    Ok(mix)
}

/// `2`, `2,#ff8800` or `2,1,0.5,0.2`.
fn factors(text: &str) -> Option<[f64; 3]> {
    let number = |t: &str| t.trim().parse().ok().filter(|v: &f64| v.is_finite() && *v >= 0.0);
    let (scale, color) = text.split_once(',').map_or((text, None), |(s, c)| (s, Some(c.trim())));
    let scale = number(scale)?;
    let color = match color {
        None => [1.0; 3],
        Some(hex) if hex.starts_with('#') => read_color(&Value::Text(hex.to_string()))?,
        Some(list) => {
            let lanes: Vec<f64> = list.split(',').map(number).collect::<Option<_>>()?;
            lanes.try_into().ok()?
        }
    };
    Some(color.map(|c| c * scale))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn factors_are_a_scale_and_a_colour() {
        assert_eq!(factors("2"), Some([2.0; 3]));
        assert_eq!(factors("2, 1,0.5,0"), Some([2.0, 1.0, 0.0]));
        assert_eq!(factors("0.5,#ff0000"), Some([0.5, 0.0, 0.0]));
        for bad in ["", "-1", "nan", "inf", "1,", "1,2", "1,2,3", "1,2,3,4,5", "1,#ff00", "1,#gg0000", "x"] {
            assert_eq!(factors(bad), None, "{bad}");
        }
    }
}
