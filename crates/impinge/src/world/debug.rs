//! `Debug` output of a world and its objects, and a check of its invariants for tests.

use core::fmt;

use super::bodies::WorldBody;
use super::{CollisionObject, CollisionObjects, CollisionWorld};
use crate::bounding_volume::BoundingVolume;
use crate::math::Space;
use crate::narrow_phase::CollisionObjectHandle;

/// Prints the numbers of objects and pairs, and the kinds of changes that wait for the next update.
/// If `pending` is `[]`, pairs, contacts and events are up to date.
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
    /// Returns descriptions of the changes that wait for the next update.
    fn pending(&self) -> Vec<String> {
        let counts =
            [(self.objects.changes.len(), "changed objects"), (self.queued.len(), "queued events")];
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

/// A pair filter, as a function that changes no state.
type PairRule<'a, N, const D: usize, T> =
    dyn Fn(&CollisionObject<N, D, T>, &CollisionObject<N, D, T>) -> bool + 'a;

impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Checks the invariants and the set of pairs: the narrow phase must have every pair that fixed
    /// marks, groups and filters allow and whose volumes overlap, no pair that they forbid, and no
    /// pair twice. The volume of an object is its box grown by query limit and skin. Tests every
    /// pair of objects, so it is slow. Call it right after an update, since later changes wait for
    /// the next one.
    ///
    /// # Errors
    /// Returns a sentence that names the violated invariant.
    #[doc(hidden)]
    pub fn validate(&self) -> Result<(), String> {
        self.validate_with(&|_, _| true)
    }

    /// Checks the invariants of a world whose updates borrow the filter `update_filter`
    /// ([`Self::update_with`]); see [`Self::validate`].
    ///
    /// # Errors
    /// Returns a sentence that names the violated invariant.
    #[doc(hidden)]
    pub fn validate_with(&self, update_filter: &PairRule<'_, N, D, T>) -> Result<(), String> {
        self.objects.validate(&*self.broad_phase)?;
        let contacts = self.contact_pairs().map(|(a, b, _)| (a.handle(), b.handle()));
        let proximities = self.proximity_pairs().map(|(a, b, _)| (a.handle(), b.handle()));
        let mut known: Vec<_> = contacts.chain(proximities).collect();
        known.sort_unstable();
        if known.windows(2).any(|two| two[0] == two[1]) {
            return Err("a pair is known twice".to_owned());
        }
        for pair in self.expected_pairs(update_filter) {
            if known.binary_search(&pair).is_err() {
                return Err(format!("the boxes of {pair:?} meet, but the pair is not known"));
            }
        }
        match known.iter().find(|(a, b)| !self.is_allowed(*a, *b, update_filter)) {
            Some(pair) => Err(format!("{pair:?} is known, but groups or filters forbid it")),
            None => Ok(()),
        }
    }

    /// Returns the pairs that must exist: every two objects that fixed marks, groups and filters
    /// allow and whose volumes overlap, and each object with itself if the flag for its self-pair
    /// is set. Volumes do not include the margin of the broad phase.
    fn expected_pairs(
        &self,
        update_filter: &PairRule<'_, N, D, T>,
    ) -> Vec<(CollisionObjectHandle, CollisionObjectHandle)> {
        let bodies: Vec<_> = self.objects.bodies().collect();
        let alone = bodies.iter().filter(|body| body.has_self_pair());
        let mut pairs: Vec<_> = alone.map(|body| (body.handle, body.handle)).collect();
        for (index, first) in bodies.iter().enumerate() {
            let volume = self.objects.changes.volume(first);
            let overlaps =
                |second: &&WorldBody<N, D>| volume.intersects(&self.objects.changes.volume(second));
            let others = bodies[index + 1..].iter().copied().filter(overlaps);
            let allowed =
                others.filter(|second| self.is_allowed(first.handle, second.handle, update_filter));
            pairs.extend(allowed.map(|second| (first.handle, second.handle)));
        }
        pairs
    }

    /// Returns `true` if at most one of the objects is fixed, and groups and filters allow the
    /// pair. For an object with itself, returns [`WorldBody::wants_self_pair`]. `false` for a stale
    /// handle.
    fn is_allowed(
        &self,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
        update_filter: &PairRule<'_, N, D, T>,
    ) -> bool {
        if handle1 == handle2 {
            return self.objects.body(handle1.index()).is_some_and(WorldBody::wants_self_pair);
        }
        let both = self.objects.get(handle1).zip(self.objects.get(handle2));
        self.objects.can_interact(handle1.index(), handle2.index())
            && both
                .is_some_and(|(co1, co2)| self.filters.allow(co1, co2) && update_filter(co1, co2))
    }
}
