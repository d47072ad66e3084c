//! The interface of shapes for the naive world; tests may implement their own.

use crate::geometry::vector::norm;
use crate::geometry::{
    Pose, Solid, contains_point, point_signed_distance, ray_cast, signed_distance,
};

/// The geometric queries that the world makes about a shape at a pose.
pub trait Shape<const D: usize> {
    /// Returns the signed distance; minus infinity for solids that overlap without bound, which
    /// have no contact.
    fn signed_distance(&self, pose: &Pose<D>, other: &Self, other_pose: &Pose<D>) -> f64;

    /// Returns the radius of a ball about the local origin that contains the shape. Infinity is
    /// always correct, but slow.
    fn bounding_radius(&self) -> f64;

    /// Returns the least `t >= 0` at which the point `origin + t * direction` is in the shape;
    /// `None` if the ray misses.
    fn ray_cast(&self, pose: &Pose<D>, origin: &[f64; D], direction: &[f64; D]) -> Option<f64>;

    /// Whether a world point lies in the shape.
    fn contains_point(&self, pose: &Pose<D>, point: &[f64; D]) -> bool;

    /// Returns the least and the greatest corner of the smallest box around the shape.
    fn aabb(&self, pose: &Pose<D>) -> ([f64; D], [f64; D]);
}

impl<const D: usize> Shape<D> for Solid<D> {
    fn signed_distance(&self, pose: &Pose<D>, other: &Self, other_pose: &Pose<D>) -> f64 {
        signed_distance(self, pose, other, other_pose).lower
    }

    fn bounding_radius(&self) -> f64 {
        Self::bounding_radius(self)
    }

    fn ray_cast(&self, pose: &Pose<D>, origin: &[f64; D], direction: &[f64; D]) -> Option<f64> {
        ray_cast(self, pose, origin, direction)
    }

    fn contains_point(&self, pose: &Pose<D>, point: &[f64; D]) -> bool {
        contains_point(self, pose, point)
    }

    fn aabb(&self, pose: &Pose<D>) -> ([f64; D], [f64; D]) {
        Self::aabb(self, pose)
    }
}

/// A union of solids, each with a pose in the frame of the union: compounds, meshes, polylines and
/// height fields.
#[derive(Clone, Debug, PartialEq)]
pub struct Union<const D: usize> {
    /// The parts; at least one.
    pub parts: Vec<(Pose<D>, Solid<D>)>,
}

impl<const D: usize> From<Solid<D>> for Union<D> {
    fn from(solid: Solid<D>) -> Self {
        Self { parts: vec![(Pose::identity(), solid)] }
    }
}

impl<const D: usize> Union<D> {
    /// Returns the parts with their world poses.
    fn placed(&self, pose: &Pose<D>) -> impl Iterator<Item = (Pose<D>, &Solid<D>)> {
        self.parts.iter().map(|(local, solid)| (pose.compose(local), solid))
    }

    /// Returns the signed distance of a point from the nearest part. For a point inside it is minus
    /// the depth in the part in which the point is deepest.
    #[must_use]
    pub fn point_signed_distance(&self, pose: &Pose<D>, point: &[f64; D]) -> f64 {
        let distances = self.placed(pose).map(|(at, part)| point_signed_distance(part, &at, point));
        distances.fold(f64::INFINITY, f64::min)
    }
}

/// If unions are apart, all results are exact. If they interpenetrate, the depth is that of the
/// deepest pair of parts, which may be less than the translation that separates the unions.
impl<const D: usize> Shape<D> for Union<D> {
    fn signed_distance(&self, pose: &Pose<D>, other: &Self, other_pose: &Pose<D>) -> f64 {
        let mut least = f64::INFINITY;
        for (at1, part1) in self.placed(pose) {
            for (at2, part2) in other.placed(other_pose) {
                least = least.min(signed_distance(part1, &at1, part2, &at2).lower);
            }
        }
        least
    }

    fn bounding_radius(&self) -> f64 {
        let reach =
            |(local, part): &(Pose<D>, Solid<D>)| norm(&local.translation) + part.bounding_radius();
        self.parts.iter().map(reach).fold(0.0, f64::max)
    }

    fn ray_cast(&self, pose: &Pose<D>, origin: &[f64; D], direction: &[f64; D]) -> Option<f64> {
        let hits =
            self.placed(pose).filter_map(|(at, part)| ray_cast(part, &at, origin, direction));
        hits.min_by(f64::total_cmp)
    }

    fn contains_point(&self, pose: &Pose<D>, point: &[f64; D]) -> bool {
        self.placed(pose).any(|(at, part)| contains_point(part, &at, point))
    }

    fn aabb(&self, pose: &Pose<D>) -> ([f64; D], [f64; D]) {
        let mut whole = ([f64::INFINITY; D], [f64::NEG_INFINITY; D]);
        for (at, part) in self.placed(pose) {
            let (least, greatest) = part.aabb(&at);
            whole.0 = std::array::from_fn(|i| whole.0[i].min(least[i]));
            whole.1 = std::array::from_fn(|i| whole.1[i].max(greatest[i]));
        }
        whole
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns two squares of edge 2 side by side, with a gap of 2 between them.
    fn pair_of_boxes() -> Union<2> {
        let at = |x: f64| (Pose::at([x, 0.0]), Solid::cuboid([1.0, 1.0]));
        Union { parts: vec![at(-2.0), at(2.0)] }
    }

    #[test]
    fn union_by_hand() {
        let (union, pose) = (pair_of_boxes(), Pose::from_complex([10.0, 0.0], [0.0, 1.0]));
        assert_eq!(union.aabb(&pose), ([9.0, -3.0], [11.0, 3.0]));
        assert_eq!(union.bounding_radius(), 2.0 + 2f64.sqrt());
        assert_eq!(union.point_signed_distance(&pose, &[10.0, 0.25]), 0.75);
        assert_eq!(union.point_signed_distance(&pose, &[10.0, 1.25]), -0.25);
        assert!(!union.contains_point(&pose, &[10.0, 0.0]), "in the gap");
        let through_the_gap = union.ray_cast(&pose, &[0.0, 0.0], &[1.0, 0.0]);
        assert_eq!(through_the_gap, None);
        let t = union.ray_cast(&pose, &[10.0, -6.0], &[0.0, 1.0]).expect("hits");
        assert!((t - 3.0).abs() < 1e-14, "t {t}");
        let ball = Union::from(Solid::ball(0.5));
        assert_eq!(ball.signed_distance(&Pose::at([10.0, 0.0]), &union, &pose), 0.5);
    }
}
