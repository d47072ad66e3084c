//! A box at rest for distance tests against blocks. Squared distances are in `f32`; limits and
//! results are widened by their error bound, so that no box within a limit is missed.

use super::kernel::{Scalar, WideBlock, low_half};
use super::{Block, Bounds, LANES};
use crate::bounding_volume::Aabb;
use crate::math::{Mapped, Real, f32_above, f32_below};
use fearless_simd::{Select, Simd, SimdBase, SimdMask, f32x16, mask32x16};

/// Magnitude of coordinates, 2¹²⁵, at and above which differences may overflow `f32`.
const LARGEST: f32 = f32::from_bits((125 + 127) << 23);

/// Least value used for the largest coordinate, 2⁻¹²⁰, so that the unit has a finite reciprocal.
const SMALLEST: f32 = f32::from_bits((127 - 120) << 23);

/// Relative error bound of a squared distance, in `f32` rounding units. It covers the test here and
/// the caller's test in its own scalar type.
const SQUARE: f32 = 16.0;

/// A box for tests of its squared distances to the boxes of a block.
///
/// Distances are in units of a power of two near the largest coordinate, so that squares stay in
/// range at any scale.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Gaps<const D: usize> {
    lo: [f32; D],
    hi: [f32; D],
    /// Reciprocal of the unit of distance.
    scale: f32,
    /// Absolute error that underflow may cause in the caller's squared distances.
    lost: f64,
}

impl<const D: usize> Gaps<D> {
    /// Converts a box that contains a finite point, for trees with coordinates up to `size`.
    ///
    /// If a finite coordinate is 2¹²⁵ or more, `f32` differences may overflow. The result then
    /// covers all of space: every box is at distance zero.
    pub(crate) fn new<N: Real>(aabb: &Aabb<N, D>, size: f32) -> Self {
        let mut largest = size;
        for axis in 0..D {
            for face in [aabb.mins()[axis], aabb.maxs()[axis]] {
                let magnitude = face.as_f32().abs();
                largest =
                    if face.is_finite_number() { f32::max(largest, magnitude) } else { largest };
            }
        }
        let lost = N::MIN_POSITIVE.as_f64();
        if largest < LARGEST {
            let Bounds { lo, hi } = Bounds::enclosing(aabb).clamped();
            return Self { lo, hi, scale: 1.0 / largest.max(SMALLEST).power_of_two_below(), lost };
        }
        Self { lo: [-f32::MAX; D], hi: [f32::MAX; D], scale: 1.0, lost }
    }

    /// Shrinks the box by `depth` on each side, so that only boxes that overlap it by at least
    /// `depth` along each axis have distance zero. Unchanged if `depth` is not positive.
    pub(super) fn within<N: Real>(mut self, depth: N) -> Self {
        let depth = depth.as_f64();
        if depth > 0.0 {
            self.lo = self.lo.mapped(|lo| f32_below(f64::from(lo) + depth));
            self.hi = self.hi.mapped(|hi| f32_above(f64::from(hi) - depth));
        }
        self
    }

    /// Converts a distance of the caller to an upper bound of its square, in squared units of the
    /// gaps. The result is finite; -1 for a negative or NaN distance.
    #[expect(clippy::cast_possible_truncation, reason = "the slack is more than the rounding")]
    pub(crate) fn limit<N: Real>(&self, distance: N) -> f32 {
        let (distance, scale) = (distance.as_f64(), f64::from(self.scale));
        let is_distance = distance >= 0.0;
        if !is_distance {
            return -1.0;
        }
        let squared = (distance * scale) * (distance * scale) + self.lost * scale * scale;
        let slack = f64::from(SQUARE * f32::EPSILON);
        f32::min((squared + squared * slack) as f32 + f32::MIN_POSITIVE, f32::MAX)
    }

    /// Returns a lower bound of the caller's distance for a key that
    /// [`Kernel::apart`](super::kernel::Kernel::apart) wrote.
    pub(crate) fn distance<N: Real>(&self, key: f32) -> N {
        let (key, scale) = (f64::from(key), f64::from(self.scale));
        let slack = f64::from(2.0 * SQUARE * f32::EPSILON);
        let surely = key - key * slack - self.lost * scale * scale - f64::from(f32::MIN_POSITIVE);
        N::lit(if surely > 0.0 { surely.sqrt() / scale } else { 0.0 })
    }
}

impl Scalar {
    /// Tests one lane after another; see [`Kernel::apart`](super::kernel::Kernel::apart).
    #[inline(always)]
    pub(super) fn apart_from_block<const D: usize>(
        self,
        block: &Block<D>,
        gaps: &Gaps<D>,
        limit: f32,
        keys: &mut [f32; LANES],
    ) -> u32 {
        let larger = |a: f32, b: f32| if a > b { a } else { b };
        let mut mask = 0;
        for (lane, key) in keys.iter_mut().enumerate() {
            let mut squared = 0.0;
            for axis in 0..D {
                let above = block.lo[axis][lane] - gaps.hi[axis];
                let below = gaps.lo[axis] - block.hi[axis][lane];
                let gap = larger(larger(above, below), 0.0) * gaps.scale;
                squared += gap * gap;
            }
            *key = squared;
            mask |= u32::from(squared <= limit) << lane;
        }
        mask
    }

    /// See [`Kernel::least`](super::kernel::Kernel::least).
    #[inline(always)]
    pub(super) fn least_key(self, keys: &[f32; LANES], mask: u32) -> usize {
        let among = (0..LANES).filter(|lane| mask >> lane & 1 == 1);
        among.min_by(|&a, &b| keys[a].total_cmp(&keys[b])).unwrap_or(0)
    }
}

impl<S: Simd> WideBlock<S> {
    /// Tests all lanes at once; see [`Kernel::apart`](super::kernel::Kernel::apart).
    #[inline(always)]
    pub(super) fn apart_from_block<const D: usize>(
        self,
        block: &Block<D>,
        gaps: &Gaps<D>,
        limit: f32,
        keys: &mut [f32; LANES],
    ) -> u32 {
        let simd = self.0;
        let mut squared = f32x16::splat(simd, 0.0);
        for axis in 0..D {
            let above = f32x16::load_array_ref(simd, &block.lo[axis]) - gaps.hi[axis];
            let hi = f32x16::load_array_ref(simd, &block.hi[axis]);
            let below = f32x16::splat(simd, gaps.lo[axis]) - hi;
            let gap = above.max(below).max(0.0) * gaps.scale;
            squared += gap * gap;
        }
        squared.store_slice(keys);
        low_half(squared.simd_le(limit).to_bitmask())
    }

    /// See [`Kernel::least`](super::kernel::Kernel::least).
    #[inline(always)]
    pub(super) fn least_key(self, keys: &[f32; LANES], mask: u32) -> usize {
        let (first, last) = (mask.trailing_zeros() as usize, 31 - mask.leading_zeros() as usize);
        if mask.count_ones() <= 2 {
            // With at most two lanes, selects by index, which needs no unpredictable branch.
            return [first, last][usize::from(keys[last] < keys[first])];
        }
        let simd = self.0;
        let wanted = mask32x16::from_bitmask(simd, u64::from(mask));
        let keys = f32x16::load_array_ref(simd, keys);
        let among = wanted.select(keys, f32x16::splat(simd, f32::INFINITY));
        let least = among.reduce_min();
        (low_half(among.simd_eq(least).to_bitmask()) & mask).trailing_zeros() as usize
    }
}

#[cfg(test)]
mod tests {
    use super::super::kernel::{Kernel, Lanes, with_kernel};
    use super::*;
    use crate::math::{Point, Vector};

    /// Returns a random number: zero, tiny, moderate, or of magnitude up to `largest`. Values
    /// repeat.
    fn number(state: &mut u64, largest: f32) -> f32 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040);
        let small = f32::from(i16::try_from(*state >> 56).expect("eight bits")) - 128.0;
        match *state >> 40 & 7 {
            0 => 0.0,
            1 => small * 0.007_812_5 * largest,
            2 => small * 1e-30,
            3 => small * 1e-42,
            _ => small * 0.125,
        }
    }

    fn proposed(
        lanes: Lanes,
        block: &Block<3>,
        gaps: &Gaps<3>,
        limit: f32,
    ) -> (u32, [u32; LANES], usize) {
        let mut keys = [0.0; LANES];
        with_kernel!(lanes, kernel => {
            let mask = kernel.apart(block, gaps, limit, &mut keys);
            let least = if mask == 0 { LANES } else { kernel.least(&keys, mask) };
            (mask, keys.mapped(f32::to_bits), least)
        })
    }

    #[test]
    fn every_instruction_set_proposes_what_is_near() {
        let (state, mut near) = (&mut 5, 0);
        for round in 0..4000 {
            let largest = [1.0, 1e18, 1e37, f32::MAX][round % 4];
            let mut block = Block::<3>::EMPTY;
            for lane in 0..LANES - 2 {
                let lo = [(); 3].mapped(|()| number(state, largest));
                let hi = lo.mapped(|x| x.max(number(state, largest)));
                block.set_lane(lane, &Bounds { lo, hi });
            }
            let corner = Point::<f32, 3>::from([(); 3].mapped(|()| number(state, largest)));
            let extent = Vector::<f32, 3>::from([(); 3].mapped(|()| number(state, 1.0).abs()));
            let unbounded = if round % 16 == 5 { f32::INFINITY } else { 0.0 };
            let end = corner + extent + Vector::<f32, 3>::new(0.0, unbounded, 0.0);
            let Ok(aabb) = Aabb::try_new(corner, end) else { continue };
            let gaps = Gaps::new(&aabb, largest);
            for limit in [0.0, number(state, largest).abs(), f32::INFINITY] {
                let expected = proposed(Lanes::scalar(), &block, &gaps, gaps.limit(limit));
                for lanes in Lanes::available() {
                    let own = proposed(lanes, &block, &gaps, gaps.limit(limit));
                    assert_eq!(own, expected, "{lanes:?} {aabb:?} {limit}");
                }
                let (mask, keys, least) = expected;
                assert_eq!(mask >> (LANES - 2), 0, "nothing is in empty lanes");
                let is_least = |key: &u32| least == LANES || keys[least] <= *key;
                assert!(keys.iter().all(is_least), "{least} of {keys:?}");
                for (lane, key) in keys.into_iter().enumerate().take(LANES - 2) {
                    let Bounds { lo, hi } = block.lane(lane);
                    let exact = Aabb::new(Point::from(lo), Point::from(hi));
                    let distance = exact.distance_to_aabb(&aabb);
                    let is_near = distance <= limit;
                    assert!(!is_near || mask >> lane & 1 == 1, "{aabb:?} {exact:?}: {distance}");
                    let bound = f32::from_bits(key);
                    assert!(!is_near || bound <= gaps.limit(distance), "a bound of {distance}");
                    let known = gaps.distance::<f32>(bound);
                    assert!(!is_near || known <= distance, "{known} is above {distance}");
                    near += usize::from(is_near);
                }
            }
        }
        assert!(near > 50_000, "{near} boxes were near");
    }

    #[test]
    fn what_is_no_distance_ends_the_search() {
        let gaps = Gaps::new(&Aabb::at(Point::<f64, 2>::new(1e300, 0.0)), 1.0);
        assert_eq!(gaps.limit(f64::NAN), -1.0, "NaN");
        assert_eq!(gaps.limit(-1e-300), -1.0, "negative");
        assert_eq!(
            gaps.limit(f64::INFINITY),
            f32::MAX,
            "finite, so that empty lanes are beyond it"
        );
    }
}
