//! Finds the best normal in the ring of normals of a round side.
//!
//! If the axes of two solids nearly coincide, or a small solid is near the axis of a large one, a
//! whole ring of normals has about the same height. A growing polytope does not find the best
//! normal of the ring before its cap, and a local search makes tiny steps. If two solids have
//! exactly the same axis, the problem is one of two polygons in a half-plane through the axis: the
//! best normal is the normal of an edge of one polygon. Rotated about the axis, this normal forms
//! the ring of a round side. So the ring of each side is searched: the height is a function of one
//! angle with few maxima.

use smallvec::SmallVec;

use super::candidate::SupportCandidate;
use super::climb::climb;
use super::difference::{Difference, Vertex, rounding_error, tolerance};
use super::polish::polish;
use super::witness::Mix;
use crate::math::{Mapped, Real, Vector, cross, filled, unit};

/// Number of evenly spaced normals of a ring that are sampled first.
const SAMPLES: usize = 16;
/// Angle between two adjacent samples, in radians.
const PITCH: f64 = core::f64::consts::TAU / 16.0;
/// Cap on the number of maxima that are searched.
const TOPS: usize = 3;
/// A ring is searched only if the component of the known normal along the axis differs from the
/// component of the side's normals by at most this value.
const NEAR: f64 = 1.0 / 16.0;
/// A ring is searched only if the height of its normal at angle π from the known normal is lower
/// than the known height by at most this value, in units of the pair.
const MAX_UNEVENNESS: f64 = 1.0 / 8.0;
/// Fraction of an interval that is left after a step of the golden section.
const GOLDEN: f64 = 0.618_033_988_749_894_8;
/// Cap on the steps of the golden section: 43 steps shrink an interval to 1e-9 of its length.
const STEPS: usize = 43;

/// A refined normal of a ring whose height is larger than the height of the known normal, and
/// points that are lowest along it, or nearly so.
pub(super) struct Better<N: Real> {
    pub(super) best: SupportCandidate<N, 3>,
    pub(super) mix: Option<Mix<N, 3>>,
    pub(super) lowest: SmallVec<[Vertex<N, 3>; 8]>,
}

/// Returns a normal from the rings of the sides near `normal` whose height exceeds `height` by more
/// than rounding; `None` if there is none.
pub(super) fn better<N: Real>(
    difference: &dyn Difference<N, 3>,
    normal: &Vector<N, 3>,
    height: N,
) -> Option<Better<N>> {
    let mut found: Option<Better<N>> = None;
    for (axis, rise) in difference.round_sides().into_iter().flatten() {
        let least = found.as_ref().map_or(height, |found| found.best.height) + rounding_error();
        let ring =
            NormalRing::near(axis, rise, normal).filter(|ring| ring.is_even(difference, height));
        let top = ring.and_then(|ring| ring.best(difference, least));
        found = top.map(|(ring, start)| ring.polished(difference, start)).or(found);
    }
    found
}

/// A circle of unit vectors, parametrised by an angle.
#[derive(Clone, Copy)]
struct NormalRing<N: Real> {
    /// Axis of the round side, a unit vector.
    axis: Vector<N, 3>,
    /// Component of the normals along the axis.
    rise: N,
    /// Unit vectors perpendicular to the axis and to each other; `from` is at angle zero.
    from: Vector<N, 3>,
    aside: Vector<N, 3>,
}

impl<N: Real> NormalRing<N> {
    /// Returns the ring of a side, with angles measured from `normal`; `None` if the normal is not
    /// near the ring.
    fn near(axis: Vector<N, 3>, rise: N, normal: &Vector<N, 3>) -> Option<Self> {
        let cosine = normal.dot(&axis);
        let is_near = (cosine - rise).abs() <= N::lit(NEAR);
        let (from, _) = unit(&(normal - axis * cosine)).filter(|_| is_near)?;
        Some(Self { axis, rise, from, aside: cross(&axis, &from) })
    }

    fn at(&self, angle: N) -> Vector<N, 3> {
        let (sine, cosine) = angle.sine_cosine();
        let away = ((N::ONE - self.rise) * (N::ONE + self.rise)).sqrt();
        self.axis * self.rise + (self.from * cosine + self.aside * sine) * away
    }

    /// Returns the ring with angles measured from its normal at `angle`; `None` for a ring whose
    /// normals are all the axis.
    fn rotated(&self, angle: N) -> Option<Self> {
        Self::near(self.axis, self.rise, &self.at(angle))
    }

    fn height(&self, difference: &dyn Difference<N, 3>, angle: N) -> N {
        SupportCandidate::along(difference, self.at(angle)).height
    }

    /// Returns whether the height of the normal at angle π is at most [`MAX_UNEVENNESS`] below
    /// `height`, the height of the known normal. If it is lower, the heights of the ring vary
    /// enough to find the best normal without a search of the ring.
    fn is_even(&self, difference: &dyn Difference<N, 3>, height: N) -> bool {
        height - self.height(difference, N::lit(core::f64::consts::PI)) <= N::lit(MAX_UNEVENNESS)
    }

    /// Returns the best normal of the ring, and the ring with angles measured from it; `None` if
    /// its height is not above `least`.
    fn best(
        &self,
        difference: &dyn Difference<N, 3>,
        least: N,
    ) -> Option<(Self, SupportCandidate<N, 3>)> {
        let mut best: Option<(Self, SupportCandidate<N, 3>)> = None;
        for top in self.tops(difference) {
            let Some(ring) = self.rotated(top).and_then(|ring| ring.risen(difference)) else {
                continue;
            };
            let found = SupportCandidate::along(difference, ring.at(N::ZERO));
            if found.height > best.as_ref().map_or(least, |(_, best)| best.height) {
                best = Some((ring, found));
            }
        }
        best
    }

    /// Returns the angles of the samples that are no lower than both neighbours; if there are more
    /// than `TOPS`, the angles of the highest samples.
    fn tops(&self, difference: &dyn Difference<N, 3>) -> SmallVec<[N; TOPS]> {
        let mut next = N::ZERO;
        let samples: [(N, N); SAMPLES] = filled(|_| {
            let angle = next;
            next += N::lit(PITCH);
            (angle, self.height(difference, angle))
        });
        let height = |index: usize| samples[index % SAMPLES].1;
        let is_top = |&index: &usize| {
            height(index) >= height(index + 1) && height(index) >= height(index + SAMPLES - 1)
        };
        let mut tops: SmallVec<[usize; SAMPLES]> = (0..SAMPLES).filter(is_top).collect();
        let mut highest = SmallVec::new();
        while highest.len() < TOPS {
            let higher = |a, b| if height(tops[b]) > height(tops[a]) { b } else { a };
            let Some(index) = (0..tops.len()).reduce(higher) else { break };
            highest.push(samples[tops.remove(index)].0);
        }
        highest
    }

    /// Returns the ring with angles measured from its highest normal within `PITCH` of angle zero,
    /// found by golden section; `None` if [`Self::rotated`] returns `None`.
    fn risen(&self, difference: &dyn Difference<N, 3>) -> Option<Self> {
        let (mut low, mut high) = (-N::lit(PITCH), N::lit(PITCH));
        let inner = |low: N, high: N| {
            let share = (high - low) * N::lit(GOLDEN);
            [high - share, low + share]
        };
        let [mut left, mut right] = inner(low, high);
        let mut heights = [left, right].mapped(|angle| self.height(difference, angle));
        for _ in 0..STEPS {
            if heights[0] >= heights[1] {
                high = right;
                [left, right] = [inner(low, high)[0], left];
                heights = [self.height(difference, left), heights[0]];
            } else {
                low = left;
                [left, right] = [right, inner(low, high)[1]];
                heights = [heights[1], self.height(difference, right)];
            }
        }
        self.rotated(if heights[0] >= heights[1] { left } else { right })
    }

    /// Refines the normal at angle zero by Newton's method, with the points that are lowest along
    /// four normals around it. If the method does not converge, uses [`climb`] instead, and `mix`
    /// is `None`.
    fn polished(
        &self,
        difference: &dyn Difference<N, 3>,
        start: SupportCandidate<N, 3>,
    ) -> Better<N> {
        let slight = tolerance::<N>().sqrt();
        let sides = [self.aside, -self.aside, self.axis, -self.axis];
        let mut lowest: SmallVec<[Vertex<N, 3>; 8]> = sides
            .iter()
            .filter_map(|side| unit(&(start.normal + side * slight)))
            .map(|(normal, _)| difference.lowest(&normal))
            .collect();
        lowest.push(start.vertex);
        let mut best = start;
        let mix = polish(difference, &mut best, &lowest);
        if mix.is_none() {
            climb(difference, &mut best);
            lowest.push(best.vertex);
        }
        Better { best, mix, lowest }
    }
}
