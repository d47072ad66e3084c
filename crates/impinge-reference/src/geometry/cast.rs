//! Ray casts and linear casts of convex solids.
//!
//! For a fixed normal, the separation of two convex solids is linear in the translation. The signed
//! distance is the maximum over all normals, so it is convex along any straight motion. Its minimum
//! is found by ternary search, and its first zero before the minimum by bisection.

use super::distance::signed_distance;
use super::point::PointMeter;
use super::pose::Pose;
use super::solid::Solid;
use super::vector::{add, dot, norm, scale, sub};

/// Returns the least `t >= 0` at which `origin + t * direction` is in the solid: zero if the origin
/// is in the solid, `None` if the ray misses. `direction` may have any length; if it is zero, only
/// the origin is tested.
///
/// The distance along the ray is accurate to about 1e-14 of the distances involved if the ray
/// enters the solid by more than 1e-12 of them. A ray that passes the solid at a distance of at
/// most 1e-12 of these distances counts as a hit, also for flat solids.
#[must_use]
pub fn ray_cast<const D: usize>(
    solid: &Solid<D>,
    pose: &Pose<D>,
    origin: &[f64; D],
    direction: &[f64; D],
) -> Option<f64> {
    let start = pose.inverse_apply(origin);
    let meter = PointMeter::new(solid);
    if meter.measure(&start).0 <= 0.0 {
        return Some(0.0);
    }
    let speed = norm(direction);
    if speed <= 0.0 {
        return None;
    }
    let along = scale(&pose.inverse_rotate(direction), 1.0 / speed);
    let height = |t: f64| meter.measure(&add(&start, &scale(&along, t))).0;
    // At the distance `end` along the ray, the ray has left the bounding ball of the solid. A
    // half-space has no such ball: the hit with its plane is computed directly.
    let end = match solid {
        Solid::HalfSpace { normal } => {
            return (dot(normal, &along) < 0.0).then(|| -height(0.0) / dot(normal, &along) / speed);
        }
        _ => norm(&start) + solid.bounding_radius(),
    };
    Descent::of(&height, end, 1e-12 * end).first.map(|t| t / speed)
}

/// The result of [`linear_cast`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cast {
    /// The first time at which the signed distance is at most zero; zero if it is at most zero at
    /// the start, `None` if it stays positive up to `max_time`. A near pass counts as zero, within
    /// the tolerance of [`linear_cast`].
    pub time_of_impact: Option<f64>,
    /// The least signed distance on the path; for solids that touch or overlap at the start, the
    /// distance there. Against a half-space, only the path up to twice the way to the contact
    /// counts. If it is near zero, the solids only graze, and rounding may decide between hit and
    /// miss.
    pub least_distance: f64,
}

/// Computes the first contact and the least distance of two solids that move with constant
/// velocities, without rotation, from time zero to `max_time` (which may be infinite).
///
/// The time is accurate to about 1e-14 of the distances involved, divided by the speed of approach;
/// for cylinders and cones to 1e-9. A pass at a distance of at most 1e-12 (for cylinders and cones
/// 1e-9) of these distances counts as a hit.
#[must_use]
pub fn linear_cast<const D: usize>(
    (solid1, pose1, velocity1): (&Solid<D>, &Pose<D>, &[f64; D]),
    (solid2, pose2, velocity2): (&Solid<D>, &Pose<D>, &[f64; D]),
    max_time: f64,
) -> Cast {
    let start = signed_distance(solid1, pose1, solid2, pose2);
    let velocity = sub(velocity2, velocity1);
    let speed = norm(&velocity);
    let Some(normal) = start.normal.filter(|_| speed > 0.0) else {
        let time_of_impact = (start.lower <= 0.0).then_some(0.0);
        return Cast { time_of_impact, least_distance: start.lower };
    };
    let along = scale(&velocity, 1.0 / speed);
    let between = norm(&sub(&pose2.translation, &pose1.translation));
    let reach = solid1.bounding_radius() + solid2.bounding_radius();
    // Beyond `horizon` the solids only move apart. Against a half-space the normal is constant, so
    // twice the path to the contact suffices.
    let horizon = if reach.is_finite() {
        between + reach
    } else {
        (2.0 * start.lower / -dot(&normal, &along)).max(0.0)
    };
    let end = horizon.min(max_time * speed);
    let height =
        |t: f64| signed_distance(solid1, pose1, solid2, &pose2.moved(&scale(&along, t))).lower;
    let curved = |s: &Solid<D>| matches!(s, Solid::Cylinder { .. } | Solid::Cone { .. });
    let share = if curved(solid1) || curved(solid2) { 1e-9 } else { 1e-12 };
    let descent = Descent::of(&height, end, share * end);
    Cast { time_of_impact: descent.first.map(|t| t / speed), least_distance: descent.least }
}

/// The first zero and the minimum of a convex function on an interval that begins at zero.
struct Descent {
    /// The first argument at which the function is at most zero; `None` if there is none. See
    /// [`Self::of`] for functions that only touch zero.
    first: Option<f64>,
    /// The minimum value of the function. If the function is at most zero at the argument zero, or
    /// if the interval is empty, its value there.
    least: f64,
}

impl Descent {
    /// Searches `height` on `[0, end]`. If its minimum is at least `-thickness`, the level
    /// `thickness` takes the place of zero, so that rounding errors do not lose a grazing contact.
    fn of(height: &impl Fn(f64) -> f64, end: f64, thickness: f64) -> Self {
        let start = height(0.0);
        if end.is_nan() || end <= 0.0 || start <= 0.0 {
            return Self { first: (start <= 0.0).then_some(0.0), least: start };
        }
        let lowest = lowest_of_convex(height, end);
        let least = height(lowest);
        let level = if least < -thickness { 0.0 } else { thickness };
        let first = (least <= level).then(|| first_below(height, level, lowest));
        Self { first, least }
    }
}

/// Returns the argument of the minimum of a convex function on `[0, end]` by ternary search: each
/// step removes a third of the interval.
fn lowest_of_convex(height: &impl Fn(f64) -> f64, end: f64) -> f64 {
    let (mut low, mut high) = (0.0, end);
    for _ in 0..100 {
        let (left, right) = (low + (high - low) / 3.0, high - (high - low) / 3.0);
        if height(left) <= height(right) {
            high = right;
        } else {
            low = left;
        }
    }
    0.5 * (low + high)
}

/// Returns by bisection the first argument at which a function that decreases on `[0, inside]` is
/// at most `level`. The value at `inside` must be at most `level`.
fn first_below(height: &impl Fn(f64) -> f64, level: f64, inside: f64) -> f64 {
    let (mut outside, mut inside) = (0.0, inside);
    for _ in 0..100 {
        let middle = 0.5 * (outside + inside);
        if height(middle) <= level {
            inside = middle;
        } else {
            outside = middle;
        }
    }
    inside
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rays_by_hand() {
        let pose = Pose::identity();
        let ball = Solid::ball(1.0);
        let t = ray_cast(&ball, &pose, &[-3.0, 0.0, 0.0], &[2.0, 0.0, 0.0]).expect("hits");
        assert!((t - 1.0).abs() < 1e-14, "t {t}");
        assert_eq!(ray_cast(&ball, &pose, &[-3.0, 0.0, 0.0], &[-2.0, 0.0, 0.0]), None);
        assert_eq!(ray_cast(&ball, &pose, &[-3.0, 1.01, 0.0], &[2.0, 0.0, 0.0]), None);
        assert_eq!(ray_cast(&ball, &pose, &[0.5, 0.0, 0.0], &[0.0; 3]), Some(0.0));
        assert_eq!(ray_cast(&ball, &pose, &[1.5, 0.0, 0.0], &[0.0; 3]), None);
    }

    #[test]
    fn rays_on_flat_solids_by_hand() {
        let pose = Pose::identity();
        let triangle = Solid::triangle([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 0.0]);
        let t = ray_cast(&triangle, &pose, &[0.25, 0.25, 5.0], &[0.0, 0.0, -1.0]).expect("hits");
        assert!((t - 5.0).abs() < 1e-11, "t {t}");
        assert_eq!(ray_cast(&triangle, &pose, &[0.75, 0.75, 5.0], &[0.0, 0.0, -1.0]), None);
        let segment = Solid::segment([10.0, 1.0], [10.0, -1.0]);
        let t = ray_cast(&segment, &Pose::identity(), &[0.0, 0.0], &[4.0, 0.0]).expect("hits");
        assert!((t - 2.5).abs() < 1e-11, "t {t}");
        let t = ray_cast(&segment, &Pose::identity(), &[10.0, 4.0], &[0.0, -1.0]).expect("end on");
        assert!((t - 3.0).abs() < 1e-10, "t {t}");
    }

    #[test]
    fn rays_on_half_spaces_by_hand() {
        let ground = Solid::half_space([0.0, 1.0]);
        let pose = Pose::at([0.0, 2.0]);
        assert_eq!(ray_cast(&ground, &pose, &[0.0, 6.0], &[1.0, -2.0]), Some(2.0));
        assert_eq!(ray_cast(&ground, &pose, &[0.0, 6.0], &[1.0, 0.0]), None);
        assert_eq!(ray_cast(&ground, &pose, &[0.0, 1.0], &[1.0, 0.0]), Some(0.0));
    }

    fn cast<const D: usize>(one: &Solid<D>, two: &Solid<D>, at: [f64; D], by: [f64; D]) -> Cast {
        linear_cast(
            (one, &Pose::at([1.0; D]), &[1.0; D]),
            (two, &Pose::at(add(&at, &[1.0; D])), &add(&by, &[1.0; D])),
            100.0,
        )
    }

    #[test]
    fn casts_by_hand() {
        let (ball, cuboid) = (Solid::ball(1.0), Solid::cuboid([1.0, 1.0]));
        let head_on = cast(&ball, &cuboid, [6.0, 0.5], [-2.0, 0.0]);
        assert!((head_on.time_of_impact.expect("hits") - 2.0).abs() < 1e-13, "{head_on:?}");
        let past = cast(&ball, &cuboid, [6.0, 2.5], [-2.0, 0.0]);
        assert_eq!(past.time_of_impact, None);
        assert!((past.least_distance - 0.5).abs() < 1e-13, "{past:?}");
        let too_slow = cast(&ball, &cuboid, [6.0, 0.0], [-0.03125, 0.0]);
        assert_eq!(too_slow.time_of_impact, None);
        assert!((too_slow.least_distance - 0.875).abs() < 1e-13, "{too_slow:?}");
        // The corner touches the ball at offset (3, 4) from its centre: a triangle with sides 3, 4,
        // 5.
        let corner = cast(&Solid::ball(5.0), &cuboid, [14.0, 5.0], [-1.0, 0.0]);
        assert!((corner.time_of_impact.expect("hits") - 10.0).abs() < 1e-12, "{corner:?}");
        assert_eq!(cast(&ball, &cuboid, [1.5, 0.0], [9.0, 0.0]).time_of_impact, Some(0.0));
        assert_eq!(cast(&ball, &cuboid, [4.0, 0.0], [0.0, 0.0]).time_of_impact, None);
    }

    #[test]
    fn casts_on_a_half_space_by_hand() {
        let (ground, ball) = (Solid::half_space([0.0, 1.0, 0.0]), Solid::ball(0.5));
        let falls = cast(&ground, &ball, [0.0, 4.5, 0.0], [9.0, -2.0, 0.0]);
        assert!((falls.time_of_impact.expect("hits") - 2.0).abs() < 1e-13, "{falls:?}");
        let rises = cast(&ground, &ball, [0.0, 4.5, 0.0], [9.0, 2.0, 0.0]);
        assert_eq!((rises.time_of_impact, rises.least_distance), (None, 4.0));
        let slides = cast(&ground, &ball, [0.0, 4.5, 0.0], [9.0, 0.0, 0.0]);
        assert_eq!((slides.time_of_impact, slides.least_distance), (None, 4.0));
    }
}
