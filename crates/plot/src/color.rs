//! Colours that everybody can tell apart, and dashes for those who print in grey.

/// Red, green, blue (sRGB) and opacity.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Color(pub [u8; 3], pub f32);

impl Color {
    /// The sheet.
    pub const WHITE: Self = Color([255, 255, 255], 1.0);
    /// Texts and axes.
    pub const INK: Self = Color([38, 38, 42], 1.0);
    /// Numbers and lesser texts.
    pub const GREY: Self = Color([95, 95, 102], 1.0);
    /// Lines of a grid.
    pub const GRID: Self = Color([224, 225, 230], 1.0);

    /// The curve number `i`.
    pub fn of_curve(i: usize) -> Self {
        CURVES[i % CURVES.len()]
    }

    /// The same, seen through.
    pub fn faint(self, opacity: f32) -> Self {
        Color(self.0, opacity)
    }

    /// False colour of 0..1, dark to bright: equal steps look equal, and it prints well in grey. Values outside are clamped.
    pub fn of_value(x: f64) -> Self {
        let x = if x.is_nan() { 0.0 } else { x.clamp(0.0, 1.0) } * (RAMP.len() - 1) as f64;
        let i = (x as usize).min(RAMP.len() - 2);
        let mix = |c: usize| {
            let (a, b) = (f64::from(RAMP[i][c]), f64::from(RAMP[i + 1][c]));
            (a + (b - a) * (x - i as f64)).round() as u8
        };
        Color([mix(0), mix(1), mix(2)], 1.0)
    }

    /// False colour of -1..1: blue, white, red.
    pub fn of_difference(x: f64) -> Self {
        let x = if x.is_nan() { 0.0 } else { x.clamp(-1.0, 1.0) };
        let end = if x < 0.0 { [33.0, 102.0, 172.0] } else { [178.0, 24.0, 43.0] };
        Color(end.map(|e: f64| (247.0 + (e - 247.0) * x.abs()).round() as u8), 1.0)
    }
}

/// M. Okabe & K. Ito, "Color Universal Design", 2008, without yellow, which is too bright for lines, and with black last.
const CURVES: [Color; 7] = [
    Color([0, 114, 178], 1.0),
    Color([213, 94, 0], 1.0),
    Color([0, 158, 115], 1.0),
    Color([204, 121, 167], 1.0),
    Color([86, 180, 233], 1.0),
    Color([230, 159, 0], 1.0),
    Color([38, 38, 42], 1.0),
];

/// Viridis (S. van der Walt & N. Smith, 2015, CC0) at nine places.
const RAMP: [[u8; 3]; 9] = [
    [68, 1, 84],
    [71, 45, 123],
    [59, 82, 139],
    [44, 114, 142],
    [33, 145, 140],
    [40, 174, 128],
    [94, 201, 98],
    [173, 220, 48],
    [253, 231, 37],
];

/// How a line is broken.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Dash {
    /// Not at all.
    #[default]
    Solid,
    /// Long strokes.
    Dashed,
    /// Dots.
    Dotted,
    /// Strokes and dots in turn.
    DashDot,
}

impl Dash {
    /// The line style number `i`.
    pub fn of_style(i: usize) -> Self {
        [Dash::Solid, Dash::Dashed, Dash::Dotted, Dash::DashDot][i % 4]
    }

    /// Strokes and gaps in line widths; empty for none.
    pub fn pattern(self) -> &'static [f64] {
        match self {
            Dash::Solid => &[],
            Dash::Dashed => &[4.5, 2.5],
            Dash::Dotted => &[1.0, 2.0],
            Dash::DashDot => &[5.0, 2.0, 1.0, 2.0],
        }
    }
}
