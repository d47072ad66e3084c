//! Which of many patches may have a normal: they lie on shelves, each for the normals of one cell of a grid.

use smallvec::SmallVec;

use super::patch::{FEW_PIECES, Piece, SAME};
use crate::math::{Real, Vector};

/// How long the sides of cells are.
const CELL: f64 = 4.0 * SAME;
/// A patch lies on the shelves of all normals that differ by no more than this along each axis, by rounding more
/// than those of one patch may.
const REACH: f64 = SAME * (1.0 + 1.0 / 16.0);
/// Of the patches on a shelf, which lie in different planes, so many are looked at: the deepest.
const MAX_PLANES: usize = 32;

/// A cell of the grid; whole numbers.
type Cell<const D: usize> = [f64; D];

/// The patches of many pieces by their normals.
pub(super) struct Shelves<const D: usize> {
    /// Those of the normals of all pieces, in order; none of few pieces, which share one shelf.
    cells: Vec<Cell<D>>,
    /// By cell: patches in the order in which they were put there.
    shelves: SmallVec<[SmallVec<[usize; 8]>; 1]>,
}

impl<const D: usize> Shelves<D> {
    /// Empty shelves for the normals of some pieces.
    ///
    /// Cost: O(n log n) in the number of pieces.
    pub(super) fn of<N: Real>(pieces: &[Piece<N, D>]) -> Self {
        let mut cells = Vec::new();
        if pieces.len() > FEW_PIECES {
            cells.extend(pieces.iter().map(|piece| cell(&piece.normal, [0.0; D])));
            cells.sort_unstable_by(order);
            cells.dedup();
        }
        let shelves = SmallVec::from_elem(SmallVec::new(), cells.len().max(1));
        Self { cells, shelves }
    }

    /// Patches among which are all whose normals may be the same as that of a piece.
    pub(super) fn near<N: Real>(&self, normal: &Vector<N, D>) -> &[usize] {
        let shelf = self.at(&cell(normal, [0.0; D])).map_or(&[][..], |at| &self.shelves[at]);
        &shelf[..shelf.len().min(MAX_PLANES)]
    }

    /// Puts a patch on the shelves of all normals that may be the same.
    pub(super) fn put<N: Real>(&mut self, patch: usize, normal: &Vector<N, D>) {
        for corner in 0..1_u32 << D {
            let aside = |axis| if corner >> axis & 1 == 0 { -REACH } else { REACH };
            let at = self.at(&cell(normal, core::array::from_fn(aside)));
            if let Some(at) = at.filter(|&at| self.shelves[at].last() != Some(&patch)) {
                self.shelves[at].push(patch);
            }
        }
    }

    fn at(&self, cell: &Cell<D>) -> Option<usize> {
        if self.cells.is_empty() {
            return Some(0);
        }
        self.cells.binary_search_by(|other| order(other, cell)).ok()
    }
}

/// The cell of a vector moved aside.
fn cell<N: Real, const D: usize>(normal: &Vector<N, D>, aside: [f64; D]) -> Cell<D> {
    // Adding zero makes zeros of both signs one.
    core::array::from_fn(|axis| ((normal[axis].as_f64() + aside[axis]) / CELL).floor() + 0.0)
}

fn order<const D: usize>(a: &Cell<D>, b: &Cell<D>) -> core::cmp::Ordering {
    let axes = a.iter().zip(b).map(|(a, b)| a.total_cmp(b));
    axes.fold(core::cmp::Ordering::Equal, core::cmp::Ordering::then)
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
            let near = shelves.near(&piece.normal);
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
