//! The nearest point of the surface of a capsule.

use super::segment::{feature_at, nearest, surface_point as segment_point};
use super::{SurfacePoint, length};
use crate::math::{Point, Real, Vector, unit_or};
use crate::shape::{Capsule, FeatureId};

/// Returns the point at the distance `radius` from the nearest point of the core segment, towards
/// `point`; in a direction perpendicular to the segment if `point` lies on it. A capsule without
/// radius is that segment.
pub(super) fn surface_point<N: Real, const D: usize>(
    capsule: &Capsule<N, D>,
    point: &Point<N, D>,
) -> SurfacePoint<N, D> {
    let (segment, radius) = (capsule.segment(), capsule.radius());
    if radius == N::ZERO {
        return segment_point(segment, point);
    }
    let (core, fraction) = nearest([segment.a(), segment.b()], point);
    let outward = point - core;
    let direction = unit_or(&outward, aside(&(segment.b() - segment.a())));
    SurfacePoint {
        point: core + direction * radius,
        feature: feature_at(fraction, [0, 1], FeatureId::Edge(0)),
        is_inside: length(&outward) <= radius,
    }
}

/// Returns a unit vector perpendicular to `axis`: the projection of the coordinate axis that is
/// least aligned with it, the first if there are several. For a zero `axis` returns the first
/// coordinate axis.
fn aside<N: Real, const D: usize>(axis: &Vector<N, D>) -> Vector<N, D> {
    let mut least = 0;
    for index in 1..D {
        if axis[index].abs() < axis[least].abs() {
            least = index;
        }
    }
    let mut across = Vector::<N, D>::zeros();
    across[least] = N::ONE;
    let along = unit_or(axis, Vector::<N, D>::zeros());
    unit_or(&(across - along * along[least]), across)
}
