//! Ball against segment or capsule, in closed form, in any dimension.

use crate::collide::Pair;
use crate::collide::separation::projection::{
    Projection, center_in_second, first_axis, made_perpendicular, perpendicular_to,
};
use crate::collide::separation::segments::nearest::{core, nearest_on_segment};
use crate::convex::Separation;
use crate::math::{Point, Real, Vector, unit};
use crate::shape::{Kind, Segment};

/// Returns the separation of a ball from a segment or capsule; `None` above `limit`.
///
/// If the centre lies on the segment, the ball is pushed out along a fixed perpendicular of the
/// segment. If the segment is a single point and the centre coincides with it, the ball is pushed
/// out along the first axis of the segment's frame.
pub(in crate::collide::separation) fn separation<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    limit: N,
) -> Option<Separation<N, D>> {
    let Kind::Ball(ball) = &pair.first else { crate::collide::separation::wrong_kinds(pair) };
    let (ends, rounding) = core(pair, &pair.second);
    let foot = Foot::new(ends, &center_in_second(&pair.pose12));
    let is_within = foot.distance - rounding - ball.radius() <= limit;
    let mut projected = is_within.then(|| foot.projection())?;
    projected.distance -= rounding;
    projected.point += projected.outward * rounding;
    projected.of_ball(ball.radius(), &pair.pose12, limit)
}

/// Returns the distance of a point from a segment, without computing a direction.
#[inline]
pub(in crate::collide::separation) fn distance_from<N: Real, const D: usize>(
    segment: &Segment<N, D>,
    center: &Point<N, D>,
) -> N {
    Foot::new([*segment.a(), *segment.b()], center).distance
}

/// Projects a point onto a segment.
pub(in crate::collide::separation) fn project<N: Real, const D: usize>(
    ends: &[Point<N, D>; 2],
    center: &Point<N, D>,
) -> Projection<N, D> {
    Foot::new(*ends, center).projection()
}

/// The point of a segment nearest to the projected point, and the offset of the projected point
/// from it.
pub(in crate::collide::separation) struct Foot<N: Real, const D: usize> {
    ends: [Point<N, D>; 2],
    /// The nearest point of the segment.
    point: Point<N, D>,
    /// Vector from `point` to the projected point; `distance` is its length.
    offset: Vector<N, D>,
    pub(in crate::collide::separation) distance: N,
    /// Whether `point` lies between the ends.
    is_inside: bool,
}

impl<N: Real, const D: usize> Foot<N, D> {
    /// Finds the nearest point of the segment to `center`.
    #[inline]
    pub(in crate::collide::separation) fn new(
        ends: [Point<N, D>; 2],
        center: &Point<N, D>,
    ) -> Self {
        let (point, is_inside) = nearest_on_segment(&ends, center);
        let offset = center - point;
        Self { ends, point, offset, distance: offset.norm(), is_inside }
    }

    /// Returns the projection of the point. The direction costs more to compute than all other
    /// values, so callers that need only the distance read the field.
    pub(in crate::collide::separation) fn projection(&self) -> Projection<N, D> {
        Projection { distance: self.distance, outward: self.outward(), point: self.point }
    }

    /// Returns the unit direction from the segment to the projected point. If the nearest point
    /// lies between the ends, this is the direction of the part of the offset perpendicular to the
    /// segment, else the direction of the offset. If that part is mostly rounding error, or the
    /// offset is zero, returns a fixed perpendicular of the segment, or the first axis for a
    /// segment without length.
    fn outward(&self) -> Vector<N, D> {
        let direct = if self.is_inside { None } else { unit(&self.offset) };
        if let Some((outward, _)) = direct {
            return outward;
        }
        let Some((axis, _)) = unit(&(self.ends[1] - self.ends[0])) else { return first_axis() };
        let sideways = if self.is_inside { made_perpendicular(&self.offset, &axis) } else { None };
        sideways.unwrap_or_else(|| perpendicular_to(&axis))
    }
}
