//! Groups the pieces that form one patch: the pieces with one normal in one plane.
//!
//! If all normals differ, as on rough terrain, each piece is a patch. Otherwise pieces are taken
//! deepest first, and each piece is compared with the deepest piece of each earlier patch that may
//! have the same normal. If there are many pieces, cells of the normals' component along one axis
//! limit the candidates:
//!
//! ```text
//!  AXIS ──┬──────┬──────┬──────┬──────┬──>   compared: the patches in the own cell
//!         │      │ near │ own  │ near │       and in both neighbours, since normals of
//!         └──────┴──────┴──────┴──────┘       one patch differ by less than a cell
//! ```

use core::ops::Range;

use smallvec::SmallVec;

use super::super::RawPoint;
use super::patch::{Merging, Piece};
use crate::math::order::{order_of, sort_few, sort_keyed};
use crate::math::{Mapped, Real, Vector, min};

/// Largest length of the difference of two unit normals in one patch; also the largest ratio of
/// height above a plane to distance for points in one plane.
const SAME: f64 = 1.0 / 1024.0;
/// Up to this number of pieces, all pieces share one cell.
const FEW_PIECES: usize = 12;
/// Length of a cell: `SAME` plus a margin for rounding.
const CELL: f64 = SAME * (1.0 + 1.0 / 16.0);
/// The axis of the cells, a unit vector. It is oblique to the coordinate axes, to which the normals
/// of many surfaces are parallel.
const AXIS: [f64; 3] = [0.36, 0.48, 0.8];
/// Largest number of patches per cell that a piece is compared with; the deepest ones are used.
const MAX_COMPARED: usize = 32;
/// Average number of comparisons per piece that may be spent on the test whether all normals
/// differ.
const MAX_ALIKE: usize = 4;

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
    /// Smallest pair of parts among the pieces.
    first: [u32; 2],
    /// Range of the group's pieces in `Groups::order`.
    pieces: Range<usize>,
}

/// Returns the indices of the pieces sorted by group, and sets the range of each group in this
/// list. On entry the length of each `PieceGroup::pieces` must be the number of the group's pieces.
/// `pieces` yields (piece, group).
fn pieces_by_group(
    groups: &mut [PieceGroup],
    pieces: impl Iterator<Item = (usize, usize)>,
) -> SmallVec<[usize; 16]> {
    let mut start = 0;
    for group in &mut *groups {
        let count = group.pieces.len();
        group.pieces = start..start;
        start += count;
    }
    let mut order = SmallVec::from_elem(0, start);
    for (piece, group) in pieces {
        let end = &mut groups[group].pieces.end;
        order[*end] = piece;
        *end += 1;
    }
    order
}

/// Sorts groups by their smallest pair of parts.
fn sort_by_parts(groups: &mut [PieceGroup]) {
    sort_few(groups, |one, other| one.first < other.first);
}

/// The pieces, grouped into patches.
pub(super) struct Groups {
    /// Groups within the prediction, sorted by their smallest pair of parts.
    pub(super) groups: SmallVec<[PieceGroup; 8]>,
    /// Indices of the pieces, sorted by group.
    order: SmallVec<[usize; 16]>,
}

impl Groups {
    /// Groups the pieces. Cost: O(n log n) in the number of pieces.
    pub(super) fn of<N: Real, const D: usize>(merging: &Merging<'_, N, D>) -> Self {
        let pieces = merging.pieces;
        let mut leads = SmallVec::<[Lead; 16]>::with_capacity(pieces.len());
        for (piece, own) in pieces.iter().enumerate() {
            leads.extend(merging.deepest_of(own).map(|deepest| Lead { piece, deepest }));
        }
        let mut cells = NormalCells::of(pieces);
        let mut all = if cells.have_own_normals(pieces) {
            Self::of_one_each(merging, &leads)
        } else {
            Self::of_coplanar(merging, &leads, &mut cells)
        };
        let is_near =
            |lead: &Lead| merging.points[lead.deepest].distance <= merging.request.prediction;
        all.groups.retain(|group| is_near(&group.lead));
        all
    }

    /// Makes one group for each piece.
    fn of_one_each<N: Real, const D: usize>(merging: &Merging<'_, N, D>, leads: &[Lead]) -> Self {
        let group = |(at, lead): (usize, &Lead)| PieceGroup {
            lead: *lead,
            first: merging.pieces[lead.piece].parts,
            pieces: at..at + 1,
        };
        let order = leads.iter().map(|lead| lead.piece).collect();
        Self { groups: leads.iter().enumerate().map(group).collect(), order }
    }

    /// Adds each piece, deepest first, to the first group found whose lead is coplanar with it, or
    /// else to a new group.
    fn of_coplanar<N: Real, const D: usize>(
        merging: &Merging<'_, N, D>,
        leads: &[Lead],
        cells: &mut NormalCells,
    ) -> Self {
        let mut by_depth = SmallVec::<[(u64, u32); 16]>::with_capacity(leads.len());
        let distances = leads.iter().map(|lead| merging.points[lead.deepest].distance);
        by_depth.extend(distances.map(order_of).zip(0..));
        sort_keyed(&mut by_depth);
        let mut groups = SmallVec::<[PieceGroup; 8]>::new();
        let mut group_of = SmallVec::<[usize; 16]>::with_capacity(leads.len());
        for &(_, lead) in &by_depth {
            let lead = &leads[lead as usize];
            let is_coplanar = |&group: &usize| are_coplanar(merging, &groups[group].lead, lead);
            let known = if cells.is_one() {
                (0..groups.len()).find(is_coplanar)
            } else {
                cells.near(lead.piece).find(is_coplanar)
            };
            let (group, parts) = (known.unwrap_or(groups.len()), merging.pieces[lead.piece].parts);
            if known.is_none() {
                cells.put(group, lead.piece);
                groups.push(PieceGroup { lead: *lead, first: parts, pieces: 0..0 });
            }
            groups[group].first = groups[group].first.min(parts);
            groups[group].pieces.end += 1;
            group_of.push(group);
        }
        let pieces = by_depth.iter().map(|&(_, lead)| leads[lead as usize].piece);
        let order = pieces_by_group(&mut groups, pieces.zip(group_of));
        sort_by_parts(&mut groups);
        Self { groups, order }
    }

    /// Returns the indices of the pieces of a group.
    pub(super) fn pieces(&self, group: &PieceGroup) -> &[usize] {
        &self.order[group.pieces.clone()]
    }
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
    let is_same = (piece(lead1).normal - piece(lead2).normal).norm_squared() <= square_of_same();
    if !is_same {
        return false;
    }
    let [point1, point2] =
        [lead1, lead2].mapped(|lead| -> &RawPoint<N, D> { &merging.points[lead.deepest] });
    let arm = point2.point1 - point1.point1;
    let tolerance = N::lit(SAME) * arm.norm() + N::TWO * merging.tolerance;
    let rise1 = piece(lead1).normal.dot(&arm);
    let rise2 = rise1 + point2.distance - point1.distance;
    min(rise1.abs(), rise2.abs()) <= tolerance
}

fn square_of_same<N: Real>() -> N {
    N::lit(SAME) * N::lit(SAME)
}

/// An interval of the normals' component along [`AXIS`], and the patches in it.
struct NormalCell {
    /// Position of the interval on the axis, in lengths of a cell.
    number: i32,
    /// Patches whose lead is in this cell, the deepest first.
    patches: SmallVec<[usize; 2]>,
}

/// Cells of the normals; a single cell if there are few pieces.
struct NormalCells {
    /// Cells, in the order of their positions.
    cells: SmallVec<[NormalCell; 1]>,
    /// Index of the cell of each piece; empty if there is a single cell.
    of_pieces: Vec<usize>,
    /// Cell position and index of each piece, sorted; empty if there is a single cell.
    order: Vec<(i32, usize)>,
}

impl NormalCells {
    /// Sorts pieces into cells by their normals; up to [`FEW_PIECES`] pieces share one cell.
    fn of<N: Real, const D: usize>(pieces: &[Piece<N, D>]) -> Self {
        let (mut cells, mut of_pieces, mut order) = (SmallVec::new(), Vec::new(), Vec::new());
        let empty = |number| NormalCell { number, patches: SmallVec::new() };
        if pieces.len() <= FEW_PIECES {
            cells.push(empty(0));
            return Self { cells, of_pieces, order };
        }
        order.extend(pieces.iter().map(|piece| cell_of(&piece.normal)).zip(0..));
        order.sort_unstable();
        of_pieces.resize(pieces.len(), 0);
        for &(number, piece) in &order {
            if cells.last().is_none_or(|last: &NormalCell| last.number != number) {
                cells.push(empty(number));
            }
            of_pieces[piece] = cells.len() - 1;
        }
        Self { cells, of_pieces, order }
    }

    /// Returns whether all normals differ. Also returns `false` if the answer would take more than
    /// `MAX_ALIKE` comparisons per piece.
    fn have_own_normals<N: Real, const D: usize>(&self, pieces: &[Piece<N, D>]) -> bool {
        let are_apart = |a: usize, b: usize| {
            (pieces[a].normal - pieces[b].normal).norm_squared() > square_of_same()
        };
        if pieces.len() <= FEW_PIECES {
            return (1..pieces.len()).all(|at| (0..at).all(|before| are_apart(before, at)));
        }
        let mut rest = MAX_ALIKE * pieces.len();
        self.order.iter().enumerate().all(|(at, &(number, piece))| {
            let close = self.order[at + 1..].iter().take_while(|(other, _)| other - number <= 1);
            close.into_iter().all(|&(_, other)| {
                rest = rest.saturating_sub(1);
                rest > 0 && are_apart(piece, other)
            })
        })
    }

    /// Returns whether all pieces share one cell.
    const fn is_one(&self) -> bool {
        self.of_pieces.is_empty()
    }

    /// Returns the patches that may have the normal of a piece: those in its cell and in the two
    /// adjacent cells, from each cell at most the [`MAX_COMPARED`] deepest.
    fn near(&self, piece: usize) -> impl Iterator<Item = usize> {
        let own = self.of_pieces.get(piece).copied().unwrap_or(0);
        let number = self.cells[own].number;
        let close = &self.cells[own.saturating_sub(1)..self.cells.len().min(own + 2)];
        let close = close.iter().filter(move |cell| (cell.number - number).abs() <= 1);
        close.flat_map(|cell| cell.patches.iter().take(MAX_COMPARED).copied())
    }

    /// Adds a patch to the cell of `piece`, its deepest piece.
    fn put(&mut self, patch: usize, piece: usize) {
        let own = self.of_pieces.get(piece).copied().unwrap_or(0);
        self.cells[own].patches.push(patch);
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
    use super::*;
    use crate::math::xorshift::Xorshift;

    /// Returns `count` pieces without points, with normals in all directions. If `has_equal`, every
    /// fourth normal is nearly equal to the one before it.
    fn pieces<const D: usize>(count: usize, has_equal: bool) -> Vec<Piece<f64, D>> {
        let mut random = Xorshift(3);
        let mut pieces: Vec<Piece<f64, D>> = Vec::new();
        for at in 0..count {
            let is_near = has_equal && at % 4 == 3;
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
        let pieces = pieces::<D>(count, true);
        let (mut cells, mut compared, mut same) = (NormalCells::of(&pieces), 0, 0);
        assert!(!cells.have_own_normals(&pieces), "of {count} pieces some have one normal");
        for (at, piece) in pieces.iter().enumerate() {
            let near: Vec<usize> = cells.near(at).collect();
            compared += near.len();
            if near.len() < MAX_COMPARED {
                for (other, before) in pieces[..at].iter().enumerate() {
                    let is_same = (before.normal - piece.normal).norm() <= SAME;
                    assert!(!is_same || near.contains(&other), "{at} and {other}");
                    same += usize::from(is_same);
                }
            }
            cells.put(at, at);
        }
        assert!(same * 10 > count, "{same} have the same normal as another");
        assert!(compared <= most * count, "{compared} patches are compared with {count} pieces");
    }

    #[test]
    fn few_patches_are_near() {
        check::<3>(10, 10);
        for count in [100, 1000, 3000] {
            check::<3>(count, 4);
            check::<2>(count, MAX_COMPARED);
        }
    }

    #[test]
    fn normals_that_all_differ_are_found_to() {
        for count in [5, 40, 100] {
            let pieces = pieces::<3>(count, false);
            let are_apart = |at: usize, before: usize| {
                (pieces[at].normal - pieces[before].normal).norm() > SAME
            };
            assert!((1..count).all(|at| (0..at).all(|before| are_apart(at, before))));
            assert!(NormalCells::of(&pieces).have_own_normals(&pieces), "{count} normals");
        }
    }
}
