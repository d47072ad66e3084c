//! Solids that are wide at their base, at the foot of a wall and in valleys. The deepest corner of
//! such a solid along the normal of the wall is below the wall; the wall stops the solid anyway.

use impinge::math::na::{Translation, UnitComplex, UnitQuaternion};
use impinge::math::{Isometry2, Isometry3, Point, Space, Vector};
use impinge::narrow_phase::{
    ContactManifoldGenerator, ContactPrediction, DefaultContactDispatcher, IdAllocator,
    PairManifoldGenerator, contact_manifolds,
};
use impinge::query::{ContactId, ContactManifold};
use impinge::shape::{Cone, ConvexHull, ConvexPolygon, Cuboid, Polyline, Shape, TriMesh};

/// Returns a floor in the plane y = 0 left of a wall in the plane x = 0.
fn floor_and_wall<N: Space<3>>() -> TriMesh<N, 3> {
    let corners = [
        [-4.0, 0.0, -4.0],
        [-4.0, 0.0, 4.0],
        [0.0, 0.0, 4.0],
        [0.0, 0.0, -4.0],
        [0.0, 3.0, 4.0],
        [0.0, 3.0, -4.0],
    ];
    let vertices = corners.map(|at| Point::from(at.map(N::lit))).to_vec();
    TriMesh::new(vertices, vec![[0, 1, 2], [0, 2, 3], [3, 2, 4], [3, 4, 5]])
}

/// Asserts that a solid with the radius `radius` about the vertical axis and the half height `half`
/// touches the floor and the wall, if it is `sunk` below the floor and reaches the wall by `beyond`.
fn touches_both<N: Space<3, Isometry = Isometry3<N>>>(
    solid: &dyn Shape<N, 3>,
    [radius, half]: [f64; 2],
    yaw: f64,
    [sunk, beyond]: [f64; 2],
) {
    let turn = UnitQuaternion::from_axis_angle(&Vector::<N, 3>::y_axis(), N::lit(yaw));
    let at = Vector::<N, 3>::from([beyond - radius, half - sunk, 0.1].map(N::lit));
    let pose = Isometry3::from_parts(Translation::from(at), turn);
    let prediction = ContactPrediction::new(N::ZERO, N::ZERO, N::ZERO);
    for surface in [floor_and_wall::<N>(), floor_and_wall().one_sided()] {
        let here = Isometry3::identity();
        let found = contact_manifolds(&here, &surface, &pose, solid, &prediction, None);
        let all = || found.iter().flat_map(ContactManifold::contacts).map(|one| &one.contact);
        let name = || format!("{solid:?} turned {yaw}, sunk {sunk}, beyond {beyond}: {found:?}");
        let deepest = |axis: usize, sign: f64| {
            let along = all().filter(|found| found.normal[axis] * N::lit(sign) > N::lit(0.99));
            along.fold(-N::ONE, |best, found| if found.depth > best { found.depth } else { best })
        };
        let (floor, wall) = (deepest(1, 1.0), deepest(0, -1.0));
        let noise = N::lit(64.0) * N::EPSILON;
        assert!((floor - N::lit(sunk)).abs() <= noise, "floor {floor} {}", name());
        let is_right = wall > N::lit(0.3 * beyond) && wall <= N::lit(beyond) + noise;
        assert!(is_right, "wall {wall} {}", name());
        for found in all() {
            let is_of_face = found.normal.y > N::lit(0.99) || found.normal.x < N::lit(-0.99);
            assert!(is_of_face, "{} {}", found.normal.into_inner(), name());
        }
    }
}

/// Returns a pyramid with a base of 1 by 1 and a height of 1.
fn pyramid<N: Space<3>>() -> ConvexHull<N> {
    let corners = [
        [-0.5, -0.5, -0.5],
        [-0.5, -0.5, 0.5],
        [0.5, -0.5, -0.5],
        [0.5, -0.5, 0.5],
        [0.0, 0.5, 0.0],
    ];
    let corners = corners.map(|at| Point::from(at.map(N::lit)));
    ConvexHull::try_from_points(&corners).expect("a solid")
}

fn at_a_wall<N: Space<3, Isometry = Isometry3<N>>>() {
    let (pyramid, cone) = (pyramid::<N>(), Cone::new(N::lit(0.5), N::HALF));
    for sunk in [1e-3, 1e-2] {
        for beyond in [0.05, 0.1, 0.25] {
            for yaw in [0.1_f64, 0.3, 0.6, core::f64::consts::FRAC_PI_4] {
                let radius = 0.5 * (yaw.cos() + yaw.sin());
                touches_both::<N>(&pyramid, [radius, 0.5], yaw, [sunk, beyond]);
            }
            touches_both::<N>(&cone, [0.5, 0.5], 0.0, [sunk, beyond]);
        }
    }
}

#[test]
fn wide_bases_touch_a_wall_at_its_foot() {
    at_a_wall::<f64>();
    at_a_wall::<f32>();
}

/// A pyramid and a cone that are pushed into a wall in small steps keep their contact with the wall:
/// it is there in each step, gets deeper by the step, and keeps an id.
fn pushed_into_a_wall<N: Space<3, Isometry = Isometry3<N>>>() {
    let (here, surface) = (Isometry3::identity(), floor_and_wall::<N>());
    let (pyramid, cone) = (pyramid::<N>(), Cone::new(N::HALF, N::HALF));
    let solids: [(&dyn Shape<N, 3>, f64); 4] =
        [(&pyramid, 0.0), (&pyramid, 0.1), (&pyramid, 0.7), (&cone, 0.0)];
    for (solid, yaw) in solids {
        let reach = if yaw > 0.0 { 0.5 * (yaw.cos() + yaw.sin()) } else { 0.5 };
        let (mut generator, mut ids) =
            (PairManifoldGenerator::<N, 3>::default(), IdAllocator::new());
        let dispatcher = DefaultContactDispatcher::<3>::new();
        let prediction = ContactPrediction::new(N::lit(0.002), N::ZERO, N::ZERO);
        let mut before: Option<(N, Vec<ContactId>)> = None;
        for step in 0..40 {
            let beyond = 0.02 + 0.005 * f64::from(step);
            let at = Vector::<N, 3>::from([beyond - reach, 0.499, 0.1].map(N::lit));
            let turn = UnitQuaternion::from_axis_angle(&Vector::<N, 3>::y_axis(), N::lit(yaw));
            let pose = Isometry3::from_parts(Translation::from(at), turn);
            generator.update(&dispatcher, &here, &surface, &pose, solid, &prediction, &mut ids);
            let mut found = Vec::new();
            generator.contacts(&mut found);
            let wall = found.iter().flat_map(|manifold| manifold.contacts());
            let wall = wall.filter(|one| one.contact.normal.x < N::lit(-0.99));
            let wall: Vec<_> = wall.collect();
            let depth = wall.iter().fold(-N::ONE, |best, one| one.contact.depth.max(best));
            let ids: Vec<_> = wall.iter().map(|one| one.id).collect();
            if let Some((last, old)) = before {
                let is_deeper = (depth - last - N::lit(0.005)).abs() < N::lit(1e-5);
                assert!(is_deeper, "{solid:?} turned {yaw}, step {step}: {last} {found:?}");
                let is_kept = ids.iter().any(|id| old.contains(id));
                assert!(is_kept, "{solid:?} turned {yaw}, step {step}: {old:?} {found:?}");
            }
            before = Some((depth, ids));
        }
    }
}

#[test]
fn wide_bases_keep_their_contact_with_a_wall() {
    pushed_into_a_wall::<f64>();
    pushed_into_a_wall::<f32>();
}

fn in_plane<N: Space<2, Isometry = Isometry2<N>>>() {
    let point = |at: [f64; 2]| Point::<N, 2>::from(at.map(N::lit));
    let prediction = ContactPrediction::new(N::ZERO, N::ZERO, N::ZERO);
    let here = Isometry2::<N>::identity();
    let corner = Polyline::open([[-4.0, 0.0], [0.0, 0.0], [0.0, 4.0]].map(point).to_vec());
    for half in [0.5, 1.0, 2.0] {
        let outline = [[-half, -0.5], [half, -0.5], [0.0, 0.5]].map(point);
        let wedge = ConvexPolygon::try_from_points(&outline).expect("a triangle");
        for (sunk, beyond) in [(1e-3, 0.25), (1e-3, 0.05), (1e-2, 0.1)] {
            let at = Vector::<N, 2>::from([beyond - half, 0.5 - sunk].map(N::lit));
            let pose = Isometry2::from_parts(Translation::from(at), UnitComplex::identity());
            let found = contact_manifolds(&here, &corner, &pose, &wedge, &prediction, None);
            let mut all = found.iter().flat_map(ContactManifold::contacts);
            let is_wall = |found: &impinge::query::Contact<N, 2>| {
                let is_deep = found.depth > N::lit(0.15 * beyond);
                found.normal.x < N::lit(-0.99) && is_deep && found.depth <= N::lit(beyond)
            };
            assert!(all.any(|one| is_wall(&one.contact)), "{half} {sunk} {beyond}: {found:?}");
        }
    }
    // A box with a corner down at the bottom of a valley.
    let tip = Cuboid::new(Vector::<N, 2>::repeat(N::HALF));
    for degrees in [1.0_f64, 5.0, 10.0, 20.0] {
        let (rise, slope) = (4.0 * degrees.to_radians().tan(), degrees.to_radians());
        let valley = [[-4.0, rise], [0.0, 0.0], [4.0, rise]].map(point);
        let valley = Polyline::open(valley.to_vec());
        for x in [0.0, 1e-4, 2e-3] {
            let at = Vector::<N, 2>::from([x, 0.5_f64.sqrt() - 0.01].map(N::lit));
            let turn = UnitComplex::new(N::lit(core::f64::consts::FRAC_PI_4));
            let pose = Isometry2::from_parts(Translation::from(at), turn);
            let found = contact_manifolds(&here, &valley, &pose, &tip, &prediction, None);
            let all = found.iter().flat_map(ContactManifold::contacts);
            let all: Vec<_> = all.map(|one| &one.contact).collect();
            assert!(!all.is_empty(), "{degrees} at {x}");
            for contact in all {
                let is_slope = (contact.normal.y - N::lit(slope.cos())).abs() < N::lit(1e-5);
                assert!(is_slope, "{degrees} at {x}: {found:?}");
                // At most the height of the plane of the slope above the corner.
                let most = 0.01 * slope.cos() + x * slope.sin() + 1e-6;
                let is_right = contact.depth > N::lit(0.005) && contact.depth <= N::lit(most);
                assert!(is_right, "{degrees} at {x}: {found:?}");
            }
        }
    }
}

#[test]
fn wide_bases_and_corners_in_valleys_of_lines() {
    in_plane::<f64>();
    in_plane::<f32>();
}
