//! Eight pairs of boxes side by side, and where the second of each lies in the frame of the first.

use fearless_simd::Simd;

use super::axis::by_axis;
use super::{BoxJob, LANES};
use crate::math::{Real, Wide};

/// Two poses (a rotation by columns, a translation), two boxes, the prediction.
const ROWS: usize = 31;

/// What the queries of eight pairs start from: a row for each number, a column for each pair.
pub(super) struct Inputs<N: Real> {
    rows: [[N; LANES]; ROWS],
    /// The lanes whose request has no angle.
    pub(super) straight: u64,
}

impl<N: Real> Inputs<N> {
    pub(super) const fn new() -> Self {
        Self { rows: [[N::ZERO; LANES]; ROWS], straight: 0 }
    }

    /// Takes up to eight pairs. Lanes beyond them keep what they had.
    #[inline(always)]
    pub(super) fn gather(&mut self, jobs: &[BoxJob<'_, N, 3>]) {
        self.straight = 0;
        for (lane, job) in jobs.iter().enumerate().take(LANES) {
            for (index, pose) in job.poses.iter().enumerate() {
                self.put(lane, 12 * index, pose.rotation.as_slice());
                self.put(lane, 12 * index + 9, pose.translation.as_slice());
                self.put(lane, 24 + 3 * index, job.cuboids[index].half_extents().as_slice());
            }
            self.put(lane, 30, &[job.request.prediction]);
            self.straight |= u64::from(job.request.sine <= N::ZERO) << lane;
        }
    }

    #[inline(always)]
    fn put(&mut self, lane: usize, first: usize, numbers: &[N]) {
        for (row, &number) in self.rows[first..].iter_mut().zip(numbers) {
            row[lane & (LANES - 1)] = number;
        }
    }

    #[inline(always)]
    fn load<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, first: usize) -> [V; 3] {
        by_axis(
            #[inline(always)]
            |axis| V::load(simd, &self.rows[first + axis]),
        )
    }

    #[inline(always)]
    fn rotation<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, first: usize) -> [[V; 3]; 3] {
        [self.load(simd, first), self.load(simd, first + 3), self.load(simd, first + 6)]
    }

    #[inline(always)]
    pub(super) fn prediction<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> V {
        V::load(simd, &self.rows[30])
    }

    /// The boxes, the second of each pair in the frame of the first, as `Pose::relative` has it.
    #[inline(always)]
    pub(super) fn boxes<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> Boxes<V> {
        let (rotation1, rotation2) = (self.rotation(simd, 0), self.rotation(simd, 12));
        let (from, to) = (self.load::<S, V>(simd, 9), self.load::<S, V>(simd, 21));
        let away = [to[0] - from[0], to[1] - from[1], to[2] - from[2]];
        Boxes {
            rotation: [
                seen_from(&rotation1, &rotation2[0]),
                seen_from(&rotation1, &rotation2[1]),
                seen_from(&rotation1, &rotation2[2]),
            ],
            translation: seen_from(&rotation1, &away),
            half1: self.load(simd, 24),
            half2: self.load(simd, 27),
        }
    }
}

/// Eight pairs of boxes, the second of each placed in the frame of the first.
pub(super) struct Boxes<V> {
    /// By columns: the axes of the second box.
    pub(super) rotation: [[V; 3]; 3],
    pub(super) translation: [V; 3],
    pub(super) half1: [V; 3],
    pub(super) half2: [V; 3],
}

/// The sum of the products, in the order of the axes.
#[inline(always)]
pub(super) fn dot<S: Simd, V: Wide<S>>(a: &[V; 3], b: &[V; 3]) -> V {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A vector in the frame with these axes.
#[inline(always)]
pub(super) fn seen_from<S: Simd, V: Wide<S>>(axes: &[[V; 3]; 3], vector: &[V; 3]) -> [V; 3] {
    [dot(&axes[0], vector), dot(&axes[1], vector), dot(&axes[2], vector)]
}
