//! Records of meshes and polylines in saved worlds.

use serde::{Deserialize, Serialize};

use super::ShapeRecord;
use crate::math::numbers::{Damage, Numbers, ensure};
use crate::math::{Real, Space};
use crate::shape::{MeshByDimension, Polyline, Shape, TriMesh};

/// The record of a mesh or a polyline.
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct MeshRecord<N: Real> {
    pub(in crate::shape) vertices: Numbers<N>,
    /// The vertex indices of each part, one part after the other.
    pub(in crate::shape) parts: Vec<u32>,
    /// The number of ghosts, which are the last triangles in `parts`; 0 for a polyline.
    pub(in crate::shape) ghosts: u32,
    /// The joint of each vertex if vertices were moved after construction, else `None`. Joints of
    /// unmoved vertices follow from the positions.
    pub(in crate::shape) joints: Option<Vec<u32>>,
    pub(in crate::shape) is_one_sided: bool,
    pub(in crate::shape) is_solid: bool,
    pub(in crate::shape) keeps_internal_edges: bool,
}

impl<N: Real> MeshRecord<N> {
    /// Returns the `K` vertex indices of each part; an error if the number of indices is not a
    /// multiple of `K`.
    pub(in crate::shape) fn parts<const K: usize>(&self) -> Result<Vec<[u32; K]>, Damage> {
        let (parts, rest) = self.parts.as_chunks::<K>();
        ensure(rest.is_empty(), "a part of a mesh lacks a corner")?;
        Ok(parts.to_vec())
    }

    /// Checks and returns the joint of each vertex of a mesh whose vertices were moved; `None` if
    /// they were not moved.
    pub(in crate::shape) fn moved_joints(&self, vertices: usize) -> Result<Option<&[u32]>, Damage> {
        let Some(joints) = &self.joints else { return Ok(None) };
        ensure(joints.len() == vertices, "there are other joints than vertices")?;
        let is_first =
            |(vertex, &joint): (u32, &u32)| joint <= vertex && joints[joint as usize] == joint;
        ensure((0..).zip(joints).all(is_first), "a joint is no first vertex")?;
        Ok(Some(joints))
    }
}

/// Returns the record of a polyline or a mesh; `None` for any other shape.
pub(super) fn record<N: Space<D>, const D: usize>(
    shape: &dyn Shape<N, D>,
) -> Option<ShapeRecord<N>> {
    if let Some(line) = shape.as_shape::<Polyline<N, D>>() {
        return Some(ShapeRecord::Polyline(line.record()));
    }
    shape.as_shape::<TriMesh<N, D>>().map(|mesh| ShapeRecord::TriMesh(mesh.record()))
}

impl<N: Space<D>, const D: usize> Polyline<N, D> {
    fn record(&self) -> MeshRecord<N> {
        MeshRecord {
            vertices: Numbers::of_points(&self.vertices),
            parts: self.segments.as_flattened().to_vec(),
            ghosts: 0,
            joints: self.is_moved.then(|| self.joints.of_vertices_in_order().to_vec()),
            is_one_sided: self.is_one_sided(),
            is_solid: self.is_solid,
            keeps_internal_edges: self.keeps_internal_edges,
        }
    }

    pub(super) fn of_record(record: &MeshRecord<N>) -> Result<Self, Damage> {
        let line = Self::try_new(record.vertices.points()?, record.parts()?);
        let mut line = line.map_err(|error| Damage::found(&error))?;
        if let Some(joints) = record.moved_joints(line.vertices.len())? {
            line.move_joints(joints);
        }
        line.front = if record.is_one_sided { <N::Algorithms>::line_front() } else { None };
        line.is_solid = record.is_solid && record.is_one_sided;
        line.keeps_internal_edges = record.keeps_internal_edges;
        Ok(line)
    }
}
