//! Lower bounds of the distances from a convex solid to 8 parts of a surface at a time.
//!
//! Most parts whose boxes are near the solid are farther than the limit. A plane perpendicular to
//! the shortest segment from the part to the solid's centre rejects such parts at the cost of a few
//! products. Any plane gives a valid lower bound of the distance, so only rounding needs care. A
//! box along the axes of the solid replaces its core.
//!
//! ```text
//!   part                          solid
//!     ╲                         ┌───────┐
//!      ●──────── toward ────────┼───>·  │   · centre
//!     ╱                         └───────┘
//!      ├──── lower bound ───────┤       own: extent of the core and its radius
//!      ├─────── from_middle ────┼─own┤  lower bound = from_middle - own - slack
//! ```

use super::part_cache::PartCache;
use crate::bounding_volume::Aabb;
use crate::collide::Pair;
use crate::collide::packet::{LANES, PartPacket};
use crate::collide::parts::between::Between;
use crate::math::lanes::{bits, dot, either, in_lanes, lit, load, minus, norm, spread};
use crate::math::simd::{Level, Simd, SimdMask};
use crate::math::{Matrix, Point, Real, Space, Vector, Wide, filled, max, max_component, min};
use crate::shape::{Geometry, Kind};

/// Slack of the bounds, relative to the sum of all lengths: 128 epsilon, and at least `CURVED`,
/// which exceeds the tolerance of the distance search of curved solids.
const ROUNDING: f64 = 128.0;
const CURVED: f64 = 1.0e-10;

/// Returns the slack of the bounds, relative to the sum of all lengths.
#[inline]
pub(super) fn relative_slack<N: Real>() -> N {
    max(N::lit(ROUNDING) * N::EPSILON, N::lit(CURVED))
}

/// Returns the magnitude below which a sum of products may be inexact because a product
/// underflowed.
#[inline]
fn least_length<N: Real>() -> N {
    N::MIN_POSITIVE / N::EPSILON
}

/// A convex solid in the frame of a composite, and the limits of the search for near parts.
pub(super) struct LowerBoundQuery<N: Real, const D: usize> {
    /// Centre of the solid, in the frame of the composite.
    pub(super) center: Vector<N, D>,
    /// Axes of the solid, as columns, in the frame of the composite.
    pub(super) turn: Matrix<N, D>,
    /// Half extents of the solid's core along these axes.
    pub(super) half: Vector<N, D>,
    /// Radius around the core.
    pub(super) rounding: N,
    /// Parts beyond this distance from the solid are rejected.
    pub(super) max_distance: N,
    /// Parts whose boxes do not overlap the box from `low` to `high` are rejected.
    pub(super) low: Vector<N, D>,
    pub(super) high: Vector<N, D>,
    /// Sum of the solid's bounding radius, `max_distance` and the largest component of its
    /// translation; scales rounding errors.
    pub(super) size: N,
}

/// Results of a [`LowerBoundQuery`] for 8 parts.
pub(super) struct LowerBounds<N> {
    /// Bits of the parts that may be within `max_distance`.
    pub(super) mask: u8,
    /// Lower bound of the distance from the solid's centre to the nearest of the 8 parts whose
    /// boxes overlap the query's box; zero if unknown, infinite if no box overlaps.
    pub(super) from_middle: N,
}

impl<N: Space<D>, const D: usize> LowerBoundQuery<N, D> {
    /// Makes the query for a convex first shape and the parts of the second shape in the box
    /// `within`. The half extents of the solid are cached in `around`. `None` if the first shape
    /// has no support map: composites and half-spaces.
    pub(super) fn new(
        between: &Between<'_, N, D>,
        max_distance: N,
        around: &mut PartCache<N, D>,
        within: &Aabb<N, D>,
    ) -> Option<Self> {
        let (Pair { first, .. }, pose21) = (between.pair, &between.pose21);
        let map = Geometry(first).as_support_map()?;
        let core = if let Kind::Ball(_) = first { N::ZERO } else { map.reach() };
        Some(Self {
            center: pose21.point(&map.center()).coords,
            turn: pose21.rotation,
            half: around.half(map),
            rounding: map.rounding(),
            max_distance,
            low: within.mins().coords,
            high: within.maxs().coords,
            size: core + map.rounding() + max_distance + max_component(&pose21.translation),
        })
    }

    /// Returns the centre of the solid, in the frame of the composite.
    pub(super) fn middle(&self) -> Point<N, D> {
        Point::from(self.center)
    }

    /// Computes the bounds for 8 parts.
    pub(super) fn bounds(&self, tiles: &PartPacket<N, D>) -> LowerBounds<N> {
        at(Level::new(), tiles, self)
    }
}

/// Computes [`bounds`] of all 8 lanes. The result does not depend on the SIMD level.
fn at<N: Real, const D: usize>(
    level: Level,
    tiles: &PartPacket<N, D>,
    query: &LowerBoundQuery<N, D>,
) -> LowerBounds<N> {
    let mut all = LowerBounds { mask: 0, from_middle: N::INFINITY };
    for run in level.runs(LANES) {
        let found = in_lanes!(run, simd => bounds::<_, N, N::Lanes<_>, D>(simd, tiles, query));
        all.mask |= run.of_bits(found.mask);
        all.from_middle = min(found.from_middle, all.from_middle);
    }
    all
}

/// Computes the bounds for the lanes of `V`: the mask of the parts that may be within the limit,
/// and the smallest distance bound from the centre to the parts in the box.
#[inline(always)]
fn bounds<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    tiles: &PartPacket<N, D>,
    query: &LowerBoundQuery<N, D>,
) -> LowerBounds<N> {
    let corners: [[V; D]; 3] = [
        load(simd, &tiles.corners[0]),
        load(simd, &tiles.corners[1]),
        load(simd, &tiles.corners[2]),
    ];
    let is_in = is_in(simd, &corners, query);
    let center: [V; D] = spread(simd, &query.center);
    let arms =
        [minus(&center, &corners[0]), minus(&center, &corners[1]), minus(&center, &corners[2])];
    let toward = toward(simd, &arms);
    let heights = [dot(&toward, &arms[0]), dot(&toward, &arms[1]), dot(&toward, &arms[2])];
    let farthest =
        dot(&arms[0], &arms[0]).larger(dot(&arms[1], &arms[1])).larger(dot(&arms[2], &arms[2]));
    let slack = V::all(simd, relative_slack()) * (farthest.sqrt() + V::all(simd, query.size));
    let (length, tiny) = (norm(&toward), V::all(simd, least_length()));
    // The comparisons are false for NaN, so lanes with NaN have no bound.
    let is_bound = length.simd_gt(slack)
        & heights[0].simd_gt(tiny)
        & heights[1].simd_gt(tiny)
        & heights[2].simd_gt(tiny);
    let from_middle = heights[0].smaller(heights[1]).smaller(heights[2]) / length - slack;
    let own = extent(simd, &toward, query) / length + V::all(simd, query.rounding);
    let is_beyond =
        is_bound & (from_middle - own - slack).simd_gt(V::all(simd, query.max_distance));
    let mut known = [N::ZERO; LANES];
    let known_bound = is_bound.select(from_middle, V::all(simd, N::ZERO));
    is_in.select(known_bound, V::all(simd, N::INFINITY)).store(&mut known);
    let mask = bits(is_in & !is_beyond);
    LowerBounds { mask, from_middle: known.into_iter().fold(N::INFINITY, |least, x| min(x, least)) }
}

/// Returns the lanes whose parts have a box that overlaps the box of the query.
#[inline(always)]
fn is_in<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    [a, b, c]: &[[V; D]; 3],
    query: &LowerBoundQuery<N, D>,
) -> V::Mask {
    let all = V::all(simd, N::ZERO);
    let mut is_in = all.simd_eq(all);
    for axis in 0..D {
        let least = a[axis].smaller(b[axis]).smaller(c[axis]);
        let most = a[axis].larger(b[axis]).larger(c[axis]);
        is_in = is_in
            & least.simd_le(V::all(simd, query.high[axis]))
            & most.simd_ge(V::all(simd, query.low[axis]));
    }
    is_in
}

/// Returns the vector from the nearest point of each part to a point, given the vectors from the
/// part's corners to that point. If the point projects inside a triangle, the vector follows from
/// the barycentric coordinates, else from the nearest side.
#[inline(always)]
fn toward<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    [a, b, c]: &[[V; D]; 3],
) -> [V; D] {
    let (ab, ac) = (minus(a, b), minus(a, c));
    let (along_ab, along_ac) = (dot(&ab, a), dot(&ac, a));
    let (bb, bc, cc) = (dot(&ab, &ab), dot(&ab, &ac), dot(&ac, &ac));
    let (at_b, at_c) = (along_ab * cc - along_ac * bc, along_ac * bb - along_ab * bc);
    let (area, zero) = (bb * cc - bc * bc, V::all(simd, N::ZERO));
    let is_over =
        at_b.simd_ge(zero) & at_c.simd_ge(zero) & (at_b + at_c).simd_le(area) & area.simd_gt(zero);
    let (share_b, share_c) = (at_b / area, at_c / area);
    let over = filled(
        #[inline(always)]
        |axis| a[axis] - ab[axis] * share_b - ac[axis] * share_c,
    );
    let (first, second, third) =
        (from_side(simd, a, b), from_side(simd, b, c), from_side(simd, c, a));
    either(is_over, &over, &shorter(&shorter(&first, &second), &third))
}

/// Returns the vector from the nearest point of a segment to a point, given the vectors from the
/// segment's ends to that point.
#[inline(always)]
fn from_side<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    from: &[V; D],
    to: &[V; D],
) -> [V; D] {
    let along = minus(from, to);
    let share = dot(&along, from) / dot(&along, &along);
    let zero = V::all(simd, N::ZERO);
    let share = share.simd_gt(zero).select(share.smaller(lit(simd, 1.0)), zero);
    filled(
        #[inline(always)]
        |axis| from[axis] - along[axis] * share,
    )
}

/// Returns the shorter of two vectors, the first in a tie.
#[inline(always)]
fn shorter<S: Simd, V: Wide<S>, const D: usize>(first: &[V; D], second: &[V; D]) -> [V; D] {
    either(dot(second, second).simd_lt(dot(first, first)), second, first)
}

/// Returns the extent of the core from its centre along the vectors `toward`, times the lengths of
/// these vectors.
#[inline(always)]
fn extent<S: Simd, N: Real, V: Wide<S, Scalar = N>, const D: usize>(
    simd: S,
    toward: &[V; D],
    query: &LowerBoundQuery<N, D>,
) -> V {
    let mut sum = V::all(simd, N::ZERO);
    for axis in 0..D {
        let column: [V; D] = filled(
            #[inline(always)]
            |row| V::all(simd, query.turn[(row, axis)]),
        );
        sum += dot(&column, toward).abs() * V::all(simd, query.half[axis]);
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Mapped, Pose};
    use crate::shape::{Ball, Cuboid, Shape, TriMesh};

    type P3 = Point<f64, 3>;

    /// Returns the next pseudo-random number from -1 to 1.
    fn pseudo_random(state: &mut u64) -> f64 {
        *state ^= *state << 13;
        *state ^= *state >> 7;
        *state ^= *state << 17;
        (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// Returns the least distance from a point to samples of a triangle; never less than the true
    /// distance.
    fn sampled([a, b, c]: &[P3; 3], p: &P3) -> f64 {
        const STEPS: u32 = 48;
        let shares = (0..=STEPS).flat_map(|v| (0..=STEPS - v).map(move |w| (v, w)));
        let distance = |(v, w): (u32, u32)| {
            let [v, w] = [v, w].mapped(|share| f64::from(share) / f64::from(STEPS));
            (a + (b - a) * v + (c - a) * w - p).norm()
        };
        shares.map(distance).fold(f64::INFINITY, f64::min)
    }

    /// Returns a lower bound of the distance from the centre of a solid at the origin to a
    /// triangle, and whether the triangle is rejected as beyond `max_distance` from the solid.
    fn bound(solid: &dyn Shape<f64, 3>, corners: [P3; 3], max_distance: f64) -> (f64, bool) {
        let mesh = TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]);
        let geometries = (solid.geometry(), mesh.geometry());
        let pose12 = Pose::identity();
        let pair = Pair { first: geometries.0.0, second: geometries.1.0, pose12 };
        let between = Between::of_pair(&pair);
        let everywhere = Aabb::new(P3::from([-9.0; 3]), P3::from([9.0; 3]));
        let mut around = PartCache::default();
        assert!(around.covers(&mesh, &everywhere), "one triangle is kept");
        let query = LowerBoundQuery::new(&between, max_distance, &mut around, &everywhere);
        let found = query.expect("a convex solid").bounds(&around.tiles()[0]);
        let is_beyond = found.mask & 1 == 0;
        assert_eq!(found.mask == u8::MAX, !is_beyond, "the one stands for all eight");
        (found.from_middle, is_beyond)
    }

    #[test]
    fn bounds_are_below_the_distance_and_close_to_it() {
        let (mut state, mut close, origin) = (1_u64, 0, P3::origin());
        for round in 0..400 {
            // Every other triangle is a sliver.
            let thin = if round % 2 == 0 { 1.0 } else { 1e-9 };
            let mut corner = || P3::from([0, 1, 2].mapped(|_| 2.0 * pseudo_random(&mut state)));
            let [a, b, mut c] = [corner(), corner(), corner()];
            c = a + (b - a) * 0.3 + (c - a) * thin;
            let truth = sampled(&[a, b, c], &origin);
            let (bound, is_beyond) = bound(&Ball::new(0.25), [a, b, c], 0.1);
            assert!(bound <= truth, "{a} {b} {c}: {bound} {truth}");
            assert!(!is_beyond || truth > 0.35, "{a} {b} {c}: {truth}");
            close += u32::from(bound > 0.95 * truth && is_beyond == (truth > 0.36));
        }
        assert!(close > 350, "close in {close} cases of 400");
    }

    #[test]
    fn a_box_is_separated_from_triangles_below_it() {
        let below = |y: f64| [P3::new(-3.0, y, -3.0), P3::new(3.0, y, -3.0), P3::new(0.0, y, 4.0)];
        let cuboid = Cuboid::new(Vector::<f64, 3>::new(0.5, 0.5, 0.5));
        let (from_middle, is_beyond) = bound(&cuboid, below(-0.6), 0.2);
        assert!(!is_beyond && (from_middle - 0.6).abs() < 1e-6, "within reach");
        assert!(bound(&cuboid, below(-0.8), 0.2).1, "out of reach");
        assert_eq!(bound(&cuboid, below(0.0), 0.2), (0.0, false), "through the middle");
    }
}
