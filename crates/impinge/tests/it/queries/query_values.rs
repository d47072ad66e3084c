//! Compares distances, contacts, proximities and times of impact of two solids with results
//! computed by hand.

use impinge::math::na::UnitQuaternion;
use impinge::math::{Isometry2, Isometry3, Point, Unit, Vector};
use impinge::query::{
    ClosestPoints, Proximity, closest_points, contact, distance, proximity, time_of_impact,
};
use impinge::shape::{Ball, Capsule, Cuboid, Plane, Segment, Shape, Triangle};

type V2 = Vector<f64, 2>;
type V3 = Vector<f64, 3>;

fn at(x: f64, y: f64) -> Isometry2<f64> {
    Isometry2::translation(x, y)
}

fn half_plane(x: f64, y: f64) -> Plane<f64, 2> {
    Plane::new(Unit::new_unchecked(V2::new(x, y)))
}

#[test]
fn balls() {
    let (small, large) = (Ball::new(1.0), Ball::new(2.0));
    assert_eq!(distance(&at(0.0, 0.0), &small, &at(3.0, 4.0), &large), 2.0, "5 less 3");
    let points = closest_points(&at(0.0, 0.0), &small, &at(5.0, 0.0), &large, 2.0);
    let expected =
        ClosestPoints::WithinMargin(Point::<f64, 2>::new(1.0, 0.0), Point::<f64, 2>::new(3.0, 0.0));
    assert_eq!(points, expected, "exactly two apart");
    let nearer = closest_points(&at(0.0, 0.0), &small, &at(5.0, 0.0), &large, 1.75);
    assert_eq!(nearer, ClosestPoints::Disjoint, "farther than asked");
    let found = contact(&at(0.0, 0.0), &small, &at(0.0, 2.0), &large, 0.0).expect("overlap");
    assert_eq!((found.depth, found.normal.y), (1.0, 1.0), "1 + 2 - 2");
    assert_eq!(found.world1, Point::<f64, 2>::new(0.0, 1.0), "the top of the first");
    assert_eq!(found.world2, Point::<f64, 2>::new(0.0, 0.0), "the bottom of the second");
    let middle = contact(&at(7.0, 7.0), &small, &at(7.0, 7.0), &large, 0.0).expect("overlap");
    assert_eq!((middle.depth, middle.normal.x), (3.0, 1.0), "along the first axis");
}

#[test]
fn a_ball_looks_the_same_however_it_is_turned() {
    let (ball, cuboid) = (Ball::new(1.0_f32), Cuboid::new(Vector::<f32, 3>::new(0.5, 1.0, 2.0)));
    let (away, turn) =
        (Vector::<f32, 3>::new(1.5, 1.0, -2.5), Vector::<f32, 3>::new(0.3, 2.0, 1.0));
    let straight = Isometry3::new(away, Vector::<f32, 3>::zeros());
    let turned = Isometry3::new(away, turn);
    let beside = Isometry3::new(-away, -turn);
    for shape in [&ball as &dyn Shape<f32, 3>, &cuboid] {
        let ask = |place| contact(place, &ball, &beside, shape, 9.0);
        assert_eq!(ask(&turned), ask(&straight), "{shape:?}");
        assert!(ask(&turned).is_some(), "within nine of {shape:?}");
        let way = -away * 2.0;
        let hit = |m1| time_of_impact(m1, &way, &ball, &beside, &Vector::<f32, 3>::zeros(), shape);
        assert_eq!(hit(&turned), hit(&straight), "{shape:?}");
    }
    let mut broken = turned;
    broken.rotation = UnitQuaternion::new_unchecked(broken.rotation.into_inner() * f32::NAN);
    assert_eq!(distance(&broken, &ball, &beside, &cuboid), f32::INFINITY, "no rotation");
    assert_eq!(contact(&beside, &ball, &broken, &ball, f32::INFINITY), None, "no rotation");
}

#[test]
fn touching_counts_and_limits_include_themselves() {
    let cuboid = Cuboid::new(V2::new(1.0, 1.0));
    let ask = |x: f64, margin: f64| proximity(&at(0.0, 0.0), &cuboid, &at(x, 0.0), &cuboid, margin);
    assert_eq!(ask(2.0, 0.0), Proximity::Intersecting, "touching");
    assert_eq!(ask(2.5, 0.5), Proximity::WithinMargin, "just at the margin");
    assert_eq!(ask(2.5, 0.25), Proximity::Disjoint, "beyond the margin");
    for margin in [-1.0, f64::NAN] {
        assert_eq!(ask(2.0, margin), Proximity::Intersecting, "{margin} counts as zero");
        assert_eq!(ask(2.5, margin), Proximity::Disjoint, "{margin} counts as zero");
    }
    let touch = contact(&at(0.0, 0.0), &cuboid, &at(2.0, 0.0), &cuboid, 0.0).expect("touching");
    assert_eq!((touch.depth, touch.normal.x), (0.0, 1.0), "no depth");
}

#[test]
fn predictions_below_zero_ask_for_depth() {
    let cuboid = Cuboid::new(V2::new(1.0, 1.0));
    let ask = |prediction: f64| contact(&at(0.0, 0.0), &cuboid, &at(1.5, 0.0), &cuboid, prediction);
    assert!(ask(-0.5).is_some(), "half a unit deep");
    assert!(ask(-0.75).is_none(), "but no deeper");
    assert!(ask(f64::NAN).is_none(), "nothing is within that");
}

#[test]
fn capsules_and_segments_against_a_ball() {
    let (ball, capsule) = (Ball::new(0.5), Capsule::<f64, 2>::new(1.0, 0.25));
    assert_eq!(distance(&at(2.0, 0.5), &ball, &at(0.0, 0.0), &capsule), 1.25, "beside");
    assert_eq!(distance(&at(3.0, 5.0), &ball, &at(0.0, 0.0), &capsule), 4.25, "3 out and 4 up");
    let segment = Segment::new(Point::<f64, 2>::new(-1.0, 0.0), Point::<f64, 2>::new(1.0, 0.0));
    let on = contact(&at(0.5, 0.0), &ball, &at(0.0, 0.0), &segment, 0.0).expect("overlap");
    assert_eq!((on.depth, on.normal.x), (0.5, 0.0), "it leaves the segment sideways");
}

#[test]
fn half_planes() {
    let (floor, ceiling, wall) =
        (half_plane(0.0, 1.0), half_plane(0.0, -1.0), half_plane(1.0, 0.0));
    let shapes: [(&dyn Shape<f64, 2>, f64); 3] = [
        (&Ball::new(1.0), 1.0),
        (&Cuboid::new(V2::new(3.0, 2.0)), 2.0),
        (&Capsule::<f64, 2>::new(2.0, 0.5), 2.5),
    ];
    for (shape, reach) in shapes {
        let above = distance(&at(9.0, 4.0), shape, &at(0.0, 0.0), &floor);
        assert_eq!(above, 4.0 - reach, "{shape:?}");
        let found = contact(&at(0.0, 0.0), &floor, &at(9.0, -1.0), shape, 0.0).expect("sunk in");
        assert_eq!((found.depth, found.normal.y), (1.0 + reach, 1.0), "{shape:?}");
    }
    assert_eq!(distance(&at(0.0, 0.0), &floor, &at(5.0, 3.0), &ceiling), 3.0, "a gap");
    let slab = contact(&at(0.0, 0.0), &floor, &at(5.0, -3.0), &ceiling, 0.0).expect("a slab");
    assert_eq!((slab.depth, slab.normal.y), (3.0, 1.0), "three thick");
    assert!(contact(&at(0.0, 0.0), &floor, &at(9.0, 9.0), &wall, 0.0).is_none(), "unbounded");
    let answer = proximity(&at(0.0, 0.0), &floor, &at(9.0, 9.0), &wall, 0.0);
    assert_eq!(answer, Proximity::Intersecting, "without bound");
    assert_eq!(distance(&at(0.0, 0.0), &floor, &at(9.0, 9.0), &wall), 0.0, "without bound");
}

#[test]
fn time_of_impact_of_boxes_and_balls() {
    let cuboid = Cuboid::new(V3::new(1.0, 1.0, 1.0));
    let ball = Ball::new(1.0);
    let (origin, away) = (Isometry3::identity(), Isometry3::translation(10.0, 0.0, 0.0));
    let cast = |v1: V3, v2: V3| time_of_impact(&origin, &v1, &cuboid, &away, &v2, &ball);
    assert_eq!(cast(V3::x(), V3::zeros()), Some(8.0), "eight units at speed one");
    assert_eq!(cast(V3::x(), -V3::x() * 3.0), Some(2.0), "towards each other");
    assert_eq!(cast(-V3::x(), V3::zeros()), None, "away");
    assert_eq!(cast(V3::y(), V3::y()), None, "side by side");
    assert_eq!(cast(V3::new(1.0, 1.0, 0.0), V3::zeros()), None, "past it");
    assert_eq!(cast(V3::x() * f64::NAN, V3::zeros()), None, "no velocity");
    // The ball grazes an edge: it comes closest, at a distance of 1, after 9 units.
    let beside = Isometry3::translation(10.0, 2.0, 0.0);
    let graze = time_of_impact(&origin, &V3::x(), &cuboid, &beside, &V3::zeros(), &ball);
    assert!(graze.is_none_or(|time| time > 9.0 - 1e-6 && time < 9.0 + 1e-6), "{graze:?}");
}

#[test]
fn starts_in_contact() {
    let (ball, segment) = (
        Ball::new(1.0),
        Segment::new(Point::<f64, 2>::new(-1.0, 0.0), Point::<f64, 2>::new(1.0, 0.0)),
    );
    let cast = |y: f64, v: V2| {
        time_of_impact(&at(0.0, y), &v, &ball, &at(0.0, 0.0), &V2::zeros(), &segment)
    };
    // A start in contact counts only if the solids do not separate.
    assert_eq!(cast(1.0, V2::y()), None, "touching and leaving");
    assert_eq!(cast(1.0, -V2::y()), Some(0.0), "touching and approaching");
    assert_eq!(cast(0.5, V2::y()), None, "overlapping and leaving");
    assert_eq!(cast(0.5, V2::zeros()), Some(0.0), "overlapping and still");
    assert_eq!(cast(3.0, -V2::y()), Some(2.0), "two units down");
    let floor = half_plane(0.0, 1.0);
    let fall = time_of_impact(&at(0.0, 5.0), &-V2::y(), &ball, &at(0.0, 0.0), &V2::zeros(), &floor);
    assert_eq!(fall, Some(4.0), "onto the floor");
}

#[test]
fn a_flat_triangle_in_space_has_two_sides() {
    let corner = |x: f64, y: f64| Point::<f64, 3>::new(x, y, 0.0);
    let triangle = Triangle::new(corner(0.0, 0.0), corner(4.0, 0.0), corner(0.0, 4.0));
    let cuboid = Cuboid::new(V3::new(0.5, 0.5, 0.5));
    for side in [-1.0, 1.0] {
        let place = Isometry3::translation(1.0, 1.0, 2.0 * side);
        let found = contact(&Isometry3::identity(), &triangle, &place, &cuboid, 2.0).expect("near");
        assert!((found.depth + 1.5).abs() < 1e-12, "one and a half off: {}", found.depth);
        assert!((found.normal.z - side).abs() < 1e-12, "straight off its side");
    }
}
