//! Every built-in shape, and custom composites and convex solids, by name.

use impinge::math::{Isometry2, Isometry3, Point, Pose, Real, Space, Unit, Vector};
use impinge::procedural::space as surfaces;
use impinge::shape::{
    Ball, Capsule, Compound, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Ellipsoid,
    HeightField, Plane, Polyline, Rounded, Segment, ShapeHandle, TaperedCapsule, TriMesh, Triangle,
};

use super::composite_support::{Piece, Pieces};
use super::query_support::solids::RoundHull;

pub(crate) type Shapes<N, const D: usize> = Vec<(&'static str, ShapeHandle<N, D>)>;

/// Returns the shapes of both dimensions, a few times `s` large.
fn common<N: Space<D>, const D: usize>(s: N, corners: &[Point<N, D>; 3]) -> Shapes<N, D> {
    let [a, b, c] = *corners;
    let half = Vector::<N, D>::from_fn(|axis, _| s * N::lit([1.0, 0.5, 2.0][axis]));
    let mut up = Vector::<N, D>::zeros();
    up[1] = N::ONE;
    let wave = vec![a, b, c, a + (c - b)];
    let hull = RoundHull { points: corners.to_vec(), rounding: s * N::HALF };
    let part = Piece::Shape(ShapeHandle::new(Cuboid::new(half)));
    vec![
        ("ball", ShapeHandle::new(Ball::new(s))),
        ("segment", ShapeHandle::new(Segment::new(a, b))),
        ("capsule", ShapeHandle::new(Capsule::<N, D>::new(s, s * N::HALF))),
        ("triangle", ShapeHandle::new(Triangle::<N, D>::new(a, b, c))),
        ("cuboid", ShapeHandle::new(Cuboid::new(half))),
        ("ellipsoid", ShapeHandle::new(Ellipsoid::new(half))),
        ("tapered", ShapeHandle::new(TaperedCapsule::<N, D>::new(s, s * N::HALF, s))),
        ("rounded cuboid", ShapeHandle::new(Rounded::new(Cuboid::new(half), s * N::HALF))),
        ("rounded triangle", ShapeHandle::new(Rounded::new(Triangle::<N, D>::new(a, b, c), s))),
        ("support map", ShapeHandle::new(hull)),
        ("plane", ShapeHandle::new(Plane::<N, D>::new(Unit::new_unchecked(up)))),
        ("polyline", ShapeHandle::new(Polyline::open(wave))),
        (
            "mesh",
            ShapeHandle::new(TriMesh::new(vec![a, b, c, b + (c - a)], vec![[0, 1, 2], [2, 1, 3]])),
        ),
        (
            "pieces",
            ShapeHandle::new(Pieces::new(vec![
                (Pose::from_translation(a.coords), part),
                (Pose::identity(), Piece::Triangle(Triangle::new(a, b, c))),
                (Pose::identity(), Piece::Segment(Segment::new(a, c))),
            ])),
        ),
    ]
}

/// Returns the shapes in 2D.
pub(crate) fn plane<N: Real>(s: N) -> Shapes<N, 2> {
    let p = |x: f64, y: f64| Point::<N, 2>::new(N::lit(x) * s, N::lit(y) * s);
    let corners = [p(-1.0, -0.5), p(1.0, -0.25), p(0.25, 1.0)];
    let mut shapes = common(s, &corners);
    let square = [p(-1.0, -1.0), p(1.0, -1.0), p(1.0, 1.0), p(-1.0, 1.0)];
    let polygon = ConvexPolygon::from_points(&square);
    let heights = [0.0, 1.0, 0.5, -1.0, 0.0].map(N::lit).to_vec();
    let field = HeightField::<N, 2>::new(heights, Vector::<N, 2>::new(s * N::lit(4.0), s));
    let at = Isometry2::translation;
    let children = vec![
        (at(s, N::ZERO), ShapeHandle::new(Ball::new(s))),
        (at(-s, s), ShapeHandle::new(Polyline::closed(square.to_vec()))),
    ];
    shapes.push(("polygon", ShapeHandle::new(polygon.clone())));
    shapes.push(("rounded polygon", ShapeHandle::new(Rounded::new(polygon, s))));
    shapes.push(("height field", ShapeHandle::new(field)));
    shapes.push(("compound", ShapeHandle::new(Compound::new(children))));
    shapes
}

/// Returns the shapes in 3D.
pub(crate) fn space<N: Real>(s: N) -> Shapes<N, 3> {
    let p =
        |x: f64, y: f64, z: f64| Point::<N, 3>::new(N::lit(x) * s, N::lit(y) * s, N::lit(z) * s);
    let corners = [p(-1.0, -0.5, 0.0), p(1.0, -0.25, 0.5), p(0.25, 1.0, -0.5)];
    let mut shapes = common(s, &corners);
    let cube = surfaces::cuboid(&Cuboid::new(Vector::<N, 3>::repeat(s)));
    let hull = ConvexHull::from_points(&cube.vertices);
    let heights = [0.0, 1.0, 0.5, -1.0, 0.0, 0.25].map(N::lit).to_vec();
    let scale = Vector::<N, 3>::new(s * N::lit(4.0), s, s * N::lit(4.0));
    let at = Isometry3::translation;
    let closed = ShapeHandle::new(TriMesh::new(cube.vertices, cube.triangles));
    let children = vec![
        (at(s, N::ZERO, N::ZERO), ShapeHandle::new(Ball::new(s))),
        (at(-s, s, s), closed.clone()),
    ];
    let cylinder = || Cylinder::new(s, s * N::HALF);
    shapes.push(("hull", ShapeHandle::new(hull.clone())));
    shapes.push(("rounded hull", ShapeHandle::new(Rounded::new(hull, s))));
    shapes.push(("cylinder", ShapeHandle::new(cylinder())));
    shapes.push(("rounded cylinder", ShapeHandle::new(Rounded::new(cylinder(), s))));
    shapes.push(("cone", ShapeHandle::new(Cone::new(s, s))));
    shapes.push(("rounded cone", ShapeHandle::new(Rounded::new(Cone::new(s, s), s))));
    shapes.push(("height field", ShapeHandle::new(HeightField::<N, 3>::new(2, 3, heights, scale))));
    shapes.push(("closed mesh", closed));
    shapes.push(("compound", ShapeHandle::new(Compound::new(children))));
    shapes
}
