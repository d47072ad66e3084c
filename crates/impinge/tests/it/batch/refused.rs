//! Tests which inputs are refused and with which error, and that the output stays unchanged.

use impinge::batch::{
    BatchError, ClosestColumns, ContactColumns, Control, HitColumns, ImpactColumns, OnePose,
    PairBatch, PointBatch, ProjectionColumns, RayColumns, Shapes, Side, WitnessColumns,
};
use impinge::math::Pose;
use impinge::query::{ImpactOptions, Proximity};
use impinge::shape::{Ball, ShapeHandle};

type Poses = Vec<Pose<f64, 2>>;

fn balls(count: usize) -> Vec<ShapeHandle<f64, 2>> {
    vec![ShapeHandle::new(Ball::new(1.0)); count]
}

fn length(argument: &'static str, given: usize, needed: usize) -> BatchError {
    BatchError::Length { argument, given, needed }
}

#[test]
fn sides_need_as_many_of_both() {
    let (shapes, poses): (_, Poses) = (balls(3), vec![Pose::identity(); 4]);
    let refused = Side::try_new(Shapes::Each(&shapes), &poses).err();
    assert_eq!(refused, Some(length("poses", 4, 3)), "three and four");
    let none: Poses = Vec::new();
    let refused = Side::try_new(Shapes::Each(&shapes), &none).err();
    assert_eq!(refused, Some(length("poses", 0, 3)), "three and none");
    let side = Side::try_new(Shapes::Each(&shapes[..1]), &none).expect("one for none");
    assert!(side.is_empty(), "one stands for none");
    let picked = Shapes::Picked { shapes: &shapes, picks: &[0, 2, 3, 1] };
    let refused = Side::try_new(picked, &poses).err();
    assert_eq!(refused, Some(BatchError::Pick { index: 2, pick: 3, shapes: 3 }), "by its index");
}

#[test]
fn sides_of_different_lengths_are_no_batch() {
    let [three, four]: [Poses; 2] = [3, 4].map(|count| vec![Pose::identity(); count]);
    let (shapes, ball) = (balls(1), Ball::new(1.0));
    let side3 = Side::try_new(Shapes::Each(&shapes), &three).expect("three");
    let side4 = Side::try_new(Shapes::One(&ball), &four).expect("four");
    assert_eq!(PairBatch::try_new(side3, side4).err(), Some(length("side2", 4, 3)), "pairs");
    let points = [[0.0; 2]; 5];
    assert_eq!(PointBatch::try_new(side3, &points).err(), Some(length("points", 5, 3)), "points");
    let refused = RayColumns::try_new(side3, &points, &points).err();
    assert_eq!(refused, Some(length("origins", 5, 3)), "origins");
    let refused = RayColumns::try_new(side3, &points[..1], &points).err();
    assert_eq!(refused, Some(length("directions", 5, 3)), "directions");
}

/// Asserts for each method that output columns shorter than the batch are refused, with an error
/// that has the column's name and both lengths.
#[test]
fn columns_need_a_slot_for_each() {
    let (ball, poses): (_, Poses) = (Ball::new(1.0), vec![Pose::identity(); 3]);
    let here = OnePose(Pose::identity());
    let one = Side::try_new(Shapes::One(&ball), &here).expect("one");
    let side = Side::try_new(Shapes::One(&ball), &poses).expect("three");
    let (pairs, control) = (PairBatch::try_new(one, side).expect("three"), Control::new());
    let (mut numbers, mut points) = (vec![7.0; 3], vec![[7.0; 2]; 2]);
    let (two, short) = (length("out", 2, 3), &mut [7.0; 2]);
    assert_eq!(pairs.distances(&control, short), Err(two), "distances");
    assert_eq!(pairs.distances(&control, &mut []), Err(length("out", 0, 3)), "not even one");
    let mut near = [Proximity::WithinMargin; 2];
    assert_eq!(pairs.proximities(0.0, &control, &mut near), Err(two), "proximities");

    let out = ClosestColumns { distance: &mut numbers, point2: &mut points, ..Default::default() };
    let refused = pairs.closest_points(9.0, &control, out);
    assert_eq!(refused, Err(length("point2", 2, 3)), "closest points");
    let out = WitnessColumns { distance: &mut numbers, normal: &mut points, ..Default::default() };
    assert_eq!(pairs.witnesses(9.0, &control, out), Err(length("normal", 2, 3)), "witnesses");
    let out = ContactColumns { depth: &mut numbers, point1: &mut points, ..Default::default() };
    assert_eq!(pairs.contacts(9.0, &control, out), Err(length("point1", 2, 3)), "contacts");
    let out = ImpactColumns { time: &mut numbers, point1: &mut points, ..Default::default() };
    let refused = pairs.impacts([&[], &[]], &ImpactOptions::new(), &control, out);
    assert_eq!(refused, Err(length("point1", 2, 3)), "impacts");
    let out = ImpactColumns { time: &mut numbers, ..Default::default() };
    let refused = pairs.impacts([&[], &points], &ImpactOptions::new(), &control, out);
    assert_eq!(refused, Err(length("velocities2", 2, 3)), "velocities");

    let asked = [[5.0, 0.0]];
    let batch = PointBatch::try_new(side, &asked).expect("one point");
    let mut parts = [7; 1];
    let out = ProjectionColumns { part: &mut parts, ..Default::default() };
    assert_eq!(batch.project(true, &control, out), Err(length("part", 1, 3)), "projections");
    assert_eq!(batch.signed_distances(&control, short), Err(two), "signed distances");
    assert_eq!(batch.contains(&control, &mut [true; 2]), Err(two), "containment");
    let rays = RayColumns::try_new(side, &asked, &asked).expect("one ray");
    let out = HitColumns { time: &mut numbers, part: &mut parts, ..Default::default() };
    assert_eq!(rays.cast(&control, out), Err(length("part", 1, 3)), "rays");

    assert!(numbers.iter().chain(short.iter()).all(|&x| x == 7.0), "nothing was written");
    assert!(points.iter().flatten().all(|&x| x == 7.0), "nothing was written");
    assert_eq!((near, parts), ([Proximity::WithinMargin; 2], [7]), "nothing was written");
}

#[test]
fn empty_batches_have_no_answers() {
    let (ball, none): (_, Poses) = (Ball::new(1.0), Vec::new());
    let here = OnePose(Pose::identity());
    let one = Side::try_new(Shapes::One(&ball), &here).expect("one");
    let nobody = Side::try_new(Shapes::Each(&[]), &none).expect("none");
    for sides in [[one, nobody], [nobody, one], [nobody, nobody]] {
        let batch = PairBatch::try_new(sides[0], sides[1]).expect("none");
        assert!(batch.is_empty(), "one stands for none");
        assert_eq!(batch.distances(&Control::new(), &mut []), Ok(()), "no distance");
    }
    let points = PointBatch::try_new(nobody, &[[0.0; 2]]).expect("one point for none");
    assert_eq!(points.contains(&Control::new(), &mut []), Ok(()), "no point");
    let rays = RayColumns::try_new(one, &[], &[[0.0; 2]]).expect("no ray");
    assert_eq!(rays.cast(&Control::new(), HitColumns::default()), Ok(()), "no hit");
}
