//! Statistics of part searches by pair: how often the exact query of a pair with a composite found
//! the pair within the clearance.

use std::collections::BTreeMap;

use super::filter::Other;

/// For each pair, the number of part searches, and the number of searches that found the pair
/// within the clearance.
///
/// A configuration is not free if any pair touches, so pairs that seldom touch are searched last.
/// The order changes no result.
#[derive(Debug, Default)]
pub(super) struct PairOdds(BTreeMap<(u32, Other), [u32; 2]>);

impl PairOdds {
    pub(super) fn count(&mut self, pair: (u32, Other), is_hit: bool) {
        let [searches, hits] = self.0.entry(pair).or_default();
        *searches += 1;
        *hits += u32::from(is_hit);
    }

    /// Returns the number of part searches of a pair.
    #[cfg(test)]
    pub(super) fn searches(&self, pair: (u32, Other)) -> u32 {
        self.0.get(&pair).map_or(0, |[searches, _]| *searches)
    }

    /// Returns whether more than half of the part searches of a pair did not find the pair within
    /// the clearance.
    pub(super) fn are_poor(&self, pair: (u32, Other)) -> bool {
        self.0.get(&pair).is_some_and(|[searches, hits]| 2 * hits < *searches)
    }
}
