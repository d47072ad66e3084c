//! A robot arm with four links is checked in several configurations: does it hit itself or the
//! pillar beside it, and if not, what is the smallest distance? Links that share a joint always
//! touch there, so these pairs are not checked. The output is one line for each configuration.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4, PI};
use std::iter::once;

use impinge::dim3::batch::Control;
use impinge::dim3::checker::{Body, Checker, Frame, FrameTree, Joint, NearestColumns, Obstacle};
use impinge::dim3::math::Pose;
use impinge::dim3::prelude::*;

const LINKS: usize = 4;
/// The radius of a link. A link is a capsule whose axis has length 1, from joint to joint.
const RADIUS: f64 = 0.125;
/// The index of the pillar; obstacles come after the bodies.
const PILLAR: u32 = 4;

fn at(x: f64, y: f64) -> Pose<f64, 3> {
    Pose::from_translation(Vector::new(x, y, 0.0))
}

/// Builds the arm, and a pillar of 0.5 × 4 × 0.5 whose axis is at a distance of 1 from the axis of
/// the base.
///
/// The base rotates the arm about the vertical axis. Each joint bends the rest of the arm about the
/// z axis of the base, to the left for positive angles.
fn build() -> Checker<f64> {
    let base =
        Frame { parent: None, origin: at(0.0, 0.0), joint: Joint::revolute(Vector::y_axis(), 0) };
    let bend = |link: usize| Frame {
        parent: Some(link),
        origin: at(0.0, if link == 0 { 0.0 } else { 1.0 }),
        joint: Joint::revolute(Vector::z_axis(), link + 1),
    };
    let frames: Vec<_> = once(base).chain((0..LINKS).map(bend)).collect();
    let tree = FrameTree::try_new(&frames, 1 + LINKS).expect("a chain");
    let shape = ShapeHandle::new(Capsule::new(0.5, RADIUS));
    let link = |frame| Body { frame, shape: shape.clone(), pose: at(0.0, 0.5) };
    let bodies = (1..=LINKS).map(link).collect();
    let mut checker =
        Checker::try_new(tree, bodies, &[[0, 2], [0, 3], [1, 3]]).expect("four links");
    let pillar = ShapeHandle::new(Cuboid::new(Vector::new(0.25, 2.0, 0.25)));
    let pillar = Obstacle { shape: pillar, pose: at(1.0, 2.0) };
    checker.try_set_obstacles(vec![pillar], &[]).expect("a pillar");
    checker
}

fn main() {
    let right = -FRAC_PI_2;
    // The angle of the base, then the angles of the joints.
    let poses = [
        ("straight up", [0.0; 1 + LINKS]),
        ("over to the right", [0.0, 0.0, right, 0.0, 0.0]),
        ("over to the left", [0.0, 0.0, -right, 0.0, 0.0]),
        ("the same, turned half around", [PI, 0.0, -right, 0.0, 0.0]),
        ("curled up to the left", [0.0, 0.0, -right, -right, -right]),
        ("to the right, past the corner", [FRAC_PI_4, right, 0.0, 0.0, 0.0]),
    ];
    let configurations: Vec<f64> = poses.iter().flat_map(|(_, numbers)| *numbers).collect();
    let (mut distance, mut pair) = ([0.0; 6], [[0; 2]; 6]);
    let out = NearestColumns { distance: &mut distance, pair: &mut pair };
    build().nearest(&configurations, f64::INFINITY, &Control::new(), out).expect("six rows");
    for ((name, _), (distance, [one, other])) in poses.iter().zip(distance.iter().zip(pair)) {
        let other = if other == PILLAR { "the pillar".to_owned() } else { format!("link {other}") };
        let verdict = if *distance > 0.0 { "free" } else { "hit" };
        println!("{name:30} {verdict}: {distance:.3} from link {one} to {other}");
    }

    let is_near = |index: usize, by_hand: f64| (distance[index] - by_hand).abs() < 1e-12;
    // The near face of the pillar is 0.75 from the axis of the upright links.
    assert!(is_near(0, 0.75 - RADIUS), "straight up it is beside the pillar");
    assert_eq!((distance[1], pair[1]), (0.0, [1, PILLAR]), "the second link is in it");
    assert!(is_near(2, 0.75 - RADIUS), "to the left it goes away from it");
    assert_eq!((distance[3], pair[3]), (0.0, [1, PILLAR]), "half a turn makes left right");
    assert_eq!((distance[4], pair[4]), (0.0, [0, 3]), "the last meets the first");
    // At 45° the nearest edge of the pillar is at (0.75, ±0.25): its distance from the axis of the
    // arm is (0.75 − 0.25) / √2.
    assert!(is_near(5, 0.5 / 2.0_f64.sqrt() - RADIUS), "by the edge of the pillar");
}
