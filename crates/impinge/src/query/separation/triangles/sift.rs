//! Which triangles a solid with flat faces may be near, by the planes of its faces alone.

use super::low_byte;
use super::meeting::{Flat, FlatQuestion};
use super::turned;
use crate::math::lanes::{dot, load, minus, spread, with_lanes};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Real, Wide, max, max_component, min};
use crate::query::tiles::{LANES, Tiles};
use crate::shape::{Cuboid, Polytope, SupportMap};

/// Bounds are loosened by so many rounding units of all lengths.
const ROUNDING: f64 = 512.0;

/// What is found of eight triangles.
pub(crate) struct Sifted<N> {
    /// A bit for each that may be within the limit.
    pub(crate) near: u8,
    /// None is nearer to the middle of the solid; zero if that is not known.
    pub(crate) from_middle: N,
}

/// What the planes of all faces say of eight triangles.
struct PlaneGaps<V> {
    /// How far the triangles are beyond the plane that they are farthest beyond.
    gap: V,
    /// The same for planes through the middle of the solid.
    from_middle: V,
}

impl<N: Real> FlatQuestion<'_, N> {
    /// What may be near of eight triangles.
    pub(crate) fn sifted(&self, tiles: &Tiles<N, 3>) -> Sifted<N> {
        at(Level::new(), self, tiles)
    }
}

/// [`sift`] with the vectors of an instruction set; the answers do not depend on it.
fn at<N: Real>(level: Level, question: &FlatQuestion<'_, N>, tiles: &Tiles<N, 3>) -> Sifted<N> {
    with_lanes!(level, simd => sift::<_, N, N::Lanes<_>>(simd, question, tiles))
}

#[inline(always)]
fn sift<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    question: &FlatQuestion<'_, N>,
    tiles: &Tiles<N, 3>,
) -> Sifted<N> {
    let FlatQuestion { pose12, origin, limit, .. } = question;
    let (origins, center): ([V; 3], [V; 3]) =
        (spread(simd, origin), spread(simd, &pose12.translation));
    let mut farthest = V::all(simd, N::ZERO);
    let mut corners = [center; 3];
    for (corner, rows) in corners.iter_mut().zip(&tiles.corners) {
        let given = minus(&load::<S, N, V, 3, LANES>(simd, rows), &origins);
        farthest = given[0].abs().larger(given[1].abs()).larger(given[2].abs()).larger(farthest);
        *corner = turned(simd, &pose12.rotation, &minus(&given, &center));
    }
    let PlaneGaps { gap, from_middle } = match question.solid {
        Flat::Cuboid(cuboid) => of_box(simd, cuboid, &corners),
        Flat::Polytope(hull) => of_hull(simd, hull, &corners),
    };
    let own = question.solid.reach() + max_component(&pose12.translation);
    let slack = V::all(simd, N::lit(ROUNDING) * N::EPSILON);
    let size = farthest + V::all(simd, own);
    // Where all squares are finite all is a number.
    let is_bound = size.simd_lt(V::all(simd, N::MAX.sqrt()));
    let is_beyond = is_bound & gap.simd_gt(slack * size + V::all(simd, max(*limit, N::ZERO)));
    let clear = from_middle - slack * (size + V::all(simd, max_component(origin)));
    let is_clear = is_bound & clear.simd_gt(V::all(simd, N::ZERO));
    let mut known = [N::ZERO; LANES];
    is_clear.select(clear, V::all(simd, N::ZERO)).store(&mut known);
    let mut least = N::INFINITY;
    for value in known {
        least = min(value, least);
    }
    Sifted { near: low_byte((!is_beyond).to_bitmask()), from_middle: least }
}

#[inline(always)]
fn of_box<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    cuboid: &Cuboid<N, 3>,
    [a, b, c]: &[[V; 3]; 3],
) -> PlaneGaps<V> {
    let mut gaps = no_gaps(simd);
    for axis in 0..3 {
        let low = a[axis].smaller(b[axis]).smaller(c[axis]);
        let high = a[axis].larger(b[axis]).larger(c[axis]);
        let away = low.larger(-high);
        gaps.gap = (away - V::all(simd, cuboid.half_extents()[axis])).larger(gaps.gap);
        gaps.from_middle = away.larger(gaps.from_middle);
    }
    gaps
}

#[inline(always)]
fn of_hull<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    hull: &Polytope<N, 3>,
    [a, b, c]: &[[V; 3]; 3],
) -> PlaneGaps<V> {
    let (mut gaps, middle) = (no_gaps(simd), hull.center());
    for face in hull.faces() {
        let outward: [V; 3] = spread(simd, &face.normal);
        let low = dot(&outward, a).smaller(dot(&outward, b)).smaller(dot(&outward, c));
        gaps.gap = (low - V::all(simd, face.offset)).larger(gaps.gap);
        let level = face.normal.dot(&middle.coords);
        gaps.from_middle = (low - V::all(simd, level)).larger(gaps.from_middle);
    }
    gaps
}

#[inline(always)]
fn no_gaps<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S) -> PlaneGaps<V> {
    let least = -V::all(simd, N::INFINITY);
    PlaneGaps { gap: least, from_middle: least }
}
