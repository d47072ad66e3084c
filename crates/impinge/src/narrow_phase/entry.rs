//! Entries: the state of a pair for each combination of algorithm (built-in or custom) and query.
//!
//! The public manifold of a pair is built on first access, in the memory of the previous manifold,
//! and becomes out of date at the next update.

use core::fmt;
use std::sync::{Mutex, OnceLock, PoisonError};

use super::group::PairKey;
use super::state::{KeptContacts, Posed, proximity_of};
use super::traits::{
    ContactAlgorithm, ContactDispatcher, ContactPrediction, ProximityAlgorithm, ProximityDispatcher,
};
use super::{IdAllocator, ObjectTable};
use crate::collide::ManifoldRequest;
use crate::math::{Real, Space};
use crate::memory::clone_fields;
use crate::query::Proximity;

/// A change of a pair's status, which an update or the end of the pair reports as an event.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Change {
    /// The pair got its first contact point or lost its last.
    Contact { touching: bool },
    /// The proximity changed from the first value to the second value.
    Proximity(Proximity, Proximity),
}

/// Returns the two solids of a pair, as of the last update.
pub(crate) fn posed<N: Space<D>, const D: usize>(
    table: &ObjectTable<N, D>,
    [first, second]: PairKey,
) -> Posed<'_, N, D> {
    Posed {
        pose1: table.pose(first),
        shape1: table.shape(first).as_ref(),
        pose2: table.pose(second),
        shape2: table.shape(second).as_ref(),
        bounds: [table.bounds(first), table.bounds(second)],
        is_self: first == second,
    }
}

/// The last proximity of a pair. Each change of the proximity is reported as an event.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Status(pub(crate) Proximity);

impl Status {
    fn set(&mut self, new: Proximity) -> Option<Change> {
        let old = core::mem::replace(&mut self.0, new);
        (old != new).then_some(Change::Proximity(old, new))
    }

    /// Returns the change to `Disjoint` when the pair ends; `None` if it was disjoint.
    pub(crate) fn end(mut self) -> Option<Change> {
        self.set(Proximity::Disjoint)
    }
}

/// Contacts of a pair, computed by the library's own algorithm. Fields that readers need come
/// first, so that a reader of few contacts loads only the first cache lines.
#[derive(Debug)]
#[repr(C)]
pub(crate) struct ContactEntry<N: Real, S> {
    /// Identifier of the pair: the first half of its contact ids.
    pub(crate) number: u64,
    pub(crate) state: S,
    pub(crate) request: ManifoldRequest<N>,
}

clone_fields!([N: Real, S: Clone] ContactEntry<N, S> { number, state, request });

/// The manifolds of a pair in their public form, built on first access after an update.
#[derive(Debug)]
pub(crate) struct ContactView<M> {
    manifolds: OnceLock<M>,
    /// The manifolds of an earlier update, kept for their memory. Locked only while new manifolds
    /// are built.
    old: Mutex<M>,
}

impl<M: Default> Default for ContactView<M> {
    fn default() -> Self {
        Self { manifolds: OnceLock::new(), old: Mutex::default() }
    }
}

impl<M: Clone + Default> Clone for ContactView<M> {
    fn clone(&self) -> Self {
        Self { manifolds: self.manifolds.clone(), old: Mutex::default() }
    }
}

impl<M: Default> ContactView<M> {
    /// Marks the manifolds as out of date; keeps their memory.
    pub(super) fn expire(&mut self) {
        if let Some(manifolds) = self.manifolds.take() {
            *self.old.get_mut().unwrap_or_else(PoisonError::into_inner) = manifolds;
        }
    }

    /// Returns the manifolds. On first access after an update, `make` builds them, in the memory of
    /// the old manifolds that it receives.
    pub(crate) fn manifolds(&self, make: impl FnOnce(M) -> M) -> &M {
        self.manifolds.get_or_init(|| {
            let mut old = self.old.lock().unwrap_or_else(PoisonError::into_inner);
            make(core::mem::take(&mut *old))
        })
    }
}

impl<M: Default> ContactView<M> {
    /// Marks the manifolds of a view as out of date; does nothing if `view` is `None`, as in a
    /// group without views.
    #[inline]
    pub(crate) fn expire_any(view: Option<&mut Self>) {
        if let Some(view) = view {
            view.expire();
        }
    }
}

impl<N: Real, S> ContactEntry<N, S> {
    pub(crate) fn new<const D: usize>(request: ManifoldRequest<N>, number: u64) -> Self
    where
        S: KeptContacts<N, D>,
    {
        Self { request, number, state: S::default() }
    }

    /// Updates the contacts, and marks the view as out of date; returns `true` if there is at least
    /// one contact.
    pub(crate) fn update<const D: usize>(
        &mut self,
        view: Option<&mut ContactView<S::Manifolds>>,
        posed: &Posed<'_, N, D>,
    ) -> bool
    where
        S: KeptContacts<N, D>,
    {
        ContactView::expire_any(view);
        self.state.update(posed, &self.request);
        self.is_touching()
    }

    /// Returns `true` if there is at least one contact.
    #[inline]
    pub(crate) fn is_touching<const D: usize>(&self) -> bool
    where
        S: KeptContacts<N, D>,
    {
        self.state.len() > 0
    }
}

/// Proximity of a pair, computed by the library's own algorithm.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ProximityEntry<N: Real> {
    pub(crate) margin: N,
    pub(crate) status: Status,
}

impl<N: Real> ProximityEntry<N> {
    /// Updates the proximity and returns its change; `None` if it is the same as before.
    pub(crate) fn update<const D: usize>(&mut self, posed: &Posed<'_, N, D>) -> Option<Change>
    where
        N: Space<D>,
    {
        self.status.set(proximity_of(posed, self.margin))
    }
}

/// Contacts of a pair, computed by a custom algorithm.
#[derive(Clone)]
pub(crate) struct CustomContactEntry<N: Space<D>, const D: usize> {
    pub(crate) algorithm: ContactAlgorithm<N, D>,
    pub(crate) prediction: ContactPrediction<N>,
}

impl<N: Space<D>, const D: usize> CustomContactEntry<N, D> {
    /// Updates the contacts; returns `true` if there is at least one.
    pub(crate) fn update(
        &mut self,
        dispatcher: &dyn ContactDispatcher<N, D>,
        table: &ObjectTable<N, D>,
        [first, second]: PairKey,
        ids: &mut IdAllocator,
    ) -> bool {
        let able = self.algorithm.update(
            dispatcher,
            table.isometry(first),
            table.shape(first).as_ref(),
            table.isometry(second),
            table.shape(second).as_ref(),
            &self.prediction,
            ids,
        );
        able && self.algorithm.num_contacts() > 0
    }
}

impl<N: Space<D>, const D: usize> fmt::Debug for CustomContactEntry<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CustomContactEntry").finish_non_exhaustive()
    }
}

/// Proximity of a pair, computed by a custom algorithm.
#[derive(Clone)]
pub(crate) struct CustomProximityEntry<N: Space<D>, const D: usize> {
    pub(crate) algorithm: ProximityAlgorithm<N, D>,
    pub(crate) margin: N,
    pub(crate) status: Status,
}

impl<N: Space<D>, const D: usize> CustomProximityEntry<N, D> {
    /// Updates the proximity and returns its change; `None` if it is the same as before.
    pub(crate) fn update(
        &mut self,
        dispatcher: &dyn ProximityDispatcher<N, D>,
        table: &ObjectTable<N, D>,
        [first, second]: PairKey,
    ) -> Option<Change> {
        let able = self.algorithm.update(
            dispatcher,
            table.isometry(first),
            table.shape(first).as_ref(),
            table.isometry(second),
            table.shape(second).as_ref(),
            self.margin,
        );
        self.status.set(if able { self.algorithm.proximity() } else { Proximity::Disjoint })
    }
}

impl<N: Space<D>, const D: usize> fmt::Debug for CustomProximityEntry<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("CustomProximityEntry").field("status", &self.status).finish_non_exhaustive()
    }
}
