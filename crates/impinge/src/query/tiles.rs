//! Parts of a surface side by side, for computing with eight at a time.

use crate::math::{Point, Real, Vector};

/// How many parts lie side by side.
pub(crate) const LANES: usize = 8;

/// The corners of eight parts in the frame of their composite. A segment has its second end twice; where
/// there are fewer parts the last stands for the rest.
#[derive(Clone, Debug)]
pub(crate) struct Tiles<N, const D: usize> {
    /// By corner and coordinate.
    pub(crate) corners: [[[N; LANES]; D]; 3],
}

/// Some of the parts of many tiles.
pub(crate) struct TiledParts<'a, N: Real, const D: usize> {
    pub(crate) tiles: &'a [Tiles<N, D>],
    /// For each of the tiles a bit for each part that is meant.
    pub(crate) near: &'a [u8],
    /// Where the parts are to be seen from.
    pub(crate) origin: Vector<N, D>,
}

impl<N: Real, const D: usize> Tiles<N, D> {
    pub(crate) fn blank() -> Self {
        Self { corners: [[[N::ZERO; LANES]; D]; 3] }
    }

    pub(crate) fn put(&mut self, lane: usize, corners: &[Point<N, D>; 3]) {
        for (rows, corner) in self.corners.iter_mut().zip(corners) {
            for (axis, row) in rows.iter_mut().enumerate() {
                row[lane] = corner[axis];
            }
        }
    }

    pub(crate) fn corners(&self, lane: usize) -> [Point<N, D>; 3] {
        let mut corners = [Point::origin(); 3];
        for (corner, rows) in corners.iter_mut().zip(&self.corners) {
            for (axis, row) in rows.iter().enumerate() {
                corner[axis] = row[lane];
            }
        }
        corners
    }
}
