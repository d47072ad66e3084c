//! Manifolds of many parts merged: one for each flat patch, of few points.
//!
//! The manifolds of the parts of a composite lie side by side. Those with one normal in one plane
//! are pieces of one area of contact; of all their points those on its outline delimit it.

use core::cmp::Ordering;
use core::ops::Range;

use smallvec::SmallVec;

use super::super::{ManifoldRequest, PairIds, RawPoint};
use super::patch_outline::{Choosing, Members};
use super::patch_shelves::Shelves;
use crate::math::{Real, Space, Vector, min};

/// Normals that differ by more than this, as vectors, are those of different patches; points that
/// lie farther from a plane than this part of their distance lie in different planes.
pub(super) const SAME: f64 = 1.0 / 1024.0;

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
    match merging.pieces {
        [] => return patches.clear(),
        [piece] if piece.points.len() == 1 => {
            let count = merge_one(merging, piece, (&mut *patches, ids));
            return patches.truncate(count);
        }
        _ => (),
    }
    let (kept, mut members, mut made) = (merging.kept(patches), Members::new(), 0);
    let choosing = Choosing { merging, kept: &kept };
    if have_own_normals(merging.pieces) {
        // Each piece is a patch of its own; they come in the order of their parts.
        for (lead, piece) in merging.pieces.iter().enumerate() {
            let Some(deepest) = merging.deepest_of(piece) else { continue };
            if merging.points[deepest].distance <= merging.request.prediction {
                let out = (blank(patches, made, piece.normal), &mut *ids);
                choosing.fill((lead, deepest), core::iter::once(lead), &mut members, out);
                made += 1;
            }
        }
    } else {
        let layout = Layout::of(merging);
        for group in &layout.groups {
            let out = (blank(patches, made, merging.pieces[group.lead].normal), &mut *ids);
            let pieces = layout.order[group.pieces.clone()].iter().map(|(piece, _)| *piece);
            choosing.fill((group.lead, group.deepest), pieces, &mut members, out);
            made += 1;
        }
    }
    patches.truncate(made);
}

/// Writes the only point of all as a patch, if it is near enough; answers how many patches there are.
pub(super) fn merge_one<N: Real, const D: usize>(
    merging: &Merging<'_, N, D>,
    piece: &Piece<N, D>,
    (patches, ids): (&mut Vec<Patch<N, D>>, &mut PairIds),
) -> usize {
    let mut raw = merging.points[piece.points.start];
    // Written so that what is no number is not near.
    let is_near = raw.distance <= merging.request.prediction;
    if !is_near {
        return 0;
    }
    let mut old = patches.iter().flat_map(|patch| &patch.points);
    let kept = old.find(|old| {
        let names = (old.raw.feature1, old.raw.feature2);
        old.parts == piece.parts && names == (raw.feature1, raw.feature2)
    });
    raw.id = kept.map_or_else(|| ids.next(), |kept| kept.raw.id);
    blank(patches, 0, piece.normal).push(PatchPoint { raw, parts: piece.parts });
    1
}

/// A patch without points, in the place of an old one if there is one.
pub(super) fn blank<N: Real, const D: usize>(
    patches: &mut Vec<Patch<N, D>>,
    at: usize,
    normal: Vector<N, D>,
) -> &mut SmallVec<[PatchPoint<N, D>; 4]> {
    if at == patches.len() {
        // Most pairs have one patch at all times.
        patches.reserve_exact(1);
        patches.push(Patch { normal, points: SmallVec::new() });
    }
    let patch = &mut patches[at];
    patch.normal = normal;
    patch.points.clear();
    &mut patch.points
}

impl<N: Real, const D: usize> Merging<'_, N, D> {
    /// Which points have the numbers of old ones: each old number goes to one point on its features,
    /// the nearest, the first of equals.
    pub(super) fn kept(&self, old: &[Patch<N, D>]) -> Kept {
        let mut kept = Kept::from_elem(None, self.points.len());
        let mut at = 0;
        for PatchPoint { raw, parts } in old.iter().flat_map(|patch| &patch.points) {
            let Some(found) = self.piece_of(*parts, at) else { continue };
            at = found;
            let range = self.pieces[at].points.clone();
            let (mut heir, mut nearest) = (None, N::INFINITY);
            for (new, id) in self.points[range.clone()].iter().zip(&mut kept[range]) {
                let is_heir = new.feature1 == raw.feature1 && new.feature2 == raw.feature2;
                if !is_heir || id.is_some() {
                    continue;
                }
                let away = (new.point1 - raw.point1).norm_squared();
                if heir.is_none() || away < nearest {
                    (heir, nearest) = (Some(id), away);
                }
            }
            if let Some(heir) = heir {
                *heir = Some(raw.id);
            }
        }
        kept
    }

    /// The piece of two parts, most often that at a place or the next: the points of one pair of parts come
    /// together, and patches in the order of their parts.
    #[inline]
    fn piece_of(&self, parts: [u32; 2], place: usize) -> Option<usize> {
        let is_at = |at: usize| self.pieces.get(at).is_some_and(|piece| piece.parts == parts);
        if is_at(place) {
            return Some(place);
        }
        if is_at(place + 1) {
            return Some(place + 1);
        }
        self.pieces.binary_search_by(|piece| piece.parts.cmp(&parts)).ok()
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
    /// Where in the order the pieces are.
    pieces: Range<usize>,
}

/// Pieces with their deepest points, or with their groups.
type Order = SmallVec<[(usize, usize); 16]>;

/// Which pieces make which patches.
struct Layout {
    /// In the order of their first parts.
    groups: SmallVec<[Group; 8]>,
    /// Those of each group together, the deepest first.
    order: Order,
}

impl Layout {
    fn of<N: Real, const D: usize>(merging: &Merging<'_, N, D>) -> Self {
        let pieces = merging.pieces;
        let mut order = Order::with_capacity(pieces.len());
        for (index, piece) in pieces.iter().enumerate() {
            if let Some(deepest) = merging.deepest_of(piece) {
                order.push((index, deepest));
            }
        }
        order.sort_by(|a, b| {
            let by_value = by_depth(&merging.points[a.1], &merging.points[b.1]);
            by_value.then_with(|| pieces[a.0].parts.cmp(&pieces[b.0].parts))
        });
        let mut groups = SmallVec::<[Group; 8]>::with_capacity(pieces.len());
        let mut shelves = Shelves::of(pieces);
        for (index, found) in &mut order {
            let (piece, deepest) = (&pieces[*index], *found);
            let is_level = |&&group: &&usize| {
                let group: &Group = &groups[group];
                let leads = [group.deepest, deepest].map(|point| &merging.points[point]);
                let normals = [&pieces[group.lead].normal, &piece.normal];
                are_level(normals, leads, merging.tolerance)
            };
            let known = shelves.near(*index).iter().find(is_level).copied();
            *found = known.unwrap_or(groups.len());
            if let Some(known) = known {
                groups[known].first = groups[known].first.min(piece.parts);
            } else {
                shelves.put(groups.len(), &piece.normal);
                groups.push(Group { lead: *index, deepest, first: piece.parts, pieces: 0..0 });
            }
        }
        order.sort_by_key(|&(_, group)| group);
        let mut end = 0;
        for own in order.chunk_by(|a, b| a.1 == b.1) {
            groups[own[0].1].pieces = end..end + own.len();
            end += own.len();
        }
        groups.retain(|group| merging.points[group.deepest].distance <= merging.request.prediction);
        groups.sort_by_key(|group| group.first);
        Self { groups, order }
    }
}

/// So many pieces are held against each other.
pub(super) const FEW_PIECES: usize = 12;

/// No two of a few pieces have one normal, as on rough ground.
fn have_own_normals<N: Real, const D: usize>(pieces: &[Piece<N, D>]) -> bool {
    let same = N::lit(SAME) * N::lit(SAME);
    pieces.len() <= FEW_PIECES
        && pieces.iter().enumerate().all(|(at, piece)| {
            let before = &pieces[..at];
            before.iter().all(|other| (other.normal - piece.normal).norm_squared() > same)
        })
}

/// Deepest first, then in the order of the features.
pub(super) fn by_depth<N: Real, const D: usize>(
    a: &RawPoint<N, D>,
    b: &RawPoint<N, D>,
) -> Ordering {
    let by_value = ordering(a.distance, b.distance);
    by_value.then_with(|| (a.feature1, a.feature2).cmp(&(b.feature1, b.feature2)))
}

/// The total order of numbers; most need one look.
#[inline]
pub(super) fn ordering<N: Real>(a: N, b: N) -> Ordering {
    if a < b {
        Ordering::Less
    } else if a > b {
        Ordering::Greater
    } else {
        a.as_f64().total_cmp(&b.as_f64())
    }
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
