//! Half-spaces against all convex solids, in 2D and 3D.

use super::projection::first_axis;
use super::wrong_kinds;
use crate::collide::Pair;
use crate::convex::Separation;
use crate::math::{Point, Pose, Real, Vector, unit_or};
use crate::shape::{Geometry, Kind, Plane, SupportMap};

/// Returns the separation of a convex solid from a half-space, at the solid's point deepest in the
/// half-space; `None` above `limit`.
///
/// Exact for every support map, including curved ones. If several points are equally deep, the
/// solid's support map chooses one of them.
pub(super) fn separation<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let (Some(solid), Kind::Plane(plane)) = (Geometry(pair.first).as_support_map(), &pair.second)
    else {
        wrong_kinds(pair)
    };
    let Deepest { normal, core, distance } = Deepest::of(solid, plane, &pair.pose12);
    let point1 = core + normal * solid.rounding();
    let point2 = point1 + normal * distance;
    (distance <= limit).then_some(Separation { distance, normal, point1, point2 })
}

/// Returns the distance of [`separation`] for a convex solid, which may be rounded, and a
/// half-space whose pose in the solid's frame is `pose12`; `None` if the solid is itself a
/// half-space or a composite.
#[inline]
pub(super) fn distance<N: Real, const D: usize>(
    kind: Kind<'_, N, D>,
    plane: &Plane<N, D>,
    pose12: &Pose<N, D>,
) -> Option<N> {
    if let Kind::Rounded(solid) = kind {
        return distance(solid.inner().0, plane, pose12).map(|core| core - solid.radius());
    }
    Some(Deepest::of(Geometry(kind).as_support_map()?, plane, pose12).distance)
}

/// The point of a core deepest in a half-space, and the signed distance there.
struct Deepest<N: Real, const D: usize> {
    /// Unit normal into the half-space, in the frame of the solid.
    normal: Vector<N, D>,
    /// Point of the core, in the frame of the solid.
    core: Point<N, D>,
    /// Signed distance of the solid, its radius included.
    distance: N,
}

impl<N: Real, const D: usize> Deepest<N, D> {
    #[inline]
    fn of(solid: &dyn SupportMap<N, D>, plane: &Plane<N, D>, pose12: &Pose<N, D>) -> Self {
        let normal = -pose12.vector(plane.normal());
        let core = solid.core_support(&normal);
        let beyond = normal.dot(&(core.coords - pose12.translation));
        Self { normal, core, distance: -beyond - solid.rounding() }
    }
}

/// Returns the separation of two half-spaces; `None` above `limit`.
///
/// If they face each other, exactly or up to the rounding of rotations (an angle below 16 epsilon),
/// they have a gap or a finite depth. All other pairs overlap without bound: then the distance is
/// minus infinity, the normal is the unit vector along `normal1 - normal2` (the first axis if both
/// are equal), and the points are the origins of the half-spaces.
pub(super) fn plane_plane<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let (Kind::Plane(plane1), Kind::Plane(plane2)) = (&pair.first, &pair.second) else {
        wrong_kinds(pair)
    };
    let normal1: Vector<N, D> = plane1.normal().into_inner();
    let normal2 = pair.pose12.vector(plane2.normal());
    let origin2 = pair.pose12.translation;
    let faces = (normal1 + normal2).norm() <= N::lit(16.0) * N::EPSILON;
    let separation = if faces {
        let distance = normal1.dot(&origin2);
        let point2 = Point::from(origin2);
        Separation { distance, normal: normal1, point1: point2 - normal1 * distance, point2 }
    } else {
        Separation {
            distance: -N::INFINITY,
            normal: unit_or(&(normal1 - normal2), first_axis()),
            point1: Point::origin(),
            point2: Point::from(origin2),
        }
    };
    (separation.distance <= limit).then_some(separation)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Unit;
    use crate::shape::{Capsule, Shape};

    fn up() -> Plane<f64, 3> {
        Plane::new(Unit::new_unchecked(Vector::<f64, 3>::y()))
    }

    fn below(y: f64) -> Pose<f64, 3> {
        Pose::from_translation(Vector::<f64, 3>::new(7.0, -y, 0.0))
    }

    #[test]
    fn a_standing_capsule_sinks_in() {
        let (plane, capsule) = (up(), Capsule::<f64, 3>::new(2.0, 0.5));
        let pair =
            |pose12| Pair { first: capsule.geometry().0, second: plane.geometry().0, pose12 };
        let found = separation(&pair(below(2.25)), 0.0).expect("it reaches down to -2.5");
        assert_eq!(found.distance, -0.25, "the round end is a quarter deep");
        assert_eq!(found.point1, Point::<f64, 3>::new(0.0, -2.5, 0.0), "its lowest point");
        assert_eq!(found.point2, Point::<f64, 3>::new(0.0, -2.25, 0.0), "the plane above it");
        assert_eq!(separation(&pair(below(3.0)), 0.25), None, "half a unit above");
        assert!(separation(&pair(below(3.0)), 0.5).is_some(), "equal to the limit is inside");
    }

    #[test]
    fn planes_that_face_each_other_and_others() {
        let (up, down) = (up(), Plane::new(Unit::new_unchecked(-Vector::<f64, 3>::y())));
        let pair = |plane2: &'static Plane<f64, 3>, y| Pair {
            first: Box::leak(Box::new(up)).geometry().0,
            second: plane2.geometry().0,
            pose12: below(y),
        };
        let down: &'static _ = Box::leak(Box::new(down));
        let gap = plane_plane(&pair(down, -3.0), 9.0).expect("within the limit");
        assert_eq!((gap.distance, gap.normal.y), (3.0, 1.0), "the ceiling is three above");
        let overlap = plane_plane(&pair(down, 2.0), 0.0).expect("they overlap");
        assert_eq!(overlap.distance, -2.0, "a slab two thick");
        let same = plane_plane(&pair(Box::leak(Box::new(up)), 2.0), 0.0).expect("they overlap");
        assert_eq!(same.distance, -f64::INFINITY, "one in the other");
    }
}
