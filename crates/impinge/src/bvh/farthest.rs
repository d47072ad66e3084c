//! The extent of the objects of a tree along a direction.

use super::{Bounds, LANES, Tree};
use crate::math::{Real, Vector, filled, max};

/// A search for the largest extent, with the best extent found so far.
struct ExtentSearch<'a, N: Real, const D: usize> {
    direction: Vector<N, D>,
    /// Nodes that extend at most `tolerance` beyond the best extent found so far are skipped.
    tolerance: N,
    best: N,
    extent_of: &'a mut dyn FnMut(u32) -> N,
}

impl<const D: usize> Tree<D> {
    /// Returns an upper bound of the objects' extent along `direction`, above the exact extent by
    /// at most a few `f32` rounding units of the coordinates; minus infinity for an empty tree.
    /// `extent_of` returns the extent of one object, which must not exceed the extent of the
    /// object's box.
    ///
    /// Branch and bound: visits the boxes of each block in descending order of extent. The tree
    /// must be refitted.
    pub(crate) fn extent_along<N: Real>(
        &self,
        direction: Vector<N, D>,
        extent_of: &mut dyn FnMut(u32) -> N,
    ) -> N {
        let top = self.layers.len() - 1;
        let farthest = self.layers[top].bounds.iter().filter(|bounds| bounds.is_finite());
        let size = farthest.map(|bounds| size_along(bounds, &direction)).fold(N::ZERO, max);
        // Without the tolerance, a search above a flat floor would open all boxes: rounding
        // outwards makes each box extend slightly beyond the best object.
        let tolerance = N::lit(4.0 * f64::from(f32::EPSILON)) * size;
        let mut search = ExtentSearch { direction, tolerance, best: -N::INFINITY, extent_of };
        for block in 0..self.layers[top].blocks.len() {
            self.open(top, block, &mut search);
        }
        search.best + tolerance
    }

    /// Searches a block. The recursion depth is the number of layers, at most 8.
    fn open<N: Real>(&self, layer: usize, block: usize, search: &mut ExtentSearch<'_, N, D>) {
        let lanes = &self.layers[layer].blocks[block];
        let mut farthest: [(N, usize); LANES] = filled(|lane| {
            let bounds = lanes.lane(lane);
            let far = bounds.extent(&search.direction);
            let far = if far.partial_cmp(&far).is_some() { far } else { -N::INFINITY };
            (if bounds.is_finite() { far } else { -N::INFINITY }, lane)
        });
        farthest.sort_by(|a, b| b.0.partial_cmp(&a.0).unwrap_or(core::cmp::Ordering::Equal));
        for (far, lane) in farthest {
            // False if a term is NaN. Once the best extent is infinite, no extent exceeds it.
            let is_farther = far > search.best + search.tolerance;
            if !is_farther {
                break;
            }
            let below = block * LANES + lane;
            if layer > 0 {
                self.open(layer - 1, below, search);
            } else {
                search.best = max((search.extent_of)(self.ids[below]), search.best);
            }
        }
    }
}

/// Returns the scale of rounding errors of a box's extent: the sum over the axes of `|direction|`
/// times the largest magnitude of a coordinate.
fn size_along<N: Real, const D: usize>(bounds: &Bounds<D>, direction: &Vector<N, D>) -> N {
    let along = |axis: usize| {
        let largest = bounds.lo[axis].abs().max(bounds.hi[axis].abs());
        direction[axis].abs() * N::lit(f64::from(largest))
    };
    (0..D).fold(N::ZERO, |sum, axis| sum + along(axis))
}
