//! Cases computed by hand: joints, touching to the last bit, empty checkers, cancellation.

use std::f64::consts::{FRAC_PI_2, PI};
use std::ops::ControlFlow;

use impinge::batch::{BatchError, Control};
use impinge::checker::{Body, Checker, Frame, FrameTree, Joint, NO_PAIR, NearestColumns, Obstacle};
use impinge::math::{Pose, Real, Space, Unit, Vector};
use impinge::shape::{Ball, Cuboid, Plane, ShapeHandle};

fn along<N: Real, const D: usize>(axis: usize, by: f64) -> Pose<N, D> {
    let mut by_axis = Vector::<N, D>::zeros();
    by_axis[axis] = N::lit(by);
    Pose::from_translation(by_axis)
}

fn axis<N: Real, const D: usize>(axis: usize) -> Unit<Vector<N, D>> {
    Unit::new_unchecked(along(axis, 1.0).translation)
}

/// Returns a checker with a ball that slides along the first axis, and a box whose nearest face is
/// at 2.
fn slider<N: Space<D>, const D: usize>(radius: f64) -> Checker<N, D> {
    let frame =
        Frame { parent: None, origin: Pose::identity(), joint: Joint::prismatic(axis(0), 0) };
    let tree = FrameTree::try_new(&[frame], 1).expect("one frame");
    let shape = ShapeHandle::new(Ball::new(N::lit(radius)));
    let body = Body { frame: 0, shape, pose: Pose::identity() };
    let mut checker = Checker::try_new(tree, vec![body], &[]).expect("a ball");
    let wall = ShapeHandle::new(Cuboid::new(Vector::<N, D>::repeat(N::ONE)));
    checker
        .try_set_obstacles(vec![Obstacle { shape: wall, pose: along(0, 3.0) }], &[])
        .expect("a wall");
    checker
}

/// Asserts that a body that touches an obstacle exactly is not free, and that a body at a distance
/// of one epsilon is free.
fn touches<N: Space<D>, const D: usize>() {
    for radius in [0.5, 0.0] {
        let checker = slider::<N, D>(radius);
        let face = N::lit(2.0 - radius);
        let rows = [face - N::EPSILON, face, face + N::EPSILON];
        let (mut free, mut distance) = ([false; 3], [N::ZERO; 3]);
        checker.are_free(&rows, N::ZERO, &Control::new(), &mut free).expect("three");
        assert_eq!(free, [true, false, false], "a ball of {radius}");
        let out = NearestColumns { distance: &mut distance, ..Default::default() };
        checker.nearest(&rows, N::INFINITY, &Control::new(), out).expect("three");
        assert_eq!(distance, [N::EPSILON, N::ZERO, N::ZERO], "a ball of {radius}");
        let quarter = [face - N::lit(0.25)];
        for (clearance, expected) in [(0.25, false), (0.2499, true)] {
            let mut free = [!expected];
            checker.are_free(&quarter, N::lit(clearance), &Control::new(), &mut free).expect("one");
            assert_eq!(free, [expected], "with a clearance of {clearance}");
        }
    }
}

#[test]
fn touching_is_no_more_free() {
    touches::<f32, 2>();
    touches::<f64, 2>();
    touches::<f32, 3>();
    touches::<f64, 3>();
}

#[test]
fn joints_move_as_they_say() {
    let z = axis::<f64, 3>(2);
    let frames = [
        // The parent has a greater index than its child.
        Frame { parent: Some(2), origin: along(1, 1.0), joint: Joint::prismatic(axis(0), 1) },
        Frame { parent: Some(0), origin: along(0, 1.0), joint: Joint::fixed() },
        Frame { parent: None, origin: along(0, 2.0), joint: Joint::<f64, 3>::revolute(z, 0) },
        Frame {
            parent: Some(2),
            origin: Pose::identity(),
            joint: Joint::<f64, 3>::revolute(z, 0).with_factor(-2.0).with_offset(PI),
        },
    ];
    let tree = FrameTree::try_new(&frames, 2).expect("a tree");
    let mut poses = vec![Pose::identity(); 8];
    tree.place(&[0.0, 0.0, FRAC_PI_2, 0.5], &Control::new(), &mut poses).expect("two rows");
    let at = |index: usize, expected: [f64; 3]| {
        let error = (poses[index].translation - Vector::<f64, 3>::from(expected)).norm();
        assert!(error < 1e-15, "{index}: {}", poses[index].translation);
    };
    at(0, [2.0, 1.0, 0.0]);
    at(1, [3.0, 1.0, 0.0]);
    at(4, [1.0, 0.5, 0.0]);
    at(5, [1.0, 1.5, 0.0]);
    // In the first row, frame 3 is rotated by half a turn. In the second row it is rotated by a
    // quarter (of its parent), minus two quarters, plus half a turn.
    assert!((poses[3].rotation[(0, 0)] + 1.0).abs() < 1e-15, "half a turn");
    assert!((poses[7].rotation[(1, 0)] - 1.0).abs() < 1e-15, "a quarter turn");
}

#[test]
fn where_there_is_nothing_all_is_free() {
    let tree = FrameTree::<f64, 3>::try_new(&[], 0).expect("nothing");
    let checker = Checker::try_new(tree, Vec::new(), &[]).expect("nothing");
    let (mut free, mut pairs, mut distance) = ([false; 9], [[0; 2]; 9], [0.0; 9]);
    checker.are_free(&[], 1.0, &Control::new(), &mut free).expect("no columns");
    assert_eq!(free, [true; 9], "no bodies");
    checker.first_pairs(&[], 1.0, &Control::new(), &mut pairs).expect("no columns");
    let out = NearestColumns { distance: &mut distance, ..Default::default() };
    checker.nearest(&[], 1.0, &Control::new(), out).expect("no columns");
    assert_eq!((pairs, distance), ([NO_PAIR; 9], [f64::INFINITY; 9]), "no pair");
    slider::<f64, 2>(1.0).are_free(&[], 0.0, &Control::new(), &mut []).expect("no rows");
}

#[test]
fn a_callback_cancels() {
    let (checker, rows) = (slider::<f32, 3>(0.5), vec![0.0; 1000]);
    let stop =
        |done: usize| if done < 128 { ControlFlow::Continue(()) } else { ControlFlow::Break(()) };
    let found = checker.are_free(&rows, 0.0, &Control::with_progress(&stop), &mut [true; 1000]);
    assert!(matches!(found, Err(BatchError::Cancelled { .. })), "{found:?}");
}

/// A half-space and a ball on one frame, beside a ball that an obstacle is nearest to: the half-space
/// has no bounding ball, and must not hide the nearest pair.
fn half_spaces_hide_no_nearest_pair<N: Space<3>>() {
    let at = |x: f64, y: f64| -> Pose<N, 3> {
        Pose::from_translation(Vector::<N, 3>::new(N::lit(x), N::lit(y), N::ZERO))
    };
    let ball = || ShapeHandle::new(Ball::<N>::new(N::HALF));
    let floor = ShapeHandle::new(Plane::new(Unit::new_unchecked(Vector::<N, 3>::y())));
    let slide = Joint::prismatic(Unit::new_unchecked(Vector::<N, 3>::y()), 0);
    let frames = [
        Frame { parent: None, origin: at(0.0, 0.0), joint: Joint::fixed() },
        Frame { parent: Some(0), origin: at(0.0, 3.0), joint: slide },
    ];
    let bodies = vec![
        Body { frame: 0, shape: floor, pose: at(0.0, 0.0) },
        Body { frame: 0, shape: ball(), pose: at(0.0, 1.0) },
        Body { frame: 1, shape: ball(), pose: at(0.0, 0.0) },
    ];
    let tree = FrameTree::try_new(&frames, 1).expect("a tree");
    let mut checker = Checker::try_new(tree, bodies, &[[1, 2]]).expect("three bodies");
    let obstacle = Obstacle { shape: ball(), pose: at(1.25, 3.0) };
    checker.try_set_obstacles(vec![obstacle], &[]).expect("one obstacle");
    let (mut distance, mut pair) = ([N::ZERO], [NO_PAIR]);
    let out = NearestColumns { distance: &mut distance, pair: &mut pair };
    checker.nearest(&[N::ZERO], N::INFINITY, &Control::new(), out).expect("one row");
    assert_eq!((distance, pair), ([N::lit(0.25)], [[2, 3]]), "the obstacle");
}

#[test]
fn unbounded_bodies_hide_no_nearest_pair() {
    half_spaces_hide_no_nearest_pair::<f32>();
    half_spaces_hide_no_nearest_pair::<f64>();
}
