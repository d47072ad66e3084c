//! Inputs of the kernels, in rows: the numbers of 8 pairs side by side, or of a single pair.
//!
//! ```text
//!                  lane 0   lane 1   ...        a row for each number, a column for each pair
//!   translation x  pair i   pair i+1 ...        i = `first`; `count` lanes are filled
//!   translation y  pair i   pair i+1 ...
//!   ...                                         lanes beyond `count` keep old numbers, and their
//!   radius         pair i   pair i+1 ...        bits of `is_usable` are 0
//! ```

use super::vectors::{minus, rotated_into};
use super::{Batch, KeptPairs, PairQuestion};
use crate::math::lanes::{LanePose, load};
use crate::math::simd::Simd;
use crate::math::{Matrix, Real, Vector, Wide, filled};

/// One vector per lane, stored by coordinate.
type LaneRows<N, const D: usize, const L: usize> = [[N; L]; D];

/// Inputs of `L` pairs: one row per quantity, one column per pair.
pub(super) struct Inputs<N: Real, const D: usize, const L: usize> {
    /// Columns of the rotation matrices of both poses.
    rotations: [[LaneRows<N, D, L>; D]; 2],
    /// Translations of both poses, in their common frame, usually the world.
    translations: [LaneRows<N, D, L>; 2],
    /// Ends of the core of each solid, in its own frame; for a box the first entry has its half
    /// extents.
    ends: [[LaneRows<N, D, L>; 2]; 2],
    /// Radii of balls or capsules; unused by boxes.
    radii: [[N; L]; 2],
    /// Largest distance of a contact point, from each pair's request.
    prediction: [N; L],
    /// Sine of the angle by which the solids may rotate, from each pair's request.
    sine: [N; L],
    /// Largest number of points, from each pair's request.
    pub(super) max_points: [usize; L],
    /// Index of the first pair of the batch.
    pub(super) first: usize,
    /// Number of filled lanes.
    pub(super) count: usize,
    /// Bits of the lanes whose pair the kernel supports by its kinds and request; the other lanes
    /// fall back.
    pub(super) is_usable: u8,
}

impl<N: Real, const D: usize, const L: usize> Inputs<N, D, L> {
    /// Returns rows of zeros, without a pair.
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

    /// Begins the updates of up to `L` pairs, from index `first` on, and gathers their inputs.
    /// Lanes without a pair keep their old values.
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

    /// Copies the inputs of a pair into a lane; fields that its kernel does not use keep their old
    /// values.
    #[inline(always)]
    pub(super) fn put<B: Batch<N, D>>(&mut self, lane: usize, pair: &PairQuestion<'_, N, D>) {
        self.is_usable |= u8::from(B::gather(self, lane, pair)) << lane;
        self.prediction[lane & (L - 1)] = pair.request.prediction;
        self.max_points[lane & (L - 1)] = pair.request.max_points;
    }

    /// Copies the positions of two solids into a lane, for pairs of balls.
    #[inline(always)]
    pub(super) fn put_centers(&mut self, lane: usize, pair: &PairQuestion<'_, N, D>) {
        put(&mut self.translations[0], lane, &pair.poses[0].translation);
        put(&mut self.translations[1], lane, &pair.poses[1].translation);
    }

    /// Copies the position of a ball, the first solid, and the pose of the second solid into a
    /// lane.
    #[inline(always)]
    pub(super) fn put_beside_ball(&mut self, lane: usize, pair: &PairQuestion<'_, N, D>) {
        self.put_centers(lane, pair);
        put_all(&mut self.rotations[1], lane, &pair.poses[1].rotation);
    }

    /// Copies the poses of both solids into a lane.
    #[inline(always)]
    pub(super) fn put_poses(&mut self, lane: usize, pair: &PairQuestion<'_, N, D>) {
        self.put_beside_ball(lane, pair);
        put_all(&mut self.rotations[0], lane, &pair.poses[0].rotation);
    }

    /// Copies the radius of the solid `which` into a lane.
    #[inline(always)]
    pub(super) const fn put_radius(&mut self, lane: usize, which: usize, radius: N) {
        self.radii[which][lane & (L - 1)] = radius;
    }

    /// Copies the sine of the angle by which the solids may rotate into a lane.
    #[inline(always)]
    pub(super) const fn put_sine(&mut self, lane: usize, sine: N) {
        self.sine[lane & (L - 1)] = sine;
    }

    /// Copies a vector of the solid `solid` (0 or 1) into a lane: end `number` (0 or 1) of its
    /// core, or the half extents of a box as `number` 0.
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

    /// Loads a vector of the solid `solid` (0 or 1): end `number` (0 or 1) of its core, or the half
    /// extents of a box as `number` 0.
    #[inline(always)]
    pub(super) fn end<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        solid: usize,
        number: usize,
    ) -> [V; D] {
        load(simd, &self.ends[solid][number])
    }

    /// Returns the vector from the origin of the first solid to the origin of the second, in the
    /// axes of the frame of both poses. These are also the axes of a ball's frame.
    #[inline(always)]
    pub(super) fn away<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> [V; D] {
        minus(&load(simd, &self.translations[1]), &load(simd, &self.translations[0]))
    }

    /// Returns the pose of the second solid in the frame of a ball, whose rotation is ignored.
    #[inline(always)]
    pub(super) fn beside_ball<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> LanePose<V, D> {
        LanePose { rotation: load_all(simd, &self.rotations[1]), translation: self.away(simd) }
    }

    /// Returns the pose of the second solid in the frame of the first, bit-identical to
    /// `Pose::relative`.
    #[inline(always)]
    pub(super) fn pose12<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> LanePose<V, D> {
        let axes = load_all::<S, N, V, D, L>(simd, &self.rotations[0]);
        let rotations = load_all::<S, N, V, D, L>(simd, &self.rotations[1]);
        let rotation = filled(
            #[inline(always)]
            |column| rotated_into(&axes, &rotations[column]),
        );
        LanePose { rotation, translation: rotated_into(&axes, &self.away(simd)) }
    }
}

/// Copies a vector into a lane.
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

/// Copies a matrix into a lane, by columns.
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

/// Loads the columns of a matrix.
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
