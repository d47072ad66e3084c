//! Changes since the last update. The next update writes them to the broad phase and the object
//! table; until then queries read them here.
//!
//! The broad phase has the boxes of the last update. Objects whose boxes changed since then are
//! dirty. The first query after a change builds a [`DirtyTree`] of their boxes, and each later
//! change updates the tree. Without queries no tree is built.

use super::entries;
use std::sync::OnceLock;

use super::CollisionGroups;
use super::bodies::{WorldBody, WorldBroadPhase, aabb_at, grown};
use super::dirty::DirtyTree;
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::broad_phase::ProxyHandle;
use crate::math::{Real, Space};
use crate::memory::{Look, clone_fields};
use crate::narrow_phase::{ObjectRow, ObjectTable};

/// The kinds of changes of an object since the last update.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) struct BodyChanges {
    /// Whether the whole row of the object table must be written: the object is new, or its shape,
    /// query type or skin changed.
    row: bool,
    /// Whether the shape, query type or skin changed. The algorithms of the object's pairs must
    /// then be chosen again.
    algorithm: bool,
    /// Whether the volume in the broad phase is out of date. The object is then dirty.
    volume: bool,
    /// Whether the pairs of the object must be filtered again.
    filter: bool,
}

/// An entry of the list of changes, for one object.
#[derive(Clone, Debug)]
pub(crate) struct BodyEntry<N: Real, const D: usize> {
    /// Handle index.
    index: u32,
    changes: BodyChanges,
    /// Exact box of the shape at the present pose. It is the unbounded box, and is not read, if
    /// `changes.volume` is `false`.
    aabb: Aabb<N, D>,
}

/// The objects that changed since the last update, each once, with the predicted poses and the
/// skins of all objects.
#[derive(Debug)]
pub(crate) struct ChangeList<N: Space<D>, const D: usize> {
    entries: Vec<BodyEntry<N, D>>,
    /// By handle index, up to the largest index of an object with a prediction: the predicted pose.
    /// Meaningless for objects without a prediction.
    predictions: Vec<N::Isometry>,
    /// By handle index, up to the largest index of an object with a skin: the skin, which is the
    /// distance outside the surface at which contacts are measured.
    skins: Vec<N>,
    /// Tree in which queries find the dirty objects. Empty until the first query after a change
    /// builds it.
    dirty: OnceLock<DirtyTree<D>>,
    /// Scratch: handle indices of the changed objects, sorted.
    order: Vec<u32>,
    /// Handle indices of objects whose pair with themselves begins or ends in the next update.
    self_changed: Vec<u32>,
}

clone_fields!([N: Space<D>, const D: usize] ChangeList<N, D> {
    entries, predictions, skins, dirty, order, self_changed,
});

/// The parts of a world that receive the changes at the start of an update.
pub(crate) struct ChangeTargets<'a, N: Space<D>, const D: usize> {
    pub(crate) table: &'a mut ObjectTable<N, D>,
    pub(crate) broad_phase: &'a mut WorldBroadPhase<N, D>,
    /// Handle indices of the objects whose shape, query type or skin changed.
    pub(crate) algorithms: &'a mut Vec<u32>,
}

impl<N: Space<D>, const D: usize> ChangeList<N, D> {
    pub(crate) const fn new() -> Self {
        Self {
            entries: Vec::new(),
            predictions: Vec::new(),
            skins: Vec::new(),
            dirty: OnceLock::new(),
            order: Vec::new(),
            self_changed: Vec::new(),
        }
    }

    /// Creates the body of a new object, and records the object as changed. `proxy` registers the
    /// object's volume in the broad phase and returns its handle.
    pub(crate) fn new_body(
        &mut self,
        row: ObjectRow<N, D>,
        groups: CollisionGroups,
        proxy: impl FnOnce(Aabb<N, D>) -> ProxyHandle,
    ) -> WorldBody<N, D> {
        let aabb = aabb_at(&*row.shape, &N::pose(&row.isometry));
        let proxy = proxy(grown(&aabb, row.query.query_limit()));
        let mut body = WorldBody::new(row, groups, proxy);
        self.note_volume(&mut body, aabb).row = true;
        body
    }

    /// Returns the predicted pose of an object; `None` without a prediction.
    pub(crate) fn prediction(&self, body: &WorldBody<N, D>) -> Option<&N::Isometry> {
        body.is_predicted().then(|| &self.predictions[body.index() as usize])
    }

    /// Returns the skin of the object with handle index `index`; 0 by default.
    pub(crate) fn skin(&self, index: u32) -> N {
        self.skins.get(index as usize).copied().unwrap_or(N::ZERO)
    }

    pub(super) fn put_skin(&mut self, index: u32, skin: N) {
        let index = index as usize;
        self.skins.resize(self.skins.len().max(index + 1), N::ZERO);
        self.skins[index] = skin;
    }

    pub(super) fn predict(&mut self, index: u32, predicted: N::Isometry) {
        let index = index as usize;
        if self.predictions.len() <= index {
            self.predictions.resize(index + 1, predicted);
        }
        self.predictions[index] = predicted;
    }

    /// Returns the volume of an object in the broad phase: the box of its shape, merged with the
    /// box at the predicted pose if there is a prediction, and grown by query limit and skin.
    pub(crate) fn volume(&self, body: &WorldBody<N, D>) -> Aabb<N, D> {
        self.volume_around(body, &body.aabb())
    }

    /// Returns the volume of an object in the broad phase (see [`Self::volume`]) from its exact box
    /// `aabb`.
    fn volume_around(&self, body: &WorldBody<N, D>, aabb: &Aabb<N, D>) -> Aabb<N, D> {
        let limit = body.query_limit() + self.skin(body.index());
        match self.prediction(body) {
            None => grown(aabb, limit),
            Some(next) => {
                let next = body.aabb_at(&N::pose(next));
                grown(&aabb.merged(&next), limit)
            }
        }
    }

    /// Discards the changes and the skin of an object that is being removed. The last entry of the
    /// list moves to the index of the object's entry: returns the handle index of its object, and
    /// its new index. `None` if no entry moves.
    pub(crate) fn forget(&mut self, body: &WorldBody<N, D>) -> Option<(u32, u32)> {
        if let Some(skin) = self.skins.get_mut(body.index() as usize) {
            *skin = N::ZERO;
        }
        if let Some(tree) = self.dirty.get_mut()
            && let Some(id) = tree.id_of(body)
        {
            entries::take_dirty::<N, D>(tree, id);
        }
        let change_index = body.change_index()?;
        self.entries.swap_remove(change_index as usize);
        let &BodyEntry { index, changes, .. } = self.entries.get(change_index as usize)?;
        if let Some(tree) = self.dirty.get_mut().filter(|tree| changes.volume && !tree.has_all()) {
            let last = u32::try_from(self.entries.len()).expect("no more entries than handles");
            entries::take_dirty::<N, D>(tree, last);
            self.update_dirty_tree(index, change_index);
        }
        Some((index, change_index))
    }

    /// Returns `true` if the volume of the object in the broad phase is out of date.
    #[inline]
    pub(crate) fn is_dirty(&self, body: &WorldBody<N, D>) -> bool {
        body.change_index()
            .is_some_and(|change_index| self.entries[change_index as usize].changes.volume)
    }

    /// Returns the number of dirty objects.
    pub(crate) fn num_dirty(&self) -> usize {
        self.dirty_indices().count()
    }

    /// Iterates over the dirty objects: the index of the entry in this list, and the object's box,
    /// grown by the slack for rounding.
    pub(crate) fn dirty_boxes(&self) -> impl Iterator<Item = (u32, Aabb<N, D>)> {
        self.dirty_indices().map(|change_index| (change_index, self.box_at(change_index)))
    }

    /// Returns the box of a dirty object, grown by the slack for rounding; `None` if the object is
    /// not dirty.
    pub(crate) fn dirty_box(&self, body: &WorldBody<N, D>) -> Option<Aabb<N, D>> {
        let change_index = body.change_index().filter(|_| self.is_dirty(body))?;
        Some(self.box_at(change_index))
    }

    fn dirty_indices(&self) -> impl Iterator<Item = u32> {
        let dirty = (0..).zip(&self.entries).filter(|(_, entry)| entry.changes.volume);
        dirty.map(|(change_index, _)| change_index)
    }

    /// Returns the box of the dirty object at index `change_index`, grown by the slack for
    /// rounding.
    fn box_at(&self, change_index: u32) -> Aabb<N, D> {
        grown(&self.entries[change_index as usize].aabb, N::ZERO)
    }

    /// Returns the tree that queries search in addition to the broad phase, or instead of the broad
    /// phase if the tree has the boxes of all objects. If there is no tree, builds it with `make`.
    /// `None` if no object changed since the last update.
    pub(crate) fn dirty_tree(&self, make: impl FnOnce() -> DirtyTree<D>) -> Option<&DirtyTree<D>> {
        if self.entries.is_empty() {
            return None;
        }
        if let Some(tree) = self.existing_dirty_tree() {
            return Some(tree);
        }
        // `make` runs without a lock: a thread that waits for others to sort their part of the
        // boxes may start another query, which must not wait for this one.
        let made = make();
        Some(self.dirty.get_or_init(|| made))
    }

    /// Returns the tree of dirty objects. `None` if no query has built it since the last update, or
    /// since changes made it need a rebuild.
    pub(crate) fn existing_dirty_tree(&self) -> Option<&DirtyTree<D>> {
        self.dirty.get()
    }

    /// Returns the handle index of the object with id `id` in the tree.
    #[inline]
    pub(crate) fn dirty_index(&self, tree: &DirtyTree<D>, id: u32) -> u32 {
        if tree.has_all() { id } else { self.entries[id as usize].index }
    }

    /// Collects the handle indices of the changed objects, sorted. The list has the memory of the
    /// list that was last passed to [`Self::clear`]; pass this list to it, too.
    pub(crate) fn take_order(&mut self) -> Vec<u32> {
        let mut order = core::mem::take(&mut self.order);
        order.extend(self.waiting());
        order.sort_unstable();
        order
    }

    /// Iterates over the handle indices of the changed objects.
    pub(super) fn waiting(&self) -> impl Iterator<Item = u32> + '_ {
        self.entries.iter().map(|entry| entry.index)
    }

    /// Writes the changes of an object to the targets, and marks the object as unchanged. Does
    /// nothing if the object is not in the list.
    pub(crate) fn flush(
        &mut self,
        body: &mut WorldBody<N, D>,
        targets: &mut ChangeTargets<'_, N, D>,
    ) {
        let Some(change_index) = body.change_index() else { return };
        let BodyEntry { changes, aabb, .. } = self.entries[change_index as usize];
        body.clear_change_index();
        if body.wants_self_pair() != body.has_self_pair() {
            body.toggle_self_pair();
            self.self_changed.push(body.index());
        }
        if changes.row {
            targets.table.set_skin(body.index(), self.skin(body.index()));
            targets.table.set(body.index(), || body.row());
        } else if changes.volume {
            targets.table.set_position(body.index(), &body.isometry);
        }
        if changes.algorithm {
            targets.algorithms.push(body.index());
        }
        if changes.volume {
            let volume = self.volume_around(body, &aabb);
            targets.broad_phase.deferred_set_bounding_volume(body.proxy, volume);
        }
        if changes.filter {
            targets.broad_phase.deferred_recompute_all_proximities_with(body.proxy);
        }
    }

    /// Clears all changes, except the list of objects whose pair with themselves begins or ends.
    /// `order` is the list from [`Self::take_order`], whose memory the next call reuses.
    pub(crate) fn clear(&mut self, mut order: Vec<u32>) {
        order.clear();
        self.order = order;
        self.entries.clear();
        self.dirty.take();
    }

    /// Takes the handle indices of the objects whose pair with themselves begins or ends, as
    /// collected by [`Self::flush`] since the last call.
    pub(crate) fn take_self_changed(&mut self) -> Vec<u32> {
        core::mem::take(&mut self.self_changed)
    }

    /// Returns the number of changed objects.
    pub(crate) const fn len(&self) -> usize {
        self.entries.len()
    }

    /// Releases the memory of lists that have been short for some time.
    pub(crate) fn give_back(&mut self, look: Look) {
        look.trim(&mut self.entries);
        look.fit(&mut self.predictions);
        look.fit(&mut self.skins);
        look.trim(&mut self.order);
    }

    /// Records the new box of an object that moved.
    #[inline(always)]
    pub(super) fn note_box(&mut self, body: &mut WorldBody<N, D>, aabb: Aabb<N, D>) {
        self.note_volume(body, aabb);
    }

    /// Records that the shape, query type or skin of an object has changed.
    pub(super) fn note_row(&mut self, body: &mut WorldBody<N, D>) {
        let changes = self.note_volume(body, body.aabb());
        (changes.row, changes.algorithm) = (true, true);
    }

    /// Records that the pairs of an object must be filtered again.
    pub(super) fn note_filter(&mut self, body: &mut WorldBody<N, D>) {
        let change_index = self.note(body);
        self.entries[change_index as usize].changes.filter = true;
    }

    #[inline(always)]
    fn note_volume(&mut self, body: &mut WorldBody<N, D>, aabb: Aabb<N, D>) -> &mut BodyChanges {
        let change_index = self.note(body);
        let entry = &mut self.entries[change_index as usize];
        entry.aabb = aabb;
        entry.changes.volume = true;
        if self.dirty.get_mut().is_some() {
            self.update_dirty_tree(body.index(), change_index);
        }
        &mut self.entries[change_index as usize].changes
    }

    /// Updates the box of the object with handle index `index` in the dirty tree. Drops the tree if
    /// it has had so many changes that it needs a rebuild.
    #[cold]
    fn update_dirty_tree(&mut self, index: u32, change_index: u32) {
        let aabb = self.box_at(change_index);
        let Some(tree) = self.dirty.get_mut() else { return };
        let id = if tree.has_all() { index } else { change_index };
        entries::put_dirty(tree, id, &aabb);
        if tree.needs_rebuild() {
            self.dirty.take();
        }
    }

    /// Adds an object to the list, unless it is already there; returns its index in the list.
    #[inline]
    fn note(&mut self, body: &mut WorldBody<N, D>) -> u32 {
        body.change_index().unwrap_or_else(|| {
            let change_index = body.set_change_index(self.entries.len());
            let (index, changes) = (body.index(), BodyChanges::default());
            self.entries.push(BodyEntry { index, changes, aabb: Aabb::unbounded() });
            change_index
        })
    }

    pub(super) fn entries(&self) -> &[BodyEntry<N, D>] {
        &self.entries
    }

    /// Replaces the entries by `entries` and drops the tree of dirty objects, for a rewind.
    pub(super) fn go_back(&mut self, entries: &[BodyEntry<N, D>]) {
        self.entries.clear();
        self.entries.extend_from_slice(entries);
        self.dirty.take();
    }

    /// Returns the pose in `predictions` at a handle index, which is meaningless for an object
    /// without a prediction; `None` beyond the end of the array.
    pub(super) fn known_prediction(&self, index: u32) -> Option<N::Isometry> {
        self.predictions.get(index as usize).copied()
    }

    /// Restores the skin and the stored predicted pose of an object, for a rewind.
    pub(super) fn keep(&mut self, index: u32, skin: N, prediction: Option<N::Isometry>) {
        if skin != self.skin(index) {
            self.put_skin(index, skin);
        }
        if let Some(prediction) = prediction {
            self.predict(index, prediction);
        }
    }

    /// Returns the changes of an object since the last update; `None` if the object is not in the
    /// list.
    #[cfg(feature = "serde")]
    pub(super) fn of_body(&self, body: &WorldBody<N, D>) -> Option<BodyChanges> {
        body.change_index().map(|change_index| self.entries[change_index as usize].changes)
    }

    /// Restores the changes of an object since the last update, for an object of a saved world.
    #[cfg(feature = "serde")]
    pub(super) fn restore_changes(&mut self, body: &mut WorldBody<N, D>, changes: BodyChanges) {
        let (change_index, aabb) = (self.note(body), body.aabb());
        let entry = &mut self.entries[change_index as usize];
        entry.changes = changes;
        if changes.volume {
            entry.aabb = aabb;
        }
    }

    /// Checks that the entry at the body's index in the list belongs to the body's object; no check
    /// if the body is not in the list.
    pub(crate) fn validate(&self, body: &WorldBody<N, D>) -> Result<(), String> {
        match body.change_index().map(|change_index| self.entries.get(change_index as usize)) {
            Some(entry) if entry.map(|entry| entry.index) != Some(body.index()) => {
                Err(format!("{:?} has the place of another among the changes", body.handle))
            }
            _ => Ok(()),
        }
    }
}
