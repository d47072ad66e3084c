//! Functions shared by the kernels for segments and capsules: they gather the cores, compute
//! lengths of the cores, and name the features of a segment.

use super::gather::Inputs;
use super::vectors::{length_of, lit, minus, norm};
use super::{PairQuestion, Solid};
use crate::math::simd::Simd;
use crate::math::{Real, Vector, Wide};
use crate::shape::FeatureId;

/// Feature of a segment that a point lies on, indexed by two bits: bit 0 is set if the point is at
/// the first end, bit 1 if it is at the last. With neither or both, the feature is the segment
/// itself.
pub(super) const END_OR_SIDE: [FeatureId; 4] =
    [FeatureId::Edge(0), FeatureId::Vertex(0), FeatureId::Vertex(1), FeatureId::Edge(0)];

impl<N: Real, const D: usize, const L: usize> Inputs<N, D, L> {
    /// Copies two segments or capsules and their poses into a lane; returns `false` for other
    /// kinds.
    #[inline(always)]
    pub(super) fn put_cores(&mut self, lane: usize, pair: &PairQuestion<'_, N, D>) -> bool {
        self.put_poses(lane, pair);
        self.put_sine(lane, pair.request.sine);
        self.put_core(lane, 0, pair.solids[0]) && self.put_core(lane, 1, pair.solids[1])
    }

    /// Copies the core and radius of a segment or capsule into a lane; returns `false` for other
    /// kinds.
    #[inline(always)]
    pub(super) fn put_core(&mut self, lane: usize, which: usize, solid: &Solid<N, D>) -> bool {
        let (segment, radius) = match solid {
            Solid::Segment(segment) => (segment, N::ZERO),
            Solid::Capsule(capsule) => (capsule.segment(), capsule.radius()),
            _ => return false,
        };
        let ends: [&Vector<N, D>; 2] = [&segment.a().coords, &segment.b().coords];
        self.put_end(lane, which, 0, ends[0]);
        self.put_end(lane, which, 1, ends[1]);
        self.put_radius(lane, which, radius);
        true
    }
}

/// Returns the larger of the distances of two points from the origin. The mask has the lanes where
/// each distance is zero or has a square far from underflow and overflow.
#[inline(always)]
pub(super) fn farther<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    [first, last]: &[[V; D]; 2],
) -> (V, V::Mask) {
    let ((length1, is_in_range1), (length2, is_in_range2)) =
        (length_of(simd, first), length_of(simd, last));
    (length1.larger(length2), is_in_range1 & is_in_range2)
}

/// Returns half the distance between two points.
#[inline(always)]
pub(super) fn half_length<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    [first, last]: &[[V; D]; 2],
) -> V {
    lit::<S, N, V>(simd, 0.5) * norm(&minus(last, first))
}
