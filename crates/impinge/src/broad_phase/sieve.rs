//! The sieve: finds the moved objects whose exact boxes leave their loosened boxes.

use super::finder::{Home, Waiting};
use crate::bounding_volume::Aabb;
use crate::bvh::{Bounds, NONE};
use crate::math::Real;

/// Read-only input of the sieve, indexed by id.
pub(super) struct KeptBounds<'a, const D: usize> {
    pub(super) homes: &'a [Home],
    pub(super) loose: &'a [Bounds<D>],
}

/// Output of the sieve except the list of leavers, indexed by `id - first`.
pub(super) struct Sieve<'a, N: Real, const D: usize> {
    pub(super) first: usize,
    pub(super) exact: &'a mut [Aabb<N, D>],
    pub(super) waiting_at: &'a mut [u32],
}

impl<N: Real, const D: usize> Sieve<'_, N, D> {
    /// Stores the exact boxes, and lists in `leavers` the objects that leave their loosened boxes
    /// or are in no tree. An object is listed by its index in the whole list of waiting boxes, of
    /// which `waiting` is a part that begins at index `first_at`. `leavers` must be as long as
    /// `waiting`. Returns the number of leavers.
    pub(super) fn run(
        self,
        kept: &KeptBounds<'_, D>,
        waiting: &[Waiting<N, D>],
        first_at: u32,
        leavers: &mut [u32],
    ) -> usize {
        #[cfg(feature = "parallel")]
        if can_be_cut(waiting) {
            return self.run_parallel(kept, waiting, first_at, leavers);
        }
        self.run_serial(kept, waiting, first_at, leavers)
    }

    /// Runs on one thread. Whether an object leaves its box is unpredictable, so the loop has no
    /// such branch: each index is written, and overwritten by the next one if the object stays.
    fn run_serial(
        self,
        kept: &KeptBounds<'_, D>,
        waiting: &[Waiting<N, D>],
        first_at: u32,
        leavers: &mut [u32],
    ) -> usize {
        let mut count = 0;
        for (at, Waiting { id, aabb }) in (first_at..).zip(waiting) {
            let index = *id as usize;
            if *id == NONE {
                continue;
            }
            self.waiting_at[index - self.first] = NONE;
            self.exact[index - self.first] = *aabb;
            let is_in_tree = matches!(kept.homes[index], Home::Moving | Home::Still);
            let stays = is_in_tree & kept.loose[index].contains(&Bounds::enclosing(aabb));
            leavers[count] = at;
            count += usize::from(!stays);
        }
        count
    }
}

#[cfg(feature = "parallel")]
mod parallel {
    use super::super::finder::small;
    use super::{KeptBounds, NONE, Sieve, Waiting};
    use crate::math::Real;

    /// Greatest number of waiting boxes in one task.
    const PIECE: usize = 4096;

    /// Returns `true` if the list is long enough and its ids ascend, so that its halves write to
    /// disjoint slices.
    pub(super) fn can_be_cut<N: Real, const D: usize>(waiting: &[Waiting<N, D>]) -> bool {
        waiting.len() > PIECE
            && rayon::current_num_threads() > 1
            && waiting.is_sorted_by_key(|waiting| waiting.id)
            // A removed object has the id `NONE`; sorted, it would be last.
            && waiting.last().is_some_and(|last| last.id != NONE)
    }

    impl<N: Real, const D: usize> Sieve<'_, N, D> {
        /// Splits the list in halves of at most [`PIECE`] boxes, which may run on several threads;
        /// [`can_be_cut`] must hold.
        pub(super) fn run_parallel(
            self,
            kept: &KeptBounds<'_, D>,
            waiting: &[Waiting<N, D>],
            first_at: u32,
            leavers: &mut [u32],
        ) -> usize {
            if waiting.len() <= PIECE {
                return self.run_serial(kept, waiting, first_at, leavers);
            }
            let middle = waiting.len() / 2;
            let (waiting1, waiting2) = waiting.split_at(middle);
            let (leavers1, leavers2) = leavers.split_at_mut(middle);
            let (left, right) = self.cut(waiting2[0].id as usize);
            let middle_at = first_at + small(middle);
            let (count1, count2) = rayon::join(
                || left.run_parallel(kept, waiting1, first_at, leavers1),
                || right.run_parallel(kept, waiting2, middle_at, leavers2),
            );
            leavers.copy_within(middle..middle + count2, count1);
            count1 + count2
        }
    }

    impl<'a, N: Real, const D: usize> Sieve<'a, N, D> {
        /// Splits the output into the ids below `id` and the others.
        fn cut(self, id: usize) -> (Self, Self) {
            let (exact1, exact2) = self.exact.split_at_mut(id - self.first);
            let (at1, at2) = self.waiting_at.split_at_mut(id - self.first);
            let left = Self { first: self.first, exact: exact1, waiting_at: at1 };
            (left, Self { first: id, exact: exact2, waiting_at: at2 })
        }
    }
}
#[cfg(feature = "parallel")]
use parallel::can_be_cut;
