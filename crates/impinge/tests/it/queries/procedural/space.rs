//! Tests the triangulated surfaces of solids in 3D.

use core::f64::consts::PI;

use impinge::math::{Point, Real, Vector};
use impinge::procedural::{TriangleSurface, space};
use impinge::shape::{
    Ball, Capsule, Cone, ConvexHull, Cuboid, Cylinder, Ellipsoid, TaperedCapsule, Tetrahedron,
    Triangle,
};
use impinge_reference::random::Random;
use impinge_reference::topology::{check_surface, highest_above, volume};

use super::{COUNTS, POWERS, assert_second_order, depth_in_club, doubles, epsilon};

type Vec3 = [f64; 3];

fn point<N: Real>(p: Vec3) -> Point<N, 3> {
    Point::from(Vector::<f64, 3>::from(p).map(N::lit))
}

fn faces<N: Real>(surface: &TriangleSurface<N>) -> Vec<Vec<usize>> {
    surface.triangles.iter().map(|t| t.iter().map(|&index| index as usize).collect()).collect()
}

fn volume_of<N: Real>(surface: &TriangleSurface<N>) -> f64 {
    volume(&doubles(&surface.vertices), &faces(surface))
}

fn area_of<N: Real>(surface: &TriangleSurface<N>) -> f64 {
    let area = |[a, b, c]: [Vector<f64, 3>; 3]| (b - a).cross(&(c - a)).norm() / 2.0;
    surface.corners().map(|t| area(t.map(|p| p.coords.map(N::as_f64)))).sum()
}

/// Asserts that the surface is closed, convex and faces outwards, with unit normals that point
/// outwards.
fn check_convex<N: Real>(surface: &TriangleSurface<N>, size: f64) {
    let (vertices, faces) = (doubles(&surface.vertices), faces(surface));
    assert_eq!(check_surface(&vertices, &faces), Ok(()), "closed, like a ball");
    // The normal across an edge of length l has an error of the noise over l.
    let noise = 512.0 * epsilon::<N>() * size;
    assert!(highest_above(&vertices, &faces, &vertices) <= noise, "convex and outward");
    assert!(volume(&vertices, &faces) > 0.0, "outward");
    let used: std::collections::BTreeSet<usize> = faces.iter().flatten().copied().collect();
    assert_eq!(used.len(), vertices.len(), "no vertex is left over");
    assert_eq!(surface.normals.len(), surface.triangles.len(), "normals for each triangle");
    for (corners, normals) in surface.corners().zip(&surface.normals) {
        let [a, b, c] = corners.map(|p| p.coords.map(N::as_f64));
        let flat = (b - a).cross(&(c - a)).normalize();
        for normal in normals.map(|normal| normal.map(N::as_f64)) {
            assert!((normal.norm() - 1.0).abs() <= 8.0 * epsilon::<N>(), "unit: {normal}");
            assert!(flat.dot(&normal) > 0.2, "outward: {normal} on {flat}");
        }
    }
}

/// Returns the greatest depth of a point of the triangles below the surface. Asserts that the
/// vertices are on the surface. `depth` is positive inside.
fn widest_gap<N: Real>(
    surface: &TriangleSurface<N>,
    size: f64,
    depth: impl Fn(&Vector<f64, 3>) -> f64,
) -> f64 {
    const PARTS: i32 = 12;
    let noise = 8.0 * epsilon::<N>() * size;
    let mut widest: f64 = 0.0;
    for corners in surface.corners() {
        let [a, b, c] = corners.map(|p| p.coords.map(N::as_f64));
        for corner in [a, b, c] {
            assert!(depth(&corner).abs() <= noise, "{corner} is {} deep", depth(&corner));
        }
        for (i, j) in (0..=PARTS).flat_map(|i| (0..=PARTS - i).map(move |j| (i, j))) {
            let [u, v] = [i, j].map(|k| f64::from(k) / f64::from(PARTS));
            let inside = depth(&(a * (1.0 - u - v) + b * u + c * v));
            assert!(inside >= -noise, "inscribed: {inside}");
            widest = widest.max(inside);
        }
    }
    widest
}

fn assert_gap<N: Real>(found: f64, stated: f64, size: f64) {
    assert!(found <= stated + 8.0 * epsilon::<N>() * size, "{found} is more than {stated}");
    assert!(found > 0.4 * stated, "{found} is far from {stated}");
}

fn assert_counts<N: Real>(surface: &TriangleSurface<N>, vertices: u32, triangles: u32) {
    let counts = (surface.vertices.len(), surface.triangles.len());
    assert_eq!(counts, (vertices as usize, triangles as usize), "as documented");
}

fn balls<N: Real>() {
    for count in COUNTS {
        let surface = space::ball(&Ball::new(N::lit(1.5)), count);
        let (n, k) = (count.max(3), count.max(3).div_ceil(4));
        assert_counts(&surface, 2 + n * (2 * k - 1), 2 * n * (2 * k - 1));
        check_convex(&surface, 1.5);
        let gap = widest_gap(&surface, 1.5, |p| 1.5 - p.norm());
        assert_gap::<N>(gap, 1.5 * (PI / f64::from(n)).sin().powi(2), 1.5);
        for (corners, normals) in surface.corners().zip(&surface.normals) {
            for (corner, normal) in corners.iter().zip(normals) {
                let off = (corner.coords / N::lit(1.5) - normal).norm().as_f64();
                assert!(off <= 4.0 * epsilon::<N>(), "normals of a ball point from its middle");
            }
        }
    }
    let ball = |count| space::ball(&Ball::new(N::lit(1.5)), count);
    assert_second_order("volume of a ball", 4.0 / 3.0 * PI * 3.375, |n| volume_of(&ball(n)));
    assert_second_order("area of a ball", 4.0 * PI * 2.25, |n| area_of(&ball(n)));
}

fn capsules<N: Real>() {
    let mut random = Random::new(11);
    for count in COUNTS {
        let [a, b] = [0, 1].map(|_| [0, 1, 2].map(|_| random.range(-3.0, 3.0)));
        let capsule =
            Capsule::try_from_ends(point::<N>(a), point(b), N::lit(0.75)).expect("good numbers");
        let [a, b] =
            [capsule.segment().a(), capsule.segment().b()].map(|end| end.coords.map(N::as_f64));
        let surface = space::capsule(&capsule, count);
        let (n, k) = (count.max(3), count.max(3).div_ceil(4));
        assert_counts(&surface, 2 + 2 * n * k, 4 * n * k);
        check_convex(&surface, 6.0);
        let depth = |p: &Vector<f64, 3>| {
            let share = (p - a).dot(&(b - a)) / (b - a).norm_squared();
            0.75 - (p - a - (b - a) * share.clamp(0.0, 1.0)).norm()
        };
        let gap = widest_gap(&surface, 6.0, depth);
        assert_gap::<N>(gap, 0.75 * (PI / f64::from(n)).sin().powi(2), 6.0);
    }
    let upright = Capsule::new(N::lit(2.0), N::lit(0.5));
    let capsule = |count| space::capsule(&upright, count);
    let first = capsule(8).vertices[0];
    assert_eq!(first, point([0.0, 2.5, 0.0]), "the pole beyond the second end");
    let (side, ends) = (PI * 0.25 * 4.0, 4.0 / 3.0 * PI * 0.125);
    assert_second_order("volume of a capsule", side + ends, |n| volume_of(&capsule(n)));
    assert_second_order("area of a capsule", PI * 4.0 + PI, |n| area_of(&capsule(n)));
}

fn cylinders<N: Real>() {
    let cylinder = |count| space::cylinder(&Cylinder::new(N::lit(2.0), N::lit(0.5)), count);
    for count in COUNTS {
        let (surface, n) = (cylinder(count), count.max(3));
        assert_counts(&surface, 2 + 2 * n, 4 * n);
        check_convex(&surface, 2.0);
        let depth = |p: &Vector<f64, 3>| (0.5 - p.x.hypot(p.z)).min(2.0 - p.y.abs());
        let gap = widest_gap(&surface, 2.0, depth);
        assert_gap::<N>(gap, 0.5 * (1.0 - (PI / f64::from(n)).cos()), 2.0);
    }
    assert_second_order("volume of a cylinder", PI, |n| volume_of(&cylinder(n)));
    assert_second_order("area of a cylinder", PI * 4.5, |n| area_of(&cylinder(n)));
}

fn cones<N: Real>() {
    let cone = |count| space::cone(&Cone::new(N::lit(2.0), N::lit(3.0)), count);
    for count in COUNTS {
        let (surface, n) = (cone(count), count.max(3));
        assert_counts(&surface, 2 + n, 2 * n);
        check_convex(&surface, 3.0);
        // Height 4 over a radius of 3: the slant height is 5.
        let depth = |p: &Vector<f64, 3>| {
            let side = ((2.0 - p.y) * 3.0 - p.x.hypot(p.z) * 4.0) / 5.0;
            side.min(p.y + 2.0)
        };
        let gap = widest_gap(&surface, 3.0, depth);
        assert_gap::<N>(gap, 3.0 * (1.0 - (PI / f64::from(n)).cos()), 3.0);
        let at_tip =
            surface.triangles.iter().zip(&surface.normals).flat_map(|(triangle, normals)| {
                let [a, b, c] = triangle.map(|index| surface.vertices[index as usize]);
                let sides = [c - b, a - c, b - a];
                (0..3)
                    .filter(|&k| triangle[k] == 0)
                    .map(move |k| sides[k].dot(&normals[k]).as_f64())
            });
        let leans: Vec<f64> = at_tip.collect();
        assert_eq!(leans.len(), n as usize, "each side has a normal at the tip");
        let is_middle = |lean: &f64| lean.abs() <= 32.0 * epsilon::<N>();
        assert!(leans.iter().all(is_middle), "square to the rim: {leans:?}");
        let slope = surface.normals[0][0].map(N::as_f64);
        assert!((slope.y - 0.6).abs() <= 4.0 * epsilon::<N>(), "by hand: {slope}");
    }
    assert_second_order("volume of a cone", PI * 9.0 * 4.0 / 3.0, |n| volume_of(&cone(n)));
    assert_second_order("area of a cone", PI * 9.0 + PI * 15.0, |n| area_of(&cone(n)));
}

fn flat_faces<N: Real>() {
    let cuboid = Cuboid::new(Vector::<N, 3>::new(N::lit(1.0), N::lit(2.0), N::lit(3.0)));
    let surface = space::cuboid(&cuboid);
    check_convex(&surface, 3.0);
    assert_eq!((volume_of(&surface), area_of(&surface)), (48.0, 88.0), "by hand");
    for (face, normals) in surface.normals.iter().enumerate() {
        let sign = if face / 2 % 2 == 0 { 1.0 } else { -1.0 };
        assert_eq!(normals[0][face / 4].as_f64(), sign, "two triangles per face, in order");
    }
    let [a, b, c] = [[0.0, 0.0, 0.0], [4.0, 0.0, 0.0], [0.0, 0.0, 3.0]].map(point::<N>);
    let surface = space::triangle(&Triangle::new(a, b, c));
    assert_eq!(check_surface(&doubles(&surface.vertices), &faces(&surface)), Ok(()), "closed");
    assert_eq!((volume_of(&surface), area_of(&surface)), (0.0, 12.0), "two sides of 6");
    for (triangle, expected) in [(0, -1.0), (1, 1.0)] {
        let y = surface.normals[triangle][0].y.as_f64();
        assert!((y - expected).abs() <= 2.0 * epsilon::<N>(), "x towards z turns about -y: {y}");
    }
}

fn ellipsoids<N: Real>() {
    let half_axes = Vector::<f64, 3>::new(0.8, 1.25, 1.0);
    let solid = Ellipsoid::new(half_axes.map(N::lit));
    for count in COUNTS {
        let surface = space::ellipsoid(&solid, count);
        check_convex(&surface, 2.0);
        for corner in surface.corners().flatten() {
            let level = corner.coords.map(N::as_f64).component_div(&half_axes).norm();
            assert!((level - 1.0).abs() <= 8.0 * epsilon::<N>(), "{corner} is at {level}");
        }
        for (corners, normals) in surface.corners().zip(&surface.normals) {
            for (corner, normal) in corners.iter().zip(normals) {
                let place = corner.coords.map(N::as_f64);
                let slope = place.component_div(&half_axes.component_mul(&half_axes)).normalize();
                let off = (slope - normal.map(N::as_f64)).norm();
                assert!(off <= 16.0 * epsilon::<N>(), "{normal} at {corner}");
            }
        }
    }
    assert_second_order("volume of an ellipsoid", 4.0 / 3.0 * PI, |count| {
        volume_of(&space::ellipsoid(&solid, count))
    });
}

fn tapered_capsules<N: Real>() {
    let mut random = Random::new(13);
    for count in COUNTS {
        let ends = [0, 1].map(|_| [0, 1, 2].map(|_| random.range(-3.0, 3.0)));
        let radii = [random.range(0.2, 0.8), random.range(0.2, 0.8)];
        let [a, b] = ends.map(point::<N>);
        let solid = TaperedCapsule::try_from_ends(a, b, radii.map(N::lit)).expect("good numbers");
        let surface = space::tapered_capsule(&solid, count);
        let (n, k) = (count.max(3), count.max(3).div_ceil(4));
        assert!(surface.vertices.len() <= (2 + n * (2 * k + 1)) as usize, "at most");
        check_convex(&surface, 6.0);
        let ends = [a, b].map(|end| end.coords.map(N::as_f64));
        let radii = solid.radii().map(N::as_f64);
        let gap = widest_gap(&surface, 6.0, |p| depth_in_club(p, ends, radii));
        let stated = radii[0].max(radii[1]) * (PI / f64::from(n)).sin().powi(2);
        assert!(gap <= stated + 48.0 * epsilon::<N>(), "{gap} of {stated}");
    }
    let ball = TaperedCapsule::<N, 3>::new(N::HALF, N::TWO, N::ONE);
    let surface = space::tapered_capsule(&ball, 12);
    let away = |p: &Point<N, 3>| (p.coords.map(N::as_f64) + Vector::<f64, 3>::y() * 0.5).norm();
    assert!(
        surface.vertices.iter().all(|p| (away(p) - 2.0).abs() < 8.0 * epsilon::<N>()),
        "a ball"
    );
}

fn tetrahedra<N: Real>() {
    let [a, b, c, d] =
        [[0.0; 3], [2.0, 0.0, 0.0], [0.0, 3.0, 0.0], [0.0, 0.0, 4.0]].map(point::<N>);
    for corners in [[a, b, c, d], [b, a, c, d]] {
        let surface = space::tetrahedron(&Tetrahedron::new(corners));
        check_convex(&surface, 4.0);
        assert_eq!(volume_of(&surface), 4.0, "a sixth of 24");
        assert_eq!(surface.vertices, corners, "its own");
    }
}

fn hulls<N: Real>() {
    let mut random = Random::new(5);
    for count in [4, 8, 30, 120] {
        let points: Vec<Point<N, 3>> =
            (0..count).map(|_| point([0, 1, 2].map(|_| random.range(-1.0, 1.0)))).collect();
        let hull = ConvexHull::from_points(&points);
        let surface = space::convex_hull(&hull);
        check_convex(&surface, 1.0);
        assert_eq!(surface.vertices, hull.vertices(), "the hull's own");
        assert_eq!(surface.triangles.len(), 2 * hull.vertices().len() - 4, "Euler");
        let farthest =
            highest_above(&doubles(hull.vertices()), &faces(&surface), &doubles(&points));
        assert!(farthest <= 64.0 * epsilon::<N>(), "every point is inside: {farthest}");
    }
    // The hull of a prism has polygons of more than three corners.
    let top = space::cylinder(&Cylinder::new(N::ONE, N::ONE), 9);
    let hull = ConvexHull::from_points(&top.vertices);
    let surface = space::convex_hull(&hull);
    assert_eq!((hull.faces().len(), surface.triangles.len()), (11, 32), "two of 7, nine of 2");
    assert!(
        (volume_of(&surface) / volume_of(&top) - 1.0).abs() < 64.0 * epsilon::<N>(),
        "the same"
    );
}

fn powers_of_two_scale<N: Real>() {
    for power in POWERS.map(N::lit) {
        let surfaces = |scale: N| {
            let size = |value: f64| N::lit(value) * scale;
            let [a, b] = [[0.3, 0.7, 0.1], [-1.1, 0.4, 0.9]]
                .map(|p| Point::from(point::<N>(p).coords * scale));
            [
                space::ball(&Ball::new(size(1.3)), 11),
                space::capsule(&Capsule::try_from_ends(a, b, size(0.6)).expect("good numbers"), 9),
                space::cylinder(&Cylinder::new(size(0.7), size(0.3)), 7),
                space::cone(&Cone::new(size(0.7), size(0.3)), 7),
                space::ellipsoid(
                    &Ellipsoid::new(Vector::<N, 3>::new(size(1.3), size(0.4), size(0.6))),
                    7,
                ),
                space::tapered_capsule(
                    &TaperedCapsule::try_from_ends(a, b, [size(0.6), size(0.2)]).expect("numbers"),
                    9,
                ),
            ]
        };
        let mut grown = surfaces(N::ONE);
        for vertex in grown.iter_mut().flat_map(|surface| &mut surface.vertices) {
            *vertex = Point::from(vertex.coords * power);
        }
        assert_eq!(grown, surfaces(power), "bit by bit, normals and all, at {power}");
    }
}

fn nothing_is_no_trouble<N: Real>() {
    let (zero, one) = (N::ZERO, N::ONE);
    let middle = Point::<N, 3>::new(one, one, one);
    let surfaces = [
        (space::ball(&Ball::new(zero), 8), 2 + 8 * 3),
        (
            space::capsule(&Capsule::try_from_ends(middle, middle, zero).expect("good numbers"), 8),
            2 + 8 * 4,
        ),
        (space::cylinder(&Cylinder::new(zero, one), 8), 18),
        (space::ellipsoid(&Ellipsoid::new(Vector::<N, 3>::new(one, zero, one)), 8), 2 + 8 * 3),
        (space::ellipsoid(&Ellipsoid::new(Vector::<N, 3>::zeros()), 8), 2 + 8 * 3),
        (space::tapered_capsule(&TaperedCapsule::<N, 3>::new(one, zero, zero), 8), 2 + 8 * 4),
        (space::tetrahedron(&Tetrahedron::new([middle; 4])), 4),
        (space::cylinder(&Cylinder::new(one, zero), 8), 18),
        (space::cone(&Cone::new(zero, one), 8), 10),
        (space::cone(&Cone::new(zero, zero), 8), 10),
        (space::cuboid(&Cuboid::new(Vector::<N, 3>::new(one, zero, one))), 8),
        (space::triangle(&Triangle::new(middle, middle, middle)), 3),
    ];
    for (surface, count) in &surfaces {
        assert_eq!(surface.vertices.len(), *count, "as many as ever");
        assert!(
            surface.vertices.iter().flat_map(Point::iter).all(|x| x.is_finite_number()),
            "finite"
        );
        for normal in surface.normals.iter().flatten() {
            let length = normal.norm().as_f64();
            assert!((length - 1.0).abs() < 8.0 * epsilon::<N>(), "unit: {normal}");
        }
    }
    let huge = space::cone(&Cone::new(N::MAX, N::MAX), 5);
    let slope = huge.normals[0][0].map(N::as_f64);
    assert!((slope.y - 0.2_f64.sqrt()).abs() < 8.0 * epsilon::<N>(), "no overflow: {slope}");
}

fn all<N: Real>() {
    balls::<N>();
    capsules::<N>();
    cylinders::<N>();
    cones::<N>();
    flat_faces::<N>();
    hulls::<N>();
    ellipsoids::<N>();
    tapered_capsules::<N>();
    tetrahedra::<N>();
    powers_of_two_scale::<N>();
    nothing_is_no_trouble::<N>();
}

#[test]
fn surfaces_f32() {
    all::<f32>();
}

#[test]
#[cfg(feature = "f64")]
fn surfaces_f64() {
    all::<f64>();
}
