//! Tests laws of the mass properties of every shape.

use crate::support::query_support::random::Random;
use crate::support::shape_table::{self, Shapes};

use impinge::math::{
    AbstractRotation, Isometry, Isometry2, Isometry3, Matrix, Point, Space, Vector,
};
use impinge::query::{MassError, MassProperties, mass_properties};
use impinge::shape::{
    Ball, Capsule, Compound, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Rounded, Segment, Shape,
    ShapeHandle, TaperedCapsule,
};

use super::{Inertia, assert_alike, p3, unit, wide};

type V3 = Vector<f64, 3>;

/// Asserts that scaling a shape by a power of two scales its mass properties exactly. Segments and
/// flat triangles, whose measure is a length or an area, have their own test.
fn scales_exactly<N: Inertia<D>, const D: usize>(table: fn(N) -> Shapes<N, D>) {
    let (plain, mut tried) = (table(N::ONE), 0);
    for power in [0.0625, 1024.0, 1.0 / 1_048_576.0] {
        let scale = N::lit(power);
        let measure = (0..D).fold(1.0, |measure, _| measure * power);
        for ((name, shape), (_, scaled)) in plain.iter().zip(table(scale)) {
            let found = mass_properties(&**shape, N::ONE);
            let scaled = mass_properties(&*scaled, N::ONE);
            let (Ok(found), Ok(scaled)) = (found, scaled) else {
                assert_eq!(found.map(drop), scaled.map(drop), "{name} is refused alike");
                continue;
            };
            let own_measure =
                ["segment", "pieces"].contains(name) || (D == 3 && *name == "triangle");
            if own_measure {
                continue;
            }
            tried += 1;
            let (mass, center, tensor) = wide(&found);
            let expected = (mass * measure, center * power, tensor * (measure * power * power));
            assert_eq!(wide(&scaled), expected, "{name} by {power}");
        }
    }
    assert!(tried > 25, "{tried} shapes");
}

#[test]
fn powers_of_two_scale_exactly() {
    scales_exactly::<f32, 2>(shape_table::plane);
    scales_exactly::<f64, 2>(shape_table::plane);
    scales_exactly::<f32, 3>(shape_table::space);
    scales_exactly::<f64, 3>(shape_table::space);
}

/// Asserts that the mass of a segment scales with its length, and the mass of a flat triangle with
/// its area.
#[test]
fn rods_and_plates_scale_by_their_own_measure() {
    let corners =
        |scale: f64| [p3(0.0, 0.0, 0.0), p3(1.0, 2.0, 0.0), p3(0.5, 1.0, 3.0)].map(|p| p * scale);
    let [a, b, c] = corners(1.0);
    let [d, e, f] = corners(32.0);
    let (rod, long) = (unit(&Segment::new(a, b)), unit(&Segment::new(d, e)));
    assert_eq!(long, (rod.0 * 32.0, rod.1 * 32.0, rod.2 * 32.0_f64.powi(3)), "a rod");
    let plate = unit(&impinge::shape::Triangle::new(a, b, c));
    let large = unit(&impinge::shape::Triangle::new(d, e, f));
    assert_eq!(large, (plate.0 * 1024.0, plate.1 * 32.0, plate.2 * 1024.0 * 1024.0), "a plate");
}

/// Asserts that both scalars give results that agree within 1e-6 of their size, or 2e-4 for a
/// custom support map.
fn scalars_agree<const D: usize>(single: &Shapes<f32, D>, double: &Shapes<f64, D>)
where
    f32: Inertia<D>,
    f64: Inertia<D>,
{
    for ((name, one), (_, other)) in single.iter().zip(double) {
        let (one, other) = (mass_properties(&**one, 1.5), mass_properties(&**other, 1.5));
        let (Ok(one), Ok(other)) = (one, other) else { continue };
        // Support points are rounded, and so are the slices of a general support map, which lose
        // more.
        let share = if *name == "support map" { 2e-4 } else { 1e-6 };
        assert_alike(&wide(&one), &wide(&other), share, name);
    }
}

#[test]
fn scalars_say_the_same() {
    scalars_agree(&shape_table::plane(1.0), &shape_table::plane(1.0));
    scalars_agree(&shape_table::space(1.0), &shape_table::space(1.0));
}

/// Asserts up to rounding that the mass properties of a shape, transformed by a pose, equal those
/// of a compound with the shape at that pose as its only child.
fn places<N, R, const D: usize>(shapes: &Shapes<N, D>, turn: fn(&mut Random) -> R)
where
    N: Inertia<D> + Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Copy,
{
    let random = &mut Random(1, false);
    for (name, shape) in shapes {
        let Ok(body) = mass_properties(&**shape, N::lit(2.0)) else { continue };
        let place =
            Isometry::from_parts((random.vector::<N, D>() * N::lit(5.0)).into(), turn(random));
        let compound = Compound::new(vec![(place, shape.clone())]);
        let found = mass_properties(&compound, N::lit(2.0)).expect("as the child");
        let expected = body.transformed(&place);
        assert_alike(&wide(&found), &wide(&expected), 16.0 * N::EPSILON.as_f64(), name);
        let moved = place.transform_point(body.center_of_mass());
        assert_eq!(body.center_of_mass_at(&place), moved, "{name}");
    }
}

#[test]
fn bodies_are_placed() {
    places::<f32, _, 2>(&shape_table::plane(1.0), Random::turn2);
    places::<f64, _, 2>(&shape_table::plane(1.0), Random::turn2);
    places::<f32, _, 3>(&shape_table::space(1.0), Random::turn3);
    places::<f64, _, 3>(&shape_table::space(1.0), Random::turn3);
}

/// Asserts that the mass properties of the eight pieces of a cut box sum to those of the box, both
/// if they are added and if the pieces form a compound. Subtracting seven pieces must leave the
/// eighth.
fn cut_into_eight<N: Inertia<3> + Space<3, Isometry = Isometry3<N>>>() {
    let (low, cut, high) = ([-1.0, -2.0, 0.0], [0.25, 1.0, 0.5], [3.0, 2.0, 4.0]);
    let piece = |index: usize| {
        let is_low = |axis: usize| index >> axis & 1 == 0;
        let ends = |axis: usize| {
            if is_low(axis) { [low[axis], cut[axis]] } else { [cut[axis], high[axis]] }
        };
        let half = Vector::<N, 3>::from_fn(|axis, _| N::lit((ends(axis)[1] - ends(axis)[0]) * 0.5));
        let middle =
            Vector::<N, 3>::from_fn(|axis, _| N::lit((ends(axis)[1] + ends(axis)[0]) * 0.5));
        (Isometry3::from_parts(middle.into(), Default::default()), Cuboid::new(half))
    };
    let pieces: Vec<_> = (0..8).map(piece).collect();
    let whole = Cuboid::new(Vector::<N, 3>::new(N::TWO, N::TWO, N::TWO));
    let middle = Isometry3::translation(N::ONE, N::ZERO, N::TWO);
    let whole = mass_properties(&whole, N::lit(3.0)).expect("a box").transformed(&middle);
    let share = 8.0 * N::EPSILON.as_f64();
    let body = |(place, cuboid): &(Isometry3<N>, Cuboid<N, 3>)| {
        mass_properties(cuboid, N::lit(3.0)).expect("a box").transformed(place)
    };
    let sum: MassProperties<N, 3> = pieces.iter().map(body).sum();
    assert_alike(&wide(&sum), &wide(&whole), share, "the sum of bodies");
    let children = pieces.iter().map(|(place, cuboid)| (*place, ShapeHandle::new(*cuboid)));
    let compound = mass_properties(&Compound::new(children.collect()), N::lit(3.0)).expect("boxes");
    assert_alike(&wide(&compound), &wide(&whole), share, "the compound");
    let mut rest = whole;
    for piece in &pieces[..7] {
        rest -= body(piece);
    }
    assert_alike(&wide(&rest), &wide(&body(&pieces[7])), share * 64.0, "what is left");
    rest -= body(&pieces[7]);
    assert!(rest.mass() <= whole.mass() * N::EPSILON * N::lit(16.0), "nothing is left: {rest:?}");
}

#[test]
fn pieces_of_a_box_are_the_box() {
    cut_into_eight::<f32>();
    cut_into_eight::<f64>();
}

#[test]
fn sums_do_not_depend_on_the_order() {
    let one = mass_properties(&Cuboid::new(V3::new(1.0, 2.0, 3.0)), 0.7).expect("a box");
    let place = Isometry3::new(V3::new(0.3, -4.0, 1e6), V3::new(1.0, 0.2, -0.7));
    let other = mass_properties(&Capsule::<f64, 3>::new(1.0, 0.3), 5.0).expect("a capsule");
    let other = other.transformed(&place);
    assert_eq!(wide(&(one + other)), wide(&(other + one)), "to the last bit");
    let twice = one + one;
    assert_eq!(twice.center_of_mass(), one.center_of_mass(), "it stays");
    let nothing = MassProperties::<f64, 3>::default();
    assert_alike(&wide(&(one + nothing)), &wide(&one), 1e-15, "and nothing");
    let hollow = mass_properties(&Ball::new(2.0), 1.0).expect("a ball")
        - mass_properties(&Ball::new(1.5), 1.0).expect("a ball");
    let expected = 0.4 * hollow.mass() * (32.0 - 1.5_f64.powi(5)) / (8.0 - 1.5_f64.powi(3));
    let found: MassProperties<f64, 3> = hollow;
    assert!((found.inertia()[(0, 0)] / expected - 1.0).abs() < 1e-14, "a shell");
}

/// Tests the parallel axis theorem with a body and its mirror image.
#[test]
fn inertia_about_other_points() {
    let body = mass_properties(&Cuboid::new(V3::new(1.0, 2.0, 3.0)), 0.7).expect("a box");
    let point = p3(2.0, -1.0, 0.5);
    // The mirror image of the body at the point: the point is the centre of mass of both together.
    let mirrored = Isometry3::translation(4.0, -2.0, 1.0);
    let both = body + body.transformed(&mirrored);
    assert!((both.center_of_mass() - point).norm() < 1e-15, "{both:?}");
    let difference = both.inertia() - body.inertia_about(&point) * 2.0;
    assert!(difference.amax() < 1e-12, "{difference}");
    let plate = mass_properties(&Cuboid::new(Vector::<f64, 2>::new(1.0, 2.0)), 0.7).expect("a box");
    let both = plate + plate.transformed(&Isometry2::translation(4.0, -2.0));
    let about = plate.inertia_about(&Point::<f64, 2>::new(2.0, -1.0));
    assert!((both.inertia() - 2.0 * about).abs() < 1e-13, "in 2D");
}

/// Tests hulls and polygons a million units from the origin, with corners that the scalar
/// represents exactly: the centre of mass has a rounding error of that distance, and in `f64` the
/// mass and the inertia equal those near the origin.
fn far_away<N: Inertia<2> + Inertia<3>>() {
    let grid = |x: f64| (x * 8.0).round() / 8.0;
    let corners: Vec<[f64; 3]> = (0..12_u32)
        .map(f64::from)
        .map(|k| [grid(3.0 * (k * 1.7).sin()), grid(3.0 * (k * 2.9).cos()), grid(k * 0.4)])
        .collect();
    let far = 1_048_576.0;
    let hull = |offset: f64| {
        let place = |corner: &[f64; 3]| {
            Point::from(Vector::<N, 3>::from(corner.map(|x| N::lit(x + offset))))
        };
        ConvexHull::from_points(&corners.iter().map(place).collect::<Vec<_>>())
    };
    let polygon = |offset: f64| {
        let place = |c: &[f64; 3]| Point::<N, 2>::new(N::lit(c[0] + offset), N::lit(c[1] + offset));
        ConvexPolygon::from_points(&corners.iter().map(place).collect::<Vec<_>>())
    };
    for radius in [N::ZERO, N::HALF] {
        let [near, away] = [0.0, far].map(|offset| unit(&Rounded::new(hull(offset), radius)));
        let shift = V3::repeat(far);
        let expected = (near.0, near.1 + shift, near.2);
        let off = (away.1 - expected.1).amax();
        assert!(off <= far * N::EPSILON.as_f64(), "the centre is off by {off}");
        // In `f32` hulls and polygons are coarser: their tolerance is proportional to the greatest
        // coordinate.
        if N::EPSILON.as_f64() < 1e-10 {
            assert_alike(&away, &(near.0, away.1, near.2), 8.0 * N::EPSILON.as_f64(), "a hull");
        }
        let [near, away] = [0.0, far].map(|offset| unit(&Rounded::new(polygon(offset), radius)));
        if N::EPSILON.as_f64() < 1e-10 {
            assert_alike(&away, &(near.0, away.1, near.2), 8.0 * N::EPSILON.as_f64(), "a polygon");
        }
    }
}

#[test]
fn far_from_the_origin() {
    far_away::<f32>();
    far_away::<f64>();
}

/// Tests thin solids in any direction: each principal moment is precise, and the inverses are
/// positive.
fn needles<N: Inertia<3> + Space<3, Isometry = Isometry3<N>>>(thin: f64, share: f64) {
    let random = &mut Random(3, false);
    for _ in 0..20 {
        let axis = random.direction::<N, 3>();
        let (a, b) = (Point::from(axis * N::lit(5.0)), Point::from(axis * N::lit(-5.0)));
        let radius = N::lit(thin);
        let needle = Capsule::try_from_ends(a, b, radius).expect("numbers");
        let body = mass_properties(&needle, N::ONE).expect("a needle");
        let along =
            mass_properties(&Capsule::<N, 3>::new((a - b).norm() * N::HALF, radius), N::ONE);
        let along = along.expect("a needle");
        for (found, expected) in body.principal_moments().iter().zip(along.principal_moments()) {
            assert!((*found / *expected - N::ONE).abs() <= N::lit(share), "{body:?} {along:?}");
        }
        let place = Isometry3::from_parts(random.vector::<N, 3>().into(), random.turn3());
        let inverse = body.inverse_inertia_at(&place);
        for _ in 0..20 {
            let torque = random.direction::<N, 3>();
            assert!(torque.dot(&(inverse * torque)) > N::ZERO, "{inverse} {torque}");
        }
        // The least moment stays positive in a compound of two needles.
        let child = (Isometry3::identity(), ShapeHandle::new(needle));
        let both = Compound::new(vec![child.clone(), child]);
        let both = mass_properties(&both, N::ONE).expect("two needles");
        let least = both.principal_moments().amin();
        assert!(least > N::ZERO, "{both:?}");
    }
}

#[test]
fn needles_keep_their_digits() {
    needles::<f32>(1e-3, 1e-5);
    needles::<f32>(1e-5, 1e-5);
    needles::<f64>(1e-3, 1e-13);
    needles::<f64>(1e-5, 1e-13);
    // A plate and a needle as hulls.
    for half in [V3::new(1.0, 1e-6, 1.0), V3::new(1.0, 1e-5, 1e-5)] {
        let corner = |signs: u32| {
            V3::from_fn(|axis, _| if signs >> axis & 1 == 1 { half[axis] } else { -half[axis] })
        };
        let corners: Vec<_> = (0..8).map(|signs| Point::from(corner(signs))).collect();
        let hull = mass_properties(&ConvexHull::from_points(&corners), 1.0).expect("a hull");
        let cuboid = mass_properties(&Cuboid::new(half), 1.0).expect("a box");
        let ratio = hull.principal_moments().component_div(cuboid.principal_moments());
        assert!((ratio - V3::repeat(1.0)).amax() < 1e-14, "{ratio}");
    }
}

/// Asserts that shapes that differ by 1e-9 have mass properties within 1e-7 of each other, although
/// different formulas apply.
#[test]
fn shapes_change_gradually() {
    let shapes: [(&dyn Shape<f64, 3>, &dyn Shape<f64, 3>); 4] = [
        (&TaperedCapsule::<f64, 3>::new(1.0, 0.5, 0.5 + 1e-9), &Capsule::<f64, 3>::new(1.0, 0.5)),
        (
            &TaperedCapsule::<f64, 3>::new(0.5, 1e-9, 1.0 + 0.5e-9),
            &TaperedCapsule::<f64, 3>::new(0.5, 0.0, 1.0),
        ),
        (&Rounded::new(Cylinder::new(1e-9, 1e-9), 1.0), &Ball::new(1.0)),
        (&Rounded::new(Cuboid::new(V3::repeat(1.0)), 1e-9), &Cuboid::new(V3::repeat(1.0))),
    ];
    for (one, other) in shapes {
        assert_alike(&unit(one), &unit(other), 1e-7, "nearly the same");
    }
}

#[test]
fn masses_may_be_given() {
    let body = mass_properties(&Cuboid::new(V3::new(1.0, 2.0, 3.0)), 0.7).expect("a box");
    let heavy = body.with_mass(body.mass() * 4.0).expect("a mass");
    assert_alike(
        &wide(&heavy),
        &(body.mass() * 4.0, V3::zeros(), body.inertia() * 4.0),
        1e-15,
        "four",
    );
    let point = MassProperties::<f64, 3>::default().with_mass(2.0).expect("a mass");
    assert_eq!((point.mass(), point.inertia()), (2.0, Matrix::<f64, 3>::zeros()), "a point");
    assert!(matches!(body.with_mass(f64::NAN), Err(MassError::NotFinite { .. })), "no mass");
}
