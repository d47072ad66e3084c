//! Manifolds of many parts merged: one for each flat patch, of few points.
//!
//! The manifolds of the parts of a composite lie side by side. Those with one normal in one plane
//! are pieces of one area of contact; of all their points those on its outline delimit it.
//!
//! A contact point keeps its id while its parts and features stay.

use core::cmp::Ordering;
use core::ops::Range;

use smallvec::SmallVec;

use super::patch_groups::Groups;
use super::patch_points::{Choosing, Members};
use crate::collide::manifold::reduce::ordering;
use crate::collide::{ManifoldRequest, PairIds, RawPoint};
use crate::math::{Real, Space, Vector};

/// A manifold of two shapes one of which is a composite, in the frame of the first shape.
#[derive(Clone, Debug)]
pub(crate) struct Patch<N: Real, const D: usize> {
    /// Unit, from the first shape to the second.
    pub(crate) normal: Vector<N, D>,
    pub(crate) points: SmallVec<[PatchPoint<N, D>; 4]>,
}

/// A point of a manifold, and the parts that it lies on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchPoint<N: Real, const D: usize> {
    pub(crate) raw: RawPoint<N, D>,
    pub(crate) parts: [u32; 2],
}

/// The points of many pieces, one after the other.
pub(crate) type Points<N, const D: usize> = SmallVec<[RawPoint<N, D>; 32]>;

/// What two parts contribute, in the frame of the first shape: some of the [`Points`].
#[derive(Clone, Debug)]
pub(crate) struct Piece<N: Real, const D: usize> {
    /// Unit, from the first shape to the second.
    pub(crate) normal: Vector<N, D>,
    pub(crate) parts: [u32; 2],
    pub(crate) points: Range<usize>,
}

/// What a merged manifold is made of and how.
pub(crate) struct Merging<'a, N: Real, const D: usize> {
    pub(crate) request: &'a ManifoldRequest<N>,
    /// Lengths below this are rounding errors.
    pub(crate) tolerance: N,
    /// In the order of their parts, of which no two are the same.
    pub(crate) pieces: &'a [Piece<N, D>],
    pub(crate) points: &'a [RawPoint<N, D>],
}

/// The numbers that points inherit.
pub(super) type KeptIds = SmallVec<[Option<u32>; 32]>;

/// Merges the manifolds of parts into patches, which come in the order of their first parts, and
/// replaces those of the update before, whose points on features that are still touched hand on their
/// numbers.
///
/// The manifolds of parts may hold points beyond the prediction, of which those stay that turning
/// about the patch's nearest point brings near enough.
pub(crate) fn merge<N: Space<D>, const D: usize>(
    merging: &Merging<'_, N, D>,
    patches: &mut Vec<Patch<N, D>>,
    ids: &mut PairIds,
) {
    match merging.pieces {
        [] => return patches.clear(),
        [piece] if piece.points.len() == 1 => return merge_one(merging, piece, patches, ids),
        _ => (),
    }
    let kept = merging.kept(patches);
    let (choosing, groups) = (Choosing { merging, kept: &kept }, Groups::of(merging));
    let mut members = Members::new();
    for (at, group) in groups.groups.iter().enumerate() {
        let out = blank(patches, at, merging.pieces[group.lead.piece].normal);
        choosing.fill(group.lead, groups.pieces(group), &mut members, out, ids);
    }
    patches.truncate(groups.groups.len());
}

/// Makes a patch of the only point of all, as of a ball, if it is near enough.
fn merge_one<N: Real, const D: usize>(
    merging: &Merging<'_, N, D>,
    piece: &Piece<N, D>,
    patches: &mut Vec<Patch<N, D>>,
    ids: &mut PairIds,
) {
    let mut raw = merging.points[piece.points.start];
    // False for NaN, which is not near.
    let is_near = raw.distance <= merging.request.prediction;
    if !is_near {
        return patches.clear();
    }
    let mut old = patches.iter().flat_map(|patch| &patch.points);
    let kept = old.find(|old| {
        let names = (old.raw.feature1, old.raw.feature2);
        old.parts == piece.parts && names == (raw.feature1, raw.feature2)
    });
    raw.id = kept.map_or_else(|| ids.next(), |kept| kept.raw.id);
    blank(patches, 0, piece.normal).push(PatchPoint { raw, parts: piece.parts });
    patches.truncate(1);
}

/// A patch without points, in the place of an old one if there is one.
fn blank<N: Real, const D: usize>(
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
    fn kept(&self, old: &[Patch<N, D>]) -> KeptIds {
        let mut kept = KeptIds::from_elem(None, self.points.len());
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

/// Deepest first, then in the order of the features.
pub(super) fn by_depth<N: Real, const D: usize>(
    a: &RawPoint<N, D>,
    b: &RawPoint<N, D>,
) -> Ordering {
    let by_value = ordering(a.distance, b.distance);
    by_value.then_with(|| (a.feature1, a.feature2).cmp(&(b.feature1, b.feature2)))
}
