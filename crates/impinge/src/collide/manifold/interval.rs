//! Contacts of two flat-sided 2D solids: the ends of the overlap interval of their supporting
//! sides.
//!
//! This module computes the contacts of segments, capsules, triangles, boxes, polygons and rounded
//! solids. It also handles other support maps whose supporting feature is a side or a corner, with
//! a radius around it. Boxes, segments and capsules also have kernels of their own
//! (`collide/batch/`). A position along the tangent is one coordinate:
//!
//! ```text
//!          from ─────────────── to          the second solid's side
//!           │                   ┊
//!   from ───┼──────────── to    ┊           the first solid's
//!           │              │
//!           └─── overlap ──┘  ───────────→  the line of contact
//! ```
//!
//! The contacts are the ends of the overlap interval that the request admits, including by rotation
//! ([`ContactFrame::admit`]). The witness (the nearest points) is added if no admitted end has its
//! distance, up to rounding.

use super::frame::{Candidates, ContactFrame, MIN_COSINE, Which, lifted, part_beside};
use super::{Pair, RawManifold, add_witness, choose_in_frame};
use crate::math::{Point, Pose, Real, Vector, max, max_component, min};
use crate::shape::{FeatureId, Geometry, Kind, Segment, SideOrVertex, SupportMap};

/// Builds the manifold of two solids within the prediction, neither of them a ball or a half-space.
/// Returns `false` if a supporting feature is neither a side nor a corner.
pub(super) fn build<N: Real>(
    pair: &Pair<'_, N, 2>,
    frame: &ContactFrame<N, 2>,
    limit: usize,
    out: &mut RawManifold<N, 2>,
) -> bool {
    let first = FeatureInterval::of(Which::First, pair.first, None, frame);
    let second = FeatureInterval::of(Which::Second, pair.second, Some(&pair.pose12), frame);
    let (Some(first), Some(second)) = (first, second) else { return false };
    let mut candidates = Candidates::new();
    if first.is_side && second.is_side {
        Shared { frame, first: &first, second: &second }.candidates(&mut candidates);
    }
    let level = frame.witness.distance + frame.tolerance;
    if !candidates.iter().any(|candidate| candidate.distance <= level) {
        let parts = [first.at_witness(frame), second.at_witness(frame)];
        add_witness(&frame.witness, parts, &mut candidates);
    }
    choose_in_frame(pair, frame, &mut candidates, limit, out);
    true
}

/// An end of a side, or a corner.
#[derive(Clone, Copy)]
pub(super) struct Corner<N: Real, const D: usize> {
    /// Position in the frame of the first solid.
    pub(super) point: Point<N, D>,
    /// Coordinates along the tangents; the second is zero in 2D.
    pub(super) flat: Vector<N, 2>,
    pub(super) id: FeatureId,
}

/// Supporting feature of a 2D solid: a side or a corner, projected onto the tangent.
pub(super) struct FeatureInterval<N: Real> {
    which: Which,
    id: FeatureId,
    /// Ends of the side; for a corner only the first is used.
    pub(super) corners: [Corner<N, 2>; 2],
    /// Whether the feature is a side; otherwise it is the corner `corners[0]`.
    pub(super) is_side: bool,
    /// Radius around the feature.
    rounding: N,
    /// Cosine of the angle between the side and the tangent; 1 for a corner.
    cosine: N,
    /// Difference of the tangent coordinates of the second and the first corner; zero for a corner.
    along: N,
    /// Magnitude of `along`.
    length: N,
    /// Only for a solid with a radius: depth, below the supporting line, of the corner nearest to
    /// the other solid, and the tangent coordinates of that corner.
    top: (N, Vector<N, 2>),
}

impl<N: Real> FeatureInterval<N> {
    /// Returns the supporting feature of a solid at `pose` in the frame of the first solid; `None`
    /// if the feature is neither a side nor a corner.
    #[inline(always)]
    pub(super) fn of(
        which: Which,
        kind: Kind<'_, N, 2>,
        pose: Option<&Pose<N, 2>>,
        frame: &ContactFrame<N, 2>,
    ) -> Option<Self> {
        let outward = which.outward(frame);
        let direction = pose.map_or(outward, |pose| pose.inverse_vector(&outward));
        let supporting = SideOrVertex::of(kind, &direction)?;
        Some(Self::placed(which, &supporting, rounding(kind), pose, frame))
    }

    /// Returns the supporting feature of a segment that is the first solid.
    #[inline]
    pub(super) fn of_segment(segment: &Segment<N, 2>, frame: &ContactFrame<N, 2>) -> Self {
        Self::placed(Which::First, &SideOrVertex::of_segment(segment), N::ZERO, None, frame)
    }

    /// Transforms a feature into the frame of the first solid, and reduces it to a corner if
    /// needed.
    #[inline(always)]
    fn placed(
        which: Which,
        supporting: &SideOrVertex<N>,
        rounding: N,
        pose: Option<&Pose<N, 2>>,
        frame: &ContactFrame<N, 2>,
    ) -> Self {
        let corner = |(id, vertex): (FeatureId, Point<N, 2>)| {
            let point = pose.map_or(vertex, |pose| placed(pose, &vertex));
            Corner { point, flat: frame.flat(&point), id }
        };
        let mut interval = Self {
            which,
            id: supporting.id,
            corners: [corner(supporting.ends[0]), corner(supporting.ends[1])],
            is_side: supporting.is_side,
            rounding,
            cosine: N::ONE,
            along: N::ZERO,
            length: N::ZERO,
            top: (N::ZERO, Vector::<N, 2>::zeros()),
        };
        interval.simplify(&which.outward(frame), frame.tolerance);
        if interval.rounding > N::ZERO {
            interval.find_top(frame);
        }
        interval
    }

    /// Reduces a side to a corner if needed. A side without length becomes its first corner, with
    /// the id of the side. A side that lies along the normal or is tilted by more than 60° becomes
    /// its corner nearest to the other solid.
    #[inline(always)]
    fn simplify(&mut self, outward: &Vector<N, 2>, tolerance: N) {
        let [from, to] = &self.corners;
        // Whether the side has a length in projection. A side along the normal has none, but it is
        // still a side: the code below reduces it to its corner nearest to the other solid.
        let is_long = max_component(&(from.flat - to.flat)) > tolerance;
        self.is_side &= is_long || max_component(&(from.point - to.point)) > tolerance;
        if !self.is_side {
            return;
        }
        let flat = to.flat - from.flat;
        (self.along, self.length) = (flat.x, flat.norm());
        self.cosine = self.length / (to.point - from.point).norm();
        if !is_long || self.cosine < N::lit(MIN_COSINE) {
            let at = |corner: &Corner<N, 2>| corner.point.coords.dot(outward);
            let farthest = if at(to) > at(from) { *to } else { *from };
            (self.id, self.corners, self.is_side) = (farthest.id, [farthest; 2], false);
            self.cosine = N::ONE;
        }
    }

    /// Sets `top`: finds the corner nearest to the other solid, and its depth.
    fn find_top(&mut self, frame: &ContactFrame<N, 2>) {
        let [first, second] = &self.corners;
        let depth = self.which.below_witness(&first.point, frame);
        self.top = (depth, first.flat);
        if self.is_side {
            let other = self.which.below_witness(&second.point, frame);
            if other < depth {
                self.top = (other, second.flat);
            }
        }
    }

    /// Returns the id of the part that the nearest point lies on: an end within twice the
    /// tolerance, else the feature itself.
    pub(super) fn at_witness(&self, frame: &ContactFrame<N, 2>) -> FeatureId {
        let near = |corner: &Corner<N, 2>| corner.flat.norm() <= N::TWO * frame.tolerance;
        match &self.corners {
            [from, _] if self.is_side && near(from) => from.id,
            [_, to] if self.is_side && near(to) => to.id,
            _ => self.id,
        }
    }

    /// Returns the point of the side at a tangent coordinate, clamped to its ends.
    #[inline(always)]
    pub(super) fn under(&self, coordinate: N) -> Point<N, 2> {
        let [from, to] = &self.corners;
        // `along` is negative if the side runs against the tangent.
        let share = (coordinate - from.flat.x) * self.along / (self.along * self.along);
        from.point + (to.point - from.point) * min(max(share, N::ZERO), N::ONE)
    }

    /// Returns the part at a tangent coordinate: an end within twice the tolerance, measured along
    /// the tangent, or the side; `None` farther beyond the ends.
    #[inline(always)]
    fn beside(&self, coordinate: N, tolerance: N) -> Option<FeatureId> {
        let along = (coordinate - self.corners[0].flat.x) * self.along / self.length;
        let tolerance = N::TWO * tolerance;
        let [from, to] = &self.corners;
        part_beside(along, self.length, tolerance, [from.id, to.id], self.id)
    }

    /// Returns the part that contains a tangent coordinate: an end within twice the tolerance,
    /// measured along the tangent, or the side; `None` beyond the ends.
    pub(super) fn locate(&self, coordinate: N, tolerance: N) -> Option<FeatureId> {
        let [from, to] = &self.corners;
        let near = |corner: &Corner<N, 2>| (corner.flat.x - coordinate).abs() <= N::TWO * tolerance;
        if near(from) || near(to) {
            return Some(if near(from) { from.id } else { to.id });
        }
        let along = (coordinate - from.flat.x) * self.along;
        (along >= N::ZERO && along <= self.length * self.length).then_some(self.id)
    }

    /// Returns the height of the rounded surface above a point of the core, along the normal.
    #[inline]
    fn lift(&self, core: &Point<N, 2>, frame: &ContactFrame<N, 2>) -> N {
        if self.rounding <= N::ZERO {
            return N::ZERO;
        }
        let depth = self.which.below_witness(core, frame);
        let (radius, away) = (self.rounding, frame.flat(core) - self.top.1);
        lifted(radius, self.cosine, depth, self.top.0, away.norm_squared())
    }
}

/// Transforms a point as [`Pose::point`] does, written out because products of small matrices are
/// not inlined.
#[inline(always)]
fn placed<N: Real>(pose: &Pose<N, 2>, local: &Point<N, 2>) -> Point<N, 2> {
    let (turn, shift) = (&pose.rotation, &pose.translation);
    let x = turn[(0, 0)] * local.x + turn[(0, 1)] * local.y + shift.x;
    let y = turn[(1, 0)] * local.x + turn[(1, 1)] * local.y + shift.y;
    Point::<N, 2>::new(x, y)
}

/// Returns the radius around the core of a solid.
#[inline]
fn rounding<N: Real>(kind: Kind<'_, N, 2>) -> N {
    match kind {
        Kind::Segment(_) | Kind::Triangle(_) | Kind::Cuboid(_) | Kind::Polytope(_) => N::ZERO,
        Kind::Capsule(capsule) => capsule.radius(),
        other => Geometry(other).as_support_map().map_or(N::ZERO, SupportMap::rounding),
    }
}

/// Two supporting features in one frame.
pub(super) struct Shared<'a, N: Real> {
    pub(super) frame: &'a ContactFrame<N, 2>,
    pub(super) first: &'a FeatureInterval<N>,
    pub(super) second: &'a FeatureInterval<N>,
}

impl<N: Real> Shared<'_, N> {
    /// Adds the ends of the overlap interval. Each is an end of one side, paired with the point of
    /// the other side at the same coordinate.
    pub(super) fn candidates(&self, out: &mut Candidates<N, 2>) {
        for corner in &self.first.corners {
            if let Some(on) = self.second.beside(corner.flat.x, self.frame.tolerance) {
                let under = self.second.under(corner.flat.x);
                self.push(&corner.point, &under, [corner.id, on], out);
            }
        }
        for corner in &self.second.corners {
            if let Some(on) = self.first.beside(corner.flat.x, self.frame.tolerance) {
                let under = self.first.under(corner.flat.x);
                self.push(&under, &corner.point, [on, corner.id], out);
            }
        }
    }

    /// Adds a contact if the request admits it and it is no duplicate. The two points of the cores
    /// are first moved halfway towards each other along the tangent, so that they face each other
    /// along the normal.
    fn push(
        &self,
        core1: &Point<N, 2>,
        core2: &Point<N, 2>,
        features: [FeatureId; 2],
        out: &mut Candidates<N, 2>,
    ) {
        let (gap, normal) = (core2 - core1, self.frame.normal());
        let half = (gap - normal * normal.dot(&gap)) * N::HALF;
        self.push_pair(&(core1 + half), &(core2 - half), features, out);
    }

    /// Adds the contact of two points of the cores that face each other along the normal, if the
    /// request admits it and it is no duplicate.
    pub(super) fn push_pair(
        &self,
        core1: &Point<N, 2>,
        core2: &Point<N, 2>,
        features: [FeatureId; 2],
        out: &mut Candidates<N, 2>,
    ) {
        let normal = self.frame.normal();
        let lift1 = self.first.lift(core1, self.frame);
        let lift2 = self.second.lift(core2, self.frame);
        let distance = normal.dot(&(core2 - core1)) - lift1 - lift2;
        self.frame.push_new(core1 + normal * lift1, distance, features, out);
    }
}
