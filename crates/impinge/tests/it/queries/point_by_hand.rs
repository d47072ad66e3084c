//! Tests queries of points whose results are computed by hand.

use impinge::math::{Isometry2, Isometry3, Point, Real, Space, Unit, Vector};
use impinge::query::PointQuery;
use impinge::shape::{
    Ball, Capsule, Cone, Cuboid, Cylinder, FeatureId, Plane, Segment, Shape, Triangle,
};

use FeatureId::{Edge, Face, Vertex};

type P2 = Point<f64, 2>;
type P3 = Point<f64, 3>;
type V2 = Vector<f64, 2>;
type V3 = Vector<f64, 3>;

/// A point, whether it is inside, the nearest point of the boundary and the feature there.
type Case<const D: usize> = ([f64; D], bool, [f64; D], FeatureId);

fn check<const D: usize>(shape: &dyn Shape<f64, D>, cases: &[Case<D>])
where
    f64: Space<D>,
{
    for &(asked, is_inside, nearest, feature) in cases {
        let (found, on) = shape.project_local_point(&Point::from(asked));
        let what = format!("{shape:?} at {asked:?}: {found:?} {on:?}");
        let off = (found.point - Point::from(nearest)).norm();
        assert!(off <= 1e-15 * (1.0 + Point::from(nearest).coords.norm()), "{what}");
        assert_eq!((found.is_inside, on), (is_inside, feature), "{what}");
    }
}

#[test]
fn balls() {
    check::<2>(
        &Ball::new(1.0),
        &[
            ([3.0, 0.0], false, [1.0, 0.0], Face(0)),
            ([0.0, -0.25], true, [0.0, -1.0], Face(0)),
            ([0.0, 1.0], true, [0.0, 1.0], Face(0)),
            ([0.0, 0.0], true, [1.0, 0.0], Face(0)),
        ],
    );
    check::<3>(
        &Ball::new(5.0),
        &[
            ([6.0, 0.0, 8.0], false, [3.0, 0.0, 4.0], Face(0)),
            ([0.0, 0.0, 0.0], true, [5.0, 0.0, 0.0], Face(0)),
        ],
    );
    check::<3>(
        &Ball::new(0.0),
        &[
            ([6.0, 0.0, 8.0], false, [0.0, 0.0, 0.0], Face(0)),
            ([0.0, 0.0, 0.0], true, [0.0, 0.0, 0.0], Face(0)),
        ],
    );
}

#[test]
fn cuboids() {
    check::<2>(
        &Cuboid::new(V2::new(1.0, 2.0)),
        &[
            ([3.0, 1.0], false, [1.0, 1.0], Face(0)),
            ([-3.0, 1.0], false, [-1.0, 1.0], Face(1)),
            ([3.0, -4.0], false, [1.0, -2.0], Vertex(1)),
            ([3.0, 4.0], false, [1.0, 2.0], Vertex(3)),
            ([0.5, 1.75], true, [0.5, 2.0], Face(2)),
            ([0.0, -1.5], true, [0.0, -2.0], Face(3)),
            ([0.0, 0.0], true, [1.0, 0.0], Face(0)),
            ([1.0, 2.0], true, [1.0, 2.0], Face(0)),
        ],
    );
    check::<3>(
        &Cuboid::new(V3::new(1.0, 2.0, 3.0)),
        &[
            ([2.0, 0.0, 0.0], false, [1.0, 0.0, 0.0], Face(0)),
            ([0.0, 0.0, -4.0], false, [0.0, 0.0, -3.0], Face(5)),
            ([0.5, 3.0, -4.0], false, [0.5, 2.0, -3.0], Edge(1)),
            ([2.0, 0.5, 4.0], false, [1.0, 0.5, 3.0], Edge(4 + 3)),
            ([2.0, -3.0, 0.5], false, [1.0, -2.0, 0.5], Edge(8 + 1)),
            ([-2.0, 3.0, 4.0], false, [-1.0, 2.0, 3.0], Vertex(6)),
            ([-0.5, 0.0, 0.0], true, [-1.0, 0.0, 0.0], Face(1)),
        ],
    );
    check::<2>(
        &Cuboid::new(V2::new(0.0, 1.0)),
        &[([0.0, 0.5], true, [0.0, 0.5], Face(0)), ([2.0, 0.5], false, [0.0, 0.5], Face(0))],
    );
}

#[test]
fn half_spaces() {
    let normal = Unit::new_unchecked(V2::new(0.6, 0.8));
    check::<2>(
        &Plane::new(normal),
        &[
            ([3.0, 4.0], false, [0.0, 0.0], Face(0)),
            ([-3.0, -4.0], true, [0.0, 0.0], Face(0)),
            ([0.0, 0.0], true, [0.0, 0.0], Face(0)),
        ],
    );
}

#[test]
fn segments() {
    check::<2>(
        &Segment::new(P2::new(0.0, 0.0), P2::new(2.0, 0.0)),
        &[
            ([1.0, 3.0], false, [1.0, 0.0], Edge(0)),
            ([-1.0, 3.0], false, [0.0, 0.0], Vertex(0)),
            ([5.0, 0.0], false, [2.0, 0.0], Vertex(1)),
            ([0.5, 0.0], true, [0.5, 0.0], Edge(0)),
            ([2.0, 0.0], true, [2.0, 0.0], Vertex(1)),
        ],
    );
    let point = P3::new(1.0, 1.0, 1.0);
    check::<3>(
        &Segment::new(point, point),
        &[
            ([1.0, 3.0, 1.0], false, [1.0, 1.0, 1.0], Vertex(0)),
            ([1.0, 1.0, 1.0], true, [1.0, 1.0, 1.0], Vertex(0)),
        ],
    );
}

#[test]
fn capsules() {
    check::<2>(
        &Capsule::new(1.0, 0.5),
        &[
            ([3.0, 0.5], false, [0.5, 0.5], Edge(0)),
            ([0.0, 3.0], false, [0.0, 1.5], Vertex(1)),
            ([0.0, -3.0], false, [0.0, -1.5], Vertex(0)),
            ([-0.25, 0.0], true, [-0.5, 0.0], Edge(0)),
            ([0.0, 0.5], true, [0.5, 0.5], Edge(0)),
            ([0.0, 1.5], true, [0.0, 1.5], Vertex(1)),
        ],
    );
    check::<3>(&Capsule::new(0.0, 2.0), &[([0.0, 0.0, 0.0], true, [2.0, 0.0, 0.0], Vertex(0))]);
    check::<3>(
        &Capsule::new(1.0, 0.0),
        &[
            ([1.0, 0.0, 0.0], false, [0.0, 0.0, 0.0], Edge(0)),
            ([0.0, 0.5, 0.0], true, [0.0, 0.5, 0.0], Edge(0)),
        ],
    );
}

#[test]
fn triangles_of_the_plane() {
    let [a, b, c] = [P2::new(0.0, 0.0), P2::new(4.0, 0.0), P2::new(0.0, 4.0)];
    check::<2>(
        &Triangle::new(a, b, c),
        &[
            ([1.0, -2.0], false, [1.0, 0.0], Face(0)),
            ([1.0, 0.5], true, [1.0, 0.0], Face(0)),
            ([0.5, 1.0], true, [0.0, 1.0], Face(2)),
            ([4.0, 4.0], false, [2.0, 2.0], Face(1)),
            ([-1.0, -1.0], false, [0.0, 0.0], Vertex(0)),
            ([5.0, 0.0], false, [4.0, 0.0], Vertex(1)),
            ([2.0, 2.0], true, [2.0, 2.0], Face(1)),
            ([4.0, 0.0], true, [4.0, 0.0], Vertex(1)),
        ],
    );
    check::<2>(
        &Triangle::new(a, P2::new(1.0, 1.0), P2::new(2.0, 2.0)),
        &[
            ([1.5, 1.5], true, [1.5, 1.5], Face(1)),
            ([3.0, 3.0], false, [2.0, 2.0], Vertex(2)),
            ([1.5, 0.5], false, [1.0, 1.0], Vertex(1)),
        ],
    );
}

#[test]
fn triangles_of_space() {
    let [a, b, c] = [P3::new(0.0, 0.0, 0.0), P3::new(4.0, 0.0, 0.0), P3::new(0.0, 4.0, 0.0)];
    check::<3>(
        &Triangle::new(a, b, c),
        &[
            ([1.0, 1.0, 3.0], false, [1.0, 1.0, 0.0], Face(0)),
            ([1.0, 1.0, -3.0], false, [1.0, 1.0, 0.0], Face(1)),
            ([1.0, -1.0, 1.0], false, [1.0, 0.0, 0.0], Edge(0)),
            ([4.0, 4.0, 1.0], false, [2.0, 2.0, 0.0], Edge(1)),
            ([5.0, 0.0, 1.0], false, [4.0, 0.0, 0.0], Vertex(1)),
            ([1.0, 1.0, 0.0], true, [1.0, 1.0, 0.0], Face(0)),
        ],
    );
    check::<3>(
        &Triangle::new(a, b, P3::new(2.0, 0.0, 0.0)),
        &[
            ([1.0, 1.0, 0.0], false, [1.0, 0.0, 0.0], Edge(0)),
            ([5.0, 1.0, 0.0], false, [4.0, 0.0, 0.0], Vertex(1)),
        ],
    );
}

#[test]
fn cylinders() {
    check::<3>(
        &Cylinder::new(1.0, 2.0),
        &[
            ([5.0, 0.5, 0.0], false, [2.0, 0.5, 0.0], Face(2)),
            ([0.5, 3.0, 0.0], false, [0.5, 1.0, 0.0], Face(0)),
            ([0.0, -3.0, 0.0], false, [0.0, -1.0, 0.0], Face(1)),
            ([3.0, 2.0, 4.0], false, [1.2, 1.0, 1.6], Edge(0)),
            ([3.0, -2.0, 4.0], false, [1.2, -1.0, 1.6], Edge(1)),
            ([0.0, 0.25, 1.75], true, [0.0, 0.25, 2.0], Face(2)),
            ([0.0, 0.25, 0.5], true, [0.0, 1.0, 0.5], Face(0)),
            ([0.0, 0.0, 0.0], true, [0.0, 1.0, 0.0], Face(0)),
        ],
    );
    check::<3>(&Cylinder::new(3.0, 1.0), &[([0.0, 0.0, 0.0], true, [1.0, 0.0, 0.0], Face(2))]);
}

#[test]
fn cones() {
    // The slant falls by 4 over 3, so its normal is (4, 3) / 5: a point at an offset of (4, 3) from
    // it is 5 away.
    check::<3>(
        &Cone::new(2.0, 3.0),
        &[
            ([0.0, 5.0, 0.0], false, [0.0, 2.0, 0.0], Vertex(0)),
            ([1.0, -5.0, 0.0], false, [1.0, -2.0, 0.0], Face(0)),
            ([5.0, -3.0, 0.0], false, [3.0, -2.0, 0.0], Edge(0)),
            ([1.5 + 4.0, 3.0, 0.0], false, [1.5, 0.0, 0.0], Face(1)),
            ([0.0, 3.0, 1.5 + 4.0], false, [0.0, 0.0, 1.5], Face(1)),
            ([0.0, -1.75, 0.0], true, [0.0, -2.0, 0.0], Face(0)),
            ([1.5, 0.0, 0.0], true, [1.5, 0.0, 0.0], Face(1)),
            ([0.0, 2.0, 0.0], true, [0.0, 2.0, 0.0], Vertex(0)),
        ],
    );
    check::<3>(
        &Cone::new(0.0, 1.0),
        &[
            ([0.5, 2.0, 0.0], false, [0.5, 0.0, 0.0], Face(0)),
            ([0.5, 0.0, 0.0], true, [0.5, 0.0, 0.0], Face(0)),
        ],
    );
}

/// Asserts that the point at 0.9 of the radius and the half height is outside a cone of any size, and
/// that the point at 0.25 of both is inside.
fn check_cones<N: Real>(sizes: &[f64]) {
    for &size in sizes {
        let cone = Cone::new(N::lit(size), N::lit(size));
        let at = |share: f64| {
            let along = N::lit(share * size);
            cone.contains_local_point(&Point::<N, 3>::new(along, along, N::ZERO))
        };
        assert!(!at(0.9) && at(0.25), "{size}: {} {}", at(0.9), at(0.25));
    }
}

#[test]
fn points_beside_very_large_and_small_cones_are_outside() {
    check_cones::<f32>(&[1e-37, 1e-23, 1.0, 1e20, 3e38]);
    check_cones::<f64>(&[1e-307, 1e-200, 1.0, 1e200, 1e308]);
}

#[test]
fn answers_are_in_the_world() {
    let quarter = Isometry2::new(V2::new(10.0, 0.0), std::f64::consts::FRAC_PI_2);
    let cuboid = Cuboid::new(V2::new(1.0, 2.0));
    let outside = P2::new(14.0, 0.5);
    let found = cuboid.project_point(&quarter, &outside, true);
    assert!((found.point - P2::new(12.0, 0.5)).norm() < 1e-14, "{found:?}");
    assert!((cuboid.distance_to_point(&quarter, &outside, true) - 2.0).abs() < 1e-14, "outside");
    let inside = P2::new(11.5, 0.25);
    assert_eq!(cuboid.project_point(&quarter, &inside, true).point, inside, "its own projection");
    assert_eq!(cuboid.distance_to_point(&quarter, &inside, true), 0.0, "solid");
    let hollow = cuboid.distance_to_point(&quarter, &inside, false);
    assert!((hollow + 0.5).abs() < 1e-14, "{hollow} is minus the depth");
    assert!(cuboid.contains_point(&quarter, &inside), "it is inside");
    let (found, feature) = cuboid.project_point_with_feature(&quarter, &inside);
    assert!((found.point - P2::new(12.0, 0.25)).norm() < 1e-14, "{found:?}");
    assert_eq!(feature, Face(3), "the side that was down");
}

#[test]
fn points_that_are_not_finite_are_in_nothing() {
    let m = Isometry3::identity();
    let shapes: [&dyn Shape<f64, 3>; 5] = [
        &Ball::new(1.0),
        &Capsule::new(1.0, 1.0),
        &Cuboid::new(V3::new(1.0, 1.0, 1.0)),
        &Cylinder::new(1.0, 1.0),
        &Cone::new(1.0, 1.0),
    ];
    for shape in shapes {
        for bad in [f64::NAN, f64::INFINITY] {
            let point = P3::new(0.0, bad, 0.0);
            assert!(!shape.contains_point(&m, &point), "{shape:?} holds {bad}");
        }
    }
}
