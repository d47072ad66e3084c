//! Rewinding the narrow phase to a mark.
//!
//! Each pair returns to the row of its group that it had at the mark, because contacts are read in
//! the order of the rows. The order of the pair table affects no result, so its pairs are simply
//! inserted and removed.

use super::default_narrow_phase::NOWHERE;
use super::entry::{ContactEntry, CustomContactEntry, CustomProximityEntry, ProximityEntry};
use super::group::{Group, PairKey, set_touching};
use super::pair_groups::{GroupId, Location, PairGroups};
use super::state::{CompositeState, ContactState};
use super::{DefaultNarrowPhase, IdAllocator, ObjectTable};
use smallvec::SmallVec;

use crate::collide::{PairIds, RawManifold, RawPoint};
use crate::journal::Journal;
use crate::math::{Pose, Real, Space, Vector};

/// All data of one row of a group: a pair with its flags, its state and its reference.
#[derive(Clone, Debug)]
pub(crate) struct GroupRow<S, R> {
    key: PairKey,
    is_dirty: bool,
    is_touching: bool,
    state: S,
    /// `None` if the group has no references.
    reference: Option<R>,
}

/// The state of a pair, which is recorded in three parts: a head of constant size, the points in a
/// list of their own, and the rest, which most pairs do not have. So the note of a pair without
/// contacts takes less memory than the note of a pair with four.
pub(crate) trait Parts: Clone {
    type Head: Copy;
    type Rest;
    type Point: Copy;

    /// Returns the data of constant size that an update may change.
    fn head(&self) -> Self::Head;

    /// Returns the data that is neither in the head nor in the points; `None` if there is none.
    fn rest(&self) -> Option<Self::Rest>;

    /// Returns the points.
    fn points(&self) -> &[Self::Point];

    /// Restores the state from its parts; `reversed` yields the points in reverse order.
    fn put_together(
        &mut self,
        head: Self::Head,
        rest: Option<Self::Rest>,
        reversed: impl Iterator<Item = Self::Point>,
    );
}

/// The head of the contacts of two convex solids.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ContactHead<N: Real, const D: usize> {
    normal: Vector<N, D>,
    ids: PairIds,
    is_swapped: bool,
}

impl<N: Space<D>, const D: usize> Parts for ContactEntry<N, ContactState<N, D>> {
    type Head = ContactHead<N, D>;
    type Rest = Pose<N, D>;
    type Point = RawPoint<N, D>;

    fn head(&self) -> Self::Head {
        let (RawManifold { normal, ids, .. }, is_swapped) = self.state.kept();
        ContactHead { normal: *normal, ids: *ids, is_swapped }
    }

    /// Returns the pose of [`RawManifold::pose12`].
    fn rest(&self) -> Option<Self::Rest> {
        self.state.kept().0.pose12
    }

    fn points(&self) -> &[Self::Point] {
        &self.state.kept().0.points
    }

    fn put_together(
        &mut self,
        head: Self::Head,
        pose12: Option<Self::Rest>,
        reversed: impl Iterator<Item = Self::Point>,
    ) {
        let ContactHead { normal, ids, is_swapped } = head;
        let mut points: SmallVec<_> = reversed.collect();
        points.reverse();
        self.state.keep(RawManifold { normal, ids, points, pose12 }, is_swapped);
    }
}

/// Implements [`Parts`] for states that are recorded whole, as rests.
macro_rules! whole {
    ($([$($generics:tt)*] $type:ty;)*) => {
        $(impl<$($generics)*> Parts for $type {
            type Head = ();
            type Rest = Self;
            type Point = ();

            fn head(&self) {}

            fn rest(&self) -> Option<Self> {
                Some(self.clone())
            }

            fn points(&self) -> &[()] {
                &[]
            }

            fn put_together(&mut self, (): (), rest: Option<Self>, _: impl Iterator<Item = ()>) {
                if let Some(whole) = rest {
                    *self = whole;
                }
            }
        })*
    };
}

whole! {
    [N: Real, const D: usize] ContactEntry<N, CompositeState<N, D>>;
    [N: Real] ProximityEntry<N>;
    [N: Space<D>, const D: usize] CustomContactEntry<N, D>;
    [N: Space<D>, const D: usize] CustomProximityEntry<N, D>;
}

#[cfg(test)]
whole! {
    [] u32;
}

/// A change of a group, which can be undone.
pub(crate) enum GroupNote<S: Parts> {
    /// A pair was added in a new last row.
    Pushed,
    /// The row of a removed pair, to which the last pair of the group moved. The journal also has
    /// all data of the removed pair, as [`KeptPair::Row`].
    Removed(u32),
    /// The row of a pair before a change other than an update, or before its replacement by another
    /// pair. The journal also has all data of the old pair, as [`KeptPair::Row`].
    Replaced(u32),
    /// A pair before an update computed it. Its points are in [`Group::point_journal`].
    Written(WrittenPair<S::Head>),
}

/// The data of constant size of a [`GroupNote::Written`].
pub(crate) struct WrittenPair<H> {
    head: H,
    row: u32,
    num_points: u32,
    is_dirty: bool,
    is_touching: bool,
    /// Whether the journal also has the rest of the state and the reference, as
    /// [`KeptPair::Written`].
    is_kept: bool,
}

/// The data of a [`GroupNote`] that few pairs have or that owns memory.
pub(crate) enum KeptPair<S: Parts, R> {
    Row(Box<GroupRow<S, R>>),
    Written { rest: Option<S::Rest>, reference: Option<R> },
}

impl<S: Parts, V: Default, R: Clone + Default> Group<S, V, R> {
    fn row(&self, row: u32) -> Box<GroupRow<S, R>> {
        let at = row as usize;
        Box::new(GroupRow {
            key: self.keys[at],
            is_dirty: self.dirty[at],
            is_touching: self.is_touching(row),
            state: self.states[at].clone(),
            reference: self.reference(at),
        })
    }

    fn reference(&self, at: usize) -> Option<R> {
        self.references.as_ref().map(|references| references[at].clone())
    }

    /// Records the pairs in the given rows before an update computes them, each pair only once
    /// between two marks. Does nothing if there are no marks.
    pub(super) fn note(&mut self, rows: impl Iterator<Item = u32>) {
        if self.journal.is_on() {
            rows.for_each(|row| self.note_once(row));
        }
    }

    #[inline]
    fn note_once(&mut self, row: u32) {
        let noted = &mut self.noted[row as usize];
        if *noted < self.period {
            *noted = self.period;
            self.note_one(row);
        }
    }

    fn note_one(&mut self, row: u32) {
        let at = row as usize;
        let (state, is_dirty, is_touching) =
            (&self.states[at], self.dirty[at], self.is_touching(row));
        let (head, rest, points) = (state.head(), state.rest(), state.points());
        let num_points = u32::try_from(points.len()).expect("few enough points for ids");
        let reference = self.reference(at);
        let is_kept = rest.is_some() || reference.is_some();
        if is_kept {
            self.journal.keep(KeptPair::Written { rest, reference });
        }
        let written = WrittenPair { head, row, num_points, is_dirty, is_touching, is_kept };
        self.journal.note(GroupNote::Written(written));
        self.point_journal.note_all(points);
    }

    /// Records all data of the pair in a row before a change other than an update, each pair only
    /// once between two marks. Does nothing if there are no marks.
    pub(super) fn note_whole(&mut self, row: u32) {
        let (is_on, whole) = (self.journal.is_on(), self.period + 1);
        if is_on && core::mem::replace(&mut self.noted[row as usize], whole) != whole {
            self.journal.note_kept(GroupNote::Replaced(row), KeptPair::Row(self.row(row)));
        }
    }

    /// Records all data of the pair in a row before its removal. Does nothing if there are no
    /// marks.
    pub(super) fn note_removed(&mut self, row: u32) {
        if self.journal.is_on() {
            self.journal.note_kept(GroupNote::Removed(row), KeptPair::Row(self.row(row)));
            self.noted.swap_remove(row as usize);
        }
    }

    /// Records the pairs that the update is about to compute.
    fn note_dirty<N: Space<D>, const D: usize>(&mut self, table: &ObjectTable<N, D>) {
        let end = if self.journal.is_on() { self.keys.len() } else { 0 };
        for at in 0..end {
            let [first, second] = self.keys[at];
            if self.dirty[at] || table.has_changed(first) || table.has_changed(second) {
                self.note_once(u32::try_from(at).expect("fewer than 2^32 pairs fit in memory"));
            }
        }
    }

    /// Sets a mark, unless the group is empty and has no older mark.
    fn mark(&mut self, number: u64) {
        if !self.is_empty() || self.journal.is_on() {
            self.journal.mark(number, ());
            self.point_journal.mark(number, ());
            self.noted.resize(self.keys.len(), 0);
            self.begin_period();
        }
    }

    fn begin_period(&mut self) {
        self.period = self.period.wrapping_add(2);
        if self.period == 0 {
            self.noted.fill(0);
            self.period = 2;
        }
    }

    fn forget_before(&mut self, number: u64) {
        if self.journal.is_on() {
            self.journal.forget_before(number);
            self.point_journal.forget_before(number);
            if !self.journal.is_on() {
                self.noted = Vec::new();
            }
        }
    }

    /// Undoes all changes of the group since a mark. Returns the pairs that left it, and the rows in
    /// which another pair may stand now.
    fn rewind(&mut self, number: u64) -> (Vec<PairKey>, Vec<u32>) {
        let (mut left, mut changed) = (Vec::new(), Vec::new());
        let mut journal = core::mem::take(&mut self.journal);
        if !journal.has(number) {
            // A group without this mark was empty when the mark was set.
            left.extend_from_slice(&self.keys);
            while !self.is_empty() {
                self.pop();
            }
            (self.point_journal, self.noted) = (Journal::default(), Vec::new());
            return (left, changed);
        }
        while let Some(note) = journal.undo(number) {
            match note {
                GroupNote::Written(written) => {
                    let kept = written.is_kept.then(|| journal.take_kept());
                    self.undo_update(written, kept, number);
                }
                GroupNote::Pushed => {
                    left.extend(self.keys.last());
                    self.pop();
                }
                GroupNote::Replaced(row) => {
                    if let KeptPair::Row(kept) = journal.take_kept() {
                        left.push(self.keys[row as usize]);
                        self.put_row(row, *kept);
                        changed.push(row);
                    }
                }
                GroupNote::Removed(row) => {
                    let KeptPair::Row(kept) = journal.take_kept() else { continue };
                    let last = self.push(kept.key, kept.state.clone(), false);
                    if row != last {
                        self.put_row(last, *self.row(row));
                    }
                    self.put_row(row, *kept);
                    changed.extend([row, last]);
                }
            }
        }
        let _ = self.point_journal.undo(number);
        self.journal = journal;
        self.noted.resize(self.keys.len(), 0);
        self.begin_period();
        (left, changed)
    }

    /// Restores a pair that updates have computed since it was noted.
    fn undo_update(
        &mut self,
        written: WrittenPair<S::Head>,
        kept: Option<KeptPair<S, R>>,
        number: u64,
    ) {
        let WrittenPair { head, row, num_points, is_dirty, is_touching, .. } = written;
        let (rest, reference) = match kept {
            Some(KeptPair::Written { rest, reference }) => (rest, reference),
            Some(KeptPair::Row(_)) | None => (None, None),
        };
        let points = (0..num_points).map_while(|_| self.point_journal.undo(number));
        self.states[row as usize].put_together(head, rest, points);
        self.put(row, is_dirty, is_touching, reference);
    }

    fn pop(&mut self) {
        if let Some(last) = self.keys.len().checked_sub(1) {
            self.swap_remove(u32::try_from(last).expect("fewer than 2^32 pairs fit in memory"));
        }
    }

    fn put_row(&mut self, row: u32, kept: GroupRow<S, R>) {
        let GroupRow { key, is_dirty, is_touching, state, reference } = kept;
        (self.keys[row as usize], self.states[row as usize]) = (key, state);
        self.put(row, is_dirty, is_touching, reference);
    }

    fn put(&mut self, row: u32, is_dirty: bool, is_touching: bool, reference: Option<R>) {
        let at = row as usize;
        self.dirty[at] = is_dirty;
        set_touching(&mut self.touching, at, is_touching);
        if let Some(views) = self.views.get_mut() {
            views[at] = V::default();
        }
        if let Some((references, reference)) = self.references.as_mut().zip(reference) {
            references[at] = reference;
        }
    }
}

/// Runs `action` for each group, with its [`GroupId`].
macro_rules! each_group {
    ($groups:expr, |$id:pat_param, $group:ident| $action:expr) => {{
        let PairGroups { contacts, composites, proximity, custom_contacts, custom_proximity } =
            $groups;
        for (number, $group) in contacts.numbered_mut() {
            let $id = GroupId::Contacts(number);
            $action;
        }
        for (number, $group) in proximity.numbered_mut() {
            let $id = GroupId::Proximity(number);
            $action;
        }
        {
            let ($id, $group) = (GroupId::Composites, composites);
            $action;
        }
        {
            let ($id, $group) = (GroupId::CustomContacts, custom_contacts);
            $action;
        }
        {
            let ($id, $group) = (GroupId::CustomProximity, custom_proximity);
            $action;
        }
    }};
}

impl<N: Space<D>, const D: usize> PairGroups<N, D> {
    /// Records the pairs at the locations `picked`, which are all in one group, before they are
    /// computed. Does nothing if there are no marks.
    pub(super) fn note(&mut self, picked: &[Location]) {
        let rows = picked.iter().map(|at| at.row);
        match picked[0].group {
            GroupId::Contacts(number) => self.contacts.of_mut(number).note(rows),
            GroupId::Composites => self.composites.note(rows),
            GroupId::Proximity(number) => self.proximity.of_mut(number).note(rows),
            GroupId::CustomContacts => self.custom_contacts.note(rows),
            GroupId::CustomProximity => self.custom_proximity.note(rows),
            GroupId::Nothing => {}
        }
    }

    /// Records the pairs that the update is about to compute.
    pub(super) fn note_dirty(&mut self, table: &ObjectTable<N, D>) {
        each_group!(self, |_, group| group.note_dirty(table));
    }
}

/// State of the narrow phase that a mark copies as a whole: the id counter and the keys of the
/// dirty pairs.
#[derive(Clone, Debug)]
pub(crate) struct NarrowHead {
    ids: IdAllocator,
    dirty_pairs: Vec<PairKey>,
}

impl<N: Space<D>, const D: usize> DefaultNarrowPhase<N, D> {
    /// Sets a mark for a later [`Self::rewind`]; see [`Journal`](crate::journal::Journal).
    pub(crate) fn mark(&mut self, number: u64) {
        let head = NarrowHead { ids: self.ids.clone(), dirty_pairs: self.dirty_pairs.clone() };
        self.journal.mark(number, head);
        self.pairs.mark(number);
        each_group!(&mut self.groups, |_, group| group.mark(number));
    }

    /// Drops the marks whose numbers are less than `number`.
    pub(crate) fn forget_before(&mut self, number: u64) {
        self.journal.forget_before(number);
        self.pairs.forget_before(number);
        each_group!(&mut self.groups, |_, group| group.forget_before(number));
    }

    /// Undoes all changes since a mark. The cost is proportional to the number of changes.
    pub(crate) fn rewind(&mut self, number: u64) {
        let locations = &mut self.locations;
        self.pairs.rewind(number, |undone| match undone {
            Some(removed) => {
                locations.swap_remove(removed.index);
            }
            None => locations.push(NOWHERE),
        });
        let (mut left, mut placed) = (Vec::new(), Vec::new());
        each_group!(&mut self.groups, |id, group| {
            let (keys, rows) = group.rewind(number);
            left.extend(keys.into_iter().map(|key| (key, NOWHERE)));
            let place =
                |row: u32| Some((*group.keys.get(row as usize)?, Location { group: id, row }));
            placed.extend(rows.into_iter().filter_map(place));
        });
        // A pair that left one group may have been in another, or in none, when the mark was set.
        for ([first, second], location) in left.into_iter().chain(placed) {
            if let Some(index) = self.pairs.index_of(first, second) {
                self.locations[index] = location;
            }
        }
        while self.journal.undo(number).is_some() {}
        if let Some(NarrowHead { ids, dirty_pairs }) = self.journal.head() {
            self.ids = ids.clone();
            self.dirty_pairs.clone_from(dirty_pairs);
        }
        self.forget_order();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A pair that is changed again and again between two marks is noted once, and a rewind restores
    /// it although it moved to another row.
    #[test]
    fn a_changed_pair_is_noted_once() {
        let mut group = Group::<u32>::default();
        let rows = [0, 1, 2].map(|n| group.push([n, n + 1], n, false));
        assert_eq!(rows, [0, 1, 2], "in order");
        group.mark(1);
        for step in 0..100 {
            *group.state_mut(2) = 100 + step;
        }
        group.swap_remove(0);
        *group.state_mut(0) = 7;
        assert_eq!(group.journal.num_notes(), 2, "a change and a removal");
        group.push([8, 9], 8, false);
        *group.state_mut(2) = 9;
        assert_eq!(group.journal.num_notes(), 3, "an addition");
        let _ = group.rewind(1);
        let states = rows.map(|row| *group.state(row));
        assert_eq!((states, group.keys.len()), (rows, 3), "as they were");
        *group.state_mut(2) = 5;
        assert_eq!(group.journal.num_notes(), 1, "noted again after the rewind");
        group.mark(2);
        *group.state_mut(2) = 6;
        let _ = group.rewind(2);
        assert_eq!(*group.state(2), 5, "as at the second mark");
    }
}
