//! Ray casts against a filled triangle in 2D: the span of time during which the ray's line is
//! inside.

use super::span::{Crossing, Span};
use crate::bounding_volume::Ray;
use crate::math::{Point, Real, Vector, cross2, max, min, perp, unit_or};
use crate::shape::{FeatureId, Triangle};

/// A corner of the triangle relative to the line.
#[derive(Clone, Copy)]
struct RayCorner<N: Real> {
    /// The time at which the line is nearest to the corner.
    t: N,
    /// The signed distance of the corner from the line, positive on its left, multiplied by the
    /// length of the direction.
    side: N,
}

/// Returns the span of the line in the triangle; `None` if the line misses it. The line enters a
/// counter-clockwise triangle through a side that leads from the line's left to its right, and
/// leaves through a side that leads back.
///
/// The three signs of [`RayCorner::side`] alone decide if the line hits. Each sign is computed from
/// one corner and the ray, so triangles that share corners leave no gap.
pub(super) fn span<N: Real>(triangle: &Triangle<N, 2>, ray: &Ray<N, 2>) -> Option<Span<N, 2>> {
    let corners = triangle.corners().map(|corner| ray_corner(&corner, ray));
    let [a, b, c] = corners.map(|corner| corner.side);
    let left = a > N::ZERO && b > N::ZERO && c > N::ZERO;
    let right = a < N::ZERO && b < N::ZERO && c < N::ZERO;
    if left || right {
        return None;
    }
    let against = unit_or(&-ray.dir, Vector::<N, 2>::zeros());
    if a == N::ZERO && b == N::ZERO && c == N::ZERO {
        return Some(lengthwise(&corners, against));
    }
    let [first, second, third] = triangle.corners();
    let turns_left = cross2(&(second - first), &(third - first)) >= N::ZERO;
    let crossings = |entering: bool| {
        let falling = entering == turns_left;
        let crossed = (0..3).filter(move |&side| crosses(&corners, side, falling));
        crossed.map(move |side| crossing(triangle, &corners, side, turns_left))
    };
    let enter = crossings(true).reduce(|x, y| if y.t < x.t { y } else { x })?;
    let leave = crossings(false).reduce(|x, y| if y.t > x.t { y } else { x })?;
    let sides = [[a, b], [b, c], [c, a]];
    let thin = sides.iter().any(|ends| ends.iter().all(|&side| side == N::ZERO));
    Some(Span { thin, ..in_order(enter, leave) })
}

fn ray_corner<N: Real>(corner: &Point<N, 2>, ray: &Ray<N, 2>) -> RayCorner<N> {
    let to_corner = corner - ray.origin;
    let t = to_corner.dot(&ray.dir) / ray.dir.norm_squared();
    RayCorner { t, side: cross2(&ray.dir, &to_corner) }
}

/// Returns whether the line crosses a side that leads from the line's left to its right if
/// `falling` is true, else from right to left. One end of the side may be on the line.
fn crosses<N: Real>(corners: &[RayCorner<N>; 3], side: usize, falling: bool) -> bool {
    let (from, to) = (corners[side].side, corners[(side + 1) % 3].side);
    let (high, low) = if falling { (from, to) } else { (to, from) };
    high >= N::ZERO && low <= N::ZERO && high > low
}

/// Returns the crossing of the line with a side; the time is interpolated between the times of the
/// side's ends.
fn crossing<N: Real>(
    triangle: &Triangle<N, 2>,
    corners: &[RayCorner<N>; 3],
    side: usize,
    turns_left: bool,
) -> Crossing<N, 2> {
    let next = (side + 1) % 3;
    let (from, to) = (corners[side], corners[next]);
    let fraction = from.side.abs() / (from.side.abs() + to.side.abs());
    let inward = perp(&(triangle.corners()[next] - triangle.corners()[side]));
    let outward = if turns_left { -inward } else { inward };
    let normal = unit_or(&outward, Vector::<N, 2>::zeros());
    let number = u32::try_from(side).expect("a triangle has three sides");
    Crossing::new(from.t + (to.t - from.t) * fraction, normal, FeatureId::Face(number))
}

/// Returns the span, with the times exchanged if rounding has put them in the wrong order: sides
/// are classified by their direction, independently of the times.
fn in_order<N: Real>(enter: Crossing<N, 2>, leave: Crossing<N, 2>) -> Span<N, 2> {
    let (first, last) = (min(enter.t, leave.t), max(enter.t, leave.t));
    Span {
        enter: Crossing { t: first, ..enter },
        leave: Crossing { t: last, ..leave },
        thin: false,
    }
}

/// Returns the span if all corners lie on the line: from the first corner to the last.
fn lengthwise<N: Real>(corners: &[RayCorner<N>; 3], against: Vector<N, 2>) -> Span<N, 2> {
    let (mut first, mut last) = (0, 0);
    for index in 1..3 {
        first = if corners[index].t < corners[first].t { index } else { first };
        last = if corners[index].t > corners[last].t { index } else { last };
    }
    let [enter, leave] = [(first, against), (last, -against)].map(|(index, normal)| {
        let number = u32::try_from(index).expect("a triangle has three corners");
        Crossing::new(corners[index].t, normal, FeatureId::Vertex(number))
    });
    Span::thin(enter, leave)
}
