//! Eight pairs side by side, gathered for the search.

use core::array::from_fn;

use super::core::LaneCore;
use super::search::LaneCores;
use super::{FlatPair, LANES, vertices};
use crate::collide::Pair;
use crate::collide::separation::flat_core::FlatCore;
use crate::math::lanes::{LanePose, by_axis, load, minus, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Real, Vector, Wide};

/// A vector in each lane, by coordinates.
type LaneVectors<N> = [[N; LANES]; 3];

/// The numbers of up to eight pairs of the same kinds; lanes beyond those taken hold a copy of the first.
struct Packet<'a, N: Real> {
    pairs: [Option<FlatPair<'a, N>>; LANES],
    /// By columns.
    rotation: [LaneVectors<N>; 3],
    translation: LaneVectors<N>,
    /// Those of boxes.
    half_extents: [LaneVectors<N>; 2],
    middles: [LaneVectors<N>; 2],
    shrink: [N; LANES],
}

/// The distances of up to eight pairs of the same kinds as [`super::distance`] has them without a limit, to the bit;
/// `None` for those that have to be asked one by one.
pub(crate) fn distances<'p, 'a: 'p, N: Real>(
    pairs: impl Iterator<Item = &'p Pair<'a, N, 3>>,
) -> [Option<N>; LANES] {
    distances_at(Level::new(), pairs)
}

/// [`distances`] with the vectors of an instruction set, on which they do not depend.
pub(super) fn distances_at<'p, 'a: 'p, N: Real>(
    level: Level,
    pairs: impl Iterator<Item = &'p Pair<'a, N, 3>>,
) -> [Option<N>; LANES] {
    let packet = Packet::new(pairs);
    if !packet.shares_vertices() {
        return [None; LANES];
    }
    let mut core_distances = [N::ZERO; LANES];
    let [is_apart, is_overlap] =
        with_lanes!(level, simd => packet.search::<_, N::Lanes<_>>(simd, &mut core_distances));
    from_fn(|lane| {
        let solids = packet.pairs[lane].as_ref()?;
        if is_apart >> lane & 1 == 1 {
            let [radius1, radius2] = solids.radii;
            Some(core_distances[lane] * solids.units.scale - radius1 - radius2)
        } else {
            (is_overlap >> lane & 1 == 1).then_some(N::ZERO)
        }
    })
}

impl<'a, N: Real> Packet<'a, N> {
    fn new<'p>(given: impl Iterator<Item = &'p Pair<'a, N, 3>>) -> Self
    where
        'a: 'p,
    {
        let row = [N::ZERO; LANES];
        let mut packet = Self {
            pairs: from_fn(|_| None),
            rotation: [[row; 3]; 3],
            translation: [row; 3],
            half_extents: [[row; 3]; 2],
            middles: [[row; 3]; 2],
            shrink: row,
        };
        for (lane, pair) in given.take(LANES).enumerate() {
            packet.put(lane, pair);
        }
        packet
    }

    /// Puts a pair into its lane.
    fn put(&mut self, lane: usize, pair: &Pair<'a, N, 3>) {
        let Some(solids) = FlatPair::of(pair) else { return };
        let (pose12, shrink) = (&pair.pose12, solids.units.shrink);
        self.shrink[lane] = shrink;
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

    /// Solids with vertices are the same in all lanes.
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

    /// Runs the search; returns the lanes that are apart and those that overlap.
    #[inline(always)]
    fn search<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        distances: &mut [N; LANES],
    ) -> [u64; 2] {
        let rotation = by_axis(
            #[inline(always)]
            |column| load(simd, &self.rotation[column]),
        );
        let pose12 = LanePose { rotation, translation: load(simd, &self.translation) };
        let (middle1, middle2) = (load(simd, &self.middles[0]), load(simd, &self.middles[1]));
        let between = minus(&pose12.point(&middle2), &middle1);
        let cores = [self.core(simd, 0), self.core(simd, 1)];
        let limit = V::all(simd, N::INFINITY);
        let found = LaneCores { cores, pose12, between, limit }.gap(simd, true);
        found.distance.store(distances);
        [found.is_apart.to_bitmask(), found.is_overlap.to_bitmask()]
    }

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
