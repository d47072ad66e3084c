//! The violations found, by law and pair of kinds.

use std::collections::BTreeMap;

/// Statistics of one law and one pair of kinds: results tested, violations, the worst error, and
/// its description.
#[derive(Default)]
struct Tally {
    asked: usize,
    broken: usize,
    worst: f64,
    what: String,
}

#[derive(Default)]
pub(crate) struct Report {
    tallies: BTreeMap<String, Tally>,
}

impl Report {
    /// Counts a result of a law, and a violation if `error` is above `allowed` or NaN.
    pub(crate) fn within(
        &mut self,
        law: String,
        error: f64,
        allowed: f64,
        what: impl FnOnce() -> String,
    ) {
        let is_broken = error > allowed || error.is_nan();
        let tally = self.tallies.entry(law).or_default();
        tally.asked += 1;
        tally.broken += usize::from(is_broken);
        if is_broken && (error > tally.worst || error.is_nan() || tally.what.is_empty()) {
            (tally.worst, tally.what) = (error, what());
        } else {
            tally.worst = tally.worst.max(error);
        }
    }

    /// Counts a result of a law that has no measure of error, and a violation if `holds` is
    /// `false`.
    pub(crate) fn holds(&mut self, law: String, holds: bool, what: impl FnOnce() -> String) {
        self.within(law, if holds { 0.0 } else { 1.0 }, 0.5, what);
    }

    /// Returns the number of results tested.
    pub(crate) fn asked(&self) -> usize {
        self.tallies.values().map(|tally| tally.asked).sum()
    }

    /// Returns a line for each violated law, except for known violations.
    pub(crate) fn broken(&self, is_known: fn(&str) -> bool) -> Vec<String> {
        let broken = self.tallies.iter().filter(|(law, tally)| tally.broken > 0 && !is_known(law));
        let line = |(law, tally): (&String, &Tally)| {
            let Tally { asked, broken, worst, what } = tally;
            format!("{law}: {broken} of {asked}, at most {worst:.1}: {what}")
        };
        broken.map(line).collect()
    }
}
