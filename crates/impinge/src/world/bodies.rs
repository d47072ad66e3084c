//! The record of an object: its state as the user last set it, except the user's data, the skin and
//! the predicted pose.

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

/// The broad phase of a world, as a trait object.
pub(crate) type WorldBroadPhase<N, const D: usize> = dyn WorldsBroadPhase<N, D>;

/// State bit: the narrow phase tests the object against itself.
const SELF_PAIR: u32 = 1 << 31;
/// State bit: the object is fixed, so it has no pairs with other fixed objects.
const FIXED: u32 = 1 << 30;
/// State bit: the volume in the broad phase also covers a predicted pose.
const PREDICTED: u32 = 1 << 29;
/// Mask of the bits with the object's index in the list of changes. All of these bits are set if
/// the object is not in the list.
const CHANGE_INDEX: u32 = PREDICTED - 1;
/// Maximum number of entries in the list of changes, and therefore of objects.
pub(super) const MAX_CHANGES: u32 = CHANGE_INDEX;

/// An object as the user last set it, without the user's data, skin and predicted pose. The broad
/// phase and the object table of the narrow phase have copies of its data as of the last update.
/// Takes 96 bytes for `f32` in 3D.
///
/// Fields that queries read are adjacent, from `isometry` to `groups`:
///
/// ```text
/// shape | isometry | solid | proxy | state | handle | groups | query
/// ```
#[derive(Debug)]
#[repr(C)]
pub(crate) struct WorldBody<N: Space<D>, const D: usize> {
    pub(crate) shape: ShapeHandle<N, D>,
    pub(crate) isometry: N::Isometry,
    /// A copy of the radius of a ball or the half extents of a box, so that queries need not load
    /// the shape; a marker for any other shape.
    solid: Compact<N, D>,
    pub(crate) proxy: ProxyHandle,
    /// [`SELF_PAIR`], [`FIXED`] and [`PREDICTED`] in the high bits, the index in the list of
    /// changes ([`CHANGE_INDEX`]) in the low bits.
    state: u32,
    pub(crate) handle: CollisionObjectHandle,
    pub(crate) groups: CollisionGroups,
    pub(crate) query: PackedQuery<N>,
}

clone_fields!([N: Space<D>, const D: usize] WorldBody<N, D> {
    shape, isometry, solid, proxy, state, handle, groups, query,
});

/// The fields of a body that change when it moves, and again when an update processes the move.
/// While the world has marks ([`WorldMark`](super::WorldMark)), the old values are recorded before
/// each move.
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

    /// Returns the index of the object's handle.
    pub(crate) const fn index(&self) -> u32 {
        self.handle.index()
    }

    /// Creates the record of a new object, which is not in the list of changes.
    pub(super) fn new(row: ObjectRow<N, D>, groups: CollisionGroups, proxy: ProxyHandle) -> Self {
        let ObjectRow { handle, isometry, shape, query } = row;
        let (solid, query) = (Compact::of(&shape), PackedQuery::new(query));
        Self { shape, isometry, solid, proxy, state: CHANGE_INDEX, handle, groups, query }
    }

    /// Returns the object's index in the list of changes; `None` if it is not in the list.
    #[inline]
    pub(super) fn change_index(&self) -> Option<u32> {
        let change_index = self.state & CHANGE_INDEX;
        (change_index != CHANGE_INDEX).then_some(change_index)
    }

    /// Stores the object's index in the list of changes, and returns it. Panics if the index is not
    /// less than [`MAX_CHANGES`].
    #[inline]
    pub(super) fn set_change_index(&mut self, change_index: usize) -> u32 {
        let small =
            u32::try_from(change_index).ok().filter(|&change_index| change_index < CHANGE_INDEX);
        let change_index = small.expect("a world holds no more objects");
        self.state = self.state & !CHANGE_INDEX | change_index;
        change_index
    }

    /// Marks the object as not in the list of changes.
    pub(super) const fn clear_change_index(&mut self) {
        self.state |= CHANGE_INDEX;
    }

    /// Toggles whether the narrow phase tests the object against itself.
    pub(super) const fn toggle_self_pair(&mut self) {
        self.state ^= SELF_PAIR;
    }

    /// Returns `true` if the narrow phase tests the object against itself.
    pub(crate) const fn has_self_pair(&self) -> bool {
        self.state & SELF_PAIR != 0
    }

    /// Returns `true` if the object is fixed.
    #[inline]
    pub(crate) const fn is_fixed(&self) -> bool {
        self.state & FIXED != 0
    }

    /// Returns `true` if at most one of the objects is fixed and their groups allow the pair.
    #[inline]
    pub(crate) const fn can_interact(&self, other: &Self) -> bool {
        self.state & other.state & FIXED == 0 && self.groups.can_interact_with_groups(&other.groups)
    }

    /// Returns `true` if the object should be tested against itself: it is a composite, and its
    /// groups enable self-collision.
    pub(crate) fn wants_self_pair(&self) -> bool {
        self.groups.can_interact_with_self() && self.shape.geometry().as_composite().is_some()
    }

    /// Returns the box of the shape at the object's present pose; see [`Self::aabb_at`].
    pub(crate) fn aabb(&self) -> Aabb<N, D> {
        self.aabb_at(&N::pose(&self.isometry))
    }

    /// Returns the box of the shape at `pose`; the unbounded box if coordinates exceed the scalar's
    /// range.
    pub(super) fn aabb_at(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        usable(self.solid.aabb(&self.shape, pose))
    }

    /// Returns the prediction or margin of the object's query type. The broad phase grows the
    /// object's box by this length plus the skin; see [`GeometricQueryType::query_limit`].
    pub(crate) fn query_limit(&self) -> N {
        self.query.get().query_limit()
    }

    /// Calls `question` with the geometry of the shape and returns the result of `question`. The
    /// geometry of a ball or a box is read from the copy in the body, without loading the shape.
    #[inline(always)]
    pub(crate) fn ask<R>(&self, question: impl FnOnce(Geometry<'_, N, D>) -> R) -> R {
        self.solid.ask(&self.shape, question)
    }

    /// Returns `true` if the volume in the broad phase also covers a predicted pose.
    pub(super) const fn is_predicted(&self) -> bool {
        self.state & PREDICTED != 0
    }

    /// Marks the object as fixed without filtering its pairs again; for the restoration of a saved
    /// world.
    #[cfg(feature = "serde")]
    pub(super) const fn restore_fixed(&mut self) {
        self.state |= FIXED;
    }

    /// Marks the object as having a predicted pose, without a change of its volume; for the
    /// restoration of a saved world.
    #[cfg(feature = "serde")]
    pub(super) const fn restore_predicted(&mut self) {
        self.state |= PREDICTED;
    }

    /// Returns the object's row for the object table of the narrow phase.
    pub(crate) fn row(&self) -> ObjectRow<N, D> {
        ObjectRow {
            handle: self.handle,
            isometry: self.isometry,
            shape: self.shape.clone(),
            query: self.query.get(),
        }
    }

    /// Moves the object and clears its prediction. Fails if a number of the isometry is not finite,
    /// or its rotation is not of unit length. If the object has no prediction and `isometry` equals
    /// its present isometry, the object is not marked as changed.
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

    /// Moves the object and sets its predicted pose. Fails if a number of either pose is not
    /// finite, or a rotation is not of unit length.
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

    /// Makes the next update filter the pairs of the object again.
    pub(crate) fn refilter(&mut self, list: &mut ChangeList<N, D>) {
        list.note_filter(self);
    }
}

/// Returns the box of a placed shape; the unbounded box if coordinates exceed the scalar's range.
pub(super) fn aabb_at<N: Real, const D: usize>(
    shape: &dyn Shape<N, D>,
    pose: &Pose<N, D>,
) -> Aabb<N, D> {
    usable(shape.aabb(pose))
}

/// Returns `aabb`; the unbounded box if on any axis the minimum exceeds the maximum or one of them
/// is NaN.
fn usable<N: Real, const D: usize>(aabb: Aabb<N, D>) -> Aabb<N, D> {
    let is_usable = (0..D).all(|axis| aabb.mins()[axis] <= aabb.maxs()[axis]);
    if is_usable { aabb } else { Aabb::unbounded() }
}

/// Returns the box grown on every side by `limit` plus a slack for rounding. The slack is a few
/// units in the last place of `limit` or of the largest absolute value of a finite coordinate,
/// whichever is larger. It covers the rounding of the boxes, of the sum and of the computed
/// distance, so two grown boxes overlap whenever the computed distance of the solids is at most the
/// sum of both limits.
pub(super) fn grown<N: Real, const D: usize>(aabb: &Aabb<N, D>, limit: N) -> Aabb<N, D> {
    let mut largest = limit;
    for axis in 0..D {
        for face in [aabb.mins()[axis].abs(), aabb.maxs()[axis].abs()] {
            largest = if face < N::INFINITY { max(face, largest) } else { largest };
        }
    }
    aabb.loosened(limit + slack_of(largest))
}
