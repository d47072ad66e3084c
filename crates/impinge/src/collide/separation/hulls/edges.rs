//! Edge queries: faces of the Minkowski difference if the solids overlap, nearest points of edges
//! if they are apart.
//!
//! ```text
//!    Gauss map: each edge is the arc between the normals of its two faces.
//!
//!         n1a                     A pair of edges is a face of the difference if the arc of one
//!          |                      crosses the negated arc of the other: the ends of each lie on
//!   -n2a --+-- -n2b               opposite sides of the other's great circle, whose normal is the
//!          |                      direction of the edge. Signs of four dot products decide.
//!         n1b
//! ```

use super::face::ReferenceFace;
use super::polyhedral::Polyhedral;
use super::vertices::Vertices;
use super::{LANES, rounding_error};
use crate::collide::separation::segments::nearest::nearest_of_segments;
use crate::convex::Separation;
use crate::math::lanes::{self, LanePose, dot, highest_lane, load, spread};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Point, Real, Vector, Wide, cross, filled, unit};
use crate::shape::PolytopeEdge;

/// Capacity for edges: 32 vertices have at most 3 · 32 - 6.
pub(super) const MAX_EDGES: usize = 90;

/// An edge that is compared with the 8 edges of an [`EdgeBlock`]: an edge of the solid with the
/// reference face or, in module `segment`, the segment. It is in the frame of the solid with the
/// reference face.
pub(super) struct ReferenceEdge<N: Real> {
    pub(super) index: usize,
    /// First end, in units of the pair.
    pub(super) from: Vector<N, 3>,
    /// Vector from the first end to the second.
    pub(super) along: Vector<N, 3>,
    /// Squared length of `along`.
    pub(super) squared: N,
}

/// Eight edges of the other solid, in the frame of the solid with the reference face and in units
/// of the pair. In module `segment`, they are edges of the polyhedron, in its own frame.
pub(super) struct EdgeBlock<N: Real> {
    /// Index of the edge in each lane.
    pub(super) indices: [u8; LANES],
    pub(super) from: [[N; LANES]; 3],
    pub(super) along: [[N; LANES]; 3],
}

impl<N: Real> EdgeBlock<N> {
    /// Gathers up to 8 edges of a solid; spare lanes are copies of the first.
    #[inline(always)]
    pub(super) fn of<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        solid: &Polyhedral<'_, N>,
        vertices: &Vertices<N>,
        candidates: &[u8],
    ) -> Self {
        let zero = [[N::ZERO; LANES]; 3];
        let mut block = Self { indices: [0; LANES], from: zero, along: zero };
        let mut ends = zero;
        for lane in 0..LANES {
            let index = candidates[if lane < candidates.len() { lane } else { 0 }];
            block.indices[lane] = index;
            let [from, to] = solid.ends(vertices, usize::from(index));
            for axis in 0..3 {
                (block.from[axis][lane], ends[axis][lane]) = (from[axis], to[axis]);
            }
        }
        for (axis, ends) in ends.iter().enumerate() {
            let along = V::load(simd, ends) - V::load(simd, &block.from[axis]);
            along.store(&mut block.along[axis]);
        }
        block
    }
}

/// Indices of the edges of one solid that an edge query compares, ascending.
pub(super) struct CandidateEdges {
    indices: [u8; MAX_EDGES],
    len: usize,
}

impl CandidateEdges {
    /// Collects the indices of the edges that `is_candidate` accepts.
    #[inline(always)]
    pub(super) fn of(edges: &[PolytopeEdge], is_candidate: impl Fn(&PolytopeEdge) -> bool) -> Self {
        let mut candidates = Self { indices: [0; MAX_EDGES], len: 0 };
        for (index, edge) in (0_u8..).zip(edges) {
            // Written without a branch: an edge that is not a candidate is overwritten by the next
            // one.
            candidates.indices[candidates.len] = index;
            candidates.len += usize::from(is_candidate(edge));
        }
        candidates
    }

    /// Collects the edges with an end in `vertices`, a mask of vertices.
    #[inline(always)]
    fn at(edges: &[PolytopeEdge], vertices: u32) -> Self {
        Self::of(
            edges,
            #[inline(always)]
            |edge| (vertices >> edge.vertices[0] | vertices >> edge.vertices[1]) & 1 == 1,
        )
    }

    pub(super) fn indices(&self) -> &[u8] {
        &self.indices[..self.len]
    }
}

/// A pair of edges that forms a face of the Minkowski difference: one edge of the solid with the
/// reference face, and one of the other solid.
pub(super) struct EdgeQuery<N> {
    edges: [usize; 2],
    /// Signed distance of the solids along the pair's common perpendicular.
    pub(super) separation: N,
}

impl<N: Real> ReferenceFace<'_, '_, N> {
    /// Returns the edges of each solid that can hold the points of a result whose points are at
    /// most `max_distance` apart: those with an end close enough to the other solid along the
    /// normal of the reference face.
    #[inline(always)]
    fn candidates<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        max_distance: N,
    ) -> [CandidateEdges; 2] {
        let slack = N::lit(4.0) * rounding_error();
        let (least, most) =
            (self.other.heights.low - max_distance - slack, self.offset() + max_distance + slack);
        let own = self.own.heights.up_to::<S, V>(simd, -least);
        let other = self.other.heights.up_to::<S, V>(simd, most);
        [
            CandidateEdges::at(self.own.solid.edges, own),
            CandidateEdges::at(self.other.solid.edges, other),
        ]
    }

    /// Loads an edge of the solid with the reference face.
    #[inline(always)]
    fn edge(&self, index: u8) -> ReferenceEdge<N> {
        let index = usize::from(index);
        let [from, to] = self.own.solid.ends(self.own.vertices, index);
        let along = to - from;
        ReferenceEdge { index, from, along, squared: along.norm_squared() }
    }

    /// Returns the outward normals of the two faces beside an edge.
    #[inline(always)]
    fn normals_beside(&self, edge: usize) -> [Vector<N, 3>; 2] {
        self.own.solid.edges[edge].faces.map(|face| self.own.solid.normal(face as usize))
    }

    /// Returns the outward normals of the two faces beside each edge of a block, in the frame of
    /// the reference face.
    #[inline(always)]
    fn normals_beside_block<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        block: &EdgeBlock<N>,
    ) -> [[V; 3]; 2] {
        let (solid, mut normals) = (self.other.solid, [[[N::ZERO; LANES]; 3]; 2]);
        for (lane, &index) in block.indices.iter().enumerate() {
            let faces = solid.edges[usize::from(index)].faces;
            for (normals, face) in normals.iter_mut().zip(faces) {
                let normal = solid.normal(face as usize);
                for (row, &coordinate) in normals.iter_mut().zip(&normal) {
                    row[lane] = coordinate;
                }
            }
        }
        let pose: LanePose<V, 3> = LanePose::of(simd, &self.pose);
        [pose.vector(&load(simd, &normals[0])), pose.vector(&load(simd, &normals[1]))]
    }

    /// Queries the edge directions. Returns the pair of edges that forms a face of the Minkowski
    /// difference and has the largest signed distance, among those that [`Self::candidates`]
    /// returns for `max_distance`. `None` unless this distance exceeds the signed distance along
    /// the reference face by more than rounding.
    #[inline(always)]
    pub(super) fn query_edges<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        max_distance: N,
    ) -> Option<EdgeQuery<N>> {
        let [candidates1, candidates2] = self.candidates::<S, V>(simd, max_distance);
        let (mut best, mut largest): (Option<EdgeQuery<N>>, N) =
            (None, self.separation() + N::TWO * rounding_error());
        for packet in candidates2.indices().chunks(LANES) {
            let edges2 = EdgeBlock::of::<S, V>(simd, self.other.solid, self.other.vertices, packet);
            let normals2 = self.normals_beside_block::<S, V>(simd, &edges2);
            for &index in candidates1.indices() {
                let edge1 = self.edge(index);
                let normals1 = self.normals_beside(edge1.index);
                let separations =
                    separations::<S, N, V>(simd, (&edge1, &normals1), (&edges2, &normals2));
                let Some(separations) = separations else { continue };
                let separation = highest_lane(separations);
                let is_before = |best: &EdgeQuery<N>| best.edges[0] > edge1.index;
                if separation > largest
                    || separation == largest && best.as_ref().is_some_and(is_before)
                {
                    let is_largest = separations.simd_eq(V::all(simd, separation)).to_bitmask();
                    let lane = is_largest.trailing_zeros() as usize;
                    let edges = [edge1.index, usize::from(edges2.indices[lane])];
                    (best, largest) = (Some(EdgeQuery { edges, separation }), separation);
                }
            }
        }
        best
    }

    /// Returns the separation at the nearest points of two edges along their common perpendicular;
    /// `None` unless supporting planes prove it.
    #[inline(always)]
    pub(super) fn edge_contact<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        query: &EdgeQuery<N>,
    ) -> Option<Separation<N, 3>> {
        let (points, across) = self.nearest_points(query.edges);
        let (normal, _) = unit(&across)?;
        let [normal1, normal2] = self.normals_beside(query.edges[0]);
        let is_outward = normal.dot(&(normal1 + normal2)) > N::ZERO;
        self.proved::<S, V>(simd, &if is_outward { normal } else { -normal }, points)
    }

    /// Returns the separation at the nearest pair of edges of two solids that are apart, among
    /// those that [`Self::candidates`] returns for `max_distance`; `None` unless supporting planes
    /// prove it.
    #[inline(always)]
    pub(super) fn nearest_edges<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        max_distance: N,
    ) -> Option<Separation<N, 3>> {
        let [candidates1, candidates2] = self.candidates::<S, V>(simd, max_distance);
        let (mut nearest, mut least): (Option<[usize; 2]>, N) = (None, N::INFINITY);
        for packet in candidates2.indices().chunks(LANES) {
            let edges2 = EdgeBlock::of::<S, V>(simd, self.other.solid, self.other.vertices, packet);
            for &index in candidates1.indices() {
                let edge1 = self.edge(index);
                let squares = squared_distances::<S, N, V>(simd, &edge1, &edges2);
                let lowest = -highest_lane(-squares);
                let is_before = |best: [usize; 2]| best[0] > edge1.index;
                if lowest < least || lowest == least && nearest.is_some_and(is_before) {
                    let is_lowest = squares.simd_eq(V::all(simd, lowest)).to_bitmask();
                    let lane = is_lowest.trailing_zeros() as usize;
                    (nearest, least) =
                        (Some([edge1.index, usize::from(edges2.indices[lane])]), lowest);
                }
            }
        }
        let (points, across) = self.nearest_points(nearest?);
        self.proved::<S, V>(simd, &normal_between(&points, &across)?, points)
    }

    /// Returns the nearest points of two edges, and a vector perpendicular to both, of any length
    /// and either sign; zero for parallel edges.
    fn nearest_points(&self, [edge1, edge2]: [usize; 2]) -> ([Vector<N, 3>; 2], Vector<N, 3>) {
        let ends1 = self.own.solid.ends(self.own.vertices, edge1);
        let ends2 = self.other.solid.ends(self.other.vertices, edge2);
        nearest_points(&ends1, &ends2)
    }

    /// Returns the separation along the unit vector `normal`; `None` unless the vector between both
    /// points is `normal` times the distance of the supporting planes, up to rounding.
    #[inline(always)]
    fn proved<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        normal: &Vector<N, 3>,
        points: [Vector<N, 3>; 2],
    ) -> Option<Separation<N, 3>> {
        let low = self.other.vertices.low::<S, V>(simd, normal);
        let high = -self.own.vertices.low::<S, V>(simd, &-normal);
        proved(normal, low - high, points)
    }
}

/// Returns the nearest points of two edges, and a vector perpendicular to both, of any length and
/// either sign; zero for parallel edges.
pub(super) fn nearest_points<N: Real>(
    ends1: &[Vector<N, 3>; 2],
    ends2: &[Vector<N, 3>; 2],
) -> ([Vector<N, 3>; 2], Vector<N, 3>) {
    let (point1, point2) = nearest_of_segments(&ends1.map(Point::from), &ends2.map(Point::from));
    let across = cross(&(ends1[1] - ends1[0]), &(ends2[1] - ends2[0]));
    ([point1.coords, point2.coords], across)
}

/// Returns the unit direction from the first to the second nearest point of two edges: their common
/// perpendicular if it leads from one point to the other, else the direction of the difference. The
/// perpendicular is accurate to rounding at any distance, unlike the difference. `None` if the
/// points coincide and the edges are parallel.
pub(super) fn normal_between<N: Real>(
    [from, to]: &[Vector<N, 3>; 2],
    across: &Vector<N, 3>,
) -> Option<Vector<N, 3>> {
    let away = to - from;
    let is_across = |across: &Vector<N, 3>| {
        (away - across * across.dot(&away)).norm_squared()
            <= rounding_error::<N>() * rounding_error()
    };
    match unit(across).map(|(across, _)| across).filter(is_across) {
        Some(across) if across.dot(&away) < N::ZERO => Some(-across),
        Some(across) => Some(across),
        None => unit(&away).map(|(normal, _)| normal),
    }
}

/// Returns the separation along the unit vector `normal`; `None` unless the vector between the two
/// points is `normal` times `distance`, the distance of the supporting planes, up to rounding.
pub(super) fn proved<N: Real>(
    normal: &Vector<N, 3>,
    distance: N,
    [on_own, on_other]: [Vector<N, 3>; 2],
) -> Option<Separation<N, 3>> {
    let off = on_other - on_own - normal * distance;
    let is_proved = off.norm_squared() <= N::lit(4.0) * rounding_error::<N>() * rounding_error();
    let (point1, point2) = (Point::from(on_own), Point::from(on_other));
    is_proved.then_some(Separation { distance, normal: *normal, point1, point2 })
}

/// Returns the signed distances of the solids along the common perpendiculars of 8 pairs of edges;
/// minus infinity for pairs that do not form a face of the Minkowski difference. `None` if none of
/// the pairs does.
#[inline(always)]
fn separations<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    (edge1, normals1): (&ReferenceEdge<N>, &[Vector<N, 3>; 2]),
    (edges2, normals2): (&EdgeBlock<N>, &[[V; 3]; 2]),
) -> Option<V> {
    let zero = V::all(simd, N::ZERO);
    let (along1, along2): ([V; 3], [V; 3]) =
        (spread(simd, &edge1.along), load(simd, &edges2.along));
    // A pair is a face if the arcs between the normals beside each edge cross on the Gauss map,
    // with the arc of the second solid negated.
    let left1 = dot(&along2, &spread(simd, &normals1[0])).simd_lt(zero);
    let right1 = dot(&along2, &spread(simd, &normals1[1])).simd_lt(zero);
    let left2 = dot(&along1, &normals2[0]).simd_lt(zero);
    let right2 = dot(&along1, &normals2[1]).simd_lt(zero);
    let is_face = (left1 ^ right1) & (left2 ^ right2) & (left2 ^ right1);
    if is_face.to_bitmask() == 0 {
        return None;
    }
    let across = lanes::cross(&along1, &along2);
    let squared = dot(&across, &across);
    let from1: [V; 3] = spread(simd, &edge1.from);
    let away = filled(
        #[inline(always)]
        |axis| V::load(simd, &edges2.from[axis]) - from1[axis],
    );
    let height = dot(&across, &away) / squared.sqrt();
    let outward = left1.select(-height, height);
    // Parallel edges have no common perpendicular; a face normal then has a gap as large.
    let tiny = V::all(simd, N::lit(64.0) * N::EPSILON * N::EPSILON * edge1.squared);
    let is_crossing = squared.simd_gt(dot(&along2, &along2) * tiny);
    Some((is_face & is_crossing).select(outward, V::all(simd, -N::INFINITY)))
}

/// Returns the squared distances of 8 pairs of edges: C. Ericson, "Real-Time Collision
/// Detection" (2005), 5.1.9. An edge without length counts as its first end.
#[inline(always)]
pub(super) fn squared_distances<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    edge1: &ReferenceEdge<N>,
    edges2: &EdgeBlock<N>,
) -> V {
    let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
    let clamp = |share: V| share.larger(zero).smaller(one);
    let (along1, along2): ([V; 3], [V; 3]) =
        (spread(simd, &edge1.along), load(simd, &edges2.along));
    let from1: [V; 3] = spread(simd, &edge1.from);
    let away = filled(
        #[inline(always)]
        |axis| from1[axis] - V::load(simd, &edges2.from[axis]),
    );
    let least = V::all(simd, N::MIN_POSITIVE);
    let squared1 = V::all(simd, edge1.squared).larger(least);
    let squared2 = dot(&along2, &along2).larger(least);
    let (both, toward1, toward2) =
        (dot(&along1, &along2), dot(&along1, &away), dot(&along2, &away));
    let spread = (squared1 * squared2 - both * both).larger(least);
    let share1 = clamp((both * toward2 - toward1 * squared2) / spread);
    let share2 = clamp((both * share1 + toward2) / squared2);
    let share1 = clamp((both * share2 - toward1) / squared1);
    let off: [V; 3] = filled(
        #[inline(always)]
        |axis| away[axis] + along1[axis] * share1 - along2[axis] * share2,
    );
    dot(&off, &off)
}
