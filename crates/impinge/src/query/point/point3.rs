//! The table of nearest-point algorithms in 3D, by kind of solid.

use super::{
    SurfacePoint, ball, capsule, cone, cuboid, cylinder, ellipsoid, plane, polytope, rounded,
    segment, support_map, tapered_capsule, triangle3,
};
use crate::math::{Point, Real};
use crate::query::composite;
use crate::shape::Kind;

/// Returns the nearest point of the solid's boundary, in its local frame.
pub(crate) fn surface_point<N: Real>(
    kind: Kind<'_, N, 3>,
    point: &Point<N, 3>,
) -> SurfacePoint<N, 3> {
    match kind {
        Kind::Ball(solid) => ball::surface_point(solid.radius(), point),
        Kind::Segment(solid) => segment::surface_point(solid, point),
        Kind::Capsule(solid) => capsule::surface_point(solid, point),
        Kind::Triangle(solid) => triangle3::surface_point(solid, point),
        Kind::Cuboid(solid) => {
            let corner = Point::from(*solid.half_extents());
            cuboid::surface_point([&-corner, &corner], point)
        }
        Kind::Polytope(solid) => polytope::surface_point3(solid, point),
        Kind::Cylinder(solid, _) => cylinder::surface_point(solid, point),
        Kind::Cone(solid, _) => cone::surface_point(solid, point),
        Kind::SupportMap(map) => support_map::surface_point(map, point),
        Kind::Ellipsoid(solid) => ellipsoid::surface_point(solid, point),
        Kind::TaperedCapsule(solid) => tapered_capsule::surface_point(solid, point),
        Kind::Rounded(solid) => rounded::surface_point(solid, point),
        Kind::Plane(solid) => plane::surface_point(solid, point),
        Kind::Composite(parts) => composite::surface_point(parts, point),
    }
}
