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
//! and on the second in its own frame. So a corner that slides over a floor has not moved, nor has a point of the
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
//! depend on the order of the two solids, and scaling by a power of two changes no choice. Where the same features
//! meet as before, each pair of them once, no place has to be compared ([`renew`], and the codes of lanes).

use smallvec::SmallVec;

use super::super::{Pair, RawManifold, RawPoint};
use super::frame::Candidate;
use crate::collide::size::smaller_size;
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
    /// Of the second solid in the frame of the first.
    pub(in crate::collide) pose12: &'a Pose<N, D>,
    /// Unit, from the first to the second, in the frame of the first.
    pub(in crate::collide) normal: &'a Vector<N, D>,
}

impl<N: Real, const D: usize> PairPose<'_, N, D> {
    /// The anchors of a contact, given its point on the first solid in the frame of that solid.
    pub(in crate::collide) fn anchors(
        &self,
        point1: &Point<N, D>,
        distance: N,
        names: ([u32; 2], [FeatureId; 2]),
    ) -> Anchors<N, D> {
        let point2 = self.pose12.inverse_point(&(point1 + self.normal * distance));
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
pub(in crate::collide) type AnchorList<N, const D: usize> = SmallVec<[Anchors<N, D>; 16]>;

/// The three classes, above the other bits of a key.
const SAME: u64 = 0;
const NEAR: u64 = 1;
const FAR: u64 = 2;
const CLASS_AT: u32 = 62;

/// Old and new points that may be the same, by their indices.
type IndexPairs = SmallVec<[[u32; 2]; 32]>;

/// Whole numbers to sort by, each with an index.
type SortKeys = SmallVec<[(u64, u32); 32]>;

/// The id that a new point inherits.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::collide) struct Inherited {
    pub(in crate::collide) id: u32,
    /// The point is where the old one was. One that is not has moved far, and is not preferred in the choice of points.
    pub(in crate::collide) is_old: bool,
}

/// Returns for each new point the old one that it continues, whose ids are given. `size` is that of the pair
/// ([`smaller_size`]).
///
/// Cost: O(n log n) for n points that lie apart.
pub(in crate::collide) fn matched<N: Real, const D: usize>(
    old: &[Anchors<N, D>],
    ids: impl Fn(usize) -> u32,
    new: &[Anchors<N, D>],
    size: N,
) -> SmallVec<[Option<Inherited>; 16]> {
    let mut kept: SmallVec<[Option<Inherited>; 16]> = SmallVec::from_elem(None, new.len());
    let mut is_taken: SmallVec<[bool; 16]> = SmallVec::from_elem(false, old.len());
    let (mut pairs, mut keys, mut number) = (IndexPairs::new(), SortKeys::new(), 0);
    find_pairs(old, new, N::lit(SHARE) * size, |key, pair| {
        keys.push((key, number));
        pairs.push(pair);
        number += 1;
    });
    sort_keyed(&mut keys);
    for &(key, at) in &keys {
        let [old, new] = pairs[at as usize].map(|index| index as usize);
        if kept[new].is_none() && !is_taken[old] {
            let is_old = key >> CLASS_AT < FAR;
            (kept[new], is_taken[old]) = (Some(Inherited { id: ids(old), is_old }), true);
        }
    }
    kept
}

/// Visits all pairs of an old and a new point that may be the same, with a key that is lower for better pairs.
///
/// New points are looked up in three sorted lists: by names, and on either solid by the first coordinate, in which
/// no match is farther than `length`.
fn find_pairs<N: Real, const D: usize>(
    old: &[Anchors<N, D>],
    new: &[Anchors<N, D>],
    length: N,
    mut visit: impl FnMut(u64, [u32; 2]),
) {
    let by_names = sorted(new, |anchors| anchors.names_key());
    let by_place = [0, 1].map(|solid| sorted(new, |anchors| order_of(anchors.places[solid][0])));
    for (anchors, number) in old.iter().zip(0..) {
        let names = anchors.names_key();
        for (other, at) in between(&by_names, [names; 2]).map(|at| (&new[at as usize], at)) {
            if other.names == anchors.names {
                let moved = moved(anchors, other, length);
                // Written so that NaN is far.
                let class = if moved <= N::ONE { SAME } else { FAR };
                visit(key(class, moved), [number, at]);
            }
        }
        for (solid, order) in by_place.iter().enumerate() {
            let x = anchors.places[solid][0];
            let ends = [x - length, x + length].map(order_of);
            for (other, at) in between(order, ends).map(|at| (&new[at as usize], at)) {
                let moved = moved(anchors, other, length);
                if moved <= N::ONE && other.names != anchors.names {
                    visit(key(NEAR, moved), [number, at]);
                }
            }
        }
    }
}

/// The sort key of a pair: its class, then `moved`, which is not negative, without its last two bits.
fn key<N: Real>(class: u64, moved: N) -> u64 {
    class << CLASS_AT | moved.as_f64().to_bits() >> 2
}

/// Returns the keys and indices of some anchors in the order of the keys.
fn sorted<N: Real, const D: usize>(
    anchors: &[Anchors<N, D>],
    key: impl Fn(&Anchors<N, D>) -> u64,
) -> SortKeys {
    let mut keys: SortKeys = anchors.iter().map(key).zip(0..).collect();
    sort_keyed(&mut keys);
    keys
}

/// Iterates over the indices whose keys lie between two, both included.
fn between(keys: &SortKeys, [low, high]: [u64; 2]) -> impl Iterator<Item = u32> {
    let from = keys.partition_point(|&(key, _)| key < low);
    keys[from..].iter().take_while(move |&&(key, _)| key <= high).map(|&(_, at)| at)
}

/// The square of the way that a point has moved on the solid where it is shorter, in units of `length`.
fn moved<N: Real, const D: usize>(old: &Anchors<N, D>, new: &Anchors<N, D>, length: N) -> N {
    let on = |solid: usize| ((new.places[solid] - old.places[solid]) / length).norm_squared();
    let [on1, on2] = [on(0), on(1)];
    // Written so that a place that is not known does not count.
    if on2 < on1 { on2 } else { on1 }
}

/// Gives candidates the ids of the old points that they continue; `normal` is the new one.
pub(in crate::collide) fn inherit<N: Real, const D: usize>(
    old: &RawManifold<N, D>,
    pair: &Pair<'_, N, D>,
    normal: &Vector<N, D>,
    candidates: &mut [Candidate<N, D>],
) {
    if old.points.is_empty() {
        return;
    }
    let pose = PairPose { pose12: &pair.pose12, normal };
    let anchors =
        |new: &Candidate<N, D>| pose.anchors(&new.point1, new.distance, ([0; 2], new.features));
    let new: AnchorList<N, D> = candidates.iter().map(anchors).collect();
    let (ids, size) = (|at: usize| old.points[at].id, smaller_size([pair.first, pair.second]));
    for (candidate, kept) in candidates.iter_mut().zip(matched(&old.anchors(), ids, &new, size)) {
        candidate.kept = kept;
    }
}

impl<N: Real, const D: usize> RawManifold<N, D> {
    /// The anchors of the points.
    pub(in crate::collide) fn anchors(&self) -> AnchorList<N, D> {
        let pose = PairPose { pose12: &self.pose12, normal: &self.normal };
        let anchors = |old: &RawPoint<N, D>| {
            pose.anchors(&old.point1, old.distance, ([0; 2], [old.feature1, old.feature2]))
        };
        self.points.iter().map(anchors).collect()
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
