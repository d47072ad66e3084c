//! Chooses the few points of a patch: the points of its only piece, or the points on the outline of
//! all pieces.
//!
//! ```text
//!  gather: lists all points within the prediction, with coordinates along two tangents
//!  drop_copies: keeps one of several points within 4 tolerances of each other
//!  choose: keeps a deepest point, and the points that span the largest area
//!  points: assigns ids, and sets the distance of the deepest point exactly
//! ```
//!
//! Most patches have the few points of a single piece. All steps work in place, in lists that the
//! patches of a pair share.

use crate::tables::ByDimension;
use smallvec::SmallVec;

use super::super::{PairIds, RawPoint};
use super::patch::{KeptIds, Merging, PatchPoint};
use super::patch_groups::Lead;
use crate::collide::manifold::ids::in_order;
use crate::collide::manifold::raised::Nearer;
use crate::collide::manifold::reduce::{self, Projections, a_deepest, ordering, projected};
use crate::collide::manifold::{deepest_of, slack_level};
use crate::math::order::sort_few;
use crate::math::{Mapped, Real, Space, Vector};
use crate::shape::Geometry;

/// Number of points that fit into the lists without an allocation.
const FEW: usize = 16;

/// A point of a patch, projected along the normal of the patch.
#[derive(Clone, Copy)]
pub(super) struct Member<N> {
    /// Coordinates along both tangents, relative to the deepest point.
    flat: Vector<N, 2>,
    /// Index of the point's piece in `Merging::pieces`.
    piece: usize,
    /// Index of the point in `Merging::points`.
    point: usize,
}

/// The points of one patch.
pub(super) type Members<N> = SmallVec<[Member<N>; FEW]>;

/// Input for the choice of points: the pieces to merge, and the inherited ids of their points.
pub(super) struct Choosing<'a, N: Real, const D: usize> {
    pub(super) merging: &'a Merging<'a, N, D>,
    pub(super) kept: &'a KeptIds,
}

impl<N: Space<D>, const D: usize> Choosing<'_, N, D> {
    /// Fills a patch with at most `max_points` points of `pieces` (in 2D at most two): a deepest
    /// point, and the points that span the largest area. `lead` is the piece with the deepest
    /// point. `members` is scratch space.
    pub(super) fn fill(
        &self,
        lead: Lead,
        pieces: &[usize],
        members: &mut Members<N>,
        out: &mut SmallVec<[PatchPoint<N, D>; 4]>,
        ids: &mut PairIds,
    ) {
        let mut tangents = <N::Algorithms>::tangents(&self.merging.pieces[lead.piece].normal);
        let count = |piece: &usize| self.merging.pieces[*piece].points.len();
        if pieces.iter().map(count).sum::<usize>() > FEW {
            tangents = askew(&tangents);
        }
        self.gather(lead, pieces, &tangents, members);
        // In 2D, two points bound a manifold.
        let is_line = tangents[1] == Vector::<N, D>::zeros();
        let most = self.merging.request.max_points.max(1);
        let limit = if is_line { most.min(2) } else { most };
        let lowest = self.merging.points[lead.deepest].distance;
        let level = lowest + self.merging.tolerance;
        // If a single piece has few enough points, no choice is needed: they already span its area.
        if !(pieces.len() == 1 && members.len() <= limit) {
            self.drop_copies(members);
            self.choose(members, level, limit, is_line);
        }
        self.points(members, lowest, out, ids);
    }

    /// Keeps at most `limit` members, which span the largest area or, if `is_line`, are the ends of
    /// the line. At least one of them is a deepest member: its distance is at most `level`, or at
    /// most [`slack_level`] for a member that continues an old point.
    fn choose(&self, members: &mut Members<N>, level: N, limit: usize, is_line: bool) {
        if members.len() > limit && self.may_have_feet() {
            self.drop_raised(members, level);
        }
        let flattened =
            members.iter().map(|member| (member.flat, self.distance(member), self.is_old(member)));
        let tolerance = self.merging.tolerance;
        let slack = slack_level(level - tolerance, self.merging.size(), tolerance);
        let mut points = projected(flattened, [level, slack]);
        let indices = if is_line {
            keep_ends(&mut points);
            reduce::chosen(&mut points, limit, tolerance)
        } else {
            reduce::spanning(&mut points, limit, tolerance)
        };
        // `indices` ascend, so no member is overwritten before it is read.
        for (at, index) in indices.iter().enumerate() {
            members[at] = members[*index];
        }
        members.truncate(indices.len());
    }

    /// Returns whether points may lie steeply above nearer ones. A convex solid on a surface has its
    /// points on one face or edge.
    fn may_have_feet(&self) -> bool {
        let [first, second] = [self.merging.pair.first, self.merging.pair.second].mapped(Geometry);
        let surface = second.as_composite().and_then(|composite| composite.surface());
        first.as_support_map().is_none() || surface.is_none()
    }

    /// Drops the members beyond `level` that lie steeply above nearer ones ([`Nearer`]), such as the
    /// corners of a table's top above its feet.
    fn drop_raised(&self, members: &mut Members<N>, level: N) {
        let places = members.iter().map(|member| (member.flat, self.distance(member)));
        let nearer = Nearer::new(places, level, self.merging.request.sine);
        members.retain(|member| !nearer.is_below(&member.flat, self.distance(member)));
    }

    /// Appends the chosen points, sorted by id. The deepest old point (one that the last update
    /// had) gets exactly the distance `lowest` if its own distance exceeds `lowest` by at most the
    /// tolerance; otherwise the deepest point gets it.
    fn points(
        &self,
        chosen: &[Member<N>],
        lowest: N,
        out: &mut SmallVec<[PatchPoint<N, D>; 4]>,
        ids: &mut PairIds,
    ) {
        let level = lowest + self.merging.tolerance;
        let deepest = deepest_of(chosen.len(), level, |at| {
            (self.is_old(&chosen[at]), self.distance(&chosen[at]))
        });
        let new = chosen.iter().enumerate().filter(|(_, member)| self.kept[member.point].is_none());
        let position = |member: &Member<N>| self.merging.points[member.point].point1;
        let mut new_ids = SmallVec::<[u32; FEW]>::from_elem(0, chosen.len());
        for (_, at) in in_order(new.map(|(at, member)| (at, position(member)))) {
            new_ids[at] = ids.next();
        }
        for (index, &Member { piece, point, .. }) in chosen.iter().enumerate() {
            let id = self.kept[point].map_or(new_ids[index], |kept| kept.id);
            let mut raw = RawPoint { id, code: 0, ..self.merging.points[point] };
            if index == deepest {
                raw.distance = lowest;
            }
            let mut at = out.len();
            out.push(PatchPoint { raw, parts: self.merging.pieces[piece].parts });
            while at > 0 && out[at - 1].raw.id > id {
                out.swap(at - 1, at);
                at -= 1;
            }
        }
    }

    /// Returns whether the point continues a point of the last update that was near it.
    fn is_old(&self, member: &Member<N>) -> bool {
        self.kept[member.point].is_some_and(|kept| kept.is_old)
    }

    fn distance(&self, member: &Member<N>) -> N {
        self.merging.points[member.point].distance
    }

    /// Fills `members` with the deepest point, and then the other points within the prediction,
    /// enlarged by the distance by which the rotation of the request can bring a point nearer. The
    /// deepest point is always a member, even if its coordinates are NaN.
    fn gather(
        &self,
        Lead { piece: lead, deepest }: Lead,
        pieces: &[usize],
        tangents: &[Vector<N, D>; 2],
        members: &mut Members<N>,
    ) {
        let Merging { request, points, .. } = *self.merging;
        let origin = points[deepest].point1;
        members.clear();
        members.push(Member { flat: Vector::<N, 2>::zeros(), piece: lead, point: deepest });
        for &piece in pieces {
            for point in self.merging.pieces[piece].points.clone() {
                if point == deepest {
                    continue;
                }
                let arm = points[point].point1 - origin;
                let flat = Vector::<N, 2>::new(tangents[0].dot(&arm), tangents[1].dot(&arm));
                let is_turning = request.sine > N::ZERO;
                let swing = if is_turning { request.sine * flat.norm() } else { N::ZERO };
                if points[point].distance <= request.prediction + swing {
                    members.push(Member { flat, piece, point });
                }
            }
        }
    }

    /// Sorts the points along the first tangent, then along the second, and removes copies: all
    /// parts that meet at a point have a copy of this point. [`Self::is_better`] selects the copy
    /// that stays.
    fn drop_copies(&self, members: &mut Members<N>) {
        let near = N::lit(4.0) * self.merging.tolerance;
        sort(members);
        // The first `count` members are those kept.
        let (mut count, mut is_exchanged) = (0, false);
        for next in 0..members.len() {
            let member = members[next];
            let flat = member.flat;
            // The points are sorted along the first tangent, so only the last few can be at the
            // position of the next.
            let is_close = |at: &usize| flat.x - members[*at].flat.x <= N::TWO * near;
            let mut last = (0..count).rev().take_while(is_close);
            match last.find(|&at| (members[at].flat - flat).norm_squared() <= near * near) {
                Some(at) if self.is_better(&member, &members[at]) => {
                    (members[at], is_exchanged) = (member, true);
                }
                Some(_) => {}
                None => {
                    members[count] = member;
                    count += 1;
                }
            }
        }
        members.truncate(count);
        if is_exchanged {
            // An exchange may break the order.
            sort(members);
        }
    }

    /// Returns whether `new` replaces `old` at one position: the deeper point if the depths differ
    /// by more than the tolerance, else the point with an inherited id, else the point with the
    /// smaller pair of parts.
    fn is_better(&self, new: &Member<N>, old: &Member<N>) -> bool {
        let tolerance = self.merging.tolerance;
        let rank = |member: &Member<N>| {
            (self.kept[member.point].is_none(), self.merging.pieces[member.piece].parts)
        };
        let lower = self.distance(old) - self.distance(new);
        lower > tolerance || lower >= -tolerance && rank(new) < rank(old)
    }
}

/// Keeps the two ends of a line of sorted points, the points that continue old points and, if
/// neither end is marked as deepest, one deepest point.
fn keep_ends<N: Real>(points: &mut Projections<N>) {
    let (last, deepest) = (points.len() - 1, a_deepest(points));
    let is_inner = !(points[0].is_deepest || points[last].is_deepest);
    points.retain(|point| {
        let is_end = point.index == 0 || point.index == last;
        is_end || point.is_kept || is_inner && point.index == deepest
    });
}

/// Rotates the tangents by one radian, so that few points of an axis-aligned grid have equal
/// coordinates along the first tangent.
fn askew<N: Real, const D: usize>([first, second]: &[Vector<N, D>; 2]) -> [Vector<N, D>; 2] {
    let [cosine, sine] = [0.540_302_305_868_139_7, 0.841_470_984_807_896_5].map(N::lit);
    // In 2D the second tangent is zero.
    if *second == Vector::<N, D>::zeros() {
        return [*first, *second];
    }
    [first * cosine + second * sine, second * cosine - first * sine]
}

/// Sorts points along the first tangent, then along the second; stable.
#[inline]
fn sort<N: Real>(members: &mut [Member<N>]) {
    if members.len() > FEW {
        return members.sort_by(by_position);
    }
    sort_few(members, |one, other| by_position(one, other).is_lt());
}

/// Orders points by the coordinate along the first tangent, then by that along the second.
#[inline]
fn by_position<N: Real>(a: &Member<N>, b: &Member<N>) -> core::cmp::Ordering {
    let (a, b) = (&a.flat, &b.flat);
    ordering(a.x, b.x).then_with(|| ordering(a.y, b.y))
}
