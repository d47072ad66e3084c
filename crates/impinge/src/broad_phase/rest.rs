//! Objects that have come to rest, and the order of the trees.

use super::PairFinder;
use super::finder::Home;
use crate::bvh::NONE;
use crate::math::Real;

/// Updates without a change after which an object counts as still.
const REST: u32 = 32;
/// Each update looks at so many places as are one in so many of all objects.
const WINDOW: usize = 32;

impl<N: Real, const D: usize> PairFinder<N, D> {
    /// Moves objects at rest to the tree of still ones and does this update's share of keeping both
    /// trees in order. Looks at a window of places that advances with each update, so that the
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

    /// Lists them in the order of the tree that they leave, which is one of space: in the order of
    /// their numbers they would leave the other tree without one.
    fn list_resting(&mut self, resting: &mut Vec<u32>) {
        let slots = self.moving.slots_in_order();
        resting.clear();
        if slots.is_empty() {
            return;
        }
        let start = if self.cursor < slots.len() { self.cursor } else { 0 };
        self.cursor = start + self.homes.len() / WINDOW + 1;
        let is_resting =
            |id: u32| id != NONE && self.clock.wrapping_sub(self.last_change[id as usize]) >= REST;
        let looked_at = slots[start..self.cursor.min(slots.len())].iter();
        resting.extend(looked_at.copied().filter(|&id| is_resting(id)));
    }
}
