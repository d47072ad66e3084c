//! Measures the processor time of the calling thread, and runs contenders in turn.

use cpu_time::ThreadTime;

/// The times of one contender, in the unit of the caller.
#[derive(Clone, Debug, Default)]
pub struct Times(pub Vec<f64>);

impl Times {
    /// Adds a time.
    pub fn push(&mut self, time: f64) {
        self.0.push(time);
    }

    /// Returns the quantile at `percent`; NaN without times.
    pub fn quantile(&self, percent: usize) -> f64 {
        let mut times = self.0.clone();
        times.sort_unstable_by(f64::total_cmp);
        let last = times.len().saturating_sub(1);
        times.get(last * percent / 100).copied().unwrap_or(f64::NAN)
    }

    /// Returns the median; NaN without times.
    pub fn median(&self) -> f64 {
        self.quantile(50)
    }
}

/// Runs `work`. Returns the processor time that it took on this thread, in nanoseconds, and its
/// result.
pub fn timed<R>(work: impl FnOnce() -> R) -> (f64, R) {
    let start = ThreadTime::now();
    let result = work();
    (start.elapsed().as_secs_f64() * 1e9, result)
}

/// Runs the contenders in turn for `rounds` timed rounds, after one round that is not timed.
///
/// Each round begins with the next contender, so that no contender always runs first, or always
/// finds the caches as the same other contender left them. The times are nanoseconds divided by
/// `operations`, the number of operations of one call.
pub fn in_turn(
    rounds: usize,
    operations: usize,
    contenders: &mut [&mut dyn FnMut()],
) -> Vec<Times> {
    let count = contenders.len();
    let mut times = vec![Times::default(); count];
    for round in 0..=rounds {
        for n in (0..count).map(|n| (n + round) % count) {
            let (time, ()) = timed(&mut *contenders[n]);
            if round > 0 {
                times[n].push(time / operations as f64);
            }
        }
    }
    times
}
