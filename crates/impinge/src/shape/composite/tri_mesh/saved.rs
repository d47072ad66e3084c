//! Conversion of meshes to and from the records of saved worlds.

use super::{TriMesh, entries};
use crate::math::Space;
use crate::math::numbers::{Damage, Numbers, ensure};
use crate::shape::saved::MeshRecord;

impl<N: Space<D>, const D: usize> TriMesh<N, D> {
    /// Returns the record of the mesh.
    pub(in crate::shape) fn record(&self) -> MeshRecord<N> {
        let joints = &self.topology.joints;
        MeshRecord {
            vertices: Numbers::of_points(&self.vertices),
            parts: self.triangles.as_flattened().to_vec(),
            ghosts: u32::try_from(self.ghosts).unwrap_or(u32::MAX),
            joints: self.topology.is_moved.then(|| joints.of_vertices_in_order().to_vec()),
            is_one_sided: self.is_one_sided,
            is_solid: self.is_solid,
            keeps_internal_edges: self.keeps_internal_edges,
        }
    }

    /// Restores the mesh from its record; an error if the record is not of a valid mesh.
    pub(in crate::shape) fn of_record(record: &MeshRecord<N>) -> Result<Self, Damage> {
        let (triangles, ghosts) = (record.parts()?, record.ghosts as usize);
        ensure(ghosts < triangles.len(), "all triangles of a mesh are ghosts")?;
        let mesh = entries::build_mesh(record.vertices.points()?, triangles, ghosts);
        let mut mesh = mesh.map_err(|error| Damage::found(&error))?;
        if let Some(joints) = record.moved_joints(mesh.vertices.len())? {
            mesh.move_joints(joints);
        }
        mesh.is_one_sided = record.is_one_sided;
        mesh.is_solid = record.is_solid && record.is_one_sided;
        mesh.keeps_internal_edges = record.keeps_internal_edges;
        Ok(mesh)
    }
}
