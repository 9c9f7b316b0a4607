//! Files of refractiveindex.info: the small part of YAML that they use.

use super::formula::Formula;
use super::{OpticalConstants, Source};
use crate::spectrum::curve::{FIRST, LAST, SAMPLES, wavelength};

/// One item below `DATA:`.
#[derive(Default)]
struct Block {
    kind: String,
    table: Vec<Vec<f64>>,
    coefficients: Vec<f64>,
    range: Option<(f64, f64)>,
}

/// Read a `.yml` file; the error says what is wrong and where.
pub fn read(text: &str) -> Result<OpticalConstants, String> {
    let blocks = blocks(text)?;
    let (mut n, mut k) = (None, None);
    for block in &blocks {
        match block.kind.as_str() {
            "tabulated nk" => {
                n = n.or(Some(pairs(block, 1)?));
                k = k.or(Some(pairs(block, 2)?));
            }
            "tabulated n" => n = n.or(Some(pairs(block, 1)?)),
            "tabulated k" => k = k.or(Some(pairs(block, 1)?)),
            // Nonlinear indices say nothing about faint light.
            "tabulated n2" => {}
            other => match other.strip_prefix("formula ").and_then(|x| x.trim().parse::<u8>().ok()) {
                Some(number) => n = n.or(Some(formula(number, block)?)),
                None => return Err(format!("`type: {other}` is not known")),
            },
        }
    }
    let n = n.ok_or("it has no refractive index (`tabulated n`, `tabulated nk` or `formula 1` to `formula 9`)")?;
    for i in 0..SAMPLES {
        let (w, value) = (wavelength(i), n.at(wavelength(i)));
        if !(value.is_finite() && value > 0.0) {
            return Err(format!("its index at {w} nm is {value}, which is no refractive index"));
        }
    }
    Ok(OpticalConstants { n, k })
}

fn blocks(text: &str) -> Result<Vec<Block>, String> {
    let mut blocks: Vec<Block> = Vec::new();
    let (mut is_in_data, mut is_in_table) = (false, false);
    for (i, line) in text.lines().enumerate() {
        let bad = |what: &str| Err(format!("line {}: {what}", i + 1));
        let words = line.trim();
        if words.is_empty() || words.starts_with('#') {
            continue;
        }
        if !line.starts_with([' ', '-']) {
            is_in_data = words.starts_with("DATA:");
            is_in_table = false;
            continue;
        }
        if !is_in_data {
            continue;
        }
        let (is_first, words) = match words.strip_prefix("- ") {
            Some(rest) => (true, rest.trim()),
            None => (false, words),
        };
        if is_first {
            blocks.push(Block::default());
            is_in_table = false;
        }
        let Some(block) = blocks.last_mut() else { return bad("`DATA:` must be a list of `- type: ...`") };
        match words.split_once(':') {
            Some((key, value)) => {
                is_in_table = key.trim() == "data";
                let value = value.trim().trim_matches(['"', '\'']);
                match key.trim() {
                    "type" => block.kind = value.to_string(),
                    "coefficients" => match numbers(value) {
                        Some(c) => block.coefficients = c,
                        None => return bad("coefficients must be numbers"),
                    },
                    "wavelength_range" | "range" => match numbers(value).as_deref() {
                        Some(&[a, b]) if a < b => block.range = Some((a, b)),
                        _ => return bad("a range is two rising numbers"),
                    },
                    _ => {}
                }
            }
            None if is_in_table => match numbers(words) {
                Some(row) => block.table.push(row),
                None => return bad("a table's row must be numbers"),
            },
            None => {}
        }
    }
    if blocks.is_empty() {
        Err("it has no `DATA:`, so it is no file of refractiveindex.info".into())
    } else {
        Ok(blocks)
    }
}

fn numbers(text: &str) -> Option<Vec<f64>> {
    text.split([' ', ',', '\t', '[', ']'])
        .filter(|s| !s.is_empty())
        .map(|s| s.parse().ok().filter(|x: &f64| x.is_finite()))
        .collect()
}

fn pairs(block: &Block, column: usize) -> Result<Source, String> {
    let pair = |row: &Vec<f64>| match row.get(column) {
        Some(&value) => Ok((1000.0 * row[0], value)),
        None => Err(format!("a row of `{}` lacks a number", block.kind)),
    };
    let mut pairs = block.table.iter().map(pair).collect::<Result<Vec<_>, _>>()?;
    // Some measured tables are out of order, or say a wavelength twice; then the first holds.
    pairs.sort_by(|a, b| a.0.total_cmp(&b.0));
    pairs.dedup_by_key(|p| p.0);
    let range = pairs.first().map(|p| p.0).zip(pairs.last().map(|p| p.0));
    check_range(range, &block.kind)?;
    Ok(Source::Pairs(pairs))
}

fn formula(number: u8, block: &Block) -> Result<Source, String> {
    let range = block.range.map_or((FIRST, LAST), |(a, b)| (1000.0 * a, 1000.0 * b));
    check_range(Some(range), &block.kind)?;
    Ok(Source::Formula(Formula::new(number, block.coefficients.clone())?, range))
}

fn check_range(range: Option<(f64, f64)>, kind: &str) -> Result<(), String> {
    match range {
        None => Err(format!("its `{kind}` is empty")),
        Some((a, b)) if b < FIRST || a > LAST => {
            Err(format!("its `{kind}` goes from {a} nm to {b} nm, outside the visible 380-780 nm"))
        }
        _ => Ok(()),
    }
}
