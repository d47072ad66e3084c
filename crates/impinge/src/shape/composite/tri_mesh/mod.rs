//! Meshes of triangles: filled in 2D, surfaces in 3D.

mod around;
mod bends;
mod build;
mod by_dimension;
mod composite;
mod entries;
mod rays;
mod solid;
mod surface2;
mod surface3;
mod topology;

pub(in crate::shape) use around::inward_of;
pub(crate) use build::box_of_corners;
pub(crate) use by_dimension::MeshByDimension;
pub(in crate::shape) use composite::{aabb_at, sphere_around};
pub(crate) use entries::MeshEntries;
pub(in crate::shape) use surface3::normal_of;
pub use topology::EdgeNeighbor;

use std::sync::OnceLock;

use self::bends::Bends;
use self::topology::Topology;
use crate::bvh::Triangles;
use crate::math::{Mapped, Point, Real, Vector};
use crate::partitioning::BoxTree;
use crate::shape::{Revision, Triangle};

/// Triangles that share corners: a filled shape in 2D, a surface in 3D, open or closed.
///
/// Parts are the triangles, in the order given, with the vertices and sides of
/// [`Triangle`]; all is in the frame of the mesh. Triangles belong together by the positions of their
/// corners, not by the indices: a mesh whose triangles each bring corners of their own is as smooth as
/// one that shares them. Corners that lie in the middle of a side of another triangle do not join.
///
/// **Sides.** In 3D the front of a triangle is the side that sees its corners counter-clockwise.
/// A mesh has two sides, or one if asked by `one_sided`: then nothing touches it from behind, and what
/// is inside a closed mesh is not pushed deeper. It is a skin, and has no inside in the queries that all
/// shapes have, unless `solid` makes a closed one a body; what a closed skin encloses say `encloses` and
/// `signed_distance`. In 2D triangles are filled, and their winding means nothing.
///
/// **Seams.** Contacts see the mesh as one surface (see [`Surface`](crate::shape::Surface)): at an edge or
/// corner only those normals count that the whole has there, so that nothing catches on the edges of
/// a floor. Faces whose normals differ by less than 0.57 degrees (a sine of 0.01) count as one flat.
/// [`Self::with_internal_edges_kept`] switches this off.
///
/// **Bad triangles.** A triangle with repeated or collinear corners is kept, so that parts keep their
/// numbers: it acts as a segment or a point.
///
/// Making a mesh costs O(n log n), a search O(log n + what it finds). A triangle with its share of
/// vertices takes about 209 bytes in `f32`: 36 of them are a copy of its corners beside those of its
/// neighbours, for rays.
///
/// ```
/// use impinge::dim3::math::Point;
/// use impinge::dim3::shape::{CompositeShape, TriMesh};
///
/// // A square floor of two triangles.
/// let corners = [[0.0_f32, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
/// let vertices = corners.map(|[x, z]| Point::new(x, 0.0, z)).to_vec();
/// let floor = TriMesh::new(vertices, vec![[0, 2, 1], [0, 3, 2]]);
/// assert_eq!(floor.num_parts(), 2);
/// assert_eq!(floor.normal(0), Some([0.0, 1.0, 0.0].into()));
/// assert!(!floor.is_closed() && floor.is_oriented());
/// ```
#[derive(Clone)]
pub struct TriMesh<N: Real, const D: usize> {
    vertices: Vec<Point<N, D>>,
    triangles: Vec<[u32; 3]>,
    topology: Topology,
    /// By triangle: unit, on the front; zero without area. None in 2D.
    normals: Vec<Vector<N, D>>,
    bends: Bends,
    tree: BoxTree<N, D>,
    /// In the order of the tree's blocks: what rays look at. None in 2D.
    packed: Vec<Triangles>,
    /// The triangles are a cycle, and corners that belong together lie together.
    is_cycle: bool,
    is_one_sided: bool,
    /// It was made one, as long as it [`Self::is_cycle`].
    is_solid: bool,
    keeps_internal_edges: bool,
    /// By triangle: the first one of its piece.
    pieces: OnceLock<Vec<u32>>,
    revision: Revision,
}

impl<N: Real, const D: usize> TriMesh<N, D> {
    /// The vertices, as given; some may belong to no triangle.
    #[must_use]
    pub fn vertices(&self) -> &[Point<N, D>] {
        &self.vertices
    }

    /// The three vertices of each triangle.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles
    }

    /// The number of triangles.
    #[must_use]
    pub const fn num_triangles(&self) -> usize {
        self.triangles.len()
    }

    /// One triangle.
    ///
    /// # Panics
    /// If there is no such triangle.
    #[must_use]
    pub fn triangle(&self, index: u32) -> Triangle<N, D> {
        Triangle::of_finite(self.corners(index))
    }

    /// What lies across a side, 0 to 2, of a triangle. Looking costs O(1).
    ///
    /// # Panics
    /// If there is no such triangle or side.
    #[must_use]
    pub fn neighbor(&self, triangle: u32, side: u32) -> EdgeNeighbor {
        self.across(triangle, side as usize)
    }

    fn across(&self, triangle: u32, side: usize) -> EdgeNeighbor {
        if self.topology.has_several_across(triangle, side) {
            return EdgeNeighbor::Several;
        }
        let Some(index) = self.topology.single_across(triangle, side) else {
            return EdgeNeighbor::Border;
        };
        let ends = self.joint_ends(triangle, side);
        let other = self.side_between(index, ends);
        let is_flipped = other.is_some_and(|other| self.joint_ends(index, other) == ends);
        EdgeNeighbor::Triangle { index, is_flipped }
    }

    /// Every side with a length has a neighbour, so that a surface in 3D has no border. O(n).
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.each_side().all(|(triangle, side)| {
            let [from, to] = self.joint_ends(triangle, side);
            from == to || !self.topology.is_border(triangle, side)
        })
    }

    /// No side has more than two triangles, and where there are two their fronts agree. O(n).
    #[must_use]
    pub fn is_oriented(&self) -> bool {
        self.each_side().all(|(triangle, side)| match self.across(triangle, side) {
            EdgeNeighbor::Border => true,
            EdgeNeighbor::Triangle { is_flipped, .. } => !is_flipped,
            EdgeNeighbor::Several => false,
        })
    }

    /// The tree over the boxes of the triangles.
    #[must_use]
    pub const fn tree(&self) -> &BoxTree<N, D> {
        &self.tree
    }

    /// Nothing touches the mesh from behind.
    #[must_use]
    pub const fn is_one_sided(&self) -> bool {
        self.is_one_sided
    }

    /// Contacts treat each triangle on its own; see [`Self::with_internal_edges_kept`].
    #[must_use]
    pub const fn keeps_internal_edges(&self) -> bool {
        self.keeps_internal_edges
    }

    /// Makes contacts treat each triangle on its own, with all its edges and corners, as if it had no
    /// neighbours.
    #[must_use]
    pub const fn with_internal_edges_kept(mut self) -> Self {
        self.keeps_internal_edges = true;
        self
    }

    pub(crate) fn corners(&self, triangle: u32) -> [Point<N, D>; 3] {
        self.triangles[triangle as usize].mapped(|vertex| self.vertices[vertex as usize])
    }

    /// The joints at the ends of a side, in the order of the triangle.
    fn joint_ends(&self, triangle: u32, side: usize) -> [u32; 2] {
        [side, (side + 1) % 3].mapped(|corner| self.joint_at(triangle, corner))
    }

    /// The joint at a corner.
    fn joint_at(&self, triangle: u32, corner: usize) -> u32 {
        self.topology.joints.of(self.triangles[triangle as usize][corner])
    }

    /// The side of a triangle between two joints.
    fn side_between(&self, triangle: u32, [from, to]: [u32; 2]) -> Option<usize> {
        (0..3).find(|&side| {
            let ends = self.joint_ends(triangle, side);
            ends == [from, to] || ends == [to, from]
        })
    }

    fn each_side(&self) -> impl Iterator<Item = (u32, usize)> + '_ {
        (0..).take(self.triangles.len()).flat_map(|index| (0..3).map(move |side| (index, side)))
    }
}

impl<N: Real> TriMesh<N, 3> {
    /// The mesh is the boundary of a volume, or of several: each side with a length is run along by as
    /// many triangles in one direction as in the other. O(1).
    ///
    /// So is every mesh that [is closed](Self::is_closed) and [oriented](Self::is_oriented); and one whose
    /// bodies share a side, which has four triangles then, or that has triangles with repeated corners.
    /// Vertices that [`Self::set_vertices`] moves apart, though they were at one position, open the mesh.
    /// What lies inside say [`Self::encloses`] and [`Self::signed_distance`].
    #[must_use]
    pub const fn is_volume(&self) -> bool {
        self.is_cycle
    }

    /// Lets nothing touch the mesh from behind; the front of a triangle is the side that sees its
    /// corners counter-clockwise. Neighbours should agree on it: see [`Self::is_oriented`].
    #[must_use]
    pub const fn one_sided(mut self) -> Self {
        self.is_one_sided = true;
        self
    }

    /// The unit normal on the front of a triangle; `None` without area.
    ///
    /// # Panics
    /// If there is no such triangle.
    #[must_use]
    pub fn normal(&self, triangle: u32) -> Option<Vector<N, 3>> {
        let normal = self.normals[triangle as usize];
        (normal != Vector::<N, 3>::zeros()).then_some(normal)
    }
}
