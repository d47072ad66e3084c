//! A growing polytope of triangles, for `epa3`.
//!
//! ```text
//!       a ----- b              a ----- b
//!       | x  /  |              | \   / |      x: faces that the apex * lies beyond: removed
//!       |  /  x |     --->     |   *   |      horizon: the sides ab, bc, cd, da, each of only one
//!       d ----- c              | /   \ |      removed face; each becomes [start, end, apex]
//!                              d ----- c
//! ```
//!
//! Faces have no links to their neighbours. The orientation of a new face follows from the
//! orientation of the removed faces, never from a sign that rounding could change. So the surface
//! stays closed even if rounding makes wrong faces visible. Indices of vertices are `u16`, because
//! the rounds of `epa3` are capped.

use smallvec::SmallVec;

use super::difference::{Vertex, rounding_error};
use crate::math::{Mapped, Real, Vector, cross, max, unit};

/// A triangle; its corners run counter-clockwise seen from outside.
#[derive(Clone, Copy)]
pub(super) struct EpaFace<N: Real> {
    pub(super) corners: [u16; 3],
    /// Outward unit normal.
    pub(super) outward: Vector<N, 3>,
    /// Signed distance of the face's plane from the origin along `outward`, negative if the origin
    /// is in front of the face; infinite if the face is too thin to have a normal.
    pub(super) offset: N,
    /// Whether [`Hull::finalize`] has set `offset`; the face then grows no more.
    pub(super) is_final: bool,
}

/// Directed sides of a hole in the surface, each with the direction that it has in the removed
/// face.
type Horizon = SmallVec<[[u16; 2]; 24]>;

/// Indices of faces.
type FaceIndices = SmallVec<[usize; 16]>;

/// A closed polytope inside the difference, and vertices that belong to no face.
pub(super) struct Hull<N: Real> {
    vertices: SmallVec<[Vertex<N, 3>; 32]>,
    faces: SmallVec<[EpaFace<N>; 48]>,
}

impl<N: Real> Hull<N> {
    /// Creates a tetrahedron, its corners in any order.
    pub(super) fn new(corners: [Vertex<N, 3>; 4]) -> Self {
        let [a, b, c, d] = corners.mapped(|corner| corner.point);
        let volume = cross(&(b - a), &(c - a)).dot(&(d - a));
        let mut vertices = SmallVec::from_slice(&corners);
        if volume > N::ZERO {
            vertices.swap(1, 2);
        }
        let mut hull = Self { vertices, faces: SmallVec::new() };
        for corners in [[0, 1, 2], [0, 3, 1], [0, 2, 3], [1, 3, 2]] {
            hull.faces.push(hull.face_of(corners));
        }
        hull
    }

    pub(super) fn vertices(&self) -> &[Vertex<N, 3>] {
        &self.vertices
    }

    pub(super) fn vertex(&self, index: u16) -> &Vertex<N, 3> {
        &self.vertices[usize::from(index)]
    }

    pub(super) fn face(&self, index: usize) -> &EpaFace<N> {
        &self.faces[index]
    }

    /// Returns whether a vertex of the hull equals the point of `vertex` exactly.
    pub(super) fn contains(&self, vertex: &Vertex<N, 3>) -> bool {
        self.vertices.iter().any(|known| known.point == vertex.point)
    }

    /// Returns the index of the face with the smallest offset; `None` if all faces are too thin.
    pub(super) fn nearest(&self) -> Option<usize> {
        let (mut nearest, mut offset) = (None, N::INFINITY);
        for (index, face) in self.faces.iter().enumerate() {
            if face.offset < offset {
                (nearest, offset) = (Some(index), face.offset);
            }
        }
        nearest
    }

    /// Returns the outward unit normals of the faces whose offset is below `offset`.
    pub(super) fn nearer_than(&self, offset: N) -> impl Iterator<Item = Vector<N, 3>> + '_ {
        let faces = self.faces.iter().filter(move |face| face.offset < offset);
        faces.map(|face| face.outward)
    }

    /// Marks a face as final and sets its offset to `offset`: the height, with the opposite sign,
    /// of the best normal known for the face.
    pub(super) fn finalize(&mut self, index: usize, offset: N) {
        self.faces[index].offset = offset;
        self.faces[index].is_final = true;
    }

    /// Adds vertices without faces; these are used only for the points of the answer
    /// ([`Self::vertices`]).
    pub(super) fn keep(&mut self, vertices: &[Vertex<N, 3>]) {
        self.vertices.extend_from_slice(vertices);
    }

    /// Grows the polytope to include a point beyond the face `from`.
    pub(super) fn extend(&mut self, from: usize, vertex: Vertex<N, 3>) {
        let apex = u16::try_from(self.vertices.len()).expect("the number of rounds is capped");
        self.vertices.push(vertex);
        let mut visible = self.visible(from, &vertex);
        let (mut outline, mut free) = (Horizon::new(), FaceIndices::new());
        self.uncover(from, &mut outline);
        free.push(from);
        // Only faces connected to `from` are removed: a face elsewhere that rounding makes visible
        // would tear a second hole.
        while let Some(next) = visible.iter().position(|&face| self.adjoins(face, &outline)) {
            let face = visible.swap_remove(next);
            self.uncover(face, &mut outline);
            free.push(face);
        }
        for [a, b] in outline {
            let face = self.face_of([a, b, apex]);
            match free.pop() {
                Some(index) => self.faces[index] = face,
                None => self.faces.push(face),
            }
        }
        free.sort_unstable();
        while let Some(index) = free.pop() {
            self.faces.swap_remove(index);
        }
    }

    /// Returns the indices of the faces other than `from` that a point lies beyond, and of those
    /// too thin to have a normal.
    fn visible(&self, from: usize, vertex: &Vertex<N, 3>) -> FaceIndices {
        let mut visible = FaceIndices::new();
        for (index, face) in self.faces.iter().enumerate() {
            let beyond = face.outward.dot(&vertex.point) - face.offset > rounding_error();
            if index != from && (beyond || face.offset == N::INFINITY) {
                visible.push(index);
            }
        }
        visible
    }

    /// Returns whether a face has the reverse of a side of the hole's outline.
    fn adjoins(&self, face: usize, outline: &Horizon) -> bool {
        let [a, b, c] = self.faces[face].corners;
        outline.iter().any(|side| [[b, a], [c, b], [a, c]].contains(side))
    }

    /// Removes a face from the surface. Each of its sides is added to the outline, unless the
    /// outline has the reversed side, which is then removed.
    fn uncover(&self, face: usize, outline: &mut Horizon) {
        let [a, b, c] = self.faces[face].corners;
        for [start, end] in [[a, b], [b, c], [c, a]] {
            match outline.iter().position(|&side| side == [end, start]) {
                Some(index) => {
                    outline.swap_remove(index);
                }
                None => outline.push([start, end]),
            }
        }
    }

    fn face_of(&self, corners: [u16; 3]) -> EpaFace<N> {
        let [a, b, c] = corners.mapped(|corner| self.vertex(corner).point);
        let (e, f) = (b - a, c - a);
        let normal = cross(&e, &f);
        let longest = max(max(e.norm_squared(), f.norm_squared()), (c - b).norm_squared());
        let sound = normal.norm_squared() > rounding_error::<N>() * rounding_error() * longest;
        let direction = unit(&normal).filter(|_| sound);
        let (outward, offset) = direction.map_or((Vector::<N, 3>::zeros(), N::INFINITY), |found| {
            let (outward, _) = found;
            (outward, outward.dot(&a))
        });
        EpaFace { corners, outward, offset, is_final: false }
    }
}
