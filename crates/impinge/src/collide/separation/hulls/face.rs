//! Reference face of the separating axis test, and the search for the lowest point of the other
//! solid over this face.

use core::ops::ControlFlow;

use super::polyhedral::Polyhedral;
use super::rounding_error;
use super::vertices::{Heights, Vertices, height_above};
use crate::collide::separation::segments::nearest::nearest_on_segment;
use crate::convex::Separation;
use crate::math::simd::Simd;
use crate::math::{Mapped, Point, Pose, Real, Vector, Wide, cross, max, min};

/// One of the two solids, in the frame of the solid with the reference face.
pub(super) struct LocalSolid<'s, 'a, N: Real> {
    pub(super) solid: &'s Polyhedral<'a, N>,
    /// Vertices in the frame of the reference face, in units of the pair.
    pub(super) vertices: &'s Vertices<N>,
    /// Heights of the vertices: of the other solid along the normal of the face, of the face's own
    /// solid along the negated normal.
    pub(super) heights: Heights<N>,
}

/// The reference face, with both solids: of all faces of both solids, the face with the largest
/// signed height of the other solid above it.
pub(super) struct ReferenceFace<'s, 'a, N: Real> {
    pub(super) own: LocalSolid<'s, 'a, N>,
    pub(super) other: LocalSolid<'s, 'a, N>,
    /// Pose of the other solid in the frame of the face's own solid.
    pub(super) pose: Pose<N, 3>,
    /// Index of the face in its solid.
    index: usize,
    /// Outward unit normal of the face.
    normal: Vector<N, 3>,
    /// Factor from lengths of the shapes to units of the pair.
    shrink: N,
}

/// Result of the search for the lowest point of the other solid along the normal of the face.
enum LowestPoint<N: Real> {
    /// A lowest point that projects into the face, up to rounding.
    Over(Vector<N, 3>),
    /// No lowest point projects into the face. Holds the smallest distance of a lowest vertex from
    /// the face, which is an upper bound of the distance of the solids, or of their depth.
    Beside(N),
}

impl<'s, 'a, N: Real> ReferenceFace<'s, 'a, N> {
    /// Creates the reference face with index `index` of the first solid; the vertices of both
    /// solids are in the frame of the first.
    #[inline(always)]
    pub(super) fn new<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        index: usize,
        [(own, own_vertices), (other, other_vertices)]: [(&'s Polyhedral<'a, N>, &'s Vertices<N>);
            2],
        pose: Pose<N, 3>,
        shrink: N,
    ) -> Self {
        let normal = own.normal(index);
        let heights = own_vertices.heights::<S, V>(simd, &-normal);
        let own = LocalSolid { solid: own, vertices: own_vertices, heights };
        let heights = other_vertices.heights::<S, V>(simd, &normal);
        let other = LocalSolid { solid: other, vertices: other_vertices, heights };
        Self { own, other, pose, index, normal, shrink }
    }
}

impl<N: Real> ReferenceFace<'_, '_, N> {
    /// Returns the separation; `None` unless supporting planes prove it.
    ///
    /// Edges are not queried if a lowest point of the other solid lies over the face and above its
    /// plane. Otherwise they are queried up to twice: first the few near the plane, which are
    /// enough for most pairs, then all within the bound of [`LowestPoint::Beside`]. Closures are
    /// avoided because they are not inlined into vector code.
    #[inline(always)]
    pub(super) fn resolve<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
    ) -> Option<Separation<N, 3>> {
        let separation = self.separation();
        let (over, max_distances) = match self.lowest_point(self.lowest_vertices::<S, V>(simd)) {
            LowestPoint::Over(point) if separation > N::ZERO => return Some(self.at(&point)),
            LowestPoint::Over(point) => (Some(self.at(&point)), [-separation; 2]),
            LowestPoint::Beside(max_distance) if separation > N::ZERO => {
                (None, [min(separation * N::TWO + N::lit(1.0 / 16.0), max_distance), max_distance])
            }
            LowestPoint::Beside(max_distance) => {
                (None, [-separation, max(max_distance, -separation)])
            }
        };
        for max_distance in max_distances {
            let is_last = max_distance >= max_distances[1];
            if let ControlFlow::Break(found) =
                self.within::<S, V>(simd, max_distance, is_last, over)
            {
                return found;
            }
        }
        None
    }

    /// Queries the edges within `max_distance` of the plane. Breaks with the separation that they
    /// determine, or with `over`, the separation along the face's normal, if it is `Some` and no
    /// pair of edges has a larger signed distance. Otherwise continues. If `is_last` is `true`, it
    /// always breaks: with [`Self::nearly_over`] if no pair of edges has a larger signed distance,
    /// else with `None` if no result is proved.
    #[inline(always)]
    fn within<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        max_distance: N,
        is_last: bool,
        over: Option<Separation<N, 3>>,
    ) -> ControlFlow<Option<Separation<N, 3>>> {
        let mut are_apart = self.separation() > N::ZERO;
        if !are_apart {
            let Some(query) = self.query_edges::<S, V>(simd, max_distance) else {
                return if over.is_some() {
                    ControlFlow::Break(over)
                } else if is_last {
                    ControlFlow::Break(self.nearly_over::<S, V>(simd))
                } else {
                    ControlFlow::Continue(())
                };
            };
            let found = self.edge_contact::<S, V>(simd, &query);
            if let Some(found) = found
                && (is_last || self.is_certain::<S, V>(simd, &found))
            {
                return ControlFlow::Break(Some(found));
            }
            are_apart = found.is_none() && query.separation > N::ZERO;
        }
        let found = if are_apart { self.nearest_edges::<S, V>(simd, max_distance) } else { None };
        let is_decided = found.is_some() || is_last;
        if is_decided { ControlFlow::Break(found) } else { ControlFlow::Continue(()) }
    }

    /// Returns whether no farther edge can improve a separation found by edges. This holds if the
    /// solids are apart. It also holds if both solids contain the middle of the two points of the
    /// separation, because edges farther from the plane than the depth along the face's normal
    /// cannot be better.
    #[inline(always)]
    fn is_certain<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        found: &Separation<N, 3>,
    ) -> bool {
        let middle = (found.point1.coords + found.point2.coords) * N::HALF;
        found.distance > N::ZERO || self.is_common::<S, V>(simd, &middle)
    }

    /// Returns whether both solids contain a point, up to rounding.
    #[inline(always)]
    fn is_common<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, point: &Vector<N, 3>) -> bool {
        let in_other = self.pose.rotation.tr_mul(&(point - self.pose.translation));
        let (own, other) = (self.own.solid.planes, self.other.solid.planes);
        height_above::<S, N, V>(simd, own, self.shrink, point) <= rounding_error()
            && height_above::<S, N, V>(simd, other, self.shrink, &in_other) <= rounding_error()
    }

    /// Returns the signed height of the other solid above the plane of the face.
    pub(super) fn separation(&self) -> N {
        self.other.heights.low - self.offset()
    }

    /// Returns the offset of the face's plane along its normal, in units of the pair.
    pub(super) fn offset(&self) -> N {
        self.own.solid.offset(self.index) * self.shrink
    }

    /// Returns the separation along the normal of the face, at a point of the other solid that
    /// projects into the face.
    fn at(&self, point: &Vector<N, 3>) -> Separation<N, 3> {
        let distance = self.separation();
        let (point1, point2) = (Point::from(point - self.normal * distance), Point::from(*point));
        Separation { distance, normal: self.normal, point1, point2 }
    }

    /// Returns the first vertex in the mask `lowest` that projects into the face or, if there is
    /// none, another lowest point, computed by [`Self::point_among`]. [`LowestPoint::Beside`] if no
    /// lowest point projects into the face.
    fn lowest_point(&self, lowest: u32) -> LowestPoint<N> {
        let (mut max_distance, mut rest) = (N::INFINITY, lowest);
        while rest != 0 {
            let point = self.other.vertices.at(rest.trailing_zeros() as usize);
            match self.distance_beside(&point) {
                None => return LowestPoint::Over(point),
                Some(beside) => max_distance = min(beside, max_distance),
            }
            rest &= rest - 1;
        }
        let among = if lowest.count_ones() > 1 { self.point_among(lowest) } else { None };
        among.map_or(LowestPoint::Beside(max_distance), LowestPoint::Over)
    }

    /// Returns the bits of the lowest vertices of the other solid, up to rounding.
    #[inline(always)]
    fn lowest_vertices<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> u32 {
        self.other.heights.up_to::<S, V>(simd, self.other.heights.low + rounding_error())
    }

    /// Returns the separation along the face's normal if the lowest vertex projects beside the
    /// face, but no pair of edges is better than the face by more than rounding. Then an edge of
    /// the other solid is nearly parallel to the face, and a point of it that is as low, up to
    /// rounding, lies over the face. `None` if there is no such edge.
    #[inline(always)]
    fn nearly_over<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S) -> Option<Separation<N, 3>> {
        let most = self.other.heights.low + N::lit(3.0) * rounding_error();
        let low = self.other.heights.up_to::<S, V>(simd, most);
        let is_low = |vertex: u32| low >> vertex & 1 == 1;
        for edge in self.other.solid.edges {
            let [from, to] = edge.vertices;
            if !is_low(from) && !is_low(to) {
                continue;
            }
            let ends = if is_low(from) { [from, to] } else { [to, from] };
            let [from, to] = ends.mapped(|vertex| self.other.vertices.at(vertex as usize));
            let Some((share, _)) = self.span([from, to]) else { continue };
            let point = from + (to - from) * share;
            if self.normal.dot(&point) <= most {
                return Some(self.at(&point));
            }
        }
        None
    }

    /// Iterates over the sides of the face: their ends, and the inward normals of their side
    /// planes. A side face of a triangle is one edge in both directions; it also gets planes
    /// perpendicular to the edge at both ends.
    fn sides(&self) -> impl Iterator<Item = ([Vector<N, 3>; 2], Vector<N, 3>)> {
        let ring = self.own.solid.ring(self.index);
        let at = |vertex: u32| self.own.vertices.at(vertex as usize);
        let mut from = at(ring[ring.len() - 1]);
        let around = ring.iter().map(move |&vertex| {
            let to = at(vertex);
            let ends = [core::mem::replace(&mut from, to), to];
            (ends, cross(&self.normal, &(ends[1] - ends[0])))
        });
        let caps = if ring.len() == 2 { [[0, 1], [1, 0]].as_slice() } else { &[] };
        let across = caps.iter().map(move |&[end, other]| {
            let end = at(ring[end]);
            ([end; 2], at(ring[other]) - end)
        });
        around.chain(across)
    }

    /// Returns the distance from the face of a point that projects beside it; `None` for a point
    /// that projects into it, up to rounding.
    fn distance_beside(&self, point: &Vector<N, 3>) -> Option<N> {
        let mut least: Option<N> = None;
        for (ends, inward) in self.sides() {
            let inside = inward.dot(&(point - ends[0]));
            let is_beside = inside < N::ZERO
                && inside * inside
                    > rounding_error::<N>() * rounding_error() * inward.norm_squared();
            if is_beside {
                let nearest = nearest_on_segment(&ends.mapped(Point::from), &Point::from(*point)).0;
                let squared = (point - nearest.coords).norm_squared();
                least = Some(least.map_or(squared, |least| min(squared, least)));
            }
        }
        least.map(N::sqrt)
    }

    /// Returns a lowest point of the other solid over the reference face. If an edge with both ends
    /// in the mask `lowest` lies partly over the face, it is the middle of that part. Otherwise it
    /// is the point above the face's first corner, on a face whose vertices are all in the mask.
    /// `None` if there is no such point.
    fn point_among(&self, lowest: u32) -> Option<Vector<N, 3>> {
        let solid = self.other.solid;
        let is_lowest = |vertex: &u32| lowest >> *vertex & 1 == 1;
        let edges = solid.edges.iter().filter(|edge| edge.vertices.iter().all(is_lowest));
        let mut crossing = edges.filter_map(|edge| {
            self.clipped(edge.vertices.mapped(|vertex| self.other.vertices.at(vertex as usize)))
        });
        if let Some(point) = crossing.next() {
            return Some(point);
        }
        let corner = self.own.vertices.at(self.own.solid.ring(self.index)[0] as usize);
        // A triangle's side faces have no area.
        let has_area = |face: &usize| solid.ring(*face).len() > 2;
        let is_low = |face: &usize| solid.ring(*face).iter().all(is_lowest);
        let mut faces = (0..solid.faces()).filter(has_area).filter(is_low);
        faces
            .any(|face| self.is_under(face, &corner))
            .then(|| corner + self.normal * self.separation())
    }

    /// Returns the middle of the part of an edge that lies over the face; `None` if there is none.
    fn clipped(&self, [a, b]: [Vector<N, 3>; 2]) -> Option<Vector<N, 3>> {
        let (from, to) = self.span([a, b])?;
        Some(a + (b - a) * ((from + to) * N::HALF))
    }

    /// Returns the interval of an edge that lies over the face, as parameters from 0 at `a` to 1 at
    /// `b`. `None` if it is empty.
    fn span(&self, [a, b]: [Vector<N, 3>; 2]) -> Option<(N, N)> {
        let (mut from, mut to) = (N::ZERO, N::ONE);
        for (ends, inward) in self.sides() {
            let [inside1, inside2] = [a, b].mapped(|end| inward.dot(&(end - ends[0])));
            if inside1 < N::ZERO && inside2 < N::ZERO {
                return None;
            }
            if (inside1 < N::ZERO) != (inside2 < N::ZERO) {
                let at = inside1 / (inside1 - inside2);
                (from, to) =
                    if inside1 < N::ZERO { (max(at, from), to) } else { (from, min(at, to)) };
            }
        }
        (from <= to).then_some((from, to))
    }

    /// Returns whether a face of the other solid, coplanar with this one, covers a point.
    fn is_under(&self, face: usize, point: &Vector<N, 3>) -> bool {
        let ring = self.other.solid.ring(face);
        let at = |corner: usize| self.other.vertices.at(ring[corner % ring.len()] as usize);
        // The covering face has the opposite normal, so its ring is clockwise about this face's
        // normal.
        (0..ring.len()).all(|corner| {
            let (from, to) = (at(corner), at(corner + 1));
            cross(&self.normal, &(to - from)).dot(&(point - from)) <= N::ZERO
        })
    }
}
