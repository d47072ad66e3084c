//! Tests that the results of the scan are equal for all instruction sets.

use super::chain::{LANES, LaneRow};
use super::filter::{CollisionSearch, ScanScratch, SearchMode, scan_at};
use super::{Body, Checker, Frame, FrameTree, Joint, Obstacle};
use crate::collide::separation::hulls::tests::Random;
use crate::math::simd::Level;
use crate::math::{Pose, Space, Unit, Vector};
use crate::shape::{Ball, Capsule, Cuboid, Plane, Segment, ShapeHandle};

/// Returns a checker of an arm of six joints, every third of which slides, with a ball and a box on
/// each frame.
fn arm<N: Space<D>, const D: usize>(turn: fn(usize) -> Joint<N, D>) -> Checker<N, D> {
    let at = |axis: usize, by: f64| {
        let mut translation = Vector::<N, D>::zeros();
        translation[axis] = N::lit(by);
        Pose::from_translation(translation)
    };
    let axis = |axis| Unit::new_unchecked(at(axis, 1.0).translation);
    let frame = |number: usize| Frame {
        parent: number.checked_sub(1),
        origin: at(number % D, 0.5),
        joint: if number % 3 == 2 { Joint::prismatic(axis(0), number) } else { turn(number) },
    };
    let frames: Vec<_> = (0..6).map(frame).collect();
    let tree = FrameTree::try_new(&frames, 6).expect("a chain");
    let half = Vector::<N, D>::repeat(N::lit(0.1));
    let bodies = (0..12).map(|number| {
        let is_ball = number % 2 == 0;
        let ball = || ShapeHandle::new(Ball::new(N::lit(0.2)));
        let shape = if is_ball { ball() } else { ShapeHandle::new(Cuboid::new(half)) };
        Body { frame: number / 2, shape, pose: at(0, 0.25) }
    });
    let pairs: Vec<_> = (0..12).flat_map(|one| (one + 4..12).map(move |two| [one, two])).collect();
    let mut checker = Checker::try_new(tree, bodies.collect(), &pairs).expect("bodies");
    let ends = [at(0, 0.5), at(1, -0.5)].map(|end| end.translation.into());
    let shapes = [
        ShapeHandle::new(Ball::new(N::lit(0.3))),
        ShapeHandle::new(Capsule::<N, D>::new(N::ONE, N::lit(0.2))),
        ShapeHandle::new(Segment::<N, D>::new(ends[0], ends[1])),
        ShapeHandle::new(Cuboid::new(half * N::TWO)),
        ShapeHandle::new(Plane::<N, D>::new(axis(1))),
    ];
    let poses = [at(0, 1.0), at(1, 1.5), at(0, -1.0), at(1, 0.75), at(1, -1.0)];
    let obstacles = shapes.into_iter().zip(poses).map(|(shape, pose)| Obstacle { shape, pose });
    checker.try_set_obstacles(obstacles.collect(), &[[0, 4]]).expect("obstacles");
    checker
}

/// Returns the state of a search after a scan as text, and the number of configurations in which a
/// pair is certainly within the distance 0.05; 0 unless `mode` is [`SearchMode::Any`].
fn found<N: Space<D>, const D: usize>(
    (level, mode): (Level, SearchMode),
    checker: &Checker<N, D>,
    numbers: &[LaneRow<f32>],
) -> (String, u32) {
    let mut scratch = ScanScratch::new(&checker.robot);
    scratch.numbers.copy_from_slice(numbers);
    let mut search = CollisionSearch::new(mode);
    search.begin(u8::MAX, 0.05, (&[0.5; LANES], checker.robot.slide_margin()));
    scan_at(level, &checker.robot, &checker.surroundings, &mut scratch, &mut search);
    (format!("{search:?}"), search.hits.count_ones())
}

fn agree<N: Space<D>, const D: usize>(checker: &Checker<N, D>) {
    let random = &mut Random(5);
    let mut hits = 0;
    for round in 0..200 {
        let mut numbers = [(); 6].map(|()| [(); LANES].map(|()| random.vector::<f32>().x * 3.0));
        numbers[round % 6][round % LANES] = [f32::NAN, f32::INFINITY, 1e20, 0.0][round % 4];
        for mode in [SearchMode::Any, SearchMode::All, SearchMode::Nearest] {
            let mut all = Level::available().into_iter();
            let expected = found((all.next().expect("the best"), mode), checker, &numbers);
            for level in all {
                assert_eq!(found((level, mode), checker, &numbers), expected, "{level:?}, {round}");
            }
            hits += expected.1;
        }
    }
    // Each mode searches 200 packets of 8 configurations; only the mode `Any` counts touching ones.
    assert!((480..4320).contains(&hits), "{hits} of 4800 configurations touch");
}

#[test]
fn every_instruction_set_finds_the_same() {
    agree(&arm::<f32, 2>(Joint::<f32, 2>::revolute));
    agree(&arm::<f32, 3>(|column| Joint::<f32, 3>::revolute(Vector::<f32, 3>::z_axis(), column)));
}
