//! Bounding boxes for searches of parts, and functions that enlarge boxes and limits by the
//! rounding error, so that a search rejects no part within its limit.

use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::math::{Point, Pose, Real, Space, Vector, max, max_component};
use crate::shape::{Kind, Shape, SupportMap};

/// Rounding error of boxes and times, in units of epsilon times the largest coordinate used to
/// compute them.
const ROUNDING_ERRORS: f64 = 16.0;

/// Returns a box around a solid of any kind placed at `pose`.
///
/// Cost: at most two support points for each coordinate axis; for a composite, reading the bounds
/// of its search structure.
pub(crate) fn aabb_of<N: Space<D>, const D: usize>(
    kind: Kind<'_, N, D>,
    pose: &Pose<N, D>,
) -> Aabb<N, D> {
    match kind {
        Kind::Ball(ball) => Shape::<N, D>::aabb(ball, pose),
        Kind::Segment(segment) => segment.aabb(pose),
        Kind::Capsule(capsule) => capsule.aabb(pose),
        Kind::Triangle(triangle) => triangle.aabb(pose),
        Kind::Cuboid(cuboid) => cuboid.aabb(pose),
        Kind::Plane(plane) => plane.aabb(pose),
        Kind::Ellipsoid(ellipsoid) => ellipsoid.aabb(pose),
        Kind::TaperedCapsule(capsule) => capsule.aabb(pose),
        Kind::Rounded(solid) => aabb_of(solid.inner().0, pose).loosened(solid.radius()),
        Kind::Polytope(map) => of_map(map, pose),
        Kind::Cylinder(_, map) | Kind::Cone(_, map) | Kind::SupportMap(map) => of_map(map, pose),
        Kind::Composite(parts) => parts.search().bounds().transformed_by(pose),
    }
}

/// Returns the box of a support map placed at `pose`, computed from its support points along the
/// axes; unbounded if the computed corners do not form a valid box.
fn of_map<N: Real, const D: usize>(map: &dyn SupportMap<N, D>, pose: &Pose<N, D>) -> Aabb<N, D> {
    let (mut mins, mut maxs) = (pose.point(&map.center()), pose.point(&map.center()));
    for axis in 0..D {
        let mut outward = Vector::<N, D>::zeros();
        outward[axis] = N::ONE;
        let local = pose.inverse_vector(&outward);
        maxs[axis] = pose.point(&map.core_support(&local))[axis] + map.rounding();
        mins[axis] = pose.point(&map.core_support(&-local))[axis] - map.rounding();
    }
    Aabb::try_new(mins, maxs).unwrap_or_else(|_| Aabb::unbounded())
}

/// Loosens `aabb`, a box transformed by `pose`, so that it encloses the result of the same
/// transformation in exact arithmetic. Returns an unbounded box if the loosened box is not valid.
pub(crate) fn enclosing<N: Real, const D: usize>(
    aabb: &Aabb<N, D>,
    pose: &Pose<N, D>,
) -> Aabb<N, D> {
    let scale = extent(aabb) + max_component(&pose.translation);
    let grown = aabb.loosened(rounding(scale));
    Aabb::try_new(*grown.mins(), *grown.maxs()).unwrap_or_else(|_| Aabb::unbounded())
}

/// Returns a box around a point, loosened by rounding error; `None` if the point is not finite.
///
/// `bounds` must enclose all boxes that the result is compared with: the rounding error is
/// proportional to the coordinates of `bounds` and `point`.
#[inline(always)]
pub(crate) fn around_point<N: Real, const D: usize>(
    point: &Point<N, D>,
    bounds: &Aabb<N, D>,
) -> Option<Aabb<N, D>> {
    let at = Aabb::at(*point);
    // Infinite and NaN coordinates are rejected, so that the box is valid.
    let is_finite = (0..D).all(|axis| point[axis].is_finite_number());
    is_finite.then(|| at.loosened(rounding(extent(bounds) + extent(&at))))
}

/// Returns the largest absolute value of the finite coordinates of a box.
pub(super) fn extent<N: Real, const D: usize>(aabb: &Aabb<N, D>) -> N {
    let mut most = N::ZERO;
    for axis in 0..D {
        for x in [aabb.mins()[axis], aabb.maxs()[axis]] {
            if x.is_finite_number() {
                most = max(x.abs(), most);
            }
        }
    }
    most
}

/// Returns an upper bound of the rounding error of lengths computed from coordinates up to `scale`.
fn rounding<N: Real>(scale: N) -> N {
    N::lit(ROUNDING_ERRORS) * N::EPSILON * scale
}

/// Returns `limit`, a distance or time of zero or more, plus its rounding error, so that
/// comparisons of boxes reject no part within `limit`. Infinite if the square of the sum, which
/// searches may compute, is not finite.
pub(crate) fn loosened<N: Real>(limit: N) -> N {
    let within = limit + rounding(limit);
    if (within * within).is_finite_number() { within } else { N::INFINITY }
}
