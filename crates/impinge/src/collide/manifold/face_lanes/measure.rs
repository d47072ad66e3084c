//! Measures what a solid and eight triangles show along the normals: the distances of the corners
//! of each outline from the sides of the other, and the distances between both along the normal.
//!
//! ```text
//!      v3 ──────────── v2     seen along the normal n of the lane, which points into the page
//!       │               │     inside   distance of c1 from the line of side v1 v2, across n;
//!       │    c1 ─inside─┤              positive on the inner side of the outline
//!       │               │     within   inside > tolerance;  beyond: inside < -tolerance
//!      v0 ──────────── v1     depth    distance along n from c1 to the plane of the face
//! ```
//!
//! Everything is in the frame of the solid. A row `[N; LANES]` has a number for each triangle, a
//! byte a bit.

use super::super::frame::ROUNDING_ERRORS;
use super::FaceSolid;
use crate::collide::packet::{LANES, PartPacket};
use crate::math::lanes::{
    bits, cross, dot, in_lanes, lit, load, minus, norm, spread, times, turned_back,
};
use crate::math::simd::{Run, Simd, SimdMask};
use crate::math::{Real, Vector, Wide};
use crate::shape::{CLEARLY_LARGER, FACING_SINE_SQUARED, FaceRing, THIN_SQUARED};

/// Most corners of a face.
const MAX: usize = FaceRing::<f32>::MAX;

/// Distances of the corners of one outline from the sides of the other, by corner and side, and
/// masks of the lanes in which they exceed the rounding error.
pub(super) struct SideHeights<N, const CORNERS: usize, const SIDES: usize> {
    /// Signed distances, positive on the inner side.
    inside: [[[N; LANES]; SIDES]; CORNERS],
    /// The lanes in which `inside` is above the tolerance, and below its opposite. NaN is neither.
    within: [[u8; SIDES]; CORNERS],
    beyond: [[u8; SIDES]; CORNERS],
    /// The lanes in which a corner is beyond some side, and in which it is on the line of some
    /// side.
    pub(super) is_beyond: [u8; CORNERS],
    pub(super) is_on: [u8; CORNERS],
}

impl<N: Real, const CORNERS: usize, const SIDES: usize> SideHeights<N, CORNERS, SIDES> {
    const fn blank() -> Self {
        let (inside, none) = ([[[N::ZERO; LANES]; SIDES]; CORNERS], [[0; SIDES]; CORNERS]);
        let blank = [0; CORNERS];
        Self { inside, within: none, beyond: none, is_beyond: blank, is_on: blank }
    }

    /// Stores the distances of one corner from one side. Side 0 resets the masks of the corner.
    #[inline(always)]
    fn put<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        [corner, side]: [usize; 2],
        inside: V,
        tolerance: V,
    ) {
        inside.store(&mut self.inside[corner][side]);
        let (within, beyond) = (bits(inside.simd_gt(tolerance)), bits(inside.simd_lt(-tolerance)));
        (self.within[corner][side], self.beyond[corner][side]) = (within, beyond);
        if side == 0 {
            (self.is_beyond[corner], self.is_on[corner]) = (0, 0);
        }
        self.is_beyond[corner] |= beyond;
        self.is_on[corner] |= !(within | beyond);
    }

    /// The lanes in which a corner is on the line of a side, within the tolerance.
    pub(super) const fn on(&self, corner: usize, side: usize) -> u8 {
        !(self.within[corner][side] | self.beyond[corner][side])
    }

    /// The lanes in which two corners lie on different sides of the line of a side, both off it.
    fn parted(&self, [from, to]: [usize; 2], side: usize) -> u8 {
        self.within[from][side] & self.beyond[to][side]
            | self.beyond[from][side] & self.within[to][side]
    }

    /// The share of the way from one corner to another at which it crosses the line of a side.
    pub(super) fn share(&self, [from, to]: [usize; 2], side: usize, lane: usize) -> N {
        let [from, to] = [self.inside[from][side][lane], self.inside[to][side][lane]];
        from / (from - to)
    }
}

/// A face and eight triangles, measured along the normals. Of an edge or corner of the solid, the
/// ring holds two points or one.
pub(in crate::collide) struct FaceClip<N: Real> {
    pub(super) ring: FaceRing<N>,
    /// The corners of the triangles, and the signed distances along the normal from these to the
    /// plane of the face; negative where they overlap. Unused unless the ring is a face.
    pub(super) corners: [[[N; LANES]; 3]; 3],
    pub(super) depths: [[N; LANES]; 3],
    /// The signed distances along the normal from the planes of the triangles to the corners of the
    /// ring.
    pub(super) vertex_depths: [[N; LANES]; MAX],
    /// The corners of the triangles against the sides of the ring, and the reverse.
    pub(super) in_face: SideHeights<N, 3, MAX>,
    pub(super) in_triangle: SideHeights<N, MAX, 3>,
    /// Bound of the rounding errors of lengths.
    pub(super) tolerance: [N; LANES],
    pub(super) shown: ShownBits,
    /// The lanes in which the shown feature is certain and all sides are longer than two
    /// tolerances.
    pub(super) plain: u8,
    /// The lanes in which a side of the triangle, the first index, and a side of the ring cross.
    pub(super) crossed: [[u8; MAX]; 3],
}

/// The lanes in which a triangle shows its face, and the corners and sides of the shown feature.
#[derive(Clone, Copy, Default)]
pub(super) struct ShownBits {
    pub(super) face: u8,
    /// The lanes in which the face is the back.
    pub(super) back: u8,
    pub(super) corners: [u8; 3],
    pub(super) sides: [u8; 3],
}

impl<N: Real> FaceClip<N> {
    pub(in crate::collide) fn blank() -> Self {
        let zeros = [N::ZERO; LANES];
        Self {
            ring: FaceRing::blank(),
            corners: [[zeros; 3]; 3],
            depths: [zeros; 3],
            vertex_depths: [zeros; MAX],
            in_face: SideHeights::blank(),
            in_triangle: SideHeights::blank(),
            tolerance: zeros,
            shown: ShownBits::default(),
            plain: 0,
            crossed: [[0; MAX]; 3],
        }
    }

    /// Measures the lanes of a run.
    pub(super) fn measure(
        &mut self,
        run: Run,
        solid: &FaceSolid<'_, N>,
        triangles: &PartPacket<N, 3>,
        normals: &[[N; LANES]; 3],
    ) {
        in_lanes!(run, simd =>
            self.measure_in_lanes::<_, N::Lanes<_>>(simd, solid, triangles, normals));
    }

    #[inline(always)]
    fn measure_in_lanes<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        solid: &FaceSolid<'_, N>,
        triangles: &PartPacket<N, 3>,
        normals: &[[N; LANES]; 3],
    ) {
        let origin: [V; 3] = spread(simd, &solid.origin);
        let seen = |corner: usize| -> [V; 3] {
            turned_back(simd, solid.turn, &minus(&load(simd, &triangles.corners[corner]), &origin))
        };
        let (normal, corners) = (load(simd, normals), [seen(0), seen(1), seen(2)]);
        let squared = [
            dot(&corners[0], &corners[0]),
            dot(&corners[1], &corners[1]),
            dot(&corners[2], &corners[2]),
        ];
        let reach = squared[0].larger(squared[1]).larger(squared[2]).sqrt();
        let rounding = V::all(simd, N::lit(ROUNDING_ERRORS) * N::EPSILON);
        let tolerance = rounding * (V::all(simd, solid.reach()) + reach);
        let seen = SeenTriangles::new(simd, &corners, &normal);
        let (shown, is_shown) = seen.shown(simd, tolerance);
        let is_plain = is_shown & self.measure_face(simd, &seen, tolerance);
        self.measure_triangles(simd, &seen, tolerance);
        (self.shown, self.plain) = (shown, bits(is_plain));
        self.find_crossings();
        tolerance.store(&mut self.tolerance);
        for (rows, corner) in self.corners.iter_mut().zip(&corners) {
            for (row, values) in rows.iter_mut().zip(corner) {
                values.store(row);
            }
        }
    }

    /// Two sides cross where each has its ends on different sides of the other.
    fn find_crossings(&mut self) {
        let (count, sides) = (self.ring.count, self.sides());
        for (side, crossed) in self.crossed.iter_mut().enumerate() {
            for (other, crossed) in crossed.iter_mut().enumerate().take(sides) {
                let own = self.in_face.parted([side, (side + 1) % 3], other);
                let others = self.in_triangle.parted([other, (other + 1) % count], side);
                *crossed = own & others & self.shown.sides[side];
            }
        }
    }

    /// Measures the corners of the triangles against the sides and the plane of the ring. Returns
    /// the lanes in which all its sides are longer than two tolerances.
    #[inline(always)]
    fn measure_face<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        seen: &SeenTriangles<V>,
        tolerance: V,
    ) -> V::Mask {
        let (outward, count): ([V; 3], usize) = (spread(simd, &self.ring.normal), self.ring.count);
        let slope = lit::<S, N, V>(simd, 1.0) / dot(&outward, &seen.normal);
        let mut is_long = slope.simd_eq(slope);
        for side in 0..self.sides() {
            let (from, to) = (self.vertex(side), self.vertex((side + 1) % count));
            let start: [V; 3] = spread(simd, &from);
            let across = cross(&spread(simd, &(to - from)), &seen.normal);
            let length = norm(&across);
            is_long &= length.simd_gt(tolerance + tolerance);
            let inward = times(&across, lit::<S, N, V>(simd, 1.0) / length);
            for corner in 0..3 {
                let arm = minus(&seen.corners[corner], &start);
                self.in_face.put([corner, side], dot(&inward, &arm), tolerance);
                if side == 0 {
                    (-dot(&outward, &arm) * slope).store(&mut self.depths[corner]);
                }
            }
        }
        is_long
    }

    /// Measures the corners of the ring against the sides and the planes of the triangles.
    #[inline(always)]
    fn measure_triangles<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        seen: &SeenTriangles<V>,
        tolerance: V,
    ) {
        let slope = lit::<S, N, V>(simd, 1.0) / seen.rise;
        for at in 0..self.ring.count {
            let vertex: [V; 3] = spread(simd, &self.vertex(at));
            for side in 0..3 {
                let arm = minus(&vertex, &seen.corners[side]);
                self.in_triangle.put([at, side], dot(&seen.inward[side], &arm), tolerance);
                if side == 0 {
                    (dot(&seen.across, &arm) * slope).store(&mut self.vertex_depths[at]);
                }
            }
        }
    }

    /// The number of sides of the ring: one of an edge, none of a corner.
    #[inline(always)]
    pub(super) const fn sides(&self) -> usize {
        let count = self.ring.count;
        if count < 3 { count - 1 } else { count }
    }

    /// A corner of the ring.
    #[inline(always)]
    pub(super) fn vertex(&self, at: usize) -> Vector<N, 3> {
        let [x, y, z] = &self.ring.corners;
        Vector::<N, 3>::new(x[at], y[at], z[at])
    }
}

/// Eight triangles and their normals.
struct SeenTriangles<V> {
    corners: [[V; 3]; 3],
    normal: [V; 3],
    /// From each corner to the next, the squared lengths, and the cross product of the first two.
    sides: [[V; 3]; 3],
    squared: [V; 3],
    across: [V; 3],
    /// Twice the area projected along the normal; negative if the solid is behind the triangle.
    rise: V,
    /// Unit, perpendicular to the normal and a side, into the triangle; and the projected lengths
    /// of the sides.
    inward: [[V; 3]; 3],
    lengths: [V; 3],
}

impl<V> SeenTriangles<V> {
    #[inline(always)]
    fn new<S: Simd, N: Real>(simd: S, corners: &[[V; 3]; 3], normal: &[V; 3]) -> Self
    where
        V: Wide<S, Scalar = N>,
    {
        let [a, b, c] = corners;
        let sides = [minus(b, a), minus(c, b), minus(a, c)];
        let squared =
            [dot(&sides[0], &sides[0]), dot(&sides[1], &sides[1]), dot(&sides[2], &sides[2])];
        let across = cross(&sides[0], &sides[1]);
        let rise = dot(&across, normal);
        let one: V = lit(simd, 1.0);
        // Seen from the back, the sides run clockwise.
        let turn = rise.simd_lt(V::all(simd, N::ZERO)).select(-one, one);
        let (mut inward, mut lengths) = (sides, squared);
        for (own, length) in inward.iter_mut().zip(&mut lengths) {
            let way = cross(normal, own);
            *length = norm(&way);
            *own = times(&way, turn / *length);
        }
        Self { corners: *corners, normal: *normal, sides, squared, across, rise, inward, lengths }
    }

    /// Returns the features that the triangles show along the normals, by the rule of
    /// [`core_feature`](crate::shape::SupportMap::core_feature), and the lanes in which rounding
    /// cannot change them and they are not degenerate.
    #[inline(always)]
    fn shown<S: Simd, N: Real>(&self, simd: S, tolerance: V) -> (ShownBits, V::Mask)
    where
        V: Wide<S, Scalar = N>,
    {
        let (zero, limit) = (V::all(simd, N::ZERO), lit::<S, N, V>(simd, FACING_SINE_SQUARED));
        let less = lit::<S, N, V>(simd, 1.0 - CLEARLY_LARGER);
        let longest = self.squared[0].larger(self.squared[1]).larger(self.squared[2]);
        let (area, rise) = (dot(&self.across, &self.across), self.rise * self.rise);
        let is_wide = area.simd_gt(lit::<S, N, V>(simd, THIN_SQUARED) * longest * longest)
            & longest.simd_gt(V::all(simd, N::MIN_POSITIVE.sqrt()));
        // A face is shown if the squared cosine of its tilt is above 1 - `FACING_SINE_SQUARED`.
        // Close cases are neither `is_face` nor `is_steep`.
        let upright = lit::<S, N, V>(simd, 1.0 - FACING_SINE_SQUARED) * area;
        let is_face = is_wide & upright.simd_lt(rise * less);
        let is_steep = is_wide & rise.simd_lt(upright * less);
        // The farthest corner along the normal, and the squared sines of the slopes of the sides at
        // it.
        let climbs = [
            dot(&self.sides[0], &self.normal),
            dot(&self.sides[1], &self.normal),
            dot(&self.sides[2], &self.normal),
        ];
        let second = climbs[0].simd_gt(zero);
        let third = (climbs[0] + climbs[1]).simd_gt(second.select(climbs[0], zero));
        let tops = [!second & !third, second & !third, third];
        let slopes = [
            climbs[0] * climbs[0] / self.squared[0],
            climbs[1] * climbs[1] / self.squared[1],
            climbs[2] * climbs[2] / self.squared[2],
        ];
        let at = |of: [V; 3]| tops[0].select(of[0], tops[1].select(of[1], of[2]));
        let (out, back) = (at(slopes), at([slopes[2], slopes[0], slopes[1]]));
        let is_back = back.simd_lt(out);
        // The flatter of the two sides at the farthest corner is shown if it is flat enough.
        let (least, other) = (is_back.select(back, out), is_back.select(out, back));
        let is_corner = is_steep & limit.simd_lt(least * less);
        let is_side = is_steep & least.simd_lt(limit * less) & least.simd_lt(other * less);
        let mut bits_of = ShownBits {
            face: bits(is_face),
            back: bits(is_face & self.rise.simd_lt(zero)),
            ..ShownBits::default()
        };
        let mut is_plain = is_face | is_corner | is_side;
        for side in 0..3 {
            let is_own = (tops[side] & !is_back) | (tops[(side + 1) % 3] & is_back);
            let is_shown = is_face | (is_side & is_own);
            let is_long = self.lengths[side].simd_gt(tolerance + tolerance);
            is_plain &= is_long | !is_shown;
            bits_of.sides[side] = bits(is_shown);
            bits_of.corners[side] |= bits(is_shown | (is_corner & tops[side]));
            bits_of.corners[(side + 1) % 3] |= bits(is_shown);
        }
        // A face seen nearly edge-on, at most two tolerances wide, is degenerate.
        let width = (tolerance + tolerance) * longest.sqrt();
        (bits_of, is_plain & (self.rise.abs().simd_gt(width) | !is_face))
    }
}
