//! Shapes that are certainly too far apart, told before anything is turned.
//!
//! A ball around the origin of its frame holds a solid however it is turned. So the balls of two solids,
//! whose radii are known at once, and the difference of the positions tell most pairs apart that the
//! algorithms need not look at: without a rotation, an order of the two, or a feature.
//!
//! What is told here is what the algorithms would have answered. They are off by some hundred rounding
//! errors of the lengths of the pair, and all of these are at most twice the distance of the origins
//! where the balls do not meet. The squares are compared with a factor of 1 + 2⁻⁶: the balls of solids
//! that are told apart are farther from each other than the limit by 2⁻⁸ of that distance, which is
//! 2¹⁵ rounding errors of `f32`.

use crate::math::{Real, Vector, max, max_component, min};
use crate::shape::Geometry;

/// By how much the square of a distance must exceed that of the lengths it is held against.
const ROOM: f64 = 1.0 + 1.0 / 64.0;

/// Two shapes and the way from the origin of the first to that of the second, in any frame.
#[derive(Clone, Copy)]
pub(crate) struct Apart<'a, N: Real, const D: usize> {
    pub(crate) shapes: [Geometry<'a, N, D>; 2],
    pub(crate) between: Vector<N, D>,
}

impl<N: Real, const D: usize> Apart<'_, N, D> {
    /// The shapes are certainly farther apart than `limit`; a negative limit and NaN count as zero.
    ///
    /// `false` says nothing; it is the answer for half-spaces, composites and support maps of users, of
    /// which no ball is known.
    pub(crate) fn is_beyond(&self, limit: N) -> bool {
        self.is_clear(self.between.norm_squared(), self.reach(limit))
    }

    /// The same at all times up to `end`, zero included, while the second shape moves with `velocity`
    /// against the first.
    pub(crate) fn stays_beyond(&self, limit: N, velocity: &Vector<N, D>, end: N) -> bool {
        let speed_squared = velocity.norm_squared();
        // A speed whose square is no number of the type says nothing about when they are nearest.
        let is_still = max_component(velocity) <= N::ZERO;
        if !is_still && speed_squared <= N::MIN_POSITIVE {
            return false;
        }
        let nearest = if is_still { N::ZERO } else { -self.between.dot(velocity) / speed_squared };
        let way = self.between + velocity * max(min(nearest, end), N::ZERO);
        // The way is off by some rounding errors of the distance that it began with.
        let rounding = max_component(&self.between) * N::lit(4096.0) * N::EPSILON;
        self.is_clear(way.norm_squared(), self.reach(limit) + rounding)
    }

    /// How far apart the origins are at most where the shapes are no farther apart than `limit`.
    fn reach(&self, limit: N) -> N {
        self.shapes[0].extent() + self.shapes[1].extent() + max(limit, N::ZERO)
    }

    /// Squares that are subnormal numbers are not precise, which they are beside one that is not. NaN
    /// and infinities on the right are never exceeded; one on the left is too large for its type.
    #[inline]
    fn is_clear(&self, squared: N, reach: N) -> bool {
        squared > reach * reach * N::lit(ROOM) && squared > N::MIN_POSITIVE
    }
}

/// [`Apart::is_beyond`], to be reached from elsewhere.
pub(crate) fn are_beyond<N: Real, const D: usize>(apart: &Apart<'_, N, D>, limit: N) -> bool {
    apart.is_beyond(limit)
}
