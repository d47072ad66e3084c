//! The state of a scan: its mode, its limits, and the candidate pairs.

use crate::checker::chain::{LANES, LaneRow};
use crate::math::lanes::bits;
use crate::math::order::sort_few;
use crate::math::simd::Simd;
use crate::math::{Wide, max, min};

/// The kind of query for 8 configurations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::checker) enum SearchMode {
    /// Whether any pair is within the limit: a lane ends at its first certain pair.
    Any,
    /// Every pair within the limit.
    All,
    /// The pairs that may be the nearest pair of a lane.
    Nearest,
}

/// A pair that is not certainly farther apart than the limit in a configuration.
#[derive(Clone, Copy, Debug)]
pub(in crate::checker) struct CandidatePair {
    pub(in crate::checker) lane: usize,
    pub(in crate::checker) pair: (u32, Other),
    /// Whether the pair certainly is within the limit.
    pub(in crate::checker) is_certain: bool,
    /// A lower bound of the pair's distance, in the mode [`SearchMode::Nearest`].
    pub(in crate::checker) lower: f32,
}

impl CandidatePair {
    /// Returns the sort key: by lane, then by pair.
    #[inline]
    fn key(&self) -> u128 {
        let (body, other) = self.pair;
        let (is_obstacle, number) = match other {
            Other::Body(number) => (0, number),
            Other::Obstacle(number) => (1, number),
        };
        (self.lane as u128) << 96 | u128::from(body) << 64 | is_obstacle << 32 | u128::from(number)
    }

    /// Merges the result of other balls of the same pair into this candidate.
    #[inline]
    fn merge(&mut self, other: &Self) {
        self.is_certain |= other.is_certain;
        self.lower = min(self.lower, other.lower);
    }
}

/// The second of a pair; the first is a body, with a lower index if the second is a body too.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::checker) enum Other {
    Body(u32),
    Obstacle(u32),
}

/// A search in 8 configurations.
#[derive(Debug)]
pub(in crate::checker) struct CollisionSearch {
    mode: SearchMode,
    /// A bit mask of the lanes that are not decided yet.
    live: u8,
    /// A bit mask of the lanes in which numbers are too large for `f32`.
    pub(in crate::checker) blind: u8,
    /// A bit mask of the lanes in which a pair is certainly within the limit, in the mode
    /// [`SearchMode::Any`].
    pub(in crate::checker) hits: u8,
    /// A pair farther apart than `outer`, beyond all margins, exceeds the limit; a pair nearer than
    /// `inner` is within it.
    outer: LaneRow<f32>,
    inner: LaneRow<f32>,
    /// The margin for slides, in each lane.
    slack: LaneRow<f32>,
    /// The largest value of `outer`, and the largest slide.
    pub(super) farthest: f32,
    pub(super) slide: f32,
    /// The candidate pairs, sorted by lane and pair after [`Self::tidy`].
    pub(in crate::checker) candidates: Vec<CandidatePair>,
}

/// The distances of up to 8 balls of a group from one ball or obstacle.
#[derive(Clone, Copy)]
pub(super) struct Distances<V> {
    /// The squared distances of the balls' centres from the centre of the ball, or from the
    /// obstacle's core.
    pub(super) squared: V,
    /// The sums of the radii, and the margin.
    pub(super) radius: V,
    pub(super) margin: f32,
    /// Bit masks of the balls to be tested, and of those whose distance is exact.
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
            candidates: Vec::new(),
        }
    }

    /// Starts a search in new configurations. `lanes` is their bit mask; `slides` is the total
    /// slide of each lane, and `margin` the margin per unit of slide.
    pub(in crate::checker) fn begin(
        &mut self,
        lanes: u8,
        limit: f32,
        (slides, margin): (&LaneRow<f32>, f32),
    ) {
        (self.live, self.blind, self.hits) = (lanes, 0, 0);
        self.slide = 0.0;
        // The rounding error of the limit itself. If the limit is infinite, `outer` is infinite and
        // `inner` NaN.
        let rounding = limit * (2.0 * f32::EPSILON);
        for (lane, &slide) in slides.iter().enumerate() {
            self.slack[lane] = slide * margin;
            self.outer[lane] = limit + rounding + self.slack[lane];
            self.inner[lane] = limit - rounding - self.slack[lane];
            self.slide = max(slide, self.slide);
        }
        self.candidates.clear();
    }

    /// Excludes the lanes outside `usable`, whose numbers are too large, and resets their limits.
    pub(super) fn leave_out(&mut self, usable: u8) {
        self.blind = self.live & !usable;
        self.live &= usable;
        self.farthest = 0.0;
        for lane in 0..LANES {
            self.outer[lane] = if self.is_live(lane) { self.outer[lane] } else { 0.0 };
            self.farthest = max(self.outer[lane], self.farthest);
        }
    }

    /// Whether a lane is not decided yet.
    #[inline(always)]
    pub(super) const fn is_live(&self, lane: usize) -> bool {
        self.live >> lane & 1 == 1
    }

    /// Whether all lanes are decided.
    #[inline(always)]
    pub(super) const fn is_done(&self) -> bool {
        self.live == 0
    }

    /// Returns the live lanes in which two balls or cores are not certainly farther apart than the
    /// limit. NaN distances are included.
    #[inline(always)]
    pub(super) fn candidate_lanes<S: Simd, V: Wide<S, Scalar = f32>>(
        &self,
        simd: S,
        squared: V,
        radius: f32,
    ) -> u8 {
        let max_distance = V::all(simd, radius) + V::load(simd, &self.outer);
        !bits(squared.simd_gt(max_distance * max_distance)) & self.live
    }

    /// Returns a bit mask of the balls that are not certainly beyond the limit in a configuration;
    /// `radius` includes the margin.
    #[inline(always)]
    pub(super) fn candidate_balls<S: Simd, V: Wide<S, Scalar = f32>>(
        &self,
        simd: S,
        lane: usize,
        squared: V,
        (radii, radius): (V, f32),
    ) -> u8 {
        let max_distance = radii + V::all(simd, radius + self.outer[lane]);
        !bits(squared.simd_gt(max_distance * max_distance))
    }

    /// Records the candidate balls of a configuration; `pair_of(ball)` returns the pair of a ball.
    #[inline(always)]
    pub(super) fn record<S: Simd, V: Wide<S, Scalar = f32>>(
        &mut self,
        simd: S,
        lane: usize,
        distances: &Distances<V>,
        pair_of: impl Fn(usize) -> (u32, Other),
    ) {
        let radii = (distances.radius, distances.margin);
        let mask = self.candidate_balls(simd, lane, distances.squared, radii) & distances.wanted;
        if mask == 0 {
            return;
        }
        let inner = distances.radius + V::all(simd, self.inner[lane] - distances.margin);
        let is_within = distances.squared.simd_lt(inner * inner) & inner.simd_gt(V::all(simd, 0.0));
        let certain = bits(is_within) & mask & distances.exact;
        if certain != 0 && self.mode == SearchMode::Any {
            self.hits |= 1 << lane;
            self.live &= !(1 << lane);
            return;
        }
        let lower = self.bounds(simd, lane, distances, mask);
        let mut balls = mask;
        while balls != 0 {
            let ball = balls.trailing_zeros() as usize;
            balls &= balls - 1;
            let (is_certain, lower) = (certain >> ball & 1 == 1, lower[ball]);
            let found = CandidatePair { lane, pair: pair_of(ball), is_certain, lower };
            // Balls of one body mostly follow each other, so it suffices to compare with the last
            // candidate.
            match self.candidates.last_mut() {
                Some(last) if last.key() == found.key() => last.merge(&found),
                _ => self.candidates.push(found),
            }
        }
    }

    /// Returns lower bounds of the distances. Also lowers `outer` to the smallest upper bound: no
    /// pair beyond it can be the nearest.
    #[inline(always)]
    fn bounds<S: Simd, V: Wide<S, Scalar = f32>>(
        &mut self,
        simd: S,
        lane: usize,
        distances: &Distances<V>,
        mask: u8,
    ) -> LaneRow<f32> {
        let mut bounds = [0.0; LANES];
        if self.mode != SearchMode::Nearest {
            return bounds;
        }
        let slack = self.slack[lane];
        let lower =
            distances.squared.sqrt() - distances.radius - V::all(simd, distances.margin + slack);
        lower.store(&mut bounds);
        let exact = (0..LANES).filter(|ball| (mask & distances.exact) >> ball & 1 == 1);
        let upper = exact.fold(f32::INFINITY, |upper, ball| min(bounds[ball], upper));
        // Twice the margin above the lower bound, and once for slides; no distance is negative.
        let upper = max(upper + 2.0 * (distances.margin + slack), 0.0) + slack;
        self.outer[lane] = min(upper, self.outer[lane]);
        self.farthest = self.outer.iter().fold(0.0, |most, &outer| max(outer, most));
        bounds
    }

    /// Sorts the candidates, merges duplicates, and drops those beyond the final limit.
    pub(in crate::checker) fn tidy(&mut self) {
        if self.mode == SearchMode::Nearest {
            let outer = self.outer;
            self.candidates.retain(|candidate| candidate.lower <= outer[candidate.lane]);
        }
        sort_few(&mut self.candidates, |one, other| one.key() < other.key());
        self.candidates.dedup_by(|later, kept| {
            let is_same = later.key() == kept.key();
            if is_same {
                kept.merge(later);
            }
            is_same
        });
    }
}
