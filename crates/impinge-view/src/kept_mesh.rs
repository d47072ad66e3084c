//! Meshes in the form in which a picture stores them.

use crate::recording::embed;
use impinge::debug_render::ShapeMesh;
use impinge::dim3::math::{Point, Vector};
use impinge::math::Real;
use std::collections::BTreeMap;

/// A mesh in `f64` and 3D, with the data for shading and silhouettes.
#[derive(Clone, Debug, Default)]
pub(crate) struct KeptMesh {
    pub(crate) vertices: Vec<Point<f64>>,
    pub(crate) lines: Vec<[usize; 2]>,
    pub(crate) triangles: Vec<[usize; 3]>,
    /// The unit normal at each corner of each triangle, for shading. Triangles that meet at a small
    /// angle have a common normal at their common corners. A degenerate triangle has zero normals.
    pub(crate) normals: Vec<[Vector<f64>; 3]>,
    pub(crate) hinges: Vec<Hinge>,
    /// The number of lines and triangles with an invalid index or vertex.
    pub(crate) left_out: u64,
}

/// An edge that exactly two triangles share.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Hinge {
    pub(crate) ends: [usize; 2],
    pub(crate) triangles: [usize; 2],
}

/// The minimum cosine of the angle between the normals of two faces that share a smooth corner.
const SMOOTH: f64 = 0.75;

impl KeptMesh {
    /// Converts a mesh. Lines and triangles with an index without a vertex, or with a vertex that
    /// [`embed`] rejects, are omitted and counted. Costs `O(n log n)`.
    pub(crate) fn new<N: Real, const D: usize>(mesh: &ShapeMesh<N, D>) -> Self {
        let found: Vec<_> = mesh.vertices.iter().map(embed).collect();
        let is_good = |index: &u32| matches!(found.get(*index as usize), Some(Some(_)));
        let lines = mesh.lines.iter().filter(|line| line.iter().all(is_good));
        let triangles = mesh.triangles.iter().filter(|corners| corners.iter().all(is_good));
        let lines: Vec<_> = lines.map(|line| line.map(|index| index as usize)).collect();
        let triangles: Vec<_> = triangles.map(|corners| corners.map(|i| i as usize)).collect();
        let drawn = lines.len() + triangles.len();
        let left_out = (mesh.lines.len() + mesh.triangles.len() - drawn) as u64;
        let vertices = found.into_iter().map(Option::unwrap_or_default).collect();
        let mut kept = Self { vertices, lines, triangles, left_out, ..Self::default() };
        let welded = kept.welded();
        kept.hinges = hinges(&welded);
        kept.normals = kept.corner_normals(&welded);
        kept
    }

    /// Returns the triangles with each vertex index replaced by the index of the first vertex at
    /// the same position.
    fn welded(&self) -> Vec<[usize; 3]> {
        let mut first = BTreeMap::new();
        // Adding zero turns -0 into +0, so both zeros have the same bits.
        let bits =
            |vertex: &Point<f64>| [vertex.x, vertex.y, vertex.z].map(|x| (x + 0.0).to_bits());
        let vertices = self.vertices.iter().enumerate();
        let index_of = vertices.map(|(index, v)| *first.entry(bits(v)).or_insert(index));
        let index_of: Vec<usize> = index_of.collect();
        self.triangles.iter().map(|corners| corners.map(|index| index_of[index])).collect()
    }

    /// Returns a unit normal for each corner of each triangle: the normalized sum of the normals,
    /// weighted by area, of those faces at the corner whose angle to the triangle is small.
    fn corner_normals(&self, welded: &[[usize; 3]]) -> Vec<[Vector<f64>; 3]> {
        let normals: Vec<_> = (0..self.triangles.len()).map(|index| self.normal(index)).collect();
        let units: Vec<_> = normals.iter().map(unit).collect();
        let mut around = vec![Vec::new(); self.vertices.len()];
        for (triangle, corners) in welded.iter().enumerate() {
            for corner in corners {
                around[*corner].push(triangle);
            }
        }
        let smooth = |triangle: usize, corner: usize| {
            let others = around[corner].iter();
            let others = others.filter(|other| units[**other].dot(&units[triangle]) > SMOOTH);
            unit(&others.fold(Vector::zeros(), |sum, other| sum + normals[*other]))
        };
        let corners = welded.iter().enumerate();
        corners.map(|(triangle, corners)| corners.map(|corner| smooth(triangle, corner))).collect()
    }

    /// Returns the normal of a triangle, whose length is twice the area.
    pub(crate) fn normal(&self, triangle: usize) -> Vector<f64> {
        let [a, b, c] = self.triangles[triangle].map(|index| self.vertices[index]);
        (b - a).cross(&(c - a))
    }
}

/// Normalizes a vector. Returns zero if its norm is zero.
pub(crate) fn unit(v: &Vector<f64>) -> Vector<f64> {
    let norm = v.norm();
    if norm > 0.0 { v / norm } else { Vector::zeros() }
}

fn hinges(triangles: &[[usize; 3]]) -> Vec<Hinge> {
    let mut sides: BTreeMap<[usize; 2], Vec<usize>> = BTreeMap::new();
    for (index, [a, b, c]) in triangles.iter().copied().enumerate() {
        for [start, end] in [[a, b], [b, c], [c, a]] {
            sides.entry([start.min(end), start.max(end)]).or_default().push(index);
        }
    }
    let hinge = |(ends, triangles): (_, Vec<usize>)| {
        Some(Hinge { ends, triangles: triangles.try_into().ok()? })
    };
    sides.into_iter().filter_map(hinge).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use impinge::dim3::math::Point as Point3;

    /// Returns two triangles that share an edge along z, a third triangle and a line with an
    /// invalid index each, and a valid line. The second triangle is tilted up by `slope`.
    fn roof(slope: f32) -> ShapeMesh<f32, 3> {
        let vertices = [[-1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, -1.0], [1.0, slope, 0.0]];
        ShapeMesh {
            id: 1,
            vertices: vertices.map(Point3::from).to_vec(),
            lines: vec![[0, 1], [0, 9]],
            triangles: vec![[0, 1, 2], [1, 3, 2], [0, 1, 4]],
        }
    }

    #[test]
    fn hinges_and_normals() {
        let kept = KeptMesh::new(&roof(0.25));
        assert_eq!(kept.hinges, [Hinge { ends: [1, 2], triangles: [0, 1] }], "the common edge");
        assert_eq!(kept.normals[0][1], kept.normals[1][0], "smooth across the edge");
        assert_ne!(kept.normals[0][0], kept.normals[0][1], "the free corner keeps its own");
        let sharp = KeptMesh::new(&roof(2.0));
        assert_ne!(sharp.normals[0][1], sharp.normals[1][0], "not smooth");
        assert_eq!(kept.left_out, 2, "a line and a triangle with unknown vertices");
    }

    #[test]
    fn vertices_that_are_not_finite_take_their_lines_along() {
        let mut mesh = roof(0.0);
        mesh.vertices[3].y = f32::NAN;
        let kept = KeptMesh::new(&mesh);
        assert_eq!((kept.lines.len(), kept.triangles.len(), kept.left_out), (1, 1, 3), "{kept:?}");
    }
}
