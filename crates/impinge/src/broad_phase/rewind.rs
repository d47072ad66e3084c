//! Rewinds the broad phase to a mark.
//!
//! A rewind restores the state that determines pairs: exact and loosened boxes, the set of objects,
//! waiting changes, and the pairs. The positions of objects in the trees affect only time, and are
//! not restored.

use super::finder::{Container, Waiting, small};
use super::{DBVTBroadPhase, PairFinder, ProxyHandle};
use crate::bounding_volume::Aabb;
use crate::bvh::{Bounds, NONE};
use crate::math::{Real, Space};

/// A change of the set of objects, with the data that undoing it needs.
#[derive(Clone, Debug)]
pub(super) enum ProxyNote<T> {
    Created(ProxyHandle),
    /// A removed object with its data.
    Removed(ProxyHandle, Option<T>),
}

/// The state of an object before its first change since a mark.
#[derive(Clone, Copy, Debug)]
pub(super) struct BoxNote<N: Real, const D: usize> {
    id: u32,
    exact: Aabb<N, D>,
    loose: Bounds<D>,
    home: Container,
}

/// The changes that waited for the next update when a mark was set: boxes, and objects to be
/// filtered again.
#[derive(Clone, Debug)]
pub(super) struct FinderHead<N: Real, const D: usize> {
    waiting: Vec<Waiting<N, D>>,
    again: Vec<u32>,
    is_all_again: bool,
}

impl<N: Space<D>, const D: usize, T> DBVTBroadPhase<N, Aabb<N, D>, T> {
    /// Sets a mark with this number; see [`Journal`](crate::journal::Journal).
    pub(crate) fn mark(&mut self, number: u64) {
        self.journal.mark(number, ());
        self.finder.add_mark(number);
    }

    /// Drops the marks with a number less than `number`.
    pub(crate) fn forget_before(&mut self, number: u64) {
        self.journal.forget_before(number);
        self.finder.journal.forget_before(number);
        self.finder.pairs.forget_before(number);
    }

    /// Undoes all changes since the mark `number`. The cost is O(k log n) for k changed objects of
    /// n.
    pub(crate) fn rewind(&mut self, number: u64) {
        while let Some(note) = self.journal.undo(number) {
            match note {
                ProxyNote::Created(handle) => {
                    self.handles.uncreate(handle);
                    self.proxies[handle.uid()] = None;
                }
                ProxyNote::Removed(handle, data) => {
                    self.handles.unremove(handle);
                    self.proxies[handle.uid()] = data;
                }
            }
        }
        self.finder.rewind(number);
    }
}

impl<N: Real, const D: usize> PairFinder<N, D> {
    fn add_mark(&mut self, number: u64) {
        // `changes` is not empty here only after a filter panicked.
        let again = self.to_refilter.iter().chain(&self.changes).copied().collect();
        let (waiting, is_all_again) = (self.waiting.clone(), self.refilters_all);
        self.journal.mark(number, FinderHead { waiting, again, is_all_again });
        self.pairs.mark(number);
    }

    /// Records boxes and container of an object before its first change since the latest mark; does
    /// nothing if there are no marks.
    pub(super) fn note(&mut self, id: u32) {
        let index = id as usize;
        if self.journal.is_first(index) {
            let (exact, loose, home) =
                (self.exact[index], self.loose[index], self.containers[index]);
            self.journal.note(BoxNote { id, exact, loose, home });
        }
    }

    fn rewind(&mut self, number: u64) {
        let mut journal = core::mem::take(&mut self.journal);
        for id in self.changes.drain(..) {
            self.marks[id as usize] = 0;
        }
        self.searched.clear();
        for Waiting { id, .. } in self.waiting.drain(..) {
            self.waiting_at[id as usize] = NONE;
        }
        while let Some(note) = journal.undo(number) {
            self.bring_back(&note);
        }
        self.settle_trees();
        self.pairs.rewind(number, |_| ());
        if let Some(head) = journal.head() {
            self.wait_again(head);
        }
        self.journal = journal;
    }

    /// Makes the present boxes in both trees the old boxes of the next update.
    pub(super) fn settle_trees(&mut self) {
        for tree in [&mut self.moving, &mut self.still] {
            tree.refit();
            tree.commit_boxes();
        }
    }

    fn wait_again(&mut self, head: &FinderHead<N, D>) {
        self.waiting.clone_from(&head.waiting);
        for (at, Waiting { id, .. }) in self.waiting.iter().enumerate() {
            self.waiting_at[*id as usize] = small(at);
        }
        self.to_refilter.clone_from(&head.again);
        self.refilters_all = head.is_all_again;
    }

    /// Restores the boxes and the container of an object. An object that was bounded at the mark
    /// and is bounded now stays in its present tree.
    fn bring_back(&mut self, &BoxNote { id, exact, loose, home }: &BoxNote<N, D>) {
        let index = id as usize;
        (self.exact[index], self.loose[index]) = (exact, loose);
        match (self.containers[index], home) {
            (Container::Moving, Container::Moving | Container::Still) => {
                self.moving.set_still(id, &loose);
            }
            (Container::Still, Container::Moving | Container::Still) => {
                self.still.set_still(id, &loose);
            }
            (_, Container::Nowhere) => self.remove_from_container(id),
            (_, Container::Unbounded) => {
                self.remove_from_container(id);
                self.containers[index] = Container::Unbounded;
                self.unbounded.push(id);
            }
            (_, Container::Moving | Container::Still) => {
                self.remove_from_container(id);
                self.containers[index] = Container::Moving;
                self.moving.insert_still(id, &loose);
            }
        }
    }
}
