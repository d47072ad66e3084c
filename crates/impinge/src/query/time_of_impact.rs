//! When two solids that move without turning first touch.

use super::Pair;
use super::pair::{Placed, canonical};
use super::separation::separation;
use crate::math::{AbstractRotation, Isometry, Real, Space, Vector, max_component};
use crate::shape::{Geometry, Shape};

/// A solid that moves along a straight line, with the same velocity at all times.
#[derive(Clone, Copy)]
pub(crate) struct Moving<'a, N: Real, const D: usize> {
    pub(crate) placed: Placed<'a, N, D>,
    pub(crate) velocity: Vector<N, D>,
}

/// At most so many steps are made.
const MAX_STEPS: usize = 128;

/// The first time, zero or more, at which two solids touch that move with constant velocities and
/// do not turn; `None` if they never do.
///
/// Zero if they touch or overlap at the start, however they move. The time is right up to the
/// rounding of the solids' sizes and of their initial distance, and never late by more: solids that
/// pass each other that closely may count as touching. `None` if a pose or velocity is not finite.
/// The unit of time is the one that velocities are lengths per.
///
/// Cost: a few computations of the distance, at most 128. Each step goes as far as the solids
/// certainly stay apart: Newton's method on a convex function, which squares the error where they
/// meet head on and halves it where they graze.
pub fn time_of_impact<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    m1: &Isometry<N, R, D>,
    v1: &Vector<N, D>,
    g1: &dyn Shape<N, D>,
    m2: &Isometry<N, R, D>,
    v2: &Vector<N, D>,
    g2: &dyn Shape<N, D>,
) -> Option<N> {
    let moving1 = Moving { placed: Placed::new(m1, g1), velocity: *v1 };
    let moving2 = Moving { placed: Placed::new(m2, g2), velocity: *v2 };
    (N::tables().time_of_impact)(&moving1, &moving2)
}

/// The first time at which two moving solids touch.
///
/// Conservative advancement (Mirtich, "Impulse-based dynamic simulation", 1996) in the canonical
/// order: with the gap along the normal between the nearest points, and the speed at which that
/// normal sees it closing, the solids stay apart until the gap is used up. If the normal does not
/// see it closing, they stay apart for ever.
pub(crate) fn advance<N: Space<D>, const D: usize>(
    moving1: &Moving<'_, N, D>,
    moving2: &Moving<'_, N, D>,
) -> Option<N> {
    let (placed1, placed2) = (&moving1.placed, &moving2.placed);
    let (start, swapped) = canonical(&placed1.pose, placed1.shape, &placed2.pose, placed2.shape);
    if !start.pose12.is_finite() {
        return None;
    }
    let (first, second) = if swapped { (moving2, moving1) } else { (moving1, moving2) };
    let velocity = first.placed.pose.inverse_vector(&(second.velocity - first.velocity));
    let tolerance = N::lit(8.0) * N::EPSILON * size(&start);
    let (mut pair, mut time) = (start, N::ZERO);
    for _ in 0..MAX_STEPS {
        let found = separation(&pair, N::INFINITY)?;
        if found.distance <= N::ZERO || (time > N::ZERO && found.distance <= tolerance) {
            return Some(time);
        }
        let closing = -found.normal.dot(&velocity);
        if closing <= N::ZERO {
            return None;
        }
        let later = time + found.distance / closing;
        if !later.is_finite_number() {
            return None;
        }
        if later <= time {
            return Some(time);
        }
        time = later;
        pair.pose12.translation = start.pose12.translation + velocity * time;
    }
    Some(time)
}

/// The length that tolerances are in proportion to: the sizes of the solids and how far they are.
fn size<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> N {
    let reach = |geometry: Geometry<'_, N, D>| {
        geometry.as_support_map().map_or(N::ZERO, |map| map.reach() + map.rounding())
    };
    let apart = max_component(&pair.pose12.translation);
    apart + reach(Geometry(pair.first)) + reach(Geometry(pair.second))
}
