//! Tests formulas from textbooks, sizes of zero, and bad input.

use std::f64::consts::PI;

use impinge::math::na::UnitQuaternion;
use impinge::math::{Isometry3, Matrix, Point, Real, Unit, Vector};
use impinge::query::{MassError, MassProperties, mass_properties};
use impinge::shape::{
    Ball, Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Ellipsoid, HeightField,
    Plane, Rounded, Segment, Shape, TaperedCapsule, Tetrahedron, Triangle,
};

use super::{Found, Inertia, assert_alike, p2, p3, unit};

type V2 = Vector<f64, 2>;
type V3 = Vector<f64, 3>;

fn found3(mass: f64, center: [f64; 3], diagonal: [f64; 3]) -> Found<3> {
    (mass, V3::from(center), Matrix::<f64, 3>::from_diagonal(&V3::from(diagonal)))
}

fn found2(mass: f64, center: [f64; 2], inertia: f64) -> Found<2> {
    (mass, V2::from(center), Matrix::<f64, 2>::new(inertia, 0.0, 0.0, 0.0))
}

fn check3<N: Real>(name: &str, shape: &dyn Shape<N, 3>, expected: &Found<3>) {
    assert_alike(&unit(shape), expected, 4.0 * N::EPSILON.as_f64(), name);
}

fn check2<N: Real>(name: &str, shape: &dyn Shape<N, 2>, expected: &Found<2>) {
    assert_alike(&unit(shape), expected, 4.0 * N::EPSILON.as_f64(), name);
}

/// Compares solids with formulas from textbooks. All sizes are exact in `f32`.
fn solids_of_textbooks<N: Real>() {
    let l = N::lit;
    let ball = 4.0 / 3.0 * PI * 8.0;
    check3::<N>("ball", &Ball::new(l(2.0)), &found3(ball, [0.0; 3], [0.4 * ball * 4.0; 3]));
    let half = Vector::<N, 3>::new(l(0.5), l(1.0), l(3.0));
    let cuboid = found3(12.0, [0.0; 3], [40.0, 37.0, 5.0]);
    check3("cuboid", &Cuboid::new(half), &cuboid);
    let mass = 4.0 / 3.0 * PI * 1.5;
    let moments = [10.0, 9.25, 1.25].map(|sum| mass * sum / 5.0);
    check3("ellipsoid", &Ellipsoid::new(half), &found3(mass, [0.0; 3], moments));
    // The cylinder and the cone have the height 6 and the radius 2.
    let mass = PI * 4.0 * 6.0;
    let (across, along) = (mass * (3.0 * 4.0 + 36.0) / 12.0, mass * 2.0);
    let cylinder = found3(mass, [0.0; 3], [across, along, across]);
    check3::<N>("cylinder", &Cylinder::new(l(3.0), l(2.0)), &cylinder);
    let mass = PI * 4.0 * 6.0 / 3.0;
    let (across, along) = (mass * (0.15 * 4.0 + 3.0 / 80.0 * 36.0), mass * 0.3 * 4.0);
    let cone = found3(mass, [0.0, -1.5, 0.0], [across, along, across]);
    check3::<N>("cone", &Cone::new(l(3.0), l(2.0)), &cone);
    let (rod, ends) = (PI * 4.0 * 6.0, ball);
    let along = rod * 2.0 + ends * 0.4 * 4.0;
    let across = rod * (3.0 + 1.0) + ends * (0.4 * 4.0 + 36.0 / 4.0 + 3.0 / 8.0 * 6.0 * 2.0);
    let capsule = found3(rod + ends, [0.0; 3], [across, along, across]);
    check3("capsule", &Capsule::<N, 3>::new(l(3.0), l(2.0)), &capsule);
    let rounded = Rounded::new(Segment::new(point3(0.0, -3.0, 0.0), point3(0.0, 3.0, 0.0)), l(2.0));
    check3("rounded segment", &rounded, &capsule);
    check3(
        "rounded capsule",
        &Rounded::new(Capsule::<N, 3>::new(l(3.0), l(0.5)), l(1.5)),
        &capsule,
    );
    let equal = TaperedCapsule::<N, 3>::new(l(3.0), l(2.0), l(2.0));
    check3("tapered capsule of equal radii", &equal, &capsule);
    let swallowed = TaperedCapsule::<N, 3>::new(l(0.5), l(0.5), l(2.0));
    let ball = found3(ball, [0.0, 0.5, 0.0], [0.4 * ball * 4.0; 3]);
    check3("tapered capsule in its larger ball", &swallowed, &ball);
}

fn point3<N: Real>(x: f64, y: f64, z: f64) -> Point<N, 3> {
    Point::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z))
}

fn flat_sided_solids<N: Real>() {
    let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
    let corners = corners.map(|[x, y, z]| point3::<N>(x, y, z));
    let (beside, on) = (1.0 / 480.0, 1.0 / 80.0);
    let tensor = Matrix::<f64, 3>::from_fn(|row, column| if row == column { on } else { beside });
    let expected = (1.0 / 6.0, V3::repeat(0.25), tensor);
    check3("tetrahedron", &Tetrahedron::new(corners), &expected);
    check3("hull", &ConvexHull::from_points(&corners), &expected);
    // A triangle of area 6 with legs of 4 and 3: about its centre ∫ x² is A l² / 18, and ∫ x y is
    // -A l w / 36.
    let plate = Triangle::new(corners[0], point3(4.0, 0.0, 0.0), point3(0.0, 3.0, 0.0));
    let (x, y, xy) = (6.0 * 16.0 / 18.0, 3.0, -2.0);
    let tensor = Matrix::<f64, 3>::new(y, -xy, 0.0, -xy, x, 0.0, 0.0, 0.0, x + y);
    check3("plate", &plate, &(6.0, V3::new(4.0 / 3.0, 1.0, 0.0), tensor));
    let rod = Segment::new(point3::<N>(1.0, 0.0, 2.0), point3(1.0, 6.0, 2.0));
    check3("rod", &rod, &found3(6.0, [1.0, 3.0, 2.0], [18.0, 0.0, 18.0]));
}

#[test]
fn solids() {
    solids_of_textbooks::<f32>();
    solids_of_textbooks::<f64>();
    flat_sided_solids::<f32>();
    flat_sided_solids::<f64>();
}

fn plane_shapes<N: Real>() {
    let l = N::lit;
    check2::<N>("disk", &Ball::new(l(2.0)), &found2(4.0 * PI, [0.0; 2], 8.0 * PI));
    let half = Vector::<N, 2>::new(l(0.5), l(3.0));
    check2("rectangle", &Cuboid::new(half), &found2(6.0, [0.0; 2], 18.5));
    let mass = 1.5 * PI;
    check2("ellipse", &Ellipsoid::new(half), &found2(mass, [0.0; 2], mass * 9.25 / 4.0));
    // A stadium: a rectangle of 4 by 6 and two half disks, whose centres of mass are 8 / 3π from
    // their flat sides.
    let (rectangle, ends, shift) = (24.0, 4.0 * PI, 8.0 / 3.0 / PI);
    let inertia = rectangle * 52.0 / 12.0 + ends * (2.0 + 9.0 + 2.0 * 3.0 * shift);
    let stadium = found2(rectangle + ends, [0.0; 2], inertia);
    check2("capsule", &Capsule::<N, 2>::new(l(3.0), l(2.0)), &stadium);
    let p = |x: f64, y: f64| Point::<N, 2>::new(l(x), l(y));
    let triangle = found2(6.0, [4.0 / 3.0, 1.0], 6.0 * 25.0 / 18.0);
    check2("triangle", &Triangle::new(p(0.0, 0.0), p(4.0, 0.0), p(0.0, 3.0)), &triangle);
    check2("clockwise", &Triangle::new(p(0.0, 0.0), p(0.0, 3.0), p(4.0, 0.0)), &triangle);
    let corners = [p(1.0, 0.0), p(2.0, 1.0), p(1.0, 2.0), p(0.0, 1.0)];
    let square = found2(2.0, [1.0, 1.0], 2.0 / 3.0);
    check2("polygon", &ConvexPolygon::from_points(&corners), &square);
    let rod = Segment::new(p(1.0, 0.0), p(1.0, 6.0));
    check2("rod", &rod, &found2(6.0, [1.0, 3.0], 18.0));
}

#[test]
fn shapes_of_the_plane() {
    plane_shapes::<f32>();
    plane_shapes::<f64>();
}

/// Compares the volumes of solids rounded by the radius r with Steiner's formula V + S r + M r² +
/// 4/3 π r³. For the solid before rounding, V is the volume, S the area of the surface and M the
/// integral of its mean curvature.
#[test]
fn rounded_volumes() {
    let r = 0.5;
    let ball = 4.0 / 3.0 * PI * r * r * r;
    let volume = |shape: &dyn Shape<f64, 3>| unit(shape).0;
    let near = |found: f64, expected: f64, name: &str| {
        assert!((found / expected - 1.0).abs() < 4e-15, "{name}: {found}, not {expected}");
    };
    let square = |s: f64| s * s;
    let disk = Rounded::new(Cylinder::new(0.0, 2.0), r);
    near(volume(&disk), 2.0 * PI * 4.0 * r + PI * PI * 2.0 * square(r) + ball, "disk");
    let (surface, mean) = (2.0 * PI * 4.0 + 4.0 * PI * 6.0, PI * 6.0 + PI * PI * 2.0);
    let cylinder = Rounded::new(Cylinder::new(3.0, 2.0), r);
    near(volume(&cylinder), 24.0 * PI + surface * r + mean * square(r) + ball, "cylinder");
    // The slant height of the cone is 5, and the cosine of its angle at the apex is 4/5.
    let cone = Rounded::new(Cone::new(2.0, 3.0), r);
    let rim = (-3.0_f64 / 5.0).acos();
    let mean = PI * 5.0 * 0.8 + PI * 3.0 * rim;
    near(volume(&cone), 12.0 * PI + 24.0 * PI * r + mean * square(r) + ball, "cone");
    let flat = [p3(1.0, 1.0, 1.0), p3(5.0, 1.0, 1.0), p3(1.0, 4.0, 1.0)];
    let plate = Rounded::new(Triangle::new(flat[0], flat[1], flat[2]), r);
    near(volume(&plate), 2.0 * 6.0 * r + PI / 2.0 * 12.0 * square(r) + ball, "triangle");
    // A regular tetrahedron with edges of √8, whose dihedral angles have the cosine 1/3.
    let corners =
        [p3(1.0, 1.0, 1.0), p3(1.0, -1.0, -1.0), p3(-1.0, 1.0, -1.0), p3(-1.0, -1.0, 1.0)];
    let mean = 6.0 * 8.0_f64.sqrt() * (PI - (1.0_f64 / 3.0).acos()) / 2.0;
    let expected = 8.0 / 3.0 + 8.0 * 3.0_f64.sqrt() * r + mean * square(r) + ball;
    near(volume(&Rounded::new(Tetrahedron::new(corners), r)), expected, "tetrahedron");
    // A ball made as a rounded ellipsoid.
    let same = Rounded::new(Ellipsoid::new(V3::repeat(1.5)), r);
    assert_alike(&unit(&same), &unit(&Ball::new(2.0)), 1e-12, "a rounded ball");
    // An ellipsoid of height zero is a disk, so rounded it equals the rounded cylinder of height
    // zero.
    let flat = Rounded::new(Ellipsoid::new(V3::new(2.0, 0.0, 2.0)), r);
    assert_alike(&unit(&flat), &unit(&disk), 1e-8, "a rounded disk");
    let line = Rounded::new(Ellipsoid::new(V3::new(0.0, 3.0, 0.0)), r);
    assert_alike(&unit(&line), &unit(&Capsule::<f64, 3>::new(3.0, r)), 1e-8, "a rounded line");
}

#[test]
fn rounded_areas() {
    let (r, corners) = (0.5, [p2(0.0, 0.0), p2(4.0, 0.0), p2(0.0, 3.0)]);
    let expected = 6.0 + 12.0 * r + PI * r * r;
    let shapes: [Rounded<f64, 2>; 2] = [
        Rounded::new(Triangle::new(corners[0], corners[2], corners[1]), r),
        Rounded::new(ConvexPolygon::from_points(&corners), r),
    ];
    for shape in &shapes {
        assert!((unit(shape).0 - expected).abs() < 1e-14, "{:?}", unit(shape));
    }
    assert_alike(&unit(&shapes[0]), &unit(&shapes[1]), 1e-14, "one solid");
    let ellipse = Rounded::new(Ellipsoid::new(V2::new(1.5, 1.5)), r);
    assert_alike(&unit(&ellipse), &unit::<f64, 2>(&Ball::new(2.0)), 1e-12, "a disk");
    let line = Rounded::new(Ellipsoid::new(V2::new(0.0, 3.0)), r);
    assert_alike(&unit(&line), &unit(&Capsule::<f64, 2>::new(3.0, r)), 1e-8, "a stadium");
}

/// Compares the mass properties of a rounded hull, which are summed over its faces, with those of a
/// rounded box, which a product formula gives. The two share no code.
#[test]
fn rounded_polytopes_are_rounded_boxes() {
    let half = V3::new(0.5, 1.25, 2.0);
    let corner = |signs: u32| {
        V3::from_fn(|axis, _| if signs >> axis & 1 == 1 { half[axis] } else { -half[axis] })
    };
    let offset = V3::new(3.0, -2.0, 1.0);
    let corners: Vec<_> = (0..8).map(|signs| Point::from(corner(signs) + offset)).collect();
    for radius in [1e-3, 0.25, 40.0] {
        let hull = unit(&Rounded::new(ConvexHull::from_points(&corners), radius));
        let (mass, center, tensor) = unit(&Rounded::new(Cuboid::new(half), radius));
        assert_alike(&hull, &(mass, center + offset, tensor), 1e-13, "in 3D");
    }
    let half = V2::new(0.5, 1.25);
    let corner = |signs: u32| {
        V2::from_fn(|axis, _| if signs >> axis & 1 == 1 { half[axis] } else { -half[axis] })
    };
    let corners: Vec<_> = (0..4).map(|signs| Point::from(corner(signs))).collect();
    for radius in [1e-3, 0.25, 40.0] {
        let polygon = unit(&Rounded::new(ConvexPolygon::from_points(&corners), radius));
        assert_alike(&polygon, &unit(&Rounded::new(Cuboid::new(half), radius)), 1e-14, "in 2D");
    }
}

fn sizes_of_zero<N: Inertia<2> + Inertia<3>>() {
    let (zero, one) = (N::ZERO, N::ONE);
    let (a, b) = (point3::<N>(1.0, 2.0, 3.0), point3::<N>(1.0, 4.0, 3.0));
    let nothing: [&dyn Shape<N, 3>; 9] = [
        &Ball::new(zero),
        &Cuboid::new(Vector::<N, 3>::new(one, zero, one)),
        &Cylinder::new(zero, one),
        &Cylinder::new(one, zero),
        &Cone::new(one, zero),
        &Capsule::<N, 3>::new(one, zero),
        &Ellipsoid::new(Vector::<N, 3>::new(one, zero, one)),
        &Rounded::new(
            Triangle::new(point3(0.0, 0.0, 0.0), point3(1.0, 0.0, 0.0), point3(0.0, 0.0, 1.0)),
            zero,
        ),
        &Tetrahedron::new([
            point3(0.0, 0.0, 0.0),
            point3(1.0, 0.0, 0.0),
            point3(0.0, 0.0, 1.0),
            point3(1.0, 0.0, 1.0),
        ]),
    ];
    for shape in nothing {
        let body = mass_properties(shape, one).expect("no error");
        assert_eq!((body.mass(), body.inverse_mass()), (zero, zero), "{shape:?}");
        assert_eq!(body.inverse_inertia(), Matrix::<N, 3>::zeros(), "{shape:?}");
        assert!(body.center_of_mass().coords.norm() <= N::lit(1.5), "{shape:?} {body:?}");
    }
    let point = unit(&Segment::new(a, a));
    assert_eq!(point, (0.0, a.coords.map(N::as_f64), Matrix::<f64, 3>::zeros()), "a point");
    // A segment has no inertia about its own axis, so the inverse is zero there.
    let rod = mass_properties(&Segment::new(a, b), one).expect("a rod");
    let expected =
        Matrix::<N, 3>::from_diagonal(&Vector::<N, 3>::new(N::lit(1.5), zero, N::lit(1.5)));
    assert_eq!(rod.inverse_inertia(), expected, "about its ends alone");
    let ball = unit(&Rounded::new(Triangle::new(a, a, a), N::TWO));
    let (mass, _, tensor) = unit::<N, 3>(&Ball::new(N::TWO));
    let expected = (mass, a.coords.map(N::as_f64), tensor);
    assert_alike(&ball, &expected, 4.0 * N::EPSILON.as_f64(), "a rounded point");
    let line = Rounded::new(Triangle::new(b, a, a + (b - a) * N::HALF), N::HALF);
    let capsule = Capsule::try_from_ends(a, b, N::HALF).expect("numbers");
    assert_alike(&unit(&line), &unit(&capsule), 8.0 * N::EPSILON.as_f64(), "a rounded line");
    // The cross product of these sides is a rounding error in any direction.
    let ends =
        [[1.0 / 3.0, 0.2, 0.7], [5.0 / 3.0, 1.0, 3.5]].map(|end| Point::from(end.map(N::lit)));
    let line = Rounded::new(Triangle::new(Point::origin(), ends[0], ends[1]), N::TWO);
    let capsule = Capsule::try_from_ends(Point::origin(), ends[1], N::TWO).expect("numbers");
    assert_alike(&unit(&line), &unit(&capsule), 64.0 * N::EPSILON.as_f64(), "a tilted line");
    let (a, b) = (Point::<N, 2>::new(one, N::TWO), Point::<N, 2>::new(N::lit(3.0), N::TWO));
    let line = Rounded::new(Triangle::new(b, a, a + (b - a) * N::HALF), N::HALF);
    let capsule = Capsule::try_from_ends(a, b, N::HALF).expect("numbers");
    assert_alike(&unit(&line), &unit(&capsule), 8.0 * N::EPSILON.as_f64(), "a rounded line");
}

#[test]
fn sizes_of_zero_have_no_mass() {
    sizes_of_zero::<f32>();
    sizes_of_zero::<f64>();
}

#[test]
fn refusals_say_what_is_wrong() {
    let plane = Plane::<f64, 2>::new(Unit::new_unchecked(V2::y()));
    assert_eq!(mass_properties(&plane, 1.0), Err(MassError::Unbounded { part: 0 }));
    let field = HeightField::<f64, 2>::new(vec![0.0, 1.0], V2::new(1.0, 1.0));
    assert_eq!(mass_properties(&field, 1.0), Err(MassError::NotClosed { part: 0 }));
    let ball = Ball::new(1.0_f32);
    for (density, text) in [
        (-1.5, "the density is -1.5, below zero"),
        (f32::NAN, "the density is NaN, which is not finite"),
        (f32::INFINITY, "the density is inf, which is not finite"),
    ] {
        let refused = mass_properties::<f32, 3>(&ball, density).expect_err("no density");
        assert_eq!(refused.to_string(), text, "{density}");
    }
    let huge = mass_properties::<f32, 3>(&Ball::new(1e20), 1.0).expect_err("no mass of `f32`");
    assert_eq!(huge.to_string(), "the mass is inf, which is not finite");
    let huge = mass_properties::<f32, 3>(&Ball::new(1e9), 1.0).expect_err("its inertia");
    assert!(matches!(huge, MassError::NotFinite { what: "a moment of inertia", .. }), "{huge}");
    // A small density keeps the mass in range, but not the inertia.
    let light = mass_properties::<f32, 3>(&Ball::new(1e20), 1e-30).map(|body| body.mass());
    assert!(light.is_err(), "its inertia is 1e70");
    let numbers = |mass, inertia| MassProperties::<f64, 2>::try_new(Point::origin(), mass, inertia);
    assert!(numbers(1.0, 2.0).is_ok() && numbers(0.0, 0.0).is_ok(), "good numbers");
    assert!(matches!(numbers(-1.0, 2.0), Err(MassError::Negative { value: -1.0, .. })), "mass");
    assert!(matches!(numbers(1.0, f64::NAN), Err(MassError::NotFinite { .. })), "inertia");
    let tensor = Matrix::<f64, 3>::from_diagonal(&V3::new(1.0, -1e-3, 1.0));
    let refused = MassProperties::<f64, 3>::try_new(Point::origin(), 1.0, &tensor);
    assert!(matches!(refused, Err(MassError::Negative { .. })), "{refused:?}");
}

/// Asserts that mass properties made from principal moments return these unchanged, and their frame
/// up to rounding. Made anew from the resulting inertia, even the least moment has a relative error
/// below 1e-9.
#[test]
fn bodies_from_numbers() {
    let frame = UnitQuaternion::from_scaled_axis(V3::new(0.3, -1.2, 0.7));
    let (center, moments) = (p3(1.0, -2.0, 0.5), V3::new(1e-6, 2.0, 2.0 + 1e-9));
    let body = MassProperties::try_from_principal(center, 3.0, &moments, &frame).expect("numbers");
    assert_eq!(
        (body.mass(), body.center_of_mass(), body.principal_moments()),
        (3.0, &center, &moments)
    );
    assert!(body.principal_frame().angle_to(&frame) < 1e-15, "{:?}", body.principal_frame());
    let again = MassProperties::<f64, 3>::new(center, 3.0, &body.inertia());
    assert!((again.inertia() - body.inertia()).amax() < 1e-15, "by its tensor");
    let least = again.principal_moments().amin();
    assert!((least / 1e-6 - 1.0).abs() < 1e-9, "{least} beside two");
    let at = Isometry3::new(V3::new(9.0, 9.0, 9.0), V3::new(1.0, 2.0, 3.0));
    let product = body.inverse_inertia_at(&at) * body.inertia_at(&at);
    assert!((product - Matrix::<f64, 3>::identity()).amax() < 1e-9, "{product}");
    assert!((body.center_of_mass_at(&at) - at * center).norm() < 1e-15, "placed");
}
