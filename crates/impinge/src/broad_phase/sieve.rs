//! Which of the objects that moved leave their loosened boxes.

use super::finder::{Home, Waiting};
use crate::bounding_volume::Aabb;
use crate::bvh::{Bounds, NONE};
use crate::math::Real;

/// What the answer depends on, by id.
pub(super) struct KeptBounds<'a, const D: usize> {
    pub(super) homes: &'a [Home],
    pub(super) loose: &'a [Bounds<D>],
}

/// What is written beside it, by id less `first`.
pub(super) struct Sieve<'a, N: Real, const D: usize> {
    pub(super) first: usize,
    pub(super) exact: &'a mut [Aabb<N, D>],
    pub(super) waiting_at: &'a mut [u32],
}

impl<N: Real, const D: usize> Sieve<'_, N, D> {
    /// Stores the exact boxes and lists the objects that leave their loosened boxes or have none in a
    /// tree, by their place in the list of those that wait, the first of which is `first_at`. As many
    /// as wait may leave; returns how many do.
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

    /// Whether an object leaves its box, no processor foresees: each is written down, and the next
    /// one over it if it stays.
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

    /// The most objects that one thread looks at.
    const PIECE: usize = 4096;

    /// There are enough, and ids ascend: then halves of the list write to separate memory.
    pub(super) fn can_be_cut<N: Real, const D: usize>(waiting: &[Waiting<N, D>]) -> bool {
        waiting.len() > PIECE
            && rayon::current_num_threads() > 1
            && waiting.is_sorted_by_key(|waiting| waiting.id)
            // Removed ones, whose id says nothing, stand last if at all.
            && waiting.last().is_some_and(|last| last.id != NONE)
    }

    impl<N: Real, const D: usize> Sieve<'_, N, D> {
        /// For a list that can be cut.
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
        /// Two parts: before the id and from it on.
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
