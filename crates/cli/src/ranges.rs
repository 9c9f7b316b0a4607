//! Which samples a picture holds: `0..20` or `0..20,40..64`.

use std::fmt;
use std::ops::Range;

/// Ranges of sample numbers: rising, apart from each other, none empty (but for the one range of an empty picture).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct SampleRanges(Vec<Range<u32>>);

impl SampleRanges {
    /// One range.
    pub fn one(range: Range<u32>) -> Self {
        SampleRanges(vec![range])
    }

    /// As [`fmt::Display`] wrote it.
    pub fn parse(text: &str) -> Option<Self> {
        text.split(',').map(parse_range).collect::<Option<Vec<_>>>().map(SampleRanges)
    }

    /// The one range, if it is only one.
    pub fn single(&self) -> Option<Range<u32>> {
        match self.0.as_slice() {
            [one] => Some(one.clone()),
            _ => None,
        }
    }

    /// Both together; as error a range that is in both.
    pub fn union(&self, other: &Self) -> Result<Self, Range<u32>> {
        let mut all: Vec<Range<u32>> = self.0.iter().chain(&other.0).filter(|r| !r.is_empty()).cloned().collect();
        all.sort_by_key(|r| r.start);
        let mut joined: Vec<Range<u32>> = Vec::new();
        for range in all {
            match joined.last_mut() {
                Some(last) if range.start < last.end => return Err(range.start..range.end.min(last.end)),
                Some(last) if range.start == last.end => last.end = range.end,
                _ => joined.push(range),
            }
        }
        if joined.is_empty() {
            joined.push(0..0);
        }
        Ok(SampleRanges(joined))
    }
}

/// `A..B` with A <= B.
pub fn parse_range(text: &str) -> Option<Range<u32>> {
    let (a, b) = text.split_once("..")?;
    let range = a.trim().parse().ok()?..b.trim().parse().ok()?;
    (range.start <= range.end).then_some(range)
}

impl fmt::Display for SampleRanges {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let texts: Vec<String> = self.0.iter().map(|r| format!("{}..{}", r.start, r.end)).collect();
        f.write_str(&texts.join(","))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ranges_join_where_they_touch_and_refuse_to_overlap() {
        let r = |t: &str| SampleRanges::parse(t).unwrap();
        assert_eq!(r("20..64").union(&r("0..20")), Ok(r("0..64")));
        assert_eq!(r("0..20,40..64").union(&r("20..30")).unwrap().to_string(), "0..30,40..64");
        assert_eq!(r("0..20").union(&r("19..64")), Err(19..20));
        assert_eq!(r("0..0").union(&r("0..0")).unwrap().to_string(), "0..0");
        assert_eq!(SampleRanges::parse("3..1"), None);
        assert_eq!(SampleRanges::parse("x"), None);
    }
}
