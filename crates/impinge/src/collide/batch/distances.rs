//! The distances of many pairs of convex solids, eight at a time where their kinds have lanes.

use super::LANES;
use super::gather::put;
use super::segments3::nearest_of_segments;
use super::vectors::{bits, dot, minus};
use crate::collide::Pair;
use crate::collide::separation::segments::nearest::core;
use crate::collide::separation::{apart, distance_in_plane, distance_in_space, is_usual};
use crate::math::lanes::{load, with_lanes};
use crate::math::simd::{Level, Simd};
use crate::math::{Real, Wide};
use crate::shape::{Geometry, Kind, ShapeKind};

/// A pair of convex solids and the slot of its answer.
pub(crate) struct SlottedPair<'a, N: Real, const D: usize> {
    pub(crate) slot: usize,
    pub(crate) pair: Pair<'a, N, D>,
}

impl<N: Real, const D: usize> SlottedPair<'_, N, D> {
    fn kinds(&self) -> [ShapeKind; 2] {
        [Geometry(self.pair.first).kind(), Geometry(self.pair.second).kind()]
    }
}

/// Fills the slots of all pairs of the plane with their distances, each with the bits of a lone pair; negative or zero
/// where they overlap.
pub(crate) fn distances2<N: Real>(pairs: &mut [SlottedPair<'_, N, 2>], out: &mut [Option<N>]) {
    for SlottedPair { slot, pair } in pairs {
        out[*slot] = distance_in_plane(pair, N::INFINITY);
    }
}

/// The same of pairs in 3D. The pairs are brought in the order of their kinds.
pub(crate) fn distances3<N: Real>(pairs: &mut [SlottedPair<'_, N, 3>], out: &mut [Option<N>]) {
    if !pairs.is_sorted_by_key(SlottedPair::kinds) {
        pairs.sort_unstable_by_key(SlottedPair::kinds);
    }
    for same in pairs.chunk_by(|one, other| one.kinds() == other.kinds()) {
        for packet in same.chunks(LANES) {
            let found = in_lanes(packet);
            for (SlottedPair { slot, pair }, found) in packet.iter().zip(found) {
                out[*slot] = found.or_else(|| distance_in_space(pair, N::INFINITY));
            }
        }
    }
}

/// The distances of up to eight pairs of the same kinds; `None` where a lone pair has to be asked.
#[inline]
fn in_lanes<N: Real>(packet: &[SlottedPair<'_, N, 3>]) -> [Option<N>; LANES] {
    let is_segment = |kind| matches!(kind, Kind::Segment(_) | Kind::Capsule(_));
    let Pair { first, second, .. } = packet[0].pair;
    // A packet costs as much as three or four lone pairs.
    if packet.len() < LANES / 2 {
        [None; LANES]
    } else if is_segment(first) && is_segment(second) {
        of_segments(packet)
    } else if apart::is_faceted(&first) && apart::is_faceted(&second) {
        apart::distances(packet.iter().map(|slotted| &slotted.pair))
    } else {
        [None; LANES]
    }
}

/// The distances of segments and capsules, as `segment_segment::distance` has them.
fn of_segments<N: Real>(packet: &[SlottedPair<'_, N, 3>]) -> [Option<N>; LANES] {
    let mut ends = [[[[N::ZERO; LANES]; 3]; 2]; 2];
    let mut radii = [[N::ZERO; 2]; LANES];
    for (lane, SlottedPair { pair, .. }) in packet.iter().enumerate() {
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
        *distance = (is_known >> lane & 1 == 1).then(|| found[lane] - radius1 - radius2);
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
