//! 2D boxes: the separating axis test and the overlap of the sides in lanes.

mod axis;
mod names;
mod sides;

use self::names::Names;
use self::sides::Sides;
use super::admit::{Admission, Limits, Slots};
use super::choose::Choice;
use super::gather::Inputs;
use super::masks::{bits, turned};
use super::{BoxJob, Eights, LANES};
use crate::math::lanes::lit;
use crate::math::simd::Simd;
use crate::math::{Real, Vector, Wide};
use crate::query::manifold_build::contacts_of_separation2;

/// The ends of the upper side, the one with the smaller place first, and of the lower one.
const SLOTS: usize = 4;

/// What is known of eight pairs before points are chosen.
pub(super) struct Found<N: Real> {
    slots: Slots<N, 2, SLOTS>,
    gap: [N; LANES],
    tolerance: [N; LANES],
    normal: [[N; LANES]; 2],
    /// The lanes: the axis across the lower side is the second, the side is on the positive side of
    /// it; the same of the upper side; the lower side is the second box's; the upper side's first
    /// end is the one on the positive side of its box; too far apart; the slots are filled.
    sides: [u8; 8],
    /// Of each slot, whether it is at the first end of the other side, and at the second.
    at_ends: [u8; 2 * SLOTS],
}

impl<N: Real> Eights<N, 2> for Found<N> {
    fn new() -> Self {
        let row = [N::ZERO; LANES];
        Self {
            slots: Slots::new(),
            gap: row,
            tolerance: row,
            normal: [row; 2],
            sides: [0; 8],
            at_ends: [0; 2 * SLOTS],
        }
    }

    #[inline(always)]
    fn find<S: Simd, V: Wide<S, Scalar = N>>(&mut self, simd: S, inputs: &Inputs<N, 2>) {
        let (boxes, prediction) = (inputs.boxes::<S, V>(simd), inputs.prediction::<S, V>(simd));
        let axis = boxes.best_side(simd);
        let is_apart = axis.gap.simd_gt(prediction + lit::<S, N, V>(simd, 16.0) * axis.noise);
        let is_near = axis.gap.simd_le(prediction) & axis.is_finite;
        let is_apart = bits(is_apart & axis.is_finite);
        let is_asked = bits(is_near) & inputs.taken;
        self.sides = [0, 0, 0, 0, 0, 0, is_apart, 0];
        if is_asked == 0 {
            return;
        }
        let sides = Sides::meeting(simd, &boxes, &axis);
        let (gap, sine, tolerance) = (axis.gap, inputs.sine::<S, V>(simd), sides.tolerance);
        let mut admission = Admission::new(simd, Limits { gap, prediction, sine, tolerance });
        self.at_ends = sides.share(simd, &mut admission, &mut self.slots);
        let is_built = bits(admission.is_found() & sides.is_fit) & is_asked;
        self.sides = [
            bits(sides.is_y),
            bits(sides.is_upward),
            bits(sides.is_own_y),
            bits(sides.is_positive),
            bits(axis.is_second),
            bits(sides.is_turned),
            is_apart,
            is_built,
        ];
        axis.gap.store(&mut self.gap);
        sides.tolerance.store(&mut self.tolerance);
        axis.normal[0].store(&mut self.normal[0]);
        axis.normal[1].store(&mut self.normal[1]);
        let is_second = axis.is_second;
        admission.admit(
            simd,
            &mut self.slots,
            #[inline(always)]
            |[place, _], height| sides.point1(simd, &boxes, is_second, (place, height)),
        );
    }

    #[inline(always)]
    fn settle(&self, jobs: &mut [BoxJob<'_, N, 2>]) {
        let (sides, at_ends) = (turned(self.sides), turned(self.at_ends));
        let [a, b, c, d] = self.slots.valid;
        let [e, f, g, h] = self.slots.level;
        let slots = turned([a, b, c, d, e, f, g, h]);
        for (lane, job) in jobs.iter_mut().enumerate().take(LANES) {
            let names = Names { sides: sides[lane], at_ends: at_ends[lane] };
            if names.sides & 64 != 0 {
                job.raw.points.clear();
            } else if names.sides & 128 != 0 {
                self.choose(lane, names, u32::from(slots[lane]), job);
            } else {
                Self::fall_back(job);
            }
        }
    }

    fn fall_back(job: &mut BoxJob<'_, N, 2>) {
        contacts_of_separation2(&job.pair(), job.request, job.raw);
    }
}

impl<N: Real> Found<N> {
    #[inline(always)]
    fn choose(&self, lane: usize, names: Names, slots: u32, job: &mut BoxJob<'_, N, 2>) {
        let choice = Choice {
            slots: &self.slots,
            lane,
            valid: slots & 15,
            level: slots >> SLOTS,
            gap: self.gap[lane],
            tolerance: self.tolerance[lane],
        };
        choice.settle(&names, job.request.max_points.clamp(1, 2), job.raw);
        job.raw.normal = Vector::<N, 2>::new(self.normal[0][lane], self.normal[1][lane]);
    }
}
