//! Bounding boxes and spheres of placed shapes.

use crate::bounding_volume::{Aabb, BoundingSphere};
use crate::math::lanes::{highest_lane, load, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{AbstractRotation, Isometry, Matrix, Point, Pose, Real, Vector, Wide, max};
use crate::shape::polytope::LANES;
use crate::shape::solids::segment::length_of;
use crate::shape::{Polytope, Shape, SupportMap};

/// Returns a box around a shape placed at `pose`, in the frame that the pose maps to. The box is as
/// small as is cheap to compute. The box of a half-space is unbounded, except that it ends at the
/// boundary if the normal is exactly parallel to an axis.
///
/// ```
/// use impinge::dim2::bounding_volume::aabb;
/// use impinge::dim2::math::{Isometry, Point};
/// use impinge::dim2::shape::Ball;
///
/// let around = aabb(&Ball::new(1.0_f32), &Isometry::translation(3.0, 0.0));
/// assert_eq!((around.mins().x, around.maxs().x), (2.0, 4.0));
/// ```
pub fn aabb<N: Real, R: AbstractRotation<N, D>, const D: usize>(
    shape: &dyn Shape<N, D>,
    pose: &Isometry<N, R, D>,
) -> Aabb<N, D> {
    shape.aabb(&Pose::from_isometry(pose))
}

/// Returns a sphere around a shape placed at `pose`, in the frame that the pose maps to; infinite
/// for a half-space.
///
/// ```
/// use impinge::dim3::bounding_volume::bounding_sphere;
/// use impinge::dim3::math::{Isometry, Vector};
/// use impinge::dim3::shape::Cuboid;
///
/// let (cube, place) = (Cuboid::new(Vector::repeat(1.0_f64)), Isometry::translation(3.0, 0.0, 0.0));
/// let sphere = bounding_sphere(&cube, &place);
/// assert_eq!(sphere.center().x, 3.0);
/// assert!(sphere.radius() >= 3.0_f64.sqrt());
/// ```
pub fn bounding_sphere<N: Real, R: AbstractRotation<N, D>, const D: usize>(
    shape: &dyn Shape<N, D>,
    pose: &Isometry<N, R, D>,
) -> BoundingSphere<N, D> {
    shape.local_bounding_sphere().transformed_by(&Pose::from_isometry(pose))
}

impl<N: Real, const D: usize> Polytope<N, D> {
    /// Returns the smallest box around the solid placed at `pose`, rounded outwards; all of space
    /// if a rotated vertex is NaN.
    pub(super) fn aabb_at(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        // If the rotation gives NaN, there are no extents and the box is unbounded.
        let extents = extents(Level::new(), &self.blocks, &pose.rotation);
        extents.map_or_else(Aabb::unbounded, |[low, high]| {
            Aabb::of_rotated(low, high, self.reach(), pose)
        })
    }

    /// Returns a sphere around the centre of the box; its radius exceeds the distance of the
    /// farthest vertex by a bound of the rounding error. All of space if the radius overflows.
    pub(super) fn bounding_sphere(&self) -> BoundingSphere<N, D> {
        let center = self.aabb_at(&Pose::identity()).center();
        let distance = |vertex: &Point<N, D>| length_of(&(vertex - center));
        let radius = self.vertices.iter().map(distance).fold(N::ZERO, max);
        let radius = radius * (N::ONE + N::lit(4.0) * N::EPSILON);
        BoundingSphere::try_new(center, radius).unwrap_or(BoundingSphere::unbounded())
    }
}

/// Returns the result of [`extents_in_lanes`], computed with the vector instructions of `level`.
/// The result does not depend on `level`.
fn extents<N: Real, const D: usize>(
    level: Level,
    blocks: &[[[N; LANES]; D]],
    rotation: &Matrix<N, D>,
) -> Option<[Vector<N, D>; 2]> {
    with_lanes!(level, simd => extents_in_lanes::<_, N, N::Lanes<_>, D>(simd, blocks, rotation))
}

/// Returns the componentwise minimum and maximum of the rotated vertices; each block has 8
/// vertices. `None` if a coordinate is NaN.
#[inline(always)]
fn extents_in_lanes<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    blocks: &[[[N; LANES]; D]],
    rotation: &Matrix<N, D>,
) -> Option<[Vector<N, D>; 2]> {
    let (mut mins, mut maxs) = (Vector::<N, D>::zeros(), Vector::<N, D>::zeros());
    for axis in 0..D {
        let most = V::all(simd, N::INFINITY);
        let (mut low, mut high, mut are_numbers) = (most, -most, true);
        for block in blocks {
            let local: [V; D] = load(simd, block);
            let mut at = V::all(simd, rotation[(axis, 0)]) * local[0];
            for (column, local) in local.iter().enumerate().skip(1) {
                at += V::all(simd, rotation[(axis, column)]) * *local;
            }
            are_numbers &= at.simd_le(most).to_bitmask() == ALL;
            (low, high) = (at.smaller(low), at.larger(high));
        }
        if !are_numbers {
            return None;
        }
        (mins[axis], maxs[axis]) = (-highest_lane(-low), highest_lane(high));
    }
    Some([mins, maxs])
}

/// The bitmask in which the bits of all lanes are set.
const ALL: u64 = (1 << LANES) - 1;

#[cfg(test)]
mod tests {
    use super::super::{Ball, Plane};
    use super::*;
    use crate::bounding_volume::BoundingVolume;
    use crate::math::{Isometry2, Isometry3, Unit, Vector};

    #[test]
    fn balls_and_half_spaces_by_isometries() {
        let pose = Isometry3::translation(1.0_f32, 2.0, 3.0);
        let ball = aabb(&Ball::new(0.5), &pose);
        assert_eq!(ball.maxs(), &Point::<f32, 3>::new(1.5, 2.5, 3.5), "moved");
        assert_eq!(bounding_sphere(&Ball::new(0.5), &pose).radius(), 0.5, "itself");
        let plane = Plane::new(Unit::new_unchecked(Vector::<f64, 2>::y()));
        let below = aabb(&plane, &Isometry2::translation(0.0, 4.0));
        assert_eq!(below.maxs(), &Point::<f64, 2>::new(f64::INFINITY, 4.0), "bounded above");
        let sphere = bounding_sphere(&plane, &Isometry2::identity());
        assert!(sphere.radius().is_infinite(), "{sphere:?}");
    }

    #[test]
    fn boxes_of_hulls_are_those_of_their_placed_vertices() {
        use super::super::ConvexHull;
        let point = |n: u32| {
            let [x, y, z] = [n * 7 % 11, n * 5 % 13, n * 3 % 17].map(f64::from);
            Point::<f64, 3>::new(x - 5.0, y - 6.0, z - 8.0)
        };
        let rotation = Isometry3::rotation(Vector::<f64, 3>::new(0.3, -1.1, 0.7)).rotation;
        for count in [4, 5, 8, 9, 31] {
            let points: Vec<_> = (0..count).map(point).collect();
            let hull = ConvexHull::from_points(&points);
            for x in [0.0, 1e6, f64::MAX, f64::INFINITY, f64::NAN] {
                let translation = Vector::<f64, 3>::new(x, 0.25, -3.0);
                let isometry = Isometry3::from_parts(translation.into(), rotation);
                let pose = Pose::from_isometry(&isometry);
                let placed = hull.polytope().vertices().iter().map(|vertex| pose.point(vertex));
                let (found, inner) = (hull.aabb(&pose), Aabb::around_all(placed));
                let inner = inner.unwrap_or_else(Aabb::unbounded);
                assert!(
                    found.contains(&inner),
                    "{count} points at {x}: {found:?} around {inner:?}"
                );
                let outer = inner.loosened(1e-13 + 4.0 * f64::EPSILON * x.abs());
                assert!(
                    x.is_nan() || x.abs() > 1e7 || outer.contains(&found),
                    "{count} points at {x}"
                );
            }
        }
    }
}
