//! Boxes around what a pose has placed, rounded outwards.
//!
//! A coordinate of a placed point is `t + Σ Rᵢⱼ·pⱼ`. The sum is rounded, so that boxes grow by a bound of its error
//! ([`slack_of`]); adding `t` is as exact as the scalar allows ([`sum_below`], [`sum_above`]), so that solids far
//! from the origin have boxes as tight as others. Where a pose turns axes to axes nothing is rounded but that.

use super::Aabb;
use crate::math::outward::{slack_of, sum_above, sum_below};
use crate::math::{Point, Pose, Real, Vector, max, min};

impl<N: Real, const D: usize> Aabb<N, D> {
    /// The box around `center` that reaches `half_extents` along each axis, rounded outwards; for trusted numbers.
    #[inline]
    pub(crate) fn around(center: Point<N, D>, half_extents: Vector<N, D>) -> Self {
        Self::moved([&-half_extents, &half_extents], &center.coords)
    }

    /// The box between two corners, moved and rounded outwards.
    #[inline(always)]
    fn moved([low, high]: [&Vector<N, D>; 2], by: &Vector<N, D>) -> Self {
        let (mut mins, mut maxs) = (*by, *by);
        for axis in 0..D {
            mins[axis] = sum_below(by[axis], low[axis]);
            maxs[axis] = sum_above(by[axis], high[axis]);
        }
        Self { mins: Point::from(mins), maxs: Point::from(maxs) }
    }

    /// The box around a solid that is symmetric about the local origin, placed at `pose`. `reach` is how far it
    /// reaches along each outer axis: sums of magnitudes, each off by at most four units of its rounding.
    #[inline(always)]
    pub(crate) fn around_turned(pose: &Pose<N, D>, mut reach: Vector<N, D>) -> Self {
        if !pose.is_aligned() {
            for axis in 0..D {
                let slack = slack_of(reach[axis]);
                reach[axis] += slack;
            }
        }
        Self::around(Point::from(pose.translation), reach)
    }

    /// The box around points that are turned by `pose` already, but not moved: `low` and `high` are the least and
    /// the greatest of their coordinates as [`Pose::vector`] has them. No point is farther from the local origin
    /// than `size`. The box of everything where the numbers end.
    ///
    /// A coordinate of a turned point is a sum of D products and off by at most D·ε·size/2 (Higham, "Accuracy and
    /// Stability of Numerical Algorithms", 2002, section 3.1).
    #[inline]
    pub(crate) fn of_turned(
        mut low: Vector<N, D>,
        mut high: Vector<N, D>,
        size: N,
        pose: &Pose<N, D>,
    ) -> Self {
        if !pose.is_aligned() {
            let slack = slack_of(size);
            for axis in 0..D {
                (low[axis], high[axis]) = (low[axis] - slack, high[axis] + slack);
            }
        }
        let Self { mins, maxs } = Self::moved([&low, &high], &pose.translation);
        Self::try_new(mins, maxs).unwrap_or_else(|_| Self::unbounded())
    }

    /// The smallest box, in the outer frame, around this box placed at `pose`; rounded outwards, and exact where
    /// the pose turns axes to axes and the corners are numbers of the scalar.
    ///
    /// An unbounded axis of the local box makes every outer axis it leans on unbounded.
    #[must_use]
    pub fn transformed_by(&self, pose: &Pose<N, D>) -> Self {
        let is_aligned = pose.is_aligned();
        let (mut low, mut high) = (Vector::<N, D>::zeros(), Vector::<N, D>::zeros());
        for row in 0..D {
            let (mut below, mut above) = (N::ZERO, N::ZERO);
            for column in 0..D {
                let factor = pose.rotation[(row, column)];
                // 0 · ∞ is no number: such an axis says nothing of this one.
                if factor != N::ZERO {
                    let (a, b) = (factor * self.mins[column], factor * self.maxs[column]);
                    let (least, most) = (min(a, b), max(a, b));
                    (low[row], high[row]) = (low[row] + least, high[row] + most);
                    (below, above) = (below + least.abs(), above + most.abs());
                }
            }
            if !is_aligned {
                (low[row], high[row]) = (low[row] - slack_of(below), high[row] + slack_of(above));
            }
        }
        Self::moved([&low, &high], &pose.translation)
    }
}
