//! Lower bounds of the time at which a convex solid on a straight path reaches parts.

use crate::bounding_volume::Aabb;
use crate::collide::parts::between::Between;
use crate::collide::parts::bounds::aabb_of;
use crate::collide::parts::slabs::{across, corners, range};
use crate::math::{Mapped, Pose, Real, Space, Vector, max, max_component, min};
use crate::shape::{Geometry, Part, SupportMap};

/// Gaps are loosened by this many rounding units of all lengths.
const ROUNDING: f64 = 128.0;

/// A convex solid that moves in the frame of a composite. While an axis separates it from a part,
/// they do not touch. The axes are those of both frames, and those across the sides and the plane
/// of the part.
pub(super) struct Mover<'a, N: Real, const D: usize> {
    map: &'a dyn SupportMap<N, D>,
    /// Boxes around it in its own frame and in the composite's.
    boxes: [Aabb<N, D>; 2],
    pose: Pose<N, D>,
    velocity: Vector<N, D>,
    /// The distance that counts as touching.
    target: N,
}

/// The times at which none of the axes tested so far separates the two.
struct MeetingSpan<N> {
    enter: N,
    leave: N,
    /// The largest distance along an axis that does not count as separated.
    slack: N,
}

impl<'a, N: Space<D>, const D: usize> Mover<'a, N, D> {
    /// The first shape, if it is convex, with its velocity in the frame of the second.
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

    /// Returns a time, zero or more, before which the solid certainly does not touch a part; `None`
    /// if it does not up to `end`. It depends only on the solid and the part, so that no result
    /// depends on the search.
    pub(super) fn earliest(&self, part: &Part<'_, N, D>, end: N) -> Option<N> {
        let Some(corners) = corners(&part.solid, &part.pose) else { return Some(N::ZERO) };
        let seen = corners.mapped(|corner| corner - self.pose.translation);
        let own = max_component(&self.pose.translation) + self.map.reach() + self.map.rounding();
        let size = seen.iter().fold(own + self.target, |size, at| max(max_component(at), size));
        let slack = self.target + size * N::lit(ROUNDING) * N::EPSILON;
        let mut meeting = MeetingSpan { enter: N::ZERO, leave: end, slack };
        let turned = seen.mapped(|at| self.pose.inverse_vector(&at));
        let speeds = [self.pose.inverse_vector(&self.velocity), self.velocity];
        for (index, points) in [turned, corners].iter().enumerate() {
            let own = &self.boxes[index];
            for axis in 0..D {
                let [a, b, c] = points.each_ref().mapped(|at| at[axis]);
                let other = [min(min(a, b), c), max(max(a, b), c)];
                meeting.cut([own.mins()[axis], own.maxs()[axis]], other, speeds[index][axis]);
            }
        }
        for along in across(&seen.mapped(|at| at - seen[0])) {
            let local = self.pose.inverse_vector(&along);
            let reach = |direction: &Vector<N, D>| {
                self.map.core_support(direction).coords.dot(direction) + self.map.rounding()
            };
            meeting.cut(
                [-reach(&-local), reach(&local)],
                range(&seen, &along),
                self.velocity.dot(&along),
            );
        }
        (meeting.enter <= meeting.leave).then_some(meeting.enter)
    }
}

impl<N: Real> MeetingSpan<N> {
    /// Intersects the span with the times at which two intervals `[low, high]` along an axis
    /// overlap; `speed` is that of the first. NaN has no effect.
    fn cut(&mut self, own: [N; 2], other: [N; 2], speed: N) {
        let ([low, high], [bottom, top]) = (own, other);
        let (down, up) = (bottom - high - self.slack, top - low + self.slack);
        if speed == N::ZERO {
            // Separated for good: the span becomes empty.
            self.leave = if down > N::ZERO || up < N::ZERO { -N::ONE } else { self.leave };
            return;
        }
        // The rounding error of the quotients is below this.
        let room = N::lit(4.0) * N::EPSILON;
        let (one, other) = (down / speed, up / speed);
        let (enter, leave) = (min(one, other), max(one, other));
        let (enter, leave) = (enter - enter.abs() * room, leave + leave.abs() * room);
        self.enter = if enter > self.enter { enter } else { self.enter };
        self.leave = if leave < self.leave { leave } else { self.leave };
    }
}
