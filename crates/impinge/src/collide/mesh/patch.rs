//! Merges the manifolds of many pairs of parts into few manifolds: one for each flat patch.
//!
//! The manifolds of the parts of a composite lie side by side. Manifolds with equal normals in one
//! plane are pieces of one contact area; the points on the outline of that area suffice.
//!
//! ```text
//!  pieces, one per pair of parts        patch
//!   ┌────────┐┌────────┐
//!   │a      b││c      d│                ●───────────────●
//!   │        ││        │    merge ─>    │               │   four corners span the area;
//!   │e      f││g      h│                ●───────────────●   c and g are copies of b and f
//!   └────────┘└────────┘
//! ```
//!
//! A contact point keeps its id by the rule of [`ids`](crate::collide::manifold::ids); the two
//! parts are treated as additional features.

use core::cell::OnceCell;
use core::cmp::Ordering;
use core::ops::Range;

use smallvec::SmallVec;

use super::patch_groups::Groups;
use super::patch_points::{Choosing, Members};
use crate::collide::manifold::ids::{
    AnchorList, Anchors, Inherited, PairPose, are_near, is_one_point, normals_agree,
};
use crate::collide::manifold::matching::each_match;
use crate::collide::manifold::reduce::ordering;
use crate::collide::size::smaller_size;
use crate::collide::{ManifoldRequest, Pair, PairIds, RawPoint};
use crate::math::{Pose, Real, Space, Vector};

/// A manifold of two shapes, at least one of them a composite, in the frame of the first shape.
#[derive(Clone, Debug)]
pub(crate) struct Patch<N: Real, const D: usize> {
    /// Unit normal from the first shape to the second.
    pub(crate) normal: Vector<N, D>,
    /// Points, sorted by id.
    pub(crate) points: SmallVec<[PatchPoint<N, D>; 4]>,
}

/// A point of a manifold, and the parts it lies on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct PatchPoint<N: Real, const D: usize> {
    /// The point, in the frame of the first shape.
    pub(crate) raw: RawPoint<N, D>,
    /// Index of the part of the first shape, and of the second; 0 for a convex solid.
    pub(crate) parts: [u32; 2],
}

/// The manifold of two parts, in the frame of the first shape: a normal and a range of
/// [`RawPoints`](crate::collide::RawPoints).
#[derive(Clone, Debug)]
pub(crate) struct Piece<N: Real, const D: usize> {
    /// Unit normal from the first shape to the second.
    pub(crate) normal: Vector<N, D>,
    /// Index of the part of the first shape, and of the second; 0 for a convex solid.
    pub(crate) parts: [u32; 2],
    /// Range of the piece's points in `Merging::points`.
    pub(crate) points: Range<usize>,
}

/// The input of [`merge`].
pub(crate) struct Merging<'a, N: Real, const D: usize> {
    pub(crate) pair: &'a Pair<'a, N, D>,
    pub(crate) request: &'a ManifoldRequest<N>,
    /// Bound of the rounding errors of lengths computed for the two shapes.
    pub(crate) tolerance: N,
    /// Pieces, sorted by their parts; each pair of parts occurs once.
    pub(crate) pieces: &'a [Piece<N, D>],
    /// Points of all pieces.
    pub(crate) points: &'a [RawPoint<N, D>],
    /// Cache of [`Self::size`].
    pub(crate) size: OnceCell<N>,
}

/// The inherited id of each point in [`Merging::points`]; `None` for a new point.
pub(super) type KeptIds = SmallVec<[Option<Inherited>; 32]>;

/// Merges the manifolds of parts into patches, sorted by the smallest pair of parts in each.
/// Replaces `patches`, the result of the last update, in which the second shape had the pose
/// `old_pose12`.
///
/// The manifolds of parts may hold points beyond the prediction. Such a point is kept only if a
/// rotation about the deepest point of the patch, by the angle of `request.sine`, may bring it
/// within the prediction.
pub(crate) fn merge<N: Space<D>, const D: usize>(
    merging: &Merging<'_, N, D>,
    old_pose12: &Pose<N, D>,
    patches: &mut Vec<Patch<N, D>>,
    ids: &mut PairIds,
) {
    match merging.pieces {
        [] => return patches.clear(),
        [piece] if piece.points.len() == 1 => {
            return merge_one(merging, piece, old_pose12, patches, ids);
        }
        _ => (),
    }
    let mut kept = KeptIds::new();
    merging.keep(old_pose12, patches, &mut kept);
    let (choosing, groups) = (Choosing { merging, kept: &kept }, Groups::of(merging));
    let mut members = Members::new();
    for (at, group) in groups.groups.iter().enumerate() {
        let out = blank(patches, at, merging.pieces[group.lead.piece].normal);
        choosing.fill(group.lead, groups.pieces(group), &mut members, out, ids);
    }
    patches.truncate(groups.groups.len());
}

/// Makes a patch from a piece with a single point, such as that of a ball, if the point is within
/// the prediction; else clears the patches.
fn merge_one<N: Real, const D: usize>(
    merging: &Merging<'_, N, D>,
    piece: &Piece<N, D>,
    old_pose12: &Pose<N, D>,
    patches: &mut Vec<Patch<N, D>>,
    ids: &mut PairIds,
) {
    let mut raw = merging.points[piece.points.start];
    // The comparison is false for NaN.
    let is_near = raw.distance <= merging.request.prediction;
    if !is_near {
        return patches.clear();
    }
    let mut kept = KeptIds::new();
    merging.keep(old_pose12, patches, &mut kept);
    raw.id = kept[piece.points.start].map_or_else(|| ids.next(), |kept| kept.id);
    blank(patches, 0, piece.normal).push(PatchPoint { raw, parts: piece.parts });
    patches.truncate(1);
}

/// Returns the anchors that identify a point between updates: its positions on both shapes, its
/// parts and its features.
fn anchors<N: Real, const D: usize>(
    pose: &PairPose<'_, N, D>,
    raw: &RawPoint<N, D>,
    parts: [u32; 2],
) -> Anchors<N, D> {
    pose.anchors(&raw.point1, raw.distance, (parts, [raw.feature1, raw.feature2]))
}

/// Clears the patch at index `at`, or appends a patch if `at` is the number of patches. Sets its
/// normal and returns its empty list of points.
fn blank<N: Real, const D: usize>(
    patches: &mut Vec<Patch<N, D>>,
    at: usize,
    normal: Vector<N, D>,
) -> &mut SmallVec<[PatchPoint<N, D>; 4]> {
    if at == patches.len() {
        // Most pairs have one patch in all updates.
        patches.reserve_exact(1);
        patches.push(Patch { normal, points: SmallVec::new() });
    }
    let patch = &mut patches[at];
    patch.normal = normal;
    patch.points.clear();
    &mut patch.points
}

impl<N: Real, const D: usize> Merging<'_, N, D> {
    /// Computes the ids that points inherit, by the rule of [`ids`](crate::collide::manifold::ids):
    /// first by parts and features if these identify one point, then by position.
    fn keep(&self, old_pose12: &Pose<N, D>, old: &[Patch<N, D>], kept: &mut KeptIds) {
        kept.resize(self.points.len(), None);
        let (mut at, mut olds, mut ids) = (0, AnchorList::new(), SmallVec::<[u32; 8]>::new());
        for patch in old {
            let pose = PairPose { pose12: Some(old_pose12), normal: &patch.normal };
            for point in &patch.points {
                let piece = self.piece_of(point.parts, at);
                at = piece.unwrap_or(at);
                let heir = piece.and_then(|piece| self.only_heir(&pose, (patch, point), piece));
                if let Some(heir) = heir.filter(|&heir| kept[heir].is_none()) {
                    kept[heir] = Some(Inherited { id: point.raw.id, is_old: true });
                } else {
                    olds.push(anchors(&pose, &point.raw, point.parts));
                    ids.push(point.raw.id);
                }
            }
        }
        if !olds.is_empty() {
            self.keep_by_position(&olds, &ids, kept);
        }
    }

    /// Returns the index of the point of a piece that inherits the id of an old point: the only
    /// point with the same features. If one of these features is a vertex, that suffices; otherwise
    /// the two points must be near each other with similar normals, and no other old point of the
    /// patch may have these parts and features. `None` if there is no such point.
    fn only_heir(
        &self,
        old_pose: &PairPose<'_, N, D>,
        (patch, old): (&Patch<N, D>, &PatchPoint<N, D>),
        piece: usize,
    ) -> Option<usize> {
        let features_of = |raw: &RawPoint<N, D>| [raw.feature1, raw.feature2];
        let (features, Piece { normal, parts, points }) =
            (features_of(&old.raw), &self.pieces[piece]);
        let mut heirs = points.clone().filter(|&at| features_of(&self.points[at]) == features);
        let heir = heirs.next()?;
        let is_twin =
            |at: &&PatchPoint<N, D>| at.parts == old.parts && features_of(&at.raw) == features;
        if heirs.next().is_some() {
            return None;
        }
        if is_one_point(features) {
            return Some(heir);
        }
        let pose = PairPose { pose12: Some(&self.pair.pose12), normal };
        let are_near = || {
            let old = anchors(old_pose, &old.raw, old.parts);
            are_near(&old, &anchors(&pose, &self.points[heir], *parts), self.size())
        };
        let is_only = normals_agree(&patch.normal, normal)
            && patch.points.iter().filter(is_twin).nth(1).is_none();
        (is_only && are_near()).then_some(heir)
    }

    /// Matches the remaining old and new points by [`each_match`], and passes the ids on.
    #[inline(never)]
    fn keep_by_position(&self, olds: &[Anchors<N, D>], ids: &[u32], kept: &mut KeptIds) {
        let (mut news, mut indices) = (AnchorList::new(), SmallVec::<[usize; 32]>::new());
        for Piece { normal, parts, points } in self.pieces {
            let pose = PairPose { pose12: Some(&self.pair.pose12), normal };
            for at in points.clone().filter(|&at| kept[at].is_none()) {
                news.push(anchors(&pose, &self.points[at], *parts));
                indices.push(at);
            }
        }
        each_match(olds, &news, self.size(), &mut |old, new, is_old| {
            kept[indices[new]] = Some(Inherited { id: ids[old], is_old });
        });
    }

    /// Returns the length scale of the pair, for relative tolerances; cached at the first call.
    pub(super) fn size(&self) -> N {
        *self.size.get_or_init(|| smaller_size([self.pair.first, self.pair.second]))
    }

    /// Returns the index of the piece of two parts; `None` if there is none. The search starts at
    /// `guess`: points of one pair of parts follow each other and patches are sorted by their
    /// parts, so the piece is usually at `guess` or next to it.
    #[inline]
    fn piece_of(&self, parts: [u32; 2], guess: usize) -> Option<usize> {
        let is_at = |at: usize| self.pieces.get(at).is_some_and(|piece| piece.parts == parts);
        if is_at(guess) {
            return Some(guess);
        }
        if is_at(guess + 1) {
            return Some(guess + 1);
        }
        self.pieces.binary_search_by(|piece| piece.parts.cmp(&parts)).ok()
    }

    /// Returns the index of the first point of a piece in the order of [`by_depth`]; `None` without
    /// points.
    pub(super) fn deepest_of(&self, piece: &Piece<N, D>) -> Option<usize> {
        let deeper = |best: usize, next: usize| {
            if by_depth(&self.points[next], &self.points[best]).is_lt() { next } else { best }
        };
        piece.points.clone().reduce(deeper)
    }
}

/// Orders points by distance, the deepest first, then by their features.
pub(super) fn by_depth<N: Real, const D: usize>(
    a: &RawPoint<N, D>,
    b: &RawPoint<N, D>,
) -> Ordering {
    let by_value = ordering(a.distance, b.distance);
    by_value.then_with(|| (a.feature1, a.feature2).cmp(&(b.feature1, b.feature2)))
}
