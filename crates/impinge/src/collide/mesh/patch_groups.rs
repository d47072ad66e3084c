//! Groups the pieces that form one patch: the pieces with one normal in one plane.
//!
//! Pieces are taken deepest first. Each is compared with the deepest piece of each earlier patch
//! that may have the same normal. A hash table of cells finds these patches; a cell is an interval
//! of the normals' component along one axis:
//!
//! ```text
//!  AXIS ──┬──────┬──────┬──────┬──────┬──>   compared: the patches in the own cell
//!         │      │ near │ own  │ near │       and in both neighbours, since normals of
//!         └──────┴──────┴──────┴──────┘       one patch differ by less than a cell
//!
//!  newest   4  -  -  3         the slot of a cell is its number modulo the number of slots;
//!  older    -  -  0  -  2      slot 0 holds the patches 4, 2 and 0, slot 3 the patch 3
//! ```

use core::iter;
use core::ops::Range;

use smallvec::SmallVec;

use super::super::RawPoint;
use super::patch::Merging;
use crate::math::order::{order_of, sort_keyed};
use crate::math::{Mapped, Real, Vector, min};

/// Largest length of the difference of two unit normals in one patch; also the largest ratio of
/// height above a plane to distance for points in one plane.
const SAME: f64 = 1.0 / 1024.0;
/// Length of a cell: `SAME` plus a margin for rounding.
const CELL: f64 = SAME * (1.0 + 1.0 / 16.0);
/// The axis of the cells, a unit vector. It is oblique to the coordinate axes, to which the normals
/// of many surfaces are parallel.
const AXIS: [f64; 3] = [0.36, 0.48, 0.8];
/// Largest number of patches of a cell that a piece is compared with. The newest are used: pieces
/// are sorted by depth, so the depths of the newest are nearest to that of the piece.
const MAX_COMPARED: usize = 32;
/// Least and greatest number of slots, both powers of two. Unit vectors have about 1900 cells.
const MIN_SLOTS: usize = 4;
const MAX_SLOTS: usize = 2048;
/// Stands for the index of a patch where there is none.
const NONE: usize = usize::MAX;

/// A piece and its deepest point, by their indices.
#[derive(Clone, Copy)]
pub(super) struct Lead {
    pub(super) piece: usize,
    pub(super) deepest: usize,
}

/// The pieces of one patch.
pub(super) struct PieceGroup {
    /// The piece with the deepest point of the group.
    pub(super) lead: Lead,
    /// Range of the group's pieces in `Groups::order`.
    pieces: Range<usize>,
}

/// The pieces, grouped into patches.
pub(super) struct Groups {
    /// Groups within the prediction, sorted by their smallest pair of parts.
    pub(super) groups: SmallVec<[PieceGroup; 8]>,
    /// Indices of the pieces, sorted by group, the deepest piece of a group first.
    order: SmallVec<[usize; 16]>,
}

impl Groups {
    /// Groups the pieces. Cost: O(n log n) in the number of pieces.
    pub(super) fn of<N: Real, const D: usize>(merging: &Merging<'_, N, D>) -> Self {
        let leads = deepest_first(merging);
        let mut cells = NormalCells::new(leads.len());
        // The first lead of each group, and the group of each piece.
        let mut groups = SmallVec::<[Lead; 8]>::new();
        let mut group_of = SmallVec::<[usize; 16]>::from_elem(NONE, merging.pieces.len());
        for lead in &leads {
            let cell = cell_of(&merging.pieces[lead.piece].normal);
            let known = cells.near(cell).find(|&at| are_coplanar(merging, &groups[at], lead));
            if let Some(group) = known {
                group_of[lead.piece] = group;
            } else if merging.points[lead.deepest].distance <= merging.request.prediction {
                group_of[lead.piece] = groups.len();
                cells.put(cell);
                groups.push(*lead);
            }
        }
        Self::sorted(&leads, &groups, &group_of)
    }

    /// Sorts the groups by their first pieces: the pieces are sorted by their parts.
    fn sorted(leads: &[Lead], first_leads: &[Lead], group_of: &[usize]) -> Self {
        let mut ranks = SmallVec::<[usize; 8]>::from_elem(NONE, first_leads.len());
        let mut groups = SmallVec::<[PieceGroup; 8]>::with_capacity(first_leads.len());
        for &group in group_of.iter().filter(|&&group| group != NONE) {
            if ranks[group] == NONE {
                ranks[group] = groups.len();
                groups.push(PieceGroup { lead: first_leads[group], pieces: 0..0 });
            }
            groups[ranks[group]].pieces.end += 1;
        }
        let mut start = 0;
        for PieceGroup { pieces, .. } in &mut groups {
            let count = pieces.len();
            *pieces = start..start;
            start += count;
        }
        let mut order = SmallVec::from_elem(0, start);
        for Lead { piece, .. } in leads.iter().filter(|lead| group_of[lead.piece] != NONE) {
            let end = &mut groups[ranks[group_of[*piece]]].pieces.end;
            order[*end] = *piece;
            *end += 1;
        }
        Self { groups, order }
    }

    /// Returns the indices of the pieces of a group.
    pub(super) fn pieces(&self, group: &PieceGroup) -> &[usize] {
        &self.order[group.pieces.clone()]
    }
}

/// Returns the pieces with points, the deepest first; pieces of equal depth keep their order.
fn deepest_first<N: Real, const D: usize>(merging: &Merging<'_, N, D>) -> SmallVec<[Lead; 16]> {
    let pieces = merging.pieces.iter().enumerate();
    let leads =
        pieces.filter_map(|(piece, own)| Some(Lead { piece, deepest: merging.deepest_of(own)? }));
    let leads: SmallVec<[Lead; 16]> = leads.collect();
    let mut by_depth = SmallVec::<[(u64, u32); 16]>::with_capacity(leads.len());
    let depths = leads.iter().map(|lead| order_of(merging.points[lead.deepest].distance));
    by_depth.extend(depths.zip(0..));
    sort_keyed(&mut by_depth);
    by_depth.iter().map(|&(_, at)| leads[at as usize]).collect()
}

/// Returns whether two pieces have one normal and lie in one plane, on the surface of the first
/// shape or on the surface of the second. `lead1` must be the deeper.
fn are_coplanar<N: Real, const D: usize>(
    merging: &Merging<'_, N, D>,
    lead1: &Lead,
    lead2: &Lead,
) -> bool {
    let piece = |lead: &Lead| &merging.pieces[lead.piece];
    // The comparison is false for NaN.
    let same = N::lit(SAME);
    let is_same = (piece(lead1).normal - piece(lead2).normal).norm_squared() <= same * same;
    if !is_same {
        return false;
    }
    let [point1, point2] =
        [lead1, lead2].mapped(|lead| -> &RawPoint<N, D> { &merging.points[lead.deepest] });
    let arm = point2.point1 - point1.point1;
    let tolerance = same * arm.norm() + N::TWO * merging.tolerance;
    let rise1 = piece(lead1).normal.dot(&arm);
    let rise2 = rise1 + point2.distance - point1.distance;
    min(rise1.abs(), rise2.abs()) <= tolerance
}

/// The patches by the cells of their normals: a hash table with a list of patches for each slot.
struct NormalCells {
    /// The newest patch of each slot, or `NONE`. The number of slots is a power of two.
    newest: SmallVec<[usize; 16]>,
    /// For each patch, the next older patch of its slot, or `NONE`.
    older: SmallVec<[usize; 8]>,
}

impl NormalCells {
    /// Creates an empty table for the patches of `pieces` pieces.
    fn new(pieces: usize) -> Self {
        let slots = pieces.next_power_of_two().clamp(MIN_SLOTS, MAX_SLOTS);
        Self { newest: SmallVec::from_elem(NONE, slots), older: SmallVec::new() }
    }

    /// Returns the slot of a cell.
    #[expect(clippy::cast_sign_loss, reason = "the bits that the mask keeps are the remainder")]
    fn slot_of(&self, cell: i32) -> usize {
        cell as usize & (self.newest.len() - 1)
    }

    /// Returns the patches that may have a normal in the cell `cell`: those in the slots of the cell
    /// and of its two neighbours, from each slot at most the [`MAX_COMPARED`] newest.
    fn near(&self, cell: i32) -> impl Iterator<Item = usize> {
        let listed = |at: usize| (at != NONE).then_some(at);
        [0, -1, 1].into_iter().flat_map(move |offset| {
            let newest = self.newest[self.slot_of(cell.wrapping_add(offset))];
            let patches = iter::successors(listed(newest), move |&at| listed(self.older[at]));
            patches.take(MAX_COMPARED)
        })
    }

    /// Adds the next patch to a cell; patches are numbered in the order in which they are added.
    fn put(&mut self, cell: i32) {
        let (slot, patch) = (self.slot_of(cell), self.older.len());
        self.older.push(core::mem::replace(&mut self.newest[slot], patch));
    }
}

/// Returns the position of the cell of a unit vector.
#[expect(clippy::cast_possible_truncation, reason = "a unit vector is in some thousands of cells")]
fn cell_of<N: Real, const D: usize>(normal: &Vector<N, D>) -> i32 {
    let along = |sum: f64, (own, axis): (&N, f64)| sum + own.as_f64() * axis;
    (normal.iter().zip(AXIS).fold(0.0, along) / CELL).floor() as i32
}

#[cfg(test)]
mod tests {
    use super::super::patch::Piece;
    use super::*;
    use crate::math::xorshift::Xorshift;

    /// Returns `count` pieces without points, with normals in all directions; every fourth normal is
    /// nearly equal to the one before it.
    fn pieces<const D: usize>(count: usize) -> Vec<Piece<f64, D>> {
        let mut random = Xorshift(3);
        let mut pieces: Vec<Piece<f64, D>> = Vec::new();
        for at in 0..count {
            let is_near = at % 4 == 3;
            let near = if is_near { pieces[at - 1].normal } else { Vector::<f64, D>::zeros() };
            let scale = if is_near { 0.4 * SAME } else { 1.0 };
            let aside = Vector::<f64, D>::from_fn(|_, _| scale * random.next());
            let normal = (near + aside).normalize();
            pieces.push(Piece { normal, parts: [0; 2], points: 0..0 });
        }
        pieces
    }

    /// Asserts that all earlier patches with the normal of a piece are candidates for that piece,
    /// unless the number of candidates reaches [`MAX_COMPARED`]. Asserts that a piece has at most
    /// `most` candidates on average.
    fn check<const D: usize>(count: usize, most: usize) {
        let pieces = pieces::<D>(count);
        let (mut cells, mut compared, mut same) = (NormalCells::new(count), 0, 0);
        for (at, piece) in pieces.iter().enumerate() {
            let cell = cell_of(&piece.normal);
            let near: Vec<usize> = cells.near(cell).collect();
            compared += near.len();
            if near.len() < MAX_COMPARED {
                for (other, before) in pieces[..at].iter().enumerate() {
                    let is_same = (before.normal - piece.normal).norm() <= SAME;
                    assert!(!is_same || near.contains(&other), "{at} and {other}");
                    same += usize::from(is_same);
                }
            }
            cells.put(cell);
        }
        assert!(same * 10 > count, "{same} have the same normal as another");
        assert!(compared <= most * count, "{compared} patches are compared with {count} pieces");
    }

    #[test]
    fn few_patches_are_near() {
        for count in [10, 100, 1000, 3000] {
            check::<3>(count, 6);
            check::<2>(count, MAX_COMPARED);
        }
    }
}
