//! Pairs of solids side by side: eight, or one.

use super::vectors::{minus, seen_from};
use super::{Batch, KeptPairs, PairQuestion};
use crate::math::lanes::{LanePose, load};
use crate::math::simd::Simd;
use crate::math::{Matrix, Real, Vector, Wide, filled};

/// A vector in each lane, by rows.
type LaneRows<N, const D: usize, const L: usize> = [[N; L]; D];

/// What `L` pairs are asked about: a row for each number, a column for each pair.
pub(super) struct Inputs<N: Real, const D: usize, const L: usize> {
    /// By columns.
    rotations: [[LaneRows<N, D, L>; D]; 2],
    translations: [LaneRows<N, D, L>; 2],
    /// The ends of a segment; the first is the half extents of a box.
    ends: [[LaneRows<N, D, L>; 2]; 2],
    radii: [[N; L]; 2],
    prediction: [N; L],
    sine: [N; L],
    pub(super) max_points: [usize; L],
    /// The first of the pairs, and how many lanes are taken.
    pub(super) first: usize,
    pub(super) count: usize,
    /// The lanes that hold a pair for the algorithm.
    pub(super) is_usable: u8,
}

impl<N: Real, const D: usize, const L: usize> Inputs<N, D, L> {
    pub(super) const fn new() -> Self {
        let row = [N::ZERO; L];
        Self {
            rotations: [[[row; D]; D]; 2],
            translations: [[row; D]; 2],
            ends: [[[row; D]; 2]; 2],
            radii: [row; 2],
            prediction: row,
            sine: row,
            max_points: [0; L],
            first: 0,
            count: 0,
            is_usable: 0,
        }
    }

    /// Takes up to `L` pairs, beginning with one of a number. Lanes beyond those taken keep what they had.
    #[inline(always)]
    pub(super) fn gather<B: Batch<N, D>, P: KeptPairs<N, D>>(
        &mut self,
        pairs: &mut P,
        first: usize,
    ) {
        (self.first, self.is_usable) = (first, 0);
        self.count = (pairs.len() - first).min(L);
        for lane in 0..self.count {
            self.put::<B>(lane, &pairs.begin(first + lane));
        }
    }

    /// Puts a pair into a lane.
    #[inline(always)]
    pub(super) fn put<B: Batch<N, D>>(&mut self, lane: usize, pair: &PairQuestion<'_, N, D>) {
        self.is_usable |= u8::from(B::gather(self, lane, pair)) << lane;
        self.prediction[lane & (L - 1)] = pair.request.prediction;
        self.max_points[lane & (L - 1)] = pair.request.max_points;
    }

    /// Where two balls are.
    #[inline(always)]
    pub(super) fn put_centers(&mut self, lane: usize, pair: &PairQuestion<'_, N, D>) {
        put(&mut self.translations[0], lane, &pair.poses[0].translation);
        put(&mut self.translations[1], lane, &pair.poses[1].translation);
    }

    /// Where a ball and another solid are.
    #[inline(always)]
    pub(super) fn put_beside_ball(&mut self, lane: usize, pair: &PairQuestion<'_, N, D>) {
        self.put_centers(lane, pair);
        put_all(&mut self.rotations[1], lane, &pair.poses[1].rotation);
    }

    /// Where both solids are.
    #[inline(always)]
    pub(super) fn put_poses(&mut self, lane: usize, pair: &PairQuestion<'_, N, D>) {
        self.put_beside_ball(lane, pair);
        put_all(&mut self.rotations[0], lane, &pair.poses[0].rotation);
    }

    /// The radius of one of the solids.
    #[inline(always)]
    pub(super) const fn put_radius(&mut self, lane: usize, which: usize, radius: N) {
        self.radii[which][lane & (L - 1)] = radius;
    }

    /// By how much solids may turn.
    #[inline(always)]
    pub(super) const fn put_sine(&mut self, lane: usize, sine: N) {
        self.sine[lane & (L - 1)] = sine;
    }

    /// An end of the segment in the middle of one of the solids, or the half extents of a box.
    #[inline(always)]
    pub(super) fn put_end(&mut self, lane: usize, solid: usize, number: usize, end: &Vector<N, D>) {
        put(&mut self.ends[solid][number], lane, end);
    }

    #[inline(always)]
    pub(super) fn radius<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, which: usize) -> V {
        V::load(simd, &self.radii[which])
    }

    #[inline(always)]
    pub(super) fn prediction<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> V {
        V::load(simd, &self.prediction)
    }

    #[inline(always)]
    pub(super) fn sine<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> V {
        V::load(simd, &self.sine)
    }

    #[inline(always)]
    pub(super) fn end<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        solid: usize,
        number: usize,
    ) -> [V; D] {
        load(simd, &self.ends[solid][number])
    }

    /// The second solid's place seen from the first, which is its place in the frame of a ball.
    #[inline(always)]
    pub(super) fn away<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> [V; D] {
        minus(&load(simd, &self.translations[1]), &load(simd, &self.translations[0]))
    }

    /// The second solid's pose in the frame of a ball, as `Pair::new` has it.
    #[inline(always)]
    pub(super) fn beside_ball<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> LanePose<V, D> {
        LanePose { rotation: load_all(simd, &self.rotations[1]), translation: self.away(simd) }
    }

    /// The second solid's pose in the frame of the first, as `Pose::relative` has it.
    #[inline(always)]
    pub(super) fn pose12<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> LanePose<V, D> {
        let axes = load_all::<S, N, V, D, L>(simd, &self.rotations[0]);
        let turned = load_all::<S, N, V, D, L>(simd, &self.rotations[1]);
        let rotation = filled(
            #[inline(always)]
            |column| seen_from(&axes, &turned[column]),
        );
        LanePose { rotation, translation: seen_from(&axes, &self.away(simd)) }
    }
}

/// Puts a vector into a lane.
#[inline(always)]
pub(super) fn put<N: Real, const D: usize, const L: usize>(
    rows: &mut LaneRows<N, D, L>,
    lane: usize,
    vector: &Vector<N, D>,
) {
    for axis in 0..D {
        rows[axis][lane & (L - 1)] = vector[axis];
    }
}

#[inline(always)]
fn put_all<N: Real, const D: usize, const L: usize>(
    columns: &mut [LaneRows<N, D, L>; D],
    lane: usize,
    matrix: &Matrix<N, D>,
) {
    for column in 0..D {
        for axis in 0..D {
            columns[column][axis][lane & (L - 1)] = matrix[(axis, column)];
        }
    }
}

#[inline(always)]
fn load_all<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize, const L: usize>(
    simd: S,
    columns: &[LaneRows<N, D, L>; D],
) -> [[V; D]; D] {
    filled(
        #[inline(always)]
        |column| load(simd, &columns[column]),
    )
}
