//! Which points of the two cores a normal and its height belong to.

use super::Separation;
use super::candidate::Candidate;
use super::difference::{Vertex, noise};
use super::simplex::{Simplex, Simplicial};
use crate::math::{Point, Real, Vector};

/// Cap on the number of corners tried.
const ROUNDS: usize = 32;

/// The answer in units of the pair: the points whose difference is `height · normal`.
///
/// They are the mix of the points that made up `vertices`, in the proportions in which the vertices
/// mix to a difference nearest to that; then moved onto the supporting planes of the normal, and
/// sideways half way each until they lie exactly across from each other.
pub(super) fn locate<N: Simplicial<D>, const D: usize>(
    best: &Candidate<N, D>,
    vertices: &[Vertex<N, D>],
) -> Separation<N, D> {
    let (normal, across) = (best.normal, best.normal * best.height);
    let (on1, on2) = mix(&across, vertices);
    let middle = (on1 + (on2 - across)) * N::HALF;
    let on1 = middle + normal * normal.dot(&(best.vertex.on1 - middle));
    Separation {
        distance: best.height,
        normal,
        point1: Point::from(on1),
        point2: Point::from(on1 + across),
    }
}

/// The points on both cores, mixed so that their difference comes nearest to `target`.
fn mix<N: Simplicial<D>, const D: usize>(
    target: &Vector<N, D>,
    vertices: &[Vertex<N, D>],
) -> (Vector<N, D>, Vector<N, D>) {
    let mut simplex = Simplex::new(moved(nearest_to(target, vertices), target));
    let mut nearest = N::nearest(simplex.points());
    let mut best = Mix::of(&simplex, &nearest.weights);
    for _ in 0..ROUNDS {
        let away = nearest.squared > noise::<N>() * noise();
        if nearest.enclosed || !away {
            break;
        }
        let Some(next) = lowest_along(&nearest.point, vertices) else { break };
        let next = moved(next, target);
        simplex.keep(&nearest.weights);
        if simplex.contains(&next) {
            break;
        }
        simplex.push(next);
        nearest = N::nearest(simplex.points());
        // Judged by what the weights make, not by what they should: slivers give poor weights.
        let mut found = Mix::of(&simplex, &nearest.weights);
        if nearest.enclosed && found.miss > noise::<N>() * noise() {
            found = Mix::of_facets(&simplex, found);
        }
        if found.miss >= best.miss {
            break;
        }
        best = found;
    }
    (best.on1, best.on2)
}

/// Points of the cores, mixed by weights.
struct Mix<N: Real, const D: usize> {
    on1: Vector<N, D>,
    on2: Vector<N, D>,
    /// The square of the distance of their difference from the target.
    miss: N,
}

impl<N: Simplicial<D>, const D: usize> Mix<N, D> {
    /// The vertices of the simplex are seen from the target.
    fn of(simplex: &Simplex<N, D>, weights: &[N; 4]) -> Self {
        let zero = Vector::<N, D>::zeros();
        let (mut on1, mut on2, mut missed) = (zero, zero, zero);
        for (vertex, &weight) in simplex.vertices().iter().zip(weights) {
            on1 += vertex.on1 * weight;
            on2 += vertex.on2 * weight;
            missed += vertex.point * weight;
        }
        Self { on1, on2, miss: missed.norm_squared() }
    }

    /// The best over the facets of a simplex that holds the target, or `best`: one so flat that its
    /// volume is mostly rounding errors has poor weights, but its facets come as near.
    fn of_facets(simplex: &Simplex<N, D>, mut best: Self) -> Self {
        for dropped in 0..=D {
            let mut kept = [N::ONE; 4];
            kept[dropped] = N::ZERO;
            let mut facet = *simplex;
            facet.keep(&kept);
            let found = Self::of(&facet, &N::nearest(facet.points()).weights);
            if found.miss < best.miss {
                best = found;
            }
        }
        best
    }
}

/// The vertex as seen from `target`.
fn moved<N: Simplicial<D>, const D: usize>(
    vertex: &Vertex<N, D>,
    target: &Vector<N, D>,
) -> Vertex<N, D> {
    Vertex { point: vertex.point - target, ..*vertex }
}

/// The vertex closest to `target`.
fn nearest_to<'a, N: Simplicial<D>, const D: usize>(
    target: &Vector<N, D>,
    vertices: &'a [Vertex<N, D>],
) -> &'a Vertex<N, D> {
    let (mut best, mut least) = (&vertices[0], N::INFINITY);
    for vertex in vertices {
        let squared = (vertex.point - target).norm_squared();
        if squared < least {
            (best, least) = (vertex, squared);
        }
    }
    best
}

/// The vertex lowest along a direction.
fn lowest_along<'a, N: Simplicial<D>, const D: usize>(
    direction: &Vector<N, D>,
    vertices: &'a [Vertex<N, D>],
) -> Option<&'a Vertex<N, D>> {
    let (mut best, mut least) = (None, N::INFINITY);
    for vertex in vertices {
        let height = direction.dot(&vertex.point);
        if height < least {
            (best, least) = (Some(vertex), height);
        }
    }
    best
}
