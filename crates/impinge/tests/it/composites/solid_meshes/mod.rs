//! Tests of closed meshes and lines made solid by `solid`.

mod concave;
mod contacts;
mod convex_twins;
mod flush;
mod making;
mod pieces;
mod plane;
mod worlds;

use impinge::math::{Isometry3, Point, Real, Space, Vector};
use impinge::procedural::space as surfaces;
use impinge::shape::{Ball, Cuboid, TriMesh};

type V3 = Vector<f64, 3>;
type P3 = Point<f64, 3>;

/// The vertices and triangles of a surface.
type Soup<N> = (Vec<Point<N, 3>>, Vec<[u32; 3]>);

/// Returns the surface of a box around a point.
fn cuboid<N: Real>(half: [f64; 3], middle: [f64; 3]) -> Soup<N> {
    let lit = |xs: [f64; 3]| Vector::<N, 3>::from(xs.map(N::lit));
    let surface = surfaces::cuboid(&Cuboid::new(lit(half)));
    (surface.vertices.iter().map(|corner| corner + lit(middle)).collect(), surface.triangles)
}

/// Returns the surface of a ball around the origin.
fn ball<N: Real>(radius: f64, subdivisions: u32) -> Soup<N> {
    let surface = surfaces::ball(&Ball::new(N::lit(radius)), subdivisions);
    (surface.vertices, surface.triangles)
}

/// Returns the surface with all windings reversed.
fn inverted<N: Real>((corners, triangles): Soup<N>) -> Soup<N> {
    (corners, triangles.iter().map(|&[a, b, c]| [a, c, b]).collect())
}

/// Joins several surfaces into one.
fn joined<N: Real>(bodies: &[Soup<N>]) -> Soup<N> {
    let (mut corners, mut triangles) = (Vec::new(), Vec::new());
    for (own, named) in bodies {
        let first = u32::try_from(corners.len()).expect("few");
        triangles.extend(named.iter().map(|names| names.map(|name| name + first)));
        corners.extend(own.iter().copied());
    }
    (corners, triangles)
}

fn skin<N: Space<3>>((corners, triangles): Soup<N>) -> TriMesh<N, 3> {
    TriMesh::new(corners, triangles)
}

fn solid<N: Space<3>>(soup: Soup<N>) -> TriMesh<N, 3> {
    skin(soup).solid()
}

fn at<N: Real>(place: [f64; 3]) -> Isometry3<N> {
    let [x, y, z] = place.map(N::lit);
    Isometry3::translation(x, y, z)
}
