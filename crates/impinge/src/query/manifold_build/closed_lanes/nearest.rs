//! Segments in lanes: their nearest points to others, and the names of their parts.

use super::gather::Inputs;
use super::vectors::{dot, either, length_of, minus, plus, times};
use super::{PairQuestion, Solid};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Vector, Wide};
use crate::shape::FeatureId;

/// The part of a segment by whether a point is at the first and at the last end.
pub(super) const END_OR_SIDE: [FeatureId; 4] =
    [FeatureId::Edge(0), FeatureId::Vertex(0), FeatureId::Vertex(1), FeatureId::Edge(0)];

impl<N: Real, const D: usize> Inputs<N, D> {
    /// Two segments or capsules and where they are; answers whether both are.
    #[inline(always)]
    pub(super) fn put_cores(&mut self, lane: usize, pair: &PairQuestion<'_, N, D>) -> bool {
        self.put_poses(lane, pair);
        self.put_sine(lane, pair.request.sine);
        self.put_core(lane, 0, pair.solids[0]) && self.put_core(lane, 1, pair.solids[1])
    }

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
    pub(super) along: [V; D],
    /// How far along the given point is from the first end, and how far from the last, times the length.
    pub(super) from_first: V,
    pub(super) to_last: V,
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
