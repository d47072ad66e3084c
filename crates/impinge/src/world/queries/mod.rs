//! Questions about everything in a world: rays, points, boxes, solids at rest and in motion.
//!
//! The broad phase answers as of the last update, and a tree of dirty objects for those whose boxes changed since,
//! so every change is seen at once; what they propose is tested again exactly, by the queries for one solid and two.

pub(super) mod cast;
mod filter;
mod one;
mod point;
mod ranking;
mod ray;
mod search;
pub(super) mod shape;

use core::fmt;

pub use filter::QueryFilter;
use smallvec::SmallVec;

use self::search::WorldProbe;
use super::{CollisionObject, CollisionWorld};
use crate::bounding_volume::Aabb;
use crate::math::Space;
use crate::query::ClosestPoints;

/// So many objects are found without memory from the allocator.
const FEW: usize = 16;

/// An object near what was asked about.
///
/// ```
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::{Ball, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType, QueryFilter};
///
/// let mut world = CollisionWorld::new(0.02_f32);
/// let (ball, query) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
/// world.add(Isometry::translation(5.0, 0.0), ball, CollisionGroups::new(), query, "tree");
/// let (probe, here) = (Ball::new(1.0), Isometry::identity());
/// let found = world.nearest_objects(&here, &probe, 1, 10.0, &QueryFilter::new());
/// assert_eq!((*found[0].object.data(), found[0].distance), ("tree", 3.0));
/// ```
pub struct NearObject<'a, N: Space<D>, const D: usize, T> {
    /// The object.
    pub object: &'a CollisionObject<N, D, T>,
    /// How far it is: zero if it touches or overlaps what was asked about.
    pub distance: N,
    /// The nearest points, in the world frame: on what was asked about, then on the object.
    /// Never [`ClosestPoints::Disjoint`].
    pub points: ClosestPoints<N, D>,
}

impl<N: Space<D>, const D: usize, T> Clone for NearObject<'_, N, D, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<N: Space<D>, const D: usize, T> Copy for NearObject<'_, N, D, T> {}

impl<N: Space<D>, const D: usize, T> fmt::Debug for NearObject<'_, N, D, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("NearObject")
            .field("object", &self.object.handle())
            .field("distance", &self.distance)
            .field("points", &self.points)
            .finish()
    }
}

/// What all queries share.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// The objects whose boxes the probe meets with a key of at most `limit`, and few others, allowed by the filter,
    /// in order, each once: for the test of the question itself.
    fn met<'a>(
        &'a self,
        probe: &WorldProbe<N, D>,
        limit: N,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> impl Iterator<Item = &'a CollisionObject<N, D, T>> + use<'a, N, D, T> {
        let mut objects: SmallVec<[&'a CollisionObject<N, D, T>; FEW]> = SmallVec::new();
        self.any_met(probe, limit, |object| {
            objects.push(object);
            false
        });
        objects.retain(|object| self.allows(object, filter));
        objects.sort_unstable_by_key(|object| object.body.handle);
        objects.into_iter()
    }

    /// One of the objects whose boxes the probe meets with a key of at most `limit`, or of few others, passes a
    /// test; none is asked after it, and each once at most.
    fn any_met<'a>(
        &'a self,
        probe: &WorldProbe<N, D>,
        limit: N,
        mut passes: impl FnMut(&'a CollisionObject<N, D, T>) -> bool,
    ) -> bool {
        if matches!(probe, WorldProbe::Near(aabb) if !aabb.holds_finite_point()) {
            // No search goes to infinity, where none but unbounded boxes are met.
            return self.objects.iter().any(passes);
        }
        let mut is_found = false;
        self.propose(probe, limit, |object, limit| {
            is_found = passes(object);
            if is_found { -N::ONE } else { limit }
        });
        is_found
    }

    /// The objects whose boxes meet `aabb`, as [`Self::met`].
    fn meeting<'a>(
        &'a self,
        aabb: &Aabb<N, D>,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> impl Iterator<Item = &'a CollisionObject<N, D, T>> + use<'a, N, D, T> {
        self.met(&WorldProbe::Near(*aabb), N::ZERO, filter)
    }
}
