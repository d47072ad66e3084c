//! Tests that every representation of poses and of shapes gives the same bits.

use impinge::batch::{
    AsPose, BatchError, ClosestColumns, Control, Matrices, MatrixError, OnePose, PairBatch,
    PoseSource, Shapes, Side, WitnessColumns,
};
use impinge::math::{AbstractRotation, Pose, Real, Space, Vector};
use impinge::shape::{Ball, Cuboid, ShapeHandle};

use super::scene::{Scene, scene2, scene3};
use crate::support::samples::stride;

/// Returns the poses as homogeneous matrices, row by row.
fn numbers<N: Real, const D: usize>(poses: &[Pose<N, D>]) -> Vec<N> {
    let mut numbers = Vec::new();
    for pose in poses {
        for row in 0..D {
            numbers.extend((0..D).map(|column| pose.rotation[(row, column)]));
            numbers.push(pose.translation[row]);
        }
        numbers.extend([N::ZERO; D]);
        numbers.push(N::ONE);
    }
    numbers
}

/// Returns the bits of all distances of a batch, and of the distance, the first point and the
/// normal of each witness up to distance 2.
fn facts<N: Space<D>, const D: usize>(batch: &PairBatch<'_, N, D>) -> Vec<u64> {
    let count = batch.len();
    let (mut distance, mut away) = (vec![N::ZERO; count], vec![N::ZERO; count]);
    let (mut point1, mut normal) = (vec![[N::ZERO; D]; count], vec![[N::ZERO; D]; count]);
    batch.distances(&Control::new(), &mut distance).expect("good");
    let out = WitnessColumns {
        distance: &mut away,
        point1: &mut point1,
        normal: &mut normal,
        ..Default::default()
    };
    batch.witnesses(N::TWO, &Control::new(), out).expect("good");
    let numbers = distance.into_iter().chain(away);
    let all = numbers.chain(point1.into_iter().flatten()).chain(normal.into_iter().flatten());
    all.map(Real::bits).collect()
}

fn check<N: Space<D>, R: AbstractRotation<N, D> + Copy + Sync, const D: usize>(
    mut scene: Scene<N, R, D>,
) {
    // A NaN translation is refused in a matrix, so it is replaced here.
    for pose in &mut scene.poses[1] {
        if !pose.translation.vector.iter().all(|x| x.is_finite_number()) {
            pose.translation.vector = Vector::<N, D>::zeros();
        }
    }
    let expected = facts(&scene.batch());
    let poses = scene
        .poses
        .each_ref()
        .map(|list| list.iter().map(AsPose::<N, D>::to_pose).collect::<Vec<Pose<N, D>>>());
    let numbers = poses.each_ref().map(|list| numbers(list));
    let matrices = numbers.each_ref().map(|list| Matrices::try_new(list).expect("poses"));
    let slices = poses.each_ref().map(Vec::as_slice);
    let of = |sources: [&dyn PoseSource<N, D>; 2]| {
        let [side1, side2] = [0, 1].map(|side| scene.side(side, sources[side]));
        facts(&PairBatch::try_new(side1, side2).expect("as many"))
    };
    assert_eq!(of([&poses[0], &poses[1]]), expected, "poses");
    assert_eq!(of([&slices[0], &slices[1]]), expected, "slices");
    assert_eq!(of([&matrices[0], &matrices[1]]), expected, "matrices");
    assert_eq!(of([&matrices[0], &scene.poses[1]]), expected, "mixed");
    let each = [0, 1].map(|side| {
        (0..scene.len()).map(|index| scene.shape(side, index).clone()).collect::<Vec<_>>()
    });
    let [side1, side2] = [0, 1]
        .map(|side| Side::try_new(Shapes::Each(&each[side]), &scene.poses[side]).expect("as many"));
    assert_eq!(facts(&PairBatch::try_new(side1, side2).expect("as many")), expected, "each");
}

#[test]
fn forms_of_poses_and_arrangements_of_shapes() {
    check(scene2::<f32>(0.0).thinned());
    check(scene2::<f64>(0.0).thinned());
    check(scene3::<f32>(0.0).thinned());
    check(scene3::<f64>(1e6).thinned());
}

/// Asserts that a single shape or pose gives the same bits as a list of copies of it: for each
/// shape in one of the five arrangements, which takes turns, or in all if the [`stride`] is 1.
fn ones<N: Space<D>, R: AbstractRotation<N, D> + Copy + Sync, const D: usize>(
    scene: &Scene<N, R, D>,
) {
    let side2 = scene.side(1, &scene.poses[1]);
    for (index, shape) in scene.shapes.iter().enumerate() {
        let (one, copies) = (OnePose(scene.poses[1][3]), vec![scene.poses[1][3]; scene.len()]);
        let clones = vec![shape.clone(); scene.len()];
        let all = Side::try_new(Shapes::Each(&clones), &copies).expect("as many");
        let expected = facts(&PairBatch::try_new(all, side2).expect("as many"));
        let single = std::slice::from_ref(shape);
        let arrangements = [
            Side::try_new(Shapes::One(&**shape), &one),
            Side::try_new(Shapes::One(&**shape), &copies),
            Side::try_new(Shapes::Each(&clones), &one),
            Side::try_new(Shapes::Each(single), &one),
            Side::try_new(Shapes::Picked { shapes: single, picks: &[0] }, &copies),
        ];
        for (number, side) in arrangements.into_iter().enumerate() {
            if (index + number) % stride(5) != 0 {
                continue;
            }
            let batch = PairBatch::try_new(side.expect("good"), side2).expect("one against many");
            assert_eq!(batch.len(), scene.len(), "one stands for all");
            assert_eq!(facts(&batch), expected, "shape {index}, arrangement {number}");
        }
    }
}

#[test]
fn one_stands_for_as_many_as_are_needed() {
    ones(&scene2::<f64>(0.0).thinned());
    ones(&scene3::<f32>(0.0).thinned());
}

/// Asserts for a ball and a box that an element of a batch has no result if a number of its pose is
/// not finite.
#[test]
fn broken_poses_have_no_answers() {
    let shapes: [ShapeHandle<f32, 3>; 2] = [
        ShapeHandle::new(Ball::new(1.0)),
        ShapeHandle::new(Cuboid::new(Vector::<f32, 3>::repeat(1.0))),
    ];
    let here = OnePose(Pose::identity());
    for (shape, bad) in shapes.iter().flat_map(|s| [f32::NAN, f32::INFINITY].map(|bad| (s, bad))) {
        let mut poses = vec![Pose::<f32, 3>::identity(); 13];
        (0..9).for_each(|index| poses[index].rotation[index] = bad);
        (0..3).for_each(|axis| poses[9 + axis].translation[axis] = bad);
        let one = Side::try_new(Shapes::One(&*shapes[0]), &here).expect("one");
        let many = Side::try_new(Shapes::One(&**shape), &poses).expect("many");
        let batch = PairBatch::try_new(one, many).expect("one against many");
        let mut distance = vec![-1.0; 13];
        batch.distances(&Control::new(), &mut distance).expect("no error");
        assert_eq!(distance[12], 0.0, "the last is good");
        assert!(distance[..12].iter().all(|&x| x == f32::INFINITY), "{bad}: {distance:?}");
        let out = ClosestColumns { distance: &mut distance, ..Default::default() };
        batch.closest_points(f32::INFINITY, &Control::new(), out).expect("no error");
        assert!(distance[..12].iter().all(|&x| x == f32::INFINITY), "{bad}: {distance:?}");
        assert_eq!(batch.nearest(f32::INFINITY, &Control::new()), Ok(Some((12, 0.0))), "the good");
    }
}

#[test]
fn matrices_that_are_no_poses_are_refused() {
    let good = numbers(&[Pose::<f64, 3>::identity(); 3]);
    let refused = |at: usize, value: f64| {
        let mut bad = good.clone();
        bad[16 + at] = value;
        match Matrices::<f64, 3>::try_new(&bad) {
            Err(BatchError::Matrix { index: 1, error }) => error,
            other => panic!("{value} at {at}: {other:?}"),
        }
    };
    let infinity = MatrixError::NotFinite { row: 2, column: 3, value: f64::INFINITY };
    assert_eq!(refused(11, f64::INFINITY), infinity, "a translation");
    assert!(
        matches!(refused(0, f64::NAN), MatrixError::NotFinite { row: 0, column: 0, .. }),
        "a rotation"
    );
    assert_eq!(refused(12, 0.5), MatrixError::LastRow { column: 0, value: 0.5 }, "projective");
    assert_eq!(refused(15, 2.0), MatrixError::LastRow { column: 3, value: 2.0 }, "scaled");
    let stretched = MatrixError::NotOrthogonal { columns: [1, 1], product: 4.0 };
    assert_eq!(refused(5, 2.0), stretched, "scaled along an axis");
    let sheared = MatrixError::NotOrthogonal { columns: [0, 0], product: 1.0625 };
    assert_eq!(refused(8, 0.25), sheared, "sheared");
    assert_eq!(refused(5, -1.0), MatrixError::NotARotation { determinant: -1.0 }, "mirrored");
    assert!(Matrices::<f64, 3>::try_new(&good[..47]).is_err(), "a number is missing");
    let error = Matrices::<f64, 3>::try_new(&good[..47]).expect_err("a number is missing");
    let expected = BatchError::PartialRow { argument: "matrices", given: 47, width: 16 };
    assert_eq!(error, expected, "what is said");
    assert_eq!(Matrices::<f64, 3>::try_new(&[]).expect("none").len(), 0, "none");
}

#[test]
fn five_decimals_make_a_rotation() {
    let (sine, cosine) = (0.479_426_f64, 0.877_583);
    let rounded = |x: f64| (x * 1e5).round() / 1e5;
    let matrix = |s: f64, c: f64| [c, -s, 0.0, s, c, 0.0, 0.0, 0.0, 1.0];
    let numbers = matrix(rounded(sine), rounded(cosine));
    assert!(Matrices::<f64, 2>::try_new(&numbers).is_ok(), "as a file has it");
    let coarse = matrix((sine * 1e3).round() / 1e3, (cosine * 1e3).round() / 1e3);
    assert!(Matrices::<f64, 2>::try_new(&coarse).is_err(), "three decimals will not do");
}
