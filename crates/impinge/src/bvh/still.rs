//! Trees of static boxes: built at once, in an order that costs more to compute and less to search
//! than the k-d order of [`super::order`], and then changed one box at a time.
//!
//! Ranges of slots are cut by the surface area heuristic (Goldsmith and Salmon 1987; binned as by
//! Wald, "On fast construction of SAH-based bounding volume hierarchies", 2007), but only between
//! whole blocks of the layer: so all blocks but the last are full, and child and parent are
//! computed from the index. Ranges of more than [`SAMPLE`] boxes are cut by a sample.

use super::order::key;
use super::tree::small;
use super::{Bounds, LANES, Lanes, NONE, Tree};
use crate::math::filled;

/// Number of bins along each axis.
const BINS: usize = 16;
/// Greatest number of boxes that are sampled to choose a cut.
const SAMPLE: usize = 512;
/// Least number of boxes whose two parts are sorted in parallel.
#[cfg(feature = "parallel")]
const PARALLEL_SORT: usize = 4096;

/// A box with its id, sorted by its centre.
#[derive(Clone, Copy, Debug)]
struct StillItem<const D: usize> {
    bounds: Bounds<D>,
    id: u32,
}

impl<const D: usize> StillItem<D> {
    /// Returns the centre on an axis. Coordinates are halved before they are added, so the sum does
    /// not overflow.
    #[inline]
    fn middle(&self, axis: usize) -> f32 {
        self.bounds.lo[axis] * 0.5 + self.bounds.hi[axis] * 0.5
    }

    /// Returns the sort key on an axis: the centre, then the id. Keys of two boxes differ, so the
    /// sorted order is unique.
    #[inline]
    fn key(&self, axis: usize) -> u64 {
        key(self.middle(axis), self.id)
    }
}

impl<const D: usize> Tree<D> {
    /// Builds a tree from boxes with distinct ids. The tree is refitted and committed.
    pub(crate) fn of_still(lanes: Lanes, boxes: impl Iterator<Item = (u32, Bounds<D>)>) -> Self {
        let mut items: Vec<_> = boxes.map(|(id, bounds)| StillItem { bounds, id }).collect();
        arrange(&mut items);
        let mut tree = Self::sparing(lanes);
        tree.resize_leaves(items.len().div_ceil(LANES));
        tree.slots.resize(items.iter().map(|item| item.id as usize + 1).max().unwrap_or(0), NONE);
        for (slot, item) in items.iter().enumerate() {
            tree.layers[0].blocks[slot / LANES].set_lane(slot % LANES, &item.bounds);
            tree.ids[slot] = item.id;
            tree.slots[item.id as usize] = small(slot);
        }
        (tree.end, tree.live) = (items.len(), items.len());
        tree.is_stale = true;
        for block in 0..tree.leaf_count() {
            tree.touch(block);
        }
        tree.declare_ordered(tree.end);
        tree.refit_layers(&[]);
        tree.commit_boxes();
        tree
    }

    /// Sets the box of an object, and inserts the object if it is new. Reports no pairs. Refits and
    /// commits the tree, so searches are valid at once.
    ///
    /// An object moves to another slot if its new box would enlarge its leaf block by more than
    /// [`Self::hardly_grows_by`] allows.
    pub(crate) fn put(&mut self, id: u32, bounds: &Bounds<D>) {
        let slot = self.slot(id);
        if slot.is_some_and(|slot| self.hardly_grows_by(slot / LANES, bounds)) {
            self.set_still(id, bounds);
        } else {
            if slot.is_some() {
                self.remove(id);
            }
            self.insert_still(id, bounds);
        }
        self.refit();
        self.commit_boxes();
    }
}

/// Reorders the items for consecutive slots that begin with the first slot of a subtree. The
/// recursion ends, since both parts are smaller.
fn arrange<const D: usize>(items: &mut [StillItem<D>]) {
    // Number of boxes in one child: the least power of 16 such that at most 16 children hold all
    // items.
    let mut child = LANES;
    while child * LANES < items.len() {
        child *= LANES;
    }
    if items.len() <= child {
        return;
    }
    let children = items.len().div_ceil(child);
    let (axis, left) = best_cut(items, child, children);
    // Whole children go to the left; only the last child on the right may be partial.
    items.select_nth_unstable_by_key(left * child, |item| item.key(axis));
    let (first, second) = items.split_at_mut(left * child);
    #[cfg(feature = "parallel")]
    if first.len() + second.len() >= PARALLEL_SORT {
        rayon::join(|| arrange(first), || arrange(second));
        return;
    }
    arrange(first);
    arrange(second);
}

/// Returns the axis to cut and the number of whole children on the left. If no cut has a finite
/// cost, halves the children along the axis with the largest spread of centres, the first of
/// equals.
fn best_cut<const D: usize>(
    items: &[StillItem<D>],
    child: usize,
    children: usize,
) -> (usize, usize) {
    let step = items.len().div_ceil(SAMPLE);
    let mut middles = Bounds::<D>::EMPTY;
    for item in items.iter().step_by(step) {
        let middle = filled(|axis| item.middle(axis));
        middles = middles.merged(&Bounds { lo: middle, hi: middle });
    }
    // Coordinates are halved before they are subtracted, so the difference does not overflow.
    let spread = |axis: usize| middles.hi[axis] * 0.5 - middles.lo[axis] * 0.5;
    let longest =
        (1..D).fold(0, |best, axis| if spread(axis) > spread(best) { axis } else { best });
    let mut best = (longest, children / 2);
    let mut least = f64::INFINITY;
    for axis in 0..D {
        let bins = Bins::of(items.iter().step_by(step), axis, &middles);
        bins.each_cut(step, child, children, |left, cost| {
            if cost < least {
                (least, best) = (cost, (axis, left));
            }
        });
    }
    best
}

/// The boxes of a sample, in bins by their centres.
struct Bins<const D: usize> {
    /// Union of the boxes in each bin.
    bounds: [Bounds<D>; BINS],
    /// Number of sampled boxes in each bin.
    counts: [usize; BINS],
}

impl<const D: usize> Bins<D> {
    /// Sorts boxes into bins of equal width on an axis; `middles` are the bounds of the boxes'
    /// centres.
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of the bins; NaN, of an axis without extent, goes to the first"
    )]
    fn of<'a>(
        items: impl Iterator<Item = &'a StillItem<D>>,
        axis: usize,
        middles: &Bounds<D>,
    ) -> Self {
        let mut bins = Self { bounds: [Bounds::EMPTY; BINS], counts: [0; BINS] };
        let least = middles.lo[axis];
        let scale = BINS as f32 / (middles.hi[axis] - least);
        for item in items {
            let bin = (((item.middle(axis) - least) * scale) as usize).min(BINS - 1);
            bins.bounds[bin] = bins.bounds[bin].merged(&item.bounds);
            bins.counts[bin] += 1;
        }
        bins
    }

    /// Calls `visit` for each cut between two children, with the number of children on the left and
    /// the estimated cost. If a cut falls within a bin, the boxes of the bin enlarge both sides.
    #[expect(clippy::cast_precision_loss, reason = "counts that weigh a heuristic")]
    fn each_cut(
        &self,
        step: usize,
        child: usize,
        children: usize,
        mut visit: impl FnMut(usize, f64),
    ) {
        // `right[bin]` becomes the half surface of the union of the boxes in `bin` and all later
        // bins.
        let mut right = [0.0; BINS];
        let mut all = Bounds::EMPTY;
        for bin in (0..BINS).rev() {
            all = all.merged(&self.bounds[bin]);
            right[bin] = all.half_surface();
        }
        let (mut all, mut count, mut next) = (Bounds::EMPTY, 0, 1);
        for (bin, bounds) in self.bounds.iter().enumerate() {
            all = all.merged(bounds);
            // Each sampled box stands for `step` boxes.
            count += self.counts[bin] * step;
            if next >= children || next * child > count {
                continue;
            }
            let left = all.half_surface();
            while next < children && next * child <= count {
                // A cut at the end of this bin excludes it from the right side; a cut within it
                // does not.
                let is_even = next * child == count && bin + 1 < BINS;
                let rest = right[if is_even { bin + 1 } else { bin }];
                // The heuristic: surface times number of children, summed over both sides.
                visit(next, left * next as f64 + rest * (children - next) as f64);
                next += 1;
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Returns `count` scattered boxes of size 1, but size 1000 for every tenth.
    fn boxes(count: u32) -> Vec<Bounds<3>> {
        let box_at = |id: u32| {
            let x = f32::from(u16::try_from(id * 7919 % 1000).expect("small"));
            let z = f32::from(u16::try_from(id * 104_729 % 977).expect("small"));
            let size = if id.is_multiple_of(10) { 1000.0 } else { 1.0 };
            Bounds { lo: [x, 0.0, z], hi: [x + size, size, z + size] }
        };
        (0..count).map(box_at).collect()
    }

    #[test]
    fn every_box_has_a_slot_and_every_block_is_full() {
        for count in [0, 1, 15, 16, 17, 255, 256, 257, 4097, 10_000] {
            let boxes = boxes(count);
            let tree = Tree::of_still(Lanes::detect(), (0..).zip(boxes.iter().copied()));
            assert_eq!(tree.validate(), Ok(()), "{count}");
            assert_eq!(tree.len(), boxes.len(), "{count}");
            assert!((0..).zip(&boxes).all(|(id, own)| tree.bounds(id) == Some(*own)), "{count}");
        }
    }

    #[test]
    fn cuts_by_surface_cost_less_than_halves() {
        let boxes = boxes(10_000);
        let still = Tree::of_still(Lanes::detect(), (0..).zip(boxes.iter().copied()));
        let mut moving = Tree::new(Lanes::detect());
        for (id, bounds) in (0..).zip(&boxes) {
            moving.insert_still(id, bounds);
        }
        moving.refit();
        let (cut, halved) = (still.leaf_surface(), moving.leaf_surface());
        assert!(cut < halved, "{cut} against {halved} in k-d order");
    }

    #[test]
    fn boxes_at_one_position_are_halved() {
        let one = Bounds { lo: [1.0; 2], hi: [2.0; 2] };
        let tree = Tree::of_still(Lanes::detect(), (0..1000).map(|id| (id, one)));
        assert_eq!(tree.validate(), Ok(()), "all alike");
    }
}
