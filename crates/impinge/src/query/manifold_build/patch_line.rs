//! Manifolds of parts of the plane merged: patches are stretches of lines, of one or two points.
//!
//! The same as [`merge`](super::merge), which defines it, bit for bit: seen along the normal all points lie in
//! a row, so that the outline of a patch is its first and its last point.

use core::ops::Range;

use smallvec::SmallVec;

use super::patch::{
    Kept, Merging, Patch, PatchPoint, Piece, are_level, blank, by_depth, merge, merge_one,
};
use super::reduce::{Indices, a_deepest, chosen, projected};
use super::{deepest_of, tangents2};
use crate::math::{Real, Vector};
use crate::query::{PairIds, RawPoint};

/// As many pieces and points are merged here; more are left to the general way.
const MAX_PIECES: usize = 8;
const MAX_POINTS: usize = 12;

/// [`merge`](super::merge) in 2D; many pieces are left to it.
pub(in crate::query) fn merge_in_plane<N: Real>(
    merging: &Merging<'_, N, 2>,
    patches: &mut Vec<Patch<N, 2>>,
    ids: &mut PairIds,
) {
    let (pieces, points) = (merging.pieces.len(), merging.points.len());
    if pieces > MAX_PIECES || points > MAX_POINTS {
        return merge(merging, patches, ids);
    }
    let count = match merging.pieces {
        [] => 0,
        [piece] if piece.points.len() == 1 => merge_one(merging, piece, (patches, ids)),
        _ => merge_some(merging, (patches, ids)),
    };
    patches.truncate(count);
}

/// Merges some pieces; answers how many patches there are.
fn merge_some<N: Real>(
    merging: &Merging<'_, N, 2>,
    (patches, ids): (&mut Vec<Patch<N, 2>>, &mut PairIds),
) -> usize {
    let kept = merging.kept(patches);
    let row = Row { merging, kept: &kept };
    let mut order = [Placed { piece: 0, deepest: 0, group: 0 }; MAX_PIECES];
    let count = row.order(&mut order);
    let mut groups = [Group { lead: 0, first: [0; 2], count: 0 }; MAX_PIECES];
    let of_groups = row.group(&mut order[..count], &mut groups);
    let (order, groups) = (&order[..count], &mut groups[..of_groups]);
    groups.sort_unstable_by_key(|group| group.first);
    let mut made = 0;
    for group in groups.iter() {
        let lead = order[group.lead];
        if merging.points[lead.deepest].distance <= merging.request.prediction {
            let points = blank(patches, made, merging.pieces[lead.piece].normal);
            if !(group.count == 1 && row.fill_from_few(lead, (&mut *points, &mut *ids))) {
                row.fill_patch(lead, order, (points, ids));
            }
            made += 1;
        }
    }
    made
}

/// A piece, its deepest point and its group.
#[derive(Clone, Copy)]
struct Placed {
    piece: usize,
    deepest: usize,
    group: usize,
}

/// The pieces of one patch.
#[derive(Clone, Copy)]
struct Group {
    /// The piece with the deepest point: its place in the order.
    lead: usize,
    /// The first of the parts.
    first: [u32; 2],
    /// How many there are.
    count: u32,
}

/// A point of a patch, seen along its normal.
#[derive(Clone, Copy)]
struct Member<N: Real> {
    flat: Vector<N, 2>,
    piece: usize,
    point: usize,
}

/// What patches are made of.
struct Row<'a, N: Real> {
    merging: &'a Merging<'a, N, 2>,
    kept: &'a Kept,
}

impl<N: Real> Row<'_, N> {
    /// The pieces with points, the deepest first; answers how many.
    fn order(&self, order: &mut [Placed; MAX_PIECES]) -> usize {
        let Merging { pieces, points, .. } = *self.merging;
        let mut count = 0;
        for (index, piece) in pieces.iter().enumerate() {
            let Some(deepest) = self.merging.deepest_of(piece) else { continue };
            // Pieces come in the order of their parts, so that equal ones stay as they are.
            let mut at = count;
            while at > 0 && by_depth(&points[deepest], &points[order[at - 1].deepest]).is_lt() {
                order[at] = order[at - 1];
                at -= 1;
            }
            order[at] = Placed { piece: index, deepest, group: 0 };
            count += 1;
        }
        count
    }

    /// Puts each piece to the first group that it lies level with; answers how many there are.
    fn group(&self, order: &mut [Placed], groups: &mut [Group; MAX_PIECES]) -> usize {
        let Merging { pieces, points, tolerance, .. } = *self.merging;
        let mut count = 0;
        for at in 0..order.len() {
            let Placed { piece, deepest, .. } = order[at];
            let own = &pieces[piece];
            let mut group = 0;
            while group < count {
                let lead = order[groups[group].lead];
                let normals = [&pieces[lead.piece].normal, &own.normal];
                let leads = [&points[lead.deepest], &points[deepest]];
                if are_level(normals, leads, tolerance) {
                    break;
                }
                group += 1;
            }
            if group == count {
                groups[group] = Group { lead: at, first: own.parts, count: 0 };
                count += 1;
            }
            groups[group].count += 1;
            groups[group].first = groups[group].first.min(own.parts);
            order[at].group = group;
        }
        count
    }

    /// [`Self::fill_patch`] for a group of one piece of one or two points, of which nothing is left out; answers
    /// whether it is that.
    fn fill_from_few(
        &self,
        lead: Placed,
        (out, ids): (&mut SmallVec<[PatchPoint<N, 2>; 4]>, &mut PairIds),
    ) -> bool {
        let Merging { request, pieces, points, tolerance } = *self.merging;
        let Piece { normal, parts, points: Range { start, end } } = pieces[lead.piece];
        let lowest = points[lead.deepest].distance;
        if end - start == 1 {
            out.push(self.patch_point(lead.deepest, lowest, (parts, ids)));
            return true;
        }
        let other = if lead.deepest == start { start + 1 } else { start };
        let arm = points[other].point1 - points[lead.deepest].point1;
        let tangents = tangents2(&normal);
        let flat = Vector::<N, 2>::new(tangents[0].dot(&arm), tangents[1].dot(&arm));
        let reach = if request.sine > N::ZERO { request.sine * flat.norm() } else { N::ZERO };
        let is_near = points[other].distance <= request.prediction + reach;
        let is_apart = flat.x.abs() > N::lit(8.0) * tolerance;
        if end - start > 2 || request.max_points < 2 || !(is_near && is_apart) {
            return false;
        }
        let row = if flat.x < N::ZERO { [other, lead.deepest] } else { [lead.deepest, other] };
        let what = |index: usize| (self.kept[row[index]].is_some(), points[row[index]].distance);
        let deepest = row[deepest_of(2, lowest + tolerance, what)];
        for point in row {
            let distance = if point == deepest { lowest } else { points[point].distance };
            out.push(self.patch_point(point, distance, (parts, &mut *ids)));
        }
        if out[0].raw.id > out[1].raw.id {
            out.swap(0, 1);
        }
        true
    }

    /// A point with its number, or the next one.
    #[inline]
    fn patch_point(
        &self,
        point: usize,
        distance: N,
        (parts, ids): ([u32; 2], &mut PairIds),
    ) -> PatchPoint<N, 2> {
        let id = self.kept[point].unwrap_or_else(|| ids.next());
        let raw = RawPoint { id, code: 0, distance, ..self.merging.points[point] };
        PatchPoint { raw, parts }
    }

    /// Fills the patch of a group: its deepest point and, of the two ends, those that span most.
    fn fill_patch(
        &self,
        lead: Placed,
        order: &[Placed],
        (out, ids): (&mut SmallVec<[PatchPoint<N, 2>; 4]>, &mut PairIds),
    ) {
        let flat = Vector::<N, 2>::zeros();
        let mut members = [Member { flat, piece: lead.piece, point: lead.deepest }; MAX_POINTS];
        let count = self.members(lead, order, &mut members);
        let count = self.without_copies(&mut members[..count]);
        let lowest = self.merging.points[lead.deepest].distance;
        let level = lowest + self.merging.tolerance;
        let members = &members[..count];
        let chosen = self.chosen(members, level);
        let deepest = deepest_of(chosen.len(), level, |at| {
            let member = &members[chosen[at]];
            (self.kept[member.point].is_some(), self.distance(member))
        });
        for (place, &index) in chosen.iter().enumerate() {
            let Member { piece, point, .. } = members[index];
            let id = self.kept[point].unwrap_or_else(|| ids.next());
            let mut raw = RawPoint { id, code: 0, ..self.merging.points[point] };
            if place == deepest {
                raw.distance = lowest;
            }
            out.push(PatchPoint { raw, parts: self.merging.pieces[piece].parts });
        }
        if let [first, second] = out.as_mut_slice()
            && first.raw.id > second.raw.id
        {
            core::mem::swap(first, second);
        }
    }

    fn distance(&self, member: &Member<N>) -> N {
        self.merging.points[member.point].distance
    }

    /// The points of a group that the request asks for, the deepest first; answers how many.
    fn members(
        &self,
        lead: Placed,
        order: &[Placed],
        members: &mut [Member<N>; MAX_POINTS],
    ) -> usize {
        let Merging { request, pieces, points, .. } = *self.merging;
        let tangents = tangents2(&pieces[lead.piece].normal);
        let origin = points[lead.deepest].point1;
        // The first is the deepest already.
        let mut count = 1;
        for placed in order.iter().filter(|placed| placed.group == lead.group) {
            for point in pieces[placed.piece].points.clone() {
                if point == lead.deepest {
                    continue;
                }
                let arm = points[point].point1 - origin;
                let flat = Vector::<N, 2>::new(tangents[0].dot(&arm), tangents[1].dot(&arm));
                let is_turning = request.sine > N::ZERO;
                let reach = if is_turning { request.sine * flat.norm() } else { N::ZERO };
                if points[point].distance <= request.prediction + reach {
                    members[count] = Member { flat, piece: placed.piece, point };
                    count += 1;
                }
            }
        }
        count
    }

    /// Sorts the points along the line, and keeps one of those at one place; answers how many are left.
    fn without_copies(&self, members: &mut [Member<N>]) -> usize {
        let near = N::lit(4.0) * self.merging.tolerance;
        sort(members);
        let (mut count, mut is_exchanged) = (0, false);
        for next in 0..members.len() {
            let member = members[next];
            let mut at = count;
            let mut is_copy = false;
            while at > 0 && !is_copy && member.flat.x - members[at - 1].flat.x <= N::TWO * near {
                at -= 1;
                is_copy = (members[at].flat - member.flat).norm_squared() <= near * near;
            }
            if !is_copy {
                members[count] = member;
                count += 1;
            } else if self.is_better(&member, &members[at]) {
                (members[at], is_exchanged) = (member, true);
            }
        }
        if is_exchanged {
            // An exchange may have taken a point past its neighbours.
            sort(&mut members[..count]);
        }
        count
    }

    fn is_better(&self, new: &Member<N>, old: &Member<N>) -> bool {
        let tolerance = self.merging.tolerance;
        let rank = |member: &Member<N>| {
            (self.kept[member.point].is_none(), self.merging.pieces[member.piece].parts)
        };
        let lower = self.distance(old) - self.distance(new);
        lower > tolerance || lower >= -tolerance && rank(new) < rank(old)
    }

    /// The indices of at most as many members as are asked for, one of the deepest among them: of the two ends
    /// and, if neither is as deep, of a deepest one.
    fn chosen(&self, members: &[Member<N>], level: N) -> Indices {
        let limit = self.merging.request.max_points.clamp(1, 2);
        let last = members.len() - 1;
        if last < limit {
            return (0..=last).collect();
        }
        let seen = members
            .iter()
            .map(|member| (member.flat, self.distance(member), self.kept[member.point].is_some()));
        let mut points = projected(seen, level);
        let deepest = a_deepest(&points);
        let is_inner = !(points[0].is_deepest || points[last].is_deepest);
        points.retain(|point| {
            point.index == 0 || point.index == last || is_inner && point.index == deepest
        });
        chosen(&mut points, limit, self.merging.tolerance)
    }
}

/// Sorts few points along the line; equal ones stay as they are.
fn sort<N: Real>(members: &mut [Member<N>]) {
    let is_after = |a: &Member<N>, b: &Member<N>| {
        let by_x = a.flat.x.as_f64().total_cmp(&b.flat.x.as_f64());
        by_x.then(a.flat.y.as_f64().total_cmp(&b.flat.y.as_f64())).is_gt()
    };
    for next in 1..members.len() {
        let mut at = next;
        while at > 0 && is_after(&members[at - 1], &members[at]) {
            members.swap(at - 1, at);
            at -= 1;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Point;
    use crate::query::ManifoldRequest;
    use crate::query::separation::hulls::tests::Random;
    use crate::shape::FeatureId;

    /// Points of a piece: one to three, some of them at one place or beyond reach.
    fn points(random: &mut Random, count: u32) -> Vec<RawPoint<f64, 2>> {
        let point = |feature: u32| {
            let at = random.vector::<f64>();
            let x = if at.z > 0.6 { 0.25 } else { at.x };
            RawPoint {
                point1: Point::<f64, 2>::new(x, 1e-4 * at.y),
                distance: 0.06 * at.y,
                feature1: FeatureId::Vertex(feature),
                feature2: FeatureId::Edge(0),
                id: 0,
                code: 0,
            }
        };
        (0..count).map(point).collect()
    }

    /// Over several updates, as names are handed on, with few points and with several pieces of one patch.
    #[test]
    fn rows_are_merged_as_all_points_are() {
        let random = &mut Random(5);
        let (mut ways, mut both) = ([Vec::new(), Vec::new()], 0);
        let mut ids = [PairIds::default(), PairIds::default()];
        for round in 0..4000_u32 {
            let (mut all, mut pieces) = (Vec::new(), Vec::new());
            for part in 0..=round % 3 {
                let lean = if round % 5 == 0 { 0.0 } else { 0.2 * f64::from(part) };
                let normal = Vector::<f64, 2>::new(lean, 1.0).normalize();
                let own = points(random, 1 + (round / 3 + part) % 3);
                pieces.push(Piece {
                    normal,
                    parts: [0, part],
                    points: all.len()..all.len() + own.len(),
                });
                all.extend(own);
            }
            let (sine, max_points) =
                (f64::from(round % 2) * 0.02, [2, 1, 4][round as usize % 7 % 3]);
            let request = ManifoldRequest { prediction: 0.03, sine, max_points };
            let merging =
                Merging { request: &request, tolerance: 1e-12, pieces: &pieces, points: &all };
            merge(&merging, &mut ways[0], &mut ids[0]);
            merge_in_plane(&merging, &mut ways[1], &mut ids[1]);
            let [expected, found] = [format!("{:?}", ways[0]), format!("{:?}", ways[1])];
            assert_eq!(found, expected, "in round {round}");
            both += ways[1].iter().filter(|patch| patch.points.len() == 2).count();
        }
        assert!(both > 1000, "{both} patches of two points");
    }
}
