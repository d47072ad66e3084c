//! What a step reads and writes of the objects, apart from the users' data, and what has changed
//! since the last update.

use super::error::finite_pose;
use super::{CollisionGroups, WorldError};
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::broad_phase::{BroadPhase, ProxyHandle};
use crate::math::{Pose, Real, Space, max};
use crate::narrow_phase::{CollisionObjectHandle, GeometricQueryType, ObjectRow, ObjectTable};
use crate::shape::{Shape, ShapeHandle};

/// The broad phase of a world.
pub(crate) type WorldBroadPhase<N, const D: usize> =
    dyn BroadPhase<N, Aabb<N, D>, CollisionObjectHandle> + Send + Sync;

/// The hot copy of one object: always as the user left it, never as of the last update.
#[derive(Clone, Debug)]
pub(crate) struct Body<N: Space<D>, const D: usize> {
    pub(crate) handle: CollisionObjectHandle,
    pub(crate) proxy: ProxyHandle,
    pub(crate) isometry: N::Isometry,
    /// The exact box of the shape where the object is now.
    pub(crate) aabb: Aabb<N, D>,
    pub(crate) shape: ShapeHandle<N, D>,
    pub(crate) query: GeometricQueryType<N>,
    pub(crate) groups: CollisionGroups,
    pub(crate) alive: bool,
    /// The narrow phase has been told to test the object against itself.
    pub(crate) has_self_pair: bool,
    changes: Changes,
}

/// What happened to an object since the last update.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct Changes {
    /// The index is among the changed ones.
    listed: bool,
    /// Another object, shape or query type: the whole row is to be written.
    row: bool,
    /// The shape or query type of an object that may have pairs.
    algorithm: bool,
    /// The volume in the broad phase is out of date.
    volume: bool,
    /// The pairs are to be filtered again.
    groups: bool,
}

/// The hot copies, by handle index, and the list of those that changed.
#[derive(Debug)]
pub(crate) struct Bodies<N: Space<D>, const D: usize> {
    bodies: Vec<Body<N, D>>,
    /// The indices of what changed since the last update, each once.
    changed: Vec<u32>,
    /// Of the last flush: the indices of those whose pairs with themselves begin or end.
    self_changed: Vec<u32>,
}

impl<N: Space<D>, const D: usize> Body<N, D> {
    /// The hot copy of an object whose volume the broad phase does not have yet.
    pub(crate) fn new(
        row: ObjectRow<N, D>,
        groups: CollisionGroups,
        proxy: impl FnOnce(Aabb<N, D>) -> ProxyHandle,
    ) -> Self {
        let aabb = aabb_at(&*row.shape, &N::pose(&row.isometry));
        let proxy = proxy(volume(&aabb, row.query));
        let ObjectRow { handle, isometry, shape, query } = row;
        let changes = Changes::default();
        let (alive, has_self_pair) = (true, false);
        Self { handle, proxy, isometry, aabb, shape, query, groups, alive, has_self_pair, changes }
    }

    /// The volume for the broad phase.
    pub(crate) fn volume(&self) -> Aabb<N, D> {
        volume(&self.aabb, self.query)
    }

    /// Queries must test the object itself: the broad phase does not know where it is now.
    pub(crate) fn is_astray(&self) -> bool {
        self.changes.volume
    }

    /// The object shall be tested against itself: its groups ask for it, and it has parts that could
    /// touch each other.
    pub(crate) fn wants_self_pair(&self) -> bool {
        self.alive
            && self.groups.can_interact_with_self()
            && self.shape.geometry().as_composite().is_some()
    }

    fn row(&self) -> ObjectRow<N, D> {
        ObjectRow {
            handle: self.handle,
            isometry: self.isometry,
            shape: self.shape.clone(),
            query: self.query,
        }
    }
}

/// The box of a placed shape; the box of everything where the numbers go beyond the scalar's range.
pub(super) fn aabb_at<N: Real, const D: usize>(
    shape: &dyn Shape<N, D>,
    pose: &Pose<N, D>,
) -> Aabb<N, D> {
    let aabb = shape.aabb(pose);
    let usable = (0..D).all(|axis| aabb.mins()[axis] <= aabb.maxs()[axis]);
    if usable { aabb } else { Aabb::unbounded() }
}

/// The box grown by what the object wants to know of others, so that two boxes meet whenever the
/// solids are as near as the sum of both limits; and by a few units in the last place, because the
/// box, the sum and the distance that it is compared with are rounded.
fn volume<N: Real, const D: usize>(aabb: &Aabb<N, D>, query: GeometricQueryType<N>) -> Aabb<N, D> {
    grown(aabb, query.query_limit())
}

/// The box grown by `limit`, and by a few units in the last place of what that makes of it.
pub(super) fn grown<N: Real, const D: usize>(aabb: &Aabb<N, D>, limit: N) -> Aabb<N, D> {
    let faces = aabb.mins().iter().chain(aabb.maxs().iter());
    let finite = faces.filter(|x| x.is_finite_number());
    let reach = finite.fold(limit, |reach, x| max(x.abs(), reach));
    aabb.loosened(limit + N::lit(8.0) * N::EPSILON * reach)
}

impl<N: Space<D>, const D: usize> Bodies<N, D> {
    pub(crate) const fn new() -> Self {
        Self { bodies: Vec::new(), changed: Vec::new(), self_changed: Vec::new() }
    }

    /// Puts an object at its index: one that is free, or the next one.
    pub(crate) fn insert(&mut self, mut body: Body<N, D>) {
        let index = body.handle.index();
        match self.bodies.get_mut(body.handle.uid()) {
            Some(place) => {
                body.changes.listed = place.changes.listed;
                *place = body;
            }
            None => self.bodies.push(body),
        }
        let changes = self.note(index);
        changes.row = true;
        changes.volume = true;
    }

    /// Takes note that an object is gone; its copy stays until the index is used again.
    pub(crate) fn remove(&mut self, index: u32) {
        let body = &mut self.bodies[index as usize];
        body.alive = false;
        body.has_self_pair = false;
        // An index must have a row before later ones can: the row is written if it never was.
        body.changes =
            Changes { listed: body.changes.listed, row: body.changes.row, ..Changes::default() };
    }

    /// Moves an object, unless a number of the position is not finite. An object that is there already
    /// does not count as changed.
    pub(crate) fn set_isometry(
        &mut self,
        index: u32,
        isometry: N::Isometry,
    ) -> Result<(), WorldError> {
        let body = &mut self.bodies[index as usize];
        if isometry == body.isometry {
            return Ok(());
        }
        let pose = finite_pose(N::pose(&isometry), Some(body.handle))?;
        body.isometry = isometry;
        body.aabb = aabb_at(&*body.shape, &pose);
        self.note(index).volume = true;
        Ok(())
    }

    pub(crate) fn set_shape(&mut self, index: u32, shape: ShapeHandle<N, D>) {
        let body = &mut self.bodies[index as usize];
        body.aabb = aabb_at(&*shape, &N::pose(&body.isometry));
        body.shape = shape;
        self.note_row(index);
    }

    pub(crate) fn set_query(&mut self, index: u32, query: GeometricQueryType<N>) {
        self.bodies[index as usize].query = query;
        self.note_row(index);
    }

    pub(crate) fn set_groups(&mut self, index: u32, groups: CollisionGroups) {
        self.bodies[index as usize].groups = groups;
        self.note(index).groups = true;
    }

    pub(crate) fn set_proxy(&mut self, index: u32, proxy: ProxyHandle) {
        self.bodies[index as usize].proxy = proxy;
    }

    /// The object at an index; the last one that was there if it is free.
    #[inline]
    pub(crate) fn at(&self, index: u32) -> &Body<N, D> {
        &self.bodies[index as usize]
    }

    /// The objects, in order.
    pub(crate) fn iter(&self) -> impl Iterator<Item = &Body<N, D>> {
        self.bodies.iter().filter(|body| body.alive)
    }

    /// The living objects that queries must test themselves, in no particular order.
    pub(crate) fn astray(&self) -> impl Iterator<Item = &Body<N, D>> {
        let changed = self.changed.iter().map(|&index| self.at(index));
        changed.filter(|body| body.alive && body.is_astray())
    }

    /// How many indices were ever used.
    pub(crate) fn len(&self) -> usize {
        self.bodies.len()
    }

    /// The groups of both objects allow the pair.
    #[inline]
    pub(crate) fn can_interact(&self, index1: u32, index2: u32) -> bool {
        self.at(index1).groups.can_interact_with_groups(&self.at(index2).groups)
    }

    /// The objects whose pairs with themselves begin or end, as of the last flush, and which of the
    /// two; forgotten hereby.
    pub(crate) fn take_self_changes(&mut self) -> Vec<(CollisionObjectHandle, bool)> {
        let changed = core::mem::take(&mut self.self_changed);
        let one = |index: u32| (self.at(index).handle, self.at(index).has_self_pair);
        changed.into_iter().map(one).collect()
    }

    /// The objects that are tested against themselves.
    pub(crate) fn with_self_pairs(&self) -> impl Iterator<Item = CollisionObjectHandle> {
        self.iter().filter(|body| body.has_self_pair).map(|body| body.handle)
    }

    fn note_row(&mut self, index: u32) {
        let changes = self.note(index);
        changes.row = true;
        changes.algorithm = true;
        changes.volume = true;
    }

    /// Lists an index as changed.
    fn note(&mut self, index: u32) -> &mut Changes {
        let changes = &mut self.bodies[index as usize].changes;
        if !changes.listed {
            changes.listed = true;
            self.changed.push(index);
        }
        changes
    }

    /// Hands the changes since the last update to the table and the broad phase, in order of index,
    /// and forgets them. Leaves in `algorithms` the objects whose pairs need other algorithms.
    pub(crate) fn flush(
        &mut self,
        table: &mut ObjectTable<N, D>,
        broad_phase: &mut WorldBroadPhase<N, D>,
        algorithms: &mut Vec<u32>,
    ) {
        table.begin_update();
        algorithms.clear();
        self.changed.sort_unstable();
        for index in self.changed.drain(..) {
            let body = &mut self.bodies[index as usize];
            let changes = core::mem::take(&mut body.changes);
            if body.wants_self_pair() != body.has_self_pair {
                body.has_self_pair = !body.has_self_pair;
                self.self_changed.push(index);
            }
            if changes.row {
                table.set(body.row());
            } else if changes.volume {
                table.set_position(index, body.isometry);
            }
            if changes.algorithm {
                algorithms.push(index);
            }
            if changes.volume {
                broad_phase.deferred_set_bounding_volume(body.proxy, body.volume());
            }
            if changes.groups {
                broad_phase.deferred_recompute_all_proximities_with(body.proxy);
            }
        }
    }
}
