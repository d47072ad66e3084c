//! What a scan looks for, and what it found.

use crate::checker::chain::{LANES, LaneRow};
use crate::math::lanes::bits;
use crate::math::order::sort_few;
use crate::math::simd::Simd;
use crate::math::{Wide, max, min};

/// What is asked of eight configurations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::checker) enum SearchMode {
    /// Whether there is any pair: what is decided needs no more.
    Any,
    /// All pairs.
    All,
    /// The pairs that may be the nearest.
    Nearest,
}

/// A pair that in a configuration is not certainly farther apart than the limit.
#[derive(Clone, Copy, Debug)]
pub(in crate::checker) struct NearPair {
    pub(in crate::checker) lane: usize,
    pub(in crate::checker) pair: (u32, Other),
    /// It certainly is not farther apart.
    pub(in crate::checker) is_certain: bool,
    /// How far apart it is at least, in the mode [`SearchMode::Nearest`].
    pub(in crate::checker) lower: f32,
}

impl NearPair {
    /// Lanes and pairs in their order.
    #[inline]
    fn key(&self) -> u128 {
        let (body, other) = self.pair;
        let (is_obstacle, number) = match other {
            Other::Body(number) => (0, number),
            Other::Obstacle(number) => (1, number),
        };
        (self.lane as u128) << 96 | u128::from(body) << 64 | is_obstacle << 32 | u128::from(number)
    }

    /// Takes in what other balls say of the same pair.
    #[inline]
    fn merge(&mut self, other: &Self) {
        self.is_certain |= other.is_certain;
        self.lower = min(self.lower, other.lower);
    }
}

/// The second of a pair, whose first is a body of a lower number.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::checker) enum Other {
    Body(u32),
    Obstacle(u32),
}

/// A search in eight configurations.
#[derive(Debug)]
pub(in crate::checker) struct CollisionSearch {
    mode: SearchMode,
    /// The lanes that are looked at.
    live: u8,
    /// The lanes in which numbers are too large for `f32`.
    pub(in crate::checker) blind: u8,
    /// The lanes in which a pair is certainly not farther apart than the limit, in the mode [`SearchMode::Any`].
    pub(in crate::checker) hits: u8,
    /// Farther apart than this with all margins is farther than the limit; nearer than the other is not.
    outer: LaneRow<f32>,
    inner: LaneRow<f32>,
    /// The margin for what slides.
    slack: LaneRow<f32>,
    /// The highest number of `outer`, and how far anything slides.
    pub(super) farthest: f32,
    pub(super) slide: f32,
    /// In order of the lanes and pairs after [`Self::tidy`].
    pub(in crate::checker) near: Vec<NearPair>,
}

/// What is known of the distances of up to eight balls of a group from one thing.
#[derive(Clone, Copy)]
pub(super) struct Distances<V> {
    /// The squares of the distances of the centers from its center, or from its core.
    pub(super) squared: V,
    /// The sums of the radii, and the margin.
    pub(super) radius: V,
    pub(super) margin: f32,
    /// The balls that are asked about, and those of which radius and distance are all.
    pub(super) wanted: u8,
    pub(super) exact: u8,
}

impl CollisionSearch {
    pub(in crate::checker) fn new(mode: SearchMode) -> Self {
        let zero = [0.0; LANES];
        Self {
            mode,
            live: 0,
            blind: 0,
            hits: 0,
            outer: zero,
            inner: zero,
            slack: zero,
            farthest: 0.0,
            slide: 0.0,
            near: Vec::new(),
        }
    }

    /// Begins with new configurations: those of the lanes, and how far things slide in each, with the margin for a unit
    /// of that.
    pub(in crate::checker) fn begin(
        &mut self,
        lanes: u8,
        limit: f32,
        (slides, margin): (&LaneRow<f32>, f32),
    ) {
        (self.live, self.blind, self.hits) = (lanes, 0, 0);
        self.slide = 0.0;
        // The limit itself was rounded. Without one the first is infinite, and the other NaN.
        let rounding = limit * (2.0 * f32::EPSILON);
        for (lane, &slide) in slides.iter().enumerate() {
            self.slack[lane] = slide * margin;
            self.outer[lane] = limit + rounding + self.slack[lane];
            self.inner[lane] = limit - rounding - self.slack[lane];
            self.slide = max(slide, self.slide);
        }
        self.near.clear();
    }

    /// Leaves out the lanes in which numbers are too large; no limit of a lane that is left out counts.
    pub(super) fn leave_out(&mut self, usable: u8) {
        self.blind = self.live & !usable;
        self.live &= usable;
        self.farthest = 0.0;
        for lane in 0..LANES {
            self.outer[lane] = if self.is_live(lane) { self.outer[lane] } else { 0.0 };
            self.farthest = max(self.outer[lane], self.farthest);
        }
    }

    /// A lane is looked at.
    #[inline(always)]
    pub(super) const fn is_live(&self, lane: usize) -> bool {
        self.live >> lane & 1 == 1
    }

    /// All lanes are decided.
    #[inline(always)]
    pub(super) const fn is_done(&self) -> bool {
        self.live == 0
    }

    /// The live lanes in which two things with these radii and distances are not certainly farther apart than the limit:
    /// NaN is not.
    #[inline(always)]
    pub(super) fn near_lanes<S: Simd, V: Wide<S, Scalar = f32>>(
        &self,
        simd: S,
        squared: V,
        radius: f32,
    ) -> u8 {
        let reach = V::all(simd, radius) + V::load(simd, &self.outer);
        !bits(squared.simd_gt(reach * reach)) & self.live
    }

    /// The balls that are near a ball of this radius in a configuration, with the margin in the radius.
    #[inline(always)]
    pub(super) fn near_balls<S: Simd, V: Wide<S, Scalar = f32>>(
        &self,
        simd: S,
        lane: usize,
        squared: V,
        (radii, radius): (V, f32),
    ) -> u8 {
        let reach = radii + V::all(simd, radius + self.outer[lane]);
        !bits(squared.simd_gt(reach * reach))
    }

    /// Keeps the balls that are near in a configuration; `pair_of` has the pair of a ball.
    #[inline(always)]
    pub(super) fn settle<S: Simd, V: Wide<S, Scalar = f32>>(
        &mut self,
        simd: S,
        lane: usize,
        distances: &Distances<V>,
        pair_of: impl Fn(usize) -> (u32, Other),
    ) {
        let radii = (distances.radius, distances.margin);
        let near = self.near_balls(simd, lane, distances.squared, radii) & distances.wanted;
        if near == 0 {
            return;
        }
        let inner = distances.radius + V::all(simd, self.inner[lane] - distances.margin);
        let is_within = distances.squared.simd_lt(inner * inner) & inner.simd_gt(V::all(simd, 0.0));
        let certain = bits(is_within) & near & distances.exact;
        if certain != 0 && self.mode == SearchMode::Any {
            self.hits |= 1 << lane;
            self.live &= !(1 << lane);
            return;
        }
        let lower = self.bounds(simd, lane, distances, near);
        let mut balls = near;
        while balls != 0 {
            let ball = balls.trailing_zeros() as usize;
            balls &= balls - 1;
            let (is_certain, lower) = (certain >> ball & 1 == 1, lower[ball]);
            let found = NearPair { lane, pair: pair_of(ball), is_certain, lower };
            // The balls of one body mostly follow each other.
            match self.near.last_mut() {
                Some(last) if last.key() == found.key() => last.merge(&found),
                _ => self.near.push(found),
            }
        }
    }

    /// How far apart the balls are at least. No pair is wanted that is farther apart than the upper bound of one.
    #[inline(always)]
    fn bounds<S: Simd, V: Wide<S, Scalar = f32>>(
        &mut self,
        simd: S,
        lane: usize,
        distances: &Distances<V>,
        near: u8,
    ) -> LaneRow<f32> {
        let mut bounds = [0.0; LANES];
        if self.mode != SearchMode::Nearest {
            return bounds;
        }
        let slack = self.slack[lane];
        let lower =
            distances.squared.sqrt() - distances.radius - V::all(simd, distances.margin + slack);
        lower.store(&mut bounds);
        let exact = (0..LANES).filter(|ball| (near & distances.exact) >> ball & 1 == 1);
        let upper = exact.fold(f32::INFINITY, |upper, ball| min(bounds[ball], upper));
        // Twice the margin above the lower bound, and once for what slides; no distance is negative.
        let upper = max(upper + 2.0 * (distances.margin + slack), 0.0) + slack;
        self.outer[lane] = min(upper, self.outer[lane]);
        self.farthest = self.outer.iter().fold(0.0, |most, &outer| max(outer, most));
        bounds
    }

    /// Puts what was kept in order, each pair once, without what turned out to be farther than others.
    pub(in crate::checker) fn tidy(&mut self) {
        if self.mode == SearchMode::Nearest {
            let outer = self.outer;
            self.near.retain(|near| near.lower <= outer[near.lane]);
        }
        sort_few(&mut self.near, |one, other| one.key() < other.key());
        self.near.dedup_by(|later, kept| {
            let is_same = later.key() == kept.key();
            if is_same {
                kept.merge(later);
            }
            is_same
        });
    }
}
