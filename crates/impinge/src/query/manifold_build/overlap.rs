//! Where two facets overlap, seen along the normal: the corners of the common area.
//!
//! Both facets are treated alike, so there is no reference face that a small motion could exchange:
//! a corner of the common area is a corner of one facet inside the other, or a crossing of two sides.
//! That costs a product of the two numbers of corners, and names every point the same way whichever
//! solid is first. A place within rounding of a side lies on it, which keeps the names still when
//! sides or corners coincide.

use smallvec::SmallVec;

use super::facet::{Corner, Facet, LANES};
use super::frame::{Candidate, Frame};
use crate::math::lanes::with_lanes;
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Point, Real, Wide, cross2, max, max_component};
use crate::shape::FeatureId;

/// What a manifold is chosen from.
pub(super) type Candidates<N, const D: usize> = SmallVec<[Candidate<N, D>; 8]>;

/// Two facets in one frame.
pub(super) struct Overlap<'a, N: Real, const D: usize> {
    pub(super) frame: &'a Frame<N, D>,
    pub(super) first: &'a Facet<N, D>,
    pub(super) second: &'a Facet<N, D>,
}

impl<N: Real, const D: usize> Overlap<'_, N, D> {
    /// Adds the corners of the common area that the request admits; none where a facet is a point.
    pub(super) fn candidates(&self, out: &mut Candidates<N, D>) {
        if self.first.is_point() || self.second.is_point() {
            return;
        }
        if self.are_parallel_segments() {
            return self.common_stretch(out);
        }
        let most = max_len(self.first.corners.len(), self.second.corners.len());
        if most <= LANES {
            return self.candidates_in_lanes(out);
        }
        self.candidates_one_by_one(out);
    }

    /// [`Self::candidates`] of facets with any number of corners.
    pub(super) fn candidates_one_by_one(&self, out: &mut Candidates<N, D>) {
        let insides = [Insides::of(self.first, self.second), Insides::of(self.second, self.first)];
        self.corners_inside(&insides, out);
        self.crossings(&insides, out);
    }

    /// [`Self::candidates`] of facets with eight corners at most: the same, eight lines at a time.
    pub(super) fn candidates_in_lanes(&self, out: &mut Candidates<N, D>) {
        let rows = Rows::of_both(self);
        let tolerance = self.frame.tolerance;
        for (index, corner) in self.first.corners.iter().enumerate() {
            if let Some(on_lines) = rows[0].inside(index, self.second)
                && let Some(id) = self.second.locate_on_sides(on_lines, &corner.flat, tolerance)
            {
                self.push_corner_of_first(corner, id, out);
            }
        }
        for (index, corner) in self.second.corners.iter().enumerate() {
            if let Some(on_lines) = rows[1].inside(index, self.first)
                && let Some(id) = self.first.locate_on_sides(on_lines, &corner.flat, tolerance)
            {
                self.push_corner_of_second(corner, id, out);
            }
        }
        for side1 in 0..self.first.side_count() {
            let mut crossed = rows[0].crossed(side1, self.first.next(side1), self.second);
            while crossed != 0 {
                let side2 = crossed.trailing_zeros() as usize;
                let next2 = self.second.next(side2);
                if rows[1].crossed(side2, next2, self.first) >> side1 & 1 == 1 {
                    let ends1 = [side1, self.first.next(side1)].map(|c| rows[0].insides[c][side2]);
                    let ends2 = [side2, next2].map(|corner| rows[1].insides[corner][side1]);
                    self.push_crossing([side1, side2], [ends1, ends2], out);
                }
                crossed &= crossed - 1;
            }
        }
    }

    /// Adds the place where a side of each facet cross, which are told how far inside of the other's
    /// line their ends are.
    fn push_crossing(
        &self,
        [side1, side2]: [usize; 2],
        [ends1, ends2]: [[N; 2]; 2],
        out: &mut Candidates<N, D>,
    ) {
        let at = |[from, to]: [N; 2]| from / (from - to);
        let core1 = self.first.along_side(side1, at(ends1));
        let core2 = self.second.along_side(side2, at(ends2));
        let names = [self.first.corners[side1].side, self.second.corners[side2].side];
        self.push(&core1, &core2, names, out);
    }

    /// Adds what [`Self::candidates`] leaves to the witness: of a facet that is a point, the point, if
    /// it is seen inside the other facet.
    pub(super) fn candidates_of_points(&self, out: &mut Candidates<N, D>) {
        let tolerance = self.frame.tolerance;
        match (self.first.corners.as_slice(), self.second.corners.as_slice()) {
            ([corner1], [corner2])
                if (corner1.flat - corner2.flat).norm() <= N::TWO * tolerance =>
            {
                self.push(&corner1.point, &corner2.point, [corner1.id, corner2.id], out);
            }
            ([_], [_]) => {}
            ([corner], _) => {
                if let Some(id) = self.second.locate(&corner.flat, tolerance) {
                    self.push_corner_of_first(corner, id, out);
                }
            }
            (_, [corner]) => {
                if let Some(id) = self.first.locate(&corner.flat, tolerance) {
                    self.push_corner_of_second(corner, id, out);
                }
            }
            _ => {}
        }
    }

    /// Corners of either facet within the other.
    fn corners_inside(&self, insides: &[Insides<N>; 2], out: &mut Candidates<N, D>) {
        let tolerance = self.frame.tolerance;
        for (corner, insides) in self.first.corners.iter().zip(insides[0].rows()) {
            if let Some(id) = self.second.locate_inside(insides, &corner.flat, tolerance) {
                self.push_corner_of_first(corner, id, out);
            }
        }
        for (corner, insides) in self.second.corners.iter().zip(insides[1].rows()) {
            if let Some(id) = self.first.locate_inside(insides, &corner.flat, tolerance) {
                self.push_corner_of_second(corner, id, out);
            }
        }
    }

    /// A corner of the first facet above the part `on` of the second.
    fn push_corner_of_first(
        &self,
        corner: &Corner<N, D>,
        on: FeatureId,
        out: &mut Candidates<N, D>,
    ) {
        let under = self.second.under(&corner.point, self.frame);
        self.push(&corner.point, &under, [corner.id, on], out);
    }

    /// A corner of the second facet above the part `on` of the first.
    fn push_corner_of_second(
        &self,
        corner: &Corner<N, D>,
        on: FeatureId,
        out: &mut Candidates<N, D>,
    ) {
        let under = self.first.under(&corner.point, self.frame);
        self.push(&under, &corner.point, [on, corner.id], out);
    }

    /// Sides that cross well inside both.
    fn crossings(&self, insides: &[Insides<N>; 2], out: &mut Candidates<N, D>) {
        for side1 in 0..self.first.side_count() {
            let [from1, to1] = insides[0].at_ends(self.first, side1);
            for (side2, ends1) in from1.iter().zip(to1).enumerate() {
                let ends1 = [*ends1.0, *ends1.1];
                if !self.are_apart(ends1) {
                    continue;
                }
                let ends2 = insides[1].at_ends(self.second, side2).map(|row| row[side1]);
                if self.are_apart(ends2) {
                    self.push_crossing([side1, side2], [ends1, ends2], out);
                }
            }
        }
    }

    /// The ends of a side lie on different hands of a line, and neither on it: a side that ends on
    /// the line crosses nothing, its corner lies on the other facet or outside.
    #[inline]
    fn are_apart(&self, [from, to]: [N; 2]) -> bool {
        let tolerance = self.frame.tolerance;
        from > tolerance && to < -tolerance || from < -tolerance && to > tolerance
    }

    /// Two segments that a turn by the predicted angle would make parallel.
    fn are_parallel_segments(&self) -> bool {
        if !(self.first.is_segment() && self.second.is_segment()) {
            return false;
        }
        let (a, b) = (self.first.side(0), self.second.side(0));
        let least = N::lit(16.0) * N::EPSILON;
        cross2(&a, &b).abs() <= max(self.frame.sine, least) * a.norm() * b.norm()
    }

    /// The ends of the stretch that two nearly parallel segments share: each is an end of one of
    /// them and the place beside it on the other. Half-way between the two is where they meet once
    /// turned: the points are off their segments by half the lever arm times the sine at most.
    fn common_stretch(&self, out: &mut Candidates<N, D>) {
        let (length1, length2) = (self.first.side(0).norm(), self.second.side(0).norm());
        for corner in &self.first.corners {
            if let Some(on) = self.beside(corner, self.second, length2) {
                let under = self.second.under(&corner.point, self.frame);
                self.push_halfway(&corner.point, &under, [corner.id, on], out);
            }
        }
        for corner in &self.second.corners {
            if let Some(on) = self.beside(corner, self.first, length1) {
                let under = self.first.under(&corner.point, self.frame);
                self.push_halfway(&under, &corner.point, [on, corner.id], out);
            }
        }
    }

    /// Adds a pair of points that do not face each other exactly, each moved by half the gap.
    fn push_halfway(
        &self,
        core1: &Point<N, D>,
        core2: &Point<N, D>,
        features: [FeatureId; 2],
        out: &mut Candidates<N, D>,
    ) {
        let (gap, normal) = (core2 - core1, self.frame.normal());
        let half = (gap - normal * normal.dot(&gap)) * N::HALF;
        self.push(&(core1 + half), &(core2 - half), features, out);
    }

    /// The part of a segment of a given length beside a corner of the other; `None` beyond the ends.
    fn beside(&self, corner: &Corner<N, D>, segment: &Facet<N, D>, length: N) -> Option<FeatureId> {
        let (side, from) = (segment.side(0), segment.corners[0].flat);
        let along = (corner.flat - from).dot(&side) / length;
        let tolerance = N::TWO * self.frame.tolerance;
        if along < -tolerance || along > length + tolerance {
            return None;
        }
        let end = if along <= tolerance { Some(0) } else { None };
        let end = if along >= length - tolerance { Some(1) } else { end };
        Some(end.map_or(segment.id, |end: usize| segment.corners[end].id))
    }

    /// Adds the pair of surface points above two points of the cores, once: corners that coincide in
    /// both facets are found from both. Different points may share a name, on round rims.
    fn push(
        &self,
        core1: &Point<N, D>,
        core2: &Point<N, D>,
        features: [FeatureId; 2],
        out: &mut Candidates<N, D>,
    ) {
        let (lift1, lift2) =
            (self.first.lift(core1, self.frame), self.second.lift(core2, self.frame));
        let normal = self.frame.normal();
        let distance = normal.dot(&(core2 - core1)) - lift1 - lift2;
        let found = self.frame.candidate(core1 + normal * lift1, distance, features);
        let Some(found) = found else { return };
        let near = N::lit(4.0) * self.frame.tolerance;
        let is_new = |old: &Candidate<N, D>| {
            let away = old.flat - found.flat;
            old.features != found.features || max_component(&away) > near || away.norm() > near
        };
        if out.iter().all(is_new) {
            out.push(found);
        }
    }
}

/// How far inside the sides of one facet the corners of the other are: a row for each corner.
struct Insides<N: Real> {
    numbers: SmallVec<[N; 64]>,
    side_count: usize,
}

impl<N: Real> Insides<N> {
    fn of<const D: usize>(corners: &Facet<N, D>, sides: &Facet<N, D>) -> Self {
        // Facets that are no points have sides.
        let side_count = sides.side_count().max(1);
        let mut numbers = SmallVec::from_elem(N::ZERO, side_count * corners.corners.len());
        for (row, corner) in numbers.chunks_exact_mut(side_count).zip(&corners.corners) {
            sides.measure_inside(&corner.flat, row);
        }
        Self { numbers, side_count }
    }

    #[inline]
    fn rows(&self) -> impl Iterator<Item = &[N]> {
        self.numbers.chunks_exact(self.side_count)
    }

    /// The rows of the two ends of a side of the facet whose corners these are.
    #[inline]
    fn at_ends<const D: usize>(&self, facet: &Facet<N, D>, side: usize) -> [&[N]; 2] {
        let row = |corner: usize| &self.numbers[corner * self.side_count..][..self.side_count];
        [row(side), row(facet.next(side))]
    }
}

/// The larger of two numbers of corners.
fn max_len(a: usize, b: usize) -> usize {
    if a > b { a } else { b }
}

/// How far inside the sides of one facet the corners of the other are, of which there are eight each at
/// most: a row for each corner, and what the numbers say as bits.
struct Rows<N: Real> {
    insides: [[N; LANES]; LANES],
    /// By more than the tolerance; outside by more; inside by no more.
    within: [u8; LANES],
    beyond: [u8; LANES],
    on_line: [u8; LANES],
}

impl<N: Real> Rows<N> {
    /// The corners of the first facet in the second, and the other way round.
    fn of_both<const D: usize>(overlap: &Overlap<'_, N, D>) -> [Self; 2] {
        let mut rows = [Self::empty(), Self::empty()];
        Self::fill_at(Level::new(), overlap, &mut rows);
        rows
    }

    fn empty() -> Self {
        let bits = [0; LANES];
        let insides = [[N::ZERO; LANES]; LANES];
        Self { insides, within: bits, beyond: bits, on_line: bits }
    }

    /// Fills both with the vectors of an instruction set; the numbers do not depend on it.
    fn fill_at<const D: usize>(level: Level, overlap: &Overlap<'_, N, D>, rows: &mut [Self; 2]) {
        with_lanes!(level, simd => Self::fill_both::<_, N::Lanes<_>, D>(simd, overlap, rows));
    }

    #[inline(always)]
    fn fill_both<S: Simd, V: Wide<S, Scalar = N>, const D: usize>(
        simd: S,
        overlap: &Overlap<'_, N, D>,
        [rows1, rows2]: &mut [Self; 2],
    ) {
        let tolerance = overlap.frame.tolerance;
        rows1.fill::<S, V, D>(simd, overlap.first, overlap.second, tolerance);
        rows2.fill::<S, V, D>(simd, overlap.second, overlap.first, tolerance);
    }

    #[inline(always)]
    fn fill<S: Simd, V: Wide<S, Scalar = N>, const D: usize>(
        &mut self,
        simd: S,
        corners: &Facet<N, D>,
        sides: &Facet<N, D>,
        tolerance: N,
    ) {
        let lines = sides.lines();
        let (from_x, from_y) = (V::load(simd, &lines.from[0]), V::load(simd, &lines.from[1]));
        let (x, y) = (V::load(simd, &lines.inward[0]), V::load(simd, &lines.inward[1]));
        let (most, least) = (V::all(simd, tolerance), V::all(simd, -tolerance));
        for (index, corner) in corners.corners.iter().enumerate() {
            let (flat_x, flat_y) = (V::all(simd, corner.flat.x), V::all(simd, corner.flat.y));
            let inside = x * (flat_x - from_x) + y * (flat_y - from_y);
            inside.store(&mut self.insides[index]);
            self.within[index] = bits(inside.simd_gt(most));
            self.beyond[index] = bits(inside.simd_lt(least));
            self.on_line[index] = bits(inside.simd_le(most));
        }
    }

    /// Whether a corner is inside the facet, but for the tolerance; and then the sides on whose lines it
    /// is, or from which it is seen within the tolerance.
    fn inside<const D: usize>(&self, corner: usize, facet: &Facet<N, D>) -> Option<u8> {
        let sides = all(facet.side_count());
        let is_segment = facet.is_segment();
        let outside = self.beyond[corner] | if is_segment { self.within[corner] } else { 0 };
        (outside & sides == 0).then_some(self.on_line[corner] & sides)
    }

    /// The sides of the facet whose lines lie between two corners, neither of which is on it.
    fn crossed<const D: usize>(&self, from: usize, to: usize, facet: &Facet<N, D>) -> u8 {
        let apart = self.within[from] & self.beyond[to] | self.beyond[from] & self.within[to];
        apart & all(facet.side_count())
    }
}

/// As many bits as there are sides, eight at most.
fn all(sides: usize) -> u8 {
    u8::MAX >> (LANES - sides)
}

fn bits<S: Simd, M: SimdMask<S>>(mask: M) -> u8 {
    mask.to_bitmask().to_le_bytes()[0]
}
