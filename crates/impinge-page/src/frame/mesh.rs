//! The meshes of a stage and their ids.

use std::collections::BTreeMap;

use impinge::debug_render::ShapeMesh;
use impinge::math::Real;
use serde::Serialize;

use crate::frame::payload::{Payload, Section};
use crate::space::coordinates;

/// The number of frames after which an unused mesh is dropped.
const PATIENCE: u64 = 120;

/// A mesh in `f32`, as the page receives it.
#[derive(Clone, Debug)]
struct Buffers {
    /// The [`ShapeMesh::id`] of the mesh.
    hash: u64,
    /// The point in the frame of the shape to which the vertices are relative. It is not the origin
    /// if the mesh is far from the origin, where vertices would coincide in `f32`.
    center: [f64; 3],
    vertices: Vec<f32>,
    triangles: Vec<u32>,
    lines: Vec<u32>,
    /// The index of the last frame that used the mesh.
    used: u64,
}

/// The sections of a mesh in a payload.
#[derive(Debug, Serialize)]
pub(crate) struct MeshSections {
    id: u32,
    vertices: Section,
    triangles: Section,
    lines: Section,
}

/// The meshes of a stage by id. Ids increase and are not reused.
#[derive(Debug, Default)]
pub(crate) struct MeshTable {
    /// The id of the mesh for each [`ShapeMesh::id`].
    numbers: BTreeMap<u64, u32>,
    meshes: BTreeMap<u32, Buffers>,
    /// The id of the next new mesh.
    next: u32,
    frame: u64,
}

impl MeshTable {
    /// Begins a frame. Drops the meshes that were not used in the last [`PATIENCE`] frames, and
    /// returns their ids.
    pub(crate) fn begin(&mut self) -> Vec<u32> {
        self.frame += 1;
        let (frame, numbers, mut dropped) = (self.frame, &mut self.numbers, Vec::new());
        self.meshes.retain(|number, mesh| {
            let is_recent = frame <= mesh.used + PATIENCE;
            if !is_recent {
                numbers.remove(&mesh.hash);
                dropped.push(*number);
            }
            is_recent
        });
        dropped
    }

    /// Returns the id by which frames refer to a mesh. Adds the mesh if the table lacks it.
    pub(crate) fn number<N: Real, const D: usize>(&mut self, mesh: &ShapeMesh<N, D>) -> u32 {
        let next = self.next;
        let number = *self.numbers.entry(mesh.id).or_insert(next);
        if number == next {
            self.meshes.insert(next, Buffers::of(mesh, self.frame));
            self.next += 1;
        }
        number
    }

    /// Marks a mesh as used in this frame. Returns the centre to which its vertices are relative;
    /// `None` if the mesh was dropped.
    pub(crate) fn keep(&mut self, number: u32) -> Option<[f64; 3]> {
        let mesh = self.meshes.get_mut(&number)?;
        mesh.used = self.frame;
        Some(mesh.center)
    }

    /// Writes the meshes whose ids are at least `known`.
    pub(crate) fn write(&self, known: u32, payload: &mut Payload) -> Vec<MeshSections> {
        let meshes = self.meshes.range(known..);
        meshes
            .map(|(&id, mesh)| MeshSections {
                id,
                vertices: payload.floats(&mesh.vertices),
                triangles: payload.words(&mesh.triangles),
                lines: payload.words(&mesh.lines),
            })
            .collect()
    }
}

impl Buffers {
    fn of<N: Real, const D: usize>(mesh: &ShapeMesh<N, D>, frame: u64) -> Self {
        let points: Vec<_> =
            mesh.vertices.iter().map(|vertex| coordinates(&vertex.coords)).collect();
        let center = far_center(&points);
        let relative = |point: &[f64; 3]| [0, 1, 2].map(|axis| single(point[axis] - center[axis]));
        Self {
            hash: mesh.id,
            center,
            vertices: points.iter().flat_map(relative).collect(),
            triangles: mesh.triangles.as_flattened().to_vec(),
            lines: mesh.lines.as_flattened().to_vec(),
            used: frame,
        }
    }
}

/// Returns the centre of the AABB of the points if the magnitude of one coordinate of this centre
/// exceeds 16 times the largest extent of the AABB, otherwise the origin. Beyond that limit `f32`
/// would lose more than 4 of its 24 bits.
fn far_center(points: &[[f64; 3]]) -> [f64; 3] {
    let ends = |axis: usize| {
        let on_axis = points.iter().map(|point| point[axis]);
        let least = on_axis.clone().fold(f64::INFINITY, f64::min);
        [least, on_axis.fold(f64::NEG_INFINITY, f64::max)]
    };
    if points.is_empty() {
        return [0.0; 3];
    }
    let ends = [0, 1, 2].map(ends);
    let extent = ends.iter().map(|[low, high]| high - low).fold(0.0, f64::max);
    let center = ends.map(|[low, high]| f64::midpoint(low, high));
    let distance = center.iter().map(|x| x.abs()).fold(0.0, f64::max);
    if distance > 16.0 * extent { center } else { [0.0; 3] }
}

/// Converts to the nearest `f32`, clamped to ±1e30. The result is finite unless `x` is NaN.
#[expect(clippy::cast_possible_truncation, reason = "rounds, as documented")]
pub(crate) const fn single(x: f64) -> f32 {
    x.clamp(-1e30, 1e30) as f32
}

#[cfg(test)]
mod tests {
    use impinge::debug_render::MeshOptions;
    use impinge::dim3::math::Point;
    use impinge::dim3::shape::{Segment, Shape};

    use super::*;

    fn mesh(shape: &dyn Shape<f64, 3>) -> ShapeMesh<f64, 3> {
        ShapeMesh::of(shape, &MeshOptions::default())
    }

    #[test]
    fn a_mesh_far_from_its_origin_keeps_its_size() {
        let far = Segment::new(Point::new(1e12, 0.0, 0.0), Point::new(1e12 + 1.0, 0.0, 0.0));
        let mut table = MeshTable::default();
        let number = table.number(&mesh(&far));
        assert_eq!(table.keep(number), Some([1e12 + 0.5, 0.0, 0.0]), "the middle");
        let buffers = &table.meshes[&0];
        assert_eq!(buffers.vertices, [-0.5, 0.0, 0.0, 0.5, 0.0, 0.0], "half a length each way");
    }

    #[test]
    fn meshes_are_known_again_until_they_are_dropped() {
        let segment = Segment::new(Point::origin(), Point::new(1.0, 0.0, 0.0));
        let mut table = MeshTable::default();
        assert_eq!([0; 2].map(|_| table.number(&mesh(&segment))), [0, 0], "the same number");
        let dropped: Vec<u32> = (0..PATIENCE + 2).flat_map(|_| table.begin()).collect();
        assert_eq!((dropped, table.keep(0)), (vec![0], None), "once");
        assert_eq!(table.number(&mesh(&segment)), 1, "numbers are given once");
        assert_eq!(table.write(0, &mut Payload::default()).len(), 1, "the dropped one is gone");
    }
}
