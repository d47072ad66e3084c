//! Tests in 2D that solids that slide over a straight line of many segments, or over filled
//! triangles, have only the normal of the floor.

use crate::support::samples::stride;
use crate::support::slides;

use impinge::math::na::{Translation2, UnitComplex};
use impinge::math::{Isometry2, Point, Pose, Real, Space, Vector};
use impinge::shape::{
    Ball, Capsule, ConvexPolygon, Cuboid, HeightField, Polyline, Shape, ShapeHandle, TriMesh,
};
use slides::{Expected, Random, slide};

fn v<N: Real>(x: f64, y: f64) -> Vector<N, 2> {
    Vector::<N, 2>::new(N::lit(x), N::lit(y))
}

fn solids<N: Real>() -> Vec<(&'static str, ShapeHandle<N, 2>)> {
    let corners = [[0.0, -0.4], [0.5, -0.2], [0.4, 0.3], [-0.1, 0.5], [-0.5, 0.1]];
    let corners = corners.map(|[x, y]| Point::from(v(x, y)));
    vec![
        ("ball", ShapeHandle::new(Ball::new(N::lit(0.37)))),
        ("cuboid", ShapeHandle::new(Cuboid::new(v(0.31, 0.23)))),
        ("wide cuboid", ShapeHandle::new(Cuboid::new(v(1.7, 0.23)))),
        ("capsule", ShapeHandle::new(Capsule::<N, 2>::new(N::lit(0.4), N::lit(0.2)))),
        ("polygon", ShapeHandle::new(ConvexPolygon::try_new(&corners).expect("convex"))),
    ]
}

/// Returns the height of the lowest point of a solid with the rotation `turn` and its origin at
/// height 0.
fn lowest<N: Real>(solid: &dyn Shape<N, 2>, turn: UnitComplex<N>) -> N {
    let pose = Pose::from_isometry(&Isometry2::from_parts(Translation2::identity(), turn));
    let geometry = solid.geometry();
    let map = geometry.as_support_map().expect("a convex solid");
    pose.point(&map.support_point(&pose.inverse_vector(&v(0.0, -1.0)))).y
}

/// Slides all solids along a floor at y = 0 around x = `center`, to the left or right at random.
/// Asserts that each contact has the floor's normal and the depth `depth`, in a single manifold. By
/// default every seventh way is tested; these eight ways have all solids, angles and frames.
fn slide_all<N: Real + Space<2, Isometry = Isometry2<N>>>(
    floor: &dyn Shape<N, 2>,
    (center, depth, is_below): (f64, f64, bool),
    label: &str,
) {
    let mut random = Random::new(5);
    let mut number = 0_usize;
    for (name, solid) in solids::<N>() {
        for angle in [0.0, 0.013, 0.5, std::f64::consts::FRAC_PI_2, -0.8, 2.9] {
            for frame in [Isometry2::identity(), Isometry2::new(v(-40.0, 11.0), N::lit(0.7))] {
                let turn = UnitComplex::new(N::lit(angle));
                let height = -lowest(solid.as_ref(), turn) - N::lit(depth);
                let start = random.unit();
                let side = if random.below(2) == 0 { N::ONE } else { -N::ONE };
                number += 1;
                if !number.is_multiple_of(stride(7)) {
                    continue;
                }
                // For a solid below the floor, its poses and the expected normal are rotated by
                // half a turn.
                let half = if is_below { N::pi() } else { N::ZERO };
                let flip = Isometry2::rotation(half);
                let middle = Isometry2::translation(N::lit(center), N::ZERO);
                let way = (0..30).map(|step| {
                    let x = N::lit(start) + side * N::lit(f64::from(step) * 0.143 - 2.0);
                    let at = Vector::<N, 2>::new(x, height);
                    frame * middle * flip * Isometry2::from_parts(Translation2::from(at), turn)
                });
                let up = (frame * flip).rotation * v(0.0, 1.0);
                let size = N::lit(64.0 + center.abs());
                let expected = Expected {
                    normal: up,
                    normal_tolerance: N::lit(1e-6),
                    depth: N::lit(depth),
                    depth_tolerance: N::lit(1e-11) + N::lit(16.0) * N::EPSILON * size,
                    manifolds: 1,
                };
                let name = format!("{label}: {name}, angle {angle}, depth {depth}");
                slide(&name, (&frame, floor), solid.as_ref(), way, &expected);
            }
        }
    }
}

fn line<N: Real>(center: f64, is_even: bool) -> Vec<Point<N, 2>> {
    let mut random = Random::new(9);
    let off = |random: &mut Random| if is_even { 0.0 } else { 0.2 * random.unit() };
    let xs = (0..=40).map(|i| f64::from(i) * 0.5 - 10.0 + center + off(&mut random));
    // From right to left, so that the front, which is on the right of each segment, faces up.
    xs.rev().map(|x| Point::from(v(x, 0.0))).collect()
}

fn over_lines<N: Real + Space<2, Isometry = Isometry2<N>>>() {
    for (center, is_even) in [(0.0, true), (0.0, false), (2000.0, false)] {
        let line = Polyline::<N, 2>::open(line(center, is_even));
        for depth in [0.01, 0.0, -0.01] {
            slide_all(&line, (center, depth, false), "line");
            slide_all(&line, (center, depth, true), "line from below");
        }
        slide_all(&line.one_sided(), (center, 0.01, false), "one-sided line");
    }
    let heights = HeightField::<N, 2>::new(vec![N::ZERO; 41], v(20.0, 1.0));
    slide_all(&heights, (0.0, 0.01, false), "heights");
    slide_all(&heights, (0.0, -0.01, true), "heights from below");
}

#[test]
fn solids_slide_over_lines_in_single_precision() {
    over_lines::<f32>();
}

#[test]
fn solids_slide_over_lines_in_double_precision() {
    over_lines::<f64>();
}

/// Returns a slab of filled triangles with its top at y = 0.
fn slab<N: Real + Space<2>>(rows: u32) -> TriMesh<N, 2> {
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    for j in 0..=rows {
        for i in 0..=40 {
            vertices.push(Point::from(v(f64::from(i) * 0.5 - 10.0, -0.6 * f64::from(j))));
        }
    }
    for j in 0..rows {
        for i in 0..40 {
            let at = |di: u32, dj: u32| (j + dj) * 41 + i + di;
            let [a, b, c, d] = [at(0, 0), at(0, 1), at(1, 1), at(1, 0)];
            if (i + j) % 2 == 0 {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    TriMesh::new(vertices, triangles)
}

#[test]
fn solids_slide_over_filled_triangles() {
    for rows in [1, 3] {
        for depth in [0.01, 0.0, -0.01] {
            slide_all(&slab::<f64>(rows), (0.0, depth, false), "slab");
            slide_all(&slab::<f32>(rows), (0.0, depth, false), "slab");
        }
    }
}
