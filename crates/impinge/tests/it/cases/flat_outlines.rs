//! Found by fuzzing: triangles and segments in 2D with coinciding corners.

use impinge::dim2::math::{Isometry, Point, Vector};
use impinge::dim2::shape::{Ball, Capsule, Cuboid, Segment, Shape, Triangle};
use impinge::query::{Proximity, contact, distance, proximity};

const HERE: [f64; 2] = [4.875, 0.0];

/// Returns the distance between a flat solid and a small solid that lies on the line of the flat
/// solid, beyond its end. Asserts that contact and proximity agree with the distance.
fn beyond(flat: &dyn Shape<f64, 2>, solid: &dyn Shape<f64, 2>) -> f64 {
    let (origin, place) = (Isometry::identity(), Isometry::translation(HERE[0], HERE[1]));
    let found = distance(&origin, flat, &place, solid);
    assert_eq!(distance(&place, solid, &origin, flat), found, "in either order");
    let nearest = contact(&origin, flat, &place, solid, 100.0).expect("nearer than 100");
    assert_eq!(-nearest.depth, found, "one fact");
    let expected = if found > 0.0 { Proximity::Disjoint } else { Proximity::Intersecting };
    assert_eq!(proximity(&origin, flat, &place, solid, 0.0), expected, "one fact");
    found
}

/// Bug: a triangle with a side of length zero was unbounded at that end, so it touched every solid
/// on its line.
#[test]
fn triangles_with_two_corners_at_one_place_end_there() {
    let (a, o) = (Point::new(-7.5, 0.0), Point::origin());
    for corners in [[a, o, o], [o, a, o], [o, o, a]] {
        let triangle = Triangle::new(corners[0], corners[1], corners[2]);
        assert_eq!(beyond(&triangle, &Ball::new(0.0)), 4.875, "a point beyond {corners:?}");
        assert_eq!(beyond(&triangle, &Ball::new(0.5)), 4.375, "a ball beyond {corners:?}");
        let point = Segment::new(o, o);
        assert_eq!(beyond(&triangle, &point), 4.875, "a segment of no length");
        let square = Cuboid::new(Vector::new(0.0, 0.0));
        assert_eq!(beyond(&triangle, &square), 4.875, "a square of no size");
        assert_eq!(beyond(&triangle, &Capsule::new(0.0, 0.25)), 4.625, "a capsule of no length");
    }
}

#[test]
fn triangles_of_one_point_are_points() {
    let o = Point::origin();
    let triangle = Triangle::new(o, o, o);
    assert_eq!(beyond(&triangle, &Ball::new(0.0)), 4.875, "two points");
    assert_eq!(beyond(&triangle, &Segment::new(o, Point::new(1.0, 0.0))), 4.875, "away from it");
    assert_eq!(beyond(&triangle, &Segment::new(Point::new(-2.0, 0.0), o)), 2.875, "towards it");
}

/// Asserts that boxes with a half extent of zero, which have coinciding corners too, end at these
/// corners.
#[test]
fn flat_boxes_end_at_their_corners() {
    let flat = Cuboid::new(Vector::new(2.0, 0.0));
    let slope = Triangle::new(Point::origin(), Point::new(1.0, 0.0), Point::new(1.0, 0.0));
    assert_eq!(beyond(&flat, &Ball::new(0.0)), 2.875, "a point beyond a flat box");
    assert_eq!(beyond(&flat, &slope), 2.875, "a flat triangle beyond a flat box");
    assert_eq!(beyond(&slope, &flat), 1.875, "and the other way round");
}
