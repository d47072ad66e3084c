//! Tests the outlines of disks, capsules, ellipses, tapered capsules, boxes, triangles and polygons
//! in 2D.

use core::f64::consts::PI;

use impinge::math::{Point, Real, Vector};
use impinge::procedural::plane;
use impinge::shape::{Ball, Capsule, ConvexPolygon, Cuboid, Ellipsoid, TaperedCapsule, Triangle};
use impinge_reference::geometry::{Solid, point_signed_distance};
use impinge_reference::random::Random;
use impinge_reference::topology::{check_polygon, farthest_outside, polygon_area};

use super::{COUNTS, POWERS, assert_second_order, depth_in_club, doubles, epsilon};

fn point<N: Real>(p: [f64; 2]) -> Point<N, 2> {
    Point::from(Vector::<f64, 2>::from(p).map(N::lit))
}

/// Asserts that the outline is closed, convex and counter-clockwise, with its corners on the
/// surface and seven points of each side at most `gap` inside it. Returns the greatest gap found.
fn check_round<N: Real>(points: &[Point<N, 2>], solid: &Solid<2>, size: f64, gap: f64) -> f64 {
    let points = doubles(points);
    let noise = 8.0 * epsilon::<N>() * size;
    assert_eq!(check_polygon(&points), Ok(()), "a polygon");
    assert!(farthest_outside(&points, &points) <= noise, "convex");
    let mut widest: f64 = 0.0;
    for (index, from) in points.iter().enumerate() {
        let to = points[(index + 1) % points.len()];
        let depth = |p: [f64; 2]| -point_signed_distance(solid, &identity(), &p);
        assert!(depth(*from).abs() <= noise, "corner {index}: {}", depth(*from));
        for part in 1..8 {
            let share = f64::from(part) / 8.0;
            let between = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
            widest = widest.max(depth(between));
            assert!(depth(between) >= -noise, "side {index} leaves the solid");
        }
    }
    assert!(widest <= gap + noise, "the gap is {widest}, not {gap}");
    widest
}

fn identity() -> impinge_reference::geometry::Pose<2> {
    impinge_reference::geometry::Pose::identity()
}

fn gap_of(radius: f64, parts: u32) -> f64 {
    radius * (1.0 - (PI / f64::from(parts)).cos())
}

fn balls<N: Real>() {
    for count in COUNTS {
        let parts = count.max(3);
        let outline = plane::ball(&Ball::new(N::lit(1.5)), count);
        assert_eq!(outline.points.len(), parts as usize, "as many corners as parts");
        let gap = gap_of(1.5, parts);
        let found = check_round(&outline.points, &Solid::ball(1.5), 1.5, gap);
        assert!(found > 0.99 * gap, "the gap is reached: {found} of {gap}");
    }
    assert_second_order("a disk", PI * 2.25, |count| {
        polygon_area(&doubles(&plane::ball(&Ball::new(N::lit(1.5)), count).points))
    });
}

fn capsules<N: Real>() {
    let mut random = Random::new(7);
    for count in COUNTS {
        let [a, b] = [0, 1].map(|_| [0, 1].map(|_| random.range(-3.0, 3.0)));
        let capsule =
            Capsule::try_from_ends(point::<N>(a), point(b), N::lit(0.75)).expect("good numbers");
        // The ends as the capsule has them, rounded to the scalar.
        let ends = doubles(&[*capsule.segment().a(), *capsule.segment().b()]);
        let outline = plane::capsule(&capsule, count);
        let half = count.max(3).div_ceil(2);
        assert_eq!(outline.points.len(), 2 * half as usize + 2, "two half circles");
        let solid = Solid::capsule(ends[0], ends[1], 0.75);
        let found = check_round(&outline.points, &solid, 5.0, gap_of(0.75, 2 * half));
        assert!(found > 0.99 * gap_of(0.75, 2 * half), "the gap is reached");
    }
    let upright = Capsule::new(N::lit(2.0), N::lit(0.5));
    let first = plane::capsule(&upright, 8).points[0];
    assert_eq!(first, point([0.5, 2.0]), "it starts on the right, at the upper end");
    assert_second_order("a stadium", 4.0 + PI * 0.25, |count| {
        polygon_area(&doubles(&plane::capsule(&upright, count).points))
    });
}

fn ellipses<N: Real>() {
    let solid = Ellipsoid::new(Vector::<N, 2>::new(N::lit(2.0), N::lit(0.5)));
    for count in COUNTS {
        let points = doubles(&plane::ellipse(&solid, count).points);
        assert_eq!(
            (points.len(), check_polygon(&points)),
            (count.max(3) as usize, Ok(())),
            "a corner each"
        );
        for [x, y] in points {
            let level = (x / 2.0).hypot(y / 0.5);
            assert!((level - 1.0).abs() <= 8.0 * epsilon::<N>(), "({x}, {y}) is at {level}");
        }
    }
    assert_second_order("an ellipse", PI, |count| {
        polygon_area(&doubles(&plane::ellipse(&solid, count).points))
    });
}

fn tapered_capsules<N: Real>() {
    let mut random = Random::new(17);
    for count in COUNTS.iter().cycle().take(80).copied() {
        let ends = [0, 1].map(|_| [0, 1].map(|_| random.range(-2.0, 2.0)));
        let radii = [random.range(0.1, 0.9), random.range(0.1, 0.9)];
        let [a, b] = ends.map(point::<N>);
        let solid = TaperedCapsule::try_from_ends(a, b, radii.map(N::lit)).expect("good numbers");
        let [a, b] = [a, b].map(|end| end.coords.map(N::as_f64));
        let radii = solid.radii().map(N::as_f64);
        let points = doubles(&plane::tapered_capsule(&solid, count).points);
        assert_eq!(check_polygon(&points), Ok(()), "a polygon: {solid:?}");
        if (b - a).norm() <= (radii[1] - radii[0]).abs() {
            continue;
        }
        let gap = gap_of(radii[0].max(radii[1]), count.max(3)) + 32.0 * epsilon::<N>();
        assert!(points.len() <= count.max(3) as usize + 4, "at most");
        for (index, from) in points.iter().enumerate() {
            let to = points[(index + 1) % points.len()];
            for part in 0..8 {
                let share = f64::from(part) / 8.0;
                let place = [0, 1].map(|axis| from[axis] + share * (to[axis] - from[axis]));
                let depth = depth_in_club(&Vector::<f64, 2>::from(place), [a, b], radii);
                let most = if part == 0 { 32.0 * epsilon::<N>() } else { gap };
                assert!((-32.0 * epsilon::<N>()..=most).contains(&depth), "{depth}: {solid:?}");
            }
        }
    }
}

fn flat_sides<N: Real>() {
    let cuboid = Cuboid::new(Vector::<N, 2>::new(N::lit(2.0), N::lit(3.0)));
    let corners = doubles(&plane::cuboid(&cuboid).points);
    assert_eq!(corners, [[2.0, -3.0], [2.0, 3.0], [-2.0, 3.0], [-2.0, -3.0]], "by hand");
    let [a, b, c] = [[0.0, 0.0], [4.0, 1.0], [1.0, 3.0]].map(point::<N>);
    for (corners, expected) in [([a, b, c], [a, b, c]), ([a, c, b], [a, b, c])] {
        let [p, q, r] = corners;
        let outline = plane::triangle(&Triangle::new(p, q, r));
        assert_eq!(outline.points, expected, "in the order that is counter-clockwise");
        assert_eq!(polygon_area(&doubles(&outline.points)), 5.5, "by hand");
    }
    let polygon = ConvexPolygon::from_points(&[a, b, c, point([1.0, 1.0])]);
    let outline = doubles(&plane::convex_polygon(&polygon).points);
    assert_eq!(check_polygon(&outline), Ok(()), "a polygon");
    assert_eq!(polygon_area(&outline), 5.5, "the inner point is gone");
}

fn triangles_turn_the_right_way<N: Real>() {
    let (mut random, mut reversed) = (Random::new(3), 0);
    for _ in 0..200 {
        let [a, b, c] = [0, 1, 2].map(|_| point::<N>([0, 1].map(|_| random.range(-1.0, 1.0))));
        let outline = plane::triangle(&Triangle::new(a, b, c));
        assert_eq!(outline.points[0], a, "from the first corner on");
        assert!(polygon_area(&doubles(&outline.points)) > 0.0, "{a} {b} {c}");
        reversed += u32::from(outline.points[1] == c);
    }
    assert!((60..=140).contains(&reversed), "{reversed} of 200 were given clockwise");
}

fn powers_of_two_scale<N: Real>() {
    for power in POWERS.map(N::lit) {
        let outlines = |scale: N| {
            let [a, b] =
                [[0.3, 0.7], [-1.1, 0.4]].map(|p| Point::from(point::<N>(p).coords * scale));
            let capsule = Capsule::try_from_ends(a, b, N::lit(0.6) * scale).expect("good numbers");
            [
                plane::ball(&Ball::new(N::lit(1.3) * scale), 11).points,
                plane::capsule(&capsule, 9).points,
            ]
        };
        let grown = outlines(N::ONE).map(|points| {
            points.iter().map(|p| Point::from(p.coords * power)).collect::<Vec<Point<N, 2>>>()
        });
        assert_eq!(grown, outlines(power), "bit by bit, at {power}");
    }
}

fn nothing_is_no_trouble<N: Real>() {
    let middle = point::<N>([1.0, 2.0]);
    let dot = Capsule::try_from_ends(middle, middle, N::ZERO).expect("good numbers");
    assert!(plane::capsule(&dot, 6).points.iter().all(|p| *p == middle), "a point eight times");
    let disk = Capsule::try_from_ends(middle, middle, N::ONE).expect("good numbers");
    let points = doubles(&plane::capsule(&disk, 6).points);
    let noise = 4.0 * epsilon::<N>();
    let is_on = |p: &[f64; 2]| ((p[0] - 1.0).hypot(p[1] - 2.0) - 1.0).abs() <= noise;
    assert!(points.iter().all(is_on), "a disk: {points:?}");
    let point_triangle = Triangle::new(middle, middle, middle);
    assert_eq!(plane::triangle(&point_triangle).points, [middle; 3], "a point three times");
}

fn all<N: Real>() {
    balls::<N>();
    capsules::<N>();
    flat_sides::<N>();
    ellipses::<N>();
    tapered_capsules::<N>();
    triangles_turn_the_right_way::<N>();
    powers_of_two_scale::<N>();
    nothing_is_no_trouble::<N>();
}

#[test]
fn outlines_f32() {
    all::<f32>();
}

#[test]
#[cfg(feature = "f64")]
fn outlines_f64() {
    all::<f64>();
}
