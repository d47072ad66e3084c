//! Boxes around placed solids, rounded outwards.
//!
//! A pose with rotation `R` and translation `t` maps a point `p` to the coordinates `tᵢ + Σⱼ
//! Rᵢⱼ·pⱼ`. The sum is rounded, so boxes are grown by an upper bound of its error ([`slack_of`]).
//! The addition of `tᵢ` is rounded outwards to a neighbouring number ([`sum_below`],
//! [`sum_above`]), so that the boxes of solids far from the origin are tight too. If a pose maps
//! axes to axes, only this addition is rounded.

use super::Aabb;
use crate::math::outward::{slack_of, sum_above, sum_below};
use crate::math::{Point, Pose, Real, Vector, max, min};

impl<N: Real, const D: usize> Aabb<N, D> {
    /// Returns the box with the given centre and half extents, rounded outwards; the coordinates
    /// are not checked.
    #[inline]
    pub(crate) fn around(center: Point<N, D>, half_extents: Vector<N, D>) -> Self {
        Self::moved([&-half_extents, &half_extents], &center.coords)
    }

    /// Returns the box between the corners `low` and `high`, translated by `by` and rounded
    /// outwards.
    #[inline(always)]
    fn moved([low, high]: [&Vector<N, D>; 2], by: &Vector<N, D>) -> Self {
        let (mut mins, mut maxs) = (*by, *by);
        for axis in 0..D {
            mins[axis] = sum_below(by[axis], low[axis]);
            maxs[axis] = sum_above(by[axis], high[axis]);
        }
        Self { mins: Point::from(mins), maxs: Point::from(maxs) }
    }

    /// Returns the box around a solid that is symmetric about its local origin, placed at `pose`.
    /// `extents` has the half extent of the solid along each outer axis. Each is a sum of
    /// magnitudes with a relative error of at most 2 ε.
    #[inline(always)]
    pub(crate) fn around_rotated(pose: &Pose<N, D>, mut extents: Vector<N, D>) -> Self {
        if !pose.is_aligned() {
            for axis in 0..D {
                let slack = slack_of(extents[axis]);
                extents[axis] += slack;
            }
        }
        Self::around(Point::from(pose.translation), extents)
    }

    /// Returns the box around points that `pose` has rotated but not yet translated. `low` and
    /// `high` are the least and greatest coordinates of the rotated points as computed by
    /// [`Pose::vector`]. `size` is an upper bound of the distance of the points from the local
    /// origin. The result is unbounded if one of its coordinates would be NaN, as after an
    /// overflow.
    ///
    /// A coordinate of a rotated point is a sum of D products with an error of at most D·ε·size/2
    /// (Higham, "Accuracy and Stability of Numerical Algorithms", 2002, section 3.1).
    #[inline]
    pub(crate) fn of_rotated(
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

    /// Returns the smallest box, in the outer frame, around this box placed at `pose`; rounded
    /// outwards, and exact if the pose maps axes to axes and the corners are representable.
    ///
    /// If the box is unbounded on a local axis, the result is unbounded on every outer axis to
    /// which that axis contributes.
    #[must_use]
    pub fn transformed_by(&self, pose: &Pose<N, D>) -> Self {
        let is_aligned = pose.is_aligned();
        let (mut low, mut high) = (Vector::<N, D>::zeros(), Vector::<N, D>::zeros());
        for row in 0..D {
            let (mut below, mut above) = (N::ZERO, N::ZERO);
            for column in 0..D {
                let factor = pose.rotation[(row, column)];
                // Skips 0 · ∞, which is NaN: this local axis does not contribute to this outer
                // axis.
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
