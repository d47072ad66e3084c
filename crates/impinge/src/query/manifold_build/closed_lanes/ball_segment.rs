//! A ball and a segment or capsule: `separation/ball_segment.rs` in lanes.

use fearless_simd::{Select, Simd};

use super::gather::Inputs;
use super::vectors::{bits, dot, either, length_of, lit, minus, negated, plus, rounding_of, times, unit};
use super::{Form, Found, PairQuestion, Solid};
use crate::math::{Real, Vector, Wide};
use crate::shape::FeatureId;

/// Balls with their centre some way off a segment that has a length.
pub(super) struct BallSegment;

impl<N: Real, const D: usize> Form<N, D> for BallSegment {
    #[inline(always)]
    fn gather(inputs: &mut Inputs<N, D>, lane: usize, pair: &PairQuestion<'_, N, D>) -> bool {
        let Solid::Ball(ball) = pair.solids[0] else { return false };
        inputs.put_radius(lane, 0, ball.radius());
        inputs.put_poses(lane, pair);
        inputs.put_core(lane, 1, pair.solids[1])
    }

    #[inline(always)]
    fn find<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        inputs: &Inputs<N, D>,
        found: &mut Found<N, D>,
    ) {
        let pose12 = inputs.pose12::<S, V>(simd);
        let ends = [inputs.end::<S, V>(simd, (1, 0)), inputs.end::<S, V>(simd, (1, 1))];
        let (radius, rounding) = (inputs.radius::<S, V>(simd, 0), inputs.radius::<S, V>(simd, 1));
        let center = pose12.inverse_origin(simd);
        let near = nearest_on_segment(simd, &ends, &center);
        let offset = minus(&center, &near.point);
        let (direct, away, is_off) = unit(simd, &offset);
        let (axis, length, is_long) = unit(simd, &near.along);
        let (sideways, is_beside) = made_perpendicular(simd, (&direct, is_off), &axis);
        let outward = either(near.is_inside, &sideways, &direct);
        let normal = negated(&pose12.vector(&outward));
        let point1 = times(&normal, radius);
        let (reach, is_moderate) = farther(simd, &ends);
        let size = radius + (reach + rounding) + pose12.apart();
        let noise = lit::<S, N, V>(simd, 2.0) * rounding_of::<S, N, V>(simd, size);
        let (slack, is_edge) = (noise * length, length.simd_le(noise));
        let is_first = near.from_first.simd_le(slack) & !is_edge;
        let is_last = near.to_last.simd_le(slack) & !is_edge;
        found.parts[0] = bits(is_first);
        found.parts[1] = bits(is_last & !is_first);
        let is_known = (near.is_inside & is_beside) | (!near.is_inside & is_off);
        let distance = away - rounding - radius;
        found.put(simd, inputs, (distance, is_known & is_long & is_moderate), [&normal, &point1]);
    }

    #[inline(always)]
    fn features(parts: u8) -> [FeatureId; 2] {
        [FeatureId::Face(0), END_OR_SIDE[usize::from(parts & 3)]]
    }
}

/// The part of a segment by whether a point is at the first and at the last end.
pub(super) const END_OR_SIDE: [FeatureId; 4] =
    [FeatureId::Edge(0), FeatureId::Vertex(0), FeatureId::Vertex(1), FeatureId::Edge(0)];

impl<N: Real, const D: usize> Inputs<N, D> {
    /// A segment or capsule; answers whether it is one.
    #[inline(always)]
    pub(super) fn put_core(&mut self, lane: usize, which: usize, solid: &Solid<N, D>) -> bool {
        let (segment, radius) = match solid {
            Solid::Segment(segment) => (segment, N::ZERO),
            Solid::Capsule(capsule) => (capsule.segment(), capsule.radius()),
            _ => return false,
        };
        let ends: [&Vector<N, D>; 2] = [&segment.a().coords, &segment.b().coords];
        self.put_end(lane, (which, 0), ends[0]);
        self.put_end(lane, (which, 1), ends[1]);
        self.put_radius(lane, which, radius);
        true
    }
}

/// The nearest point of a segment to a point, in lanes.
pub(super) struct Nearest<V, M, const D: usize> {
    pub(super) point: [V; D],
    /// It lies between the ends.
    pub(super) is_inside: M,
    /// From the first end to the last.
    along: [V; D],
    /// How far along the given point is from the first end, and how far from the last, times the length.
    from_first: V,
    to_last: V,
}

/// `nearest_on_segment` of `separation/segments.rs`.
#[inline(always)]
pub(super) fn nearest_on_segment<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    [first, last]: &[[V; D]; 2],
    point: &[V; D],
) -> Nearest<V, V::Mask, D> {
    let zero = V::all(simd, N::ZERO);
    let along = minus(last, first);
    let from_first = dot(&minus(point, first), &along);
    let to_last = dot(&minus(last, point), &along);
    let (is_beyond_first, whole) = (from_first.simd_gt(zero), from_first + to_last);
    let is_inside = is_beyond_first & to_last.simd_gt(zero);
    let is_first_half = from_first.simd_lt(to_last);
    let step = times(&along, is_first_half.select(from_first, to_last) / whole);
    let inside = either(is_first_half, &plus(first, &step), &minus(last, &step));
    let end = either(is_beyond_first, last, first);
    let point = either(is_inside, &inside, &end);
    Nearest { point, is_inside, along, from_first, to_last }
}

/// `made_perpendicular` of a vector whose direction is given, and where that is certain.
#[inline(always)]
fn made_perpendicular<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    (v, is_off): (&[V; D], V::Mask),
    d: &[V; D],
) -> ([V; D], V::Mask) {
    let (once, remainder, is_once) = unit(simd, &minus(v, &times(d, dot(v, d))));
    let (twice, _, is_twice) = unit(simd, &minus(&once, &times(d, dot(&once, d))));
    let least = lit::<S, N, V>(simd, 16.0) * V::all(simd, N::EPSILON);
    (twice, is_off & is_once & is_twice & remainder.simd_gt(least))
}

/// The larger of the distances of two points from the origin, where both are usual.
#[inline(always)]
pub(super) fn farther<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    [first, last]: &[[V; D]; 2],
) -> (V, V::Mask) {
    let ((length1, is_usual1), (length2, is_usual2)) =
        (length_of(simd, first), length_of(simd, last));
    (length1.larger(length2), is_usual1 & is_usual2)
}
