//! The span of time during which a line is inside a convex set.

use super::RayIntersection;
use crate::math::{Real, Vector};
use crate::shape::FeatureId;

/// A crossing of a line with a boundary: time, outward normal and feature.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Crossing<N: Real, const D: usize> {
    /// The time; it may be negative (behind the origin) or infinite (never).
    pub(super) t: N,
    /// The outward unit normal.
    pub(super) normal: Vector<N, D>,
    pub(super) feature: FeatureId,
}

/// The span from entering to leaving: `enter.t ≤ leave.t` up to rounding.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Span<N: Real, const D: usize> {
    pub(super) enter: Crossing<N, D>,
    pub(super) leave: Crossing<N, D>,
    /// Whether the line stays on the boundary; a hollow query then has the result of a solid query.
    pub(super) thin: bool,
}

impl<N: Real, const D: usize> Crossing<N, D> {
    pub(super) const fn new(t: N, normal: Vector<N, D>, feature: FeatureId) -> Self {
        Self { t, normal, feature }
    }

    /// Returns a crossing that never happens, at the time `t` of plus or minus infinity.
    pub(super) fn never(t: N) -> Self {
        Self::new(t, Vector::<N, D>::zeros(), FeatureId::Face(0))
    }

    fn hit(self) -> Option<RayIntersection<N, D>> {
        let Self { t, normal, feature } = self;
        // Adding to zero turns −0 into 0.
        let toi = N::ZERO + t;
        toi.is_finite_number().then_some(RayIntersection { toi, normal, feature, part: 0 })
    }
}

impl<N: Real, const D: usize> Span<N, D> {
    /// Returns the span of all time.
    pub(super) fn everything() -> Self {
        Self {
            enter: Crossing::never(-N::INFINITY),
            leave: Crossing::never(N::INFINITY),
            thin: false,
        }
    }

    /// Returns the span on a set without thickness: one time, or the times of the two ends of a
    /// chord.
    pub(super) fn thin(enter: Crossing<N, D>, leave: Crossing<N, D>) -> Self {
        Self { enter, leave, thin: true }
    }

    /// Returns the span of the union of two convex sets, which must itself be convex. It is thin if
    /// one span is: a line that stays on the boundary of one set does not enter their union.
    pub(super) fn union(self, other: Self) -> Self {
        Self {
            enter: if other.enter.t < self.enter.t { other.enter } else { self.enter },
            leave: if other.leave.t > self.leave.t { other.leave } else { self.leave },
            thin: self.thin || other.thin,
        }
    }

    /// Returns the union of two spans; `None` stands for an empty span.
    pub(super) fn union_of(first: Option<Self>, second: Option<Self>) -> Option<Self> {
        match (first, second) {
            (Some(first), Some(second)) => Some(first.union(second)),
            (first, second) => first.or(second),
        }
    }

    /// Returns the first hit at a time of zero or more. `None` if the line leaves the set before
    /// time zero, if it starts in a hollow set and never leaves it, or if it never enters the set.
    pub(super) fn first_hit(self, solid: bool) -> Option<RayIntersection<N, D>> {
        if self.enter.t >= N::ZERO {
            return self.enter.hit();
        }
        let starts_inside = self.leave.t >= N::ZERO;
        if !starts_inside {
            return None;
        }
        if !solid && !self.thin {
            return self.leave.hit();
        }
        let behind = -self.enter.t < self.leave.t;
        let feature = if behind { self.enter.feature } else { self.leave.feature };
        Some(RayIntersection { toi: N::ZERO, normal: Vector::<N, D>::zeros(), feature, part: 0 })
    }
}
