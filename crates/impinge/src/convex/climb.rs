//! Local search for the normal of an overlap with the largest height, starting from a good normal.

use super::candidate::SupportCandidate;
use super::difference::{Difference, Moved, rounding_error};
use super::gjk::nearest_normal;
use super::simplex::Simplicial;
use crate::math::{Vector, max, unit_or};

/// Cap on the number of steps; each step searches for at least one nearest point.
const STEPS: usize = 40;
/// Cap on the doublings of one step.
const DOUBLINGS: usize = 16;

/// Raises the height of `best` to a local maximum, up to the cap on the steps.
///
/// The difference is moved along the normal `n` by a distance `s`, so that it no longer contains
/// the origin. The normal `m` of its nearest point then maximises `h(m) + s m·n`. As `m·n` is
/// largest at `n`, the height of `m` is at least that of `n`. This is the proximal point method (R.
/// T. Rockafellar, "Monotone Operators and the Proximal Point Algorithm", 1976), which also works
/// at the kinks of `h`, the normals of flat faces. If heights hardly differ nearby, the steps of
/// the method are short, so each step is doubled while the height grows. If doubling does not raise
/// the height, the ascent may follow a curved ridge: then each trial is first moved back to the
/// ridge by a step of the method.
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
        let worth_it = best.height - before.height > rounding_error::<N>() / N::lit(8.0);
        if !worth_it {
            return;
        }
    }
}

/// Tries the normal of `best` plus `step` times 1, 2, 4 and so on, while the height grows. Returns
/// whether the height grew at least once. `trial` makes a candidate from a normal.
fn stride<N: Simplicial<D>, const D: usize>(
    best: &mut SupportCandidate<N, D>,
    step: &Vector<N, D>,
    trial: impl Fn(Vector<N, D>) -> SupportCandidate<N, D>,
) -> bool {
    let (start, mut factor) = (best.normal, N::ONE);
    for round in 0..DOUBLINGS {
        let normal = unit_or(&(start + step * factor), start);
        if !best.improve(&trial(normal)) {
            return round > 0;
        }
        factor *= N::TWO;
    }
    true
}

/// Returns the candidate after one step of the proximal point method.
fn raised<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    from: &SupportCandidate<N, D>,
) -> SupportCandidate<N, D> {
    let free = max(-from.height * N::lit(0.25), N::lit(1.0 / 64.0));
    let moved = Moved { inner: difference, by: from.normal * (free - from.height) };
    SupportCandidate::along(difference, nearest_normal(&moved, &from.normal))
}
