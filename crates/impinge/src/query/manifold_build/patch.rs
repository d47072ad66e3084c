//! Manifolds of many parts merged: one for each flat patch, of few points.
//!
//! The manifolds of the parts of a composite lie side by side. Those with one normal in one plane
//! are pieces of one area of contact; of all their points those on its outline delimit it.

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

impl<N: Real, const D: usize> PatchPoint<N, D> {
    /// What a contact is known by from one update to the next.
    fn name(&self) -> Name {
        (self.parts, [self.raw.feature1, self.raw.feature2])
    }
}

type Name = ([u32; 2], [crate::shape::FeatureId; 2]);

/// What a merged manifold is made of and how.
pub(in crate::query) struct Merging<'a, N: Real, const D: usize> {
    pub(in crate::query) request: &'a ManifoldRequest<N>,
    /// Lengths below this are rounding errors.
    pub(in crate::query) tolerance: N,
    /// The patches of the update before, whose points hand on their numbers.
    pub(in crate::query) old: &'a [Patch<N, D>],
}

/// Merges the manifolds of parts into patches, which come in the order of their first parts; points
/// on features that were touched before keep their numbers.
///
/// The manifolds of parts may hold points beyond the prediction, of which those stay that turning
/// about the patch's nearest point brings near enough.
pub(in crate::query) fn merge<N: Space<D>, const D: usize>(
    mut pieces: Vec<Patch<N, D>>,
    merging: &Merging<'_, N, D>,
    ids: &mut PairIds,
) -> Vec<Patch<N, D>> {
    if let [Patch { points, .. }] = pieces.as_mut_slice()
        && let [point] = points.as_mut_slice()
    {
        keep_alone(point, merging, ids);
        pieces.retain(|piece| piece.points[0].raw.distance <= merging.request.prediction);
        return pieces;
    }
    for piece in &mut pieces {
        piece.points.sort_by(|a, b| by_depth(a, b));
    }
    pieces.retain(|piece| !piece.points.is_empty());
    pieces.sort_by(|a, b| by_depth(&a.points[0], &b.points[0]));
    let mut patches: Vec<Patch<N, D>> = Vec::new();
    for piece in pieces {
        match patches.iter_mut().find(|patch| are_level(patch, &piece, merging.tolerance)) {
            Some(patch) => patch.points.extend(piece.points),
            None => patches.push(piece),
        }
    }
    patches.retain(|patch| patch.points[0].raw.distance <= merging.request.prediction);
    let first = |patch: &Patch<N, D>| patch.points.iter().map(|point| point.parts).min();
    patches.sort_by_key(first);
    let mut heirs = Heirs::of(merging.old, &patches);
    for (index, patch) in patches.iter_mut().enumerate() {
        reduce_patch(patch, heirs.of_patch(index), merging, ids);
    }
    patches
}

/// Numbers the only point of all, if it is near enough.
fn keep_alone<N: Real, const D: usize>(
    point: &mut PatchPoint<N, D>,
    merging: &Merging<'_, N, D>,
    ids: &mut PairIds,
) {
    if point.raw.distance <= merging.request.prediction {
        let mut old = merging.old.iter().flat_map(|patch| &patch.points);
        let same = old.find(|old| old.name() == point.name());
        point.raw.id = same.map_or_else(|| ids.next(), |old| old.raw.id);
    }
}

/// Deepest first, then in the order of the parts.
fn by_depth<N: Real, const D: usize>(
    a: &PatchPoint<N, D>,
    b: &PatchPoint<N, D>,
) -> core::cmp::Ordering {
    let by_value = a.raw.distance.as_f64().total_cmp(&b.raw.distance.as_f64());
    by_value.then_with(|| a.name().cmp(&b.name()))
}

/// Two manifolds, of which the first is the deeper, have one normal and lie in one plane: that of
/// the points of the first shape or that of those of the second.
fn are_level<N: Real, const D: usize>(a: &Patch<N, D>, b: &Patch<N, D>, tolerance: N) -> bool {
    let same = N::lit(SAME);
    if (a.normal - b.normal).norm() > same {
        return false;
    }
    let (lead1, lead2) = (&a.points[0].raw, &b.points[0].raw);
    let arm = lead2.point1 - lead1.point1;
    let room = same * arm.norm() + N::TWO * tolerance;
    let rise1 = a.normal.dot(&arm);
    let rise2 = rise1 + lead2.distance - lead1.distance;
    min(rise1.abs(), rise2.abs()) <= room
}

/// Which points have the numbers of old ones.
struct Heirs {
    kept: Vec<Vec<Option<u32>>>,
}

impl Heirs {
    /// Each old number goes to one point on its features: the nearest, the first of equals.
    fn of<N: Real, const D: usize>(old: &[Patch<N, D>], new: &[Patch<N, D>]) -> Self {
        let mut kept: Vec<Vec<Option<u32>>> =
            new.iter().map(|patch| vec![None; patch.points.len()]).collect();
        if old.iter().all(|patch| patch.points.is_empty()) {
            return Self { kept };
        }
        let count = new.iter().map(|patch| patch.points.len()).sum();
        let mut names: Vec<(Name, usize, usize)> = Vec::with_capacity(count);
        for (at, patch) in new.iter().enumerate() {
            names.extend(patch.points.iter().enumerate().map(|(i, point)| (point.name(), at, i)));
        }
        names.sort_unstable();
        for point in old.iter().flat_map(|patch| &patch.points) {
            let name = point.name();
            let start = names.partition_point(|(other, ..)| *other < name);
            let same = names[start..].iter().take_while(|(other, ..)| *other == name);
            let free = same.filter(|&&(_, at, i)| kept[at][i].is_none());
            let arm = |&(_, at, i): &(Name, usize, usize)| {
                (new[at].points[i].raw.point1 - point.raw.point1).norm_squared()
            };
            let heir = free.reduce(|best, next| if arm(next) < arm(best) { next } else { best });
            if let Some(&(_, at, i)) = heir {
                kept[at][i] = Some(point.raw.id);
            }
        }
        Self { kept }
    }

    fn of_patch(&mut self, index: usize) -> Vec<Option<u32>> {
        core::mem::take(&mut self.kept[index])
    }
}

/// A point of a patch, seen along its normal.
#[derive(Clone, Copy)]
struct Member<N: Real, const D: usize> {
    candidate: Candidate<N, D>,
    parts: [u32; 2],
}

/// Leaves of a patch, whose first point is the deepest, at most as many points as are asked for:
/// the deepest, and of the outline those that span most.
fn reduce_patch<N: Space<D>, const D: usize>(
    patch: &mut Patch<N, D>,
    kept: Vec<Option<u32>>,
    merging: &Merging<'_, N, D>,
    ids: &mut PairIds,
) {
    let tangents = (N::tables().tangents)(&patch.normal);
    let members = members(patch, kept, merging, &tangents);
    let lowest = patch.points[0].raw.distance;
    let members = outline(members, lowest + merging.tolerance, merging.tolerance);
    let mut candidates: Vec<Candidate<N, D>> = members.iter().map(|m| m.candidate).collect();
    let deepest = super::deepest(&candidates, lowest + merging.tolerance);
    candidates[deepest].distance = lowest;
    // In the plane two points delimit all there is.
    let is_line = tangents[1] == Vector::<N, D>::zeros();
    let most = merging.request.max_points.max(1);
    let limit = if is_line { most.min(2) } else { most };
    let chosen = reduce::chosen(&candidates, deepest, limit, merging.tolerance);
    patch.points.clear();
    for &index in &chosen {
        let candidate = &candidates[index];
        let id = candidate.kept_id.unwrap_or_else(|| ids.next());
        patch.points.push(PatchPoint { raw: candidate.named(id), parts: members[index].parts });
    }
    patch.points.sort_by_key(|point| point.raw.id);
}

/// The points of a patch that the request asks for; the first, which is the deepest, always, also where
/// its coordinates are no numbers.
fn members<N: Real, const D: usize>(
    patch: &Patch<N, D>,
    kept: Vec<Option<u32>>,
    merging: &Merging<'_, N, D>,
    tangents: &[Vector<N, D>; 2],
) -> Vec<Member<N, D>> {
    let origin: Point<N, D> = patch.points[0].raw.point1;
    let ManifoldRequest { prediction, sine, .. } = *merging.request;
    let member = |(at, (point, kept_id)): (usize, (&PatchPoint<N, D>, Option<u32>))| {
        let raw = &point.raw;
        let is_first = at == 0;
        let arm = if is_first { Vector::<N, D>::zeros() } else { raw.point1 - origin };
        let flat = Vector::<N, 2>::new(tangents[0].dot(&arm), tangents[1].dot(&arm));
        let (point1, features) = (raw.point1, [raw.feature1, raw.feature2]);
        let asked = is_first || raw.distance <= prediction + sine * flat.norm();
        let candidate = Candidate { point1, distance: raw.distance, flat, features, kept_id };
        asked.then_some(Member { candidate, parts: point.parts })
    };
    patch.points.iter().zip(kept).enumerate().filter_map(member).collect()
}

/// The points on the outline of all, each once; and the deepest, if no point of the outline is at
/// most `level`.
fn outline<N: Real, const D: usize>(
    members: Vec<Member<N, D>>,
    level: N,
    tolerance: N,
) -> Vec<Member<N, D>> {
    let members = without_copies(members, tolerance);
    let forth = chain(members.iter());
    let back = chain(members.iter().rev());
    // Each chain ends where the other starts.
    let ends = forth.len().saturating_sub(1).max(1);
    let mut outline: Vec<Member<N, D>> = forth[..ends].to_vec();
    outline.extend_from_slice(&back[..back.len() - 1]);
    thin(&mut outline, tolerance);
    if !outline.iter().any(|member| member.candidate.distance <= level) {
        let depth = |member: &Member<N, D>| member.candidate.distance;
        let deeper =
            |best: Member<N, D>, next| if depth(&next) < depth(&best) { next } else { best };
        outline.extend(members.into_iter().reduce(deeper));
    }
    outline
}

/// The points sorted along the first tangent, then along the second; of points at one place, which
/// the parts around it all have, one: one with a number, the deepest, or that of the first parts.
fn without_copies<N: Real, const D: usize>(
    mut members: Vec<Member<N, D>>,
    tolerance: N,
) -> Vec<Member<N, D>> {
    let near = N::lit(4.0) * tolerance;
    let rank = |member: &Member<N, D>| (member.candidate.kept_id.is_none(), member.parts);
    let is_better = |new: &Member<N, D>, old: &Member<N, D>| {
        let lower = old.candidate.distance - new.candidate.distance;
        lower > tolerance || lower >= -tolerance && rank(new) < rank(old)
    };
    members.sort_by(by_place);
    let mut kept: Vec<Member<N, D>> = Vec::new();
    for member in members {
        let flat = member.candidate.flat;
        // Sorted along the first tangent: only the last few can be at the same place.
        let in_reach =
            |&(_, old): &(usize, &Member<N, D>)| flat.x - old.candidate.flat.x <= N::TWO * near;
        let last = kept.iter().enumerate().rev().take_while(in_reach);
        let mut same = last.filter(|(_, old)| (old.candidate.flat - flat).norm() <= near);
        let beside = same.next().map(|(at, _)| at);
        match beside {
            Some(at) if is_better(&member, &kept[at]) => kept[at] = member,
            Some(_) => {}
            None => kept.push(member),
        }
    }
    // An exchange may have taken a point past its neighbours.
    kept.sort_by(by_place);
    kept
}

fn by_place<N: Real, const D: usize>(a: &Member<N, D>, b: &Member<N, D>) -> core::cmp::Ordering {
    let (a, b) = (&a.candidate.flat, &b.candidate.flat);
    a.x.as_f64().total_cmp(&b.x.as_f64()).then(a.y.as_f64().total_cmp(&b.y.as_f64()))
}

/// One side of the hull of sorted points, from the first to the last: every corner turns left.
///
/// Andrew, "Another Efficient Algorithm for Convex Hulls in Two Dimensions" (1979).
fn chain<'a, N: Real, const D: usize>(
    members: impl Iterator<Item = &'a Member<N, D>>,
) -> Vec<Member<N, D>> {
    let mut chain: Vec<Member<N, D>> = Vec::new();
    for member in members {
        while let [.., before, last] = &chain[..] {
            // Positive is left of the whole: inside.
            if beside(before, last, member) < N::ZERO {
                break;
            }
            chain.pop();
        }
        chain.push(*member);
    }
    chain
}

/// Twice the area of a triangle; positive if `at` lies left of the way from one end to the other.
fn beside<N: Real, const D: usize>(from: &Member<N, D>, at: &Member<N, D>, to: &Member<N, D>) -> N {
    let origin = from.candidate.flat;
    cross2(&(to.candidate.flat - origin), &(at.candidate.flat - origin))
}

/// Leaves out the corners of a convex polygon that lie, but for rounding, on the line between those
/// next to them.
fn thin<N: Real, const D: usize>(outline: &mut Vec<Member<N, D>>, tolerance: N) {
    let mut at = 0;
    while outline.len() > 2 && at < outline.len() {
        let before = &outline[if at == 0 { outline.len() - 1 } else { at - 1 }];
        let after = &outline[if at + 1 == outline.len() { 0 } else { at + 1 }];
        let length = (after.candidate.flat - before.candidate.flat).norm();
        let is_straight = beside(before, &outline[at], after).abs() <= tolerance * length;
        if is_straight {
            outline.remove(at);
        } else {
            at += 1;
        }
    }
}
