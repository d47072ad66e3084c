//! Construction of meshes, from triangles or from other meshes.

use std::sync::OnceLock;

use super::MeshByDimension;
use super::bends::Bends;
use super::topology::Topology;
use super::{TriMesh, entries};
use crate::bounding_volume::Aabb;
use crate::math::{Mapped, Point, Real, Space, Vector};
use crate::partitioning::BoxTree;
use crate::shape::Revision;
use crate::shape::composite::joints::Joints;
use crate::shape::composite::mesh_error::{
    MeshError, check_moved, check_parts, check_scale, check_vertices, or_panic,
};
use crate::shape::composite::polyline::refused;

impl<N: Space<D>, const D: usize> TriMesh<N, D> {
    /// Returns the mesh of triangles, each given by the indices of its three vertices.
    ///
    /// # Panics
    /// If [`Self::try_new`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn new(vertices: Vec<Point<N, D>>, triangles: Vec<[u32; 3]>) -> Self {
        or_panic(Self::try_new(vertices, triangles))
    }

    /// Returns the mesh of triangles, each given by the indices of its three vertices. Vertices may
    /// coincide or belong to no triangle, and triangles may have no area.
    ///
    /// # Errors
    /// If a coordinate is not finite, a triangle refers to a vertex that does not exist, there are
    /// no triangles, or the corners do not fit 32-bit indices.
    pub fn try_new(
        vertices: Vec<Point<N, D>>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, MeshError> {
        entries::build_mesh(vertices, triangles, 0)
    }

    /// Returns the mesh with its ghosts replaced by `ghosts`; see [`Self::try_with_ghosts`].
    ///
    /// # Panics
    /// If [`Self::try_with_ghosts`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn with_ghosts(self, ghosts: &[[u32; 3]]) -> Self {
        or_panic(self.try_with_ghosts(ghosts))
    }

    /// Returns the mesh with its ghosts replaced by `ghosts`: triangles of the surface around the
    /// mesh. A ghost is not a part and no query finds it, but the surface continues across the
    /// seams beside it. So solids do not catch on the seam between two tiles of a terrain, if each
    /// tile has the other's border triangles as ghosts.
    ///
    /// Ghosts refer to the vertices of the mesh, and must be wound like its triangles. Pass all
    /// neighbours that share a corner with the border, not only those that share a side. Ghosts do
    /// not close a mesh: [`Self::neighbor`] returns a border for a side next to a ghost.
    ///
    /// The cost equals the cost of building the mesh.
    ///
    /// # Errors
    /// If a ghost refers to a vertex that does not exist, or the corners do not fit 32-bit indices.
    /// In the error, the part index of a ghost counts from the number of triangles.
    ///
    /// ```
    /// use impinge::dim3::math::Point;
    /// use impinge::dim3::shape::{EdgeNeighbor, TriMesh};
    ///
    /// // A triangle, and as a ghost the neighbouring tile's triangle across its side 1.
    /// let corners = [[0.0_f32, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]];
    /// let vertices = corners.map(|[x, z]| Point::new(x, 0.0, z)).to_vec();
    /// let tile = TriMesh::new(vertices, vec![[0, 1, 2]]).with_ghosts(&[[2, 1, 3]]);
    /// assert_eq!((tile.num_triangles(), tile.ghosts()), (1, &[[2, 1, 3]][..]));
    /// assert_eq!(tile.neighbor(0, 1), EdgeNeighbor::Border);
    /// ```
    pub fn try_with_ghosts(self, ghosts: &[[u32; 3]]) -> Result<Self, MeshError> {
        let triangles = [self.triangles(), ghosts].concat();
        let joints = self.topology.joints.of_vertices_in_order();
        self.with(self.vertices.clone(), triangles, ghosts.len(), joints)
    }

    /// Implements [`Self::try_new`]; the last `ghosts` triangles are ghosts.
    pub(super) fn build(
        vertices: Vec<Point<N, D>>,
        triangles: Vec<[u32; 3]>,
        ghosts: usize,
    ) -> Result<Self, MeshError> {
        let own = &triangles[..triangles.len() - ghosts];
        check_vertices(&vertices)?;
        check_parts(own, vertices.len())?;
        check_parts(&triangles, vertices.len())?;
        let mut topology = Topology::new(&vertices, &triangles);
        if ghosts > 0 {
            topology.is_cycle = Topology::new(&vertices, own).is_cycle;
        }
        let boxes = boxes_of(&vertices, own);
        let mut tree = BoxTree::try_from_vec(boxes).map_err(refused)?;
        let normals = normals_of(&vertices, &triangles);
        tree.add_slabs(&normals, |index| corners_of(&vertices, &triangles[index as usize]));
        Ok(Self {
            is_cycle: topology.is_cycle,
            bends: Bends::new(triangles.len()),
            packed: <N::Algorithms>::mesh_packed(&tree, &vertices, &triangles),
            vertices,
            triangles,
            ghosts,
            topology,
            normals,
            tree,
            is_one_sided: false,
            is_solid: false,
            keeps_internal_edges: false,
            pieces: OnceLock::new(),
            revision: Revision::new(),
        })
    }

    /// Merges vertices that were at the same position when the mesh was built and still are: only
    /// the first of them is kept, and the triangles refer to it. Results of queries do not change.
    #[must_use]
    pub fn with_vertices_merged(self) -> Self {
        let (mut number, mut kept) = (Vec::with_capacity(self.vertices.len()), Vec::new());
        let (mut next, mut joints) = (0.., Vec::new());
        for (vertex, point) in (0..).zip(&self.vertices) {
            let first = self.topology.joints.of(vertex);
            if first == vertex || self.vertices[first as usize] != *point {
                number.extend(next.next());
                kept.push(*point);
                joints.push(number[first as usize]);
            } else {
                number.push(number[first as usize]);
            }
        }
        let renumbered = |vertex: u32| number[vertex as usize];
        let triangles = self.triangles.iter().map(|corners| corners.map(renumbered)).collect();
        or_panic(self.with(kept, triangles, self.ghosts, &joints))
    }

    /// Reverses the front of each triangle: exchanges the second and third corner, and with them
    /// the first and last side. A solid mesh becomes a surface without an inside.
    #[must_use]
    pub fn flipped(self) -> Self {
        let triangles = self.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        let (vertices, joints) =
            (self.vertices.clone(), self.topology.joints.of_vertices_in_order());
        let made = or_panic(self.with(vertices, triangles, self.ghosts, joints));
        Self { is_solid: false, ..made }
    }

    /// Returns the mesh scaled along the axes of its frame, about its origin. A mirroring scale
    /// also reverses the winding of the triangles, as [`Self::flipped`] does, so that fronts stay
    /// fronts.
    ///
    /// # Errors
    /// If a factor of the scale is zero or not finite, or a coordinate becomes infinite.
    pub fn try_scaled(&self, scale: &Vector<N, D>) -> Result<Self, MeshError> {
        check_scale(scale)?;
        let scaled = |point: &Point<N, D>| Point::from(point.coords.component_mul(scale));
        let vertices = self.vertices.iter().map(scaled).collect();
        let is_mirrored = scale.iter().filter(|&&x| x < N::ZERO).count() % 2 == 1;
        let reversed = |&[a, b, c]: &[u32; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
        let triangles = self.triangles.iter().map(reversed).collect();
        self.with(vertices, triangles, self.ghosts, self.topology.joints.of_vertices_in_order())
    }

    /// Returns a mesh of the given vertices and triangles, of which the last `ghosts` are ghosts,
    /// with the options of this mesh. If vertices of this mesh were moved, `joints` has the joint
    /// of each vertex of the result.
    fn with(
        &self,
        vertices: Vec<Point<N, D>>,
        triangles: Vec<[u32; 3]>,
        ghosts: usize,
        joints: &[u32],
    ) -> Result<Self, MeshError> {
        let mut made = entries::build_mesh(vertices, triangles, ghosts)?;
        if self.topology.is_moved {
            made.move_joints(joints);
        }
        let Self { is_one_sided, is_solid, keeps_internal_edges, .. } = *self;
        Ok(Self { is_one_sided, is_solid, keeps_internal_edges, ..made })
    }

    /// Replaces the joints by those of a mesh whose vertices were moved after construction, so that
    /// positions no longer determine them. `of_vertex` is the joint of each vertex.
    pub(super) fn move_joints(&mut self, of_vertex: &[u32]) {
        let topology = |triangles: &[[u32; 3]]| {
            Topology::of_joints(Joints::of_vertices(of_vertex.to_vec(), triangles), triangles)
        };
        let is_cycle = topology(self.triangles()).is_cycle;
        self.topology = topology(&self.triangles);
        (self.topology.is_cycle, self.topology.is_moved) = (is_cycle, true);
        let is_whole = self.topology.joints.are_together(&self.vertices, self.triangles());
        self.is_cycle = is_cycle && is_whole;
    }

    /// Moves the vertices; see [`Self::try_set_vertices`].
    ///
    /// # Panics
    /// If [`Self::try_set_vertices`] returns an error.
    #[track_caller]
    pub fn set_vertices(&mut self, vertices: &[Point<N, D>]) {
        or_panic(self.try_set_vertices(vertices));
    }

    /// Moves all vertices of a deforming mesh; `vertices` has the order of [`Self::vertices`].
    ///
    /// Triangles that were joined stay joined, even if their corners are now apart, also in meshes
    /// that are made from this one. The tree is refitted, not rebuilt: O(n), a fifth to a tenth of
    /// the cost of building the mesh. A degraded tree order is renewed over several calls. On an
    /// error the mesh is unchanged.
    ///
    /// # Errors
    /// If a coordinate is not finite or the number of vertices differs.
    pub fn try_set_vertices(&mut self, vertices: &[Point<N, D>]) -> Result<(), MeshError> {
        entries::move_vertices(self, vertices)
    }

    /// Implements [`Self::try_set_vertices`].
    pub(super) fn move_vertices(&mut self, vertices: &[Point<N, D>]) -> Result<(), MeshError> {
        check_moved(vertices, self.vertices.len())?;
        let boxes = boxes_of(vertices, self.triangles());
        self.tree.try_refit(&boxes).map_err(refused)?;
        self.vertices.copy_from_slice(vertices);
        self.normals = normals_of(vertices, &self.triangles);
        let corners = |index: u32| corners_of(vertices, &self.triangles[index as usize]);
        self.tree.add_slabs(&self.normals, corners);
        self.bends.clear();
        self.pieces = OnceLock::new();
        self.revision = Revision::new();
        self.topology.is_moved = true;
        self.packed = <N::Algorithms>::mesh_packed(&self.tree, vertices, &self.triangles);
        let is_whole = self.topology.joints.are_together(vertices, self.triangles());
        self.is_cycle = self.topology.is_cycle && is_whole;
        Ok(())
    }
}

fn boxes_of<N: Space<D>, const D: usize>(
    vertices: &[Point<N, D>],
    triangles: &[[u32; 3]],
) -> Vec<Aabb<N, D>> {
    triangles.iter().map(|triangle| box_of_corners(&corners_of(vertices, triangle))).collect()
}

fn corners_of<N: Real, const D: usize>(
    vertices: &[Point<N, D>],
    triangle: &[u32; 3],
) -> [Point<N, D>; 3] {
    triangle.mapped(|vertex| vertices[vertex as usize])
}

/// Returns the box of a triangle, as stored in the tree; all of space if a coordinate is NaN.
pub(crate) fn box_of_corners<N: Real, const D: usize>(corners: &[Point<N, D>; 3]) -> Aabb<N, D> {
    Aabb::from_points(corners).unwrap_or_else(Aabb::unbounded)
}

/// Returns the unit normals of all triangles, zero for a triangle without area. Empty in 2D.
fn normals_of<N: Space<D>, const D: usize>(
    vertices: &[Point<N, D>],
    triangles: &[[u32; 3]],
) -> Vec<Vector<N, D>> {
    let normal = |triangle| <N::Algorithms>::mesh_normal(&corners_of(vertices, triangle));
    triangles.iter().map_while(normal).collect()
}
