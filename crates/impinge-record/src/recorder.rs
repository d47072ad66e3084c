//! A world that records its calls.

use core::fmt;
use core::num::NonZeroU64;
use core::ops::Deref;

use impinge::narrow_phase::{CollisionObjectHandle, GeometricQueryType};
use impinge::shape::{Shape, ShapeHandle};
use impinge::world::{CollisionGroups, CollisionObject, CollisionWorld, WorldError};

use crate::RecordData;
use crate::call::{Call, KeyFrame, ObjectData};
use crate::error::RecordError;
use crate::log::Log;
use crate::player::exchange_phases;
use crate::registry::Registry;
use crate::shapes::KnownShapes;
use crate::space::Recordable;
use crate::state::Observer;

/// A collision world that records the calls that change it, and the queries made through it.
///
/// It owns the world and dereferences to it for reading only ([`Deref`]), so that every change is
/// recorded. A method with the name of a method of [`CollisionWorld`] calls that method and returns
/// its errors. After an error neither the world nor the recording has changed. Queries through
/// `Deref` are not recorded; they have no influence on the replay.
///
/// An update is recorded with hashes of all bits of its result: positions, groups, query types,
/// pairs, contacts, proximities and events. This costs O(objects + contacts) time, and 12 bytes for
/// each object whose hashes changed. A shape is written once, by value, and is kept alive as long
/// as the recorder.
///
/// Changes without a method here cannot be recorded: other phases
/// ([`CollisionWorld::set_broad_phase`], [`CollisionWorld::set_narrow_phase`]) and algorithms of a
/// narrow phase are code. The data of an object can only be replaced, not borrowed mutably. Marks
/// cannot be recorded either: a recording is one sequence of steps. A game with rollback marks and
/// rewinds a world of its own, and records the steps whose inputs are final with a second one.
///
/// ```
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::{Ball, ShapeHandle};
/// use impinge::dim2::world::{CollisionGroups, GeometricQueryType};
/// use impinge_record::{Recorder, Registry, validate};
///
/// let registry = Registry::<f64, 2, u32>::new();
/// let mut recorder = Recorder::new(0.02, registry.clone())?;
/// let (ball, contacts) = (ShapeHandle::new(Ball::new(1.0)), GeometricQueryType::Contacts(0.0, 0.0));
/// let add = |x, id| (Isometry::translation(x, 0.0), id);
/// for (position, id) in [add(0.0, 7), add(1.5, 8)] {
///     recorder.add(position, ball.clone(), CollisionGroups::new(), contacts, id)?;
/// }
/// recorder.update();
/// assert_eq!(recorder.contact_events().len(), 1, "reading goes to the world");
///
/// let recording = recorder.finish();
/// assert_eq!(validate(&recording.bytes, &registry), Ok(None), "the replay has the same bits");
/// # Ok::<(), impinge_record::RecordError>(())
/// ```
pub struct Recorder<N: Recordable<D>, const D: usize, T> {
    pub(crate) world: CollisionWorld<N, D, T>,
    margin: N,
    registry: Registry<N, D, T>,
    shapes: KnownShapes<N, D>,
    observer: Observer,
    log: Log,
    updates: u64,
    /// The number of updates between key frames; `None` if no key frames are written.
    key_frames: Option<NonZeroU64>,
}

/// A finished recording, and the world that was recorded.
#[derive(Debug)]
pub struct Recording<N: Recordable<D>, const D: usize, T> {
    /// The bytes that [`Recorder::take_bytes`] has not returned yet: the whole recording if it was
    /// not called.
    pub bytes: Vec<u8>,
    /// The world.
    pub world: CollisionWorld<N, D, T>,
}

/// The reason why a world cannot be recorded, and the world.
#[derive(Debug)]
pub struct Refused<N: Recordable<D>, const D: usize, T> {
    /// The reason.
    pub error: RecordError,
    /// The world, unchanged.
    pub world: Box<CollisionWorld<N, D, T>>,
}

impl<N: Recordable<D>, const D: usize, T: RecordData> Recorder<N, D, T> {
    /// Creates a recorder with an empty world.
    ///
    /// # Errors
    /// If the margin is negative, NaN or infinite.
    pub fn new(margin: N, registry: Registry<N, D, T>) -> Result<Self, RecordError> {
        Ok(Self::around(CollisionWorld::try_new(margin)?, margin, registry))
    }

    /// Records a world that already has objects, beginning with a key frame, and updates it.
    ///
    /// Before this update, the broad phase and the narrow phase of the world are replaced by new
    /// ones of the library, with this margin, as
    /// [`set_narrow_phase`](CollisionWorld::set_narrow_phase) does. The exchange itself causes no
    /// events, but contacts get new ids. All later results depend on the key frame alone, not on
    /// the history of the world.
    ///
    /// # Errors
    /// If the margin is invalid, a shape cannot be written, or the registry lacks a pair filter
    /// that is registered in the world.
    pub fn of_world(
        world: CollisionWorld<N, D, T>,
        margin: N,
        registry: Registry<N, D, T>,
    ) -> Result<Self, Refused<N, D, T>> {
        let usable = CollisionWorld::<N, D, T>::try_new(margin).map_err(RecordError::from);
        let unknown = unknown_filter(&world, &registry);
        let unknown = unknown.map_or(Ok(()), |name| Err(RecordError::UnknownFilter(name)));
        let mut recorder = Self::around(world, margin, registry);
        let begun = usable.and(unknown).and_then(|()| recorder.key_frame());
        match begun {
            Ok(()) => {
                recorder.world.update();
                recorder.end_step();
                Ok(recorder)
            }
            Err(error) => Err(Refused { error, world: Box::new(recorder.world) }),
        }
    }

    fn around(world: CollisionWorld<N, D, T>, margin: N, registry: Registry<N, D, T>) -> Self {
        let (shapes, log) = (KnownShapes::new(), Log::new(margin));
        let observer = Observer::default();
        let (updates, key_frames) = (0, None);
        Self { world, margin, registry, shapes, observer, log, updates, key_frames }
    }

    /// Writes a key frame before every update whose index is a positive multiple of `updates`. A
    /// replay that goes backwards then repeats little more than `updates` updates. Without key
    /// frames, the default, it goes back to the start of the recording.
    ///
    /// A key frame takes about as many bytes as adding all objects. The update after it recomputes
    /// every pair, and contacts get new ids, as with [`Self::of_world`]. Key frames do not change
    /// the events.
    #[must_use]
    pub const fn with_key_frames(mut self, updates: NonZeroU64) -> Self {
        self.key_frames = Some(updates);
        self
    }

    /// Adds an object.
    ///
    /// # Errors
    /// If the world rejects the object, or the shape cannot be written.
    pub fn add(
        &mut self,
        position: N::Isometry,
        shape: ShapeHandle<N, D>,
        groups: CollisionGroups,
        query_type: impl Into<GeometricQueryType<N>>,
        data: T,
    ) -> Result<CollisionObjectHandle, RecordError> {
        let (number, query_type) = (self.number(&shape)?, query_type.into());
        let bytes = data.to_bytes();
        let handle = self.world.try_add(position, shape, groups, query_type, data)?;
        let index = index_of(handle);
        let (shape, data) = (number, bytes);
        let object = ObjectData { index, position, shape, groups, query_type, data };
        self.record(&Call::Add(object));
        Ok(handle)
    }

    /// Removes objects.
    ///
    /// # Errors
    /// If a handle is stale or occurs twice.
    pub fn remove(&mut self, handles: &[CollisionObjectHandle]) -> Result<(), RecordError> {
        self.world.try_remove(handles)?;
        self.record(&Call::Remove(handles.iter().copied().map(index_of).collect()));
        Ok(())
    }

    /// Removes the objects for which `keeps` returns `false`. `keeps` is called in the order of
    /// handles.
    pub fn retain(&mut self, mut keeps: impl FnMut(&CollisionObject<N, D, T>) -> bool) {
        let leaving = self.world.collision_objects().filter(|object| !keeps(object));
        let leaving: Vec<_> = leaving.map(CollisionObject::handle).collect();
        self.world.remove(&leaving);
        self.record(&Call::Remove(leaving.into_iter().map(index_of).collect()));
    }

    /// Removes all objects.
    pub fn clear(&mut self) {
        self.retain(|_| false);
    }

    /// Moves an object.
    ///
    /// # Errors
    /// If the handle is stale or a number of the position is not finite.
    pub fn set_position(
        &mut self,
        handle: CollisionObjectHandle,
        position: N::Isometry,
    ) -> Result<(), RecordError> {
        self.set_positions(&[(handle, position)])
    }

    /// Moves objects; on an error none of them is moved.
    ///
    /// # Errors
    /// As [`Self::set_position`].
    pub fn set_positions(
        &mut self,
        positions: &[(CollisionObjectHandle, N::Isometry)],
    ) -> Result<(), RecordError> {
        self.world.try_set_positions(positions)?;
        let positions = positions.iter().map(|(handle, position)| (index_of(*handle), *position));
        self.record(&Call::SetPositions(positions.collect()));
        Ok(())
    }

    /// Replaces the shape of an object.
    ///
    /// # Errors
    /// If the handle is stale or the shape cannot be written.
    pub fn set_shape(
        &mut self,
        handle: CollisionObjectHandle,
        shape: ShapeHandle<N, D>,
    ) -> Result<(), RecordError> {
        let number = self.number(&shape)?;
        self.world.try_set_shape(handle, shape)?;
        self.record(&Call::SetShape { index: index_of(handle), shape: number });
        Ok(())
    }

    /// Changes a copy of the shape of an object, which must have the type `S`, and replaces the
    /// shape by this copy. Returns the result of `change`; see [`CollisionWorld::deform`].
    ///
    /// The recording gets the whole shape, as with [`Self::set_shape`]. A mesh of many vertices
    /// that changes at every step makes a large recording, and the recorder keeps every version of
    /// the shape alive.
    ///
    /// # Errors
    /// If the handle is stale or the shape has another type; `change` is then not called. Or if the
    /// changed shape cannot be written; the object then keeps its shape.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Point};
    /// use impinge::dim2::shape::{Polyline, ShapeHandle};
    /// use impinge::dim2::world::{CollisionGroups, GeometricQueryType};
    /// use impinge_record::{Recorder, Registry, validate};
    ///
    /// let registry = Registry::<f32, 2, ()>::new();
    /// let mut recorder = Recorder::new(0.02, registry.clone())?;
    /// let rope = |y| [-1.0, 0.0, 1.0].map(|x| Point::new(x, y)).to_vec();
    /// let (shape, query) = (ShapeHandle::new(Polyline::open(rope(0.0))), GeometricQueryType::Proximity(0.0));
    /// let handle = recorder.add(Isometry::identity(), shape, CollisionGroups::new(), query, ())?;
    /// recorder.deform(handle, |line: &mut Polyline<f32>| line.set_vertices(&rope(2.0)))?;
    /// recorder.update();
    /// assert_eq!(validate(&recorder.finish().bytes, &registry), Ok(None));
    /// # Ok::<(), impinge_record::RecordError>(())
    /// ```
    pub fn deform<S: Shape<N, D> + Clone, R>(
        &mut self,
        handle: CollisionObjectHandle,
        change: impl FnOnce(&mut S) -> R,
    ) -> Result<R, RecordError> {
        let object = self.world.collision_object(handle).ok_or(WorldError::StaleHandle(handle))?;
        let shape = object.shape().as_shape::<S>().ok_or(WorldError::ShapeType(handle))?;
        let mut shape = shape.clone();
        let result = change(&mut shape);
        self.set_shape(handle, ShapeHandle::new(shape))?;
        Ok(result)
    }

    /// Replaces the groups of an object.
    ///
    /// # Errors
    /// If the handle is stale.
    pub fn set_collision_groups(
        &mut self,
        handle: CollisionObjectHandle,
        groups: CollisionGroups,
    ) -> Result<(), RecordError> {
        self.world.try_set_collision_groups(handle, groups)?;
        self.record(&Call::SetGroups { index: index_of(handle), groups });
        Ok(())
    }

    /// Replaces the query type of an object.
    ///
    /// # Errors
    /// If the handle is stale, or a number of the query type is negative or not finite.
    pub fn set_query_type(
        &mut self,
        handle: CollisionObjectHandle,
        query_type: impl Into<GeometricQueryType<N>>,
    ) -> Result<(), RecordError> {
        let query_type = query_type.into();
        self.world.try_set_query_type(handle, query_type)?;
        self.record(&Call::SetQueryType { index: index_of(handle), query_type });
        Ok(())
    }

    /// Replaces the data of an object.
    ///
    /// # Errors
    /// If the handle is stale.
    pub fn set_data(&mut self, handle: CollisionObjectHandle, data: T) -> Result<(), RecordError> {
        let bytes = data.to_bytes();
        let object = self.world.collision_object_mut(handle);
        *object.ok_or(WorldError::StaleHandle(handle))?.data_mut() = data;
        self.record(&Call::SetData { index: index_of(handle), data: bytes });
        Ok(())
    }

    /// Registers a pair filter of the registry by its name.
    ///
    /// # Errors
    /// If the registry has no such filter.
    pub fn register_broad_phase_pair_filter(&mut self, name: &str) -> Result<(), RecordError> {
        if !self.registry.register(name, &mut self.world) {
            return Err(RecordError::UnknownFilter(name.to_owned()));
        }
        self.record(&Call::RegisterFilter(name.to_owned()));
        Ok(())
    }

    /// Unregisters the pair filter with this name, if it exists.
    pub fn unregister_broad_phase_pair_filter(&mut self, name: &str) {
        self.world.unregister_broad_phase_pair_filter(name);
        self.record(&Call::UnregisterFilter(name.to_owned()));
    }

    /// Updates the world and records the hashes of the result.
    pub fn update(&mut self) {
        self.begin_step();
        self.world.update();
        self.end_step();
    }

    /// Writes a key frame if the next update gets one; see [`Self::with_key_frames`].
    pub(crate) fn begin_step(&mut self) {
        if self.key_frames.is_some_and(|every| self.updates > 0 && self.updates % every == 0) {
            let known = self.key_frame();
            debug_assert!(known.is_ok(), "the shapes of all objects are known");
        }
    }

    /// Records an update that has just run.
    pub(crate) fn end_step(&mut self) {
        self.updates += 1;
        let observation = self.observer.observe(&self.world);
        self.record(&Call::Update(observation));
    }

    /// Writes a key frame of the world, and installs new phases in it.
    fn key_frame(&mut self) -> Result<(), RecordError> {
        let mut objects = Vec::with_capacity(self.world.len());
        for object in self.world.collision_objects() {
            let shape = self.shapes.number(object.shape(), &self.registry)?;
            objects.push(ObjectData {
                index: index_of(object.handle()),
                position: *object.position(),
                shape,
                groups: *object.collision_groups(),
                query_type: object.query_type(),
                data: object.data().to_bytes(),
            });
        }
        let filters = self.world.broad_phase_pair_filter_names().map(str::to_owned).collect();
        let vacant = self.vacant(&objects);
        self.record(&Call::KeyFrame(KeyFrame { filters, vacant, objects }));
        exchange_phases(&mut self.world, self.margin);
        self.observer = Observer::default();
        self.record_rare_facts();
        Ok(())
    }

    /// Returns the free indices for a key frame; the last one is used next. Indices that the world
    /// can never use again come first.
    fn vacant(&self, objects: &[ObjectData<N, D>]) -> Vec<u32> {
        let small = |index| u32::try_from(index).expect("an index has 31 bits");
        let free: Vec<u32> = self.world.vacant_indices().map(small).collect();
        let last = objects.last().map(|object| object.index);
        let reach = last.max(free.iter().copied().max()).map_or(0, |last| last as usize + 1);
        let mut is_used = vec![false; reach];
        let used = objects.iter().map(|object| object.index).chain(free.iter().copied());
        used.for_each(|index| is_used[index as usize] = true);
        let spent = (0..).zip(is_used).filter(|(_, used)| !used).map(|(index, _)| index);
        spent.chain(free).collect()
    }

    /// Returns the bytes that were written since the last call, for recordings that are written to
    /// a file as they grow.
    ///
    /// ```
    /// use impinge_record::{Recorder, Registry, validate};
    ///
    /// let registry = Registry::<f32, 2, ()>::new();
    /// let mut recorder = Recorder::new(0.02, registry.clone())?;
    /// let mut file = recorder.take_bytes();
    /// recorder.update();
    /// file.extend(recorder.take_bytes());
    /// file.extend(recorder.finish().bytes);
    /// assert_eq!(validate(&file, &registry), Ok(None));
    /// # Ok::<(), impinge_record::RecordError>(())
    /// ```
    #[must_use]
    pub fn take_bytes(&mut self) -> Vec<u8> {
        std::mem::take(&mut self.log.bytes)
    }

    /// Writes the last record and ends the recording.
    #[must_use]
    pub fn finish(mut self) -> Recording<N, D, T> {
        self.record(&Call::End { updates: self.updates });
        Recording { bytes: self.log.bytes, world: self.world }
    }

    /// Returns the index of a shape in the recording; a new shape is written before the next
    /// record.
    pub(crate) fn number(&mut self, shape: &ShapeHandle<N, D>) -> Result<u32, RecordError> {
        self.shapes.number(shape, &self.registry)
    }

    /// Writes a record, after the records of the shapes that are not written yet.
    pub(crate) fn record(&mut self, call: &Call<N, D>) {
        for shape in self.shapes.unwritten.drain(..) {
            self.log.record(&Call::Shape(shape));
        }
        self.log.record(call);
    }
}

/// Returns the first filter of a world that the registry lacks.
fn unknown_filter<N: Recordable<D>, const D: usize, T>(
    world: &CollisionWorld<N, D, T>,
    registry: &Registry<N, D, T>,
) -> Option<String> {
    let mut names = world.broad_phase_pair_filter_names();
    names.find(|name| !registry.has_filter(name)).map(str::to_owned)
}

/// Returns the index of an object's handle, which identifies the object in the recording.
pub(crate) fn index_of(handle: CollisionObjectHandle) -> u32 {
    u32::try_from(handle.uid()).expect("an index has 31 bits")
}

impl<N: Recordable<D>, const D: usize, T> Deref for Recorder<N, D, T> {
    type Target = CollisionWorld<N, D, T>;

    fn deref(&self) -> &Self::Target {
        &self.world
    }
}

impl<N: Recordable<D>, const D: usize, T: fmt::Debug> fmt::Debug for Recorder<N, D, T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Recorder")
            .field("world", &self.world)
            .field("updates", &self.updates)
            .finish_non_exhaustive()
    }
}
