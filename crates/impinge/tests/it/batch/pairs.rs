//! Compares the results of each batch query of pairs with those of single calls.

use impinge::batch::{
    ClosestColumns, ContactColumns, Control, ImpactColumns, NO_FEATURE, WitnessColumns,
};
use impinge::math::{AbstractRotation, Point, Space, Vector};
use impinge::query::{
    ClosestPoints, ImpactOptions, Moving, Proximity, closest_points, contact, distance, impact,
    proximity, witness,
};
use impinge::shape::FeatureId;

use super::scene::{Scene, assert_number, assert_point, on_threads, scene2, scene3};

/// Limits at which some pairs of a scene have a result and others have none.
const LIMITS: [f64; 4] = [0.0, 0.5, f64::INFINITY, -0.25];

/// Calls a generic function with thinned scenes of both dimensions and scalars near the origin, and
/// with `f64` scenes 1e6 away from it.
macro_rules! everywhere {
    ($check:ident) => {
        $check(&scene2::<f32>(0.0).thinned());
        $check(&scene2::<f64>(1e6).thinned());
        $check(&scene3::<f32>(0.0).thinned());
        $check(&scene3::<f64>(0.0).thinned());
        $check(&scene3::<f64>(1e6).thinned());
    };
}

fn distances<N: Space<D>, R: AbstractRotation<N, D> + Sync, const D: usize>(
    scene: &Scene<N, R, D>,
) {
    let mut out = vec![N::ZERO; scene.len()];
    for threads in [1, 4] {
        out.fill(-N::ONE);
        on_threads(threads, || scene.batch().distances(&Control::new(), &mut out)).expect("good");
        for (index, &found) in out.iter().enumerate() {
            let [m1, m2] = [&scene.poses[0][index], &scene.poses[1][index]];
            let [g1, g2] = [0, 1].map(|side| &**scene.shape(side, index));
            assert_number(found, distance(m1, g1, m2, g2), &format!("pair {index}"));
        }
    }
    let touching = out.iter().filter(|&&distance| distance == N::ZERO).count();
    let apart = out.iter().filter(|distance| distance.is_finite_number()).count() - touching;
    assert!(touching * 5 > scene.len() && apart * 5 > scene.len(), "{touching} and {apart}");
}

fn nearest_points<N: Space<D>, R: AbstractRotation<N, D> + Sync, const D: usize>(
    scene: &Scene<N, R, D>,
) {
    let (mut away, mut all) = (vec![N::ZERO; scene.len()], vec![N::ZERO; scene.len()]);
    scene.batch().distances(&Control::new(), &mut all).expect("good");
    let mut points = [vec![[N::ZERO; D]; scene.len()], vec![[N::ZERO; D]; scene.len()]];
    for (threads, limit) in [1, 4].into_iter().flat_map(|count| LIMITS.map(|limit| (count, limit)))
    {
        let limit = N::lit(limit);
        let [point1, point2] = &mut points;
        let out = ClosestColumns { distance: &mut away, point1, point2 };
        on_threads(threads, || scene.batch().closest_points(limit, &Control::new(), out))
            .expect("good");
        for index in 0..scene.len() {
            let [m1, m2] = [&scene.poses[0][index], &scene.poses[1][index]];
            let [g1, g2] = [0, 1].map(|side| &**scene.shape(side, index));
            let (expected, nearest) = match closest_points(m1, g1, m2, g2, limit) {
                ClosestPoints::Intersecting => (N::ZERO, [None; 2]),
                ClosestPoints::WithinMargin(one, other) => (all[index], [Some(one), Some(other)]),
                ClosestPoints::Disjoint => (N::INFINITY, [None; 2]),
            };
            let what = format!("pair {index} within {limit}");
            assert_number(away[index], expected, &what);
            assert_point(&points[0][index], nearest[0], &what);
            assert_point(&points[1][index], nearest[1], &what);
        }
    }
}

fn witnesses<N: Space<D>, R: AbstractRotation<N, D> + Sync, const D: usize>(
    scene: &Scene<N, R, D>,
) {
    let count = scene.len();
    let (mut away, mut parts) = (vec![N::ZERO; count], [vec![0; count], vec![0; count]]);
    let mut features = [vec![NO_FEATURE; count], vec![NO_FEATURE; count]];
    let mut points = [(); 3].map(|()| vec![[N::ZERO; D]; count]);
    for (threads, limit) in [1, 4].into_iter().zip([0.5, f64::INFINITY]) {
        let limit = N::lit(limit);
        let ([point1, point2, normal], [part1, part2]) = (&mut points, &mut parts);
        let [feature1, feature2] = &mut features;
        let distance = &mut away;
        let out =
            WitnessColumns { distance, point1, point2, normal, part1, part2, feature1, feature2 };
        on_threads(threads, || scene.batch().witnesses(limit, &Control::new(), out)).expect("good");
        for index in 0..count {
            let [m1, m2] = [&scene.poses[0][index], &scene.poses[1][index]];
            let [g1, g2] = [0, 1].map(|side| &**scene.shape(side, index));
            let found = witness(m1, g1, m2, g2, limit);
            let what = format!("pair {index} within {limit}");
            assert_number(away[index], found.map_or(N::INFINITY, |found| found.distance), &what);
            assert_point(&points[0][index], found.map(|found| found.point1), &what);
            assert_point(&points[1][index], found.map(|found| found.point2), &what);
            let normal = found.map(|found| Point::from(*found.normal));
            assert_point(&points[2][index], normal, &what);
            let facts = (parts[0][index], parts[1][index], features[0][index], features[1][index]);
            let none = (u32::MAX, u32::MAX, FeatureId::Face(u32::MAX), FeatureId::Face(u32::MAX));
            let expected = found.map(|f| (f.part1, f.part2, f.feature1, f.feature2));
            assert_eq!(facts, expected.unwrap_or(none), "{what}");
        }
    }
}

fn proximities<N: Space<D>, R: AbstractRotation<N, D> + Sync, const D: usize>(
    scene: &Scene<N, R, D>,
) {
    let mut out = vec![Proximity::Disjoint; scene.len()];
    for (threads, margin) in [1, 4].into_iter().zip([0.5, 0.0]) {
        let margin = N::lit(margin);
        on_threads(threads, || scene.batch().proximities(margin, &Control::new(), &mut out))
            .expect("good");
        for (index, found) in out.iter().enumerate() {
            let [m1, m2] = [&scene.poses[0][index], &scene.poses[1][index]];
            let [g1, g2] = [0, 1].map(|side| &**scene.shape(side, index));
            assert_eq!(*found, proximity(m1, g1, m2, g2, margin), "pair {index}");
        }
    }
}

fn contacts<N: Space<D>, R: AbstractRotation<N, D> + Sync, const D: usize>(scene: &Scene<N, R, D>) {
    let mut depths = vec![N::ZERO; scene.len()];
    let mut points = [(); 3].map(|()| vec![[N::ZERO; D]; scene.len()]);
    let mut answered = 0;
    for (threads, limit) in [4, 1, 4].into_iter().zip(LIMITS) {
        let limit = N::lit(limit);
        let [normal, point1, point2] = &mut points;
        let out = ContactColumns { depth: &mut depths, normal, point1, point2 };
        on_threads(threads, || scene.batch().contacts(limit, &Control::new(), out)).expect("good");
        for index in 0..scene.len() {
            let [m1, m2] = [&scene.poses[0][index], &scene.poses[1][index]];
            let [g1, g2] = [0, 1].map(|side| &**scene.shape(side, index));
            let found = contact(m1, g1, m2, g2, limit);
            let what = format!("pair {index} within {limit}");
            assert_number(depths[index], found.map_or(-N::INFINITY, |found| found.depth), &what);
            let normal = found.map(|found| Point::from(*found.normal));
            assert_point(&points[0][index], normal, &what);
            assert_point(&points[1][index], found.map(|found| found.world1), &what);
            assert_point(&points[2][index], found.map(|found| found.world2), &what);
            answered += usize::from(found.is_some());
        }
    }
    assert!(answered > scene.len(), "{answered} contacts");
}

fn impacts<N: Space<D>, R: AbstractRotation<N, D> + Sync, const D: usize>(scene: &Scene<N, R, D>) {
    let count = scene.len();
    let velocity = |index: usize| {
        let components: [f64; 3] = [[-1.0, 0.0, 0.0], [-2.0, 1.0, 0.5], [0.0, 0.0, 0.0]][index % 3];
        Vector::<N, D>::from_fn(|axis, _| N::lit(components[axis]))
    };
    let mut each: Vec<[N; D]> = (0..count).map(|index| velocity(index).into()).collect();
    each[5][0] = N::INFINITY;
    let one = [[N::HALF; D]];
    let (mut times, mut parts) = (vec![N::ZERO; count], [vec![0; count], vec![0; count]]);
    let (mut points, mut states) = ([(); 3].map(|()| vec![[N::ZERO; D]; count]), vec![None; count]);
    let options = ImpactOptions::new().with_target_distance(N::lit(0.125));
    for (threads, first) in [1, 4].into_iter().zip([&one[..], &[]]) {
        let ([normal, point1, point2], [part1, part2]) = (&mut points, &mut parts);
        let (time, status) = (&mut times, &mut states);
        let out = ImpactColumns { time, normal, point1, point2, part1, part2, status };
        on_threads(threads, || {
            scene.batch().impacts([first, &each], &options, &Control::new(), out)
        })
        .expect("good");
        let velocity1 = first.first().map_or_else(Vector::<N, D>::zeros, |v| Vector::from(*v));
        for index in 0..count {
            let [m1, m2] = [&scene.poses[0][index], &scene.poses[1][index]];
            let [g1, g2] = [0, 1].map(|side| &**scene.shape(side, index));
            let moving2 = Moving::new(m2, &Vector::<N, D>::from(each[index]), g2);
            let found = impact(&Moving::new(m1, &velocity1, g1), &moving2, &options);
            let what = format!("pair {index}");
            assert_number(times[index], found.map_or(N::INFINITY, |found| found.toi), &what);
            let normal = found.map(|found| Point::from(*found.normal));
            assert_point(&points[0][index], normal, &what);
            assert_point(&points[1][index], found.map(|found| found.world1), &what);
            assert_point(&points[2][index], found.map(|found| found.world2), &what);
            let expected = found.map_or((u32::MAX, u32::MAX), |found| (found.part1, found.part2));
            assert_eq!((parts[0][index], parts[1][index]), expected, "{what}");
            assert_eq!(states[index], found.map(|found| found.status), "{what}");
        }
        let answered = times.iter().filter(|time| time.is_finite_number()).count();
        assert!(answered * 4 > count && answered < count, "{answered} of {count}");
    }
}

#[test]
fn distances_are_those_of_single_calls() {
    everywhere!(distances);
}

#[test]
fn closest_points_are_those_of_single_calls() {
    everywhere!(nearest_points);
}

#[test]
fn witnesses_are_those_of_single_calls() {
    everywhere!(witnesses);
}

#[test]
fn proximities_are_those_of_single_calls() {
    everywhere!(proximities);
}

#[test]
fn contacts_are_those_of_single_calls() {
    everywhere!(contacts);
}

#[test]
fn impacts_are_those_of_single_calls() {
    everywhere!(impacts);
}
