//! Segments and capsules against convex hulls of so few parts that all of them can be looked at.
//!
//! The planes of all faces, eight at a time, tell how far the segment lies above each, and which it climbs
//! over. Over the highest face the lower end is the answer. If it is beside it, edges decide: where the two
//! overlap those between a face that the segment climbs over and one that it does not, which with the segment
//! are the faces of the Minkowski difference; where they are apart the nearest of the edges of faces that are
//! seen from some point of the segment. What is not proved is left to the general algorithm.

use super::super::rod::{Parting, Rod, Verdict, noise, settled};
use super::super::segments::nearest_of_segments;
use super::super::{general, wrong_kinds};
use super::edges::{EdgeBlock, ReferenceEdge, squared_distances};
use super::{BLOCKS, LANES, PLANE_BLOCKS};
use crate::convex::Separation;
use crate::math::lanes::{dot, highest_lane, load, spread, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Point, Real, Vector, Wide, cross, max, min};
use crate::query::Pair;
use crate::shape::{Kind, Polytope, PolytopeEdge, SupportMap};

/// The separation of a segment or capsule from a convex hull.
pub(in crate::query::separation) fn separation<N: Real>(
    pair: &Pair<'_, N, 3>,
    limit: N,
) -> Option<Separation<N, 3>> {
    let Kind::Polytope(hull) = pair.second else { wrong_kinds(pair) };
    let ask = |rod: &Rod<'_, N>, most: N| {
        if has_few_features(hull) {
            SegmentQuery::new(rod, hull).verdict(most)
        } else {
            Verdict::Undecided
        }
    };
    settled(pair, hull.reach(), limit, ask, || general::of_flat_cores(pair, limit))
}

/// A solid with few parts.
fn has_few_features<N: Real>(hull: &Polytope<N, 3>) -> bool {
    let has_room = hull.blocks().len() <= BLOCKS && hull.planes().len() <= PLANE_BLOCKS;
    has_room && hull.faces().len() > 3
}

/// A hull and the segment.
struct SegmentQuery<'a, N: Real> {
    rod: &'a Rod<'a, N>,
    hull: &'a Polytope<N, 3>,
    planes: PlaneHeights<N>,
}

/// What the planes of all faces say.
struct PlaneHeights<N> {
    /// The face that the segment is highest above, the first of equals, and how high.
    face: usize,
    gap: N,
    /// A bit for each face: the second end is higher above its plane than the first.
    climbed: u64,
    /// Some point of the segment is above its plane.
    seen: u64,
}

impl<'a, N: Real> SegmentQuery<'a, N> {
    fn new(rod: &'a Rod<'a, N>, hull: &'a Polytope<N, 3>) -> Self {
        Self { rod, hull, planes: PlaneHeights::of(Level::new(), rod, hull) }
    }

    fn verdict(&self, most: N) -> Verdict<N> {
        let gap = self.planes.gap;
        if gap > most {
            return Verdict::Beyond;
        }
        let found = if gap > N::ZERO {
            self.above().or_else(|| self.nearest())
        } else {
            match self.best_edge(gap + N::TWO * noise()) {
                None => self.above(),
                Some((_, _, height)) if height > N::ZERO => self.nearest(),
                Some((edge, outward, _)) => self.across(edge, outward),
            }
        };
        found.map_or(Verdict::Undecided, Verdict::Parted)
    }

    fn vertex(&self, index: u32) -> Vector<N, 3> {
        self.hull.vertices()[index as usize].coords * self.rod.shrink
    }

    /// How far along a vector the hull reaches.
    fn level(&self, along: &Vector<N, 3>) -> N {
        self.hull.core_support(along).coords.dot(along) * self.rod.shrink
    }

    /// The answer along the normal of the highest face, if the lower end lies over it, or the middle of what
    /// does of a segment along it.
    fn above(&self) -> Option<Parting<N>> {
        let face = &self.hull.faces()[self.planes.face];
        let (first, last) = self.over(&face.normal)?;
        let [a, b] = [self.rod.ends[0].dot(&face.normal), self.rod.ends[1].dot(&face.normal)];
        let on_rod = if (a - b).abs() <= noise() {
            self.rod.at((first + last) * N::HALF)
        } else if a < b && first <= N::ZERO {
            self.rod.ends[0]
        } else if b < a && last >= N::ONE {
            self.rod.ends[1]
        } else {
            return None;
        };
        let (outward, distance) = (face.normal, self.planes.gap);
        Some(Parting { outward, on_rod, on_solid: on_rod - outward * distance, distance })
    }

    /// Where the part of the segment that lies over the highest face begins and ends, as shares of the whole.
    fn over(&self, normal: &Vector<N, 3>) -> Option<(N, N)> {
        let ring = self.hull.face_vertices(&self.hull.faces()[self.planes.face]);
        let (mut first, mut last) = (N::ZERO, N::ONE);
        let mut from = self.vertex(ring[ring.len() - 1]);
        for &vertex in ring {
            let to = self.vertex(vertex);
            let inward = cross(normal, &(to - from));
            let [a, b] = self.rod.ends.map(|end| inward.dot(&(end - from)));
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

    /// The edge that leaves the largest gap, if it is larger than `least`, the direction along which it does, and
    /// the gap.
    fn best_edge(&self, least: N) -> Option<(PolytopeEdge, Vector<N, 3>, N)> {
        let (mut best, mut bound) = (None, least);
        let (end, along) = (&self.rod.ends[0], &self.rod.along);
        for edge in self.hull.edges() {
            let [one, other] = edge.faces;
            if (self.planes.climbed >> one ^ self.planes.climbed >> other) & 1 == 0 {
                continue;
            }
            let [from, to] = edge.vertices.map(|vertex| self.vertex(vertex));
            let across = cross(&(to - from), along);
            let length = across.norm();
            // The edge runs around its first face: out of the hull, its product with what climbs over that.
            let is_out = self.planes.climbed >> one & 1 == 1;
            let height = across.dot(&(end - from));
            let height = if is_out { height } else { -height };
            if length > noise() && height > bound * length {
                bound = height / length;
                best =
                    Some((*edge, if is_out { across / length } else { -across / length }, bound));
            }
        }
        best
    }

    /// The answer along the common perpendicular of the segment and an edge.
    fn across(&self, edge: PolytopeEdge, outward: Vector<N, 3>) -> Option<Parting<N>> {
        let points = self.points_beside(edge);
        self.rod.proved(outward, self.level(&outward), points)
    }

    /// The nearest points of the segment and an edge.
    fn points_beside(&self, edge: PolytopeEdge) -> [Vector<N, 3>; 2] {
        let ends = edge.vertices.map(|vertex| Point::from(self.vertex(vertex)));
        let (on_rod, on_edge) = nearest_of_segments(&self.rod.ends.map(Point::from), &ends);
        [on_rod.coords, on_edge.coords]
    }

    /// The nearest points of the two, which are apart, if they lie on an edge.
    fn nearest(&self) -> Option<Parting<N>> {
        let edge = self.hull.edges()[nearest_edge(Level::new(), self)?];
        let points = self.points_beside(edge);
        let away = points[0] - points[1];
        let [from, to] = edge.vertices.map(|vertex| self.vertex(vertex));
        let across = cross(&(to - from), &self.rod.along);
        let length = across.norm();
        let mut outward = None;
        if length > noise() {
            // The perpendicular is right to the last bits, however near the points are.
            let across = across / length;
            let along = across.dot(&away);
            if (away - across * along).norm_squared() <= noise::<N>() * noise() {
                outward = Some(if along < N::ZERO { -across } else { across });
            }
        }
        if outward.is_none() {
            let length = away.norm();
            outward = (length > noise()).then(|| away / length);
        }
        let outward = outward?;
        self.rod.proved(outward, self.level(&outward), points)
    }
}

impl<N: Real> PlaneHeights<N> {
    /// With the vectors of an instruction set; the answer does not depend on it.
    fn of(level: Level, rod: &Rod<'_, N>, hull: &Polytope<N, 3>) -> Self {
        with_lanes!(level, simd => Self::in_lanes::<_, N::Lanes<_>>(simd, rod, hull))
    }

    #[inline(always)]
    fn in_lanes<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        rod: &Rod<'_, N>,
        hull: &Polytope<N, 3>,
    ) -> Self {
        let [a, b]: [[V; 3]; 2] = [spread(simd, &rod.ends[0]), spread(simd, &rod.ends[1])];
        let (shrink, zero) = (V::all(simd, rod.shrink), V::all(simd, N::ZERO));
        let mut planes = Self { face: 0, gap: -N::INFINITY, climbed: 0, seen: 0 };
        for (number, block) in hull.planes().iter().enumerate() {
            let normals: [V; 3] = load(simd, &block.normals);
            let offsets = V::load(simd, &block.offsets) * shrink;
            let (high1, high2) = (dot(&normals, &a) - offsets, dot(&normals, &b) - offsets);
            let low = high1.smaller(high2);
            planes.climbed |= high2.simd_gt(high1).to_bitmask() << (number * LANES);
            planes.seen |= high1.larger(high2).simd_gt(zero).to_bitmask() << (number * LANES);
            let highest = highest_lane(low);
            if highest > planes.gap {
                let lanes = low.simd_eq(V::all(simd, highest)).to_bitmask();
                planes.face = number * LANES + lanes.trailing_zeros() as usize;
                planes.gap = highest;
            }
        }
        planes
    }
}

/// The edge of a face that is seen that is nearest to the segment, the first of equals.
fn nearest_edge<N: Real>(level: Level, query: &SegmentQuery<'_, N>) -> Option<usize> {
    with_lanes!(level, simd => nearest_in_lanes::<_, N, N::Lanes<_>>(simd, query))
}

#[inline(always)]
fn nearest_in_lanes<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    query: &SegmentQuery<'_, N>,
) -> Option<usize> {
    let (rod, seen) = (query.rod, query.planes.seen);
    let (from, along) = (rod.ends[0], rod.along);
    let rod = ReferenceEdge { index: 0, from, along, squared: along.norm_squared() };
    let mut eight = EdgeBlock::zero();
    let (mut count, mut best, mut least) = (0, None, N::INFINITY);
    let (mut places, mut next) = ([0; LANES], 0);
    let edges = query.hull.edges();
    while next < edges.len() {
        let [one, other] = edges[next].faces;
        if (seen >> one | seen >> other) & 1 == 1 {
            let [from, to] = edges[next].vertices.map(|vertex| query.vertex(vertex));
            for axis in 0..3 {
                eight.from[axis][count] = from[axis];
                eight.along[axis][count] = to[axis] - from[axis];
            }
            places[count] = next;
            count += 1;
        }
        next += 1;
        if count == LANES || next == edges.len() && count > 0 {
            let (mut numbers, found) =
                ([N::ZERO; LANES], squared_distances::<S, N, V>(simd, &rod, &eight));
            found.store(&mut numbers);
            for (squared, &place) in numbers.iter().zip(&places).take(count) {
                if *squared < least {
                    (best, least) = (Some(place), *squared);
                }
            }
            count = 0;
        }
    }
    best
}
