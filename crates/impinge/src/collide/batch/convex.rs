//! Computes distances and separations of many pairs of convex solids. In 3D, kinds with a kernel
//! are computed 8 pairs at a time.
//!
//! ```text
//!   pairs in 3D, sorted by kinds   [bb bb bb | ss ss ... ss ss | cc ...]    b ball, s segment,
//!   packets of 8, of the same kinds           [0 .. 7] [8 .. ]              c box
//!   out[slot]                                 each pair has its `slot`, so it may be moved
//! ```
//!
//! A packet that is at least half full runs in a kernel: pairs of segments or capsules in this
//! module, pairs of faceted solids in `collide/separation/apart/`. All other pairs are computed one
//! by one. The separations of kernels and of single pairs are bit-identical, and so are the
//! distances of solids that are apart.

use super::LANES;
use super::gather::put;
use super::segments3::nearest_of_segments;
use super::vectors::{bits, dot, minus};
use crate::collide::Pair;
use crate::collide::separation::segments::nearest::core;
use crate::collide::separation::segments::segment_segment::of_points;
use crate::collide::separation::{
    apart, distance_2d, distance_3d, is_square_in_range, separation_2d, separation_3d,
};
use crate::convex::Separation;
use crate::math::lanes::{load, with_vectors};
use crate::math::order::sort_few;
use crate::math::simd::{Level, Simd, Vectors};
use crate::math::{Point, Real, Wide};
use crate::shape::{Geometry, Kind, ShapeKind};

/// A pair of convex solids in canonical order, and the index of its result.
pub(crate) struct ConvexPair<'a, N: Real, const D: usize> {
    /// Index of the result in the output slice.
    pub(crate) slot: usize,
    /// Whether the canonical order is the reverse of the caller's order.
    pub(crate) swapped: bool,
    pub(crate) pair: Pair<'a, N, D>,
}

impl<N: Real, const D: usize> ConvexPair<'_, N, D> {
    fn kinds(&self) -> [ShapeKind; 2] {
        [Geometry(self.pair.first).kind(), Geometry(self.pair.second).kind()]
    }
}

/// Writes the distance of each pair in 2D to its `slot` of `out`, as [`distance_2d`] returns it:
/// zero or negative for an overlap, `None` beyond `limit`. `limit` must be zero or more.
pub(crate) fn distances2<N: Real>(
    pairs: &mut [ConvexPair<'_, N, 2>],
    limit: N,
    out: &mut [Option<N>],
) {
    for ConvexPair { slot, pair, .. } in pairs {
        out[*slot] = distance_2d(pair, limit);
    }
}

/// Writes the separation of each pair in 2D to its `slot` of `out`, as [`separation_2d`] returns
/// it: `None` beyond `limit`.
pub(crate) fn separations2<N: Real>(
    pairs: &mut [ConvexPair<'_, N, 2>],
    limit: N,
    out: &mut [Option<Separation<N, 2>>],
) {
    for ConvexPair { slot, pair, .. } in pairs {
        out[*slot] = separation_2d(pair, limit);
    }
}

/// Writes the distance of each pair in 3D to its `slot` of `out`: bit-identical to [`distance_3d`]
/// if the solids are apart, any number that is not positive if they overlap, `None` beyond `limit`.
/// `limit` must be zero or more. Sorts the pairs by kinds.
pub(crate) fn distances3<N: Real>(
    pairs: &mut [ConvexPair<'_, N, 3>],
    limit: N,
    out: &mut [Option<N>],
) {
    each_packet(pairs, |packet| {
        let found = if let Some(vectors) = lanes_for(packet, is_segment) {
            SegmentPacket::new(vectors, packet).distances(limit)
        } else if lanes_for(packet, apart::is_faceted).is_some() {
            apart::distances(packet.iter().map(|one| &one.pair), limit)
        } else {
            [None; LANES]
        };
        fill(packet, out, found, |pair| distance_3d(pair, limit));
    });
}

/// Writes the separation of each pair in 3D to its `slot` of `out`, bit-identical to
/// [`separation_3d`]: `None` beyond `limit`. Sorts the pairs by kinds.
pub(crate) fn separations3<N: Real>(
    pairs: &mut [ConvexPair<'_, N, 3>],
    limit: N,
    out: &mut [Option<Separation<N, 3>>],
) {
    each_packet(pairs, |packet| {
        let found = if let Some(vectors) = lanes_for(packet, is_segment) {
            SegmentPacket::new(vectors, packet).separations(limit)
        } else if lanes_for(packet, apart::is_faceted).is_some() {
            apart::separations(packet.iter().map(|one| &one.pair), limit)
        } else {
            [None; LANES]
        };
        fill(packet, out, found, |pair| separation_3d(pair, limit));
    });
}

/// Sorts the pairs by kinds, then calls `work` with up to 8 pairs of the same kinds at a time.
fn each_packet<'a, N: Real>(
    pairs: &mut [ConvexPair<'a, N, 3>],
    mut work: impl FnMut(&[ConvexPair<'a, N, 3>]),
) {
    if !pairs.is_sorted_by_key(ConvexPair::kinds) {
        sort_few(pairs, |one, other| one.kinds() < other.kinds());
    }
    for same in pairs.chunk_by(|one, other| one.kinds() == other.kinds()) {
        same.chunks(LANES).for_each(&mut work);
    }
}

/// Returns the SIMD vectors for a packet of pairs of the same kinds. `None` if kernels do not use
/// vectors on this machine, if `is_one` is `false` for one of the two kinds, or if the packet is
/// less than half full: a packet costs as much as three or four single pairs.
fn lanes_for<N: Real>(
    packet: &[ConvexPair<'_, N, 3>],
    is_one: fn(&Kind<'_, N, 3>) -> bool,
) -> Option<Vectors> {
    let Pair { first, second, .. } = &packet[0].pair;
    let vectors = Level::new().vectors()?;
    (packet.len() >= LANES / 2 && is_one(first) && is_one(second)).then_some(vectors)
}

const fn is_segment<N: Real>(kind: &Kind<'_, N, 3>) -> bool {
    matches!(kind, Kind::Segment(_) | Kind::Capsule(_))
}

/// Writes the results of a packet to `out`. Pairs whose entry of `found` is `None` are computed by
/// `lone`.
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

/// Up to 8 pairs of segments or capsules.
struct SegmentPacket<N: Real> {
    /// Ends of the cores of each lane, in the frame of its first solid.
    ends: [[[Point<N, 3>; 2]; 2]; LANES],
    /// Radii around both cores of each lane.
    radii: [[N; 2]; LANES],
    /// Nearest points of both cores, by coordinate and lane.
    points: [[[N; LANES]; 3]; 2],
    /// Distances of the cores; the radii are not subtracted.
    distances: [N; LANES],
    /// Bits of the lanes with known nearest points; the pairs in other lanes are computed one by
    /// one.
    is_known: u8,
}

impl<N: Real> SegmentPacket<N> {
    /// Gathers the pairs and computes the nearest points of all lanes.
    fn new(vectors: Vectors, packet: &[ConvexPair<'_, N, 3>]) -> Self {
        let row = [N::ZERO; LANES];
        let mut found = Self {
            ends: [[[Point::origin(); 2]; 2]; LANES],
            radii: [[N::ZERO; 2]; LANES],
            points: [[row; 3]; 2],
            distances: row,
            is_known: 0,
        };
        let mut ends = [[[row; 3]; 2]; 2];
        for (lane, ConvexPair { pair, .. }) in packet.iter().enumerate() {
            let (ends1, radius1) = core(pair, &pair.first);
            let (local2, radius2) = core(pair, &pair.second);
            let ends2 = [pair.pose12.point(&local2[0]), pair.pose12.point(&local2[1])];
            found.radii[lane] = [radius1, radius2];
            for end in 0..2 {
                put(&mut ends[0][end], lane, &ends1[end].coords);
                put(&mut ends[1][end], lane, &ends2[end].coords);
            }
            found.ends[lane] = [ends1, ends2];
        }
        with_vectors!(vectors, simd => found.search::<_, N::Lanes<_>>(simd, &ends));
        found
    }

    /// Computes nearest points and distances of the cores in all lanes.
    #[inline(always)]
    fn search<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        ends: &[[[[N; LANES]; 3]; 2]; 2],
    ) {
        let ends1: [[V; 3]; 2] = [load(simd, &ends[0][0]), load(simd, &ends[0][1])];
        let ends2: [[V; 3]; 2] = [load(simd, &ends[1][0]), load(simd, &ends[1][1])];
        let (points, has_scale) = nearest_of_segments(simd, &ends1, &ends2);
        let between = minus(&points[1], &points[0]);
        let squared = dot(&between, &between);
        squared.sqrt().store(&mut self.distances);
        for (stored, point) in self.points.iter_mut().zip(&points) {
            for (row, coordinate) in stored.iter_mut().zip(point) {
                coordinate.store(row);
            }
        }
        // Lanes whose squared distance is close to underflow or overflow are computed one by one.
        self.is_known = bits(has_scale & is_square_in_range(simd, squared));
    }

    /// Applies `answer` to each lane with known nearest points; the result of other lanes is
    /// `None`.
    #[inline]
    fn each<T: Copy>(
        &self,
        answer: impl Fn(&Self, usize) -> Option<T>,
    ) -> [Option<Option<T>>; LANES] {
        let mut answers = [None; LANES];
        for (lane, slot) in answers.iter_mut().enumerate() {
            *slot = (self.is_known >> lane & 1 == 1).then(|| answer(self, lane));
        }
        answers
    }

    /// Returns the distances, bit-identical to `segment_segment::distance`. An inner `None` is a
    /// pair beyond `limit`; an outer `None` is a lane without known nearest points.
    fn distances(&self, limit: N) -> [Option<Option<N>>; LANES] {
        self.each(|packet, lane| {
            let [radius1, radius2] = packet.radii[lane];
            Some(packet.distances[lane] - radius1 - radius2).filter(|distance| *distance <= limit)
        })
    }

    /// Returns the separations, bit-identical to `segment_segment::separation`. An inner `None` is
    /// a pair beyond `limit`; an outer `None` is a lane without known nearest points.
    fn separations(&self, limit: N) -> [Option<Option<Separation<N, 3>>>; LANES] {
        self.each(|packet, lane| {
            let point = |[x, y, z]: &[[N; LANES]; 3]| Point::<N, 3>::new(x[lane], y[lane], z[lane]);
            let points = (point(&packet.points[0]), point(&packet.points[1]));
            of_points(&packet.ends[lane], &points, packet.radii[lane], limit)
        })
    }
}
