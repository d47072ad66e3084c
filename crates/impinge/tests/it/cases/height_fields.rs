//! Tests height fields with inputs that exposed bugs in other libraries.

use impinge::math::na::Isometry3;
use impinge::math::{Point, Real, Vector};
use impinge::query::{Ray, RayCast};
use impinge::shape::HeightField;

/// Returns the height field of rapier#165: sin(x) + cos(z) over 100 by 100, in 20 by 20 cells of 5
/// by 5.
fn waves<N: Real>() -> HeightField<N, 3> {
    let at = |index: u32| f64::from(index) * 5.0 - 50.0;
    let height = |row: u32, column: u32| {
        let ((sine, _), (_, cosine)) = (at(column).sine_cosine(), at(row).sine_cosine());
        N::lit(sine + cosine)
    };
    let heights = (0..21).flat_map(|row| (0..21).map(move |column| height(row, column))).collect();
    HeightField::<N, 3>::new(
        21,
        21,
        heights,
        Vector::<N, 3>::new(N::lit(100.0), N::ONE, N::lit(100.0)),
    )
}

/// Asserts that a ray straight down hits the field at its height there, even at corners and borders
/// of cells.
fn down<N: Real>(field: &HeightField<N, 3>, [x, z]: [f64; 2]) {
    let here = Isometry3::identity();
    let (x, z) = (N::lit(x), N::lit(z));
    let ray = Ray::new(Point::<N, 3>::new(x, N::lit(10.0), z), -Vector::<N, 3>::y());
    let hit = field.toi_and_normal_with_ray(&here, &ray, true);
    let hit = hit.unwrap_or_else(|| panic!("the ray down at {x} {z} misses"));
    let height = field.height_at(x, z).expect("it is over the field");
    let error = (N::lit(10.0) - hit.toi - height).abs();
    assert!(error <= N::lit(32.0) * N::EPSILON, "{error} off at {x} {z}");
    assert!(hit.normal.y > N::ZERO, "from above at {x} {z}");
}

/// Casts vertical rays exactly on borders of cells, where rapier's rays missed, and asserts that
/// they hit: first at the reported coordinates, then on all borders and corners.
fn rapier_165<N: Real>() {
    let field = waves::<N>();
    let reported =
        [[5.0, 2.63113], [9.50162, 5.0], [19.00324, 10.0], [30.0, 15.78678], [40.0, 21.04904]];
    reported.into_iter().for_each(|at| down(&field, at));
    // These include the outermost borders.
    for line in 0..=20_u32 {
        let line = f64::from(line) * 5.0 - 50.0;
        for step in 0..=400_u32 {
            let along = f64::from(step) * 0.25 - 50.0;
            down(&field, [line, along]);
            down(&field, [along, line]);
        }
    }
}

#[test]
fn rapier_165_rays_on_borders() {
    rapier_165::<f32>();
    rapier_165::<f64>();
}

/// Asserts that a point on the diagonal of a cell has a height, also if rounding puts it beside both
/// triangles as seen from their corners.
#[test]
fn diagonals_have_heights() {
    let field =
        HeightField::<f64, 3>::new(2, 2, vec![0.0; 4], Vector::<f64, 3>::new(7.0, 1.0, 10.0));
    assert_eq!(field.height_at(-2.66, -3.8), Some(0.0), "a reported point");
    for step in 1..1000_u32 {
        let share = f64::from(step) / 1000.0 - 0.5;
        for x in [7.0 * share, -7.0 * share] {
            assert_eq!(field.height_at(x, 10.0 * share), Some(0.0), "step {step} at {x}");
        }
    }
}

/// Asserts that a cell that rises from 0 to 1 along z has the height 0.75 at three quarters, however
/// wide it is.
fn check_height_at<N: Real>(widths: &[f64]) {
    let heights = || [0.0, 0.0, 1.0, 1.0].map(N::lit).to_vec();
    for &width in widths {
        let scale = Vector::<N, 3>::new(N::lit(width), N::ONE, N::lit(width));
        let field = HeightField::<N, 3>::new(2, 2, heights(), scale);
        let quarter = scale.x * N::lit(0.25);
        let height = field.height_at(-quarter, quarter).expect("it is over the field");
        assert!((height - N::lit(0.75)).abs() <= N::EPSILON, "{height} at a width of {width}");
    }
}

#[test]
fn very_wide_and_narrow_fields_have_heights() {
    check_height_at::<f32>(&[4e-30, 4e-23, 4.0, 4e20, 3e38]);
    check_height_at::<f64>(&[4e-300, 4e-200, 4.0, 4e200, 1e308]);
}
