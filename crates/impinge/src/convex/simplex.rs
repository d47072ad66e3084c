//! Up to four points, and the point of their hull nearest to the origin.
//!
//! ```text
//!    tetrahedron -----> faces that the origin -----> their sides -----> their ends
//!         |             lies beyond                       |                  |
//!         |                   |                           |                  |
//!      enclosed         inside a face               inside a side        a corner
//!      4 weights        3 weights                   2 weights            1 weight
//!
//!    Part `i` is the volume (area, length) with corner `i` replaced by the origin. The origin lies
//!    beyond the facet opposite to corner `i` if part `i` and the whole differ in sign. A simplex
//!    that is flat up to `rounding_error` has no sign, so all its facets are searched.
//! ```
//!
//! Deciding by the signs of volumes, and falling back to the faces of a simplex instead of dividing
//! by a small volume, follows M. Montanari, N. Petrinic and E. Barbieri, "Improving the GJK
//! Algorithm for Faster and More Reliable Distance Queries Between Convex Objects" (2017). The code
//! that depends on the dimension is in `simplex2` and `simplex3`;
//! `collide/separation/apart/simplex.rs` has the same case analysis in lanes, without branches.

use super::Separation;
use super::difference::{Difference, Vertex, rounding_error};
use crate::math::{Real, Vector};

/// A scalar type, with those parts of the algorithms that depend on the dimension `D`.
pub(crate) trait Simplicial<const D: usize>: Real {
    /// Returns the point of the hull of one to `D + 1` points that is nearest to the origin.
    fn nearest(points: &[Vector<Self, D>]) -> NearestOfSimplex<Self, D>;

    /// Returns whether the planes (lines in 2D) of all facets of `D + 1` points are farther from
    /// the origin than `radius`. If the hull of the points contains the origin, it then contains a
    /// ball of that radius around the origin. `false` for fewer points.
    fn clears(points: &[Vector<Self, D>], radius: Self) -> bool;

    /// Calls `visit` with a normal of the facet through each choice of `D` of the points. The
    /// normal may have any length; it is zero for a facet without extent.
    fn visit_facets(points: &[Vector<Self, D>], visit: &mut dyn FnMut(&Vector<Self, D>));

    /// Returns the separation of a difference that contains the origin, or misses it only by
    /// rounding. `simplex` is the last simplex of GJK.
    fn deepest(
        difference: &dyn Difference<Self, D>,
        simplex: &Simplex<Self, D>,
    ) -> Separation<Self, D>;
}

/// The point of a simplex nearest to the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearestOfSimplex<N: Real, const D: usize> {
    /// The nearest point, computed from the feature that it lies on, not as a weighted sum of
    /// corners. So its direction is accurate even if it is very close to the origin.
    pub(super) point: Vector<N, D>,
    /// Squared length of `point`.
    pub(super) squared: N,
    /// Barycentric weights of the corners: not negative, with sum 1, and zero for corners outside
    /// the feature that `point` lies on.
    pub(super) weights: [N; 4],
    /// Whether the origin lies in the interior of the simplex; `point` is then zero.
    pub(super) enclosed: bool,
}

impl<N: Real, const D: usize> NearestOfSimplex<N, D> {
    pub(super) fn new(point: Vector<N, D>, weights: [N; 4]) -> Self {
        Self { point, squared: point.norm_squared(), weights, enclosed: false }
    }

    /// Returns the result for an origin inside the simplex, which has the barycentric coordinates
    /// `weights`.
    pub(super) fn enclosed(weights: [N; 4]) -> Self {
        Self { enclosed: true, ..Self::new(Vector::<N, D>::zeros(), weights) }
    }

    /// Returns the result if the corner `index`, which lies at `point`, is nearest.
    pub(super) fn corner(index: usize, point: &Vector<N, D>) -> Self {
        let mut weights = [N::ZERO; 4];
        weights[index] = N::ONE;
        Self::new(*point, weights)
    }

    /// Returns whether all of `corners` have a positive weight.
    pub(super) fn weighs<const K: usize>(&self, corners: [usize; K]) -> bool {
        corners.iter().all(|&corner| self.weights[corner] > N::ZERO)
    }

    /// Returns the nearer of two results; `self` in a tie, and if `other` is `None`.
    pub(super) fn or_nearer(self, other: Option<Self>) -> Self {
        match other {
            Some(other) if other.squared < self.squared => other,
            _ => self,
        }
    }
}

/// Returns the point nearest to the origin on the segment between the corners `i` and `j`.
///
/// If the ends are closer to each other than `rounding_error`, returns the nearer end.
pub(super) fn nearest_on_segment<N: Real, const D: usize>(
    points: &[Vector<N, D>],
    [i, j]: [usize; 2],
) -> NearestOfSimplex<N, D> {
    let (a, b) = (&points[i], &points[j]);
    let edge = b - a;
    let squared = edge.norm_squared();
    let (along, back) = (-a.dot(&edge), b.dot(&edge));
    let a_is_nearer = along < back;
    // The test of `squared` makes the division below safe; NaN also ends here.
    let inside =
        squared > rounding_error::<N>() * rounding_error() && along > N::ZERO && back > N::ZERO;
    if !inside {
        return if a_is_nearer {
            NearestOfSimplex::corner(i, a)
        } else {
            NearestOfSimplex::corner(j, b)
        };
    }
    let end = if a_is_nearer { a } else { b };
    let across = end - edge * (end.dot(&edge) / squared);
    let mut weights = [N::ZERO; 4];
    weights[j] = along / squared;
    weights[i] = N::ONE - weights[j];
    // Subtracting the remainder along the edge again makes the direction accurate to rounding.
    NearestOfSimplex::new(across - edge * (across.dot(&edge) / squared), weights)
}

/// One to `D + 1` points of a difference.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Simplex<N: Real, const D: usize> {
    vertices: [Vertex<N, D>; 4],
    /// Copies of the points in `vertices`, in contiguous memory.
    points: [Vector<N, D>; 4],
    /// Weights of the points in the nearest point, as set by [`Self::keep`].
    weights: [N; 4],
    len: usize,
}

impl<N: Simplicial<D>, const D: usize> Simplex<N, D> {
    /// Creates a simplex of one point.
    pub(super) fn new(vertex: Vertex<N, D>) -> Self {
        let zero = Vector::<N, D>::zeros();
        let weights = [N::ONE, N::ZERO, N::ZERO, N::ZERO];
        Self { vertices: [vertex; 4], points: [vertex.point, zero, zero, zero], weights, len: 1 }
    }

    /// Returns the vertices: points of the difference, and the points of both cores that they come
    /// from.
    pub(super) fn vertices(&self) -> &[Vertex<N, D>] {
        &self.vertices[..self.len]
    }

    /// Returns the points of the difference, without the points of the cores.
    pub(super) fn points(&self) -> &[Vector<N, D>] {
        &self.points[..self.len]
    }

    /// Returns the weights of the points, as set by [`Self::keep`]; zero for points added later.
    pub(super) fn weights(&self) -> &[N] {
        &self.weights[..self.len]
    }

    /// Returns whether one of the points equals the point of `vertex` exactly.
    pub(super) fn contains(&self, vertex: &Vertex<N, D>) -> bool {
        self.points().contains(&vertex.point)
    }

    /// Adds a point, with weight zero. Precondition: there are at most `D` points.
    pub(super) fn push(&mut self, vertex: Vertex<N, D>) {
        self.vertices[self.len] = vertex;
        self.points[self.len] = vertex.point;
        self.weights[self.len] = N::ZERO;
        self.len += 1;
    }

    /// Undoes the last [`Self::push`].
    pub(super) fn pop(&mut self) {
        self.len -= 1;
    }

    /// Drops the points whose weight is not positive, and sets the weights of the others.
    pub(super) fn keep(&mut self, weights: &[N; 4]) {
        let mut kept = 0;
        for (index, &weight) in weights.iter().enumerate().take(self.len) {
            if weight > N::ZERO {
                if kept < index {
                    self.vertices[kept] = self.vertices[index];
                    self.points[kept] = self.points[index];
                }
                self.weights[kept] = weight;
                kept += 1;
            }
        }
        // NaN weights leave one point, because a simplex is never empty.
        self.len = kept.max(1);
    }
}
