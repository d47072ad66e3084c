//! The user's filters of pairs that the broad phase finds.

use core::any::Any;
use core::fmt;
use std::panic::{AssertUnwindSafe, catch_unwind, resume_unwind};
use std::sync::Arc;

use super::error::or_panic;
use super::{CollisionObject, CollisionWorld, WorldError};
use crate::math::Space;
use crate::memory::clone_fields;
use crate::narrow_phase::CollisionObjectHandle;

/// Decides which pairs may exist.
///
/// An update calls a filter only for a pair whose loosened boxes overlap, whose groups allow it and
/// of which at most one object is fixed. It calls the filter when the boxes begin to overlap, and
/// when the pair is filtered again. All filters of a world must return `true` for the pair to
/// exist. The result for a pair must not change until the filter is registered again or the pairs
/// are filtered again ([`CollisionWorld::refilter_pairs_of`]).
///
/// If a filter panics, the update calls no filter any more, leaves the pairs without an answer as
/// they were, and ends; then the panic goes on to the caller of the update. The next update filters
/// these pairs again, so no pair and no event is lost.
///
/// Implement the trait of the same name in [`crate::dim2::world`] or [`crate::dim3::world`], which
/// fixes the dimension. Closures over two references to objects implement these traits.
///
/// ```
/// use impinge::dim2::world::{CollisionObject, CollisionWorld};
///
/// type Object = CollisionObject<f32, &'static str>;
/// let mut world = CollisionWorld::<f32, &str>::new(0.02);
/// world.register_broad_phase_pair_filter("teams", |a: &Object, b: &Object| a.data() != b.data());
/// world.unregister_broad_phase_pair_filter("teams");
/// ```
pub trait BroadPhasePairFilter<N: Space<D>, const D: usize, T>: Send + Sync {
    /// Returns `true` if the two objects may interact. The handle of `co1` is smaller than the
    /// handle of `co2`.
    fn is_pair_valid(&self, co1: &CollisionObject<N, D, T>, co2: &CollisionObject<N, D, T>)
    -> bool;
}

type NamedFilter<N, const D: usize, T> = (String, Arc<dyn BroadPhasePairFilter<N, D, T>>);

/// The filters of a world, sorted by name.
pub(super) struct Filters<N: Space<D>, const D: usize, T> {
    filters: Vec<NamedFilter<N, D, T>>,
    /// Whether a filter was registered or unregistered since the last update.
    have_changed: bool,
}

clone_fields!([N: Space<D>, const D: usize, T] Filters<N, D, T> { filters, have_changed });

impl<N: Space<D>, const D: usize, T> Filters<N, D, T> {
    pub(super) const fn new() -> Self {
        Self { filters: Vec::new(), have_changed: false }
    }

    /// Registers a filter under a name; replaces an earlier filter with the same name.
    pub(super) fn register(&mut self, name: &str, filter: Arc<dyn BroadPhasePairFilter<N, D, T>>) {
        self.have_changed = true;
        match self.position(name) {
            Ok(index) => self.filters[index].1 = filter,
            Err(index) => self.filters.insert(index, (name.to_owned(), filter)),
        }
    }

    /// Removes the filter with this name; returns `false` if there is none.
    pub(super) fn unregister(&mut self, name: &str) -> bool {
        let index = self.position(name);
        if let Ok(index) = index {
            self.filters.remove(index);
            self.have_changed = true;
        }
        index.is_ok()
    }

    fn position(&self, name: &str) -> Result<usize, usize> {
        self.filters.binary_search_by(|(other, _)| other.as_str().cmp(name))
    }

    /// Returns `true` if all filters allow the pair.
    pub(super) fn allow(
        &self,
        co1: &CollisionObject<N, D, T>,
        co2: &CollisionObject<N, D, T>,
    ) -> bool {
        self.filters.iter().all(|(_, filter)| filter.is_pair_valid(co1, co2))
    }

    /// Returns the names, sorted, of the filters that refuse the pair.
    pub(super) fn refusing(
        &self,
        co1: &CollisionObject<N, D, T>,
        co2: &CollisionObject<N, D, T>,
    ) -> Vec<&str> {
        let refusing = self.filters.iter().filter(|(_, filter)| !filter.is_pair_valid(co1, co2));
        refusing.map(|(name, _)| name.as_str()).collect()
    }

    /// Iterates over the names of the filters, sorted.
    pub(super) fn names(&self) -> impl Iterator<Item = &str> {
        self.filters.iter().map(|(name, _)| name.as_str())
    }

    /// Clears the flag of changed filters, at the end of an update.
    pub(super) const fn note_update(&mut self) {
        self.have_changed = false;
    }

    /// Restores whether a filter was registered or unregistered since the last update.
    #[cfg(feature = "serde")]
    pub(super) const fn note_change(&mut self, have_changed: bool) {
        self.have_changed = have_changed;
    }

    pub(super) const fn have_changed(&self) -> bool {
        self.have_changed
    }

    pub(super) fn is_empty(&self) -> bool {
        self.filters.is_empty()
    }
}

/// A pair filter of the caller, borrowed for one update.
pub(super) type UpdateFilter<'a, N, const D: usize, T> =
    &'a mut dyn FnMut(&CollisionObject<N, D, T>, &CollisionObject<N, D, T>) -> bool;

/// The calls of filters in one update.
///
/// A panic of a filter must not leave the update half done: the object table and the broad phase
/// would hold changes of which the narrow phase never hears. So the panic is caught, the update
/// runs to its end without filters, and [`Self::finish`] lets the panic go on.
pub(super) struct Filtering<'a, N: Space<D>, const D: usize, T> {
    filter: Option<UpdateFilter<'a, N, D, T>>,
    /// The payload of the first panic.
    panic: Option<Box<dyn Any + Send>>,
    /// The first object of each pair that no filter has decided on since the panic.
    undecided: Vec<CollisionObjectHandle>,
}

impl<'a, N: Space<D>, const D: usize, T> Filtering<'a, N, D, T> {
    /// Begins an update with an additional filter.
    pub(super) const fn new(filter: Option<UpdateFilter<'a, N, D, T>>) -> Self {
        Self { filter, panic: None, undecided: Vec::new() }
    }

    /// Returns `true` if no filter restricts the pairs of this update.
    pub(super) fn allows_all(&self, filters: &Filters<N, D, T>) -> bool {
        filters.is_empty() && self.filter.is_none()
    }

    /// Returns `true` if all filters allow the pair; `None` if one of them panics, or has panicked
    /// in this update.
    pub(super) fn allow(
        &mut self,
        filters: &Filters<N, D, T>,
        co1: &CollisionObject<N, D, T>,
        co2: &CollisionObject<N, D, T>,
    ) -> Option<bool> {
        let Self { filter, panic, undecided } = self;
        let mut decide =
            || filters.allow(co1, co2) && filter.as_mut().is_none_or(|filter| filter(co1, co2));
        if panic.is_none() {
            // The panic goes on, so the caller sees whatever state his filter has left behind.
            match catch_unwind(AssertUnwindSafe(&mut decide)) {
                Ok(is_allowed) => return Some(is_allowed),
                Err(payload) => *panic = Some(payload),
            }
        }
        undecided.push(co1.handle());
        None
    }

    /// Ends the update. If a filter panicked, makes the next update filter the undecided pairs, and
    /// lets the panic go on.
    pub(super) fn finish(self, world: &mut CollisionWorld<N, D, T>) {
        let Some(payload) = self.panic else { return };
        for handle in self.undecided {
            world.refilter_pairs_of(handle);
        }
        resume_unwind(payload)
    }
}

impl<N: Space<D>, const D: usize, T> fmt::Debug for Filters<N, D, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_list().entries(self.filters.iter().map(|(name, _)| name)).finish()
    }
}

/// Registering filters, and filtering pairs again.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Registers a pair filter; replaces an earlier filter with the same name. All pairs are
    /// filtered again at the next update.
    pub fn register_broad_phase_pair_filter<F>(&mut self, name: &str, filter: F)
    where
        F: BroadPhasePairFilter<N, D, T> + 'static,
    {
        self.filters.register(name, Arc::new(filter));
        self.broad_phase.deferred_recompute_all_proximities();
    }

    /// Removes the pair filter with this name; does nothing if there is none. All pairs are
    /// filtered again at the next update.
    pub fn unregister_broad_phase_pair_filter(&mut self, name: &str) {
        if self.filters.unregister(name) {
            self.broad_phase.deferred_recompute_all_proximities();
        }
    }

    /// Makes the next update filter all pairs again: it tests groups and filters for every two
    /// objects whose boxes overlap. Call this when the rules of a filter have changed, also of a
    /// filter of [`Self::update_with`].
    pub fn refilter_pairs(&mut self) {
        self.broad_phase.deferred_recompute_all_proximities();
    }

    /// Makes the next update filter the pairs of an object again; see [`Self::refilter_pairs`].
    ///
    /// ```
    /// use impinge::dim2::math::Isometry;
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{
    ///     CollisionGroups, CollisionObject, CollisionWorld, ContactQuery,
    /// };
    ///
    /// let mut world = CollisionWorld::new(0.02_f32);
    /// let (ball, groups) = (ShapeHandle::new(Ball::new(1.0)), CollisionGroups::new());
    /// let [_, ghost] = [true, false].map(|is_solid| {
    ///     world.add(Isometry::identity(), ball.clone(), groups, ContactQuery::default(), is_solid)
    /// });
    /// type Object = CollisionObject<f32, bool>;
    /// let both_solid = |a: &Object, b: &Object| *a.data() && *b.data();
    /// world.register_broad_phase_pair_filter("solid", both_solid);
    /// world.update();
    /// *world.collision_object_mut(ghost).expect("alive").data_mut() = true;
    /// world.refilter_pairs_of(ghost);
    /// world.update();
    /// assert_eq!(world.contact_events().len(), 1, "now it is solid");
    /// ```
    ///
    /// # Panics
    /// If the handle is stale; [`Self::try_refilter_pairs_of`] returns an error instead.
    #[track_caller]
    pub fn refilter_pairs_of(&mut self, handle: CollisionObjectHandle) {
        or_panic(self.try_refilter_pairs_of(handle));
    }

    /// Makes the next update filter the pairs of an object again; see [`Self::refilter_pairs_of`].
    ///
    /// # Errors
    /// If the handle is stale. The world is unchanged then.
    pub fn try_refilter_pairs_of(
        &mut self,
        handle: CollisionObjectHandle,
    ) -> Result<(), WorldError> {
        let (body, changes) = self.objects.body_mut(handle)?;
        body.refilter(changes);
        Ok(())
    }
}
