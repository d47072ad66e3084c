//! Corners of the parts of a surface, in structure-of-arrays layout for computing with 8 parts at
//! once.
//!
//! ```text
//!   corners[c][axis][lane]     c: corner 0, 1, 2 of the part; a segment has its second end twice
//!                              lane: part `tile * 8 + lane` of a list; spare: copies of the last
//! ```
//!
//! `mesh/part_cache.rs` keeps lists of packets, called tiles. `mesh/cull.rs`,
//! `separation/triangles`, `separation/chain`, `manifold/face_lanes`, `parts/pair_lanes.rs` and
//! `parts/slab_lanes.rs` read packets 8 lanes at a time.

use crate::math::{Point, Real};

/// Number of parts in one packet.
pub(crate) const LANES: usize = 8;

/// Corners of 8 parts in the frame of their composite. For a segment, the second end occurs twice;
/// if there are fewer parts, copies of the last one fill the remaining lanes.
#[derive(Clone, Debug)]
pub(crate) struct PartPacket<N, const D: usize> {
    /// Coordinates, indexed by corner, axis and lane.
    pub(crate) corners: [[[N; LANES]; D]; 3],
}

impl<N: Real, const D: usize> PartPacket<N, D> {
    pub(crate) fn blank() -> Self {
        Self { corners: [[[N::ZERO; LANES]; D]; 3] }
    }

    /// Copies the part in lane `lane` of `given` into lane `at` of this packet.
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
