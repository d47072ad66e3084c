//! From a good normal of an overlap to the best one nearby.

use super::candidate::SupportCandidate;
use super::difference::{Difference, Moved, noise};
use super::gjk::nearest_normal;
use super::simplex::Simplicial;
use crate::math::{Vector, max, unit_or};

/// Cap on the number of steps; each finds a nearest point.
const STEPS: usize = 40;
/// Cap on the doublings of one step.
const DOUBLINGS: usize = 16;

/// Raises the height of `best` as far as a local search can.
///
/// The difference is moved along the normal `n` by `D` until it is free of the origin. The normal
/// `m` of its nearest point then maximises `h(m) + D m·n`. As `m·n` is largest at `n`, the height
/// of `m` is at least that of `n`. This is the proximal point method (R. T. Rockafellar, "Monotone
/// Operators and the Proximal Point Algorithm", 1976), which is not disturbed by kinks of `h`, the
/// flat faces. If heights hardly differ nearby, its steps are short, so each is doubled while that
/// helps. If that does not help, the ascent may follow a curved ridge: then each trial is first
/// brought back to the ridge by a step of its own.
pub(super) fn climb<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &mut SupportCandidate<N, D>,
) {
    for _ in 0..STEPS {
        let before = *best;
        let first = raised(difference, &before);
        best.improve(&first);
        let step = first.normal - before.normal;
        let along = |normal| SupportCandidate::along(difference, normal);
        if !stride(best, &step, along) {
            stride(best, &step, |normal| raised(difference, &along(normal)));
        }
        let worth_it = best.height - before.height > noise::<N>() / N::lit(8.0);
        if !worth_it {
            return;
        }
    }
}

/// Continues in the direction of a step, twice as far each time, while that helps; returns whether
/// it did. `trial` makes a candidate from a normal.
fn stride<N: Simplicial<D>, const D: usize>(
    best: &mut SupportCandidate<N, D>,
    step: &Vector<N, D>,
    trial: impl Fn(Vector<N, D>) -> SupportCandidate<N, D>,
) -> bool {
    let (start, mut stretch) = (best.normal, N::ONE);
    for round in 0..DOUBLINGS {
        let normal = unit_or(&(start + step * stretch), start);
        if !best.improve(&trial(normal)) {
            return round > 0;
        }
        stretch *= N::TWO;
    }
    true
}

/// Computes one step of the method.
fn raised<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    from: &SupportCandidate<N, D>,
) -> SupportCandidate<N, D> {
    let free = max(-from.height * N::lit(0.25), N::lit(1.0 / 64.0));
    let moved = Moved { inner: difference, by: from.normal * (free - from.height) };
    SupportCandidate::along(difference, nearest_normal(&moved, &from.normal))
}
