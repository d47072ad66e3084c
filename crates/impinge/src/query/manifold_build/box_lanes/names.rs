//! Names of the parts of boxes in a byte, so that pairs of them are compared at once.

use super::clip::{CORNERS, SIGNS};
use crate::query::manifold_build::box_faces::{edge, face, vertex};
use crate::shape::FeatureId;

/// What is no name of a part of a box.
const NONE: u8 = u8::MAX;

/// A face by its axis and whether it is on the positive side: its nine parts. The place of a part is
/// three times its place along the face's first axis plus that along the second: at the negative
/// end, between, at the positive end.
const PARTS: [[[u8; 9]; 2]; 3] = parts();

const fn parts() -> [[[u8; 9]; 2]; 3] {
    let mut all = [[[NONE; 9]; 2]; 3];
    let mut number = 0;
    while number < 54 {
        let (axis, side, part) = (number / 18, number / 9 % 2, number % 9);
        all[axis][side][part] = code(part_of_face(axis, side == 1, [part / 3, part % 3]));
        number += 1;
    }
    all
}

const fn part_of_face(w: usize, is_positive: bool, [first, second]: [usize; 2]) -> FeatureId {
    let (u, v) = ((w + 1) % 3, (w + 2) % 3);
    match (first, second) {
        (1, 1) => face(w, is_positive),
        (_, 1) => edge(v, is_positive, first == 2),
        (1, _) => edge(u, second == 2, is_positive),
        _ => vertex([(u, first == 2), (v, second == 2), (w, is_positive)]),
    }
}

/// The kind in the upper half, the number in the lower.
const fn code(id: FeatureId) -> u8 {
    let (kind, number) = match id {
        FeatureId::Vertex(number) => (0, number),
        FeatureId::Edge(number) => (1, number),
        FeatureId::Face(number) => (2, number),
    };
    if number < 16 { kind << 4 | number.to_le_bytes()[0] } else { NONE }
}

fn decoded(code: u8) -> FeatureId {
    let number = u32::from(code & 15);
    match code >> 4 {
        0 => FeatureId::Vertex(number),
        1 => FeatureId::Edge(number),
        _ => FeatureId::Face(number),
    }
}

/// The names of two parts, of the first and the second box.
#[derive(Clone, Copy, PartialEq, Eq, Default)]
pub(super) struct Key(u16);

impl Key {
    pub(super) const fn of(features: [FeatureId; 2]) -> Self {
        Self(u16::from_le_bytes([code(features[0]), code(features[1])]))
    }

    pub(super) fn features(self) -> [FeatureId; 2] {
        self.0.to_le_bytes().map(decoded)
    }
}

/// The parts that a slot stands for, of the rectangle and the parallelogram; of a corner, the part
/// of its own face alone.
const SLOT_PARTS: [[u8; 2]; 24] = slot_parts();

const fn slot_parts() -> [[u8; 2]; 24] {
    let mut all = [[4; 2]; 24];
    let mut slot = 0;
    while slot < 24 {
        if slot < CORNERS {
            let [x, y] = SIGNS[slot % 4];
            all[slot][1 - slot / 4] = 6 * x as u8 + 2 * y as u8;
        } else {
            all[slot] = [side((slot - CORNERS) % 4), side((slot - CORNERS) / 4)];
        }
        slot += 1;
    }
    all
}

/// The four sides in the order of the slots: at the ends of the first axis, then of the second.
const fn side(number: usize) -> u8 {
    [7, 1, 5, 3][number]
}

/// How the slots of one pair are named.
pub(super) struct Naming {
    rectangle: &'static [u8; 9],
    parallelogram: &'static [u8; 9],
    is_second: bool,
    at_end: [u8; 2],
    beyond: [u8; 2],
}

/// A face: its axis, and whether it is on the positive side.
pub(super) type Side = (usize, bool);

impl Naming {
    /// For a rectangle of the second box or the first; `at_end` and `beyond` are bits of the corners.
    #[inline]
    pub(super) fn new(
        [rectangle, parallelogram]: [Side; 2],
        is_second: bool,
        at_end: [u8; 2],
        beyond: [u8; 2],
    ) -> Self {
        let parts = |(axis, is_positive): Side| &PARTS[axis][usize::from(is_positive)];
        let (rectangle, parallelogram) = (parts(rectangle), parts(parallelogram));
        Self { rectangle, parallelogram, is_second, at_end, beyond }
    }

    /// The name of a candidate.
    #[inline]
    pub(super) fn key(&self, slot: usize) -> Key {
        let mut parts = SLOT_PARTS[slot];
        if slot < CORNERS {
            parts[slot / 4] = 3 * self.third(0, slot) + self.third(1, slot);
        }
        let below = self.rectangle[usize::from(parts[0])];
        let above = self.parallelogram[usize::from(parts[1])];
        Key(u16::from_le_bytes(if self.is_second { [above, below] } else { [below, above] }))
    }

    /// Where a corner lies along an axis of the other face: 0, 1 or 2.
    #[inline]
    fn third(&self, axis: usize, slot: usize) -> u8 {
        let at_end = self.at_end[axis] >> slot & 1;
        1 - at_end + 2 * (at_end & self.beyond[axis] >> slot)
    }
}
