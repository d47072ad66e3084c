//! The obstacles of a checker, prepared for the scan.

use super::core::RoundedCore;
use super::robot::{BallGroup, RobotFilter, path_to, shift_of};
use super::{MAX_LENGTH, margin};
use crate::checker::body::Obstacle;
use crate::checker::frames::FrameTree;
use crate::collide::Placed;
use crate::math::order::{order_of, sort_few};
use crate::math::{Pose, Real, Space, Vector};
use crate::query::distance_between;
use crate::shape::{Ball, Shape};

/// The obstacles in `f32`, and for each group of balls the obstacles to test it against.
#[derive(Clone, Debug)]
pub(in crate::checker) struct Surroundings<const D: usize> {
    pub(super) obstacles: Vec<LaneObstacle<D>>,
    /// For each group, the obstacles to test it against, in ascending order of `gap`.
    pub(super) within: Vec<Vec<CloseObstacle>>,
    /// The pairs of a body and an obstacle that may touch, in ascending order.
    ignored: Vec<[u32; 2]>,
}

/// An obstacle in `f32`, relative to the first joint, and a bound of its rounding error.
#[derive(Clone, Debug)]
pub(super) struct LaneObstacle<const D: usize> {
    pub(super) outline: RoundedCore<D>,
    pub(super) margin: f32,
}

/// An obstacle that some body of a group must not touch.
#[derive(Clone, Debug)]
pub(super) struct CloseObstacle {
    /// A lower bound of the distance between the group and the obstacle in all configurations whose
    /// slides are zero.
    pub(super) gap: f32,
    pub(super) obstacle: usize,
    /// The index of the obstacle in the user's order.
    pub(super) number: u32,
    /// A bit mask of the balls of the group whose bodies must not touch the obstacle.
    pub(super) wanted: u8,
    /// The sum of the radius of the group's bounding ball, the rounding radius of the obstacle, and
    /// both margins.
    pub(super) radius: f32,
}

impl<const D: usize> Surroundings<D> {
    pub(in crate::checker) fn new<N: Space<D>>(
        tree: &FrameTree<N, D>,
        robot: &RobotFilter<D>,
        obstacles: &[Obstacle<N, D>],
        ignored: &[[u32; 2]],
    ) -> Self {
        let mut ignored = ignored.to_vec();
        ignored.sort_unstable();
        let in_lanes = obstacles.iter().map(|obstacle| in_f32(tree, obstacle));
        let mut all = Self { obstacles: in_lanes.collect(), within: Vec::new(), ignored };
        all.within = (0..robot.groups.len())
            .map(|group| all.close_obstacles(tree, robot, obstacles, group))
            .collect();
        all
    }

    /// Returns the obstacles that some body of a group must not touch, in ascending order of `gap`.
    fn close_obstacles<N: Space<D>>(
        &self,
        tree: &FrameTree<N, D>,
        robot: &RobotFilter<D>,
        obstacles: &[Obstacle<N, D>],
        group: usize,
    ) -> Vec<CloseObstacle> {
        let group = &robot.groups[group];
        let path = path_to(tree, group.node, (&group.center, group.radius));
        let mut all = Vec::new();
        for (index, obstacle) in obstacles.iter().enumerate() {
            let number = u32::try_from(index).expect("32 bits can number the obstacles");
            let wanted = self.wanted(group, number);
            if wanted == 0 {
                continue;
            }
            let LaneObstacle { outline, margin } = &self.obstacles[index];
            let margin = margin + group.margin;
            let radius = group.radius + outline.radius + margin;
            let gap =
                distance_from(&path.anchor, obstacle).as_f64() - path.length - f64::from(margin);
            let gap = N::lit(gap).as_f32_below();
            // A NaN gap (infinity minus infinity) becomes minus infinity, so that the obstacle is
            // always tested.
            let gap = if gap.is_nan() { -f32::INFINITY } else { gap };
            all.push(CloseObstacle { gap, obstacle: index, number, wanted, radius });
        }
        let key = |within: &CloseObstacle| (order_of(within.gap), within.obstacle);
        sort_few(&mut all, |one, other| key(one) < key(other));
        all
    }

    /// Returns a bit mask of the balls of a group whose bodies must not touch an obstacle.
    fn wanted(&self, group: &BallGroup<D>, obstacle: u32) -> u8 {
        let may_touch = |body| self.ignored.binary_search(&[body, obstacle]).is_ok();
        let wanted = (0..group.count).filter(|&ball| !may_touch(group.bodies[ball]));
        wanted.fold(0, |bits, ball| bits | 1 << ball)
    }
}

/// Returns the distance of an obstacle from a point.
fn distance_from<N: Space<D>, const D: usize>(
    point: &Vector<N, D>,
    obstacle: &Obstacle<N, D>,
) -> N {
    let ball = Ball::new(N::ZERO);
    let at = Placed { pose: Pose::from_translation(*point), shape: Shape::<N, D>::geometry(&ball) };
    let there = Placed::of_pose(&obstacle.pose, obstacle.shape.geometry());
    distance_between(&at, &there)
}

/// Converts an obstacle to `f32`, relative to the first joint. If a length is too large for `f32`,
/// the core is unknown.
fn in_f32<N: Space<D>, const D: usize>(
    tree: &FrameTree<N, D>,
    obstacle: &Obstacle<N, D>,
) -> LaneObstacle<D> {
    let shift = shift_of(tree);
    let pose = Pose { translation: obstacle.pose.translation - shift, ..obstacle.pose };
    let outline = RoundedCore::new(&*obstacle.shape, &pose);
    let extent = obstacle.shape.geometry().extent();
    let own = if extent.is_finite_number() { extent.as_f64() } else { size_of_box(obstacle) };
    let near = pose.translation.norm().as_f64() + own;
    let far = near + shift.norm().as_f64();
    let margin = margin::<N>(0, near, far);
    let is_usable = margin <= MAX_LENGTH && near <= f64::from(MAX_LENGTH);
    if is_usable {
        LaneObstacle { outline, margin }
    } else {
        LaneObstacle { outline: RoundedCore::unknown(), margin: 0.0 }
    }
}

/// Returns the largest distance of a corner of the shape's box from the shape's origin; zero if the
/// box is unbounded, as for a half-space.
fn size_of_box<N: Real, const D: usize>(obstacle: &Obstacle<N, D>) -> f64 {
    let aabb = obstacle.shape.local_aabb();
    if !aabb.is_bounded() {
        return 0.0;
    }
    (aabb.center().coords.abs() + aabb.half_extents()).norm().as_f64()
}
