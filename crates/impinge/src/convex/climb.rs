//! From a good normal of an overlap to the best one nearby.

use super::candidate::Candidate;
use super::difference::{Difference, Moved, noise};
use super::gjk::nearest_normal;
use super::simplex::Simplicial;
use crate::math::{max, unit_or};

/// Cap on the number of steps; each finds a nearest point.
const STEPS: usize = 40;
/// Cap on the doublings of one step.
const DOUBLINGS: usize = 16;

/// Raises the height of `best` as far as a local search can.
///
/// The difference is moved along the normal until it is free of the origin; the normal `m` of its
/// nearest point then maximises `h(m) + D m·n` for the way `D` it was moved along `n`. As `m·n` is
/// largest at `n`, the height of `m` is no less than that of `n`: this is the proximal point method
/// (R. T. Rockafellar, "Monotone Operators and the Proximal Point Algorithm", 1976), and kinks of
/// `h`, the flat faces, are no trouble to it. Where the heights around hardly differ its steps are
/// short; so each is doubled while that helps, and as the way up may be a ridge that bends, each
/// trial is brought back to the ridge by a step of its own.
pub(super) fn climb<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &mut Candidate<N, D>,
) {
    for _ in 0..STEPS {
        let before = *best;
        let first = raised(difference, &before);
        best.improve(&first);
        let step = first.normal - before.normal;
        let mut stretch = N::TWO;
        for _ in 0..DOUBLINGS {
            let normal = unit_or(&(before.normal + step * stretch), before.normal);
            let trial = raised(difference, &Candidate::along(difference, normal));
            if !best.improve(&trial) {
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

/// One step of the method.
fn raised<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    from: &Candidate<N, D>,
) -> Candidate<N, D> {
    let free = max(-from.height * N::lit(0.25), N::lit(1.0 / 64.0));
    let moved = Moved { inner: difference, by: from.normal * (free - from.height) };
    Candidate::along(difference, nearest_normal(&moved, &from.normal))
}
