//! The first step of an update: stores the exact boxes of moved objects, and finds the objects
//! whose exact box leaves the loosened box.

use super::finder::{Container, Waiting};
use crate::bounding_volume::Aabb;
use crate::bvh::{Bounds, NONE};
use crate::math::Real;

/// The loosened boxes and the containers of all objects, indexed by id.
pub(super) struct LooseBounds<'a, const D: usize> {
    pub(super) containers: &'a [Container],
    pub(super) loose: &'a [Bounds<D>],
}

/// The arrays to which [`Self::write`] writes: exact boxes, and the index of each object's waiting
/// box. Both are slices for the ids from `first` on, so they are indexed by `id - first`.
pub(super) struct ExactBoxes<'a, N: Real, const D: usize> {
    pub(super) first: usize,
    pub(super) exact: &'a mut [Aabb<N, D>],
    pub(super) waiting_at: &'a mut [u32],
}

impl<N: Real, const D: usize> ExactBoxes<'_, N, D> {
    /// Stores the waiting boxes as exact boxes. Lists in `outside` each object whose exact box
    /// leaves the loosened box, and each object that is in no tree. Returns the number of listed
    /// objects.
    ///
    /// `waiting` is the part of the whole list of waiting boxes that begins at index `first_at`.
    /// `outside` receives the index of each listed object's box in the whole list, and must be as
    /// long as `waiting`.
    pub(super) fn write(
        self,
        bounds: &LooseBounds<'_, D>,
        waiting: &[Waiting<N, D>],
        first_at: u32,
        outside: &mut [u32],
    ) -> usize {
        #[cfg(feature = "parallel")]
        if can_split(waiting) {
            return self.write_parallel(bounds, waiting, first_at, outside);
        }
        self.write_serial(bounds, waiting, first_at, outside)
    }

    /// Implements [`Self::write`] on one thread. The loop does not branch on the test against the
    /// loosened box, because such a branch would be hard to predict. The index of each object is
    /// written, and the next index overwrites the index of an object that stays.
    fn write_serial(
        self,
        bounds: &LooseBounds<'_, D>,
        waiting: &[Waiting<N, D>],
        first_at: u32,
        outside: &mut [u32],
    ) -> usize {
        let mut count = 0;
        for (at, Waiting { id, aabb }) in (first_at..).zip(waiting) {
            let index = *id as usize;
            self.waiting_at[index - self.first] = NONE;
            self.exact[index - self.first] = *aabb;
            let is_in_tree =
                matches!(bounds.containers[index], Container::Moving | Container::Still);
            let stays = is_in_tree & bounds.loose[index].contains(&Bounds::enclosing(aabb));
            outside[count] = at;
            count += usize::from(!stays);
        }
        count
    }
}

#[cfg(feature = "parallel")]
mod parallel {
    use super::super::finder::small;
    use super::{ExactBoxes, LooseBounds, Waiting};
    use crate::math::Real;

    /// Maximum number of waiting boxes in one task.
    const MAX_SERIAL: usize = 4096;

    /// Returns `true` if there are several threads, the list is long enough, and its ids ascend.
    /// Ascending ids ensure that the two halves of the list write to disjoint slices.
    pub(super) fn can_split<N: Real, const D: usize>(waiting: &[Waiting<N, D>]) -> bool {
        waiting.len() > MAX_SERIAL
            && rayon::current_num_threads() > 1
            && waiting.is_sorted_by_key(|waiting| waiting.id)
    }

    impl<N: Real, const D: usize> ExactBoxes<'_, N, D> {
        /// Implements [`Self::write`] on several threads: halves the list recursively into parts of
        /// at most [`MAX_SERIAL`] boxes. [`can_split`] must hold for the whole list.
        pub(super) fn write_parallel(
            self,
            bounds: &LooseBounds<'_, D>,
            waiting: &[Waiting<N, D>],
            first_at: u32,
            outside: &mut [u32],
        ) -> usize {
            if waiting.len() <= MAX_SERIAL {
                return self.write_serial(bounds, waiting, first_at, outside);
            }
            let middle = waiting.len() / 2;
            let (waiting1, waiting2) = waiting.split_at(middle);
            let (outside1, outside2) = outside.split_at_mut(middle);
            let (left, right) = self.split(waiting2[0].id as usize);
            let middle_at = first_at + small(middle);
            let (count1, count2) = rayon::join(
                || left.write_parallel(bounds, waiting1, first_at, outside1),
                || right.write_parallel(bounds, waiting2, middle_at, outside2),
            );
            outside.copy_within(middle..middle + count2, count1);
            count1 + count2
        }
    }

    impl<'a, N: Real, const D: usize> ExactBoxes<'a, N, D> {
        /// Splits the slices into those of the ids below `id` and those of the ids from `id` on.
        fn split(self, id: usize) -> (Self, Self) {
            let (exact1, exact2) = self.exact.split_at_mut(id - self.first);
            let (at1, at2) = self.waiting_at.split_at_mut(id - self.first);
            let left = Self { first: self.first, exact: exact1, waiting_at: at1 };
            (left, Self { first: id, exact: exact2, waiting_at: at2 })
        }
    }
}
#[cfg(feature = "parallel")]
use parallel::can_split;
