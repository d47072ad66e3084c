//! Classifies the edges of a mesh, and checks whether its triangles bound a volume.

use impinge::math::na::Vector3;

use super::report::MeshReport;

/// One of the three sides of a triangle. Sides with the same `ends` form an edge of the mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct Side {
    /// The indices of the two vertices, the lower index first.
    ends: [u32; 2],
    triangle: u32,
    /// `true` if the triangle traverses the edge from the lower to the higher vertex index.
    is_forward: bool,
}

/// Counts the edges of each defective kind and the components, and computes the volume if the mesh
/// is solid. `origin` returns the face of a triangle, and its line. O(n log n).
pub(super) fn examine(
    vertices: &[[f64; 3]],
    triangles: &[[u32; 3]],
    origin: impl Fn(usize) -> (usize, Option<usize>),
    report: &mut MeshReport,
) {
    let mut sides = sides(triangles);
    sides.sort_unstable();
    let mut pieces = Pieces::new(triangles.len());
    for edge in sides.chunk_by(|a, b| a.ends == b.ends) {
        let (face, line) = origin(edge[0].triangle as usize);
        match edge {
            [_] => report.boundary_edges.add(face, line),
            [one, two] if one.is_forward == two.is_forward => {
                report.inconsistent_edges.add(face, line);
            }
            [_, _] => {}
            _ => report.non_manifold_edges.add(face, line),
        }
        edge[1..].iter().for_each(|side| pieces.join(edge[0].triangle, side.triangle));
    }
    report.components = pieces.count;
    report.volume = report.is_solid().then(|| volume(vertices, triangles));
}

fn sides(triangles: &[[u32; 3]]) -> Vec<Side> {
    let mut sides = Vec::with_capacity(3 * triangles.len());
    for (triangle, corners) in (0..).zip(triangles) {
        sides.extend((0..3).map(|side| {
            let [from, to] = [corners[side], corners[(side + 1) % 3]];
            Side { ends: [from.min(to), from.max(to)], triangle, is_forward: from < to }
        }));
    }
    sides
}

/// Computes the volume by the divergence theorem, relative to the first vertex.
fn volume(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> f64 {
    let origin = vertices.first().copied().map(Vector3::from).unwrap_or_default();
    let at = |corner: u32| Vector3::from(vertices[corner as usize]) - origin;
    let six_times = triangles.iter().map(|[a, b, c]| at(*a).dot(&at(*b).cross(&at(*c))));
    six_times.sum::<f64>() / 6.0
}

/// The connected components of triangles, by union-find with path halving.
struct Pieces {
    parent: Vec<u32>,
    count: usize,
}

impl Pieces {
    fn new(triangles: usize) -> Self {
        Self { parent: (0..).take(triangles).collect(), count: triangles }
    }

    fn root(&mut self, mut triangle: u32) -> u32 {
        // Terminates: the parent of a triangle has a lower index.
        while self.parent[triangle as usize] != triangle {
            let above = self.parent[triangle as usize];
            self.parent[triangle as usize] = self.parent[above as usize];
            triangle = above;
        }
        triangle
    }

    fn join(&mut self, triangle1: u32, triangle2: u32) {
        let [root1, root2] = [self.root(triangle1), self.root(triangle2)];
        if root1 != root2 {
            self.parent[root1.max(root2) as usize] = root1.min(root2);
            self.count -= 1;
        }
    }
}
