//! From a good normal of an overlap to the best one nearby.

use super::candidate::Candidate;
use super::difference::{Difference, Vertex, noise};
use super::gjk::nearest_normal;
use super::simplex::Simplicial;
use crate::math::{Real, Vector, max, unit_or};

/// Cap on the number of steps; each finds a nearest point.
const STEPS: usize = 40;
/// Cap on the doublings of one step.
const DOUBLINGS: usize = 16;

/// A difference moved away from the origin.
struct Moved<'a, N: Real, const D: usize> {
    inner: &'a dyn Difference<N, D>,
    by: Vector<N, D>,
}

impl<N: Real, const D: usize> Difference<N, D> for Moved<'_, N, D> {
    fn lowest(&self, normal: &Vector<N, D>) -> Vertex<N, D> {
        let vertex = self.inner.lowest(normal);
        Vertex { point: vertex.point + self.by, ..vertex }
    }
}

/// Raises the height of `best` as far as a local search can.
///
/// The difference is moved along the normal until it is free of the origin; the normal `m` of its
/// nearest point then maximises `h(m) + D m·n` for the way `D` it was moved along `n`. As `m·n` is
/// largest at `n`, the height of `m` is no less than that of `n`: this is the proximal point method
/// (R. T. Rockafellar, "Monotone Operators and the Proximal Point Algorithm", 1976), and kinks of
/// `h`, the flat faces, are no trouble to it. Where the heights around hardly differ its steps are
/// short; so each is doubled while that helps.
pub(super) fn climb<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &mut Candidate<N, D>,
) {
    for _ in 0..STEPS {
        let before = *best;
        let depth = max(-before.height, N::ZERO);
        let free = max(depth * N::lit(0.25), N::lit(1.0 / 64.0));
        let moved = Moved { inner: difference, by: before.normal * (depth + free) };
        let step = nearest_normal(&moved, &before.normal) - before.normal;
        let mut stretch = N::ONE;
        for _ in 0..DOUBLINGS {
            let normal = unit_or(&(before.normal + step * stretch), before.normal);
            if !best.improve(&Candidate::along(difference, normal)) {
                break;
            }
            stretch *= N::TWO;
        }
        let worth_it = best.height - before.height > noise::<N>() / N::lit(8.0);
        if !worth_it {
            return;
        }
    }
}
