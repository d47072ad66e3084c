//! The sizes of a ball or a box, copied into the object's record. Reading the copy avoids the cache
//! miss of the shape behind its handle.
//!
//! Queries of a world read the copy; the result equals the result of the shape itself.

use crate::bounding_volume::Aabb;
use crate::math::{Pose, Real, Space, Vector, filled};
use crate::shape::{Ball, Cuboid, Geometry, Kind, Shape, ShapeHandle};

/// The half extents of a box, or the radius of a ball followed by −1: the most common shapes. For
/// any other shape all components are −1.
///
/// ```text
/// box    h0    h1  [h2]     half extents, none negative
/// ball   r     -1  [-1]
/// other  -1    -1  [-1]
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Compact<N: Real, const D: usize>([N; D]);

impl<N: Real, const D: usize> Compact<N, D> {
    pub(crate) fn of(shape: &ShapeHandle<N, D>) -> Self {
        let mut numbers = [-N::ONE; D];
        if let Some(ball) = shape.as_shape::<Ball<N>>() {
            numbers[0] = ball.radius();
        } else if let Some(cuboid) = shape.as_shape::<Cuboid<N, D>>() {
            numbers = filled(|axis| cuboid.half_extents()[axis]);
        }
        Self(numbers)
    }

    /// Returns the AABB of the shape `own` at `pose`; reads `own` only if the copy is a marker.
    #[inline(always)]
    pub(crate) fn aabb(&self, own: &ShapeHandle<N, D>, pose: &Pose<N, D>) -> Aabb<N, D>
    where
        N: Space<D>,
    {
        if self.0[0] < N::ZERO {
            own.aabb(pose)
        } else if self.0[1] < N::ZERO {
            Ball::of_radius(self.0[0]).aabb(pose)
        } else {
            Cuboid::<N, D>::reaching(self.0.into()).aabb(pose)
        }
    }

    /// Calls `question` with the geometry of the shape `own`. Reads `own` only if the shape is
    /// neither a ball nor a box.
    #[inline(always)]
    pub(crate) fn ask<R>(
        &self,
        own: &ShapeHandle<N, D>,
        question: impl FnOnce(Geometry<'_, N, D>) -> R,
    ) -> R {
        let (ball, cuboid);
        let geometry = if self.0[0] < N::ZERO {
            own.geometry()
        } else if self.0[1] < N::ZERO {
            ball = Ball::of_radius(self.0[0]);
            Geometry(Kind::Ball(&ball))
        } else {
            cuboid = Cuboid::reaching(Vector::<N, D>::from(self.0));
            Geometry(Kind::Cuboid(&cuboid))
        };
        question(geometry)
    }
}

#[cfg(test)]
mod tests {
    use super::super::{Capsule, ShapeKind};
    use super::*;

    fn answers_as<const D: usize>(shape: ShapeHandle<f64, D>, kind: ShapeKind) {
        let compact = Compact::of(&shape);
        let found = compact.ask(&shape, |geometry| {
            assert_eq!(geometry.kind(), kind, "{shape:?}");
            match geometry.0 {
                Kind::Ball(ball) => vec![ball.radius()],
                Kind::Cuboid(cuboid) => cuboid.half_extents().iter().copied().collect(),
                _ => Vec::new(),
            }
        });
        let half_extents = shape.local_aabb().half_extents();
        assert!(found.iter().zip(half_extents.iter()).all(|(a, b)| a == b), "{shape:?}: {found:?}");
    }

    #[test]
    fn numbers_are_those_of_the_shape() {
        for size in [0.0, 1e-300, 2.5, 1e300] {
            answers_as::<2>(ShapeHandle::new(Ball::new(size)), ShapeKind::Ball);
            answers_as::<3>(ShapeHandle::new(Ball::new(size)), ShapeKind::Ball);
            let half = Vector::<f64, 3>::new(size, 0.0, 3.0);
            answers_as::<3>(ShapeHandle::new(Cuboid::new(half)), ShapeKind::Cuboid);
            let half = Vector::<f64, 2>::new(0.0, size);
            answers_as::<2>(ShapeHandle::new(Cuboid::new(half)), ShapeKind::Cuboid);
        }
        answers_as::<3>(ShapeHandle::new(Capsule::new(1.0, 0.5)), ShapeKind::Capsule);
    }
}
