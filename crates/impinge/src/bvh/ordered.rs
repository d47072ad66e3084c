//! Best-first searches: objects in ascending order of a key, such as the first hits of a ray or the
//! nearest objects.
//!
//! Blocks and objects wait in one queue, sorted by key (Hjaltason and Samet, "Distance browsing in
//! spatial databases", 1999). The key of a block is not above the keys of its contents, so objects
//! leave the queue in the order of their keys. A search that stops at an object has opened only
//! blocks whose lower bound is at most the object's key.

use core::cmp::Reverse;
use std::collections::BinaryHeap;

use super::kernel::with_kernel;
use super::tree::small;
use super::{Block, LANES, Lanes, Tree};
use crate::bounding_volume::Aabb;
use crate::math::{Real, Vector, max, min};

/// Initial capacity of the queue: enough for most searches.
const EXPECTED: usize = 64;

/// Entries of the queue. A block or a candidate has a lower bound as its key, an object its exact
/// key. A candidate is an object whose exact key is computed only when the candidate reaches the
/// front. At equal keys objects come last, by ascending id.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Entry {
    Block { tree: u8, layer: u8, block: u32 },
    Candidate { id: u32 },
    Object { id: u32 },
}

/// The two functions that compute keys, which must be zero or more.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Keys<B, O> {
    /// Returns the mask of the lanes to visit, and by lane a lower bound of the keys of the lane's
    /// contents.
    pub block: B,
    /// Returns the key of an object; `None` to skip it.
    pub object: O,
}

/// The queue of blocks and objects that a search has not visited yet.
///
/// Keys are zero or more, so their bits have the same order as their values.
#[derive(Clone, Debug, Default)]
pub(crate) struct Frontier {
    queue: BinaryHeap<Reverse<(u64, Entry)>>,
}

impl Frontier {
    /// Creates an empty queue.
    #[must_use]
    pub(crate) fn new() -> Self {
        Self { queue: BinaryHeap::with_capacity(EXPECTED) }
    }

    /// Adds an object that is in none of the trees.
    pub(crate) fn push_object<N: Real>(&mut self, key: N, id: u32) {
        self.push(key, Entry::Object { id });
    }

    fn push<N: Real>(&mut self, key: N, entry: Entry) {
        // Adding zero removes the sign of a negative zero.
        self.queue.push(Reverse(((key + N::ZERO).bits(), entry)));
    }

    /// Passes objects to `found` in ascending order of (key, id) until the key exceeds `limit`.
    /// `found` returns the new limit; a negative or NaN limit ends the search.
    pub(crate) fn search<N: Real, const D: usize>(
        mut self,
        trees: &[&Tree<D>],
        mut limit: N,
        keys: &Keys<impl Fn(&Block<D>) -> (u32, [N; LANES]), impl Fn(u32) -> Option<N>>,
        mut found: impl FnMut(u32, N) -> N,
    ) {
        for (tree, index) in trees.iter().zip(0..) {
            let layer = tree.top_layer();
            if !tree.is_empty() {
                self.push(N::ZERO, Entry::Block { tree: index, layer, block: 0 });
            }
        }
        while let Some(Reverse((bits, entry))) = self.queue.pop() {
            // Also false for a NaN limit, which ends the search.
            let is_within = limit >= N::ZERO && bits <= (limit + N::ZERO).bits();
            if !is_within {
                return;
            }
            match entry {
                Entry::Object { id } => {
                    // For an object of a tree, the key in the queue equals this key exactly, since
                    // [`Keys::object`] computed both.
                    let Some(key) = (keys.object)(id) else { continue };
                    limit = found(id, key);
                }
                Entry::Candidate { id } => {
                    if let Some(key) = (keys.object)(id) {
                        self.push_object(key, id);
                    }
                }
                Entry::Block { tree: index, layer, block } => {
                    let tree = trees[usize::from(index)];
                    let opened = &tree.layers[usize::from(layer)].blocks[block as usize];
                    let (mask, keys) = (keys.block)(opened);
                    let lanes = BlockLanes { tree, index, layer, block, mask, keys };
                    self.push_lanes(&lanes, limit);
                }
            }
        }
    }

    /// Queues the lanes of `mask` whose key is at most `limit`.
    fn push_lanes<N: Real, const D: usize>(&mut self, lanes: &BlockLanes<'_, N, D>, limit: N) {
        let &BlockLanes { tree, index, layer, block, mut mask, ref keys } = lanes;
        while mask != 0 {
            let lane = mask.trailing_zeros();
            mask &= mask - 1;
            let child = block * small(LANES) + lane;
            let key = keys[lane as usize];
            let is_beyond = key > limit;
            if is_beyond {
                continue;
            }
            if layer > 0 {
                if tree.is_block(layer - 1, child) {
                    self.push(key, Entry::Block { tree: index, layer: layer - 1, block: child });
                }
            } else if let Some(id) = tree.id_in(child) {
                self.push(key, Entry::Candidate { id });
            }
        }
    }
}

/// A block of one of the trees, with the keys of its lanes.
struct BlockLanes<'t, N, const D: usize> {
    tree: &'t Tree<D>,
    /// Index of the tree in the list of trees.
    index: u8,
    layer: u8,
    block: u32,
    /// Lanes to visit.
    mask: u32,
    keys: [N; LANES],
}

impl Lanes {
    /// Returns, by lane, the time at which the moving box first touches the lane's box, and the
    /// mask of the lanes that it does touch. [`Frontier::search`] uses both, [`Tree::visit`] only
    /// the mask. A ray is a box of a single point.
    pub(crate) fn times_of_block<N: Real, const D: usize>(
        self,
        block: &Block<D>,
        moving: &Aabb<N, D>,
        velocity: &Vector<N, D>,
    ) -> (u32, [N; LANES]) {
        with_kernel!(self, _kernel => times_of_block(block, moving, velocity))
    }

    /// Returns, by lane, the distance between `aabb` and the lane's box, and the mask of lanes in
    /// use, for [`Frontier::search`].
    pub(crate) fn distance_of_block<N: Real, const D: usize>(
        self,
        block: &Block<D>,
        aabb: &Aabb<N, D>,
    ) -> (u32, [N; LANES]) {
        with_kernel!(self, _kernel => distance_of_block(block, aabb))
    }
}

/// Returns, by lane, the time at which the moving box first touches the lane's box, and the mask of
/// the lanes that it does touch.
///
/// Performs the operations of `Aabb::sweep_interval`. Rounding is monotone, so if a box is hit, an
/// enclosing box is hit too, and entered no later.
#[inline(always)]
fn times_of_block<N: Real, const D: usize>(
    block: &Block<D>,
    moving: &Aabb<N, D>,
    velocity: &Vector<N, D>,
) -> (u32, [N; LANES]) {
    let (mut enter, mut leave) = ([N::ZERO; LANES], [N::INFINITY; LANES]);
    for axis in 0..D {
        let (low, high, speed) = (moving.mins()[axis], moving.maxs()[axis], velocity[axis]);
        for lane in 0..LANES {
            let lo = N::lit(f64::from(block.lo[axis][lane]));
            let hi = N::lit(f64::from(block.hi[axis][lane]));
            if speed == N::ZERO {
                let is_beside = high < lo || low > hi;
                leave[lane] = if is_beside { -N::ONE } else { leave[lane] };
            } else {
                let (a, b) = ((lo - high) / speed, (hi - low) / speed);
                enter[lane] = max(enter[lane], min(a, b));
                leave[lane] = min(leave[lane], max(a, b));
            }
        }
    }
    let mut mask = 0;
    for lane in 0..LANES {
        mask |= u32::from(enter[lane] <= leave[lane]) << lane;
    }
    (mask, enter)
}

/// Returns, by lane, the distance between `aabb` and the lane's box, and the mask of lanes in use.
///
/// Performs the operations of `Aabb::distance_to_aabb`. Rounding is monotone, so an enclosing box
/// is no farther.
#[inline(always)]
fn distance_of_block<N: Real, const D: usize>(
    block: &Block<D>,
    aabb: &Aabb<N, D>,
) -> (u32, [N; LANES]) {
    let (mut mask, mut distances) = (0, [N::ZERO; LANES]);
    for (lane, distance) in distances.iter_mut().enumerate() {
        let mut squared = N::ZERO;
        for axis in 0..D {
            let (low, high) = (aabb.mins()[axis], aabb.maxs()[axis]);
            let below = max(N::lit(f64::from(block.lo[axis][lane])) - high, N::ZERO);
            let above = max(low - N::lit(f64::from(block.hi[axis][lane])), N::ZERO);
            squared += (below + above) * (below + above);
        }
        *distance = squared.sqrt();
        mask |= u32::from(block.lo[0][lane] <= block.hi[0][lane]) << lane;
    }
    for (lane, distance) in distances.iter_mut().enumerate() {
        let is_used = mask >> lane & 1 == 1;
        if is_used && !distance.is_finite_number() {
            *distance = block.lane(lane).as_aabb().distance_to_aabb(aabb);
        }
    }
    (mask, distances)
}
