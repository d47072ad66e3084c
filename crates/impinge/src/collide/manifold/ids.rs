//! The ids of contact points: a contact that moved keeps its id.
//!
//! Old points are matched to new ones in three classes, the nearest first within a class:
//!
//! 1. points on the same pair of features, no farther from where the old one was than [`SHARE`] of the pair's size;
//! 2. points on other features within that length: features flicker where edges coincide, and a corner that slides
//!    over the triangles of a mesh meets another one at each step;
//! 3. points on the same pair of features at any distance: the crossing of two edges may move fast.
//!
//! The distance is the smaller of two: how far the point has moved on the first solid, in the frame of that solid,
//! and on the second in its own frame; zero on a vertex of either. Lanes keep no old pose, so they compare places on the
//! first solid alone. So a corner that slides over a floor has not moved, nor has a point of the
//! floor that a solid slides over.
//!
//! ```text
//!           ┌─────────┐            ┌─────────┐
//!           │  first  │   slides   │  first  │
//!           └a───────b┘   ----->   └a───────b┘     a and b: at rest on the first solid
//!     ───────1───────2─────────────────────────    1 and 2: where they were on the second
//! ```
//!
//! Each id goes to one point. Ties go to the older id, then to the candidate that comes first: the order does not
//! depend on the order of the two solids, and scaling by a power of two changes no choice. Where each pair of features
//! names one point, as of two boxes, the same features are the same point and no place has to be compared ([`renew`],
//! and the codes of lanes).

use smallvec::SmallVec;

use super::super::ones::Ones;
use super::super::{RawManifold, RawPoint};
use super::frame::Candidate;
use crate::math::order::{order_of, sort_keyed};
use crate::math::{Point, Pose, Real, Vector};
use crate::shape::FeatureId;

/// A contact is the same one as long as it moves by no more than this part of the size of the smaller solid in a
/// step: half the diagonal of its box.
const SHARE: f64 = 1.0 / 16.0;

/// A contact point as it is matched: where it is anchored on either solid.
#[derive(Clone, Copy, Debug)]
pub(in crate::collide) struct Anchors<N: Real, const D: usize> {
    /// The parts of either composite, zero of a convex solid, and the features of the parts.
    names: ([u32; 2], [FeatureId; 2]),
    /// Where the point is on each solid, in that solid's frame.
    places: [Point<N, D>; 2],
}

/// How two solids lie: what it takes to find where a contact is on each of them.
#[derive(Clone, Copy)]
pub(in crate::collide) struct PairPose<'a, N: Real, const D: usize> {
    /// Of the second solid in the frame of the first; `None` if places on the second are not compared.
    pub(in crate::collide) pose12: Option<&'a Pose<N, D>>,
    /// Unit, from the first to the second, in the frame of the first.
    pub(in crate::collide) normal: &'a Vector<N, D>,
}

impl<N: Real, const D: usize> PairPose<'_, N, D> {
    /// The anchors of a contact, given its point on the first solid in the frame of that solid.
    #[inline]
    pub(in crate::collide) fn anchors(
        &self,
        point1: &Point<N, D>,
        distance: N,
        names: ([u32; 2], [FeatureId; 2]),
    ) -> Anchors<N, D> {
        let point2 = self.pose12.map_or_else(
            || Point::from(Vector::<N, D>::repeat(N::INFINITY)),
            |pose12| pose12.inverse_point(&(point1 + self.normal * distance)),
        );
        Anchors { names, places: [*point1, point2] }
    }
}

impl<N: Real, const D: usize> Anchors<N, D> {
    /// A number that points with the same names share, and few others.
    fn names_key(&self) -> u64 {
        let ([part1, part2], features) = self.names;
        let [feature1, feature2] = features.map(|id| match id {
            FeatureId::Vertex(number) => 3 * u64::from(number),
            FeatureId::Edge(number) => 3 * u64::from(number) + 1,
            FeatureId::Face(number) => 3 * u64::from(number) + 2,
        });
        let all = [u64::from(part1), u64::from(part2), feature1, feature2];
        // Steele, Lea and Flood, "Fast splittable pseudorandom number generators", 2014.
        all.iter()
            .fold(0, |sum: u64, &n| (sum.rotate_left(21) ^ n).wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }
}

/// The anchors of some points.
pub(in crate::collide) type AnchorList<N, const D: usize> = SmallVec<[Anchors<N, D>; 8]>;

/// The id that a new point inherits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::collide) struct Inherited {
    pub(in crate::collide) id: u32,
    /// The point is where the old one was. One that is not has moved far, and is not preferred in the choice of points.
    pub(in crate::collide) is_old: bool,
}

/// The three classes, above the other bits of a key.
const SAME: u64 = 0;
const NEAR: u64 = 1;
const FAR: u64 = 2;
const CLASS_AT: u32 = 62;

/// No pair has this key.
const NEVER: u64 = u64::MAX;

/// Up to so many old and new points all pairs are compared; of more, those that can be near are found first.
const FEW: usize = u32::BITS as usize;

/// Visits the index of each old point that goes on and that of the new point that it is now, and whether that is
/// where the old one was. `size` is that of the pair ([`smaller_size`](crate::collide::size::smaller_size)).
///
/// Cost: O(n log n) for n points that lie apart.
pub(in crate::collide) fn each_match<N: Real, const D: usize>(
    old: &[Anchors<N, D>],
    new: &[Anchors<N, D>],
    size: N,
    visit: &mut dyn FnMut(usize, usize, bool),
) {
    if old.len() <= FEW && new.len() <= FEW {
        match_few(old, new, near_scale(size), visit);
    } else {
        match_many(old, new, size, visit);
    }
}

/// [`each_match`] of points that are bits of a word.
fn match_few<N: Real, const D: usize>(
    old: &[Anchors<N, D>],
    new: &[Anchors<N, D>],
    scale: N,
    visit: &mut dyn FnMut(usize, usize, bool),
) {
    let all = |points: &[Anchors<N, D>]| u32::MAX.unbounded_shr(32 - points.len() as u32);
    nearest_first(
        [all(old), all(new)],
        NEVER,
        |at, other| key_of(&old[at], &new[other], scale),
        |at, other, key| visit(at, other, is_near(key)),
    );
}

/// Visits pairs of old and new points, both given by bits, the one with the smallest key first and each point once. Ties
/// go to the old point that comes first, then to the new one. Keys that are not below `never` make no pair.
#[inline(always)]
pub(in crate::collide) fn nearest_first<K: PartialOrd + Copy>(
    [old, mut new]: [u32; 2],
    never: K,
    key: impl Fn(usize, usize) -> K,
    mut visit: impl FnMut(usize, usize, K),
) {
    let best = |at: usize, new: u32| {
        let nearer = |best: (K, usize), other: usize| {
            let key = key(at, other);
            if key < best.0 { (key, other) } else { best }
        };
        Ones::<FEW>(new).fold((never, 0), nearer)
    };
    // Of each old point that is left the nearest new one.
    let mut nearest = SmallVec::<[(usize, K, usize); 8]>::new();
    for at in Ones::<FEW>(old) {
        let (key, other) = best(at, new);
        if key < never {
            nearest.push((at, key, other));
        }
    }
    while !nearest.is_empty() {
        let nearer = |a: usize, b: usize| if nearest[b].1 < nearest[a].1 { b } else { a };
        let first = (1..nearest.len()).fold(0, nearer);
        let (at, key, other) = nearest.remove(first);
        visit(at, other, key);
        new &= !(1 << other);
        nearest.retain(|entry| {
            if entry.2 == other {
                (entry.1, entry.2) = best(entry.0, new);
            }
            entry.1 < never
        });
    }
}

/// [`each_match`] by the sorted keys of the pairs that are possible.
fn match_many<N: Real, const D: usize>(
    old: &[Anchors<N, D>],
    new: &[Anchors<N, D>],
    size: N,
    visit: &mut dyn FnMut(usize, usize, bool),
) {
    let (mut pairs, mut keys, mut number) = (Vec::new(), Vec::new(), 0);
    each_possible(old, new, N::lit(SHARE) * size, &mut |at, other| {
        let key = key_of(&old[at], &new[other], near_scale(size));
        if key != NEVER {
            keys.push((key, number));
            pairs.push([at, other]);
            number += 1;
        }
    });
    sort_keyed(&mut keys);
    let mut is_taken = [vec![false; old.len()], vec![false; new.len()]];
    for (key, pair) in keys {
        let [at, other] = pairs[pair as usize];
        if !(is_taken[0][at] || is_taken[1][other]) {
            (is_taken[0][at], is_taken[1][other]) = (true, true);
            visit(at, other, is_near(key));
        }
    }
}

/// The one point is where the other was.
pub(in crate::collide) fn are_near<N: Real, const D: usize>(
    old: &Anchors<N, D>,
    new: &Anchors<N, D>,
    size: N,
) -> bool {
    moved(old, new, near_scale(size)) <= N::ONE
}

/// The key is one of the first two classes.
const fn is_near(key: u64) -> bool {
    key >> CLASS_AT < FAR
}

/// The key of a pair; [`NEVER`] if the two are not the same contact. `scale` is one over the length that counts as near.
#[inline]
fn key_of<N: Real, const D: usize>(old: &Anchors<N, D>, new: &Anchors<N, D>, scale: N) -> u64 {
    let moved = moved(old, new, scale);
    // Written so that NaN is far.
    let class = match (old.names == new.names, moved <= N::ONE) {
        (true, true) => SAME,
        (false, true) => NEAR,
        (true, false) => FAR,
        (false, false) => return NEVER,
    };
    key(class, moved)
}

/// Visits the pairs of many points that [`key_of`] may accept: of the same names, and, on either solid, within `length`
/// along the first axis.
fn each_possible<N: Real, const D: usize>(
    old: &[Anchors<N, D>],
    new: &[Anchors<N, D>],
    length: N,
    visit: &mut dyn FnMut(usize, usize),
) {
    let by_names = sorted(new, Anchors::names_key);
    let by_place = [0, 1].map(|solid| sorted(new, |point| order_of(point.places[solid][0])));
    for (at, point) in old.iter().enumerate() {
        let names = point.names_key();
        between(&by_names, [names; 2]).for_each(|other| visit(at, other));
        for (solid, order) in by_place.iter().enumerate() {
            let x = point.places[solid][0];
            between(order, [x - length, x + length].map(order_of))
                .for_each(|other| visit(at, other));
        }
    }
}

/// The sort key of a pair: its class, then `moved`, which is not negative, without its last two bits.
fn key<N: Real>(class: u64, moved: N) -> u64 {
    class << CLASS_AT | moved.as_f64().to_bits() >> 2
}

/// Returns the keys and indices of some points in the order of the keys.
fn sorted<N: Real, const D: usize>(
    points: &[Anchors<N, D>],
    key: impl Fn(&Anchors<N, D>) -> u64,
) -> Vec<(u64, u32)> {
    let mut keys: Vec<_> = points.iter().map(key).zip(0..).collect();
    sort_keyed(&mut keys);
    keys
}

/// Iterates over the indices whose keys lie between two, both included.
fn between(keys: &[(u64, u32)], [low, high]: [u64; 2]) -> impl Iterator<Item = usize> {
    let from = keys.partition_point(|&(key, _)| key < low);
    keys[from..].iter().take_while(move |&&(key, _)| key <= high).map(|&(_, at)| at as usize)
}

/// The square of the way that a point has moved on the solid where it is shorter, times the square of `scale`. On a
/// vertex it has not moved.
#[inline]
fn moved<N: Real, const D: usize>(old: &Anchors<N, D>, new: &Anchors<N, D>, scale: N) -> N {
    let names = |point: &Anchors<N, D>, solid: usize| (point.names.0[solid], point.names.1[solid]);
    let is_same = [0, 1].map(|solid| names(old, solid) == names(new, solid));
    if has_same_vertex(is_same, old.names.1) {
        return N::ZERO;
    }
    let on = |solid: usize| ((new.places[solid] - old.places[solid]) * scale).norm_squared();
    let [on1, on2] = [on(0), on(1)];
    // Written so that a place that is not known does not count.
    if on2 < on1 { on2 } else { on1 }
}

/// [`moved`] of two points of which the places on the first solid are known, as lanes know them. The old one is not on a
/// composite.
#[inline(always)]
pub(in crate::collide) fn moved_on_first<N: Real, const D: usize>(
    old: &RawPoint<N, D>,
    (new, features): (&Point<N, D>, [FeatureId; 2]),
    scale: N,
) -> N {
    let olds = [old.feature1, old.feature2];
    if has_same_vertex([olds[0] == features[0], olds[1] == features[1]], olds) {
        return N::ZERO;
    }
    ((new - old.point1) * scale).norm_squared()
}

/// A solid touches with the vertex that it did before.
#[inline(always)]
fn has_same_vertex(is_same: [bool; 2], old: [FeatureId; 2]) -> bool {
    let is_vertex = |id: FeatureId| matches!(id, FeatureId::Vertex(_));
    is_same[0] && is_vertex(old[0]) || is_same[1] && is_vertex(old[1])
}

/// One over the length that a contact of a pair of this size moves by in a step at most.
#[inline(always)]
pub(in crate::collide) fn near_scale<N: Real>(size: N) -> N {
    N::ONE / (N::lit(SHARE) * size)
}

/// A pair of features names one point: a vertex is among them. Edges may be round rims, which many points lie on.
pub(in crate::collide) fn is_one_point(features: [FeatureId; 2]) -> bool {
    features.iter().any(|id| matches!(id, FeatureId::Vertex(_)))
}

/// Gives candidates the ids of the old points that they continue, where a pair of features names one old and one new
/// point.
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

/// Gives those of some candidates that have none the ids that none of them has, by [`each_match`]; `pose` is the new
/// one, `size` that of the pair.
pub(in crate::collide) fn inherit_by_place<N: Real, const D: usize>(
    old: &RawManifold<N, D>,
    pose: &PairPose<'_, N, D>,
    size: impl Fn() -> N,
    candidates: &mut [Candidate<N, D>],
    some: &[usize],
) {
    let (mut news, mut places) = (AnchorList::new(), SmallVec::<[usize; 8]>::new());
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
        places.push(at);
    }
    if !news.is_empty() {
        each_match(&olds, &news, size(), &mut |at, new, is_old| {
            candidates[places[new]].kept = Some(Inherited { id: ids[at], is_old });
        });
    }
}

impl<N: Real, const D: usize> RawManifold<N, D> {
    /// The anchors of one of the points.
    #[inline]
    pub(in crate::collide) fn anchors(&self, point: &RawPoint<N, D>) -> Anchors<N, D> {
        let pose = PairPose { pose12: self.pose12.as_deref(), normal: &self.normal };
        let features = [point.feature1, point.feature2];
        pose.anchors(&point.point1, point.distance, ([0; 2], features))
    }
}

/// Moves the points of a manifold to the candidates, the nearest of which takes the separation's `distance`, if
/// they have the same features in the same order, each pair of features once; answers whether it did.
pub(in crate::collide) fn renew<N: Real, const D: usize>(
    candidates: &[Candidate<N, D>],
    distance: N,
    out: &mut RawManifold<N, D>,
) -> bool {
    let old = out.points.as_mut_slice();
    let is_same = |(point, new): (&RawPoint<N, D>, &Candidate<N, D>)| {
        point.feature1 == new.features[0] && point.feature2 == new.features[1]
    };
    if old.len() != candidates.len() || !old.iter().zip(candidates).all(is_same) {
        return false;
    }
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
        point.distance = distance;
    }
    true
}

/// Replaces the points of a manifold, in the order of their ids; those without one get the next.
pub(in crate::collide) fn settle<N: Real, const D: usize>(
    candidates: &[Candidate<N, D>],
    chosen: &[usize],
    out: &mut RawManifold<N, D>,
) {
    out.points.clear();
    for &index in chosen {
        let id = candidates[index].kept.map_or_else(|| out.ids.next(), |kept| kept.id);
        out.points.push(candidates[index].named(id));
    }
    out.sort_points();
}
