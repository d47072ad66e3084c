//! Corners of the overlap area of the rectangle and the parallelogram of [`faces`](super::faces),
//! for `L` pairs, each in its own slot.
//!
//! ```text
//!   slot  0..4    corner of the parallelogram         signs of slot, by both axes of its own face:
//!         4..8    corner of the rectangle             0 ++   1 -+   2 --   3 +-
//!         8..24   crossing of two sides:              8 + 8 * arm + 4 * (arm's negative end)
//!                                                       + 2 * axis + (axis' negative end)
//!           1 ---------- 0
//!          /  5 --------/x---- 4     x: the side at the positive end of arm 0 crosses the side at
//!         /   |        /       |        the positive end of axis 1: slot 8 + 0 + 0 + 2 + 0
//!        2 ---------- 3        |
//!             6 -------------- 7
//! ```
//!
//! The mask `valid` marks the filled slots among the 24, so no candidate is moved before the final
//! choice. `features` uses the same order of slots.

use super::super::admit::{Admission, Limits, Slots};
use super::SLOTS;
use super::faces::{FacesInLanes, cross};
use super::supporting::SupportingParts;
use crate::math::lanes::bits;
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide};

/// Number of slots for corners of the two faces; they come first. The features of a candidate in
/// one of them depend on the part of the other face below or above the corner.
pub(super) const CORNERS: usize = 8;

/// Signs of the two coordinates of a corner on its own face, in the order of the slots.
pub(super) const SIGNS: [[bool; 2]; 4] =
    [[true, true], [false, true], [false, false], [true, false]];

/// Positions of the 8 corners relative to the other face, as masks over the lanes, indexed by axis
/// of the other face.
pub(super) struct Corners {
    /// Lanes where the corner is at an end of the other face along that axis, within the tolerance,
    /// or beyond the end.
    pub(super) at_end: [[u8; CORNERS]; 2],
    /// Lanes where the coordinate of the corner along that axis, measured from the centre of the
    /// other face, is positive.
    pub(super) beyond: [[u8; CORNERS]; 2],
}

impl Corners {
    pub(super) const fn new() -> Self {
        Self { at_end: [[0; CORNERS]; 2], beyond: [[0; CORNERS]; 2] }
    }
}

/// A corner of one face, relative to the other face.
struct CornerPosition<V, M> {
    /// Coordinates along the axes `u` and `v` of the rectangle.
    flat: [V; 2],
    /// Height above the rectangle, along the normal.
    height: V,
    /// Lanes where the corner is inside the other face, or outside by at most twice the tolerance.
    is_inside: M,
    /// For each axis of the other face: lanes where the corner is at one of its ends, within the
    /// tolerance, or beyond it.
    at_end: [M; 2],
    /// For each axis of the other face: lanes where the coordinate of the corner along it, measured
    /// from the centre of that face, is positive.
    beyond: [M; 2],
}

#[inline(always)]
fn signed<S: Simd, V: Wide<S>>(value: V, is_positive: bool) -> V {
    if is_positive { value } else { -value }
}

/// Returns the signs, along both arms, of a corner of the parallelogram: `sign` along the arm
/// `arm`, and `upper` along the other arm. With `arm` and `sign` fixed, the two values of `upper`
/// give the ends of one side.
const fn ends(arm: usize, sign: bool, upper: bool) -> [bool; 2] {
    if arm == 0 { [sign, upper] } else { [upper, sign] }
}

/// State while the two faces of each of `L` pairs are clipped against each other.
pub(super) struct Clip<'a, S, N: Real, V, M, const L: usize> {
    simd: S,
    faces: &'a FacesInLanes<V, M>,
    /// Supporting features of the rectangle and of the parallelogram.
    supporting: [SupportingParts<M>; 2],
    /// Collects the lowest height and the level candidates while the slots are filled.
    admission: Admission<V>,
    slots: &'a mut Slots<N, 3, SLOTS, L>,
    corners: &'a mut Corners,
    /// Set if one of the faces is tilted too far in some lane, so that parts of faces have to be
    /// excluded.
    is_partial: bool,
}

impl<'a, S, N, V, M, const L: usize> Clip<'a, S, N, V, M, L>
where
    S: Simd,
    N: Real,
    V: Wide<S, Scalar = N, Mask = M>,
    M: SimdMask<S>,
{
    #[inline(always)]
    pub(super) fn new(
        simd: S,
        faces: &'a FacesInLanes<V, M>,
        limits: &Limits<V>,
        slots: &'a mut Slots<N, 3, SLOTS, L>,
        corners: &'a mut Corners,
        is_partial: bool,
    ) -> Self {
        let (supporting, admission) = (faces.supporting(simd), Admission::new(simd, *limits));
        Self { simd, faces, supporting, admission, slots, corners, is_partial }
    }

    /// Fills all 24 slots; returns the state of the admission.
    #[inline(always)]
    pub(super) fn run(mut self) -> Admission<V> {
        let above = [self.above(0), self.above(1), self.above(2), self.above(3)];
        let mut below = [self.below(0), self.below(1), self.below(2), self.below(3)];
        drop_coincident(&above, &mut below);
        let [a, b, c, d] = above;
        self.corner(0, &a);
        self.corner(1, &b);
        self.corner(2, &c);
        self.corner(3, &d);
        let [a, b, c, d] = below;
        self.corner(4, &a);
        self.corner(5, &b);
        self.corner(6, &c);
        self.corner(7, &d);
        self.crossings(CORNERS, 0, true);
        self.crossings(CORNERS + 4, 0, false);
        self.crossings(CORNERS + 8, 1, true);
        self.crossings(CORNERS + 12, 1, false);
        self.admission
    }

    /// Returns the coordinates `u`, `v` and the height of the parallelogram's corner with the signs
    /// `signs` along both arms.
    #[inline(always)]
    fn arm_end(&self, signs: [bool; 2]) -> ([V; 2], V) {
        let (center, arms, climbs) = (&self.faces.center, &self.faces.arms, &self.faces.climbs);
        let x = center[0] + signed(arms[0][0], signs[0]) + signed(arms[1][0], signs[1]);
        let y = center[1] + signed(arms[0][1], signs[0]) + signed(arms[1][1], signs[1]);
        let height = self.faces.height + signed(climbs[0], signs[0]) + signed(climbs[1], signs[1]);
        ([x, y], height)
    }

    /// Compares a corner of the parallelogram with the rectangle.
    #[inline(always)]
    fn above(&self, corner: usize) -> CornerPosition<V, M> {
        let (flat, height) = self.arm_end(SIGNS[corner]);
        let across = &self.faces.across;
        // Signed distances to the sides of the rectangle, positive inside, along both of its axes.
        let inside = [across[0] - flat[0].abs(), across[1] - flat[1].abs()];
        let mut position = self.compare((flat, height), inside, flat);
        if self.is_partial {
            position.is_inside &=
                self.supporting[0].is_whole() & self.supporting[1].has_corner(corner);
        }
        position
    }

    /// Compares a corner of the rectangle with the parallelogram.
    #[inline(always)]
    fn below(&self, corner: usize) -> CornerPosition<V, M> {
        let signs = SIGNS[corner];
        let (faces, one) = (self.faces, V::all(self.simd, N::ONE));
        let flat = [signed(faces.across[0], signs[0]), signed(faces.across[1], signs[1])];
        // Coordinates along the arms: 1 and -1 at the sides of the parallelogram, 0 at its centre.
        let arm = [flat[0] - faces.center[0], flat[1] - faces.center[1]];
        let along =
            [cross(&arm, &faces.arms[1]) / faces.area, cross(&faces.arms[0], &arm) / faces.area];
        let inside =
            [(one - along[0].abs()) * faces.widths[0], (one - along[1].abs()) * faces.widths[1]];
        let height = faces.height + along[0] * faces.climbs[0] + along[1] * faces.climbs[1];
        let mut position = self.compare((flat, height), inside, along);
        if self.is_partial {
            position.is_inside &= self.supporting[0].is_whole()
                & self.supporting[1].has_position(&position.at_end, &position.beyond);
        }
        position
    }

    /// Compares a corner of one face with the other face. `inside` are its signed distances to the
    /// nearest sides of that face along both axes, positive inside. Only the signs of
    /// `coordinates`, along these axes, are used.
    #[inline(always)]
    fn compare(
        &self,
        (flat, height): ([V; 2], V),
        inside: [V; 2],
        coordinates: [V; 2],
    ) -> CornerPosition<V, M> {
        let (tolerance, zero) = (self.faces.tolerance, V::all(self.simd, N::ZERO));
        // A crossing counts only farther than the tolerance from all ends. Corners count up to
        // twice the tolerance outside, so that rounding never drops both a corner and the crossing
        // next to it.
        let out = -(tolerance + tolerance);
        CornerPosition {
            flat,
            height,
            is_inside: !inside[0].smaller(inside[1]).simd_lt(out),
            at_end: [inside[0].simd_le(tolerance), inside[1].simd_le(tolerance)],
            beyond: [coordinates[0].simd_gt(zero), coordinates[1].simd_gt(zero)],
        }
    }

    /// Stores a corner in its slot, and the masks of its position in `corners`.
    #[inline(always)]
    fn corner(&mut self, slot: usize, position: &CornerPosition<V, M>) {
        for axis in 0..2 {
            self.corners.at_end[axis][slot] = bits(position.at_end[axis]);
            self.corners.beyond[axis][slot] = bits(position.beyond[axis]);
        }
        self.store(slot, &position.flat, position.height, position.is_inside);
    }

    /// Fills four slots, from `slot` on, with the crossings of one side of the parallelogram with
    /// the four sides of the rectangle. The side is at the end `sign` of the arm `arm`.
    #[inline(always)]
    fn crossings(&mut self, slot: usize, arm: usize, sign: bool) {
        let (from, low) = self.arm_end(ends(arm, sign, false));
        let (to, high) = self.arm_end(ends(arm, sign, true));
        let side = [to[0] - from[0], to[1] - from[1]];
        let (from, side) = ((&from, low), (&side, high - low));
        let ends = [from, side, (&to, high)];
        let is_supporting = self.supporting[1].has_side(arm, sign);
        self.crossing(slot, ends, (0, true), is_supporting);
        self.crossing(slot + 1, ends, (0, false), is_supporting);
        self.crossing(slot + 2, ends, (1, true), is_supporting);
        self.crossing(slot + 3, ends, (1, false), is_supporting);
    }

    /// Fills `slot` with the crossing of a side of the parallelogram and the side of the rectangle
    /// at one end of `axis`. Only crossings farther than the tolerance from the ends of both sides
    /// count.
    #[inline(always)]
    fn crossing(
        &mut self,
        slot: usize,
        [from, side, to]: [(&[V; 2], V); 3],
        (axis, is_positive): (usize, bool),
        is_supporting: M,
    ) {
        let (across, tolerance) = (&self.faces.across, self.faces.tolerance);
        let at = signed(across[axis], is_positive);
        let (before, after) = (from.0[axis] - at, to.0[axis] - at);
        // Both ends are farther than the tolerance from the line, on opposite sides of it.
        let leaves = before.simd_gt(tolerance) & after.simd_lt(-tolerance);
        let enters = before.simd_lt(-tolerance) & after.simd_gt(tolerance);
        if M::LEN == 1 && !(leaves | enters).any_true() {
            // Most sides of a single pair do not cross. Among 8 pairs some do, so the test would
            // not pay.
            (self.slots.valid[slot], self.slots.level[slot]) = (0, 0);
            return;
        }
        let along = before / (before - after);
        let flat = [from.0[0] + side.0[0] * along, from.0[1] + side.0[1] * along];
        let is_within = flat[1 - axis].abs().simd_lt(across[1 - axis] - tolerance);
        let height = from.1 + side.1 * along;
        let mut is_there = (leaves | enters) & is_within;
        if self.is_partial {
            is_there &= is_supporting & self.supporting[0].has_side(axis, is_positive);
        }
        self.store(slot, &flat, height, is_there);
    }

    /// Stores a candidate in `slot`, in the lanes of `is_there`.
    #[inline(always)]
    fn store(&mut self, slot: usize, flat: &[V; 2], height: V, is_there: M) {
        self.admission.store(self.simd, self.slots, slot, flat, height, is_there);
    }
}

/// Drops corners of the rectangle that coincide with a corner of the parallelogram.
#[inline(always)]
fn drop_coincident<S: Simd, V, M: SimdMask<S>>(
    above: &[CornerPosition<V, M>; 4],
    below: &mut [CornerPosition<V, M>; 4],
) {
    for (lower, lower_signs) in below.iter_mut().zip(SIGNS) {
        let at_corner = lower.is_inside & lower.at_end[0] & lower.at_end[1];
        if !at_corner.any_true() {
            continue;
        }
        for (upper, upper_signs) in above.iter().zip(SIGNS) {
            let faces = upper.is_inside & upper.at_end[0] & upper.at_end[1];
            let is_same = at_corner & faces & is_at(lower, upper_signs) & is_at(upper, lower_signs);
            lower.is_inside &= !is_same;
        }
    }
}

/// Returns the lanes where the coordinates of the corner on the other face have the signs `signs`.
#[inline(always)]
fn is_at<S: Simd, V, M: SimdMask<S>>(position: &CornerPosition<V, M>, signs: [bool; 2]) -> M {
    let [x, y] = position.beyond;
    (if signs[0] { x } else { !x }) & (if signs[1] { y } else { !y })
}
