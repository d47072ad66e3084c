//! What a world keeps of an object beside the user's data.

use super::changes::ChangeList;
use super::error::usable_pose;
use super::{CollisionGroups, WorldError, WorldsBroadPhase};
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::broad_phase::ProxyHandle;
use crate::math::outward::slack_of;
use crate::math::{Pose, Real, Space, max};
use crate::memory::clone_fields;
use crate::narrow_phase::{CollisionObjectHandle, GeometricQueryType, ObjectRow, PackedQuery};
use crate::shape::{Compact, Geometry, Shape, ShapeHandle};

/// The broad phase of a world.
pub(crate) type WorldBroadPhase<N, const D: usize> = dyn WorldsBroadPhase<N, D>;

/// The object is tested against itself, as the narrow phase knows.
const SELF_PAIR: u32 = 1 << 31;
/// The object has no pairs with others that have this bit.
const FIXED: u32 = 1 << 30;
/// The volume in the broad phase holds a second pose as well, see [`ChangeList::predictions`].
const PREDICTED: u32 = 1 << 29;
/// The bits of a place in the list of changes; all set for an object that has none.
const PLACE: u32 = PREDICTED - 1;
/// The largest number of changes that can be listed: there are no more objects than these.
pub(super) const MAX_CHANGES: u32 = PLACE;

/// An object as the user left it: each fact is kept here and nowhere else, but for what the phases
/// hold as of the last update. Of `f32` in 3D 96 bytes, and there are as many as objects.
///
/// What queries read stands side by side, the rest at both ends.
#[derive(Debug)]
#[repr(C)]
pub(crate) struct WorldBody<N: Space<D>, const D: usize> {
    pub(crate) shape: ShapeHandle<N, D>,
    pub(crate) isometry: N::Isometry,
    /// The numbers of the shape, if they are all that there is.
    solid: Compact<N, D>,
    pub(crate) proxy: ProxyHandle,
    /// [`SELF_PAIR`], [`FIXED`], [`PREDICTED`] and a place in the list of changes.
    state: u32,
    pub(crate) handle: CollisionObjectHandle,
    pub(crate) groups: CollisionGroups,
    pub(crate) query: PackedQuery<N>,
}

clone_fields!([N: Space<D>, const D: usize] WorldBody<N, D> {
    shape, isometry, solid, proxy, state, handle, groups, query,
});

/// What of a body changes when it moves, and when an update sees that.
#[derive(Clone, Copy, Debug)]
pub(super) struct BodyMotion<N: Space<D>, const D: usize> {
    isometry: N::Isometry,
    state: u32,
}

impl<N: Space<D>, const D: usize> WorldBody<N, D> {
    pub(super) const fn motion(&self) -> BodyMotion<N, D> {
        BodyMotion { isometry: self.isometry, state: self.state }
    }

    pub(super) const fn set_motion(&mut self, motion: BodyMotion<N, D>) {
        (self.isometry, self.state) = (motion.isometry, motion.state);
    }

    /// The handle index.
    pub(crate) const fn index(&self) -> u32 {
        self.handle.index()
    }

    /// The record of a new object, which has no place in the list of changes.
    pub(super) fn new(row: ObjectRow<N, D>, groups: CollisionGroups, proxy: ProxyHandle) -> Self {
        let ObjectRow { handle, isometry, shape, query } = row;
        let (solid, query) = (Compact::of(&shape), PackedQuery::new(query));
        Self { shape, isometry, solid, proxy, state: PLACE, handle, groups, query }
    }

    /// Where the object stands in the list of changes, if it does.
    #[inline]
    pub(super) fn place(&self) -> Option<u32> {
        let place = self.state & PLACE;
        (place != PLACE).then_some(place)
    }

    /// Notes the place of the object in the list of changes.
    #[inline]
    pub(super) fn set_place(&mut self, place: usize) -> u32 {
        let small = u32::try_from(place).ok().filter(|&place| place < PLACE);
        let place = small.expect("a world holds no more objects");
        self.state = self.state & !PLACE | place;
        place
    }

    /// Notes that the object has no place in the list of changes.
    pub(super) const fn leave_place(&mut self) {
        self.state |= PLACE;
    }

    /// The narrow phase begins or ends to test the object against itself.
    pub(super) const fn toggle_self_pair(&mut self) {
        self.state ^= SELF_PAIR;
    }

    /// The narrow phase tests the object against itself.
    pub(crate) const fn has_self_pair(&self) -> bool {
        self.state & SELF_PAIR != 0
    }

    /// The object has no pairs with other fixed ones.
    #[inline]
    pub(crate) const fn is_fixed(&self) -> bool {
        self.state & FIXED != 0
    }

    /// The two objects are not both fixed, and their groups allow the pair.
    #[inline]
    pub(crate) const fn can_interact(&self, other: &Self) -> bool {
        self.state & other.state & FIXED == 0 && self.groups.can_interact_with_groups(&other.groups)
    }

    /// The object shall be tested against itself: its groups ask for it, and it has parts that could
    /// touch each other.
    pub(crate) fn wants_self_pair(&self) -> bool {
        self.groups.can_interact_with_self() && self.shape.geometry().as_composite().is_some()
    }

    /// The exact box of the shape where the object is now.
    pub(crate) fn aabb(&self) -> Aabb<N, D> {
        self.aabb_at(&N::pose(&self.isometry))
    }

    /// Its box where it stands at a pose.
    pub(super) fn aabb_at(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        usable(self.solid.aabb(&self.shape, pose))
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

    /// The broad phase is to find the pairs on the way to a predicted pose, too.
    pub(super) const fn is_predicted(&self) -> bool {
        self.state & PREDICTED != 0
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

    /// Moves the object, unless the position is none, and forgets the predicted pose. An
    /// object that is there already does not count as changed.
    pub(crate) fn set_isometry(
        &mut self,
        list: &mut ChangeList<N, D>,
        isometry: N::Isometry,
    ) -> Result<(), WorldError> {
        if isometry == self.isometry && !self.is_predicted() {
            self.isometry = isometry;
            return Ok(());
        }
        let pose = usable_pose(&isometry, Some(self.handle))?;
        self.state &= !PREDICTED;
        self.isometry = isometry;
        let aabb = self.aabb_at(&pose);
        list.note_box(self, aabb);
        Ok(())
    }

    /// Moves the object and predicts the pose after that, unless either is no position.
    pub(crate) fn set_predicted(
        &mut self,
        list: &mut ChangeList<N, D>,
        isometry: N::Isometry,
        predicted: N::Isometry,
    ) -> Result<(), WorldError> {
        let pose = usable_pose(&isometry, Some(self.handle))?;
        usable_pose::<N, D>(&predicted, Some(self.handle))?;
        self.state |= PREDICTED;
        self.isometry = isometry;
        list.predict(self.index(), predicted);
        let aabb = self.aabb_at(&pose);
        list.note_box(self, aabb);
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
        self.refilter(list);
    }

    pub(crate) fn set_skin(&mut self, list: &mut ChangeList<N, D>, skin: N) {
        if skin != list.skin(self.index()) {
            list.put_skin(self.index(), skin);
            list.note_row(self);
        }
    }

    pub(crate) fn set_fixed(&mut self, list: &mut ChangeList<N, D>, is_fixed: bool) {
        if is_fixed != self.is_fixed() {
            self.state ^= FIXED;
            self.refilter(list);
        }
    }

    /// Has the pairs of the object filtered again.
    pub(crate) fn refilter(&mut self, list: &mut ChangeList<N, D>) {
        list.note_filter(self);
    }
}

/// The box of a placed shape; the box of everything where the numbers go beyond the scalar's range.
pub(super) fn aabb_at<N: Real, const D: usize>(
    shape: &dyn Shape<N, D>,
    pose: &Pose<N, D>,
) -> Aabb<N, D> {
    usable(shape.aabb(pose))
}

/// A box; the box of everything where its numbers go beyond the scalar's range.
fn usable<N: Real, const D: usize>(aabb: Aabb<N, D>) -> Aabb<N, D> {
    let is_usable = (0..D).all(|axis| aabb.mins()[axis] <= aabb.maxs()[axis]);
    if is_usable { aabb } else { Aabb::unbounded() }
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
