//! Tests hulls of 100000 points: most of them inside, all of them vertices, flat sets, copies, tiny
//! and huge coordinates.

use impinge::math::{Point, Real};
use impinge::shape::{ConvexHull, ConvexPolygon};
use impinge::transformation::convex_hull2;

use super::checks::{cast, hull_of, hull_within};
use super::points::{Numbers, P3, ball, sphere};

const COUNT: usize = 100_000;

/// Returns points on the six faces of a cube, and its corners: many points in each plane.
fn on_a_cube() -> Vec<P3> {
    let mut numbers = Numbers::new(23);
    let mut corners = Vec::with_capacity(COUNT);
    for index in 0..COUNT {
        let mut place = numbers.vector();
        place[index % 3] = if index % 2 == 0 { 1.0 } else { -1.0 };
        corners.push(P3::from(place));
    }
    corners.extend((0..8_u8).map(|i| {
        let sign = |bit: u8| if i >> bit & 1 == 1 { 1.0 } else { -1.0 };
        P3::new(sign(0), sign(1), sign(2))
    }));
    corners
}

/// Returns `COUNT` points, which repeat the given points in turn.
fn doubled(points: &[P3]) -> Vec<P3> {
    points.iter().cycle().take(COUNT).copied().collect()
}

fn scaled(points: &[P3], scale: f64) -> Vec<P3> {
    points.iter().map(|p| p * scale).collect()
}

fn space<N: Real>() {
    let (inside, round) = (ball(COUNT), sphere(COUNT));
    for scale in [1e-23, 1e6] {
        hull_of::<N>("a full ball", &scaled(&inside, scale));
        // Where samples lie closer than rounding, the angles between faces are rounding errors too.
        hull_within::<N>(32.0, "a sphere", &scaled(&round, scale));
        let cube = hull_of::<N>("a cube", &scaled(&on_a_cube(), scale));
        assert_eq!((cube.vertices.len(), cube.faces.len()), (8, 6), "flat faces of many points");
        let copies = hull_of::<N>("copies", &scaled(&doubled(&inside[..1000]), scale));
        let once = hull_of::<N>("once", &scaled(&inside[..1000], scale));
        assert_eq!(copies, once, "copies change nothing");
    }
    let solid = ConvexHull::from_points(&cast::<N>(&inside));
    assert_eq!(solid.validate(), Ok(()), "a solid");
}

fn plane<N: Real>() {
    let mut numbers = Numbers::new(29);
    for scale in [1e-23, 1.0, 1e6] {
        let mut cloud: Vec<Point<N, 2>> = (0..COUNT / 2)
            .map(|_| {
                Point::<N, 2>::new(N::lit(numbers.next() * scale), N::lit(numbers.next() * scale))
            })
            .collect();
        cloud.extend_from_within(..);
        let ring = convex_hull2(&cloud).expect("an area");
        let at = |index: usize| cloud[index].coords.map(|x| x.as_f64() / scale);
        let mut outside = 0.0_f64;
        for (side, &from) in ring.iter().enumerate() {
            let (from, to) = (at(from), at(ring[(side + 1) % ring.len()]));
            let along = (to - from).normalize();
            let beyond = |index| (at(index) - from).perp(&along);
            outside = (0..cloud.len()).map(beyond).fold(outside, f64::max);
        }
        assert!(outside <= 8.0 * N::EPSILON.as_f64(), "{outside} outside at {scale}");
        assert!(ring.len() < 100, "few corners: {}", ring.len());
        assert_eq!(ConvexPolygon::from_points(&cloud).validate(), Ok(()), "a polygon");
    }
}

#[test]
fn hundred_thousand_points_f32() {
    space::<f32>();
    plane::<f32>();
}

#[test]
fn hundred_thousand_points_f64() {
    space::<f64>();
    plane::<f64>();
}
