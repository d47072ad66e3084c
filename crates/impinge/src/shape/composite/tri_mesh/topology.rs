//! Which triangles share a side.

use crate::math::order::sort_few;
use crate::math::{Mapped, Point, Real};
use crate::shape::composite::joints::Joints;

/// What lies across a side of a triangle of a mesh.
///
/// Sides belong together by the positions of their ends, not by the indices.
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

/// Stored for [`EdgeNeighbor::Border`] and [`EdgeNeighbor::Several`].
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
    /// Vertices moved since: what is at one position need not be joined, nor the other way round.
    pub(super) is_moved: bool,
}

/// A side that has a joint for its lower end: the other end, whose side it is and which, and whether
/// it leads away from the joint.
type TopologySide = (u32, u32, u8, bool);

/// All sides with two ends, by their lower ends, and by joint where its sides end.
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
        let joints = Joints::new(vertices, triangles);
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
fn link(group: &[TopologySide], across: &mut [[u32; 3]]) {
    for &(_, own, side, _) in group {
        let mut others = group.iter().map(|&(_, index, ..)| index).filter(|&index| index != own);
        let first = others.next();
        let has_more = others.next().is_some();
        let found = if has_more { SEVERAL } else { first.unwrap_or(BORDER) };
        across[own as usize][usize::from(side)] = found;
    }
}
