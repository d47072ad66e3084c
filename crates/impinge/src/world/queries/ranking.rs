//! The best results of a query that ranks objects by a key.
//!
//! Results are ordered by (key, handle), whatever the order in which objects are proposed. A box is
//! skipped only if its key proves that its object has no result among the best.

use core::cmp::Ordering;
use std::collections::BinaryHeap;

use crate::math::{Real, max};
use crate::narrow_phase::CollisionObjectHandle;

/// The best results so far: those with the smallest keys and, at equal keys, the smallest handles.
/// Has at most `count` results, with keys of at most `limit`.
#[derive(Debug)]
pub(super) struct Ranking<N: Real, A> {
    count: usize,
    limit: N,
    /// A max-heap, with the worst result on top.
    heap: BinaryHeap<Ranked<N, A>>,
}

/// A result for an object, and its key: a time or a distance, not negative.
#[derive(Debug)]
pub(super) struct Ranked<N: Real, A> {
    pub(super) key: N,
    pub(super) handle: CollisionObjectHandle,
    pub(super) answer: A,
}

/// The best results so far, which limit the keys of further results.
pub(super) trait Rank<N: Real, A> {
    /// Returns the largest key with which a further result can still be among the best.
    fn limit(&self) -> N;

    /// Keeps the result if it is among the best. Drops a result with a NaN key.
    fn offer(&mut self, ranked: Ranked<N, A>);

    /// Returns the largest key of a box whose object may still have a result among the best.
    ///
    /// Keys of boxes are quotients, or square roots of sums, with errors of a few units in the last
    /// place. Squares of lengths below `√(MIN_POSITIVE / EPSILON)` lose digits to underflow, so the
    /// limit is never less than this length.
    fn limit_of_boxes(&self) -> N {
        let limit = self.limit();
        let least = (N::MIN_POSITIVE / N::EPSILON).sqrt();
        max(limit + limit * N::lit(8.0) * N::EPSILON, least)
    }
}

/// The number of requested results, and the largest key that they may have.
#[derive(Clone, Copy, Debug)]
pub(super) struct RankRange<N: Real> {
    pub(super) count: usize,
    pub(super) limit: N,
}

impl<N: Real> RankRange<N> {
    /// Requests all results with keys up to `limit`.
    pub(super) const fn for_all(limit: N) -> Self {
        Self { count: usize::MAX, limit }
    }
}

impl<N: Real, A> Ranking<N, A> {
    /// Creates a ranking of up to `count` results with keys of at most `limit`; `None` if `count`
    /// is zero, or `limit` is negative or NaN.
    pub(super) fn new(count: usize, limit: N) -> Option<Self> {
        let is_satisfiable = count > 0 && limit >= N::ZERO;
        is_satisfiable.then(|| Self { count, limit, heap: BinaryHeap::new() })
    }

    /// Returns the results, best first.
    pub(super) fn into_sorted(self) -> Vec<Ranked<N, A>> {
        self.heap.into_sorted_vec()
    }
}

impl<N: Real, A> Rank<N, A> for Ranking<N, A> {
    fn limit(&self) -> N {
        let last = self.heap.peek().filter(|_| self.heap.len() >= self.count);
        last.map_or(self.limit, |last| last.key)
    }

    fn offer(&mut self, ranked: Ranked<N, A>) {
        // Also false for a NaN key.
        let is_within = ranked.key <= self.limit();
        if is_within && self.heap.len() < self.count {
            self.heap.push(ranked);
        } else if is_within
            && let Some(mut last) = self.heap.peek_mut()
            && ranked < *last
        {
            *last = ranked;
        }
    }
}

/// The best result so far, for a query with a single result; does not allocate.
#[derive(Debug)]
pub(super) struct BestOne<N: Real, A> {
    limit: N,
    best: Option<Ranked<N, A>>,
}

impl<N: Real, A> BestOne<N, A> {
    /// Creates an empty ranking for the best result with a key of at most `limit`; `None` if
    /// `limit` is negative or NaN.
    pub(super) fn new(limit: N) -> Option<Self> {
        (limit >= N::ZERO).then_some(Self { limit, best: None })
    }

    /// Returns the best result; `None` if there is none.
    pub(super) fn found(self) -> Option<Ranked<N, A>> {
        self.best
    }
}

impl<N: Real, A> Rank<N, A> for BestOne<N, A> {
    fn limit(&self) -> N {
        self.best.as_ref().map_or(self.limit, |best| best.key)
    }

    fn offer(&mut self, ranked: Ranked<N, A>) {
        // The first comparison is false for a NaN key.
        let is_within = ranked.key <= self.limit();
        if is_within && self.best.as_ref().is_none_or(|best| ranked < *best) {
            self.best = Some(ranked);
        }
    }
}

impl<N: Real, A> Ord for Ranked<N, A> {
    fn cmp(&self, other: &Self) -> Ordering {
        let by_key = self.key.partial_cmp(&other.key).unwrap_or(Ordering::Equal);
        by_key.then(self.handle.cmp(&other.handle))
    }
}

impl<N: Real, A> PartialOrd for Ranked<N, A> {
    fn partial_cmp(&self, other: &Self) -> Option<Ordering> {
        Some(self.cmp(other))
    }
}

impl<N: Real, A> PartialEq for Ranked<N, A> {
    fn eq(&self, other: &Self) -> bool {
        self.cmp(other) == Ordering::Equal
    }
}

impl<N: Real, A> Eq for Ranked<N, A> {}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::generation::Generation;

    /// Keys and indices of offered results. NaN comes with the lowest index, early and late.
    const OFFERED: [(f32, u32); 7] =
        [(3.0, 6), (f32::NAN, 1), (1.0, 4), (2.0, 3), (1.0, 2), (9.0, 5), (f32::NAN, 0)];

    fn filled(count: usize, limit: f32) -> Vec<(f32, u32)> {
        let mut ranking = Ranking::new(count, limit).expect("room");
        for (key, index) in OFFERED {
            ranking.offer(Ranked {
                key,
                handle: CollisionObjectHandle::new(index, Generation::of_no_table(0)),
                answer: index,
            });
        }
        ranking.into_sorted().iter().map(|ranked| (ranked.key, ranked.answer)).collect()
    }

    #[test]
    fn the_best_by_key_then_handle() {
        assert_eq!(filled(1, 8.0), [(1.0, 2)], "the one");
        assert_eq!(filled(3, 8.0), [(1.0, 2), (1.0, 4), (2.0, 3)], "three of them");
        assert_eq!(
            filled(9, 2.0),
            [(1.0, 2), (1.0, 4), (2.0, 3)],
            "up to the limit, that included"
        );
        let all = filled(9, f32::INFINITY);
        assert_eq!(all.len(), 5, "all but NaN: {all:?}");
    }

    #[test]
    fn one_answer_is_that_of_a_ranking_of_one() {
        for limit in [0.5, 1.0, 2.0, f32::INFINITY] {
            let mut best = BestOne::new(limit).expect("room");
            for (key, index) in OFFERED {
                let handle = CollisionObjectHandle::new(index, Generation::of_no_table(0));
                best.offer(Ranked { key, handle, answer: index });
            }
            let found: Vec<_> =
                best.found().map(|best| (best.key, best.answer)).into_iter().collect();
            assert_eq!(found, filled(1, limit), "up to {limit}");
        }
        assert!(BestOne::<f32, ()>::new(f32::NAN).is_none(), "no room");
    }

    #[test]
    fn no_room() {
        for (count, limit) in [(0, 1.0), (1, -1.0), (1, f32::NAN)] {
            assert!(Ranking::<f32, ()>::new(count, limit).is_none(), "{count} up to {limit}");
        }
    }
}
