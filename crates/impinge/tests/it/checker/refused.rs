//! Tests which trees, bodies, pairs, configurations and columns the checker refuses, and with which
//! error.

use impinge::batch::{BatchError, Control};
use impinge::checker::{Body, Checker, CheckerError, Frame, FrameTree, Joint, Obstacle};
use impinge::math::{Pose, Unit, Vector};
use impinge::shape::{Ball, ShapeHandle};

fn frame(parent: Option<usize>) -> Frame<f64, 3> {
    let joint = Joint::<f64, 3>::revolute(Vector::<f64, 3>::x_axis(), 0);
    Frame { parent, origin: Pose::identity(), joint }
}

fn nowhere() -> Pose<f64, 3> {
    Pose::from_translation(Vector::<f64, 3>::new(0.0, f64::NAN, 0.0))
}

fn body(frame: usize, pose: Pose<f64, 3>) -> Body<f64, 3> {
    Body { frame, shape: ShapeHandle::new(Ball::new(1.0)), pose }
}

#[test]
fn trees() {
    let refused = |frames: &[Frame<f64, 3>], columns| FrameTree::try_new(frames, columns).err();
    let parent = CheckerError::Parent { frame: 1, parent: 2, frames: 2 };
    assert_eq!(refused(&[frame(None), frame(Some(2))], 1), Some(parent), "no frame 2");
    let looped = [frame(None), frame(Some(2)), frame(Some(1))];
    assert_eq!(refused(&looped, 1), Some(CheckerError::Loop { frame: 1 }), "two on each other");
    assert_eq!(refused(&[frame(Some(0))], 1), Some(CheckerError::Loop { frame: 0 }), "on itself");
    let column = CheckerError::Column { frame: 0, column: 0, columns: 0 };
    assert_eq!(refused(&[frame(None)], 0), Some(column), "no columns");
    let broken = Frame { origin: nowhere(), ..frame(None) };
    let error = CheckerError::NotFinite { argument: "frames", index: 0 };
    assert_eq!(refused(&[broken], 1), Some(error), "the origin");
    let axis = Unit::new_unchecked(Vector::<f64, 3>::repeat(f64::INFINITY));
    let broken = Frame { joint: Joint::prismatic(axis, 0), ..frame(None) };
    assert_eq!(refused(&[broken], 1), Some(error), "the axis");
    for joint in [
        Joint::prismatic(Unit::new_unchecked(Vector::<f64, 3>::repeat(1.0)), 0),
        Joint::<f64, 3>::revolute(Unit::new_unchecked(Vector::<f64, 3>::x() * 1.001), 0),
        Joint::turning(Vector::<f64, 3>::x().cross_matrix().abs(), 0),
    ] {
        let axis = Some(CheckerError::Axis { frame: 1 });
        assert_eq!(
            refused(&[frame(None), Frame { joint, ..frame(Some(0)) }], 1),
            axis,
            "{joint:?}"
        );
    }
    let broken = Frame { joint: frame(None).joint.with_factor(f64::NAN), ..frame(None) };
    assert_eq!(refused(&[broken], 1), Some(error), "the factor");
}

#[test]
fn bodies_pairs_and_obstacles() {
    let tree = || FrameTree::try_new(&[frame(None)], 1).expect("one frame");
    let refused = |bodies, pairs: &[[u32; 2]]| Checker::try_new(tree(), bodies, pairs).err();
    let two = || vec![body(0, Pose::identity()), body(0, Pose::identity())];
    let on = CheckerError::BodyFrame { body: 1, frame: 1, frames: 1 };
    assert_eq!(
        refused(vec![body(0, Pose::identity()), body(1, nowhere())], &[]),
        Some(on),
        "frame"
    );
    let finite = CheckerError::NotFinite { argument: "bodies", index: 0 };
    assert_eq!(refused(vec![body(0, nowhere())], &[]), Some(finite), "pose");
    for pair in [[0, 2], [1, 1]] {
        let error = CheckerError::Pair { argument: "pairs", index: 1, pair };
        assert_eq!(refused(two(), &[[1, 0], pair]), Some(error), "{pair:?}");
    }
    let mut checker = Checker::try_new(tree(), two(), &[[1, 0]]).expect("a pair");
    let obstacle = |pose| Obstacle { shape: ShapeHandle::new(Ball::new(1.0)), pose };
    let far = || vec![obstacle(Pose::from_translation(Vector::<f64, 3>::new(9.0, 0.0, 0.0)))];
    checker.try_set_obstacles(far(), &[[1, 0]]).expect("an obstacle");
    let error = CheckerError::NotFinite { argument: "obstacles", index: 0 };
    assert_eq!(checker.try_set_obstacles(vec![obstacle(nowhere())], &[]), Err(error), "pose");
    for pair in [[2, 0], [0, 1]] {
        let error = CheckerError::Pair { argument: "ignored", index: 0, pair };
        assert_eq!(checker.try_set_obstacles(far(), &[pair]), Err(error), "{pair:?}");
    }
    assert_eq!(checker.obstacles().len(), 1, "nothing was replaced");
}

#[test]
fn configurations_and_columns() {
    let tree = FrameTree::try_new(&[frame(None)], 2).expect("one frame");
    let checker = Checker::try_new(tree, vec![body(0, Pose::identity())], &[]).expect("a body");
    let partial = BatchError::PartialRow { argument: "configurations", given: 3, width: 2 };
    let control = Control::new();
    assert_eq!(checker.are_free(&[0.0; 3], 0.0, &control, &mut [true; 2]), Err(partial), "a half");
    let length = |argument, given, needed| Err(BatchError::Length { argument, given, needed });
    let mut free = [true; 3];
    assert_eq!(checker.are_free(&[0.0; 4], 0.0, &control, &mut free), length("out", 3, 2), "slots");
    let mut pairs = [[7; 2]; 1];
    let found = checker.first_pairs(&[0.0; 4], 0.0, &control, &mut pairs);
    assert_eq!((found, pairs), (length("out", 1, 2), [[7; 2]]), "slots");
    let mut poses = vec![nowhere(); 3];
    let found = checker.frames().place(&[0.0; 4], &control, &mut poses);
    assert_eq!(found, length("poses", 3, 2), "a pose for each frame and row");
}
