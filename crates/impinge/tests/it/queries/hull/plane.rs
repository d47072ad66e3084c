//! Tests hulls of points in 2D, and polygons made from outlines of either winding.

use impinge::math::{Point, Real};
use impinge::shape::{ConvexPolygon, ShapeError};
use impinge::transformation::convex_hull2;

use super::points::Numbers;

fn points<N: Real>(coordinates: &[[f64; 2]]) -> Vec<Point<N, 2>> {
    coordinates.iter().map(|&[x, y]| Point::<N, 2>::new(N::lit(x), N::lit(y))).collect()
}

/// Returns the largest distance, computed in `f64`, by which a point lies to the right of a side
/// and so outside a counter-clockwise ring; zero if none does.
fn outside<N: Real>(points: &[Point<N, 2>], ring: &[usize]) -> f64 {
    let at = |i: usize| points[i].coords.map(Real::as_f64);
    let mut outside = 0.0_f64;
    for side in 0..ring.len() {
        let (a, b) = (at(ring[side]), at(ring[(side + 1) % ring.len()]));
        for point in 0..points.len() {
            let (u, v) = (b - a, at(point) - a);
            outside = outside.max((u.y * v.x - u.x * v.y) / u.norm());
        }
    }
    outside
}

fn random<N: Real>() {
    let mut numbers = Numbers::new(5);
    for count in [3, 5, 20, 300] {
        for scale in [1e-23, 1.0, 1e6] {
            let cloud: Vec<[f64; 2]> =
                (0..count).map(|_| [numbers.next() * scale, numbers.next() * scale]).collect();
            let cloud = points::<N>(&cloud);
            let ring = convex_hull2(&cloud).expect("an area");
            let tolerance = 8.0 * N::EPSILON.as_f64() * scale;
            assert!(outside(&cloud, &ring) <= tolerance, "all within: {ring:?}");
            let hull = ConvexPolygon::from_points(&cloud);
            assert_eq!(hull.validate(), Ok(()), "{cloud:?}");
            assert_eq!(hull.vertices().len(), ring.len(), "the same corners");
            assert_eq!(ConvexPolygon::new(hull.vertices()), hull, "an outline is its own hull");
        }
    }
}

#[test]
fn random_points_lie_within() {
    random::<f32>();
    random::<f64>();
}

/// Asserts that the ring starts at the corner with the smallest x, also if the point with the
/// smallest x is on a side, up to rounding.
#[test]
fn the_ring_starts_at_its_first_corner() {
    let thin = points::<f64>(&[[0.0, 0.0], [3e-16, -1.0], [1.0, 0.0], [1e-16, 1.0]]);
    assert_eq!(convex_hull2(&thin), Ok(vec![3, 1, 2]));
}

#[test]
fn a_grid_has_four_corners() {
    let grid: Vec<[f64; 2]> = (0..100).map(|i| [f64::from(i % 10), f64::from(i / 10)]).collect();
    assert_eq!(convex_hull2(&points::<f32>(&grid)), Ok(vec![0, 9, 99, 90]), "as they are");
    let (sine, cosine) = (0.6, 0.8);
    let turned: Vec<[f64; 2]> = grid
        .iter()
        .map(|[x, y]| [(x * cosine - y * sine) / 3.0, (x * sine + y * cosine) / 3.0])
        .collect();
    let mut ring = convex_hull2(&points::<f32>(&turned)).expect("an area");
    ring.sort_unstable();
    assert_eq!(ring, [0, 9, 90, 99], "turned, with rounding noise on the sides");
}

const SQUARE: [[f64; 2]; 4] = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0]];

#[test]
fn outlines_in_both_orders() {
    let there = ConvexPolygon::new(&points::<f64>(&SQUARE));
    assert_eq!(there.vertices(), points::<f64>(&SQUARE), "counter-clockwise stays");
    let mut back = SQUARE;
    back.reverse();
    let back = ConvexPolygon::new(&points::<f64>(&back));
    assert_eq!(back.vertices(), points::<f64>(&SQUARE), "clockwise is reversed");
    let more = [[0.0, 0.0], [0.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 2.0], [0.0, 2.0], [0.0, 1.0]];
    let more = ConvexPolygon::new(&points::<f64>(&more));
    assert_eq!(more.vertices().len(), 4, "repeated points and points on sides go: {more:?}");
}

#[test]
fn bad_outlines_are_named() {
    let dent = [[0.0, 0.0], [2.0, 0.0], [1.0, 0.5], [2.0, 2.0], [0.0, 2.0]];
    let mut dent_back = dent;
    dent_back.reverse();
    let spike = [[0.0, 0.0], [2.0, 0.0], [2.0, 2.0], [2.0, 3.0], [2.0, 1.0], [0.0, 2.0]];
    let star = [0, 2, 4, 1, 3].map(|i| {
        let angle = f64::from(i) * std::f64::consts::TAU / 5.0;
        [angle.cos(), angle.sin()]
    });
    let error = |coordinates: &[[f64; 2]]| {
        ConvexPolygon::try_new(&points::<f64>(coordinates)).expect_err("not convex")
    };
    assert_eq!(error(&dent), ShapeError::NotConvex { index: 2 }, "the dent");
    assert_eq!(error(&dent_back), ShapeError::NotConvex { index: 2 }, "clockwise too");
    assert!(matches!(error(&spike), ShapeError::NotConvex { index: 3 | 4 }), "the spike");
    assert!(
        matches!(error(&star), ShapeError::NotConvex { .. }),
        "a star turns left, twice around"
    );
    let [few, line] = [&SQUARE[..2], &[[0.0, 0.0], [2.0, 2.0], [1.0, 1.0]][..]];
    assert_eq!(error(few), ShapeError::TooFewPoints { given: 2, needed: 3 }, "too few");
    assert_eq!(error(line), ShapeError::Degenerate { dimension: 1 }, "a line");
    assert_eq!(error(&[[1.0, 1.0]; 5]), ShapeError::Degenerate { dimension: 0 }, "a point");
    assert_eq!(
        error(&[[1.0, 1.0], [0.0, f64::NAN], [3.0, 4.0]]),
        ShapeError::PointNotFinite { index: 1 },
        "NaN"
    );
    assert_eq!(
        convex_hull2::<f32>(&[]),
        Err(ShapeError::TooFewPoints { given: 0, needed: 3 }),
        "none"
    );
}

/// Asserts that points on a circle, so dense that each lies on the segment between its neighbours
/// up to rounding, stay within twice the tolerance of the hull, and of the polygon of the outline.
fn dense_circles<N: Real>(most: u32) {
    for count in [1_000, most] {
        let step = core::f64::consts::TAU / f64::from(count);
        let at = |index: u32| {
            let angle = f64::from(index) * step;
            [angle.cos(), angle.sin()]
        };
        let circle = points::<N>(&(0..count).map(at).collect::<Vec<_>>());
        let ring = convex_hull2(&circle).expect("an area");
        let tolerance = 8.0 * N::EPSILON.as_f64();
        let strided: Vec<_> = circle.iter().copied().step_by(97).collect();
        let corners: Vec<_> = ring.iter().map(|&index| circle[index]).collect();
        let all = [corners.clone(), strided].concat();
        let hull: Vec<usize> = (0..corners.len()).collect();
        assert!(outside(&all, &hull) <= tolerance, "{count}: {}", outside(&all, &hull));
        let polygon = ConvexPolygon::new(&circle);
        assert_eq!(ConvexPolygon::new(polygon.vertices()), polygon, "an outline is its own hull");
        let all =
            [polygon.vertices().to_vec(), circle.iter().copied().step_by(97).collect()].concat();
        let hull: Vec<usize> = (0..polygon.vertices().len()).collect();
        assert!(outside(&all, &hull) <= tolerance, "{count}: {}", outside(&all, &hull));
    }
}

#[test]
fn dense_circles_keep_their_size() {
    dense_circles::<f32>(100_000);
    dense_circles::<f64>(3_000);
}

/// A corner that rounding makes reflex, which must stay for the sake of another point until its
/// neighbours are known, is left out in the end: the outline is a triangle.
#[test]
fn noise_on_a_side_is_no_dent() {
    let u = f64::from(f32::EPSILON);
    let outline = [[0.0, 0.0], [0.5, -3.75 * u], [0.75, 0.0], [0.78125, u], [1.0, -u], [0.5, 1.0]];
    let polygon = ConvexPolygon::try_new(&points::<f32>(&outline)).expect("a triangle");
    assert_eq!(polygon.vertices().len(), 3, "{polygon:?}");
}
