//! Features and codes of the slots of one pair in 3D, and the lookup of a slot by its features.
//!
//! ```text
//!   parts of a face: 3 * p + q, p along its first axis, q along its second;
//!   0 at the negative end, 1 between, 2 at the positive end
//!
//!        2  5  8      corners 0 2 6 8, sides 1 3 5 7, 4 the face        pair of parts:
//!        1  4  7                                                        9 * rectangle's part
//!        0  3  6      q up, p to the right                              + parallelogram's part
//!
//!   code   31   19    12       5       0
//!          [1 | ... | faces | pair  | slot ]     faces: byte 6 of `Columns`
//! ```

use super::super::choose::SlotFeatures;
use super::FaceSides;
use super::SLOTS;
use super::clip::{CORNERS, SIGNS};
use crate::collide::RawPoint;
use crate::math::Real;
use crate::shape::FeatureId;

/// Number of parts of a face: four corners, four sides and the face itself; see the figure.
const PARTS: usize = 9;
/// Exclusive upper bound of the indices of features of one kind; a box has 12 edges.
const NUMBERS: usize = 12;
/// Marks a missing part or slot.
const NONE: u8 = u8::MAX;

/// Table of the features of one face of a box.
struct FaceFeatures {
    /// Feature of each part.
    parts: [FeatureId; PARTS],
    /// Part of the face with each feature, indexed by kind and feature index; [`NONE`] for features
    /// of other faces.
    part_of: [u8; 3 * NUMBERS],
}

/// Features of the six faces of a box, indexed by axis and by whether the face is at its positive
/// end.
static FACES: [[FaceFeatures; 2]; 3] = [
    [FaceFeatures::new(0, false), FaceFeatures::new(0, true)],
    [FaceFeatures::new(1, false), FaceFeatures::new(1, true)],
    [FaceFeatures::new(2, false), FaceFeatures::new(2, true)],
];

impl FaceFeatures {
    /// Computes the features of the face at one end of `axis`.
    const fn new(axis: usize, is_positive: bool) -> Self {
        let mut parts = [face(axis, is_positive); PARTS];
        let mut part_of = [NONE; 3 * NUMBERS];
        let mut part: u8 = 0;
        while (part as usize) < PARTS {
            let id = part_of_face(axis, is_positive, [part / 3, part % 3]);
            parts[part as usize] = id;
            part_of[index_of(id)] = part;
            part += 1;
        }
        Self { parts, part_of }
    }

    /// Returns the part that owns the feature `id`, or [`NONE`] if the id belongs to another face.
    #[inline(always)]
    fn part(&self, id: FeatureId) -> u8 {
        self.part_of.get(index_of(id)).copied().unwrap_or(NONE)
    }
}

/// Returns the position of a feature in `part_of`; `usize::MAX` for an index that no box has.
#[inline(always)]
const fn index_of(id: FeatureId) -> usize {
    let (kind, number) = match id {
        FeatureId::Vertex(number) => (0, number as usize),
        FeatureId::Edge(number) => (1, number as usize),
        FeatureId::Face(number) => (2, number as usize),
    };
    if number < NUMBERS { NUMBERS * kind + number } else { usize::MAX }
}

/// Returns a vertex. Each pair holds an axis and whether the vertex has a positive coordinate on
/// that axis.
const fn vertex([a, b, c]: [(usize, bool); 3]) -> FeatureId {
    FeatureId::Vertex((a.1 as u32) << a.0 | (b.1 as u32) << b.0 | (c.1 as u32) << c.0)
}

/// Returns the edge along `axis`; `next` and `after` are the signs of its coordinates on the next
/// two axes in cyclic order.
const fn edge(axis: usize, next: bool, after: bool) -> FeatureId {
    const FIRST: [u32; 3] = [0, 4, 8];
    FeatureId::Edge(FIRST[axis] + next as u32 + 2 * after as u32)
}

/// Returns the face at one end of an axis.
const fn face(axis: usize, is_positive: bool) -> FeatureId {
    const FIRST: [u32; 3] = [0, 2, 4];
    FeatureId::Face(FIRST[axis] + !is_positive as u32)
}

/// Returns the feature of one part of the face perpendicular to `w`; `first` and `second` are `p`
/// and `q` of the figure.
const fn part_of_face(w: usize, is_positive: bool, [first, second]: [u8; 2]) -> FeatureId {
    let (u, v) = ((w + 1) % 3, (w + 2) % 3);
    match (first, second) {
        (1, 1) => face(w, is_positive),
        (_, 1) => edge(v, is_positive, first == 2),
        (1, _) => edge(u, second == 2, is_positive),
        _ => vertex([(u, first == 2), (v, second == 2), (w, is_positive)]),
    }
}

/// Parts of the four sides of a face: at the positive and negative end of its first axis, then of
/// its second.
const SIDES: [u8; 4] = [7, 1, 5, 3];
/// Part of a face at each of its corners, in the order of the slots.
const OWN: [u8; 4] = own_parts();
/// Number of pairs of parts; pair `9 * r + p` has part `r` of the rectangle and `p` of the
/// parallelogram.
const PAIRS: usize = PARTS * PARTS;

const fn own_parts() -> [u8; 4] {
    let mut own = [0; 4];
    let mut corner = 0;
    while corner < 4 {
        let [x, y] = SIGNS[corner];
        own[corner] = 6 * x as u8 + 2 * y as u8;
        corner += 1;
    }
    own
}

/// Pair of parts of each slot, as the number `9 * r + p`. For a corner, only the summand of the
/// corner's own face.
const OWN_PAIRS: [u8; PLACES] = own_pairs();

const fn own_pairs() -> [u8; PLACES] {
    let mut pairs = [NONE; PLACES];
    let mut slot = 0;
    while slot < SLOTS {
        pairs[slot] = if slot < 4 {
            OWN[slot]
        } else if slot < CORNERS {
            9 * OWN[slot - 4]
        } else {
            9 * SIDES[(slot - CORNERS) % 4] + SIDES[(slot - CORNERS) / 4]
        };
        slot += 1;
    }
    pairs
}

/// The two parts of each pair: of the rectangle and of the parallelogram.
static PARTS_OF: [[u8; 2]; PAIRS] = parts_of();

/// Computes [`PARTS_OF`].
const fn parts_of() -> [[u8; 2]; PAIRS] {
    let mut all = [[0; 2]; PAIRS];
    let mut pair: u8 = 0;
    while (pair as usize) < PAIRS {
        all[pair as usize] = [pair / 9, pair % 9];
        pair += 1;
    }
    all
}

/// Slots that may hold a pair of parts, at most two: a corner of the parallelogram or a crossing,
/// and a corner of the rectangle.
static SLOTS_OF: [[u8; 2]; PAIRS] = slots_of();

/// Computes [`SLOTS_OF`]: stores each slot at all pairs of parts that it may hold.
const fn slots_of() -> [[u8; 2]; PAIRS] {
    let mut all = [[NONE; 2]; PAIRS];
    let mut slot: u8 = 0;
    while (slot as usize) < SLOTS {
        let own = OWN_PAIRS[slot as usize] as usize;
        let mut part = 0;
        while part < PARTS {
            if slot < 4 {
                all[own + PARTS * part][0] = slot;
            } else if (slot as usize) < CORNERS {
                all[own + part][1] = slot;
            } else {
                all[own][0] = slot;
            }
            part += 1;
        }
        slot += 1;
    }
    all
}

/// Eight bytes, each with only its lowest bit set.
const ONES: u64 = 0x0101_0101_0101_0101;

/// Features of the slots of one pair.
pub(super) struct BoxPairFeatures {
    rectangle: &'static FaceFeatures,
    parallelogram: &'static FaceFeatures,
    /// Whether the rectangle is a face of the second box.
    is_second: bool,
    /// Byte of the faces, shifted to its position in a code, and [`MARK`].
    faces: u32,
    /// Pair of parts of each slot.
    pairs: [u8; PLACES],
}

/// Number of slots that a code distinguishes.
const PLACES: usize = 32;
/// Position of the pair of parts in a code.
const PARTS_AT: u32 = 5;
/// Position of the byte of the faces in a code.
const FACES_AT: u32 = 12;
/// Bit that is set in every code, so that no code is 0.
const MARK: u32 = 1 << 31;
/// Mask of the bits of a pair of parts.
const PAIR_BITS: u32 = 127;

impl BoxPairFeatures {
    /// Computes the features for the two faces `sides`. `bits` is the byte that `sides` was decoded
    /// from; `parts` is the result of [`parts_at`].
    #[inline(always)]
    pub(super) fn new(sides: &FaceSides, bits: u8, parts: u64) -> Self {
        let mut pairs = OWN_PAIRS;
        // A byte for each corner: the summand of the corner's own face. The summand of the other
        // face is added below.
        let own = u64::from_le_bytes([
            pairs[0], pairs[1], pairs[2], pairs[3], pairs[4], pairs[5], pairs[6], pairs[7],
        ]);
        let below = parts & 0xffff_ffff;
        let corners = own + 9 * below + (parts - below);
        pairs[..CORNERS].copy_from_slice(&corners.to_le_bytes());
        let features = |side: FaceSide| &FACES[side.axis][usize::from(side.is_positive)];
        Self {
            rectangle: features(sides.rectangle),
            parallelogram: features(sides.parallelogram),
            is_second: sides.is_second,
            faces: MARK | u32::from(bits) << FACES_AT,
            pairs,
        }
    }
}

impl BoxPairFeatures {
    /// Returns the pair of parts that own two features; `None` if one of the features belongs to
    /// another face.
    #[inline(always)]
    fn pair(&self, [first, second]: [FeatureId; 2]) -> Option<usize> {
        let (below, above) = if self.is_second { (second, first) } else { (first, second) };
        let (below, above) = (self.rectangle.part(below), self.parallelogram.part(above));
        let is_there = below != NONE && above != NONE;
        is_there.then(|| PARTS * usize::from(below) + usize::from(above))
    }
}

impl SlotFeatures for BoxPairFeatures {
    #[inline(always)]
    fn features(&self, slot: usize) -> [FeatureId; 2] {
        let [below, above] = PARTS_OF[usize::from(self.pairs[slot])];
        let below = self.rectangle.parts[usize::from(below)];
        let above = self.parallelogram.parts[usize::from(above)];
        if self.is_second { [above, below] } else { [below, above] }
    }

    #[inline(always)]
    fn slot<N: Real, const D: usize>(&self, point: &RawPoint<N, D>, valid: u32) -> Option<usize> {
        let pair = if point.code >> FACES_AT == self.faces >> FACES_AT {
            (point.code >> PARTS_AT & PAIR_BITS) as usize
        } else {
            self.pair([point.feature1, point.feature2])?
        };
        let is_it = |slot: u8| {
            let slot = usize::from(slot);
            slot < SLOTS && usize::from(self.pairs[slot]) == pair && valid >> slot & 1 == 1
        };
        let &[one, other] = SLOTS_OF.get(pair)?;
        let slot = if is_it(one) { one } else { other };
        is_it(slot).then_some(usize::from(slot))
    }

    #[inline(always)]
    fn code(&self, slot: usize) -> u32 {
        let pair = u32::from(self.pairs[slot & (PLACES - 1)]);
        self.faces | pair << PARTS_AT | u32::from(slot.to_le_bytes()[0])
    }
}

/// A face of a box: perpendicular to `axis`, at the positive or the negative end of this axis.
#[derive(Clone, Copy)]
pub(super) struct FaceSide {
    pub(super) axis: usize,
    pub(super) is_positive: bool,
}

/// Returns, in one byte for each of the 8 corners, the part of the other face that the corner lies
/// on, from the bits of `lane` in `at_end` and `beyond`.
#[inline(always)]
pub(super) fn parts_at(
    lane: usize,
    at_end: &[[u8; CORNERS]; 2],
    beyond: &[[u8; CORNERS]; 2],
) -> u64 {
    // Position along one axis: 0 at the negative end, 1 between, 2 at the positive end.
    let third = |axis: usize| {
        let at_end = u64::from_le_bytes(at_end[axis]) >> lane & ONES;
        let beyond = u64::from_le_bytes(beyond[axis]) >> lane;
        ONES - at_end + 2 * (at_end & beyond)
    };
    3 * third(0) + third(1)
}
