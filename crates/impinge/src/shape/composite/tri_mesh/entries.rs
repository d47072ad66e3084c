//! Entry points of meshes: construction, seam rules and ray tests.

use super::rays::RayBounds;
use super::{MeshByDimension, TriMesh};
use crate::math::{Point, Vector};
use crate::shape::composite::mesh_error::MeshError;
use crate::shape::{FaceSeams, FeatureId, Part};
use crate::tables::{Here, compiled};

compiled! {
    /// Entry points of meshes, compiled once per scalar type.
    trait MeshEntries;

    fn build_mesh(
        vertices: Vec<Point<N, D>>,
        triangles: Vec<[u32; 3]>,
        ghosts: usize,
    ) -> Result<TriMesh<N, D>, MeshError> = TriMesh::build;

    fn move_vertices(
        mesh: &mut TriMesh<N, D>,
        vertices: &[Point<N, D>],
    ) -> Result<(), MeshError> = TriMesh::move_vertices;

    fn admits(
        mesh: &TriMesh<N, D>,
        part: u32,
        feature: FeatureId,
        normal: &Vector<N, D>,
    ) -> bool = <Here as MeshByDimension<N, D>>::mesh_admits;

    fn admits_in_turn(
        mesh: &TriMesh<N, D>,
        part: u32,
        feature: FeatureId,
        normals: [&Vector<N, D>; 2],
    ) -> [bool; 2] = <Here as MeshByDimension<N, D>>::mesh_admits_in_turn;

    fn corner_admits_in_turn(
        mesh: &TriMesh<N, D>,
        part: u32,
        corner: (usize, bool),
        normals: [&Vector<N, D>; 2],
    ) -> [bool; 2] = <Here as MeshByDimension<N, D>>::mesh_corner_admits_in_turn;

    fn face_seams(
        mesh: &TriMesh<N, D>,
        part: u32,
    ) -> Option<FaceSeams<N>> = <Here as MeshByDimension<N, D>>::mesh_face_seams;

    fn snapped(
        mesh: &TriMesh<N, D>,
        part: u32,
        normal: &Vector<N, D>,
    ) -> Option<Vector<N, D>> = <Here as MeshByDimension<N, D>>::mesh_snapped;

    fn parts_along(
        mesh: &TriMesh<N, D>,
        bounds: &RayBounds<'_, N, D>,
        visit: &mut dyn FnMut(u32, Part<'_, N, D>) -> N,
    ) = <Here as MeshByDimension<N, D>>::mesh_parts_along;
}
