//! Segments and capsules against triangles and hulls: the separating axis test with a polyhedron of
//! two vertices and one edge.
//!
//! A segment has no faces, so the reference face belongs to the solid. If the lower end of the
//! segment projects into that face, the separation is along the face's normal. Otherwise edges
//! decide. If segment and solid overlap, the candidates are the edges between a face along whose
//! normal the segment rises and a face along whose normal it does not: with the segment these edges
//! form faces of the Minkowski difference. If segment and solid are apart, the candidates are the
//! edges of the faces that some point of the segment lies above.
//!
//! ```text
//!    b *            `climbed`: bit f set if b is higher above plane f than a
//!       \  |normal  `visible`: bit f set if a or b is above plane f
//!        \ |
//!       a *|        separations are from the solid to the segment; `hulls::in_first_frame`
//!    ------+-----   flips them
//!      solid
//! ```

use super::super::general;
use super::super::segments::nearest::core;
use super::edges::{
    CandidateEdges, EdgeBlock, ReferenceEdge, nearest_points, normal_between, proved,
    squared_distances,
};
use super::vertices::Vertices;
use super::{
    LANES, LocalFeatures, Polyhedral, SatResult, beyond_limit, in_first_frame, rounding_error,
};
use crate::collide::Pair;
use crate::convex::{Separation, Units};
use crate::math::lanes::{self, dot, highest_lane, load, spread, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{
    Mapped, Point, Pose, Real, Vector, Wide, cross, filled, max, max_component, min,
};

/// Returns the separation of a segment or capsule from a triangle or a convex hull; `None` above
/// `limit`.
///
/// Cost: linear in the numbers of faces and edges, in blocks of 8. Thin triangles, large hulls and
/// unproved results fall back to the general algorithm.
pub(in crate::collide::separation) fn separation<N: Real>(
    pair: &Pair<'_, N, 3>,
    limit: N,
) -> Option<Separation<N, 3>> {
    let (_, radius) = core(pair, &pair.first);
    let result = match result(Level::new(), pair, limit + radius) {
        SatResult::Found(found) => SatResult::Found(found.rounded(radius, N::ZERO)),
        other => other,
    };
    result.separation(pair, limit, general::of_flat_cores)
}

/// Runs the test for the cores of a pair; returns `Unproved` also for thin triangles and for hulls
/// that do not fit the lanes or have fewer than 4 faces.
pub(super) fn result<N: Real>(level: Level, pair: &Pair<'_, N, 3>, limit: N) -> SatResult<N> {
    let (ends, _) = core(pair, &pair.first);
    let features = LocalFeatures::of(pair.second);
    Polyhedral::of(pair.second, features.as_ref())
        .filter(|solid| solid.faces() > 3)
        .map_or(SatResult::Unproved, |solid| sat(level, &ends, &solid, &pair.pose12, limit))
}

/// Runs the test with the instruction set `level`, on which the result does not depend. Returns
/// `Unproved` if the pose or the unit of length is not finite.
fn sat<N: Real>(
    level: Level,
    ends: &[Point<N, 3>; 2],
    solid: &Polyhedral<'_, N>,
    pose12: &Pose<N, 3>,
    limit: N,
) -> SatResult<N> {
    let reach = max(max_component(&ends[0].coords), max_component(&ends[1].coords));
    let units = Units::of(reach, solid.reach, &pose12.translation);
    if !(pose12.is_finite() && units.scale.is_finite_number()) {
        return SatResult::Unproved;
    }
    let local = |end: &Point<N, 3>| {
        pose12.rotation.tr_mul(&((end.coords - pose12.translation) * units.shrink))
    };
    let query = SegmentQuery {
        solid,
        ends: [local(&ends[0]), local(&ends[1])],
        // Computed from the ends before they are translated, so that the distance of the origins
        // adds no rounding error.
        along: pose12.rotation.tr_mul(&((ends[1] - ends[0]) * units.shrink)),
        shrink: units.shrink,
    };
    let beyond = beyond_limit(&units, limit);
    let result = with_lanes!(level, simd => query.sat_in_lanes::<_, N::Lanes<_>>(simd, beyond));
    match result {
        SatResult::Found(found) => {
            SatResult::Found(in_first_frame(&found.scaled(units.scale), pose12))
        }
        other => other,
    }
}

/// A segment in the frame of a solid, in units of the pair. Separations are from the solid to the
/// segment.
struct SegmentQuery<'a, N: Real> {
    solid: &'a Polyhedral<'a, N>,
    /// Ends in the frame of the solid, in units of the pair.
    ends: [Vector<N, 3>; 2],
    /// Vector from the first end to the second.
    along: Vector<N, 3>,
    /// Factor from lengths of the shapes to units of the pair.
    shrink: N,
}

/// Heights of the segment above the planes of all faces.
struct FaceHeights<N> {
    /// Index of the face with the largest height of the segment's lower end; the first face wins a
    /// tie.
    index: usize,
    /// Signed height of the segment's lower end above that face.
    separation: N,
    /// Bits of the faces above whose planes the second end is higher than the first.
    climbed: u64,
    /// Bits of the faces above whose planes some point of the segment lies.
    visible: u64,
}

impl<N: Real> SegmentQuery<'_, N> {
    /// Queries faces, then edges; returns the separation in the frame of the solid.
    #[inline(always)]
    fn sat_in_lanes<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, beyond: N) -> SatResult<N> {
        let faces = self.query_faces::<S, V>(simd);
        if faces.separation > beyond {
            return SatResult::Beyond;
        }
        let vertices = Vertices::in_own_frame::<S, V>(simd, self.solid, self.shrink);
        let found = if faces.separation > N::ZERO {
            match self.over_face(&vertices, &faces) {
                Some(found) => Some(found),
                None => self.nearest_edge::<S, V>(simd, &vertices, &faces),
            }
        } else {
            match self.query_edges::<S, V>(simd, &vertices, &faces) {
                None => self.over_face(&vertices, &faces),
                Some((_, separation)) if separation > N::ZERO => {
                    self.nearest_edge::<S, V>(simd, &vertices, &faces)
                }
                Some((edge, _)) => self.edge_contact::<S, V>(simd, &vertices, edge, &faces),
            }
        };
        found.map_or(SatResult::Unproved, SatResult::Found)
    }

    /// Computes the heights of both ends above the planes of all faces.
    #[inline(always)]
    fn query_faces<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> FaceHeights<N> {
        let [a, b]: [[V; 3]; 2] = [spread(simd, &self.ends[0]), spread(simd, &self.ends[1])];
        let (shrink, zero) = (V::all(simd, self.shrink), V::all(simd, N::ZERO));
        let mut faces = FaceHeights { index: 0, separation: -N::INFINITY, climbed: 0, visible: 0 };
        for (number, block) in self.solid.planes.iter().enumerate() {
            let normals: [V; 3] = load(simd, &block.normals);
            let offsets = V::load(simd, &block.offsets) * shrink;
            let (high1, high2) = (dot(&normals, &a) - offsets, dot(&normals, &b) - offsets);
            let low = high1.smaller(high2);
            faces.climbed |= high2.simd_gt(high1).to_bitmask() << (number * LANES);
            faces.visible |= high1.larger(high2).simd_gt(zero).to_bitmask() << (number * LANES);
            let highest = highest_lane(low);
            if highest > faces.separation {
                let is_highest = low.simd_eq(V::all(simd, highest)).to_bitmask();
                faces.index = number * LANES + is_highest.trailing_zeros() as usize;
                faces.separation = highest;
            }
        }
        faces
    }

    /// Returns the point at parameter `share` from 0 to 1, computed from the nearer end.
    fn at(&self, share: N) -> Vector<N, 3> {
        if share <= N::HALF {
            self.ends[0] + self.along * share
        } else {
            self.ends[1] - self.along * (N::ONE - share)
        }
    }

    /// Returns the separation along the normal of the face `faces.index`; `None` unless the end of
    /// the segment that is lower above this face projects into it. If the segment is parallel to
    /// the face, the points are at the middle of the part that projects into the face.
    fn over_face(
        &self,
        vertices: &Vertices<N>,
        faces: &FaceHeights<N>,
    ) -> Option<Separation<N, 3>> {
        let normal = self.solid.normal(faces.index);
        let (first, last) = self.span(vertices, faces.index, &normal)?;
        let climb = self.along.dot(&normal);
        let point = if climb.abs() <= rounding_error() {
            self.at((first + last) * N::HALF)
        } else if climb > N::ZERO && first <= N::ZERO {
            self.ends[0]
        } else if climb < N::ZERO && last >= N::ONE {
            self.ends[1]
        } else {
            return None;
        };
        let distance = faces.separation;
        let (point1, point2) = (Point::from(point - normal * distance), Point::from(point));
        Some(Separation { distance, normal, point1, point2 })
    }

    /// Returns the interval of the segment that projects into a face, as parameters from 0 to 1.
    /// `None` if it is empty, and for a face without area.
    fn span(&self, vertices: &Vertices<N>, face: usize, normal: &Vector<N, 3>) -> Option<(N, N)> {
        let ring = self.solid.ring(face);
        let (mut first, mut last) = (N::ZERO, N::ONE);
        let mut from = vertices.at(ring[ring.len() - 1] as usize);
        for &vertex in ring {
            let to = vertices.at(vertex as usize);
            let side = to - from;
            if ring.len() < 3 || side.norm_squared() <= rounding_error::<N>() * rounding_error() {
                return None;
            }
            let inward = cross(normal, &side);
            let [a, b] = self.ends.mapped(|end| inward.dot(&(end - from)));
            from = to;
            if a < N::ZERO && b < N::ZERO {
                return None;
            }
            if a < N::ZERO {
                first = max(first, a / (a - b));
            } else if b < N::ZERO {
                last = min(last, a / (a - b));
            }
        }
        (first <= last).then_some((first, last))
    }

    /// Queries the edge directions. Returns the edge that forms a face of the Minkowski difference
    /// with the segment and has the largest signed distance, with that distance. `None` unless this
    /// distance exceeds the signed distance along the reference face by more than rounding.
    #[inline(always)]
    fn query_edges<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        vertices: &Vertices<N>,
        faces: &FaceHeights<N>,
    ) -> Option<(usize, N)> {
        let (edges, climbed) = (self.solid.edges, faces.climbed);
        let candidates = CandidateEdges::of(
            edges,
            #[inline(always)]
            |edge| (climbed >> edge.faces[0] ^ climbed >> edge.faces[1]) & 1 == 1,
        );
        let (along, end): ([V; 3], [V; 3]) =
            (spread(simd, &self.along), spread(simd, &self.ends[0]));
        let tiny = V::all(simd, rounding_error::<N>() * rounding_error());
        let (mut best, mut largest) = (None, faces.separation + N::TWO * rounding_error());
        for packet in candidates.indices().chunks(LANES) {
            let block = EdgeBlock::of::<S, V>(simd, self.solid, vertices, packet);
            let outward = block.indices.mapped(|index| self.outward(usize::from(index), climbed));
            let across = lanes::cross(&load(simd, &block.along), &along);
            let squared = dot(&across, &across);
            let away: [V; 3] = filled(
                #[inline(always)]
                |axis| end[axis] - V::load(simd, &block.from[axis]),
            );
            let height = dot(&across, &away) * V::load(simd, &outward) / squared.sqrt();
            // Parallel edges have no common perpendicular; a face normal then has a gap as large.
            let separations = squared.simd_gt(tiny).select(height, V::all(simd, -N::INFINITY));
            let highest = highest_lane(separations);
            if highest > largest {
                let is_largest = separations.simd_eq(V::all(simd, highest)).to_bitmask();
                let lane = is_largest.trailing_zeros() as usize;
                (best, largest) = (Some(usize::from(block.indices[lane])), highest);
            }
        }
        best.map(|edge| (edge, largest))
    }

    /// Returns the sign that makes the cross product of an edge and the segment point out of the
    /// solid. The edge runs counter-clockwise around its first face, so the product points outwards
    /// if the segment rises along the normal of that face.
    fn outward(&self, edge: usize, climbed: u64) -> N {
        let [first, _] = self.solid.edges[edge].faces;
        if climbed >> first & 1 == 1 { N::ONE } else { -N::ONE }
    }

    /// Returns the separation at the nearest points of an edge and the segment along their common
    /// perpendicular; `None` unless supporting planes prove it.
    #[inline(always)]
    fn edge_contact<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        vertices: &Vertices<N>,
        edge: usize,
        faces: &FaceHeights<N>,
    ) -> Option<Separation<N, 3>> {
        let (points, across) = nearest_points(&self.solid.ends(vertices, edge), &self.ends);
        let normal = across * (self.outward(edge, faces.climbed) / across.norm());
        self.proved::<S, V>(simd, vertices, &normal, points)
    }

    /// Returns the separation at the nearest visible edge (an edge of a face that some point of the
    /// segment lies above); `None` unless supporting planes prove it.
    #[inline(always)]
    fn nearest_edge<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        vertices: &Vertices<N>,
        faces: &FaceHeights<N>,
    ) -> Option<Separation<N, 3>> {
        let (edges, visible) = (self.solid.edges, faces.visible);
        let candidates = CandidateEdges::of(
            edges,
            #[inline(always)]
            |edge| (visible >> edge.faces[0] | visible >> edge.faces[1]) & 1 == 1,
        );
        let (from, along) = (self.ends[0], self.along);
        let segment = ReferenceEdge { index: 0, from, along, squared: along.norm_squared() };
        let (mut nearest, mut least) = (None, N::INFINITY);
        for packet in candidates.indices().chunks(LANES) {
            let block = EdgeBlock::of::<S, V>(simd, self.solid, vertices, packet);
            let squares = squared_distances::<S, N, V>(simd, &segment, &block);
            let lowest = -highest_lane(-squares);
            if lowest < least {
                let is_lowest = squares.simd_eq(V::all(simd, lowest)).to_bitmask();
                let lane = is_lowest.trailing_zeros() as usize;
                (nearest, least) = (Some(usize::from(block.indices[lane])), lowest);
            }
        }
        let (points, across) = nearest_points(&self.solid.ends(vertices, nearest?), &self.ends);
        self.proved::<S, V>(simd, vertices, &normal_between(&points, &across)?, points)
    }

    /// Returns the separation along the unit vector `normal`; `None` unless the vector between both
    /// points is `normal` times the distance of the supporting planes, up to rounding.
    #[inline(always)]
    fn proved<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        vertices: &Vertices<N>,
        normal: &Vector<N, 3>,
        points: [Vector<N, 3>; 2],
    ) -> Option<Separation<N, 3>> {
        let low = min(normal.dot(&self.ends[0]), normal.dot(&self.ends[1]));
        let high = -vertices.low::<S, V>(simd, &-normal);
        proved(normal, low - high, points)
    }
}
