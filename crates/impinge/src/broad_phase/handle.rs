//! Handles of objects in a broad phase. A handle stays distinct from all later handles after its
//! object is removed.

use crate::generation::Generation;
use crate::memory::{Look, clone_fields};

/// The handle of an object in a broad phase.
///
/// A broad phase issues no handle twice, unless its world is rewound: the handle of a removed
/// object differs from those of all later objects. A [`DBVTBroadPhase`](super::DBVTBroadPhase)
/// refuses a handle of another broad phase like a stale one, unless one broad phase is a clone of
/// the other. (Broad phases are distinguished by a tag of 16 bits, which is reused after 65535
/// other handle tables.) Handles are ordered by [`Self::uid`], then by age.
///
/// ```
/// use impinge::dim2::bounding_volume::Aabb;
/// use impinge::dim2::broad_phase::{BroadPhase, DBVTBroadPhase};
/// use impinge::dim2::math::{Point, Vector};
///
/// let mut broad_phase = DBVTBroadPhase::new(0.1_f32);
/// let [a, b] = ["a", "b"].map(|name| {
///     broad_phase.create_proxy(Aabb::from_half_extents(Point::origin(), Vector::repeat(1.0)), name)
/// });
///
/// assert_eq!((a.uid(), b.uid()), (0, 1));
/// broad_phase.remove(&[a], &mut |_, _| ());
/// assert!(broad_phase.proxy(a).is_none() && broad_phase.proxy(b).is_some());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub struct ProxyHandle {
    index: u32,
    generation: Generation,
}

impl ProxyHandle {
    /// Creates a handle, for a custom broad phase. `generation` is the number of objects that had
    /// this index before. The broad phase must use each pair of arguments only once.
    #[must_use]
    pub const fn new(index: u32, generation: u16) -> Self {
        Self { index, generation: Generation::of_no_table(generation) }
    }

    /// Returns the number of objects that had this index before.
    #[must_use]
    pub const fn generation(&self) -> u16 {
        self.generation.count()
    }

    /// Returns the index in the table of handles. Indices are dense, and in order of creation until
    /// the first removal.
    ///
    /// An index is unique among the objects present at one time, but is reused after a removal.
    #[inline]
    #[must_use]
    pub const fn uid(&self) -> usize {
        self.index as usize
    }
}

/// A table that issues handles and recognises stale handles.
#[derive(Debug)]
pub(super) struct Handles {
    /// Generation of the first object at each index.
    pub(super) first: Generation,
    /// By index: the generation of the present object; if there is none, of the next object.
    pub(super) generations: Vec<Generation>,
    /// By index: whether an object with this index exists.
    pub(super) is_present: Vec<bool>,
    /// Indices without an object; the last one in the list is used next.
    pub(super) free: Vec<u32>,
}

clone_fields!([] Handles { first, generations, is_present, free });

impl Handles {
    pub(super) fn new() -> Self {
        let (generations, is_present, free) = (Vec::new(), Vec::new(), Vec::new());
        Self { first: Generation::of_new_table(), generations, is_present, free }
    }

    pub(super) fn create(&mut self) -> ProxyHandle {
        let index = self.free.pop().unwrap_or_else(|| {
            self.generations.push(self.first);
            self.is_present.push(false);
            u32::try_from(self.generations.len() - 1).expect("fewer than 2^32 handles")
        });
        self.is_present[index as usize] = true;
        self.at(index)
    }

    /// Returns the handle of the present object at an index; if there is none, of the next object.
    pub(super) fn at(&self, index: u32) -> ProxyHandle {
        ProxyHandle { index, generation: self.generations[index as usize] }
    }

    /// Releases surplus memory if the number of handles no longer grows.
    pub(super) fn fit(&mut self, look: Look) {
        look.fit(&mut self.generations);
        look.fit(&mut self.is_present);
    }

    pub(super) fn is_alive(&self, handle: ProxyHandle) -> bool {
        self.generations.get(handle.uid()) == Some(&handle.generation)
            && self.is_present[handle.uid()]
    }

    /// Undoes the last [`Self::create`], which returned `handle`.
    pub(super) fn uncreate(&mut self, handle: ProxyHandle) {
        self.is_present[handle.uid()] = false;
        if handle.generation == self.first {
            self.generations.pop();
            self.is_present.pop();
        } else {
            self.free.push(handle.index);
        }
    }

    /// Undoes the last [`Self::remove`], which received `handle`.
    pub(super) fn unremove(&mut self, handle: ProxyHandle) {
        self.is_present[handle.uid()] = true;
        self.generations[handle.uid()] = handle.generation;
        if handle.generation.next().is_some() {
            self.free.pop();
        }
    }

    /// Makes the handle stale. An index whose generations are exhausted is not reused.
    pub(super) fn remove(&mut self, handle: ProxyHandle) {
        self.is_present[handle.uid()] = false;
        if let Some(next) = handle.generation.next() {
            self.generations[handle.uid()] = next;
            self.free.push(handle.index);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn stale_handles_never_alias() {
        let mut handles = Handles::new();
        let [first, second] = [handles.create(), handles.create()];
        assert_eq!((first.uid(), second.uid()), (0, 1), "dense, in order of creation");
        handles.remove(first);
        let third = handles.create();
        assert_eq!(third.uid(), 0, "the index is used again");
        assert!(!handles.is_alive(first) && handles.is_alive(third), "the handle is not");
        assert!(first < third && third < second, "by index, then by age");
    }

    #[test]
    fn worn_out_indices_are_retired() {
        let mut handles = Handles::new();
        let mut last = handles.create();
        while last.generation() < u16::MAX {
            handles.remove(last);
            last = handles.create();
        }
        handles.remove(last);
        assert_eq!((last.uid(), handles.create().uid()), (0, 1), "index 0 has no generation left");
        assert!(!handles.is_alive(last), "gone");
    }
}
