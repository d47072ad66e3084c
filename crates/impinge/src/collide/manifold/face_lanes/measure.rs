//! Measures how a solid's supporting feature and each of 8 triangles overlap, projected along the
//! normal: the distances of the corners of each outline from the sides of the other, and the
//! distances of the corners from the plane of the other along the normal.
//!
//! ```text
//!      v3 ──────────── v2     seen along the normal n of the lane, which points into the page
//!       │               │     inside   distance of c1 from the line of side v1 v2, across n;
//!       │    c1 ─inside─┤              positive on the inner side of the outline
//!       │               │     within   inside > tolerance;  beyond: inside < -tolerance
//!      v0 ──────────── v1     depth    distance along n from c1 to the plane of the face
//! ```
//!
//! All vectors are in the frame of the solid. A row `[N; LANES]` has one entry per triangle, a mask
//! byte one bit.

use super::super::frame::ROUNDING_ERRORS;
use super::FaceSolid;
use crate::collide::packet::{LANES, PartPacket};
use crate::math::lanes::{
    bits, cross, dot, in_lanes, lit, load, minus, norm, rotated_back, spread, times,
};
use crate::math::simd::{Run, Simd, SimdMask};
use crate::math::{Real, Vector, Wide};
use crate::shape::{CLEARLY_LARGER, FACING_SINE_SQUARED, FaceRing, THIN_SQUARED};

/// Largest number of corners of a ring; faces with more corners are not clipped in lanes.
const MAX: usize = FaceRing::<f32>::MAX;

/// Signed distances of the corners of one outline from the sides of the other, by corner and side,
/// and masks over the lanes.
pub(super) struct SideHeights<N, const CORNERS: usize, const SIDES: usize> {
    /// Signed distances, positive on the inner side.
    inside: [[[N; LANES]; SIDES]; CORNERS],
    /// Lanes where `inside` is above the tolerance; not set for NaN.
    within: [[u8; SIDES]; CORNERS],
    /// Lanes where `inside` is below minus the tolerance; not set for NaN.
    beyond: [[u8; SIDES]; CORNERS],
    /// Lanes where the corner is beyond some side.
    pub(super) is_beyond: [u8; CORNERS],
    /// Lanes where the corner is on the line of some side, within the tolerance; also set for NaN.
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

    /// Returns the lanes where a corner is on the line of a side, within the tolerance; also set
    /// for NaN.
    pub(super) const fn on(&self, corner: usize, side: usize) -> u8 {
        !(self.within[corner][side] | self.beyond[corner][side])
    }

    /// Returns the lanes where the line of a side separates two corners that are both farther from
    /// it than the tolerance.
    fn parted(&self, [from, to]: [usize; 2], side: usize) -> u8 {
        self.within[from][side] & self.beyond[to][side]
            | self.beyond[from][side] & self.within[to][side]
    }

    /// Returns the parameter, from 0 at `from` to 1 at `to`, at which the segment between two
    /// corners crosses the line of a side.
    pub(super) fn share(&self, [from, to]: [usize; 2], side: usize, lane: usize) -> N {
        let [from, to] = [self.inside[from][side][lane], self.inside[to][side][lane]];
        from / (from - to)
    }
}

/// A feature of the solid and 8 triangles, measured along the normals. The ring holds the corners
/// of a face, the two ends of an edge, or one corner.
pub(in crate::collide) struct FaceClip<N: Real> {
    pub(super) ring: FaceRing<N>,
    /// Corners of the triangles.
    pub(super) corners: [[[N; LANES]; 3]; 3],
    /// Signed distances along the normal from the corners of the triangles to the plane of the
    /// face; negative where the solids overlap. Unused unless the ring is a face.
    pub(super) depths: [[N; LANES]; 3],
    /// Signed distances along the normal from the planes of the triangles to the corners of the
    /// ring; negative where the solids overlap.
    pub(super) vertex_depths: [[N; LANES]; MAX],
    /// Corners of the triangles, measured against the sides of the ring.
    pub(super) in_face: SideHeights<N, 3, MAX>,
    /// Corners of the ring, measured against the sides of the triangles.
    pub(super) in_triangle: SideHeights<N, MAX, 3>,
    /// By lane, a bound of the rounding errors of lengths.
    pub(super) tolerance: [N; LANES],
    pub(super) supporting: SupportingBits,
    /// Lanes where the triangle's supporting feature is certain, and the sides of this feature and
    /// of the ring are longer than two tolerances in projection.
    pub(super) with_extent: u8,
    /// Lanes where a side of the triangle (first index) and a side of the ring (second index)
    /// cross.
    pub(super) crossed: [[u8; MAX]; 3],
}

/// Supporting features of the triangles along the normals, as masks over the lanes.
#[derive(Clone, Copy, Default)]
pub(super) struct SupportingBits {
    /// Lanes whose supporting feature is the face.
    pub(super) face: u8,
    /// Lanes where the supporting face is the back of the triangle.
    pub(super) back: u8,
    /// For each corner, the lanes whose supporting feature contains it.
    pub(super) corners: [u8; 3],
    /// For each side, the lanes whose supporting feature contains it.
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
            supporting: SupportingBits::default(),
            with_extent: 0,
            crossed: [[0; MAX]; 3],
        }
    }

    /// Measures the triangles in the lanes of one SIMD run.
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
        let in_frame = |corner: usize| -> [V; 3] {
            rotated_back(simd, solid.turn, &minus(&load(simd, &triangles.corners[corner]), &origin))
        };
        let (normal, corners) = (load(simd, normals), [in_frame(0), in_frame(1), in_frame(2)]);
        let squared = [
            dot(&corners[0], &corners[0]),
            dot(&corners[1], &corners[1]),
            dot(&corners[2], &corners[2]),
        ];
        let farthest = squared[0].larger(squared[1]).larger(squared[2]).sqrt();
        let rounding = V::all(simd, N::lit(ROUNDING_ERRORS) * N::EPSILON);
        let tolerance = rounding * (V::all(simd, solid.reach()) + farthest);
        let projected = ProjectedTriangles::new(simd, &corners, &normal);
        let (supporting, is_supporting) = projected.supporting(simd, tolerance);
        let has_extent = is_supporting & self.measure_face(simd, &projected, tolerance);
        self.measure_triangles(simd, &projected, tolerance);
        (self.supporting, self.with_extent) = (supporting, bits(has_extent));
        self.find_crossings();
        tolerance.store(&mut self.tolerance);
        for (rows, corner) in self.corners.iter_mut().zip(&corners) {
            for (row, values) in rows.iter_mut().zip(corner) {
                values.store(row);
            }
        }
    }

    /// Finds the lanes where a supporting side of the triangle crosses a side of the ring: the line
    /// of each separates the ends of the other, all farther from the line than the tolerance.
    fn find_crossings(&mut self) {
        let (count, sides) = (self.ring.count, self.sides());
        for (side, crossed) in self.crossed.iter_mut().enumerate() {
            for (other, crossed) in crossed.iter_mut().enumerate().take(sides) {
                let own = self.in_face.parted([side, (side + 1) % 3], other);
                let others = self.in_triangle.parted([other, (other + 1) % count], side);
                *crossed = own & others & self.supporting.sides[side];
            }
        }
    }

    /// Measures the corners of the triangles against the sides and the plane of the ring. Returns
    /// the lanes where all sides of the ring are longer than two tolerances in projection, and the
    /// distances from its plane are not NaN.
    #[inline(always)]
    fn measure_face<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        projected: &ProjectedTriangles<V>,
        tolerance: V,
    ) -> V::Mask {
        let (outward, count): ([V; 3], usize) = (spread(simd, &self.ring.normal), self.ring.count);
        let slope = lit::<S, N, V>(simd, 1.0) / dot(&outward, &projected.normal);
        let mut is_long = slope.simd_eq(slope);
        for side in 0..self.sides() {
            let (from, to) = (self.vertex(side), self.vertex((side + 1) % count));
            let start: [V; 3] = spread(simd, &from);
            let across = cross(&spread(simd, &(to - from)), &projected.normal);
            let length = norm(&across);
            is_long &= length.simd_gt(tolerance + tolerance);
            let inward = times(&across, lit::<S, N, V>(simd, 1.0) / length);
            for corner in 0..3 {
                let arm = minus(&projected.corners[corner], &start);
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
        projected: &ProjectedTriangles<V>,
        tolerance: V,
    ) {
        let slope = lit::<S, N, V>(simd, 1.0) / projected.rise;
        for at in 0..self.ring.count {
            let vertex: [V; 3] = spread(simd, &self.vertex(at));
            for side in 0..3 {
                let arm = minus(&vertex, &projected.corners[side]);
                self.in_triangle.put([at, side], dot(&projected.inward[side], &arm), tolerance);
                if side == 0 {
                    (dot(&projected.across, &arm) * slope).store(&mut self.vertex_depths[at]);
                }
            }
        }
    }

    /// Returns the number of sides of the ring: one for an edge, none for a corner.
    #[inline(always)]
    pub(super) const fn sides(&self) -> usize {
        let count = self.ring.count;
        if count < 3 { count - 1 } else { count }
    }

    /// Returns a corner of the ring.
    #[inline(always)]
    pub(super) fn vertex(&self, at: usize) -> Vector<N, 3> {
        let [x, y, z] = &self.ring.corners;
        Vector::<N, 3>::new(x[at], y[at], z[at])
    }
}

/// Eight triangles, projected along their normals.
struct ProjectedTriangles<V> {
    corners: [[V; 3]; 3],
    normal: [V; 3],
    /// Vectors from each corner to the next.
    sides: [[V; 3]; 3],
    /// Squared lengths of `sides`.
    squared: [V; 3],
    /// Cross product of the first two sides.
    across: [V; 3],
    /// Twice the area projected along the normal; negative if the solid is behind the triangle.
    rise: V,
    /// Unit vectors perpendicular to the normal and to a side, into the triangle.
    inward: [[V; 3]; 3],
    /// Projected lengths of the sides.
    lengths: [V; 3],
}

impl<V> ProjectedTriangles<V> {
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
        // The sides of a triangle seen from its back run clockwise.
        let turn = rise.simd_lt(V::all(simd, N::ZERO)).select(-one, one);
        let (mut inward, mut lengths) = (sides, squared);
        for (own, length) in inward.iter_mut().zip(&mut lengths) {
            let perpendicular = cross(normal, own);
            *length = norm(&perpendicular);
            *own = times(&perpendicular, turn / *length);
        }
        Self { corners: *corners, normal: *normal, sides, squared, across, rise, inward, lengths }
    }

    /// Returns the supporting features of the triangles along the normals, by the rule of
    /// [`core_feature`](crate::shape::SupportMap::core_feature). The mask has the lanes where
    /// rounding cannot change the feature and the feature is not degenerate.
    #[inline(always)]
    fn supporting<S: Simd, N: Real>(&self, simd: S, tolerance: V) -> (SupportingBits, V::Mask)
    where
        V: Wide<S, Scalar = N>,
    {
        let (zero, limit) = (V::all(simd, N::ZERO), lit::<S, N, V>(simd, FACING_SINE_SQUARED));
        let less = lit::<S, N, V>(simd, 1.0 - CLEARLY_LARGER);
        let longest = self.squared[0].larger(self.squared[1]).larger(self.squared[2]);
        let (area, rise) = (dot(&self.across, &self.across), self.rise * self.rise);
        let is_wide = area.simd_gt(lit::<S, N, V>(simd, THIN_SQUARED) * longest * longest)
            & longest.simd_gt(V::all(simd, N::MIN_POSITIVE.sqrt()));
        // The feature is a face if the squared cosine of its tilt is above 1 -
        // `FACING_SINE_SQUARED`. Close cases are neither `is_face` nor `is_steep`.
        let upright = lit::<S, N, V>(simd, 1.0 - FACING_SINE_SQUARED) * area;
        let is_face = is_wide & upright.simd_lt(rise * less);
        let is_steep = is_wide & rise.simd_lt(upright * less);
        // Farthest corner along the normal, and the squared sines of the slopes of the two sides at
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
        // The flatter of the two sides at the farthest corner is the feature if it is flat enough.
        let (least, other) = (is_back.select(back, out), is_back.select(out, back));
        let is_corner = is_steep & limit.simd_lt(least * less);
        let is_side = is_steep & least.simd_lt(limit * less) & least.simd_lt(other * less);
        let mut bits_of = SupportingBits {
            face: bits(is_face),
            back: bits(is_face & self.rise.simd_lt(zero)),
            ..SupportingBits::default()
        };
        let mut has_extent = is_face | is_corner | is_side;
        for side in 0..3 {
            let is_own = (tops[side] & !is_back) | (tops[(side + 1) % 3] & is_back);
            let is_supporting = is_face | (is_side & is_own);
            let is_long = self.lengths[side].simd_gt(tolerance + tolerance);
            has_extent &= is_long | !is_supporting;
            bits_of.sides[side] = bits(is_supporting);
            bits_of.corners[side] |= bits(is_supporting | (is_corner & tops[side]));
            bits_of.corners[(side + 1) % 3] |= bits(is_supporting);
        }
        // A face seen nearly edge-on, at most two tolerances wide, is degenerate.
        let width = (tolerance + tolerance) * longest.sqrt();
        (bits_of, has_extent & (self.rise.abs().simd_gt(width) | !is_face))
    }
}
