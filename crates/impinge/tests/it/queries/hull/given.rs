//! Tests solids made from points and faces, and hulls of points that do not span a solid.

use impinge::math::{Isometry3, Point, Real, Space};
use impinge::query::{PointQuery, RayCast};
use impinge::shape::{ConvexHull, Segment, ShapeError, ShapeHandle, TriMesh, Triangle};
use impinge::transformation::{convex_hull3, convex_shape2, convex_shape3};

use super::checks::cast;
use super::points::{P3, ball, cube, grid, octahedron, prism, sphere, turned};

/// Returns solids with whole and rounded coordinates; some are large, tiny or far from the origin.
fn solids() -> Vec<Vec<P3>> {
    let plain = [cube(), octahedron(), prism(7), grid(3), ball(60), sphere(40)];
    let around = [(1.0, 0.0), (1e-12, 0.0), (1e12, 0.0), (1.0, 100.0)];
    let moved = around
        .iter()
        .flat_map(|&(scale, offset)| plain.iter().map(move |points| turned(points, scale, offset)));
    plain.iter().cloned().chain(moved).collect()
}

/// Returns the faces of a hull cut into triangles, every other one with reversed winding.
fn triangles<N: Real>(points: &[Point<N, 3>]) -> Vec<[u32; 3]> {
    let index = |&index: &usize| u32::try_from(index).expect("few points");
    let faces = convex_hull3(points).expect("a solid").faces;
    let fan = |face: &Vec<usize>| {
        let ring: Vec<_> = face.iter().map(index).collect();
        (1..ring.len() - 1).map(|at| [ring[0], ring[at], ring[at + 1]]).collect::<Vec<_>>()
    };
    let mut all: Vec<_> = faces.iter().flat_map(fan).collect();
    all.iter_mut().step_by(2).for_each(|triangle| triangle.reverse());
    all
}

fn faces_that_are_given_are_those_of_the_hull<N: Real>() {
    for points in solids() {
        let points: Vec<Point<N, 3>> = cast(&points);
        let faces = triangles(&points);
        let hull = ConvexHull::try_new(&points, &faces);
        assert_eq!(hull, Ok(ConvexHull::from_points(&points)), "{points:?}");
        let missing = ConvexHull::try_new(&points, &faces[1..]);
        assert!(matches!(missing, Err(ShapeError::NotClosed { .. })), "{missing:?}");
        let mut named = faces.clone();
        named[2][1] = 1000;
        let count = points.len();
        let expected = ShapeError::NoSuchPoint { face: 2, point: 1000, points: count };
        assert_eq!(ConvexHull::try_new(&points, &named), Err(expected), "a point too far");
        // Pushes a corner in beyond the middle, which dents the solid if the other corners still
        // span it.
        let mut dented = points.clone();
        let corner = faces[0][0] as usize;
        let middle = points.iter().fold(Point::<N, 3>::origin(), |sum, point| {
            sum + point.coords / N::lit(f64::from(u16::try_from(count).expect("few points")))
        });
        dented[corner] = middle + (middle - points[corner]) * N::lit(0.125);
        let refused = ConvexHull::try_new(&dented, &faces);
        let is_tetrahedron = count == 4;
        assert!(
            is_tetrahedron || matches!(refused, Err(ShapeError::FaceNotOnHull { .. })),
            "{refused:?}"
        );
    }
    let few = ConvexHull::<N>::try_new(&cast(&cube()), &[[0, 1]]);
    assert_eq!(few, Err(ShapeError::TooFewPoints { given: 2, needed: 3 }), "no face");
    let none = ConvexHull::<N>::try_new::<[u32; 3]>(&[], &[]);
    assert_eq!(none, Err(ShapeError::TooFewPoints { given: 0, needed: 4 }), "nothing");
}

/// Returns the dimension of the shape: 0 for a point, 1 for a segment, 2 for flat shapes, 3 for
/// solids.
fn dimension<N: Space<3>>(shape: &ShapeHandle<N, 3>) -> usize {
    let is_point = |segment: &Segment<N, 3>| segment.a() == segment.b();
    if let Some(segment) = shape.as_shape::<Segment<N, 3>>() {
        return usize::from(!is_point(segment));
    }
    let is_flat = shape.is_shape::<Triangle<N, 3>>() || shape.is_shape::<TriMesh<N, 3>>();
    if is_flat { 2 } else { 3 }
}

/// Asserts that hulls have the dimension that their points span, from a single point to a solid,
/// rotated, at three scales and away from the origin.
fn hulls_are_what_their_points_span<N: Real>() {
    let flat = |points: Vec<P3>| -> Vec<P3> {
        points.into_iter().map(|p| P3::new(p.x, p.y, 0.25)).collect()
    };
    let on_line = (0..6).map(|i| P3::from(cube()[7].coords * f64::from(i * i))).collect::<Vec<_>>();
    let sets = [
        (vec![P3::new(1.0, 2.0, 3.0)], 0),
        (vec![P3::new(1.0, 2.0, 3.0); 5], 0),
        (on_line[..2].to_vec(), 1),
        (on_line, 1),
        (flat(prism(3)), 2),
        (flat(prism(4)), 2),
        (flat(grid(4)), 2),
        (flat(prism(9)), 2),
        (cube(), 3),
    ];
    for (points, expected) in sets {
        for (scale, offset) in [(1.0, 0.0), (1e-12, 0.0), (1e12, 0.0), (1.0, 100.0)] {
            let points: Vec<Point<N, 3>> = cast(&turned(&points, scale, offset));
            let shape = convex_shape3(&points).expect("finite");
            assert_eq!(dimension(&shape), expected, "{points:?}: {shape:?}");
            let slack = N::lit(64.0 * (scale * 4.0 + offset)) * N::EPSILON;
            for point in &points {
                let distance = shape.distance_to_point(&Isometry3::identity(), point, true);
                assert!(distance <= slack, "{distance} from {point}: {shape:?}");
            }
            let around = shape.local_aabb();
            let given = impinge::bounding_volume::Aabb::from_points(&points).expect("some");
            let beyond = (around.half_extents() - given.half_extents()).amax();
            assert!(beyond <= slack, "no more than the points: {shape:?}");
        }
    }
    let none = convex_shape3::<N>(&[]).expect_err("nothing");
    assert_eq!(none, ShapeError::TooFewPoints { given: 0, needed: 1 }, "nothing");
    let bad = [Point::<N, 3>::origin(), Point::from([N::INFINITY, N::ZERO, N::ZERO])];
    assert_eq!(convex_shape3(&bad).err(), Some(ShapeError::PointNotFinite { index: 1 }), "bad");
    let line = [[0.0, 0.0], [2.0, 1.0], [4.0, 2.0]].map(|p| Point::<N, 2>::from(p.map(N::lit)));
    let segment = convex_shape2(&line).expect("finite");
    let segment = *segment.as_shape::<Segment<N, 2>>().expect("on a line");
    assert_eq!((*segment.a(), *segment.b()), (line[0], line[2]), "its ends");
    assert_eq!(convex_shape2(&line[..1]).expect("one").local_aabb().mins(), &line[0], "a point");
}

/// Asserts that `first_hit_where` returns the first of all hits that the condition accepts: here
/// hits on fronts, on backs, or all hits, for rays at a closed surface.
fn hits_that_count_are_the_first_of_them<N: Real>() {
    use impinge::bounding_volume::Ray;
    use impinge::shape::FeatureId;
    let points: Vec<Point<N, 3>> = cast(&turned(&sphere(40), 1.0, 0.0));
    let hull = ConvexHull::from_points(&points);
    let surface = impinge::procedural::space::convex_hull(&hull);
    let mesh = TriMesh::<N, 3>::try_from(surface).expect("good triangles");
    let pose = Isometry3::translation(N::lit(0.5), N::ZERO, N::ZERO);
    let mut numbers = super::points::Numbers::new(2);
    let mut culled = 0;
    for _ in 0..300 {
        let ray = Ray::new(
            Point::from(numbers.vector().map(|x| N::lit(2.0 * x))),
            numbers.vector().map(N::lit),
        );
        for left_out in [FeatureId::Face(0), FeatureId::Face(1), FeatureId::Vertex(9)] {
            let limit = N::lit(8.0);
            let counts = |feature: FeatureId| feature != left_out;
            let found = mesh.first_hit_where(&pose, &ray, limit, true, |hit| counts(hit.feature));
            let all = mesh.all_hits_with_ray(&pose, &ray, limit, true);
            let expected = all.iter().find(|hit| counts(hit.feature)).copied();
            assert_eq!(found, expected, "{ray:?} without {left_out:?}");
            culled += usize::from(found.is_some() && found != all.first().copied());
            let convex = hull.first_hit_where(&pose, &ray, limit, true, |_| false);
            assert_eq!(convex, None, "nothing counts");
        }
    }
    assert!(culled > 10, "some were passed by: {culled}");
}

#[test]
fn of_f32() {
    faces_that_are_given_are_those_of_the_hull::<f32>();
    hulls_are_what_their_points_span::<f32>();
    hits_that_count_are_the_first_of_them::<f32>();
}

#[test]
fn of_f64() {
    faces_that_are_given_are_those_of_the_hull::<f64>();
    hulls_are_what_their_points_span::<f64>();
    hits_that_count_are_the_first_of_them::<f64>();
}

/// Bug: the mean of the corners of a large face was added up with a bias, and so lay beside the hull.
fn large_faces<N: Real>(sides: &[u32]) {
    for &sides in sides {
        let points = cast::<N>(&prism(sides));
        let hull = convex_hull3(&points).expect("a solid");
        let faces: Vec<Vec<u32>> = hull
            .faces
            .iter()
            .map(|face| face.iter().map(|&corner| u32::try_from(corner).expect("few")).collect())
            .collect();
        let corners: Vec<_> = hull.vertices.iter().map(|&vertex| points[vertex]).collect();
        assert_eq!(corners.len(), points.len(), "all points are corners");
        let given = ConvexHull::try_new(&points, &faces);
        assert!(given.is_ok(), "{sides} sides: {:?}", given.err());
    }
}

#[test]
fn prisms_of_many_sides_are_solids() {
    large_faces::<f32>(&[541, 614, 1000]);
    large_faces::<f64>(&[545, 642, 2000]);
}
