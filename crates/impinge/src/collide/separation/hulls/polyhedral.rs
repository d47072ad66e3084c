//! Hulls, boxes and triangles as one type of convex polyhedron: vertices and face planes in lanes,
//! edges, and rings of faces.
//!
//! ```text
//!   triangle: prism of height 0        faces 0 front, 1 back, 2..5 the sides 01, 12, 20
//!                                      edges 0..3 front, 3..6 back: two along each side
//!         2                            rings 012, 021, and 10, 21, 02 for the sides
//!        / \
//!       0---1     box: vertices, faces and edges numbered as in `Cuboid`
//! ```

use super::edges::MAX_EDGES;
use super::vertices::Vertices;
use super::{BLOCKS, LANES, PLANE_BLOCKS, rounding_error};
use crate::math::{Mapped, Real, Vector, cross, filled, max, max_component, min};
use crate::shape::{Cuboid, Kind, Planes, Polytope, PolytopeEdge, SupportMap, Triangle};

/// A convex polyhedron in its own frame and in units of the shape.
pub(in crate::collide::separation) struct Polyhedral<'a, N: Real> {
    /// Vertices in blocks of 8; copies of the last vertex fill the last block.
    pub(in crate::collide::separation) blocks: &'a [[[N; LANES]; 3]],
    /// Number of vertices.
    pub(in crate::collide::separation) vertices: usize,
    /// Planes of the faces in blocks of 8; copies of the last plane fill the last block.
    pub(in crate::collide::separation) planes: &'a [Planes<N, 3>],
    pub(in crate::collide::separation) edges: &'a [PolytopeEdge],
    rings: Rings<'a, N>,
    /// Upper bound of the distance of the vertices from the origin ([`SupportMap::reach`]).
    pub(in crate::collide::separation) reach: N,
    /// Smallest half extent of a box, or height of a triangle above its longest side; infinite for
    /// hulls.
    thickness: N,
}

/// Vertices around each face.
enum Rings<'a, N: Real> {
    Polytope(&'a Polytope<N, 3>),
    Fixed(&'static [&'static [u32]]),
}

impl<'a, N: Real> Polyhedral<'a, N> {
    /// Makes the polyhedron of a hull, or of another solid from its `features`. `None` for a hull
    /// with more features than the lanes hold, and for another solid if `features` is `None`.
    pub(in crate::collide::separation) fn of(
        kind: Kind<'a, N, 3>,
        features: Option<&'a LocalFeatures<N>>,
    ) -> Option<Self> {
        match kind {
            Kind::Polytope(polytope) => Self::of_polytope(polytope),
            _ => features.map(LocalFeatures::polyhedral),
        }
    }

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
            rings: Rings::Polytope(polytope),
            reach: polytope.reach(),
            thickness: N::INFINITY,
        })
    }

    /// Returns whether the solid is thicker than the rounding error of a pair with a solid of
    /// bounding radius `reach`. In a thinner solid, some face has a side so short that its
    /// direction is rounding error.
    pub(super) fn has_width(&self, reach: N) -> bool {
        self.thickness > rounding_error::<N>() * (self.reach + reach)
    }

    /// Returns the number of faces.
    pub(in crate::collide::separation) fn faces(&self) -> usize {
        match self.rings {
            Rings::Polytope(polytope) => polytope.faces().len(),
            Rings::Fixed(rings) => rings.len(),
        }
    }

    /// Returns the indices of the vertices around a face, counter-clockwise seen from outside.
    pub(in crate::collide::separation) fn ring(&self, face: usize) -> &[u32] {
        match self.rings {
            Rings::Polytope(polytope) => polytope.face_vertices(&polytope.faces()[face]),
            Rings::Fixed(rings) => rings[face],
        }
    }

    /// Returns the ends of an edge, taken from `vertices`, which may be in another frame.
    #[inline(always)]
    pub(super) fn ends(&self, vertices: &Vertices<N>, edge: usize) -> [Vector<N, 3>; 2] {
        let [from, to] = self.edges[edge].vertices;
        [vertices.at(from as usize), vertices.at(to as usize)]
    }

    /// Returns a vertex, in the solid's own frame and in units of the shape.
    #[inline(always)]
    pub(in crate::collide::separation) fn vertex(&self, vertex: usize) -> Vector<N, 3> {
        let [x, y, z] = &self.blocks[vertex / LANES];
        let lane = vertex % LANES;
        Vector::<N, 3>::new(x[lane], y[lane], z[lane])
    }

    /// Returns the outward unit normal of a face.
    #[inline(always)]
    pub(in crate::collide::separation) fn normal(&self, face: usize) -> Vector<N, 3> {
        let [x, y, z] = &self.planes[face / LANES].normals;
        let lane = face % LANES;
        Vector::<N, 3>::new(x[lane], y[lane], z[lane])
    }

    /// Returns the offset of a face's plane from the origin along its normal.
    #[inline(always)]
    pub(in crate::collide::separation) fn offset(&self, face: usize) -> N {
        self.planes[face / LANES].offsets[face % LANES]
    }
}

/// Vertices and face planes in lanes for boxes and triangles, which do not store them.
pub(in crate::collide::separation) struct LocalFeatures<N: Real> {
    blocks: [[[N; LANES]; 3]; 1],
    planes: [Planes<N, 3>; 1],
    vertices: usize,
    edges: &'static [PolytopeEdge],
    rings: &'static [&'static [u32]],
    reach: N,
    thickness: N,
}

impl<N: Real> LocalFeatures<N> {
    /// Computes the features of a box or triangle; `None` for other solids and thin triangles.
    pub(in crate::collide::separation) fn of(kind: Kind<'_, N, 3>) -> Option<Self> {
        match kind {
            Kind::Cuboid(cuboid) => Some(Self::of_cuboid(cuboid)),
            Kind::Triangle(triangle) => Self::of_triangle(triangle),
            _ => None,
        }
    }

    fn of_cuboid(cuboid: &Cuboid<N, 3>) -> Self {
        let half = cuboid.half_extents();
        let signed = |axis: usize, bit: usize| if bit == 0 { -half[axis] } else { half[axis] };
        let vertices = filled(|axis| filled(|vertex| signed(axis, vertex >> axis & 1)));
        // Face 2 · axis is on the positive side of the axis, the next on the negative; spare lanes
        // repeat the last face.
        let face = |lane: usize| if lane < 6 { lane } else { 5 };
        let along = |axis: usize, lane: usize| match face(lane) {
            face if face / 2 != axis => N::ZERO,
            face if face % 2 == 0 => N::ONE,
            _ => -N::ONE,
        };
        let planes = Planes {
            normals: filled(|axis| filled(|lane| along(axis, lane))),
            offsets: filled(|lane| half[face(lane) / 2]),
        };
        Self {
            blocks: [vertices],
            planes: [planes],
            vertices: 8,
            edges: &BOX_EDGES,
            rings: &BOX_RINGS,
            reach: cuboid.reach(),
            thickness: min(min(half[0], half[1]), half[2]),
        }
    }

    /// Computes the features of a prism without height: front and back are the triangle, the other
    /// faces its sides, and two edges lie along each side. `None` for a thin triangle, whose normal
    /// would be off by more than rounding.
    fn of_triangle(triangle: &Triangle<N, 3>) -> Option<Self> {
        let [a, b, c] = triangle.corners();
        let sides = [b - a, c - b, a - c];
        // Scaled to length about 1, so that squares neither overflow nor underflow.
        let scale = max(max_component(&sides[0]), max_component(&sides[1])).power_of_two_below();
        let sides = sides.mapped(|side| side / scale);
        let squared = sides.mapped(|side| side.norm_squared());
        let longest = max(max(squared[0], squared[1]), squared[2]);
        let across = cross(&sides[0], &sides[1]);
        let area = across.norm();
        // False for NaN, which counts as thin.
        let is_wide = area > N::lit(THIN) * longest;
        if !is_wide {
            return None;
        }
        let front = across / area;
        let outward: [_; 3] = filled(|side| cross(&sides[side], &front) / squared[side].sqrt());
        let faces = [front, -front, outward[0], outward[1], outward[2]];
        // Spare lanes repeat the last face.
        let face = |lane: usize| if lane < 4 { lane } else { 4 };
        let corner = |lane: usize| &triangle.corners()[if lane < 2 { lane } else { 2 }];
        // The plane of a side contains the corner at which the side begins.
        let on = [a, a, a, b, c];
        let planes = Planes {
            normals: filled(|axis| filled(|lane| faces[face(lane)][axis])),
            offsets: filled(|lane| faces[face(lane)].dot(&on[face(lane)].coords)),
        };
        Some(Self {
            blocks: [filled(|axis| filled(|lane| corner(lane)[axis]))],
            planes: [planes],
            vertices: 3,
            edges: &TRIANGLE_EDGES,
            rings: &TRIANGLE_RINGS,
            reach: triangle.reach(),
            thickness: scale * area / longest.sqrt(),
        })
    }

    fn polyhedral(&self) -> Polyhedral<'_, N> {
        Polyhedral {
            blocks: &self.blocks,
            vertices: self.vertices,
            planes: &self.planes,
            edges: self.edges,
            rings: Rings::Fixed(self.rings),
            reach: self.reach,
            thickness: self.thickness,
        }
    }
}

/// A triangle is thin if its height above its longest side, divided by the length of that side, is
/// at most this.
pub(in crate::collide::separation) const THIN: f64 = 1.0 / 256.0;

/// Edges of a triangle: for each side one of the front and one of the back.
const TRIANGLE_EDGES: [PolytopeEdge; 6] = [
    PolytopeEdge { vertices: [0, 1], faces: [0, 2] },
    PolytopeEdge { vertices: [1, 2], faces: [0, 3] },
    PolytopeEdge { vertices: [2, 0], faces: [0, 4] },
    PolytopeEdge { vertices: [0, 1], faces: [2, 1] },
    PolytopeEdge { vertices: [1, 2], faces: [3, 1] },
    PolytopeEdge { vertices: [2, 0], faces: [4, 1] },
];

/// Vertices around the front, the back and the sides of a triangle.
const TRIANGLE_RINGS: [&[u32]; 5] = [&[0, 1, 2], &[0, 2, 1], &[1, 0], &[2, 1], &[0, 2]];

/// Edges of a box in the numbering of [`Cuboid`].
const BOX_EDGES: [PolytopeEdge; 12] = {
    let mut edges = [PolytopeEdge { vertices: [0; 2], faces: [0; 2] }; 12];
    let mut number = 0_u32;
    while number < 12 {
        let (axis, signs) = (number / 4, number % 4);
        let (next, after) = ((axis + 1) % 3, (axis + 2) % 3);
        let low = ((signs & 1) << next) | ((signs >> 1) << after);
        let faces = [2 * next + 1 - (signs & 1), 2 * after + 1 - (signs >> 1)];
        // The faces are ordered so that the ring of the first runs in the direction of the edge.
        let is_even = (signs & 1) == (signs >> 1);
        edges[number as usize] = PolytopeEdge {
            vertices: [low, low | (1 << axis)],
            faces: if is_even { faces } else { [faces[1], faces[0]] },
        };
        number += 1;
    }
    edges
};

/// Vertices around the faces of a box in the numbering of [`Cuboid`].
const BOX_RINGS: [&[u32]; 6] =
    [&[1, 3, 7, 5], &[4, 6, 2, 0], &[2, 6, 7, 3], &[1, 5, 4, 0], &[4, 5, 7, 6], &[2, 3, 1, 0]];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Point;

    /// Asserts that the ends of each edge and the vertices of each ring lie on their faces, that
    /// each edge runs in the direction of the cross product of the normals of its faces, and that
    /// rings with an area are counter-clockwise.
    fn check(solid: &Polyhedral<'_, f64>) {
        let is_zero = |height: &f64| height.abs() < 1e-14;
        let at = |vertex: u32| {
            Vector::<f64, 3>::from(filled(|axis| solid.blocks[0][axis][vertex as usize]))
        };
        for edge in solid.edges {
            let [a, b] = edge.vertices.mapped(at);
            let [m, n] = edge.faces.mapped(|face| solid.normal(face as usize));
            assert!(cross(&m, &n).dot(&(b - a)) > 0.0, "{edge:?} lies between its faces");
            for face in edge.faces.mapped(|face| face as usize) {
                let height = |v: Vector<f64, 3>| solid.normal(face).dot(&v) - solid.offset(face);
                assert!([a, b].mapped(height).iter().all(is_zero), "{edge:?} lies on face {face}");
            }
        }
        for face in 0..solid.faces() {
            let ring: Vec<_> = solid.ring(face).iter().map(|&vertex| at(vertex)).collect();
            if let [a, b, c, ..] = ring[..] {
                let turn = cross(&(b - a), &(c - b));
                assert!(turn.dot(&solid.normal(face)) > 0.0, "face {face} runs counter-clockwise");
            }
            let height = |v: &Vector<f64, 3>| solid.normal(face).dot(v) - solid.offset(face);
            let heights: Vec<_> = ring.iter().map(height).collect();
            assert!(heights.iter().all(is_zero), "the corners of face {face} lie on it");
        }
    }

    #[test]
    fn features_of_a_box_fit_together() {
        let cuboid = Cuboid::new(Vector::<f64, 3>::new(1.0, 2.0, 3.0));
        check(&LocalFeatures::of_cuboid(&cuboid).polyhedral());
    }

    #[test]
    fn features_of_a_triangle_fit_together() {
        let [a, b, c] = [[0.0, 0.0, 1.0], [3.0, 0.0, 1.0], [0.0, 4.0, 1.0]].mapped(Point::from);
        let features = LocalFeatures::of_triangle(&Triangle::new(a, b, c)).expect("wide");
        check(&features.polyhedral());
        let thin = Triangle::new(a, b, b + (c - a) * 1e-4);
        assert!(LocalFeatures::of_triangle(&thin).is_none(), "its normal is not accurate");
    }
}
