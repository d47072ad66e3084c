//! Moves objects at rest to the tree of still objects, and maintains the order of both trees.

use super::PairFinder;
use super::finder::Container;
use crate::bvh::NONE;
use crate::math::Real;

/// Number of updates without a change of its loosened box after which an object is at rest.
const REST_UPDATES: u32 = 32;
/// An update scans at most `1 / SCAN_DIVISOR` of the slots of the tree of moving objects, plus one
/// slot, and at most [`MAX_SCANNED`] slots. But it scans at least one slot for every
/// [`CHANGED_PER_SLOT`] changed objects.
const SCAN_DIVISOR: usize = 32;
const MAX_SCANNED: usize = 512;
const CHANGED_PER_SLOT: usize = 16;
/// An update moves at most `MAX_RESTING` objects to the tree of still objects, or two for each
/// changed object if that is more. So objects leave the tree of moving objects faster than changed
/// objects can come to rest.
const MAX_RESTING: usize = 64;
/// The trees are swapped only if there are at most `MAX_STILL_TO_SWAP` still objects, because these
/// become moving objects.
const MAX_STILL_TO_SWAP: usize = 64;
/// The trees are swapped only if there are at least `MIN_MOVING_TO_SWAP` moving objects.
const MIN_MOVING_TO_SWAP: usize = 1024;

/// A pass over the slots of the tree of moving objects, from the last slot to the first. It is
/// spread over many updates.
#[derive(Clone, Copy, Debug)]
pub(super) struct RestPass {
    /// Number of slots that have not been scanned yet: those before slot `end`.
    end: usize,
    resting: usize,
    /// Number of updates since the last update in which at least a quarter of the moving objects
    /// changed.
    quiet_updates: u32,
    /// Whether the pass moves objects at rest to the tree of still objects, instead of only
    /// counting them.
    moves_resting: bool,
}

impl RestPass {
    /// The value before the first pass: there are no slots to scan.
    pub(super) const NONE: Self =
        Self { end: 0, resting: 0, quiet_updates: 0, moves_resting: true };
}

impl<N: Real, const D: usize> PairFinder<N, D> {
    /// Moves objects at rest to the tree of still objects, and performs one step of the maintenance
    /// of both trees. Unless the trees are swapped, the work is bounded by a constant plus a
    /// multiple of `changed`, the number of changed objects. The result depends only on the
    /// sequence of calls.
    pub(super) fn keep_order(&mut self, changed: usize) {
        let mut resting = core::mem::take(&mut self.resting);
        resting.clear();
        self.list_resting(changed, &mut resting);
        for &id in &resting {
            self.moving.remove(id);
            self.still.insert_still(id, &self.loose[id as usize]);
            self.containers[id as usize] = Container::Still;
        }
        if !resting.is_empty() {
            self.moving.drop_free_end();
        }
        self.resting = resting;
        for tree in [&mut self.moving, &mut self.still] {
            tree.refit();
            tree.commit_boxes();
            tree.maintain();
        }
    }

    /// Continues the pass, and lists the objects at rest in `resting`. Slots are in spatial order;
    /// the pass goes from the last slot to the first, so that the tree can shrink.
    ///
    /// If nearly all objects are in the tree of moving objects, as after a bulk insertion, a pass
    /// begins only after [`REST_UPDATES`] quiet updates, and every second pass only counts the
    /// objects at rest. If such a pass finds at least three quarters of the objects at rest, the
    /// trees are swapped.
    fn list_resting(&mut self, changed: usize, resting: &mut Vec<u32>) {
        let slots = self.moving.slots_in_order();
        let max_resting = MAX_RESTING.max(2 * changed);
        let num_scanned =
            MAX_SCANNED.min(slots.len() / SCAN_DIVISOR + 1).max(changed / CHANGED_PER_SLOT);
        let mut pass = self.rest_pass;
        let is_quiet = 4 * changed < self.moving.len();
        pass.quiet_updates = if is_quiet { pass.quiet_updates.saturating_add(1) } else { 0 };
        if pass.end == 0 || pass.end > slots.len() {
            let is_bulk =
                self.still.len() <= MAX_STILL_TO_SWAP && self.moving.len() >= MIN_MOVING_TO_SWAP;
            let end = if is_bulk && pass.quiet_updates < REST_UPDATES { 0 } else { slots.len() };
            pass = RestPass {
                end,
                resting: 0,
                quiet_updates: pass.quiet_updates,
                moves_resting: !is_bulk || !pass.moves_resting,
            };
        }
        for _ in 0..num_scanned.min(pass.end) {
            pass.end -= 1;
            let id = slots[pass.end];
            if id == NONE || self.clock.wrapping_sub(self.last_change[id as usize]) < REST_UPDATES {
                continue;
            }
            pass.resting += 1;
            if pass.moves_resting {
                resting.push(id);
            }
            if resting.len() == max_resting {
                break;
            }
        }
        self.rest_pass = pass;
        if !pass.moves_resting && pass.end == 0 && 4 * pass.resting >= 3 * self.moving.len() {
            self.swap_trees();
        }
    }

    /// Swaps the trees of moving and still objects. Objects that actually move leave the tree of
    /// still objects at their next change.
    fn swap_trees(&mut self) {
        core::mem::swap(&mut self.moving, &mut self.still);
        self.moving.spend();
        self.still.spare();
        for container in &mut self.containers {
            *container = match *container {
                Container::Moving => Container::Still,
                Container::Still => Container::Moving,
                other => other,
            };
        }
    }
}
