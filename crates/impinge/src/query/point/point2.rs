//! The table of nearest-point algorithms in 2D, by kind of solid.

use super::{
    SurfacePoint, ball, capsule, cuboid, ellipsoid, plane, polytope, rounded, segment, support_map,
    tapered_capsule, triangle2,
};
use crate::math::{Point, Real};
use crate::query::composite;
use crate::shape::Kind;

/// Returns the nearest point of the solid's boundary, in its local frame.
pub(crate) fn surface_point<N: Real>(
    kind: Kind<'_, N, 2>,
    point: &Point<N, 2>,
) -> SurfacePoint<N, 2> {
    match kind {
        Kind::Ball(solid) => ball::surface_point(solid.radius(), point),
        Kind::Segment(solid) => segment::surface_point(solid, point),
        Kind::Capsule(solid) => capsule::surface_point(solid, point),
        Kind::Triangle(solid) => triangle2::surface_point(solid, point),
        Kind::Cuboid(solid) => {
            let corner = Point::from(*solid.half_extents());
            cuboid::surface_point([&-corner, &corner], point)
        }
        Kind::Polytope(solid) => polytope::surface_point2(solid, point),
        Kind::Cylinder(_, map) | Kind::Cone(_, map) | Kind::SupportMap(map) => {
            support_map::surface_point(map, point)
        }
        Kind::Ellipsoid(solid) => ellipsoid::surface_point(solid, point),
        Kind::TaperedCapsule(solid) => tapered_capsule::surface_point(solid, point),
        Kind::Rounded(solid) => rounded::surface_point(solid, point),
        Kind::Plane(solid) => plane::surface_point(solid, point),
        Kind::Composite(parts) => composite::surface_point(parts, point),
    }
}
