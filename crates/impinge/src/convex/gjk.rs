//! The point of a difference nearest to the origin.
//!
//! ```text
//!              difference                upper = |nearest point of the simplex|
//!           .-------.                    along = nearest / upper, the next normal
//!    o - - -|*      |                    lower = height of `along`: its lowest support point
//!      lower '.     |                    upper - lower <= gap: done
//!             '-----'
//! ```
//!
//! E. Gilbert, D. Johnson and S. Keerthi, "A Fast Procedure for Computing the Distance Between
//! Complex Objects in Three-Dimensional Space" (1988). Stopping on the gap between the bounds
//! follows G. van den Bergen, "A Fast and Robust GJK Implementation for Collision Detection of
//! Convex Objects" (1999).

use smallvec::SmallVec;

use super::Separation;
use super::candidate::SupportCandidate;
use super::difference::{Difference, noise, tolerance};
use super::newton::settles;
use super::polish::{lowest, polish};
use super::refine::{Bundle, refine};
use super::simplex::{NearestOfSimplex, Simplex, Simplicial};
use super::witness::{Mix, locate, placed, settle};
use crate::math::{Real, Vector, max, unit_or};

/// Cap on the number of support points. Flat faces take about six, curved ones up to about thirty.
/// A search that reaches it is refined from the best normal so far.
const ROUNDS: usize = 64;

/// A depth, in units of the pair, that is far more than rounding: 2⁻¹⁰.
const CLEAR: f64 = 1.0 / 1024.0;

/// How the search ended.
enum Outcome {
    /// The difference is certainly beyond the limit.
    Beyond,
    /// The difference contains the origin, or is nearer to it than the noise.
    Overlap,
    /// The nearest point is found, or arithmetic comes no closer.
    Apart,
    /// A point is nearer than `near`.
    Near,
}

struct GjkSearch<N: Real, const D: usize> {
    simplex: Simplex<N, D>,
    /// Best normal so far; its height is a lower bound of the distance.
    best: SupportCandidate<N, D>,
    /// Normal of the nearest point so far.
    last: SupportCandidate<N, D>,
    /// Length of the nearest point so far: an upper bound of the distance.
    upper: N,
    /// Gap between the bounds at which the search stops.
    gap: N,
    /// The lower bound used is that of `last`, whose points lie across from each other, not that of
    /// `best`.
    for_points: bool,
    /// A point nearer than this ends the search.
    near: N,
}

/// Result for two cores.
pub(super) enum Answer<N: Real, const D: usize> {
    Signed(Separation<N, D>),
    /// The cores inflated by their radii certainly overlap; the depth was not asked for.
    Overlap,
}

/// Returns the signed distance of the difference from the origin, searched from the unit vector
/// `start`, in units of the pair; `None` if it is above `limit`.
pub(super) fn solve<N, S, const D: usize>(
    difference: &S,
    start: &Vector<N, D>,
    limit: N,
) -> Option<Separation<N, D>>
where
    N: Simplicial<D>,
    S: Difference<N, D>,
{
    match answer(difference, start, limit, None)? {
        Answer::Signed(found) => Some(found),
        Answer::Overlap => unreachable!("nobody was content with an overlap"),
    }
}

/// Computes [`solve`]; with a `rounding`, a certain overlap of the cores inflated by it is enough
/// (see [`overlaps`]). If they are apart, the steps are the same.
pub(super) fn answer<N, S, const D: usize>(
    difference: &S,
    start: &Vector<N, D>,
    limit: N,
    rounding: Option<N>,
) -> Option<Answer<N, D>>
where
    N: Simplicial<D>,
    S: Difference<N, D>,
{
    let mut search = GjkSearch::new(SupportCandidate::along(difference, *start));
    search.near = rounding.map_or(N::ZERO, near);
    let mut outcome = Outcome::Apart;
    let rough: &[N] = if difference.is_flat() { &[] } else { &[coarse_gap(), rough_gap()] };
    for &gap in rough {
        search.gap = gap;
        outcome = search.run(difference, limit);
        if !matches!(outcome, Outcome::Apart) {
            break;
        }
        if let Some(polished) = search.polished(difference) {
            return (polished.distance <= limit).then_some(Answer::Signed(polished));
        }
    }
    if matches!(outcome, Outcome::Apart) {
        search.gap = gap();
        outcome = search.run(difference, limit);
    }
    match outcome {
        Outcome::Beyond => None,
        Outcome::Near => Some(Answer::Overlap),
        Outcome::Overlap if rounding.is_some_and(|radius| search.clears(difference, radius)) => {
            Some(Answer::Overlap)
        }
        Outcome::Overlap => Some(Answer::Signed(search.finish_overlap(difference))),
        Outcome::Apart => Some(Answer::Signed(search.finish(difference))),
    }
}

/// Returns the distance of points below which solids with this radius certainly overlap.
fn near<N: Real>(rounding: N) -> N {
    rounding - N::lit(CLEAR)
}

/// Returns whether the difference inflated by `radius` certainly contains the origin: by a simplex
/// that contains a ball around it, or by a point nearer than the radius. `false` without a search
/// if the depth along `start` is less than `min_depth`.
pub(super) fn overlaps<N, S, const D: usize>(
    difference: &S,
    start: &Vector<N, D>,
    radius: N,
    min_depth: N,
) -> bool
where
    N: Simplicial<D>,
    S: Difference<N, D>,
{
    let mut search = GjkSearch::new(SupportCandidate::along(difference, *start));
    search.near = near(radius);
    if search.best.height > radius - min_depth {
        return false;
    }
    match search.run(difference, radius) {
        Outcome::Near => true,
        Outcome::Overlap => search.is_clear(),
        Outcome::Beyond | Outcome::Apart => false,
    }
}

/// Returns the normal of the nearest point of a difference well away from the origin.
pub(super) fn nearest_normal<N: Simplicial<D>, const D: usize>(
    difference: &impl Difference<N, D>,
    start: &Vector<N, D>,
) -> Vector<N, D> {
    let mut search = GjkSearch::new(SupportCandidate::along(difference, *start));
    (search.gap, search.for_points) = (noise(), false);
    search.run(difference, N::INFINITY);
    search.best.normal
}

/// Computes [`nearest_normal`] to the limit of arithmetic, with the points around the nearest one.
pub(super) fn nearest_simplex<N: Simplicial<D>, const D: usize>(
    difference: &impl Difference<N, D>,
    start: &Vector<N, D>,
) -> (Vector<N, D>, Simplex<N, D>) {
    let mut search = GjkSearch::new(SupportCandidate::along(difference, *start));
    search.gap = N::ZERO;
    search.run(difference, N::INFINITY);
    (search.last.normal, search.simplex)
}

impl<N: Simplicial<D>, const D: usize> GjkSearch<N, D> {
    fn new(first: SupportCandidate<N, D>) -> Self {
        Self {
            simplex: Simplex::new(first.vertex),
            best: first,
            last: first,
            upper: N::INFINITY,
            gap: gap(),
            for_points: true,
            near: N::ZERO,
        }
    }

    /// Returns whether the inflated difference certainly contains a ball around the origin. For
    /// solids that lie symmetrically the search from their middles ends at a corner, edge or face;
    /// another start avoids that.
    fn clears(&self, difference: &impl Difference<N, D>, radius: N) -> bool {
        self.is_clear() || overlaps(difference, &skew_axis(), radius, N::ZERO)
    }

    /// Returns whether the simplex contains a ball around the origin.
    fn is_clear(&self) -> bool {
        let points = self.simplex.points();
        N::nearest(points).enclosed && N::clears(points, N::lit(CLEAR))
    }

    fn run(&mut self, difference: &impl Difference<N, D>, limit: N) -> Outcome {
        let mut nearest = N::nearest(self.simplex.points());
        for _ in 0..ROUNDS {
            // Written so that NaN counts as an overlap, whose loops end by their caps.
            let away = nearest.squared > noise::<N>() * noise();
            if nearest.enclosed || !away {
                return Outcome::Overlap;
            }
            self.upper = nearest.squared.sqrt();
            if self.upper < self.near {
                return Outcome::Near;
            }
            let candidate = SupportCandidate::along(difference, nearest.point / self.upper);
            self.best.improve(&candidate);
            self.last = candidate;
            if self.best.height > limit {
                return Outcome::Beyond;
            }
            let proof = if self.for_points { &self.last } else { &self.best };
            let closed = self.upper - proof.height <= self.gap;
            let known = closed || self.simplex.contains(&candidate.vertex);
            match if known { None } else { self.advanced(&nearest) } {
                Some(next) => nearest = next,
                None => {
                    self.best.prefer(candidate, N::EPSILON);
                    return Outcome::Apart;
                }
            }
        }
        Outcome::Apart
    }

    /// Adds the last support point to the simplex; `None`, and no change, if that brings the origin
    /// no nearer: arithmetic is at its limit.
    fn advanced(&mut self, nearest: &NearestOfSimplex<N, D>) -> Option<NearestOfSimplex<N, D>> {
        self.simplex.push(self.last.vertex);
        let next = N::nearest(self.simplex.points());
        if next.squared >= nearest.squared {
            self.simplex.pop();
            return None;
        }
        self.simplex.keep(&next.weights);
        Some(next)
    }

    /// Returns whether the bounds lie farther apart than they should.
    fn open(&self) -> bool {
        let closed = self.upper - self.best.height <= N::TWO * tolerance();
        !closed
    }

    /// Returns whether the bounds meet, up to rounding. Rounding may also have put the upper below
    /// the lower: slivers give poor nearest points.
    fn met(&self) -> bool {
        (self.upper - self.best.height).abs() <= N::TWO * gap()
    }

    /// Returns the answer from the features found, refined first if the bounds do not meet. That
    /// happens near touching, where the direction of the nearest point is mostly rounding, and if
    /// one solid is much larger than the other.
    fn finish(&mut self, difference: &dyn Difference<N, D>) -> Separation<N, D> {
        if self.met() {
            return self.settled(difference);
        }
        let mut bundle: Bundle<N, D> = SmallVec::from_slice(self.simplex.vertices());
        if settles(difference, &mut self.best) {
            bundle.push(self.best.vertex);
            return locate(difference, &self.best, &bundle);
        }
        bundle.extend([self.best.vertex, self.last.vertex]);
        refine(difference, &mut bundle, &mut self.best);
        let near = lowest(&bundle, &self.best.normal);
        let apart = match polish(difference, &mut self.best, &near) {
            Some(mix) => placed(&self.best, &mix, N::HALF),
            None => locate(difference, &self.best, &bundle),
        };
        if !self.open() {
            return apart;
        }
        let deep = N::deepest(difference, &self.simplex);
        if deep.distance > apart.distance { deep } else { apart }
    }

    /// Returns the answer if the difference contains the origin, or nearly: at once if a normal is
    /// known with the origin on its supporting plane.
    fn finish_overlap(&self, difference: &dyn Difference<N, D>) -> Separation<N, D> {
        if self.best.height >= -noise::<N>() {
            return self.settled(difference);
        }
        N::deepest(difference, &self.simplex)
    }

    /// Returns the answer of Newton's method from the current normal, if it leads to points that
    /// prove it: they are as far apart as the height of the normal.
    fn polished(&self, difference: &dyn Difference<N, D>) -> Option<Separation<N, D>> {
        let mut best = self.best;
        let mix = polish(difference, &mut best, self.simplex.vertices())?;
        let is_apart = best.height > noise();
        is_apart.then(|| placed(&best, &mix, N::HALF))
    }

    /// Returns the answer if the bounds meet. Of several valid normals, that of the nearest point
    /// is taken if its points lie across from each other along no other.
    fn settled(&self, difference: &dyn Difference<N, D>) -> Separation<N, D> {
        let (mix, mut best) = (Mix::of(&self.simplex), self.best);
        if let Some(polished) = polish(difference, &mut best, self.simplex.vertices()) {
            return placed(&best, &polished, N::HALF);
        }
        let raised = best.height > self.best.height;
        if !raised && !mix.meets(&best) {
            // The points of a sliver do not prove that its plane is as near as it seems.
            if settles(difference, &mut best) {
                return locate(difference, &best, &[best.vertex]);
            }
            best.prefer(self.last, N::TWO * gap());
        }
        settle(difference, &best, &mix, self.simplex.vertices())
    }
}

/// Returns a unit vector that is no axis of symmetry of solids aligned with the axes.
fn skew_axis<N: Real, const D: usize>() -> Vector<N, D> {
    let mut next = N::ONE;
    let skew = Vector::<N, D>::from_fn(|_, _| {
        next *= N::lit(0.618);
        next
    });
    unit_or(&skew, skew)
}

/// Gap at which curved cores first go to Newton's method, which mostly finds the answer from there.
fn coarse_gap<N: Real>() -> N {
    max(rough_gap(), N::lit(1.0 / 128.0))
}

/// Gap at which they go to it once more, which succeeds from there: 2⁻⁹ in `f32`, 2⁻¹⁹ in `f64`.
fn rough_gap<N: Real>() -> N {
    N::TWO * tolerance::<N>().sqrt()
}

/// Gap that is good enough: 2⁻²⁰ in `f32`, 2⁻⁴⁶ in `f64`.
fn gap<N: Real>() -> N {
    max(noise(), N::lit(1.0 / 70_368_744_177_664.0))
}
