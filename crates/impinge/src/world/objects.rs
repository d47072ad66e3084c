//! The objects of a world: handle slots, records, the list of changes, and the table for the narrow
//! phase.

use super::bodies::{MAX_CHANGES, WorldBody, WorldBroadPhase};
use super::changes::{BodyEntry, ChangeList, ChangeTargets};
use super::dirty::DirtyTree;
use super::entries;
use super::fork::{KeptObject, ObjectNote};
use super::{CollisionGroups, CollisionObject, WorldError};
use crate::bounding_volume::Aabb;
use crate::broad_phase::ProxyHandle;
use crate::generation::Generation;
use crate::journal::Journal;
use crate::math::Space;
use crate::memory::{Look, clone_fields};
use crate::narrow_phase::{CollisionObjectHandle, GeometricQueryType, ObjectRow, ObjectTable};
use crate::shape::ShapeHandle;

/// If at least one object in `DIRTY_RATIO` is dirty, the dirty tree holds the boxes of all objects.
const DIRTY_RATIO: usize = 4;

/// The objects of a world, by handle.
///
/// A free index is reused under the next generation; the last freed index is reused first. An index
/// whose generations are exhausted is not reused.
///
/// ```
/// use impinge::dim2::world::{CollisionObject, CollisionObjects};
///
/// // A function for custom filters and narrow phases; this one counts objects with a name.
/// fn named(objects: &CollisionObjects<f32, String>) -> usize {
///     objects.iter().filter(|object: &&CollisionObject<f32, String>| !object.data().is_empty()).count()
/// }
/// # let _ = named;
/// ```
pub struct CollisionObjects<N: Space<D>, const D: usize, T> {
    /// Generation of the first object at each index.
    pub(super) first: Generation,
    pub(super) slots: Vec<Slot>,
    /// The objects, without gaps and in unspecified order. The check for a stale handle reads only
    /// the slot, so code that merely passes on a reference does not wait for the record to be
    /// loaded.
    pub(super) records: Vec<CollisionObject<N, D, T>>,
    /// Free handle indices; the last one in the list is used next.
    pub(super) free: Vec<u32>,
    pub(super) changes: ChangeList<N, D>,
    pub(super) table: ObjectTable<N, D>,
    pub(super) journal: Journal<ObjectNote<N, D>, Vec<BodyEntry<N, D>>, KeptObject<N, D, T>>,
    /// Clones an object; `None` before the first mark, since `T` need not be `Clone` until then.
    pub(super) cloned: Option<CloneObject<N, D, T>>,
}

clone_fields!([N: Space<D>, const D: usize, T: Clone] CollisionObjects<N, D, T> {
    first, slots, records, free, changes, table, journal, cloned,
});

/// A function that clones an object, for worlds with marks.
type CloneObject<N, const D: usize, T> = fn(&CollisionObject<N, D, T>) -> CollisionObject<N, D, T>;

/// Handle slot: the generation and the record of one handle index.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Slot {
    /// Generation of the object at this index, or of the next object if the slot is free.
    pub(super) generation: Generation,
    /// Index of the object in `records`, or [`NO_RECORD`].
    pub(super) record: u32,
}

#[cfg(feature = "serde")]
impl Slot {
    /// Returns a free slot whose next object has this generation.
    pub(super) const fn without_object(generation: Generation) -> Self {
        Self { generation, record: NO_RECORD }
    }
}

/// Returns the handle of the object at an index, which must be in use.
#[inline]
pub(super) fn handle_at(slots: &[Slot], index: u32) -> CollisionObjectHandle {
    CollisionObjectHandle::new(index, slots[index as usize].generation)
}

/// The record index of a free slot.
const NO_RECORD: u32 = u32::MAX;

/// Arguments of [`CollisionWorld::add`](super::CollisionWorld::add).
pub(super) struct Description<N: Space<D>, const D: usize, T> {
    pub(super) position: N::Isometry,
    pub(super) shape: ShapeHandle<N, D>,
    pub(super) groups: CollisionGroups,
    pub(super) query_type: GeometricQueryType<N>,
    pub(super) data: T,
}

impl<N: Space<D>, const D: usize, T> CollisionObjects<N, D, T> {
    pub(super) fn new() -> Self {
        Self {
            first: Generation::of_new_table(),
            slots: Vec::new(),
            records: Vec::new(),
            free: Vec::new(),
            changes: ChangeList::new(),
            table: ObjectTable::new(),
            journal: Journal::default(),
            cloned: None,
        }
    }

    /// Returns the object with this handle; `None` for a stale handle or a handle of another world.
    #[inline]
    #[must_use]
    pub fn get(&self, handle: CollisionObjectHandle) -> Option<&CollisionObject<N, D, T>> {
        self.records.get(self.record_index(handle)?)
    }

    pub(super) fn get_mut(
        &mut self,
        handle: CollisionObjectHandle,
    ) -> Option<&mut CollisionObject<N, D, T>> {
        let record = self.record_index(handle)?;
        self.note(record);
        self.records.get_mut(record)
    }

    /// Returns the index in `records` of the object with this handle; `None` for a stale handle or
    /// a handle of another world.
    #[inline]
    fn record_index(&self, handle: CollisionObjectHandle) -> Option<usize> {
        let slot = self.slots.get(handle.uid())?;
        (slot.generation == handle.generation()).then_some(slot.record as usize)
    }

    /// Returns the object at an index; `None` if the index is free.
    fn object_at(&self, index: u32) -> Option<&CollisionObject<N, D, T>> {
        self.records.get(self.slots.get(index as usize)?.record as usize)
    }

    /// Returns the body of the object at an index; `None` if the index is free.
    pub(super) fn body(&self, index: u32) -> Option<&WorldBody<N, D>> {
        self.object_at(index).map(|object| &object.body)
    }

    /// Iterates over the bodies of all objects, in order of their indices.
    pub(super) fn bodies(&self) -> impl Iterator<Item = &WorldBody<N, D>> {
        self.iter().map(|object| &object.body)
    }

    /// Returns the tree that queries search in addition to the broad phase, or instead of it if the
    /// tree has all objects; builds it if necessary. `None` if nothing changed since the last
    /// update.
    pub(super) fn dirty_tree(&self, broad_phase: &WorldBroadPhase<N, D>) -> Option<&DirtyTree<D>> {
        self.changes.dirty_tree(|| {
            let has_all = self.changes.num_dirty() * DIRTY_RATIO >= self.records.len();
            let boxes = &mut *self.boxes(has_all, broad_phase);
            entries::new_dirty_tree(has_all, boxes)
        })
    }

    /// Iterates over the boxes of all objects, with their handle indices, if `has_all`; else over
    /// the dirty boxes, with their indices in the list of changes. The box of an object that is not
    /// dirty is its volume in the broad phase.
    fn boxes<'a>(
        &'a self,
        has_all: bool,
        broad_phase: &'a WorldBroadPhase<N, D>,
    ) -> Box<dyn Iterator<Item = (u32, Aabb<N, D>)> + 'a> {
        if !has_all {
            return Box::new(self.changes.dirty_boxes());
        }
        Box::new(self.records.iter().map(|CollisionObject { body, .. }| {
            let stored = || broad_phase.proxy(body.proxy).map(|(volume, _)| *volume);
            let aabb = self.changes.dirty_box(body).or_else(stored);
            (body.index(), aabb.unwrap_or_else(|| self.changes.volume(body)))
        }))
    }

    /// Returns the object with id `id` in the dirty tree; `None` if it has been removed.
    #[inline]
    pub(super) fn dirty_object(
        &self,
        tree: &DirtyTree<D>,
        id: u32,
    ) -> Option<&CollisionObject<N, D, T>> {
        self.object_at(self.changes.dirty_index(tree, id))
    }

    /// Returns the object whose proxy has the uid `uid`, found without a search. Tries the record
    /// at index `uid`, which is right while no object has been removed, then the object with handle
    /// index `uid`. `None` if neither has this proxy.
    #[inline]
    pub(super) fn object_of_proxy(&self, uid: usize) -> Option<&CollisionObject<N, D, T>> {
        let has_proxy = |object: &&CollisionObject<N, D, T>| object.body.proxy.uid() == uid;
        let in_order = self.records.get(uid).filter(has_proxy);
        in_order.or_else(|| self.object_at(u32::try_from(uid).ok()?).filter(has_proxy))
    }

    /// Returns `true` if both indices are in use, at most one of the objects is fixed and the
    /// groups allow the pair.
    #[inline]
    pub(super) fn can_interact(&self, index1: u32, index2: u32) -> bool {
        let both = self.body(index1).zip(self.body(index2));
        both.is_some_and(|(one, two)| one.can_interact(two))
    }

    #[inline]
    pub(super) fn slots(&self) -> &[Slot] {
        &self.slots
    }

    /// Iterates over the objects, in order of their handles.
    pub fn iter(&self) -> impl Iterator<Item = &CollisionObject<N, D, T>> {
        self.slots.iter().filter_map(|slot| self.records.get(slot.record as usize))
    }

    /// Returns the number of objects.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.records.len()
    }

    /// Returns `true` if there is no object.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.records.is_empty()
    }

    /// Returns the table of poses, shapes and query types: as of the last update, or during an
    /// update as of this update.
    #[must_use]
    pub const fn table(&self) -> &ObjectTable<N, D> {
        &self.table
    }

    /// Returns the body of the object with this handle; [`WorldError::StaleHandle`] if there is
    /// none.
    pub(super) fn checked_body(
        &self,
        handle: CollisionObjectHandle,
    ) -> Result<&WorldBody<N, D>, WorldError> {
        let object = self.get(handle).ok_or(WorldError::StaleHandle(handle))?;
        Ok(&object.body)
    }

    /// Returns the body of an object and the list of changes, for a change of the object, and
    /// records the old state if there are marks. [`WorldError::StaleHandle`] if there is no such
    /// object.
    pub(super) fn body_mut(
        &mut self,
        handle: CollisionObjectHandle,
    ) -> Result<(&mut WorldBody<N, D>, &mut ChangeList<N, D>), WorldError> {
        let record = self.record_index(handle).ok_or(WorldError::StaleHandle(handle))?;
        self.note(record);
        let object = self.records.get_mut(record).ok_or(WorldError::StaleHandle(handle))?;
        Ok((&mut object.body, &mut self.changes))
    }

    /// Returns the body of an object and the list of changes, for a move of the object. Equals
    /// [`Self::body_mut`], but records only the object's motion if there are marks.
    pub(super) fn body_mut_to_move(
        &mut self,
        handle: CollisionObjectHandle,
    ) -> Result<(&mut WorldBody<N, D>, &mut ChangeList<N, D>), WorldError> {
        let record = self.record_index(handle).ok_or(WorldError::StaleHandle(handle))?;
        self.note_motion(record);
        let object = self.records.get_mut(record).ok_or(WorldError::StaleHandle(handle))?;
        Ok((&mut object.body, &mut self.changes))
    }

    /// Returns the handle of the next object; [`WorldError::Full`] if there is none.
    pub(super) fn next_handle(&self) -> Result<CollisionObjectHandle, WorldError> {
        if let Some(&index) = self.free.last() {
            return Ok(CollisionObjectHandle::new(index, self.slots[index as usize].generation));
        }
        let index = u32::try_from(self.slots.len()).ok().filter(|&index| index < MAX_CHANGES);
        Ok(CollisionObjectHandle::new(index.ok_or(WorldError::Full)?, self.first))
    }

    /// Stores an object under `handle`, which must be the next handle. `proxy` registers the
    /// object's volume in the broad phase and returns the proxy's handle.
    pub(super) fn insert(
        &mut self,
        handle: CollisionObjectHandle,
        new: Description<N, D, T>,
        proxy: impl FnOnce(Aabb<N, D>) -> ProxyHandle,
    ) {
        let Description { position, shape, groups, query_type, data } = new;
        let row = ObjectRow { handle, isometry: position, shape, query: query_type };
        let body = self.changes.new_body(row, groups, proxy);
        let record = u32::try_from(self.records.len()).expect("no more objects than handles");
        let slot = Slot { generation: handle.generation(), record };
        self.records.push(CollisionObject { body, data });
        self.journal.note(ObjectNote::Added(handle));
        if self.free.pop().is_some() {
            self.slots[handle.uid()] = slot;
        } else {
            self.slots.push(slot);
        }
    }

    /// Removes an object and returns it; its handle becomes stale.
    pub(super) fn remove(&mut self, handle: CollisionObjectHandle) -> CollisionObject<N, D, T> {
        let next = handle.generation().next();
        self.note_removed(handle);
        let object = self.take_record(handle);
        self.slots[handle.uid()].generation = next.unwrap_or(handle.generation());
        if let Some((moved, change_index)) = self.changes.forget(&object.body) {
            let record = self.slots[moved as usize].record as usize;
            self.records[record].body.set_change_index(change_index as usize);
        }
        self.table.release(handle.index());
        if next.is_some() {
            self.free.push(handle.index());
        }
        object
    }

    /// Removes the record of an object; the last record moves to its index.
    pub(super) fn take_record(
        &mut self,
        handle: CollisionObjectHandle,
    ) -> CollisionObject<N, D, T> {
        let record = core::mem::replace(&mut self.slots[handle.uid()].record, NO_RECORD);
        let object = self.records.swap_remove(record as usize);
        if let Some(moved) = self.records.get(record as usize) {
            self.slots[moved.body.handle.uid()].record = record;
        }
        object
    }

    /// Writes the changes since the last update to the table and the broad phase, in order of
    /// handle indices, and clears them. Fills `algorithms` with the handle indices of the objects
    /// for whose pairs the algorithms must be chosen again.
    pub(super) fn flush(
        &mut self,
        broad_phase: &mut WorldBroadPhase<N, D>,
        algorithms: &mut Vec<u32>,
    ) {
        let order = self.changes.take_order();
        let Self { slots, records, changes, table, .. } = self;
        table.begin_update();
        algorithms.clear();
        let mut targets = ChangeTargets { table, broad_phase, algorithms };
        for &index in &order {
            if let Some(object) = records.get_mut(slots[index as usize].record as usize) {
                entries::flush(changes, &mut object.body, &mut targets);
            }
        }
        changes.clear(order);
    }

    /// Writes the row of an object to the table; does nothing if the object has a row already, or
    /// if the index is free.
    pub(super) fn acquire_row(&mut self, index: u32) {
        let Self { slots, records, table, .. } = self;
        let slot = slots.get(index as usize);
        if let Some(object) = slot.and_then(|slot| records.get(slot.record as usize)) {
            table.acquire(index, || object.body.row());
        }
    }

    /// Releases memory that has not been needed for some time.
    pub(super) fn give_back(&mut self, look: Look) {
        look.fit(&mut self.slots);
        look.fit(&mut self.records);
        self.changes.give_back(look);
        self.table.give_back(look);
    }

    /// Iterates over the free indices; the last one is used next.
    pub(super) fn vacant(&self) -> impl DoubleEndedIterator<Item = usize> {
        self.free.iter().map(|&index| index as usize)
    }

    /// Returns the number of indices that have ever been used.
    pub(super) const fn num_slots(&self) -> usize {
        self.slots.len()
    }

    pub(super) fn set_proxy(&mut self, handle: CollisionObjectHandle, proxy: ProxyHandle) {
        if let Some(object) = self.get_mut(handle) {
            object.body.proxy = proxy;
        }
    }

    /// Checks slots, records, changes and table; the error describes the violation.
    pub(super) fn validate(&self, broad_phase: &WorldBroadPhase<N, D>) -> Result<(), String> {
        if self.iter().count() != self.records.len() {
            return Err(format!("{} objects do not all have slots", self.records.len()));
        }
        for (index, slot) in (0..).zip(&self.slots) {
            let Some(CollisionObject { body, .. }) = self.object_at(index) else { continue };
            if body.handle.generation() != slot.generation {
                return Err(format!("slot {index} has another generation than {:?}", body.handle));
            }
            self.changes.validate(body)?;
            if body.index() != index {
                return Err(format!("{:?} stands in slot {index}", body.handle));
            }
            if !self.changes.is_dirty(body) && !self.is_row_of(body) {
                return Err(format!("the row of {:?} is out of date", body.handle));
            }
        }
        if let Some(tree) = self.changes.existing_dirty_tree() {
            tree.validate(&mut *self.boxes(tree.has_all(), broad_phase))?;
        }
        self.table.validate()?;
        self.validate_free()
    }

    /// Returns `true` if the table has no row for the object, or an up-to-date row.
    fn is_row_of(&self, body: &WorldBody<N, D>) -> bool {
        let index = body.index();
        !self.table.has_row(index)
            || self.table.handle(index) == body.handle
                && self.table.isometry(index) == &body.isometry
                && self.table.shape(index).is_same(&body.shape)
                && self.table.query(index) == body.query.get()
                && self.table.skin(index) == self.changes.skin(index)
    }

    fn validate_free(&self) -> Result<(), String> {
        let mut free = self.free.clone();
        free.sort_unstable();
        free.dedup();
        let used = free.iter().find(|&&index| self.body(index).is_some());
        if let Some(index) = used {
            return Err(format!("index {index} is in use and free"));
        }
        if free.len() != self.free.len() {
            return Err("an index is free twice".to_owned());
        }
        Ok(())
    }
}
