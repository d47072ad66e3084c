//! Vertices, normals and edges of a flat-sided solid, in the frame of a round one.
//!
//! ```text
//!   Edge { vertices: [v, w], normals: [i, j] }     the arc from normal i to normal j, along which
//!                                                  the edge from v to w is lowest
//!   segment    4 edges v w; arcs between p, q, -p, -q, the unit vectors perpendicular to it
//!   triangle   2 edges for each side: front to side, side to back
//!   box, hull  1 for each edge, between the normals of its two faces
//! ```
//!
//! `normals` point into the solid, `own_normals` out of it.

use smallvec::SmallVec;

use crate::collide::separation::hulls::rounding_error;
use crate::math::{Mapped, Matrix, Point, Pose, Real, Vector, cross, orthonormal_basis, unit};
use crate::shape::{Cuboid, Kind, Polytope, Triangle};

/// Largest number of vertices of a hull. Larger hulls are passed to the general algorithm, which
/// does not visit all their features.
const MAX_VERTICES: usize = 128;

/// An edge: the indices of its ends, and of the ends of the arc of normals along which the edge is
/// lowest.
#[derive(Clone, Copy)]
pub(super) struct Edge {
    pub(super) vertices: [u32; 2],
    pub(super) normals: [u32; 2],
}

/// A flat-sided solid, in units of the pair.
pub(super) struct Flat<N: Real> {
    /// Vertices in the solid's own frame.
    pub(super) own_vertices: SmallVec<[Vector<N, 3>; 16]>,
    /// Vertices in the frame of the round solid.
    pub(super) vertices: SmallVec<[Vector<N, 3>; 16]>,
    /// Unit vectors out of the solid, in its own frame: the normals of all faces. If there are too
    /// few faces, further vectors are added, so that arcs between two of the vectors cover all
    /// normals of the edges.
    pub(super) own_normals: SmallVec<[Vector<N, 3>; 16]>,
    /// The negated `own_normals` in the frame of the round solid, each with the index of a vertex
    /// that is lowest along it.
    pub(super) normals: SmallVec<[(Vector<N, 3>, u32); 16]>,
    pub(super) edges: SmallVec<[Edge; 32]>,
}

impl<N: Real> Flat<N> {
    /// Extracts the features of a solid; `pose12` is the pose of the round solid in the frame of
    /// this one. `None` for other kinds, for segments without length and thin triangles, whose
    /// normals are unknown, and for hulls of more than [`MAX_VERTICES`] vertices.
    pub(super) fn new(kind: &Kind<'_, N, 3>, pose12: &Pose<N, 3>, shrink: N) -> Option<Self> {
        let mut flat = Self {
            own_vertices: SmallVec::new(),
            vertices: SmallVec::new(),
            own_normals: SmallVec::new(),
            normals: SmallVec::new(),
            edges: SmallVec::new(),
        };
        match kind {
            Kind::Segment(segment) => flat.fill_segment([segment.a(), segment.b()], shrink)?,
            Kind::Capsule(capsule) => {
                let segment = capsule.segment();
                flat.fill_segment([segment.a(), segment.b()], shrink)?;
            }
            Kind::Triangle(triangle) => flat.fill_triangle(triangle, shrink)?,
            Kind::Cuboid(cuboid) => flat.fill_box(cuboid, shrink),
            Kind::Polytope(polytope) => flat.fill_polytope(polytope, shrink)?,
            _ => return None,
        }
        flat.transform(&pose12.rotation.transpose(), &(pose12.translation * shrink));
        Some(flat)
    }

    /// Returns the index of the vertex that is lowest along a direction; the first vertex wins a
    /// tie.
    pub(super) fn lowest(&self, direction: &Vector<N, 3>) -> usize {
        let (mut lowest, mut low) = (0, N::INFINITY);
        for (index, vertex) in self.vertices.iter().enumerate() {
            let height = direction.dot(vertex);
            if height < low {
                (lowest, low) = (index, height);
            }
        }
        lowest
    }

    /// Transforms vertices and normals to the frame of the round solid; normals are negated.
    fn transform(&mut self, turn: &Matrix<N, 3>, translation: &Vector<N, 3>) {
        for vertex in &self.own_vertices {
            self.vertices.push(turn * (vertex - translation));
        }
        for (normal, outward) in self.normals.iter_mut().zip(&self.own_normals) {
            normal.0 = -(turn * outward);
        }
    }

    /// Adds a unit vector out of the solid, with the index of a vertex that is farthest along it.
    fn push_normal(&mut self, outward: Vector<N, 3>, vertex: u32) {
        self.own_normals.push(outward);
        self.normals.push((outward, vertex));
    }

    fn push_edge(&mut self, vertices: [u32; 2], normals: [u32; 2]) {
        self.edges.push(Edge { vertices, normals });
    }

    /// Extracts a segment: four normals perpendicular to it, and four arcs between them. `None` if
    /// it has no length.
    fn fill_segment(&mut self, ends: [&Point<N, 3>; 2], shrink: N) -> Option<()> {
        self.own_vertices.extend(ends.mapped(|end| end.coords * shrink));
        let along = self.own_vertices[1] - self.own_vertices[0];
        let (along, _) = unit(&along).filter(|(_, length)| *length > rounding_error())?;
        let (u, v) = orthonormal_basis(&along);
        [u, v, -u, -v].into_iter().for_each(|normal| self.push_normal(normal, 0));
        [[0, 1], [1, 2], [2, 3], [3, 0]].into_iter().for_each(|arc| self.push_edge([0, 1], arc));
        Some(())
    }

    /// Extracts a triangle: both of its normals, and the normals of its side planes. `None` if it
    /// is thin.
    fn fill_triangle(&mut self, triangle: &Triangle<N, 3>, shrink: N) -> Option<()> {
        let corners = triangle.corners().mapped(|corner| corner.coords * shrink);
        self.own_vertices.extend(corners);
        let (e, f) = (corners[1] - corners[0], corners[2] - corners[0]);
        let longest = (corners[2] - corners[1]).norm() + e.norm() + f.norm();
        let thick = |&(_, area): &(Vector<N, 3>, N)| area > N::EPSILON.sqrt() * longest * longest;
        let (normal, _) = unit(&cross(&e, &f)).filter(thick)?;
        self.push_normal(normal, 0);
        self.push_normal(-normal, 0);
        for (number, [from, to]) in (2..).zip([[0_u32, 1], [1, 2], [2, 0]]) {
            let side = corners[to as usize] - corners[from as usize];
            self.push_normal(unit(&cross(&side, &normal))?.0, from);
            self.push_edge([from, to], [0, number]);
            self.push_edge([from, to], [number, 1]);
        }
        Some(())
    }

    /// Extracts a box. Extents may be zero: an edge without length then has normals of its vertex,
    /// which are valid directions too.
    fn fill_box(&mut self, cuboid: &Cuboid<N, 3>, shrink: N) {
        let half = cuboid.half_extents() * shrink;
        for signs in 0..8_usize {
            let at = |axis: usize| if signs >> axis & 1 == 1 { half[axis] } else { -half[axis] };
            self.own_vertices.push(Vector::<N, 3>::new(at(0), at(1), at(2)));
        }
        for axis in 0..3 {
            let mut normal = Vector::<N, 3>::zeros();
            normal[axis] = N::ONE;
            self.push_normal(-normal, 0);
            self.push_normal(normal, 7);
        }
        for axis in 0..3_u32 {
            let (next, after) = ((axis + 1) % 3, (axis + 2) % 3);
            for (side1, side2) in [(0, 0), (0, 1), (1, 0), (1, 1)] {
                let low = (side1 << next) | (side2 << after);
                self.push_edge([low, low | (1 << axis)], [2 * next + side1, 2 * after + side2]);
            }
        }
    }

    /// Extracts a hull with all its faces and edges. `None` above [`MAX_VERTICES`] vertices.
    fn fill_polytope(&mut self, polytope: &Polytope<N, 3>, shrink: N) -> Option<()> {
        if polytope.vertices().len() > MAX_VERTICES {
            return None;
        }
        self.own_vertices.extend(polytope.vertices().iter().map(|vertex| vertex.coords * shrink));
        for face in polytope.faces() {
            self.push_normal(face.normal, polytope.face_vertices(face)[0]);
        }
        for edge in polytope.edges() {
            self.push_edge(edge.vertices, edge.faces);
        }
        Some(())
    }
}
