//! Segments and capsules of the plane: the facets of `facet.rs` and what two of them share, as
//! `overlap.rs` has it, in lanes.

use super::gather::Inputs;
use super::nearest::{END_OR_SIDE, farther};
use super::outlines::{Outline, Plane, separation};
use super::vectors::{bits, dot, either, lit, minus, negated, norm, plus, rounding_of, times};
use super::{Form, Found, PairQuestion};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide};
use crate::shape::FeatureId;

/// Segments and capsules whose cores are apart and which share one point.
pub(super) struct Segments2;

impl<N: Real> Form<N, 2> for Segments2 {
    #[inline(always)]
    fn gather(inputs: &mut Inputs<N, 2>, lane: usize, pair: &PairQuestion<'_, N, 2>) -> bool {
        inputs.put_cores(lane, pair)
    }

    #[inline(always)]
    fn find<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        inputs: &Inputs<N, 2>,
        found: &mut Found<N, 2>,
    ) {
        let pose12 = inputs.pose12::<S, V>(simd);
        let ends1 = [inputs.end::<S, V>(simd, (0, 0)), inputs.end::<S, V>(simd, (0, 1))];
        let local2 = [inputs.end::<S, V>(simd, (1, 0)), inputs.end::<S, V>(simd, (1, 1))];
        let radii = [inputs.radius::<S, V>(simd, 0), inputs.radius::<S, V>(simd, 1)];
        let prediction = inputs.prediction::<S, V>(simd);
        let (outline1, is_long1) = Outline::of(simd, ends1);
        let (outline2, is_long2) = Outline::of(simd, local2);
        let outline2 = Outline {
            ends: [pose12.point(&local2[0]), pose12.point(&local2[1])],
            normals: [pose12.vector(&outline2.normals[0]), pose12.vector(&outline2.normals[1])],
        };
        let apart = separation(simd, [&outline1, &outline2], (radii[0] + radii[1], prediction));
        let ((reach1, is_usual1), (reach2, is_usual2)) =
            (farther(simd, &ends1), farther(simd, &local2));
        let size = (reach1 + radii[0]) + (reach2 + radii[1]) + pose12.apart();
        let normal = apart.axis.normal;
        let frame = Frame {
            normal,
            tangent: negated(&[-normal[1], normal[0]]),
            point1: plus(&apart.points[0], &times(&normal, radii[0])),
            distance: apart.axis.gap - radii[0] - radii[1],
            tolerance: rounding_of::<S, N, V>(simd, size),
            prediction,
            sine: inputs.sine(simd),
        };
        let facets = [
            facet(simd, &frame, (&outline1.ends, radii[0]), true),
            facet(simd, &frame, (&outline2.ends, radii[1]), false),
        ];
        let shared = shared(simd, &frame, &facets);
        for (place, part) in shared.parts.iter().enumerate() {
            found.parts[place] = bits(*part);
        }
        let is_known = apart.is_known & is_long1 & is_long2;
        let is_apart = is_known & frame.distance.simd_gt(prediction);
        let is_fit = is_known & is_usual1 & is_usual2 & shared.is_one;
        let is_beyond = bits(apart.is_beyond & is_long1 & is_long2);
        found.put(simd, inputs, (frame.distance, is_fit | is_apart), [&normal, &shared.point1]);
        found.is_apart |= is_beyond;
        found.is_found &= !is_beyond;
    }

    #[inline(always)]
    fn features(parts: u8) -> [FeatureId; 2] {
        [END_OR_SIDE[usize::from(parts & 3)], END_OR_SIDE[usize::from(parts >> 2 & 3)]]
    }
}

/// `Frame` of the plane, where the second flat coordinate is always zero.
struct Frame<V> {
    normal: Plane<V>,
    tangent: Plane<V>,
    /// The witness.
    point1: Plane<V>,
    distance: V,
    tolerance: V,
    prediction: V,
    sine: V,
}

impl<V> Frame<V> {
    #[inline(always)]
    fn flat<S: Simd>(&self, point: &Plane<V>) -> V
    where
        V: Wide<S>,
    {
        dot(&self.tangent, &minus(point, &self.point1))
    }

    #[inline(always)]
    fn height<S: Simd>(&self, point: &Plane<V>) -> V
    where
        V: Wide<S>,
    {
        dot(&self.normal, &minus(point, &self.point1))
    }

    /// `admit`: the distance to give to a pair of points, and where it is admitted.
    #[inline(always)]
    fn admit<S: Simd>(&self, distance: V, flat: V) -> (V, V::Mask)
    where
        V: Wide<S>,
    {
        let distance = distance.larger(self.distance);
        let is_near = distance.simd_le(self.prediction);
        let is_at = distance.simd_le(self.prediction + self.tolerance);
        let is_turned = distance.simd_le(self.prediction + self.sine * length(flat));
        let beyond = is_at.select(self.prediction, distance);
        (is_near.select(distance, beyond), is_near | is_at | is_turned)
    }
}

/// The length of a vector with one coordinate that is not zero, computed as that of any.
#[inline(always)]
fn length<S: Simd, V: Wide<S>>(x: V) -> V {
    (x * x).sqrt()
}

/// `Facet` of a segment: both ends, or where it leans too much the farther one.
struct Facet<V, M> {
    is_first: bool,
    ends: [Plane<V>; 2],
    flats: [V; 2],
    radius: V,
    cosine: V,
    /// How far the end nearest to the other solid is below the supporting plane, and where it is seen.
    top: (V, V),
    is_point: M,
    /// The facet, or the part of it at the witness, is the first end; the last.
    at_witness: [M; 2],
    /// Its ends are seen apart from each other.
    is_wide: M,
}

/// `Facet::face` of a segment, the first of the pair or the second, swollen by a radius.
#[inline(always)]
fn facet<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    frame: &Frame<V>,
    (ends, radius): (&[Plane<V>; 2], V),
    is_first: bool,
) -> Facet<V, V::Mask> {
    let flats = [frame.flat(&ends[0]), frame.flat(&ends[1])];
    let side = flats[1] - flats[0];
    let is_wide = side.abs().simd_gt(frame.tolerance);
    let cosine = length(side) / norm(&minus(&ends[1], &ends[0]));
    let is_point = cosine.simd_lt(lit::<S, N, V>(simd, 0.5));
    let outward = if is_first { frame.normal } else { negated(&frame.normal) };
    let is_last_far = dot(&ends[1], &outward).simd_gt(dot(&ends[0], &outward));
    let near = lit::<S, N, V>(simd, 2.0) * frame.tolerance;
    // The witness is seen at zero.
    let is_at = [length(flats[0]).simd_le(near), length(flats[1]).simd_le(near)];
    let at_witness = [
        (is_point & !is_last_far) | (!is_point & is_at[0]),
        (is_point & is_last_far) | (!is_point & is_at[1] & !is_at[0]),
    ];
    let ends = *ends;
    let top = (radius, radius);
    let mut facet =
        Facet { is_first, ends, flats, radius, cosine, top, is_point, at_witness, is_wide };
    let below = [facet.below_witness(&ends[0], frame), facet.below_witness(&ends[1], frame)];
    let is_last = below[1].simd_lt(below[0]);
    facet.top = (is_last.select(below[1], below[0]), is_last.select(flats[1], flats[0]));
    facet
}

impl<V, M> Facet<V, M> {
    #[inline(always)]
    fn below_witness<S: Simd>(&self, point: &Plane<V>, frame: &Frame<V>) -> V
    where
        V: Wide<S>,
    {
        let height = frame.height(point);
        if self.is_first { -height } else { height - frame.distance }
    }

    /// `under`: the point of the segment that is seen at the same place as another.
    #[inline(always)]
    fn under<S: Simd, N: Real>(&self, simd: S, flat: V) -> Plane<V>
    where
        V: Wide<S, Scalar = N>,
    {
        let side = self.flats[1] - self.flats[0];
        let along = (flat - self.flats[0]) * side / (side * side);
        let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
        let parameter = along.larger(zero).smaller(one);
        plus(&self.ends[0], &times(&minus(&self.ends[1], &self.ends[0]), parameter))
    }

    /// `lift`: how far the rounded surface is above a point of the core.
    #[inline(always)]
    fn lift<S: Simd, N: Real>(&self, simd: S, core: &Plane<V>, frame: &Frame<V>) -> V
    where
        V: Wide<S, Scalar = N>,
    {
        let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
        let room = self.below_witness(core, frame);
        let away = frame.flat(core) - self.top.1;
        let (away_squared, radius) = (away * away, self.radius);
        let turns_squared = radius * radius * (one - self.cosine * self.cosine);
        let round = room - self.top.0 + (radius * radius - away_squared).sqrt();
        let is_round = away_squared.simd_lt(turns_squared);
        let lift = is_round.select(round, radius / self.cosine);
        let lift = lift.smaller(room).larger(zero);
        radius.simd_le(zero).select(zero, lift)
    }

    /// `beside`: whether the place of an end of the other segment is beside this one, and whether at
    /// its first end or at its last.
    #[inline(always)]
    fn beside<S: Simd, N: Real>(&self, simd: S, flat: V, frame: &Frame<V>) -> [V::Mask; 3]
    where
        V: Wide<S, Scalar = N>,
    {
        let side = self.flats[1] - self.flats[0];
        let length = length(side);
        let along = (flat - self.flats[0]) * side / length;
        let tolerance = lit::<S, N, V>(simd, 2.0) * frame.tolerance;
        let is_off = along.simd_lt(-tolerance) | along.simd_gt(length + tolerance);
        let is_last = along.simd_ge(length - tolerance);
        [!is_off, along.simd_le(tolerance) & !is_last, is_last]
    }
}

/// A candidate for the manifold: an end of one segment beside the other.
struct Candidate<V, M> {
    point1: Plane<V>,
    flat: V,
    distance: V,
    is_admitted: M,
    /// It is beside the first end of the other segment; the last.
    beside: [M; 2],
}

impl<V, M> Candidate<V, M> {
    /// The end of a number of the first facet or of the second, as `common_stretch` adds it.
    #[inline(always)]
    fn of<S: Simd, N: Real>(
        simd: S,
        frame: &Frame<V>,
        facets: &[Facet<V, M>; 2],
        (which, end): (usize, usize),
    ) -> Self
    where
        V: Wide<S, Scalar = N, Mask = M>,
        M: SimdMask<S>,
    {
        let (own, other) = (&facets[which], &facets[1 - which]);
        let [is_beside, is_first, is_last] = other.beside(simd, own.flats[end], frame);
        let under = other.under(simd, own.flats[end]);
        let cores = if which == 0 { [own.ends[end], under] } else { [under, own.ends[end]] };
        let (gap, normal) = (minus(&cores[1], &cores[0]), &frame.normal);
        let across = minus(&gap, &times(normal, dot(normal, &gap)));
        let half = times(&across, V::all(simd, N::HALF));
        let cores = [plus(&cores[0], &half), minus(&cores[1], &half)];
        let lifts =
            [facets[0].lift(simd, &cores[0], frame), facets[1].lift(simd, &cores[1], frame)];
        let distance = dot(normal, &minus(&cores[1], &cores[0])) - lifts[0] - lifts[1];
        let point1 = plus(&cores[0], &times(normal, lifts[0]));
        let flat = frame.flat(&point1);
        let (distance, is_admitted) = frame.admit(distance, flat);
        let are_segments = !facets[0].is_point & !facets[1].is_point;
        let is_admitted = is_admitted & is_beside & are_segments;
        Self { point1, flat, distance, is_admitted, beside: [is_first, is_last] }
    }
}

/// The one point of a manifold.
struct Shared<V, M> {
    point1: Plane<V>,
    /// It is at the first end of the first segment; at the last; the same of the second segment.
    parts: [M; 4],
    /// There is no other.
    is_one: M,
}

/// What `fill` and `choose` make of two facets, where that is one point: the witness, or an end of one
/// segment above the other, found once or from both.
#[inline(always)]
fn shared<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    frame: &Frame<V>,
    facets: &[Facet<V, V::Mask>; 2],
) -> Shared<V, V::Mask> {
    let of1 =
        [Candidate::of(simd, frame, facets, (0, 0)), Candidate::of(simd, frame, facets, (0, 1))];
    let of2 =
        [Candidate::of(simd, frame, facets, (1, 0)), Candidate::of(simd, frame, facets, (1, 1))];
    let limit = frame.distance + frame.tolerance;
    let near = lit::<S, N, V>(simd, 4.0) * frame.tolerance;
    let any1 = of1[0].is_admitted | of1[1].is_admitted;
    let any2 = of2[0].is_admitted | of2[1].is_admitted;
    let both1 = of1[0].is_admitted & of1[1].is_admitted;
    let both2 = of2[0].is_admitted & of2[1].is_admitted;
    // Two candidates of one segment each are one if they are the same two ends at one place.
    let mut is_twice = both1 & !both1;
    for (end1, one) in of1.iter().enumerate() {
        for (end2, other) in of2.iter().enumerate() {
            let is_same = one.beside[end2] & other.beside[end1];
            let is_new = length(one.flat - other.flat).simd_gt(near);
            is_twice |= one.is_admitted & other.is_admitted & is_same & !is_new;
        }
    }
    let is_fit = !both1 & !both2 & (!(any1 & any2) | is_twice);
    let mut point1 = frame.point1;
    let mut is_low = !(any1 | any2);
    let is_witness = is_low;
    let mut parts = [
        is_witness & facets[0].at_witness[0],
        is_witness & facets[0].at_witness[1],
        is_witness & facets[1].at_witness[0],
        is_witness & facets[1].at_witness[1],
    ];
    for (end, one) in of2.iter().enumerate() {
        let is_it = one.is_admitted & !any1;
        point1 = either(is_it, &one.point1, &point1);
        is_low |= is_it & one.distance.simd_le(limit);
        parts[2 + end] |= is_it;
        parts[0] |= is_it & one.beside[0];
        parts[1] |= is_it & one.beside[1];
    }
    for (end, one) in of1.iter().enumerate() {
        let is_it = one.is_admitted;
        point1 = either(is_it, &one.point1, &point1);
        is_low |= is_it & one.distance.simd_le(limit);
        parts[end] |= is_it;
        parts[2] |= is_it & one.beside[0];
        parts[3] |= is_it & one.beside[1];
    }
    let is_wide = facets[0].is_wide & facets[1].is_wide;
    Shared { point1, parts, is_one: is_fit & is_low & is_wide }
}
