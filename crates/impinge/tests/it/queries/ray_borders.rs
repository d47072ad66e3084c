//! Rays that meet the border of a triangle or a mesh in 3D exactly: the rounding of the ray must not
//! let them pass.

use impinge::math::{Point, Real, Space, Vector};
use impinge::query::{Ray, RayCast};
use impinge::shape::{Shape, TriMesh, Triangle};

use crate::support::samples::samples;

fn hits_at_one<N: Space<3>>(shape: &dyn Shape<N, 3>, origin: [f64; 3], dir: [f64; 3]) {
    let ray = Ray::new(Point::<N, 3>::from(origin.map(N::lit)), dir.map(N::lit).into());
    for solid in [true, false] {
        let found = shape.cast_local_ray(&ray, solid).map(|hit| hit.toi);
        let is_near = found.is_some_and(|toi| (toi - N::ONE).abs() <= N::lit(256.0) * N::EPSILON);
        assert!(is_near, "{found:?} for {ray:?} and {shape:?}");
    }
}

fn triangle<N: Real>(corners: [[f64; 3]; 3]) -> Triangle<N, 3> {
    let [a, b, c] = corners.map(|corner| Point::from(corner.map(N::lit)));
    Triangle::new(a, b, c)
}

#[test]
fn borders_by_hand() {
    let corners = [[-2.0, 0.0, -2.0], [2.0, 0.0, -2.0], [2.0, 0.0, 2.0], [-2.0, 0.0, 2.0]];
    let floor =
        TriMesh::new(corners.map(Point::<f64, 3>::from).to_vec(), vec![[0, 2, 1], [0, 3, 2]]);
    hits_at_one(&floor, [1.5, 1.0, 5.0], [-3.0, -1.0, -3.0]);
    let tilted = triangle::<f64>([[2.5, -3.0, -2.5], [-2.0, -2.0, -2.0], [1.0, -1.5, -1.0]]);
    hits_at_one(&tilted, [-0.75, -3.5, -5.25], [1.0, 1.0, 3.0]);
}

/// Rays through points of sides, at quarters between corners on a grid: all numbers are exact.
fn borders_on_a_grid<N: Space<3>>() {
    let mut state = 11_u32;
    let mut random = |range: u32| {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from((state >> 8) % (2 * range + 1)) - f64::from(range)
    };
    let mut hits = 0;
    for round in 0..samples(2000) {
        let corners = [0; 3].map(|_| [0; 3].map(|_: i32| random(8) / 2.0));
        let dir = [0; 3].map(|_: i32| random(4));
        let [a, b, c] = corners.map(Vector::<f64, 3>::from);
        let volume = (b - a).cross(&(c - a)).dot(&Vector::<f64, 3>::from(dir));
        if volume.abs() < 1.0 {
            // The ray is parallel to the triangle, or nearly so.
            continue;
        }
        let share = f64::from(u32::try_from(round % 5).expect("few")) / 4.0;
        let on = Vector::<f64, 3>::from(corners[round % 3]) * (1.0 - share)
            + Vector::<f64, 3>::from(corners[(round + 1) % 3]) * share;
        let origin = on - Vector::<f64, 3>::from(dir);
        hits_at_one::<N>(&triangle::<N>(corners), origin.into(), dir);
        let vertices = corners.map(|corner| Point::<N, 3>::from(corner.map(N::lit))).to_vec();
        hits_at_one::<N>(&TriMesh::new(vertices, vec![[0, 1, 2]]), origin.into(), dir);
        hits += 1;
    }
    assert!(hits > samples(1000), "{hits} rays");
}

#[test]
fn borders_of_triangles_on_a_grid() {
    borders_on_a_grid::<f64>();
    borders_on_a_grid::<f32>();
}
