//! Boxes against boxes in space, eight pairs at a time.
//!
//! The algorithm of `box_faces.rs` and of the separating axis test, each lane of a vector another
//! pair, and with the same bits: the operations of each lane are those of one pair in the same order.
//! What depends on the pair is chosen by masks, and a corner of the common area has a place of its own
//! whether it is there or not ([`clip`]). Only the choice of the points ([`choose`]) goes pair by pair.
//! What `box_faces` declines goes to the general builder here too, one by one.
//!
//! The idea of lanes across pairs is that of bepuphysics (R. Nordby).

mod axis;
mod choose;
mod clip;
mod faces;
mod gather;
mod names;
#[cfg(test)]
mod tests;

use fearless_simd::{Level, Simd, SimdMask, dispatch};

use self::axis::lit;
use self::choose::Candidates;
use self::clip::{Clip, Limits, SLOTS, Slots};
use self::faces::Faces;
use self::gather::{Boxes, Inputs};
use self::names::Naming;
use super::{ManifoldRequest, Pair, RawManifold, contacts3};
use crate::math::{Point, Pose, Real, Vector, Wide, max, min};
use crate::query::RawPoint;
use crate::shape::{Cuboid, Kind};

/// How many pairs are treated at once.
const LANES: usize = 8;

/// A pair of boxes in canonical order whose manifold is to be brought up to date.
pub(crate) struct BoxJob<'a, N: Real, const D: usize> {
    pub(crate) poses: [&'a Pose<N, D>; 2],
    pub(crate) cuboids: [&'a Cuboid<N, D>; 2],
    pub(crate) request: &'a ManifoldRequest<N>,
    /// The manifold of the last update, which is replaced.
    pub(crate) raw: &'a mut RawManifold<N, D>,
}

impl<N: Real, const D: usize> BoxJob<'_, N, D> {
    fn half_extents(&self, index: usize) -> &Vector<N, D> {
        self.cuboids[index].half_extents()
    }

    fn pair(&self) -> Pair<'_, N, D> {
        let [first, second] = self.cuboids.map(Kind::Cuboid);
        Pair { first, second, pose12: Pose::relative(self.poses[0], self.poses[1]) }
    }
}

/// Brings the manifolds of pairs of boxes up to date: the same bits as [`contacts3`] one by one.
pub(crate) fn update_box_pairs3<N: Real>(jobs: &mut [BoxJob<'_, N, 3>]) {
    update_at(Level::new(), jobs);
}

/// [`update_box_pairs3`] with the vectors of an instruction set.
fn update_at<N: Real>(level: Level, jobs: &mut [BoxJob<'_, N, 3>]) {
    dispatch!(level, simd => update::<_, N, N::Lanes<_>>(simd, jobs));
}

/// Eight by eight. The numbers of the next eight are gathered before those gathered last are used,
/// which gives the memory time to put them together.
#[inline(always)]
fn update<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, jobs: &mut [BoxJob<'_, N, 3>]) {
    let mut inputs = [Inputs::new(), Inputs::new()];
    let mut found = Found::new();
    inputs[0].gather(jobs);
    for (count, first) in (0..jobs.len()).step_by(LANES).enumerate() {
        if let Some(next) = jobs.get(first + LANES..) {
            inputs[(count + 1) % 2].gather(next);
        }
        found.find::<S, V>(simd, &inputs[count % 2]);
        let bits = Columns::of(&found);
        for (lane, job) in jobs[first..].iter_mut().enumerate().take(LANES) {
            found.settle(lane, &bits, job);
        }
    }
}

/// What is known of eight pairs before points are chosen.
struct Found<N: Real> {
    slots: Slots<N>,
    gap: [N; LANES],
    tolerance: [N; LANES],
    prediction: [N; LANES],
    normal: [[N; LANES]; 3],
    /// The pose of the second box in the frame of the first, the rotation by columns.
    rotation: [[N; LANES]; 9],
    translation: [[N; LANES]; 3],
    /// Half of the rectangle's box across the rectangle.
    half: [N; LANES],
    /// The lanes: the axis across the rectangle is the first, the second, and so of the
    /// parallelogram; the rectangle faces up, the parallelogram is on the positive side, the
    /// rectangle is the second box's.
    sides: [u8; 8],
    /// The lanes that are too far apart, and those whose slots are filled.
    is_apart: u8,
    is_built: u8,
}

impl<N: Real> Found<N> {
    fn new() -> Self {
        let row = [N::ZERO; LANES];
        Self {
            slots: Slots::new(),
            gap: row,
            tolerance: row,
            prediction: row,
            normal: [row; 3],
            rotation: [row; 9],
            translation: [row; 3],
            half: row,
            sides: [0; 8],
            is_apart: 0,
            is_built: 0,
        }
    }

    /// Everything that goes for eight pairs at once.
    #[inline(always)]
    fn find<S: Simd, V: Wide<S, Scalar = N>>(&mut self, simd: S, inputs: &Inputs<N>) {
        let (boxes, prediction) = (inputs.boxes::<S, V>(simd), inputs.prediction::<S, V>(simd));
        let axis = boxes.best_axis(simd);
        let is_apart = axis.gap.simd_gt(prediction + lit::<S, N, V>(simd, 16.0) * axis.noise);
        let is_near = axis.gap.simd_le(prediction) & axis.is_finite;
        self.is_apart = bits(is_apart & axis.is_finite);
        let is_ordinary = bits(is_near) & inputs.straight.to_le_bytes()[0];
        self.is_built = 0;
        if is_ordinary == 0 {
            return;
        }
        let faces = Faces::meeting(simd, &boxes, &axis);
        let limits = Limits { gap: axis.gap, prediction };
        let is_found = Clip::new(simd, &faces, limits, &mut self.slots).run();
        self.is_built = bits(is_found & faces.is_fit) & is_ordinary;
        self.sides = [
            bits(faces.is_w[0]),
            bits(faces.is_w[1]),
            bits(faces.is_m[0]),
            bits(faces.is_m[1]),
            bits(faces.is_upward),
            bits(faces.is_positive),
            bits(axis.is_second),
            0,
        ];
        axis.gap.store(&mut self.gap);
        faces.tolerance.store(&mut self.tolerance);
        prediction.store(&mut self.prediction);
        faces.half.store(&mut self.half);
        self.store(&boxes, &axis.normal);
    }

    #[inline(always)]
    fn store<S: Simd, V: Wide<S, Scalar = N>>(&mut self, boxes: &Boxes<V>, normal: &[V; 3]) {
        for axis in 0..3 {
            normal[axis].store(&mut self.normal[axis]);
            boxes.translation[axis].store(&mut self.translation[axis]);
            for row in 0..3 {
                boxes.rotation[axis][row].store(&mut self.rotation[3 * axis + row]);
            }
        }
    }

    /// The end of one pair.
    fn settle(&self, lane: usize, columns: &Columns, job: &mut BoxJob<'_, N, 3>) {
        if self.is_apart >> lane & 1 == 1 {
            job.raw.points.clear();
        } else if self.is_built >> lane & 1 == 1 {
            self.choose(lane, columns, job);
        } else {
            let [first, second] = job.cuboids.map(Kind::Cuboid);
            let pose12 = Pose::relative(job.poses[0], job.poses[1]);
            contacts3(&Pair { first, second, pose12 }, job.request, job.raw);
        }
    }

    fn choose(&self, lane: usize, columns: &Columns, job: &mut BoxJob<'_, N, 3>) {
        let sides = Sides::of(columns.byte(7, lane));
        let (at_end, beyond) = (
            [columns.byte(3, lane), columns.byte(4, lane)],
            [columns.byte(5, lane), columns.byte(6, lane)],
        );
        let naming = Naming::new([sides.rectangle, sides.parallelogram], sides.is_second, at_end, beyond);
        let (gap, prediction) = (self.gap[lane], self.prediction[lane]);
        let mut candidates = Candidates::new();
        let mut left = u32::from_le_bytes([
            columns.byte(0, lane),
            columns.byte(1, lane),
            columns.byte(2, lane),
            0,
        ]);
        while left != 0 {
            let slot = left.trailing_zeros() as usize;
            left &= left - 1;
            if slot < SLOTS {
                let flat = [self.slots.flat[0][slot][lane], self.slots.flat[1][slot][lane]];
                let distance = min(max(self.slots.height[slot][lane], gap), prediction);
                candidates.push(slot, naming.key(slot), (flat, distance));
            }
        }
        let (raw, tolerance) = (&mut *job.raw, self.tolerance[lane]);
        candidates.inherit(raw);
        let deepest = candidates.take_deepest(gap, tolerance);
        let chosen = candidates.chosen(deepest, job.request.max_points.max(1), tolerance);
        raw.points.clear();
        let pose12 = self.pose12(lane);
        for &index in chosen.as_slice() {
            let (slot, key, distance, id) = candidates.get(index);
            let id = id.unwrap_or_else(|| raw.ids.next());
            let point1 = self.point1(lane, slot, (&sides, &pose12));
            let [feature1, feature2] = key.features();
            raw.points.push(RawPoint { point1, distance, feature1, feature2, id });
        }
        if !raw.points.is_sorted_by_key(|point| point.id) {
            raw.points.sort_by_key(|point| point.id);
        }
        raw.normal = Vector::<N, 3>::from(self.normal.map(|row| row[lane]));
    }

    fn pose12(&self, lane: usize) -> Pose<N, 3> {
        Pose {
            rotation: crate::math::Matrix::<N, 3>::from_iterator(self.rotation.iter().map(|row| row[lane])),
            translation: Vector::<N, 3>::from(self.translation.map(|row| row[lane])),
        }
    }

    /// The point of a slot on the first box, in its frame.
    fn point1(&self, lane: usize, slot: usize, (sides, pose12): (&Sides, &Pose<N, 3>)) -> Point<N, 3> {
        let (w, is_upward) = sides.rectangle;
        let rise = if sides.is_second { self.slots.height[slot][lane] } else { N::ZERO };
        let level = self.half[lane] + rise;
        let mut point = Point::<N, 3>::origin();
        point[(w + 1) % 3] = self.slots.flat[0][slot][lane];
        point[(w + 2) % 3] = self.slots.flat[1][slot][lane];
        point[w] = if is_upward { level } else { -level };
        if sides.is_second { pose12.point(&point) } else { point }
    }
}

/// The faces of one pair.
struct Sides {
    rectangle: names::Side,
    parallelogram: names::Side,
    is_second: bool,
}

impl Sides {
    fn of(bits: u8) -> Self {
        let bit = |index: u32| bits >> index & 1 == 1;
        let axis = |first: bool, second: bool| if first { 0 } else { 2 - usize::from(second) };
        Self {
            rectangle: (axis(bit(0), bit(1)), bit(4)),
            parallelogram: (axis(bit(2), bit(3)), bit(5)),
            is_second: bit(6),
        }
    }
}

/// The masks of eight pairs, turned so that a byte has the bits of one pair.
struct Columns([u64; 8]);

impl Columns {
    #[inline(always)]
    fn of<N: Real>(found: &Found<N>) -> Self {
        let (slots, valid) = (&found.slots, &found.slots.valid);
        let part = |first: usize| core::array::from_fn(|index| valid[first + index]);
        let [at_end0, at_end1] = slots.at_end;
        let [beyond0, beyond1] = slots.beyond;
        let rows = [part(0), part(8), part(16), at_end0, at_end1, beyond0, beyond1, found.sides];
        Self(rows.map(|row| transposed(u64::from_le_bytes(row))))
    }

    #[inline]
    fn byte(&self, row: usize, lane: usize) -> u8 {
        self.0[row].to_le_bytes()[lane]
    }
}

/// A matrix of eight by eight bits with rows and columns exchanged (H. S. Warren, "Hacker's
/// Delight", 7-3).
#[inline(always)]
const fn transposed(mut x: u64) -> u64 {
    let swapped = (x ^ x >> 7) & 0x00aa_00aa_00aa_00aa;
    x ^= swapped ^ swapped << 7;
    let swapped = (x ^ x >> 14) & 0x0000_cccc_0000_cccc;
    x ^= swapped ^ swapped << 14;
    let swapped = (x ^ x >> 28) & 0x0000_0000_f0f0_f0f0;
    x ^ swapped ^ swapped << 28
}

#[inline(always)]
fn bits<S: Simd, M: SimdMask<S>>(mask: M) -> u8 {
    mask.to_bitmask().to_le_bytes()[0]
}
