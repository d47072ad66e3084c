//! The expected results of the checker, computed by single queries of all pairs.

use impinge::batch::{Control, PairBatch, Shapes, Side};
use impinge::checker::NO_PAIR;
use impinge::math::{Pose, Real, Space};
use impinge::shape::ShapeHandle;

use super::robots::Robot;

/// All pairs of one configuration with their distances, in ascending order of the pairs.
pub(super) struct Brute<N> {
    /// Whether the poses of all frames are finite; otherwise the configuration has no result.
    pub(super) is_finite: bool,
    pairs: Vec<[u32; 2]>,
    distances: Vec<N>,
}

impl<N: Real> Brute<N> {
    pub(super) fn new<const D: usize>(robot: &Robot<N, D>, index: usize) -> Self
    where
        N: Space<D>,
    {
        let (checker, control) = (&robot.checker, Control::new());
        let columns = checker.frames().columns();
        let configuration = &robot.configurations[index * columns..][..columns];
        let mut frames = vec![Pose::identity(); checker.frames().len()];
        checker.frames().place(configuration, &control, &mut frames).expect("one row");
        let mut poses = vec![Pose::identity(); checker.bodies().len()];
        checker.place_bodies(configuration, &control, &mut poses).expect("one row");
        poses.extend(checker.obstacles().iter().map(|obstacle| obstacle.pose));
        let shapes: Vec<ShapeHandle<N, D>> = checker
            .bodies()
            .iter()
            .map(|body| body.shape.clone())
            .chain(checker.obstacles().iter().map(|obstacle| obstacle.shape.clone()))
            .collect();
        let pairs = pairs_of(robot);
        let side = |which: usize| {
            let numbers = pairs.iter().map(|pair| pair[which]);
            let places = numbers.clone().map(|number| poses[number as usize]);
            (numbers.collect::<Vec<_>>(), places.collect::<Vec<_>>())
        };
        let [(picks1, poses1), (picks2, poses2)] = [side(0), side(1)];
        let [picked1, picked2] =
            [&picks1, &picks2].map(|picks| Shapes::Picked { shapes: &shapes, picks });
        let side1 = Side::try_new(picked1, &poses1).expect("as many");
        let side2 = Side::try_new(picked2, &poses2).expect("as many");
        let mut distances = vec![N::ZERO; pairs.len()];
        let batch = PairBatch::try_new(side1, side2).expect("as many");
        batch.distances(&control, &mut distances).expect("a slot for each");
        Self { is_finite: frames.iter().all(Pose::is_finite), pairs, distances }
    }

    /// Returns the first pair whose distance is at most the clearance; [`NO_PAIR`] if there is none
    /// or a pose is not finite.
    pub(super) fn first(&self, clearance: N) -> [u32; 2] {
        let found = self.distances.iter().position(|&distance| distance <= clearance);
        found.filter(|_| self.is_finite).map_or(NO_PAIR, |index| self.pairs[index])
    }

    /// Returns the least distance that is at most `limit`, and the first pair at that distance.
    /// Returns infinity and [`NO_PAIR`] if there is none, NaN and [`NO_PAIR`] if a pose is not
    /// finite. A limit below zero counts as zero.
    pub(super) fn nearest(&self, limit: N) -> (N, [u32; 2]) {
        if !self.is_finite {
            return (N::lit(f64::NAN), NO_PAIR);
        }
        let limit = if limit > N::ZERO { limit } else { N::ZERO };
        let mut best = (N::INFINITY, NO_PAIR);
        for (&distance, &pair) in self.distances.iter().zip(&self.pairs) {
            if distance < best.0 && distance <= limit {
                best = (distance, pair);
            }
        }
        best
    }
}

/// Returns all pairs that the checker tests, ascending.
fn pairs_of<N: Space<D>, const D: usize>(robot: &Robot<N, D>) -> Vec<[u32; 2]> {
    let count = |number: usize| u32::try_from(number).expect("a few");
    let (bodies, obstacles) =
        (count(robot.checker.bodies().len()), count(robot.checker.obstacles().len()));
    let beside = (0..bodies).flat_map(|body| (0..obstacles).map(move |obstacle| [body, obstacle]));
    let beside = beside.filter(|pair| !robot.ignored.contains(pair));
    let mut pairs: Vec<_> = beside.map(|[body, obstacle]| [body, bodies + obstacle]).collect();
    pairs.extend(robot.checker.pairs());
    pairs.sort_unstable();
    pairs
}
