//! Two convex polygons of a plane, a triangle and one of up to eight corners: how far inside of the sides
//! of each the corners of the other are, side by side.

use crate::math::lanes::{dot, load, minus, spread, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Point, Pose, Real, Vector, Wide, max};
use crate::shape::FaceRing;

/// How many corners or sides are side by side.
pub(super) const LANES: usize = 8;

/// A triangle seen along its normal, counter-clockwise, and what it is held against.
pub(super) struct Base<'a, N: Real> {
    pub(super) flats: [Vector<N, 2>; 3],
    /// Of each side the unit normal inward.
    pub(super) inward: [Vector<N, 2>; 3],
    /// The first of the corners.
    pub(super) origin: Point<N, 3>,
    pub(super) tangents: [Vector<N, 3>; 2],
    /// The pose of the solid that shows the other polygon.
    pub(super) pose: &'a Pose<N, 3>,
    /// Lengths below this are rounding errors.
    pub(super) tolerance: N,
}

/// What lies how to some sides, as a bit for each of what is side by side.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Signs {
    /// Farther inside than rounding.
    pub(super) inside: u8,
    /// Farther outside than rounding.
    pub(super) outside: u8,
}

/// How two polygons lie to each other. What is beyond the corners that there are means nothing.
pub(super) struct Fences<N> {
    /// The corners of the other polygon by coordinate, in the frame of the triangle, and as seen along
    /// its normal.
    pub(super) points: [[N; LANES]; 3],
    pub(super) flats: [[N; LANES]; 2],
    /// For each side of the triangle how far inside of it the corners of the other are.
    pub(super) of_base: [[N; LANES]; 3],
    /// For each corner of the triangle how far inside of the sides of the other it is.
    pub(super) of_top: [[N; LANES]; 3],
    pub(super) base_signs: [Signs; 3],
    pub(super) top_signs: [Signs; 3],
}

impl<N: Real> Fences<N> {
    /// Holds a triangle against a face of a solid; `None` if the face is not plain to see as a polygon.
    pub(super) fn new(base: &Base<'_, N>, face: &FaceRing<N>) -> Option<Self> {
        at(Level::new(), base, face)
    }
}

/// [`held`] with the vectors of an instruction set; the answers do not depend on it.
fn at<N: Real>(level: Level, base: &Base<'_, N>, face: &FaceRing<N>) -> Option<Fences<N>> {
    with_lanes!(level, simd => held::<_, N, N::Lanes<_>>(simd, base, face))
}

#[inline(always)]
fn held<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    base: &Base<'_, N>,
    face: &FaceRing<N>,
) -> Option<Fences<N>> {
    let points: [V; 3] = placed(simd, base.pose, &load(simd, &face.corners));
    let arms = minus(&points, &spread(simd, &base.origin.coords));
    let flats: [V; 2] = [
        dot(&spread::<S, N, V, 3>(simd, &base.tangents[0]), &arms),
        dot(&spread::<S, N, V, 3>(simd, &base.tangents[1]), &arms),
    ];
    let blank = [N::ZERO; LANES];
    let mut fences = Fences {
        points: [blank; 3],
        flats: [blank; 2],
        of_base: [blank; 3],
        of_top: [blank; 3],
        base_signs: [Signs::default(); 3],
        top_signs: [Signs::default(); 3],
    };
    for (row, values) in fences.points.iter_mut().zip(&points) {
        values.store(row);
    }
    for (row, values) in fences.flats.iter_mut().zip(&flats) {
        values.store(row);
    }
    let inward = fence(simd, &flats, (&fences.flats, face.count), base.tolerance)?;
    for at in 0..3 {
        let (place, own) = (&base.flats[at], &base.inward[at]);
        let [x, y] = [V::all(simd, place.x), V::all(simd, place.y)];
        let of_top = inward[0] * (x - flats[0]) + inward[1] * (y - flats[1]);
        let of_base = V::all(simd, own.x) * (flats[0] - x) + V::all(simd, own.y) * (flats[1] - y);
        of_top.store(&mut fences.of_top[at]);
        of_base.store(&mut fences.of_base[at]);
        fences.top_signs[at] = signs(simd, of_top, base.tolerance);
        fences.base_signs[at] = signs(simd, of_base, base.tolerance);
    }
    Some(fences)
}

/// The unit normals inward of the sides of a polygon, which is given in lanes and as numbers; `None` of one
/// without an area, or with a side that is none.
#[inline(always)]
pub(super) fn fence<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    flats: &[V; 2],
    (rows, count): (&[[N; LANES]; 2], usize),
    tolerance: N,
) -> Option<[V; 2]> {
    let mut next = *rows;
    for (next, row) in next.iter_mut().zip(rows) {
        next[..LANES - 1].copy_from_slice(&row[1..]);
        next[count - 1] = row[0];
    }
    let sides: [V; 2] = minus(&load(simd, &next), flats);
    let first = [V::all(simd, rows[0][0]), V::all(simd, rows[1][0])];
    let arms = minus(flats, &first);
    let (mut areas, mut squares) = ([N::ZERO; LANES], [N::ZERO; LANES]);
    (arms[0] * sides[1] - arms[1] * sides[0]).store(&mut areas);
    let squared = dot(&sides, &sides);
    squared.store(&mut squares);
    let (mut area, mut longest) = (N::ZERO, N::ZERO);
    for (part, square) in areas[..count].iter().zip(&squares) {
        area += *part;
        longest = max(longest, *square);
    }
    let room = N::lit(64.0) * tolerance;
    let short = squared.simd_le(V::all(simd, room * room)).to_bitmask() & valid(count);
    // Written so that what is no number is not plain.
    let is_plain = short == 0 && area.abs() > room * longest.sqrt();
    if !is_plain {
        return None;
    }
    let turn = V::all(simd, if area < N::ZERO { -N::ONE } else { N::ONE }) / squared.sqrt();
    Some([-sides[1] * turn, sides[0] * turn])
}

/// A bit for each of the corners that there are.
const fn valid(count: usize) -> u64 {
    (1 << count) - 1
}

#[inline(always)]
fn signs<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, insides: V, tolerance: N) -> Signs {
    let [inside, ..] = insides.simd_gt(V::all(simd, tolerance)).to_bitmask().to_le_bytes();
    let [outside, ..] = insides.simd_lt(V::all(simd, -tolerance)).to_bitmask().to_le_bytes();
    Signs { inside, outside }
}

/// Points of a frame in that which a pose leads to.
#[inline(always)]
pub(super) fn placed<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    pose: &Pose<N, 3>,
    local: &[V; 3],
) -> [V; 3] {
    let mut all = *local;
    for (row, value) in all.iter_mut().enumerate() {
        let turned = V::all(simd, pose.rotation[(row, 0)]) * local[0]
            + V::all(simd, pose.rotation[(row, 1)]) * local[1]
            + V::all(simd, pose.rotation[(row, 2)]) * local[2];
        *value = turned + V::all(simd, pose.translation[row]);
    }
    all
}
