//! Random robots, with bodies and obstacles of every kind.

use std::f64::consts::FRAC_PI_2;

use impinge::checker::{Body, Checker, Frame, FrameTree, Joint, Obstacle};
use impinge::math::{Pose, Real, Space, Unit, Vector};
use impinge::shape::{Ball, ShapeHandle};

use crate::support::query_support::random::Random;
use crate::support::shape_table;

/// A checker of a random robot, its ignored pairs of a body and an obstacle, and configurations row
/// by row.
pub(super) struct Robot<N: Real, const D: usize> {
    pub(super) checker: Checker<N, D>,
    pub(super) ignored: Vec<[u32; 2]>,
    pub(super) configurations: Vec<N>,
}

/// Number of joint values of a random robot.
const COLUMNS: usize = 5;

/// Makes a random revolute joint that is driven by a given column.
type Turn<N, const D: usize> = fn(&mut Random, usize) -> Joint<N, D>;

/// The functions that differ by dimension: they draw revolute joints and poses.
type Draws<N, const D: usize> = (Turn<N, D>, fn(&mut Random) -> Pose<N, D>);

impl<N: Space<D>, const D: usize> Robot<N, D> {
    /// Returns the number of configurations.
    pub(super) fn count(&self) -> usize {
        self.configurations.len() / self.checker.frames().columns()
    }
}

fn robot<N: Space<D>, const D: usize>(
    table: &shape_table::Shapes<N, D>,
    (turn, pose): Draws<N, D>,
    (seed, away): (u64, f64),
) -> Robot<N, D> {
    let random = &mut Random(seed, false);
    let mut base = Pose::identity();
    base.translation = Vector::<N, D>::repeat(N::lit(away));
    let mut frames = vec![Frame { parent: None, origin: base, joint: Joint::fixed() }];
    for number in 1..9 {
        let parent = Some(if number % 4 == 0 { number / 2 } else { number - 1 });
        let mut origin = pose(random);
        origin.translation *= N::lit(0.75);
        frames.push(Frame { parent, origin, joint: joint(random, number, turn) });
    }
    let mut bodies = Vec::new();
    for (number, (_, shape)) in table.iter().enumerate().filter(|(_, row)| row.0 != "plane") {
        bodies.push(Body { frame: number % 9, shape: shape.clone(), pose: pose(random) });
    }
    for (number, radius) in
        [0.25, 0.125, 0.0, 0.3, 0.2, 0.1, 0.15, 0.2, 0.3].into_iter().enumerate()
    {
        let shape = ShapeHandle::new(Ball::new(N::lit(radius)));
        bodies.push(Body { frame: number, shape, pose: pose(random) });
    }
    let count = u32::try_from(bodies.len()).expect("a few");
    let all = (0..count).flat_map(|one| (0..one).map(move |other| [one, other]));
    let pairs: Vec<[u32; 2]> = all.filter(|_| random.bits() & 63 == 0).collect();
    let tree = FrameTree::try_new(&frames, COLUMNS).expect("a tree");
    let mut checker = Checker::try_new(tree, bodies, &pairs).expect("bodies");
    let obstacles: Vec<_> =
        table.iter().map(|row| obstacle(random, row, &base.translation, pose)).collect();
    let ignored = vec![[3, 1], [0, 0], [count - 1, 2]];
    checker.try_set_obstacles(obstacles, &ignored).expect("obstacles");
    Robot { checker, ignored, configurations: configurations(random) }
}

/// Returns joint `number`. Joint 3 slides, joint 5 is fixed, and the others are revolute. Joint 6
/// is driven by column 1, which other joints use too, with a factor and an offset.
fn joint<N: Space<D>, const D: usize>(
    random: &mut Random,
    number: usize,
    turn: Turn<N, D>,
) -> Joint<N, D> {
    match number {
        3 => Joint::prismatic(Unit::new_normalize(random.vector()), 2),
        5 => Joint::fixed(),
        6 => turn(random, 1).with_factor(N::lit(-0.5)).with_offset(N::lit(0.25)),
        _ => turn(random, [0, 1, 3, 4][number % 4]),
    }
}

fn obstacle<N: Space<D>, const D: usize>(
    random: &mut Random,
    (name, shape): &(&'static str, ShapeHandle<N, D>),
    base: &Vector<N, D>,
    pose: fn(&mut Random) -> Pose<N, D>,
) -> Obstacle<N, D> {
    let mut place = pose(random);
    place.translation = base + place.translation.normalize() * N::lit(random.within(3.0, 7.0));
    if *name == "plane" {
        place = Pose::from_translation(*base);
        place.translation[1] -= N::lit(6.0);
    }
    Obstacle { shape: shape.clone(), pose: place }
}

/// Returns configurations: random, aligned to quarter turns, extreme, or not finite. They are mixed
/// so that a batch of eight has several kinds.
fn configurations<N: Real>(random: &mut Random) -> Vec<N> {
    let mut all: Vec<N> = vec![N::ZERO; COLUMNS];
    for index in 0..90 * COLUMNS {
        let quarters = FRAC_PI_2 * (random.signed() * 4.0).round();
        all.push(N::lit(if (index / COLUMNS).is_multiple_of(5) {
            quarters
        } else {
            random.signed() * 3.0
        }));
    }
    for value in [f64::NAN, f64::INFINITY, 1e4, 1e6, 1e9, -1e12, 1e20, 1e30, 1e-30] {
        for column in 0..COLUMNS {
            all.extend((0..COLUMNS).map(|at| N::lit(if at == column { value } else { 0.5 })));
        }
    }
    all
}

pub(super) fn robot2<N: Real>(seed: u64, away: f64) -> Robot<N, 2> {
    let turn: Turn<N, 2> = |_, column| Joint::<N, 2>::revolute(column);
    robot(&shape_table::plane(N::lit(0.25)), (turn, pose2), (seed, away))
}

pub(super) fn robot3<N: Real>(seed: u64, away: f64) -> Robot<N, 3> {
    let turn: Turn<N, 3> =
        |random, column| Joint::<N, 3>::revolute(Unit::new_normalize(random.vector()), column);
    robot(&shape_table::space(N::lit(0.25)), (turn, pose3), (seed, away))
}

fn pose2<N: Real>(random: &mut Random) -> Pose<N, 2> {
    let rotation = random.turn2::<N>().to_rotation_matrix().into_inner();
    Pose { rotation, translation: random.vector() }
}

fn pose3<N: Real>(random: &mut Random) -> Pose<N, 3> {
    let rotation = random.turn3::<N>().to_rotation_matrix().into_inner();
    Pose { rotation, translation: random.vector() }
}
