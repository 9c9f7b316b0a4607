//! Dispersion formulas as refractiveindex.info numbers them; wavelengths in micrometres.
//!
//! M. N. Polyanskiy, "Refractiveindex.info database of optical constants", 2024, <https://doi.org/10.1038/s41597-023-02898-2>,
//! and the database's "Dispersion formulas".

use kirkas_geometry::elementary::pow;

/// One of the formulas with its coefficients.
#[derive(Clone, Debug, PartialEq)]
pub struct Formula {
    number: u8,
    c: Vec<f64>,
}

impl Formula {
    /// Formula `number` (1 to 9) with its coefficients, C1 first; the error says what is wrong with them.
    pub fn new(number: u8, coefficients: Vec<f64>) -> Result<Self, String> {
        let count = coefficients.len();
        let (least, most) = match number {
            1..=3 | 5 | 6 => (1, 17),
            4 => (9, 17),
            7 => (3, 6),
            8 => (4, 4),
            9 => (6, 6),
            _ => return Err(format!("there is no formula {number}; they are 1 to 9")),
        };
        if count < least || count > most {
            return Err(format!("formula {number} takes {least} to {most} coefficients, not {count}"));
        }
        if matches!(number, 1..=6) && count.is_multiple_of(2) {
            return Err(format!("formula {number} takes C1 and then pairs, not {count} coefficients"));
        }
        Ok(Formula { number, c: coefficients })
    }

    /// Cauchy's `n = A + B / l^2 + C / l^4 + ...`.
    pub fn cauchy(terms: &[f64]) -> Self {
        let mut c = vec![terms.first().copied().unwrap_or(1.0)];
        for (i, b) in terms.iter().enumerate().skip(1) {
            c.extend([*b, -2.0 * i as f64]);
        }
        Formula { number: 5, c }
    }

    /// Sellmeier's `n^2 = 1 + B1 l^2 / (l^2 - C1) + ...` from `B1, B2, ..., C1, C2, ...`, as glass makers publish it.
    pub fn sellmeier(b_then_c: &[f64]) -> Self {
        let half = b_then_c.len() / 2;
        let mut c = vec![0.0];
        for i in 0..half {
            c.extend([b_then_c[i], b_then_c[half + i]]);
        }
        Formula { number: 2, c }
    }

    /// The index at a wavelength in micrometres; NaN where the formula has none.
    pub fn at(&self, l: f64) -> f64 {
        let c = |i: usize| self.c.get(i - 1).copied().unwrap_or(0.0);
        let l2 = l * l;
        let pairs = |first: usize| self.c[(first - 1).min(self.c.len())..].chunks_exact(2).map(|p| (p[0], p[1]));
        match self.number {
            1 => (1.0 + c(1) + pairs(2).map(|(b, d)| b * l2 / (l2 - d * d)).sum::<f64>()).sqrt(),
            2 => (1.0 + c(1) + pairs(2).map(|(b, d)| b * l2 / (l2 - d)).sum::<f64>()).sqrt(),
            3 => (c(1) + pairs(2).map(|(b, e)| b * pow(l, e)).sum::<f64>()).sqrt(),
            4 => {
                let pole = |i| c(i) * pow(l, c(i + 1)) / (l2 - pow(c(i + 2), c(i + 3)));
                (c(1) + pole(2) + pole(6) + pairs(10).map(|(b, e)| b * pow(l, e)).sum::<f64>()).sqrt()
            }
            5 => c(1) + pairs(2).map(|(b, e)| b * pow(l, e)).sum::<f64>(),
            6 => 1.0 + c(1) + pairs(2).map(|(b, d)| b / (d - 1.0 / l2)).sum::<f64>(),
            7 => {
                let p = 1.0 / (l2 - 0.028);
                c(1) + c(2) * p + c(3) * p * p + c(4) * l2 + c(5) * l2 * l2 + c(6) * l2 * l2 * l2
            }
            8 => {
                let x = c(1) + c(2) * l2 / (l2 - c(3)) + c(4) * l2;
                ((1.0 + 2.0 * x) / (1.0 - x)).sqrt()
            }
            _ => {
                let d = l - c(5);
                (c(1) + c(2) / (l2 - c(3)) + c(4) * d / (d * d + c(6))).sqrt()
            }
        }
    }
}
