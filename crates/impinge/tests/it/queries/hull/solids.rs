//! Tests hulls and polygons as solids: features, support points, boxes.

use impinge::bounding_volume::BoundingVolume;
use impinge::math::{Isometry2, Isometry3, Point, Real, Vector};
use impinge::shape::{
    Ball, Capsule, Cone, ConvexHull, ConvexPolygon, ConvexPolyhedron, Cuboid, Cylinder, Feature,
    FeatureId, Segment, Shape, SupportMap, Triangle, aabb, bounding_sphere,
};

use super::checks::cast;
use super::points::{Numbers, ball, cube, grid, octahedron, prism, sphere, turned};

fn hulls<N: Real>() -> Vec<ConvexHull<N>> {
    let sets = [
        cube(),
        octahedron(),
        prism(7),
        turned(&grid(4), 0.1, 0.0),
        ball(200),
        turned(&sphere(60), 1e-20, 0.0),
    ];
    sets.iter().map(|points| ConvexHull::from_points(&cast(points))).collect()
}

fn direction3<N: Real>(numbers: &mut Numbers) -> Vector<N, 3> {
    numbers.vector().normalize().map(N::lit)
}

fn hull_features<N: Real>() {
    let mut numbers = Numbers::new(9);
    let (mut faces, mut edges, mut vertices) = (0, 0, 0);
    let mut feature = Feature::default();
    for hull in hulls::<N>() {
        assert_eq!(hull.validate(), Ok(()), "{hull:?}");
        let tolerance = N::lit(64.0) * N::EPSILON * hull.reach();
        for (edge, id) in hull.edges().iter().zip((0..).map(FeatureId::Edge)) {
            let normal = hull.feature_normal(id);
            let top = hull.core_support(&normal).coords.dot(&normal);
            for (_, end) in hull.edge(id) {
                assert!(top - end.coords.dot(&normal) <= tolerance, "{id:?} faces its normal");
            }
            for face in edge.faces {
                hull.face(FeatureId::Face(face), &mut feature);
                assert!(feature.side_ids.contains(&id), "an edge is a side of its faces");
            }
        }
        for _ in 0..200 {
            let direction = direction3::<N>(&mut numbers);
            hull.core_feature(&direction, &mut feature);
            match feature.id {
                FeatureId::Face(_) => faces += 1,
                FeatureId::Edge(_) => edges += 1,
                FeatureId::Vertex(_) => vertices += 1,
            }
            let top = hull.core_support(&direction).coords.dot(&direction);
            for (at, vertex) in hull.vertices().iter().enumerate() {
                let touches = top - vertex.coords.dot(&direction) <= N::EPSILON * hull.reach();
                assert!(!touches || feature.vertices.contains(vertex), "vertex {at}: {feature:?}");
            }
            hull.support_face_toward(&direction, &mut feature);
            let along = feature.normal.expect("a face has one").dot(&direction);
            assert!(
                hull.faces().iter().all(|face| face.normal.dot(&direction) <= along),
                "the most aligned"
            );
        }
    }
    assert!(faces > 300 && edges > 300 && vertices > 50, "{faces}, {edges}, {vertices}: all kinds");
}

#[test]
fn features_of_hulls_are_consistent() {
    hull_features::<f32>();
    hull_features::<f64>();
}

fn polygon<N: Real>(sides: u32, scale: f64) -> ConvexPolygon<N> {
    let corner = |i: u32| {
        let angle = std::f64::consts::TAU * f64::from(i) / f64::from(sides) + 0.1;
        Point::<N, 2>::new(N::lit(angle.cos() * scale), N::lit(angle.sin() * scale))
    };
    ConvexPolygon::new(&(0..sides).map(corner).collect::<Vec<_>>())
}

fn polygon_features<N: Real>() {
    let mut feature = Feature::default();
    for (sides, scale) in [(3, 1.0), (4, 1e-20), (7, 1e6), (40, 1.0)] {
        let solid = polygon::<N>(sides, scale);
        assert_eq!(solid.validate(), Ok(()), "{solid:?}");
        for side in 0..sides {
            let id = FeatureId::Face(side);
            solid.face(id, &mut feature);
            assert_eq!(feature.vertex_ids[0], FeatureId::Vertex(side), "named by its first vertex");
            assert_eq!((feature.side_ids.len(), feature.id), (1, id), "one segment");
            let normal = feature.normal.expect("a side has one");
            let (a, b) = (feature.vertices[0], feature.vertices[1]);
            let left = (b.x - a.x) * normal.y - (b.y - a.y) * normal.x;
            assert!(left < N::ZERO, "the solid is on the left, the normal on the right");
            solid.core_feature(&normal, &mut feature);
            assert_eq!(feature.id, id, "a side faces its own normal");
            let corner = solid.feature_normal(FeatureId::Vertex(side));
            assert_eq!(solid.core_support(&corner), a, "a corner faces its normal");
            solid.support_feature_toward(&corner, N::lit(0.01), &mut feature);
            assert_eq!(feature.id, FeatureId::Vertex(side), "sides lean by more than 0.01");
            assert_eq!(solid.support_feature_id_toward(&normal), id, "exactly");
        }
    }
}

#[test]
fn features_of_polygons_are_consistent() {
    polygon_features::<f32>();
    polygon_features::<f64>();
}

#[test]
#[should_panic(expected = "no vertex named Vertex(8)")]
fn a_feature_that_is_not_there_is_named() {
    let _ = ConvexHull::<f32>::from_points(&cast(&cube())).vertex(FeatureId::Vertex(8));
}

/// Asserts that boxes and spheres contain the support points, and that `reach` bounds the distance
/// of the support points from the origin.
fn bounds<N: Real, const D: usize>(
    shape: &dyn Shape<N, D>,
    directions: &[Vector<N, D>],
    boxes: (impinge::bounding_volume::Aabb<N, D>, impinge::bounding_volume::BoundingSphere<N, D>),
    place: &dyn Fn(&Point<N, D>) -> Point<N, D>,
) {
    let map = shape.geometry().as_support_map().expect("a convex solid");
    let (placed, sphere) = boxes;
    let reach = map.reach() + map.rounding();
    let slack = N::lit(32.0) * N::EPSILON * (reach + placed.center().coords.norm());
    for direction in directions {
        let point = map.support_point(direction);
        assert!(shape.local_aabb().loosened(slack).contains_point(&point), "{shape:?}: {point}");
        assert!(point.coords.norm() <= reach + slack, "{shape:?} reaches {point}");
        let point = place(&point);
        assert!(placed.loosened(slack).contains_point(&point), "{shape:?}: {point} in {placed:?}");
        assert!(sphere.loosened(slack).contains_point(&point), "{shape:?}: {point} in {sphere:?}");
    }
}

fn bounds_in_space<N: Real>() {
    let n = N::lit;
    let mut numbers = Numbers::new(21);
    let p = |x: f64, y: f64, z: f64| Point::<N, 3>::new(n(x), n(y), n(z));
    let mut shapes: Vec<Box<dyn Shape<N, 3>>> = vec![
        Box::new(Ball::new(n(0.7))),
        Box::new(Cuboid::<N, 3>::new(Vector::<N, 3>::new(n(1.0), n(0.2), n(3.0)))),
        Box::new(Capsule::<N, 3>::new(n(1.0), n(0.3))),
        Box::new(Cylinder::new(n(1.0), n(0.3))),
        Box::new(Cone::new(n(1.0), n(0.6))),
        Box::new(Segment::new(p(1.0, 2.0, 3.0), p(-1.0, 0.0, 2.0))),
        Box::new(Triangle::<N, 3>::new(p(1.0, 2.0, 3.0), p(-1.0, 0.0, 2.0), p(0.0, 5.0, 0.0))),
    ];
    shapes.extend(hulls::<N>().into_iter().map(|hull| -> Box<dyn Shape<N, 3>> { Box::new(hull) }));
    for shape in &shapes {
        let directions: Vec<_> = (0..100).map(|_| direction3::<N>(&mut numbers)).collect();
        for _ in 0..20 {
            let pose =
                Isometry3::new(numbers.vector().map(n) * n(5.0), numbers.vector().map(n) * n(3.0));
            let boxes = (aabb(&**shape, &pose), bounding_sphere(&**shape, &pose));
            bounds(&**shape, &directions, boxes, &|point| pose * point);
        }
    }
}

#[test]
fn bounds_hold_in_space() {
    bounds_in_space::<f32>();
    bounds_in_space::<f64>();
}

fn bounds_in_the_plane<N: Real>() {
    let n = N::lit;
    let mut numbers = Numbers::new(22);
    let mut vector = || Vector::<N, 2>::new(n(numbers.next()), n(numbers.next()));
    let p = |x: f64, y: f64| Point::<N, 2>::new(n(x), n(y));
    let shapes: Vec<Box<dyn Shape<N, 2>>> = vec![
        Box::new(Ball::new(n(0.7))),
        Box::new(Cuboid::<N, 2>::new(Vector::<N, 2>::new(n(1.0), n(0.2)))),
        Box::new(Capsule::<N, 2>::new(n(1.0), n(0.3))),
        Box::new(Segment::new(p(1.0, 2.0), p(-1.0, 0.0))),
        Box::new(Triangle::<N, 2>::new(p(1.0, 2.0), p(-1.0, 0.0), p(0.0, 5.0))),
        Box::new(polygon::<N>(5, 1.0)),
        Box::new(polygon::<N>(3, 1e-10)),
    ];
    for shape in &shapes {
        let directions: Vec<_> = (0..100).map(|_| vector()).collect();
        for _ in 0..20 {
            let pose = Isometry2::new(vector() * n(5.0), vector().x * n(3.0));
            let boxes = (aabb(&**shape, &pose), bounding_sphere(&**shape, &pose));
            bounds(&**shape, &directions, boxes, &|point| pose * point);
        }
    }
}

#[test]
fn bounds_hold_in_the_plane() {
    bounds_in_the_plane::<f32>();
    bounds_in_the_plane::<f64>();
}

/// Asserts that each upper face of the box of a rotated hull touches a vertex up to rounding.
#[test]
fn boxes_of_hulls_are_tight() {
    let pose = Isometry3::rotation(Vector::<f64, 3>::new(0.4, 0.5, -0.2));
    let hull = ConvexHull::from_points(&turned(&octahedron(), 2.0, 0.0));
    let found = aabb(&hull, &pose);
    for axis in 0..3 {
        let top = hull.vertices().iter().map(|v| (pose * v)[axis]).fold(f64::MIN, f64::max);
        let room = found.maxs()[axis] - top;
        assert!((-4.0 * f64::EPSILON..64.0 * f64::EPSILON).contains(&room), "axis {axis}: {room}");
    }
}
