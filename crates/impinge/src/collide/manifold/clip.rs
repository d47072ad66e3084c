//! Corners of the overlap area of two supporting features in 3D: points, segments or faces.
//!
//! ```text
//!      .-----------.             corner of one ring against each side of the other, in lanes:
//!      |  1        |               inside > tolerance    within
//!      |     c-----x---.           inside < -tolerance   beyond
//!      |     |     | 2 |           otherwise             touched
//!      '-----x-----c   |
//!            |         |         c: corner inside the other ring (beyond no side)
//!            '---------'         x: a side of 1 and a side of 2, each with one end within and one
//!                                   end beyond the other
//! ```
//!
//! Both features are [rings](super::ring) projected along the normal. Both solids are treated
//! alike: there is no reference face that could flip, and the features of a point do not depend on
//! which solid is first. A point within the tolerance of a side lies on the side. So features are
//! stable where sides or corners coincide. A segment has one side; a corner counts as inside it
//! only on its line. If a feature is a point, or both are segments that are not parallel, [`build`]
//! keeps only the contact at the nearest points.
//!
//! The algorithm of Sutherland and Hodgman ("Reentrant polygon clipping", 1974) is not used: it
//! clips one polygon against the sides of the other, so one solid would be the reference.
//!
//! This module clips all pairs in 3D with flat features, alone or as parts of a composite, along
//! the pair's own normal or the normal of a face. Boxes, segments and capsules also have SIMD
//! kernels (`collide/batch/`), and so have boxes and hulls against triangles
//! ([`face_lanes`](super::face_lanes)). Rotation of the solids enters through the sine in
//! [`ContactFrame::admit`] and [`RingClip::are_parallel`].

use smallvec::SmallVec;

use super::frame::{Candidates, ContactFrame, Which, part_beside};
use super::ring::{LANES, RingCorner, SupportRing};
use super::{Pair, RawManifold, add_witness, choose_in_frame};
use crate::math::lanes::{bits, load, with_lanes};
use crate::math::simd::{Level, Simd};
use crate::math::{Mapped, Point, Pose, Real, Vector, Wide, cross2, max};
use crate::shape::{FeatureId, Kind};

/// Builds the manifold of two solids within the prediction; the witness of `frame` is their nearest
/// points.
pub(super) fn build<N: Real>(
    pair: &Pair<'_, N, 3>,
    frame: &ContactFrame<N, 3>,
    limit: usize,
    out: &mut RawManifold<N, 3>,
) {
    let mut clip = RingClip::blank(pair, frame);
    clip.project(pair);
    let mut candidates = Candidates::new();
    if clip.has_area_or_length() {
        clip.candidates(&mut candidates);
    }
    let level = frame.witness.distance + frame.tolerance;
    if !candidates.iter().any(|candidate| candidate.distance <= level) {
        let parts = [clip.part_at_witness(0), clip.part_at_witness(1)];
        add_witness(&frame.witness, parts, &mut candidates);
    }
    choose_in_frame(pair, frame, &mut candidates, limit, out);
}

/// Returns the part of a solid's supporting feature on which the solid's nearest point to the other
/// solid lies; the whole feature if rounding places that point outside.
pub(super) fn part_at_witness<N: Real>(
    kind: Kind<'_, N, 3>,
    which: Which,
    pose: Option<&Pose<N, 3>>,
    frame: &ContactFrame<N, 3>,
) -> FeatureId {
    let (mut rings, mut insides) = ([SupportRing::blank(which, pose)], [Insides::new()]);
    rings[0].fill(kind, frame);
    project_rings(Level::new(), &mut rings, frame, &mut insides);
    let ([ring], [insides]) = (&rings, &insides);
    ring_part(ring, insides.row(0), &Vector::<N, 2>::zeros(), frame.tolerance).unwrap_or(ring.id)
}

/// Adds the corners of the overlap area, projected along the normal of `frame`, that the request
/// admits. The witness of `frame` need not be the nearest points. Adds none if the supporting
/// features do not overlap in projection.
pub(super) fn candidates<N: Real>(
    pair: &Pair<'_, N, 3>,
    frame: &ContactFrame<N, 3>,
    out: &mut Candidates<N, 3>,
) {
    let mut clip = RingClip::blank(pair, frame);
    clip.project(pair);
    clip.candidates(out);
}

/// Runs [`project_in_lanes`] with the instruction set of `level`; the results do not depend on the
/// level.
fn project_rings<N: Real>(
    level: Level,
    rings: &mut [SupportRing<'_, N>],
    frame: &ContactFrame<N, 3>,
    insides: &mut [Insides<N>],
) {
    with_lanes!(level, simd =>
        project_in_lanes::<_, N, N::Lanes<_>>(simd, rings, frame, insides));
}

/// Projects one ring or two. Measures the nearest point and the corners of the other ring, if there
/// is one, against the sides of each ring.
#[inline(always)]
fn project_in_lanes<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    rings: &mut [SupportRing<'_, N>],
    frame: &ContactFrame<N, 3>,
    insides: &mut [Insides<N>],
) {
    for ring in rings.iter_mut() {
        ring.project::<S, V>(simd, frame);
    }
    for (which, (ring, insides)) in rings.iter().zip(insides).enumerate() {
        let other = if which == 0 { rings.get(1) } else { rings.first() };
        insides.measure::<S, V>(simd, ring, other, frame.tolerance);
    }
}

/// Position of a point relative to up to 8 sides of a ring.
#[derive(Clone, Copy)]
struct SideRow<N: Real> {
    /// Signed distance from each side, positive inside.
    inside: [N; LANES],
    /// Bits of the sides with `inside` above the tolerance.
    within: u8,
    /// Bits of the sides with `inside` below minus the tolerance.
    beyond: u8,
    /// Bits of the sides with `inside` between minus and plus the tolerance, or NaN.
    touched: u8,
}

/// Positions of the corners of one ring, and last of the nearest point, relative to the sides of
/// the other ring.
struct Insides<N: Real> {
    /// Number of rows for each point: one for each block of 8 sides.
    width: usize,
    /// Rows, by point and then by block.
    rows: SmallVec<[SideRow<N>; 2 * LANES + 4]>,
}

impl<N: Real> Insides<N> {
    fn new() -> Self {
        Self { width: 1, rows: SmallVec::new() }
    }

    /// Returns the rows of a corner, or of the nearest point at the index after the last corner.
    fn row(&self, index: usize) -> &[SideRow<N>] {
        &self.rows[index * self.width..][..self.width]
    }

    /// Measures the corners of `other`, and last the nearest point, against the sides of `own`.
    #[inline(always)]
    fn measure<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        own: &SupportRing<'_, N>,
        other: Option<&SupportRing<'_, N>>,
        tolerance: N,
    ) {
        let (count, sides) = (other.map_or(0, |other| other.count), own.side_count());
        let (most, least) = (V::all(simd, tolerance), V::all(simd, -tolerance));
        self.width = own.count.div_ceil(LANES);
        for index in 0..=count {
            let flat = match other {
                Some(other) if index < count => other.flat(index),
                // The nearest point is the origin of the tangent coordinates.
                _ => Vector::<N, 2>::zeros(),
            };
            let [x, y] = [V::all(simd, flat.x), V::all(simd, flat.y)];
            for (at, block) in own.blocks.iter().enumerate().take(self.width) {
                let (from, inward): ([V; 2], [V; 2]) =
                    (load(simd, &block.flats), load(simd, &block.inward));
                let inside = inward[0] * (x - from[0]) + inward[1] * (y - from[1]);
                let within = bits(inside.simd_gt(most));
                let beyond = bits(inside.simd_lt(least));
                // Lanes after the last side are unused.
                let all = first_bits(sides - at * LANES);
                let mut row = SideRow {
                    inside: [N::ZERO; LANES],
                    within: within & all,
                    beyond: beyond & all,
                    touched: !(within | beyond) & all,
                };
                inside.store(&mut row.inside);
                self.rows.push(row);
            }
        }
    }
}

/// Returns a mask of the lowest `count` bits, 8 at most.
const fn first_bits(count: usize) -> u8 {
    if count < LANES { (1 << count) - 1 } else { u8::MAX }
}

/// Returns the smallest part of a ring that contains the point `flat`, whose positions relative to
/// the sides are `rows`: a corner, a side or the whole ring. `None` if the point is outside; a
/// segment contains only points on its line.
fn ring_part<N: Real>(
    ring: &SupportRing<'_, N>,
    rows: &[SideRow<N>],
    flat: &Vector<N, 2>,
    tolerance: N,
) -> Option<FeatureId> {
    let is_segment = ring.is_segment();
    let mut found = None;
    for (block, row) in rows.iter().enumerate() {
        if row.beyond != 0 || is_segment && row.within != 0 {
            return None;
        }
        // Where two touched sides meet, both give the corner, so either may be found last.
        let mut touched = row.touched;
        while touched != 0 {
            let side = block * LANES + touched.trailing_zeros() as usize;
            touched &= touched - 1;
            found = ring.on_side(side, flat, tolerance).or(found);
        }
    }
    if is_segment { found } else { Some(found.unwrap_or(ring.id)) }
}

/// Returns the bits of the sides whose lines separate two points that are both farther from the
/// line than the tolerance.
const fn parted<N: Real>(from: &SideRow<N>, to: &SideRow<N>) -> u8 {
    from.within & to.beyond | from.beyond & to.within
}

/// Returns the parameter, from 0 at `from` to 1 at `to`, at which a segment crosses a line; `from`
/// and `to` are the signed distances of its ends from the line.
fn share<N: Real>(from: N, to: N) -> N {
    from / (from - to)
}

/// The supporting features of two solids as rings, projected in one frame and measured against each
/// other.
struct RingClip<'a, N: Real> {
    frame: &'a ContactFrame<N, 3>,
    rings: [SupportRing<'a, N>; 2],
    /// For each ring, the positions of the other ring's corners relative to its sides.
    insides: [Insides<N>; 2],
}

impl<'a, N: Real> RingClip<'a, N> {
    /// Creates a clip with blank rings; [`Self::project`] fills them.
    #[inline(always)]
    fn blank(pair: &'a Pair<'_, N, 3>, frame: &'a ContactFrame<N, 3>) -> Self {
        let rings = [
            SupportRing::blank(Which::First, None),
            SupportRing::blank(Which::Second, Some(&pair.pose12)),
        ];
        Self { frame, rings, insides: [Insides::new(), Insides::new()] }
    }

    /// Fills the rings with the supporting features of a pair, and measures each ring against the
    /// other.
    fn project(&mut self, pair: &Pair<'_, N, 3>) {
        self.rings[0].fill(pair.first, self.frame);
        self.rings[1].fill(pair.second, self.frame);
        project_rings(Level::new(), &mut self.rings, self.frame, &mut self.insides);
    }

    /// Returns `false` if the overlap is a single point, because then the nearest points are the
    /// only contact. Otherwise the overlap may have a length or an area.
    fn has_area_or_length(&self) -> bool {
        let [first, second] = &self.rings;
        let are_segments = first.is_segment() && second.is_segment();
        !(first.is_point() || second.is_point() || are_segments && !self.are_parallel())
    }

    /// Adds the corners of the overlap area that the request admits. If one feature is a point
    /// inside the other, adds that point. Two points overlap if they project to within twice the
    /// tolerance of each other.
    fn candidates(&self, out: &mut Candidates<N, 3>) {
        let [first, second] = &self.rings;
        if first.is_segment() && second.is_segment() && self.are_parallel() {
            return self.common_interval(out);
        }
        if first.is_point() && second.is_point() {
            let [corner1, corner2] = [first.corner(0), second.corner(0)];
            if (corner1.flat - corner2.flat).norm() <= N::TWO * self.frame.tolerance {
                self.push([corner1.point, corner2.point], [corner1.id, corner2.id], out);
            }
            return;
        }
        self.corners(out);
        self.crossings(out);
    }

    /// Returns the id of the part of a ring that the nearest point lies on; the id of the whole
    /// ring if rounding places the point outside.
    fn part_at_witness(&self, which: usize) -> FeatureId {
        let (ring, other) = (&self.rings[which], &self.rings[1 - which]);
        let rows = self.insides[which].row(other.count);
        ring_part(ring, rows, &Vector::<N, 2>::zeros(), self.frame.tolerance).unwrap_or(ring.id)
    }

    /// Adds a contact for each corner of a ring that lies inside the other ring.
    fn corners(&self, out: &mut Candidates<N, 3>) {
        for (which, ring) in self.rings.iter().enumerate() {
            let other = &self.rings[1 - which];
            // No corner lies inside a ring that is a point; that point is tested as a corner of its
            // own ring.
            let count = if other.is_point() { 0 } else { ring.count };
            for at in 0..count {
                let flat = ring.flat(at);
                let rows = self.insides[1 - which].row(at);
                if let Some(on) = ring_part(other, rows, &flat, self.frame.tolerance) {
                    let corner = ring.corner(at);
                    let under = other.under(&corner.point, &flat, self.frame);
                    self.push_corner(which, &corner, under, on, out);
                }
            }
        }
    }

    /// Adds a contact of a corner of ring `which` (0 or 1). `under` is the point of the other ring
    /// opposite to it along the normal; `on` is the part of that ring that contains `under`.
    fn push_corner(
        &self,
        which: usize,
        corner: &RingCorner<N>,
        under: Point<N, 3>,
        on: FeatureId,
        out: &mut Candidates<N, 3>,
    ) {
        if which == 0 {
            self.push([corner.point, under], [corner.id, on], out);
        } else {
            self.push([under, corner.point], [on, corner.id], out);
        }
    }

    /// Adds each crossing of a side of the first ring with a side of the second. The line of each
    /// side must separate the ends of the other side, both farther from the line than the
    /// tolerance. A side that ends on the other's line has no crossing: [`Self::corners`] tests
    /// that end.
    fn crossings(&self, out: &mut Candidates<N, 3>) {
        let (one, in_other) = (&self.rings[0], &self.insides[1]);
        for side1 in 0..one.side_count() {
            let ends1 = [in_other.row(side1), in_other.row(one.next(side1))];
            for block2 in 0..in_other.width {
                let [from1, to1] = ends1.mapped(|rows| &rows[block2]);
                let mut crossed = parted(from1, to1);
                while crossed != 0 {
                    let lane2 = crossed.trailing_zeros() as usize;
                    crossed &= crossed - 1;
                    let share1 = share(from1.inside[lane2], to1.inside[lane2]);
                    self.push_crossing(side1, block2 * LANES + lane2, share1, out);
                }
            }
        }
    }

    /// Adds the crossing of two sides, if `side2` crosses the line of `side1`. Precondition:
    /// `side1` crosses the line of `side2`, at the parameter `share1`.
    fn push_crossing(&self, side1: usize, side2: usize, share1: N, out: &mut Candidates<N, 3>) {
        let ([one, other], in_one) = (&self.rings, &self.insides[0]);
        let (block1, lane1) = (side1 / LANES, side1 % LANES);
        let [from2, to2] = [side2, other.next(side2)].mapped(|at| &in_one.row(at)[block1]);
        if parted(from2, to2) >> lane1 & 1 == 1 {
            let share2 = share(from2.inside[lane1], to2.inside[lane1]);
            let cores = [one.along_side(side1, share1), other.along_side(side2, share2)];
            self.push(cores, [one.side_id(side1), other.side_id(side2)], out);
        }
    }

    /// Returns whether the two segments are parallel up to rounding, or up to the angle by which
    /// the solids may rotate.
    fn are_parallel(&self) -> bool {
        let [a, b] = [self.rings[0].side(0), self.rings[1].side(0)];
        let least = N::lit(16.0) * N::EPSILON;
        cross2(&a, &b).abs() <= max(self.frame.sine, least) * a.norm() * b.norm()
    }

    /// Adds the ends of the overlap interval of two nearly parallel segments. Each contact is an
    /// end of one segment and the point beside it on the other segment. Both points are moved
    /// halfway towards each other, perpendicular to the normal, because they meet there if the
    /// solids rotate. The moved points are off their segments by at most half their distance from
    /// the nearest points times the sine.
    fn common_interval(&self, out: &mut Candidates<N, 3>) {
        for (which, ring) in self.rings.iter().enumerate() {
            let other = &self.rings[1 - which];
            for corner in [ring.corner(0), ring.corner(1)] {
                let Some(on) = self.beside(&corner.flat, other) else { continue };
                let under = other.under(&corner.point, &corner.flat, self.frame);
                let (gap, normal) = (under - corner.point, self.frame.normal());
                let half = (gap - normal * normal.dot(&gap)) * N::HALF;
                let corner = RingCorner { point: corner.point + half, ..corner };
                self.push_corner(which, &corner, under - half, on, out);
            }
        }
    }

    /// Returns the part of a segment beside a point: an end, if it is within twice the tolerance
    /// along the segment, else the segment; `None` farther beyond the ends.
    fn beside(&self, flat: &Vector<N, 2>, segment: &SupportRing<'_, N>) -> Option<FeatureId> {
        let (side, tolerance) = (segment.side(0), N::TWO * self.frame.tolerance);
        let length = side.norm();
        let along = (flat - segment.flat(0)).dot(&side) / length;
        let ends = [segment.corner(0).id, segment.corner(1).id];
        part_beside(along, length, tolerance, ends, segment.id)
    }

    /// Adds the contact whose points lie on the rounded surfaces, above two points of the cores, if
    /// the request admits it. Skips a duplicate of a contact in `out`, because corners that
    /// coincide are found from both rings. Contacts count as duplicates only at one position:
    /// different points on round rims may have the same features.
    fn push(
        &self,
        [core1, core2]: [Point<N, 3>; 2],
        features: [FeatureId; 2],
        out: &mut Candidates<N, 3>,
    ) {
        let (frame, [first, second]) = (self.frame, &self.rings);
        let (normal, lift1) = (frame.normal(), first.lift(&core1, frame));
        let distance = normal.dot(&(core2 - core1)) - lift1 - second.lift(&core2, frame);
        frame.push_new(core1 + normal * lift1, distance, features, out);
    }
}
