//! An undo journal: notes that revert the changes since a mark.
//!
//! An owner notes the old state before it changes it. To return to a mark, it reverts its notes, the newest first, so
//! that entries of dense arrays return to their former indices. Without marks nothing is noted.
//!
//! ```text
//! marks      1           2           3
//! notes      a b c       d           e f      undo(2): f, e, d, then `None`; mark 2 stays, 3 is gone
//! ```

use core::fmt;
use std::collections::VecDeque;

/// Notes `U` since each mark, and state `H` copied whole with each mark.
pub(crate) struct Journal<U, H = ()> {
    /// One frame for each mark, the oldest first.
    frames: VecDeque<Frame<U, H>>,
    /// Memory of removed frames, for reuse.
    spare: Vec<Vec<U>>,
    /// By index of an object: the periods in which a part of it, and the whole of it, were last noted. Each mark and
    /// each return to a mark begins a period.
    noted: Vec<[u32; 2]>,
    period: u32,
}

struct Frame<U, H> {
    number: u64,
    head: H,
    notes: Vec<U>,
}

impl<U, H> Default for Journal<U, H> {
    fn default() -> Self {
        Self { frames: VecDeque::new(), spare: Vec::new(), noted: Vec::new(), period: 0 }
    }
}

impl<U, H> fmt::Debug for Journal<U, H> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Journal").field("marks", &self.frames.len()).finish_non_exhaustive()
    }
}

/// A clone has no marks.
impl<U, H> Clone for Journal<U, H> {
    fn clone(&self) -> Self {
        Self::default()
    }
}

impl<U, H> Journal<U, H> {
    /// Returns `true` if there is a mark, so that changes must be noted.
    #[inline]
    pub(crate) fn is_on(&self) -> bool {
        !self.frames.is_empty()
    }

    /// Returns `true` if there are marks and the object has not been noted since the last one; it counts as noted from
    /// then on.
    #[inline]
    pub(crate) fn is_first(&mut self, index: usize) -> bool {
        self.is_on() && self.is_first_of(index, 0)
    }

    /// As [`Self::is_first`], for a note of the whole object, which makes notes of its parts superfluous.
    #[inline]
    pub(crate) fn is_first_whole(&mut self, index: usize) -> bool {
        let is_first = self.is_on() && self.is_first_of(index, 1);
        if is_first {
            self.noted[index][0] = self.period;
        }
        is_first
    }

    fn is_first_of(&mut self, index: usize, part: usize) -> bool {
        if self.noted.len() <= index {
            self.noted.resize(index + 1, [0; 2]);
        }
        core::mem::replace(&mut self.noted[index][part], self.period) != self.period
    }

    /// Adds the note that reverts a change, if there is a mark.
    #[inline]
    pub(crate) fn note(&mut self, undo: U) {
        if let Some(frame) = self.frames.back_mut() {
            frame.notes.push(undo);
        }
    }

    /// Sets a mark. Numbers must ascend.
    pub(crate) fn mark(&mut self, number: u64, head: H) {
        let notes = self.spare.pop().unwrap_or_default();
        self.frames.push_back(Frame { number, head, notes });
        self.end_period();
    }

    /// Drops the marks with smaller numbers.
    pub(crate) fn forget_before(&mut self, number: u64) {
        while self.frames.front().is_some_and(|frame| frame.number < number) {
            if let Some(frame) = self.frames.pop_front() {
                self.keep_memory(frame);
            }
        }
        if !self.is_on() {
            *self = Self::default();
        }
    }

    /// Returns `true` if the mark is kept.
    pub(crate) fn has(&self, number: u64) -> bool {
        self.frames.iter().any(|frame| frame.number == number)
    }

    /// Takes the newest note since a mark; `None` when there is none left. By then later marks are gone.
    pub(crate) fn undo(&mut self, number: u64) -> Option<U> {
        while let Some(frame) = self.frames.back_mut() {
            if let Some(undo) = frame.notes.pop() {
                return Some(undo);
            }
            if frame.number <= number {
                break;
            }
            let frame = self.frames.pop_back()?;
            self.keep_memory(frame);
        }
        self.end_period();
        None
    }

    /// Returns the state copied with the last mark.
    pub(crate) fn head(&self) -> Option<&H> {
        self.frames.back().map(|frame| &frame.head)
    }

    fn keep_memory(&mut self, frame: Frame<U, H>) {
        let mut notes = frame.notes;
        notes.clear();
        self.spare.push(notes);
    }

    fn end_period(&mut self) {
        self.period = self.period.wrapping_add(1);
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
        assert!(!journal.clone().is_on(), "a clone has no marks");
    }
}
