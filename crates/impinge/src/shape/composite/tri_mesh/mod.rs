//! Meshes of triangles: filled in 2D, surfaces in 3D.

mod around;
mod bends;
mod build;
mod by_dimension;
mod composite;
mod entries;
mod rays;
#[cfg(feature = "serde")]
mod saved;
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
/// Parts are the triangles, in the order given, with the vertices and sides of [`Triangle`]; all
/// coordinates are in the frame of the mesh. Triangles join where the positions of their corners
/// are equal, regardless of vertex indices, so a mesh with duplicated vertices is as smooth as one
/// with shared vertices. A corner in the middle of a side of another triangle does not join.
///
/// **Sides.** In 3D the front of a triangle is the side from which its corners run
/// counter-clockwise. Contacts arise on both sides, or only on the front after `one_sided`, so that
/// a solid inside a closed mesh is not pushed deeper. For most queries a mesh is a surface without
/// an inside, unless `solid` makes the enclosed volume part of the shape. `encloses` and
/// `signed_distance` test points against the volume that a closed surface encloses. In 2D triangles
/// are filled, and their winding is irrelevant.
///
/// **Seams.** Contacts treat the mesh as one surface (see [`Surface`](crate::shape::Surface)): at
/// an edge or corner only normals of the whole surface are admitted, so that solids do not catch on
/// the edges of a floor. Faces whose normals differ by less than 0.57 degrees (a sine of 0.01)
/// count as coplanar. [`Self::with_internal_edges_kept`] disables this.
///
/// **Degenerate triangles.** A triangle with repeated or collinear corners is kept, so that part
/// indices do not change: it acts as a segment or a point.
///
/// Construction costs O(n log n), a search O(log n + results). A triangle with its share of
/// vertices takes about 209 bytes in `f32`. Of these, 36 are a copy of its corners for rays, stored
/// in the order of the tree.
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
    /// The triangles, followed by the ghosts. Ghosts have entries in the topology and the normals,
    /// but are not parts.
    triangles: Vec<[u32; 3]>,
    /// The number of ghosts; they are the last elements of `triangles`.
    ghosts: usize,
    topology: Topology,
    /// The unit normal on the front of each triangle; zero for a triangle without area. Empty in
    /// 2D.
    normals: Vec<Vector<N, D>>,
    bends: Bends,
    tree: BoxTree<N, D>,
    /// The corners of the triangles in blocks for ray tests, in the order of the tree's leaves.
    /// Empty in 2D.
    packed: Vec<Triangles>,
    /// Whether each side is traversed equally often in both directions, and joined corners still
    /// coincide.
    is_cycle: bool,
    is_one_sided: bool,
    /// Whether `solid` was called; has an effect only while [`Self::is_cycle`] is true.
    is_solid: bool,
    keeps_internal_edges: bool,
    /// For each triangle, the first triangle of its connected piece; computed on first use.
    pieces: OnceLock<Vec<u32>>,
    revision: Revision,
}

impl<N: Real, const D: usize> TriMesh<N, D> {
    /// Returns the vertices, as given; some may belong to no triangle.
    #[must_use]
    pub fn vertices(&self) -> &[Point<N, D>] {
        &self.vertices
    }

    /// Returns the vertex indices of each triangle, without the ghosts.
    #[must_use]
    pub fn triangles(&self) -> &[[u32; 3]] {
        &self.triangles[..self.num_triangles()]
    }

    /// Returns the vertex indices of each ghost; see [`Self::try_with_ghosts`].
    #[must_use]
    pub fn ghosts(&self) -> &[[u32; 3]] {
        &self.triangles[self.num_triangles()..]
    }

    /// Returns the number of triangles, without the ghosts.
    #[must_use]
    pub const fn num_triangles(&self) -> usize {
        self.triangles.len() - self.ghosts
    }

    /// Returns the triangle with the index `index`; ghosts follow the triangles.
    ///
    /// # Panics
    /// If `index` is not below the total number of triangles and ghosts.
    #[must_use]
    pub fn triangle(&self, index: u32) -> Triangle<N, D> {
        Triangle::of_finite(self.corners(index))
    }

    /// Returns the neighbour across the side `side`, 0 to 2, of a triangle. Ghosts are not
    /// neighbours. O(1).
    ///
    /// # Panics
    /// If there is no such triangle or side.
    #[must_use]
    pub fn neighbor(&self, triangle: u32, side: u32) -> EdgeNeighbor {
        self.across(triangle, side as usize)
    }

    /// Implements [`Self::neighbor`]. The neighbour is flipped if both triangles traverse the side
    /// in the same direction.
    fn across(&self, triangle: u32, side: usize) -> EdgeNeighbor {
        let ends = self.joint_ends(triangle, side);
        let mut found = EdgeNeighbor::Border;
        self.each_across(triangle, side, |index, entered| {
            let is_flipped = self.joint_ends(index, entered) == ends;
            found = match found {
                _ if index as usize >= self.num_triangles() => found,
                EdgeNeighbor::Border => EdgeNeighbor::Triangle { index, is_flipped },
                _ => EdgeNeighbor::Several,
            };
        });
        found
    }

    /// Returns whether every side with a length has a neighbour: in 3D the surface then has no
    /// border. O(n).
    #[must_use]
    pub fn is_closed(&self) -> bool {
        self.each_side().all(|(triangle, side)| {
            let [from, to] = self.joint_ends(triangle, side);
            from == to || self.across(triangle, side) != EdgeNeighbor::Border
        })
    }

    /// Returns whether no side has more than two triangles, and the fronts of all neighbours agree.
    /// O(n).
    #[must_use]
    pub fn is_oriented(&self) -> bool {
        self.each_side().all(|(triangle, side)| match self.across(triangle, side) {
            EdgeNeighbor::Border => true,
            EdgeNeighbor::Triangle { is_flipped, .. } => !is_flipped,
            EdgeNeighbor::Several => false,
        })
    }

    /// Returns the tree over the boxes of the triangles.
    #[must_use]
    pub const fn tree(&self) -> &BoxTree<N, D> {
        &self.tree
    }

    /// Returns whether the mesh is one-sided: no contact arises from behind.
    #[must_use]
    pub const fn is_one_sided(&self) -> bool {
        self.is_one_sided
    }

    /// Returns whether contacts treat each triangle as a separate solid; see
    /// [`Self::with_internal_edges_kept`].
    #[must_use]
    pub const fn keeps_internal_edges(&self) -> bool {
        self.keeps_internal_edges
    }

    /// Makes contacts treat each triangle as a separate solid, with all its edges and corners, as
    /// if it had no neighbours.
    #[must_use]
    pub const fn with_internal_edges_kept(mut self) -> Self {
        self.keeps_internal_edges = true;
        self
    }

    pub(crate) fn corners(&self, triangle: u32) -> [Point<N, D>; 3] {
        self.triangles[triangle as usize].mapped(|vertex| self.vertices[vertex as usize])
    }

    /// Returns the joints at the two ends of a side, in the order of the triangle's corners.
    fn joint_ends(&self, triangle: u32, side: usize) -> [u32; 2] {
        [side, (side + 1) % 3].mapped(|corner| self.joint_at(triangle, corner))
    }

    /// Returns the joint at a corner (0 to 2) of a triangle.
    fn joint_at(&self, triangle: u32, corner: usize) -> u32 {
        self.topology.joints.of(self.triangles[triangle as usize][corner])
    }

    /// Returns the index of the side of a triangle between two joints, in either direction; `None`
    /// if there is none.
    fn side_between(&self, triangle: u32, [from, to]: [u32; 2]) -> Option<usize> {
        (0..3).find(|&side| {
            let ends = self.joint_ends(triangle, side);
            ends == [from, to] || ends == [to, from]
        })
    }

    fn each_side(&self) -> impl Iterator<Item = (u32, usize)> + '_ {
        (0..).take(self.num_triangles()).flat_map(|index| (0..3).map(move |side| (index, side)))
    }
}

impl<N: Real> TriMesh<N, 3> {
    /// Returns whether the mesh bounds one or several volumes: each side with a length is traversed
    /// equally often in both directions. O(1).
    ///
    /// True for every mesh that [is closed](Self::is_closed) and [oriented](Self::is_oriented).
    /// Also true if volumes share a side, which then has four triangles, or if triangles have
    /// repeated corners. If [`Self::set_vertices`] moves joined vertices apart, the result is
    /// false. [`Self::encloses`] and [`Self::signed_distance`] test whether a point lies inside.
    #[must_use]
    pub const fn is_volume(&self) -> bool {
        self.is_cycle
    }

    /// Makes the mesh one-sided: no contact arises from behind. The front of a triangle is the side
    /// from which its corners run counter-clockwise. The fronts of neighbours should agree: see
    /// [`Self::is_oriented`].
    #[must_use]
    pub const fn one_sided(mut self) -> Self {
        self.is_one_sided = true;
        self
    }

    /// Returns the unit normal on the front of a triangle; `None` for a triangle without area.
    ///
    /// # Panics
    /// If there is no such triangle.
    #[must_use]
    pub fn normal(&self, triangle: u32) -> Option<Vector<N, 3>> {
        let normal = self.normals[triangle as usize];
        (normal != Vector::<N, 3>::zeros()).then_some(normal)
    }
}
