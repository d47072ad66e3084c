//! Boxes in 3D: the separating axis test, and the corners of the overlap area of two facing faces,
//! one of each box. [`faces`] defines the rectangle and the parallelogram.
//!
//! ```text
//!   find:            axis -> faces -> clip (24 slots) -> admit    a mask per slot or flag
//!   turn:            Columns: bytes 0..3 the valid slots of a pair (24 bits), 3..6 the level,
//!                    6 its faces: axis (2 bits) and side of the rectangle, then of the face of the
//!                    parallelogram, then a bit set if the rectangle belongs to the second box
//!   write_manifold:  choose, features
//! ```

mod axis;
mod clip;
mod faces;
mod features;
mod supporting;

use self::clip::{Clip, Corners};
use self::faces::FacesInLanes;
use self::features::{BoxPairFeatures, FaceSide, parts_at};
use super::admit::{Limits, Slots};
use super::choose::SlotChoice;
use super::masks::per_pair;
use super::{Boxes, Inputs, smaller_size};
use crate::collide::RawManifold;
use crate::collide::batch::{Batch, PairQuestion};
use crate::math::lanes::{bits, lit};
use crate::math::simd::Simd;
use crate::math::{Real, Wide, filled};

/// Number of slots of a pair; `clip` defines their order.
const SLOTS: usize = 24;

/// Results of the kernel for `L` pairs.
pub(in super::super) struct LaneFaces<N: Real, const L: usize> {
    slots: Slots<N, 3, SLOTS, L>,
    corners: Corners,
    /// Signed distance of the boxes; negative for an overlap.
    gap: [N; L],
    /// Largest length that counts as a rounding error.
    tolerance: [N; L],
    /// Length scale: half the diagonal of the smaller box.
    size: [N; L],
    /// Unit normal from the first box to the second, in the frame of the first.
    normal: [[N; L]; 3],
    /// One mask over the lanes for each flag:
    ///
    /// - 0, 1: the rectangle is perpendicular to the first or to the second axis of its box;
    /// - 2: the rectangle is at the positive end of its axis;
    /// - 3, 4, 5: the same three flags of the parallelogram's face, in its own box;
    /// - 6: the rectangle belongs to the second box.
    sides: [u8; 8],
    /// Bits of the lanes beyond the prediction, which have no points.
    is_apart: u8,
    /// Bits of the lanes with filled slots. Lanes in neither `is_apart` nor `is_built` fall back.
    is_built: u8,
    columns: Columns,
}

/// Kernel for pairs of boxes in 3D.
pub(in super::super) struct Boxes3;

impl<N: Real, const L: usize> LaneFaces<N, L> {
    fn new() -> Self {
        let row = [N::ZERO; L];
        Self {
            slots: Slots::new(),
            corners: Corners::new(),
            gap: row,
            tolerance: row,
            size: row,
            normal: [row; 3],
            sides: [0; 8],
            is_apart: 0,
            is_built: 0,
            columns: Columns([[0; 8]; 7]),
        }
    }
}

impl<N: Real> Batch<N, 3> for Boxes3 {
    type Found<const L: usize> = LaneFaces<N, L>;

    fn blank<const L: usize>() -> LaneFaces<N, L> {
        LaneFaces::new()
    }

    #[inline(always)]
    fn gather<const L: usize>(
        inputs: &mut Inputs<N, 3, L>,
        lane: usize,
        pair: &PairQuestion<'_, N, 3>,
    ) -> bool {
        inputs.put_boxes(lane, pair)
    }

    #[inline(always)]
    fn find<S: Simd, V: Wide<S, Scalar = N>, const L: usize>(
        simd: S,
        inputs: &Inputs<N, 3, L>,
        found: &mut LaneFaces<N, L>,
    ) {
        found.find::<S, V>(simd, inputs);
        found.turn();
    }

    #[inline(always)]
    fn write_manifold<const L: usize>(
        found: &LaneFaces<N, L>,
        lane: usize,
        max_points: usize,
        raw: &mut RawManifold<N, 3>,
    ) -> bool {
        found.write_manifold(lane & (L - 1), max_points, raw)
    }
}

impl<N: Real, const L: usize> LaneFaces<N, L> {
    /// Runs the kernel: tests the axes, chooses the faces and fills the slots. Returns after the
    /// axis test if no lane has a supported pair within the prediction.
    #[inline(always)]
    fn find<S: Simd, V: Wide<S, Scalar = N>>(&mut self, simd: S, inputs: &Inputs<N, 3, L>) {
        let (boxes, prediction) = (inputs.boxes::<S, V>(simd), inputs.prediction::<S, V>(simd));
        let axis = boxes.best_axis(simd);
        let is_apart =
            axis.gap.simd_gt(prediction + lit::<S, N, V>(simd, 16.0) * axis.rounding_error);
        let is_near = axis.gap.simd_le(prediction) & axis.is_finite;
        self.is_apart = bits(is_apart & axis.is_finite);
        let is_candidate = bits(is_near) & inputs.is_usable;
        self.is_built = 0;
        if is_candidate == 0 {
            return;
        }
        let faces = FacesInLanes::of_axis(simd, &boxes, &axis);
        let (gap, sine, tolerance) = (axis.gap, inputs.sine::<S, V>(simd), faces.tolerance);
        let limits = Limits { gap, prediction, sine, tolerance };
        // If no face of the batch is tilted too far, no part of a face has to be excluded.
        let is_partial = bits(!faces.is_whole) & is_candidate != 0;
        let is_found = self.fill::<S, V>(simd, &boxes, &faces, &limits, is_partial);
        self.is_built = bits(is_found & faces.is_fit) & is_candidate;
        self.sides = [
            bits(faces.is_w[0]),
            bits(faces.is_w[1]),
            bits(faces.is_upward),
            bits(faces.is_m[0]),
            bits(faces.is_m[1]),
            bits(faces.is_positive),
            bits(faces.is_second),
            0,
        ];
        axis.gap.store(&mut self.gap);
        smaller_size(&boxes).store(&mut self.size);
        faces.tolerance.store(&mut self.tolerance);
        for (row, along) in self.normal.iter_mut().zip(axis.normal) {
            along.store(row);
        }
    }

    /// Transposes the masks of the batch into bytes of each pair.
    #[inline(always)]
    fn turn(&mut self) {
        self.columns = Columns::of(self);
    }

    /// Replaces the manifold of the pair in `lane`; clears its points if the boxes are beyond the
    /// prediction. Returns `false`, without a change, if the pair has to fall back.
    #[inline(always)]
    fn write_manifold(&self, lane: usize, max_points: usize, raw: &mut RawManifold<N, 3>) -> bool {
        if self.is_apart >> lane & 1 == 1 {
            raw.points.clear();
            return true;
        }
        let is_built = self.is_built >> lane & 1 == 1;
        if is_built {
            let (choice, features) = self.choice(lane);
            choice.write_manifold(&features, max_points.max(1), raw);
        }
        is_built
    }

    /// Fills the slots; returns the lanes where the lowest candidate is at the gap. `is_partial` is
    /// set if a face is tilted too far in some lane.
    #[inline(always)]
    fn fill<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        boxes: &Boxes<V, 3>,
        faces: &FacesInLanes<V, V::Mask>,
        limits: &Limits<V>,
        is_partial: bool,
    ) -> V::Mask {
        let (slots, corners) = (&mut self.slots, &mut self.corners);
        let clip = Clip::new(simd, faces, limits, slots, corners, is_partial);
        let found = clip.run();
        found.admit(
            simd,
            &mut self.slots,
            #[inline(always)]
            |flat, height| faces.point1(simd, boxes, (flat, height), is_partial),
        );
        found.is_found()
    }

    /// Returns the slots of the pair in `lane`, and their features.
    #[inline(always)]
    fn choice(&self, lane: usize) -> (SlotChoice<'_, N, 3, SLOTS, L>, BoxPairFeatures) {
        let (columns, bits) = (&self.columns, self.columns.byte(6, lane));
        let sides = FaceSides::of(bits);
        let parts = parts_at(lane, &self.corners.at_end, &self.corners.beyond);
        let choice = SlotChoice {
            slots: &self.slots,
            lane,
            valid: columns.slots(0, lane),
            level: columns.slots(3, lane),
            gap: self.gap[lane],
            tolerance: self.tolerance[lane],
            size: self.size[lane],
            normal: &self.normal,
        };
        (choice, BoxPairFeatures::new(&sides, bits, parts))
    }
}

/// The reference faces of one pair, and whether the rectangle belongs to the second box.
struct FaceSides {
    rectangle: FaceSide,
    parallelogram: FaceSide,
    is_second: bool,
}

impl FaceSides {
    /// Decodes a pair's byte of `LaneFaces::sides`, after transposition.
    #[inline(always)]
    fn of(bits: u8) -> Self {
        const AXES: [usize; 4] = [2, 0, 1, 0];
        let side =
            |bits: u8| FaceSide { axis: AXES[usize::from(bits & 3)], is_positive: bits & 4 != 0 };
        Self { rectangle: side(bits), parallelogram: side(bits >> 3), is_second: bits & 64 != 0 }
    }
}

/// Transposed masks, by row and lane: three bytes of the filled slots, three of the level slots,
/// and one of the faces.
struct Columns([[u8; 8]; 7]);

impl Columns {
    #[inline(always)]
    fn of<N: Real, const L: usize>(found: &LaneFaces<N, L>) -> Self {
        let Slots { valid, level, .. } = &found.slots;
        let rows = [
            part(valid, 0),
            part(valid, 8),
            part(valid, 16),
            part(level, 0),
            part(level, 8),
            part(level, 16),
            found.sides,
        ];
        let mut columns = [[0; 8]; 7];
        for (column, row) in columns.iter_mut().zip(rows) {
            *column = per_pair(row);
        }
        Self(columns)
    }

    #[inline(always)]
    fn byte(&self, row: usize, lane: usize) -> u8 {
        self.0[row][lane & 7]
    }

    /// Returns the 24 bits of the slots of a pair, from the rows `row` to `row + 2`.
    #[inline(always)]
    fn slots(&self, row: usize, lane: usize) -> u32 {
        let bytes = [self.byte(row, lane), self.byte(row + 1, lane), self.byte(row + 2, lane), 0];
        u32::from_le_bytes(bytes)
    }
}

/// Returns `bytes[first..first + 8]`.
#[inline(always)]
fn part(bytes: &[u8; SLOTS], first: usize) -> [u8; 8] {
    filled(
        #[inline(always)]
        |index| bytes[first + index],
    )
}
