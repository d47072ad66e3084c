//! Shared by the tests of pair queries: solids that only the tests have, readers of the corpus
//! files, and a random generator.
#![allow(dead_code, unreachable_pub, reason = "each test binary uses a part")]

pub mod corpus;
pub mod random;
pub mod samples;
pub mod solids;

use impinge::math::{AbstractRotation, Isometry, Point, Real, Space, Vector};
use impinge::query::contact;
use impinge::shape::Shape;

/// A shape and its pose.
pub struct Placed<N: Real, R, const D: usize> {
    pub shape: Box<dyn Shape<N, D>>,
    pub pose: Isometry<N, R, D>,
}

impl<N: Space<D>, R: AbstractRotation<N, D>, const D: usize> Placed<N, R, D> {
    /// Returns the point farthest along a world direction. Panics for half-spaces.
    pub fn support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let local = self.pose.rotation.inverse_transform_vector(direction);
        let map = self.shape.geometry().as_support_map().expect("not a half-space");
        self.pose.transform_point(&map.support_point(&local))
    }

    /// Returns, up to rounding, an upper bound of the distance of the points of the solid from the
    /// world origin. For a half-space, returns the distance of the origin of its frame.
    pub fn extent(&self) -> N {
        let geometry = self.shape.geometry();
        let reach = geometry.as_support_map().map_or(N::ZERO, |map| map.reach() + map.rounding());
        reach + self.pose.translation.vector.norm()
    }
}

/// Returns the signed distance; -∞ only for two half-spaces that overlap without bound.
pub fn signed<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    solid1: &Placed<N, R, D>,
    solid2: &Placed<N, R, D>,
) -> N {
    let found = contact(&solid1.pose, &*solid1.shape, &solid2.pose, &*solid2.shape, N::INFINITY);
    found.map_or(-N::INFINITY, |found| -found.depth)
}

/// Returns the separation along a direction from the first solid to the second.
pub fn gap_along<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    solid1: &Placed<N, R, D>,
    solid2: &Placed<N, R, D>,
    normal: &Vector<N, D>,
) -> N {
    normal.dot(&(solid2.support(&-normal) - solid1.support(normal)))
}
