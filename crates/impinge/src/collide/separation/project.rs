//! Projection of a point onto a solid of any kind with a closed form. The separation of a ball
//! follows from the projection of its centre.

use super::balls::{
    ball_cone, ball_cuboid, ball_cylinder, ball_ellipsoid, ball_polygon, ball_polytope,
    ball_segment, ball_tapered, ball_triangle, ball_triangle2,
};
use super::projection::{Projection, first_axis};
use crate::math::{Point, Real, unit};
use crate::shape::Kind;

/// Projects a point onto a solid in 2D, in the frame of the solid; `None` for kinds without a
/// closed form, for triangles that are segments up to rounding, and for a triangle and a NaN point.
pub(crate) fn project_on_solid_2d<N: Real>(
    kind: Kind<'_, N, 2>,
    point: &Point<N, 2>,
) -> Option<Projection<N, 2>> {
    match kind {
        Kind::Triangle(triangle) => ball_triangle2::project(triangle.corners(), point),
        Kind::Polytope(polygon) => Some(ball_polygon::project(polygon, point)),
        Kind::Rounded(solid) => {
            let core = project_on_solid_2d(solid.inner().0, point)?;
            Some(inflated(&core, solid.radius()))
        }
        other => project_on_common(other, point),
    }
}

/// Projects a point onto a solid in 3D, in the frame of the solid; `None` for kinds without a
/// closed form.
pub(crate) fn project_on_solid_3d<N: Real>(
    kind: Kind<'_, N, 3>,
    point: &Point<N, 3>,
) -> Option<Projection<N, 3>> {
    Some(match kind {
        Kind::Triangle(triangle) => ball_triangle::project(triangle.corners(), point),
        Kind::Polytope(hull) => ball_polytope::project(hull, point),
        Kind::Cylinder(cylinder, _) => ball_cylinder::project(cylinder, point),
        Kind::Cone(cone, _) => ball_cone::project(cone, point),
        Kind::Rounded(solid) => {
            inflated(&project_on_solid_3d(solid.inner().0, point)?, solid.radius())
        }
        other => return project_on_common(other, point),
    })
}

/// Projects a point onto a solid whose formula does not depend on the dimension; `None` for other
/// kinds.
#[inline]
fn project_on_common<N: Real, const D: usize>(
    kind: Kind<'_, N, D>,
    point: &Point<N, D>,
) -> Option<Projection<N, D>> {
    Some(match kind {
        Kind::Ball(ball) => {
            let (outward, apart) = unit(&point.coords).unwrap_or((first_axis(), N::ZERO));
            let center = Projection { distance: apart, outward, point: Point::origin() };
            inflated(&center, ball.radius())
        }
        Kind::Segment(segment) => ball_segment::project(&[*segment.a(), *segment.b()], point),
        Kind::Capsule(capsule) => {
            let core = capsule.segment();
            inflated(&ball_segment::project(&[*core.a(), *core.b()], point), capsule.radius())
        }
        Kind::Cuboid(cuboid) => ball_cuboid::project(cuboid.half_extents(), point),
        Kind::Ellipsoid(ellipsoid) => ball_ellipsoid::project(ellipsoid, point),
        Kind::TaperedCapsule(capsule) => ball_tapered::project(capsule, point).0,
        Kind::Plane(plane) => {
            let outward = plane.normal().into_inner();
            let distance = outward.dot(&point.coords);
            Projection { distance, outward, point: point - outward * distance }
        }
        _ => return None,
    })
}

/// Moves `core`, the projection of a point onto a solid, to the surface of the solid inflated by
/// `radius`.
#[inline]
fn inflated<N: Real, const D: usize>(core: &Projection<N, D>, radius: N) -> Projection<N, D> {
    Projection {
        distance: core.distance - radius,
        outward: core.outward,
        point: core.point + core.outward * radius,
    }
}
