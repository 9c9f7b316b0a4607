//! Axes: from values to places along them, and the values at which a line of the grid is drawn.

/// How values are spread along an axis.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Scale {
    /// Evenly.
    #[default]
    Linear,
    /// Evenly by their logarithm.
    Log,
}

/// One axis.
#[derive(Clone, Debug)]
pub struct Axis {
    /// What it shows, with its unit.
    pub label: String,
    /// The values at both ends; above 0 on a logarithmic axis.
    pub range: (f64, f64),
    /// How they are spread.
    pub scale: Scale,
    /// From one line of the grid to the next; `None`: about six, at round numbers.
    pub step: Option<f64>,
}

impl Axis {
    /// A linear axis.
    pub fn linear(label: impl Into<String>, range: (f64, f64)) -> Self {
        Axis { label: label.into(), range: widened(range), scale: Scale::Linear, step: None }
    }

    /// Degrees, with a line at every `step`.
    pub fn degrees(label: impl Into<String>, range: (f64, f64), step: f64) -> Self {
        Axis { step: Some(step), ..Self::linear(label, range) }
    }

    /// From 0, or on a logarithmic axis from `decades` below the greatest value, to a round number above all of `values`.
    pub fn of_values(label: impl Into<String>, values: impl Iterator<Item = f64>, scale: Scale, decades: i32) -> Self {
        let (mut least, mut most) = (f64::INFINITY, 0.0_f64);
        for v in values.filter(|v| v.is_finite() && *v > 0.0) {
            (least, most) = (least.min(v), most.max(v));
        }
        let most = if most > 0.0 { most } else { 1.0 };
        let range = match scale {
            Scale::Linear => {
                let step = round_step(most / 5.0);
                (0.0, (most * 1.02 / step).ceil() * step)
            }
            Scale::Log => {
                let top = (most * 1.05).log10().ceil();
                let low = least.min(most).log10().floor().max(top - f64::from(decades)).min(top - 1.0);
                (power_of_ten(low), power_of_ten(top))
            }
        };
        Axis { label: label.into(), range, scale, step: None }
    }

    /// 0 at the lower end, 1 at the upper one; below that what does not fit on a logarithmic axis.
    pub fn place(&self, value: f64) -> f64 {
        let (low, high) = self.range;
        match self.scale {
            Scale::Linear => (value - low) / (high - low),
            Scale::Log if value > 0.0 => (value / low).log10() / (high / low).log10(),
            Scale::Log => -1.0,
        }
    }

    /// Where lines of the grid are drawn, and what is written beside them.
    pub fn ticks(&self) -> Vec<(f64, String)> {
        let (low, high) = self.range;
        if self.scale == Scale::Log {
            let (first, last) = (low.log10().round() as i32, high.log10().round() as i32);
            let every = ((last - first) / 8).max(1);
            let decades = (first..=last).filter(|d| (d - first) % every == 0);
            return decades.map(|d| (power_of_ten(f64::from(d)), decade(d))).collect();
        }
        let step = self.step.unwrap_or_else(|| round_step((high - low) / 6.0));
        let digits = (-step.log10().floor()).clamp(0.0, 12.0) as usize;
        let digits = if (step * power_of_ten(digits as f64)).fract().abs() > 1e-6 { digits + 1 } else { digits };
        let first = (low / step - 1e-9).ceil() as i64;
        (first..)
            .map(|i| i as f64 * step)
            .take_while(|v| *v <= high + step * 1e-9)
            .take(1000)
            .map(|v| (v, written(v, digits)))
            .collect()
    }
}

/// A number with a proper minus.
pub fn written(value: f64, digits: usize) -> String {
    let text = format!("{value:.digits$}");
    let is_zero = text.chars().all(|c| matches!(c, '-' | '0' | '.'));
    match text.strip_prefix('-') {
        Some(rest) if is_zero => rest.to_string(),
        Some(rest) => format!("\u{2212}{rest}"),
        None => text,
    }
}

/// 10, 100, 10⁻³.
fn decade(power: i32) -> String {
    match power {
        0 => "1".into(),
        1 => "10".into(),
        2 => "100".into(),
        -1 => "0.1".into(),
        -2 => "0.01".into(),
        _ => {
            let raised = |c: char| match c {
                '-' => '⁻',
                '1' => '¹',
                '2' => '²',
                '3' => '³',
                c => char::from_u32(0x2070 + c.to_digit(10).unwrap_or(0)).unwrap_or(c),
            };
            format!("10{}", power.to_string().chars().map(raised).collect::<String>())
        }
    }
}

/// 1, 2 or 5 times a power of ten, near `rough`.
fn round_step(rough: f64) -> f64 {
    let ten = power_of_ten(rough.abs().max(1e-300).log10().floor());
    [1.0, 2.0, 5.0, 10.0].into_iter().map(|m| m * ten).find(|s| *s >= rough * 0.999).unwrap_or(10.0 * ten)
}

fn power_of_ten(power: f64) -> f64 {
    kirkas_geometry::elementary::pow(10.0, power)
}

fn widened((low, high): (f64, f64)) -> (f64, f64) {
    if high > low { (low, high) } else { (low, low + 1.0) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_numbers_within_the_range() {
        let axis = Axis::linear("x", (0.0, 0.33));
        let texts: Vec<String> = axis.ticks().into_iter().map(|t| t.1).collect();
        assert_eq!(texts, ["0.0", "0.1", "0.2", "0.3"]);
        let degrees = Axis::degrees("x", (-90.0, 90.0), 45.0);
        let texts: Vec<String> = degrees.ticks().into_iter().map(|t| t.1).collect();
        assert_eq!(texts, ["−90", "−45", "0", "45", "90"]);
    }

    #[test]
    fn a_logarithmic_axis_has_whole_decades() {
        let axis = Axis::of_values("f", [3e-4, 40.0].into_iter(), Scale::Log, 9);
        let texts: Vec<String> = axis.ticks().into_iter().map(|t| t.1).collect();
        assert_eq!(texts, ["10⁻⁴", "10⁻³", "0.01", "0.1", "1", "10", "100"]);
        assert!((axis.place(1.0) - 4.0 / 6.0).abs() < 1e-9);
    }

    #[test]
    fn values_that_are_all_nothing_still_get_an_axis() {
        let axis = Axis::of_values("f", [0.0, f64::NAN].into_iter(), Scale::Linear, 4);
        assert_eq!(axis.ticks().last().map(|t| t.1.clone()), Some("1.2".into()));
    }
}
