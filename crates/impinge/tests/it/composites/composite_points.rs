//! Tests point queries on composites: the result comes from the nearest part, or from the part in
//! which the point lies deepest.

use crate::support::composite_support;
use crate::support::query_support;

use composite_support::scenes::Maker;
use composite_support::{Piece, Pieces};
use impinge::math::{AbstractRotation, Isometry, Isometry3, Point, Pose, Real, Space, Vector};
use impinge::query::{Barycentric, PointQuery, distance};
use impinge::shape::{
    Ball, CompositeShape, Cuboid, FeatureId, PartSolid, Segment, Shape, Triangle,
};
use query_support::random::Random;
use query_support::samples::{PLANE, SPACE, sample2, sample3};

fn dot<N: Real, const D: usize, const K: usize>(
    weights: [N; K],
    corners: [Point<N, D>; K],
) -> Point<N, D> {
    let mut sum = Vector::<N, D>::zeros();
    for (weight, corner) in weights.iter().zip(&corners) {
        assert!(*weight >= N::ZERO && *weight <= N::ONE, "{weights:?}");
        sum += corner.coords * *weight;
    }
    Point::from(sum)
}

/// Returns the point with these barycentric weights, in the frame of the part. Returns `None` for a
/// part that is a [`Shape`]; asserts that its weights are defined if and only if the shape is a
/// triangle or a segment.
fn weighed<N: Real, const D: usize>(
    solid: &PartSolid<'_, N, D>,
    barycentric: &Barycentric<N>,
) -> Option<Point<N, D>> {
    match (solid, barycentric) {
        (PartSolid::Triangle(triangle), Barycentric::Triangle(weights)) => {
            Some(dot(*weights, *triangle.corners()))
        }
        (PartSolid::Segment(segment), Barycentric::Segment(weights)) => {
            Some(dot(*weights, [*segment.a(), *segment.b()]))
        }
        (PartSolid::Shape(shape), weights) => {
            let kind = format!("{:?}", shape.geometry().kind());
            let named = kind == "Triangle" || kind == "Segment";
            assert_eq!(named, *weights != Barycentric::Undefined, "{kind} {weights:?}");
            None
        }
        other => panic!("{other:?} do not go together"),
    }
}

fn check<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    maker: &Maker<N, R, D>,
    scale: f64,
) {
    let scale = N::lit(scale);
    let (mut inside, mut weighted) = (0, 0);
    for seed in 0..80 {
        let random = &mut Random(seed, seed % 7 == 0);
        let scene = maker.scene(random, 1 + usize::try_from(seed % 30).expect("few"), scale);
        let m = maker.place(random, scale * N::lit(9.0));
        let noise = scale * (N::EPSILON * N::lit(1024.0));
        for shot in 0..20 {
            let mut local = Point::from(random.vector::<N, D>() * (scale * N::lit(6.0)));
            if shot % 4 == 0 {
                // Moves the point onto the surface of the nearest part, to test points on
                // boundaries.
                local = scene.fast.project_local_point(&local).0.point;
            }
            let point = m.transform_point(&local);
            let signed = scene.fast.distance_to_point(&m, &point, false);
            let one = |part: usize| {
                let (place, (_, piece)) = (&scene.places[part], &scene.fast.parts[part]);
                piece.as_shape().distance_to_point(&(&m * place), &point, false)
            };
            let each = (0..scene.places.len()).map(one);
            let brute = each.fold(N::INFINITY, |a, b| if b < a { b } else { a });
            assert!((signed - brute).abs() <= noise, "{seed} {signed:?} {brute:?}");
            let slow = scene.slow.distance_to_point(&m, &point, false);
            assert_eq!(signed, slow, "whatever the search proposes");

            let solid = scene.fast.project_point(&m, &point, true);
            let is_inside = signed <= N::ZERO;
            assert_eq!(scene.fast.contains_point(&m, &point), is_inside, "{seed} {signed:?}");
            assert_eq!(solid.is_inside, is_inside, "{seed}");
            let outer = scene.fast.distance_to_point(&m, &point, true);
            assert_eq!(outer == N::ZERO, is_inside, "{seed}");
            assert!(!is_inside || solid.point == point, "its own projection");
            let (boundary, feature) = scene.fast.project_point_with_feature(&m, &point);
            let apart = (boundary.point - point).norm();
            assert!((apart - signed.abs()).abs() <= noise, "{seed} {apart:?} {signed:?}");

            let spot = Ball::new(N::ZERO);
            let there = Isometry::from_parts(point.coords.into(), R::identity());
            let apart = distance(&m, &scene.fast, &there, &spot);
            assert!((apart - outer).abs() <= noise, "a ball without extent: {apart:?} {outer:?}");

            for solid in [true, false] {
                let (nearest, location) =
                    scene.fast.project_local_point_with_location(&local, solid);
                let part = scene.fast.part(location.part);
                assert!(shot % 4 == 0 || location.feature == feature, "{location:?} {feature:?}");
                if let Some(point) = weighed(&part.solid, &location.barycentric) {
                    let point = part.pose.point(&point);
                    let gap = (point - nearest.point).norm();
                    assert!(
                        gap <= noise,
                        "{seed} {gap:?} {solid} {nearest:?} {location:?} {part:?}"
                    );
                    weighted += 1;
                }
            }
            inside += u32::from(is_inside);
        }
    }
    assert!(inside > 100 && weighted > 1000, "{inside} inside, {weighted} with weights");
}

#[test]
fn the_nearest_part_answers() {
    for scale in [1.0, 1e-3, 1e5] {
        check(&Maker::<f32, _, 2> { kinds: &PLANE, sample: sample2, turn: Random::turn2 }, scale);
        check(&Maker::<f32, _, 3> { kinds: &SPACE, sample: sample3, turn: Random::turn3 }, scale);
        check(&Maker::<f64, _, 2> { kinds: &PLANE, sample: sample2, turn: Random::turn2 }, scale);
        check(&Maker::<f64, _, 3> { kinds: &SPACE, sample: sample3, turn: Random::turn3 }, scale);
    }
}

#[test]
fn inside_the_deepest_part_answers() {
    let square = || Piece::of(Cuboid::new(Vector::<f64, 2>::new(1.0, 1.0)));
    let at = |x: f64| Pose::from_translation(Vector::<f64, 2>::new(x, 0.0));
    let two = Pieces::new(vec![(at(0.0), square()), (at(1.5), square())]);
    let here = impinge::math::Isometry2::identity();
    let p = |x: f64| Point::<f64, 2>::new(x, 0.0);
    assert_eq!(two.distance_to_point(&here, &p(0.625), false), -0.375, "in the first");
    let (_, location) = two.project_local_point_with_location(&p(0.875), true);
    assert_eq!((location.part, location.barycentric), (1, Barycentric::Undefined), "deeper");
    assert_eq!(two.distance_to_point(&here, &p(0.75), false), -0.25, "in both as deep");
    assert_eq!(two.distance_to_point(&here, &p(0.75), true), 0.0, "solid");
    assert_eq!(two.project_local_point_with_location(&p(0.75), true).1.part, 0, "the first");
}

fn close(weights: [f64; 3], expected: [f64; 3], tolerance: f64) -> bool {
    weights.iter().zip(&expected).all(|(weight, right)| (weight - right).abs() <= tolerance)
}

#[test]
fn locations_name_corners_and_sides_exactly() {
    let p = Point::<f64, 3>::new;
    let points = [p(0.0, 0.0, 0.0), p(4.0, 0.0, 0.0), p(4.0, 0.0, 4.0), p(0.0, 0.0, 4.0)];
    let mesh = Pieces::mesh(&points, &[[0, 2, 1], [0, 3, 2]]);
    let m = Isometry3::translation(10.0, 0.0, 0.0);
    let at = |x, y, z| mesh.project_point_with_location(&m, &p(10.0 + x, y, z), true).1;
    let weights = |location: impinge::query::PointLocation<f64>| match location.barycentric {
        Barycentric::Triangle(weights) => (location.part, location.feature, weights),
        other => panic!("{other:?} is not of a triangle"),
    };
    assert_eq!(weights(at(5.0, 1.0, -1.0)), (0, FeatureId::Vertex(2), [0.0, 0.0, 1.0]), "1");
    assert_eq!(weights(at(-3.0, 1.0, 1.0)), (1, FeatureId::Edge(0), [0.75, 0.25, 0.0]), "03");
    let (part, feature, above) = weights(at(3.0, 1.0, 1.0));
    assert_eq!((part, feature), (0, FeatureId::Face(0)), "above");
    assert!(close(above, [0.25, 0.25, 0.5], 1e-15), "{above:?}");
    assert_eq!(weights(at(3.0, -1.0, 1.0)).1, FeatureId::Face(1), "below");
    let segment = Segment::new(points[0], points[1]);
    let (_, location) = segment.project_local_point_with_location(&p(1.0, 2.0, 0.0), true);
    assert_eq!(location.barycentric, Barycentric::Segment([0.75, 0.25]), "a segment");
    let needle = Triangle::new(p(0.0, 0.0, 0.0), p(8.0, 0.0, 0.0), p(4.0, 1e-9, 0.0));
    let (_, location) = needle.project_local_point_with_location(&p(3.0, 2.5e-10, 1.0), true);
    let Barycentric::Triangle([a, b, c]) = location.barycentric else { panic!("a triangle") };
    assert!(
        (8.0 * b + 4.0 * c - 3.0).abs() < 1e-12 && (a + b + c - 1.0).abs() < 1e-15,
        "{a} {b} {c}"
    );
}

#[test]
fn far_meshes_are_as_exact() {
    for far in [0.0_f32, 1024.0, 131_072.0] {
        let p = |x: f32, y: f32, z: f32| Point::<f32, 3>::new(far + x, y - far, far + z);
        let points = [p(0.0, 0.0, 0.0), p(4.0, 0.0, 0.0), p(4.0, 0.0, 4.0), p(0.0, 0.0, 4.0)];
        let mesh = Pieces::mesh(&points, &[[0, 2, 1], [0, 3, 2]]);
        let m = Isometry3::translation(-far, far, -far);
        let asked = Point::<f32, 3>::new(3.0, 0.0625, 1.0);
        assert_eq!(mesh.distance_to_point(&m, &asked, true), 0.0625, "{far}");
        assert!(!mesh.contains_point(&m, &asked), "{far}");
        let (_, location) = mesh.project_point_with_location(&m, &asked, true);
        let Barycentric::Triangle(weights) = location.barycentric else { panic!("a triangle") };
        assert!(close(weights.map(f64::from), [0.25, 0.25, 0.5], 1e-7), "{far} {weights:?}");
        assert!(mesh.contains_point(&m, &Point::<f32, 3>::new(3.0, 0.0, 1.0)), "{far}");
    }
}

#[test]
fn nowhere() {
    let none = Pieces::<f32, 3>::new(Vec::new());
    let here = Isometry3::identity();
    assert_eq!(none.distance_to_point(&here, &Point::origin(), true), f32::INFINITY, "no parts");
    assert!(!none.contains_point(&here, &Point::origin()), "in nothing");
    let one = Pieces::wrapped(Pose::identity(), Piece::of(Ball::new(1.0_f32)));
    for bad in [f32::NAN, f32::INFINITY] {
        let point = Point::<f32, 3>::new(bad, 0.0, 0.0);
        assert!(!one.contains_point(&here, &point), "{bad}");
        assert!(!one.project_point(&here, &point, true).is_inside, "{bad}");
    }
    assert_eq!(one.num_parts(), 1, "a ball");
    assert!(one.local_aabb().is_bounded(), "a ball");
}
