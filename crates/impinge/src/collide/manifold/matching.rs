//! Matches new contact points to old ones: greedily, by the classes and distances of
//! [`ids`](super::ids).
//!
//! ```text
//!   key   63 62   61 ... 0
//!         class   bits of `moved` as an `f64`, less the last two    smallest keys match first
//! ```
//!
//! Up to 32 old and 32 new points are bits of a `u32`, and all pairs are compared. For more points,
//! only pairs that may match are compared: a list sorted by features gives the pairs with equal
//! features, and lists sorted by the first coordinate the pairs that may be near on either solid.
//! The kernels of `batch` have no positions on the second solid; for them [`each_near`] compares
//! positions on the first, and the vertices of the second that points lie on.

use super::ids::{Anchors, REACH, SHARE, are_edges, moved, near_scale};
use crate::math::ones::Ones;
use crate::math::order::{order_of, sort_keyed};
use crate::math::{Mapped, Real};
use crate::shape::FeatureId;

/// Class of two points with the same features that are near: at most the near length apart, which
/// is `SHARE` of the pair's size.
const SAME: u64 = 0;
/// Class of two points with different features that are near.
const NEAR: u64 = 1;
/// Class of two points with the same features that are farther apart than the near length.
const FAR: u64 = 2;
/// Position of the class in a key.
const CLASS_AT: u32 = 62;

/// Largest squared distance of two crossings of the same two edges in the class `FAR`, in units of
/// the squared near length.
const FARTHEST: f64 = (REACH / SHARE) * (REACH / SHARE);

/// Key of pairs that do not match.
const NEVER: u64 = u64::MAX;

/// Up to this number of old and of new points, all pairs are compared.
const FEW: usize = u32::BITS as usize;

/// Calls `visit` for each match with the index of the old point, the index of the new point, and
/// whether the two are near each other. `size` is the size of the pair
/// ([`smaller_size`](crate::collide::size::smaller_size)).
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

/// Runs [`each_match`] for at most [`FEW`] old and new points, as bits of a word.
fn match_few<N: Real, const D: usize>(
    old: &[Anchors<N, D>],
    new: &[Anchors<N, D>],
    scale: N,
    visit: &mut dyn FnMut(usize, usize, bool),
) {
    let nearest =
        |at: usize, among: u32| least(among, NEVER, |other| key_of(&old[at], &new[other], scale));
    nearest_first([all(old.len()), all(new.len())], NEVER, nearest, |at, other, key| {
        visit(at, other, is_near(key));
    });
}

/// Returns the mask with the lowest `count` bits set.
#[inline(always)]
fn all(count: usize) -> u32 {
    u32::MAX.unbounded_shr(u32::try_from(FEW - count).unwrap_or(0))
}

/// Returns the smallest key of the points in a mask, and the first point that has it; `never` and 0
/// if no key is smaller than `never`.
#[inline(always)]
fn least<K: PartialOrd>(among: u32, never: K, key: impl Fn(usize) -> K) -> (K, usize) {
    let mut least = (never, 0);
    for at in Ones::<FEW>(among) {
        let key = key(at);
        if key < least.0 {
            least = (key, at);
        }
    }
    least
}

/// Matches old and new points greedily, smallest key first, each point at most once. Visits the
/// matches in any order. `old` and `new` are masks of points. Ties go to the old point with the
/// lower index, then to the new point with the lower index. Pairs with a key not below `never` are
/// skipped.
///
/// `nearest` returns the [`least`] key of an old point among the new points in a mask.
#[inline(always)]
fn nearest_first<K: PartialOrd + Copy>(
    [mut old, mut new]: [u32; 2],
    never: K,
    nearest: impl Fn(usize, u32) -> (K, usize),
    mut visit: impl FnMut(usize, usize, K),
) {
    let (mut keys, mut others) = ([never; FEW], [0; FEW]);
    let mut pending = old;
    loop {
        for at in Ones::<FEW>(pending) {
            (keys[at], others[at]) = nearest(at, new);
            let has_one = keys[at] < never;
            // The set of new points only shrinks, so an old point without a match now has none
            // later.
            old &= !(u32::from(!has_one) << at);
        }
        // New points that are nearest to at least one old point.
        let taken = Ones::<FEW>(old).fold(0_u32, |bits, at| bits | 1 << others[at]);
        if taken.count_ones() == old.count_ones() {
            // In most cases the nearest new points of all old points differ, and the matching is
            // complete.
            return Ones::<FEW>(old).for_each(|at| visit(at, others[at], keys[at]));
        }
        let (key, first) = least(old, never, |at| keys[at]);
        let taken = others[first];
        visit(first, taken, key);
        (old, new) = (old & !(1 << first), new & !(1 << taken));
        pending = Ones::<FEW>(old).fold(0, |bits, at| bits | u32::from(others[at] == taken) << at);
    }
}

/// Runs [`each_match`] for any number of points, by the sorted keys of all possible pairs.
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

/// Matches points by position and visits the matches; features count only through `same_vertex`.
/// Points do not match if their distance exceeds the near length (`SHARE` of the pair's size).
/// `old` and `new` are masks of points.
///
/// `moved` returns the squared distance of an old and a new point in units of the squared near
/// length. `same_vertex` returns, for an old point and a mask of new points, the new points on the
/// same vertex of the second solid; they count as not moved.
#[inline(always)]
pub(in crate::collide) fn each_near<N: Real>(
    [old, new]: [u32; 2],
    same_vertex: impl Fn(usize, u32) -> u32,
    moved: impl Fn(usize, usize) -> N,
    mut visit: impl FnMut(usize, usize),
) {
    let never = N::ONE + N::EPSILON;
    let nearest = |at: usize, among: u32| match same_vertex(at, among) {
        0 => least(among, never, |new| moved(at, new)),
        same => (N::ZERO, same.trailing_zeros() as usize),
    };
    nearest_first([old, new], never, nearest, |at, new, _| visit(at, new));
}

/// Returns whether a key is in one of the two near classes.
const fn is_near(key: u64) -> bool {
    key >> CLASS_AT < FAR
}

/// Returns the key of a pair; [`NEVER`] if the points do not match. `scale` is the reciprocal of
/// the near length.
#[inline]
fn key_of<N: Real, const D: usize>(old: &Anchors<N, D>, new: &Anchors<N, D>, scale: N) -> u64 {
    // The first coordinates exclude most pairs. Written so that NaN counts as far.
    let is_beside = |solid: usize| {
        ((new.positions[solid][0] - old.positions[solid][0]) * scale).abs() <= N::ONE
    };
    let is_same = old.ids == new.ids;
    if !(is_same | is_beside(0) | is_beside(1)) {
        return NEVER;
    }
    let moved = moved(old, new, scale);
    let class = match (is_same, moved <= N::ONE) {
        (true, true) => SAME,
        (false, true) => NEAR,
        (true, false) if moved <= N::lit(FARTHEST) || !are_edges(old.ids.1) => FAR,
        _ => return NEVER,
    };
    key(class, moved)
}

/// Visits the pairs of many points that [`key_of`] may accept: pairs with the same features, and
/// pairs within `length` along the first axis on either solid.
fn each_possible<N: Real, const D: usize>(
    old: &[Anchors<N, D>],
    new: &[Anchors<N, D>],
    length: N,
    visit: &mut dyn FnMut(usize, usize),
) {
    let by_ids = sorted(new, Anchors::ids_key);
    let by_position = [0, 1].map(|solid| sorted(new, |point| order_of(point.positions[solid][0])));
    for (at, point) in old.iter().enumerate() {
        let key = point.ids_key();
        between(&by_ids, [key; 2]).for_each(|other| visit(at, other));
        for (solid, order) in by_position.iter().enumerate() {
            let x = point.positions[solid][0];
            between(order, [x - length, x + length].mapped(order_of))
                .for_each(|other| visit(at, other));
        }
    }
}

/// Returns the sort key of a pair: its class, then the bits of `moved`, which must not be negative,
/// without the last two.
fn key<N: Real>(class: u64, moved: N) -> u64 {
    class << CLASS_AT | moved.as_f64().to_bits() >> 2
}

/// Returns the keys and indices of some points, sorted by key.
fn sorted<N: Real, const D: usize>(
    points: &[Anchors<N, D>],
    key: impl Fn(&Anchors<N, D>) -> u64,
) -> Vec<(u64, u32)> {
    let mut keys: Vec<_> = points.iter().map(key).zip(0..).collect();
    sort_keyed(&mut keys);
    keys
}

/// Iterates over the indices whose keys lie between `low` and `high`, both inclusive.
fn between(keys: &[(u64, u32)], [low, high]: [u64; 2]) -> impl Iterator<Item = usize> {
    let from = keys.partition_point(|&(key, _)| key < low);
    keys[from..].iter().take_while(move |&&(key, _)| key <= high).map(|&(_, at)| at as usize)
}

impl<N: Real, const D: usize> Anchors<N, D> {
    /// Returns a hash of the parts and features of a point; points with equal parts and features
    /// have equal hashes.
    fn ids_key(&self) -> u64 {
        let ([part1, part2], features) = self.ids;
        let [feature1, feature2] = features.mapped(|id| match id {
            FeatureId::Vertex(number) => 3 * u64::from(number),
            FeatureId::Edge(number) => 3 * u64::from(number) + 1,
            FeatureId::Face(number) => 3 * u64::from(number) + 2,
        });
        let all = [u64::from(part1), u64::from(part2), feature1, feature2];
        // The multiplier is from Steele, Lea and Flood, "Fast splittable pseudorandom number
        // generators", 2014.
        all.iter()
            .fold(0, |sum: u64, &n| (sum.rotate_left(21) ^ n).wrapping_mul(0x9e37_79b9_7f4a_7c15))
    }
}
