//! An undo journal: notes that revert the changes since a mark.
//!
//! The owner of a journal notes the old state before each change. To return to a mark, it undoes
//! the noted changes, the newest first, so that entries of dense arrays return to the indices that
//! they had at the mark. Without marks nothing is noted.
//!
//! ```text
//! marks      1       2     3
//! notes      a b c   d     e f          undo(2): f, e, d, then `None`; mark 2 stays, 3 is gone
//! kept       A             F            data of the notes a and f
//! ```
//!
//! Forgetting a mark drops its notes. If `U` owns no memory, this takes constant time; therefore
//! rare data that owns memory is kept in a separate list, as values of type `K`.

use core::fmt;
use std::collections::VecDeque;

/// Notes `U` since each mark, state `H` copied whole with each mark, and data `K` of rare notes.
pub(crate) struct Journal<U, H = (), K = ()> {
    /// The marks, the oldest first.
    marks: VecDeque<Mark<U, H, K>>,
    /// The notes since the last mark.
    notes: Notes<U, K>,
    /// Memory of removed notes, for reuse.
    spare: Vec<Notes<U, K>>,
    /// By index of an object: the period in which it was last noted, plus 1 if the whole of it was
    /// noted then.
    noted: Vec<u32>,
    /// The current period: even, and greater than 0 if there are marks. Each mark and each return
    /// to a mark begins a new period.
    period: u32,
}

struct Mark<U, H, K> {
    number: u64,
    head: H,
    /// The notes until the next mark; empty for the last mark.
    notes: Notes<U, K>,
}

struct Notes<U, K> {
    list: Vec<U>,
    kept: Vec<K>,
}

impl<U, K> Default for Notes<U, K> {
    fn default() -> Self {
        Self { list: Vec::new(), kept: Vec::new() }
    }
}

impl<U, H, K> Default for Journal<U, H, K> {
    fn default() -> Self {
        let (marks, notes, spare) = (VecDeque::new(), Notes::default(), Vec::new());
        Self { marks, notes, spare, noted: Vec::new(), period: 0 }
    }
}

impl<U, H, K> fmt::Debug for Journal<U, H, K> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Journal").field("marks", &self.marks.len()).finish_non_exhaustive()
    }
}

/// A clone has no marks.
impl<U, H, K> Clone for Journal<U, H, K> {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl<U, H, K> Journal<U, H, K> {
    /// Returns the number of notes since the last mark.
    #[cfg(test)]
    pub(crate) const fn num_notes(&self) -> usize {
        self.notes.list.len()
    }

    /// Returns `true` if there is a mark. Changes must then be noted.
    #[inline]
    pub(crate) fn is_on(&self) -> bool {
        !self.marks.is_empty()
    }

    /// Returns `true` if there are marks and the object with this index has not been noted since
    /// the last mark or return to a mark. From then on it counts as noted.
    #[inline]
    pub(crate) fn is_first(&mut self, index: usize) -> bool {
        // Without marks the period is 0, and `noted` is empty.
        let period = self.period;
        match self.noted.get_mut(index) {
            Some(noted) => {
                let is_first = *noted < period;
                *noted = (*noted).max(period);
                is_first
            }
            None => self.is_on() && self.grow_noted(index, period),
        }
    }

    /// Returns `true` if there are marks and the object with this index has not been noted as a
    /// whole since the last mark or return to a mark. From then on it counts as noted as a whole,
    /// and [`Self::is_first`] returns `false` too.
    #[inline]
    pub(crate) fn is_first_whole(&mut self, index: usize) -> bool {
        let whole = self.period + 1;
        match self.noted.get_mut(index) {
            Some(noted) => core::mem::replace(noted, whole) != whole,
            None => self.is_on() && self.grow_noted(index, whole),
        }
    }

    /// Extends [`Self::noted`] to an index, and sets its entry. Returns `true`.
    #[cold]
    fn grow_noted(&mut self, index: usize, period: u32) -> bool {
        self.noted.resize(index, 0);
        self.noted.push(period);
        true
    }

    /// Adds the note that reverts a change, if there is a mark.
    #[inline]
    pub(crate) fn note(&mut self, undo: U) {
        if self.is_on() {
            self.notes.list.push(undo);
        }
    }

    /// Adds several notes in their order, if there is a mark. [`Self::undo`] returns the last of
    /// them first.
    #[inline]
    pub(crate) fn note_all(&mut self, undo: &[U])
    where
        U: Copy,
    {
        if self.is_on() {
            self.notes.list.extend_from_slice(undo);
        }
    }

    /// Adds a note, if there is a mark, and keeps its data, which [`Self::take_kept`] returns.
    pub(crate) fn note_kept(&mut self, undo: U, data: K) {
        self.keep(data);
        self.note(undo);
    }

    /// Keeps the data of the note that is added next, if there is a mark.
    pub(crate) fn keep(&mut self, data: K) {
        if self.is_on() {
            self.notes.kept.push(data);
        }
    }

    /// Takes the data of the note that [`Self::undo`] has just returned. The owner must call this
    /// for each note with data, before the next call of [`Self::undo`].
    pub(crate) fn take_kept(&mut self) -> K {
        self.notes.kept.pop().expect("the note was made with data")
    }

    /// Sets the mark `number` and copies `head` with it. The numbers of successive marks must
    /// ascend.
    pub(crate) fn mark(&mut self, number: u64, head: H) {
        let notes = core::mem::replace(&mut self.notes, self.spare.pop().unwrap_or_default());
        if let Some(last) = self.marks.back_mut() {
            last.notes = notes;
        }
        self.marks.push_back(Mark { number, head, notes: Notes::default() });
        self.begin_period();
    }

    /// Drops the marks whose numbers are less than `number`, with their notes.
    pub(crate) fn forget_before(&mut self, number: u64) {
        while self.marks.front().is_some_and(|mark| mark.number < number) {
            if let Some(mark) = self.marks.pop_front() {
                self.keep_memory(mark.notes);
            }
        }
        if !self.is_on() {
            *self = Self::default();
        }
    }

    /// Returns `true` if the mark is kept.
    pub(crate) fn has(&self, number: u64) -> bool {
        self.marks.iter().any(|mark| mark.number == number)
    }

    /// Removes the newest note since mark `number` and returns it. `None` if no note is left; by
    /// then the later marks have been removed.
    pub(crate) fn undo(&mut self, number: u64) -> Option<U> {
        loop {
            if let Some(undo) = self.notes.list.pop() {
                return Some(undo);
            }
            if self.marks.back().is_none_or(|mark| mark.number <= number) {
                self.begin_period();
                return None;
            }
            self.marks.pop_back();
            let earlier = self.marks.back_mut().map(|mark| core::mem::take(&mut mark.notes));
            let notes = core::mem::replace(&mut self.notes, earlier.unwrap_or_default());
            self.keep_memory(notes);
        }
    }

    /// Returns the state copied with the last mark; `None` if there are no marks.
    pub(crate) fn head(&self) -> Option<&H> {
        self.marks.back().map(|mark| &mark.head)
    }

    fn keep_memory(&mut self, mut notes: Notes<U, K>) {
        notes.list.clear();
        notes.kept.clear();
        self.spare.push(notes);
    }

    fn begin_period(&mut self) {
        self.period = self.period.wrapping_add(2);
        if self.period == 0 {
            self.noted.fill(0);
            self.period = 2;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn notes_come_back_newest_first_up_to_the_mark() {
        let mut journal = Journal::<u32>::default();
        journal.note(0);
        assert!(!journal.is_on() && !journal.is_first(3), "without a mark nothing is noted");
        for number in 1..4 {
            journal.mark(u64::from(number), ());
            assert!(journal.is_first(3) && !journal.is_first(3), "once after each mark");
            journal.note(10 * number);
            journal.note(10 * number + 1);
        }
        journal.forget_before(2);
        assert!(!journal.has(1) && journal.has(2), "the oldest is gone");
        let undone: Vec<_> = core::iter::from_fn(|| journal.undo(2)).collect();
        assert_eq!(undone, [31, 30, 21, 20]);
        assert!(journal.has(2) && !journal.has(3), "the mark stays, later ones are gone");
        assert!(journal.is_first(3) && journal.is_first_whole(3), "a return is like a mark");
        assert!(journal.is_first_whole(4) && !journal.is_first(4), "the whole has the part");
        assert!(!journal.is_first_whole(4) && !journal.clone().is_on(), "a clone has no marks");
    }

    #[test]
    fn kept_data_comes_back_with_its_note() {
        let mut journal = Journal::<u8, (), String>::default();
        for number in 1..4 {
            journal.mark(number, ());
            journal.note(0);
            journal.note_kept(1, format!("data {number}"));
            journal.note(2);
        }
        journal.forget_before(2);
        let mut data = Vec::new();
        while let Some(note) = journal.undo(2) {
            if note == 1 {
                data.push(journal.take_kept());
            }
        }
        assert_eq!(data, ["data 3", "data 2"], "the newest first, and none of the forgotten mark");
    }

    #[test]
    fn periods_do_not_repeat_when_their_counter_wraps() {
        let mut journal = Journal::<()> { period: u32::MAX - 3, ..Journal::default() };
        journal.mark(1, ());
        assert!(journal.is_first_whole(0), "in the last period");
        journal.mark(2, ());
        assert!(journal.is_first(0) && !journal.is_first(0), "in the first");
    }
}
