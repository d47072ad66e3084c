//! Mass of convex solids in 2D, computed from support points alone.

use super::integrals::{Integrals, LocalUnits};
use super::outline::crossed;
use crate::math::{Mapped, Point, Real, Vector};
use crate::shape::{MassError, Moments, SupportMap, finite};

type V2 = Vector<f64, 2>;

/// The maximum number of times that an arc is halved, starting from the quarters between the axes.
const DEPTH: u32 = 9;

/// An arc whose height is at most this many epsilon of the solid's size is treated as a segment.
const FLAT: f64 = 64.0;

/// Returns the moments of a convex solid from its support points, accurate to about 1e-9; for
/// polygons up to rounding.
///
/// # Errors
/// If a support point is not finite.
pub(super) fn by_support<N: Real>(map: &dyn SupportMap<N, 2>) -> Result<Moments<2>, MassError> {
    let axes = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].mapped(V2::from);
    let mut extremes = [Point::<N, 2>::origin(); 4];
    for (extreme, axis) in extremes.iter_mut().zip(&axes) {
        *extreme = map.support_point(&axis.map(N::lit));
        for coordinate in &extreme.coords {
            finite("a coordinate of a support point", coordinate.as_f64())?;
        }
    }
    let units = LocalUnits::around(&extremes, N::ZERO);
    let support = |direction: &V2| units.point(&map.support_point(&direction.map(N::lit)));
    let mut tracing = Tracing::new(&support, FLAT * N::EPSILON.as_f64());
    tracing.trace(DEPTH);
    Ok(units.grown(&tracing.sum.moments()))
}

/// Traces the outline of a convex solid by its support points.
///
/// Each arc between two support points is split at the support point across its chord, until the
/// arc is flat or the depth is reached. The remaining region between chord and arc is approximated
/// by a parabola.
pub(super) struct Tracing<'s> {
    support: &'s dyn Fn(&V2) -> V2,
    /// The largest height of an arc over its chord at which the arc is treated as flat.
    flat: f64,
    pub(super) sum: Integrals<2>,
}

impl<'s> Tracing<'s> {
    /// Returns an empty tracing. `support` returns a support point for a unit vector; an arc with a
    /// height of at most `flat` is treated as a segment.
    pub(super) fn new(support: &'s dyn Fn(&V2) -> V2, flat: f64) -> Self {
        Self { support, flat, sum: Integrals::none() }
    }

    /// Adds the solid; the quarters of its outline are halved at most `depth` times.
    pub(super) fn trace(&mut self, depth: u32) {
        let axes = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0]].mapped(V2::from);
        let ends = axes.mapped(|axis| (self.support)(&axis));
        for quarter in 0..4 {
            self.follow(&ends[quarter], &ends[(quarter + 1) % 4], depth);
        }
    }

    /// Adds the region between the origin and the arc from the support point `a` counter-clockwise
    /// to `b`.
    fn follow(&mut self, a: &V2, b: &V2, depth: u32) {
        let chord = b - a;
        let length = chord.norm();
        if length <= 0.0 {
            return;
        }
        let outward = V2::new(chord.y, -chord.x) / length;
        let top = (self.support)(&outward);
        let height = (top - a).dot(&outward);
        let is_curved = height > self.flat;
        if is_curved && depth > 0 {
            self.follow(a, &top, depth - 1);
            self.follow(&top, b, depth - 1);
            return;
        }
        self.sum.add_cone(crossed(a, b) * 0.5, &[a, b]);
        if is_curved {
            // A parabola over the chord has two thirds of the rectangle's area, and its centre at
            // two fifths of the height.
            let center = (a + b) * 0.5 + outward * (height * 0.4);
            let area = length * height * (2.0 / 3.0);
            self.sum.add(area, &center, &(chord * chord.transpose() * (area / 20.0)));
        }
    }
}
