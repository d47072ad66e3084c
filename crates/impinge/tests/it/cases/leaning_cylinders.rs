//! Cylinders whose axes are nearly parallel, one standing above the other: the common perpendicular
//! of the axes is far from well conditioned, and its feet must not be taken for points between the
//! ends of both cylinders.

use impinge::math::{Isometry3, Space, Vector};
use impinge::query::{Proximity, contact, distance, proximity};
use impinge::shape::Cylinder;

/// Asserts that cylinders of half height 1 with a clear gap between their caps are apart. The
/// second is rotated by `tilt` about z; `shift` is across and `height` along the first axis.
fn stand_apart<N: Space<3, Isometry = Isometry3<N>>>(
    radius: f64,
    tilt: f64,
    [x, height, z]: [f64; 3],
) {
    let solid = Cylinder::new(N::ONE, N::lit(radius));
    let above = Isometry3::new(
        Vector::from([x, height, z].map(N::lit)),
        Vector::<N, 3>::z() * N::lit(tilt),
    );
    let below = Isometry3::identity();
    let gap = height - 1.0 - tilt.cos() - tilt.sin() * radius;
    for (pose1, pose2) in [(below, above), (above, below)] {
        let found = distance(&pose1, &solid, &pose2, &solid).as_f64();
        let what = format!("radius {radius}, tilted by {tilt}, at {x}, {height}, {z}: {found}");
        assert!(found >= gap - 1e-5 && found < gap + 0.01, "{what} for {gap}");
        let near = proximity(&pose1, &solid, &pose2, &solid, N::ZERO);
        assert_eq!(near, Proximity::Disjoint, "{what}");
        let contact = contact(&pose1, &solid, &pose2, &solid, N::lit(1.0)).expect("in reach");
        assert!((contact.depth.as_f64() + found).abs() < 1e-5, "{what}: {contact:?}");
    }
}

#[test]
fn leaning_cylinders_with_a_gap_are_apart() {
    for (radius, shift) in [(0.01, 0.015), (0.1, 0.21), (0.01, 0.021)] {
        stand_apart::<f32>(radius, 0.00163, [-0.00168, 2.06, shift]);
        stand_apart::<f64>(radius, 0.00163, [-0.00168, 2.06, shift]);
    }
    stand_apart::<f32>(0.01, 0.00208, [-0.00168, 2.04, 0.015]);
    for height in [2.02, 2.03, 2.04] {
        stand_apart::<f64>(0.01, 6.33e-8, [-6.5e-8, height, 0.021]);
    }
}
