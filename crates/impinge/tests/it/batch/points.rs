//! Compares the results of batches of point queries with those of single calls.

use impinge::batch::{Control, NO_FEATURE, OnePose, PointBatch, ProjectionColumns, Shapes, Side};
use impinge::math::{AbstractRotation, Isometry, Point, Space};
use impinge::query::PointQuery;

use super::scene::{Scene, assert_number, assert_point, on_threads, scene2, scene3};
use crate::support::query_support::random::Random;

/// Returns a point near the first solid of each pair; two of the points are not finite.
fn points_near<N: Space<D>, R: AbstractRotation<N, D> + Sync, const D: usize>(
    scene: &Scene<N, R, D>,
) -> Vec<[N; D]> {
    let random = &mut Random(8, false);
    let near =
        |pose: &Isometry<N, R, D>| pose.translation.vector + random.vector::<N, D>() * N::TWO;
    let mut points: Vec<[N; D]> = scene.poses[0].iter().map(near).map(Into::into).collect();
    points[70][0] = N::lit(f64::NAN);
    points[71][1] = N::INFINITY;
    points
}

fn check<N: Space<D>, R: AbstractRotation<N, D> + Sync, const D: usize>(scene: &Scene<N, R, D>) {
    let (points, count) = (points_near(scene), scene.len());
    let side = scene.side(1, &scene.poses[1]);
    let batch = PointBatch::try_new(side, &points).expect("as many");
    let (mut point, mut is_inside) = (vec![[N::ZERO; D]; count], vec![false; count]);
    let (mut part, mut feature) = (vec![0; count], vec![NO_FEATURE; count]);
    let (mut signed, mut contained) = (vec![N::ZERO; count], vec![false; count]);
    for (threads, solid) in [(1, true), (4, false)] {
        on_threads(threads, || {
            let (point, is_inside) = (&mut point[..], &mut is_inside[..]);
            let (part, feature) = (&mut part[..], &mut feature[..]);
            let out = ProjectionColumns { point, is_inside, part, feature };
            batch.project(solid, &Control::new(), out).expect("good");
            batch.signed_distances(&Control::new(), &mut signed).expect("good");
            batch.contains(&Control::new(), &mut contained).expect("good");
        });
        for index in 0..count {
            let (shape, m) = (&**scene.shape(1, index), &scene.poses[1][index]);
            let (asked, what) = (Point::from(points[index]), format!("point {index}"));
            let numbers = asked.iter().chain(m.translation.vector.iter());
            if !numbers.into_iter().all(|x| x.is_finite_number()) {
                assert_point(&point[index], None, &what);
                assert_eq!((is_inside[index], contained[index]), (false, false), "{what}");
                assert_eq!((part[index], feature[index]), (u32::MAX, NO_FEATURE), "{what}");
                assert_number(signed[index], N::INFINITY, &what);
                continue;
            }
            let (nearest, location) = shape.project_point_with_location(m, &asked, solid);
            assert_point(&point[index], Some(nearest.point), &what);
            assert_eq!(is_inside[index], nearest.is_inside, "{what}");
            assert_eq!((part[index], feature[index]), (location.part, location.feature), "{what}");
            assert_eq!(nearest, shape.project_point(m, &asked, solid), "{what}");
            assert_number(signed[index], shape.distance_to_point(m, &asked, false), &what);
            assert_eq!(contained[index], shape.contains_point(m, &asked), "{what}");
        }
    }
    let inside = contained.iter().filter(|&&is_inside| is_inside).count();
    assert!(inside * 10 > count && inside * 10 < 9 * count, "{inside} of {count} are inside");
}

#[test]
fn projections_are_those_of_single_calls() {
    check(&scene2::<f32>(0.0));
    check(&scene2::<f64>(1e6));
    check(&scene3::<f32>(0.0));
    check(&scene3::<f64>(0.0));
}

/// Compares one point against many shapes and many points against one shape with single calls.
fn one_against_many<N: Space<D>, R: AbstractRotation<N, D> + Copy + Sync, const D: usize>(
    scene: &Scene<N, R, D>,
) {
    let mut points = points_near(scene);
    points.truncate(70);
    let mut found = vec![N::ZERO; points.len()];
    for shape in &scene.shapes {
        let pose = &scene.poses[1][3];
        let one = OnePose(*pose);
        let side = Side::try_new(Shapes::One(&**shape), &one).expect("one");
        let batch = PointBatch::try_new(side, &points).expect("one against many");
        batch.signed_distances(&Control::new(), &mut found).expect("good");
        for (point, &found) in points.iter().zip(&found) {
            let expected = shape.distance_to_point(pose, &Point::from(*point), false);
            assert_number(found, expected, "one shape");
        }
    }
    let mut found = vec![N::ZERO; scene.len()];
    let batch = PointBatch::try_new(scene.side(0, &scene.poses[0]), &points[..1]).expect("good");
    assert_eq!((batch.len(), batch.is_empty()), (scene.len(), false), "one point for all");
    batch.signed_distances(&Control::new(), &mut found).expect("good");
    for (index, &found) in found.iter().enumerate() {
        let (shape, m) = (&**scene.shape(0, index), &scene.poses[0][index]);
        let expected = shape.distance_to_point(m, &Point::from(points[0]), false);
        assert_number(found, expected, "one point");
    }
}

#[test]
fn one_of_either_against_many() {
    one_against_many(&scene2::<f64>(0.0));
    one_against_many(&scene3::<f32>(0.0));
}
