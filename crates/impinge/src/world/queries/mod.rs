//! Questions about everything in a world: rays, points, boxes, solids at rest and in motion.
//!
//! The broad phase answers as of the last update. Objects that it does not know where they are now
//! are few and tested one by one, so every change is seen at once; what it proposes is tested again
//! exactly, by the queries for one solid and two.

mod cast;
mod filter;
mod one;
mod point;
mod ranking;
mod ray;
mod search;
mod shape;

use core::fmt;

pub use filter::QueryFilter;
use smallvec::SmallVec;

use super::bodies::grown;
use super::{CollisionObject, CollisionWorld};
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::math::Space;
use crate::narrow_phase::CollisionObjectHandle;
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
    /// The objects that the broad phase found and has not lost track of, and those that it has and
    /// that `may` meet the question; allowed by the filter, in order, each once.
    ///
    /// The test of the question itself comes next.
    fn candidates<'a>(
        &'a self,
        found: Vec<&CollisionObjectHandle>,
        may: &dyn Fn(&Aabb<N, D>) -> bool,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> impl Iterator<Item = &'a CollisionObject<N, D, T>> + use<'a, N, D, T> {
        let settled = found.into_iter().filter_map(|&handle| self.settled(handle));
        let astray = self.astray().filter(|(_, volume)| may(volume)).map(|(object, _)| object);
        let allowed = settled.chain(astray).filter(|object| self.allows(object, filter));
        let mut objects: Vec<_> = allowed.collect();
        objects.sort_unstable_by_key(|object| object.body.handle);
        objects.into_iter()
    }

    /// The objects whose volumes meet `aabb`, and few others, allowed by the filter, in order, each once:
    /// for the test of the question itself, as [`Self::candidates`].
    fn meeting<'a>(
        &'a self,
        aabb: &Aabb<N, D>,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> impl Iterator<Item = &'a CollisionObject<N, D, T>> + use<'a, N, D, T> {
        let mut objects: SmallVec<[&'a CollisionObject<N, D, T>; FEW]> = SmallVec::new();
        self.any_meeting(aabb, |object| {
            objects.push(object);
            false
        });
        objects.retain(|object| self.allows(object, filter));
        objects.sort_unstable_by_key(|object| object.body.handle);
        objects.into_iter()
    }

    /// One of the objects whose volumes meet `aabb`, or of few others, passes a test; none is asked after it, and
    /// each once at most.
    fn any_meeting<'a>(
        &'a self,
        aabb: &Aabb<N, D>,
        mut passes: impl FnMut(&'a CollisionObject<N, D, T>) -> bool,
    ) -> bool {
        let mut astray = self.astray().filter(|(_, volume)| volume.intersects(aabb));
        if astray.any(|(object, _)| passes(object)) {
            return true;
        }
        if !aabb.holds_finite_point() {
            // No search goes to infinity, where none but unbounded volumes are met.
            let mut found = Vec::new();
            self.broad_phase.interferences_with_bounding_volume(aabb, &mut found);
            return found.into_iter().filter_map(|&handle| self.settled(handle)).any(passes);
        }
        let mut is_found = false;
        self.broad_phase.visit_nearest_roughly(aabb, N::ZERO, &mut |proposals| {
            let mut settled = proposals.iter().filter_map(|one| self.settled_proposal(one));
            is_found = is_found || settled.any(&mut passes);
            if is_found { -N::ONE } else { N::ZERO }
        });
        is_found
    }

    /// The object of a handle of the broad phase, if it lives and is where it was at the last update.
    fn settled(&self, handle: CollisionObjectHandle) -> Option<&CollisionObject<N, D, T>> {
        let object = self.objects.get(handle)?;
        (!self.objects.changes.is_astray(&object.body)).then_some(object)
    }

    /// The living objects of which the broad phase does not know where they are, and their volumes.
    fn astray(&self) -> impl Iterator<Item = (&CollisionObject<N, D, T>, Aabb<N, D>)> {
        let astray = self.objects.astray();
        astray.map(|(object, aabb)| (object, grown(aabb, object.body.query_limit())))
    }
}
