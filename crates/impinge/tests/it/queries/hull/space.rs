//! Tests hulls in 3D: known solids, random, flat and tiny point sets, coordinates near the limits,
//! and errors.

use impinge::math::{Point, Real};
use impinge::shape::{ConvexHull, ShapeError};
use impinge::transformation::convex_hull3;

use super::checks::{cast, hull_of, hull_within};
use super::points::{Numbers, P3, ball, cube, grid, octahedron, prism, slab, sphere, turned};
use crate::support::samples::samples;

fn counts<N: Real>(name: &str, points: &[P3]) -> (usize, usize) {
    let hull = hull_of::<N>(name, points);
    (hull.vertices.len(), hull.faces.len())
}

/// Asserts the numbers of vertices and faces of solids for which they are known: unchanged, and
/// rotated, small, large and far away.
fn known_solids<N: Real>() {
    let tetrahedron: Vec<P3> =
        cube().into_iter().filter(|p| (p.x + p.y + p.z) % 2.0 == 0.0).collect();
    let solids = [
        ("tetrahedron", tetrahedron, (4, 4)),
        ("cube", cube(), (8, 6)),
        ("octahedron", octahedron(), (6, 8)),
        ("prism of 5", prism(5), (10, 7)),
        ("prism of 24", prism(24), (48, 26)),
        ("3³ grid", grid(3), (8, 6)),
        ("10³ grid", grid(10), (8, 6)),
    ];
    for (name, points, expected) in solids {
        assert_eq!(counts::<N>(name, &points), expected, "{name}");
        assert_eq!(counts::<N>(name, &turned(&points, 1.0, 0.0)), expected, "{name}, turned");
        assert_eq!(counts::<N>(name, &turned(&points, 1e-23, 0.0)), expected, "{name}, tiny");
        assert_eq!(counts::<N>(name, &turned(&points, 1e6, 0.0)), expected, "{name}, huge");
        assert_eq!(counts::<N>(name, &turned(&points, 1.0, 30.0)), expected, "{name}, far");
    }
}

#[test]
fn known_solids_have_their_faces() {
    known_solids::<f32>();
    known_solids::<f64>();
}

#[test]
fn a_cube_of_size_one_a_million_away() {
    let far: Vec<P3> = cube().iter().map(|p| p + P3::new(1e6, -1e6, 1e6).coords).collect();
    assert_eq!(counts::<f32>("exact", &far), (8, 6), "whole numbers are exact");
    assert_eq!(counts::<f64>("exact", &far), (8, 6), "whole numbers are exact");
    assert_eq!(counts::<f64>("turned", &turned(&cube(), 1.0, 1e6)), (8, 6), "noise of 1e-10");
}

fn random<N: Real>() {
    let (vertices, _) = counts::<N>("8000 in a ball", &ball(8000));
    assert!((200..1000).contains(&vertices), "{vertices} of 8000 are on the hull");
    let (vertices, faces) = counts::<N>("2000 on a sphere", &sphere(2000));
    assert_eq!(vertices, 2000, "all are");
    assert!((3980..=3996).contains(&faces), "{faces}: triangles, but for neighbors flat by chance");
    let flat: Vec<P3> = ball(8000).iter().map(|p| P3::new(p.x, p.y, p.z * 1e-4)).collect();
    counts::<N>("a lens", &turned(&flat, 1.0, 0.0));
    let twice: Vec<P3> = ball(500).into_iter().flat_map(|p| [p, p, p]).collect();
    let hull = hull_of::<N>("each point three times", &twice);
    let thirds: Vec<usize> = hull.vertices.iter().map(|vertex| vertex / 3).collect();
    assert!(thirds.windows(2).all(|pair| pair[0] < pair[1]), "one of each three at most");
    assert_eq!(
        hull.vertices.len(),
        counts::<N>("each point once", &ball(500)).0,
        "no more vertices"
    );
}

#[test]
fn random_points() {
    random::<f32>();
    random::<f64>();
}

/// Tests points with few different whole coordinates, so that most points share planes and lines
/// with many others: they are refused as degenerate, or the hull passes all checks.
fn small_grids<N: Real>() {
    let mut numbers = Numbers::new(33);
    let (mut solids, mut flat) = (0, 0);
    for round in 0..600 {
        let size = f64::from(1 + round % 4);
        let mut point = || P3::from(numbers.vector().map(|x| ((x + 1.0) * 0.5 * size).round()));
        let points: Vec<P3> = (0..4 + round % 19).map(|_| point()).collect();
        let turned = turned(&points, 0.7, 0.0);
        for points in [points, turned] {
            if let Err(error) = convex_hull3(&cast::<N>(&points)) {
                assert!(matches!(error, ShapeError::Degenerate { .. }), "{error}");
                flat += 1;
            } else {
                hull_of::<N>("small grid", &points);
                let solid = ConvexHull::<N>::from_points(&cast(&points));
                assert_eq!(solid.validate(), Ok(()), "{points:?}");
                solids += 1;
            }
        }
    }
    assert!(solids > 800 && flat > 20, "{solids} solids, {flat} flat sets");
}

#[test]
fn points_of_small_grids() {
    small_grids::<f32>();
    small_grids::<f64>();
}

/// Asserts that the hull passes all checks for clouds of points, up to a thousand rounding units in
/// size, around the corners of a prism and around segments between its corners.
fn noise<N: Real>() {
    let mut numbers = Numbers::new(17);
    for units in [0.5, 1.0, 2.0, 4.0, 8.0, 30.0, 1e3] {
        let corners = turned(&prism(6), 1.0, 0.0);
        let mut points = Vec::new();
        for _ in 0..400 {
            let mut pick = || {
                let nearest = numbers.vector();
                let along = |p: &&P3| nearest.dot(&p.coords);
                corners.iter().max_by(|p, q| along(p).total_cmp(&along(q))).expect("twelve").coords
            };
            let (a, b) = (pick(), pick());
            let t = (numbers.next() * 2.0).clamp(-1.0, 1.0) * 0.5 + 0.5;
            let shake = numbers.vector() * (units * N::EPSILON.as_f64());
            points.push(P3::from(a * t + b * (1.0 - t) + shake));
        }
        let hull = hull_of::<N>("noise", &points);
        assert!(
            units > 4.0 || hull.vertices.len() < 60,
            "{units}: {} vertices",
            hull.vertices.len()
        );
        let solid = ConvexHull::<N>::from_points(&cast(&points));
        assert_eq!(solid.validate(), Ok(()), "noise of {units} units");
    }
}

#[test]
fn clouds_of_rounding_size() {
    noise::<f32>();
    noise::<f64>();
}

/// Asserts that the hull passes all checks for a smooth surface sampled so finely that neighbouring
/// points lie in one plane up to rounding.
#[test]
fn samples_finer_than_rounding() {
    for sides in [1000, 6000] {
        let hull = hull_of::<f32>("round prism", &prism(sides));
        assert!(hull.faces.iter().any(|face| face.len() > 300), "the caps are polygons");
        hull_of::<f64>("round prism", &prism(sides));
    }
    let cap: Vec<P3> =
        ball(6000).iter().map(|p| P3::new(p.x, p.y, 1e-5 * (p.x * p.x + p.y * p.y))).collect();
    hull_within::<f32>(32.0, "shallow dish", &cap);
    hull_of::<f64>("shallow dish", &cap);
}

fn slabs<N: Real>() {
    // Thicknesses from well above the rounding of the coordinates to below it.
    for units in [1e6, 1e4, 1e3, 100.0, 30.0, 10.0, 5.0, 3.0, 1.0, 0.1] {
        let points = slab(units * N::EPSILON.as_f64());
        let (level, tilted) = (cast::<N>(&points), cast::<N>(&turned(&points, 1.0, 0.0)));
        for points in [level, tilted] {
            let exact: Vec<P3> =
                points.iter().map(|p| Point::from(p.coords.map(Real::as_f64))).collect();
            match convex_hull3(&points) {
                Ok(_) => assert!(hull_of::<N>("slab", &exact).vertices.len() >= 4, "{units}"),
                Err(error) => {
                    assert_eq!(error, ShapeError::Degenerate { dimension: 2 }, "{units}");
                    assert!(units <= 5.0, "a slab {units} units thick is no plane");
                }
            }
        }
    }
}

/// Tests prisms barely thicker than rounding: the hull passes all checks, or points at most 5 units
/// in thickness are refused as flat.
fn sheets<N: Real>() {
    for sides in [3, 5, 16, 40] {
        for units in [1e3, 30.0, 10.0, 7.0, 5.0, 4.0] {
            let half = units * N::EPSILON.as_f64() / 2.0;
            let flattened = |p: &P3| P3::new(p.x, p.y, half.copysign(p.z));
            let points: Vec<P3> = prism(sides).iter().map(flattened).collect();
            match convex_hull3(&cast::<N>(&points)) {
                Ok(_) => drop(hull_of::<N>("sheet", &points)),
                Err(error) => {
                    assert_eq!(error, ShapeError::Degenerate { dimension: 2 }, "{units}");
                    assert!(units <= 5.0, "a sheet {units} units thick is no plane");
                }
            }
        }
    }
}

#[test]
fn sheets_keep_their_outline() {
    sheets::<f32>();
    sheets::<f64>();
}

#[test]
fn slabs_down_to_nothing() {
    slabs::<f32>();
    slabs::<f64>();
}

fn bad_input<N: Real>() {
    let p = |x: f64, y: f64, z: f64| P3::new(x, y, z);
    let line: Vec<P3> = (0..8).map(|i| p(f64::from(i), 2.0 * f64::from(i), 0.0)).collect();
    let plane = [p(0.0, 0.0, 1.0), p(1.0, 0.0, 1.0), p(0.0, 1.0, 1.0), p(1.0, 1.0, 1.0)];
    let degenerate = |dimension| Err(ShapeError::Degenerate { dimension });
    let few = |given| Err(ShapeError::TooFewPoints { given, needed: 4 });
    let cases = [
        (vec![], few(0)),
        (vec![p(1.0, 2.0, 3.0)], few(1)),
        (vec![p(1.0, 2.0, 3.0); 9], degenerate(0)),
        (vec![p(0.0, 0.0, 0.0); 9], degenerate(0)),
        (line.clone(), degenerate(1)),
        (turned(&line, 1.0, 5.0), degenerate(1)),
        (plane.to_vec(), degenerate(2)),
        (turned(&plane, 1e-20, 0.0), degenerate(2)),
    ];
    for (points, expected) in cases {
        let points = cast::<N>(&points);
        assert_eq!(convex_hull3(&points).map(|_| ()), expected, "{points:?}");
        assert_eq!(ConvexHull::try_from_points(&points).map(|_| ()), expected, "{points:?}");
    }
    for bad in [f64::NAN, f64::INFINITY, f64::NEG_INFINITY] {
        let mut points = cast::<N>(&cube());
        points[5].y = N::lit(bad);
        assert_eq!(convex_hull3(&points), Err(ShapeError::PointNotFinite { index: 5 }), "{bad}");
    }
}

#[test]
fn bad_input_is_named() {
    bad_input::<f32>();
    bad_input::<f64>();
}

#[test]
#[should_panic(expected = "the points span no solid: they lie on one line")]
fn the_panicking_constructor_says_why() {
    let _ =
        ConvexHull::<f32>::from_points(&[[0.0; 3], [1.0; 3], [2.0; 3], [3.0; 3]].map(Point::from));
}

/// Asserts that the hull of a cube is a cube at scales near the limits of the scalar, where
/// products of coordinates underflow or overflow unless the points are scaled first.
#[test]
fn the_ends_of_the_range() {
    for scale in [f32::MIN_POSITIVE, 1e-40, 1e30, f32::MAX] {
        let points: Vec<P3> = cube().iter().map(|p| p * f64::from(scale)).collect();
        assert_eq!(counts::<f32>("cube", &points), (8, 6), "{scale}");
        let solid = ConvexHull::from_points(&cast::<f32>(&points));
        let unit = solid.faces().iter().all(|face| (face.normal.norm() - 1.0).abs() < 1e-6);
        assert!(unit, "normals at {scale}");
    }
    for scale in [f64::MIN_POSITIVE, 1e-310, 1e300, f64::MAX] {
        let points: Vec<P3> = cube().iter().map(|p| p * scale).collect();
        assert_eq!(counts::<f64>("cube", &points), (8, 6), "{scale}");
    }
}

#[test]
fn scaling_by_a_power_of_two_changes_nothing() {
    let points = turned(&ball(300), 1.0, 0.3);
    let hull = convex_hull3(&cast::<f32>(&points));
    for power in [-70, -3, 1, 40] {
        let scaled: Vec<P3> = points
            .iter()
            .map(|p| P3::from(cast::<f32>(&[*p])[0].coords.map(f64::from)) * 2.0_f64.powi(power))
            .collect();
        assert_eq!(convex_hull3(&cast::<f32>(&scaled)), hull, "times 2^{power}");
    }
}

#[test]
#[ignore = "a measurement, for optimised builds"]
#[expect(clippy::print_stdout, reason = "the measurement is what it is for")]
fn time_of_large_hulls() {
    for count in [1_000, 10_000, 100_000] {
        for (name, points) in [("sphere", sphere(count)), ("ball", ball(count))] {
            let points = cast::<f32>(&points);
            let start = std::time::Instant::now();
            let hull = convex_hull3(&points).expect("a volume");
            let hulled = start.elapsed();
            let solid = ConvexHull::try_from_points(&points).expect("a volume");
            println!("{count} {name}: {hulled:?}, {:?} with the solid", start.elapsed() - hulled);
            assert_eq!(solid.faces().len(), hull.faces.len(), "the same hull");
        }
    }
}

/// Bug: corners at the rim of hulls almost as thin as rounding were taken for points in the middle of
/// a face, because the rounded height of a neighbor over the line through it was not exactly zero.
#[test]
fn rims_of_nearly_flat_hulls_keep_their_corners() {
    let five = [
        [2_742_737.5, -4_715_858.0, -566_647.312_5],
        [4_163_171.5, -2_182_100.0, -1_735_456.875],
        [-5_931_892.5, -7_724_595.5, 4_378_594.0],
        [-21_663_910.0, -324_940.906_25, 11_085_468.0],
        [1_946_969.5, 14_063_551.0, -3_465_121.5],
    ];
    let six = [
        [-2_351_941.5, -1_255_162.125, 843_616.312_5],
        [-5_935_322.5, -15_419.076_171_875, 1_966_076.875],
        [-8_398_209.0, 4_974_390.5, 2_523_742.25],
        [-7_055_822.5, -3_765_486.25, 2_530_855.25],
        [-9_518_706.0, 1_224_323.625, 3_088_529.0],
        [-10_750_150.0, 3_719_228.25, 3_367_359.5],
    ];
    assert_eq!(hull_of::<f32>("five", &five.map(P3::from)).vertices.len(), 5, "five points");
    // Some of the six lie on sides of the others within rounding.
    hull_of::<f32>("six", &six.map(P3::from));
}

/// Asserts that hulls of rotated discs, a few rounding units thick, keep their extents.
fn thin_discs<N: Real>() {
    let random = &mut Numbers::new(4);
    let mut solids = 0;
    for round in 0..samples(400) {
        let count = 8 + round % 23;
        let noise = (2.0 + f64::from(u8::try_from(round % 3).expect("few"))) * N::EPSILON.as_f64();
        let flat: Vec<P3> = (0..count)
            .map(|_| {
                let angle = std::f64::consts::PI * random.next();
                let radius = random.next().abs().sqrt();
                let height = noise * (random.next() - random.next());
                [radius * angle.cos(), radius * angle.sin(), height].into()
            })
            .collect();
        let points = turned(&flat, 1.0, 0.0);
        if convex_hull3(&cast::<N>(&points)).is_ok() {
            hull_of::<N>("disc", &points);
            solids += 1;
        }
    }
    assert!(solids > samples(100), "{solids} discs span a solid");
}

#[test]
fn thin_discs_keep_their_extents() {
    thin_discs::<f64>();
    thin_discs::<f32>();
}
