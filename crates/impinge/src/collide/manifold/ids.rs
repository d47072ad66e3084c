//! Ids of contact points: a contact that moves by a short distance in one step keeps its id.
//!
//! Old points are matched to new points in three classes, and within a class by distance, nearest
//! first:
//!
//! 1. points on the same pair of features, within [`SHARE`] of the pair's size;
//! 2. points on other features within the same length: features flicker where edges coincide, and a
//!    corner that slides over the triangles of a mesh meets another triangle in each step;
//! 3. points on the same pair of features at any distance; a crossing of two edges only within
//!    [`REACH`] of the size.
//!
//! The distance of a match is the smaller of two: how far the point moved on the first solid, in
//! that solid's frame, and how far it moved on the second, in the second's frame. So a corner that
//! slides over a floor counts as unmoved, and so does a point of the floor that a solid slides
//! over. The distance is zero for a point that stays on a vertex of either solid. The kernels of
//! `batch` keep no old pose, so they compare positions on the first solid only.
//!
//! If the normal turned by more than 45°, the distance is infinite, because a solid that fell on
//! another side begins new contacts. Then only points on the same pair of features still match,
//! unless both features are edges. For such a pair with a vertex the distance is zero, because the
//! pair has only one point.
//!
//! ```text
//!           ┌─────────┐            ┌─────────┐
//!           │  first  │   slides   │  first  │
//!           └a───────b┘   ----->   └a───────b┘     a and b: at rest on the first solid
//!     ───────1───────2─────────────────────────    1 and 2: where they were on the second
//! ```
//!
//! Each id goes to one point. Ties go to the older id, then to the candidate that comes first. The
//! distance treats both solids alike. Scaling by a power of two changes no choice. If each pair of
//! features has at most one point, as for two boxes, points with the same features are the same
//! point, and positions are compared only for crossings of two edges ([`is_same_point`]).

use smallvec::SmallVec;

use super::super::{RawManifold, RawPoint};
use super::PointChoice;
use super::frame::Candidate;
use super::matching::each_match;
use crate::math::order::askew;
use crate::math::{Point, Pose, Real, Vector, max_component};
use crate::shape::FeatureId;

/// Near length, as a fraction of the pair's size (`collide/size.rs`): an old and a new point at
/// most this distance apart are near each other.
pub(super) const SHARE: f64 = 1.0 / 16.0;

/// Largest distance, as a fraction of the pair's size, that a crossing of two edges may move and
/// stay the same contact; [`is_same_point`] compares it with each coordinate. A crossing of edges
/// that nearly coincide may jump farther, from one end to the other.
pub(super) const REACH: f64 = 1.0 / 2.0;

/// Returns whether both features are edges.
pub(super) fn are_edges(features: [FeatureId; 2]) -> bool {
    features.iter().all(|id| matches!(id, FeatureId::Edge(_)))
}

/// Returns whether a point with these features that moved by `moved` on the first solid is still
/// the same contact; always `true` unless both features are edges. `normals` computes the old and
/// the new normal, which must agree, and `size` the size of the pair.
#[inline(always)]
pub(in crate::collide) fn is_same_point<N: Real, const D: usize>(
    features: [FeatureId; 2],
    moved: &Vector<N, D>,
    normals: impl FnOnce() -> [Vector<N, D>; 2],
    size: impl FnOnce() -> N,
) -> bool {
    let agree = |[old, new]: [Vector<N, D>; 2]| normals_agree(&old, &new);
    !are_edges(features) || agree(normals()) && max_component(moved) <= N::lit(REACH) * size()
}

/// Returns the reciprocal of the near length, [`SHARE`] of the pair's `size`.
#[inline(always)]
pub(in crate::collide) fn near_scale<N: Real>(size: N) -> N {
    N::ONE / (N::lit(SHARE) * size)
}

/// Data by which a contact point is matched: its features, its position on either solid, and the
/// normal.
#[derive(Clone, Copy, Debug)]
pub(in crate::collide) struct Anchors<N: Real, const D: usize> {
    /// Indices of the parts of composites, zero for a convex solid, and the features of these
    /// parts.
    pub(super) ids: ([u32; 2], [FeatureId; 2]),
    /// Position of the point on each solid, in that solid's frame.
    pub(super) positions: [Point<N, D>; 2],
    /// Normal of the contact, in the frame of the first solid.
    normal: Vector<N, D>,
}

/// Pose and normal of a pair, from which the positions of a point on both solids follow.
#[derive(Clone, Copy)]
pub(in crate::collide) struct PairPose<'a, N: Real, const D: usize> {
    /// Pose of the second solid in the frame of the first; `None` if positions on it are not
    /// compared.
    pub(in crate::collide) pose12: Option<&'a Pose<N, D>>,
    /// Unit vector from the first solid to the second, in the frame of the first.
    pub(in crate::collide) normal: &'a Vector<N, D>,
}

impl<N: Real, const D: usize> PairPose<'_, N, D> {
    /// Returns the anchors of a contact, from its point on the first solid in the first solid's
    /// frame. If `pose12` is `None`, the position on the second solid is infinite.
    #[inline]
    pub(in crate::collide) fn anchors(
        &self,
        point1: &Point<N, D>,
        distance: N,
        ids: ([u32; 2], [FeatureId; 2]),
    ) -> Anchors<N, D> {
        let point2 = self.pose12.map_or_else(
            || Point::from(Vector::<N, D>::repeat(N::INFINITY)),
            |pose12| pose12.inverse_point(&(point1 + self.normal * distance)),
        );
        Anchors { ids, positions: [*point1, point2], normal: *self.normal }
    }
}

/// Anchors of the points of a manifold.
pub(in crate::collide) type AnchorList<N, const D: usize> = SmallVec<[Anchors<N, D>; 8]>;

/// Id that a new point inherits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::collide) struct Inherited {
    pub(in crate::collide) id: u32,
    /// Whether the new point is near the old point. If not, it moved far and gets no preference in
    /// the choice of points.
    pub(in crate::collide) is_old: bool,
}

/// Returns whether an old and a new point are near each other: at most the near length apart.
/// `size` is the size of the pair.
pub(in crate::collide) fn are_near<N: Real, const D: usize>(
    old: &Anchors<N, D>,
    new: &Anchors<N, D>,
    size: N,
) -> bool {
    moved(old, new, near_scale(size)) <= N::ONE
}

/// Returns the smaller of the squared distances that a point moved on the two solids, times `scale`
/// squared. Zero if the old and the new point are on the same vertex of one of the solids. If the
/// normals do not agree ([`normals_agree`]), zero for the same features with a vertex among them,
/// else infinite.
#[inline]
pub(super) fn moved<N: Real, const D: usize>(
    old: &Anchors<N, D>,
    new: &Anchors<N, D>,
    scale: N,
) -> N {
    if !normals_agree(&old.normal, &new.normal) {
        let is_same = is_one_point(old.ids.1) && old.ids == new.ids;
        return if is_same { N::ZERO } else { N::INFINITY };
    }
    // A point on the same vertex of either solid has not moved.
    let is_on_vertex = |solid: usize| {
        let id_of = |point: &Anchors<N, D>| (point.ids.0[solid], point.ids.1[solid]);
        matches!(id_of(old).1, FeatureId::Vertex(_)) && id_of(old) == id_of(new)
    };
    if is_on_vertex(0) || is_on_vertex(1) {
        return N::ZERO;
    }
    let on = |solid: usize| ((new.positions[solid] - old.positions[solid]) * scale).norm_squared();
    let [on1, on2] = [on(0), on(1)];
    // Written so that NaN, the result for unknown positions on the second solid, is not chosen.
    if on2 < on1 { on2 } else { on1 }
}

/// Cosine of the largest angle, 45°, between the old and new normal of one contact.
const TURN: f64 = core::f64::consts::FRAC_1_SQRT_2;

/// Returns whether the angle between an old and a new normal, both in the frame of the first solid,
/// is at most 45°. `false` for NaN.
#[inline(always)]
pub(in crate::collide) fn normals_agree<N: Real, const D: usize>(
    old: &Vector<N, D>,
    new: &Vector<N, D>,
) -> bool {
    old.dot(new) >= N::lit(TURN)
}

/// Returns whether a pair of features has only one point: whether one of them is a vertex. Two
/// edges may be round rims, with many points.
pub(in crate::collide) fn is_one_point(features: [FeatureId; 2]) -> bool {
    features.iter().any(|id| matches!(id, FeatureId::Vertex(_)))
}

/// Passes the id of each old point on to the candidate with the same features, if one of these
/// features is a vertex, only one candidate has both features, and that candidate has no id yet.
pub(in crate::collide) fn inherit_by_features<N: Real, const D: usize>(
    old: &RawManifold<N, D>,
    candidates: &mut [Candidate<N, D>],
) {
    for point in &old.points {
        let features = [point.feature1, point.feature2];
        let is_heir =
            |new: &&mut Candidate<N, D>| is_one_point(features) && new.features == features;
        let mut heirs = candidates.iter_mut().filter(is_heir);
        if let (Some(heir), None) = (heirs.next(), heirs.next())
            && heir.kept.is_none()
        {
            heir.kept = Some(Inherited { id: point.id, is_old: true });
        }
    }
}

/// Passes ids on by position ([`each_match`]). `some` holds the indices of the candidates that may
/// get an id. Matches the candidates without an id to the old points whose ids no candidate in
/// `some` has. `pose` is the new pose; `size` computes the size of the pair.
pub(in crate::collide) fn inherit_by_position<N: Real, const D: usize>(
    old: &RawManifold<N, D>,
    pose: &PairPose<'_, N, D>,
    size: impl Fn() -> N,
    candidates: &mut [Candidate<N, D>],
    some: &[usize],
) {
    let (mut news, mut indices) = (AnchorList::new(), SmallVec::<[usize; 8]>::new());
    let (mut olds, mut ids) = (AnchorList::new(), SmallVec::<[u32; 8]>::new());
    let has =
        |id: u32| some.iter().any(|&at| candidates[at].kept.is_some_and(|kept| kept.id == id));
    for point in old.points.iter().filter(|point| !has(point.id)) {
        olds.push(old.anchors(point));
        ids.push(point.id);
    }
    for &at in some.iter().filter(|&&at| !olds.is_empty() && candidates[at].kept.is_none()) {
        let new = &candidates[at];
        news.push(pose.anchors(&new.point1, new.distance, ([0; 2], new.features)));
        indices.push(at);
    }
    if !news.is_empty() {
        each_match(&olds, &news, size(), &mut |at, new, is_old| {
            candidates[indices[new]].kept = Some(Inherited { id: ids[at], is_old });
        });
    }
}

impl<N: Real, const D: usize> RawManifold<N, D> {
    /// Returns the anchors of one of the manifold's points.
    #[inline]
    pub(in crate::collide) fn anchors(&self, point: &RawPoint<N, D>) -> Anchors<N, D> {
        let pose = PairPose { pose12: self.pose12.as_ref(), normal: &self.normal };
        let features = [point.feature1, point.feature2];
        pose.anchors(&point.point1, point.distance, ([0; 2], features))
    }
}

/// Moves the points of a manifold to the candidates, if these have the same features in the same
/// order, each pair of features occurs once, and no crossing of edges jumped ([`is_same_point`]).
/// Returns `true` if it moved the points; else `false`, with nothing changed. The normal stays. The
/// nearest point gets exactly the distance of the pair.
pub(super) fn renew<N: Real, const D: usize>(
    candidates: &[Candidate<N, D>],
    choice: &PointChoice<'_, N, D>,
    out: &mut RawManifold<N, D>,
) -> bool {
    let normals = || [out.normal, *choice.pose.normal];
    let old = out.points.as_mut_slice();
    let is_same = |(point, new): (&RawPoint<N, D>, &Candidate<N, D>)| {
        let features = [point.feature1, point.feature2];
        let moved = new.point1 - point.point1;
        features == new.features && is_same_point(features, &moved, normals, choice.size)
    };
    if old.len() != candidates.len() || !old.iter().zip(candidates).all(is_same) {
        return false;
    }
    // Points that share their features, as on round rims, are matched by position by the caller.
    let is_twin = |(at, new): (usize, &Candidate<N, D>)| {
        candidates[..at].iter().any(|other| other.features == new.features)
    };
    if candidates.iter().enumerate().any(is_twin) {
        return false;
    }
    let (mut deepest, mut least) = (0, N::INFINITY);
    for (at, (point, new)) in old.iter_mut().zip(candidates).enumerate() {
        (point.point1, point.distance, point.code) = (new.point1, new.distance, 0);
        if new.distance < least {
            (deepest, least) = (at, new.distance);
        }
    }
    if let Some(point) = old.get_mut(deepest) {
        point.distance = choice.distance;
    }
    true
}

/// Sorts new points into the order in which they get ids: by ascending coordinate along an
/// [`askew`] direction. Takes the index and the position on the first solid of each point; returns
/// the coordinate and the index of each.
///
/// The direction is fixed in the frame of the first solid. If the points are the four corners of a
/// rectangle, the last is opposite to the first. In a solver that visits contacts in this order, as
/// most do, a stack sways a quarter as much as with corners in circular order.
#[inline(always)]
pub(in crate::collide) fn in_order<N: Real, const D: usize>(
    points: impl Iterator<Item = (usize, Point<N, D>)>,
) -> SmallVec<[(N, usize); 8]> {
    // An insertion sort: there are nearly always at most four new points, and mostly none.
    let mut order = SmallVec::<[(N, usize); 8]>::new();
    for (number, point) in points {
        let coordinate = askew(&point.coords);
        let mut at = order.len();
        order.push((coordinate, number));
        while at > 0 && order[at - 1].0 > coordinate {
            order.swap(at - 1, at);
            at -= 1;
        }
    }
    order
}

/// Replaces the points of a manifold by the `chosen` candidates, sorted by id. Candidates without
/// an id get new ids, in the order of [`in_order`].
pub(in crate::collide) fn replace_points<N: Real, const D: usize>(
    candidates: &mut [Candidate<N, D>],
    chosen: &[usize],
    out: &mut RawManifold<N, D>,
) {
    let new = chosen.iter().filter(|&&at| candidates[at].kept.is_none());
    for (_, at) in in_order(new.map(|&at| (at, candidates[at].point1))) {
        candidates[at].kept = Some(Inherited { id: out.ids.next(), is_old: false });
    }
    out.points.clear();
    for &at in chosen {
        let kept = candidates[at].kept.expect("the new ones have ids now, too");
        out.points.push(candidates[at].with_id(kept.id));
    }
    out.sort_points();
}
