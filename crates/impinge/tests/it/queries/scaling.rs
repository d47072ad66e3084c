//! Compares the extents of scaled shapes with the extents of their scaled points. Also tests
//! half-spaces, fronts, compounds, and factors that are refused.

use crate::support::query_support;

use impinge::bounding_volume::Aabb;
use impinge::dim2::shape::Compound as Compound2;
use impinge::dim3::shape::Compound as Compound3;
use impinge::math::{Isometry2, Isometry3, Point, Pose, Real, Space, Unit, Vector};
use impinge::shape::{
    Ball, Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Diagonals, Ellipsoid,
    Geometry, HeightField, Plane, Polyline, Rounded, ScaleError, Segment, Shape, ShapeHandle,
    TaperedCapsule, Tetrahedron, TriMesh, Triangle,
};
use query_support::random::Random;

type Handle<N, const D: usize> = ShapeHandle<N, D>;

/// Returns the extent of each part along a direction; a shape that is not a composite is its only
/// part.
fn reaches<N: Real, const D: usize>(shape: &Handle<N, D>, direction: &Vector<N, D>) -> Vec<f64> {
    let reach = |pose: &Pose<N, D>, geometry: Geometry<'_, N, D>| {
        let map = geometry.as_support_map().expect("convex");
        let farthest = pose.point(&map.support_point(&pose.inverse_vector(direction)));
        farthest.coords.dot(direction).as_f64()
    };
    let Some(composite) = shape.geometry().as_composite() else {
        return vec![reach(&Pose::identity(), shape.geometry())];
    };
    let part = |number| {
        let part = composite.part(number);
        reach(&part.pose, part.solid.geometry())
    };
    (0..composite.num_parts()).map(part).collect()
}

/// Asserts that the extent of a scaled solid along a direction equals, up to rounding, the extent
/// of the unscaled solid along the direction multiplied by `factors`.
fn check<N: Real, const D: usize>(shape: &Handle<N, D>, factors: [f64; D], random: &mut Random) {
    let scale = Vector::<N, D>::from_fn(|axis, _| N::lit(factors[axis]));
    let scaled =
        shape.scaled(&scale).unwrap_or_else(|error| panic!("{error}: {factors:?} {shape:?}"));
    let largest = factors.iter().fold(0.0_f64, |largest, factor| largest.max(factor.abs()));
    let size = reaches(shape, &Vector::<N, D>::repeat(N::ONE))
        .iter()
        .fold(8.0, |size: f64, x| size.max(x.abs()));
    let rounding = 64.0 * N::EPSILON.as_f64() * largest * size;
    for _ in 0..20 {
        let direction = random.direction::<N, D>();
        let own = reaches(&scaled, &direction);
        let expected = reaches(shape, &direction.component_mul(&scale));
        assert_eq!(own.len(), expected.len(), "as many parts");
        for (part, (own, expected)) in own.iter().zip(&expected).enumerate() {
            let what = format!("part {part} of {shape:?} scaled by {factors:?}");
            assert!((own - expected).abs() <= rounding, "{own}, not {expected}: {what}");
        }
    }
}

/// Returns the error with which the handle of the shape refuses the factors.
fn refused<const D: usize>(shape: &Handle<f64, D>, factors: [f64; D]) -> ScaleError {
    shape.scaled(&Vector::<f64, D>::from(factors)).expect_err("no such shape")
}

const UNIFORM: [[f64; 3]; 3] = [[2.5, 2.5, 2.5], [-0.5, 0.5, 0.5], [-3.0, -3.0, -3.0]];
const AXIAL: [[f64; 3]; 2] = [[2.0, 0.125, -2.0], [1e-3, 40.0, 1e-3]];
const ANY: [[f64; 3]; 3] = [[2.0, 0.5, 3.0], [-1.0, 4.0, 0.1], [0.7, -0.2, -5.0]];

fn points<N: Real, const D: usize>(random: &mut Random, count: usize) -> Vec<Point<N, D>> {
    (0..count).map(|_| Point::from(random.vector::<N, D>() * N::lit(4.0))).collect()
}

fn check_space<N: Real>() {
    let mut random = Random(91, false);
    let p = points::<N, 3>(&mut random, 12);
    let every: Vec<Handle<N, 3>> = vec![
        Handle::new(Cuboid::new(p[0].coords.abs())),
        Handle::new(Ball::new(N::TWO)),
        Handle::new(Ellipsoid::new(p[0].coords.abs())),
        Handle::new(Tetrahedron::new([p[0], p[1], p[2], p[3]])),
        Handle::new(Segment::new(p[0], p[1])),
        Handle::new(Triangle::new(p[0], p[1], p[2])),
        Handle::new(ConvexHull::from_points(&p)),
        Handle::new(TriMesh::<N, 3>::new(p.clone(), vec![[0, 1, 2], [3, 2, 1], [4, 5, 6]])),
        Handle::new(Polyline::<N, 3>::closed(p.clone())),
        Handle::new(
            HeightField::<N, 3>::new(3, 4, p.iter().map(|p| p.x).collect(), p[3].coords)
                .with_diagonals(Diagonals::Zigzag),
        ),
    ];
    let axial: Vec<Handle<N, 3>> =
        vec![Handle::new(Cylinder::new(N::TWO, N::ONE)), Handle::new(Cone::new(N::TWO, N::ONE))];
    let capsule = Capsule::try_from_ends(p[4], p[5], N::HALF).expect("finite");
    let tapered = TaperedCapsule::try_from_ends(p[4], p[5], [N::HALF, N::ONE]).expect("finite");
    let rounded = Rounded::new(Cuboid::new(p[0].coords.abs()), N::HALF);
    let twice = Rounded::new(Rounded::new(Triangle::new(p[0], p[1], p[2]), N::HALF), N::ONE);
    let round: Vec<Handle<N, 3>> =
        vec![Handle::new(capsule), Handle::new(tapered), Handle::new(rounded), Handle::new(twice)];
    for factors in UNIFORM {
        every.iter().chain(&round).for_each(|shape| check(shape, factors, &mut random));
    }
    for factors in UNIFORM.iter().chain(&AXIAL).filter(|factors| factors[1] > 0.0) {
        axial.iter().for_each(|shape| check(shape, *factors, &mut random));
    }
    for factors in ANY.iter().chain(&AXIAL) {
        every.iter().for_each(|shape| check(shape, *factors, &mut random));
    }
}

#[test]
fn shapes_of_space_reach_where_their_scaled_points_do() {
    check_space::<f32>();
    check_space::<f64>();
}

fn check_plane<N: Real>() {
    let mut random = Random(92, false);
    let p = points::<N, 2>(&mut random, 9);
    let every: Vec<Handle<N, 2>> = vec![
        Handle::new(Cuboid::new(p[0].coords.abs())),
        Handle::new(Ball::new(N::TWO)),
        Handle::new(Ellipsoid::new(p[0].coords.abs())),
        Handle::new(Segment::new(p[0], p[1])),
        Handle::new(Triangle::new(p[0], p[1], p[2])),
        Handle::new(ConvexPolygon::from_points(&p)),
        Handle::new(TriMesh::<N, 2>::new(p.clone(), vec![[0, 1, 2], [3, 2, 1]])),
        Handle::new(Polyline::<N, 2>::open(p.clone())),
        Handle::new(HeightField::<N, 2>::new(p.iter().map(|p| p.x).collect(), p[3].coords)),
    ];
    for factors in [[2.0, 2.0], [-3.0, 3.0], [0.5, 4.0], [-1.0, 1e-2]] {
        every.iter().for_each(|shape| check(shape, factors, &mut random));
    }
    let capsule = Handle::new(Capsule::<N, 2>::new(N::TWO, N::HALF));
    let rounded = Handle::new(Rounded::new(Cuboid::new(p[0].coords.abs()), N::HALF));
    for factors in [[2.0, 2.0], [-3.0, 3.0]] {
        check(&capsule, factors, &mut random);
        check(&rounded, factors, &mut random);
    }
}

#[test]
fn shapes_of_the_plane_reach_where_their_scaled_points_do() {
    check_plane::<f32>();
    check_plane::<f64>();
}

/// Asserts that a point is in a half-space if and only if the scaled point is in the scaled
/// half-space.
#[test]
fn half_spaces_keep_their_points() {
    let mut random = Random(93, false);
    for factors in ANY.iter().chain(&UNIFORM) {
        let scale = Vector::<f64, 3>::from(*factors);
        let normal = random.direction::<f64, 3>();
        let plane = Handle::new(Plane::new(Unit::new_unchecked(normal)));
        let scaled = plane.scaled(&scale).expect("always possible");
        let own = scaled.as_shape::<Plane<f64, 3>>().expect("a half-space").normal();
        assert!((own.norm() - 1.0).abs() < 1e-15, "a unit vector");
        for _ in 0..50 {
            let point = random.vector::<f64, 3>();
            let inside = normal.dot(&point) <= 0.0;
            assert_eq!(
                own.dot(&point.component_mul(&scale)) <= 0.0,
                inside,
                "{point} by {factors:?}"
            );
        }
    }
}

#[test]
fn faces_of_mirrored_polytopes_point_out() {
    let corners = [[0.0, 0.0], [3.0, 0.0], [4.0, 2.0], [1.0, 3.0]].map(Point::<f64, 2>::from);
    let polygon = Handle::new(ConvexPolygon::new(&corners));
    let mirrored = polygon.scaled(&Vector::<f64, 2>::new(-1.0, 2.0)).expect("any scale");
    let mirrored = mirrored.as_shape::<ConvexPolygon<f64>>().expect("a polygon");
    let expected = ConvexPolygon::new(mirrored.vertices());
    assert_eq!(mirrored, &expected, "counter-clockwise, as if made of its corners");

    let mut random = Random(94, false);
    let hull = Handle::new(ConvexHull::from_points(&points::<f64, 3>(&mut random, 20)));
    for factors in ANY {
        let scaled = hull.scaled(&Vector::<f64, 3>::from(factors)).expect("any scale");
        let scaled = scaled.as_shape::<ConvexHull<f64>>().expect("a hull");
        for face in scaled.faces() {
            let ring = scaled.face_vertices(face);
            let [a, b, c] = [0, 1, 2].map(|at| scaled.vertices()[ring[at] as usize]);
            assert!(
                (b - a).cross(&(c - a)).dot(&face.normal) > 0.0,
                "counter-clockwise from outside"
            );
            for vertex in scaled.vertices() {
                assert!(face.normal.dot(&vertex.coords) <= face.offset + 1e-12, "outward");
            }
        }
    }
}

/// Asserts that the front of a scaled one-sided surface is on the side to which scaling moves the
/// points in front of the surface.
#[test]
fn fronts_are_scaled_too() {
    let p = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0]].map(Point::<f64, 3>::from);
    let mesh = Handle::new(TriMesh::<f64, 3>::new(p.to_vec(), vec![[0, 1, 2]]).one_sided());
    let field = HeightField::<f64, 3>::new(2, 2, vec![0.0; 4], Vector::<f64, 3>::repeat(1.0));
    let field = Handle::new(field.one_sided());
    for shape in [mesh, field] {
        for (factors, up) in [
            ([1.0, 1.0, 1.0], 1.0),
            ([-1.0, 1.0, 1.0], 1.0),
            ([1.0, -2.0, 1.0], -1.0),
            ([-1.0, -1.0, 3.0], -1.0),
        ] {
            let scaled = shape.scaled(&Vector::<f64, 3>::from(factors)).expect("any scale");
            let surface =
                scaled.geometry().as_composite().and_then(|composite| composite.surface());
            let front = surface.expect("one").snapped(0, &Vector::<f64, 3>::x());
            assert_eq!(front, Some(Vector::<f64, 3>::new(0.0, up, 0.0)), "{factors:?}");
        }
    }
}

#[test]
fn compounds_are_scaled_where_no_child_is_sheared() {
    let mut random = Random(95, false);
    let p = points::<f64, 3>(&mut random, 3);
    let triangle = Handle::new(Triangle::new(p[0], p[1], p[2]));
    let ball = Handle::new(Ball::new(0.5));
    let anywhere = |random: &mut Random| {
        Isometry3::from_parts(random.vector::<f64, 3>().into(), random.turn3())
    };
    let loose = Handle::new(Compound3::<f64>::new(vec![
        (anywhere(&mut random), triangle.clone()),
        (anywhere(&mut random), ball),
        (anywhere(&mut random), triangle.clone()),
    ]));
    for factors in UNIFORM {
        check(&loose, factors, &mut random);
        let nested =
            Handle::new(Compound3::<f64>::new(vec![(anywhere(&mut random), loose.clone())]));
        check(&nested, factors, &mut random);
    }
    // Quarter turns map axes to axes, so any factors are possible.
    let quarter = std::f64::consts::FRAC_PI_2;
    let turned = |axis: usize, angle: f64| {
        let mut about = Vector::<f64, 3>::zeros();
        about[axis] = angle;
        Isometry3::new(Vector::<f64, 3>::new(1.0, -2.0, 3.0), about)
    };
    let square = |position| Handle::new(Compound3::<f64>::new(vec![(position, triangle.clone())]));
    for factors in ANY {
        for axis in 0..3 {
            let twice = turned(axis, quarter) * turned((axis + 1) % 3, -quarter);
            check(&square(turned(axis, quarter)), factors, &mut random);
            check(&square(twice), factors, &mut random);
        }
    }
    // Around y any rotation is possible, because the factors across y are equal.
    for factors in AXIAL {
        check(&square(turned(1, 0.7)), factors, &mut random);
    }
    let tilted = Compound3::<f64>::new(vec![
        (Isometry3::identity(), triangle.clone()),
        (turned(0, 0.7), triangle),
    ]);
    let error = tilted.try_scaled(&Vector::<f64, 3>::new(1.0, 2.0, 1.0)).expect_err("sheared");
    assert_eq!(error, ScaleError::Child { index: 1 }, "named");
    assert_eq!(error.to_string(), "child 1 cannot be scaled so", "in words");

    let plane = Compound2::<f64>::new(vec![(
        Isometry2::new(Vector::<f64, 2>::new(1.0, 2.0), 0.4),
        Handle::new(Segment::new(Point::<f64, 2>::new(0.0, 1.0), Point::<f64, 2>::new(2.0, 5.0))),
    )]);
    check(&Handle::new(plane), [-3.0, 3.0], &mut random);
}

/// Asserts that cylinders and cones whose axis is turned onto another axis are scaled along it.
fn check_quarter_turns<N: Space<3, Isometry = Isometry3<N>>>() {
    let mut random = Random(96, false);
    let solids: [Handle<N, 3>; 2] =
        [Handle::new(Cylinder::new(N::TWO, N::ONE)), Handle::new(Cone::new(N::TWO, N::ONE))];
    let quarter = std::f64::consts::FRAC_PI_2;
    // A turn about x and one about z by these numbers of quarters, and the axis on which y lies then.
    for (about_x, about_z, axis) in
        [(0.0, 1.0, 0), (0.0, -1.0, 0), (0.0, 2.0, 1), (1.0, 0.0, 2), (-1.0, 0.0, 2), (1.0, 1.0, 0)]
    {
        let turn = |axis: usize, quarters: f64| {
            let mut about = Vector::<N, 3>::zeros();
            about[axis] = N::lit(quarters * quarter);
            Isometry3::new(Vector::<N, 3>::zeros(), about)
        };
        let position = turn(0, about_x) * turn(2, about_z);
        let mut factors = [2.0; 3];
        factors[axis] = 3.0;
        for solid in &solids {
            let turned = Handle::new(Compound3::<N>::new(vec![(position, solid.clone())]));
            check(&turned, factors, &mut random);
        }
    }
}

#[test]
fn turned_cylinders_and_cones_are_scaled_along_their_axis() {
    check_quarter_turns::<f32>();
    check_quarter_turns::<f64>();
}

#[derive(Debug)]
struct Own(Ball<f64>);

impl Shape<f64, 3> for Own {
    fn geometry(&self) -> Geometry<'_, f64, 3> {
        self.0.geometry()
    }

    fn local_aabb(&self) -> Aabb<f64, 3> {
        self.0.local_aabb()
    }
}

#[test]
fn what_cannot_be_is_refused() {
    let p = [[0.0, 0.0, 0.0], [0.0, 0.0, 1.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]
        .map(Point::<f64, 3>::from);
    let cuboid = Handle::new(Cuboid::new(Vector::<f64, 3>::repeat(1.0)));
    let all = [
        Handle::new(Ball::new(1.0)),
        cuboid.clone(),
        Handle::new(Segment::new(p[0], p[1])),
        Handle::new(Capsule::<f64, 3>::new(1.0, 1.0)),
        Handle::new(Triangle::new(p[0], p[1], p[2])),
        Handle::new(ConvexHull::from_points(&p)),
        Handle::new(Cylinder::new(1.0, 1.0)),
        Handle::new(Cone::new(1.0, 1.0)),
        Handle::new(Plane::new(Unit::new_unchecked(Vector::<f64, 3>::y()))),
        Handle::new(TriMesh::<f64, 3>::new(p.to_vec(), vec![[0, 1, 2]])),
        Handle::new(Polyline::<f64, 3>::open(p.to_vec())),
        Handle::new(HeightField::<f64, 3>::new(2, 2, vec![1.0; 4], Vector::<f64, 3>::repeat(1.0))),
        Handle::new(Compound3::<f64>::new(vec![(Isometry3::identity(), cuboid.clone())])),
    ];
    for shape in &all {
        for (factors, axis) in
            [([0.0, 1.0, 1.0], 0), ([1.0, f64::NAN, 1.0], 1), ([1.0, 1.0, f64::INFINITY], 2)]
        {
            let is_named = matches!(refused(shape, factors), ScaleError::BadFactor { axis: at, .. } if at == axis);
            assert!(is_named, "{factors:?} for {shape:?}");
        }
        // Scaling twice by 1e300 overflows every shape with a size.
        let huge = shape
            .scaled(&Vector::<f64, 3>::repeat(1e300))
            .and_then(|huge| huge.scaled(&Vector::<f64, 3>::repeat(1e300)));
        let is_half_space = shape.is_shape::<Plane<f64, 3>>();
        assert_eq!(huge.is_ok(), is_half_space, "{shape:?}");
    }
    for (shape, factors) in
        [(3, [1.0, 2.0, 1.0]), (6, [1.0, 1.0, 2.0]), (7, [1.0, 1.0, 2.0]), (7, [1.0, -1.0, 1.0])]
    {
        assert!(
            matches!(refused(&all[shape], factors), ScaleError::NotSuch { .. }),
            "{shape}: {factors:?}"
        );
    }
    let tiny = all[5].scaled(&Vector::<f64, 3>::repeat(1e-300)).expect("there is room");
    assert_eq!(refused(&tiny, [1e-300; 3]), ScaleError::OutOfRange, "a hull without a volume");
    let rounded = Handle::new(Rounded::new(Ball::new(1.0), 0.5));
    assert!(matches!(refused(&rounded, [1.0, 2.0, 1.0]), ScaleError::NotSuch { .. }), "rounded");
    assert_eq!(
        refused(&Handle::new(Own(Ball::new(1.0))), [1.0; 3]),
        ScaleError::Unsupported,
        "a user's"
    );
}
