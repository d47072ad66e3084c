//! The scan: eight configurations against all pairs.

use super::MAX_LENGTH;
use super::obstacles::{LaneObstacle, Surroundings};
use super::robot::{Crossing, Group, HeldBody, RobotFilter};
use super::search::{Distances, Other, Pairing, Search};
use crate::checker::chain::{LANES, PoseRows, Row, forward};
use crate::math::Wide;
use crate::math::lanes::{LanePose, bits, by_axis, dot, lit, load, minus, with_lanes};
use crate::math::simd::{Eight, Level, Simd};

/// Where everything is in eight configurations.
#[derive(Debug)]
pub(in crate::checker) struct Scratch<const D: usize> {
    /// The number of each node.
    pub(in crate::checker) numbers: Vec<Row<f32>>,
    pub(in crate::checker) rows: Vec<PoseRows<f32, D>>,
    /// The centers of the groups and of the balls; those of the balls of a group when they are needed.
    groups: Vec<[Row<f32>; D]>,
    balls: Vec<[Row<f32>; D]>,
    is_placed: Vec<bool>,
}

impl<const D: usize> Scratch<D> {
    pub(in crate::checker) fn new(robot: &RobotFilter<D>) -> Self {
        let nothing = [[0.0; LANES]; D];
        Self {
            numbers: vec![[0.0; LANES]; robot.nodes.len()],
            rows: vec![PoseRows::identity(); robot.nodes.len() + 1],
            groups: vec![nothing; robot.groups.len()],
            balls: vec![nothing; robot.balls.len()],
            is_placed: vec![false; robot.groups.len()],
        }
    }
}

/// What is scanned.
#[derive(Clone, Copy)]
struct Scan<'a, const D: usize> {
    robot: &'a RobotFilter<D>,
    around: &'a Surroundings<D>,
}

/// Finds the pairs of eight configurations, of which `scratch` has the numbers.
pub(in crate::checker) fn scan_at<const D: usize>(
    level: Level,
    robot: &RobotFilter<D>,
    around: &Surroundings<D>,
    scratch: &mut Scratch<D>,
    search: &mut Search,
) {
    let scan = Scan { robot, around };
    with_lanes!(level, simd => run(simd, scan, scratch, search));
}

/// [`Scan::run`] with vectors of eight.
#[inline(always)]
fn run<S: Simd, const D: usize>(
    simd: S,
    scan: Scan<'_, D>,
    scratch: &mut Scratch<D>,
    search: &mut Search,
) {
    scan.run::<S, <f32 as Eight>::Lanes<S>>(simd, scratch, search);
}

impl<const D: usize> Scan<'_, D> {
    #[inline(always)]
    fn run<S: Simd, V: Wide<S, Scalar = f32>>(
        self,
        simd: S,
        scratch: &mut Scratch<D>,
        search: &mut Search,
    ) {
        forward::<S, f32, V, D>(simd, &self.robot.nodes, &scratch.numbers, &mut scratch.rows);
        search.blind = search.live & !usable_lanes::<S, V, D>(simd, &scratch.rows);
        search.live &= !search.blind;
        scratch.is_placed.fill(false);
        for (index, group) in self.robot.groups.iter().enumerate() {
            let pose: LanePose<V, D> = scratch.rows[group.node].load(simd);
            put(&pose.point(&spread(simd, &group.ball.center)), &mut scratch.groups[index]);
        }
        self.meet_obstacles::<S, V>(simd, scratch, search);
        self.meet_itself::<S, V>(simd, scratch, search);
    }

    /// The balls of a group.
    #[inline(always)]
    fn place<S: Simd, V: Wide<S, Scalar = f32>>(
        self,
        simd: S,
        index: usize,
        scratch: &mut Scratch<D>,
    ) {
        if scratch.is_placed[index] {
            return;
        }
        scratch.is_placed[index] = true;
        let group = &self.robot.groups[index];
        let pose: LanePose<V, D> = scratch.rows[group.node].load(simd);
        for ball in group.balls.clone() {
            let center = spread(simd, &self.robot.balls[ball].center);
            put(&pose.point(&center), &mut scratch.balls[ball]);
        }
    }

    #[inline(always)]
    fn meet_obstacles<S: Simd, V: Wide<S, Scalar = f32>>(
        self,
        simd: S,
        scratch: &mut Scratch<D>,
        search: &mut Search,
    ) {
        for (index, group) in self.robot.groups.iter().enumerate() {
            let center: [V; D] = load(simd, &scratch.groups[index]);
            for within in &self.around.within[index] {
                if search.is_done() || within.gap > search.farthest + search.slide {
                    break;
                }
                let obstacle = &self.around.obstacles[within.obstacle];
                let distances = Distances {
                    squared: obstacle.outline.core.squared(simd, &center),
                    radius: group.ball.radius + obstacle.outline.radius,
                    margin: group.margin + obstacle.margin,
                    is_exact: false,
                };
                if search.near_lanes(simd, &distances) != 0 {
                    self.place::<S, V>(simd, index, scratch);
                    self.meet_obstacle::<S, V>(simd, (group, within.obstacle), scratch, search);
                }
            }
        }
    }

    /// The bodies of a group against an obstacle.
    #[inline(always)]
    fn meet_obstacle<S: Simd, V: Wide<S, Scalar = f32>>(
        self,
        simd: S,
        (group, number): (&Group<D>, usize),
        scratch: &Scratch<D>,
        search: &mut Search,
    ) {
        let LaneObstacle { outline, margin } = &self.around.obstacles[number];
        let number = u32::try_from(number).expect("32 bits can number the obstacles");
        for body in &self.robot.bodies[group.bodies.clone()] {
            if self.around.is_ignored(body.number, number) {
                continue;
            }
            let mut pairing = Pairing::new();
            for ball in body.balls.clone() {
                let center: [V; D] = load(simd, &scratch.balls[ball]);
                let distances = Distances {
                    squared: outline.core.squared(simd, &center),
                    radius: self.robot.balls[ball].radius + outline.radius,
                    margin: group.margin + margin,
                    is_exact: body.is_ball & outline.is_exact,
                };
                search.add(simd, &distances, &mut pairing);
            }
            if pairing.lanes != 0 {
                search.finish(body.number, Other::Obstacle(number), &pairing);
            }
        }
    }

    #[inline(always)]
    fn meet_itself<S: Simd, V: Wide<S, Scalar = f32>>(
        self,
        simd: S,
        scratch: &mut Scratch<D>,
        search: &mut Search,
    ) {
        for crossing in &self.robot.crossings {
            if search.is_done() {
                return;
            }
            if crossing.gap > search.farthest {
                continue;
            }
            let [one, other] = crossing.groups.map(
                #[inline(always)]
                |group| &self.robot.groups[group],
            );
            let centers: [[V; D]; 2] = crossing.groups.map(
                #[inline(always)]
                |group| load(simd, &scratch.groups[group]),
            );
            let distances = Distances {
                squared: squared_between(&centers),
                radius: one.ball.radius + other.ball.radius,
                margin: one.margin + other.margin,
                is_exact: false,
            };
            if search.near_lanes(simd, &distances) != 0 {
                self.place::<S, V>(simd, crossing.groups[0], scratch);
                self.place::<S, V>(simd, crossing.groups[1], scratch);
                self.cross::<S, V>(simd, crossing, scratch, search);
            }
        }
    }

    /// The bodies of two groups against each other.
    #[inline(always)]
    fn cross<S: Simd, V: Wide<S, Scalar = f32>>(
        self,
        simd: S,
        crossing: &Crossing,
        scratch: &Scratch<D>,
        search: &mut Search,
    ) {
        let [one, other] = crossing.groups.map(
            #[inline(always)]
            |group| &self.robot.groups[group],
        );
        let (margin, far) =
            (one.margin + other.margin, load(simd, &scratch.groups[crossing.groups[1]]));
        for row in &crossing.rows {
            let body = &self.robot.bodies[row.body];
            let mut is_near = false;
            for ball in body.balls.clone() {
                let distances = Distances {
                    squared: squared_between::<S, V, D>(&[load(simd, &scratch.balls[ball]), far]),
                    radius: self.robot.balls[ball].radius + other.ball.radius,
                    margin,
                    is_exact: false,
                };
                is_near |= search.near_lanes(simd, &distances) != 0;
            }
            if is_near {
                for &partner in &self.robot.partners[row.partners.clone()] {
                    let pair = [body, &self.robot.bodies[partner]];
                    self.cross_bodies::<S, V>(simd, pair, margin, scratch, search);
                }
            }
        }
    }

    #[inline(always)]
    fn cross_bodies<S: Simd, V: Wide<S, Scalar = f32>>(
        self,
        simd: S,
        [one, other]: [&HeldBody; 2],
        margin: f32,
        scratch: &Scratch<D>,
        search: &mut Search,
    ) {
        let mut pairing = Pairing::new();
        for ball1 in one.balls.clone() {
            let center1: [V; D] = load(simd, &scratch.balls[ball1]);
            for ball2 in other.balls.clone() {
                let distances = Distances {
                    squared: squared_between(&[center1, load(simd, &scratch.balls[ball2])]),
                    radius: self.robot.balls[ball1].radius + self.robot.balls[ball2].radius,
                    margin,
                    is_exact: one.is_ball & other.is_ball,
                };
                search.add(simd, &distances, &mut pairing);
            }
        }
        if pairing.lanes != 0 {
            let (low, high) = (one.number.min(other.number), one.number.max(other.number));
            search.finish(low, Other::Body(high), &pairing);
        }
    }
}

impl<const D: usize> Surroundings<D> {
    #[inline(always)]
    fn is_ignored(&self, body: u32, obstacle: u32) -> bool {
        !self.ignored.is_empty() && self.ignored.binary_search(&[body, obstacle]).is_ok()
    }
}

/// The lanes in which all numbers are finite and have squares.
#[inline(always)]
fn usable_lanes<S: Simd, V: Wide<S, Scalar = f32>, const D: usize>(
    simd: S,
    rows: &[PoseRows<f32, D>],
) -> u8 {
    let most: V = V::all(simd, MAX_LENGTH);
    let mut usable = lit::<S, f32, V>(simd, 0.0).simd_le(most);
    for block in rows {
        let pose: LanePose<V, D> = block.load(simd);
        usable &= pose.rotation[0][0].abs().simd_le(most);
        for axis in 0..D {
            usable &= pose.translation[axis].abs().simd_le(most);
        }
    }
    bits(usable)
}

#[inline(always)]
fn squared_between<S: Simd, V: Wide<S>, const D: usize>([one, other]: &[[V; D]; 2]) -> V {
    let way = minus(other, one);
    dot(&way, &way)
}

#[inline(always)]
fn spread<S: Simd, V: Wide<S, Scalar = f32>, const D: usize>(simd: S, v: &[f32; D]) -> [V; D] {
    by_axis(
        #[inline(always)]
        |axis| V::all(simd, v[axis]),
    )
}

#[inline(always)]
fn put<S: Simd, V: Wide<S, Scalar = f32>, const D: usize>(from: &[V; D], to: &mut [Row<f32>; D]) {
    for axis in 0..D {
        from[axis].store(&mut to[axis]);
    }
}
