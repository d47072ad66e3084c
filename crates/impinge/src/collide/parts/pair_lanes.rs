//! Tests 8 pairs of parts at a time: which are certainly farther apart than a limit, and which
//! certainly are not.
//!
//! The test uses separating axes (Gottschalk, Lin and Manocha, "`OBBTree`", 1996). Two parts
//! overlap iff none of these axes separates them: for triangles in 3D, the two normals and the nine
//! cross products of a side of each; for coplanar triangles, the in-plane normals of the six sides;
//! for segments and triangles in 2D, the normals of all sides. If they overlap, the shortest
//! separating translation is along one of these axes. An axis may have any length `l`: gaps are
//! compared with `limit * l` instead of being divided.
//!
//! ```text
//! axis                          lanes             stops when all are beyond
//!  between means of corners      limit > 0         yes
//!  2 normals                     all               yes
//!  9 cross products of sides     all
//!  6 in-plane normals of sides   coplanar pairs
//! ```

use super::slabs::rounding_unit;
use crate::collide::packet::{LANES, PartPacket};
use crate::math::lanes::{bits, cross, dot, in_lanes, load, minus, plus};
use crate::math::simd::{Level, Run, Simd};
use crate::math::{Real, Wide};

/// Smallest sine of the angle between two sides at which the direction perpendicular to both counts
/// as exact; otherwise the pair never counts as within.
const MIN_SINE: f64 = 1.0 / 64.0;
/// Margin, in units of the rounding error, by which gaps must be below the limit to count as
/// within.
const CERTAIN: f64 = 4.0;

/// Up to 8 pairs of parts; the corners of both parts of a pair are in one frame.
pub(crate) struct PartPairs<N, const D: usize> {
    pub(crate) ones: PartPacket<N, D>,
    pub(crate) others: PartPacket<N, D>,
    /// Number of pairs; lanes from `count` on are ignored.
    pub(crate) count: usize,
    /// Smallest length that scales the rounding error; a larger coordinate of a corner replaces it.
    pub(crate) scale: N,
}

/// Results for 8 pairs, one bit each. If the test of a pair is undecided, neither bit is set.
#[derive(Clone, Copy, Default)]
pub(crate) struct PairMasks {
    /// Pairs certainly farther apart than the limit, which is compared with the signed distance
    /// (negative for an overlap).
    pub(crate) beyond: u8,
    /// Pairs certainly not farther apart than the limit. Only valid for a limit of zero or less,
    /// because the gaps along these axes may be smaller than a positive distance.
    pub(crate) within: u8,
}

impl<N: Real, const D: usize> PartPairs<N, D> {
    /// Returns an empty batch; `scale` is a lower bound of the length that scales the rounding
    /// error.
    pub(crate) fn new(scale: N) -> Self {
        Self { ones: PartPacket::blank(), others: PartPacket::blank(), count: 0, scale }
    }
}

/// Tests pairs of triangles or segments in 2D; sets no `within` bit.
pub(crate) fn part_pairs2<N: Real>(pairs: &PartPairs<N, 2>, limit: N) -> PairMasks {
    masks(
        pairs.count,
        |run| in_lanes!(run, simd => in_lanes_2d::<_, N, N::Lanes<_>>(simd, pairs, limit)),
    )
}

/// Tests pairs of triangles in 3D.
pub(crate) fn part_pairs3<N: Real>(pairs: &PartPairs<N, 3>, limit: N) -> PairMasks {
    masks(
        pairs.count,
        |run| in_lanes!(run, simd => in_lanes_3d::<_, N, N::Lanes<_>>(simd, pairs, limit)),
    )
}

/// Tests the lanes that hold pairs, one SIMD run (all 8 lanes, or one lane without SIMD) after
/// another, and merges the bits.
#[inline(always)]
fn masks(count: usize, of_run: impl Fn(Run) -> PairMasks) -> PairMasks {
    let mut all = PairMasks::default();
    for run in Level::new().runs(count.min(LANES)) {
        let found = of_run(run);
        all.beyond |= run.of_bits(found.beyond);
        all.within |= run.of_bits(found.within);
    }
    all
}

/// Tests the axes in 2D: the perpendiculars of all sides of both parts.
#[inline(always)]
fn in_lanes_2d<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    pairs: &PartPairs<N, 2>,
    limit: N,
) -> PairMasks {
    let mut held = HeldPairs::<S, V, 2>::new(simd, pairs, limit);
    for side in sides(&held.one).iter().chain(&sides(&held.other)) {
        held.along(&[-side[1], side[0]]);
    }
    held.masks(false)
}

/// Tests the axes in 3D, in the order of the table at the head of this file.
#[inline(always)]
fn in_lanes_3d<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    pairs: &PartPairs<N, 3>,
    limit: N,
) -> PairMasks {
    let mut held = HeldPairs::<S, V, 3>::new(simd, pairs, limit);
    let (own, others) = (sides(&held.one), sides(&held.other));
    let [normal, other_normal] = [cross(&own[0], &own[1]), cross(&others[0], &others[1])];
    if limit > N::ZERO {
        // The other axes seldom separate distant coplanar pairs, so the line through the means of
        // the corners is tested first.
        held.between_middles();
        if bits(held.beyond) == u8::MAX {
            return held.masks(false);
        }
    }
    held.along(&normal);
    held.along(&other_normal);
    if bits(held.beyond) == u8::MAX {
        return held.masks(false);
    }
    let (squares, other_squares) = (squares_of(&own), squares_of(&others));
    held.require_width(&normal, squares[0] * squares[1]);
    held.require_width(&other_normal, other_squares[0] * other_squares[1]);
    let across = cross(&normal, &other_normal);
    let both = dot(&normal, &normal) * dot(&other_normal, &other_normal);
    let is_askew = held.is_wide(&across, both);
    for (side, squared) in own.iter().zip(squares) {
        for (other, other_squared) in others.iter().zip(other_squares) {
            let along = cross(side, other);
            held.along(&along);
            held.require_width(&along, squared * other_squared);
        }
    }
    held.unsure |= !is_askew;
    if bits(is_askew | held.beyond) != u8::MAX {
        let (beyond, within) = (held.beyond, held.within);
        for (sides, normal) in [(&own, &normal), (&others, &other_normal)] {
            for side in sides {
                held.along(&cross(side, normal));
            }
        }
        // The extra axes count for coplanar pairs only, so that no lane's result depends on other
        // lanes.
        held.beyond = beyond | (held.beyond & !is_askew);
        held.within = within;
    }
    held.masks(true)
}

/// Eight pairs, relative to the first corner of their first part, and the results so far.
struct HeldPairs<S: Simd, V: Wide<S>, const D: usize> {
    simd: S,
    one: [[V; D]; 3],
    other: [[V; D]; 3],
    /// Thresholds for a gap along a unit axis. A gap above the first, which is the limit plus the
    /// rounding error, proves that the pair is beyond. Gaps up to the second, which is the limit
    /// minus [`CERTAIN`] times the rounding error, count as within.
    limits: [V; 2],
    is_precise: V::Mask,
    beyond: V::Mask,
    /// Pairs that no axis tested so far separates by more than the limit, with the margin
    /// [`CERTAIN`].
    within: V::Mask,
    /// Pairs for which the direction of some axis was not exact.
    unsure: V::Mask,
}

impl<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize> HeldPairs<S, V, D> {
    /// Loads the pairs and translates them to the first corner of the first part. The rounding
    /// error is computed from the coordinates before this translation.
    #[inline(always)]
    fn new(simd: S, pairs: &PartPairs<N, D>, limit: N) -> Self {
        let [a, b, c] = &pairs.ones.corners;
        let one = [load(simd, a), load(simd, b), load(simd, c)];
        let [a, b, c] = &pairs.others.corners;
        let other: [[V; D]; 3] = [load(simd, a), load(simd, b), load(simd, c)];
        let mut size = V::all(simd, pairs.scale);
        for value in one.as_flattened().iter().chain(other.as_flattened()) {
            size = value.abs().larger(size);
        }
        let slack = size * V::all(simd, rounding_unit());
        // Subnormal lengths have a large relative rounding error.
        let least = N::MIN_POSITIVE / N::EPSILON * rounding_unit::<N>();
        let is_precise = slack.simd_gt(V::all(simd, least));
        let limit = V::all(simd, limit);
        let limits = [limit + slack, limit - slack * V::all(simd, N::lit(CERTAIN))];
        let none = slack.simd_lt(slack);
        let [a, b, c] = &other;
        let origin = one[0];
        let other = [minus(a, &origin), minus(b, &origin), minus(c, &origin)];
        let [a, b, c] = &one;
        let one = [minus(a, &origin), minus(b, &origin), minus(c, &origin)];
        Self { simd, one, other, limits, is_precise, beyond: none, within: !none, unsure: none }
    }

    /// Tests an axis, which may have any length, and updates `beyond` and `within`.
    #[inline(always)]
    fn along(&mut self, along: &[V; D]) {
        let squared = dot(along, along);
        let length = squared.sqrt();
        let ([low, high], [other_low, other_high]) =
            (extent(&self.one, along), extent(&self.other, along));
        let gap = (other_low - high).larger(low - other_high);
        let is_length = squared.simd_gt(V::all(self.simd, N::MIN_POSITIVE / N::EPSILON))
            & squared.simd_lt(V::all(self.simd, N::INFINITY));
        self.beyond |= gap.simd_gt(self.limits[0] * length) & is_length;
        // False for a NaN gap, so that the pair does not count as within.
        self.within &= gap.simd_le(self.limits[1] * length);
    }

    /// Tests the line through the means of the corners of both parts (an end of a segment that
    /// occurs twice counts twice). Updates `beyond` only, because this axis cannot prove an
    /// overlap.
    #[inline(always)]
    fn between_middles(&mut self) {
        let ([a, b, c], [d, e, f]) = (&self.one, &self.other);
        let within = self.within;
        self.along(&minus(&plus(&plus(d, e), f), &plus(&plus(a, b), c)));
        self.within = within;
    }

    /// Returns the lanes where the direction of `along`, the cross product of two vectors, is
    /// exact: the sine of the angle between these vectors is above [`MIN_SINE`]. `squares` is the
    /// product of the squared lengths of the two vectors.
    #[inline(always)]
    fn is_wide(&self, along: &[V; D], squares: V) -> V::Mask {
        let least = N::lit(MIN_SINE * MIN_SINE);
        dot(along, along).simd_gt(squares * V::all(self.simd, least))
    }

    /// Marks the pairs as unsure in the lanes that [`Self::is_wide`] does not select.
    #[inline(always)]
    fn require_width(&mut self, along: &[V; D], squares: V) {
        self.unsure |= !self.is_wide(along, squares);
    }

    /// Returns the results. No bit is set for pairs whose lengths are too small to be precise. A
    /// `within` bit is set only if the pair is not beyond, all directions were exact, and all axes
    /// were tested (`has_all`).
    #[inline(always)]
    fn masks(&self, has_all: bool) -> PairMasks {
        let beyond = bits(self.beyond & self.is_precise);
        let within = bits(self.within & !self.unsure & self.is_precise & !self.beyond);
        PairMasks { beyond, within: if has_all { within } else { 0 } }
    }
}

/// Returns the vectors from each corner to the next, and from the last to the first.
#[inline(always)]
fn sides<S: Simd, V: Wide<S>, const D: usize>([a, b, c]: &[[V; D]; 3]) -> [[V; D]; 3] {
    [minus(b, a), minus(c, b), minus(a, c)]
}

#[inline(always)]
fn squares_of<S: Simd, V: Wide<S>, const D: usize>([a, b, c]: &[[V; D]; 3]) -> [V; 3] {
    [dot(a, a), dot(b, b), dot(c, c)]
}

/// Returns the smallest and the largest dot product of the corners with `along`.
#[inline(always)]
fn extent<S: Simd, V: Wide<S>, const D: usize>([a, b, c]: &[[V; D]; 3], along: &[V; D]) -> [V; 2] {
    let (a, b, c) = (dot(a, along), dot(b, along), dot(c, along));
    [a.smaller(b).smaller(c), a.larger(b).larger(c)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collide::Pair;
    use crate::collide::separation::separation_3d;
    use crate::math::xorshift::Xorshift;
    use crate::math::{Mapped, Point, Pose, Vector};
    use crate::shape::{Geometry, Shape, Triangle};

    type Corners<N> = [Point<N, 3>; 3];

    /// Returns the distance computed by [`separation_3d`] without a limit.
    fn distance<N: Real>(one: &Corners<N>, other: &Corners<N>) -> N {
        let [one, other] = [one, other].mapped(|[a, b, c]| Triangle::new(*a, *b, *c));
        let [first, second]: [Geometry<'_, N, 3>; 2] = [one.geometry(), other.geometry()];
        let pair = Pair { first: first.0, second: second.0, pose12: Pose::identity() };
        separation_3d(&pair, N::INFINITY).expect("there is no limit").distance
    }

    /// Asserts that no bit contradicts [`distance`], and that over 90 % of the pairs are decided
    /// unless all triangles are coplanar.
    fn check<N: Real>(scale: f64, flat: f64) {
        let (mut random, mut known, mut all) = (Xorshift(7), 0, 0);
        for round in 0..200 {
            let (mut pairs, mut placed) = (PartPairs::<N, 3>::new(N::ZERO), Vec::new());
            for lane in 0..LANES {
                let mut corner = || {
                    let at = random.vector::<f64>(scale);
                    Point::from(Vector::<N, 3>::new(
                        N::lit(at.x),
                        N::lit(at.y),
                        N::lit(at.z * flat),
                    ))
                };
                let (one, other) = ([corner(), corner(), corner()], [corner(), corner(), corner()]);
                pairs.ones.put(lane, &one);
                pairs.others.put(lane, &other);
                placed.push((one, other));
            }
            pairs.count = LANES;
            let limit = N::lit(scale * [0.0, 0.1, -0.02][round % 3]);
            let PairMasks { beyond, within } = part_pairs3(&pairs, limit);
            assert_eq!(beyond & within, 0, "not both");
            for (lane, (one, other)) in placed.iter().enumerate() {
                let distance = distance(one, other);
                let [is_beyond, is_within] = [beyond, within].mapped(|bits| bits >> lane & 1 == 1);
                assert!(!is_beyond || distance > limit, "beyond: {distance} and {limit}");
                // The gap along an axis may be less than the distance of triangles that are apart.
                assert!(
                    !is_within || distance <= limit || limit > N::ZERO,
                    "within: {distance} and {limit}"
                );
                known += u32::from(is_beyond || is_within);
                all += 1;
            }
        }
        assert!(known * 10 > all * 9 || flat == 0.0, "{known} of {all} are known");
    }

    #[test]
    fn masks_are_true() {
        check::<f64>(1.0, 1.0);
        check::<f32>(1.0, 1.0);
        check::<f64>(1e6, 0.1);
        check::<f64>(1e-6, 1.0);
        check::<f64>(1.0, 0.0);
    }
}
