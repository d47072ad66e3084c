//! Corners of the common area of two faces, for `L` pairs, each in a slot of its own.
//!
//! ```text
//!   slot  0..4    corner of the parallelogram         signs of slot, by both axes of its own face:
//!         4..8    corner of the rectangle             0 ++   1 -+   2 --   3 +-
//!         8..24   crossing of two sides:              8 + 8 * arm + 4 * (arm's negative end)
//!                                                       + 2 * axis + (axis' negative end)
//!           1 ---------- 0
//!          /  5 --------/x---- 4     x: the side at the positive end of arm 0 crosses that at the
//!         /   |        /       |        positive end of axis 1: slot 8 + 0 + 0 + 2 + 0
//!        2 ---------- 3        |
//!             6 -------------- 7
//! ```
//!
//! `valid` says which of the 24 exist, so nothing is moved until all is known. `names` has the same
//! order.

use super::super::admit::{Admission, Limits, Slots};
use super::SLOTS;
use super::faces::{FacesInLanes, cross};
use super::shown::ShownFaces;
use crate::math::lanes::bits;
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide};

/// The first eight slots are corners; their features depend on what they lie above or below.
pub(super) const CORNERS: usize = 8;

/// Signs of the two coordinates of a corner, in the order of the slots.
pub(super) const SIGNS: [[bool; 2]; 4] =
    [[true, true], [false, true], [false, false], [true, false]];

/// Positions of the corners relative to the other face: masks of `L` pairs.
pub(super) struct Corners {
    /// At an end of the other face along its first or second axis.
    pub(super) at_end: [[u8; CORNERS]; 2],
    /// On the positive side of that axis.
    pub(super) beyond: [[u8; CORNERS]; 2],
}

impl Corners {
    pub(super) const fn new() -> Self {
        Self { at_end: [[0; CORNERS]; 2], beyond: [[0; CORNERS]; 2] }
    }
}

/// A corner of one face, relative to the other face.
struct CornerPlace<V, M> {
    /// Coordinates along the axes `u` and `v` of the rectangle.
    flat: [V; 2],
    /// Height above the rectangle along the normal.
    height: V,
    /// It lies inside the other face, or outside by at most twice the tolerance.
    is_inside: M,
    /// For each axis of the other face: it is at one of its ends, up to the tolerance.
    at_end: [M; 2],
    /// For each axis of the other face: it is on the positive side.
    beyond: [M; 2],
}

#[inline(always)]
fn signed<S: Simd, V: Wide<S>>(value: V, is_positive: bool) -> V {
    if is_positive { value } else { -value }
}

/// Returns one end of the side at the end `sign` of `arm`: the lower or the upper one.
const fn ends(arm: usize, sign: bool, upper: bool) -> [bool; 2] {
    if arm == 0 { [sign, upper] } else { [upper, sign] }
}

/// The clipping of `L` pairs.
pub(super) struct Clip<'a, S, N: Real, V, M, const L: usize> {
    simd: S,
    faces: &'a FacesInLanes<V, M>,
    /// Supporting features of the rectangle and of the parallelogram.
    shown: [ShownFaces<M>; 2],
    /// Collects heights and level candidates while the slots are filled.
    admission: Admission<V>,
    slots: &'a mut Slots<N, 3, SLOTS, L>,
    corners: &'a mut Corners,
    /// One of the faces is tilted too far in some lane.
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
        let (shown, admission) = (faces.shown(simd), Admission::new(simd, *limits));
        Self { simd, faces, shown, admission, slots, corners, is_partial }
    }

    /// Fills the slots with the candidates.
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

    /// Returns coordinates and height of a corner of the parallelogram.
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
    fn above(&self, corner: usize) -> CornerPlace<V, M> {
        let (flat, height) = self.arm_end(SIGNS[corner]);
        let across = &self.faces.across;
        // Distances inside the sides of the rectangle, along both of its axes.
        let inside = [across[0] - flat[0].abs(), across[1] - flat[1].abs()];
        let mut place = self.place((flat, height), inside, flat);
        if self.is_partial {
            place.is_inside &= self.shown[0].is_whole() & self.shown[1].has_corner(corner);
        }
        place
    }

    /// Compares a corner of the rectangle with the parallelogram.
    #[inline(always)]
    fn below(&self, corner: usize) -> CornerPlace<V, M> {
        let signs = SIGNS[corner];
        let (faces, one) = (self.faces, V::all(self.simd, N::ONE));
        let flat = [signed(faces.across[0], signs[0]), signed(faces.across[1], signs[1])];
        // Coordinates along the arms are 1 and -1 at the sides of the parallelogram.
        let arm = [flat[0] - faces.center[0], flat[1] - faces.center[1]];
        let along =
            [cross(&arm, &faces.arms[1]) / faces.area, cross(&faces.arms[0], &arm) / faces.area];
        let inside =
            [(one - along[0].abs()) * faces.widths[0], (one - along[1].abs()) * faces.widths[1]];
        let height = faces.height + along[0] * faces.climbs[0] + along[1] * faces.climbs[1];
        let mut place = self.place((flat, height), inside, along);
        if self.is_partial {
            place.is_inside &=
                self.shown[0].is_whole() & self.shown[1].has_place(&place.at_end, &place.beyond);
        }
        place
    }

    /// Compares a point with the other face, whose ends it lies `inside` of along both axes, with
    /// the coordinates `coordinates` on them.
    #[inline(always)]
    fn place(
        &self,
        (flat, height): ([V; 2], V),
        inside: [V; 2],
        coordinates: [V; 2],
    ) -> CornerPlace<V, M> {
        let (tolerance, zero) = (self.faces.tolerance, V::all(self.simd, N::ZERO));
        // A crossing is farther than the tolerance from all ends. Corners are admitted up to twice
        // as far outside, so that rounding never drops both a corner and the crossing next to it.
        let out = -(tolerance + tolerance);
        CornerPlace {
            flat,
            height,
            is_inside: !inside[0].smaller(inside[1]).simd_lt(out),
            at_end: [inside[0].simd_le(tolerance), inside[1].simd_le(tolerance)],
            beyond: [coordinates[0].simd_gt(zero), coordinates[1].simd_gt(zero)],
        }
    }

    /// Stores a corner in its slot, and its position relative to the other face.
    #[inline(always)]
    fn corner(&mut self, slot: usize, place: &CornerPlace<V, M>) {
        for axis in 0..2 {
            self.corners.at_end[axis][slot] = bits(place.at_end[axis]);
            self.corners.beyond[axis][slot] = bits(place.beyond[axis]);
        }
        self.store(slot, &place.flat, place.height, place.is_inside);
    }

    /// Crosses a side of the parallelogram with all sides of the rectangle.
    #[inline(always)]
    fn crossings(&mut self, slot: usize, arm: usize, sign: bool) {
        let (from, low) = self.arm_end(ends(arm, sign, false));
        let (to, high) = self.arm_end(ends(arm, sign, true));
        let side = [to[0] - from[0], to[1] - from[1]];
        let (from, side) = ((&from, low), (&side, high - low));
        let ends = [from, side, (&to, high)];
        let is_shown = self.shown[1].has_side(arm, sign);
        self.crossing(slot, ends, (0, true), is_shown);
        self.crossing(slot + 1, ends, (0, false), is_shown);
        self.crossing(slot + 2, ends, (1, true), is_shown);
        self.crossing(slot + 3, ends, (1, false), is_shown);
    }

    /// Crosses a side with the side of the rectangle at one end of an axis; only crossings away
    /// from the ends of both count.
    #[inline(always)]
    fn crossing(
        &mut self,
        slot: usize,
        [from, side, to]: [(&[V; 2], V); 3],
        (axis, is_positive): (usize, bool),
        is_shown: M,
    ) {
        let (across, tolerance) = (&self.faces.across, self.faces.tolerance);
        let at = signed(across[axis], is_positive);
        let (before, after) = (from.0[axis] - at, to.0[axis] - at);
        // Both ends farther than the tolerance from the line, on opposite sides.
        let leaves = before.simd_gt(tolerance) & after.simd_lt(-tolerance);
        let enters = before.simd_lt(-tolerance) & after.simd_gt(tolerance);
        if M::LEN == 1 && !(leaves | enters).any_true() {
            // Most sides of a lone pair do not cross; among eight pairs some do.
            (self.slots.valid[slot], self.slots.level[slot]) = (0, 0);
            return;
        }
        let along = before / (before - after);
        let flat = [from.0[0] + side.0[0] * along, from.0[1] + side.0[1] * along];
        let is_within = flat[1 - axis].abs().simd_lt(across[1 - axis] - tolerance);
        let height = from.1 + side.1 * along;
        let mut is_there = (leaves | enters) & is_within;
        if self.is_partial {
            is_there &= is_shown & self.shown[0].has_side(axis, is_positive);
        }
        self.store(slot, &flat, height, is_there);
    }

    /// Stores a candidate.
    #[inline(always)]
    fn store(&mut self, slot: usize, flat: &[V; 2], height: V, is_there: M) {
        self.admission.store(self.simd, self.slots, slot, flat, height, is_there);
    }
}

/// Drops corners of the rectangle that coincide with a corner of the parallelogram.
#[inline(always)]
fn drop_coincident<S: Simd, V, M: SimdMask<S>>(
    above: &[CornerPlace<V, M>; 4],
    below: &mut [CornerPlace<V, M>; 4],
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

/// Returns the lanes where the coordinates have these signs.
#[inline(always)]
fn is_at<S: Simd, V, M: SimdMask<S>>(place: &CornerPlace<V, M>, signs: [bool; 2]) -> M {
    let [x, y] = place.beyond;
    (if signs[0] { x } else { !x }) & (if signs[1] { y } else { !y })
}
