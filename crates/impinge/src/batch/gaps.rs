//! The distances of the pairs of a chunk: first all are placed, then those of convex solids are computed together.

use core::ops::Range;

use super::side::{PreparedSide, index_in};
use crate::chunks::CHUNK;
use crate::collide::SlottedPair;
use crate::collide::pair::Ordered;
use crate::math::{Space, max};

/// The distance of each pair of a range, zero where the shapes touch or overlap, with the bits of the single call;
/// `None` without an answer.
pub(super) fn distances<N: Space<D>, const D: usize>(
    sides: &[PreparedSide<'_, N, D>; 2],
    range: Range<usize>,
) -> Vec<Option<N>> {
    let mut found = vec![None; range.len()];
    let placed = [sides[0].placed(range.clone()), sides[1].placed(range)];
    let mut convex = Vec::with_capacity(CHUNK);
    for (slot, found) in found.iter_mut().enumerate() {
        let [placed1, placed2] =
            [0, 1].map(|side| &placed[side][index_in(placed[side].len(), slot)]);
        let ordered = Ordered::new(placed1, placed2);
        if ordered.has_composite() {
            *found = (N::tables().distance_in_world)(placed1, placed2, N::INFINITY);
            continue;
        }
        let pair = ordered.pair();
        if pair.pose12.is_finite() {
            convex.push(SlottedPair { slot, pair });
        }
    }
    (N::tables().distances)(&mut convex, &mut found);
    found.iter_mut().flatten().for_each(|distance| *distance = max(*distance, N::ZERO));
    found
}
