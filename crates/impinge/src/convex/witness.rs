//! Finds the points of the two cores that belong to a normal and its height.
//!
//! A mix (weighted mean) of points of the difference is the difference of the mixes of the core
//! points that they come from. These mixes lie in the cores, because the cores are convex. No point
//! of the difference is lower along the normal than `height`. If the mix is the point
//! `height · normal`, each point that has a weight lies at exactly this height, so both core points
//! lie on the supporting planes of the normal. The error of a mix is therefore its distance from
//! `height · normal`.

use super::Separation;
use super::candidate::SupportCandidate;
use super::difference::{Difference, Moved, Vertex, rounding_error, tolerance};
use super::gjk::nearest_simplex;
use super::simplex::{Simplex, Simplicial};
use crate::math::{Point, Real, Vector, max, unit};

/// Cap on the number of vertices that [`mix`] adds.
const ROUNDS: usize = 32;
/// Cap on the number of nearest-point searches in [`search`].
const SEARCHES: usize = 16;

/// A point of each core: a weighted mean of points of that core.
#[derive(Clone, Copy)]
pub(super) struct Mix<N: Real, const D: usize> {
    on1: Vector<N, D>,
    on2: Vector<N, D>,
}

impl<N: Simplicial<D>, const D: usize> Mix<N, D> {
    /// Creates the mix with the point `on1` of the first core and `on2` of the second.
    pub(super) fn new(on1: Vector<N, D>, on2: Vector<N, D>) -> Self {
        Self { on1, on2 }
    }

    /// Mixes the core points of the vertices of a simplex with its weights.
    pub(super) fn of(simplex: &Simplex<N, D>) -> Self {
        Self::by(simplex, simplex.weights())
    }

    fn by(simplex: &Simplex<N, D>, weights: &[N]) -> Self {
        let zero = Vector::<N, D>::zeros();
        let (mut on1, mut on2) = (zero, zero);
        for (vertex, &weight) in simplex.vertices().iter().zip(weights) {
            on1 += vertex.on1 * weight;
            on2 += vertex.on2 * weight;
        }
        Self { on1, on2 }
    }

    /// Returns the mix of up to `D + 1` vertices that is nearest to `height · normal` of `best`.
    pub(super) fn nearest(best: &SupportCandidate<N, D>, vertices: &[Vertex<N, D>]) -> Self {
        let target = best.normal * best.height;
        let moved = |vertex: &Vertex<N, D>| moved(vertex, &target);
        let mut simplex = Simplex::new(moved(&vertices[0]));
        vertices[1..].iter().for_each(|vertex| simplex.push(moved(vertex)));
        Self::by(&simplex, &N::nearest(simplex.points()).weights)
    }

    /// Returns the mix nearest to `target` over the facets of a simplex, or `best` if that is
    /// nearer. If the volume of a simplex is mostly rounding error, its weights are poor, but the
    /// weights of one of its facets give a mix as near.
    fn of_facets(simplex: &Simplex<N, D>, mut best: Self, target: &Vector<N, D>) -> Self {
        for dropped in 0..=D {
            let mut kept = [N::ONE; 4];
            kept[dropped] = N::ZERO;
            let mut facet = *simplex;
            facet.keep(&kept);
            let found = Self::by(&facet, &N::nearest(facet.points()).weights);
            if found.miss(target) < best.miss(target) {
                best = found;
            }
        }
        best
    }

    /// Returns the squared distance of the mix from the target.
    fn miss(&self, target: &Vector<N, D>) -> N {
        (self.on2 - self.on1 - target).norm_squared()
    }

    /// Returns whether the points face each other along the normal of `best` and lie on its
    /// supporting planes, up to rounding.
    pub(super) fn meets(&self, best: &SupportCandidate<N, D>) -> bool {
        let slack = N::TWO * rounding_error();
        self.miss(&(best.normal * best.height)) <= slack * slack
    }
}

/// Returns the separation, in units of the pair, with the points of `mix`. These points are moved
/// onto the supporting planes, and perpendicular to the normal until they face each other exactly:
/// the first point by `share` of the offset, the second by the rest.
pub(super) fn placed<N: Simplicial<D>, const D: usize>(
    best: &SupportCandidate<N, D>,
    mix: &Mix<N, D>,
    share: N,
) -> Separation<N, D> {
    let (normal, across) = (best.normal, best.normal * best.height);
    let shared = mix.on1 + (mix.on2 - across - mix.on1) * share;
    let on1 = shared + normal * normal.dot(&(best.vertex.on1 - shared));
    Separation {
        distance: best.height,
        normal,
        point1: Point::from(on1),
        point2: Point::from(on1 + across),
    }
}

/// Returns the fraction of the offset between the two points, perpendicular to the normal, by which
/// the first point is moved; the second is moved by the rest. One half if neither point would leave
/// its core, or if there is no offset.
///
/// A point of a curved surface may be moved, because it leaves the surface only by the square of
/// the distance. A point of an edge must stay. The supporting planes in a direction halfway between
/// the normal and the offset give the distance by which each point would leave its core; the point
/// with the larger distance stays.
fn share<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &SupportCandidate<N, D>,
    mix: &Mix<N, D>,
) -> N {
    let (normal, across) = (best.normal, best.normal * best.height);
    let away = mix.on2 - mix.on1;
    let Some((aside, _)) = unit(&(away - normal * normal.dot(&away))) else { return N::HALF };
    let Some((slant, _)) = unit(&(normal + aside)) else { return N::HALF };
    let ends = difference.lowest(&slant);
    // Distance by which each point leaves its core if it moves by the whole offset; negative
    // inside.
    let beyond1 = slant.dot(&(mix.on2 - across - ends.on1));
    let beyond2 = slant.dot(&(ends.on2 - mix.on1 - across));
    if max(beyond1, beyond2) <= N::ZERO {
        N::HALF
    } else if beyond1 > beyond2 {
        N::ZERO
    } else {
        N::ONE
    }
}

/// Returns the separation with the points of `mix` if [`Mix::meets`] returns `true` for it; else
/// the result of [`locate`].
pub(super) fn finish<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &SupportCandidate<N, D>,
    mix: &Mix<N, D>,
    vertices: &[Vertex<N, D>],
) -> Separation<N, D> {
    if mix.meets(best) {
        return placed(best, mix, N::HALF);
    }
    locate(difference, best, vertices)
}

/// Returns the separation with the mix of `vertices` nearest to `height · normal` or, if
/// [`Mix::meets`] returns `false` for that mix, with the points that [`search`] finds.
pub(super) fn locate<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &SupportCandidate<N, D>,
    vertices: &[Vertex<N, D>],
) -> Separation<N, D> {
    let mix = mix(&(best.normal * best.height), vertices);
    if mix.meets(best) { placed(best, &mix, N::HALF) } else { search(difference, best, &mix) }
}

/// Returns the separation with the points that up to [`SEARCHES`] runs of GJK find, or with the
/// points of `mix` if their error is smaller.
///
/// The difference is moved along the normal until it is well away from the origin. Its nearest
/// point is then a mix of points that are lowest along the normal. If the normal is slightly wrong,
/// which happens only on curved surfaces, the direction to that point is a better one: a step of
/// the proximal point method, as in `climb`.
fn search<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &SupportCandidate<N, D>,
    mix: &Mix<N, D>,
) -> Separation<N, D> {
    let (mut found, mut mix) = (*best, *mix);
    let mut least = mix.miss(&(best.normal * best.height));
    let mut normal = *best;
    for _ in 0..SEARCHES {
        let by = normal.normal * (N::lit(1.0 / 64.0) - normal.height);
        let moved = Moved { inner: difference, by };
        let (candidate, simplex) = nearest_simplex(&moved, &normal.normal);
        let other = Mix::of(&simplex);
        let miss = other.miss(&(normal.normal * normal.height));
        if miss < least {
            (found, mix, least) = (normal, other, miss);
        }
        normal = SupportCandidate::along(difference, candidate);
        let worse = normal.height < best.height - tolerance();
        if mix.meets(&found) || worse {
            break;
        }
    }
    // If the new height is lower by more than rounding, the old normal with slightly offset points
    // is the smaller error; in `f32` this never happens.
    let found = if found.height < best.height - N::TWO * rounding_error() { *best } else { found };
    let share = share(difference, &found, &mix);
    placed(&found, &mix, share)
}

/// Returns the mix of the vertices that is nearest to `target`.
fn mix<N: Simplicial<D>, const D: usize>(
    target: &Vector<N, D>,
    vertices: &[Vertex<N, D>],
) -> Mix<N, D> {
    let mut simplex = Simplex::new(moved(nearest_to(target, vertices), target));
    let mut nearest = N::nearest(simplex.points());
    let mut best = Mix::by(&simplex, &nearest.weights);
    for _ in 0..ROUNDS {
        let away = nearest.squared > rounding_error::<N>() * rounding_error();
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
        // Compares the mixes, not the distances of `nearest`, because the weights of slivers are
        // inaccurate.
        let mut found = Mix::by(&simplex, &nearest.weights);
        if nearest.enclosed && found.miss(target) > rounding_error::<N>() * rounding_error() {
            found = Mix::of_facets(&simplex, found, target);
        }
        if found.miss(target) >= best.miss(target) {
            break;
        }
        best = found;
    }
    best
}

/// Returns a vertex with its point translated by `-target`; its core points are unchanged.
fn moved<N: Simplicial<D>, const D: usize>(
    vertex: &Vertex<N, D>,
    target: &Vector<N, D>,
) -> Vertex<N, D> {
    Vertex { point: vertex.point - target, ..*vertex }
}

/// Returns the vertex nearest to `target`.
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

/// Returns the vertex lowest along a direction; `None` if all heights are NaN or plus infinity.
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
