//! What a world and its objects print.

use core::fmt;

use super::{CollisionObject, CollisionObjects, CollisionWorld};
use crate::math::Space;

/// How many objects and pairs there are, and what waits for the next update: `pending: []` says that pairs,
/// contacts and events are up to date.
impl<N: Space<D>, const D: usize, T> fmt::Debug for CollisionWorld<N, D, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CollisionWorld")
            .field("num_objects", &self.len())
            .field("num_pairs", &self.broad_phase.num_interferences())
            .field("filters", &self.filters)
            .field("pending", &self.pending())
            .finish_non_exhaustive()
    }
}

impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// What waits for the next update, in words.
    fn pending(&self) -> Vec<String> {
        let counts = [
            (self.objects.changes.num_present(), "changed objects"),
            (self.queued.len(), "queued events"),
        ];
        let counted = counts.into_iter().filter(|&(count, _)| count > 0);
        let changes = [
            (self.filters.have_changed(), "filters"),
            (self.next_broad_phase.is_some(), "broad phase"),
            (self.next_narrow_phase.is_some(), "narrow phase"),
        ];
        let changed = changes.into_iter().filter(|(is_pending, _)| *is_pending);
        let counted = counted.map(|(count, what)| format!("{what}: {count}"));
        counted.chain(changed.map(|(_, what)| format!("other {what}"))).collect()
    }
}

impl<N: Space<D>, const D: usize, T: fmt::Debug> fmt::Debug for CollisionObjects<N, D, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.iter()).finish()
    }
}

impl<N: Space<D>, const D: usize, T: fmt::Debug> fmt::Debug for CollisionObject<N, D, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CollisionObject")
            .field("handle", &self.handle())
            .field("position", self.position())
            .field("shape", &**self.shape())
            .field("collision_groups", self.collision_groups())
            .field("query_type", &self.query_type())
            .field("is_fixed", &self.is_fixed())
            .field("data", self.data())
            .finish()
    }
}
