//! Smooth spectra for colours: a sigmoid of a quadratic in the wavelength, always between 0 and 1.
//!
//! W. Jakob, J. Hanika, "A Low-Dimensional Function Space for Efficient Spectral Upsampling", 2019, equations 2 and 3,
//! <https://doi.org/10.1111/cgf.13626>. Coefficients are found by Gauss and Newton's method on the colour under D65 itself.
//! Saturated textures look their coefficients up in a table ([`from_table`]); all other colours are solved for one by one.

use super::curve::{SAMPLES, wavelength};
use super::observer::{apply, inverse, observer};
use std::sync::{LazyLock, OnceLock};

/// Coefficients of the quadratic in [`variable`], the highest power first.
pub type Coefficients = [f32; 3];

/// The quadratic's variable: -1 at 380 nm, 1 at 780 nm.
#[inline]
pub fn variable(nanometres: f32) -> f32 {
    (nanometres - 580.0) * (1.0 / 200.0)
}

/// The value at a wavelength in nm.
#[inline]
pub fn at_wavelength(c: &Coefficients, nanometres: f32) -> f32 {
    let t = variable(nanometres);
    let x = (c[0] * t + c[1]) * t + c[2];
    0.5 + 0.5 * x / (1.0 + x * x).sqrt()
}

/// Coefficients of the spectrum whose colour under D65 is `rgb`, each in 0..1, not all equal.
pub fn solve(rgb: [f32; 3]) -> Coefficients {
    let target = rgb.map(within);
    let grey = (target[0] + target[1] + target[2]) / 3.0;
    // Walk from grey to the colour, so that each step starts close.
    const STEPS: u32 = 6;
    let mut c = flat(grey);
    for step in 1..=STEPS {
        let share = f64::from(step) / f64::from(STEPS);
        c = refine(c, target.map(|x| grey + share * (x - grey)), if step == STEPS { 30 } else { 4 });
    }
    c.map(|x| x as f32)
}

/// A sigmoid never reaches 0 or 1.
fn within(x: f32) -> f64 {
    f64::from(x).clamp(2e-4, 1.0 - 2e-4)
}

/// Coefficients of the constant `value`, within 0..1.
fn flat(value: f64) -> [f64; 3] {
    let y = 2.0 * value - 1.0;
    [0.0, 0.0, y / (1.0 - y * y).sqrt()]
}

/// Greatest coefficient: steeper edges than within one sample serve no colour.
const STEEPEST: f64 = 4000.0;

fn refine(mut c: [f64; 3], target: [f64; 3], most_steps: u32) -> [f64; 3] {
    let (mut error, mut jacobian) = miss(&c, &target);
    for _ in 0..most_steps {
        let size = norm(&error);
        if size < 1e-7 {
            break;
        }
        let step = apply(&inverse(jacobian), error);
        // Shorten the step until it helps.
        let mut share = 1.0;
        let better = loop {
            let next: [f64; 3] = core::array::from_fn(|i| (c[i] - share * step[i]).clamp(-STEEPEST, STEEPEST));
            let (e, j) = miss(&next, &target);
            if norm(&e) < size {
                break Some((next, e, j));
            }
            share *= 0.5;
            if share < 1e-3 {
                break None;
            }
        };
        let Some((next, e, j)) = better else { break };
        (c, error, jacobian) = (next, e, j);
    }
    c
}

fn norm(v: &[f64; 3]) -> f64 {
    (v[0] * v[0] + v[1] * v[1] + v[2] * v[2]).sqrt()
}

/// How far the colour is off, and its derivatives by the coefficients.
fn miss(c: &[f64; 3], target: &[f64; 3]) -> ([f64; 3], [[f64; 3]; 3]) {
    let mut color = [0.0; 3];
    let mut jacobian = [[0.0; 3]; 3];
    for (i, w) in observer().reflected_weights().iter().enumerate().take(SAMPLES) {
        let t = (wavelength(i) - 580.0) / 200.0;
        let x = (c[0] * t + c[1]) * t + c[2];
        let root = 1.0 / (1.0 + x * x).sqrt();
        let value = 0.5 + 0.5 * x * root;
        let slope = 0.5 * root * root * root;
        for channel in 0..3 {
            color[channel] += w[channel] * value;
            let by_x = w[channel] * slope;
            jacobian[channel][0] += by_x * t * t;
            jacobian[channel][1] += by_x * t;
            jacobian[channel][2] += by_x;
        }
    }
    ([0, 1, 2].map(|i| color[i] - target[i]), jacobian)
}

/// Cells along each axis of the table.
const EDGE: usize = 32;

/// Coefficients by which channel is greatest, its value, and the other two relative to it. A column holds those of all values; it is
/// made when a colour first needs it, and is the same whoever does.
struct Table {
    columns: Vec<OnceLock<Column>>,
    nodes: [f32; EDGE],
}

type Column = Box<[[f32; 4]; EDGE]>;

static TABLE: LazyLock<Table> = LazyLock::new(|| Table {
    columns: (0..3 * EDGE * EDGE).map(|_| OnceLock::new()).collect(),
    nodes: core::array::from_fn(|i| node(i) as f32),
});

/// As [`solve`], nearly, from a table.
#[inline]
pub fn from_table(rgb: [f32; 3]) -> Coefficients {
    TABLE.look_up(rgb)
}

/// Nodes of the greatest channel crowd towards 0 and 1, where the coefficients grow.
fn node(i: usize) -> f64 {
    let smooth = |x: f64| x * x * (3.0 - 2.0 * x);
    smooth(smooth(i as f64 / (EDGE - 1) as f64))
}

#[cold]
fn column(greatest: usize, y: usize, x: usize) -> Column {
    let ratios = [x as f64 / (EDGE - 1) as f64, y as f64 / (EDGE - 1) as f64];
    let color = |z: usize| {
        let mut rgb = [0.0; 3];
        rgb[greatest] = node(z);
        rgb[(greatest + 1) % 3] = node(z) * ratios[0];
        rgb[(greatest + 2) % 3] = node(z) * ratios[1];
        rgb.map(|x| within(x as f32))
    };
    // From a dark one outwards, each from its neighbour.
    let start = EDGE / 5;
    let first = solve(color(start).map(|x| x as f32)).map(f64::from);
    let mut column = Box::new([[0.0; 4]; EDGE]);
    let mut walk = |places: &mut dyn Iterator<Item = usize>| {
        let mut c = first;
        for z in places {
            c = refine(c, color(z), 12);
            column[z] = [c[0] as f32, c[1] as f32, c[2] as f32, 0.0];
        }
    };
    walk(&mut (start..EDGE));
    walk(&mut (0..start).rev());
    column
}

impl Table {
    fn look_up(&self, rgb: [f32; 3]) -> Coefficients {
        let greatest = if rgb[0] > rgb[1] {
            if rgb[0] > rgb[2] { 0 } else { 2 }
        } else if rgb[1] > rgb[2] {
            1
        } else {
            2
        };
        let value = rgb[greatest];
        if value <= 0.0 {
            return [0.0, 0.0, -STEEPEST as f32];
        }
        let last = (EDGE - 1) as f32;
        let split = |place: f32| {
            let i = (place as usize).min(EDGE - 2);
            (i, place - i as f32)
        };
        let (x, dx) = split(rgb[(greatest + 1) % 3] / value * last);
        let (y, dy) = split(rgb[(greatest + 2) % 3] / value * last);
        let nodes = &self.nodes;
        let z = nodes.partition_point(|&n| n <= value).clamp(1, EDGE - 1) - 1;
        let dz = (value - nodes[z]) / (nodes[z + 1] - nodes[z]);
        let mix =
            |a: &[f32; 4], b: &[f32; 4], t: f32| -> [f32; 4] { core::array::from_fn(|i| a[i] + (b[i] - a[i]) * t) };
        let at = |y: usize, x: usize| {
            let column = self.columns[(greatest * EDGE + y) * EDGE + x].get_or_init(|| column(greatest, y, x));
            [&column[z], &column[z + 1]]
        };
        let corners = [at(y, x), at(y, x + 1), at(y + 1, x), at(y + 1, x + 1)];
        let plane = |z: usize| {
            let [a, b, c, d] = corners.map(|c| c[z]);
            mix(&mix(a, b, dx), &mix(c, d, dx), dy)
        };
        let [a, b, c, _] = mix(&plane(0), &plane(1), dz);
        [a, b, c]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn color(c: &Coefficients) -> [f64; 3] {
        let samples = core::array::from_fn(|i| at_wavelength(c, wavelength(i) as f32));
        observer().color_of_reflectance(&samples)
    }

    fn worst(of: impl Fn([f32; 3]) -> Coefficients, least: f32, most: f32) -> (f64, f64, [f32; 3]) {
        let (mut worst, mut sum, mut count, mut at) = (0.0, 0.0, 0.0, [0.0; 3]);
        let steps = 17;
        for i in 0..steps * steps * steps {
            let level = |k: i32| least + (most - least) * (k % steps) as f32 / (steps - 1) as f32;
            let rgb = [level(i), level(i / steps), level(i / steps / steps)];
            if rgb[0] == rgb[1] && rgb[1] == rgb[2] {
                continue;
            }
            let got = color(&of(rgb));
            let miss = (0..3).map(|k| (got[k] - f64::from(rgb[k])).abs()).fold(0.0, f64::max);
            sum += miss;
            count += 1.0;
            if miss > worst {
                (worst, at) = (miss, rgb);
            }
        }
        (worst, sum / count, at)
    }

    #[test]
    fn solved_colours_come_back_within_a_thousandth() {
        let found = worst(solve, 0.0, 1.0);
        assert!(found.0 < 1e-3, "{found:?}");
    }

    #[test]
    fn tabulated_colours_come_back_nearly() {
        let found = worst(from_table, 0.013, 0.987);
        assert!(found.0 < 1e-2 && found.1 < 1e-3, "{found:?}");
    }
}
