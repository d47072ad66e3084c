//! The distances and separations of many pairs of convex solids, eight at a time where their kinds have lanes.

use super::LANES;
use super::gather::put;
use super::segments3::nearest_of_segments;
use super::vectors::{bits, dot, minus};
use crate::collide::Pair;
use crate::collide::separation::segments::nearest::core;
use crate::collide::separation::{
    apart, distance_in_plane, distance_in_space, is_usual, separation_in_plane, separation_in_space,
};
use crate::convex::Separation;
use crate::math::lanes::{load, with_lanes};
use crate::math::simd::{Level, Simd};
use crate::math::{Real, Wide};
use crate::shape::{Geometry, Kind, ShapeKind};

/// A pair of convex solids in canonical order and the slot of its answer.
pub(crate) struct ConvexPair<'a, N: Real, const D: usize> {
    pub(crate) slot: usize,
    /// The canonical order is the opposite of the given one.
    pub(crate) swapped: bool,
    pub(crate) pair: Pair<'a, N, D>,
}

impl<N: Real, const D: usize> ConvexPair<'_, N, D> {
    fn kinds(&self) -> [ShapeKind; 2] {
        [Geometry(self.pair.first).kind(), Geometry(self.pair.second).kind()]
    }
}

/// Fills the slots of all pairs of the plane with their distances, each with the bits of a lone pair; negative or zero
/// where they overlap, `None` beyond a limit of zero or more.
pub(crate) fn distances2<N: Real>(
    pairs: &mut [ConvexPair<'_, N, 2>],
    limit: N,
    out: &mut [Option<N>],
) {
    for ConvexPair { slot, pair, .. } in pairs {
        out[*slot] = distance_in_plane(pair, limit);
    }
}

/// Fills the slots of all pairs of the plane with their separations, each with the bits of a lone pair.
pub(crate) fn separations2<N: Real>(
    pairs: &mut [ConvexPair<'_, N, 2>],
    limit: N,
    out: &mut [Option<Separation<N, 2>>],
) {
    for ConvexPair { slot, pair, .. } in pairs {
        out[*slot] = separation_in_plane(pair, limit);
    }
}

/// [`distances2`] of pairs in 3D, which are brought in the order of their kinds.
pub(crate) fn distances3<N: Real>(
    pairs: &mut [ConvexPair<'_, N, 3>],
    limit: N,
    out: &mut [Option<N>],
) {
    each_packet(pairs, |packet| {
        let found = if are(packet, is_segment) {
            of_segments(packet, limit)
        } else if are(packet, apart::is_faceted) {
            apart::distances(packet.iter().map(|one| &one.pair), limit)
        } else {
            [None; LANES]
        };
        fill(packet, out, found, |pair| distance_in_space(pair, limit));
    });
}

/// [`separations2`] of pairs in 3D, which are brought in the order of their kinds.
pub(crate) fn separations3<N: Real>(
    pairs: &mut [ConvexPair<'_, N, 3>],
    limit: N,
    out: &mut [Option<Separation<N, 3>>],
) {
    each_packet(pairs, |packet| {
        let found = if are(packet, apart::is_faceted) {
            apart::separations(packet.iter().map(|one| &one.pair), limit)
        } else {
            [None; LANES]
        };
        fill(packet, out, found, |pair| separation_in_space(pair, limit));
    });
}

/// Calls with up to eight pairs of the same kinds at a time.
fn each_packet<'a, N: Real>(
    pairs: &mut [ConvexPair<'a, N, 3>],
    mut work: impl FnMut(&[ConvexPair<'a, N, 3>]),
) {
    if !pairs.is_sorted_by_key(ConvexPair::kinds) {
        pairs.sort_unstable_by_key(ConvexPair::kinds);
    }
    for same in pairs.chunk_by(|one, other| one.kinds() == other.kinds()) {
        same.chunks(LANES).for_each(&mut work);
    }
}

/// Both solids of these pairs of the same kinds are of some, and there are enough for lanes: a packet costs as much as
/// three or four lone pairs.
fn are<N: Real>(packet: &[ConvexPair<'_, N, 3>], is_one: fn(&Kind<'_, N, 3>) -> bool) -> bool {
    let Pair { first, second, .. } = &packet[0].pair;
    packet.len() >= LANES / 2 && is_one(first) && is_one(second)
}

const fn is_segment<N: Real>(kind: &Kind<'_, N, 3>) -> bool {
    matches!(kind, Kind::Segment(_) | Kind::Capsule(_))
}

/// Fills the slots of some pairs with what lanes have found, or with what is found of a lone pair.
#[inline]
fn fill<'a, N: Real, T>(
    packet: &[ConvexPair<'a, N, 3>],
    out: &mut [Option<T>],
    found: [Option<Option<T>>; LANES],
    lone: impl Fn(&Pair<'a, N, 3>) -> Option<T>,
) {
    for (ConvexPair { slot, pair, .. }, found) in packet.iter().zip(found) {
        out[*slot] = found.unwrap_or_else(|| lone(pair));
    }
}

/// The distances of segments and capsules, as `segment_segment::distance` has them, without those beyond the limit;
/// `None` where a lone pair has to be asked.
fn of_segments<N: Real>(packet: &[ConvexPair<'_, N, 3>], limit: N) -> [Option<Option<N>>; LANES] {
    let mut ends = [[[[N::ZERO; LANES]; 3]; 2]; 2];
    let mut radii = [[N::ZERO; 2]; LANES];
    for (lane, ConvexPair { pair, .. }) in packet.iter().enumerate() {
        let (ends1, radius1) = core(pair, &pair.first);
        let (local2, radius2) = core(pair, &pair.second);
        let ends2 = [pair.pose12.point(&local2[0]), pair.pose12.point(&local2[1])];
        radii[lane] = [radius1, radius2];
        for end in 0..2 {
            put(&mut ends[0][end], lane, &ends1[end].coords);
            put(&mut ends[1][end], lane, &ends2[end].coords);
        }
    }
    let mut found = [N::ZERO; LANES];
    let is_known =
        with_lanes!(Level::new(), simd => between::<_, N, N::Lanes<_>>(simd, &ends, &mut found));
    let mut distances = [None; LANES];
    for (lane, distance) in distances.iter_mut().enumerate() {
        let [radius1, radius2] = radii[lane];
        let known = found[lane] - radius1 - radius2;
        *distance =
            (is_known >> lane & 1 == 1).then_some(Some(known).filter(|known| *known <= limit));
    }
    distances
}

/// The distances of segments, and the lanes in which they are known.
#[inline(always)]
fn between<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    ends: &[[[[N; LANES]; 3]; 2]; 2],
    distances: &mut [N; LANES],
) -> u8 {
    let ends1: [[V; 3]; 2] = [load(simd, &ends[0][0]), load(simd, &ends[0][1])];
    let ends2: [[V; 3]; 2] = [load(simd, &ends[1][0]), load(simd, &ends[1][1])];
    let (points, is_moderate) = nearest_of_segments(simd, &ends1, &ends2);
    let between = minus(&points[1], &points[0]);
    let squared = dot(&between, &between);
    squared.sqrt().store(distances);
    bits(is_moderate & is_usual(simd, squared))
}
