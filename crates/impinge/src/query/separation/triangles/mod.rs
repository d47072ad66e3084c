//! Triangles against one solid with flat faces in space, eight side by side.
//!
//! The separating axes are those of [`triangle_cuboid`](super::triangle_cuboid) and
//! [`triangle_polytope`](super::triangle_polytope), in the same order of operations, so that the answers
//! have the same bits.

mod ball;
mod cuboid;
mod meeting;
mod polytope;

pub(crate) use self::ball::{BallQuestion, Sighted, sighted};
pub(crate) use self::meeting::{gaps2, gaps3};

use super::triangle_axes::{Axis, AxisKind, Fin, THIN, noise};
use crate::convex::Separation;
use crate::math::lanes::{
    by_axis, cross, dot, either, load, minus, over, spread, times, with_lanes,
};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Matrix, Pose, Real, Vector, Wide, max, max_component};
use crate::query::tiles::{LANES, Tiles};
use crate::shape::SupportMap;

/// A solid with flat faces.
trait Faceted<N: Real>: SupportMap<N, 3> {
    /// Finds the directions that leave the largest gaps to eight triangles.
    fn search<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        question: &Question<'_, N>,
        tiles: &Tiles<N, 3>,
    ) -> Axes<N>;

    /// The edge of the solid and the side of the triangle that an index stands for, with a normal.
    fn edges(index: usize, normal: &Vector<N, 3>) -> AxisKind;

    /// What an axis says of a triangle, if it is within the limit.
    fn answer(&self, fin: &Fin<'_, N>, axis: Axis<N>, limit: N) -> Option<Separation<N, 3>>;
}

/// The axes by the vectors of an instruction set, on which they do not depend.
fn at<N: Real>(
    level: Level,
    solid: &impl Faceted<N>,
    question: &Question<'_, N>,
    tiles: &Tiles<N, 3>,
) -> Axes<N> {
    with_lanes!(level, simd => solid.search::<_, N::Lanes<_>>(simd, question, tiles))
}

/// What all triangles are asked.
struct Question<'a, N: Real> {
    pose12: &'a Pose<N, 3>,
    /// No point of the solid is farther from its origin.
    reach: N,
    limit: N,
    /// Where the triangles are seen from.
    origin: &'a Vector<N, 3>,
}

/// Where the search for an axis ended for each of eight triangles.
struct Axes<N> {
    /// A bit for each triangle that is beyond the limit.
    beyond: u8,
    /// The units of each pair; see [`Fin::units`].
    scale: [N; LANES],
    shrink: [N; LANES],
    /// In the frame of the solid, in units of the pair.
    corners: [[[N; LANES]; 3]; 3],
    normals: [[N; LANES]; 3],
    gaps: [N; LANES],
    kinds: [N; LANES],
    indices: [N; LANES],
}

/// What a direction is perpendicular to, as numbers of lanes: the triangle, a face of the solid, or a side
/// of the triangle and an edge.
const TRIANGLE: f64 = 0.0;
const FACE: f64 = 1.0;
const EDGES: f64 = 2.0;

impl<N: Real> Axes<N> {
    /// The corners of one of the triangles in the frame of the solid, in units of the pair.
    fn corners_of(&self, lane: usize) -> [Vector<N, 3>; 3] {
        let [a, b, c] = &self.corners;
        [of_lane(a, lane), of_lane(b, lane), of_lane(c, lane)]
    }

    fn axis<T: Faceted<N>>(&self, lane: usize, _: &T) -> Axis<N> {
        let (normal, gap) = (of_lane(&self.normals, lane), self.gaps[lane]);
        let index = whole(self.indices[lane]);
        let kind = if self.kinds[lane] == N::lit(EDGES) {
            T::edges(index, &normal)
        } else if self.kinds[lane] == N::lit(FACE) {
            AxisKind::Face(u32::try_from(index).expect("32 bits number the faces"))
        } else {
            AxisKind::Triangle
        };
        Axis { kind, normal, gap }
    }
}

fn of_lane<N: Real>(rows: &[[N; LANES]; 3], lane: usize) -> Vector<N, 3> {
    Vector::<N, 3>::new(rows[0][lane], rows[1][lane], rows[2][lane])
}

/// A small whole number.
#[expect(
    clippy::cast_possible_truncation,
    clippy::cast_sign_loss,
    reason = "the indices of faces and edges are small and not negative"
)]
fn whole<N: Real>(number: N) -> usize {
    number.as_f64() as usize
}

/// The best directions so far.
#[derive(Clone, Copy)]
struct Best<V> {
    gap: V,
    normal: [V; 3],
    kind: V,
    index: V,
}

/// Eight triangles.
struct Eight<N, V> {
    /// As seen from their origin.
    given: [[V; 3]; 3],
    /// The same in the frame of the solid, in units of the pairs.
    corners: [[V; 3]; 3],
    scale: V,
    shrink: V,
    scales: [N; LANES],
    shrinks: [N; LANES],
    /// What is beyond the limit by more than rounding, in lengths of the pairs.
    beyond: V,
}

impl<N: Real, V> Eight<N, V> {
    #[inline(always)]
    fn new<S: Simd>(simd: S, question: &Question<'_, N>, tiles: &Tiles<N, 3>) -> Self
    where
        V: Wide<S, Scalar = N>,
    {
        let given = seen_from_origin::<S, N, V>(simd, question, tiles);
        let (scales, shrinks) = units(simd, question, &given);
        let (scale, shrink) = (V::load(simd, &scales), V::load(simd, &shrinks));
        let center: [V; 3] = spread(simd, &question.pose12.translation);
        let mut corners = given;
        for corner in &mut corners {
            let arm = times(&minus(corner, &center), shrink);
            *corner = turned(simd, &question.pose12.rotation, &arm);
        }
        let slack = V::all(simd, N::lit(16.0) * noise::<N>()) * scale;
        let beyond = V::all(simd, question.limit) + slack;
        Self { given, corners, scale, shrink, scales, shrinks, beyond }
    }

    /// A gap says that a triangle is beyond the limit.
    #[inline(always)]
    fn is_beyond<S: Simd>(&self, gap: V) -> V::Mask
    where
        V: Wide<S, Scalar = N>,
    {
        (gap * self.scale).simd_gt(self.beyond)
    }

    #[inline(always)]
    fn stored<S: Simd>(&self, best: &Best<V>, beyond: u64) -> Axes<N>
    where
        V: Wide<S, Scalar = N>,
    {
        let blank = [N::ZERO; LANES];
        let (mut corners, mut normals) = ([[blank; 3]; 3], [blank; 3]);
        for (rows, corner) in corners.iter_mut().zip(&self.corners) {
            for (row, values) in rows.iter_mut().zip(corner) {
                values.store(row);
            }
        }
        for (row, values) in normals.iter_mut().zip(&best.normal) {
            values.store(row);
        }
        let (mut gaps, mut kinds, mut indices) = (blank, blank, blank);
        best.gap.store(&mut gaps);
        best.kind.store(&mut kinds);
        best.index.store(&mut indices);
        let (scale, shrink, beyond) = (self.scales, self.shrinks, low_byte(beyond));
        Axes { beyond, scale, shrink, corners, normals, gaps, kinds, indices }
    }
}

fn low_byte(bits: u64) -> u8 {
    let [low, ..] = bits.to_le_bytes();
    low
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
    let own = max(question.reach, max_component(&question.pose12.translation));
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

/// The gap that a direction or its opposite leaves to a solid that lies between two heights, and whether
/// the triangle is the upper one.
#[inline(always)]
fn parted<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    [a, b, c]: [V; 3],
    [bottom, top]: [V; 2],
) -> (V, V::Mask) {
    let (low, high) = (a.smaller(b).smaller(c), a.larger(b).larger(c));
    let (above, below) = (low - top, bottom - high);
    let is_above = above.simd_gt(below);
    (is_above.select(above, below), is_above)
}

#[inline(always)]
fn exchanged<S: Simd, V: Wide<S>>(is_more: V::Mask, new: Best<V>, old: &Best<V>) -> Best<V> {
    Best {
        gap: is_more.select(new.gap, old.gap),
        normal: either(is_more, &new.normal, &old.normal),
        kind: is_more.select(new.kind, old.kind),
        index: is_more.select(new.index, old.index),
    }
}

/// The directions of the sides, those of the fronts, and which triangles have fronts.
#[inline(always)]
fn edging<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    eight: &Eight<N, V>,
    turn: &Matrix<N, 3>,
) -> ([[V; 3]; 3], [V; 3], V::Mask) {
    let ([a, b, c], shrink) = (&eight.given, eight.shrink);
    let ways =
        [times(&minus(b, a), shrink), times(&minus(c, b), shrink), times(&minus(a, c), shrink)];
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
    let mut sides = ways;
    for at in 0..3 {
        let has_length = (has_front | is_longest[at]) & squared[at].simd_gt(tiny);
        let share = has_length.select(one / squared[at].sqrt(), zero);
        sides[at] = turned(simd, turn, &times(&ways[at], share));
    }
    (sides, front, has_front)
}

/// The triangles' own normals, unless those of faces of the solid, which lies between two heights along
/// them, leave gaps that are larger by more than rounding.
#[inline(always)]
fn best_face<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    corners: &[[V; 3]; 3],
    front: &[V; 3],
    has_front: V::Mask,
    heights: [V; 2],
    of_solid: &Best<V>,
) -> Best<V> {
    let [a, b, c] = corners;
    let (gap, is_above) = parted([dot(a, front), dot(b, front), dot(c, front)], heights);
    let away = [-front[0], -front[1], -front[2]];
    let (kind, index) = (V::all(simd, N::lit(TRIANGLE)), V::all(simd, N::ZERO));
    let own = Best { gap, normal: either(is_above, &away, front), kind, index };
    let is_less = of_solid.gap.simd_gt(gap + V::all(simd, noise()));
    exchanged(has_front & !is_less, own, of_solid)
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
