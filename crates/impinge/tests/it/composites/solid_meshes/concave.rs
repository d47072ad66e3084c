//! Solid meshes: boxes on a stair and in a groove with ends flush, crates flush with each other, and
//! crates at the grid lines of a floor. Contacts are those of boxes at the same places.

use super::{P3, V3, at, cuboid, solid};

use impinge::math::na::UnitQuaternion;
use impinge::math::{Isometry3, Point, Space, Unit, Vector};
use impinge::narrow_phase::{ContactPrediction, contact_manifolds};
use impinge::query::{ContactManifold, contact};
use impinge::shape::{Cuboid, HeightField, Shape, TriMesh};

/// The contacts of two shapes, the first one at the origin, by normal and depth.
fn contacts<N: Space<3, Isometry = Isometry3<N>>>(
    lower: &dyn Shape<N, 3>,
    upper: &dyn Shape<N, 3>,
    pose: &Isometry3<N>,
    prediction: f64,
) -> Vec<(Vector<N, 3>, N, Point<N, 3>)> {
    let prediction = ContactPrediction::new(N::lit(prediction), N::ZERO, N::ZERO);
    let found = contact_manifolds(&Isometry3::identity(), lower, pose, upper, &prediction, None);
    let all = found.iter().flat_map(ContactManifold::contacts);
    all.map(|tracked| &tracked.contact)
        .map(|contact| (contact.normal.into_inner(), contact.depth, contact.world2))
        .collect()
}

/// Returns the prism from z = -1 to 1 over an outline that runs counter-clockwise; `cap` are its
/// triangles.
fn prism<N: Space<3>>(outline: &[[f64; 2]], cap: &[[u32; 3]]) -> TriMesh<N, 3> {
    let side = |z: f64| outline.iter().map(move |[x, y]| Point::from([*x, *y, z].map(N::lit)));
    let count = u32::try_from(outline.len()).expect("few");
    let vertices = side(1.0).chain(side(-1.0)).collect();
    let mut triangles = cap.to_vec();
    triangles.extend(cap.iter().map(|[a, b, c]| [a + count, c + count, b + count]));
    for first in 0..count {
        let next = (first + 1) % count;
        triangles.push([first, first + count, next + count]);
        triangles.push([first, next + count, next]);
    }
    TriMesh::new(vertices, triangles).solid()
}

fn stair<N: Space<3>>() -> TriMesh<N, 3> {
    let outline = [[0.0, 0.0], [2.0, 0.0], [2.0, 1.0], [1.0, 1.0], [1.0, 2.0], [0.0, 2.0]];
    prism(&outline, &[[0, 3, 5], [3, 4, 5], [0, 1, 3], [1, 2, 3]])
}

fn on_a_stair<N: Space<3, Isometry = Isometry3<N>>>() {
    let solid = Cuboid::new(Vector::<N, 3>::from([0.5, 0.5, 1.0].map(N::lit)));
    let noise = N::lit(64.0) * N::EPSILON;
    for [sunk, aside] in [[0.0, 0.0], [0.01, 0.0], [0.001, 0.001], [0.0, 0.001], [0.01, 0.02]] {
        let pose = at::<N>([1.5 - aside, 1.5 - sunk, 0.0]);
        let found = contacts(&stair::<N>(), &solid, &pose, 0.005);
        let deepest = |axis: usize| {
            let along = found.iter().filter(|found| found.0[axis] > N::lit(0.99));
            along.map(|found| found.1).reduce(|best, next| if next > best { next } else { best })
        };
        for (depth, expected) in [(deepest(0), aside), (deepest(1), sunk)] {
            let is_right = |depth: N| (depth - N::lit(expected)).abs() <= noise;
            assert!(depth.is_some_and(is_right), "{expected} of {sunk}, {aside}: {found:?}");
        }
        let is_right = found.iter().all(|found| found.0[0] + found.0[1] > N::lit(0.99));
        assert!(is_right, "out of the stair: {sunk}, {aside}: {found:?}");
        let query = contact(&Isometry3::identity(), &stair::<N>(), &pose, &solid, N::ZERO);
        let depth = query.expect("they touch").depth;
        assert!(depth <= N::lit(sunk.max(aside)) + noise, "{depth} of {sunk}, {aside}");
    }
}

#[test]
fn boxes_touch_both_sides_of_a_stair() {
    on_a_stair::<f64>();
    on_a_stair::<f32>();
}

#[test]
fn a_box_in_a_groove_touches_its_floor_and_sides() {
    let outline = [
        [-2.0, 0.0],
        [2.0, 0.0],
        [2.0, 3.0],
        [1.0, 3.0],
        [1.0, 1.0],
        [-1.0, 1.0],
        [-1.0, 3.0],
        [-2.0, 3.0],
    ];
    let cap = [[0, 5, 7], [5, 6, 7], [0, 1, 4], [0, 4, 5], [1, 2, 4], [2, 3, 4]];
    let groove = prism::<f64>(&outline, &cap);
    let solid = Cuboid::new(V3::new(1.0, 0.5, 1.0));
    let found = contacts(&groove, &solid, &at([0.0, 1.49, 0.0]), 0.0);
    for (normal, least) in [(V3::x(), 0.0), (-V3::x(), 0.0), (V3::y(), 0.01)] {
        let is_there = |found: &(V3, f64, P3)| {
            (found.0 - normal).norm() < 1e-12 && (found.1 - least).abs() < 1e-12
        };
        assert!(found.iter().any(is_there), "{normal}: {found:?}");
    }
}

#[test]
fn crates_flush_with_a_crate_are_not_pushed_aside() {
    let lower = solid(cuboid::<f64>([0.5; 3], [0.0; 3]));
    for half in [[0.5, 0.5, 0.25], [0.25, 0.5, 0.5], [0.5, 0.25, 0.25], [0.25, 0.25, 0.5]] {
        let upper = solid(cuboid::<f64>(half, [0.0; 3]));
        for sunk in [0.001, 0.01] {
            for (x, z) in [(1.0, 1.0), (-1.0, 1.0), (1.0, -1.0), (-1.0, -1.0)] {
                let aside = [x * (0.5 - half[0]), z * (0.5 - half[2])];
                let pose = at([aside[0], 0.5 + half[1] - sunk, aside[1]]);
                let found = contacts(&lower, &upper, &pose, 0.0);
                assert!(found.iter().any(|found| found.0.y > 0.99), "no support: {found:?}");
                for (normal, depth, _) in &found {
                    let is_up = normal.y > 0.99 && (depth - sunk).abs() < 1e-12;
                    assert!(is_up || *depth < 1e-12, "{half:?} by {aside:?}: {found:?}");
                }
            }
        }
    }
}

#[test]
fn sides_of_crates_do_not_bump_into_flat_edges() {
    let scale = V3::new(10.0, 1.0, 10.0);
    let field = HeightField::<f64, 3>::new(11, 11, vec![0.0; 121], scale);
    let crates = solid(cuboid::<f64>([0.4; 3], [0.0; 3]));
    let axis = Unit::new_normalize(V3::new(1.0, 0.0, 1.0));
    for tilt in [0.0, 1e-6, 1e-4, -1e-4, 1e-3] {
        let turn = UnitQuaternion::from_axis_angle(&axis, tilt);
        for step in 0..48 {
            // The side passes the grid line at z = 1.
            let z = 0.585 + 0.0005 * f64::from(step);
            let pose = Isometry3::from_parts(V3::new(0.03, 0.399, z).into(), turn);
            for (normal, depth, place) in contacts(&field, &crates, &pose, 0.02) {
                // Sides that have just passed a grid line may still touch it.
                let is_past = depth > 0.0 && depth <= 0.011;
                assert!(normal.y > 0.99 || is_past, "{normal} {depth} at {place}, {tilt} {z}");
            }
        }
    }
}
