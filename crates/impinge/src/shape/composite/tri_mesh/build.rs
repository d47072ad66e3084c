//! Construction of meshes, and of meshes from other ones.

use std::sync::OnceLock;

use super::MeshByDimension;
use super::bends::Bends;
use super::topology::Topology;
use super::{TriMesh, entries};
use crate::bounding_volume::Aabb;
use crate::math::{Mapped, Point, Real, Space, Vector};
use crate::partitioning::BoxTree;
use crate::shape::Revision;
use crate::shape::composite::mesh_error::{
    MeshError, check_moved, check_parts, check_scale, check_vertices, or_panic,
};
use crate::shape::composite::polyline::refused;

impl<N: Space<D>, const D: usize> TriMesh<N, D> {
    /// The mesh of triangles given by three vertices each.
    ///
    /// # Panics
    /// Where [`Self::try_new`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn new(vertices: Vec<Point<N, D>>, triangles: Vec<[u32; 3]>) -> Self {
        or_panic(Self::try_new(vertices, triangles))
    }

    /// The mesh of triangles given by three vertices each. Vertices may coincide or belong to no
    /// triangle, and triangles may have no area.
    ///
    /// # Errors
    /// If a coordinate is not finite, a triangle refers to a vertex that does not exist, there is
    /// no triangle, or 32 bits cannot number the corners.
    pub fn try_new(
        vertices: Vec<Point<N, D>>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, MeshError> {
        entries::build_mesh(vertices, triangles)
    }

    /// See [`Self::try_new`].
    pub(super) fn build(
        vertices: Vec<Point<N, D>>,
        triangles: Vec<[u32; 3]>,
    ) -> Result<Self, MeshError> {
        check_vertices(&vertices)?;
        check_parts(&triangles, vertices.len())?;
        let topology = Topology::new(&vertices, &triangles);
        let boxes = boxes_of(&vertices, &triangles);
        let mut tree = BoxTree::try_from_vec(boxes).map_err(refused)?;
        let normals = normals_of(&vertices, &triangles);
        tree.add_slabs(&normals, |index| corners_of(&vertices, &triangles[index as usize]));
        Ok(Self {
            is_cycle: topology.is_cycle,
            bends: Bends::new(triangles.len()),
            packed: <N::Algorithms>::mesh_packed(&tree, &vertices, &triangles),
            vertices,
            triangles,
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

    /// Merges vertices at one position: those that repeat an earlier one are dropped, and the
    /// triangles renumbered. The behaviour of the mesh is unchanged.
    #[must_use]
    pub fn with_vertices_merged(self) -> Self {
        let (mut number, mut kept) = (Vec::with_capacity(self.vertices.len()), Vec::new());
        let mut next = 0..;
        for (vertex, point) in (0..).zip(&self.vertices) {
            let first = self.topology.joints.of(vertex);
            if first == vertex {
                number.extend(next.next());
                kept.push(*point);
            } else {
                number.push(number[first as usize]);
            }
        }
        let renumbered = |vertex: u32| number[vertex as usize];
        let triangles = self.triangles.iter().map(|corners| corners.map(renumbered)).collect();
        self.with(kept, triangles)
    }

    /// Reverses the front of each triangle: the second and third corner are exchanged, and with
    /// them the first and last side. A solid mesh becomes a skin.
    #[must_use]
    pub fn flipped(self) -> Self {
        let triangles = self.triangles.iter().map(|&[a, b, c]| [a, c, b]).collect();
        let vertices = self.vertices.clone();
        Self { is_solid: false, ..self.with(vertices, triangles) }
    }

    /// The mesh scaled along the axes of its frame, about its origin. If the scale mirrors it, the
    /// triangles are flipped as by [`Self::flipped`], so that the front stays in front.
    ///
    /// # Errors
    /// If a scale is zero or not finite, or a coordinate becomes infinite.
    pub fn try_scaled(&self, scale: &Vector<N, D>) -> Result<Self, MeshError> {
        check_scale(scale)?;
        let scaled = |point: &Point<N, D>| Point::from(point.coords.component_mul(scale));
        let vertices: Vec<_> = self.vertices.iter().map(scaled).collect();
        check_vertices(&vertices)?;
        let is_mirrored = scale.iter().filter(|&&x| x < N::ZERO).count() % 2 == 1;
        let turned = |&[a, b, c]: &[u32; 3]| if is_mirrored { [a, c, b] } else { [a, b, c] };
        let triangles = self.triangles.iter().map(turned).collect();
        Ok(self.with(vertices, triangles))
    }

    /// The mesh of vertices and triangles that are known to be valid, with the options of this one.
    fn with(&self, vertices: Vec<Point<N, D>>, triangles: Vec<[u32; 3]>) -> Self {
        let made = Self::new(vertices, triangles);
        let Self { is_one_sided, is_solid, keeps_internal_edges, .. } = *self;
        Self { is_one_sided, is_solid, keeps_internal_edges, ..made }
    }

    /// Moves the vertices; see [`Self::try_set_vertices`].
    ///
    /// # Panics
    /// Where [`Self::try_set_vertices`] returns an error.
    #[track_caller]
    pub fn set_vertices(&mut self, vertices: &[Point<N, D>]) {
        or_panic(self.try_set_vertices(vertices));
    }

    /// Moves the vertices, for a mesh that deforms: all of them, in the order of
    /// [`Self::vertices`].
    ///
    /// Triangles that were joined stay joined, even if their corners are apart now. The tree is
    /// refitted, not rebuilt: O(n), a fifth to a tenth of the cost of making the mesh; a degraded
    /// tree order is renewed over several calls. On an error nothing has changed.
    ///
    /// # Errors
    /// If a coordinate is not finite or the number of vertices differs.
    pub fn try_set_vertices(&mut self, vertices: &[Point<N, D>]) -> Result<(), MeshError> {
        entries::move_vertices(self, vertices)
    }

    /// See [`Self::try_set_vertices`].
    pub(super) fn move_vertices(&mut self, vertices: &[Point<N, D>]) -> Result<(), MeshError> {
        check_moved(vertices, self.vertices.len())?;
        let boxes = boxes_of(vertices, &self.triangles);
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
        self.is_cycle = self.topology.is_cycle && self.topology.joints.are_together(vertices);
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

/// The box of a triangle, as stored in the tree.
pub(crate) fn box_of_corners<N: Real, const D: usize>(corners: &[Point<N, D>; 3]) -> Aabb<N, D> {
    Aabb::from_points(corners).unwrap_or_else(Aabb::unbounded)
}

/// The unit normals of all triangles, zero without area; empty in 2D.
fn normals_of<N: Space<D>, const D: usize>(
    vertices: &[Point<N, D>],
    triangles: &[[u32; 3]],
) -> Vec<Vector<N, D>> {
    let normal = |triangle| <N::Algorithms>::mesh_normal(&corners_of(vertices, triangle));
    triangles.iter().map_while(normal).collect()
}
