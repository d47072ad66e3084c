//! Manifolds of many parts merged: one for each flat patch, of few points.
//!
//! The manifolds of the parts of a composite lie side by side. Those with one normal in one plane
//! are pieces of one area of contact; of all their points those on its outline delimit it.

use core::ops::Range;

use smallvec::SmallVec;

use super::super::{ManifoldRequest, PairIds, RawPoint};
use super::frame::Candidate;
use super::reduce;
use crate::math::{Point, Real, Space, Vector, cross2, min};

/// Normals that differ by more than this, as vectors, are those of different patches; points that
/// lie farther from a plane than this part of their distance lie in different planes.
const SAME: f64 = 1.0 / 1024.0;

/// A manifold of two shapes one of which is a composite, in the frame of the first shape.
#[derive(Clone, Debug)]
pub(in crate::query) struct Patch<N: Real, const D: usize> {
    /// Unit, from the first shape to the second.
    pub(in crate::query) normal: Vector<N, D>,
    pub(in crate::query) points: SmallVec<[PatchPoint<N, D>; 4]>,
}

/// A point of a manifold, and the parts that it lies on.
#[derive(Clone, Copy, Debug)]
pub(in crate::query) struct PatchPoint<N: Real, const D: usize> {
    pub(in crate::query) raw: RawPoint<N, D>,
    pub(in crate::query) parts: [u32; 2],
}

/// The points of many pieces, one after the other.
pub(in crate::query) type Points<N, const D: usize> = SmallVec<[RawPoint<N, D>; 32]>;

/// What two parts contribute, in the frame of the first shape: some of the [`Points`].
#[derive(Clone, Debug)]
pub(in crate::query) struct Piece<N: Real, const D: usize> {
    /// Unit, from the first shape to the second.
    pub(in crate::query) normal: Vector<N, D>,
    pub(in crate::query) parts: [u32; 2],
    pub(in crate::query) points: Range<usize>,
}

/// What a merged manifold is made of and how.
pub(in crate::query) struct Merging<'a, N: Real, const D: usize> {
    pub(in crate::query) request: &'a ManifoldRequest<N>,
    /// Lengths below this are rounding errors.
    pub(in crate::query) tolerance: N,
    /// In the order of their parts, of which no two are the same.
    pub(in crate::query) pieces: &'a [Piece<N, D>],
    pub(in crate::query) points: &'a [RawPoint<N, D>],
}

/// The numbers that points inherit.
pub(super) type Kept = SmallVec<[Option<u32>; 32]>;

/// Merges the manifolds of parts into patches, which come in the order of their first parts, and
/// replaces those of the update before, whose points on features that are still touched hand on their
/// numbers.
///
/// The manifolds of parts may hold points beyond the prediction, of which those stay that turning
/// about the patch's nearest point brings near enough.
pub(in crate::query) fn merge<N: Space<D>, const D: usize>(
    merging: &Merging<'_, N, D>,
    patches: &mut Vec<Patch<N, D>>,
    ids: &mut PairIds,
) {
    let kept = merging.kept(patches);
    patches.clear();
    if let [piece] = merging.pieces
        && piece.points.len() == 1
    {
        return merging.push_alone(piece, (&kept, patches), ids);
    }
    let (layout, choosing) = (Layout::of(merging), Choosing { merging, kept: &kept });
    for group in &layout.groups {
        patches.push(choosing.patch(group, &layout, ids));
    }
}

impl<N: Real, const D: usize> Merging<'_, N, D> {
    /// Which points have the numbers of old ones: each old number goes to one point on its features,
    /// the nearest, the first of equals.
    pub(super) fn kept(&self, old: &[Patch<N, D>]) -> Kept {
        let mut kept = Kept::from_elem(None, self.points.len());
        let mut at = 0;
        for PatchPoint { raw, parts } in old.iter().flat_map(|patch| &patch.points) {
            // The points of one pair of parts come together, as a rule.
            if self.pieces.get(at).is_none_or(|piece| piece.parts != *parts) {
                let Ok(found) = self.pieces.binary_search_by(|piece| piece.parts.cmp(parts)) else {
                    continue;
                };
                at = found;
            }
            let (mut heir, mut nearest) = (None, N::INFINITY);
            for index in self.pieces[at].points.clone() {
                let new = &self.points[index];
                let is_heir = (new.feature1, new.feature2) == (raw.feature1, raw.feature2);
                if !is_heir || kept[index].is_some() {
                    continue;
                }
                let away = (new.point1 - raw.point1).norm_squared();
                if heir.is_none() || away < nearest {
                    (heir, nearest) = (Some(index), away);
                }
            }
            if let Some(heir) = heir {
                kept[heir] = Some(raw.id);
            }
        }
        kept
    }

    /// The only point of all is a patch, if it is near enough.
    fn push_alone(
        &self,
        piece: &Piece<N, D>,
        (kept, patches): (&Kept, &mut Vec<Patch<N, D>>),
        ids: &mut PairIds,
    ) {
        let only = piece.points.start;
        let mut raw = self.points[only];
        if raw.distance <= self.request.prediction {
            raw.id = kept[only].unwrap_or_else(|| ids.next());
            let mut points = SmallVec::new();
            points.push(PatchPoint { raw, parts: piece.parts });
            patches.push(Patch { normal: piece.normal, points });
        }
    }

    /// The index of the deepest point of a piece, by the order of [`by_depth`].
    pub(super) fn deepest_of(&self, piece: &Piece<N, D>) -> Option<usize> {
        let deeper = |best: usize, next: usize| {
            if by_depth(&self.points[next], &self.points[best]).is_lt() { next } else { best }
        };
        piece.points.clone().reduce(deeper)
    }
}

/// The pieces of one patch.
struct Group {
    /// The piece whose point is the deepest, and that point.
    lead: usize,
    deepest: usize,
    /// The first of the parts.
    first: [u32; 2],
}

/// Which pieces make which patches.
struct Layout {
    /// In the order of their first parts.
    groups: SmallVec<[Group; 8]>,
    /// Pieces and the leads of their groups, the deepest first.
    order: SmallVec<[(usize, usize); 16]>,
}

impl Layout {
    fn of<N: Real, const D: usize>(merging: &Merging<'_, N, D>) -> Self {
        let pieces = merging.pieces;
        let mut order: SmallVec<[(usize, usize); 16]> = SmallVec::new();
        for (index, piece) in pieces.iter().enumerate() {
            order.extend(merging.deepest_of(piece).map(|deepest| (index, deepest)));
        }
        order.sort_by(|a, b| {
            let by_value = by_depth(&merging.points[a.1], &merging.points[b.1]);
            by_value.then_with(|| pieces[a.0].parts.cmp(&pieces[b.0].parts))
        });
        let mut groups: SmallVec<[Group; 8]> = SmallVec::new();
        for (index, found) in &mut order {
            let (piece, deepest) = (&pieces[*index], *found);
            let is_level = |group: &&mut Group| {
                let leads = [group.deepest, deepest].map(|point| &merging.points[point]);
                let normals = [&pieces[group.lead].normal, &piece.normal];
                are_level(normals, leads, merging.tolerance)
            };
            *found = match groups.iter_mut().find(is_level) {
                Some(group) => {
                    group.first = group.first.min(piece.parts);
                    group.lead
                }
                None => {
                    groups.push(Group { lead: *index, deepest, first: piece.parts });
                    *index
                }
            };
        }
        groups.retain(|group| merging.points[group.deepest].distance <= merging.request.prediction);
        groups.sort_by_key(|group| group.first);
        Self { groups, order }
    }
}

/// Deepest first, then in the order of the features.
pub(super) fn by_depth<N: Real, const D: usize>(
    a: &RawPoint<N, D>,
    b: &RawPoint<N, D>,
) -> core::cmp::Ordering {
    let by_value = a.distance.as_f64().total_cmp(&b.distance.as_f64());
    by_value.then_with(|| (a.feature1, a.feature2).cmp(&(b.feature1, b.feature2)))
}

/// Two manifolds, of which the first is the deeper, have one normal and lie in one plane: that of
/// the points of the first shape or that of those of the second.
pub(super) fn are_level<N: Real, const D: usize>(
    normals: [&Vector<N, D>; 2],
    [lead1, lead2]: [&RawPoint<N, D>; 2],
    tolerance: N,
) -> bool {
    let same = N::lit(SAME);
    if (normals[0] - normals[1]).norm_squared() > same * same {
        return false;
    }
    let arm = lead2.point1 - lead1.point1;
    let room = same * arm.norm() + N::TWO * tolerance;
    let rise1 = normals[0].dot(&arm);
    let rise2 = rise1 + lead2.distance - lead1.distance;
    min(rise1.abs(), rise2.abs()) <= room
}

/// A point of a patch, seen along its normal.
#[derive(Clone, Copy)]
struct Member<N> {
    flat: Vector<N, 2>,
    /// The index of its piece, and its own.
    piece: usize,
    point: usize,
}

/// The points of a patch, or their indices.
type Members<N> = SmallVec<[Member<N>; 16]>;
type Indices = SmallVec<[usize; 16]>;

/// What the points of a patch are chosen by.
struct Choosing<'a, N: Real, const D: usize> {
    merging: &'a Merging<'a, N, D>,
    kept: &'a Kept,
}

impl<N: Space<D>, const D: usize> Choosing<'_, N, D> {
    /// A patch of at most as many points as are asked for: the deepest and, of the outline, those that
    /// span most.
    fn patch(&self, group: &Group, layout: &Layout, ids: &mut PairIds) -> Patch<N, D> {
        let normal = self.merging.pieces[group.lead].normal;
        let tangents = (N::tables().tangents)(&normal);
        let members = self.members(group, layout, &tangents);
        let (lowest, tolerance) =
            (self.merging.points[group.deepest].distance, self.merging.tolerance);
        let outline = self.outline(members, lowest + tolerance);
        let deepest = super::deepest_of(outline.len(), lowest + tolerance, |index| {
            (self.kept[outline[index].point].is_some(), self.distance(&outline[index]))
        });
        // In the plane two points delimit all there is.
        let is_line = tangents[1] == Vector::<N, D>::zeros();
        let most = self.merging.request.max_points.max(1);
        let limit = if is_line { most.min(2) } else { most };
        let chosen = self.chosen(&outline, deepest, limit);
        let mut named: SmallVec<[(u32, usize); 8]> = SmallVec::new();
        for index in chosen {
            named.push((self.kept[outline[index].point].unwrap_or_else(|| ids.next()), index));
        }
        named.sort_unstable();
        let mut points: SmallVec<[PatchPoint<N, D>; 4]> = SmallVec::new();
        for (id, index) in named {
            let Member { piece, point, .. } = outline[index];
            let mut raw = RawPoint { id, code: 0, ..self.merging.points[point] };
            if index == deepest {
                raw.distance = lowest;
            }
            points.push(PatchPoint { raw, parts: self.merging.pieces[piece].parts });
        }
        Patch { normal, points }
    }

    fn distance(&self, member: &Member<N>) -> N {
        self.merging.points[member.point].distance
    }

    /// The points of a group that the request asks for, the deepest first; that one always, also
    /// where its coordinates are no numbers.
    fn members(&self, group: &Group, layout: &Layout, tangents: &[Vector<N, D>; 2]) -> Members<N> {
        let Merging { request, pieces, points, .. } = *self.merging;
        let origin: Point<N, D> = points[group.deepest].point1;
        let mut members = Members::new();
        members.push(Member {
            flat: Vector::<N, 2>::zeros(),
            piece: group.lead,
            point: group.deepest,
        });
        for (piece, _) in layout.order.iter().filter(|(_, lead)| *lead == group.lead) {
            for point in pieces[*piece].points.clone().filter(|point| *point != group.deepest) {
                let arm = points[point].point1 - origin;
                let flat = Vector::<N, 2>::new(tangents[0].dot(&arm), tangents[1].dot(&arm));
                let is_turning = request.sine > N::ZERO;
                let reach = if is_turning { request.sine * flat.norm() } else { N::ZERO };
                if points[point].distance <= request.prediction + reach {
                    members.push(Member { flat, piece: *piece, point });
                }
            }
        }
        members
    }

    /// The points on the outline of all, each place once; and the deepest, if no point of the outline
    /// is at most `level`.
    fn outline(&self, members: Members<N>, level: N) -> Members<N> {
        let members = self.without_copies(members);
        let mut outline = chain(&members, 0..members.len());
        let back = chain(&members, (0..members.len()).rev());
        // Each chain ends where the other starts.
        outline.truncate(outline.len().saturating_sub(1).max(1));
        outline.extend_from_slice(&back[..back.len() - 1]);
        thin(&members, &mut outline, self.merging.tolerance);
        let depth = |index: usize| self.distance(&members[index]);
        if !outline.iter().any(|&index| depth(index) <= level) {
            let deeper = |best, next| if depth(next) < depth(best) { next } else { best };
            outline.extend((0..members.len()).reduce(deeper));
        }
        let mut corners = Members::new();
        for index in outline {
            corners.push(members[index]);
        }
        corners
    }

    /// The points sorted along the first tangent, then along the second; of points at one place, which
    /// the parts around it all have, one: one with a number, the deepest, or that of the first parts.
    fn without_copies(&self, mut members: Members<N>) -> Members<N> {
        let near = N::lit(4.0) * self.merging.tolerance;
        members.sort_by(by_place);
        // The first ones are those kept.
        let (mut count, mut is_exchanged) = (0, false);
        for next in 0..members.len() {
            let member = members[next];
            let flat = member.flat;
            // Sorted along the first tangent: only the last few can be at the same place.
            let in_reach = |at: &usize| flat.x - members[*at].flat.x <= N::TWO * near;
            let mut last = (0..count).rev().take_while(in_reach);
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
            // An exchange may have taken a point past its neighbours.
            members.sort_by(by_place);
        }
        members
    }

    fn is_better(&self, new: &Member<N>, old: &Member<N>) -> bool {
        let tolerance = self.merging.tolerance;
        let rank = |member: &Member<N>| {
            (self.kept[member.point].is_none(), self.merging.pieces[member.piece].parts)
        };
        let lower = self.distance(old) - self.distance(new);
        lower > tolerance || lower >= -tolerance && rank(new) < rank(old)
    }

    /// The indices of at most `limit` points of the outline.
    fn chosen(&self, outline: &Members<N>, deepest: usize, limit: usize) -> SmallVec<[usize; 8]> {
        if outline.len() <= limit {
            return (0..outline.len()).collect();
        }
        let mut candidates: SmallVec<[Candidate<N, D>; 16]> = SmallVec::new();
        for &Member { flat, point, .. } in outline {
            let RawPoint { point1, distance, feature1, feature2, .. } = self.merging.points[point];
            let (features, kept_id) = ([feature1, feature2], self.kept[point]);
            candidates.push(Candidate { point1, distance, flat, features, kept_id });
        }
        reduce::chosen(&candidates, deepest, limit, self.merging.tolerance)
    }
}

fn by_place<N: Real>(a: &Member<N>, b: &Member<N>) -> core::cmp::Ordering {
    let (a, b) = (&a.flat, &b.flat);
    a.x.as_f64().total_cmp(&b.x.as_f64()).then(a.y.as_f64().total_cmp(&b.y.as_f64()))
}

/// One side of the hull of sorted points, from the first to the last: every corner turns left.
///
/// Andrew, "Another Efficient Algorithm for Convex Hulls in Two Dimensions" (1979).
fn chain<N: Real>(members: &[Member<N>], order: impl Iterator<Item = usize>) -> Indices {
    let mut chain = Indices::new();
    for member in order {
        while let [.., before, last] = chain[..] {
            // Positive is left of the whole: inside.
            if beside(members, [before, last, member]) < N::ZERO {
                break;
            }
            chain.pop();
        }
        chain.push(member);
    }
    chain
}

/// Twice the area of a triangle; positive if the middle one lies left of the way from the first to the
/// last.
#[inline]
fn beside<N: Real>(members: &[Member<N>], [from, at, to]: [usize; 3]) -> N {
    let (from, at, to) = (members[from].flat, members[at].flat, members[to].flat);
    cross2(&(to - from), &(at - from))
}

/// Leaves out the corners of a convex polygon that lie, but for rounding, on the line between those
/// next to them.
fn thin<N: Real>(members: &[Member<N>], outline: &mut Indices, tolerance: N) {
    let mut at = 0;
    while outline.len() > 2 && at < outline.len() {
        let before = outline[if at == 0 { outline.len() - 1 } else { at - 1 }];
        let after = outline[if at + 1 == outline.len() { 0 } else { at + 1 }];
        let length = (members[after].flat - members[before].flat).norm();
        let area = beside(members, [before, outline[at], after]);
        if area.abs() <= tolerance * length {
            outline.remove(at);
        } else {
            at += 1;
        }
    }
}
