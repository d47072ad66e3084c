//! Triangles against one convex hull.

use super::super::triangle_axes::{Axis, AxisKind, Fin, least_sine, noise};
use super::super::triangle_polytope;
use super::{
    Axes, Best, EDGES, Eight, FACE, Faceted, Question, best_face, edging, exchanged, low_byte,
};
use crate::convex::Separation;
use crate::math::lanes::{cross, dot, minus, over, spread, times};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Vector, Wide};
use crate::query::tiles::Tiles;
use crate::shape::Polytope;

/// So many faces have hulls of no more edges than are treated here; see [`triangle_polytope`].
const MOST_FACES: usize = 64;

/// The hull is treated here.
pub(super) fn is_small<N: Real>(hull: &Polytope<N, 3>) -> bool {
    triangle_polytope::is_usual(hull) && hull.faces().len() <= MOST_FACES
}

/// For each face which sides climb over its plane.
type Climbs<M> = [[M; 3]; MOST_FACES];

impl<N: Real> Faceted<N> for Polytope<N, 3> {
    /// Says of triangles that are beyond the limit by a pair of edges that they are not: that is held
    /// against the farthest points first.
    #[inline(always)]
    fn search<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        question: &Question<'_, N>,
        tiles: &Tiles<N, 3>,
    ) -> Axes<N> {
        let eight = Eight::<N, V>::new(simd, question, tiles);
        let none = eight.shrink.simd_lt(eight.shrink);
        let mut climbs = [[none; 3]; MOST_FACES];
        let best = best_of_hull(simd, &eight, self, &mut climbs);
        let beyond = eight.is_beyond(best.gap);
        if low_byte(beyond.to_bitmask()) == u8::MAX {
            return eight.stored(&best, beyond.to_bitmask());
        }
        let (sides, front, has_front) = edging(simd, &eight, &question.pose12.rotation);
        let heights = heights(simd, self, &front, eight.shrink);
        let best = best_face(simd, &eight.corners, &front, has_front, heights, &best);
        let beyond = beyond | eight.is_beyond(best.gap);
        let edging = PacketDirections { sides, front, has_front, asked: !beyond };
        let best = best_edges(simd, &eight, self, &climbs, &edging, best);
        eight.stored(&best, beyond.to_bitmask())
    }

    fn edges(index: usize, _: &Vector<N, 3>) -> AxisKind {
        AxisKind::Edges(u32::try_from(index / 3).expect("32 bits number the edges"), index % 3)
    }

    fn answer(&self, fin: &Fin<'_, N>, axis: Axis<N>, limit: N) -> Option<Separation<N, 3>> {
        triangle_polytope::answer(fin, self, axis, limit)
    }
}

/// The face normals of the hull that leave the largest gaps.
#[inline(always)]
fn best_of_hull<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    eight: &Eight<N, V>,
    hull: &Polytope<N, 3>,
    climbs: &mut Climbs<V::Mask>,
) -> Best<V> {
    let (zero, kind) = (V::all(simd, N::ZERO), V::all(simd, N::lit(FACE)));
    let mut best = Best { gap: -V::all(simd, N::INFINITY), normal: [zero; 3], kind, index: zero };
    let (mut index, one) = (zero, V::all(simd, N::ONE));
    for (face, climbs) in hull.faces().iter().zip(climbs) {
        let outward: [V; 3] = spread(simd, &face.normal);
        let [a, b, c] = &eight.corners;
        let (a, b, c) = (dot(&outward, a), dot(&outward, b), dot(&outward, c));
        let gap = a.smaller(b).smaller(c) - V::all(simd, face.offset) * eight.shrink;
        *climbs = [b.simd_gt(a), c.simd_gt(b), a.simd_gt(c)];
        let normal = [-outward[0], -outward[1], -outward[2]];
        let is_more = gap.simd_gt(best.gap);
        best = exchanged(is_more, Best { gap, normal, kind, index }, &best);
        index += one;
    }
    best
}

/// How low and how high the hull lies along directions.
#[inline(always)]
fn heights<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    hull: &Polytope<N, 3>,
    along: &[V; 3],
    shrink: V,
) -> [V; 2] {
    let mut high = -V::all(simd, N::INFINITY);
    let mut low = -high;
    for vertex in hull.vertices() {
        let height = dot(along, &spread(simd, &vertex.coords));
        (low, high) = (height.smaller(low), height.larger(high));
    }
    [low * shrink, high * shrink]
}

/// The directions of eight triangles.
struct PacketDirections<V, M> {
    sides: [[V; 3]; 3],
    front: [V; 3],
    has_front: M,
    /// Those of which something is asked.
    asked: M,
}

/// Edges of the hull and sides of the triangles, where they leave larger gaps than the faces; their index
/// is three times the edge and the side.
#[inline(always)]
fn best_edges<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    eight: &Eight<N, V>,
    hull: &Polytope<N, 3>,
    climbs: &Climbs<V::Mask>,
    edging: &PacketDirections<V, V::Mask>,
    face: Best<V>,
) -> Best<V> {
    let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
    let (kind, mut index) = (V::all(simd, N::lit(EDGES)), zero - one);
    let least = V::all(simd, least_sine::<N>() * least_sine());
    let (mut best, mut bound) = (face, face.gap + V::all(simd, noise()));
    for edge in hull.edges() {
        let [first, second] = edge.faces.map(|face| &climbs[face as usize]);
        let [from, to] = edge.vertices.map(|end| &hull.vertices()[end as usize].coords);
        let along = times(&spread(simd, &(to - from)), eight.shrink);
        let start = times(&spread(simd, from), eight.shrink);
        // As in the algorithm for one triangle: the triangle lies beyond the side if the edge runs forward.
        let is_forward = dot(&edging.front, &along).simd_ge(zero) | !edging.has_front;
        let is_backward = !dot(&edging.front, &along).simd_ge(zero) | !edging.has_front;
        let least = least * dot(&along, &along);
        for side in 0..3 {
            index += one;
            let outer = (is_forward & first[side]) | (is_backward & !first[side]);
            let is_asked = (first[side] ^ second[side]) & outer & edging.asked;
            if is_asked.to_bitmask() == 0 {
                continue;
            }
            let across = cross(&along, &edging.sides[side]);
            let sign = first[side].select(one, -one);
            let across = times(&across, sign);
            let slack = dot(&across, &minus(&eight.corners[side], &start));
            let squared = dot(&across, &across);
            let length = squared.sqrt();
            let is_more = is_asked
                & (bound.simd_lt(zero) | slack.simd_gt(zero))
                & squared.simd_gt(least)
                & slack.simd_gt(bound * length);
            // Divisions cost more than all of the rest, and few directions are better than those before.
            if is_more.to_bitmask() == 0 {
                continue;
            }
            let normal = over(&across, -length);
            best = exchanged(is_more, Best { gap: slack / length, normal, kind, index }, &best);
            bound = is_more.select(slack / length, bound);
        }
    }
    best
}
