//! A moving box for slab tests against blocks, in `f32`. Rounding errors only enlarge the result.

use super::kernel::{IOTA, Scalar, WideBlock, low_half};
use super::{Block, LANES};
use crate::bounding_volume::Aabb;
use crate::math::{Mapped, Real, Vector, filled, max_component};
use fearless_simd::{Bytes, Select, Simd, SimdBase, SimdMask, f32x16, u32x16};

/// Least speed on an axis, as a fraction of the fastest component's power of two. Raising a slower
/// component to this speed displaces the box, while it passes a tree, by less than the padding.
const SLOWEST: f32 = f32::from_bits(27 << 23);

/// Padding of the moving box, in `f32` rounding units of the largest coordinate.
const PADDING: f32 = 5.0;

/// Error bound of quotients, in `f32` rounding units.
const QUOTIENT: f32 = 8.0;

/// Returns the smaller of `x` and `limit`; NaN if `x` is NaN.
#[inline(always)]
fn at_most(x: f32, limit: f32) -> f32 {
    if x > limit { limit } else { x }
}

/// Returns the larger of `x` and `limit`; NaN if `x` is NaN.
#[inline(always)]
fn at_least(x: f32, limit: f32) -> f32 {
    if x < limit { limit } else { x }
}

/// A moving box, prepared for slab tests. A ray is a box of a single point.
///
/// The velocity is divided by a power of two, so that its largest component is between 1 and 2 and
/// quotients stay in range at any scale. Times are multiplied by that power of two.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slabs<const D: usize> {
    /// By axis: the face of the moving box that meets other boxes first, and the opposite face.
    front: [f32; D],
    back: [f32; D],
    /// Reciprocal of the velocity, never zero and never infinite.
    inverse: [f32; D],
    /// The power of two by which the velocity is divided.
    unit: f64,
}

impl<const D: usize> Slabs<D> {
    /// Converts the box `moving` with a finite velocity, for trees with coordinates of magnitude up
    /// to `size`.
    #[inline(always)]
    pub(crate) fn new<N: Real>(moving: &Aabb<N, D>, velocity: &Vector<N, D>, size: f32) -> Self {
        let speed = max_component(velocity);
        // Division by a power of two changes exponents alone.
        let unit = if speed > N::ZERO { speed.power_of_two_below() } else { N::ONE };
        let direction = velocity.map(|x| (x / unit).as_f32());
        // The largest finite magnitude of a coordinate of the tree or the box.
        let mut largest = size;
        for axis in 0..D {
            for face in [moving.mins()[axis], moving.maxs()[axis]] {
                let face = face.as_f32().abs();
                largest = if face > largest && face < f32::INFINITY { face } else { largest };
            }
        }
        let pad = PADDING * f32::EPSILON * largest + f32::MIN_POSITIVE;
        // Both cases are computed and then selected, since the sign of a direction is
        // unpredictable.
        let low = filled(|axis| at_most(moving.mins()[axis].as_f32(), f32::MAX) - pad);
        let high = filled(|axis| at_least(moving.maxs()[axis].as_f32(), -f32::MAX) + pad);
        let inverse = filled(|axis| 1.0 / f32::max(direction[axis].abs(), SLOWEST));
        let chosen = |back: [f32; D], on: [f32; D]| {
            filled(|axis| if direction[axis] < 0.0 { back[axis] } else { on[axis] })
        };
        Self {
            front: chosen(low, high),
            back: chosen(high, low),
            inverse: chosen(inverse.mapped(|x: f32| -x), inverse),
            unit: unit.as_f64(),
        }
    }

    /// Converts a time of the caller to an upper bound in the units of the slabs; -1 for a negative
    /// or NaN time.
    #[expect(clippy::cast_possible_truncation, reason = "the slack is more than the rounding")]
    pub(crate) fn limit<N: Real>(&self, time: N) -> f32 {
        let scaled = time.as_f64() * self.unit;
        let is_time = scaled >= 0.0;
        let slack = f64::from(QUOTIENT * f32::EPSILON);
        if is_time { (scaled + scaled * slack) as f32 + f32::MIN_POSITIVE } else { -1.0 }
    }

    /// Returns a lower bound of the caller's time for a key that
    /// [`Kernel::enter`](super::kernel::Kernel::enter) wrote.
    pub(crate) fn time<N: Real>(&self, key: f32) -> N {
        let slack = f64::from(2.0 * QUOTIENT * f32::EPSILON);
        let exact = f64::from(key) / self.unit;
        N::lit(exact - exact * slack)
    }

    /// Returns, by lane, the faces that the moving box meets first on an axis, and the opposite
    /// faces.
    #[inline(always)]
    fn faces<'a>(&self, block: &'a Block<D>, axis: usize) -> [&'a [f32; LANES]; 2] {
        let (lo, hi) = (&block.lo[axis], &block.hi[axis]);
        if self.inverse[axis] < 0.0 { [hi, lo] } else { [lo, hi] }
    }
}

/// Factor that enlarges exit times, since entry and exit times are rounded.
const STRETCH: f32 = 1.0 + QUOTIENT * f32::EPSILON;

impl Scalar {
    /// Tests one lane after another; see [`Kernel::enter`](super::kernel::Kernel::enter).
    #[inline(always)]
    pub(super) fn enter_block<const D: usize>(
        self,
        block: &Block<D>,
        slabs: &Slabs<D>,
        limit: f32,
        keys: &mut [f32; LANES],
    ) -> u32 {
        let mut mask = 0;
        for (lane, key) in keys.iter_mut().enumerate() {
            let (mut enter, mut leave) = (0.0_f32, limit);
            for axis in 0..D {
                let [near, far] = slabs.faces(block, axis).map(|faces| faces[lane]);
                let first = (near - slabs.front[axis]) * slabs.inverse[axis];
                let last = (far - slabs.back[axis]) * slabs.inverse[axis] * STRETCH;
                enter = if first > enter { first } else { enter };
                leave = if last < leave { last } else { leave };
            }
            *key = enter;
            mask |= u32::from(enter <= leave) << lane;
        }
        mask
    }
}

impl<S: Simd> WideBlock<S> {
    /// Tests all lanes at once; see [`Kernel::enter`](super::kernel::Kernel::enter).
    #[inline(always)]
    pub(super) fn enter_block<const D: usize>(
        self,
        block: &Block<D>,
        slabs: &Slabs<D>,
        limit: f32,
        keys: &mut [f32; LANES],
    ) -> u32 {
        let (enter, leave) = self.times(block, slabs, limit);
        enter.store_slice(keys);
        low_half(enter.simd_le(leave).to_bitmask())
    }

    /// Tests all lanes at once; see
    /// [`Kernel::enter_nearest`](super::kernel::Kernel::enter_nearest).
    #[inline(always)]
    pub(super) fn enter_block_nearest<const D: usize>(
        self,
        block: &Block<D>,
        slabs: &Slabs<D>,
        limit: f32,
        keys: &mut [u32; LANES],
    ) -> (u32, u32) {
        let simd = self.0;
        let (enter, leave) = self.times(block, slabs, limit);
        let is_entered = enter.simd_le(leave);
        let lanes = u32x16::load_array_ref(simd, &IOTA);
        // The lowest four bits of each time are replaced by the lane index, so that one minimum
        // gives the nearest lane. Times are not negative, so their bits are in the order of the
        // times.
        let with_lane = enter.bitcast::<u32x16<S>>() & u32x16::splat(simd, !15) | lanes;
        let all = is_entered.select(with_lane, u32x16::splat(simd, u32::MAX));
        all.store_slice(keys);
        (low_half(is_entered.to_bitmask()), all.reduce_min())
    }

    /// Returns, by lane, the time at which the moving box enters the lane's box, at least zero, and
    /// the time at which it leaves, at most `limit`. A lane is missed if its entry time is above
    /// its exit time.
    #[inline(always)]
    fn times<const D: usize>(
        self,
        block: &Block<D>,
        slabs: &Slabs<D>,
        limit: f32,
    ) -> (f32x16<S>, f32x16<S>) {
        let simd = self.0;
        let mut enter = f32x16::splat(simd, 0.0);
        let mut leave = f32x16::splat(simd, limit);
        for axis in 0..D {
            let [near, far] = slabs.faces(block, axis);
            let inverse = slabs.inverse[axis];
            let first = (f32x16::load_array_ref(simd, near) - slabs.front[axis]) * inverse;
            let last = (f32x16::load_array_ref(simd, far) - slabs.back[axis]) * inverse * STRETCH;
            enter = first.max(enter);
            leave = last.min(leave);
        }
        (enter, leave)
    }
}

#[cfg(test)]
mod tests {
    use super::super::Bounds;
    use super::super::kernel::{Kernel, Lanes, with_kernel, with_widest_kernel};
    use super::*;
    use crate::math::Point;

    /// Returns a random number: zero, tiny, huge or moderate. Values repeat.
    fn number(state: &mut u64) -> f32 {
        *state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040);
        let small = f32::from(i16::try_from(*state >> 56).expect("eight bits")) - 128.0;
        match *state >> 40 & 7 {
            0 => 0.0,
            1 => small * 1e30,
            2 => small * 1e-30,
            _ => small * 0.125,
        }
    }

    /// Asserts that all instruction sets find the same lanes and keys, and that keys are no later
    /// than the times of entry.
    fn check_nearest(
        block: &Block<3>,
        slabs: &Slabs<3>,
        limit: f32,
        (expected, keys): (u32, &[f32; LANES]),
    ) {
        let nearest = |lanes: Lanes| {
            let mut keys = [0; LANES];
            let limit = slabs.limit(limit);
            let found = with_kernel!(lanes, kernel => {
                kernel.enter_nearest(block, slabs, limit, &mut keys)
            });
            let mut widest = [0; LANES];
            let again = with_widest_kernel!(lanes, kernel => {
                kernel.enter_nearest(block, slabs, limit, &mut widest)
            });
            assert_eq!((again, widest), (found, keys), "{lanes:?}");
            (found, keys)
        };
        let ((mask, least), lane_keys) = nearest(Lanes::scalar());
        assert_eq!(mask, expected, "the same lanes are entered");
        assert_eq!(lane_keys.iter().min(), Some(&least), "the least is the first");
        for (lane, key) in (0..).zip(lane_keys).filter(|&(_, key)| key != u32::MAX) {
            assert!(key & 15 == lane && f32::from_bits(key - lane) <= keys[lane as usize]);
        }
        for lanes in Lanes::available() {
            assert_eq!(nearest(lanes), ((mask, least), lane_keys), "{lanes:?}");
        }
    }

    #[test]
    fn every_instruction_set_proposes_what_is_hit() {
        let (state, mut hits, mut proposed) = (&mut 3, 0, 0);
        for _ in 0..4000 {
            let mut block = Block::<3>::EMPTY;
            for lane in 0..LANES - 2 {
                let lo = [(); 3].map(|()| number(state));
                let hi = lo.map(|x| x + number(state).abs());
                block.set_lane(lane, &Bounds { lo, hi });
            }
            let origin = Point::<f32, 3>::new(number(state), number(state), number(state));
            let dir = Vector::<f32, 3>::new(number(state), number(state), number(state));
            let moving = Aabb::at(origin);
            let slabs = Slabs::new(&moving, &dir, 4e32);
            let tight = Slabs::new(&moving, &dir, 0.0);
            let limit = number(state).abs();
            let test = |lanes: Lanes, slabs: &Slabs<3>| {
                let mut keys = [0.0; LANES];
                let limit = slabs.limit(limit);
                (with_kernel!(lanes, kernel => kernel.enter(&block, slabs, limit, &mut keys)), keys)
            };
            let (expected, keys) = test(Lanes::scalar(), &tight);
            for lanes in Lanes::available() {
                let (mask, own) = test(lanes, &tight);
                assert_eq!(mask, expected, "{lanes:?} {origin} {dir} {block:?}");
                for lane in (0..LANES).filter(|lane| mask >> lane & 1 == 1) {
                    assert_eq!(own[lane], keys[lane], "{lanes:?}, lane {lane}");
                }
            }
            check_nearest(&block, &tight, limit, (expected, &keys));
            let (padded, keys) = test(Lanes::scalar(), &slabs);
            assert_eq!(padded & expected, expected, "padding takes nothing away");
            assert_eq!(expected >> (LANES - 2), 0, "nothing is in empty lanes");
            for (lane, &key) in keys.iter().enumerate().take(LANES - 2) {
                let Bounds { lo, hi } = block.lane(lane);
                let exact = Aabb::new(Point::from(lo), Point::from(hi));
                let hit = exact.sweep_interval(&moving, &dir).filter(|&(enter, _)| enter <= limit);
                if let Some((enter, _)) = hit {
                    assert!(padded >> lane & 1 == 1, "{origin} {dir} {exact:?}");
                    assert!(key <= slabs.limit(enter), "a bound of the time");
                    assert!(slabs.time::<f32>(key) <= enter, "as the caller counts");
                    hits += 1;
                }
            }
            proposed += expected.count_ones();
        }
        assert!(hits > 500 && proposed < hits * 3, "{hits} hits, {proposed} proposals");
    }
}
