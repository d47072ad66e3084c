//! Boxes and spheres around shapes placed somewhere.

use super::polytope::QUARTET;
use super::segment::length_of;
use super::{Polytope, Shape};
use crate::bounding_volume::{Aabb, BoundingSphere};
use crate::math::{AbstractRotation, Isometry, Point, Pose, Real, max, min};

/// The box around a shape placed at `pose`, in the frame that the pose leads to; as small as is
/// cheap. Unbounded for a half-space, but for the axis that its normal lies along exactly.
pub fn aabb<N: Real, R: AbstractRotation<N, D>, const D: usize>(
    shape: &dyn Shape<N, D>,
    pose: &Isometry<N, R, D>,
) -> Aabb<N, D> {
    shape.aabb(&Pose::from_isometry(pose))
}

/// The sphere around a shape placed at `pose`, in the frame that the pose leads to; infinite for a
/// half-space.
pub fn bounding_sphere<N: Real, R: AbstractRotation<N, D>, const D: usize>(
    shape: &dyn Shape<N, D>,
    pose: &Isometry<N, R, D>,
) -> BoundingSphere<N, D> {
    shape.local_bounding_sphere().transformed_by(&Pose::from_isometry(pose))
}

impl<N: Real, const D: usize> Polytope<N, D> {
    /// The smallest box around the solid placed at `pose`.
    pub(super) fn aabb_at(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        let (mut mins, mut maxs) = (pose.translation, pose.translation);
        for axis in 0..D {
            // A pose that is not finite gives no box; then everything is in it.
            let Some(extent) = self.extent_along(axis, pose) else { return Aabb::unbounded() };
            [mins[axis], maxs[axis]] = extent;
        }
        Aabb::try_new(Point::from(mins), Point::from(maxs)).unwrap_or_else(|_| Aabb::unbounded())
    }

    /// The least and the greatest coordinate of the vertices on one axis of the frame that a pose leads to:
    /// four vertices at a time, each as [`Pose::point`] has it. `None` if a coordinate is not a number.
    fn extent_along(&self, axis: usize, pose: &Pose<N, D>) -> Option<[N; 2]> {
        let mut are_numbers = [true; QUARTET];
        let mut lows = [N::INFINITY; QUARTET];
        let mut highs = [-N::INFINITY; QUARTET];
        for quartet in &self.quartets {
            let mut at = quartet[0].map(|x| pose.rotation[(axis, 0)] * x);
            for (column, coordinates) in quartet.iter().enumerate().skip(1) {
                let factor = pose.rotation[(axis, column)];
                for (at, x) in at.iter_mut().zip(coordinates) {
                    *at += factor * *x;
                }
            }
            for lane in 0..QUARTET {
                let at = at[lane] + pose.translation[axis];
                are_numbers[lane] &= at <= N::INFINITY;
                lows[lane] = if at < lows[lane] { at } else { lows[lane] };
                highs[lane] = if at > highs[lane] { at } else { highs[lane] };
            }
        }
        let [a, b, c, d] = lows;
        let [e, f, g, h] = highs;
        let extent = [min(min(a, c), min(b, d)), max(max(e, g), max(f, h))];
        are_numbers.into_iter().all(|is| is).then_some(extent)
    }

    /// The sphere around the middle of the box; a little larger than the farthest vertex asks for,
    /// by the rounding of its distance.
    pub(super) fn bounding_sphere(&self) -> BoundingSphere<N, D> {
        let center = self.aabb_at(&Pose::identity()).center();
        let distance = |vertex: &Point<N, D>| length_of(&(vertex - center));
        let radius = self.vertices.iter().map(distance).fold(N::ZERO, max);
        let radius = radius * (N::ONE + N::lit(4.0) * N::EPSILON);
        BoundingSphere::try_new(center, radius).unwrap_or(BoundingSphere::unbounded())
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Ball, Plane};
    use super::*;
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
                let expected = Aabb::around_all(placed).unwrap_or_else(Aabb::unbounded);
                assert_eq!(hull.aabb(&pose), expected, "{count} points at {x}");
            }
        }
    }
}
