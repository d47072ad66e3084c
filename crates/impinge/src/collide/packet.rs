//! Parts of a surface side by side, for computing with eight at a time.

use crate::convex::Separation;
use crate::math::{Point, Real, Vector};
use crate::shape::FeatureId;

/// How many parts lie side by side.
pub(crate) const LANES: usize = 8;

/// The corners of eight parts in the frame of their composite. A segment has its second end twice; where
/// there are fewer parts the last stands for the rest.
#[derive(Clone, Debug)]
pub(crate) struct PartPacket<N, const D: usize> {
    /// By corner and coordinate.
    pub(crate) corners: [[[N; LANES]; D]; 3],
}

/// Some of the parts of many tiles.
pub(crate) struct TiledParts<'a, N: Real, const D: usize> {
    pub(crate) tiles: &'a [PartPacket<N, D>],
    /// For each of the tiles a bit for each part that is meant.
    pub(crate) near: &'a [u8],
    /// Where the parts are to be seen from.
    pub(crate) origin: Vector<N, D>,
}

/// How far a solid and a part are apart, in the frame of the first of the pair. The points cost more than
/// this, and few contacts need them.
#[derive(Clone, Copy)]
pub(crate) struct PartGap<N: Real, const D: usize> {
    pub(crate) distance: N,
    /// Unit, from the first of the pair to the second.
    pub(crate) normal: Vector<N, D>,
    /// What of the part is nearest, where that is plain.
    pub(crate) touched: Option<FeatureId>,
    /// The separation, if it is known.
    pub(crate) witness: Option<Separation<N, D>>,
}

/// Is called with the number of a part, counted among those that are meant, and what is known of it.
pub(crate) type GapVisitor<'v, N, const D: usize> =
    &'v mut dyn FnMut(usize, Option<&PartGap<N, D>>);

impl<N: Real, const D: usize> PartGap<N, D> {
    /// Of a separation that is known.
    pub(crate) fn of(found: &Separation<N, D>) -> Self {
        let Separation { distance, normal, .. } = *found;
        Self { distance, normal, touched: None, witness: Some(*found) }
    }
}

impl<N: Real, const D: usize> TiledParts<'_, N, D> {
    /// The tile and the lane of each part that is meant.
    pub(crate) fn places(&self) -> impl Iterator<Item = (&PartPacket<N, D>, usize)> {
        let lanes = |near: u8| (0..LANES).filter(move |lane| near >> lane & 1 == 1);
        let all = self.tiles.iter().zip(self.near);
        all.flat_map(move |(tiles, near)| lanes(*near).map(move |lane| (tiles, lane)))
    }
}

impl<N: Real, const D: usize> PartPacket<N, D> {
    pub(crate) fn blank() -> Self {
        Self { corners: [[[N::ZERO; LANES]; D]; 3] }
    }

    /// Copies a part from other tiles.
    #[inline]
    pub(crate) fn copy(&mut self, at: usize, given: &Self, lane: usize) {
        for (rows, given) in self.corners.iter_mut().zip(&given.corners) {
            for (row, given) in rows.iter_mut().zip(given) {
                row[at] = given[lane];
            }
        }
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
