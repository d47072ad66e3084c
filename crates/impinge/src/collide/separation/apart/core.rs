//! Support points of cores, and the numbers of vertices tied along a direction, for all lanes at
//! once.

use crate::math::lanes::{dot, either, minus, spread, times};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Point, Real, Vector, Wide};
use crate::shape::{Polytope, SupportMap};

/// Core (a solid without its rounding radius) of one solid of each pair, in the solid's own frame
/// and in units of the pair (see [`super::FlatPair::units`]). All lanes have the same kind.
pub(super) enum LaneCore<'a, N: Real, V> {
    /// Half extents of each lane's box, in units of its pair.
    Cuboid([V; 3]),
    /// Vertices shared by all lanes, in units of the shape; `shrink` scales them to each pair's
    /// units.
    Points { points: CorePoints<'a, N>, shrink: V },
}

/// Vertices of a triangle or hull.
#[derive(Clone, Copy)]
pub(super) struct CorePoints<'a, N: Real> {
    pub(super) vertices: &'a [Point<N, 3>],
    /// The hull that owns the vertices. A search for a single pair uses its faster support
    /// function. `None` for a triangle.
    pub(super) hull: Option<&'a Polytope<N, 3>>,
}

/// Vertices of a core that are farthest along a direction, up to a tolerance.
pub(super) struct LaneTies<V> {
    /// Number of tied vertices, as a value of the scalar type. Coinciding vertices may count twice.
    pub(super) count: V,
    /// Vector parallel to the line through the tied vertices, of any length and either sign, if
    /// there are exactly two of them. Meaningless for other counts.
    pub(super) along: [V; 3],
}

impl<N: Real, V> LaneCore<'_, N, V> {
    /// Returns the vertex farthest along `direction`. In a tie, returns the first of the tied
    /// vertices or, for a box, the vertex on the positive side.
    #[inline(always)]
    pub(super) fn support<S: Simd>(&self, simd: S, direction: &[V; 3]) -> [V; 3]
    where
        V: Wide<S, Scalar = N>,
    {
        match self {
            Self::Cuboid(half) => {
                let zero = V::all(simd, N::ZERO);
                let toward =
                    |axis: usize| direction[axis].simd_lt(zero).select(-half[axis], half[axis]);
                [toward(0), toward(1), toward(2)]
            }
            Self::Points { points, shrink } => {
                let local = match points.hull {
                    Some(hull) if <V::Mask as SimdMask<S>>::LEN == 1 => {
                        lone_support(simd, hull, direction)
                    }
                    _ => farthest(simd, points.vertices, direction),
                };
                times(&local, *shrink)
            }
        }
    }

    /// Returns the number of vertices whose height along the unit vector `direction` is within
    /// `tolerance` of the largest height and, for two such vertices, the direction of the line
    /// through them.
    #[inline(always)]
    pub(super) fn ties<S: Simd>(&self, simd: S, direction: &[V; 3], tolerance: V) -> LaneTies<V>
    where
        V: Wide<S, Scalar = N>,
    {
        let (one, two) = (V::all(simd, N::ONE), V::all(simd, N::TWO));
        match self {
            Self::Cuboid(half) => {
                let (mut count, mut least) = (one, V::all(simd, N::INFINITY));
                let mut along = [V::all(simd, N::ZERO); 3];
                for axis in 0..3 {
                    let rise = direction[axis].abs() * half[axis] * two;
                    // A box without extent along an axis has each corner twice there, and the
                    // copies do not count.
                    let has_extent = (half[axis] * two).simd_gt(tolerance);
                    count = (rise.simd_le(tolerance) & has_extent).select(count + count, count);
                    let is_least = rise.simd_lt(least) & has_extent;
                    let unit = Vector::<N, 3>::ith(axis, N::ONE);
                    along = either(is_least, &spread(simd, &unit), &along);
                    least = is_least.select(rise, least);
                }
                LaneTies { count, along }
            }
            Self::Points { points, shrink } => {
                let best = self.support(simd, direction);
                let highest = dot(&best, direction);
                let (mut count, mut other) = (V::all(simd, N::ZERO), best);
                for vertex in points.vertices {
                    let vertex = times(&spread(simd, &vertex.coords), *shrink);
                    let is_tied = (highest - dot(&vertex, direction)).simd_le(tolerance);
                    count = is_tied.select(count + one, count);
                    other = either(is_tied, &vertex, &other);
                }
                // `other` is the last tied vertex: if it is the only one, it is the support point
                // itself and `along` is zero.
                LaneTies { count, along: minus(&other, &best) }
            }
        }
    }
}

/// Returns the vertex farthest along a direction; the first vertex wins a tie.
#[inline(always)]
fn farthest<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    vertices: &[Point<N, 3>],
    direction: &[V; 3],
) -> [V; 3] {
    let mut best = spread(simd, &vertices[0].coords);
    let mut highest = dot(&best, direction);
    for vertex in &vertices[1..] {
        let vertex = spread(simd, &vertex.coords);
        let height = dot(&vertex, direction);
        let is_higher = height.simd_gt(highest);
        best = either(is_higher, &vertex, &best);
        highest = is_higher.select(height, highest);
    }
    best
}

/// Returns the support point of a hull for one pair, computed by [`SupportMap::core_support`] of
/// the hull.
#[inline(always)]
fn lone_support<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    hull: &Polytope<N, 3>,
    direction: &[V; 3],
) -> [V; 3] {
    let mut toward = Vector::<N, 3>::zeros();
    for (coordinate, number) in toward.as_mut_slice().chunks_mut(1).zip(direction) {
        number.store(coordinate);
    }
    spread(simd, &hull.core_support(&toward).coords)
}
