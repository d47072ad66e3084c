//! Inputs and results of the search for 8 pairs, one pair in each lane.
//!
//! ```text
//!                 lane 0  lane 1  ...  lane 7
//!   rotation  x   pair 0  pair 1  ...  pair 7      rows of coordinates; `rotation` by columns
//!   rotation  y   pair 0  pair 1  ...  pair 7
//!   ...                                            lanes without a pair: zeros, results unread
//!   shrink        pair 0  pair 1  ...  pair 7
//!   limit         pair 0  pair 1  ...  pair 7      hulls and triangles: same vertices in all lanes
//! ```
//!
//! The lane of a pair is its index in the packet of `collide/batch/convex.rs`.

use super::core::LaneCore;
use super::search::LaneCores;
use super::{FlatPair, GapResult, LANES, vertices};
use crate::collide::Pair;
use crate::collide::separation::flat_core::FlatCore;
use crate::convex::Separation;
use crate::math::lanes::{LanePose, load, minus, with_vectors};
use crate::math::simd::{Simd, SimdMask, Vectors};
use crate::math::{Point, Real, Vector, Wide, filled};

/// One vector per lane, stored by coordinate.
type LaneVectors<N> = [[N; LANES]; 3];

/// Inputs of up to 8 pairs of the same kinds. Lanes without a pair stay zero.
struct Packet<'a, N: Real> {
    /// Both solids of each pair; `None` for lanes without a pair, and for pairs that
    /// [`FlatPair::of`] rejects.
    pairs: [Option<FlatPair<'a, N>>; LANES],
    /// Columns of the rotations of `pose12`.
    rotation: [LaneVectors<N>; 3],
    /// Translations of `pose12`, in units of each pair.
    translation: LaneVectors<N>,
    /// Half extents of boxes, in units of each pair; zero for other kinds.
    half_extents: [LaneVectors<N>; 2],
    /// Centres of the cores in their own frames, in units of each pair.
    middles: [LaneVectors<N>; 2],
    /// Factor from lengths of the shapes to units of each pair.
    shrink: [N; LANES],
    /// Limit of the distance of the cores, in units of each pair.
    limit: [N; LANES],
}

/// Results of the search, in units of each lane's pair.
struct PacketGap<N: Real> {
    distance: [N; LANES],
    /// Unit normals from the first core to the second, in the frame of the first.
    normal: LaneVectors<N>,
    /// Nearest points of both cores, in the frame of the first.
    points: [LaneVectors<N>; 2],
    /// Bits of the lanes with a proved separation.
    is_apart: u64,
    /// Bits of the lanes whose cores are beyond the limit.
    is_beyond: u64,
    /// Bits of the lanes whose cores certainly overlap.
    is_overlap: u64,
}

/// Computes the results of up to 8 pairs of the same kinds, bit-identical to [`super::result`] and
/// independent of the instruction set. `None` if a hull or triangle is not the same object in all
/// pairs, or if [`FlatPair::of`] rejects all pairs.
pub(super) fn results<'p, 'a: 'p, N: Real>(
    vectors: Vectors,
    pairs: impl Iterator<Item = &'p Pair<'a, N, 3>>,
    limit: N,
    with_overlap: bool,
) -> Option<[GapResult<N>; LANES]> {
    let packet = Packet::new(pairs, limit);
    if !packet.shares_vertices() {
        return None;
    }
    let mut found = PacketGap::new();
    with_vectors!(vectors, simd => packet.search::<_, N::Lanes<_>>(simd, with_overlap, &mut found));
    Some(filled(|lane| match &packet.pairs[lane] {
        Some(solids) => found.result(lane, solids),
        None => GapResult::Unproved,
    }))
}

impl<N: Real> PacketGap<N> {
    const fn new() -> Self {
        let row = [N::ZERO; LANES];
        Self {
            distance: row,
            normal: [row; 3],
            points: [[row; 3]; 2],
            is_apart: 0,
            is_beyond: 0,
            is_overlap: 0,
        }
    }

    /// Returns the result of one lane.
    #[inline]
    fn result(&self, lane: usize, solids: &FlatPair<'_, N>) -> GapResult<N> {
        let is = |lanes: u64| lanes >> lane & 1 == 1;
        let known = [is(self.is_beyond), is(self.is_overlap), is(self.is_apart)];
        let vector = |rows: &LaneVectors<N>| {
            Vector::<N, 3>::new(rows[0][lane], rows[1][lane], rows[2][lane])
        };
        solids.result(known, || Separation {
            distance: self.distance[lane],
            normal: vector(&self.normal),
            point1: Point::from(vector(&self.points[0])),
            point2: Point::from(vector(&self.points[1])),
        })
    }
}

impl<'a, N: Real> Packet<'a, N> {
    /// Gathers the first [`LANES`] pairs; further pairs are ignored.
    fn new<'p>(given: impl Iterator<Item = &'p Pair<'a, N, 3>>, limit: N) -> Self
    where
        'a: 'p,
    {
        let row = [N::ZERO; LANES];
        let mut packet = Self {
            pairs: [const { None }; LANES],
            rotation: [[row; 3]; 3],
            translation: [row; 3],
            half_extents: [[row; 3]; 2],
            middles: [[row; 3]; 2],
            shrink: row,
            limit: row,
        };
        for (lane, pair) in given.take(LANES).enumerate() {
            packet.put(lane, pair, limit);
        }
        packet
    }

    /// Copies a pair into its lane; leaves the lane empty if [`FlatPair::of`] returns `None`.
    fn put(&mut self, lane: usize, pair: &Pair<'a, N, 3>, limit: N) {
        let Some(solids) = FlatPair::of(pair) else { return };
        let (pose12, shrink) = (&pair.pose12, solids.units.shrink);
        self.shrink[lane] = shrink;
        self.limit[lane] = solids.limit_of_cores(limit);
        put(&mut self.translation, lane, &(pose12.translation * shrink));
        for column in 0..3 {
            put(&mut self.rotation[column], lane, &pose12.rotation.column(column).into());
        }
        for which in 0..2 {
            put(&mut self.middles[which], lane, &solids.middles[which]);
            if let FlatCore::Cuboid(cuboid) = solids.solids[which] {
                put(&mut self.half_extents[which], lane, &(cuboid.half_extents() * shrink));
            }
        }
        self.pairs[lane] = Some(solids);
    }

    /// Returns whether each solid that is a hull or triangle is the same object in all lanes, so
    /// that its vertices need no gathering. `false` if no lane has a pair.
    fn shares_vertices(&self) -> bool {
        let mut solids = self.pairs.iter().flatten();
        let Some(first) = solids.next() else { return false };
        let is_same = |which: usize, other: &FlatPair<'_, N>| match (
            vertices(&first.solids[which]),
            vertices(&other.solids[which]),
        ) {
            (Some(one), Some(other)) => core::ptr::eq(one.vertices, other.vertices),
            (one, other) => one.is_none() && other.is_none(),
        };
        solids.all(|other| is_same(0, other) && is_same(1, other))
    }

    /// Runs the search in all lanes.
    #[inline(always)]
    fn search<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        with_overlap: bool,
        out: &mut PacketGap<N>,
    ) {
        let rotation = filled(
            #[inline(always)]
            |column| load(simd, &self.rotation[column]),
        );
        let pose12 = LanePose { rotation, translation: load(simd, &self.translation) };
        let (middle1, middle2) = (load(simd, &self.middles[0]), load(simd, &self.middles[1]));
        let between = minus(&pose12.point(&middle2), &middle1);
        let cores = [self.core(simd, 0), self.core(simd, 1)];
        let limit = V::load(simd, &self.limit);
        let found = LaneCores { cores, pose12, between, limit }.gap(simd, with_overlap);
        found.distance.store(&mut out.distance);
        for axis in 0..3 {
            found.normal[axis].store(&mut out.normal[axis]);
            found.points[0][axis].store(&mut out.points[0][axis]);
            found.points[1][axis].store(&mut out.points[1][axis]);
        }
        out.is_apart = found.is_apart.to_bitmask();
        out.is_beyond = found.is_beyond.to_bitmask();
        out.is_overlap = found.is_overlap.to_bitmask();
    }

    /// Loads the core of one solid: vertices shared by all lanes, or half extents.
    #[inline(always)]
    fn core<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, which: usize) -> LaneCore<'a, N, V> {
        let solid = self.pairs.iter().flatten().next().map(|solids| solids.solids[which]);
        match solid.as_ref().and_then(vertices) {
            Some(points) => LaneCore::Points { points, shrink: V::load(simd, &self.shrink) },
            None => LaneCore::Cuboid(load(simd, &self.half_extents[which])),
        }
    }
}

#[inline(always)]
fn put<N: Real>(rows: &mut LaneVectors<N>, lane: usize, vector: &Vector<N, 3>) {
    for axis in 0..3 {
        rows[axis][lane & (LANES - 1)] = vector[axis];
    }
}
