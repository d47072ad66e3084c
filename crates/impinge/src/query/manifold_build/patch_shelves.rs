//! Which of many patches may have a normal: they lie on shelves, each for the normals of one cell of a grid.

use smallvec::SmallVec;

use super::patch::{FEW_PIECES, Piece, SAME};
use crate::math::{Real, Vector};

/// How long the sides of cells are.
const CELL: f64 = 4.0 * SAME;
/// A patch lies on the shelves of all normals that differ by no more than this along each of [`WAYS`], by rounding
/// more than those of one patch may.
const REACH: f64 = SAME * (1.0 + 1.0 / 16.0);
/// Of the patches on a shelf, which lie in different planes, so many are looked at: the deepest.
const MAX_PLANES: usize = 32;
/// The axes of the grid, unit vectors: two tell nearly all normals apart. They are askew to the axes of space,
/// along which most faces of what people build lie.
const WAYS: [[f64; 3]; 2] = [[0.36, 0.48, 0.8], [0.48, 0.64, -0.6]];

/// A cell of the grid: its two whole numbers, one after the other.
type Cell = i64;

/// The patches of many pieces by their normals.
pub(super) struct Shelves {
    /// Those of the normals of all pieces, in order; none of few pieces, which share one shelf.
    cells: Vec<Cell>,
    /// For each piece its shelf; none of few pieces.
    of_pieces: Vec<usize>,
    /// By cell: patches in the order in which they were put there.
    shelves: SmallVec<[SmallVec<[usize; 4]>; 1]>,
}

impl Shelves {
    /// Empty shelves for the normals of some pieces.
    ///
    /// Cost: O(n log n) in the number of pieces.
    pub(super) fn of<N: Real, const D: usize>(pieces: &[Piece<N, D>]) -> Self {
        let (mut cells, mut of_pieces) = (Vec::new(), Vec::new());
        if pieces.len() > FEW_PIECES {
            let cell_of = |piece: &Piece<N, D>| cell(heights(&piece.normal));
            let mut order: Vec<(Cell, usize)> = pieces.iter().map(cell_of).zip(0..).collect();
            order.sort_unstable();
            of_pieces.resize(pieces.len(), 0);
            for (cell, piece) in order {
                if cells.last() != Some(&cell) {
                    cells.push(cell);
                }
                of_pieces[piece] = cells.len() - 1;
            }
        }
        let shelves = SmallVec::from_elem(SmallVec::new(), cells.len().max(1));
        Self { cells, of_pieces, shelves }
    }

    /// Patches among which are all whose normals may be the same as that of a piece.
    pub(super) fn near(&self, piece: usize) -> &[usize] {
        let shelf = &self.shelves[self.of_pieces.get(piece).copied().unwrap_or(0)];
        &shelf[..shelf.len().min(MAX_PLANES)]
    }

    /// Puts a patch on the shelves of all normals that may be the same.
    pub(super) fn put<N: Real, const D: usize>(&mut self, patch: usize, normal: &Vector<N, D>) {
        let [first, second] = heights(normal);
        for (aside1, aside2) in [(-REACH, -REACH), (-REACH, REACH), (REACH, -REACH), (REACH, REACH)]
        {
            let shelf = self.shelf(cell([first + aside1, second + aside2]));
            if let Some(shelf) = shelf.map(|shelf| &mut self.shelves[shelf])
                && shelf.last() != Some(&patch)
            {
                shelf.push(patch);
            }
        }
    }

    fn shelf(&self, cell: Cell) -> Option<usize> {
        if self.cells.is_empty() { Some(0) } else { self.cells.binary_search(&cell).ok() }
    }
}

/// How far a normal points along the axes of the grid.
fn heights<N: Real, const D: usize>(normal: &Vector<N, D>) -> [f64; 2] {
    let along = |sum: f64, (own, way): (&N, f64)| sum + own.as_f64() * way;
    WAYS.map(|way| normal.iter().zip(way).fold(0.0, along))
}

#[expect(clippy::cast_possible_truncation, reason = "a unit vector is in some hundreds of cells")]
fn cell(heights: [f64; 2]) -> Cell {
    let [first, second] = heights.map(|height| (height / CELL).floor() as i32);
    Cell::from(first) << 32 | Cell::from(second) & 0xffff_ffff
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::noise::Noise;

    /// Pieces without points, with normals all over, of which some are nearly equal.
    fn pieces<const D: usize>(count: usize) -> Vec<Piece<f64, D>> {
        let mut noise = Noise(3);
        let mut pieces: Vec<Piece<f64, D>> = Vec::new();
        for at in 0..count {
            let near = if at % 4 == 3 { pieces[at - 1].normal } else { Vector::<f64, D>::zeros() };
            let scale = if at % 4 == 3 { 0.4 * SAME } else { 1.0 };
            let aside = Vector::<f64, D>::from_fn(|_, _| scale * noise.next());
            let normal = (near + aside).normalize();
            pieces.push(Piece { normal, parts: [0; 2], points: 0..0 });
        }
        pieces
    }

    /// All patches with the same normal are near, and few others: their number does not grow with that of all.
    fn check<const D: usize>(count: usize, most: usize) {
        let pieces = pieces::<D>(count);
        let (mut shelves, mut looked, mut same) = (Shelves::of(&pieces), 0, 0);
        for (at, piece) in pieces.iter().enumerate() {
            let near = shelves.near(at);
            looked += near.len();
            if near.len() < MAX_PLANES {
                for (other, before) in pieces[..at].iter().enumerate() {
                    let is_same = (before.normal - piece.normal).norm() <= SAME;
                    assert!(!is_same || near.contains(&other), "{at} and {other}");
                    same += usize::from(is_same);
                }
            }
            shelves.put(at, &piece.normal);
        }
        assert!(same * 10 > count, "{same} have the same normal as another");
        assert!(looked <= most * count, "{looked} patches are looked at for {count} pieces");
    }

    #[test]
    fn few_patches_are_near() {
        check::<3>(10, 10);
        for count in [100, 1000, 3000] {
            check::<3>(count, 4);
            check::<2>(count, MAX_PLANES);
        }
    }
}
