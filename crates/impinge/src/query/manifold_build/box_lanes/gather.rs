//! Eight pairs of boxes side by side, and where the second of each lies in the frame of the first.

use super::{BoxJob, LANES};
use crate::math::lanes::{by_axis, either, lit, norm, seen_from};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Pose, Real, Wide};
use crate::query::manifold_build::frame::ROUNDING_ERRORS;
use crate::shape::Cuboid;

/// What the queries of eight pairs start from: a row for each number, a column for each pair.
pub(super) struct Inputs<N: Real, const D: usize> {
    boxes: [Placed<N, D>; 2],
    prediction: [N; LANES],
    sine: [N; LANES],
    /// A bit for each lane that has a pair.
    pub(super) taken: u8,
}

/// The first or the second box of eight pairs.
#[derive(Clone, Copy)]
struct Placed<N: Real, const D: usize> {
    /// By columns.
    rotation: [[[N; LANES]; D]; D],
    translation: [[N; LANES]; D],
    half: [[N; LANES]; D],
}

impl<N: Real, const D: usize> Inputs<N, D> {
    pub(super) const fn new() -> Self {
        let rows = [[N::ZERO; LANES]; D];
        let placed = Placed { rotation: [rows; D], translation: rows, half: rows };
        let row = [N::ZERO; LANES];
        Self { boxes: [placed; 2], prediction: row, sine: row, taken: 0 }
    }

    /// Takes up to eight pairs. Lanes beyond them keep what they had.
    #[inline(always)]
    pub(super) fn gather(&mut self, jobs: &[BoxJob<'_, N, D>]) {
        self.taken = 0;
        for (lane, job) in jobs.iter().enumerate().take(LANES) {
            for (index, placed) in self.boxes.iter_mut().enumerate() {
                placed.put(lane & (LANES - 1), job.poses[index], job.cuboids[index]);
            }
            self.prediction[lane & (LANES - 1)] = job.request.prediction;
            self.sine[lane & (LANES - 1)] = job.request.sine;
            self.taken |= 1 << lane;
        }
    }

    #[inline(always)]
    pub(super) fn prediction<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> V {
        V::load(simd, &self.prediction)
    }

    /// The sines of the angles that the boxes may turn by.
    #[inline(always)]
    pub(super) fn sine<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> V {
        V::load(simd, &self.sine)
    }

    /// The boxes, the second of each pair in the frame of the first, as `Pose::relative` has it.
    #[inline(always)]
    pub(super) fn boxes<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> Boxes<V, D> {
        let [first, second] = &self.boxes;
        let rotation1 = first.axes(simd);
        let rotation2: [[V; D]; D] = second.axes(simd);
        let (from, to): ([V; D], [V; D]) =
            (load(simd, &first.translation), load(simd, &second.translation));
        let away = by_axis(
            #[inline(always)]
            |axis| to[axis] - from[axis],
        );
        Boxes {
            rotation: by_axis(
                #[inline(always)]
                |axis| seen_from(&rotation1, &rotation2[axis]),
            ),
            translation: seen_from(&rotation1, &away),
            half1: load(simd, &first.half),
            half2: load(simd, &second.half),
        }
    }
}

impl<N: Real, const D: usize> Placed<N, D> {
    #[inline(always)]
    fn put(&mut self, lane: usize, pose: &Pose<N, D>, cuboid: &Cuboid<N, D>) {
        for column in 0..D {
            for row in 0..D {
                self.rotation[column][row][lane] = pose.rotation[(row, column)];
            }
            self.translation[column][lane] = pose.translation[column];
            self.half[column][lane] = cuboid.half_extents()[column];
        }
    }

    #[inline(always)]
    fn axes<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> [[V; D]; D] {
        by_axis(
            #[inline(always)]
            |axis| load(simd, &self.rotation[axis]),
        )
    }
}

#[inline(always)]
fn load<S: Simd, V: Wide<S, Scalar = N>, N: Real, const D: usize>(
    simd: S,
    rows: &[[N; LANES]; D],
) -> [V; D] {
    by_axis(
        #[inline(always)]
        |axis| V::load(simd, &rows[axis]),
    )
}

/// Eight pairs of boxes, the second of each placed in the frame of the first.
pub(super) struct Boxes<V, const D: usize> {
    /// By columns: the axes of the second box.
    pub(super) rotation: [[V; D]; D],
    pub(super) translation: [V; D],
    pub(super) half1: [V; D],
    pub(super) half2: [V; D],
}

/// What a box of the pair sees of the other, the second where the mask says so: the other's axes and
/// its translation, as `Pose::inverse` has them for the second.
#[inline(always)]
pub(super) fn other<S: Simd, V: Wide<S>, const D: usize>(
    boxes: &Boxes<V, D>,
    is_second: V::Mask,
) -> ([[V; D]; D], [V; D]) {
    let (r, t) = (&boxes.rotation, &boxes.translation);
    let inverse = seen_from(r, t);
    let rotation = by_axis(
        #[inline(always)]
        |j| {
            let row = by_axis(
                #[inline(always)]
                |axis| r[axis][j],
            );
            either(is_second, &row, &r[j])
        },
    );
    let shift = by_axis(
        #[inline(always)]
        |axis| is_second.select(-inverse[axis], t[axis]),
    );
    (rotation, shift)
}

/// Lengths below this are rounding errors, as for the general builder.
#[inline(always)]
pub(super) fn tolerance<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    boxes: &Boxes<V, D>,
) -> V {
    let size = norm(&boxes.half1) + norm(&boxes.half2) + norm(&boxes.translation);
    lit::<S, N, V>(simd, ROUNDING_ERRORS) * V::all(simd, N::EPSILON) * size
}

/// The lanes all of whose numbers are finite, and so is the sum of their magnitudes.
#[inline(always)]
pub(super) fn is_finite<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    boxes: &Boxes<V, D>,
) -> V::Mask {
    let mut all = size(&boxes.translation);
    for axis in &boxes.rotation {
        all += size(axis);
    }
    all.simd_lt(V::all(simd, N::INFINITY))
}

/// The sum of the magnitudes.
#[inline(always)]
fn size<S: Simd, V: Wide<S>, const D: usize>(v: &[V; D]) -> V {
    let mut sum = v[0].abs();
    for x in &v[1..] {
        sum += x.abs();
    }
    sum
}
