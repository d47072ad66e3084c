//! Whether a world's parts agree: for tests.

use super::bodies::WorldBody;
use super::{CollisionObject, CollisionWorld};
use crate::bounding_volume::BoundingVolume;
use crate::math::Space;
use crate::narrow_phase::CollisionObjectHandle;

/// A filter that does not change.
type PairRule<'a, N, const D: usize, T> =
    dyn Fn(&CollisionObject<N, D, T>, &CollisionObject<N, D, T>) -> bool + 'a;

impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Checks the bookkeeping, and that the narrow phase knows every pair whose boxes meet and that
    /// groups and filters allow. Looks at every pair of objects. Call it right after an update.
    ///
    /// # Errors
    /// A sentence that says what does not agree.
    #[doc(hidden)]
    pub fn validate(&self) -> Result<(), String> {
        self.validate_with(&|_, _| true)
    }

    /// [`Self::validate`] of a world whose updates are lent a filter ([`Self::update_with`]).
    ///
    /// # Errors
    /// A sentence that says what does not agree.
    #[doc(hidden)]
    pub fn validate_with(&self, lent: &PairRule<'_, N, D, T>) -> Result<(), String> {
        self.objects.validate(&*self.broad_phase)?;
        let contacts = self.contact_pairs().map(|(a, b, _)| (a.handle(), b.handle()));
        let proximities = self.proximity_pairs().map(|(a, b, _)| (a.handle(), b.handle()));
        let mut known: Vec<_> = contacts.chain(proximities).collect();
        known.sort_unstable();
        if known.windows(2).any(|two| two[0] == two[1]) {
            return Err("a pair is known twice".to_owned());
        }
        for pair in self.expected_pairs(lent) {
            if known.binary_search(&pair).is_err() {
                return Err(format!("the boxes of {pair:?} meet, but the pair is not known"));
            }
        }
        match known.iter().find(|(a, b)| !self.is_allowed(*a, *b, lent)) {
            Some(pair) => Err(format!("{pair:?} is known, but groups or filters forbid it")),
            None => Ok(()),
        }
    }

    /// The allowed pairs whose volumes meet.
    fn expected_pairs(
        &self,
        lent: &PairRule<'_, N, D, T>,
    ) -> Vec<(CollisionObjectHandle, CollisionObjectHandle)> {
        let bodies: Vec<_> = self.objects.bodies().collect();
        let alone = bodies.iter().filter(|body| body.has_self_pair());
        let mut pairs: Vec<_> = alone.map(|body| (body.handle, body.handle)).collect();
        for (place, first) in bodies.iter().enumerate() {
            let volume = self.objects.changes.volume(first);
            let meets =
                |second: &&WorldBody<N, D>| volume.intersects(&self.objects.changes.volume(second));
            let others = bodies[place + 1..].iter().copied().filter(meets);
            let allowed =
                others.filter(|second| self.is_allowed(first.handle, second.handle, lent));
            pairs.extend(allowed.map(|second| (first.handle, second.handle)));
        }
        pairs
    }

    /// Groups and filters allow the pair.
    fn is_allowed(
        &self,
        handle1: CollisionObjectHandle,
        handle2: CollisionObjectHandle,
        lent: &PairRule<'_, N, D, T>,
    ) -> bool {
        if handle1 == handle2 {
            return self.objects.body(handle1.index()).is_some_and(WorldBody::wants_self_pair);
        }
        let both = self.objects.get(handle1).zip(self.objects.get(handle2));
        self.objects.can_interact(handle1.index(), handle2.index())
            && both.is_some_and(|(co1, co2)| self.filters.allow(co1, co2) && lent(co1, co2))
    }
}
