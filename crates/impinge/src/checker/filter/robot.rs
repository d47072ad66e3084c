//! The bodies of a robot as groups of balls, which the scan tests against each other and against
//! obstacles.

use std::collections::BTreeMap;

use super::core::numbers;
use super::cover::{CoverBall, around, cover};
use super::{MAX_LENGTH, margin};
use crate::checker::chain::{LANES, LaneRow, Node};
use crate::checker::frames::{FrameTree, OnNode};
use crate::math::order::{order_of, sort_few};
use crate::math::{Mapped, Matrix, Point, Pose, Real, Space, Vector};
use crate::shape::Shape;

/// The bodies of a robot in `f32`, as groups of balls that the scan tests.
#[derive(Clone, Debug)]
pub(in crate::checker) struct RobotFilter<const D: usize> {
    pub(super) nodes: Vec<Node<f32, D>>,
    pub(super) groups: Vec<BallGroup<D>>,
    pub(super) crossings: Vec<GroupPair>,
    /// The error margin per unit of length that the prismatic joints slide in total.
    slide_margin: f32,
}

/// Up to 8 neighbouring balls on one node, which cover one or several bodies.
#[derive(Clone, Debug)]
pub(super) struct BallGroup<const D: usize> {
    pub(super) node: usize,
    /// The bounding ball of all balls of the group, in the frame of the node.
    pub(super) center: [f32; D],
    pub(super) radius: f32,
    /// The centres of the balls, in the frame of the node, one lane per ball; lanes without a ball
    /// are masked out.
    pub(super) centers: [LaneRow<f32>; D],
    pub(super) radii: LaneRow<f32>,
    /// The index of the body that each ball covers, in the user's order.
    pub(super) bodies: [u32; LANES],
    /// The number of balls in the group. `exact` is a bit mask of the balls that equal their body.
    pub(super) count: usize,
    pub(super) exact: u8,
    pub(super) margin: f32,
}

/// Two groups that contain bodies which must not touch each other.
#[derive(Clone, Debug)]
pub(super) struct GroupPair {
    pub(super) groups: [usize; 2],
    /// A lower bound of the distance between the bodies of the pairs in all configurations whose
    /// slides are zero.
    pub(super) gap: f32,
    /// The gap shrinks by at most this factor times the total slide: 0 if both groups are on one
    /// node, else 2, since slides may move both groups.
    pub(super) sliding: f32,
    /// The sum of the radii of both bounding balls and of both margins.
    pub(super) radius: f32,
    /// For each ball of the first group, a bit mask of the balls of the second group that must not
    /// touch it.
    pub(super) wanted: [u8; LANES],
}

/// A body with the balls that cover it, before it is assigned to a group.
struct Covered<N: Real, const D: usize> {
    number: usize,
    node: usize,
    balls: Vec<CoverBall<N, D>>,
    is_ball: bool,
}

/// A bound of the region that a group can occupy in all configurations whose slides are zero: a
/// ball around `anchor`.
pub(super) struct NodePath<N: Real, const D: usize> {
    /// The position of the first revolute joint of the chain, or the centre of the group if the
    /// chain has no revolute joint, with all slides at zero.
    pub(super) anchor: Vector<N, D>,
    /// An upper bound of the distance from `anchor` to any point of the group's bounding ball,
    /// without slides.
    pub(super) length: f64,
    /// The position of the first joint of the chain, or the centre of a group that is fixed to the
    /// world. `from_first` is the length of the chain from that position. Both determine the
    /// margins.
    first: Vector<N, D>,
    from_first: f64,
    joints: usize,
}

/// A [`RobotFilter`] under construction, with the data that only its construction needs.
struct Builder<'a, N: Real, const D: usize> {
    tree: &'a FrameTree<N, D>,
    shift: Vector<N, D>,
    filter: RobotFilter<D>,
    /// For each group, a bound of the region that it can occupy.
    paths: Vec<NodePath<N, D>>,
    /// For each body in the user's order, the index of its group and a bit mask of its balls in the
    /// group.
    memberships: Vec<(usize, u8)>,
}

impl<const D: usize> RobotFilter<D> {
    /// Builds the filter from bodies on their nodes, and the pairs that must not touch.
    pub(in crate::checker) fn new<'s, N: Space<D>>(
        tree: &FrameTree<N, D>,
        bodies: impl Iterator<Item = (&'s dyn Shape<N, D>, OnNode<N, D>)>,
        pairs: &[[u32; 2]],
    ) -> Self {
        let covered = bodies.enumerate().map(|(number, (shape, on_node))| {
            let pose = on_node.pose.unwrap_or_else(Pose::identity);
            let (balls, is_ball) = cover(shape, &pose);
            Covered { number, node: on_node.node, balls, is_ball }
        });
        let covered: Vec<_> = covered.collect();
        let mut builder = Builder::new(tree, covered.len());
        for node in 0..=tree.nodes.len() {
            let on_node: Vec<_> = covered.iter().filter(|body| body.node == node).collect();
            if !on_node.is_empty() {
                builder.divide(on_node);
            }
        }
        builder.cross(pairs);
        builder.filter
    }

    pub(in crate::checker) const fn slide_margin(&self) -> f32 {
        self.slide_margin
    }
}

/// Returns the origin of the `f32` coordinates in the world frame: the position of the first joint
/// whose parent is the world, or zero if there is no such joint.
pub(super) fn shift_of<N: Real, const D: usize>(tree: &FrameTree<N, D>) -> Vector<N, D> {
    let first = tree.nodes.iter().find(|node| node.parent == 0);
    first.map_or_else(Vector::<N, D>::zeros, |node| node.origin)
}

/// Returns a bound of the region that a ball on a node can occupy. `center` is in the frame of the
/// node; if `node` is 0, the world, it is relative to [`shift_of`].
pub(super) fn path_to<N: Real, const D: usize>(
    tree: &FrameTree<N, D>,
    node: usize,
    (center, radius): (&[f32; D], f32),
) -> NodePath<N, D> {
    let mut center = Vector::<N, D>::from_fn(|axis, _| N::lit(f64::from(center[axis])));
    if node == 0 {
        center += shift_of(tree);
    }
    let (mut chain, mut at) = (Vec::new(), node);
    while at != 0 {
        chain.push(&tree.nodes[at - 1]);
        at = tree.nodes[at - 1].parent;
    }
    let own = f64::from(radius) + if node == 0 { 0.0 } else { center.norm().as_f64() };
    let lengths = chain.iter().rev().skip(1).map(|node| node.origin.norm().as_f64());
    let from_first = own + lengths.sum::<f64>();
    // Before the first revolute joint of the chain, all rotations are constant.
    let mut pose = Pose::identity();
    let mut turning = chain.iter().rev().skip_while(|node| {
        let rotation = node.constant_rotation();
        pose.translation = pose.point(&Point::from(node.origin)).coords;
        pose.rotation *= rotation.unwrap_or_else(Matrix::<N, D>::identity);
        rotation.is_some()
    });
    let is_rotated = turning.next().is_some();
    let beyond: f64 = turning.map(|node| node.origin.norm().as_f64()).sum();
    let center_at_zero = pose.point(&Point::from(center)).coords;
    let (anchor, length) = if is_rotated {
        (pose.translation, own + beyond)
    } else {
        (center_at_zero, f64::from(radius))
    };
    let first = chain.last().map_or(center, |node| node.origin);
    NodePath { anchor, length, first, from_first, joints: chain.len() }
}

impl<'a, N: Space<D>, const D: usize> Builder<'a, N, D> {
    fn new(tree: &'a FrameTree<N, D>, bodies: usize) -> Self {
        let shift = shift_of(tree);
        let filter = RobotFilter {
            nodes: tree.nodes.iter().map(|node| node.in_f32(&shift)).collect(),
            groups: Vec::new(),
            crossings: Vec::new(),
            slide_margin: margin::<N>(tree.nodes.len(), 1.0, 1.0),
        };
        Self { tree, shift, filter, paths: Vec::new(), memberships: vec![(0, 0); bodies] }
    }

    /// Divides the bodies of one node into groups: one group if all their balls fit, else the
    /// groups of each half along the longest axis.
    fn divide(&mut self, mut bodies: Vec<&Covered<N, D>>) {
        let count: usize = bodies.iter().map(|body| body.balls.len()).sum();
        if bodies.len() < 2 || count <= LANES {
            return self.add_group(&bodies);
        }
        let axis = longest_axis(&bodies);
        let key = |body: &Covered<N, D>| (order_of(body.balls[0].center[axis]), body.number);
        sort_few(&mut bodies, |one, other| key(one) < key(other));
        // Splits at a multiple of 8 if that leaves a second part, so that fewer groups are needed.
        let half = bodies.len().div_ceil(2);
        let full = half.next_multiple_of(LANES);
        let back = bodies.split_off(if full < bodies.len() { full } else { half });
        self.divide(bodies);
        self.divide(back);
    }

    /// Appends a group of the balls of some bodies on one node, with its bounding ball, region and
    /// margin.
    fn add_group(&mut self, bodies: &[&Covered<N, D>]) {
        let node = bodies[0].node;
        let shift = if node == 0 { self.shift } else { Vector::<N, D>::zeros() };
        let mut group = BallGroup::empty(node);
        let mut all = Vec::new();
        for body in bodies {
            let from = group.count;
            for ball in &body.balls {
                let ball = CoverBall { center: ball.center - shift, ..*ball };
                group.push(body, in_f32(&ball));
                all.push(ball);
            }
            let bits = (from..group.count).fold(0, |bits, ball| bits | 1 << ball);
            self.memberships[body.number] = (self.filter.groups.len(), bits);
        }
        (group.center, group.radius) = in_f32(&around(&all));
        let path = path_to(self.tree, node, (&group.center, group.radius));
        let near = path.from_first + (path.first - self.shift).norm().as_f64();
        let far = near + self.shift.norm().as_f64();
        group.margin = margin::<N>(path.joints, near, far);
        self.filter.groups.push(group);
        self.paths.push(path);
    }

    /// Collects the pairs of bodies by the pair of groups that contain the bodies.
    fn cross(&mut self, pairs: &[[u32; 2]]) {
        let mut by_groups = BTreeMap::<[usize; 2], [u8; LANES]>::new();
        for pair in pairs {
            let [one, other] = pair.mapped(|body| self.memberships[body as usize]);
            let ((group1, balls1), (group2, balls2)) = (one.min(other), one.max(other));
            let wanted = by_groups.entry([group1, group2]).or_default();
            for (ball, others) in wanted.iter_mut().enumerate() {
                *others |= if balls1 >> ball & 1 == 1 { balls2 } else { 0 };
            }
        }
        for (groups, wanted) in by_groups {
            let [one, other] = groups.mapped(|group| &self.filter.groups[group]);
            let (gap, sliding) = if one.node == other.node {
                (gap_on_node([one, other], &wanted), 0.0)
            } else {
                (self.gap_between(groups), 2.0)
            };
            let gap = gap - one.margin - other.margin;
            let gap = if gap.is_nan() { -f32::INFINITY } else { gap };
            let radius = one.radius + other.radius + (one.margin + other.margin);
            self.filter.crossings.push(GroupPair { groups, gap, sliding, radius, wanted });
        }
    }

    /// Returns a lower bound of the distance between the regions that two groups can occupy;
    /// negative if the bounds of the regions overlap.
    fn gap_between(&self, groups: [usize; 2]) -> f32 {
        let [one, other] = groups.mapped(|group| &self.paths[group]);
        let apart = (one.anchor - other.anchor).norm().as_f64();
        N::lit(apart - one.length - other.length).as_f32_below()
    }
}

/// Returns the smallest distance between balls of two groups on one node that must not touch;
/// negative if they overlap.
fn gap_on_node<const D: usize>([one, other]: [&BallGroup<D>; 2], wanted: &[u8; LANES]) -> f32 {
    let mut least = f32::INFINITY;
    for (ball1, others) in wanted.iter().enumerate() {
        for ball2 in (0..LANES).filter(|ball| others >> ball & 1 == 1) {
            let offset = one.center_of(ball1) - other.center_of(ball2);
            least = least.min(offset.norm() - one.radii[ball1] - other.radii[ball2]);
        }
    }
    least
}

impl<const D: usize> BallGroup<D> {
    const fn empty(node: usize) -> Self {
        Self {
            node,
            center: [0.0; D],
            radius: 0.0,
            centers: [[0.0; LANES]; D],
            radii: [0.0; LANES],
            bodies: [u32::MAX; LANES],
            count: 0,
            exact: 0,
            margin: 0.0,
        }
    }

    /// Appends a ball of a body; the group must have fewer than 8 balls.
    fn push<N: Real>(&mut self, body: &Covered<N, D>, (center, radius): ([f32; D], f32)) {
        let lane = self.count;
        for (row, x) in self.centers.iter_mut().zip(center) {
            row[lane] = x;
        }
        self.radii[lane] = radius;
        self.bodies[lane] = u32::try_from(body.number).expect("32 bits can number the bodies");
        self.exact |= u8::from(body.is_ball) << lane;
        self.count += 1;
    }

    /// Returns a bit mask of the lanes that have a ball.
    #[inline(always)]
    pub(super) const fn present(&self) -> u8 {
        u8::MAX >> (LANES - self.count)
    }

    fn center_of(&self, ball: usize) -> Vector<f32, D> {
        Vector::<f32, D>::from_fn(|axis, _| self.centers[axis][ball])
    }
}

/// Returns the axis along which the centres of the bodies' first balls have the greatest spread.
fn longest_axis<N: Real, const D: usize>(bodies: &[&Covered<N, D>]) -> usize {
    let spread = |axis: usize| {
        let coordinates = bodies.iter().map(|body| body.balls[0].center[axis].as_f64());
        let (low, high) = coordinates
            .fold((f64::INFINITY, -f64::INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        high - low
    };
    (1..D).fold(0, |best, axis| if spread(axis) > spread(best) { axis } else { best })
}

/// Converts the centre and the radius of a ball to `f32`. The radius is infinite if squares of
/// these numbers might overflow.
fn in_f32<N: Real, const D: usize>(ball: &CoverBall<N, D>) -> ([f32; D], f32) {
    let (center, radius) = (numbers(&ball.center), ball.radius.as_f32_above());
    let is_usable = radius <= MAX_LENGTH && center.iter().all(|x: &f32| x.abs() <= MAX_LENGTH);
    if is_usable { (center, radius) } else { ([0.0; D], f32::INFINITY) }
}
