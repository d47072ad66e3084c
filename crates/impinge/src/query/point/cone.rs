//! The nearest point of the surface of a cone, computed in the half-plane through the y axis and
//! the query point.

use super::SurfacePoint;
use super::cylinder::Meridian;
use super::segment::nearest;
use crate::math::{Point, Real};
use crate::shape::{Cone, FeatureId};

/// Returns the nearest point of the base and the slanted side, which are two segments in the
/// half-plane.
pub(super) fn surface_point<N: Real>(cone: &Cone<N>, point: &Point<N, 3>) -> SurfacePoint<N, 3> {
    let (radius, half_height) = (cone.radius(), cone.half_height());
    let meridian = Meridian::of(point);
    let middle = Point::<N, 2>::new(N::ZERO, -half_height);
    let rim = Point::<N, 2>::new(radius, -half_height);
    let apex = Point::<N, 2>::new(N::ZERO, half_height);
    let (on_base, base_fraction) = nearest([&middle, &rim], &meridian.flat);
    let (on_side, side_fraction) = nearest([&rim, &apex], &meridian.flat);
    let base_feature =
        if base_fraction >= N::ONE { FeatureId::Edge(0) } else { FeatureId::Face(0) };
    let side_feature = match side_fraction {
        fraction if fraction >= N::ONE => FeatureId::Vertex(0),
        fraction if fraction <= N::ZERO => FeatureId::Edge(0),
        _ => FeatureId::Face(1),
    };
    let base = SurfacePoint::on(on_base, base_feature);
    let found = base.nearer(SurfacePoint::on(on_side, side_feature), &meridian.flat);
    SurfacePoint {
        point: meridian.lift(&found.point),
        feature: found.feature,
        is_inside: contains(cone, &meridian.flat),
    }
}

/// Returns whether the cone contains a point; `flat` is (distance from the axis, height).
fn contains<N: Real>(cone: &Cone<N>, flat: &Point<N, 2>) -> bool {
    // Divides lengths by powers of two, so that the products neither overflow nor underflow.
    let units = [cone.radius(), cone.half_height()].map(N::power_of_two_below);
    let (radius, x) = (cone.radius() / units[0], flat.x / units[0]);
    let (half_height, y) = (cone.half_height() / units[1], flat.y / units[1]);
    y.abs() <= half_height
        && x <= radius
        && x * (half_height + half_height) <= radius * (half_height - y)
}
