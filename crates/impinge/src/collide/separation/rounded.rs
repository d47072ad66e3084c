//! Rounded solids against all kinds: the separation of the inner solids, minus the radii.

use crate::collide::Pair;
use crate::convex::Separation;
use crate::math::{Real, Space};
use crate::shape::Kind;

/// Returns the separation of two solids of which one or both are rounded; `None` above `limit`.
///
/// Exact for overlapping solids as well: inflating a solid moves each supporting plane outwards by
/// the radius, so the normal of least depth stays the same.
pub(super) fn separation<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let ((first, radius1), (second, radius2)) = (bare(pair.first), bare(pair.second));
    let bare = Pair { first, second, pose12: pair.pose12 };
    let found = super::separation(&bare, loosened(limit, radius1 + radius2))?;
    let found = found.rounded(radius1, radius2);
    (found.distance <= limit).then_some(found)
}

/// Returns the inner solid of a rounded solid, and the radius around it; for other solids the solid
/// itself and zero. Removes only the outermost radius of nested rounded solids.
pub(crate) fn bare<N: Real, const D: usize>(kind: Kind<'_, N, D>) -> (Kind<'_, N, D>, N) {
    match kind {
        Kind::Rounded(solid) => (solid.inner().0, solid.radius()),
        other => (other, N::ZERO),
    }
}

/// Returns a limit for the inner solids: `limit + radii`, raised so that rounding rejects no pair
/// within `limit`. An infinite or NaN limit is returned unchanged.
fn loosened<N: Real>(limit: N, radii: N) -> N {
    if !limit.is_finite_number() {
        return limit;
    }
    limit + radii + N::lit(8.0) * N::EPSILON * (limit.abs() + radii)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Pose, Vector};
    use crate::shape::{Cuboid, Rounded, Shape};

    #[test]
    fn corners_of_rounded_boxes() {
        let cuboid = Cuboid::new(Vector::<f64, 3>::repeat(1.0));
        let (small, large) = (Rounded::new(cuboid, 0.25), Rounded::new(cuboid, 0.5));
        let pose12 = Pose::from_translation(Vector::<f64, 3>::new(4.0, 5.0, 8.0));
        let pair = Pair { first: small.geometry().0, second: large.geometry().0, pose12 };
        let found = separation(&pair, 7.0).expect("within the limit");
        assert!((found.distance - 6.25).abs() < 4e-15, "(2, 3, 6) between the corners: {found:?}");
        assert!((found.normal - Vector::<f64, 3>::new(2.0, 3.0, 6.0) / 7.0).norm() < 1e-15);
        assert!(separation(&pair, found.distance).is_some(), "equal to the limit");
        assert_eq!(separation(&pair, 6.2499), None, "beyond it");
        assert!(separation(&pair, f64::INFINITY).is_some(), "without a limit");
    }

    #[test]
    fn roundings_add_up_to_any_depth() {
        let cuboid = Cuboid::new(Vector::<f64, 2>::new(1.0, 2.0));
        let twice = Rounded::new(Rounded::new(cuboid, 0.25), 0.5);
        let pose12 = Pose::from_translation(Vector::<f64, 2>::new(1.5, 0.0));
        let pair = Pair { first: cuboid.geometry().0, second: twice.geometry().0, pose12 };
        let found = separation(&pair, 0.0).expect("they overlap");
        assert_eq!(found.distance, -0.5 - 0.75, "half a unit deep, and both roundings");
        assert_eq!(found.normal, Vector::<f64, 2>::new(1.0, 0.0), "across the narrow sides");
    }
}
