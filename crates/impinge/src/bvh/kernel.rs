//! The elementary operations on blocks, scalar and with SIMD vectors.
//!
//! [`Scalar`] defines the results; [`WideBlock`] computes the same bits with SIMD vectors of the
//! machine. The operations of the join are comparisons, minima and maxima, which do not round.
//! `with_kernel!` selects the kernel once for a batch, and compiles its body for every instruction
//! set.

use crate::math::filled;
use fearless_simd::{Simd, SimdBase, SimdMask, f32x16, mask32x16, u32x16};

use super::gaps::Gaps;
use super::slabs::Slabs;
use super::triangles::{ShearedLine, Triangles};
use super::{Block, Bounds, LANES};
use crate::math::simd::{Level, ON_ARRAYS};

/// The SIMD instruction set that the kernels use. It does not affect results.
#[derive(Clone, Copy, Debug)]
pub struct Lanes(pub(super) Level);

impl Lanes {
    /// Detects the widest instruction set of this machine.
    #[must_use]
    pub fn detect() -> Self {
        Self(Level::new())
    }

    /// Returns the AVX-512 token if AVX-512 is the widest instruction set of the machine; else
    /// `None`.
    #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"))]
    pub(super) fn avx512(self) -> Option<fearless_simd::Avx512> {
        let is_best = matches!(self.0, Level::Wide(_));
        is_best.then(|| fearless_simd::Level::new().as_avx512()).flatten()
    }

    /// Returns the scalar kernels, which define the results of the others.
    #[cfg(test)]
    pub(crate) const fn scalar() -> Self {
        Self(Level::Arrays)
    }

    /// Returns the instruction sets that this machine has and for which kernels are compiled. Tests
    /// compare the results of all.
    #[must_use]
    pub fn available() -> Vec<Self> {
        let is_compiled = |level: &Level| ON_ARRAYS || !matches!(level, Level::Arrays);
        Level::available().into_iter().filter(is_compiled).map(Self).collect()
    }
}

impl Default for Lanes {
    fn default() -> Self {
        Self::detect()
    }
}

/// Runs `$body` with `$kernel` bound to the kernel of `$lanes`.
macro_rules! with_kernel {
    ($lanes:expr, $kernel:ident => $body:expr) => {
        match $lanes.0 {
            $crate::math::simd::Level::Wide(vectors) => {
                $crate::math::lanes::with_vectors!(vectors, simd => {
                    let $kernel = $crate::bvh::kernel::WideBlock(simd);
                    $body
                })
            }
            #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"))]
            $crate::math::simd::Level::Sse2(simd) => $crate::math::lanes::vectorized!(simd, {
                let $kernel = $crate::bvh::kernel::WideBlock(simd);
                $body
            }),
            $crate::math::simd::Level::Arrays if $crate::math::simd::ON_ARRAYS => {
                let $kernel = $crate::bvh::kernel::Scalar;
                $body
            }
            $crate::math::simd::Level::Arrays => unreachable!("this target has vectors"),
        }
    };
}
/// Runs `$body` as `with_kernel!` does, but with AVX-512 where the machine has it. Worthwhile for
/// code that gains from mask registers and 512-bit vectors.
macro_rules! with_widest_kernel {
    ($lanes:expr, $kernel:ident => $body:expr) => {{
        #[cfg(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2"))]
        match $lanes.avx512() {
            Some(simd) => $crate::math::lanes::vectorized!(simd, {
                let $kernel = $crate::bvh::kernel::WideBlock(simd);
                $body
            }),
            None => $crate::bvh::kernel::with_kernel!($lanes, $kernel => $body),
        }
        #[cfg(not(all(any(target_arch = "x86", target_arch = "x86_64"), target_feature = "sse2")))]
        $crate::bvh::kernel::with_kernel!($lanes, $kernel => $body)
    }};
}
pub(super) use {with_kernel, with_widest_kernel};

/// A list of pairs of `u32`, in two arrays, so that sixteen pairs can be stored at once.
///
/// Elements at indices from `len` on are meaningless.
#[derive(Clone, Debug, Default)]
pub(super) struct TaskList {
    first: Vec<u32>,
    second: Vec<u32>,
    len: usize,
    /// The greatest length at a call of `clear` since the last call of `give_back`.
    longest: usize,
}

impl TaskList {
    pub(super) fn clear(&mut self) {
        self.longest = self.longest.max(self.len);
        self.len = 0;
    }

    /// Clears the list. Shrinks the arrays if they have more than 2048 elements and are more than
    /// four times as long as the longest list since the last call.
    pub(super) fn give_back(&mut self) {
        self.clear();
        let needed = (2 * self.longest).max(64 * LANES);
        if self.first.len() / 2 > needed {
            for list in [&mut self.first, &mut self.second] {
                list.truncate(needed);
                list.shrink_to_fit();
            }
        }
        self.longest = 0;
    }

    pub(super) fn len(&self) -> usize {
        self.len
    }

    /// Returns the pairs as two arrays.
    #[inline]
    pub(super) fn parts(&self) -> [&[u32]; 2] {
        [&self.first[..self.len], &self.second[..self.len]]
    }

    /// Returns a range of the pairs as two arrays.
    #[inline]
    pub(super) fn part(&self, range: core::ops::Range<usize>) -> [&[u32]; 2] {
        let [first, second] = self.parts();
        [&first[range.clone()], &second[range]]
    }

    /// Grows the arrays so that sixteen more pairs can be written after `len`.
    #[inline]
    fn reserve(&mut self) {
        if self.len + LANES > self.first.len() {
            let length = (2 * self.first.len()).max(64 * LANES);
            self.first.resize(length, 0);
            self.second.resize(length, 0);
        }
    }

    #[inline]
    pub(super) fn push(&mut self, first: u32, second: u32) {
        self.reserve();
        self.first[self.len] = first;
        self.second[self.len] = second;
        self.len += 1;
    }

    /// Appends all pairs of another list.
    #[cfg(feature = "parallel")]
    pub(super) fn append(&mut self, other: &Self) {
        self.first.truncate(self.len);
        self.second.truncate(self.len);
        let [first, second] = other.parts();
        self.first.extend_from_slice(first);
        self.second.extend_from_slice(second);
        self.len = self.first.len();
    }
}

/// The operations on blocks. Masks have lane 0 in the lowest bit.
pub(super) trait Kernel: Copy {
    /// Returns the lanes of the block that overlap the query.
    fn overlaps<const D: usize>(self, block: &Block<D>, query: &Bounds<D>) -> u32;

    /// Returns the smallest box around all lanes.
    fn bounds<const D: usize>(self, block: &Block<D>) -> Bounds<D>;

    /// Returns the lanes that the moving box may enter between time 0 and `limit`, and writes lower
    /// bounds of the entry times to `keys`. The mask contains every lane that the box does enter.
    fn enter<const D: usize>(
        self,
        block: &Block<D>,
        slabs: &Slabs<D>,
        limit: f32,
        keys: &mut [f32; LANES],
    ) -> u32;

    /// Returns the mask of [`Self::enter`] and the least key, and writes all keys to `keys`. The
    /// lowest four bits of a key are the lane index, and the other bits are those of the time,
    /// rounded down. The key of a lane that is not entered is `u32::MAX`.
    fn enter_nearest<const D: usize>(
        self,
        block: &Block<D>,
        slabs: &Slabs<D>,
        limit: f32,
        keys: &mut [u32; LANES],
    ) -> (u32, u32);

    /// Returns the least of sixteen keys of [`Self::enter_nearest`].
    fn least_lane_key(self, keys: &[u32; LANES]) -> u32;

    /// Returns the lanes whose squared distance may be at most `limit`, and writes the squares to
    /// `keys`, in squared units of the gaps. Keys have rounding errors ([`Gaps::distance`] allows
    /// for them). If [`Gaps::limit`] converted a distance to `limit`, the mask contains every lane
    /// within that distance. A finite limit excludes empty lanes.
    fn apart<const D: usize>(
        self,
        block: &Block<D>,
        gaps: &Gaps<D>,
        limit: f32,
        keys: &mut [f32; LANES],
    ) -> u32;

    /// Returns the lane in `mask` with the least key; the lowest lane if several keys are equal.
    /// The mask must not be empty, and the keys of its lanes must be finite.
    fn least(self, keys: &[f32; LANES], mask: u32) -> usize;

    /// Returns the triangles that the line may cross between times zero and `limit`. The mask
    /// contains every triangle that an exact test may accept.
    fn crossed(self, triangles: &Triangles, line: &ShearedLine, limit: f32) -> u32;

    /// Appends `(first, base + lane)` for every lane of the mask, in ascending order.
    fn push(self, list: &mut TaskList, first: u32, base: u32, mask: u32);
}

/// Reference implementation, one lane after another.
#[derive(Clone, Copy, Debug)]
pub(super) struct Scalar;

impl Kernel for Scalar {
    fn overlaps<const D: usize>(self, block: &Block<D>, query: &Bounds<D>) -> u32 {
        (0..LANES).fold(0, |mask, lane| mask | u32::from(block.lane(lane).overlaps(query)) << lane)
    }

    fn bounds<const D: usize>(self, block: &Block<D>) -> Bounds<D> {
        (0..LANES).fold(Bounds::EMPTY, |all, lane| all.merged(&block.lane(lane)))
    }

    fn enter<const D: usize>(
        self,
        block: &Block<D>,
        slabs: &Slabs<D>,
        limit: f32,
        keys: &mut [f32; LANES],
    ) -> u32 {
        self.enter_block(block, slabs, limit, keys)
    }

    fn enter_nearest<const D: usize>(
        self,
        block: &Block<D>,
        slabs: &Slabs<D>,
        limit: f32,
        keys: &mut [u32; LANES],
    ) -> (u32, u32) {
        let mut times = [0.0; LANES];
        let mask = self.enter_block(block, slabs, limit, &mut times);
        for (lane, key) in (0..).zip(keys.iter_mut()) {
            let is_entered = mask >> lane & 1 == 1;
            *key = if is_entered { times[lane as usize].to_bits() & !15 | lane } else { u32::MAX };
        }
        (mask, self.least_lane_key(keys))
    }

    fn least_lane_key(self, keys: &[u32; LANES]) -> u32 {
        keys.iter().fold(u32::MAX, |least, &key| least.min(key))
    }

    fn apart<const D: usize>(
        self,
        block: &Block<D>,
        gaps: &Gaps<D>,
        limit: f32,
        keys: &mut [f32; LANES],
    ) -> u32 {
        self.apart_from_block(block, gaps, limit, keys)
    }

    fn least(self, keys: &[f32; LANES], mask: u32) -> usize {
        self.least_key(keys, mask)
    }

    fn crossed(self, triangles: &Triangles, line: &ShearedLine, limit: f32) -> u32 {
        self.crossed_triangles(triangles, line, limit)
    }

    fn push(self, list: &mut TaskList, first: u32, base: u32, mask: u32) {
        push_bits(list, first, base, mask);
    }
}

/// Appends the lanes of the mask one by one: without AVX2, faster than packing a vector.
#[inline(always)]
fn push_bits(list: &mut TaskList, first: u32, base: u32, mut mask: u32) {
    while mask != 0 {
        list.push(first, base + mask.trailing_zeros());
        mask &= mask - 1;
    }
}

/// Kernel on vectors of sixteen lanes, in one to four registers.
#[derive(Clone, Copy, Debug)]
pub(super) struct WideBlock<S>(pub(super) S);

/// The indices of the lanes.
pub(super) const IOTA: [u32; LANES] = [0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15];

impl<S: Simd> Kernel for WideBlock<S> {
    #[inline(always)]
    fn overlaps<const D: usize>(self, block: &Block<D>, query: &Bounds<D>) -> u32 {
        let mut mask = overlaps_on(self.0, block, query, 0);
        for axis in 1..D {
            mask &= overlaps_on(self.0, block, query, axis);
        }
        low_half(mask.to_bitmask())
    }

    #[inline(always)]
    fn bounds<const D: usize>(self, block: &Block<D>) -> Bounds<D> {
        let simd = self.0;
        Bounds {
            lo: filled(
                #[inline(always)]
                |axis| f32x16::load_array_ref(simd, &block.lo[axis]).reduce_min(),
            ),
            hi: filled(
                #[inline(always)]
                |axis| f32x16::load_array_ref(simd, &block.hi[axis]).reduce_max(),
            ),
        }
    }

    #[inline(always)]
    fn enter<const D: usize>(
        self,
        block: &Block<D>,
        slabs: &Slabs<D>,
        limit: f32,
        keys: &mut [f32; LANES],
    ) -> u32 {
        self.enter_block(block, slabs, limit, keys)
    }

    #[inline(always)]
    fn enter_nearest<const D: usize>(
        self,
        block: &Block<D>,
        slabs: &Slabs<D>,
        limit: f32,
        keys: &mut [u32; LANES],
    ) -> (u32, u32) {
        self.enter_block_nearest(block, slabs, limit, keys)
    }

    #[inline(always)]
    fn least_lane_key(self, keys: &[u32; LANES]) -> u32 {
        u32x16::load_array_ref(self.0, keys).reduce_min()
    }

    #[inline(always)]
    fn apart<const D: usize>(
        self,
        block: &Block<D>,
        gaps: &Gaps<D>,
        limit: f32,
        keys: &mut [f32; LANES],
    ) -> u32 {
        self.apart_from_block(block, gaps, limit, keys)
    }

    #[inline(always)]
    fn least(self, keys: &[f32; LANES], mask: u32) -> usize {
        self.least_key(keys, mask)
    }

    #[inline(always)]
    fn crossed(self, triangles: &Triangles, line: &ShearedLine, limit: f32) -> u32 {
        self.crossed_triangles(triangles, line, limit)
    }

    #[inline(always)]
    fn push(self, list: &mut TaskList, first: u32, base: u32, mask: u32) {
        if !packs_lanes(self.0.level()) {
            return push_bits(list, first, base, mask);
        }
        let simd = self.0;
        list.reserve();
        let end = list.len + LANES;
        u32x16::splat(simd, first).store_slice(&mut list.first[list.len..end]);
        let lanes = u32x16::load_array_ref(simd, &IOTA) + u32x16::splat(simd, base);
        let selected = SimdMask::from_bitmask(simd, u64::from(mask));
        lanes.compress(selected).store_slice(&mut list.second[list.len..end]);
        list.len += mask.count_ones() as usize;
    }
}

/// Returns the lanes whose intervals on axis `axis` overlap the interval of the query.
#[inline(always)]
fn overlaps_on<S: Simd, const D: usize>(
    simd: S,
    block: &Block<D>,
    query: &Bounds<D>,
    axis: usize,
) -> mask32x16<S> {
    let lo = f32x16::load_array_ref(simd, &block.lo[axis]);
    let hi = f32x16::load_array_ref(simd, &block.hi[axis]);
    lo.simd_le(f32x16::splat(simd, query.hi[axis]))
        & hi.simd_ge(f32x16::splat(simd, query.lo[axis]))
}

/// Returns `true` if the instruction set packs selected lanes fast.
#[inline(always)]
fn packs_lanes(level: fearless_simd::Level) -> bool {
    #[cfg(any(target_arch = "x86", target_arch = "x86_64"))]
    return level.as_avx2().is_some();
    #[cfg(not(any(target_arch = "x86", target_arch = "x86_64")))]
    {
        let _ = level;
        false
    }
}

/// Returns the lower 32 bits of a mask; a mask of sixteen lanes has no others.
#[inline(always)]
#[expect(clippy::cast_possible_truncation, reason = "sixteen lanes make sixteen bits")]
pub(super) const fn low_half(mask: u64) -> u32 {
    mask as u32
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns a block of small boxes on a grid, so that touching is common, with some lanes empty.
    fn block(seed: u64) -> Block<3> {
        let mut state = seed;
        let mut next = move || {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(99);
            u8::try_from(state >> 60).expect("four bits")
        };
        let mut block = Block::EMPTY;
        for lane in 0..LANES {
            let lo = [(); 3].map(|()| f32::from(next()));
            let hi = lo.map(|x| x + f32::from(next()) + 4.0);
            if next() > 2 {
                block.set_lane(lane, &Bounds { lo, hi });
            }
        }
        block
    }

    fn results(lanes: Lanes, block: &Block<3>, query: &Bounds<3>) -> (u32, Bounds<3>, Vec<u32>) {
        with_kernel!(lanes, kernel => {
            let mask = kernel.overlaps(block, query);
            let mut list = TaskList::default();
            kernel.push(&mut list, 7, 100, mask);
            kernel.push(&mut list, 8, 200, mask >> 3);
            let [first, second] = list.parts();
            (mask, kernel.bounds(block), [first, second].concat())
        })
    }

    #[test]
    fn every_instruction_set_agrees_with_the_definition() {
        let (mut hits, mut tests) = (0, 0);
        for seed in 0..500 {
            let (block, query) = (block(seed), block(seed + 10_000).lane(3));
            let expected = results(Lanes::scalar(), &block, &query);
            for lanes in Lanes::available() {
                assert_eq!(results(lanes, &block, &query), expected, "{lanes:?}, seed {seed}");
            }
            hits += expected.0.count_ones();
            tests += 16;
        }
        assert!((tests * 3 / 10..tests * 7 / 10).contains(&hits), "{hits} of {tests} tests hit");
    }

    #[test]
    fn every_mask_is_pushed_in_order() {
        for lanes in Lanes::available() {
            for mask in 0..1_u32 << 16 {
                let mut list = TaskList::default();
                with_kernel!(lanes, kernel => kernel.push(&mut list, 1, 32, mask));
                let expected = (0..16).filter(|lane| mask >> lane & 1 == 1).map(|lane| lane + 32);
                assert!(list.parts()[1].iter().copied().eq(expected), "{lanes:?}, {mask:b}");
            }
        }
    }
}
