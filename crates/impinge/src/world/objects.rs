//! The objects of a world: the handle table, the users' records, and what a step reads of them.

use super::bodies::{Bodies, Body};
use super::{CollisionGroups, CollisionObject, WorldError};
use crate::bounding_volume::Aabb;
use crate::broad_phase::ProxyHandle;
use crate::math::Space;
use crate::narrow_phase::{CollisionObjectHandle, GeometricQueryType, ObjectRow, ObjectTable};
use crate::shape::ShapeHandle;

/// The objects of a world, by handle.
///
/// A freed index is used again, the last freed one first, under the next generation; an index whose
/// generations are used up is never used again.
#[derive(Debug)]
pub struct CollisionObjects<N: Space<D>, const D: usize, T> {
    slots: Vec<Slot<N, D, T>>,
    /// Indices without an object, the next one to be used at the end.
    free: Vec<u32>,
    count: usize,
    pub(super) bodies: Bodies<N, D>,
    pub(super) table: ObjectTable<N, D>,
}

#[derive(Debug)]
struct Slot<N: Space<D>, const D: usize, T> {
    /// That of the object here, or of the next one.
    generation: u32,
    object: Option<CollisionObject<N, D, T>>,
}

/// What the user says about a new object.
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
            slots: Vec::new(),
            free: Vec::new(),
            count: 0,
            bodies: Bodies::new(),
            table: ObjectTable::new(),
        }
    }

    /// The object of a handle; `None` for a stale one.
    #[must_use]
    pub fn get(&self, handle: CollisionObjectHandle) -> Option<&CollisionObject<N, D, T>> {
        let slot = self.slots.get(handle.uid())?;
        slot.object.as_ref().filter(|_| slot.generation == handle.generation())
    }

    pub(super) fn get_mut(
        &mut self,
        handle: CollisionObjectHandle,
    ) -> Option<&mut CollisionObject<N, D, T>> {
        let slot = self.slots.get_mut(handle.uid())?;
        slot.object.as_mut().filter(|_| slot.generation == handle.generation())
    }

    /// The object at an index.
    #[must_use]
    pub(super) fn at(&self, index: u32) -> Option<&CollisionObject<N, D, T>> {
        self.slots.get(index as usize)?.object.as_ref()
    }

    /// The objects, in order of their handles.
    pub fn iter(&self) -> impl Iterator<Item = &CollisionObject<N, D, T>> {
        self.slots.iter().filter_map(|slot| slot.object.as_ref())
    }

    /// How many objects there are.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.count
    }

    /// There is no object.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.count == 0
    }

    /// The poses, shapes and query types as of the last update (within an update: of this one).
    #[must_use]
    pub const fn table(&self) -> &ObjectTable<N, D> {
        &self.table
    }

    /// The object of a handle, or the error that says that the handle is stale.
    pub(super) fn fresh(
        &mut self,
        handle: CollisionObjectHandle,
    ) -> Result<&mut CollisionObject<N, D, T>, WorldError> {
        self.get_mut(handle).ok_or(WorldError::StaleHandle(handle))
    }

    /// The handle that the next object will have.
    pub(super) fn next_handle(&self) -> Result<CollisionObjectHandle, WorldError> {
        if let Some(&index) = self.free.last() {
            return Ok(CollisionObjectHandle::new(index, self.slots[index as usize].generation));
        }
        let index = u32::try_from(self.slots.len()).map_err(|_| WorldError::Full)?;
        if index == u32::MAX {
            Err(WorldError::Full)
        } else {
            Ok(CollisionObjectHandle::new(index, 0))
        }
    }

    /// Stores an object under the next handle.
    pub(super) fn insert(
        &mut self,
        handle: CollisionObjectHandle,
        new: Description<N, D, T>,
        proxy: impl FnOnce(Aabb<N, D>) -> ProxyHandle,
    ) {
        let Description { position, shape, groups: collision_groups, query_type, data } = new;
        let row = ObjectRow { handle, isometry: position, shape: shape.clone(), query: query_type };
        let body = Body::new(row, collision_groups, proxy);
        let proxy_handle = body.proxy;
        self.bodies.insert(body);
        let object = CollisionObject {
            handle,
            proxy_handle,
            position,
            shape,
            collision_groups,
            query_type,
            data,
        };
        self.count += 1;
        if self.free.pop().is_some() {
            self.slots[handle.uid()].object = Some(object);
        } else {
            self.slots.push(Slot { generation: 0, object: Some(object) });
        }
    }

    /// Forgets an object; its row in the table stays until the index is used again.
    pub(super) fn remove(&mut self, handle: CollisionObjectHandle) {
        let slot = &mut self.slots[handle.uid()];
        slot.object = None;
        self.count -= 1;
        self.bodies.remove(handle.index());
        if let Some(next) = slot.generation.checked_add(1) {
            slot.generation = next;
            self.free.push(handle.index());
        }
    }

    pub(super) fn set_proxy(&mut self, handle: CollisionObjectHandle, proxy: ProxyHandle) {
        self.bodies.set_proxy(handle.index(), proxy);
        if let Some(object) = self.get_mut(handle) {
            object.proxy_handle = proxy;
        }
    }

    /// What is wrong with the bookkeeping, if anything.
    pub(super) fn validate(&self) -> Result<(), String> {
        if self.iter().count() != self.count {
            return Err(format!("the count of objects, {}, is wrong", self.count));
        }
        if self.slots.len() != self.bodies.len() {
            return Err(format!("{} slots, {} copies", self.slots.len(), self.bodies.len()));
        }
        for (index, slot) in (0..).zip(&self.slots) {
            let body = self.bodies.at(index);
            if slot.object.is_some() != body.alive {
                return Err(format!("slot {index} and its copy disagree on whether it is alive"));
            }
            let Some(object) = &slot.object else { continue };
            let handle = CollisionObjectHandle::new(index, slot.generation);
            let same = object.handle == handle
                && body.handle == handle
                && object.position == body.isometry
                && object.proxy_handle == body.proxy
                && object.shape.is_same(&body.shape)
                && object.query_type == body.query
                && object.collision_groups == body.groups;
            if !same {
                return Err(format!("the record of {handle:?} and its copy differ"));
            }
            if !body.is_astray() && !self.is_row_of(body) {
                return Err(format!("the row of {handle:?} is out of date"));
            }
        }
        self.validate_free()
    }

    /// The table's row is that of an object.
    fn is_row_of(&self, body: &Body<N, D>) -> bool {
        let index = body.handle.index();
        body.handle.uid() < self.table.len()
            && self.table.handle(index) == body.handle
            && self.table.isometry(index) == &body.isometry
            && self.table.shape(index).is_same(&body.shape)
            && self.table.query(index) == body.query
    }

    fn validate_free(&self) -> Result<(), String> {
        let mut free = self.free.clone();
        free.sort_unstable();
        free.dedup();
        let used = free.iter().find(|&&index| self.at(index).is_some());
        if let Some(index) = used {
            return Err(format!("index {index} is in use and free"));
        }
        if free.len() != self.free.len() {
            return Err("an index is free twice".to_owned());
        }
        Ok(())
    }
}
