//! Which pairs are likely to be found touching.

use std::collections::BTreeMap;

use super::filter::Other;

/// How often parts of a pair were searched, and how often with success.
///
/// A configuration is decided by any pair that touches, so pairs that seldom do are asked last: that changes no answer.
#[derive(Debug, Default)]
pub(super) struct PairOdds(BTreeMap<(u32, Other), [u32; 2]>);

impl PairOdds {
    pub(super) fn count(&mut self, pair: (u32, Other), is_hit: bool) {
        let [searches, hits] = self.0.entry(pair).or_default();
        *searches += 1;
        *hits += u32::from(is_hit);
    }

    /// How often parts of a pair were searched.
    #[cfg(test)]
    pub(super) fn searches(&self, pair: (u32, Other)) -> u32 {
        self.0.get(&pair).map_or(0, |[searches, _]| *searches)
    }

    /// More than half of the searches found nothing.
    pub(super) fn are_poor(&self, pair: (u32, Other)) -> bool {
        self.0.get(&pair).is_some_and(|[searches, hits]| 2 * hits < *searches)
    }
}
