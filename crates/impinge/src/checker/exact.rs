//! The exact distance queries, in the user's scalar, which decide the pairs that the `f32` filter
//! leaves undecided.

use core::ops::Range;

use super::Checker;
use super::chain::{LANES, LaneRow, PoseRows};
use super::filter::Other;
use crate::collide::Placed;
use crate::math::Space;
use crate::query::distance_within;

/// Exact queries for a packet of up to 8 configurations. The poses in the user's scalar are
/// computed on first use.
pub(super) struct Exact<'a, N: Space<D>, const D: usize> {
    checker: &'a Checker<N, D>,
    configurations: &'a [N],
    range: Range<usize>,
    numbers: Vec<LaneRow<N>>,
    rows: Vec<PoseRows<N, D>>,
    is_placed: bool,
}

impl<'a, N: Space<D>, const D: usize> Exact<'a, N, D> {
    pub(super) fn new(checker: &'a Checker<N, D>, configurations: &'a [N]) -> Self {
        let nodes = checker.tree.nodes.len();
        Self {
            checker,
            configurations,
            range: 0..0,
            numbers: vec![[N::ZERO; LANES]; nodes],
            rows: vec![PoseRows::identity(); nodes + 1],
            is_placed: false,
        }
    }

    /// Switches to the packet with the configurations of `range`.
    pub(super) const fn begin(&mut self, range: Range<usize>) {
        self.range = range;
        self.is_placed = false;
    }

    /// Returns the poses of all nodes in the configurations of the packet; computes them on first
    /// use.
    fn rows(&mut self) -> &[PoseRows<N, D>] {
        if !self.is_placed {
            let tree = &self.checker.tree;
            tree.numbers(self.configurations, &self.range, &mut self.numbers);
            tree.forward(&self.numbers, &mut self.rows);
            self.is_placed = true;
        }
        &self.rows
    }

    /// Returns whether all frames of the configuration in lane `lane` have finite poses.
    pub(super) fn is_finite(&mut self, lane: usize) -> bool {
        let frames = &self.checker.tree.frames;
        let rows = self.rows();
        frames.iter().all(|frame| frame.at(rows, lane).is_finite())
    }

    /// Computes the distance of a pair up to `limit`, or returns `Unknown` if this needs a search
    /// of parts.
    pub(super) fn quick_distance(
        &mut self,
        pair: (u32, Other),
        lane: usize,
        limit: N,
    ) -> QuickDistance<N> {
        let [(one, number1), (other, number2)] = self.solids(pair, lane);
        let is_convex = |solid: &Placed<'_, N, D>| solid.shape.as_composite().is_none();
        if is_convex(&one) && is_convex(&other) {
            return QuickDistance::Known(distance_within(&one, &other, limit));
        }
        let hulls = &self.checker.hulls;
        let is_beyond = hulls.are_beyond([(&one, number1), (&other, number2)], limit);
        if is_beyond { QuickDistance::Known(None) } else { QuickDistance::Unknown }
    }

    /// Returns the distance of a pair in a configuration; `None` if it exceeds `limit`.
    pub(super) fn distance(&mut self, pair: (u32, Other), lane: usize, limit: N) -> Option<N> {
        match self.quick_distance(pair, lane, limit) {
            QuickDistance::Known(distance) => distance,
            QuickDistance::Unknown => self.searched(pair, lane, limit),
        }
    }

    /// Returns the distance of a pair, `None` if it exceeds `limit`. The parts of composites are
    /// searched.
    pub(super) fn searched(&mut self, pair: (u32, Other), lane: usize, limit: N) -> Option<N> {
        let [(one, _), (other, _)] = self.solids(pair, lane);
        distance_within(&one, &other, limit)
    }

    /// Returns the solids of a pair, each with its body index; `None` instead of an index for an
    /// obstacle.
    fn solids(
        &mut self,
        (first, other): (u32, Other),
        lane: usize,
    ) -> [(Placed<'a, N, D>, Option<u32>); 2] {
        let checker = self.checker;
        let rows = self.rows();
        let body = |number: u32| {
            let index = number as usize;
            let pose = checker.on_nodes[index].at(rows, lane);
            let placed = Placed::of_pose(&pose, checker.bodies[index].shape.geometry());
            (placed, Some(number))
        };
        let other = match other {
            Other::Body(other) => body(other),
            Other::Obstacle(other) => {
                let obstacle = &checker.obstacles[other as usize];
                (Placed::of_pose(&obstacle.pose, obstacle.shape.geometry()), None)
            }
        };
        [body(first), other]
    }
}

/// The result of [`Exact::quick_distance`]: the distance, which is `None` above the limit, or
/// unknown if a search of parts is needed.
pub(super) enum QuickDistance<N> {
    Known(Option<N>),
    Unknown,
}
