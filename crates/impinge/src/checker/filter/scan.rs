//! The scan, which tests all pairs in 8 configurations.
//!
//! ```text
//! group     [ c0 c1 c2 c3 c4 c5 c6 c7 ]   lane = configuration; result: where the group is near
//! its balls [ b0 b1 b2 b3 b4 b5 b6 b7 ]   lane = ball, once for each of these configurations
//! ```

use super::MAX_LENGTH;
use super::obstacles::{CloseObstacle, LaneObstacle, Surroundings};
use super::robot::{BallGroup, GroupPair, RobotFilter};
use super::search::{CollisionSearch, Distances, Other};
use crate::checker::chain::{LANES, LaneRow, PoseRows, forward, store};
use crate::math::lanes::{dot, load, minus, with_lanes};
use crate::math::simd::{Eight, Level, Simd};
use crate::math::{Wide, filled};

/// The positions of all groups in 8 configurations; reused between scans.
#[derive(Debug)]
pub(in crate::checker) struct ScanScratch<const D: usize> {
    /// For each node, the joint value in each configuration.
    pub(in crate::checker) numbers: Vec<LaneRow<f32>>,
    rows: Vec<PoseRows<f32, D>>,
    /// For each group, the centre of its bounding ball; the lane is the configuration.
    centers: Vec<[LaneRow<f32>; D]>,
    /// For each group and configuration, the centres of the group's balls, computed on first use;
    /// the lane is the ball.
    balls: Vec<[[LaneRow<f32>; D]; LANES]>,
    /// For each group, a bit mask of the configurations in which its balls are computed.
    placed: Vec<u8>,
}

impl<const D: usize> ScanScratch<D> {
    pub(in crate::checker) fn new(robot: &RobotFilter<D>) -> Self {
        let nothing = [[0.0; LANES]; D];
        Self {
            numbers: vec![[0.0; LANES]; robot.nodes.len()],
            rows: vec![PoseRows::identity(); robot.nodes.len() + 1],
            centers: vec![nothing; robot.groups.len()],
            balls: vec![[nothing; LANES]; robot.groups.len()],
            placed: vec![0; robot.groups.len()],
        }
    }
}

/// The input of a scan: the robot, and the obstacles around it.
#[derive(Clone, Copy)]
struct Scan<'a, const D: usize> {
    robot: &'a RobotFilter<D>,
    around: &'a Surroundings<D>,
}

/// Finds the candidate pairs of 8 configurations, whose joint values are in `scratch.numbers`.
pub(in crate::checker) fn scan_at<const D: usize>(
    level: Level,
    robot: &RobotFilter<D>,
    around: &Surroundings<D>,
    scratch: &mut ScanScratch<D>,
    search: &mut CollisionSearch,
) {
    let scan = Scan { robot, around };
    with_lanes!(level, simd => run(simd, scan, scratch, search));
    search.tidy();
}

/// Runs [`Scan::run`] with the vectors of eight `f32` of an instruction set.
#[inline(always)]
fn run<S: Simd, const D: usize>(
    simd: S,
    scan: Scan<'_, D>,
    scratch: &mut ScanScratch<D>,
    search: &mut CollisionSearch,
) {
    scan.run::<S, <f32 as Eight>::Lanes<S>>(simd, scratch, search);
}

impl<const D: usize> Scan<'_, D> {
    /// Places all groups by forward kinematics, then tests them against obstacles and each other.
    #[inline(always)]
    fn run<S: Simd, V: Wide<S, Scalar = f32>>(
        self,
        simd: S,
        scratch: &mut ScanScratch<D>,
        search: &mut CollisionSearch,
    ) {
        forward::<S, f32, V, D>(simd, &self.robot.nodes, &scratch.numbers, &mut scratch.rows);
        let mut usable = u8::MAX;
        for block in &scratch.rows {
            usable &= block.lanes_within::<S, V>(simd, MAX_LENGTH);
        }
        search.leave_out(usable);
        scratch.placed.fill(0);
        for (index, group) in self.robot.groups.iter().enumerate() {
            let center: [V; D] = spread(simd, &group.center);
            let center = scratch.rows[group.node].point(simd, &center);
            store(&center, &mut scratch.centers[index]);
        }
        self.meet_obstacles::<S, V>(simd, scratch, search);
        self.meet_itself::<S, V>(simd, scratch, search);
    }

    /// Returns the centres of the balls of a group in a configuration; computes them on first use.
    #[inline(always)]
    fn balls<S: Simd, V: Wide<S, Scalar = f32>>(
        self,
        simd: S,
        (index, lane): (usize, usize),
        scratch: &mut ScanScratch<D>,
    ) -> [V; D] {
        let cached = &mut scratch.balls[index][lane];
        if scratch.placed[index] >> lane & 1 == 1 {
            return load(simd, cached);
        }
        scratch.placed[index] |= 1 << lane;
        let group = &self.robot.groups[index];
        let local: [V; D] = load(simd, &group.centers);
        let centers = scratch.rows[group.node].points_in(simd, lane, &local);
        store(&centers, cached);
        centers
    }

    /// Tests each group against its obstacles in ascending order of `gap`, until the gap exceeds
    /// the greatest limit of a lane plus the greatest slide.
    #[inline(always)]
    fn meet_obstacles<S: Simd, V: Wide<S, Scalar = f32>>(
        self,
        simd: S,
        scratch: &mut ScanScratch<D>,
        search: &mut CollisionSearch,
    ) {
        // The last groups come first, since groups at the ends of chains move farthest and touch
        // obstacles most often.
        for (index, group) in self.robot.groups.iter().enumerate().rev() {
            let center: [V; D] = load(simd, &scratch.centers[index]);
            for within in &self.around.within[index] {
                if search.is_done() || within.gap > search.farthest + search.slide {
                    break;
                }
                let outline = &self.around.obstacles[within.obstacle].outline;
                let squared = outline.core.squared(simd, &center);
                let mut lanes = search.candidate_lanes(simd, squared, within.radius);
                while lanes != 0 {
                    let lane = lanes.trailing_zeros() as usize;
                    lanes &= lanes - 1;
                    let balls: [V; D] = self.balls(simd, (index, lane), scratch);
                    self.meet_obstacle::<S, V>(simd, lane, (group, &balls, within), search);
                }
            }
        }
    }

    /// Tests the balls of a group against an obstacle in the configuration of lane `lane`.
    #[inline(always)]
    fn meet_obstacle<S: Simd, V: Wide<S, Scalar = f32>>(
        self,
        simd: S,
        lane: usize,
        (group, balls, within): (&BallGroup<D>, &[V; D], &CloseObstacle),
        search: &mut CollisionSearch,
    ) {
        let LaneObstacle { outline, margin } = &self.around.obstacles[within.obstacle];
        let distances = Distances {
            squared: outline.core.squared(simd, balls),
            radius: V::load(simd, &group.radii) + V::all(simd, outline.radius),
            margin: group.margin + margin,
            wanted: within.wanted,
            exact: if outline.is_exact { group.exact } else { 0 },
        };
        search.record(
            simd,
            lane,
            &distances,
            #[inline(always)]
            |ball| (group.bodies[ball], Other::Obstacle(within.number)),
        );
    }

    /// Tests the pairs of groups against each other: first their bounding balls in all
    /// configurations, then their balls in the configurations in which the bounding balls are near
    /// each other.
    #[inline(always)]
    fn meet_itself<S: Simd, V: Wide<S, Scalar = f32>>(
        self,
        simd: S,
        scratch: &mut ScanScratch<D>,
        search: &mut CollisionSearch,
    ) {
        for crossing in &self.robot.crossings {
            if search.is_done() {
                return;
            }
            if crossing.gap > search.farthest + crossing.sliding * search.slide {
                continue;
            }
            let [first, second] = crossing.groups;
            let center: [V; D] = load(simd, &scratch.centers[first]);
            let squared = squared_between(&center, &load(simd, &scratch.centers[second]));
            let mut lanes = search.candidate_lanes(simd, squared, crossing.radius);
            while lanes != 0 {
                let lane = lanes.trailing_zeros() as usize;
                lanes &= lanes - 1;
                self.cross::<S, V>(simd, (crossing, lane), scratch, search);
            }
        }
    }

    /// Tests the balls of two groups against each other in the configuration of lane `lane`.
    #[inline(always)]
    fn cross<S: Simd, V: Wide<S, Scalar = f32>>(
        self,
        simd: S,
        (crossing, lane): (&GroupPair, usize),
        scratch: &mut ScanScratch<D>,
        search: &mut CollisionSearch,
    ) {
        let [first, second] = crossing.groups;
        let (one, other) = (&self.robot.groups[first], &self.robot.groups[second]);
        let balls: [V; D] = self.balls(simd, (first, lane), scratch);
        let there: [V; D] = spread_lane(simd, &scratch.centers[second], lane);
        let margin = one.margin + other.margin;
        let radii = (V::load(simd, &one.radii), other.radius + margin);
        let mut balls_left =
            search.candidate_balls(simd, lane, squared_between(&there, &balls), radii)
                & one.present();
        if balls_left == 0 {
            return;
        }
        let balls: [V; D] = self.balls(simd, (second, lane), scratch);
        let radii = V::load(simd, &other.radii);
        while balls_left != 0 && search.is_live(lane) {
            let ball = balls_left.trailing_zeros() as usize;
            balls_left &= balls_left - 1;
            let centers = &scratch.balls[first][lane];
            let center: [V; D] = spread_lane(simd, centers, ball);
            let distances = Distances {
                squared: squared_between(&center, &balls),
                radius: radii + V::all(simd, one.radii[ball]),
                margin,
                wanted: crossing.wanted[ball],
                exact: if one.exact >> ball & 1 == 1 { other.exact } else { 0 },
            };
            let body = one.bodies[ball];
            search.record(
                simd,
                lane,
                &distances,
                #[inline(always)]
                |partner| {
                    let partner = other.bodies[partner];
                    (body.min(partner), Other::Body(body.max(partner)))
                },
            );
        }
    }
}

#[inline(always)]
fn squared_between<S: Simd, V: Wide<S>, const D: usize>(one: &[V; D], other: &[V; D]) -> V {
    let offset = minus(other, one);
    dot(&offset, &offset)
}

#[inline(always)]
fn spread<S: Simd, V: Wide<S, Scalar = f32>, const D: usize>(simd: S, v: &[f32; D]) -> [V; D] {
    filled(
        #[inline(always)]
        |axis| V::all(simd, v[axis]),
    )
}

/// Broadcasts lane `lane` of a vector to all lanes.
#[inline(always)]
fn spread_lane<S: Simd, V: Wide<S, Scalar = f32>, const D: usize>(
    simd: S,
    rows: &[LaneRow<f32>; D],
    lane: usize,
) -> [V; D] {
    filled(
        #[inline(always)]
        |axis| V::all(simd, rows[axis][lane]),
    )
}
