//! Ray casts against a capsule: the span of time during which the ray's line is inside.

use super::ball::{around, roots};
use super::clip::in_order;
use super::segment::{RayFeatures, span as segment_span};
use super::span::{Crossing, Span};
use crate::bounding_volume::Ray;
use crate::math::{Mapped, Real, Vector, max, min, unit, unit_or};
use crate::shape::{Capsule, FeatureId};

/// Returns the span of the union of two balls and of the round side between them. The union is
/// convex, so the span runs from the first entry to the last exit; `None` if the line misses all
/// three.
///
/// A capsule without radius is treated as a segment.
pub(super) fn span<N: Real, const D: usize>(
    capsule: &Capsule<N, D>,
    ray: &Ray<N, D>,
) -> Option<Span<N, D>> {
    let (segment, radius) = (capsule.segment(), capsule.radius());
    if radius == N::ZERO {
        return segment_span([segment.a(), segment.b()], RayFeatures::SEGMENT, ray);
    }
    let at_a = around(segment.a(), radius, FeatureId::Vertex(0), ray);
    let at_b = around(segment.b(), radius, FeatureId::Vertex(1), ray);
    Span::union_of(side(capsule, ray), Span::union_of(at_a, at_b))
}

/// Returns the span in the cylinder around the segment, with flat ends; `None` if the line misses
/// the cylinder or the segment has no length.
///
/// The normal is radial at both ends of the span, even if the line passes through a flat end. A
/// flat end lies inside the balls; only its rim may come first, by rounding.
fn side<N: Real, const D: usize>(capsule: &Capsule<N, D>, ray: &Ray<N, D>) -> Option<Span<N, D>> {
    let (a, b) = (capsule.segment().a(), capsule.segment().b());
    let (along, length) = unit(&(b - a))?;
    let origin = ray.origin - a;
    let (height, climb) = (origin.dot(&along), ray.dir.dot(&along));
    let (flat_origin, flat_dir) = (origin - along * height, ray.dir - along * climb);
    let found = roots(&flat_origin, &flat_dir, capsule.radius())?;
    let (mut enter, mut leave) = (found.enter, found.leave);
    if climb == N::ZERO {
        if height < N::ZERO || height > length {
            return None;
        }
    } else {
        let (first, second) = (-height / climb, (length - height) / climb);
        enter = max(enter, min(first, second));
        leave = min(leave, max(first, second));
    }
    let against = unit_or(&-ray.dir, Vector::<N, D>::zeros());
    let normals = [(enter, against), (leave, -against)]
        .mapped(|(t, fallback)| unit_or(&(flat_origin + flat_dir * t), fallback));
    let [enter_normal, leave_normal] =
        refined(&found.points(), normals, [enter == found.enter, leave == found.leave]);
    let feature = FeatureId::Edge(0);
    let enter = Crossing::new(enter, enter_normal, feature);
    let leave = Crossing::new(leave, leave_normal, feature);
    let span = Span { enter, leave, thin: found.runs_at(capsule.radius()) };
    in_order(&span).then_some(span)
}

/// Replaces the normals by the directions of `points` where the line passes through the round side
/// itself: these are more accurate. A zero point leaves the normal.
fn refined<N: Real, const D: usize>(
    points: &[Vector<N, D>; 2],
    normals: [Vector<N, D>; 2],
    round: [bool; 2],
) -> [Vector<N, D>; 2] {
    [0, 1].mapped(|end| if round[end] { unit_or(&points[end], normals[end]) } else { normals[end] })
}
