//! Eight pairs of parts at a time: which are certainly farther apart than a limit, and which certainly are not.
//!
//! Two triangles in space overlap iff neither normal and no direction perpendicular to a side of each parts them, or,
//! where they lie in one plane, no direction across a side within it; two convex shapes in the plane, iff no direction
//! across a side does (Gottschalk, Lin and Manocha, "`OBBTree`", 1996). If they do, the one of these along which they
//! overlap least is the shortest way out. The directions here are of any length: no gap is divided.

use super::slabs::rounding_unit;
use crate::collide::packet::{LANES, PartPacket};
use crate::math::lanes::{bits, cross, dot, in_lanes, load, minus, plus};
use crate::math::simd::{Level, Run, Simd};
use crate::math::{Real, Wide};

/// Directions across sides whose sine is less are not exact: such pairs are not called near.
const MIN_SINE: f64 = 1.0 / 64.0;
/// Pairs are called near where they are within the limit by so many times what rounding does.
const CERTAIN: f64 = 4.0;

/// Eight pairs of parts, both of each in the same frame.
pub(crate) struct PartPairs<N, const D: usize> {
    pub(crate) ones: PartPacket<N, D>,
    pub(crate) others: PartPacket<N, D>,
    /// How many pairs there are.
    pub(crate) count: usize,
    /// A length that the rounding of the corners is in proportion to, unless they are larger.
    pub(crate) place: N,
}

/// What is certain of each of eight pairs, by bits.
#[derive(Clone, Copy, Default)]
pub(crate) struct PairVerdicts {
    /// They are farther apart than the limit; overlaps count as negative.
    pub(crate) beyond: u8,
    /// They are not, given a limit of zero or less: beyond it the directions here may leave less than the distance.
    pub(crate) within: u8,
}

impl<N: Real, const D: usize> PartPairs<N, D> {
    pub(crate) fn new(place: N) -> Self {
        Self { ones: PartPacket::blank(), others: PartPacket::blank(), count: 0, place }
    }
}

/// The verdicts of pairs in the plane, of which none is called near.
pub(crate) fn part_pairs2<N: Real>(pairs: &PartPairs<N, 2>, limit: N) -> PairVerdicts {
    verdicts(
        pairs.count,
        |run| in_lanes!(run, simd => in_plane::<_, N, N::Lanes<_>>(simd, pairs, limit)),
    )
}

/// The verdicts of pairs in space.
pub(crate) fn part_pairs3<N: Real>(pairs: &PartPairs<N, 3>, limit: N) -> PairVerdicts {
    verdicts(
        pairs.count,
        |run| in_lanes!(run, simd => in_space::<_, N, N::Lanes<_>>(simd, pairs, limit)),
    )
}

#[inline(always)]
fn verdicts(count: usize, of_run: impl Fn(Run) -> PairVerdicts) -> PairVerdicts {
    let mut all = PairVerdicts::default();
    for run in Level::new().runs(count.min(LANES)) {
        let found = of_run(run);
        all.beyond |= run.of_bits(found.beyond);
        all.within |= run.of_bits(found.within);
    }
    all
}

#[inline(always)]
fn in_plane<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    pairs: &PartPairs<N, 2>,
    limit: N,
) -> PairVerdicts {
    let mut held = HeldPairs::<S, V, 2>::new(simd, pairs, limit);
    for side in sides(&held.one).iter().chain(&sides(&held.other)) {
        held.along(&[-side[1], side[0]]);
    }
    held.verdicts(false)
}

#[inline(always)]
fn in_space<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    pairs: &PartPairs<N, 3>,
    limit: N,
) -> PairVerdicts {
    let mut held = HeldPairs::<S, V, 3>::new(simd, pairs, limit);
    let (own, others) = (sides(&held.one), sides(&held.other));
    let [normal, other_normal] = [cross(&own[0], &own[1]), cross(&others[0], &others[1])];
    if limit > N::ZERO {
        // Far pairs beside each other, which the directions that decide about an overlap hardly part.
        held.between_middles();
        if bits(held.beyond) == u8::MAX {
            return held.verdicts(false);
        }
    }
    held.along(&normal);
    held.along(&other_normal);
    if bits(held.beyond) == u8::MAX {
        return held.verdicts(false);
    }
    let (squares, other_squares) = (squares_of(&own), squares_of(&others));
    held.ask_width(&normal, squares[0] * squares[1]);
    held.ask_width(&other_normal, other_squares[0] * other_squares[1]);
    let across = cross(&normal, &other_normal);
    let both = dot(&normal, &normal) * dot(&other_normal, &other_normal);
    let is_askew = held.is_wide(&across, both);
    for (side, squared) in own.iter().zip(squares) {
        for (other, other_squared) in others.iter().zip(other_squares) {
            let along = cross(side, other);
            held.along(&along);
            held.ask_width(&along, squared * other_squared);
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
        // For those in one plane alone, so that lanes do not depend on each other.
        held.beyond = beyond | (held.beyond & !is_askew);
        held.within = within;
    }
    held.verdicts(true)
}

/// Eight pairs, seen from the first corner of the first of each, and what is known so far.
struct HeldPairs<S: Simd, V: Wide<S>, const D: usize> {
    simd: S,
    one: [[V; D]; 3],
    other: [[V; D]; 3],
    /// The limit, more and less by what rounding does.
    limits: [V; 2],
    is_precise: V::Mask,
    beyond: V::Mask,
    /// Nothing shows yet that they may be beyond the limit.
    within: V::Mask,
    /// A direction is not exact.
    unsure: V::Mask,
}

impl<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize> HeldPairs<S, V, D> {
    #[inline(always)]
    fn new(simd: S, pairs: &PartPairs<N, D>, limit: N) -> Self {
        let [a, b, c] = &pairs.ones.corners;
        let one = [load(simd, a), load(simd, b), load(simd, c)];
        let [a, b, c] = &pairs.others.corners;
        let other: [[V; D]; 3] = [load(simd, a), load(simd, b), load(simd, c)];
        let mut size = V::all(simd, pairs.place);
        for value in one.as_flattened().iter().chain(other.as_flattened()) {
            size = value.abs().larger(size);
        }
        let slack = size * V::all(simd, rounding_unit());
        // Lengths that are subnormal numbers are not precise.
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

    /// Takes the gap along a direction into account.
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
        // Also false for NaN.
        self.within &= gap.simd_le(self.limits[1] * length);
    }

    /// Takes the gap along the way from the middle of one to that of the other into account, which tells nothing about an
    /// overlap.
    #[inline(always)]
    fn between_middles(&mut self) {
        let ([a, b, c], [d, e, f]) = (&self.one, &self.other);
        let within = self.within;
        self.along(&minus(&plus(&plus(d, e), f), &plus(&plus(a, b), c)));
        self.within = within;
    }

    /// A direction across two vectors with this product of squares is exact.
    #[inline(always)]
    fn is_wide(&self, along: &[V; D], squares: V) -> V::Mask {
        let least = N::lit(MIN_SINE * MIN_SINE);
        dot(along, along).simd_gt(squares * V::all(self.simd, least))
    }

    #[inline(always)]
    fn ask_width(&mut self, along: &[V; D], squares: V) {
        self.unsure |= !self.is_wide(along, squares);
    }

    #[inline(always)]
    fn verdicts(&self, has_all: bool) -> PairVerdicts {
        let beyond = bits(self.beyond & self.is_precise);
        let within = bits(self.within & !self.unsure & self.is_precise & !self.beyond);
        PairVerdicts { beyond, within: if has_all { within } else { 0 } }
    }
}

#[inline(always)]
fn sides<S: Simd, V: Wide<S>, const D: usize>([a, b, c]: &[[V; D]; 3]) -> [[V; D]; 3] {
    [minus(b, a), minus(c, b), minus(a, c)]
}

#[inline(always)]
fn squares_of<S: Simd, V: Wide<S>, const D: usize>([a, b, c]: &[[V; D]; 3]) -> [V; 3] {
    [dot(a, a), dot(b, b), dot(c, c)]
}

/// How low and how high corners lie along a direction.
#[inline(always)]
fn extent<S: Simd, V: Wide<S>, const D: usize>([a, b, c]: &[[V; D]; 3], along: &[V; D]) -> [V; 2] {
    let (a, b, c) = (dot(a, along), dot(b, along), dot(c, along));
    [a.smaller(b).smaller(c), a.larger(b).larger(c)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collide::Pair;
    use crate::collide::separation::separation_in_space;
    use crate::math::noise::Noise;
    use crate::math::{Mapped, Point, Pose, Vector};
    use crate::shape::{Geometry, Shape, Triangle};

    type Corners<N> = [Point<N, 3>; 3];

    /// What [`separation_in_space`] says, of which no limit is asked.
    fn distance<N: Real>(one: &Corners<N>, other: &Corners<N>) -> N {
        let [one, other] = [one, other].mapped(|[a, b, c]| Triangle::new(*a, *b, *c));
        let [first, second]: [Geometry<'_, N, 3>; 2] = [one.geometry(), other.geometry()];
        let pair = Pair { first: first.0, second: second.0, pose12: Pose::identity() };
        separation_in_space(&pair, N::INFINITY).expect("there is no limit").distance
    }

    /// Verdicts are true, and there are few pairs without one.
    fn check<N: Real>(scale: f64, flat: f64) {
        let (mut noise, mut known, mut all) = (Noise(7), 0, 0);
        for round in 0..200 {
            let (mut pairs, mut placed) = (PartPairs::<N, 3>::new(N::ZERO), Vec::new());
            for lane in 0..LANES {
                let mut corner = || {
                    let at = noise.vector::<f64>(scale);
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
            let PairVerdicts { beyond, within } = part_pairs3(&pairs, limit);
            assert_eq!(beyond & within, 0, "not both");
            for (lane, (one, other)) in placed.iter().enumerate() {
                let distance = distance(one, other);
                let [is_beyond, is_within] = [beyond, within].mapped(|bits| bits >> lane & 1 == 1);
                assert!(!is_beyond || distance > limit, "beyond: {distance} and {limit}");
                // Along the axes the gap of triangles that are apart may be less than their distance.
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
    fn verdicts_are_true() {
        check::<f64>(1.0, 1.0);
        check::<f32>(1.0, 1.0);
        check::<f64>(1e6, 0.1);
        check::<f64>(1e-6, 1.0);
        check::<f64>(1.0, 0.0);
    }
}
