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
pub(super) mod tests;

use fearless_simd::{Level, Simd, SimdMask};

use self::axis::lit;
use self::choose::{Choice, Kept};
use self::clip::{Clip, Limits, SLOTS, Slots};
use self::faces::Faces;
use self::gather::{Boxes, Inputs};
use self::names::{Naming, Side, parts_at};
use super::{ManifoldRequest, Pair, RawManifold, contacts2, contacts3};
use crate::math::{Point, Pose, Real, Vector, Wide};
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

impl<'a, N: Real, const D: usize> BoxJob<'a, N, D> {
    pub(super) fn pair(&self) -> Pair<'a, N, D> {
        let [first, second] = self.cuboids.map(Kind::Cuboid);
        Pair { first, second, pose12: Pose::relative(self.poses[0], self.poses[1]) }
    }
}

/// Brings the manifolds of pairs of boxes of the plane up to date, as [`update_box_pairs3`].
///
/// One by one: such a pair is so little work that putting eight side by side costs as much.
pub(crate) fn update_box_pairs2<N: Real>(jobs: &mut [BoxJob<'_, N, 2>]) {
    for job in jobs {
        contacts2(&job.pair(), job.request, job.raw);
    }
}

/// Brings the manifolds of pairs of boxes up to date: the same bits as [`contacts3`] one by one.
///
/// Any number of pairs; the last vector is filled up with leftovers if that is no multiple of eight,
/// so a few hundred at a time are best.
pub(crate) fn update_box_pairs3<N: Real>(jobs: &mut [BoxJob<'_, N, 3>]) {
    update_at(Level::new(), jobs);
}

/// [`update_box_pairs3`] with the vectors of an instruction set.
///
/// Of those of x86 only the largest that is worth it and the one that is always there are compiled:
/// wider registers than AVX2 has bring nothing to eight lanes.
fn update_at<N: Real>(level: Level, jobs: &mut [BoxJob<'_, N, 3>]) {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = level.as_avx2() {
        simd.vectorize(
            #[inline(always)]
            || update::<_, N, N::Lanes<_>>(simd, jobs),
        );
    } else if let Some(simd) = level.as_sse2() {
        simd.vectorize(
            #[inline(always)]
            || update::<_, N, N::Lanes<_>>(simd, jobs),
        );
    } else {
        jobs.iter_mut().for_each(|job| contacts3(&job.pair(), job.request, job.raw));
    }
    #[cfg(not(target_arch = "x86_64"))]
    fearless_simd::dispatch!(level, simd => update::<_, N, N::Lanes<_>>(simd, jobs));
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
    rotation: [[[N; LANES]; 3]; 3],
    translation: [[N; LANES]; 3],
    /// Half of the rectangle's box across the rectangle.
    half: [N; LANES],
    /// The lanes: the axis across the rectangle is the first, the second, the rectangle is on the
    /// positive side of it; the same of the parallelogram; the rectangle is the second box's.
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
            rotation: [[row; 3]; 3],
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
            bits(faces.is_upward),
            bits(faces.is_m[0]),
            bits(faces.is_m[1]),
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
        for (axis, &along) in normal.iter().enumerate() {
            along.store(&mut self.normal[axis]);
            boxes.translation[axis].store(&mut self.translation[axis]);
            for row in 0..3 {
                boxes.rotation[axis][row].store(&mut self.rotation[axis][row]);
            }
        }
    }

    /// The end of one pair.
    #[inline(always)]
    fn settle(&self, lane: usize, columns: &Columns, job: &mut BoxJob<'_, N, 3>) {
        if self.is_apart >> lane & 1 == 1 {
            job.raw.points.clear();
        } else if self.is_built >> lane & 1 == 1 {
            self.choose(lane, columns, job);
        } else {
            contacts3(&job.pair(), job.request, job.raw);
        }
    }

    #[inline(always)]
    fn choose(&self, lane: usize, columns: &Columns, job: &mut BoxJob<'_, N, 3>) {
        let sides = Sides::of(columns.byte(6, lane));
        let faces = [sides.rectangle, sides.parallelogram];
        let parts = parts_at(lane, &self.slots.at_end, &self.slots.beyond);
        let naming = Naming::new(faces, sides.is_second, parts);
        let choice = Choice {
            slots: &self.slots,
            lane,
            valid: columns.slots(0, lane),
            level: columns.slots(3, lane),
            gap: self.gap[lane],
            prediction: self.prediction[lane],
            tolerance: self.tolerance[lane],
        };
        let kept = Kept::of(job.raw, &naming, choice.valid);
        let deepest = choice.deepest(&kept);
        let chosen = choice.chosen(deepest, job.request.max_points.max(1), &kept);
        let raw = &mut *job.raw;
        raw.points.resize(chosen.len(), RawPoint::default());
        for (slot, point) in chosen.iter().zip(&mut raw.points) {
            point.id = kept.id(slot).unwrap_or_else(|| raw.ids.next());
            point.point1 = self.point1(lane, slot, &sides);
            point.distance = if slot == deepest { choice.gap } else { choice.distance(slot) };
            [point.feature1, point.feature2] = naming.features(slot);
        }
        if !raw.points.is_sorted_by_key(|point| point.id) {
            raw.points.sort_by_key(|point| point.id);
        }
        raw.normal = self.vector(&self.normal, lane);
    }

    #[inline(always)]
    fn vector(&self, rows: &[[N; LANES]; 3], lane: usize) -> Vector<N, 3> {
        Vector::<N, 3>::new(rows[0][lane], rows[1][lane], rows[2][lane])
    }

    /// The point of a slot on the first box, in its frame: as `Pose::point` for a rectangle of the
    /// second box.
    #[inline(always)]
    fn point1(&self, lane: usize, slot: usize, sides: &Sides) -> Point<N, 3> {
        let w = sides.rectangle.axis;
        let rise = if sides.is_second { self.slots.height[slot][lane] } else { N::ZERO };
        let level = self.half[lane] + rise;
        let mut point = [N::ZERO; 3];
        point[w] = if sides.rectangle.is_positive { level } else { -level };
        point[(w + 1) % 3] = self.slots.flat[0][slot][lane];
        point[(w + 2) % 3] = self.slots.flat[1][slot][lane];
        let [x, y, z] = point;
        if !sides.is_second {
            return Point::<N, 3>::new(x, y, z);
        }
        let [column1, column2, column3] = &self.rotation;
        let along = self.vector(column1, lane) * x
            + self.vector(column2, lane) * y
            + self.vector(column3, lane) * z;
        Point::from(along + self.vector(&self.translation, lane))
    }
}

/// The faces of one pair.
struct Sides {
    rectangle: Side,
    parallelogram: Side,
    is_second: bool,
}

impl Sides {
    /// From the bits of `Found::sides`.
    #[inline(always)]
    fn of(bits: u8) -> Self {
        const AXES: [usize; 4] = [2, 0, 1, 0];
        let side =
            |bits: u8| Side { axis: AXES[usize::from(bits & 3)], is_positive: bits & 4 != 0 };
        Self { rectangle: side(bits), parallelogram: side(bits >> 3), is_second: bits & 64 != 0 }
    }
}

/// The masks of eight pairs, turned so that a byte has the bits of one pair: three bytes of the slots
/// that are there, three of those that are level, one of the faces.
struct Columns([[u8; LANES]; 7]);

impl Columns {
    #[inline(always)]
    fn of<N: Real>(found: &Found<N>) -> Self {
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
        Self(rows.map(
            #[inline(always)]
            |row| transposed(u64::from_le_bytes(row)).to_le_bytes(),
        ))
    }

    #[inline(always)]
    fn byte(&self, row: usize, lane: usize) -> u8 {
        self.0[row][lane & (LANES - 1)]
    }

    /// The bits of all slots.
    #[inline(always)]
    fn slots(&self, row: usize, lane: usize) -> u32 {
        let bytes = [self.byte(row, lane), self.byte(row + 1, lane), self.byte(row + 2, lane), 0];
        u32::from_le_bytes(bytes)
    }
}

/// Eight bytes in a row.
#[inline(always)]
fn part(bytes: &[u8; SLOTS], first: usize) -> [u8; LANES] {
    core::array::from_fn(
        #[inline(always)]
        |index| bytes[first + index],
    )
}

/// A matrix of eight by eight bits with rows and columns exchanged (H. S. Warren, "Hacker's
/// Delight", 7-3).
#[inline(always)]
pub(super) const fn transposed(mut x: u64) -> u64 {
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
