//! Nearest point to the origin on the faces of a tetrahedron that meet in its newest corner, for
//! all lanes at once.
//!
//! ```text
//!            w  newest            candidates: the edges w p0, w p1, w p2 and the inside of the
//!           /|\                   faces w p0 p1, w p1 p2, w p2 p0; corners may coincide, so that
//!          / | \                  a triangle, an edge or a point is a tetrahedron too
//!        p0--+--p1
//!          \ | /
//!           p2
//! ```
//!
//! The old face p0 p1 p2 is skipped, because the newest corner lies beyond it, toward the origin.

use crate::math::lanes::{cross, dot, either, either_mask, lit, minus, negated, plus, times};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Real, Wide};

/// The origin is clearly inside a tetrahedron if its distance from the plane of each face exceeds
/// this: 2⁻¹⁰ of the pair's size.
const CLEAR: f64 = 1.0 / 1024.0;

/// A point of the difference of two cores, and the point of the first core that it comes from.
#[derive(Clone, Copy)]
pub(super) struct LaneCorner<V> {
    /// Point of the second core minus point of the first, in units of the pair and in the frame of
    /// the first core.
    pub(super) point: [V; 3],
    pub(super) on1: [V; 3],
}

impl<V> LaneCorner<V> {
    /// Selects `other` in the lanes of `is_other`, else `self`.
    #[inline(always)]
    pub(super) fn or<S: Simd>(&self, other: &Self, is_other: V::Mask) -> Self
    where
        V: Wide<S>,
    {
        Self {
            point: either(is_other, &other.point, &self.point),
            on1: either(is_other, &other.on1, &self.on1),
        }
    }
}

/// Up to three corners and the point of their hull nearest to the origin.
#[derive(Clone, Copy)]
pub(super) struct LaneSimplex<V> {
    /// Corners. If fewer than three corners span the feature, the others have weight zero and may
    /// be copies.
    pub(super) corners: [LaneCorner<V>; 3],
    /// Barycentric weights of the corners; their sum is 1.
    pub(super) weights: [V; 3],
    /// Point of the hull nearest to the origin.
    pub(super) nearest: [V; 3],
    /// Squared length of `nearest`.
    pub(super) squared: V,
}

/// The nearest point to the origin on the candidate features so far, and the old corners of the
/// feature that this point lies on.
struct BestFeature<V> {
    nearest: [V; 3],
    squared: V,
    /// Weights of up to two old corners.
    weights: [V; 2],
    /// Indices 0, 1 or 2 of these corners, as values of the scalar type.
    corner_indices: [V; 2],
}

impl<V> BestFeature<V> {
    /// Returns the nearer feature in each lane: `other` if it is admitted and nearer to the origin,
    /// else `self`.
    #[inline(always)]
    fn or_nearer<S: Simd>(self, (other, is_admitted): (Self, V::Mask)) -> Self
    where
        V: Wide<S>,
    {
        let is_nearer = other.squared.simd_lt(self.squared) & is_admitted;
        Self {
            nearest: either(is_nearer, &other.nearest, &self.nearest),
            squared: is_nearer.select(other.squared, self.squared),
            weights: either(is_nearer, &other.weights, &self.weights),
            corner_indices: either(is_nearer, &other.corner_indices, &self.corner_indices),
        }
    }
}

/// The newest corner of a simplex, and its edges to the old corners.
struct Fan<'a, V> {
    old: &'a LaneSimplex<V>,
    newest: &'a LaneCorner<V>,
    /// Vectors from the newest corner to the old corners.
    edges: [[V; 3]; 3],
    /// Squared lengths of the edges.
    squares: [V; 3],
    /// Cross products of the vector from the newest corner to the origin with the edges.
    turns: [[V; 3]; 3],
}

impl<V: Copy> LaneSimplex<V> {
    /// Creates a simplex of a single corner.
    #[inline(always)]
    pub(super) fn new<S: Simd, N: Real>(simd: S, corner: LaneCorner<V>) -> Self
    where
        V: Wide<S, Scalar = N>,
    {
        let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
        Self {
            corners: [corner; 3],
            weights: [one, zero, zero],
            nearest: corner.point,
            squared: dot(&corner.point, &corner.point),
        }
    }

    /// Adds a corner. Returns the corners of the feature nearest to the origin as the new simplex,
    /// and the lanes where the hull of all four corners contains the ball of radius [`CLEAR`]
    /// around the origin.
    ///
    /// In a lane with two corners the third is a copy, which adds no nearer point. If no lane has
    /// three corners with a weight, the features of the third corner are skipped.
    #[inline(always)]
    pub(super) fn with<S: Simd, N: Real>(&self, simd: S, newest: &LaneCorner<V>) -> (Self, V::Mask)
    where
        V: Wide<S, Scalar = N>,
    {
        let zero = V::all(simd, N::ZERO);
        let fan = Fan::new(self, newest);
        let (mut best, _) = fan.edge(simd, 0);
        let mut holds_origin = zero.simd_gt(zero);
        best = best.or_nearer(fan.edge(simd, 1)).or_nearer(fan.face(simd, [0, 1]));
        if self.weights[2].simd_gt(zero).any_true() {
            best = best.or_nearer(fan.edge(simd, 2));
            best = best.or_nearer(fan.face(simd, [1, 2])).or_nearer(fan.face(simd, [2, 0]));
            holds_origin = fan.holds_origin(simd);
        }
        (fan.reduced(simd, &best), holds_origin)
    }
}

impl<'a, V: Copy> Fan<'a, V> {
    #[inline(always)]
    fn new<S: Simd>(old: &'a LaneSimplex<V>, newest: &'a LaneCorner<V>) -> Self
    where
        V: Wide<S>,
    {
        let to_origin = negated(&newest.point);
        let [first, second, third] = &old.corners;
        let edges = [
            minus(&first.point, &newest.point),
            minus(&second.point, &newest.point),
            minus(&third.point, &newest.point),
        ];
        let [edge1, edge2, edge3] = &edges;
        let squares = [dot(edge1, edge1), dot(edge2, edge2), dot(edge3, edge3)];
        let turns = [cross(&to_origin, edge1), cross(&to_origin, edge2), cross(&to_origin, edge3)];
        Self { old, newest, edges, squares, turns }
    }

    /// Returns the point nearest to the origin on the edge from the newest corner to the old corner
    /// `old`, ends included, and the lanes where this edge has a length.
    #[inline(always)]
    fn edge<S: Simd, N: Real>(&self, simd: S, old: usize) -> (BestFeature<V>, V::Mask)
    where
        V: Wide<S, Scalar = N>,
    {
        let (zero, one) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
        let (edge, newest) = (&self.edges[old], &self.newest.point);
        let has_length = self.squares[old].simd_gt(zero);
        let share = (-dot(newest, edge) / self.squares[old]).smaller(one).larger(zero);
        let share = has_length.select(share, zero);
        let nearest = plus(newest, &times(edge, share));
        let corner_index = index(simd, old);
        let feature = BestFeature {
            squared: dot(&nearest, &nearest),
            nearest,
            weights: [share, zero],
            corner_indices: [corner_index, corner_index],
        };
        (feature, has_length)
    }

    /// Returns the point nearest to the origin in the plane through the newest corner and the old
    /// corners `one` and `two`, and the lanes where this point lies inside their triangle and the
    /// triangle has an area.
    #[inline(always)]
    fn face<S: Simd, N: Real>(&self, simd: S, [one, two]: [usize; 2]) -> (BestFeature<V>, V::Mask)
    where
        V: Wide<S, Scalar = N>,
    {
        let (zero, whole) = (V::all(simd, N::ZERO), V::all(simd, N::ONE));
        let normal = cross(&self.edges[one], &self.edges[two]);
        let squared = dot(&normal, &normal);
        let inverse = whole / squared;
        let weight1 = dot(&self.turns[two], &normal) * inverse;
        let weight2 = -(dot(&self.turns[one], &normal) * inverse);
        let height = dot(&normal, &self.newest.point);
        let tiny = V::all(simd, N::lit(64.0) * N::EPSILON * N::EPSILON);
        let is_wide = squared.simd_gt(tiny * self.squares[one] * self.squares[two]);
        let is_within = weight1.simd_gt(zero)
            & weight2.simd_gt(zero)
            & (weight1 + weight2).simd_lt(whole)
            & is_wide;
        let feature = BestFeature {
            nearest: times(&normal, height / squared),
            squared: height * height / squared,
            weights: [weight1, weight2],
            corner_indices: [index(simd, one), index(simd, two)],
        };
        (feature, is_within)
    }

    /// Returns the lanes where the origin is clearly on the inner side of each face of the
    /// tetrahedron.
    #[inline(always)]
    fn holds_origin<S: Simd, N: Real>(&self, simd: S) -> V::Mask
    where
        V: Wide<S, Scalar = N>,
    {
        let [first, second, third] = &self.old.corners;
        let base = cross(&minus(&second.point, &first.point), &minus(&third.point, &first.point));
        let of_newest = dot(&base, &minus(&self.newest.point, &first.point));
        let mut holds = is_clear(simd, &base, -dot(&base, &first.point), of_newest);
        for [one, two, opposite] in [[0, 1, 2], [1, 2, 0], [2, 0, 1]] {
            let normal = cross(&self.edges[one], &self.edges[two]);
            let of_origin = -dot(&normal, &self.newest.point);
            holds &= is_clear(simd, &normal, of_origin, dot(&normal, &self.edges[opposite]));
        }
        holds
    }

    /// Returns the simplex of the newest corner and the old corners of the feature `best`.
    #[inline(always)]
    fn reduced<S: Simd, N: Real>(&self, simd: S, best: &BestFeature<V>) -> LaneSimplex<V>
    where
        V: Wide<S, Scalar = N>,
    {
        let [weight1, weight2] = best.weights;
        LaneSimplex {
            corners: [
                *self.newest,
                self.at(simd, best.corner_indices[0]),
                self.at(simd, best.corner_indices[1]),
            ],
            weights: [V::all(simd, N::ONE) - weight1 - weight2, weight1, weight2],
            nearest: best.nearest,
            squared: best.squared,
        }
    }

    /// Returns the old corner with this index.
    #[inline(always)]
    fn at<S: Simd, N: Real>(&self, simd: S, corner_index: V) -> LaneCorner<V>
    where
        V: Wide<S, Scalar = N>,
    {
        let [first, second, third] = &self.old.corners;
        first
            .or(second, corner_index.simd_eq(index(simd, 1)))
            .or(third, corner_index.simd_eq(index(simd, 2)))
    }
}

/// Returns the lanes where the origin and another point lie on the same side of a plane, and the
/// origin is farther than [`CLEAR`] from it. `of_origin` and `of_point` are their heights above the
/// plane, times the length of `normal`.
#[inline(always)]
fn is_clear<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    normal: &[V; 3],
    of_origin: V,
    of_point: V,
) -> V::Mask {
    let zero = V::all(simd, N::ZERO);
    let least = lit::<S, N, V>(simd, CLEAR * CLEAR) * dot(normal, normal);
    let is_far = (of_origin * of_origin).simd_gt(least);
    let both = either_mask(of_origin.simd_gt(zero), of_point.simd_gt(zero), of_point.simd_lt(zero));
    is_far & both
}

/// Returns the index of an old corner as a value of the scalar type.
#[inline(always)]
fn index<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, old: usize) -> V {
    lit(simd, [0.0, 1.0, 2.0][old])
}
