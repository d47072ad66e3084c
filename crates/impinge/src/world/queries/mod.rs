//! Questions about everything in a world: rays, points, boxes, solids at rest and in motion.
//!
//! The broad phase answers as of the last update. Objects that it does not know where they are now
//! are few and tested one by one, so every change is seen at once; what it proposes is tested again
//! exactly, by the queries for one solid and two.

mod cast;
mod filter;
mod point;
mod ranking;
mod ray;
mod search;
mod shape;

use core::fmt;

pub use filter::QueryFilter;

use super::bodies::{Body, grown};
use super::{CollisionObject, CollisionWorld};
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::math::Space;
use crate::narrow_phase::CollisionObjectHandle;
use crate::query::ClosestPoints;

/// An object near what was asked about.
pub struct Neighbor<'a, N: Space<D>, const D: usize, T> {
    /// The object.
    pub object: &'a CollisionObject<N, D, T>,
    /// How far it is: zero if it touches or overlaps what was asked about.
    pub distance: N,
    /// The nearest points, in the world frame: on what was asked about, then on the object.
    /// Never [`ClosestPoints::Disjoint`].
    pub points: ClosestPoints<N, D>,
}

impl<N: Space<D>, const D: usize, T> Clone for Neighbor<'_, N, D, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<N: Space<D>, const D: usize, T> Copy for Neighbor<'_, N, D, T> {}

impl<N: Space<D>, const D: usize, T> fmt::Debug for Neighbor<'_, N, D, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Neighbor")
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
    /// The test of the question itself comes next: the user's records, which lie elsewhere in memory,
    /// are for [`Self::record`] of those that pass it.
    fn candidates<'a>(
        &'a self,
        found: Vec<&CollisionObjectHandle>,
        may: &dyn Fn(&Aabb<N, D>) -> bool,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> impl Iterator<Item = &'a Body<N, D>> + use<'a, N, D, T> {
        let settled = found.into_iter().filter_map(|&handle| self.settled(handle));
        let astray = self.astray().filter(|(_, volume)| may(volume)).map(|(body, _)| body);
        let allowed = settled.chain(astray).filter(|body| self.allows(body, filter));
        let mut bodies: Vec<_> = allowed.collect();
        bodies.sort_unstable_by_key(|body| body.handle);
        bodies.into_iter()
    }

    /// The objects whose volumes meet `aabb`, and few others, allowed by the filter, in order, each once:
    /// for the test of the question itself, as [`Self::candidates`].
    fn meeting<'a>(
        &'a self,
        aabb: &Aabb<N, D>,
        filter: &QueryFilter<'_, N, D, T>,
    ) -> impl Iterator<Item = &'a Body<N, D>> + use<'a, N, D, T> {
        let mut bodies: Vec<&'a Body<N, D>> = Vec::new();
        if aabb.holds_finite_point() {
            self.broad_phase.visit_nearest_roughly(aabb, N::ZERO, &mut |proposals| {
                bodies.extend(proposals.iter().filter_map(|one| self.settled_proposal(one)));
                N::ZERO
            });
        } else {
            // No search goes to infinity, where none but unbounded volumes are met.
            let mut found = Vec::new();
            self.broad_phase.interferences_with_bounding_volume(aabb, &mut found);
            bodies.extend(found.into_iter().filter_map(|&handle| self.settled(handle)));
        }
        let astray = self.astray().filter(|(_, volume)| volume.intersects(aabb));
        bodies.extend(astray.map(|(body, _)| body));
        bodies.retain(|body| self.allows(body, filter));
        bodies.sort_unstable_by_key(|body| body.handle);
        bodies.into_iter()
    }

    /// The user's record of a living object.
    fn record(&self, body: &Body<N, D>) -> Option<&CollisionObject<N, D, T>> {
        self.objects.get(body.handle)
    }

    /// The object of a handle of the broad phase, if it lives and is where it was at the last update.
    fn settled(&self, handle: CollisionObjectHandle) -> Option<&Body<N, D>> {
        let body = &self.objects.get(handle)?.body;
        (!self.objects.changes.is_astray(body)).then_some(body)
    }

    /// The living objects of which the broad phase does not know where they are, and their volumes.
    fn astray(&self) -> impl Iterator<Item = (&Body<N, D>, Aabb<N, D>)> {
        let astray = self.objects.astray();
        astray.map(|(body, aabb)| (body, grown(aabb, body.query.query_limit())))
    }
}
