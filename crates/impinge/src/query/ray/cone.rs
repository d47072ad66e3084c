//! Ray casts against a cone: the span of time during which the ray's line is inside.

use super::clip::clipped;
use super::cylinder::{cap, span as cylinder_span};
use super::segment::{RayFeatures, span as segment_span};
use super::span::{Crossing, Span};
use crate::bounding_volume::Ray;
use crate::math::{Mapped, Point, Real, Vector, cross2, max, min, unit_or};
use crate::shape::{Cone, Cylinder, FeatureId};

/// Returns the span in the lower nappe of the infinite double cone, clipped at the base and at the
/// apex; `None` if the line misses the cone. A cone without height is a disk, and a cone without
/// radius is a segment.
pub(super) fn span<N: Real>(cone: &Cone<N>, ray: &Ray<N, 3>) -> Option<Span<N, 3>> {
    let (radius, half_height) = (cone.radius(), cone.half_height());
    if half_height == N::ZERO {
        return cylinder_span(&Cylinder::new(N::ZERO, radius), ray);
    }
    if radius == N::ZERO {
        let apex = Point::<N, 3>::new(N::ZERO, half_height, N::ZERO);
        return segment_span([&-apex, &apex], RayFeatures::SEGMENT, ray);
    }
    let side = Nappe::new(cone, ray).span()?;
    let caps = [(-N::ONE, FeatureId::Face(0)), (N::ONE, FeatureId::Vertex(0))];
    clipped(side, caps.mapped(|(sign, feature)| cap(half_height, sign, feature, ray)))
}

/// The condition for the times at which a line is inside a double cone:
/// `quadratic · t² + 2 · linear · t + constant ≤ 0`.
pub(super) struct ConeTimes<N: Real> {
    pub(super) quadratic: N,
    pub(super) linear: N,
    pub(super) constant: N,
    /// The square root of `linear² − quadratic · constant`; zero if that difference is negative by
    /// rounding.
    pub(super) root: N,
}

impl<N: Real> ConeTimes<N> {
    /// Returns the interval in the nappe that widens along the line if `widening` is positive.
    /// `None` if the quadratic and the linear term vanish and the constant is positive.
    ///
    /// A line steeper than the side (`quadratic < 0`) passes through both nappes. Its part in one
    /// nappe is unbounded in the direction in which that nappe widens.
    pub(super) fn in_nappe(&self, widening: N) -> Option<(N, N)> {
        let (never_in, never_out) = (-N::INFINITY, N::INFINITY);
        let Self { quadratic, linear, constant, root } = *self;
        // The numerator of a root, without cancellation.
        let larger = if linear < N::ZERO { root - linear } else { -(linear + root) };
        if quadratic == N::ZERO {
            let t = constant / larger;
            return match (larger < N::ZERO, larger > N::ZERO) {
                (true, _) => Some((never_in, t)),
                (_, true) => Some((t, never_out)),
                _ => (constant <= N::ZERO).then_some((never_in, never_out)),
            };
        }
        // A tangent has one root: `constant` and `larger` may be rounding errors there.
        let first = larger / quadratic;
        let second = if root == N::ZERO { first } else { constant / larger };
        let (low, high) = (min(first, second), max(first, second));
        Some(if quadratic > N::ZERO {
            (low, high)
        } else if widening > N::ZERO {
            (high, never_out)
        } else {
            (never_in, low)
        })
    }

    /// Returns whether the line stays on the side.
    pub(super) fn runs_along_side(&self) -> bool {
        [self.quadratic, self.linear, self.constant, self.root] == [N::ZERO; 4]
    }
}

/// The infinite cone below the apex, and a line.
///
/// `cosine` and `sine` are the cosine and the sine of half the opening angle. A point at the
/// distance `x` from the axis and the height `y ≤ 0` over the apex is inside where `cosine · x ≤
/// -sine · y`.
struct Nappe<N: Real> {
    cosine: N,
    sine: N,
    /// The line's origin: its horizontal components, and its height over the apex.
    flat: Vector<N, 2>,
    height: N,
    /// The line's direction: its horizontal components, and its vertical component.
    flat_dir: Vector<N, 2>,
    climb: N,
}

impl<N: Real> Nappe<N> {
    fn new(cone: &Cone<N>, ray: &Ray<N, 3>) -> Self {
        let rise = cone.half_height() + cone.half_height();
        let slant = Vector::<N, 2>::new(rise, cone.radius()).norm();
        Self {
            cosine: rise / slant,
            sine: cone.radius() / slant,
            flat: Vector::<N, 2>::new(ray.origin.x, ray.origin.z),
            height: ray.origin.y - cone.half_height(),
            flat_dir: Vector::<N, 2>::new(ray.dir.x, ray.dir.z),
            climb: ray.dir.y,
        }
    }

    /// Returns `cosine² a² − sine² b²`, without the cancellation of the squares; negative inside.
    fn form(&self, a: N, b: N) -> N {
        (self.cosine * a - self.sine * b) * (self.cosine * a + self.sine * b)
    }

    /// Returns the span in this nappe, without the opposite nappe except the apex; `None` if the
    /// line misses the nappe. By rounding the span may extend beyond the apex; the caller clips it
    /// there.
    fn span(&self) -> Option<Span<N, 3>> {
        let quadratic = self.form(self.flat_dir.norm(), self.climb.abs());
        let constant = self.form(self.flat.norm(), self.height.abs());
        let linear = self.cosine * self.cosine * self.flat.dot(&self.flat_dir)
            - self.sine * self.sine * self.height * self.climb;
        // The discriminant is computed from the line's moment about the apex, as a difference of
        // two squares.
        let moment = (self.flat * self.climb - self.flat_dir * self.height).norm();
        let twist = cross2(&self.flat, &self.flat_dir).abs();
        let discriminant = -self.form(twist, moment);
        if discriminant < N::ZERO && quadratic > N::ZERO && constant > N::ZERO {
            return None;
        }
        let root = self.cosine * max(discriminant, N::ZERO).sqrt();
        let times = ConeTimes { quadratic, linear, constant, root };
        let (enter, leave) = times.in_nappe(-self.climb)?;
        let thin = times.runs_along_side();
        Some(Span { enter: self.crossing(enter), leave: self.crossing(leave), thin })
    }

    /// Returns the crossing with the side at the time `t`.
    fn crossing(&self, t: N) -> Crossing<N, 3> {
        if !t.is_finite_number() {
            return Crossing::never(t);
        }
        let radial = unit_or(&(self.flat + self.flat_dir * t), Vector::<N, 2>::zeros());
        let normal = Vector::<N, 3>::new(self.cosine * radial.x, self.sine, self.cosine * radial.y);
        // At the apex there is no radial component; the normal points straight up.
        let normal = unit_or(&normal, Vector::<N, 3>::y());
        Crossing::new(t, normal, FeatureId::Face(1))
    }
}
