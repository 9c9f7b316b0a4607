//! Spectra from text files: two columns, wavelength and value, with anything that is no digit between them.

/// Pairs of wavelength (nm, rising) and value of a `.csv`, `.spd` or `.txt` file. Wavelengths below 10 are taken as
/// micrometres. Lines that begin with `#` or a letter are comments.
pub fn read_pairs(text: &str) -> Result<Vec<(f64, f64)>, String> {
    let mut pairs: Vec<(f64, f64)> = Vec::new();
    for (number, line) in text.lines().enumerate() {
        let line = line.trim().trim_start_matches('\u{feff}');
        if line.is_empty() || line.starts_with(|c: char| c == '#' || c == '"' || c.is_alphabetic()) {
            continue;
        }
        let mut numbers = line.split(|c: char| c.is_whitespace() || c == ',' || c == ';').filter(|s| !s.is_empty());
        let mut next = || numbers.next().and_then(|s| s.parse::<f64>().ok()).filter(|x| x.is_finite());
        let (Some(wavelength), Some(value)) = (next(), next()) else {
            return Err(format!("line {} does not begin with two numbers", number + 1));
        };
        let wavelength = if wavelength < 10.0 { 1000.0 * wavelength } else { wavelength };
        if pairs.last().is_some_and(|p| p.0 >= wavelength) {
            return Err(format!("line {}: wavelengths must rise", number + 1));
        }
        if value < 0.0 {
            return Err(format!("line {}: {value} is negative", number + 1));
        }
        pairs.push((wavelength, value));
    }
    match (pairs.first(), pairs.last()) {
        (Some(a), Some(b)) if a.0 < super::curve::LAST && b.0 > super::curve::FIRST => Ok(pairs),
        (Some(_), _) => Err("it has nothing between 380 nm and 780 nm".into()),
        _ => Err("it has no pairs of wavelength and value".into()),
    }
}
