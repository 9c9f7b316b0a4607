//! Time, and what is made of several measurements of it.

use std::time::Instant;

/// What is counted. Where computing cannot be told from waiting, all count what passes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Clock {
    /// Seconds that the calling thread computes: a busy machine distorts it little.
    Thread,
    /// Seconds that all threads of this process compute.
    Process,
    /// Seconds that pass.
    Wall,
}

impl Clock {
    /// How long `job` takes.
    pub fn seconds(self, job: impl FnOnce()) -> f64 {
        let (start, computed) = (Instant::now(), self.computed());
        job();
        match (computed, self.computed()) {
            (Some(before), Some(after)) => after - before,
            _ => start.elapsed().as_secs_f64(),
        }
    }

    #[cfg(unix)]
    fn computed(self) -> Option<f64> {
        use rustix::time::{ClockId, clock_gettime};
        let id = match self {
            Clock::Thread => ClockId::ThreadCPUTime,
            Clock::Process => ClockId::ProcessCPUTime,
            Clock::Wall => return None,
        };
        let t = clock_gettime(id);
        Some(t.tv_sec as f64 + t.tv_nsec as f64 * 1e-9)
    }

    #[cfg(not(unix))]
    fn computed(self) -> Option<f64> {
        None
    }
}

/// Middle and spread of a measurement.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Median {
    /// The median.
    pub value: f64,
    /// The median absolute deviation from it.
    pub deviation: f64,
}

/// The median of `values`, of which there must be some.
pub fn median(values: &[f64]) -> Median {
    let value = middle(values.to_vec());
    Median { value, deviation: middle(values.iter().map(|v| (v - value).abs()).collect()) }
}

fn middle(mut values: Vec<f64>) -> f64 {
    values.sort_by(f64::total_cmp);
    let n = values.len();
    (values[(n - 1) / 2] + values[n / 2]) * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_outlier_moves_neither_median_nor_deviation() {
        assert_eq!(median(&[2.0, 1.0, 900.0, 3.0, 2.5]), Median { value: 2.5, deviation: 0.5 });
        assert_eq!(median(&[1.0, 2.0]).value, 1.5);
    }

    #[test]
    fn time_passes_while_a_thread_computes() {
        let mut x = 1_u64;
        let mut spin = || (0..1_000_000).for_each(|_| x = std::hint::black_box(x.wrapping_mul(3)));
        for clock in [Clock::Thread, Clock::Process, Clock::Wall] {
            assert!(clock.seconds(&mut spin) > 0.0, "{clock:?}");
        }
    }
}
