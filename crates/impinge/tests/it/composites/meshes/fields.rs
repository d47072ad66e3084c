//! Tests that a height field admits the same normals as the mesh of its triangles, or the line of
//! its segments.

use impinge::math::{Real, Space, Vector};
use impinge::shape::{CompositeShape, FeatureId, HeightField, PartSolid, Polyline, TriMesh};
use impinge_reference::random::Random;

use super::{mesh, surface, vector};

/// Returns the corners of all parts, in order.
fn corners<N: Real, const D: usize>(shape: &dyn CompositeShape<N, D>) -> Vec<[f64; D]> {
    let of_part = |part| match shape.part(part).solid {
        PartSolid::Triangle(triangle) => triangle.corners().to_vec(),
        PartSolid::Segment(segment) => vec![*segment.a(), *segment.b()],
        PartSolid::Shape(shape) => panic!("{shape:?} is no piece of a surface"),
    };
    let all = (0..shape.num_parts()).flat_map(of_part);
    all.map(|corner| std::array::from_fn(|axis| corner[axis].as_f64())).collect()
}

/// Asserts that both surfaces admit the same normals at all features, for random normals and the
/// normals of parts. Returns the number of admitted normals.
fn compare<N: Space<D>, const D: usize>(
    field: &dyn CompositeShape<N, D>,
    twin: &dyn CompositeShape<N, D>,
    features: &[FeatureId],
) -> usize {
    let (mut random, mut admitted) = (Random::new(21), 0);
    let up = Vector::<N, D>::from_fn(|axis, _| if axis == 1 { N::ONE } else { N::ZERO });
    for part in 0..field.num_parts() {
        let own = surface(twin).snapped(part, &up).expect("an area");
        for _ in 0..40 {
            let lean = vector::<N, D>(random.unit_vector());
            for normal in [lean, (own + lean * N::lit(0.3)).normalize(), own, -own, up] {
                for &feature in features {
                    let expected = surface(twin).admits(part, feature, &normal);
                    let found = surface(field).admits(part, feature, &normal);
                    assert_eq!(found, expected, "{part} {feature:?} {normal:?}");
                    admitted += usize::from(found);
                }
                let expected = surface(twin).snapped(part, &normal).expect("an area");
                let found = surface(field).snapped(part, &normal).expect("an area");
                assert!((found - expected).norm() <= N::lit(4.0) * N::EPSILON, "{part}");
            }
        }
    }
    admitted
}

#[test]
fn a_sheet_is_like_the_mesh_of_its_triangles() {
    let mut random = Random::new(20);
    let at = |index| [FeatureId::Vertex(index), FeatureId::Edge(index)];
    let features: Vec<_> = (0..3).flat_map(at).chain([FeatureId::Face(0)]).collect();
    for reach in [1.0, 1.0, 0.0] {
        let heights = (0..30).map(|_| random.range(-reach, reach)).collect();
        let field = HeightField::<f64, 3>::new(5, 6, heights, vector([5.0, 1.0, 4.0]));
        let vertices = corners(&field);
        let triangles: Vec<_> =
            (0..field.num_parts()).map(|i| [0, 1, 2].map(|k| 3 * i + k)).collect();
        let twin = mesh::<f64, 3>(&vertices, &triangles);
        let admitted = compare(&field, &twin, &features);
        assert!(admitted > 500, "{admitted} of many");
        let admitted = compare(&field.one_sided(), &TriMesh::one_sided(twin), &features);
        assert!(admitted > 200, "{admitted} of many");
    }
}

#[test]
fn a_line_is_like_the_polyline_of_its_segments() {
    let mut random = Random::new(22);
    let features = [FeatureId::Vertex(0), FeatureId::Vertex(1), FeatureId::Edge(0)];
    for reach in [1.0, 0.002, 0.0] {
        let heights = (0..30).map(|_| random.range(-reach, reach)).collect();
        let field = HeightField::<f64, 2>::new(heights, vector([29.0, 1.0]));
        // The front of a field is on the left of its segments; the front of a polyline is on the
        // right.
        let vertices = corners(&field).into_iter().map(|p| vector::<f64, 2>(p).into()).collect();
        let segments = (0..field.num_parts()).map(|i| [2 * i, 2 * i + 1]).collect();
        let twin = Polyline::<f64, 2>::new(vertices, segments);
        assert!(compare(&field, &twin, &features) > 100, "some are admitted");
    }
}
