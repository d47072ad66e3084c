//! The world: objects are added, changed and removed by handle. Pairs, contacts and events change
//! at the next update.
//!
//! An operation that fails has changed nothing.

use super::entries;
use super::error::{or_panic, usable_pose, usable_query};
use super::filter::Filters;
use super::fork::History;
use super::objects::Description;
use super::removed::RemovedObjects;
use super::step::in_order;
use super::{
    CollisionGroups, CollisionObject, CollisionObjects, WorldBroadPhase, WorldError,
    WorldsNarrowPhase,
};
use crate::math::Space;
use crate::memory::Recent;
use crate::narrow_phase::{
    CollisionObjectHandle, DefaultNarrowPhase, Events, GeometricQueryType, Interaction,
};
use crate::shape::ShapeHandle;

/// Collision objects, and the pairs, contacts and proximities among them as of the last update.
///
/// Objects are added, moved, changed and removed by handle. [`Self::update`] then finds the pairs
/// (broad phase), computes their contacts and proximities (narrow phase), and collects the events
/// since the previous update. Queries reflect every change at once; pairs, contacts and events are
/// those of the last update.
///
/// `T` is the user's data, which the world stores and never accesses. It need not be `Send` or
/// `Sync`; the world is `Send` or `Sync` if `T` is. Results come in canonical order, which is the
/// order of the handles, unless a method describes another order.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::shape::{Cuboid, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
///
/// let mut world = CollisionWorld::<f64, ()>::new(0.02);
/// let square = ShapeHandle::new(Cuboid::new(Vector::new(1.0, 1.0)));
/// let (groups, contacts) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.0, 0.0));
/// let [a, b] = [0.0, 1.75].map(|y| {
///     world.add(Isometry::translation(0.0, y), square.clone(), groups, contacts, ())
/// });
/// world.update();
///
/// assert_eq!(world.contact_events().len(), 1, "they overlap");
/// world.set_position(b, Isometry::translation(0.0, 5.0));
/// assert_eq!(world.contact_manifolds().count(), 1, "as of the last update");
/// world.update();
/// assert_eq!(world.contact_manifolds().count(), 0, "they are apart");
/// # assert!(world.contains(a));
/// ```
pub struct CollisionWorld<N: Space<D>, const D: usize, T> {
    pub(super) objects: CollisionObjects<N, D, T>,
    pub(super) broad_phase: Box<WorldBroadPhase<N, D>>,
    pub(super) narrow_phase: Box<dyn WorldsNarrowPhase<N, D, T>>,
    /// The broad phase that replaces the present one at the next update; `None` if the present one
    /// stays.
    pub(super) next_broad_phase: Option<Box<WorldBroadPhase<N, D>>>,
    /// The narrow phase that replaces the present one at the next update; `None` if the present one
    /// stays.
    pub(super) next_narrow_phase: Option<Box<dyn WorldsNarrowPhase<N, D, T>>>,
    pub(super) filters: Filters<N, D, T>,
    /// The events of the last update.
    pub(super) events: Events,
    /// Events of removals and [`Self::update_pair`] since the last update, which the next update
    /// delivers.
    pub(super) queued: Events,
    /// Whether the next update keeps the events of the last update, and appends its own.
    pub(super) keeps_events: bool,
    /// Removed objects whose handles are in events.
    pub(super) removed: RemovedObjects<N, D, T>,
    /// Scratch: handle indices of objects whose shape, query type or skin changed. The algorithms
    /// of their pairs must be chosen again.
    pub(super) algorithms: Vec<u32>,
    /// Scratch: pairs that started or stopped in an update.
    pub(super) interactions: Vec<Interaction>,
    /// Recent lengths of the change list, the scratch lists and the event list, which decide when
    /// memory is released.
    pub(super) recent: Recent,
    pub(super) history: History<N, D, T>,
}

/// Creating and filling a world.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Creates an empty world.
    ///
    /// `margin` is the distance by which the broad phase loosens each box on every side. An update
    /// spends little time on an object whose box stays within its loosened box. A fiftieth of the
    /// size of a typical object is a good value. The margin never affects exact results.
    ///
    /// # Panics
    /// If the margin is negative or not finite; [`Self::try_new`] returns an error instead.
    #[must_use]
    #[track_caller]
    pub fn new(margin: N) -> Self {
        or_panic(Self::try_new(margin))
    }

    /// Creates an empty world; see [`Self::new`].
    ///
    /// # Errors
    /// If the margin is negative or not finite.
    pub fn try_new(margin: N) -> Result<Self, WorldError> {
        if margin < N::ZERO || !margin.is_finite_number() {
            return Err(WorldError::Margin { value: margin.as_f64() });
        }
        Ok(Self {
            objects: CollisionObjects::new(),
            broad_phase: entries::new_broad_phase(margin),
            narrow_phase: Box::new(DefaultNarrowPhase::<N, D>::new()),
            next_broad_phase: None,
            next_narrow_phase: None,
            filters: Filters::new(),
            events: Events::default(),
            queued: Events::default(),
            keeps_events: false,
            removed: RemovedObjects::new(),
            algorithms: Vec::new(),
            interactions: Vec::new(),
            recent: Recent::default(),
            history: History::new(),
        })
    }

    /// Adds an object and returns its handle. Queries find the object at once, and pairs follow at
    /// the next update.
    ///
    /// `query_type` is a [`GeometricQueryType`], a
    /// [`ContactQuery`](crate::narrow_phase::ContactQuery) or a
    /// [`ProximityQuery`](crate::narrow_phase::ProximityQuery). The last two have named fields.
    ///
    /// # Panics
    /// If a number of the position is not finite, the rotation is not of unit length, a number of
    /// the query type is negative or not finite, or the world is full; [`Self::try_add`] returns an
    /// error instead.
    #[track_caller]
    pub fn add(
        &mut self,
        position: N::Isometry,
        shape: ShapeHandle<N, D>,
        groups: CollisionGroups,
        query_type: impl Into<GeometricQueryType<N>>,
        data: T,
    ) -> CollisionObjectHandle {
        or_panic(self.try_add(position, shape, groups, query_type, data))
    }

    /// Adds an object; see [`Self::add`].
    ///
    /// # Errors
    /// If a number of the position is not finite, the rotation is not of unit length, a number of
    /// the query type is negative or not finite, or the world is full. Then the world is unchanged.
    pub fn try_add(
        &mut self,
        position: N::Isometry,
        shape: ShapeHandle<N, D>,
        groups: CollisionGroups,
        query_type: impl Into<GeometricQueryType<N>>,
        data: T,
    ) -> Result<CollisionObjectHandle, WorldError> {
        usable_pose::<N, D>(&position, None)?;
        let query_type = usable_query(query_type.into())?;
        let handle = self.objects.next_handle()?;
        let broad_phase = &mut self.broad_phase;
        let object = Description { position, shape, groups, query_type, data };
        self.objects.insert(handle, object, |volume| broad_phase.create_proxy(volume, handle));
        Ok(handle)
    }

    /// Removes objects. Their pairs end at once; the resulting events come first in the next batch.
    /// As long as an event contains the handle of a removed object, [`Self::removed_object`]
    /// returns that object.
    ///
    /// # Panics
    /// If a handle is stale or occurs twice; [`Self::try_remove`] returns an error instead.
    #[track_caller]
    pub fn remove(&mut self, handles: &[CollisionObjectHandle]) {
        or_panic(self.try_remove(handles));
    }

    /// Removes objects; see [`Self::remove`].
    ///
    /// # Errors
    /// If a handle is stale or occurs twice. Then no object is removed.
    pub fn try_remove(&mut self, handles: &[CollisionObjectHandle]) -> Result<(), WorldError> {
        let mut proxies = Vec::with_capacity(handles.len());
        for &handle in handles {
            proxies.push(self.objects.checked_body(handle)?.proxy);
        }
        refuse_repeated(handles)?;
        let mut pairs = Vec::new();
        self.broad_phase.remove(&proxies, &mut |&handle1, &handle2| {
            pairs.push(in_order(handle1, handle2));
        });
        let bodies = handles.iter().filter_map(|handle| self.objects.body(handle.index()));
        let alone = bodies.filter(|body| body.has_self_pair());
        pairs.extend(alone.map(|body| (body.handle, body.handle)));
        for (first, second) in pairs {
            self.narrow_phase.handle_removal(&mut self.queued, &self.objects, first, second);
            self.release_rows((first, second));
        }
        self.removed.note(&self.events, &self.queued);
        for &handle in handles {
            self.removed.keep(self.objects.remove(handle));
        }
        Ok(())
    }
}

/// Returns an error for a handle that occurs twice.
fn refuse_repeated(handles: &[CollisionObjectHandle]) -> Result<(), WorldError> {
    let mut sorted = handles.to_vec();
    sorted.sort_unstable();
    match sorted.windows(2).find(|two| two[0] == two[1]) {
        Some(two) => Err(WorldError::RepeatedHandle(two[0])),
        None => Ok(()),
    }
}

/// Changing objects.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Moves an object. Queries use the new position at once, and pairs follow at the next update.
    ///
    /// # Panics
    /// If the handle is stale, a number of the position is not finite, or the rotation is not of
    /// unit length; [`Self::try_set_position`] returns an error instead.
    #[track_caller]
    pub fn set_position(&mut self, handle: CollisionObjectHandle, position: N::Isometry) {
        or_panic(self.try_set_position(handle, position));
    }

    /// Moves an object; see [`Self::set_position`].
    ///
    /// # Errors
    /// If the handle is stale, a number of the position is not finite, or the rotation is not of
    /// unit length. Then the world is unchanged.
    pub fn try_set_position(
        &mut self,
        handle: CollisionObjectHandle,
        position: N::Isometry,
    ) -> Result<(), WorldError> {
        let (body, changes) = self.objects.body_mut_to_move(handle)?;
        entries::set_isometry(body, changes, position)
    }

    /// Moves many objects: all of them or, on an error, none. If a handle occurs several times, the
    /// object gets the last position.
    ///
    /// # Panics
    /// If a handle is stale, a number of a position is not finite, or a rotation is not of unit
    /// length; [`Self::try_set_positions`] returns an error instead.
    #[track_caller]
    pub fn set_positions(&mut self, positions: &[(CollisionObjectHandle, N::Isometry)]) {
        or_panic(self.try_set_positions(positions));
    }

    /// Moves many objects; see [`Self::set_positions`].
    ///
    /// # Errors
    /// If a handle is stale, a number of a position is not finite, or a rotation is not of unit
    /// length. Then the world is unchanged.
    pub fn try_set_positions(
        &mut self,
        positions: &[(CollisionObjectHandle, N::Isometry)],
    ) -> Result<(), WorldError> {
        for (handle, position) in positions {
            self.objects.checked_body(*handle)?;
            usable_pose::<N, D>(position, Some(*handle))?;
        }
        for (handle, position) in positions {
            self.try_set_position(*handle, *position)?;
        }
        Ok(())
    }

    /// Replaces the shape of an object. Queries use the new shape at once; the object's pairs are
    /// computed anew at the next update.
    ///
    /// # Panics
    /// If the handle is stale; [`Self::try_set_shape`] returns an error instead.
    #[track_caller]
    pub fn set_shape(&mut self, handle: CollisionObjectHandle, shape: ShapeHandle<N, D>) {
        or_panic(self.try_set_shape(handle, shape));
    }

    /// Replaces the shape of an object; see [`Self::set_shape`].
    ///
    /// # Errors
    /// If the handle is stale. The world is unchanged then.
    pub fn try_set_shape(
        &mut self,
        handle: CollisionObjectHandle,
        shape: ShapeHandle<N, D>,
    ) -> Result<(), WorldError> {
        let (body, changes) = self.objects.body_mut(handle)?;
        entries::set_shape(body, changes, shape);
        Ok(())
    }

    /// Replaces the groups of an object. Queries use the new groups at once. At the next update,
    /// pairs that the groups now allow start, and pairs that they now forbid stop.
    ///
    /// # Panics
    /// If the handle is stale; [`Self::try_set_collision_groups`] returns an error instead.
    #[track_caller]
    pub fn set_collision_groups(&mut self, handle: CollisionObjectHandle, groups: CollisionGroups) {
        or_panic(self.try_set_collision_groups(handle, groups));
    }

    /// Replaces the groups of an object; see [`Self::set_collision_groups`].
    ///
    /// # Errors
    /// If the handle is stale. The world is unchanged then.
    pub fn try_set_collision_groups(
        &mut self,
        handle: CollisionObjectHandle,
        groups: CollisionGroups,
    ) -> Result<(), WorldError> {
        let (body, changes) = self.objects.body_mut(handle)?;
        body.set_groups(changes, groups);
        Ok(())
    }

    /// Changes the query type of an object. From the next update on, its pairs are computed with
    /// the new query type.
    ///
    /// # Panics
    /// If the handle is stale, or a number of the query type is negative or not finite;
    /// [`Self::try_set_query_type`] returns an error instead.
    #[track_caller]
    pub fn set_query_type(
        &mut self,
        handle: CollisionObjectHandle,
        query_type: impl Into<GeometricQueryType<N>>,
    ) {
        or_panic(self.try_set_query_type(handle, query_type));
    }

    /// Changes the query type of an object; see [`Self::set_query_type`].
    ///
    /// # Errors
    /// If the handle is stale or a number of the query type is negative or not finite. The world is
    /// unchanged then.
    pub fn try_set_query_type(
        &mut self,
        handle: CollisionObjectHandle,
        query_type: impl Into<GeometricQueryType<N>>,
    ) -> Result<(), WorldError> {
        let (body, changes) = self.objects.body_mut(handle)?;
        entries::set_query(body, changes, usable_query(query_type.into())?);
        Ok(())
    }
}

/// Look-up of objects.
impl<N: Space<D>, const D: usize, T> CollisionWorld<N, D, T> {
    /// Returns the object with this handle; `None` for a stale handle.
    #[must_use]
    pub fn collision_object(
        &self,
        handle: CollisionObjectHandle,
    ) -> Option<&CollisionObject<N, D, T>> {
        self.objects.get(handle)
    }

    /// Returns the object with this handle, for changes of its data; `None` for a stale handle.
    #[must_use]
    pub fn collision_object_mut(
        &mut self,
        handle: CollisionObjectHandle,
    ) -> Option<&mut CollisionObject<N, D, T>> {
        self.objects.get_mut(handle)
    }

    /// Iterates over the objects, in order of their handles.
    pub fn collision_objects(&self) -> impl Iterator<Item = &CollisionObject<N, D, T>> {
        self.objects.iter()
    }

    /// Returns the handle in this world with the index and generation of `handle`, which may come
    /// from another world or from a file. `None` if there is no such object.
    ///
    /// Use it for worlds that are filled in the same way, such as a server and its clients. The
    /// caller must ensure that the two objects correspond.
    ///
    /// ```
    /// use impinge::dim2::math::Isometry;
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
    ///
    /// let [mut server, mut client] = [0, 1].map(|_| CollisionWorld::new(0.02_f32));
    /// let (ball, query) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
    /// let add = |world: &mut CollisionWorld<f32, ()>| {
    ///     world.add(Isometry::identity(), ball.clone(), CollisionGroups::new(), query, ())
    /// };
    /// let (on_server, on_client) = (add(&mut server), add(&mut client));
    /// assert!(client.collision_object(on_server).is_none(), "it names an object of the server");
    /// assert_eq!(client.counterpart(on_server), Some(on_client));
    /// ```
    #[must_use]
    pub fn counterpart(&self, handle: CollisionObjectHandle) -> Option<CollisionObjectHandle> {
        let own = self.objects.body(handle.index())?.handle;
        (own.generation().count() == handle.generation().count()).then_some(own)
    }

    /// Iterates over the free indices ([`CollisionObjectHandle::uid`]) of removed objects. New
    /// objects take the last free index first. When no free index is left, they take new indices.
    ///
    /// Together with the objects, these indices determine the indices of all later objects.
    ///
    /// ```
    /// use impinge::dim2::math::Isometry;
    /// use impinge::dim2::shape::{Ball, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
    ///
    /// let mut world = CollisionWorld::<f32, ()>::new(0.02);
    /// let (ball, query) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Proximity(0.0));
    /// let mut add = || world.add(Isometry::identity(), ball.clone(), CollisionGroups::new(), query, ());
    /// let objects = [add(), add(), add()];
    /// world.remove(&[objects[2], objects[0]]);
    /// assert!(world.vacant_indices().eq([2, 0]), "0 is taken next");
    /// ```
    pub fn vacant_indices(&self) -> impl DoubleEndedIterator<Item = usize> {
        self.objects.vacant()
    }

    /// Iterates over the names of the registered pair filters, sorted.
    ///
    /// ```
    /// use impinge::dim2::world::{CollisionObject, CollisionWorld};
    ///
    /// type Object = CollisionObject<f32, u8>;
    /// let mut world = CollisionWorld::<f32, u8>::new(0.02);
    /// world.register_broad_phase_pair_filter("teams", |a: &Object, b: &Object| a.data() != b.data());
    /// assert!(world.broad_phase_pair_filter_names().eq(["teams"]));
    /// ```
    pub fn broad_phase_pair_filter_names(&self) -> impl Iterator<Item = &str> {
        self.filters.names()
    }

    /// Returns `true` if the handle belongs to an object in this world.
    #[must_use]
    pub fn contains(&self, handle: CollisionObjectHandle) -> bool {
        self.objects.get(handle).is_some()
    }

    /// Returns the number of objects.
    #[must_use]
    pub fn len(&self) -> usize {
        self.objects.len()
    }

    /// Returns `true` if there is no object.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.objects.is_empty()
    }
}
