//! Objects that have come to rest, and the order of the trees.

use super::PairFinder;
use super::finder::{Home, small};
use crate::math::Real;

/// Updates without a change after which an object counts as still.
const REST: u32 = 32;
/// Each update looks at one object in so many.
const WINDOW: usize = 32;

impl<N: Real, const D: usize> PairFinder<N, D> {
    /// Moves objects at rest to the tree of still ones and does this update's share of keeping both
    /// trees in order. Looks at a window of objects that advances with each update, so that the
    /// outcome depends on the calls made alone.
    pub(super) fn keep_order(&mut self) {
        let mut resting = core::mem::take(&mut self.resting);
        self.list_resting(&mut resting);
        for &id in &resting {
            self.moving.remove(id);
            self.still.insert_still(id, &self.loose[id as usize]);
            self.homes[id as usize] = Home::Still;
        }
        self.resting = resting;
        for tree in [&mut self.moving, &mut self.still] {
            tree.refit();
            tree.settle();
            tree.maintain();
        }
    }

    fn list_resting(&mut self, resting: &mut Vec<u32>) {
        let count = self.homes.len();
        resting.clear();
        if self.moving.is_empty() {
            return;
        }
        let window = (count / WINDOW + 1).min(count);
        let start = self.cursor;
        self.cursor = (start + window) % count;
        let is_resting = |&id: &u32| {
            let rest = self.clock.wrapping_sub(self.last_change[id as usize]);
            self.homes[id as usize] == Home::Moving && rest >= REST
        };
        resting.extend((start..start + window).map(|at| small(at % count)).filter(is_resting));
    }
}
