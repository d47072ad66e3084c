//! Supporting feature of a 3D solid as a ring of corners, projected along the normal of a frame.
//!
//! ```text
//!     corner 0 ---side 0---> corner 1       flats: corners in the tangents (u, v), witness at 0
//!        ^                      |           inward[i]: unit normal of side i, into the ring
//!     side 3                  side 1        turn: 1 if counter-clockwise in (u, v), else -1
//!        |                      v           corner and side i: lane i % 8 of block i / 8
//!     corner 3 <---side 2--- corner 2
//! ```
//!
//! A point has one corner, a segment two corners and one side, a face three or more corners and the
//! same number of sides. A ring is a list of blocks of [`LANES`] corners. Most rings have one
//! block; a round cap may need two, and a hull face with more than 8 corners needs one for each 8.
//! [`LANES`] is the capacity of `FaceRing`, which `supporting` fills; `clip` measures corners
//! against whole blocks of sides. Ids are those of
//! [`SupportMap::core_feature`](crate::shape::SupportMap::core_feature). Corners that coincide in
//! projection are merged. A face without area becomes a segment, and a feature that is tilted by
//! more than 60° becomes its corner nearest to the other solid.

use smallvec::{SmallVec, smallvec};

use super::frame::{ContactFrame, MIN_COSINE, Which, lifted};
use super::supporting::{FaceBlocks, supporting_feature};
use crate::math::lanes::{LanePose, dot, load, minus, spread};
use crate::math::simd::Simd;
use crate::math::{Point, Pose, Real, Vector, Wide, cross2, max, max_component, min};
use crate::shape::{FaceRing, FeatureId, Kind, Segment};

/// Number of corners in one block.
pub(super) const LANES: usize = FaceRing::<f32>::MAX;

/// A corner, and the side from it to the next.
#[derive(Clone, Copy)]
pub(super) struct RingCorner<N: Real> {
    pub(super) point: Point<N, 3>,
    /// Coordinates along the tangents of the frame.
    pub(super) flat: Vector<N, 2>,
    pub(super) id: FeatureId,
    /// Id of the side from this corner to the next.
    pub(super) side: FeatureId,
}

/// Up to 8 corners, by coordinate; lanes after the last corner are unspecified.
pub(super) struct RingBlock<N: Real> {
    /// Corners in the frame of the first solid.
    points: [[N; LANES]; 3],
    /// Coordinates of the corners along the tangents.
    pub(super) flats: [[N; LANES]; 2],
    /// Inward unit normals of the sides, in tangent coordinates.
    pub(super) inward: [[N; LANES]; 2],
}

/// A supporting feature, with the radius of the solid's surface around it.
pub(super) struct SupportRing<'a, N: Real> {
    which: Which,
    /// Pose of the solid in the frame of the first solid; `None` for the first solid.
    pose: Option<&'a Pose<N, 3>>,
    /// Id of the feature.
    pub(super) id: FeatureId,
    /// Number of corners.
    pub(super) count: usize,
    /// Corners as `supporting` filled them, in the frame of the solid, with their ids.
    faces: FaceBlocks<N>,
    /// Corners in the frame of the first solid, set by [`SupportRing::project`].
    pub(super) blocks: SmallVec<[RingBlock<N>; 2]>,
    /// Outward normal of a face in the frame of the first solid; unspecified for other features.
    normal: Vector<N, 3>,
    /// Sense of rotation in tangent coordinates: 1 for counter-clockwise, -1 for clockwise.
    turn: N,
    /// Radius around the feature.
    radius: N,
    /// Cosine of the angle between the face's normal and [`Which::outward`], or between a segment
    /// and the contact plane; 1 for a point.
    cosine: N,
    /// Only for a solid with a radius: depth, below the supporting plane, of the corner nearest to
    /// the other solid, and the tangent coordinates of that corner.
    top: (N, Vector<N, 2>),
}

impl<'a, N: Real> SupportRing<'a, N> {
    /// Creates a ring without corners for one solid of a pair.
    #[inline(always)]
    pub(super) fn blank(which: Which, pose: Option<&'a Pose<N, 3>>) -> Self {
        Self {
            which,
            pose,
            id: FeatureId::Face(0),
            count: 0,
            faces: smallvec![FaceRing::blank()],
            blocks: SmallVec::new(),
            normal: Vector::<N, 3>::zeros(),
            turn: N::ONE,
            radius: N::ZERO,
            cosine: N::ONE,
            top: (N::ZERO, Vector::<N, 2>::zeros()),
        }
    }

    /// Fills a blank ring with the supporting feature of a solid; the caller then
    /// [projects](Self::project) it. Filling it in place avoids a copy of several hundred bytes.
    pub(super) fn fill(&mut self, kind: Kind<'_, N, 3>, frame: &ContactFrame<N, 3>) {
        let outward = self.which.outward(frame);
        let direction = self.pose.map_or(outward, |pose| pose.inverse_vector(&outward));
        self.radius = supporting_feature(kind, &direction, &mut self.faces);
        let normal = self.faces[0].normal;
        self.normal = self.pose.map_or(normal, |pose| pose.vector(&normal));
        self.id = self.faces[0].id;
        self.count = self.faces.iter().map(|face| face.count).sum();
    }

    #[inline]
    pub(super) const fn is_point(&self) -> bool {
        self.count == 1
    }

    #[inline]
    pub(super) const fn is_segment(&self) -> bool {
        self.count == 2
    }

    /// Returns the number of sides: none for a point, one for a segment, else one for each corner.
    #[inline]
    pub(super) const fn side_count(&self) -> usize {
        if self.count < 3 { self.count - 1 } else { self.count }
    }

    /// Returns the index of the corner after `at`, cyclically.
    #[inline]
    pub(super) const fn next(&self, at: usize) -> usize {
        if at + 1 < self.count { at + 1 } else { 0 }
    }

    #[inline]
    pub(super) fn point(&self, at: usize) -> Point<N, 3> {
        let [x, y, z] = &self.blocks[at / LANES].points;
        Point::<N, 3>::new(x[at % LANES], y[at % LANES], z[at % LANES])
    }

    #[inline]
    pub(super) fn flat(&self, at: usize) -> Vector<N, 2> {
        let [x, y] = &self.blocks[at / LANES].flats;
        Vector::<N, 2>::new(x[at % LANES], y[at % LANES])
    }

    #[inline]
    pub(super) fn corner(&self, at: usize) -> RingCorner<N> {
        let ring = &self.faces[at / LANES];
        let (id, side) = (ring.ids[at % LANES], ring.sides[at % LANES]);
        RingCorner { point: self.point(at), flat: self.flat(at), id, side }
    }

    /// Returns the id of the side from a corner to the next.
    #[inline]
    pub(super) fn side_id(&self, at: usize) -> FeatureId {
        if self.is_segment() { self.id } else { self.faces[at / LANES].sides[at % LANES] }
    }

    /// Returns the vector from a corner to the next, in tangent coordinates.
    #[inline]
    pub(super) fn side(&self, at: usize) -> Vector<N, 2> {
        self.flat(self.next(at)) - self.flat(at)
    }

    /// Returns the point of a side at the parameter `share`, from 0 at its first corner to 1.
    #[inline]
    pub(super) fn along_side(&self, at: usize, share: N) -> Point<N, 3> {
        let (from, to) = (self.point(at), self.point(self.next(at)));
        from + (to - from) * share
    }

    /// Returns the point of a face with the tangent coordinates `flat` of `point`; for a segment,
    /// its point nearest to `flat` in projection.
    pub(super) fn under(
        &self,
        point: &Point<N, 3>,
        flat: &Vector<N, 2>,
        frame: &ContactFrame<N, 3>,
    ) -> Point<N, 3> {
        if self.is_segment() {
            let side = self.side(0);
            let share = (flat - self.flat(0)).dot(&side) / side.norm_squared();
            return self.along_side(0, min(max(share, N::ZERO), N::ONE));
        }
        let along = (self.point(0) - point).dot(&self.normal) / frame.normal().dot(&self.normal);
        point + frame.normal() * along
    }

    /// Returns the part of a side that contains a point on the side's line: a corner within twice
    /// the tolerance, else the side; `None` if the point is outside the side.
    pub(super) fn on_side(
        &self,
        at: usize,
        flat: &Vector<N, 2>,
        tolerance: N,
    ) -> Option<FeatureId> {
        let (from, to) = (self.flat(at), self.flat(self.next(at)));
        let id = |at: usize| self.faces[at / LANES].ids[at % LANES];
        let near = |end: &Vector<N, 2>| (end - flat).norm() <= N::TWO * tolerance;
        if near(&from) {
            return Some(id(at));
        }
        if near(&to) {
            return Some(id(self.next(at)));
        }
        let (side, arm) = (to - from, flat - from);
        let share = arm.dot(&side);
        (share >= N::ZERO && share <= side.norm_squared()).then(|| self.side_id(at))
    }

    /// Returns the height of the rounded surface above a point of the core, along the normal.
    #[inline]
    pub(super) fn lift(&self, core: &Point<N, 3>, frame: &ContactFrame<N, 3>) -> N {
        if self.radius <= N::ZERO {
            return N::ZERO;
        }
        let (depth, (top, at)) = (self.which.below_witness(core, frame), &self.top);
        let away_squared = (frame.flat(core) - at).norm_squared();
        lifted(self.radius, self.cosine, depth, *top, away_squared)
    }

    /// Transforms and projects the corners, simplifies a feature without extent, and computes the
    /// sides.
    #[inline(always)]
    pub(super) fn project<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        frame: &ContactFrame<N, 3>,
    ) {
        let [u, v] = frame.tangents();
        for face in &self.faces {
            let local: [V; 3] = load(simd, &face.corners);
            let points = match self.pose {
                Some(pose) => LanePose::of(simd, pose).point(&local),
                None => local,
            };
            let arms = minus(&points, &spread(simd, &frame.witness.point1.coords));
            let zeros = [N::ZERO; LANES];
            let mut block = RingBlock { points: [zeros; 3], flats: [zeros; 2], inward: [zeros; 2] };
            for (row, values) in block.points.iter_mut().zip(&points) {
                values.store(row);
            }
            dot(&spread::<S, N, V, 3>(simd, u), &arms).store(&mut block.flats[0]);
            dot(&spread::<S, N, V, 3>(simd, v), &arms).store(&mut block.flats[1]);
            self.blocks.push(block);
        }
        self.simplify(frame);
        self.find_sides::<S, V>(simd);
    }

    /// Computes the inward normals of the sides.
    #[inline(always)]
    fn find_sides<S: Simd, V: Wide<S, Scalar = N>>(&mut self, simd: S) {
        let (used, first) = (self.count.div_ceil(LANES), self.flat(0));
        for at in 0..used {
            let is_last = at + 1 == used;
            let after = if is_last { first } else { self.flat((at + 1) * LANES) };
            let last = if is_last { (self.count - 1) % LANES } else { LANES - 1 };
            let block = &mut self.blocks[at];
            let mut next = block.flats;
            for ((next, row), after) in next.iter_mut().zip(&block.flats).zip(after.iter()) {
                next[..LANES - 1].copy_from_slice(&row[1..]);
                next[last] = *after;
            }
            let sides: [V; 2] = minus(&load(simd, &next), &load(simd, &block.flats));
            let turn = V::all(simd, self.turn) / dot(&sides, &sides).sqrt();
            (-sides[1] * turn).store(&mut block.inward[0]);
            (sides[0] * turn).store(&mut block.inward[1]);
        }
    }

    /// Reduces a feature that has no area or length in projection, or is tilted by more than 60°,
    /// and computes `turn`, `cosine` and `top`.
    fn simplify(&mut self, frame: &ContactFrame<N, 3>) {
        let (outward, tolerance) = (self.which.outward(frame), frame.tolerance);
        // Coinciding corners make the extent unknown; once they are merged, the face may have an
        // extent.
        let mut extent = if self.is_point() { None } else { self.extent(tolerance) };
        if extent.is_none() && self.is_segment() {
            self.end_on(&outward, tolerance);
        } else if extent.is_none() && !self.is_point() {
            self.merge_coincident(tolerance);
            extent = self.extent(tolerance);
        }
        if let Some((area, longest)) = extent {
            self.turn = if area < N::ZERO { -N::ONE } else { N::ONE };
            self.cosine = self.normal.dot(&outward);
            if self.count > 2 && area.abs() <= N::TWO * tolerance * self.side(longest).norm() {
                self.flatten(longest);
            }
        }
        if self.is_segment() {
            self.turn = N::ONE;
            self.cosine = self.side(0).norm() / (self.point(1) - self.point(0)).norm();
        }
        // Tilted by more than 60°.
        if self.count > 1 && self.cosine < N::lit(MIN_COSINE) {
            self.keep_farthest(&outward);
        }
        if self.is_point() {
            self.cosine = N::ONE;
        }
        if self.radius > N::ZERO {
            self.find_top(frame);
        }
    }

    /// Returns twice the signed area and the index of the longest side, in projection; `None` if
    /// adjacent corners coincide or a coordinate is NaN.
    fn extent(&self, tolerance: N) -> Option<(N, usize)> {
        let (mut area, mut longest, mut most) = (N::ZERO, 0, N::ZERO);
        let origin = self.flat(0);
        let mut from = origin;
        for at in 0..self.count {
            let to = self.flat(self.next(at));
            let side = to - from;
            // Written so that NaN counts as coinciding.
            let is_long = max_component(&side) > tolerance;
            if !is_long {
                return None;
            }
            area += cross2(&(from - origin), &side);
            let squared = side.norm_squared();
            if squared > most {
                (longest, most) = (at, squared);
            }
            from = to;
        }
        Some((area, longest))
    }

    /// Merges each corner with the following corners that coincide with it in projection. The
    /// merged corner gets the side that begins at the last of these corners.
    fn merge_coincident(&mut self, tolerance: N) {
        let is_apart =
            |a: &RingCorner<N>, b: &RingCorner<N>| max_component(&(a.flat - b.flat)) > tolerance;
        let mut kept: SmallVec<[RingCorner<N>; LANES]> = SmallVec::new();
        for at in 0..self.count {
            let corner = self.corner(at);
            match kept.last_mut() {
                Some(last) if !is_apart(last, &corner) => last.side = corner.side,
                _ => kept.push(corner),
            }
        }
        while kept.len() > 1 && !is_apart(&kept[0], &kept[kept.len() - 1]) {
            kept.pop();
        }
        self.replace(&kept);
    }

    /// Reduces a segment that projects to a point to its end nearest to the other solid. A segment
    /// without length keeps its own id instead of the end's.
    fn end_on(&mut self, outward: &Vector<N, 3>, tolerance: N) {
        let (id, edge) = (self.id, self.point(1) - self.point(0));
        self.keep_farthest(outward);
        // Written so that a NaN length counts as no length.
        let has_ends = edge.norm() > N::TWO * tolerance;
        self.id = if has_ends { self.id } else { id };
    }

    /// Reduces a face without width to its two extreme corners along its longest side, with the id
    /// of that side.
    fn flatten(&mut self, longest: usize) {
        let (along, from) = (self.side(longest), self.flat(longest));
        let (mut low, mut high) = (0, 0);
        for at in 1..self.count {
            let share = |at: usize| (self.flat(at) - from).dot(&along);
            low = if share(at) < share(low) { at } else { low };
            high = if share(at) > share(high) { at } else { high };
        }
        self.id = self.side_id(longest);
        self.replace(&[self.corner(low), self.corner(high)]);
    }

    /// Reduces the ring to the corner nearest to the other solid.
    fn keep_farthest(&mut self, outward: &Vector<N, 3>) {
        let height = |at: usize| self.point(at).coords.dot(outward);
        let higher = |best: usize, at: usize| if height(at) > height(best) { at } else { best };
        let farthest = self.corner((1..self.count).fold(0, higher));
        self.id = farthest.id;
        self.replace(&[farthest]);
    }

    /// Keeps only the given corners, in the order of `corners`.
    fn replace(&mut self, corners: &[RingCorner<N>]) {
        for (at, corner) in corners.iter().enumerate() {
            let (face, lane) = (&mut self.faces[at / LANES], at % LANES);
            (face.ids[lane], face.sides[lane]) = (corner.id, corner.side);
            let block = &mut self.blocks[at / LANES];
            for (row, value) in block.points.iter_mut().zip(corner.point.iter()) {
                row[lane] = *value;
            }
            (block.flats[0][lane], block.flats[1][lane]) = (corner.flat.x, corner.flat.y);
        }
        self.count = corners.len();
    }

    /// Finds the corner nearest to the other solid, the first of equals, and sets `top`.
    fn find_top(&mut self, frame: &ContactFrame<N, 3>) {
        let below = |at: usize| self.which.below_witness(&self.point(at), frame);
        let (mut best, mut least) = (0, below(0));
        for at in 1..self.count {
            let other = below(at);
            (best, least) = if other < least { (at, other) } else { (best, least) };
        }
        self.top = (least, self.flat(best));
    }
}

/// Returns the end of a segment that is within `tolerance` of a point, measured along the segment,
/// else the segment. A point beyond an end counts as at that end. `None` if the point is at both
/// ends.
pub(super) fn part_of<N: Real, const D: usize>(
    segment: &Segment<N, D>,
    point: &Point<N, D>,
    tolerance: N,
) -> Option<FeatureId> {
    let along = segment.b() - segment.a();
    let (squared, reached) = (along.norm_squared(), (point - segment.a()).dot(&along));
    let is_near = |distance: N| distance <= tolerance * squared.sqrt();
    match (is_near(reached), is_near(squared - reached)) {
        (true, true) => None,
        (true, false) => Some(FeatureId::Vertex(0)),
        (false, true) => Some(FeatureId::Vertex(1)),
        (false, false) => Some(FeatureId::Edge(0)),
    }
}
