//! Random operations on a world, compared with a model.

use std::collections::{BTreeMap, BTreeSet};

use impinge::bounding_volume::Aabb;
use impinge::broad_phase::DBVTBroadPhase;
use impinge::math::{Real, Space};
use impinge::narrow_phase::{
    CollisionObjectHandle, ContactEvent, DefaultNarrowPhase, GeometricQueryType,
};
use impinge::query::{self, Proximity};
use impinge::shape::{Polyline, ShapeHandle, TriMesh};
use impinge::world::{CollisionGroups, CollisionObject, CollisionWorld, WorldError};

use crate::construct::moved;
use crate::place::{Dimension, may_meet};
use crate::shapes::shape;
use crate::{Bytes, Task, dispatch};

/// The largest number of operations on one world.
const MAX_OPERATIONS: usize = 48;

/// The largest number of objects in one world.
const MAX_OBJECTS: usize = 10;

struct Operations;

impl Task for Operations {
    fn run<N: Space<D>, M: Dimension<N, D>, const D: usize>(self, bytes: &mut Bytes<'_>) {
        let mut stage = Stage::<N, D>::new(bytes);
        for _ in 0..MAX_OPERATIONS {
            if bytes.is_empty() {
                break;
            }
            stage.operate::<M>(bytes);
        }
        stage.update::<M>();
        let all: Vec<_> = stage.world.collision_objects().map(CollisionObject::handle).collect();
        stage.world.remove(&all);
        stage.update::<M>();
        assert!(stage.touching.is_empty() && stage.near.is_empty(), "all has ended");
    }
}

/// Fuzzes [`CollisionWorld`].
pub fn world(data: &[u8]) {
    dispatch(Operations, data);
}

type Handles = (CollisionObjectHandle, CollisionObjectHandle);

/// A world and the state that follows from its events.
struct Stage<N: Space<D>, const D: usize> {
    world: CollisionWorld<N, D, u8>,
    /// The handles of all current and removed objects.
    handles: Vec<CollisionObjectHandle>,
    /// Shapes for several objects.
    shapes: Vec<ShapeHandle<N, D>>,
    touching: BTreeSet<Handles>,
    near: BTreeMap<Handles, Proximity>,
    is_filtered: bool,
    /// Whether the next update keeps the events of the last one.
    keeps_events: bool,
    /// Whether all numbers are moderate. If so, the world must agree with the model; otherwise only
    /// its own results must agree with each other.
    is_moderate: bool,
}

impl<N: Space<D>, const D: usize> Stage<N, D> {
    fn new(bytes: &mut Bytes<'_>) -> Self {
        let margin = bytes.number();
        let world =
            CollisionWorld::try_new(margin).unwrap_or_else(|_| CollisionWorld::new(N::ZERO));
        Self {
            world,
            handles: Vec::new(),
            shapes: Vec::new(),
            touching: BTreeSet::new(),
            near: BTreeMap::new(),
            is_filtered: false,
            keeps_events: false,
            is_moderate: bytes.is_moderate(),
        }
    }

    /// Returns one of the handles, which may be stale.
    fn handle(&self, bytes: &mut Bytes<'_>) -> Option<CollisionObjectHandle> {
        let choice = bytes.choice(self.handles.len().max(1));
        self.handles.get(choice).copied()
    }

    fn shape<M: Dimension<N, D>>(&mut self, bytes: &mut Bytes<'_>) -> ShapeHandle<N, D> {
        let choice = bytes.choice(self.shapes.len() + 3);
        if let Some(shape) = self.shapes.get(choice) {
            return shape.clone();
        }
        let shape = shape::<N, M, D>(bytes);
        self.shapes.push(shape.clone());
        shape
    }

    fn operate<M: Dimension<N, D>>(&mut self, bytes: &mut Bytes<'_>) {
        let operation = bytes.choice(16);
        if operation < 3 || self.handles.is_empty() {
            return self.add::<M>(bytes);
        }
        let Some(handle) = self.handle(bytes) else { return };
        let is_known = self.world.contains(handle);
        let done = match operation {
            3 => return self.remove(bytes),
            4 | 5 => self.world.try_set_position(handle, M::stored(M::position(bytes))),
            6 => {
                let other = self.handle(bytes).unwrap_or(handle);
                let [one, two] = [0, 1].map(|_| M::stored(M::position(bytes)));
                self.world.try_set_positions(&[(handle, one), (other, two)])
            }
            7 => {
                let shape = self.shape::<M>(bytes);
                self.world.try_set_shape(handle, shape)
            }
            8 => self.world.try_set_collision_groups(handle, groups(bytes)),
            9 => self.world.try_set_query_type(handle, query_type(bytes)),
            10 => return self.deform::<M>(handle, bytes),
            11 => return self.exchange::<M>(bytes),
            12 | 13 => return self.update::<M>(),
            14 => return crate::world_queries::ask::<N, M, D>(&self.world, bytes),
            _ => return self.operate_as_engine::<M>(handle, bytes),
        };
        assert_eq!(done == Err(WorldError::StaleHandle(handle)), !is_known, "{done:?} {handle:?}");
    }

    fn add<M: Dimension<N, D>>(&mut self, bytes: &mut Bytes<'_>) {
        if self.world.len() == MAX_OBJECTS {
            return;
        }
        let (shape, position) = (self.shape::<M>(bytes), M::stored(M::position(bytes)));
        let (groups, query_type, data) = (groups(bytes), query_type(bytes), bytes.byte());
        let before = self.world.len();
        let added = self.world.try_add(position, shape, groups, query_type, data);
        assert_eq!(self.world.len(), before + usize::from(added.is_ok()));
        self.handles.extend(added);
    }

    fn remove(&mut self, bytes: &mut Bytes<'_>) {
        let handles: Vec<_> = (0..1 + bytes.choice(3)).filter_map(|_| self.handle(bytes)).collect();
        let before = self.world.len();
        let removed = self.world.try_remove(&handles);
        let gone = if removed.is_ok() { handles.len() } else { 0 };
        assert_eq!(self.world.len(), before - gone, "{removed:?}");
    }

    fn deform<M: Dimension<N, D>>(&mut self, handle: CollisionObjectHandle, bytes: &mut Bytes<'_>) {
        let mut vertices = |old: &[_]| moved::<N, D>(old, bytes);
        let mesh = |mesh: &mut TriMesh<N, D>| {
            let vertices = vertices(mesh.vertices());
            let _ = mesh.try_set_vertices(&vertices);
        };
        if self.world.try_deform(handle, mesh).is_ok() {
            return;
        }
        let line = |line: &mut Polyline<N, D>| {
            let vertices = vertices(line.vertices());
            let _ = line.try_set_vertices(&vertices);
        };
        if self.world.try_deform(handle, line).is_ok() {
            return;
        }
        let Some(object) = self.world.collision_object(handle) else { return };
        if let Some(field) = M::dig(object.shape(), bytes) {
            self.world.set_shape(handle, field);
        }
    }

    /// Replaces the broad phase or the narrow phase, or registers or unregisters the pair filter.
    fn exchange<M: Dimension<N, D>>(&mut self, bytes: &mut Bytes<'_>) {
        match bytes.choice(4) {
            0 => {
                let Ok(phase) = DBVTBroadPhase::<N, Aabb<N, D>, _>::try_new(bytes.size()) else {
                    return;
                };
                self.world.set_broad_phase(Box::new(phase));
            }
            1 => self.world.set_narrow_phase(Box::new(DefaultNarrowPhase::<N, D>::new())),
            2 => {
                M::filter(&mut self.world);
                self.is_filtered = true;
            }
            _ => {
                self.world.unregister_broad_phase_pair_filter("data");
                self.is_filtered = false;
            }
        }
    }

    /// Makes one of the calls that are meant for physics engines.
    fn operate_as_engine<M: Dimension<N, D>>(
        &mut self,
        handle: CollisionObjectHandle,
        bytes: &mut Bytes<'_>,
    ) {
        let is_known = self.world.contains(handle);
        let done = match bytes.choice(6) {
            0 => self.world.try_set_fixed(handle, bytes.choice(3) > 0),
            1 => self.world.try_set_skin(handle, bytes.size()),
            2 => {
                let [at, next] = [0, 1].map(|_| M::stored(M::position(bytes)));
                self.world.try_set_position_with_prediction(handle, at, next)
            }
            3 => {
                self.world.keep_events();
                self.keeps_events = true;
                return;
            }
            4 => {
                let is_kept = self.world.removed_object(handle).is_some();
                assert_eq!(self.world.take_removed(handle).is_some(), is_kept && !is_known);
                return;
            }
            _ => {
                let other = self.handle(bytes).unwrap_or(handle);
                let is_pair = self.world.pairs_with(handle).any(|one| one.handle() == other);
                let done = self.world.try_update_pair(handle, other);
                assert_eq!(done.unwrap_or(false), is_pair, "{done:?}");
                return;
            }
        };
        assert_eq!(done == Err(WorldError::StaleHandle(handle)), !is_known, "{done:?} {handle:?}");
    }

    /// Updates the world, then checks its events, its pairs and, for moderate numbers, the model.
    fn update<M: Dimension<N, D>>(&mut self) {
        let counts = (self.world.contact_events().len(), self.world.proximity_events().len());
        let kept = if std::mem::take(&mut self.keeps_events) { counts } else { (0, 0) };
        self.world.update();
        assert_eq!(self.world.validate(), Ok(()));
        self.hear(kept);
        self.check_pairs();
        if self.is_moderate {
            self.check_model::<M>();
        }
    }

    /// Applies the events after the kept events, to `touching` and `near`. Checks that for each
    /// pair starts and stops alternate, and that each proximity event begins with the status of the
    /// previous event of the pair.
    fn hear(&mut self, kept: (usize, usize)) {
        for event in &self.world.contact_events()[kept.0..] {
            let (handles, changed) = match *event {
                ContactEvent::Started(one, two) => ((one, two), self.touching.insert((one, two))),
                ContactEvent::Stopped(one, two) => ((one, two), self.touching.remove(&(one, two))),
            };
            assert!(changed && handles.0 <= handles.1, "{event:?}");
        }
        for event in &self.world.proximity_events()[kept.1..] {
            let handles = (event.collider1, event.collider2);
            let known = self.near.remove(&handles).unwrap_or(Proximity::Disjoint);
            assert_eq!(event.prev_status, known, "{event:?}");
            assert_ne!(event.new_status, known, "{event:?}");
            if event.new_status != Proximity::Disjoint {
                self.near.insert(handles, event.new_status);
            }
        }
    }

    /// Checks that the touching and near pairs of the world are those that follow from its events,
    /// and that no two contacts have the same id.
    fn check_pairs(&self) {
        let mut ids = BTreeSet::new();
        let mut touching = BTreeSet::new();
        for (one, two, pair) in self.world.contact_pairs() {
            let handles = (one.handle(), two.handle());
            let mut manifolds = Vec::new();
            pair.contacts(&mut manifolds);
            let contacts = manifolds.iter().flat_map(|manifold| manifold.contacts());
            let count = contacts.map(|contact| assert!(ids.insert(contact.id), "a name twice"));
            assert_eq!(count.count(), pair.num_contacts());
            if pair.num_contacts() > 0 {
                touching.insert(handles);
            }
        }
        assert_eq!(touching, self.touching);
        let near: BTreeMap<Handles, Proximity> = self
            .world
            .proximity_pairs()
            .map(|(one, two, pair)| ((one.handle(), two.handle()), pair.proximity()))
            .filter(|(_, proximity)| *proximity != Proximity::Disjoint)
            .collect();
        assert_eq!(near, self.near);
    }

    /// Checks for every two objects that the contacts and the proximity of the world agree with the
    /// queries on these two objects.
    fn check_model<M: Dimension<N, D>>(&self) {
        let objects: Vec<_> = self.world.collision_objects().collect();
        for (index, one) in objects.iter().enumerate() {
            for two in &objects[index + 1..] {
                self.check_two::<M>(one, two);
            }
        }
    }

    fn check_two<M: Dimension<N, D>>(
        &self,
        one: &CollisionObject<N, D, u8>,
        two: &CollisionObject<N, D, u8>,
    ) {
        let handles = (one.handle(), two.handle());
        let is_allowed = !(one.is_fixed() && two.is_fixed())
            && one.collision_groups().can_interact_with_groups(two.collision_groups())
            && (!self.is_filtered || may_meet(*one.data(), *two.data()));
        let is_touching = self.touching.contains(&handles);
        let near = self.near.get(&handles).copied().unwrap_or(Proximity::Disjoint);
        if !is_allowed {
            assert!(!is_touching && near == Proximity::Disjoint, "{one:?} {two:?}");
            return;
        }
        let [(m1, g1), (m2, g2)] =
            [one, two].map(|object| (M::loose(*object.position()), &**object.shape()));
        let (expected, is_proximity) = match (one.query_type(), two.query_type()) {
            (GeometricQueryType::Contacts(a, _), GeometricQueryType::Contacts(b, _)) => {
                let [skin1, skin2] = [one, two].map(|object| self.world.skin(object.handle()));
                let skins = skin1.zip(skin2).map_or(N::ZERO, |(skin1, skin2)| skin1 + skin2);
                let contact = query::contact(&m1, g1, &m2, g2, a + b + skins);
                assert_eq!(contact.is_some(), is_touching, "{contact:?} {one:?} {two:?}");
                (Proximity::Disjoint, false)
            }
            (first, second) => {
                let margin = |query| match query {
                    GeometricQueryType::Proximity(margin) => margin,
                    GeometricQueryType::Contacts(..) => N::ZERO,
                };
                let margin = margin(first) + margin(second);
                (query::proximity(&m1, g1, &m2, g2, margin), true)
            }
        };
        assert!(!is_proximity || !is_touching, "{one:?} {two:?}");
        assert_eq!(near, expected, "{one:?} {two:?}");
    }
}

fn groups(bytes: &mut Bytes<'_>) -> CollisionGroups {
    let mut groups = CollisionGroups::new();
    let choice = bytes.byte();
    if choice & 3 == 3 {
        groups.set_membership(&[usize::from(choice >> 2 & 1)]);
        groups.set_blacklist(&[usize::from(choice >> 3 & 1)]);
    }
    if choice & 0b11_0000 == 0b11_0000 {
        groups.enable_self_collision();
    }
    groups
}

fn query_type<N: Real>(bytes: &mut Bytes<'_>) -> GeometricQueryType<N> {
    let mut number = || match bytes.choice(4) {
        0 | 1 => N::ZERO,
        2 => bytes.size(),
        _ => bytes.number::<N>(),
    };
    let (linear, angular) = (number(), number());
    if bytes.choice(4) == 0 {
        GeometricQueryType::Proximity(linear)
    } else {
        GeometricQueryType::Contacts(linear, angular)
    }
}
