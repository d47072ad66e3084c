//! Tests shapes inside a solid mesh: parts of composites, cavities, and solid meshes as parts of
//! compounds.

use super::{P3, Soup, V3, at, ball, cuboid, inverted, joined, skin, solid};

use impinge::math::{Isometry3, Vector};
use impinge::query::{Proximity, contact, distance, proximity, witness};
use impinge::shape::{
    Ball, Compound, Cuboid, HalfSpace, HeightField, Shape, ShapeHandle, TriMesh, Triangle,
};

type Found = Option<(f64, Vector<f64, 3>)>;

/// Returns the distance, and the depth and normal of the contact with prediction 0. Asserts that
/// both orders agree.
fn between(one: &dyn Shape<f64, 3>, place: [f64; 3], other: &dyn Shape<f64, 3>) -> (f64, Found) {
    let (here, there) = (Isometry3::identity(), at(place));
    let near = distance(&here, one, &there, other);
    assert_eq!(near, distance(&there, other, &here, one), "in both roles");
    let found = contact(&here, one, &there, other, 0.0);
    let back = contact(&there, other, &here, one, 0.0).map(|found| found.flipped());
    assert_eq!(found, back, "in both roles");
    let touches = proximity(&here, one, &there, other, 0.0) == Proximity::Intersecting;
    assert_eq!((touches, touches), (near == 0.0, found.is_some()), "{found:?}");
    (near, found.map(|found| (found.depth, found.normal.into_inner())))
}

fn block() -> Soup<f64> {
    cuboid([4.0; 3], [0.0; 3])
}

#[test]
fn a_part_inside_is_enough() {
    let small = || ShapeHandle::new(Ball::new(0.25));
    let pair = Compound::new(vec![(at([0.0; 3]), small()), (at([20.0, 0.0, 0.0]), small())]);
    let body = solid(block());
    let (near, found) = between(&body, [3.0, 0.0, 0.0], &pair);
    assert_eq!((near, found), (0.0, Some((1.25, V3::x()))), "the other ball is far outside");
    let seen = witness(&at([0.0; 3]), &body, &at([3.0, 0.0, 0.0]), &pair, 1.0).expect("near");
    assert_eq!((seen.distance, seen.part2), (-1.25, 0));
    // A part that crosses the surface and a part that is deep inside: the contact is that of the
    // deeper part.
    let pair = Compound::new(vec![(at([0.0; 3]), small()), (at([4.0, 0.0, 0.0]), small())]);
    let (_, found) = between(&body, [0.0, 2.0, 0.0], &pair);
    assert_eq!(found, Some((2.25, V3::y())));
    assert_eq!(between(&body, [-12.0, 0.0, 0.0], &pair).0, 3.75, "apart");
}

#[test]
fn surfaces_inside_are_as_deep_as_a_whole() {
    let body = solid(block());
    for inner in [skin(cuboid([0.5, 1.0, 1.0], [0.0; 3])), solid(cuboid([0.5, 1.0, 1.0], [0.0; 3]))]
    {
        let (near, found) = between(&body, [3.0, 0.0, 0.0], &inner);
        assert_eq!((near, found), (0.0, Some((1.5, V3::x()))), "not only its nearest triangle");
    }
    // Two surfaces in one mesh, of which one is outside the solid.
    let apart = joined(&[cuboid([0.5; 3], [0.0; 3]), cuboid([0.5; 3], [30.0, 0.0, 0.0])]);
    let (near, found) = between(&body, [0.0, -3.0, 0.0], &skin(apart));
    assert_eq!((near, found), (0.0, Some((1.5, -V3::y()))));
    let flat = HeightField::<f64, 3>::new(2, 2, vec![0.0; 4], V3::new(1.0, 1.0, 1.0));
    let (near, found) = between(&body, [0.0, 3.5, 0.0], &flat);
    assert_eq!((near, found), (0.0, Some((0.5, V3::y()))));
    let sheet = Triangle::new(P3::origin(), P3::new(0.5, 0.0, 0.0), P3::new(0.0, 0.0, 0.5));
    assert_eq!(between(&body, [0.0, 3.5, 0.0], &sheet), (0.0, Some((0.5, V3::y()))));
}

#[test]
fn cavities_are_outside() {
    let hollow = solid(joined(&[block(), inverted(cuboid([2.0; 3], [0.0; 3]))]));
    let small = Ball::new(0.25);
    assert_eq!(between(&hollow, [0.0; 3], &small), (1.75, None), "in the cavity");
    assert_eq!(
        between(&hollow, [2.5, 0.0, 0.0], &small),
        (0.0, Some((0.75, -V3::x()))),
        "in the wall"
    );
    assert_eq!(between(&hollow, [3.5, 0.0, 0.0], &small), (0.0, Some((0.75, V3::x()))), "outwards");
    assert_eq!(
        between(&hollow, [1.875, 0.0, 0.0], &small),
        (0.0, Some((0.125, -V3::x()))),
        "sunk in"
    );
    assert_eq!(between(&hollow, [4.125, 0.0, 0.0], &small), (0.0, Some((0.125, V3::x()))));
    // A solid mesh in the cavity, and the same solid mesh in the wall.
    let crate_ = solid(cuboid([0.5; 3], [0.0; 3]));
    assert_eq!(between(&hollow, [0.0; 3], &crate_), (1.5, None));
    assert_eq!(between(&hollow, [3.25, 0.0, 0.0], &crate_), (0.0, Some((1.25, V3::x()))));
}

#[test]
fn bodies_that_overlap_or_lie_within_each_other() {
    let small = Ball::new(0.25);
    let nested = solid(joined(&[block(), cuboid([1.0; 3], [0.0; 3])]));
    let (near, found) = between(&nested, [1.5, 0.0, 0.0], &small);
    assert_eq!((near, found), (0.0, Some((2.75, V3::x()))), "the inner wall is no way out");
    let cross =
        solid(joined(&[cuboid([4.0, 1.0, 1.0], [0.0; 3]), cuboid([1.0, 4.0, 1.5], [0.0; 3])]));
    let (_, found) = between(&cross, [0.0, 0.125, 0.0], &small);
    assert!(found.expect("inside of both").0 >= 1.25, "{found:?}");
}

#[test]
fn compounds_that_hold_bodies() {
    let body = ShapeHandle::new(solid(cuboid::<f64>([2.0; 3], [0.0; 3])));
    let turned = Isometry3::new(V3::new(10.0, 0.0, 0.0), V3::z() * std::f64::consts::FRAC_PI_2);
    let pair = Compound::new(vec![
        (at([0.0; 3]), ShapeHandle::new(Ball::new(1.0))),
        (turned, body),
        (at([-10.0, 0.0, 0.0]), ShapeHandle::new(skin(cuboid([2.0; 3], [0.0; 3])))),
    ]);
    let nested = Compound::new(vec![(at([0.0, 5.0, 0.0]), ShapeHandle::new(pair.clone()))]);
    let small = Cuboid::new(V3::repeat(0.25));
    for (shape, up) in [(&pair as &dyn Shape<f64, 3>, 0.0), (&nested, 5.0)] {
        let (near, found) = between(shape, [11.0, up, 0.0], &small);
        let (depth, normal) = found.expect("inside of the child");
        assert_eq!(near, 0.0);
        assert!(
            (depth - 1.25).abs() < 1e-12 && (normal - V3::x()).norm() < 1e-12,
            "{depth} {normal}"
        );
        let near = between(shape, [-9.0, up, 0.0], &small).0;
        assert_eq!(near, 0.75, "the other child is a skin");
    }
    // The compound inside a solid mesh, with the mesh as either shape.
    let shell = solid(cuboid([30.0; 3], [0.0; 3]));
    assert_eq!(between(&shell, [0.0; 3], &pair).0, 0.0);
}

#[test]
fn half_spaces_have_no_inside_in_a_body() {
    let (body, ground) = (solid(block()), HalfSpace::new(Vector::y_axis()));
    assert_eq!(between(&body, [0.0, -5.0, 0.0], &ground), (1.0, None));
    let (near, found) = between(&body, [0.0, 9.0, 0.0], &ground);
    assert_eq!((near, found), (0.0, Some((13.0, -V3::y()))), "wholly below the ground");
}

#[test]
fn sides_of_a_body_are_outside() {
    let (body, small) = (solid(block()), Ball::new(0.5));
    // While the ball overlaps the surface, it does not matter on which side its centre is.
    for (place, depth) in [(4.25, 0.25), (3.75, 0.75), (3.5, 1.0), (3.25, 1.25)] {
        assert_eq!(
            between(&body, [place, 0.0, 0.0], &small),
            (0.0, Some((depth, V3::x()))),
            "{place}"
        );
    }
    // A plate thinner than the ball: the contact is along the shorter way out.
    let plate = solid(cuboid([4.0, 0.0625, 4.0], [0.0; 3]));
    for (place, depth, up) in [(0.5, 0.0625, 1.0), (0.25, 0.3125, 1.0), (-0.125, 0.4375, -1.0)] {
        let found = between(&plate, [0.3, place, 0.1], &small).1;
        assert_eq!(found, Some((depth, V3::y() * up)), "{place}");
    }
    // A ball near the outside of one face lies behind the other faces, which are also within the
    // prediction.
    let (here, there) = (at([0.0; 3]), at([0.3, 0.75, 0.1]));
    let found = contact(&here, &plate, &there, &small, 5.0).expect("near");
    assert_eq!((found.depth, found.normal.y), (-0.1875, 1.0));
}

#[test]
fn slivers_and_doubled_triangles() {
    let (corners, mut triangles) = block();
    // Adds a triangle and its reverse, and triangles without area along an edge, all with existing
    // corners.
    let [a, b, c] = triangles[0];
    triangles.extend([[a, b, c], [a, c, b], [a, b, b], [b, a, a]]);
    let body = TriMesh::new(corners, triangles).solid();
    let (near, found) = between(&body, [3.0, 0.0, 0.0], &Ball::new(0.25));
    assert_eq!((near, found.map(|found| found.0)), (0.0, Some(1.25)));
    let fine = solid(ball::<f64>(1.0, 32));
    assert_eq!(between(&fine, [0.01, 0.0, 0.0], &Ball::new(1e-9)).0, 0.0);
    let needle: Soup<f64> = cuboid([1e-7, 4.0, 1e-7], [0.0; 3]);
    assert_eq!(between(&solid(needle), [0.0; 3], &Ball::new(1e-9)).0, 0.0);
}
