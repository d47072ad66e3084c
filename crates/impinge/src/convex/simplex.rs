//! Up to four points, and their hull's point nearest to the origin.
//!
//! The idea of deciding by the signs of signed volumes, and of falling back to the faces of a
//! simplex rather than dividing by a small volume, follows M. Montanari, N. Petrinic and
//! E. Barbieri, "Improving the GJK Algorithm for Faster and More Reliable Distance Queries Between
//! Convex Objects" (2017). What is particular to a dimension stands in `simplex2` and `simplex3`.

use super::Separation;
use super::difference::{Difference, Vertex, noise};
use crate::math::{Real, Vector};

/// The scalar `Self` with the part of the algorithms that is particular to `D` dimensions.
pub(crate) trait Simplicial<const D: usize>: Real {
    /// The point nearest to the origin of the hull of one to `D + 1` points.
    fn nearest(points: &[Vector<Self, D>]) -> NearestOfSimplex<Self, D>;

    /// Whether the planes of all facets of `D + 1` points are farther from the origin than a radius: where
    /// the points enclose the origin, they hold a ball around it. `false` for fewer points.
    fn clears(points: &[Vector<Self, D>], radius: Self) -> bool;

    /// Visits a vector perpendicular to each choice of `D` of the points; not of unit length.
    fn visit_facets(points: &[Vector<Self, D>], visit: &mut dyn FnMut(&Vector<Self, D>));

    /// The best normal of a difference that holds the origin, or misses it by rounding errors only.
    fn deepest(
        difference: &dyn Difference<Self, D>,
        simplex: &Simplex<Self, D>,
    ) -> Separation<Self, D>;
}

/// The point of a simplex nearest to the origin.
#[derive(Clone, Copy, Debug)]
pub(crate) struct NearestOfSimplex<N: Real, const D: usize> {
    /// The point. Its direction comes from the feature it lies in, not from a weighted sum of the
    /// corners, and is right however near the origin is.
    pub(super) point: Vector<N, D>,
    /// The square of its length.
    pub(super) squared: N,
    /// What the corners contribute, none negative, of sum 1; zero for corners outside the feature.
    pub(super) weights: [N; 4],
    /// The origin lies in the interior; `point` is then zero.
    pub(super) enclosed: bool,
}

impl<N: Real, const D: usize> NearestOfSimplex<N, D> {
    pub(super) fn new(point: Vector<N, D>, weights: [N; 4]) -> Self {
        Self { point, squared: point.norm_squared(), weights, enclosed: false }
    }

    /// The origin is inside, at these weights.
    pub(super) fn enclosed(weights: [N; 4]) -> Self {
        Self { enclosed: true, ..Self::new(Vector::<N, D>::zeros(), weights) }
    }

    /// The corner number `index`, at `point`.
    pub(super) fn corner(index: usize, point: &Vector<N, D>) -> Self {
        let mut weights = [N::ZERO; 4];
        weights[index] = N::ONE;
        Self::new(*point, weights)
    }

    /// Whether all of these corners contribute.
    pub(super) fn weighs<const K: usize>(&self, corners: [usize; K]) -> bool {
        corners.iter().all(|&corner| self.weights[corner] > N::ZERO)
    }

    /// The nearer of two.
    pub(super) fn or_nearer(self, other: Option<Self>) -> Self {
        match other {
            Some(other) if other.squared < self.squared => other,
            _ => self,
        }
    }
}

/// The point nearest to the origin of the segment between the corners numbered `i` and `j`.
///
/// Ends closer to each other than the noise count as one.
pub(super) fn nearest_on_segment<N: Real, const D: usize>(
    points: &[Vector<N, D>],
    [i, j]: [usize; 2],
) -> NearestOfSimplex<N, D> {
    let (a, b) = (&points[i], &points[j]);
    let edge = b - a;
    let squared = edge.norm_squared();
    let (along, back) = (-a.dot(&edge), b.dot(&edge));
    let a_is_nearer = along < back;
    // The test of `squared` keeps the division below safe; NaN ends here too.
    let inside = squared > noise::<N>() * noise() && along > N::ZERO && back > N::ZERO;
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
    // Taking out what is left along the edge once more makes the direction right to the last bits.
    NearestOfSimplex::new(across - edge * (across.dot(&edge) / squared), weights)
}

/// One to `D + 1` points of a difference.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Simplex<N: Real, const D: usize> {
    vertices: [Vertex<N, D>; 4],
    /// The points of `vertices` again, in a row.
    points: [Vector<N, D>; 4],
    /// What they contribute to the nearest point; as given to [`Self::keep`].
    weights: [N; 4],
    len: usize,
}

impl<N: Simplicial<D>, const D: usize> Simplex<N, D> {
    /// One point.
    pub(super) fn new(vertex: Vertex<N, D>) -> Self {
        let zero = Vector::<N, D>::zeros();
        let weights = [N::ONE, N::ZERO, N::ZERO, N::ZERO];
        Self { vertices: [vertex; 4], points: [vertex.point, zero, zero, zero], weights, len: 1 }
    }

    /// The points with what they came from.
    pub(super) fn vertices(&self) -> &[Vertex<N, D>] {
        &self.vertices[..self.len]
    }

    /// The points.
    pub(super) fn points(&self) -> &[Vector<N, D>] {
        &self.points[..self.len]
    }

    /// The weights of the points.
    pub(super) fn weights(&self) -> &[N] {
        &self.weights[..self.len]
    }

    /// Whether the simplex has this very point already.
    pub(super) fn contains(&self, vertex: &Vertex<N, D>) -> bool {
        self.points().contains(&vertex.point)
    }

    /// Adds a point; there are at most `D` before.
    pub(super) fn push(&mut self, vertex: Vertex<N, D>) {
        self.vertices[self.len] = vertex;
        self.points[self.len] = vertex.point;
        self.weights[self.len] = N::ZERO;
        self.len += 1;
    }

    /// Takes back the last [`Self::push`].
    pub(super) fn pop(&mut self) {
        self.len -= 1;
    }

    /// Drops the points without weight, and remembers the weights of the others.
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
        // Weights that are not numbers leave one point: a simplex is never empty.
        self.len = kept.max(1);
    }
}
