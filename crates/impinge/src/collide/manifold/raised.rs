//! Candidates for contact points that lie steeply above others.

use smallvec::SmallVec;

use super::reduce::ordering;
use crate::math::{Real, Vector, max};

/// Slope above which the line from one candidate to a farther one is steep, unless the request has
/// a rotation by which a corner on a steeper line may come near.
const STEEP: f64 = 1.0 / 2.0;

/// Candidates, each with its tangent coordinates and its distance, for the test which of them lie
/// steeply above others. If corners of several faces are candidates, such a corner may add area but
/// does not touch, and must not replace a corner on which the solid rests.
///
/// ```text
///     c───────────────c       the upper corners c span more than the feet n,
///      \_n─────────n_/        but only the feet touch
///     ─────────────────────
/// ```
pub(in crate::collide) struct Nearer<N: Real> {
    /// Sorted by the first coordinate.
    all: SmallVec<[(Vector<N, 2>, N); 16]>,
    /// Largest distance of a candidate that is above no other.
    level: N,
    slope: N,
}

impl<N: Real> Nearer<N> {
    /// `sine` is that of the request, and `level` at least the smallest distance.
    pub(in crate::collide) fn new(
        candidates: impl Iterator<Item = (Vector<N, 2>, N)>,
        level: N,
        sine: N,
    ) -> Self {
        let mut all: SmallVec<_> = candidates.collect();
        all.sort_by(|a: &(Vector<N, 2>, N), b| ordering(a.0.x, b.0.x));
        Self { all, level, slope: max(N::lit(STEEP), N::TWO * sine) }
    }

    /// Returns whether a candidate lies steeply above a nearer one. Only candidates within the
    /// distance are compared at which the slope to the nearest candidate is steep; those beside it
    /// come first, since the corner below is usually among them.
    pub(in crate::collide) fn is_below(&self, at: &Vector<N, 2>, distance: N) -> bool {
        if distance <= self.level {
            return false;
        }
        let aside = (distance - self.level) / self.slope;
        let is_below = |(other, lower): &(Vector<N, 2>, N)| {
            let reach = (distance - *lower) / self.slope;
            reach > N::ZERO && (at - other).norm_squared() < reach * reach
        };
        let middle = self.all.partition_point(|(other, _)| other.x < at.x);
        let (left, right) = self.all.split_at(middle);
        right.iter().take_while(|(other, _)| other.x <= at.x + aside).any(is_below)
            || left.iter().rev().take_while(|(other, _)| other.x >= at.x - aside).any(is_below)
    }
}
