//! Lower bounds of the time at which a convex solid on a straight path touches a part.

use crate::bounding_volume::Aabb;
use crate::collide::parts::between::Between;
use crate::collide::parts::bounds::aabb_of;
use crate::collide::parts::slabs::{across, corners, range};
use crate::math::{Mapped, Pose, Real, Space, Vector, max, max_component, min};
use crate::shape::{Geometry, Part, SupportMap};

/// The tolerance of a gap, in epsilon times the largest length in its computation: the extent of
/// the solid about the composite's origin plus the target distance, or a coordinate of a corner.
const ROUNDING: f64 = 128.0;

/// A convex solid that moves in the frame of a composite. While some axis separates the solid from
/// a part, the two do not touch. The tested axes are the axes of both frames, the normals of the
/// part's sides within its plane, and the normal of that plane.
pub(super) struct Mover<'a, N: Real, const D: usize> {
    map: &'a dyn SupportMap<N, D>,
    /// The AABB of the solid in its own frame, then in the composite's frame.
    boxes: [Aabb<N, D>; 2],
    pose: Pose<N, D>,
    velocity: Vector<N, D>,
    /// The distance at which the solid and a part are treated as touching.
    target: N,
}

/// The times at which none of the tested axes separates the solid from the part.
struct ContactSpan<N> {
    enter: N,
    leave: N,
    /// The largest gap along an axis that is not treated as separation.
    slack: N,
}

impl<'a, N: Space<D>, const D: usize> Mover<'a, N, D> {
    /// Returns the first shape, with its velocity in the frame of the second shape; `None` if the
    /// first shape is not convex.
    pub(super) fn of_first(
        between: &Between<'a, N, D>,
        velocity: Vector<N, D>,
        target: N,
    ) -> Option<Self> {
        let (first, pose) = (between.pair.first, between.pose21);
        let map = Geometry(first).as_support_map()?;
        let boxes = [Pose::identity(), pose].mapped(|pose| aabb_of(first, &pose));
        Some(Self { map, boxes, pose, velocity, target })
    }

    /// Returns a time, zero or more, before which the solid certainly does not touch the part: zero
    /// if the part has no corners. `None` if the two do not touch up to `end`. The time depends
    /// only on the solid, the part and `end`, so no result depends on the order of a search.
    pub(super) fn earliest(&self, part: &Part<'_, N, D>, end: N) -> Option<N> {
        let Some(corners) = corners(&part.solid, &part.pose) else { return Some(N::ZERO) };
        let relative = corners.mapped(|corner| corner - self.pose.translation);
        let own = max_component(&self.pose.translation) + self.map.reach() + self.map.rounding();
        let size = relative.iter().fold(own + self.target, |size, at| max(max_component(at), size));
        let slack = self.target + size * N::lit(ROUNDING) * N::EPSILON;
        let mut span = ContactSpan { enter: N::ZERO, leave: end, slack };
        let local_corners = relative.mapped(|at| self.pose.inverse_vector(&at));
        let speeds = [self.pose.inverse_vector(&self.velocity), self.velocity];
        for (index, points) in [local_corners, corners].iter().enumerate() {
            let own = &self.boxes[index];
            for axis in 0..D {
                let [a, b, c] = points.each_ref().mapped(|at| at[axis]);
                let other = [min(min(a, b), c), max(max(a, b), c)];
                span.cut([own.mins()[axis], own.maxs()[axis]], other, speeds[index][axis]);
            }
        }
        for along in across(&relative.mapped(|at| at - relative[0])) {
            let local = self.pose.inverse_vector(&along);
            let extent = |direction: &Vector<N, D>| {
                self.map.core_support(direction).coords.dot(direction) + self.map.rounding()
            };
            span.cut(
                [-extent(&-local), extent(&local)],
                range(&relative, &along),
                self.velocity.dot(&along),
            );
        }
        (span.enter <= span.leave).then_some(span.enter)
    }
}

impl<N: Real> ContactSpan<N> {
    /// Intersects the span with the times at which two intervals `[low, high]` along an axis
    /// overlap, where `own` moves with `speed` and `other` is fixed. NaN has no effect.
    fn cut(&mut self, own: [N; 2], other: [N; 2], speed: N) {
        let ([low, high], [bottom, top]) = (own, other);
        let (down, up) = (bottom - high - self.slack, top - low + self.slack);
        if speed == N::ZERO {
            // Intervals that do not overlap now never do: the span becomes empty.
            self.leave = if down > N::ZERO || up < N::ZERO { -N::ONE } else { self.leave };
            return;
        }
        // An upper bound of the relative rounding error of the quotients.
        let rounding_error = N::lit(4.0) * N::EPSILON;
        let (one, other) = (down / speed, up / speed);
        let (enter, leave) = (min(one, other), max(one, other));
        let (enter, leave) =
            (enter - enter.abs() * rounding_error, leave + leave.abs() * rounding_error);
        self.enter = if enter > self.enter { enter } else { self.enter };
        self.leave = if leave < self.leave { leave } else { self.leave };
    }
}
