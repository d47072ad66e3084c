//! Tests outlines and surfaces of the built-in shapes: they are closed, face outwards, lie on the
//! true surface, and approach it with more segments for each turn.

mod plane;
mod space;

use impinge::math::{Point, Real, Vector};

fn doubles<N: Real, const D: usize>(points: &[Point<N, D>]) -> Vec<[f64; D]> {
    points.iter().map(|point| core::array::from_fn(|axis| point[axis].as_f64())).collect()
}

/// Returns the depth of a point in the hull of two balls: the union of balls whose centres and
/// radii change linearly.
fn depth_in_club<const D: usize>(
    p: &Vector<f64, D>,
    [a, b]: [Vector<f64, D>; 2],
    [first, second]: [f64; 2],
) -> f64 {
    let (axis, growth) = (b - a, second - first);
    let length = axis.norm();
    let along = (p - a).dot(&axis) / length;
    let aside = (p - a - axis * (along / length)).norm();
    let lean = (length * length - growth * growth).sqrt();
    let share = ((along + aside * growth / lean) / length).clamp(0.0, 1.0);
    first + growth * share - (p - a - axis * share).norm()
}

fn epsilon<N: Real>() -> f64 {
    N::EPSILON.as_f64()
}

/// Asserts that an outline or a surface is inscribed: its area or volume is below the true one.
/// Doubling the segments must divide that error by four, as long as it is far above rounding.
fn assert_second_order(what: &str, truth: f64, measure: impl Fn(u32) -> f64) {
    for count in [16, 32] {
        let (error, half) = (truth - measure(count), truth - measure(2 * count));
        let ratio = error / half;
        assert!(error > 0.0, "{what}: inscribed, so {error} is missing");
        assert!((3.9..4.1).contains(&ratio), "{what}: {error} and {half} at {count}");
    }
    let relative = (truth - measure(256)) / truth;
    assert!((0.0..5e-4).contains(&relative), "{what}: off by {relative} at last");
}

/// Factors of the size of a shape: 2, and two that are far from 1.
const POWERS: [f64; 3] = [2.0, 1.0 / 1_048_576.0, 1_073_741_824.0];

const COUNTS: [u32; 8] = [0, 3, 4, 5, 7, 8, 13, 30];

#[test]
fn counts_below_three_count_as_three() {
    use impinge::{procedural, shape};
    let disk = shape::Ball::new(1.0_f32);
    let [few, least] = [0, 3].map(|count| procedural::plane::ball(&disk, count));
    assert_eq!(few, least, "a triangle");
    let [few, least] = [2, 3].map(|count| procedural::space::ball(&disk, count));
    assert_eq!(few, least, "two pyramids");
}
