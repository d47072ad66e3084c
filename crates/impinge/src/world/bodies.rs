//! What a world keeps of an object beside the user's data, and what changed since the last update.

use super::error::finite_pose;
use super::{CollisionGroups, WorldError};
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::broad_phase::{BroadPhase, ProxyHandle};
use crate::math::outward::slack_of;
use crate::math::{Pose, Real, Space, max};
use crate::memory::Look;
use crate::narrow_phase::{
    CollisionObjectHandle, GeometricQueryType, ObjectRow, ObjectTable, PackedQuery,
};
use crate::shape::{Compact, Geometry, Shape, ShapeHandle};

/// The broad phase of a world.
pub(crate) type WorldBroadPhase<N, const D: usize> =
    dyn BroadPhase<N, Aabb<N, D>, CollisionObjectHandle> + Send + Sync;

/// The object is tested against itself, as the narrow phase knows.
const SELF_PAIR: u32 = 1 << 31;
/// The bits of a place in the list of changes; all set for an object that has none.
const PLACE: u32 = SELF_PAIR - 1;
/// No handle index.
const GONE: u32 = u32::MAX;

/// An object as the user left it: each fact is kept here and nowhere else, but for what the phases
/// hold as of the last update. Of `f32` in 3D 96 bytes, and there are as many as objects.
///
/// What queries read stands side by side, the rest at both ends.
#[derive(Clone, Debug)]
#[repr(C)]
pub(crate) struct WorldBody<N: Space<D>, const D: usize> {
    pub(crate) shape: ShapeHandle<N, D>,
    pub(crate) isometry: N::Isometry,
    /// The numbers of the shape, if they are all that there is.
    solid: Compact<N, D>,
    pub(crate) proxy: ProxyHandle,
    /// [`SELF_PAIR`] and a place in the list of changes.
    state: u32,
    pub(crate) handle: CollisionObjectHandle,
    pub(crate) groups: CollisionGroups,
    pub(crate) query: PackedQuery<N>,
}

/// What happened to an object since the last update.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
struct BodyChanges {
    /// Another object, shape or query type: the whole row is to be written.
    row: bool,
    /// The shape or query type of an object that may have pairs.
    algorithm: bool,
    /// The volume in the broad phase is out of date.
    volume: bool,
    /// The pairs are to be filtered again.
    groups: bool,
}

/// An object that changed.
#[derive(Clone, Debug)]
struct BodyEntry<N: Real, const D: usize> {
    /// The handle index; [`GONE`] if the object is.
    index: u32,
    changes: BodyChanges,
    /// The exact box of the shape where the object is now, if the volume changed.
    aabb: Aabb<N, D>,
}

/// The objects that changed since the last update, each once.
#[derive(Debug)]
pub(crate) struct ChangeList<N: Real, const D: usize> {
    entries: Vec<BodyEntry<N, D>>,
    /// Memory for their handle indices in order.
    order: Vec<u32>,
    /// Of the last update: those whose pairs with themselves begin or end.
    self_changed: Vec<u32>,
}

/// What learns of changes when an update begins.
pub(crate) struct Readers<'a, N: Space<D>, const D: usize> {
    pub(crate) table: &'a mut ObjectTable<N, D>,
    pub(crate) broad_phase: &'a mut WorldBroadPhase<N, D>,
    /// Gets the objects whose pairs need other algorithms.
    pub(crate) algorithms: &'a mut Vec<u32>,
}

impl<N: Space<D>, const D: usize> WorldBody<N, D> {
    /// The handle index.
    pub(crate) const fn index(&self) -> u32 {
        self.handle.index()
    }

    /// Where the object stands in the list of changes, if it does.
    fn place(&self) -> Option<usize> {
        let place = self.state & PLACE;
        (place != PLACE).then_some(place as usize)
    }

    fn set_place(&mut self, place: u32) {
        self.state = self.state & SELF_PAIR | place;
    }

    /// The narrow phase tests the object against itself.
    pub(crate) const fn has_self_pair(&self) -> bool {
        self.state & SELF_PAIR != 0
    }

    /// The object shall be tested against itself: its groups ask for it, and it has parts that could
    /// touch each other.
    pub(crate) fn wants_self_pair(&self) -> bool {
        self.groups.can_interact_with_self() && self.shape.geometry().as_composite().is_some()
    }

    /// The exact box of the shape where the object is now.
    pub(crate) fn aabb(&self) -> Aabb<N, D> {
        aabb_at(&*self.shape, &N::pose(&self.isometry))
    }

    /// See [`GeometricQueryType::query_limit`].
    pub(crate) fn query_limit(&self) -> N {
        self.query.get().query_limit()
    }

    /// Asks the shape, which need not be fetched if its numbers are at hand.
    #[inline(always)]
    pub(crate) fn ask<R>(&self, question: impl FnOnce(Geometry<'_, N, D>) -> R) -> R {
        self.solid.ask(&self.shape, question)
    }

    /// The volume for the broad phase.
    pub(crate) fn volume(&self) -> Aabb<N, D> {
        grown(&self.aabb(), self.query_limit())
    }

    /// What the narrow phase reads of the object.
    pub(crate) fn row(&self) -> ObjectRow<N, D> {
        ObjectRow {
            handle: self.handle,
            isometry: self.isometry,
            shape: self.shape.clone(),
            query: self.query.get(),
        }
    }

    /// Moves the object, unless a number of the position is not finite. An object that is there already
    /// does not count as changed.
    pub(crate) fn set_isometry(
        &mut self,
        list: &mut ChangeList<N, D>,
        isometry: N::Isometry,
    ) -> Result<(), WorldError> {
        if isometry == self.isometry {
            self.isometry = isometry;
            return Ok(());
        }
        let pose = finite_pose(N::pose(&isometry), Some(self.handle))?;
        self.isometry = isometry;
        let aabb = aabb_at(&*self.shape, &pose);
        list.note_volume(self, aabb);
        Ok(())
    }

    pub(crate) fn set_shape(&mut self, list: &mut ChangeList<N, D>, shape: ShapeHandle<N, D>) {
        self.solid = Compact::of(&shape);
        self.shape = shape;
        list.note_row(self);
    }

    pub(crate) fn set_query(&mut self, list: &mut ChangeList<N, D>, query: GeometricQueryType<N>) {
        self.query = PackedQuery::new(query);
        list.note_row(self);
    }

    pub(crate) fn set_groups(&mut self, list: &mut ChangeList<N, D>, groups: CollisionGroups) {
        self.groups = groups;
        list.note(self).changes.groups = true;
    }

    /// Hands the changes since the last update on, and forgets them.
    pub(crate) fn flush(&mut self, list: &mut ChangeList<N, D>, readers: &mut Readers<'_, N, D>) {
        let Some(place) = self.place() else { return };
        let BodyEntry { changes, aabb, .. } = list.entries[place];
        self.set_place(PLACE);
        if self.wants_self_pair() != self.has_self_pair() {
            self.state ^= SELF_PAIR;
            list.self_changed.push(self.index());
        }
        if changes.row {
            readers.table.set(self.index(), || self.row());
        } else if changes.volume {
            readers.table.set_position(self.index(), &self.isometry);
        }
        if changes.algorithm {
            readers.algorithms.push(self.index());
        }
        if changes.volume {
            let volume = grown(&aabb, self.query_limit());
            readers.broad_phase.deferred_set_bounding_volume(self.proxy, volume);
        }
        if changes.groups {
            readers.broad_phase.deferred_recompute_all_proximities_with(self.proxy);
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

/// The box grown by `limit`, what an object wants to know of others, so that two boxes meet whenever the
/// solids are as near as the sum of both limits; and by a few units in the last place of what that makes
/// of it, because the box, the sum and the distance that it is compared with are rounded.
pub(super) fn grown<N: Real, const D: usize>(aabb: &Aabb<N, D>, limit: N) -> Aabb<N, D> {
    let mut reach = limit;
    for axis in 0..D {
        for face in [aabb.mins()[axis].abs(), aabb.maxs()[axis].abs()] {
            reach = if face < N::INFINITY { max(face, reach) } else { reach };
        }
    }
    aabb.loosened(limit + slack_of(reach))
}

impl<N: Space<D>, const D: usize> ChangeList<N, D> {
    pub(crate) const fn new() -> Self {
        Self { entries: Vec::new(), order: Vec::new(), self_changed: Vec::new() }
    }

    /// The body of a new object, whose volume the broad phase learns of by `proxy`.
    pub(crate) fn admit(
        &mut self,
        row: ObjectRow<N, D>,
        groups: CollisionGroups,
        proxy: impl FnOnce(Aabb<N, D>) -> ProxyHandle,
    ) -> WorldBody<N, D> {
        let ObjectRow { handle, isometry, shape, query } = row;
        let aabb = aabb_at(&*shape, &N::pose(&isometry));
        let proxy = proxy(grown(&aabb, query.query_limit()));
        let (solid, query) = (Compact::of(&shape), PackedQuery::new(query));
        let mut body =
            WorldBody { shape, isometry, solid, proxy, state: PLACE, handle, groups, query };
        let entry = self.note(&mut body);
        entry.aabb = aabb;
        entry.changes = BodyChanges { row: true, volume: true, ..BodyChanges::default() };
        body
    }

    /// Forgets what an object that is gone changed.
    pub(crate) fn forget(&mut self, body: &WorldBody<N, D>) {
        if let Some(place) = body.place() {
            self.entries[place].index = GONE;
        }
    }

    /// Queries must test the object itself: the broad phase does not know where it is now.
    pub(crate) fn is_astray(&self, body: &WorldBody<N, D>) -> bool {
        body.place().is_some_and(|place| self.entries[place].changes.volume)
    }

    /// The handle indices and the boxes of the objects that are astray, in no particular order.
    pub(crate) fn astray(&self) -> impl Iterator<Item = (u32, &Aabb<N, D>)> {
        let astray =
            self.entries.iter().filter(|entry| entry.changes.volume && entry.index != GONE);
        astray.map(|entry| (entry.index, &entry.aabb))
    }

    /// The handle indices of the changed objects, in order. The memory is to be given back to
    /// [`Self::clear`].
    pub(crate) fn take_order(&mut self) -> Vec<u32> {
        let mut order = core::mem::take(&mut self.order);
        order.extend(self.entries.iter().map(|entry| entry.index).filter(|&index| index != GONE));
        order.sort_unstable();
        order
    }

    /// Forgets all changes but those of pairs of objects with themselves.
    pub(crate) fn clear(&mut self, mut order: Vec<u32>) {
        order.clear();
        self.order = order;
        self.entries.clear();
    }

    /// The objects whose pairs with themselves begin or end, as of the last flush; forgotten hereby.
    pub(crate) fn take_self_changed(&mut self) -> Vec<u32> {
        core::mem::take(&mut self.self_changed)
    }

    /// How many objects changed that are still there.
    pub(crate) fn num_present(&self) -> usize {
        self.entries.iter().filter(|entry| entry.index != GONE).count()
    }

    /// How many objects changed.
    pub(crate) const fn len(&self) -> usize {
        self.entries.len()
    }

    /// Gives the memory of lists that have been short for some time back.
    pub(crate) fn give_back(&mut self, look: Look) {
        look.trim(&mut self.entries);
        look.trim(&mut self.order);
    }

    fn note_volume(&mut self, body: &mut WorldBody<N, D>, aabb: Aabb<N, D>) {
        let entry = self.note(body);
        entry.aabb = aabb;
        entry.changes.volume = true;
    }

    fn note_row(&mut self, body: &mut WorldBody<N, D>) {
        let aabb = body.aabb();
        let entry = self.note(body);
        entry.aabb = aabb;
        entry.changes.row = true;
        entry.changes.algorithm = true;
        entry.changes.volume = true;
    }

    /// Lists an object as changed.
    fn note(&mut self, body: &mut WorldBody<N, D>) -> &mut BodyEntry<N, D> {
        let place = body.place().unwrap_or_else(|| {
            let place = self.entries.len();
            let small = u32::try_from(place).ok().filter(|&place| place < PLACE);
            body.set_place(small.expect("a world holds fewer than 2^31 objects"));
            let (index, changes) = (body.index(), BodyChanges::default());
            self.entries.push(BodyEntry { index, changes, aabb: Aabb::unbounded() });
            place
        });
        &mut self.entries[place]
    }

    /// What is wrong with the places of an object in the list, if anything.
    pub(crate) fn validate(&self, body: &WorldBody<N, D>) -> Result<(), String> {
        match body.place().map(|place| self.entries.get(place)) {
            Some(entry) if entry.map(|entry| entry.index) != Some(body.index()) => {
                Err(format!("{:?} has the place of another among the changes", body.handle))
            }
            _ => Ok(()),
        }
    }
}
