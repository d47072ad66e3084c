//! The state of a scan: the mode, the limits of each lane, and the candidate pairs found so far.

use crate::checker::chain::{LANES, LaneRow};
use crate::math::lanes::bits;
use crate::math::order::sort_few;
use crate::math::simd::Simd;
use crate::math::{Wide, max, min};

/// The kind of query for 8 configurations.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::checker) enum SearchMode {
    /// Whether any pair is within the limit. The search in a lane ends at the first pair that is
    /// certainly within it.
    Any,
    /// All pairs within the limit.
    All,
    /// The pairs that may be the nearest pair of a lane.
    Nearest,
}

/// A pair that, in the configuration of a lane, is not certainly farther apart than the limit.
#[derive(Clone, Copy, Debug)]
pub(in crate::checker) struct CandidatePair {
    pub(in crate::checker) lane: usize,
    pub(in crate::checker) pair: (u32, Other),
    /// Whether the pair is certainly within the limit.
    pub(in crate::checker) is_certain: bool,
    /// A lower bound of the pair's distance in the mode [`SearchMode::Nearest`]; zero in other
    /// modes.
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

    /// Merges a candidate from other balls of the same pair into this candidate.
    #[inline]
    fn merge(&mut self, other: &Self) {
        self.is_certain |= other.is_certain;
        self.lower = min(self.lower, other.lower);
    }
}

/// The second member of a pair. The first member is a body; if both are bodies, the first has the
/// lower index.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(in crate::checker) enum Other {
    Body(u32),
    Obstacle(u32),
}

/// A search for pairs in 8 configurations, one per lane.
#[derive(Debug)]
pub(in crate::checker) struct CollisionSearch {
    mode: SearchMode,
    /// A bit mask of the lanes that are not decided yet.
    live: u8,
    /// A bit mask of the lanes that the scan cannot evaluate because numbers are too large for
    /// `f32` or not finite.
    pub(in crate::checker) blind: u8,
    /// A bit mask of the lanes in which a pair is certainly within the limit, in the mode
    /// [`SearchMode::Any`].
    pub(in crate::checker) hits: u8,
    /// A pair is certainly beyond the limit of its lane if its distance minus its margin exceeds
    /// `outer`, and certainly within the limit if its distance plus its margin is less than
    /// `inner`.
    outer: LaneRow<f32>,
    inner: LaneRow<f32>,
    /// The error margin for slides in each lane, which `outer` and `inner` include.
    slack: LaneRow<f32>,
    /// The greatest value of `outer`. `slide` is the greatest total slide of a lane.
    pub(super) farthest: f32,
    pub(super) slide: f32,
    /// The candidate pairs, sorted by lane and pair after [`Self::tidy`].
    pub(in crate::checker) candidates: Vec<CandidatePair>,
}

/// The distances of up to 8 balls of a group from one ball or obstacle.
#[derive(Clone, Copy)]
pub(super) struct Distances<V> {
    /// The squared distances of the balls' centres from the centre of the other ball, or from the
    /// core of the obstacle.
    pub(super) squared: V,
    /// The sums of the two radii of each pair. `margin` is the error margin of the pairs.
    pub(super) radius: V,
    pub(super) margin: f32,
    /// A bit mask of the balls to test. `exact` is a bit mask of the balls whose computed distance
    /// equals the distance of the bodies.
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

    /// Starts a search in the configurations of the lanes in the bit mask `lanes`. `slides` has the
    /// total slide of each lane, and `margin` is the error margin per unit of slide.
    pub(in crate::checker) fn begin(
        &mut self,
        lanes: u8,
        limit: f32,
        (slides, margin): (&LaneRow<f32>, f32),
    ) {
        (self.live, self.blind, self.hits) = (lanes, 0, 0);
        self.slide = 0.0;
        // A bound of the rounding error of the limit. If the limit is infinite, `outer` is infinite
        // and `inner` is NaN.
        let rounding = limit * (2.0 * f32::EPSILON);
        for (lane, &slide) in slides.iter().enumerate() {
            self.slack[lane] = slide * margin;
            self.outer[lane] = limit + rounding + self.slack[lane];
            self.inner[lane] = limit - rounding - self.slack[lane];
            self.slide = max(slide, self.slide);
        }
        self.candidates.clear();
    }

    /// Marks the lanes outside the bit mask `usable` as blind, and sets their `outer` limit to
    /// zero.
    pub(super) fn leave_out(&mut self, usable: u8) {
        self.blind = self.live & !usable;
        self.live &= usable;
        self.farthest = 0.0;
        for lane in 0..LANES {
            self.outer[lane] = if self.is_live(lane) { self.outer[lane] } else { 0.0 };
            self.farthest = max(self.outer[lane], self.farthest);
        }
    }

    /// Returns whether a lane is not decided yet.
    #[inline(always)]
    pub(super) const fn is_live(&self, lane: usize) -> bool {
        self.live >> lane & 1 == 1
    }

    /// Returns whether all lanes are decided.
    #[inline(always)]
    pub(super) const fn is_done(&self) -> bool {
        self.live == 0
    }

    /// Returns a bit mask of the live lanes in which a bounding ball is not certainly beyond the
    /// limit. `squared` has the squared distances of its centre from the centre of another ball or
    /// from the core of an obstacle. `radius` is the sum of both radii and the margins. NaN counts
    /// as near.
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

    /// Returns a bit mask of the balls that are not certainly beyond the limit of lane `lane`. The
    /// sum of the two radii of each pair is `radii` plus `radius`, which includes the margins. NaN
    /// counts as near.
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

    /// Records the pairs of the balls that are not certainly beyond the limit of lane `lane`.
    /// `pair_of` converts the index of a ball to its pair.
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
            // The balls of one body are usually consecutive, so only the last candidate is
            // compared. `tidy` merges the others.
            match self.candidates.last_mut() {
                Some(last) if last.key() == found.key() => last.merge(&found),
                _ => self.candidates.push(found),
            }
        }
    }

    /// Returns lower bounds of the distances; zeros unless the mode is [`SearchMode::Nearest`].
    /// Also lowers `outer` to the smallest upper bound of an exact distance, since no pair beyond
    /// it can be the nearest pair.
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
        // The upper bound is the lower bound plus twice the error margin, or zero if that is
        // negative. The last term is the margin for slides, which `outer` includes. Beside an
        // unbounded ball the margin is infinite, and the distances of the group give no bound.
        if distances.margin.is_finite() {
            let upper = max(upper + 2.0 * (distances.margin + slack), 0.0) + slack;
            self.outer[lane] = min(upper, self.outer[lane]);
        }
        self.farthest = self.outer.iter().fold(0.0, |most, &outer| max(outer, most));
        bounds
    }

    /// Drops the candidates beyond the final limit, sorts the others by lane and pair, and merges
    /// candidates of the same pair.
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
