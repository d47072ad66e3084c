//! Triangles against one box.

use fearless_simd::{Level, Select, Simd, SimdMask};

use super::super::triangle_axes::{AxisKind, least_sine, noise};
use super::super::triangle_cuboid;
use super::{
    Axes, Best, EDGES, Eight, FACE, Question, Separations, best_face, edging, exchanged, low_byte,
    parted, times, triangle,
};
use crate::math::lanes::spread;
use crate::math::{Real, Wide};
use crate::query::tiles::{LANES, TiledParts, Tiles};
use crate::shape::{Cuboid, SupportMap};

/// The separations of a box; answers false where the numbers end.
pub(super) fn separations<'a, N: Real>(
    parts: &TiledParts<'_, N, 3>,
    cuboid: &Cuboid<N, 3>,
    question: impl Fn(N) -> Question<'a, N>,
    out: &mut Separations<N, 3>,
) -> bool {
    let question = question(cuboid.reach());
    for (tiles, near) in parts.tiles.iter().zip(parts.near).filter(|(_, near)| **near != 0) {
        let Some(axes) = at(Level::new(), (&question, cuboid), tiles) else { return false };
        for lane in (0..LANES).filter(|lane| near >> lane & 1 == 1) {
            let triangle = triangle(&question, tiles, lane);
            let Some(fin) = axes.fin(lane, &triangle, question.pose12) else { return false };
            let axis = axes.axis(lane, |index, normal| {
                let edge = triangle_cuboid::edge_toward(index % 3, &-normal);
                AxisKind::Edges(edge, index / 3)
            });
            let is_near = axes.beyond >> lane & 1 == 0;
            let answer = || triangle_cuboid::answer(&fin, cuboid, &axis, question.limit);
            out.push(if is_near { answer() } else { None });
        }
    }
    true
}

/// [`search`] with the vectors of an instruction set; the answers do not depend on it.
fn at<N: Real>(
    level: Level,
    asked: (&Question<'_, N>, &Cuboid<N, 3>),
    tiles: &Tiles<N, 3>,
) -> Option<Axes<N>> {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = level.as_avx2() {
        Some(simd.vectorize(
            #[inline(always)]
            || search::<_, N, N::Lanes<_>>(simd, asked, tiles),
        ))
    } else {
        level.as_sse2().map(|simd| {
            simd.vectorize(
                #[inline(always)]
                || search::<_, N, N::Lanes<_>>(simd, asked, tiles),
            )
        })
    }
    #[cfg(not(target_arch = "x86_64"))]
    Some(fearless_simd::dispatch!(level, simd => search::<_, N, N::Lanes<_>>(simd, asked, tiles)))
}

#[inline(always)]
fn search<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    (question, cuboid): (&Question<'_, N>, &Cuboid<N, 3>),
    tiles: &Tiles<N, 3>,
) -> Axes<N> {
    let eight = Eight::<N, V>::new(simd, question, tiles);
    let half = times(&spread(simd, cuboid.half_extents()), eight.shrink);
    let best = best_of_box(simd, &eight, &half);
    let beyond = eight.is_beyond(best.gap);
    if low_byte(beyond.to_bitmask()) == u8::MAX {
        return eight.stored(&best, beyond.to_bitmask());
    }
    let (sides, front, has_front) = edging(simd, &eight, &question.pose12.rotation);
    let reach = front[0].abs() * half[0] + front[1].abs() * half[1] + front[2].abs() * half[2];
    let best = best_face(simd, &eight.corners, (&front, has_front), (-reach, reach), &best);
    let beyond = beyond | eight.is_beyond(best.gap);
    let best = best_edges(simd, &eight, (&half, &sides), best);
    eight.stored(&best, (beyond | eight.is_beyond(best.gap)).to_bitmask())
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
        let heights = (-half[axis], half[axis]);
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
    (half, sides): (&[V; 3], &[[V; 3]; 3]),
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
            let (slack, is_above) = parted([p, q, q], (-reach, reach));
            let sine = (x * x + y * y).sqrt();
            let is_more = slack.simd_gt(bound.smaller(zero))
                & sine.simd_gt(least)
                & slack.simd_gt(bound * sine);
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
