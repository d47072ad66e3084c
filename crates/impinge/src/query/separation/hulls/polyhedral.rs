//! Convex polyhedra, hulls and boxes alike: vertices and face planes in lanes, edges, and the rings of faces.

use core::array::from_fn;

use super::edges::MAX_EDGES;
use super::{BLOCKS, LANES, PLANE_BLOCKS};
use crate::math::{Real, Vector};
use crate::shape::{Cuboid, Planes, Polytope, PolytopeEdge, SupportMap};

/// A convex polyhedron in its own frame.
pub(super) struct Polyhedral<'a, N: Real> {
    /// The vertices, eight at a time; the last one fills the rest.
    pub(super) blocks: &'a [[[N; LANES]; 3]],
    pub(super) vertices: usize,
    /// The planes of the faces, eight at a time; the last one fills the rest.
    pub(super) planes: &'a [Planes<N, 3>],
    pub(super) edges: &'a [PolytopeEdge],
    rings: Rings<'a, N>,
    pub(super) reach: N,
}

/// The vertices around the faces.
enum Rings<'a, N: Real> {
    OfPolytope(&'a Polytope<N, 3>),
    OfBox,
}

impl<'a, N: Real> Polyhedral<'a, N> {
    /// `None` for a polytope with more features than the lanes hold.
    pub(super) fn of_polytope(polytope: &'a Polytope<N, 3>) -> Option<Self> {
        let (blocks, planes) = (polytope.blocks(), polytope.planes());
        let fits = blocks.len() <= BLOCKS
            && planes.len() <= PLANE_BLOCKS
            && polytope.edges().len() <= MAX_EDGES;
        fits.then(|| Self {
            blocks,
            vertices: polytope.vertices().len(),
            planes,
            edges: polytope.edges(),
            rings: Rings::OfPolytope(polytope),
            reach: polytope.reach(),
        })
    }

    /// The number of faces.
    pub(super) fn faces(&self) -> usize {
        match self.rings {
            Rings::OfPolytope(polytope) => polytope.faces().len(),
            Rings::OfBox => 6,
        }
    }

    /// The vertices around a face, counter-clockwise seen from outside.
    pub(super) fn ring(&self, face: usize) -> &[u32] {
        match self.rings {
            Rings::OfPolytope(polytope) => polytope.face_vertices(&polytope.faces()[face]),
            Rings::OfBox => &BOX_RINGS[face],
        }
    }

    /// The outward unit normal of a face.
    #[inline(always)]
    pub(super) fn normal(&self, face: usize) -> Vector<N, 3> {
        let [x, y, z] = &self.planes[face / LANES].normals;
        let lane = face % LANES;
        Vector::<N, 3>::new(x[lane], y[lane], z[lane])
    }

    /// How far from the origin the plane of a face lies.
    #[inline(always)]
    pub(super) fn offset(&self, face: usize) -> N {
        self.planes[face / LANES].offsets[face % LANES]
    }
}

/// The vertices and face planes of a box, in lanes.
pub(super) struct BoxFeatures<N: Real> {
    blocks: [[[N; LANES]; 3]; 1],
    planes: [Planes<N, 3>; 1],
    reach: N,
}

impl<N: Real> BoxFeatures<N> {
    pub(super) fn new(cuboid: &Cuboid<N, 3>) -> Self {
        let half = cuboid.half_extents();
        let signed = |axis: usize, bit: usize| if bit == 0 { -half[axis] } else { half[axis] };
        let vertices = from_fn(|axis| from_fn(|vertex| signed(axis, vertex >> axis & 1)));
        // Faces 2 · axis on the positive side, one more on the negative side; the last one fills up.
        let face = |lane: usize| if lane < 6 { lane } else { 5 };
        let along = |axis: usize, lane: usize| match face(lane) {
            face if face / 2 != axis => N::ZERO,
            face if face % 2 == 0 => N::ONE,
            _ => -N::ONE,
        };
        let planes = Planes {
            normals: from_fn(|axis| from_fn(|lane| along(axis, lane))),
            offsets: from_fn(|lane| half[face(lane) / 2]),
        };
        Self { blocks: [vertices], planes: [planes], reach: cuboid.reach() }
    }

    pub(super) fn polyhedral(&self) -> Polyhedral<'_, N> {
        Polyhedral {
            blocks: &self.blocks,
            vertices: 8,
            planes: &self.planes,
            edges: &BOX_EDGES,
            rings: Rings::OfBox,
            reach: self.reach,
        }
    }
}

/// The edges of a box by their numbers; see [`Cuboid`].
const BOX_EDGES: [PolytopeEdge; 12] = {
    let mut edges = [PolytopeEdge { vertices: [0; 2], faces: [0; 2] }; 12];
    let mut number = 0_u32;
    while number < 12 {
        let (axis, signs) = (number / 4, number % 4);
        let (next, after) = ((axis + 1) % 3, (axis + 2) % 3);
        let low = ((signs & 1) << next) | ((signs >> 1) << after);
        let faces = [2 * next + 1 - (signs & 1), 2 * after + 1 - (signs >> 1)];
        // The normals of the two faces turn about the edge in its direction.
        let is_even = (signs & 1) == (signs >> 1);
        edges[number as usize] = PolytopeEdge {
            vertices: [low, low | (1 << axis)],
            faces: if is_even { faces } else { [faces[1], faces[0]] },
        };
        number += 1;
    }
    edges
};

/// The vertices around the faces of a box by their numbers; see [`Cuboid`].
const BOX_RINGS: [[u32; 4]; 6] = {
    let mut rings = [[0; 4]; 6];
    let mut face = 0_u32;
    while face < 6 {
        let (axis, is_negative) = (face / 2, face % 2 == 1);
        let (next, after) = (1 << ((axis + 1) % 3), 1 << ((axis + 2) % 3));
        let base = if is_negative { 0 } else { 1 << axis };
        let ring = [base, base | next, base | next | after, base | after];
        rings[face as usize] =
            if is_negative { [ring[3], ring[2], ring[1], ring[0]] } else { ring };
        face += 1;
    }
    rings
};

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::cross;

    #[test]
    fn features_of_a_box_fit_together() {
        let features = BoxFeatures::new(&Cuboid::new(Vector::<f64, 3>::new(1.0, 2.0, 3.0)));
        let solid = features.polyhedral();
        let at = |vertex: u32| {
            Vector::<f64, 3>::from(from_fn(|axis| solid.blocks[0][axis][vertex as usize]))
        };
        for edge in solid.edges {
            let [a, b] = edge.vertices.map(at);
            let [m, n] = edge.faces.map(|face| solid.normal(face as usize));
            assert!(cross(&m, &n).dot(&(b - a)) > 0.0, "{edge:?} lies between its faces");
            for face in edge.faces.map(|face| face as usize) {
                let height = |v: Vector<f64, 3>| solid.normal(face).dot(&v) - solid.offset(face);
                assert_eq!((height(a), height(b)), (0.0, 0.0), "{edge:?} lies on face {face}");
            }
        }
        for face in 0..solid.faces() {
            let ring: Vec<_> = solid.ring(face).iter().map(|&vertex| at(vertex)).collect();
            let turn = cross(&(ring[1] - ring[0]), &(ring[2] - ring[1]));
            assert!(turn.dot(&solid.normal(face)) > 0.0, "face {face} runs counter-clockwise");
            let height = |v: &Vector<f64, 3>| solid.normal(face).dot(v) - solid.offset(face);
            assert!(ring.iter().all(|v| height(v) == 0.0), "the corners of face {face} lie on it");
        }
    }
}
