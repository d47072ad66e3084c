//! Which triangles share a side.

use super::super::joints::Joints;
use crate::math::{Point, Real};

/// What lies across a side of a triangle of a mesh.
///
/// Sides belong together by the positions of their ends, not by the indices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Neighbor {
    /// Nothing: the side is on the border. So is a side without length.
    Border,
    /// One triangle.
    Triangle {
        /// Its index.
        index: u32,
        /// Both run along the side in the same direction, so that their fronts do not agree.
        is_flipped: bool,
    },
    /// More than one triangle.
    Several,
}

/// Stored for [`Neighbor::Border`] and [`Neighbor::Several`].
const BORDER: u32 = u32::MAX;
const SEVERAL: u32 = u32::MAX - 1;

/// What a mesh knows of its triangles but their shape.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Topology {
    pub(super) joints: Joints,
    /// By triangle and side: the triangle across, or one of the two numbers above.
    across: Vec<[u32; 3]>,
    /// Each side is run along as often in one direction as in the other.
    pub(super) is_cycle: bool,
}

/// A side by its ends, the smaller joint first, and whose it is.
type Side = ([u32; 2], u32, u8);

impl Topology {
    pub(super) fn new<N: Real, const D: usize>(
        vertices: &[Point<N, D>],
        triangles: &[[u32; 3]],
    ) -> Self {
        let joints = Joints::new(vertices, triangles);
        let mut sides: Vec<Side> = Vec::with_capacity(3 * triangles.len());
        for (index, triangle) in (0..).zip(triangles) {
            let [a, b, c] = triangle.map(|vertex| joints.of(vertex));
            for (side, [from, to]) in (0..).zip([[a, b], [b, c], [c, a]]) {
                if from != to {
                    sides.push(([from.min(to), from.max(to)], index, side));
                }
            }
        }
        sides.sort_unstable();
        let mut across = vec![[BORDER; 3]; triangles.len()];
        let mut is_cycle = true;
        for group in sides.chunk_by(|a, b| a.0 == b.0) {
            link(group, &mut across);
            let is_forward = |&&([from, _], index, side): &&Side| {
                joints.of(triangles[index as usize][usize::from(side)]) == from
            };
            is_cycle &= 2 * group.iter().filter(is_forward).count() == group.len();
        }
        Self { joints, across, is_cycle }
    }

    /// The triangle that is alone across a side.
    pub(super) fn single_across(&self, triangle: u32, side: usize) -> Option<u32> {
        Some(self.across[triangle as usize][side]).filter(|&across| across < SEVERAL)
    }

    /// More than one triangle is across a side.
    pub(super) fn has_several_across(&self, triangle: u32, side: usize) -> bool {
        self.across[triangle as usize][side] == SEVERAL
    }

    pub(super) fn is_border(&self, triangle: u32, side: usize) -> bool {
        self.across[triangle as usize][side] == BORDER
    }
}

/// Tells each triangle of a side about the others. They are in ascending order, one without area
/// perhaps twice.
fn link(group: &[Side], across: &mut [[u32; 3]]) {
    for &(_, own, side) in group {
        let mut others = group.iter().map(|&(_, index, _)| index).filter(|&index| index != own);
        let first = others.next();
        let has_more = others.next().is_some();
        let found = if has_more { SEVERAL } else { first.unwrap_or(BORDER) };
        across[own as usize][usize::from(side)] = found;
    }
}
