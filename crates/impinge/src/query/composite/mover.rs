//! When a convex solid on a straight path can first be as near to parts as it is asked to come.

use crate::bounding_volume::Aabb;
use crate::collide::parts::between::Between;
use crate::collide::parts::bounds::aabb_of;
use crate::collide::parts::slabs::{across, corners, range};
use crate::math::{Mapped, Pose, Real, Space, Vector, max, max_component, min};
use crate::shape::{Geometry, Part, SupportMap};

/// Gaps are loosened by so many rounding units of all lengths.
const ROUNDING: f64 = 128.0;

/// A convex solid that moves in the frame of a composite. While an axis parts it from a part of that, they do not
/// touch; times are bounded by the axes of both frames and those across the sides and the plane of the part.
pub(super) struct Mover<'a, N: Real, const D: usize> {
    map: &'a dyn SupportMap<N, D>,
    /// Boxes around it in its own frame and in that of the composite.
    boxes: [Aabb<N, D>; 2],
    pose: Pose<N, D>,
    velocity: Vector<N, D>,
    /// How near counts.
    target: N,
}

/// The times at which no axis so far parts the two.
struct MeetingSpan<N> {
    enter: N,
    leave: N,
    /// How far apart along an axis does not count as parted.
    slack: N,
}

impl<'a, N: Space<D>, const D: usize> Mover<'a, N, D> {
    /// The first shape, if it is convex, and its velocity in the frame of the second.
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

    /// A time, zero or more, before which the solid is certainly not at a part; `None` if that is so up to `end`.
    /// It depends on nothing else, so that no answer depends on the search.
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
    /// Takes into account how the two lie along an axis at time zero, from the lowest to the highest point, and how fast
    /// the first moves along it. NaN says nothing.
    fn cut(&mut self, own: [N; 2], other: [N; 2], speed: N) {
        let ([low, high], [bottom, top]) = (own, other);
        let (down, up) = (bottom - high - self.slack, top - low + self.slack);
        if speed == N::ZERO {
            // Parted for good: a span that is empty.
            self.leave = if down > N::ZERO || up < N::ZERO { -N::ONE } else { self.leave };
            return;
        }
        // The quotients round by less than this.
        let room = N::lit(4.0) * N::EPSILON;
        let (one, other) = (down / speed, up / speed);
        let (enter, leave) = (min(one, other), max(one, other));
        let (enter, leave) = (enter - enter.abs() * room, leave + leave.abs() * room);
        self.enter = if enter > self.enter { enter } else { self.enter };
        self.leave = if leave < self.leave { leave } else { self.leave };
    }
}
