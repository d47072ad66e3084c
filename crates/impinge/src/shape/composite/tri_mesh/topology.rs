//! Adjacency of triangles across sides.

use crate::math::order::sort_few;
use crate::math::{Mapped, Point, Real};
use crate::shape::composite::joints::Joints;

/// The neighbour across a side of a mesh triangle.
///
/// Sides join where the positions of their ends are equal, regardless of vertex indices.
///
/// ```
/// use impinge::dim2::math::Point;
/// use impinge::dim2::shape::{EdgeNeighbor, TriMesh};
///
/// let corners = [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(Point::<f32>::from);
/// let square = TriMesh::new(corners.to_vec(), vec![[0, 1, 2], [0, 2, 3]]);
/// assert_eq!(square.neighbor(0, 0), EdgeNeighbor::Border);
/// assert_eq!(square.neighbor(0, 2), EdgeNeighbor::Triangle { index: 1, is_flipped: false });
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum EdgeNeighbor {
    /// The side is on the border. A side without length counts as a border.
    Border,
    /// Exactly one triangle is across the side.
    Triangle {
        /// The index of the neighbouring triangle.
        index: u32,
        /// Whether both triangles traverse the side in the same direction: their fronts then
        /// disagree.
        is_flipped: bool,
    },
    /// More than one triangle is across the side.
    Several,
}

/// Codes of [`EdgeNeighbor::Border`] and [`EdgeNeighbor::Several`] in `across`.
const BORDER: u32 = u32::MAX;
const SEVERAL: u32 = u32::MAX - 1;

/// The connectivity of a mesh, without its geometry.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Topology {
    pub(super) joints: Joints,
    /// The triangle across each side of each triangle, or `BORDER` or `SEVERAL`.
    across: Vec<[u32; 3]>,
    /// Whether each side is traversed equally often in both directions.
    pub(super) is_cycle: bool,
    /// Whether vertices were moved since construction. Then joined vertices may be apart, and
    /// vertices at one position may not be joined.
    pub(super) is_moved: bool,
}

/// A side in the group of its end joint with the smaller index: the joint of the other end, the
/// triangle, the side's index within the triangle, and whether the triangle traverses the side from
/// the smaller joint to the larger.
type TopologySide = (u32, u32, u8, bool);

/// Returns all sides with two different ends, grouped by the end joint with the smaller index, and
/// the end of each joint's group in the list.
fn sides_by_joint(joints: &Joints, triangles: &[[u32; 3]]) -> (Vec<TopologySide>, Vec<usize>) {
    let each = |visit: &mut dyn FnMut(u32, TopologySide)| {
        for (index, triangle) in (0..).zip(triangles) {
            let [a, b, c] = triangle.mapped(|vertex| joints.of(vertex));
            for (side, [from, to]) in (0..).zip([[a, b], [b, c], [c, a]]) {
                if from != to {
                    visit(from.min(to), (from.max(to), index, side, from < to));
                }
            }
        }
    };
    let mut next = vec![0; joints.vertices()];
    each(&mut |joint, _| next[joint as usize] += 1);
    let mut total = 0;
    for count in &mut next {
        total += core::mem::replace(count, total);
    }
    let mut sides = vec![(0, 0, 0, false); total];
    each(&mut |joint, side| {
        sides[next[joint as usize]] = side;
        next[joint as usize] += 1;
    });
    (sides, next)
}

impl Topology {
    pub(super) fn new<N: Real, const D: usize>(
        vertices: &[Point<N, D>],
        triangles: &[[u32; 3]],
    ) -> Self {
        Self::of_joints(Joints::new(vertices, triangles), triangles)
    }

    /// Computes the adjacency of triangles that meet at the given joints.
    pub(super) fn of_joints(joints: Joints, triangles: &[[u32; 3]]) -> Self {
        let mut across = vec![[BORDER; 3]; triangles.len()];
        let (mut is_cycle, (mut sides, ends)) = (true, sides_by_joint(&joints, triangles));
        let mut start = 0;
        for end in ends {
            let own = &mut sides[core::mem::replace(&mut start, end)..end];
            sort_few(own, |one, other| one < other);
            for group in own.chunk_by(|a, b| a.0 == b.0) {
                link(group, &mut across);
                let forward = group.iter().filter(|side| side.3).count();
                is_cycle &= 2 * forward == group.len();
            }
        }
        Self { joints, across, is_cycle, is_moved: false }
    }

    /// Returns the triangle across a side if there is exactly one, else `None`.
    pub(super) fn single_across(&self, triangle: u32, side: usize) -> Option<u32> {
        Some(self.across[triangle as usize][side]).filter(|&across| across < SEVERAL)
    }

    /// Returns whether more than one triangle is across a side.
    pub(super) fn has_several_across(&self, triangle: u32, side: usize) -> bool {
        self.across[triangle as usize][side] == SEVERAL
    }

    pub(super) fn is_border(&self, triangle: u32, side: usize) -> bool {
        self.across[triangle as usize][side] == BORDER
    }
}

/// Stores the neighbours of the triangles in `group`: sides with equal ends, in ascending order. A
/// triangle without area may occur twice.
fn link(group: &[TopologySide], across: &mut [[u32; 3]]) {
    for &(_, own, side, _) in group {
        let mut others = group.iter().map(|&(_, index, ..)| index).filter(|&index| index != own);
        let first = others.next();
        let has_more = others.next().is_some();
        let found = if has_more { SEVERAL } else { first.unwrap_or(BORDER) };
        across[own as usize][usize::from(side)] = found;
    }
}
