//! Ten thousand grasps of a mug by a gripper with two fingers, checked in a few calls. For which
//! grasps are both fingers clear of the mug and of the table, and in which of these is the first
//! finger nearest to the mug? The output is the number of clear grasps, and the nearest one with
//! its clearance.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use impinge::dim3::batch::{
    BatchError, ClosestColumns, Control, OnePose, PairBatch, Shapes, Side, WitnessColumns,
};
use impinge::dim3::prelude::*;

/// The grasps differ by rotation about the axis of the mug and by height: the number of rotations,
/// and the number of heights.
const TURNS: u32 = 500;
const HEIGHTS: u32 = 20;

/// The radius of the mug, half its height, and the distance of a finger from the axis of the mug.
const RADIUS: f64 = 0.04;
const HALF_HEIGHT: f64 = 0.05;
const OPENING: f64 = 0.06;

/// Returns a mug with a handle on one side, which the fingers must not touch.
fn mug() -> Compound<f64> {
    let body = ShapeHandle::new(Cylinder::new(HALF_HEIGHT, RADIUS));
    let handle = ShapeHandle::new(Cuboid::new(Vector::new(0.02, 0.03, 0.005)));
    let at = Isometry::translation(RADIUS + 0.02, 0.0, 0.0);
    Compound::new(vec![(Isometry::identity(), body), (at, handle)])
}

/// Returns the poses of a finger, one for each grasp. `half_turn` is 0 for the first finger and
/// 0.5, half a turn, for the opposite one.
fn fingers(half_turn: f64) -> Vec<Isometry<f64>> {
    let pose = |index: u32| {
        let turn = f64::from(index % TURNS) / f64::from(TURNS) + half_turn;
        let height = 0.1 * f64::from(index / TURNS) / f64::from(HEIGHTS - 1) - HALF_HEIGHT;
        let rotation = Rotation::new(Vector::y() * (turn * core::f64::consts::TAU));
        Isometry::from_parts((rotation * Vector::new(OPENING, height, 0.0)).into(), rotation)
    };
    (0..TURNS * HEIGHTS).map(pose).collect()
}

fn main() -> Result<(), BatchError> {
    let (mug, finger) = (mug(), Capsule::new(0.015, 0.01));
    let (table, floor) =
        (HalfSpace::new(Vector::y_axis()), OnePose(Isometry::translation(0.0, -HALF_HEIGHT, 0.0)));
    let here = OnePose(Isometry::identity());
    let mug = Side::try_new(Shapes::One(&mug), &here)?;
    let table = Side::try_new(Shapes::One(&table), &floor)?;

    // The distances of both fingers from the mug and from the table, in four calls.
    let poses = [0.0, 0.5].map(fingers);
    let mut clearance = vec![f64::INFINITY; poses[0].len()];
    let mut distance = vec![0.0; clearance.len()];
    for (poses, obstacle) in poses.iter().flat_map(|poses| [(poses, mug), (poses, table)]) {
        let pairs = PairBatch::try_new(obstacle, Side::try_new(Shapes::One(&finger), poses)?)?;
        pairs.distances(&Control::new(), &mut distance)?;
        for (clearance, distance) in clearance.iter_mut().zip(&distance) {
            *clearance = clearance.min(*distance);
        }
    }
    let clear = clearance.iter().filter(|&&clearance| clearance > 0.0).count();
    println!("{clear} of {} grasps are clear", clearance.len());
    assert!(clear > 5000 && clear < 9900, "fingers meet the handle, or the table");

    // Single calls return the same distances, checked for some of the grasps.
    for index in (0..clearance.len()).step_by(997) {
        let shape = Capsule::new(0.015, 0.01);
        let apart = poses.each_ref().map(|poses| {
            let (mug, table) = (self::mug(), HalfSpace::new(Vector::y_axis()));
            let above = self::distance(&here.0, &mug, &poses[index], &shape);
            above.min(self::distance(&floor.0, &table, &poses[index], &shape))
        });
        assert_eq!(apart[0].min(apart[1]), clearance[index], "to the bit");
    }

    report_nearest(&mug, &poses[0], &clearance)
}

/// Prints the clear grasp in which the first finger is nearest to the mug.
fn report_nearest(
    mug: &Side<'_, f64>,
    poses: &[Isometry<f64>],
    clearance: &[f64],
) -> Result<(), BatchError> {
    let free: Vec<_> = poses
        .iter()
        .zip(clearance)
        .filter(|(_, apart)| **apart > 0.0)
        .map(|(pose, _)| *pose)
        .collect();
    let finger = Capsule::new(0.015, 0.01);
    let pairs = PairBatch::try_new(*mug, Side::try_new(Shapes::One(&finger), &free)?)?;
    let (index, apart) = pairs.nearest(1.0, &Control::new())?.expect("some are clear");
    let (mut part1, mut point1) = (vec![0; free.len()], vec![[0.0; 3]; free.len()]);
    let parts = WitnessColumns { part1: &mut part1, ..Default::default() };
    pairs.witnesses(apart, &Control::new(), parts)?;
    let points = ClosestColumns { point1: &mut point1, ..Default::default() };
    pairs.closest_points(apart, &Control::new(), points)?;
    let what = if part1[index] == 0 { "body" } else { "handle" };
    println!("the nearest is {apart:.6} from the {what}, at {:.4?}", point1[index]);
    assert!(apart > 0.0 && apart < 0.01, "less than the gap to the body");
    let others = part1.iter().filter(|&&part| part != u32::MAX).count();
    assert!(others >= 1, "no other is nearer: the limit leaves the nearest alone, and its equals");
    Ok(())
}
