//! The objects of a collision manager in a world of proximities: the touching pairs, and the nearest pair.
//!
//! Results are cached: [`Crowd::touching`] is updated from the events of the world. The nearest
//! pair is stored with the number of changes when it was found, and the cost of a query depends on
//! the changes since then. After [`EAGER`] changes without a query, the world is updated at once.

use std::collections::{BTreeMap, BTreeSet};

use impinge::math::Isometry3;
use impinge::narrow_phase::{CollisionObjectHandle, GeometricQueryType};
use impinge::query::{Proximity, distance, proximity, witness};
use impinge::shape::{Shape, ShapeHandle};
use impinge::world::{CollisionGroups, CollisionObject, CollisionWorld, QueryFilter, WorldError};

use super::changes::Changes;
use super::reach::Reach;

pub(super) type Handle = CollisionObjectHandle;
pub(super) type World = CollisionWorld<f64, 3, ()>;
pub(super) type Object = CollisionObject<f64, 3, ()>;
pub(super) type Solid = ShapeHandle<f64, 3>;

/// The world is updated after this many changes without a query, so that a query has few changes to process.
const EAGER: u64 = 16;

/// Two objects of one crowd, sorted by handle; or an object of this manager's crowd, then an object
/// of the other crowd.
pub(super) type Pair = (Handle, Handle);

/// Two objects and their distance, negative if they overlap.
#[derive(Clone, Copy, Debug)]
pub(super) struct Nearest {
    pub(super) pair: Pair,
    pub(super) distance: f64,
}

/// A nearest pair, and when it was found.
#[derive(Debug)]
struct Kept {
    nearest: Nearest,
    /// The number of changes when the pair was found.
    then: u64,
}

/// Objects and cached results.
#[derive(Debug)]
pub(super) struct Crowd {
    world: World,
    /// The last handle of each index.
    handles: Vec<Handle>,
    pub(super) changes: Changes,
    /// The number of changes at the last update of the world.
    updated: u64,
    /// The number of changes at the last query.
    asked: u64,
    /// The pairs that touched at the last update.
    touching: BTreeSet<Pair>,
    kept: Option<Kept>,
    /// For the index of an object, the cached nearest pair that contains it.
    beside: BTreeMap<u32, Kept>,
    pub(super) reach: Reach,
}

impl Crowd {
    pub(super) fn new() -> Self {
        Self {
            world: World::new(0.0),
            handles: Vec::new(),
            changes: Changes::default(),
            updated: 0,
            asked: 0,
            touching: BTreeSet::new(),
            kept: None,
            beside: BTreeMap::new(),
            reach: Reach::default(),
        }
    }

    pub(super) fn len(&self) -> usize {
        self.world.len()
    }

    /// All objects, in order of their handles.
    pub(super) fn objects(&self) -> impl Iterator<Item = &Object> {
        self.world.collision_objects()
    }

    /// Adds an object and returns its index.
    pub(super) fn add(
        &mut self,
        position: Isometry3<f64>,
        shape: Solid,
    ) -> Result<u32, WorldError> {
        let query = GeometricQueryType::Proximity(0.0);
        let groups = CollisionGroups::new();
        let handle = self.world.try_add(position, shape.clone(), groups, query, ())?;
        let index = index_of(handle);
        self.reach.add(index, &*shape, &position);
        match self.handles.get_mut(index as usize) {
            Some(place) => *place = handle,
            None => self.handles.push(handle),
        }
        self.note(index);
        Ok(index)
    }

    pub(super) fn remove(&mut self, index: u32) -> Result<(), WorldError> {
        self.world.try_remove(&[self.handle(index)])?;
        self.reach.remove(index);
        self.note(index);
        Ok(())
    }

    pub(super) fn place(&mut self, index: u32, position: Isometry3<f64>) -> Result<(), WorldError> {
        self.world.try_set_position(self.handle(index), position)?;
        self.reach.place(index as usize, &position);
        self.note(index);
        Ok(())
    }

    /// Returns the object with this index; `None` if it was removed. Panics if no object ever had
    /// the index.
    pub(super) fn object(&self, index: u32) -> Option<&Object> {
        self.world.collision_object(self.handle(index))
    }

    /// Returns the object with this handle, if it exists.
    pub(super) fn get(&self, handle: Handle) -> Option<&Object> {
        self.world.collision_object(handle)
    }

    /// Whether any object touches the placed shape.
    pub(super) fn meets_any(&self, position: &Isometry3<f64>, shape: &dyn Shape<f64, 3>) -> bool {
        self.world.overlaps_any(position, shape, &QueryFilter::new())
    }

    /// Returns the objects that touch the placed shape.
    pub(super) fn met_by(
        &self,
        position: &Isometry3<f64>,
        shape: &dyn Shape<f64, 3>,
    ) -> impl Iterator<Item = &Object> {
        self.world.objects_overlapping(position, shape, &QueryFilter::new())
    }

    /// Returns the object nearest to the placed shape within `limit`, and its distance, zero if they touch. Among
    /// equal distances the first object is returned.
    pub(super) fn nearest_to(
        &self,
        position: &Isometry3<f64>,
        shape: &dyn Shape<f64, 3>,
        limit: f64,
    ) -> Option<(Handle, f64)> {
        self.nearest_of(position, shape, limit, &QueryFilter::new())
    }

    /// Returns a pair that contains the object with this index, and caches it: a touching pair with
    /// minus its depth as distance, otherwise a pair of the smallest distance. If several pairs have
    /// this distance, the cached pair is kept, unless one of its objects has changed. `None` if
    /// there is no other object.
    pub(super) fn nearest_beside(&mut self, index: u32) -> Option<Nearest> {
        let found = self.beside_changed(index).or_else(|| self.found_beside(index, f64::INFINITY));
        match found {
            Some(nearest) => {
                let kept = Kept { nearest, then: self.changes.now() };
                self.beside.insert(index, kept);
            }
            None => {
                self.beside.remove(&index);
            }
        }
        found
    }

    /// Computes the result of [`Self::nearest_beside`] from the cached pair and the changes since
    /// then: the cached pair, unless it does not touch and a pair with a changed object is now
    /// nearer. `None` if no pair is cached, if one of its objects changed, or if the log of changes
    /// is too short.
    fn beside_changed(&self, index: u32) -> Option<Nearest> {
        let kept = self.beside.get(&index)?;
        let changed = self.changes.since(kept.then)?;
        let (one, other) = kept.nearest.pair;
        if [one, other].iter().any(|&handle| changed.contains(&index_of(handle))) {
            return None;
        }
        let own = self.object(index)?;
        let mut best = kept.nearest;
        for other in changed.iter().filter_map(|&index| self.object(index)) {
            if self.reach.may_be_within(index, index_of(other.handle()), best.distance) {
                let distance = between(own, other);
                if distance < best.distance {
                    best = self.signed(Nearest {
                        pair: ordered(own.handle(), other.handle()),
                        distance,
                    })?;
                }
            }
        }
        Some(best)
    }

    /// Returns the nearest pair within `limit` that contains the object with this index.
    fn found_beside(&self, index: u32, limit: f64) -> Option<Nearest> {
        let own = self.object(index)?;
        let others = QueryFilter::new().exclude(own.handle());
        let (other, distance) = self.nearest_of(own.position(), &**own.shape(), limit, &others)?;
        self.signed(Nearest { pair: ordered(own.handle(), other), distance })
    }

    /// Replaces the distance zero by minus the depth.
    fn signed(&self, nearest: Nearest) -> Option<Nearest> {
        if nearest.distance > 0.0 { Some(nearest) } else { self.depth_of(nearest.pair) }
    }

    /// Returns all touching pairs.
    pub(super) fn touching(&mut self) -> &BTreeSet<Pair> {
        self.update();
        &self.touching
    }

    /// Returns a touching pair; `None` if there is none. The first pair of the last update is
    /// returned without another update if it still touches.
    pub(super) fn touching_pair(&mut self) -> Option<Pair> {
        self.asked = self.changes.now();
        let first = self.touching.first().copied();
        if let Some(pair) = first.filter(|&pair| self.still_touch(pair)) {
            return Some(pair);
        }
        self.update();
        self.touching.first().copied()
    }

    /// Returns a touching pair with minus its depth as distance, if there is one, otherwise a pair
    /// of the smallest distance. If several pairs have this distance, the cached pair is returned
    /// if it is one of them. `None` if there are fewer than two objects.
    pub(super) fn nearest_pair(&mut self) -> Option<Nearest> {
        self.asked = self.changes.now();
        let found = self.overlap().or_else(|| {
            self.update();
            self.overlap()
        });
        let found = found.or_else(|| self.nearest_changed()).or_else(|| self.nearest_of_all());
        self.kept = found.map(|nearest| Kept { nearest, then: self.changes.now() });
        found
    }

    /// Returns the first pair that touched at the last update with its signed distance (minus the
    /// depth), if it still touches or overlaps.
    fn overlap(&self) -> Option<Nearest> {
        let pair = *self.touching.first()?;
        let nearest = self.kept_depth(pair).or_else(|| self.depth_of(pair))?;
        (nearest.distance <= 0.0).then_some(nearest)
    }

    /// Returns the cached nearest pair with its depth, if it is `pair`, touched when it was cached,
    /// and has not changed since.
    fn kept_depth(&self, pair: Pair) -> Option<Nearest> {
        let kept = self.kept.as_ref().filter(|kept| kept.nearest.pair == pair)?;
        let has_changed =
            [pair.0, pair.1].iter().any(|&handle| self.has_changed(handle, kept.then));
        let was_touching = kept.nearest.distance <= 0.0;
        (was_touching && !has_changed).then_some(kept.nearest)
    }

    fn depth_of(&self, pair: Pair) -> Option<Nearest> {
        Some(Nearest { pair, distance: -depth(self.get(pair.0)?, self.get(pair.1)?) })
    }

    /// Returns the nearest pair, if the objects of the cached pair have not changed. This is the
    /// cached pair, unless a pair with a changed object is now nearer. `None` if no pair at a
    /// positive distance is cached, if one of its objects changed, or if the log of changes is too
    /// short.
    fn nearest_changed(&self) -> Option<Nearest> {
        let kept = self.kept.as_ref().filter(|kept| kept.nearest.distance > 0.0)?;
        let changed = self.changes.since(kept.then)?;
        let (one, other) = kept.nearest.pair;
        if [one, other].iter().any(|&handle| changed.contains(&index_of(handle))) {
            return None;
        }
        let nearer = |best: Nearest, &index: &u32| {
            let found = self.found_beside(index, best.distance);
            found.filter(|found| found.distance < best.distance).unwrap_or(best)
        };
        Some(changed.iter().fold(kept.nearest, nearer))
    }

    /// Computes the nearest pair of all objects. Begins with the current distance of the cached
    /// pair, if there is one. Then searches for each object the nearest object of a higher handle
    /// within the smallest distance so far.
    fn nearest_of_all(&self) -> Option<Nearest> {
        let mut best = self.kept.as_ref().and_then(|kept| self.measured(kept.nearest.pair));
        for own in self.objects() {
            let handle = own.handle();
            let is_behind = |other: &Object| other.handle() > handle;
            let behind = QueryFilter::new().predicate(&is_behind);
            let limit = best.map_or(f64::INFINITY, |best| best.distance);
            let found = self.nearest_of(own.position(), &**own.shape(), limit, &behind);
            if let Some((other, distance)) = found
                && (distance < limit || best.is_none())
            {
                best = Some(Nearest { pair: (handle, other), distance });
            }
        }
        best
    }

    fn nearest_of(
        &self,
        position: &Isometry3<f64>,
        shape: &dyn Shape<f64, 3>,
        limit: f64,
        filter: &QueryFilter<'_, f64, 3, ()>,
    ) -> Option<(Handle, f64)> {
        let found = self.world.closest_object(position, shape, limit, filter)?;
        Some((found.object.handle(), found.distance))
    }

    /// Returns the pair with its current distance, if both objects exist.
    fn measured(&self, pair: Pair) -> Option<Nearest> {
        let (one, other) = (self.get(pair.0)?, self.get(pair.1)?);
        Some(Nearest { pair, distance: between(one, other) })
    }

    /// Whether the object may have changed after the first `then` changes.
    pub(super) fn has_changed(&self, handle: Handle, then: u64) -> bool {
        self.changes.may_include(index_of(handle), then)
    }

    /// Whether a pair that touched at the last update touches now. Tests the shapes only if one of
    /// the objects may have changed.
    fn still_touch(&self, (one, other): Pair) -> bool {
        let (Some(object1), Some(object2)) = (self.get(one), self.get(other)) else { return false };
        let has_changed = |handle| self.has_changed(handle, self.updated);
        !(has_changed(one) || has_changed(other)) || touch(object1, object2)
    }

    fn handle(&self, index: u32) -> Handle {
        self.handles[index as usize]
    }

    fn note(&mut self, index: u32) {
        self.changes.note(index);
        if self.changes.now() - self.asked.max(self.updated) >= EAGER {
            self.update();
        }
    }

    /// Updates [`Self::touching`].
    fn update(&mut self) {
        if self.updated == self.changes.now() {
            return;
        }
        self.updated = self.changes.now();
        self.world.update();
        for event in self.world.proximity_events() {
            let pair = ordered(event.collider1, event.collider2);
            if event.new_status == Proximity::Intersecting {
                self.touching.insert(pair);
            } else {
                self.touching.remove(&pair);
            }
        }
    }
}

/// Returns the index of an object.
pub(super) fn index_of(handle: Handle) -> u32 {
    u32::try_from(handle.uid()).expect("a world has fewer than 2^32 objects")
}

/// Whether two objects touch.
pub(super) fn touch(one: &Object, other: &Object) -> bool {
    let (shape1, shape2) = (&**one.shape(), &**other.shape());
    proximity(one.position(), shape1, other.position(), shape2, 0.0) == Proximity::Intersecting
}

/// Returns the depth of two objects: zero if they only touch, minus the distance if they are apart.
pub(super) fn depth(one: &Object, other: &Object) -> f64 {
    depth_at(one.position(), &**one.shape(), other)
}

/// Returns the depth of a placed solid and an object; minus the distance if they are apart.
pub(super) fn depth_at(
    position: &Isometry3<f64>,
    shape: &dyn Shape<f64, 3>,
    other: &Object,
) -> f64 {
    let found = witness(position, shape, other.position(), &**other.shape(), f64::INFINITY);
    found.map_or(0.0, |found| -found.distance)
}

/// Returns the distance of two objects.
pub(super) fn between(one: &Object, other: &Object) -> f64 {
    distance(one.position(), &**one.shape(), other.position(), &**other.shape())
}

fn ordered(one: Handle, other: Handle) -> Pair {
    if one < other { (one, other) } else { (other, one) }
}
