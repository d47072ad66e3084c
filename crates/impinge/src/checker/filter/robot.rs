//! The bodies of a robot as groups of balls.

use std::collections::BTreeMap;

use super::core::numbers;
use super::cover::{CoverBall, around, cover};
use super::{MAX_LENGTH, margin};
use crate::checker::chain::{LANES, LaneRow, Node};
use crate::checker::frames::{FrameTree, OnNode};
use crate::math::order::{order_of, sort_few};
use crate::math::{Mapped, Matrix, Point, Pose, Real, Space, Vector};
use crate::shape::Shape;

/// A robot in the form of the scan.
#[derive(Clone, Debug)]
pub(in crate::checker) struct RobotFilter<const D: usize> {
    pub(super) nodes: Vec<Node<f32, D>>,
    pub(super) groups: Vec<BallGroup<D>>,
    pub(super) crossings: Vec<GroupPair>,
    /// The margin per unit of length of all slides.
    slide_margin: f32,
}

/// Up to eight neighbouring balls on one node: one body, or several.
#[derive(Clone, Debug)]
pub(super) struct BallGroup<const D: usize> {
    pub(super) node: usize,
    /// The ball around all its balls.
    pub(super) center: [f32; D],
    pub(super) radius: f32,
    /// The balls in lanes; lanes without a ball are masked out.
    pub(super) centers: [LaneRow<f32>; D],
    pub(super) radii: LaneRow<f32>,
    /// The numbers, in the user's order, of the bodies that the balls cover.
    pub(super) bodies: [u32; LANES],
    /// The number of balls, and a bit for each ball that equals its body.
    pub(super) count: usize,
    pub(super) exact: u8,
    pub(super) margin: f32,
}

/// Two groups with bodies that must not touch.
#[derive(Clone, Debug)]
pub(super) struct GroupPair {
    pub(super) groups: [usize; 2],
    /// A lower bound of the distance of all pairs at all times, if nothing slides.
    pub(super) gap: f32,
    /// How many of the two groups may be moved by slides.
    pub(super) sliding: f32,
    /// The sum of the radii of their balls and of the margins.
    pub(super) radius: f32,
    /// For each ball of the first group the balls of the second that must not touch it, as bits.
    pub(super) wanted: [u8; LANES],
}

/// A body with its cover, before it has a group.
struct Covered<N: Real, const D: usize> {
    number: usize,
    node: usize,
    balls: Vec<CoverBall<N, D>>,
    is_ball: bool,
}

/// The region that a group can reach.
pub(super) struct Way<N: Real, const D: usize> {
    /// The position of the first joint that rotates, or the center if none does, with all slides at
    /// zero.
    pub(super) anchor: Vector<N, D>,
    /// An upper bound of the distance of the group's ball from there, without slides: to its center
    /// plus its radius.
    pub(super) length: f64,
    /// The position of the first joint, or the center if nothing moves, and the length from there:
    /// both enter the margins.
    first: Vector<N, D>,
    from_first: f64,
    joints: usize,
}

/// The state of building a filter.
struct Builder<'a, N: Real, const D: usize> {
    tree: &'a FrameTree<N, D>,
    shift: Vector<N, D>,
    filter: RobotFilter<D>,
    /// The reach of each group: all of it is within the length of the anchor.
    ways: Vec<Way<N, D>>,
    /// The group and the balls, as bits, of each body, in the user's order.
    places: Vec<(usize, u8)>,
}

impl<const D: usize> RobotFilter<D> {
    /// Builds the filter for bodies at places on their nodes, and the pairs that must not touch.
    pub(in crate::checker) fn new<'s, N: Space<D>>(
        tree: &FrameTree<N, D>,
        bodies: impl Iterator<Item = (&'s dyn Shape<N, D>, OnNode<N, D>)>,
        pairs: &[[u32; 2]],
    ) -> Self {
        let covered = bodies.enumerate().map(|(number, (shape, place))| {
            let pose = place.pose.unwrap_or_else(Pose::identity);
            let (balls, is_ball) = cover(shape, &pose);
            Covered { number, node: place.node, balls, is_ball }
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

/// The origin of `f32` coordinates: the first joint on the world.
pub(super) fn shift_of<N: Real, const D: usize>(tree: &FrameTree<N, D>) -> Vector<N, D> {
    let first = tree.nodes.iter().find(|node| node.parent == 0);
    first.map_or_else(Vector::<N, D>::zeros, |node| node.origin)
}

/// The chain of joints to a ball on a node; the center is relative to [`shift_of`] on the world.
pub(super) fn way_to<N: Real, const D: usize>(
    tree: &FrameTree<N, D>,
    node: usize,
    (center, radius): (&[f32; D], f32),
) -> Way<N, D> {
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
    // Up to the first joint that rotates, all rotations are constant.
    let mut pose = Pose::identity();
    let mut turning = chain.iter().rev().skip_while(|node| {
        let rotation = node.constant_rotation();
        pose.translation = pose.point(&Point::from(node.origin)).coords;
        pose.rotation *= rotation.unwrap_or_else(Matrix::<N, D>::identity);
        rotation.is_some()
    });
    let is_turned = turning.next().is_some();
    let beyond: f64 = turning.map(|node| node.origin.norm().as_f64()).sum();
    let center_at_zero = pose.point(&Point::from(center)).coords;
    let (anchor, length) = if is_turned {
        (pose.translation, own + beyond)
    } else {
        (center_at_zero, f64::from(radius))
    };
    let first = chain.last().map_or(center, |node| node.origin);
    Way { anchor, length, first, from_first, joints: chain.len() }
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
        Self { tree, shift, filter, ways: Vec::new(), places: vec![(0, 0); bodies] }
    }

    /// Groups the bodies of one node: one group, or those of the two halves along the longest axis.
    fn divide(&mut self, mut bodies: Vec<&Covered<N, D>>) {
        let count: usize = bodies.iter().map(|body| body.balls.len()).sum();
        if bodies.len() < 2 || count <= LANES {
            return self.add_group(&bodies);
        }
        let axis = longest_axis(&bodies);
        let key = |body: &Covered<N, D>| (order_of(body.balls[0].center[axis]), body.number);
        sort_few(&mut bodies, |one, other| key(one) < key(other));
        // Full groups make the number of groups smaller.
        let half = bodies.len().div_ceil(2);
        let full = half.next_multiple_of(LANES);
        let back = bodies.split_off(if full < bodies.len() { full } else { half });
        self.divide(bodies);
        self.divide(back);
    }

    /// Appends a group of the balls of some bodies on one node, with its bounding ball, reach and
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
            self.places[body.number] = (self.filter.groups.len(), bits);
        }
        (group.center, group.radius) = in_f32(&around(&all));
        let way = way_to(self.tree, node, (&group.center, group.radius));
        let near = way.from_first + (way.first - self.shift).norm().as_f64();
        let far = near + self.shift.norm().as_f64();
        group.margin = margin::<N>(way.joints, near, far);
        self.filter.groups.push(group);
        self.ways.push(way);
    }

    /// Collects the pairs of bodies by their groups.
    fn cross(&mut self, pairs: &[[u32; 2]]) {
        let mut by_groups = BTreeMap::<[usize; 2], [u8; LANES]>::new();
        for pair in pairs {
            let [one, other] = pair.mapped(|body| self.places[body as usize]);
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

    /// A lower bound of the distance between the regions that two groups can reach.
    fn gap_between(&self, groups: [usize; 2]) -> f32 {
        let [one, other] = groups.mapped(|group| &self.ways[group]);
        let apart = (one.anchor - other.anchor).norm().as_f64();
        N::lit(apart - one.length - other.length).as_f32_below()
    }
}

/// A lower bound of the distance between the balls of two groups on one node.
fn gap_on_node<const D: usize>([one, other]: [&BallGroup<D>; 2], wanted: &[u8; LANES]) -> f32 {
    let mut least = f32::INFINITY;
    for (ball1, others) in wanted.iter().enumerate() {
        for ball2 in (0..LANES).filter(|ball| others >> ball & 1 == 1) {
            let way = one.center_of(ball1) - other.center_of(ball2);
            least = least.min(way.norm() - one.radii[ball1] - other.radii[ball2]);
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

    /// Appends a ball of a body; the group must not be full.
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

    /// A bit for each ball.
    #[inline(always)]
    pub(super) const fn present(&self) -> u8 {
        u8::MAX >> (LANES - self.count)
    }

    fn center_of(&self, ball: usize) -> Vector<f32, D> {
        Vector::<f32, D>::from_fn(|axis, _| self.centers[axis][ball])
    }
}

/// The axis along which the centers are spread farthest.
fn longest_axis<N: Real, const D: usize>(bodies: &[&Covered<N, D>]) -> usize {
    let spread = |axis: usize| {
        let places = bodies.iter().map(|body| body.balls[0].center[axis].as_f64());
        let (low, high) = places
            .fold((f64::INFINITY, -f64::INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        high - low
    };
    (1..D).fold(0, |best, axis| if spread(axis) > spread(best) { axis } else { best })
}

/// The center and the radius in `f32`; an infinite radius if their squares may overflow.
fn in_f32<N: Real, const D: usize>(ball: &CoverBall<N, D>) -> ([f32; D], f32) {
    let (center, radius) = (numbers(&ball.center), ball.radius.as_f32_above());
    let is_usable = radius <= MAX_LENGTH && center.iter().all(|x: &f32| x.abs() <= MAX_LENGTH);
    if is_usable { (center, radius) } else { ([0.0; D], f32::INFINITY) }
}
