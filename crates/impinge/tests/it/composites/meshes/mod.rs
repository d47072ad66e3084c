//! Tests meshes of triangles and polylines: construction, admitted normals, deformation.

mod build;
mod fields;
mod lines;
mod moved;
mod plane;
mod space;

use impinge::dim3::procedural;
use impinge::math::{Point, Real, Space, Vector};
use impinge::shape::{Ball, CompositeShape, FeatureId, Surface, TriMesh};

fn vector<N: Real, const D: usize>(v: [f64; D]) -> Vector<N, D> {
    Vector::<N, D>::from_fn(|axis, _| N::lit(v[axis]))
}

fn unit<N: Real, const D: usize>(v: [f64; D]) -> Vector<N, D> {
    vector::<N, D>(v).normalize()
}

fn points<N: Real, const D: usize>(points: &[[f64; D]]) -> Vec<Point<N, D>> {
    points.iter().map(|&p| Point::from(vector::<N, D>(p))).collect()
}

fn mesh<N: Space<D>, const D: usize>(
    vertices: &[[f64; D]],
    triangles: &[[u32; 3]],
) -> TriMesh<N, D> {
    TriMesh::new(points(vertices), triangles.to_vec())
}

/// Returns a mesh of the same triangles, in which each triangle has its own three vertices.
fn soup<N: Space<D>, const D: usize>(mesh: &TriMesh<N, D>) -> TriMesh<N, D> {
    let corner = |&vertex: &u32| mesh.vertices()[vertex as usize];
    let vertices = mesh.triangles().iter().flatten().map(corner).collect();
    let triangles = (0..).take(mesh.num_triangles()).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]);
    TriMesh::new(vertices, triangles.collect())
}

fn sphere<N: Real>(subdivisions: u32) -> TriMesh<N, 3> {
    let surface = procedural::ball(&Ball::new(N::ONE), subdivisions);
    TriMesh::try_from(surface).expect("a good surface")
}

fn surface<N: Real, const D: usize>(shape: &dyn CompositeShape<N, D>) -> &dyn Surface<N, D> {
    shape.surface().expect("the parts hang together")
}

/// Returns a grid of squares in the plane of the first two coordinates, each cut into two
/// counter-clockwise triangles. Triangle `2 (i + side j)` and the next triangle form the square at
/// (i, j).
fn grid<const D: usize>(side: u32, at: impl Fn(f64, f64) -> [f64; D]) -> GridOf<D> {
    let numbers = || (0..=side).flat_map(|j| (0..=side).map(move |i| (i, j)));
    let vertices = numbers().map(|(i, j)| at(f64::from(i), f64::from(j))).collect();
    let squares = numbers().filter(|&(i, j)| i < side && j < side);
    let triangles = squares.flat_map(|(i, j)| {
        let (near, far) = (i + (side + 1) * j, i + (side + 1) * (j + 1));
        [[near, near + 1, far + 1], [near, far + 1, far]]
    });
    (vertices, triangles.collect())
}

type GridOf<const D: usize> = (Vec<[f64; D]>, Vec<[u32; 3]>);

/// Returns the feature of the part's corner at the position `at`. Panics if the part has no corner
/// there.
fn corner_at<N: Real, const D: usize>(mesh: &TriMesh<N, D>, part: u32, at: [f64; D]) -> FeatureId {
    let corners = mesh.triangles()[part as usize].map(|v| mesh.vertices()[v as usize].coords);
    let found = (0..3).find(|&corner| corners[corner as usize] == vector(at));
    FeatureId::Vertex(found.expect("a corner is there"))
}
