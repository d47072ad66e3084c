//! The naive collision world: every update computes every pair and compares it with its state at
//! the previous update.
//!
//! Rules:
//!
//! - A handle is an index and a generation. The index of a removed object is used again, the one
//!   freed last first, with the next generation. While no index is free, the next index is the
//!   number of slots.
//! - A pair may interact if at least one object is not fixed, the groups allow it and all filters
//!   accept it. Filters get the two indices, that of the smaller handle first, and are called only
//!   for pairs that the groups allow.
//! - If both objects query contacts, the pair touches if the signed distance is finite and at most
//!   the sum of the predictions. Solids that overlap without bound have no contact points.
//! - If at least one object queries proximity, only the proximity is computed. It is intersecting
//!   if the signed distance is at most zero, within margin if the distance is at most the sum of
//!   the margins, and otherwise disjoint. An object that queries contacts has margin zero.
//! - An update returns the differences from the previous update, whether a motion caused them or a
//!   change of a shape, groups, a query type or a filter. A pair that changes from contacts to
//!   proximity stops touching, and its proximity starts as disjoint.
//! - The removal of an object ends its pairs at once, with the state of the last update: touching
//!   pairs stop, pairs that are not disjoint become disjoint. These events come first at the next
//!   update. An object that is added and removed between two updates has no events.
//! - One pair can be computed between two updates, at the current poses, with the shapes and query
//!   types of the last update. The next update reports this change first, and its other changes
//!   relative to it.
//! - The skins of both objects add to the prediction of a pair with contacts.
//! - Changes have no effect on events and pair states before the next update. Queries use them at
//!   once.
//! - Angular predictions only add contact points, so they are not modelled. Neither is
//!   self-collision.

mod events;
mod groups;
mod shape;

pub use events::{ContactEvent, Events, Proximity, ProximityEvent};
pub use groups::{ALL, Groups};
pub use shape::{Shape, Union};

use crate::geometry::vector::{norm, sub};
use crate::geometry::{Pose, Solid};
use events::PairState;
use std::collections::{BTreeMap, BTreeSet};

/// The id of an object; it is never used again for another object.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Handle {
    /// The index of the slot, which is used again after a removal.
    pub index: usize,
    /// The number of earlier objects in the slot.
    pub generation: u32,
}

/// The error of a handle whose object was removed, or that occurs twice in a removal. The world is
/// unchanged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct StaleHandle(pub Handle);

/// The query type of an object: what is computed for its pairs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum QueryType {
    /// Contact points; the distance limit of a pair is the sum of both predictions.
    Contacts(f64),
    /// The proximity; the margin of a pair is the sum of both margins.
    Proximity(f64),
}

/// One object of the world.
#[derive(Clone, Debug)]
pub struct Object<const D: usize, S> {
    /// The handle of the object.
    pub handle: Handle,
    /// The number of objects added before this one, removed ones included.
    pub order: u64,
    /// The current pose.
    pub pose: Pose<D>,
    /// The shape, in its local frame.
    pub shape: S,
    /// The collision groups.
    pub groups: Groups,
    /// The query type of its pairs.
    pub query_type: QueryType,
    /// Whether the object is fixed: fixed objects do not interact with each other.
    pub is_fixed: bool,
    /// The distance that is added to the prediction of pairs with contacts.
    pub skin: f64,
}

type Filter = Box<dyn Fn(usize, usize) -> bool>;

/// The naive collision world; the module states its rules. By default a shape is one convex solid.
pub struct NaiveWorld<const D: usize, S = Solid<D>> {
    slots: Vec<Slot<D, S>>,
    /// The free indices, the one freed last at the end.
    free: Vec<usize>,
    added: u64,
    filters: BTreeMap<String, Filter>,
    /// The states of the pairs that were not in the default state when they were last computed.
    states: BTreeMap<(Handle, Handle), PairState>,
    /// The events of removals and of computed pairs since the last update.
    queued: Events,
    /// The objects as they were at the last update.
    updated: BTreeMap<Handle, Object<D, S>>,
}

/// A slot of the table of objects.
#[derive(Debug)]
struct Slot<const D: usize, S> {
    generation: u32,
    object: Option<Object<D, S>>,
}

impl<const D: usize, S> std::fmt::Debug for NaiveWorld<D, S> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        let count = self.slots.len() - self.free.len();
        f.debug_struct("NaiveWorld").field("objects", &count).finish_non_exhaustive()
    }
}

impl<const D: usize, S: Shape<D>> Default for NaiveWorld<D, S> {
    fn default() -> Self {
        Self::new()
    }
}

/// Methods that add, remove and change objects.
impl<const D: usize, S: Shape<D>> NaiveWorld<D, S> {
    /// Creates an empty world.
    #[must_use]
    pub fn new() -> Self {
        Self {
            slots: Vec::new(),
            free: Vec::new(),
            added: 0,
            filters: BTreeMap::new(),
            states: BTreeMap::new(),
            queued: Events::default(),
            updated: BTreeMap::new(),
        }
    }

    /// Adds an object and returns its handle.
    pub fn add(
        &mut self,
        pose: Pose<D>,
        shape: S,
        groups: Groups,
        query_type: QueryType,
    ) -> Handle {
        let index = self.free.pop().unwrap_or(self.slots.len());
        if index == self.slots.len() {
            self.slots.push(Slot { generation: 0, object: None });
        }
        let handle = Handle { index, generation: self.slots[index].generation };
        let order = self.added;
        self.added += 1;
        let (is_fixed, skin) = (false, 0.0);
        let object = Object { handle, order, pose, shape, groups, query_type, is_fixed, skin };
        self.slots[index].object = Some(object);
        handle
    }

    /// Removes objects; their indices become free in the order of the list.
    ///
    /// # Errors
    /// The first handle that is stale or repeated; no object is removed then.
    pub fn remove(&mut self, handles: &[Handle]) -> Result<(), StaleHandle> {
        for (k, &handle) in handles.iter().enumerate() {
            if self.object(handle).is_none() || handles[..k].contains(&handle) {
                return Err(StaleHandle(handle));
            }
        }
        let gone = |pair: &(Handle, Handle)| handles.contains(&pair.0) || handles.contains(&pair.1);
        for (&pair, &state) in self.states.iter().filter(|(pair, _)| gone(pair)) {
            self.queued.push_change(pair, state, PairState::default());
        }
        self.states.retain(|pair, _| !gone(pair));
        for &handle in handles {
            let slot = &mut self.slots[handle.index];
            slot.object = None;
            slot.generation += 1;
            self.free.push(handle.index);
        }
        Ok(())
    }

    /// Returns the object of a handle; `None` if the handle is stale.
    #[must_use]
    pub fn object(&self, handle: Handle) -> Option<&Object<D, S>> {
        let object = self.slots.get(handle.index)?.object.as_ref()?;
        (object.handle == handle).then_some(object)
    }

    /// Returns all objects, sorted by handle.
    pub fn objects(&self) -> impl Iterator<Item = &Object<D, S>> {
        self.slots.iter().filter_map(|slot| slot.object.as_ref())
    }

    /// Moves an object.
    ///
    /// # Errors
    /// If the handle is stale.
    pub fn set_position(&mut self, handle: Handle, pose: Pose<D>) -> Result<(), StaleHandle> {
        self.object_mut(handle).map(|object| object.pose = pose)
    }

    /// Gives an object another shape.
    ///
    /// # Errors
    /// If the handle is stale.
    pub fn set_shape(&mut self, handle: Handle, shape: S) -> Result<(), StaleHandle> {
        self.object_mut(handle).map(|object| object.shape = shape)
    }

    /// Gives an object other groups.
    ///
    /// # Errors
    /// If the handle is stale.
    pub fn set_groups(&mut self, handle: Handle, groups: Groups) -> Result<(), StaleHandle> {
        self.object_mut(handle).map(|object| object.groups = groups)
    }

    /// Gives an object another query type.
    ///
    /// # Errors
    /// If the handle is stale.
    pub fn set_query_type(&mut self, handle: Handle, query: QueryType) -> Result<(), StaleHandle> {
        self.object_mut(handle).map(|object| object.query_type = query)
    }

    /// Marks an object as fixed, or as not fixed.
    ///
    /// # Errors
    /// If the handle is stale.
    pub fn set_fixed(&mut self, handle: Handle, is_fixed: bool) -> Result<(), StaleHandle> {
        self.object_mut(handle).map(|object| object.is_fixed = is_fixed)
    }

    /// Gives an object another skin.
    ///
    /// # Errors
    /// If the handle is stale.
    pub fn set_skin(&mut self, handle: Handle, skin: f64) -> Result<(), StaleHandle> {
        self.object_mut(handle).map(|object| object.skin = skin)
    }

    fn object_mut(&mut self, handle: Handle) -> Result<&mut Object<D, S>, StaleHandle> {
        let object = self.slots.get_mut(handle.index).and_then(|slot| slot.object.as_mut());
        object.filter(|object| object.handle == handle).ok_or(StaleHandle(handle))
    }

    /// Adds a filter of pairs; it replaces a filter of the same name.
    pub fn register_filter(&mut self, name: &str, filter: impl Fn(usize, usize) -> bool + 'static) {
        self.filters.insert(name.to_owned(), Box::new(filter));
    }

    /// Removes the filter of a name; returns whether it existed.
    pub fn unregister_filter(&mut self, name: &str) -> bool {
        self.filters.remove(name).is_some()
    }
}

/// Methods about pairs and events.
impl<const D: usize, S: Shape<D> + Clone> NaiveWorld<D, S> {
    /// Computes all pairs and returns the differences from the previous update.
    pub fn update(&mut self) -> Events {
        let mut events = std::mem::take(&mut self.queued);
        events.close_removals();
        let before = std::mem::take(&mut self.states);
        self.states = self.compute_states();
        let pairs: BTreeSet<_> = before.keys().chain(self.states.keys()).copied().collect();
        for pair in pairs {
            let state = |states: &BTreeMap<_, _>| states.get(&pair).copied().unwrap_or_default();
            events.push_change(pair, state(&before), state(&self.states));
        }
        self.updated = self.objects().map(|object| (object.handle, object.clone())).collect();
        events
    }

    /// Computes the pair of two objects, the smaller handle first, at their current poses. Both
    /// must have been in the world, and allowed to interact, at the last update. The next update
    /// returns the events.
    ///
    /// # Errors
    /// The first handle that is stale, or whose object was added after the last update.
    pub fn update_pair(&mut self, handle1: Handle, handle2: Handle) -> Result<(), StaleHandle> {
        let moved = |handle: Handle| {
            let object = self.object(handle).zip(self.updated.get(&handle));
            let (now, then) = object.ok_or(StaleHandle(handle))?;
            Ok(Object { pose: now.pose, ..then.clone() })
        };
        let (pair, objects) = ((handle1, handle2), (moved(handle1)?, moved(handle2)?));
        let (before, after) =
            (self.states.remove(&pair), self.compute_interaction(&objects.0, &objects.1));
        self.queued.push_change(pair, before.unwrap_or_default(), after);
        if after != PairState::default() {
            self.states.insert(pair, after);
        }
        Ok(())
    }

    /// Returns the pairs that had contact points when they were last computed, sorted, the smaller
    /// handle first.
    #[must_use]
    pub fn touching_pairs(&self) -> Vec<(Handle, Handle)> {
        self.states.iter().filter(|(_, state)| state.touching).map(|(&pair, _)| pair).collect()
    }

    /// Returns the pairs that were not disjoint when they were last computed, sorted, the smaller
    /// handle first. Pairs of two objects that query contacts have no proximity.
    #[must_use]
    pub fn close_pairs(&self) -> Vec<(Handle, Handle, Proximity)> {
        let close = self.states.iter().filter(|(_, state)| state.proximity != Proximity::Disjoint);
        close.map(|(&(handle1, handle2), state)| (handle1, handle2, state.proximity)).collect()
    }

    /// Whether groups, filters and fixed flags allow a pair.
    #[must_use]
    pub fn is_allowed(&self, object1: &Object<D, S>, object2: &Object<D, S>) -> bool {
        let uids = (object1.handle.index, object2.handle.index);
        !(object1.is_fixed && object2.is_fixed)
            && object1.groups.can_interact(object2.groups)
            && self.filters.values().all(|filter| filter(uids.0, uids.1))
    }

    /// Returns the signed distance of two objects at their current poses.
    #[must_use]
    pub fn signed_distance(&self, object1: &Object<D, S>, object2: &Object<D, S>) -> f64 {
        object1.shape.signed_distance(&object1.pose, &object2.shape, &object2.pose)
    }

    fn compute_states(&self) -> BTreeMap<(Handle, Handle), PairState> {
        let objects: Vec<&Object<D, S>> = self.objects().collect();
        let mut states = BTreeMap::new();
        for (k, object1) in objects.iter().enumerate() {
            for object2 in &objects[k + 1..] {
                let state = self.compute_state(object1, object2);
                if state != PairState::default() {
                    states.insert((object1.handle, object2.handle), state);
                }
            }
        }
        states
    }

    fn compute_state(&self, object1: &Object<D, S>, object2: &Object<D, S>) -> PairState {
        if self.is_allowed(object1, object2) {
            self.compute_interaction(object1, object2)
        } else {
            PairState::default()
        }
    }

    /// Computes the state of a pair that is allowed.
    fn compute_interaction(&self, object1: &Object<D, S>, object2: &Object<D, S>) -> PairState {
        use QueryType::{Contacts, Proximity};
        let mut state = PairState::default();
        let query_types = (object1.query_type, object2.query_type);
        let margin = match query_types {
            (Contacts(prediction1), Contacts(prediction2)) => {
                prediction1 + prediction2 + object1.skin + object2.skin
            }
            (Proximity(margin1), Proximity(margin2)) => margin1 + margin2,
            (Proximity(margin), Contacts(_)) | (Contacts(_), Proximity(margin)) => margin,
        };
        if is_far(object1, object2, margin) {
            return state;
        }
        let distance = self.signed_distance(object1, object2);
        if let (Contacts(_), Contacts(_)) = query_types {
            state.touching = distance.is_finite() && distance <= margin;
        } else {
            state.proximity = classify(distance, margin);
        }
        state
    }
}

/// Whether the bounding balls of two objects are so far apart that the exact distance is not
/// needed. A result of `false` is always correct, but costs time.
fn is_far<const D: usize, S: Shape<D>>(
    object1: &Object<D, S>,
    object2: &Object<D, S>,
    margin: f64,
) -> bool {
    let between = norm(&sub(&object2.pose.translation, &object1.pose.translation));
    let reach = object1.shape.bounding_radius() + object2.shape.bounding_radius() + margin;
    // One percent is far more than all rounding errors.
    between > 1.01 * reach
}

fn classify(distance: f64, margin: f64) -> Proximity {
    if distance <= 0.0 {
        Proximity::Intersecting
    } else if distance <= margin {
        Proximity::WithinMargin
    } else {
        Proximity::Disjoint
    }
}

/// Queries. They use the current state of the objects, not that of the last update; results are
/// sorted by handle.
impl<const D: usize, S: Shape<D>> NaiveWorld<D, S> {
    /// Returns the objects that can interact with `groups` and that a ray hits, with the times of
    /// the hits.
    #[must_use]
    pub fn interferences_with_ray(
        &self,
        origin: &[f64; D],
        direction: &[f64; D],
        groups: Groups,
    ) -> Vec<(Handle, f64)> {
        let hit = |object: &Object<D, S>| {
            Some((object.handle, object.shape.ray_cast(&object.pose, origin, direction)?))
        };
        self.able(groups).filter_map(hit).collect()
    }

    /// Returns the objects that can interact with `groups` and that contain a point.
    #[must_use]
    pub fn interferences_with_point(&self, point: &[f64; D], groups: Groups) -> Vec<Handle> {
        let holds = |object: &&Object<D, S>| object.shape.contains_point(&object.pose, point);
        self.able(groups).filter(holds).map(|object| object.handle).collect()
    }

    /// Returns the objects that can interact with `groups` and whose boxes overlap or touch the box
    /// with these corners.
    #[must_use]
    pub fn interferences_with_aabb(
        &self,
        least: &[f64; D],
        greatest: &[f64; D],
        groups: Groups,
    ) -> Vec<Handle> {
        let meets = |object: &&Object<D, S>| {
            let (low, high) = object.shape.aabb(&object.pose);
            (0..D).all(|i| low[i] <= greatest[i] && least[i] <= high[i])
        };
        self.able(groups).filter(meets).map(|object| object.handle).collect()
    }

    fn able(&self, groups: Groups) -> impl Iterator<Item = &Object<D, S>> {
        self.objects().filter(move |object| object.groups.can_interact(groups))
    }
}

#[cfg(test)]
mod tests;
