//! The best of the normals of a round side.
//!
//! Of solids about axes that all but coincide, and of a small solid about the axis of a large one, a whole
//! ring of normals is about as good. A polytope that grows finds none of them better before it is at its cap,
//! and a local search creeps along. But on solids about exactly the same axis the ring of the best normals is
//! that of a side, as in the half-plane of the axis the best normal of two polygons is that of an edge. So
//! the heights along the ring of each side are a function of one angle, which has few tops.

use smallvec::SmallVec;

use super::candidate::SupportCandidate;
use super::climb::climb;
use super::difference::{Difference, Vertex, noise, tolerance};
use super::polish::polish;
use super::witness::Mix;
use crate::math::{Mapped, Real, Vector, cross, filled, unit};

/// As many normals of a ring are looked at first.
const SAMPLES: usize = 16;
/// The angle between them.
const PITCH: f64 = core::f64::consts::TAU / 16.0;
/// Cap on the tops that are searched for their best normal.
const TOPS: usize = 3;
/// By so much the sine of a normal may differ from that of a side whose ring it stands for.
const NEAR: f64 = 1.0 / 16.0;
/// Heights of a ring, of solids of about size 1, that differ by more than this are not all about as good.
const LEVEL: f64 = 1.0 / 8.0;
/// The share of an interval that a step of the golden section leaves.
const GOLDEN: f64 = 0.618_033_988_749_894_8;
/// Cap on these steps, by which an interval shrinks to 1e-9 of itself.
const STEPS: usize = 43;

/// The normal of a ring that is better than the one of this height, brought to the last digits, with the
/// points that lie lowest along it or nearly so.
pub(super) struct Better<N: Real> {
    pub(super) best: SupportCandidate<N, 3>,
    pub(super) mix: Option<Mix<N, 3>>,
    pub(super) lowest: SmallVec<[Vertex<N, 3>; 8]>,
}

/// What the rings of the sides have that is better than a normal near them, by more than rounding.
pub(super) fn better<N: Real>(
    difference: &dyn Difference<N, 3>,
    normal: &Vector<N, 3>,
    height: N,
) -> Option<Better<N>> {
    let mut found: Option<Better<N>> = None;
    for (axis, rise) in difference.round_sides().into_iter().flatten() {
        let least = found.as_ref().map_or(height, |found| found.best.height) + noise();
        let ring =
            NormalRing::near(axis, rise, normal).filter(|ring| ring.is_level(difference, height));
        let top = ring.and_then(|ring| ring.best(difference, least));
        found = top.map(|(ring, start)| ring.polished(difference, start)).or(found);
    }
    found
}

/// A circle of unit vectors, with a place to measure angles from.
#[derive(Clone, Copy)]
struct NormalRing<N: Real> {
    axis: Vector<N, 3>,
    rise: N,
    /// Unit, across the axis and across each other.
    from: Vector<N, 3>,
    aside: Vector<N, 3>,
}

impl<N: Real> NormalRing<N> {
    /// The ring of a side, measured from a normal near it; `None` if that is not near.
    fn near(axis: Vector<N, 3>, rise: N, normal: &Vector<N, 3>) -> Option<Self> {
        let lean = normal.dot(&axis);
        let is_near = (lean - rise).abs() <= N::lit(NEAR);
        let (from, _) = unit(&(normal - axis * lean)).filter(|_| is_near)?;
        Some(Self { axis, rise, from, aside: cross(&axis, &from) })
    }

    fn at(&self, angle: N) -> Vector<N, 3> {
        let (sine, cosine) = angle.sine_cosine();
        let away = ((N::ONE - self.rise) * (N::ONE + self.rise)).sqrt();
        self.axis * self.rise + (self.from * cosine + self.aside * sine) * away
    }

    /// The same ring, measured from another of its normals.
    fn turned(&self, angle: N) -> Option<Self> {
        Self::near(self.axis, self.rise, &self.at(angle))
    }

    fn height(&self, difference: &dyn Difference<N, 3>, angle: N) -> N {
        SupportCandidate::along(difference, self.at(angle)).height
    }

    /// The normal across is about as good as one of this height that the ring is measured from. Else heights vary
    /// enough for the best of them to be found without the ring.
    fn is_level(&self, difference: &dyn Difference<N, 3>, height: N) -> bool {
        height - self.height(difference, N::lit(core::f64::consts::PI)) <= N::lit(LEVEL)
    }

    /// The best normal, if it is higher than `least`, and the ring measured from it.
    fn best(
        &self,
        difference: &dyn Difference<N, 3>,
        least: N,
    ) -> Option<(Self, SupportCandidate<N, 3>)> {
        let mut best: Option<(Self, SupportCandidate<N, 3>)> = None;
        for top in self.tops(difference) {
            let Some(ring) = self.turned(top).and_then(|ring| ring.risen(difference)) else {
                continue;
            };
            let found = SupportCandidate::along(difference, ring.at(N::ZERO));
            if found.height > best.as_ref().map_or(least, |(_, best)| best.height) {
                best = Some((ring, found));
            }
        }
        best
    }

    /// The angles of the highest samples that are no lower than those beside them.
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
            let Some(place) = (0..tops.len()).reduce(higher) else { break };
            highest.push(samples[tops.remove(place)].0);
        }
        highest
    }

    /// Measured from its highest normal between the samples beside this one, by the golden section.
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
        self.turned(if heights[0] >= heights[1] { left } else { right })
    }

    /// The normal that the ring is measured from, brought to the last digits: by Newton's method over the points
    /// that are lowest to all sides of it.
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
