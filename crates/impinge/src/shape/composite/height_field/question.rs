//! Tests of a search box against the box of a block or a part: overlap, distance, time of impact.

use super::grid::GridExtent;
use crate::bounding_volume::Aabb;
use crate::math::{Real, Vector, max};

/// The box of a search, at rest or moving; faces may be infinite.
#[derive(Clone, Copy, Debug)]
pub(super) struct FieldProbe<N: Real> {
    own: GridExtent<N>,
}

/// Distances and times are lowered by this many epsilon of their value, so that they are lower
/// bounds: coordinates are subtracted (and divided) once, and at most three squares are summed. The
/// margin is larger than these errors for the sake of rays: a ray between two cells must find the
/// cell whose triangle the exact test hits.
const ROUNDING: f64 = 16.0;

impl<N: Real> FieldProbe<N> {
    /// Returns the probe for `aabb`, with zero on axes that 2D lacks. `None` if the box has no
    /// finite point.
    pub(super) fn new<const D: usize>(aabb: &Aabb<N, D>) -> Option<Self> {
        let mut own = GridExtent { low: [N::ZERO; 3], high: [N::ZERO; 3] };
        for axis in 0..D {
            own.low[axis] = aabb.mins()[axis];
            own.high[axis] = aabb.maxs()[axis];
        }
        let is_reachable =
            (0..3).all(|axis| own.low[axis] < N::INFINITY && own.high[axis] > -N::INFINITY);
        is_reachable.then_some(Self { own })
    }

    /// Returns the minimum and maximum corner.
    pub(super) const fn corners(&self) -> ([N; 3], [N; 3]) {
        (self.own.low, self.own.high)
    }

    /// Returns 0 if the boxes overlap or touch, else `None`; a key for
    /// [`search`](super::grid::search).
    pub(super) fn overlap(&self, other: &GridExtent<N>) -> Option<N> {
        let meets = (0..3).all(|axis| {
            self.own.low[axis] <= other.high[axis] && other.low[axis] <= self.own.high[axis]
        });
        meets.then_some(N::ZERO)
    }

    /// Returns a lower bound of the distance to `other`; never `None`.
    pub(super) fn distance(&self, other: &GridExtent<N>) -> Option<N> {
        let mut gap = Vector::<N, 3>::zeros();
        for axis in 0..3 {
            let below = max(other.low[axis] - self.own.high[axis], N::ZERO);
            let above = max(self.own.low[axis] - other.high[axis], N::ZERO);
            gap[axis] = max(below, above);
        }
        // If squares overflow or underflow, the largest gap is a lower bound too.
        let squared = gap.norm_squared();
        let is_usable = squared > N::MIN_POSITIVE && squared < N::MAX;
        let distance = if is_usable { squared.sqrt() } else { crate::math::max_component(&gap) };
        Some(distance * (N::ONE - N::lit(ROUNDING) * N::EPSILON))
    }

    /// Returns a lower bound, at least 0, of the time at which the box moving with `velocity` hits
    /// `other`; `None` if it misses.
    ///
    /// Slab test (Kay and Kajiya 1986), widened by the rounding errors of the times (Ize 2013).
    pub(super) fn time(&self, velocity: &[N; 3], other: &GridExtent<N>) -> Option<N> {
        let (mut enter, mut leave) = (N::ZERO, N::INFINITY);
        for (axis, &speed) in velocity.iter().enumerate() {
            let (to_low, to_high) =
                (other.low[axis] - self.own.high[axis], other.high[axis] - self.own.low[axis]);
            if speed == N::ZERO {
                if to_low > N::ZERO || to_high < N::ZERO {
                    return None;
                }
                continue;
            }
            let (from, to) = if speed > N::ZERO { (to_low, to_high) } else { (to_high, to_low) };
            let (from, to) = (from / speed, to / speed);
            let slack = N::lit(ROUNDING) * N::EPSILON;
            enter = max(enter, from - from.abs() * slack);
            leave = crate::math::min(leave, to + to.abs() * slack);
        }
        (enter <= leave && enter < N::INFINITY).then_some(enter)
    }
}

/// Returns `velocity` in 3D, with zero on axes that 2D lacks; `None` if a component is not finite.
pub(super) fn lifted<N: Real, const D: usize>(velocity: &Vector<N, D>) -> Option<[N; 3]> {
    let mut lifted = [N::ZERO; 3];
    for axis in 0..D {
        lifted[axis] = velocity[axis];
    }
    lifted.iter().all(|x| x.is_finite_number()).then_some(lifted)
}
