//! Found by fuzzing: balls beside cones of height or radius zero, which are disks or segments.

use impinge::dim3::math::{Isometry, Vector};
use impinge::dim3::shape::{Ball, Cone, Shape};
use impinge::query::{Proximity, contact, distance, proximity};

/// Returns the signed distance between a cone and a ball of radius 1; `center` is in the frame of
/// the cone. Asserts that contact, distance and proximity agree.
fn of_ball(cone: &Cone<f64>, center: [f64; 3]) -> f64 {
    let (ball, here) = (Ball::new(1.0), Isometry::identity());
    let place = Isometry::translation(center[0], center[1], center[2]);
    let found = contact(&here, cone, &place, &ball, 100.0).expect("nearer than 100");
    let cone = cone as &dyn Shape<f64, 3>;
    let apart = distance(&here, cone, &place, &ball);
    assert_eq!(apart, (-found.depth).max(0.0), "one fact");
    let is_near = proximity(&here, cone, &place, &ball, 0.0) == Proximity::Intersecting;
    assert_eq!(is_near, apart == 0.0, "one fact");
    let between = found.world1 - *found.normal * found.depth - found.world2;
    assert!(between.norm() < 1e-14 && (found.normal.norm() - 1.0).abs() < 1e-15, "{found:?}");
    -found.depth
}

/// Bug: a disk was unbounded within its own plane, so that it touched every solid there.
#[test]
fn a_disk_ends_at_its_rim() {
    let disk = Cone::new(0.0, 3.0);
    assert_eq!(of_ball(&disk, [20.0, 0.0, 0.0]), 16.0, "in its plane");
    assert_eq!(of_ball(&disk, [0.0, 0.0, -3.5]), -0.5, "in its plane, near the rim");
    assert_eq!(of_ball(&disk, [0.0, 4.0, 2.0]), 3.0, "above it");
    assert_eq!(of_ball(&disk, [6.0, -4.0, 0.0]), 4.0, "beside and below it");
    assert_eq!(of_ball(&disk, [1.0, 0.25, 0.0]), -0.75, "on it");
}

/// Bug: a cone of radius zero was unbounded upwards on its axis.
#[test]
fn a_needle_ends_at_its_apex() {
    let needle = Cone::new(2.0, 0.0);
    assert_eq!(of_ball(&needle, [0.0, 12.0, 0.0]), 9.0, "above it");
    assert_eq!(of_ball(&needle, [0.0, -12.0, 0.0]), 9.0, "below it");
    assert_eq!(of_ball(&needle, [3.0, 6.0, 0.0]), 4.0, "beside and above it");
    assert_eq!(of_ball(&needle, [0.0, 1.0, 2.5]), 1.5, "beside it");
}

#[test]
fn a_cone_of_no_size_is_a_point() {
    let point = Cone::new(0.0, 0.0);
    assert_eq!(of_ball(&point, [0.0, 3.0, 4.0]), 4.0, "anywhere");
    assert_eq!(of_ball(&point, [3.0, 0.0, 0.0]), 2.0, "sideways");
    assert_eq!(of_ball(&point, [0.0, -3.0, 0.0]), 2.0, "below");
    let far = Isometry::translation(5.0, 0.0, 0.0);
    let other = Cone::new(0.0, 1.0);
    let apart = distance(&far, &other, &Isometry::new(Vector::zeros(), Vector::zeros()), &point);
    assert_eq!(apart, 4.0, "a disk and a point");
}
