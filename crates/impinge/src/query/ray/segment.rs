//! Ray casts against a segment, in any dimension: the span of time during which the ray's line is
//! on the segment.

use super::span::{Crossing, Span};
use crate::bounding_volume::Ray;
use crate::math::{Mapped, Point, Real, Vector, max, unit_or};
use crate::query::point::{feature_at, nearest_on_segment};
use crate::shape::FeatureId;

/// The ids of a segment and of its two ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct RayFeatures {
    pub(super) ends: [u32; 2],
    pub(super) between: FeatureId,
}

impl RayFeatures {
    /// The ids of a segment that is a shape of its own.
    pub(super) const SEGMENT: Self = Self { ends: [0, 1], between: FeatureId::Edge(0) };
}

/// Returns the span. The projection along the ray maps the segment to a segment in one dimension
/// less, and the ray to a point. The ray hits if that point is on the projected segment within
/// rounding; else the result is `None`. A segment along the ray projects to a point; the ray enters
/// it at one end and leaves it at the other end.
pub(super) fn span<N: Real, const D: usize>(
    ends: [&Point<N, D>; 2],
    features: RayFeatures,
    ray: &Ray<N, D>,
) -> Option<Span<N, D>> {
    let squared = ray.dir.norm_squared();
    let [a, b] = ends.mapped(|end| end - ray.origin);
    let [at_a, at_b] = [a, b].mapped(|end| end.dot(&ray.dir) / squared);
    let (across_a, across_b) = (a - ray.dir * at_a, b - ray.dir * at_b);
    let rounding = N::lit(8.0) * N::EPSILON * max(a.norm(), b.norm());
    let across = [Point::from(across_a), Point::from(across_b)];
    let (nearest, fraction) = nearest_on_segment([&across[0], &across[1]], &Point::origin());
    let hits = nearest.coords.norm() <= rounding;
    if !hits {
        return None;
    }
    let against = unit_or(&-ray.dir, Vector::<N, D>::zeros());
    if (across_b - across_a).norm() <= rounding {
        let ends = [(at_a, features.ends[0]), (at_b, features.ends[1])];
        return Some(lengthwise(ends, against));
    }
    let t = at_a + (at_b - at_a) * fraction;
    let along = unit_or(&(b - a), Vector::<N, D>::zeros());
    let normal = unit_or(&(against - along * along.dot(&against)), against);
    let crossing = Crossing::new(t, normal, feature_at(fraction, features.ends, features.between));
    Some(Span::thin(crossing, crossing))
}

/// Returns the span from the end that the line meets first to the other end.
fn lengthwise<N: Real, const D: usize>(ends: [(N, u32); 2], against: Vector<N, D>) -> Span<N, D> {
    let [first, second] = if ends[1].0 < ends[0].0 { [ends[1], ends[0]] } else { ends };
    Span::thin(
        Crossing::new(first.0, against, FeatureId::Vertex(first.1)),
        Crossing::new(second.0, -against, FeatureId::Vertex(second.1)),
    )
}
