//! An edge of each solid: faces of the Minkowski difference where they overlap, nearest points where
//! they are apart.

use super::face::{Meeting, Side};
use super::pool::Asked;
use super::{Found, LANES, noise};
use crate::math::lanes::{self, by_axis, dot, highest_lane, load, spread};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Point, Real, Vector, Wide, cross, unit};
use crate::query::separation::segments::nearest_of_segments;
use crate::shape::PolytopeEdge;

/// An edge of the solid with the face, in its frame.
pub(super) struct Edge<N: Real> {
    pub(super) index: usize,
    pub(super) from: Vector<N, 3>,
    pub(super) along: Vector<N, 3>,
    pub(super) squared: N,
}

/// Eight edges of the other solid, in the same frame.
pub(super) struct Edges<N: Real> {
    pub(super) indices: [u8; LANES],
    pub(super) from: [[N; LANES]; 3],
    pub(super) along: [[N; LANES]; 3],
    pub(super) normals: [[[N; LANES]; 3]; 2],
}

/// As many edges as 32 vertices may have.
pub(super) const MOST_EDGES: usize = 90;

/// The edges that may decide, ascending.
#[derive(Clone, Copy)]
pub(super) struct Chosen {
    indices: [u8; MOST_EDGES],
    len: usize,
}

impl Chosen {
    pub(super) const NONE: Self = Self { indices: [0; MOST_EDGES], len: 0 };

    /// Those that end at one of some vertices, given as bits; `edge_bits` are those of all vertices.
    fn of(edge_bits: &[u128], mut vertices: u32) -> Self {
        let mut bits = 0;
        while vertices != 0 {
            bits |= edge_bits[vertices.trailing_zeros() as usize];
            vertices &= vertices - 1;
        }
        Self::of_bits(bits)
    }

    /// The same of some edges.
    #[inline(always)]
    fn set_among(&mut self, edges: &[PolytopeEdge], some: &[u8], vertices: u32) {
        self.len = 0;
        for &index in some {
            // Written over by the next one if this one is not.
            self.indices[self.len] = index;
            self.len += usize::from(ends_at(&edges[usize::from(index)], vertices));
        }
    }

    /// Those whose numbers are bits.
    pub(super) fn of_bits(bits: u128) -> Self {
        let mut chosen = Self::NONE;
        let [low, high] = halves(bits);
        for (mut rest, first) in [(low, 0), (high, 64)] {
            while rest != 0 {
                let [index, ..] = (rest.trailing_zeros() + first).to_le_bytes();
                chosen.indices[chosen.len] = index;
                chosen.len += 1;
                rest &= rest - 1;
            }
        }
        chosen
    }

    pub(super) fn bits(&self) -> u128 {
        self.indices().iter().fold(0, |bits, &index| bits | 1 << index)
    }

    pub(super) fn indices(&self) -> &[u8] {
        &self.indices[..self.len]
    }
}

/// The lower and the upper half of some bits.
#[expect(clippy::cast_possible_truncation, reason = "the halves are what is wanted")]
const fn halves(bits: u128) -> [u64; 2] {
    [bits as u64, (bits >> 64) as u64]
}

/// An edge ends at one of some vertices, given as bits.
#[inline(always)]
fn ends_at(edge: &PolytopeEdge, vertices: u32) -> bool {
    (vertices >> edge.vertices[0] | vertices >> edge.vertices[1]) & 1 == 1
}

/// An edge of each solid that are a face of the Minkowski difference.
pub(super) struct Crossing<N> {
    edges: [usize; 2],
    /// How far it parts the solids.
    pub(super) height: N,
}

impl<N: Real> Meeting<'_, '_, N> {
    /// The edges of each solid that may hold the points of the answer, if these are no farther from
    /// each other than `reach`: along the normal, points of one are hardly beyond all points of the
    /// other. Of those that are known to be all that decide, if this is what is known.
    #[inline(always)]
    fn choose<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        asked: Asked<N>,
        [chosen1, chosen2]: &mut [Chosen; 2],
    ) {
        self.asked.set(self.asked.get().and(asked));
        let pool = match &self.pool {
            Some(pool) if pool.serves(asked) => pool,
            _ => {
                [*chosen1, *chosen2] = self.within_reach::<S, V>(simd, asked.reach);
                return;
            }
        };
        let [own, other] = self.near::<S, V>(simd, asked.reach);
        chosen1.set_among(self.own.solid.edges, pool.own.indices(), own);
        chosen2.set_among(self.other.solid.edges, pool.other.indices(), other);
    }

    /// [`Self::choose`] of all edges.
    #[inline(always)]
    pub(super) fn within_reach<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        reach: N,
    ) -> [Chosen; 2] {
        let [own, other] = self.near::<S, V>(simd, reach);
        [Chosen::of(self.own.solid.edge_bits, own), Chosen::of(self.other.solid.edge_bits, other)]
    }

    /// The vertices of each solid within reach, as bits.
    #[inline(always)]
    fn near<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, reach: N) -> [u32; 2] {
        let slack = N::lit(4.0) * noise();
        let (least, most) = (self.other.heights.low - reach - slack, self.level() + reach + slack);
        [self.own.heights.up_to::<S, V>(simd, -least), self.other.heights.up_to::<S, V>(simd, most)]
    }

    #[inline(always)]
    fn ends(side: &Side<'_, '_, N>, index: usize) -> [Vector<N, 3>; 2] {
        let [from, to] = side.solid.edges[index].vertices;
        [side.cloud.at(from as usize), side.cloud.at(to as usize)]
    }

    #[inline(always)]
    pub(super) fn edge(&self, index: usize) -> Edge<N> {
        let [from, to] = Self::ends(&self.own, index);
        let along = to - from;
        Edge { index, from, along, squared: along.norm_squared() }
    }

    /// Up to eight edges of the other solid, with the normals of the faces beside them where these are asked
    /// for. The rest are copies of the first, and with normals points without a direction.
    #[inline(always)]
    pub(super) fn edges<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        chosen: &[u8],
        with_normals: bool,
    ) -> Edges<N> {
        let zero = [[N::ZERO; LANES]; 3];
        let mut edges = Edges { indices: [0; LANES], from: zero, along: zero, normals: [zero; 2] };
        let (mut ends, mut local) = (zero, [zero; 2]);
        for (lane, &index) in chosen.iter().enumerate().take(LANES) {
            let edge = &self.other.solid.edges[usize::from(index)];
            edges.indices[lane] = index;
            let [from, to] = edge.vertices.map(|vertex| self.other.cloud.at(vertex as usize));
            for axis in 0..3 {
                (edges.from[axis][lane], ends[axis][lane]) = (from[axis], to[axis]);
            }
            if with_normals {
                let [one, other] = edge.faces.map(|face| self.other.solid.normal(face as usize));
                for axis in 0..3 {
                    (local[0][axis][lane], local[1][axis][lane]) = (one[axis], other[axis]);
                }
            }
        }
        if with_normals {
            for (local, normals) in local.iter().zip(&mut edges.normals) {
                let turned = self.place.turned::<S, V>(simd, &load(simd, local));
                (0..3).for_each(|axis| turned[axis].store(&mut normals[axis]));
            }
        } else {
            for lane in chosen.len()..LANES {
                edges.indices[lane] = edges.indices[0];
                for (from, ends) in edges.from.iter_mut().zip(&mut ends) {
                    (from[lane], ends[lane]) = (from[0], ends[0]);
                }
            }
        }
        for (axis, ends) in ends.iter().enumerate() {
            let along = V::load(simd, ends) - V::load(simd, &edges.from[axis]);
            along.store(&mut edges.along[axis]);
        }
        edges
    }

    /// The face of the Minkowski difference between an edge of each solid that parts the solids most,
    /// if by more than the face does, and more than noise.
    #[inline(always)]
    pub(super) fn crossing<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        reach: N,
    ) -> Option<Crossing<N>> {
        let mut chosen = [Chosen::NONE; 2];
        self.choose::<S, V>(simd, Asked::crossing(reach), &mut chosen);
        let [chosen1, chosen2] = &chosen;
        let (mut best, mut least): (Option<Crossing<N>>, N) =
            (None, self.height() + N::TWO * noise());
        for eight in chosen2.indices().chunks(LANES) {
            let edges2 = self.edges::<S, V>(simd, eight, true);
            for &index in chosen1.indices() {
                let edge1 = self.edge(usize::from(index));
                let [face1, face2] = self.own.solid.edges[edge1.index].faces;
                let (face1, face2) = (face1 as usize, face2 as usize);
                let normals1 = [self.own.solid.normal(face1), self.own.solid.normal(face2)];
                let heights = heights::<S, N, V>(simd, (&edge1, &normals1), &edges2);
                let Some(heights) = heights else { continue };
                let highest = highest_lane(heights);
                let is_before = |best: &Crossing<N>| best.edges[0] > edge1.index;
                if highest > least || highest == least && best.as_ref().is_some_and(is_before) {
                    let is_highest = heights.simd_eq(V::all(simd, highest)).to_bitmask();
                    let lane = is_highest.trailing_zeros() as usize;
                    let edges = [edge1.index, usize::from(edges2.indices[lane])];
                    (best, least) = (Some(Crossing { edges, height: highest }), highest);
                }
            }
        }
        best
    }

    /// The answer where the common perpendicular of two edges meets both, if it is proved.
    #[inline(always)]
    pub(super) fn across<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        crossing: &Crossing<N>,
    ) -> Option<Found<N>> {
        let (points, across) = self.of_edges(crossing.edges);
        let (normal, _) = unit(&across)?;
        let beside = self.own.solid.edges[crossing.edges[0]].faces;
        let [normal1, normal2] = beside.map(|face| self.own.solid.normal(face as usize));
        let is_outward = normal.dot(&(normal1 + normal2)) > N::ZERO;
        self.proved::<S, V>(simd, &if is_outward { normal } else { -normal }, points)
    }

    /// The nearest points of the edges of two solids that are apart, if supporting planes prove them.
    #[inline(always)]
    pub(super) fn nearest<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        reach: N,
    ) -> Option<Found<N>> {
        let mut chosen = [Chosen::NONE; 2];
        self.choose::<S, V>(simd, Asked::nearest(reach), &mut chosen);
        let [chosen1, chosen2] = &chosen;
        let (mut nearest, mut least): (Option<[usize; 2]>, N) = (None, N::INFINITY);
        for eight in chosen2.indices().chunks(LANES) {
            let edges2 = self.edges::<S, V>(simd, eight, false);
            for &index in chosen1.indices() {
                let edge1 = self.edge(usize::from(index));
                let squares = squares::<S, N, V>(simd, &edge1, &edges2);
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
        let (points, across) = self.of_edges(nearest?);
        let [on_own, on_other] = points;
        let away = on_other - on_own;
        // The perpendicular of the edges is right to the last bits, however near the points are.
        let is_across = |across: &Vector<N, 3>| {
            (away - across * across.dot(&away)).norm_squared() <= noise::<N>() * noise()
        };
        let normal = match unit(&across).map(|(across, _)| across).filter(is_across) {
            Some(across) if across.dot(&away) < N::ZERO => -across,
            Some(across) => across,
            None => unit(&away)?.0,
        };
        self.proved::<S, V>(simd, &normal, points)
    }

    /// The nearest points of two edges, and a vector perpendicular to both, to either side.
    fn of_edges(&self, [edge1, edge2]: [usize; 2]) -> ([Vector<N, 3>; 2], Vector<N, 3>) {
        let (ends1, ends2) = (Self::ends(&self.own, edge1), Self::ends(&self.other, edge2));
        let (point1, point2) =
            nearest_of_segments(&ends1.map(Point::from), &ends2.map(Point::from));
        let across = cross(&(ends1[1] - ends1[0]), &(ends2[1] - ends2[0]));
        ([point1.coords, point2.coords], across)
    }

    /// The answer along a unit vector, if it is proved: two points lie along it as far apart as
    /// supporting planes.
    #[inline(always)]
    fn proved<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        normal: &Vector<N, 3>,
        [on_own, on_other]: [Vector<N, 3>; 2],
    ) -> Option<Found<N>> {
        let low = self.other.cloud.low::<S, V>(simd, normal);
        let high = -self.own.cloud.low::<S, V>(simd, &-normal);
        let distance = low - high;
        let off = on_other - on_own - normal * distance;
        let is_proved = off.norm_squared() <= N::lit(4.0) * noise::<N>() * noise();
        is_proved.then_some(Found { distance, normal: *normal, on_own, on_other })
    }
}

/// How far eight pairs of edges part the solids: those that are a face of the Minkowski difference, the
/// others by minus infinity; `None` if no pair is one.
#[inline(always)]
fn heights<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    (edge1, normals1): (&Edge<N>, &[Vector<N, 3>; 2]),
    edges2: &Edges<N>,
) -> Option<V> {
    let zero = V::all(simd, N::ZERO);
    let (along1, along2): ([V; 3], [V; 3]) =
        (spread(simd, &edge1.along), load(simd, &edges2.along));
    // The arcs between the normals of each edge cross on the sphere of normals, those of the second
    // solid turned round.
    let left1 = dot(&along2, &spread(simd, &normals1[0])).simd_lt(zero);
    let right1 = dot(&along2, &spread(simd, &normals1[1])).simd_lt(zero);
    let left2 = dot(&along1, &load::<_, _, V, 3, LANES>(simd, &edges2.normals[0])).simd_lt(zero);
    let right2 = dot(&along1, &load::<_, _, V, 3, LANES>(simd, &edges2.normals[1])).simd_lt(zero);
    let is_face = (left1 ^ right1) & (left2 ^ right2) & (left2 ^ right1);
    if is_face.to_bitmask() == 0 {
        return None;
    }
    let across = lanes::cross(&along1, &along2);
    let squared = dot(&across, &across);
    let from1: [V; 3] = spread(simd, &edge1.from);
    let away = by_axis(
        #[inline(always)]
        |axis| V::load(simd, &edges2.from[axis]) - from1[axis],
    );
    let height = dot(&across, &away) / squared.sqrt();
    let outward = left1.select(-height, height);
    // Parallel edges have no perpendicular, and faces that part as much.
    let tiny = V::all(simd, N::lit(64.0) * N::EPSILON * N::EPSILON * edge1.squared);
    let is_crossing = squared.simd_gt(dot(&along2, &along2) * tiny);
    Some((is_face & is_crossing).select(outward, V::all(simd, -N::INFINITY)))
}

/// The squared distances of eight pairs of edges: C. Ericson, "Real-Time Collision Detection" (2005),
/// 5.1.9. Edges of no length count as their first ends.
#[inline(always)]
pub(super) fn squares<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    edge1: &Edge<N>,
    edges2: &Edges<N>,
) -> V {
    let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
    let clamp = |share: V| share.larger(zero).smaller(one);
    let (along1, along2): ([V; 3], [V; 3]) =
        (spread(simd, &edge1.along), load(simd, &edges2.along));
    let from1: [V; 3] = spread(simd, &edge1.from);
    let away = by_axis(
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
    let off: [V; 3] = by_axis(
        #[inline(always)]
        |axis| away[axis] + along1[axis] * share1 - along2[axis] * share2,
    );
    dot(&off, &off)
}
