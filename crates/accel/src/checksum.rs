//! A hash of 64-bit words, for telling files and scenes apart. It guards against accidents, not against malice.

use kirkas_geometry::hash::combine;

/// A hash in the making. Each word goes to one of four lanes in turn, so that the processor works on four at once (as
/// in xxHash, Collet 2012).
pub(crate) struct Checksum {
    lanes: [u64; 4],
    words: u64,
}

impl Checksum {
    pub fn new() -> Self {
        Checksum { lanes: [1, 2, 3, 4], words: 0 }
    }

    /// Every step is one to one: what differs in one word only never has the same hash.
    #[inline]
    pub fn word(&mut self, word: u64) {
        let lane = &mut self.lanes[(self.words & 3) as usize];
        let spread = lane.wrapping_add(word.wrapping_mul(0x9e37_79b9_7f4a_7c15));
        *lane = spread.rotate_left(31).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        self.words += 1;
    }

    /// Numbers of 32 bits, and how many.
    pub fn all(&mut self, numbers: impl IntoIterator<Item = u32>) {
        let (mut numbers, mut count) = (numbers.into_iter(), 0_u64);
        while let Some(low) = numbers.next() {
            let high = numbers.next();
            self.word(u64::from(low) | u64::from(high.unwrap_or(0)) << 32);
            count += 1 + u64::from(high.is_some());
        }
        self.word(count);
    }

    /// Of all words so far.
    pub fn value(&self) -> u64 {
        self.lanes.iter().fold(self.words, |hash, &lane| combine(hash, lane))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_differs_in_one_bit_or_in_order_has_another_hash() {
        let hash = |words: &[u64]| {
            let mut c = Checksum::new();
            words.iter().for_each(|&w| c.word(w));
            c.value()
        };
        let words: Vec<u64> = (0..9).map(|i| i * i).collect();
        let mut seen = vec![hash(&words), hash(&words[..8])];
        for i in 0..9 {
            for bit in 0..64 {
                let mut other = words.clone();
                other[i] ^= 1 << bit;
                seen.push(hash(&other));
            }
            for j in i + 1..9 {
                let mut other = words.clone();
                other.swap(i, j);
                seen.push(hash(&other));
            }
        }
        let count = seen.len();
        seen.sort_unstable();
        seen.dedup();
        assert_eq!(seen.len(), count);
    }
}
