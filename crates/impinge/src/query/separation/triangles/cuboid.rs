//! Triangles against one box.

use super::super::triangle_axes::{Axis, AxisKind, Fin, least_sine, noise};
use super::super::triangle_cuboid;
use super::{
    Axes, Best, EDGES, Eight, FACE, Faceted, Question, best_face, edging, exchanged, low_byte,
    parted,
};
use crate::convex::Separation;
use crate::math::lanes::{spread, times};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Vector, Wide};
use crate::query::tiles::Tiles;
use crate::shape::Cuboid;

impl<N: Real> Faceted<N> for Cuboid<N, 3> {
    #[inline(always)]
    fn search<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        question: &Question<'_, N>,
        tiles: &Tiles<N, 3>,
    ) -> Axes<N> {
        let eight = Eight::<N, V>::new(simd, question, tiles);
        let half = times(&spread(simd, self.half_extents()), eight.shrink);
        let best = best_of_box(simd, &eight, &half);
        let beyond = eight.is_beyond(best.gap);
        if low_byte(beyond.to_bitmask()) == u8::MAX {
            return eight.stored(&best, beyond.to_bitmask());
        }
        let (sides, front, has_front) = edging(simd, &eight, &question.pose12.rotation);
        let reach = front[0].abs() * half[0] + front[1].abs() * half[1] + front[2].abs() * half[2];
        let best = best_face(simd, &eight.corners, &front, has_front, [-reach, reach], &best);
        let beyond = beyond | eight.is_beyond(best.gap);
        let best = best_edges(simd, &eight, &half, &sides, best);
        eight.stored(&best, (beyond | eight.is_beyond(best.gap)).to_bitmask())
    }

    fn edges(index: usize, normal: &Vector<N, 3>) -> AxisKind {
        AxisKind::Edges(triangle_cuboid::edge_toward(index % 3, &-normal), index / 3)
    }

    fn answer(&self, fin: &Fin<'_, N>, axis: Axis<N>, limit: N) -> Option<Separation<N, 3>> {
        triangle_cuboid::answer(fin, self, &axis, limit)
    }
}

/// The face normals of the box that leave the largest gaps.
#[inline(always)]
fn best_of_box<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    eight: &Eight<N, V>,
    half: &[V; 3],
) -> Best<V> {
    let (zero, one, kind) =
        (V::all(simd, N::ZERO), V::all(simd, N::ONE), V::all(simd, N::lit(FACE)));
    let mut best = Best { gap: -V::all(simd, N::INFINITY), normal: [zero; 3], kind, index: zero };
    for axis in 0..3 {
        let [a, b, c] = &eight.corners;
        let heights = [-half[axis], half[axis]];
        let (gap, is_above) = parted([a[axis], b[axis], c[axis]], heights);
        let is_more = gap.simd_gt(best.gap);
        let mut normal = [zero; 3];
        normal[axis] = is_above.select(-one, one);
        // The positive side comes first; see `Cuboid`.
        let first = V::all(simd, N::lit([0.0, 2.0, 4.0][axis]));
        let index = is_above.select(first, first + one);
        best = exchanged(is_more, Best { gap, normal, kind, index }, &best);
    }
    best
}

/// Edges of the box and sides of the triangles, where they leave larger gaps than the faces; their index
/// is three times the side and the axis.
#[inline(always)]
fn best_edges<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    eight: &Eight<N, V>,
    half: &[V; 3],
    sides: &[[V; 3]; 3],
    face: Best<V>,
) -> Best<V> {
    let (zero, kind) = (V::all(simd, N::ZERO), V::all(simd, N::lit(EDGES)));
    let least = V::all(simd, least_sine());
    let (mut best, mut bound) = (face, face.gap + V::all(simd, noise()));
    for (at, side) in sides.iter().enumerate() {
        let (on, off) = (&eight.corners[at], &eight.corners[(at + 2) % 3]);
        for (axis, (i1, i2)) in [(1, 2), (2, 0), (0, 1)].into_iter().enumerate() {
            let (x, y) = (-side[i2], side[i1]);
            let (p, q) = (x * on[i1] + y * on[i2], x * off[i1] + y * off[i2]);
            let reach = x.abs() * half[i1] + y.abs() * half[i2];
            let (slack, is_above) = parted([p, q, q], [-reach, reach]);
            let sine = (x * x + y * y).sqrt();
            let is_more = slack.simd_gt(bound.smaller(zero))
                & sine.simd_gt(least)
                & slack.simd_gt(bound * sine);
            // Divisions cost more than all of the rest, and few directions are better than those before.
            if is_more.to_bitmask() == 0 {
                continue;
            }
            let signed = is_above.select(-sine, sine);
            let mut normal = [zero; 3];
            (normal[i1], normal[i2]) = (x / signed, y / signed);
            let index = [[0.0, 1.0, 2.0], [3.0, 4.0, 5.0], [6.0, 7.0, 8.0]][at][axis];
            let index = V::all(simd, N::lit(index));
            best = exchanged(is_more, Best { gap: slack / sine, normal, kind, index }, &best);
            bound = is_more.select(slack / sine, bound);
        }
    }
    best
}
