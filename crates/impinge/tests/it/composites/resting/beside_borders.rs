//! Solids beside a plate, whose inclined sides touch its border from below while their centres are
//! above it. The contact is that of the border, as deep as the overlap, and not as deep as the part
//! of the solid below the plate.

use impinge::math::na::{Translation, UnitComplex, UnitQuaternion};
use impinge::math::{AbstractRotation, Isometry, Isometry2, Isometry3, Point, Space, Vector};
use impinge::narrow_phase::{ContactPrediction, contact_manifolds};
use impinge::query::{ContactManifold, contact};
use impinge::shape::{Cone, Cuboid, HeightField, Polyline, Shape, TriMesh};

/// The depths of the overlaps.
const DEPTHS: [f64; 4] = [1e-5, 1e-3, 0.01, 0.1];

/// Asserts that the query and every contact of the manifolds have the normal `normal`, and that the
/// deepest contact has the depth `depth`.
fn is_at_the_border<N: Space<D>, R, const D: usize>(
    plate: &dyn Shape<N, D>,
    solid: &dyn Shape<N, D>,
    pose: &Isometry<N, R, D>,
    normal: [f64; D],
    depth: f64,
) where
    R: AbstractRotation<N, D> + Copy,
{
    let (here, normal) =
        (Isometry::<N, R, D>::identity(), Vector::<N, D>::from(normal.map(N::lit)));
    let noise = N::lit(256.0) * N::EPSILON;
    let is_right = |found: N| (found - N::lit(depth)).abs() <= noise;
    let found = contact(&here, plate, pose, solid, N::ZERO).expect("they overlap");
    let is_along = (found.normal.into_inner() - normal).norm() <= noise;
    assert!(is_right(found.depth) && is_along, "{depth}: {found:?} of {plate:?} and {solid:?}");
    let prediction = ContactPrediction::new(N::ZERO, N::ZERO, N::ZERO);
    let manifolds = contact_manifolds(&here, plate, pose, solid, &prediction, None);
    let all = || manifolds.iter().flat_map(ContactManifold::contacts);
    let deepest = all().fold(-N::ONE, |best, next| next.contact.depth.max(best));
    assert!(is_right(deepest), "{depth}: {manifolds:?} of {plate:?} and {solid:?}");
    for tracked in all() {
        let is_along = (tracked.contact.normal.into_inner() - normal).norm() <= noise;
        assert!(is_along, "{depth}: {manifolds:?} of {plate:?} and {solid:?}");
    }
}

fn in_space<N: Space<3, Isometry = Isometry3<N>>>() {
    let corners = [[-4.0, 0.0, -4.0], [-4.0, 0.0, 4.0], [0.0, 0.0, 4.0], [0.0, 0.0, -4.0]];
    let vertices = || corners.map(|at| Point::<N, 3>::from(at.map(N::lit))).to_vec();
    let scale = Vector::<N, 3>::from([8.0, 1.0, 8.0].map(N::lit));
    let plates: [(f64, Box<dyn Shape<N, 3>>); 4] = [
        (0.0, Box::new(TriMesh::new(vertices(), vec![[0, 1, 2], [0, 2, 3]]))),
        (0.0, Box::new(TriMesh::new(vertices(), vec![[0, 2, 1], [0, 3, 2]]))),
        (4.0, Box::new(HeightField::<N, 3>::new(2, 2, vec![N::ZERO; 4], scale))),
        (4.0, Box::new(HeightField::<N, 3>::new(5, 5, vec![N::ZERO; 25], scale))),
    ];
    let slope = 0.5_f64.sqrt();
    let cone = Cone::new(N::lit(2.0), N::lit(4.0));
    let slab = Cuboid::new(Vector::<N, 3>::from([3.0, 0.25, 1.0].map(N::lit)));
    let turn = UnitQuaternion::from_axis_angle(
        &Vector::<N, 3>::z_axis(),
        N::lit(core::f64::consts::FRAC_PI_4),
    );
    for (border, plate) in &plates {
        for depth in DEPTHS {
            // The side of the cone reaches the height of the plate 3 beside its axis.
            let at = [border + 3.0 - depth / slope, 1.0, 0.0].map(N::lit);
            let pose = Isometry3::from_parts(
                Translation::from(Vector::<N, 3>::from(at)),
                UnitQuaternion::identity(),
            );
            is_at_the_border::<N, _, 3>(&**plate, &cone, &pose, [slope, -slope, 0.0], depth);
            // The slab rises to the right; its upper side touches the border.
            let out = 0.25 - depth;
            let at = [border + slope * (1.0 + out), slope * (1.0 - out), 0.5].map(N::lit);
            let pose = Isometry3::from_parts(Translation::from(Vector::<N, 3>::from(at)), turn);
            is_at_the_border::<N, _, 3>(&**plate, &slab, &pose, [slope, -slope, 0.0], depth);
        }
    }
}

fn in_plane<N: Space<2, Isometry = Isometry2<N>>>() {
    let line = |points: [f64; 3]| {
        let points = points.map(|x| Point::<N, 2>::from([N::lit(x), N::ZERO]));
        Polyline::open(points.to_vec())
    };
    let scale = Vector::<N, 2>::from([4.0, 1.0].map(N::lit));
    let plates: [Box<dyn Shape<N, 2>>; 3] = [
        Box::new(HeightField::<N, 2>::new(vec![N::ZERO; 5], scale)),
        Box::new(line([-2.0, 0.0, 2.0])),
        Box::new(line([2.0, 0.0, -2.0])),
    ];
    // A plank that rises away from an end of the plate; its upper side touches the end.
    let plank = Cuboid::new(Vector::<N, 2>::from([2.0, 0.2].map(N::lit)));
    for plate in &plates {
        for (depth, side) in DEPTHS.into_iter().flat_map(|depth| [(depth, 1.0), (depth, -1.0)]) {
            let turn = UnitComplex::new(N::lit(0.6_f64.atan2(0.8) * side));
            let out = 0.2 - depth;
            let at = [side * (2.0 + 0.8 + 0.6 * out), 0.6 - 0.8 * out].map(N::lit);
            let pose = Isometry2::from_parts(Translation::from(Vector::<N, 2>::from(at)), turn);
            is_at_the_border::<N, _, 2>(&**plate, &plank, &pose, [0.6 * side, -0.8], depth);
        }
    }
}

/// Turned crates that press their vertical edges into the border of a plate, also at the corners of
/// triangles, where the crate overlaps each triangle least along its own sides.
fn crates_press_a_border<N: Space<3, Isometry = Isometry3<N>>>() {
    let scale = Vector::<N, 3>::from([8.0, 1.0, 8.0].map(N::lit));
    let field = HeightField::<N, 3>::new(5, 5, vec![N::ZERO; 25], scale);
    let crate_ = Cuboid::new(Vector::<N, 3>::from([0.5, 0.5, 0.75].map(N::lit)));
    for (number, depth) in (0..480_u32).zip(DEPTHS.into_iter().cycle()) {
        let angle = 0.1 + f64::from(number) * 0.7;
        let turn = UnitQuaternion::from_axis_angle(&Vector::<N, 3>::y_axis(), N::lit(angle));
        let reach = 0.5 * angle.cos().abs() + 0.75 * angle.sin().abs();
        // The foremost edge of the crate lies beside its centre.
        let aside = [1.0, -1.0].map(|s| 0.5 * s * angle.sin() + 0.75 * angle.cos());
        let foremost = if angle.sin() * angle.cos() > 0.0 { aside[1] } else { aside[0] };
        let along = [0.0, 2.0, 0.3, -1.99][number as usize / 4 % 4];
        let height = [0.125, -0.125, 0.0][number as usize % 3];
        let at = [4.0 + reach - depth, height, along + foremost].map(N::lit);
        let pose = Isometry3::from_parts(Translation::from(Vector::<N, 3>::from(at)), turn);
        is_at_the_border::<N, _, 3>(&field, &crate_, &pose, [1.0, 0.0, 0.0], depth);
    }
}

#[test]
fn crates_beside_corners_of_a_border() {
    crates_press_a_border::<f64>();
    crates_press_a_border::<f32>();
}

#[test]
fn solids_beside_a_border_in_space() {
    in_space::<f64>();
    in_space::<f32>();
}

#[test]
fn solids_beside_a_border_in_the_plane() {
    in_plane::<f64>();
    in_plane::<f32>();
}
