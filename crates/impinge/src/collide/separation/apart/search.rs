//! Searches for the nearest points of two cores, for all lanes at once.
//!
//! ```text
//!   along = nearest / |nearest|     the next direction of search, unit
//!   corner                          the lowest point of core 2 - core 1 along `along`
//!   upper = |nearest|               two points of the cores are this far apart
//!   lower = along · corner          supporting planes: no two points are nearer
//!   upper - lower <= tolerance      the lane is closed: proved
//! ```

use super::core::LaneCore;
use super::simplex::{LaneCorner, LaneSimplex};
use crate::math::lanes::{
    LanePose, cross, dot, either, lit, minus, negated, over, plus, rotated_into, times,
};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide, max};

/// Largest number of steps, each with one support point of each core. Most pairs take five or six.
const ROUNDS: usize = 32;

/// Smallest distance of the cores, in units of the pair, at which the search returns a separation:
/// 2⁻⁶. Closer pairs fall back to algorithms that also handle contact.
pub(super) const MIN_GAP: f64 = 1.0 / 64.0;

/// Edges count as parallel if the squared sine of their angle is below this: 2⁻²⁰.
const PARALLEL: f64 = 1.0 / 1_048_576.0;

/// Returns the largest difference of the upper and the lower bound of a distance at which they
/// count as equal, in units of the pair: 2⁻¹⁹ in `f32`, 2⁻⁴⁶ in `f64`.
fn tolerance<N: Real>() -> N {
    max(N::lit(16.0) * N::EPSILON, N::lit(1.0 / 70_368_744_177_664.0))
}

/// Two cores in units of the pair, and the pose of the second in the frame of the first.
pub(super) struct LaneCores<'a, N: Real, V> {
    pub(super) cores: [LaneCore<'a, N, V>; 2],
    pub(super) pose12: LanePose<V, 3>,
    /// Vector from the centre of the first core to the centre of the second: the first direction of
    /// search.
    pub(super) between: [V; 3],
    /// Limit of the distance, in units of the pair. Lanes beyond it need no result.
    pub(super) limit: V,
}

/// Result of the search, in units of the pair and in the frame of the first core.
pub(super) struct LaneGap<V, M> {
    /// Lower bound of the distance of the cores. In the lanes of `is_apart` it equals the distance
    /// up to rounding.
    pub(super) distance: V,
    /// Unit vector from the first core to the second.
    pub(super) normal: [V; 3],
    /// Nearest points of both cores.
    pub(super) points: [[V; 3]; 2],
    /// Lanes whose cores are proved to be apart by more than [`MIN_GAP`], with a single pair of
    /// nearest points. `distance`, `normal` and `points` are proved only there.
    pub(super) is_apart: M,
    /// Lanes whose cores are farther apart than the limit.
    pub(super) is_beyond: M,
    /// Lanes whose cores certainly overlap.
    pub(super) is_overlap: M,
}

impl<N: Real, V: Copy> LaneCores<'_, N, V> {
    /// Runs the search. Without `with_overlap`, a lane stops without a result as soon as its upper
    /// bound of the distance is at most [`MIN_GAP`].
    ///
    /// A finished lane keeps its values, so no lane depends on other lanes.
    #[inline(always)]
    pub(super) fn gap<S: Simd>(&self, simd: S, with_overlap: bool) -> LaneGap<V, V::Mask>
    where
        V: Wide<S, Scalar = N>,
    {
        let (zero, least) = (V::all(simd, N::ZERO), lit::<S, N, V>(simd, MIN_GAP));
        let none = zero.simd_gt(zero);
        let start = over(&self.between, dot(&self.between, &self.between).sqrt());
        let mut simplex = LaneSimplex::new(simd, self.corner(simd, &start));
        let (mut normal, mut distance) = (start, zero);
        let (mut is_open, mut is_closed) = (!none, none);
        let (mut is_beyond, mut is_overlap) = (none, none);
        for _ in 0..ROUNDS {
            let upper = simplex.squared.sqrt();
            let along = over(&simplex.nearest, upper);
            let corner = self.corner(simd, &along);
            let lower = dot(&along, &corner.point);
            normal = either(is_open, &along, &normal);
            distance = is_open.select(lower, distance);
            is_beyond |= is_open & lower.simd_gt(self.limit);
            let gap = upper - lower;
            let closes = is_open & gap.simd_le(V::all(simd, tolerance()));
            let (next, holds_origin) = simplex.with(simd, &corner);
            let is_nearer = next.squared.simd_lt(simplex.squared);
            let stalls = is_open & !is_nearer & gap.simd_le(V::all(simd, N::TWO * tolerance()));
            is_closed |= closes | stalls;
            is_overlap |= is_open & !closes & holds_origin;
            is_open = is_open & is_nearer & !(is_closed | is_beyond | is_overlap);
            if !with_overlap {
                is_open &= upper.simd_gt(least);
            }
            if !is_open.any_true() {
                break;
            }
            simplex = simplex.or(&next, is_open);
        }
        let is_apart = is_closed & !is_beyond & distance.simd_gt(least);
        let is_apart = is_apart & self.is_unique(simd, &normal);
        let points = simplex.points();
        LaneGap { distance, normal, points, is_apart, is_beyond, is_overlap }
    }

    /// Returns the point of the difference (second core minus first) that is lowest along a unit
    /// vector.
    #[inline(always)]
    fn corner<S: Simd>(&self, simd: S, along: &[V; 3]) -> LaneCorner<V>
    where
        V: Wide<S, Scalar = N>,
    {
        let on1 = self.cores[0].support(simd, along);
        let toward1 = rotated_into(&self.pose12.rotation, &negated(along));
        let on2 = self.pose12.point(&self.cores[1].support(simd, &toward1));
        LaneCorner { point: minus(&on2, &on1), on1 }
    }

    /// Returns the lanes with a single pair of nearest points: one of the nearest features is a
    /// vertex, or both are edges that are not parallel. If there are several nearest pairs, the
    /// points of a separation are in their middle, which other algorithms compute.
    #[inline(always)]
    fn is_unique<S: Simd>(&self, simd: S, normal: &[V; 3]) -> V::Mask
    where
        V: Wide<S, Scalar = N>,
    {
        let level = lit::<S, N, V>(simd, 16.0) * V::all(simd, tolerance());
        let (one, two) = (V::all(simd, N::ONE), V::all(simd, N::TWO));
        let ties1 = self.cores[0].ties(simd, normal, level);
        let is_corner1 = ties1.count.simd_le(one);
        if is_corner1.all_true() {
            return is_corner1;
        }
        let toward1 = rotated_into(&self.pose12.rotation, &negated(normal));
        let ties2 = self.cores[1].ties(simd, &toward1, level);
        let along2 = self.pose12.vector(&ties2.along);
        let turn = cross(&ties1.along, &along2);
        let lengths = dot(&ties1.along, &ties1.along) * dot(&along2, &along2);
        let crosses = dot(&turn, &turn).simd_gt(lit::<S, N, V>(simd, PARALLEL) * lengths);
        let are_edges = ties1.count.simd_le(two) & ties2.count.simd_le(two);
        is_corner1 | ties2.count.simd_le(one) | (are_edges & crosses)
    }
}

impl<V: Copy> LaneSimplex<V> {
    /// Selects `other` in the lanes of `is_other`, else `self`.
    #[inline(always)]
    fn or<S: Simd>(&self, other: &Self, is_other: V::Mask) -> Self
    where
        V: Wide<S>,
    {
        let [first, second, third] = &self.corners;
        Self {
            corners: [
                first.or(&other.corners[0], is_other),
                second.or(&other.corners[1], is_other),
                third.or(&other.corners[2], is_other),
            ],
            weights: either(is_other, &other.weights, &self.weights),
            nearest: either(is_other, &other.nearest, &self.nearest),
            squared: is_other.select(other.squared, self.squared),
        }
    }

    /// Returns the nearest points of the first and the second core.
    #[inline(always)]
    fn points<S: Simd>(&self) -> [[V; 3]; 2]
    where
        V: Wide<S>,
    {
        let [first, second, third] = &self.corners;
        let some = plus(&times(&first.on1, self.weights[0]), &times(&second.on1, self.weights[1]));
        let point1 = plus(&some, &times(&third.on1, self.weights[2]));
        [point1, plus(&point1, &self.nearest)]
    }
}
