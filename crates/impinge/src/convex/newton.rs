//! Newton's method on the normals of curved cores: refines a good normal up to rounding.

use super::candidate::SupportCandidate;
use super::difference::{Difference, rounding_error};
use super::simplex::Simplicial;
use crate::math::{Vector, unit};

/// Cap on the number of steps. From the normals that the other iterations find, one or two steps
/// usually suffice.
const STEPS: usize = 6;

/// Runs Newton's method on the sphere of normals, starting from `best`, which each accepted step
/// replaces. Returns whether the method ended at a normal along which the two support points face
/// each other, up to 64 rounding errors.
///
/// The height of a normal `n` is `n·w` for its lowest point `w`, so the slope of the height is the
/// part of `w` perpendicular to `n`. At the maximum, this slope is zero. A step is accepted only if
/// the height does not fall beyond rounding and the slope at least halves: at kinks of the height
/// (flat faces, sharp edges) steps are rejected, and `best` stays.
pub(super) fn converges<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &mut SupportCandidate<N, D>,
) -> bool {
    let mut slope = across(&best.vertex.point, &best.normal);
    for _ in 0..STEPS {
        if slope.norm() <= rounding_error() {
            return true;
        }
        let Some(step) = step(difference, best, &slope) else { return false };
        let Some((normal, _)) = unit(&(best.normal + step)) else { return false };
        let next = SupportCandidate::along(difference, normal);
        let left = across(&next.vertex.point, &normal);
        let helps = next.height >= best.height - rounding_error::<N>() * N::HALF
            && left.norm() < slope.norm() * N::HALF;
        if !helps {
            return slope.norm() <= rounding_error::<N>() * N::lit(64.0);
        }
        (*best, slope) = (next, left);
    }
    slope.norm() <= rounding_error::<N>() * N::lit(64.0)
}

/// Returns the part of a vector perpendicular to a unit vector.
fn across<N: Simplicial<D>, const D: usize>(v: &Vector<N, D>, n: &Vector<N, D>) -> Vector<N, D> {
    v - n * n.dot(v)
}

/// Returns the step that makes the slope zero, by conjugate gradients (M. Hestenes and E. Stiefel,
/// 1952). There are `D − 1` directions perpendicular to a normal, so `D − 1` rounds give the exact
/// step, up to rounding. `None` if the height is not concave at `best`.
fn step<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &SupportCandidate<N, D>,
    slope: &Vector<N, D>,
) -> Option<Vector<N, D>> {
    let (mut step, mut residual, mut along) = (Vector::<N, D>::zeros(), *slope, *slope);
    for _ in 1..D {
        let squared = residual.norm_squared();
        if squared == N::ZERO {
            break;
        }
        let bent = bend(difference, best, &along)?;
        let curvature = along.dot(&bent);
        let is_peak = curvature < N::ZERO;
        if !is_peak {
            return None;
        }
        let share = squared / curvature;
        step -= along * share;
        let next = residual - bent * share;
        along = next + along * (next.norm_squared() / squared);
        residual = next;
    }
    Some(step)
}

/// Returns the derivative of the slope along a direction perpendicular to the normal, by central
/// differences; `None` if the direction has no length.
fn bend<N: Simplicial<D>, const D: usize>(
    difference: &dyn Difference<N, D>,
    best: &SupportCandidate<N, D>,
    along: &Vector<N, D>,
) -> Option<Vector<N, D>> {
    let (direction, length) = unit(along)?;
    let turn = N::EPSILON.sqrt() * N::lit(256.0);
    let at = |sign: N| {
        let (normal, _) = unit(&(best.normal + direction * (turn * sign)))?;
        Some(difference.lowest(&normal).point)
    };
    let change = (at(N::ONE)? - at(-N::ONE)?) / (turn * N::TWO);
    let bend = across(&change, &best.normal) - direction * best.height;
    Some(bend * length)
}
