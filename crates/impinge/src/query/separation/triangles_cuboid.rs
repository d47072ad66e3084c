//! Triangles against one box in space, eight side by side: the separating axes of
//! [`triangle_cuboid`], in the same order of operations, so that the answers have the same bits.

use fearless_simd::{Level, Select, Simd, SimdMask};
use smallvec::SmallVec;

use super::triangle_axes::{Axis, AxisKind, Fin, THIN, least_sine, noise};
use super::triangle_cuboid;
use crate::convex::Separation;
use crate::math::lanes::{by_axis, cross, dot, either, load, spread};
use crate::math::{Matrix, Pose, Real, Vector, Wide, max, max_component};
use crate::query::tiles::{LANES, TiledParts, Tiles};
use crate::shape::{Cuboid, Kind, SupportMap, Triangle};

/// The directions are numbered: that of the triangle, the faces of the box, and for each side of the
/// triangle one for each axis of the box.
const KINDS: [f64; 16] =
    [0.0, 1.0, 2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0, 9.0, 10.0, 11.0, 12.0, 13.0, 14.0, 15.0];
const FIRST_FACE: usize = 1;
const FIRST_EDGES: usize = 7;

/// What is found of each of some parts; `None` beyond the limit.
pub(crate) type Separations<N, const D: usize> = SmallVec<[Option<Separation<N, D>>; 16]>;

/// The separations of triangles from a solid, all of which lie at `pose12` in the frame of the triangles
/// as seen from their origin, if there is an algorithm for many of them; answers whether there is.
pub(crate) fn separations3<N: Real>(
    parts: &TiledParts<'_, N, 3>,
    (solid, pose12): (Kind<'_, N, 3>, &Pose<N, 3>),
    limit: N,
    out: &mut Separations<N, 3>,
) -> bool {
    let Kind::Cuboid(cuboid) = solid else { return false };
    if !pose12.is_finite() {
        return false;
    }
    let question = Question { pose12, cuboid, limit, origin: &parts.origin };
    for (tiles, near) in parts.tiles.iter().zip(parts.near) {
        if *near == 0 {
            continue;
        }
        let Some(axes) = at(Level::new(), &question, tiles) else { return false };
        for lane in (0..LANES).filter(|lane| near >> lane & 1 == 1) {
            let Some(found) = question.answer(lane, tiles, &axes) else { return false };
            out.push(found);
        }
    }
    true
}

/// In the plane triangles are filled.
pub(crate) fn separations2<N: Real>(
    _: &TiledParts<'_, N, 2>,
    _: (Kind<'_, N, 2>, &Pose<N, 2>),
    _: N,
    _: &mut Separations<N, 2>,
) -> bool {
    false
}

/// What all triangles are asked.
struct Question<'a, N: Real> {
    pose12: &'a Pose<N, 3>,
    cuboid: &'a Cuboid<N, 3>,
    limit: N,
    origin: &'a Vector<N, 3>,
}

/// The directions that leave the largest gaps.
struct Axes<N> {
    /// A bit for each triangle that is beyond the limit.
    beyond: u8,
    /// The units of each pair; see [`Fin::units`].
    scale: [N; LANES],
    shrink: [N; LANES],
    /// In the frame of the box, in units of the pair.
    corners: [[[N; LANES]; 3]; 3],
    normals: [[N; LANES]; 3],
    gaps: [N; LANES],
    kinds: [N; LANES],
}

impl<N: Real> Question<'_, N> {
    /// What the axis of one triangle says; `None` where the numbers end.
    #[expect(clippy::option_option, reason = "no answer is not the answer that there is none")]
    fn answer(
        &self,
        lane: usize,
        tiles: &Tiles<N, 3>,
        axes: &Axes<N>,
    ) -> Option<Option<Separation<N, 3>>> {
        let units = (axes.scale[lane], axes.shrink[lane]);
        if !(units.0.is_finite_number() && units.1.is_finite_number()) {
            return None;
        }
        if axes.beyond >> lane & 1 == 1 {
            return Some(None);
        }
        let triangle = &Triangle::of_finite(tiles.corners(lane).map(|corner| corner - self.origin));
        let vector = |rows: &[[N; LANES]; 3]| {
            Vector::<N, 3>::new(rows[0][lane], rows[1][lane], rows[2][lane])
        };
        let [a, b, c] = &axes.corners;
        let corners = [vector(a), vector(b), vector(c)];
        let fin = Fin::placed(triangle, self.pose12, corners, units);
        let normal = vector(&axes.normals);
        let kind = match KINDS.iter().position(|&kind| N::lit(kind) == axes.kinds[lane]) {
            Some(face @ FIRST_FACE..FIRST_EDGES) => {
                AxisKind::Face(u32::try_from(face - FIRST_FACE).expect("there are six faces"))
            }
            Some(edges @ FIRST_EDGES..) => {
                let edges = edges - FIRST_EDGES;
                AxisKind::Edges(triangle_cuboid::edge_toward(edges % 3, &-normal), edges / 3)
            }
            _ => AxisKind::Triangle,
        };
        let best = Axis { kind, normal, gap: axes.gaps[lane] };
        Some(triangle_cuboid::answer(&fin, self.cuboid, &best, self.limit))
    }
}

/// [`search`] with the vectors of an instruction set; the answers do not depend on it.
fn at<N: Real>(level: Level, question: &Question<'_, N>, tiles: &Tiles<N, 3>) -> Option<Axes<N>> {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = level.as_avx2() {
        Some(simd.vectorize(
            #[inline(always)]
            || search::<_, N, N::Lanes<_>>(simd, question, tiles),
        ))
    } else {
        level.as_sse2().map(|simd| {
            simd.vectorize(
                #[inline(always)]
                || search::<_, N, N::Lanes<_>>(simd, question, tiles),
            )
        })
    }
    #[cfg(not(target_arch = "x86_64"))]
    Some(
        fearless_simd::dispatch!(level, simd => search::<_, N, N::Lanes<_>>(simd, question, tiles)),
    )
}

/// The best directions so far.
#[derive(Clone, Copy)]
struct Best<V> {
    gap: V,
    normal: [V; 3],
    /// The number of the direction.
    kind: V,
}

/// The triangles in the frame of the box, and half its extents, in units of the pairs.
struct Lanes<V> {
    corners: [[V; 3]; 3],
    half: [V; 3],
}

#[inline(always)]
fn search<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    question: &Question<'_, N>,
    tiles: &Tiles<N, 3>,
) -> Axes<N> {
    let Question { pose12, cuboid, .. } = question;
    let given = seen_from_origin::<S, N, V>(simd, question, tiles);
    let (scales, shrinks) = units(simd, question, &given);
    let (scale, shrink) = (V::load(simd, &scales), V::load(simd, &shrinks));
    let turn = &pose12.rotation;
    let center: [V; 3] = spread(simd, &pose12.translation);
    let mut corners = given;
    for corner in &mut corners {
        *corner = turned(simd, turn, &times(&minus(corner, &center), shrink));
    }
    let half: [V; 3] = spread(simd, cuboid.half_extents());
    let lanes = Lanes { corners, half: times(&half, shrink) };
    let limit = V::all(simd, question.limit) + V::all(simd, N::lit(16.0) * noise::<N>()) * scale;
    let best = best_of_box(simd, &lanes);
    let beyond = (best.gap * scale).simd_gt(limit);
    if low_byte(beyond.to_bitmask()) == u8::MAX {
        return stored((scales, shrinks), &lanes, &best, beyond.to_bitmask());
    }
    let ways = [
        times(&minus(&given[1], &given[0]), shrink),
        times(&minus(&given[2], &given[1]), shrink),
        times(&minus(&given[0], &given[2]), shrink),
    ];
    let (sides, front, has_front) = edging(simd, &ways, turn);
    let best = best_face(simd, &lanes, (&front, has_front), best);
    let beyond = beyond | (best.gap * scale).simd_gt(limit);
    let best = best_edges(simd, &lanes, &sides, best);
    let beyond = beyond | (best.gap * scale).simd_gt(limit);
    stored((scales, shrinks), &lanes, &best, beyond.to_bitmask())
}

/// The corners of the triangles, seen from the common origin.
#[inline(always)]
fn seen_from_origin<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    question: &Question<'_, N>,
    tiles: &Tiles<N, 3>,
) -> [[V; 3]; 3] {
    let origin: [V; 3] = spread(simd, question.origin);
    let corner = [
        load::<S, N, V, 3, LANES>(simd, &tiles.corners[0]),
        load(simd, &tiles.corners[1]),
        load(simd, &tiles.corners[2]),
    ];
    [minus(&corner[0], &origin), minus(&corner[1], &origin), minus(&corner[2], &origin)]
}

/// The units of each pair and their inverses; no numbers where there are none.
#[inline(always)]
fn units<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    question: &Question<'_, N>,
    corners: &[[V; 3]; 3],
) -> ([N; LANES], [N; LANES]) {
    let own = max(question.cuboid.reach(), max_component(&question.pose12.translation));
    let mut most = V::all(simd, own);
    for corner in corners {
        for value in corner {
            most = value.abs().larger(most);
        }
    }
    let (mut sizes, mut shrinks) = ([N::ZERO; LANES], [N::INFINITY; LANES]);
    most.store(&mut sizes);
    for (size, shrink) in sizes.iter_mut().zip(&mut shrinks) {
        let is_plain = *size > N::ZERO && size.is_finite_number();
        let scale = size.power_of_two_below();
        *shrink = if is_plain { N::ONE / scale } else { N::INFINITY };
        *size = scale;
    }
    (sizes, shrinks)
}

#[inline(always)]
fn stored<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    (scale, shrink): ([N; LANES], [N; LANES]),
    lanes: &Lanes<V>,
    best: &Best<V>,
    beyond: u64,
) -> Axes<N> {
    let blank = [N::ZERO; LANES];
    let (mut corners, mut normals, mut gaps) = ([[blank; 3]; 3], [blank; 3], blank);
    for (rows, corner) in corners.iter_mut().zip(&lanes.corners) {
        for (row, values) in rows.iter_mut().zip(corner) {
            values.store(row);
        }
    }
    for (row, values) in normals.iter_mut().zip(&best.normal) {
        values.store(row);
    }
    best.gap.store(&mut gaps);
    let mut kinds = blank;
    best.kind.store(&mut kinds);
    Axes { beyond: low_byte(beyond), scale, shrink, corners, normals, gaps, kinds }
}

fn low_byte(bits: u64) -> u8 {
    let [low, ..] = bits.to_le_bytes();
    low
}

/// The gap that a direction or its opposite leaves, and whether the triangle is the upper one.
#[inline(always)]
fn parted<S: Simd, N: Real, V: Wide<S, Scalar = N>>([a, b, c]: [V; 3], reach: V) -> (V, V::Mask) {
    let (low, high) = (a.smaller(b).smaller(c), a.larger(b).larger(c));
    let (above, below) = (low - reach, -reach - high);
    let is_above = above.simd_gt(below);
    (is_above.select(above, below), is_above)
}

/// The face normals of the box that leave the largest gaps.
#[inline(always)]
fn best_of_box<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, lanes: &Lanes<V>) -> Best<V> {
    let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
    let mut best = Best { gap: -V::all(simd, N::INFINITY), normal: [zero; 3], kind: one };
    for axis in 0..3 {
        let [a, b, c] = &lanes.corners;
        let (gap, is_above) = parted([a[axis], b[axis], c[axis]], lanes.half[axis]);
        let is_more = gap.simd_gt(best.gap);
        let mut normal = [zero; 3];
        normal[axis] = is_above.select(-one, one);
        // The positive side comes first; see `Cuboid`.
        let first = V::all(simd, N::lit(KINDS[FIRST_FACE + 2 * axis]));
        let kind = is_above.select(first, first + one);
        best = exchanged(is_more, Best { gap, normal, kind }, &best);
    }
    best
}

#[inline(always)]
fn exchanged<S: Simd, V: Wide<S>>(is_more: V::Mask, new: Best<V>, old: &Best<V>) -> Best<V> {
    Best {
        gap: is_more.select(new.gap, old.gap),
        normal: either(is_more, &new.normal, &old.normal),
        kind: is_more.select(new.kind, old.kind),
    }
}

/// The directions of the sides, those of the fronts, and which triangles have fronts.
#[inline(always)]
fn edging<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    ways: &[[V; 3]; 3],
    turn: &Matrix<N, 3>,
) -> ([[V; 3]; 3], [V; 3], V::Mask) {
    let squared = [dot(&ways[0], &ways[0]), dot(&ways[1], &ways[1]), dot(&ways[2], &ways[2])];
    let is_second = squared[1].simd_gt(squared[0]);
    let longer = is_second.select(squared[1], squared[0]);
    let is_third = squared[2].simd_gt(longer);
    let longest = is_third.select(squared[2], longer);
    // The two shorter ones, in order.
    let (first, second) = (
        either(is_third, &ways[0], &either(is_second, &ways[2], &ways[1])),
        either(is_third, &ways[1], &either(is_second, &ways[0], &ways[2])),
    );
    let across = cross(&first, &second);
    let area = dot(&across, &across).sqrt();
    let has_front = area.simd_gt(V::all(simd, N::lit(THIN) * N::EPSILON) * longest)
        & longest.simd_gt(V::all(simd, N::MIN_POSITIVE.sqrt()));
    let front = turned(simd, turn, &over(&across, area));
    let all = has_front | !has_front;
    let is_longest = [!is_second & !is_third, is_second & !is_third, is_third & all];
    let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
    let tiny = V::all(simd, N::MIN_POSITIVE / N::EPSILON);
    let mut sides = *ways;
    for at in 0..3 {
        let has_length = (has_front | is_longest[at]) & squared[at].simd_gt(tiny);
        let share = has_length.select(one / squared[at].sqrt(), zero);
        sides[at] = turned(simd, turn, &times(&ways[at], share));
    }
    (sides, front, has_front)
}

/// The triangles' own normals, unless those of faces of the box leave gaps that are larger by more than
/// rounding.
#[inline(always)]
fn best_face<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    lanes: &Lanes<V>,
    (front, has_front): (&[V; 3], V::Mask),
    of_box: Best<V>,
) -> Best<V> {
    let half = &lanes.half;
    let reach = front[0].abs() * half[0] + front[1].abs() * half[1] + front[2].abs() * half[2];
    let [a, b, c] = &lanes.corners;
    let (gap, is_above) = parted([dot(a, front), dot(b, front), dot(c, front)], reach);
    let away = [-front[0], -front[1], -front[2]];
    let own = Best { gap, normal: either(is_above, &away, front), kind: V::all(simd, N::ZERO) };
    let is_less = of_box.gap.simd_gt(gap + V::all(simd, noise()));
    exchanged(has_front & !is_less, own, &of_box)
}

/// Edges of the box and sides of the triangles, where they leave larger gaps than the faces.
#[inline(always)]
fn best_edges<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    lanes: &Lanes<V>,
    sides: &[[V; 3]; 3],
    face: Best<V>,
) -> Best<V> {
    let (zero, half) = (V::all(simd, N::ZERO), &lanes.half);
    let least = V::all(simd, least_sine());
    let (mut best, mut bound) = (face, face.gap + V::all(simd, noise()));
    for (at, side) in sides.iter().enumerate() {
        let (on, off) = (&lanes.corners[at], &lanes.corners[(at + 2) % 3]);
        for (axis, (i1, i2)) in [(1, 2), (2, 0), (0, 1)].into_iter().enumerate() {
            let (x, y) = (-side[i2], side[i1]);
            let (p, q) = (x * on[i1] + y * on[i2], x * off[i1] + y * off[i2]);
            let reach = x.abs() * half[i1] + y.abs() * half[i2];
            let (slack, is_above) = parted([p, q, q], reach);
            let sine = (x * x + y * y).sqrt();
            let is_more = slack.simd_gt(bound.smaller(zero))
                & sine.simd_gt(least)
                & slack.simd_gt(bound * sine);
            let signed = is_above.select(-sine, sine);
            let mut normal = [zero; 3];
            (normal[i1], normal[i2]) = (x / signed, y / signed);
            let kind = V::all(simd, N::lit(KINDS[FIRST_EDGES + 3 * at + axis]));
            let new = Best { gap: slack / sine, normal, kind };
            best = exchanged(is_more, new, &best);
            bound = is_more.select(new.gap, bound);
        }
    }
    best
}

/// Vectors in the frame that a rotation leads from.
#[inline(always)]
fn turned<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    turn: &Matrix<N, 3>,
    v: &[V; 3],
) -> [V; 3] {
    by_axis(
        #[inline(always)]
        |axis| {
            let column: [V; 3] = by_axis(
                #[inline(always)]
                |row| V::all(simd, turn[(row, axis)]),
            );
            dot(&column, v)
        },
    )
}

#[inline(always)]
fn minus<S: Simd, V: Wide<S>>(a: &[V; 3], b: &[V; 3]) -> [V; 3] {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

#[inline(always)]
fn times<S: Simd, V: Wide<S>>(a: &[V; 3], b: V) -> [V; 3] {
    [a[0] * b, a[1] * b, a[2] * b]
}

#[inline(always)]
fn over<S: Simd, V: Wide<S>>(a: &[V; 3], b: V) -> [V; 3] {
    [a[0] / b, a[1] / b, a[2] / b]
}
