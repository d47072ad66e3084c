//! What the tests of the pair queries share: solids of the tests' own, readers of the corpus files,
//! and a generator of random numbers.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses a part")]

pub mod corpus;
pub mod random;
pub mod samples;
pub mod solids;

use impinge::math::{AbstractRotation, Isometry, Point, Real, Space, Vector};
use impinge::query::contact;
use impinge::shape::Shape;

/// A shape and where it is.
pub struct Placed<N: Real, R, const D: usize> {
    pub shape: Box<dyn Shape<N, D>>,
    pub pose: Isometry<N, R, D>,
}

impl<N: Space<D>, R: AbstractRotation<N, D>, const D: usize> Placed<N, R, D> {
    /// The point farthest along a world direction; infinite for a half-space, except along its own
    /// normal.
    pub fn support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let local = self.pose.rotation.inverse_transform_vector(direction);
        let map = self.shape.geometry().as_support_map().expect("not a half-space");
        self.pose.transform_point(&map.support_point(&local))
    }

    /// How far the solid's points are from the world origin, at most about.
    pub fn extent(&self) -> N {
        let geometry = self.shape.geometry();
        let reach = geometry.as_support_map().map_or(N::ZERO, |map| map.reach() + map.rounding());
        reach + self.pose.translation.vector.norm()
    }
}

/// The signed distance: every pair but two half-spaces that overlap without bound has one.
pub fn signed<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    solid1: &Placed<N, R, D>,
    solid2: &Placed<N, R, D>,
) -> N {
    let found = contact(&solid1.pose, &*solid1.shape, &solid2.pose, &*solid2.shape, N::INFINITY);
    found.map_or(-N::INFINITY, |found| -found.depth)
}

/// How far a direction from the first solid to the second separates them.
pub fn gap_along<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    solid1: &Placed<N, R, D>,
    solid2: &Placed<N, R, D>,
    normal: &Vector<N, D>,
) -> N {
    normal.dot(&(solid2.support(&-normal) - solid1.support(normal)))
}
