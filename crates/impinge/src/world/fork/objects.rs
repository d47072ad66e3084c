//! The journal of a world's objects: records by which a rewind undoes changes.

use crate::math::Space;
use crate::narrow_phase::CollisionObjectHandle;
use crate::world::bodies::BodyMotion;
use crate::world::objects::Slot;
use crate::world::{CollisionObject, CollisionObjects};

/// The record of a change of the objects, by which a rewind undoes the change.
#[derive(Clone, Copy)]
pub(in crate::world) enum ObjectNote<N: Space<D>, const D: usize> {
    Added(CollisionObjectHandle),
    /// The removal of an object. The journal also has the removed object, as a [`KeptObject`].
    Removed,
    /// The first change of an object since a mark, other than a move. The journal also has the
    /// object before the change, as a [`KeptObject`].
    Changed,
    /// Handle index, pose and state of an object before its first move since a mark.
    Moved(u32, BodyMotion<N, D>),
}

/// A copy of an object, with its skin and its predicted pose, which the world stores in the list of
/// changes.
pub(in crate::world) struct KeptObject<N: Space<D>, const D: usize, T> {
    object: CollisionObject<N, D, T>,
    skin: N,
    prediction: Option<N::Isometry>,
}

impl<N: Space<D>, const D: usize, T> CollisionObjects<N, D, T> {
    /// Sets a mark for a later [`Self::rewind`]; see [`Journal`](crate::journal::Journal).
    pub(super) fn mark(&mut self, number: u64)
    where
        T: Clone,
    {
        self.cloned = Some(Clone::clone);
        self.journal.mark(number, self.changes.entries().to_vec());
        self.note_waiting();
        self.table.mark(number);
    }

    /// Drops the marks whose numbers are less than `number`.
    pub(super) fn forget_before(&mut self, number: u64) {
        self.journal.forget_before(number);
        self.table.forget_before(number);
    }

    /// Undoes all changes since a mark. The mark stays.
    pub(super) fn rewind(&mut self, number: u64) {
        while let Some(note) = self.journal.undo(number) {
            match note {
                ObjectNote::Added(handle) => self.unadd(handle),
                ObjectNote::Removed => {
                    let kept = self.journal.take_kept();
                    self.unremove(kept);
                }
                ObjectNote::Changed => {
                    let kept = self.journal.take_kept();
                    let place = self.slots[kept.object.handle().uid()].record as usize;
                    self.records[place] = self.unpack(kept);
                }
                ObjectNote::Moved(index, motion) => {
                    let place = self.slots[index as usize].record as usize;
                    self.records[place].body.set_motion(motion);
                }
            }
        }
        self.changes.go_back(self.journal.head().expect("the mark is kept"));
        self.note_waiting();
        self.table.rewind(number);
    }

    /// Undoes an addition, which must be the latest change of the slots.
    fn unadd(&mut self, handle: CollisionObjectHandle) {
        self.take_record(handle);
        if handle.generation() == self.first {
            self.slots.pop();
        } else {
            self.free.push(handle.index());
        }
    }

    /// Undoes a removal, which must be the latest change of the slots. The object becomes the last
    /// record.
    fn unremove(&mut self, kept: KeptObject<N, D, T>) {
        let (handle, object) = (kept.object.handle(), self.unpack(kept));
        let generation = handle.generation();
        let place = u32::try_from(self.records.len()).expect("no more objects than handles");
        self.slots[handle.uid()] = Slot { generation, record: place };
        if generation.next().is_some() {
            self.free.pop();
        }
        self.records.push(object);
    }

    /// Restores the skin and prediction of an object, and returns the object.
    fn unpack(&mut self, kept: KeptObject<N, D, T>) -> CollisionObject<N, D, T> {
        let KeptObject { object, skin, prediction } = kept;
        self.changes.keep(object.body.index(), skin, prediction);
        object
    }

    /// Records the object at index `place` in `records` before its first change since the latest
    /// mark. Does nothing if there are no marks.
    #[inline]
    pub(in crate::world) fn note(&mut self, place: usize) {
        if self.journal.is_on() {
            self.note_changed(place);
        }
    }

    fn note_changed(&mut self, place: usize) {
        if let Some(object) = self.records.get(place)
            && self.journal.is_first_whole(object.handle().uid())
            && let Some(kept) = self.kept(place)
        {
            self.journal.note_kept(ObjectNote::Changed, kept);
        }
    }

    /// Records pose and state of the object at index `place` in `records` before its first move
    /// since the latest mark. Does nothing if there are no marks.
    #[inline]
    pub(in crate::world) fn note_motion(&mut self, place: usize) {
        if self.journal.is_on()
            && let Some(CollisionObject { body, .. }) = self.records.get(place)
            && self.journal.is_first(body.handle.uid())
        {
            self.journal.note(ObjectNote::Moved(body.index(), body.motion()));
        }
    }

    /// Records pose and state of the objects in the list of changes, because the next update alters
    /// their state. Objects that enter the list later are recorded when they change.
    fn note_waiting(&mut self) {
        for index in self.changes.waiting().collect::<Vec<_>>() {
            self.note_motion(self.slots[index as usize].record as usize);
        }
    }

    /// Records an object before it is removed, if there are marks.
    pub(in crate::world) fn note_removed(&mut self, handle: CollisionObjectHandle) {
        if let Some(kept) = self.kept(self.slots[handle.uid()].record as usize) {
            self.journal.note_kept(ObjectNote::Removed, kept);
        }
    }

    /// Returns a copy of the object at index `place` in `records`; `None` if there are no marks or
    /// no object has this index.
    fn kept(&self, place: usize) -> Option<KeptObject<N, D, T>> {
        let cloned = self.cloned.filter(|_| self.journal.is_on())?;
        let object = self.records.get(place)?;
        let skin = self.changes.skin(object.body.index());
        let prediction = self.changes.known_prediction(object.body.index());
        Some(KeptObject { object: cloned(object), skin, prediction })
    }
}
