//! Objects that have come to rest, and the order of the trees.

use super::PairFinder;
use super::finder::Home;
use crate::bvh::NONE;
use crate::math::Real;

/// Updates without a change after which an object counts as still.
const REST: u32 = 32;
/// One in so many places of the tree of moving objects is looked at in an update, but no more than these, or one for so
/// many objects that changed.
const WINDOW: usize = 32;
const LOOKED_AT: usize = 512;
const CHANGED_FOR_ONE: usize = 16;
/// So many objects at rest go to the other tree in an update, or two for each that changed: more than can come.
const TAKEN: usize = 64;
/// Up to so many still objects may begin to count as moving, where the trees change their roles.
const FEW: usize = 64;
/// From so many objects on.
const MANY: usize = 1024;

/// What a pass over the tree of moving objects has seen.
#[derive(Clone, Copy, Debug)]
pub(super) struct RestPass {
    /// The places before this are to be looked at.
    end: usize,
    resting: usize,
    /// Updates since one in which many objects changed.
    calm: u32,
    /// Those at rest are taken to the other tree, not just counted.
    takes: bool,
}

impl RestPass {
    /// None yet.
    pub(super) const NONE: Self = Self { end: 0, resting: 0, calm: 0, takes: true };
}

impl<N: Real, const D: usize> PairFinder<N, D> {
    /// Brings objects at rest to the tree of still ones and does this update's share of keeping both trees in order:
    /// a constant amount of work, and a share of what changed. The outcome depends on the calls made alone.
    pub(super) fn keep_order(&mut self, changed: usize) {
        let mut resting = core::mem::take(&mut self.resting);
        resting.clear();
        self.list_resting(changed, &mut resting);
        for &id in &resting {
            self.moving.remove(id);
            self.still.insert_still(id, &self.loose[id as usize]);
            self.homes[id as usize] = Home::Still;
        }
        if !resting.is_empty() {
            self.moving.drop_free_end();
        }
        self.resting = resting;
        for tree in [&mut self.moving, &mut self.still] {
            tree.refit();
            tree.settle();
            tree.maintain();
        }
    }

    /// Lists them from the last place to the first, so that the places that they leave are given up; in the order of a
    /// tree, which is one of space. Where nearly all objects are in the tree of moving ones, as after they came all at
    /// once, every other pass just counts: if most of them rest, the trees change their roles.
    fn list_resting(&mut self, changed: usize, resting: &mut Vec<u32>) {
        let slots = self.moving.slots_in_order();
        let most = TAKEN.max(2 * changed);
        let places = LOOKED_AT.min(slots.len() / WINDOW + 1).max(changed / CHANGED_FOR_ONE);
        let mut pass = self.rest_pass;
        let is_calm = 4 * changed < self.moving.len();
        pass.calm = if is_calm { pass.calm.saturating_add(1) } else { 0 };
        if pass.end == 0 || pass.end > slots.len() {
            let is_bulk = self.still.len() <= FEW && self.moving.len() >= MANY;
            let end = if is_bulk && pass.calm < REST { 0 } else { slots.len() };
            pass = RestPass { end, resting: 0, calm: pass.calm, takes: !is_bulk || !pass.takes };
        }
        for _ in 0..places.min(pass.end) {
            pass.end -= 1;
            let id = slots[pass.end];
            if id == NONE || self.clock.wrapping_sub(self.last_change[id as usize]) < REST {
                continue;
            }
            pass.resting += 1;
            if pass.takes {
                resting.push(id);
            }
            if resting.len() == most {
                break;
            }
        }
        self.rest_pass = pass;
        if !pass.takes && pass.end == 0 && 4 * pass.resting >= 3 * self.moving.len() {
            self.exchange_trees();
        }
    }

    /// The tree of moving objects becomes that of still ones, and the reverse. Those that move leave it when they do.
    fn exchange_trees(&mut self) {
        core::mem::swap(&mut self.moving, &mut self.still);
        self.moving.spend();
        self.still.spare();
        for home in &mut self.homes {
            *home = match *home {
                Home::Moving => Home::Still,
                Home::Still => Home::Moving,
                other => other,
            };
        }
    }
}
