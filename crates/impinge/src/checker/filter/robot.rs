//! The bodies of a robot as balls.

use core::ops::Range;
use std::collections::BTreeMap;

use super::core::numbers;
use super::cover::{CoverBall, around, cover};
use super::{MAX_LENGTH, margin};
use crate::checker::chain::Node;
use crate::checker::frames::{FrameTree, OnNode};
use crate::math::{Pose, Real, Space, Vector};
use crate::shape::Shape;

/// Groups of more balls are divided.
const MAX_GROUP: usize = 8;

/// A robot as the scan sees it.
#[derive(Clone, Debug)]
pub(in crate::checker) struct RobotFilter<const D: usize> {
    pub(super) nodes: Vec<Node<f32, D>>,
    pub(super) groups: Vec<Group<D>>,
    /// By groups.
    pub(super) bodies: Vec<HeldBody>,
    /// By bodies.
    pub(super) balls: Vec<LaneBall<D>>,
    pub(super) crossings: Vec<Crossing>,
    /// Bodies of the second group of a crossing.
    pub(super) partners: Vec<usize>,
    /// The margin for a unit of length of all that slides.
    slide_margin: f32,
}

/// A ball in the frame of a node.
#[derive(Clone, Debug)]
pub(super) struct LaneBall<const D: usize> {
    pub(super) center: [f32; D],
    pub(super) radius: f32,
}

/// Bodies of one node that are near each other.
#[derive(Clone, Debug)]
pub(super) struct Group<const D: usize> {
    pub(super) node: usize,
    /// Around all its balls.
    pub(super) ball: LaneBall<D>,
    pub(super) bodies: Range<usize>,
    pub(super) balls: Range<usize>,
    pub(super) margin: f32,
}

/// A body and the balls that hold it.
#[derive(Clone, Debug)]
pub(super) struct HeldBody {
    /// The user's number.
    pub(super) number: u32,
    pub(super) balls: Range<usize>,
    /// It is the ball.
    pub(super) is_ball: bool,
}

/// Two groups with bodies that must not touch.
#[derive(Clone, Debug)]
pub(super) struct Crossing {
    pub(super) groups: [usize; 2],
    /// How far apart all pairs are at least at all times.
    pub(super) gap: f32,
    pub(super) rows: Vec<PartnerRow>,
}

/// A body of the first group, and where its partners are in the list.
#[derive(Clone, Debug)]
pub(super) struct PartnerRow {
    pub(super) body: usize,
    pub(super) partners: Range<usize>,
}

/// A body with its balls before it has a group.
struct Covered<N: Real, const D: usize> {
    number: usize,
    frame: usize,
    node: usize,
    balls: Vec<CoverBall<N, D>>,
    is_ball: bool,
}

/// How long the way to a group is.
pub(super) struct Way<N: Real, const D: usize> {
    /// The first joint, or the center of what does not move.
    pub(super) anchor: Vector<N, D>,
    /// Of the group's ball from there, but for what slides: its center and its radius.
    pub(super) length: f64,
    joints: usize,
}

/// What builds a filter.
struct Builder<'a, N: Real, const D: usize> {
    tree: &'a FrameTree<N, D>,
    shift: Vector<N, D>,
    filter: RobotFilter<D>,
    /// The group and the index of each body of the user's.
    places: Vec<[usize; 2]>,
}

impl<const D: usize> RobotFilter<D> {
    /// That of bodies `(frame, shape, place on the node)`, of which pairs must not touch.
    pub(in crate::checker) fn new<'s, N: Space<D>>(
        tree: &FrameTree<N, D>,
        bodies: impl Iterator<Item = (usize, &'s dyn Shape<N, D>, OnNode<N, D>)>,
        pairs: &[[u32; 2]],
    ) -> Self {
        let covered = bodies.enumerate().map(|(number, (frame, shape, place))| {
            let pose = place.pose.unwrap_or_else(Pose::identity);
            let (balls, is_ball) = cover(shape, &pose);
            Covered { number, frame, node: place.node, balls, is_ball }
        });
        let covered: Vec<_> = covered.collect();
        let mut builder = Builder::new(tree, covered.len());
        for frame in 0..tree.len() {
            let of_frame: Vec<_> = covered.iter().filter(|body| body.frame == frame).collect();
            builder.divide(of_frame);
        }
        builder.cross(pairs);
        builder.filter
    }

    pub(in crate::checker) const fn slide_margin(&self) -> f32 {
        self.slide_margin
    }

    /// The lowest of the distances of two bodies that the same node moves.
    fn gap_on_node(&self, bodies: [usize; 2]) -> f32 {
        let [one, other] = bodies.map(|body| &self.balls[self.bodies[body].balls.clone()]);
        let apart = |a: &LaneBall<D>, b: &LaneBall<D>| {
            let way = Vector::<f32, D>::from(a.center) - Vector::<f32, D>::from(b.center);
            way.norm() - a.radius - b.radius
        };
        let all = one.iter().flat_map(|a| other.iter().map(move |b| apart(a, b)));
        all.fold(f32::INFINITY, f32::min)
    }
}

/// Where lengths are counted from: the first joint on the world.
pub(super) fn shift_of<N: Real, const D: usize>(tree: &FrameTree<N, D>) -> Vector<N, D> {
    let first = tree.nodes.iter().find(|node| node.parent == 0);
    first.map_or_else(Vector::<N, D>::zeros, |node| node.origin)
}

/// The way to a ball on a node.
pub(super) fn way_to<N: Real, const D: usize>(
    tree: &FrameTree<N, D>,
    node: usize,
    ball: &LaneBall<D>,
) -> Way<N, D> {
    let center = Vector::<N, D>::from_fn(|axis, _| N::lit(f64::from(ball.center[axis])));
    let own = f64::from(ball.radius);
    if node == 0 {
        return Way { anchor: center + shift_of(tree), length: own, joints: 0 };
    }
    let (mut length, mut joints, mut at) = (own + center.norm().as_f64(), 1, node);
    while tree.nodes[at - 1].parent != 0 {
        length += tree.nodes[at - 1].origin.norm().as_f64();
        joints += 1;
        at = tree.nodes[at - 1].parent;
    }
    Way { anchor: tree.nodes[at - 1].origin, length, joints }
}

impl<'a, N: Space<D>, const D: usize> Builder<'a, N, D> {
    fn new(tree: &'a FrameTree<N, D>, bodies: usize) -> Self {
        let shift = shift_of(tree);
        let filter = RobotFilter {
            nodes: tree.nodes.iter().map(|node| node.in_f32(&shift)).collect(),
            groups: Vec::new(),
            bodies: Vec::new(),
            balls: Vec::new(),
            crossings: Vec::new(),
            partners: Vec::new(),
            slide_margin: margin::<N>(tree.nodes.len(), 1.0, 1.0),
        };
        Self { tree, shift, filter, places: vec![[0; 2]; bodies] }
    }

    /// Makes groups of bodies of one frame: one, or those of its halves along the longest side.
    fn divide(&mut self, mut bodies: Vec<&Covered<N, D>>) {
        let count: usize = bodies.iter().map(|body| body.balls.len()).sum();
        if bodies.len() < 2 || count <= MAX_GROUP {
            if !bodies.is_empty() {
                self.add_group(&bodies);
            }
            return;
        }
        let axis = longest_axis(&bodies);
        let place = |body: &Covered<N, D>| crate::math::order::order_of(body.balls[0].center[axis]);
        bodies.sort_by_key(|body| (place(body), body.number));
        let back = bodies.split_off(bodies.len() / 2);
        self.divide(bodies);
        self.divide(back);
    }

    fn add_group(&mut self, bodies: &[&Covered<N, D>]) {
        let (first_body, first_ball) = (self.filter.bodies.len(), self.filter.balls.len());
        let node = bodies[0].node;
        let shift = if node == 0 { self.shift } else { Vector::<N, D>::zeros() };
        let mut all = Vec::new();
        for body in bodies {
            self.places[body.number] = [self.filter.groups.len(), self.filter.bodies.len()];
            let from = self.filter.balls.len();
            for ball in &body.balls {
                let ball = CoverBall { center: ball.center - shift, ..*ball };
                self.filter.balls.push(in_f32(&ball));
                all.push(ball);
            }
            let number = u32::try_from(body.number).expect("32 bits can number the bodies");
            let balls = from..self.filter.balls.len();
            self.filter.bodies.push(HeldBody { number, balls, is_ball: body.is_ball });
        }
        let ball = in_f32(&around(&all));
        let way = way_to(self.tree, node, &ball);
        let near = way.length + (way.anchor - self.shift).norm().as_f64();
        let far = near + self.shift.norm().as_f64();
        let margin = margin::<N>(way.joints, near, far);
        let (bodies, balls) =
            (first_body..self.filter.bodies.len(), first_ball..self.filter.balls.len());
        self.filter.groups.push(Group { node, ball, bodies, balls, margin });
    }

    /// Puts pairs of bodies in order of their groups.
    fn cross(&mut self, pairs: &[[u32; 2]]) {
        let mut by_groups = BTreeMap::<[usize; 2], Vec<[usize; 2]>>::new();
        for pair in pairs {
            let mut places = pair.map(|body| self.places[body as usize]);
            places.sort_unstable();
            let [[group1, body1], [group2, body2]] = places;
            by_groups.entry([group1, group2]).or_default().push([body1, body2]);
        }
        for (groups, mut pairs) in by_groups {
            pairs.sort_unstable();
            pairs.dedup();
            self.add_crossing(groups, &pairs);
        }
    }

    fn add_crossing(&mut self, groups: [usize; 2], pairs: &[[usize; 2]]) {
        let filter = &mut self.filter;
        let [one, other] = groups.map(|group| &filter.groups[group]);
        let gap = if one.node == other.node {
            let gaps = pairs.iter().map(|pair| filter.gap_on_node(*pair));
            gaps.fold(f32::INFINITY, f32::min) - one.margin - other.margin
        } else {
            -f32::INFINITY
        };
        let mut rows = Vec::new();
        for same in pairs.chunk_by(|one, other| one[0] == other[0]) {
            let from = filter.partners.len();
            filter.partners.extend(same.iter().map(|pair| pair[1]));
            rows.push(PartnerRow { body: same[0][0], partners: from..filter.partners.len() });
        }
        filter.crossings.push(Crossing { groups, gap, rows });
    }
}

/// Along which the centers are spread farthest.
fn longest_axis<N: Real, const D: usize>(bodies: &[&Covered<N, D>]) -> usize {
    let spread = |axis: usize| {
        let places = bodies.iter().map(|body| body.balls[0].center[axis].as_f64());
        let (low, high) = places
            .fold((f64::INFINITY, -f64::INFINITY), |(low, high), x| (low.min(x), high.max(x)));
        high - low
    };
    (1..D).fold(0, |best, axis| if spread(axis) > spread(best) { axis } else { best })
}

/// Without an end, where its numbers have no squares.
fn in_f32<N: Real, const D: usize>(ball: &CoverBall<N, D>) -> LaneBall<D> {
    let (center, radius) = (numbers(&ball.center), ball.radius.as_f32_above());
    let is_usable = radius <= MAX_LENGTH && center.iter().all(|x: &f32| x.abs() <= MAX_LENGTH);
    if is_usable {
        LaneBall { center, radius }
    } else {
        LaneBall { center: [0.0; D], radius: f32::INFINITY }
    }
}
