//! Crates, as meshes or outlines, on floors of triangles and segments: slightly tilted, and with a
//! corner down. A crate rests on all corners that are below the floor, and is pushed up.

use impinge::math::na::{Translation, Unit, UnitComplex, UnitQuaternion};
use impinge::math::{Isometry2, Isometry3, Point, Space, Vector};
use impinge::narrow_phase::{ContactPrediction, contact_manifolds};
use impinge::query::{ContactManifold, contact};
use impinge::shape::{HeightField, Polyline, Shape, TriMesh};

/// The half side of the crates.
const HALF: f64 = 0.5;

fn point2<N: Space<2>>(at: [f64; 2]) -> Point<N, 2> {
    at.map(N::lit).into()
}

fn square<N: Space<2>>() -> Polyline<N, 2> {
    let corners = [[-HALF, -HALF], [HALF, -HALF], [HALF, HALF], [-HALF, HALF]];
    Polyline::closed(corners.map(point2).to_vec())
}

fn crate3<N: Space<3, Isometry = Isometry3<N>>>() -> TriMesh<N, 3> {
    let cuboid = impinge::shape::Cuboid::new(Vector::<N, 3>::repeat(N::lit(HALF)));
    let surface = impinge::procedural::space::cuboid(&cuboid);
    TriMesh::new(surface.vertices, surface.triangles)
}

/// Returns a floor of two triangles at height 0, 4 wide.
fn plate<N: Space<3>>() -> TriMesh<N, 3> {
    let corners = [[-2.0, 0.0, -2.0], [2.0, 0.0, -2.0], [2.0, 0.0, 2.0], [-2.0, 0.0, 2.0]];
    let vertices = corners.map(|at| Point::from(at.map(N::lit))).to_vec();
    TriMesh::new(vertices, vec![[0, 2, 1], [0, 3, 2]])
}

/// Returns flat floors whose top is at height 0.
fn floors3<N: Space<3, Isometry = Isometry3<N>>>() -> Vec<Box<dyn Shape<N, 3>>> {
    let scale = Vector::<N, 3>::from([4.0, 1.0, 4.0].map(N::lit));
    let field =
        |size: usize| HeightField::<N, 3>::new(size, size, vec![N::ZERO; size * size], scale);
    vec![Box::new(plate()), Box::new(plate().one_sided()), Box::new(field(2)), Box::new(field(9))]
}

/// Returns the contact manifolds of a floor at the origin with a crate.
fn on_floor<N: Space<3, Isometry = Isometry3<N>>>(
    floor: &dyn Shape<N, 3>,
    solid: &dyn Shape<N, 3>,
    pose: &Isometry3<N>,
) -> Vec<ContactManifold<N, 3>> {
    let prediction = ContactPrediction::new(N::lit(0.01), N::ZERO, N::ZERO);
    contact_manifolds(&Isometry3::identity(), floor, pose, solid, &prediction, None)
}

/// Returns the pose at `at`, turned by `tilt` about the horizontal direction `angle`.
fn tilted<N: Space<3, Isometry = Isometry3<N>>>(
    at: [f64; 3],
    angle: f64,
    tilt: f64,
) -> Isometry3<N> {
    let axis = Vector::<N, 3>::from([angle.cos(), 0.0, angle.sin()].map(N::lit));
    let turn = UnitQuaternion::from_axis_angle(&Unit::new_normalize(axis), N::lit(tilt));
    Isometry3::from_parts(Translation::from(Vector::<N, 3>::from(at.map(N::lit))), turn)
}

/// Asserts that each corner of a crate that is below a floor has a contact, that no contact of
/// positive depth is above the floor, and that all contacts push the crate up.
fn rests_on_its_corners<N: Space<3, Isometry = Isometry3<N>>>(
    floor: &dyn Shape<N, 3>,
    solid: &TriMesh<N, 3>,
    pose: &Isometry3<N>,
) {
    let found = on_floor(floor, solid, pose);
    let here = || format!("{solid:?} at {pose:?} on {floor:?}: {found:?}");
    let all = || found.iter().flat_map(ContactManifold::contacts).map(|tracked| &tracked.contact);
    for contact in all() {
        assert!(contact.normal.y > N::lit(0.99), "pushes up: {}", here());
        let is_lifted = contact.world2.y > N::lit(64.0) * N::EPSILON;
        assert!(!is_lifted || contact.depth <= N::ZERO, "lifted points: {}", here());
    }
    for [x, z] in [[-HALF, -HALF], [-HALF, HALF], [HALF, -HALF], [HALF, HALF]] {
        let corner = Point::<N, 3>::from([x, -HALF, z].map(N::lit));
        let corner: Point<N, 3> = pose.transform_point(&corner);
        let is_there = all().any(|contact| (contact.world2 - corner).norm() <= N::lit(1e-3));
        assert!(is_there || corner.y > N::ZERO, "no contact at {corner:?}: {}", here());
    }
}

/// Runs [`rests_on_its_corners`] on each floor, for 16 directions of the tilt.
fn rest_on_their_corners<N: Space<3, Isometry = Isometry3<N>>>(
    solids: &[TriMesh<N, 3>],
    tilt: f64,
    height: f64,
) {
    for floor in &floors3::<N>() {
        for (solid, direction) in
            solids.iter().flat_map(|solid| (0..16_u32).map(move |at| (solid, at)))
        {
            let angle = f64::from(direction) * core::f64::consts::TAU / 16.0 + 0.1;
            let pose = tilted::<N>([0.1, height, 0.07], angle, tilt);
            rests_on_its_corners(&**floor, solid, &pose);
        }
    }
}

fn tilted_crates<N: Space<3, Isometry = Isometry3<N>>>() {
    let solids = [crate3::<N>().solid(), crate3::<N>().one_sided()];
    for tilt in [0.0, 1e-14, 1e-9, 1e-6, 1e-5, 1e-4, 1e-3] {
        for height in [0.499, 0.49] {
            rest_on_their_corners(&solids, tilt, height);
        }
    }
}

#[test]
fn tilted_crates_rest_on_all_corners() {
    tilted_crates::<f64>();
    tilted_crates::<f32>();
}

fn rocking_crates<N: Space<3, Isometry = Isometry3<N>>>() {
    for tilt in [1e-3, 2e-3, 1e-2] {
        for height in [0.4999, 0.5, 0.5001] {
            rest_on_their_corners(&[crate3::<N>().solid()], tilt, height);
        }
    }
}

#[test]
fn crates_that_rock_are_not_pulled_down() {
    rocking_crates::<f64>();
    rocking_crates::<f32>();
}

/// Asserts that a square that is slightly tilted has two contacts with a floor, at its corners.
fn rests_on_both_corners<N: Space<2, Isometry = Isometry2<N>>>(
    floor: &Polyline<N, 2>,
    solid: &Polyline<N, 2>,
    tilt: f64,
) {
    let (at, turn) = ([0.1, 0.499].map(N::lit), UnitComplex::new(N::lit(tilt)));
    let pose = Isometry2::from_parts(Translation::from(Vector::<N, 2>::from(at)), turn);
    let (here, prediction) =
        (Isometry2::identity(), ContactPrediction::new(N::lit(0.01), N::ZERO, N::ZERO));
    let found = contact_manifolds(&here, floor, &pose, solid, &prediction, None);
    let all = || found.iter().flat_map(ContactManifold::contacts).map(|tracked| &tracked.contact);
    assert!(all().all(|contact| contact.normal.y > N::lit(0.99)), "{tilt}: {found:?}");
    let place = |point: &Point<N, 2>| pose.inverse_transform_point(point).x;
    let mut along: Vec<N> = all().map(|contact| place(&contact.world2)).collect();
    along.sort_by(|a, b| a.partial_cmp(b).expect("finite"));
    let is_corner = |x: N, corner: f64| (x - N::lit(corner)).abs() < N::lit(1e-3);
    let stands = along.len() == 2 && is_corner(along[0], -HALF) && is_corner(along[1], HALF);
    assert!(stands, "{tilt}: {along:?} {floor:?} {solid:?} {found:?}");
}

fn tilted_square<N: Space<2, Isometry = Isometry2<N>>>() {
    let line = || Polyline::open([[2.0, 0.0], [-2.0, 0.0]].map(point2).to_vec());
    let corners = [[-2.0, -1.0], [2.0, -1.0], [2.0, 0.0], [-2.0, 0.0]];
    let block = Polyline::closed(corners.map(point2).to_vec()).solid();
    for floor in [line(), line().one_sided(), block] {
        for solid in [square::<N>().solid(), square::<N>().one_sided()] {
            for tilt in [0.0, 1e-14, 1e-9, 1e-6, 1e-5, 1e-4, 1e-3] {
                rests_on_both_corners(&floor, &solid, tilt);
                rests_on_both_corners(&floor, &solid, -tilt);
            }
        }
    }
}

#[test]
fn tilted_squares_rest_on_both_corners() {
    tilted_square::<f64>();
    tilted_square::<f32>();
}

/// Asserts that a crate whose lowest corner is `depth` below a floor, at `x` and `z`, is pushed up.
fn is_pushed_up<N: Space<3, Isometry = Isometry3<N>>>(
    floor: &dyn Shape<N, 3>,
    solid: &TriMesh<N, 3>,
    depth: f64,
    [x, z]: [f64; 2],
) {
    let axis = Vector::<N, 3>::from([1.0, 1.0, 1.0].map(N::lit));
    let down = -Vector::<N, 3>::y();
    let turn = UnitQuaternion::rotation_between(&axis, &down).expect("not opposite");
    let at = [x, HALF * 3.0_f64.sqrt() - depth, z].map(N::lit);
    let pose = Isometry3::from_parts(Translation::from(Vector::<N, 3>::from(at)), turn);
    let found =
        contact(&Isometry3::identity(), floor, &pose, solid, N::ZERO).expect("they overlap");
    let error = (found.depth - N::lit(depth)).abs();
    let is_right = error <= N::lit(64.0) * N::EPSILON && found.normal.y > N::lit(0.99);
    assert!(is_right, "{depth} at {x}, {z} in {floor:?}: {found:?} of {solid:?}");
    for manifold in on_floor(floor, solid, &pose) {
        let up = manifold.contacts()[0].contact.normal.y;
        assert!(up > N::lit(0.99), "{depth} at {x}, {z} in {floor:?}: {manifold:?}");
    }
}

fn lands_on_a_corner<N: Space<3, Isometry = Isometry3<N>>>() {
    for solid in [crate3::<N>(), crate3().one_sided(), crate3().solid()] {
        // Hollow crates that are deeper may have contacts with inner edges of the floor.
        let deepest = if solid.is_solid() { 0.05 } else { 0.02 };
        for floor in &floors3::<N>() {
            for depth in [1e-4, 0.01, deepest] {
                // The corner is above the centroid of a triangle of the grid, and beside it.
                for place in [[1.0 / 6.0, 1.0 / 3.0], [1.0 / 3.0, 1.0 / 6.0], [0.2, 0.3]] {
                    is_pushed_up(&**floor, &solid, depth, place);
                }
            }
        }
    }
}

#[test]
fn crates_that_land_on_a_corner_are_pushed_up() {
    lands_on_a_corner::<f64>();
    lands_on_a_corner::<f32>();
}

fn corner_in_a_side<N: Space<2, Isometry = Isometry2<N>>>() {
    let lines: [fn(Polyline<N, 2>) -> Polyline<N, 2>; 3] =
        [|line| line, Polyline::one_sided, Polyline::solid];
    let half = N::lit(core::f64::consts::FRAC_PI_4);
    for of in lines {
        let (first, second) = (of(square()), of(square()));
        for depth in [1e-4, 0.01, 0.05] {
            // A square turned by 45° enters the corner of another with the middle of a side.
            let reach = HALF * (1.0 + 2.0_f64.sqrt()) - depth;
            let offset = reach / 2.0_f64.sqrt();
            let at = Vector::<N, 2>::from([N::lit(offset); 2]);
            let pose = Isometry2::from_parts(Translation::from(at), UnitComplex::new(half));
            let here = Isometry2::<N>::identity();
            let found = contact(&here, &first, &pose, &second, N::ZERO).expect("they overlap");
            let error = (found.depth - N::lit(depth)).abs();
            let is_right = error <= N::lit(64.0) * N::EPSILON
                && found.normal.x > N::lit(0.7)
                && found.normal.y > N::lit(0.7);
            assert!(is_right, "{depth}: {found:?} of {first:?}");
        }
    }
}

#[test]
fn corners_in_sides_are_pushed_out() {
    corner_in_a_side::<f64>();
    corner_in_a_side::<f32>();
}
