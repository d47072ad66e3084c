//! Joints of a surface: the positions at which its parts meet, regardless of vertex indices.

use crate::math::{Mapped, Point, Real, filled};

/// The joints of a surface, with the parts that meet at each.
///
/// Vertices at the same position form one joint. Its index is the smallest index of its vertices.
/// So pieces with duplicated vertices, as exporters write them, join like pieces that share
/// vertices.
///
/// ```text
/// of_vertex[v]   joint of vertex v: the lowest vertex at its position
/// starts[j]      start of joint j in `parts`; one more entry for the end
/// parts          | parts at joint 0 | parts at joint 1 | …     ascending, each once per joint
/// ```
#[derive(Clone, Debug, PartialEq)]
pub(in crate::shape) struct Joints {
    /// The joint of each vertex: the smallest index of a vertex at the same position.
    of_vertex: Vec<u32>,
    /// For each joint, the index in `parts` where its list starts; the last entry is the length of
    /// `parts`.
    starts: Vec<u32>,
    /// The parts of each joint, in ascending order and without duplicates.
    parts: Vec<u32>,
}

impl Joints {
    /// Computes the joints of parts with `K` vertices each. The vertex indices must be valid.
    pub(in crate::shape) fn new<N: Real, const D: usize, const K: usize>(
        vertices: &[Point<N, D>],
        parts: &[[u32; K]],
    ) -> Self {
        Self::of_vertices(welded(vertices), parts)
    }

    /// Computes the joints of parts with `K` vertices each from `of_vertex`, the joint of each
    /// vertex.
    pub(in crate::shape) fn of_vertices<const K: usize>(
        of_vertex: Vec<u32>,
        parts: &[[u32; K]],
    ) -> Self {
        let mut starts = vec![0; of_vertex.len() + 1];
        let each = |visit: &mut dyn FnMut(u32, u32)| {
            for (part, corners) in (0..).zip(parts) {
                let joints = corners.mapped(|vertex| of_vertex[vertex as usize]);
                let is_new = |&at: &usize| !joints[..at].contains(&joints[at]);
                (0..K).filter(is_new).for_each(|at| visit(joints[at], part));
            }
        };
        each(&mut |joint, _| starts[joint as usize + 1] += 1);
        for at in 1..starts.len() {
            starts[at] += starts[at - 1];
        }
        let total = starts.last().copied().unwrap_or(0);
        let (mut next, mut listed) = (starts.clone(), vec![0; total as usize]);
        each(&mut |joint, part| {
            listed[next[joint as usize] as usize] = part;
            next[joint as usize] += 1;
        });
        Self { of_vertex, starts, parts: listed }
    }

    /// Returns the number of vertices.
    pub(in crate::shape) const fn vertices(&self) -> usize {
        self.of_vertex.len()
    }

    /// Returns the joint of a vertex.
    #[inline]
    pub(in crate::shape) fn of(&self, vertex: u32) -> u32 {
        self.of_vertex[vertex as usize]
    }

    /// Returns the joint of each vertex, in the order of the vertices.
    pub(in crate::shape) fn of_vertices_in_order(&self) -> &[u32] {
        &self.of_vertex
    }

    /// Returns the parts that meet at a joint, in ascending order.
    #[inline]
    pub(in crate::shape) fn parts(&self, joint: u32) -> &[u32] {
        let [start, end] = [0, 1].mapped(|next| self.starts[joint as usize + next] as usize);
        &self.parts[start..end]
    }

    /// Returns whether all vertices of each joint that belong to one of `parts` still have the same
    /// position.
    pub(in crate::shape) fn are_together<N: Real, const D: usize, const K: usize>(
        &self,
        vertices: &[Point<N, D>],
        parts: &[[u32; K]],
    ) -> bool {
        // The position of each joint: that of the first vertex of a part there.
        let mut positions = vec![None; vertices.len()];
        parts.as_flattened().iter().all(|&vertex| {
            let position = &vertices[vertex as usize];
            *positions[self.of(vertex) as usize].get_or_insert(position) == position
        })
    }
}

/// Returns for each vertex the smallest index of a vertex at the same position, where +0 and −0 are
/// equal.
fn welded<N: Real, const D: usize>(vertices: &[Point<N, D>]) -> Vec<u32> {
    let key = |vertex: u32| -> [u64; D] {
        filled(|axis| (vertices[vertex as usize][axis] + N::ZERO).bits())
    };
    let mut first: Vec<u32> = (0..).take(vertices.len()).collect();
    let mut order = first.clone();
    order.sort_unstable_by_key(|&vertex| (key(vertex), vertex));
    for pair in order.windows(2) {
        if key(pair[0]) == key(pair[1]) {
            first[pair[1] as usize] = first[pair[0] as usize];
        }
    }
    first
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn equal_positions_are_one_joint() {
        let vertices = [0.0_f32, 1.0, 1.0, -0.0, 2.0, 1.0].mapped(|x| Point::<f32, 2>::new(x, 0.0));
        let joints = Joints::new(&vertices, &[[0, 1], [2, 4], [5, 3], [5, 1]]);
        assert_eq!((0..6).map(|v| joints.of(v)).collect::<Vec<_>>(), [0, 1, 1, 0, 4, 1], "first");
        assert_eq!(joints.parts(0), [0, 2], "zeros of both signs are equal");
        assert_eq!(joints.parts(1), [0, 1, 2, 3], "the last part only once");
        assert_eq!((joints.parts(4), joints.parts(5)), ([1].as_slice(), [].as_slice()), "others");
    }

    #[test]
    fn only_vertices_of_parts_are_together() {
        let at = |xs: [f64; 4]| xs.mapped(|x| Point::<f64, 2>::new(x, 0.0));
        let parts = [[1, 3], [3, 2]];
        let joints = Joints::new(&at([0.0, 0.0, 0.0, 1.0]), &parts);
        assert!(joints.are_together(&at([0.0, 2.0, 2.0, 1.0]), &parts), "0 belongs to no part");
        assert!(!joints.are_together(&at([2.0, 2.0, 0.0, 1.0]), &parts), "1 and 2 are apart");
    }
}
