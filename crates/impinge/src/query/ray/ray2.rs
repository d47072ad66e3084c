//! The table of ray casts in 2D, by kind of solid.

use super::span::Span;
use super::{
    ball, capsule, cuboid, ellipsoid, plane, polytope, rounded, segment, support_map,
    tapered_capsule, triangle2,
};
use crate::bounding_volume::Ray;
use crate::math::{Point, Real};
use crate::shape::Kind;

/// Returns the span of the ray's line in the solid, in the solid's local frame. `None` if the line
/// misses the solid, and for a composite. For a solid known by distances alone, see
/// `RaySolid::span` for further cases of `None` and for the end of the span.
pub(crate) fn span<N: Real>(kind: Kind<'_, N, 2>, ray: &Ray<N, 2>) -> Option<Span<N, 2>> {
    match kind {
        Kind::Ball(solid) => ball::span(solid.radius(), ray),
        Kind::Segment(solid) => {
            segment::span([solid.a(), solid.b()], segment::RayFeatures::SEGMENT, ray)
        }
        Kind::Capsule(solid) => capsule::span(solid, ray),
        Kind::Triangle(solid) => triangle2::span(solid, ray),
        Kind::Cuboid(solid) => {
            let corner = Point::from(*solid.half_extents());
            cuboid::span([&-corner, &corner], ray)
        }
        Kind::Polytope(solid) => polytope::span(solid, ray),
        Kind::Cylinder(_, map) | Kind::Cone(_, map) | Kind::SupportMap(map) => {
            support_map::span(map, ray)
        }
        Kind::Ellipsoid(solid) => ellipsoid::span(solid, ray),
        Kind::TaperedCapsule(solid) => tapered_capsule::span(solid, ray),
        Kind::Rounded(solid) => rounded::span(solid, ray),
        Kind::Plane(solid) => plane::span(solid, ray),
        // Callers cast the parts of a composite instead.
        Kind::Composite(_) => None,
    }
}
