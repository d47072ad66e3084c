//! The time of impact of two solids that do not rotate: the kernel for one pair.
//!
//! Two separated balls touch at the root of a quadratic equation, which is verified by their
//! separation at that time. A half-space is hit after one step. All other pairs advance by steps
//! during which they certainly stay apart. The last step may be verified by a touching point
//! instead of a separation, if the normal has not changed during the step.

use super::ImpactStatus;
use crate::collide::Pair;
use crate::collide::separation::separation;
use crate::convex::Separation;
use crate::math::{Point, Pose, Real, Space, Vector, max, max_component, min};
use crate::shape::{FeatureId, Geometry, Kind};
use crate::tables::ByDimension;

/// The maximum number of steps of conservative advancement.
const MAX_STEPS: usize = 128;

/// Returns the length of the motion after which a contact at the start is tested again, for solids
/// whose distance has the rounding error `rounding`. A ball that rolls over another ball, or past a
/// corner, is within this error of the target distance over half this length at most, since no
/// radius is larger than `size`, the result of [`size()`].
pub(crate) fn soon<N: Real>(size: N, rounding: N) -> N {
    (N::TWO * size * rounding).sqrt()
}

/// The motion of the second solid of a pair in the frame of the first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Path<N: Real, const D: usize> {
    /// The displacement per unit of time. Its length is less than four: before the rotation into
    /// the frame of the first solid, no component exceeds two.
    pub(crate) velocity: Vector<N, D>,
    /// The latest time of an impact, inclusive.
    pub(crate) end: N,
    /// The distance at which the solids are treated as touching; zero or more.
    pub(crate) target: N,
    /// A bound of the rounding errors of the positions of both solids in the world.
    pub(crate) rounding: N,
    /// Whether a contact at the start is an impact for all velocities.
    pub(crate) contact_at_start: bool,
    /// Whether both solids are equal and at the same pose. Every normal is then equivalent to its
    /// opposite.
    pub(crate) mirrored: bool,
}

/// The impact of a pair on its path.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival<N: Real, const D: usize> {
    /// The time of impact, in the unit of the path.
    pub(crate) along: N,
    /// The separation at that time, in the frame of the first solid.
    pub(crate) separation: Separation<N, D>,
    pub(crate) status: ImpactStatus,
}

impl<N: Real, const D: usize> Path<N, D> {
    /// Returns the position of the second solid at the time `along`, for a pair that is at `start`
    /// at time zero.
    #[inline]
    fn position_at(&self, start: &Pair<'_, N, D>, along: N) -> Vector<N, D> {
        start.pose12.translation + self.velocity * along
    }

    /// Returns the pair `start` with the second solid at its pose at the time `along`.
    pub(crate) fn moved<'a>(&self, start: &Pair<'a, N, D>, along: N) -> Pair<'a, N, D> {
        let pose12 = Pose { translation: self.position_at(start, along), ..start.pose12 };
        Pair { pose12, ..*start }
    }

    /// Returns the largest distance, at the time `along`, from which the solids may still come
    /// within the target distance before the end; infinity if there is no end.
    fn limit(&self, along: N, tolerance: N) -> N {
        if !self.end.is_finite_number() {
            return N::INFINITY;
        }
        self.target + self.velocity.norm() * (self.end - along) + tolerance
    }

    /// Returns the speed at which the solids approach along a normal: negative if they separate,
    /// never positive for a mirrored pair.
    fn closing(&self, normal: &Vector<N, D>) -> N {
        let closing = -normal.dot(&self.velocity);
        if self.mirrored { -closing.abs() } else { closing }
    }

    /// Returns the largest speed along a normal that is treated as rounding error.
    fn rounding_error(&self) -> N {
        N::lit(8.0) * N::EPSILON * max_component(&self.velocity)
    }

    /// Returns the largest depth at the start that counts as touching: the tolerance of distances,
    /// and the rounding errors of the positions.
    pub(crate) fn slack(&self, tolerance: N) -> N {
        tolerance + self.rounding
    }

    /// Returns whether a contact at the start is an impact: always with `contact_at_start`, else by
    /// the rule of [`impact`](super::impact).
    pub(crate) fn counts_at_start(&self, normal: &Vector<N, D>, gap: N, tolerance: N) -> bool {
        let (slack, closing) = (self.slack(tolerance), self.closing(normal));
        self.contact_at_start || is_hit_at_start(gap, closing, slack, self.rounding_error())
    }
}

impl<N: Space<D>, const D: usize> Path<N, D> {
    /// Returns whether a contact of convex solids that counts at the start, with the separation
    /// `found`, still counts after a tiny motion: whether solids that touch still approach, an
    /// overlap has not become less, or the solids get deeper in between. Where a corner meets a
    /// corner, every normal between two faces is one of the contact, and the separation returns any
    /// of them:
    ///
    /// ```text
    ///         ┌───┐  -> slides on the floor, and does not hit the tile on its right:
    ///         │   │     at the start the normals of its side and of its bottom tie,
    ///     ┌───┼───┤     later that of its bottom has the larger gap
    ///     │   │   │
    /// ```
    ///
    /// If the box is at the target distance above the floor, it approaches the corner of the next
    /// tile just before it is above this tile, by less than the rounding error.
    pub(crate) fn counts_soon(
        &self,
        start: &Pair<'_, N, D>,
        found: &Separation<N, D>,
        tolerance: N,
    ) -> bool {
        let slack = self.slack(tolerance);
        let soon = soon(size(start), slack) / max_component(&self.velocity);
        if self.contact_at_start || !soon.is_finite_number() {
            return true;
        }
        let Some(later) = separation(&self.moved(start, soon), N::INFINITY) else { return true };
        let gaps = [found.distance - self.target, later.distance - self.target];
        let closing = [self.closing(&found.normal), self.closing(&later.normal)];
        let is_held = if gaps[0] < -slack {
            gaps[1] <= gaps[0] + N::lit(8.0) * slack
        } else {
            closing[1] > self.rounding_error()
        };
        is_held || least_gap(gaps, closing, soon) < min(gaps[0], N::ZERO) - N::TWO * slack
    }
}

impl<N: Space<D>, const D: usize> Arrival<N, D> {
    const fn reached(along: N, separation: Separation<N, D>) -> Self {
        Self { along, separation, status: ImpactStatus::Reached }
    }

    /// Returns the impact of solids in contact at the time `along`; a `gap` within the tolerance of
    /// zero is treated as touching.
    pub(crate) fn in_contact(along: N, separation: Separation<N, D>, gap: N, tolerance: N) -> Self {
        let is_start = along <= N::ZERO;
        let at_start = ImpactStatus::at_start(gap, tolerance);
        let status = if is_start { at_start } else { ImpactStatus::Reached };
        Self { along, separation, status }
    }

    /// Returns the features on which the points of the pair lie at its impact.
    pub(crate) fn features(&self, start: &Pair<'_, N, D>, path: &Path<N, D>) -> [FeatureId; 2] {
        <N::Algorithms>::witness_features(&path.moved(start, self.along), &self.separation)
    }
}

/// Returns a lower bound of a convex function of time between zero and `end`, at both of which
/// `gaps` and `closing` are its values and its speeds of decrease: the height at which the tangents
/// meet.
fn least_gap<N: Real>(gaps: [N; 2], closing: [N; 2], end: N) -> N {
    let bend = closing[0] - closing[1];
    let meeting = (gaps[0] - gaps[1] - closing[1] * end) / bend;
    // Without a bend the function is a line.
    let is_between = meeting > N::ZERO && meeting < end;
    if is_between { gaps[0] - closing[0] * meeting } else { min(gaps[0], gaps[1]) }
}

/// Returns whether a contact at the start is an impact without
/// [`ImpactOptions::contact_at_start`](super::ImpactOptions). The impacts are contacts that get
/// deeper, overlaps that do not separate, and unbounded overlaps.
///
/// A gap within `tolerance` and a closing speed within `rounding_error` are treated as zero.
pub(super) fn is_hit_at_start<N: Real>(
    gap: N,
    closing: N,
    tolerance: N,
    rounding_error: N,
) -> bool {
    let deep = gap < -tolerance;
    closing > rounding_error || (deep && closing >= -rounding_error) || gap == -N::INFINITY
}

/// The result of [`begin`]: a contact at the start, or an impact later.
pub(crate) enum Beginning<N: Real, const D: usize> {
    /// The solids are in contact at the start. `counts` is true if that contact is an impact by
    /// [`Path::counts_at_start`].
    InContact { arrival: Arrival<N, D>, counts: bool },
    /// The solids are apart at the start; `None` if there is no impact.
    Apart(Option<Arrival<N, D>>),
}

/// Returns the first impact of two solids on a path: the first time at which they are at the target
/// distance, or time zero for a contact at the start that counts as an impact. `None` if there is
/// no impact up to the end of the path.
///
/// Conservative advancement (Mirtich, "Impulse-based dynamic simulation", 1996). The solids stay
/// apart at least until the gap along the normal of the nearest points is used up at the closing
/// speed along that normal. If that speed is not positive, they stay apart for ever. The signed
/// distance of convex solids is a convex function of time; conservative advancement is Newton's
/// method on this function, from the left: no step passes the first touch.
pub(crate) fn advance<N: Space<D>, const D: usize>(
    start: &Pair<'_, N, D>,
    path: &Path<N, D>,
) -> Option<Arrival<N, D>> {
    match begin(start, path, N::ZERO) {
        Beginning::InContact { arrival, counts } => counts.then_some(arrival),
        Beginning::Apart(arrival) => arrival,
    }
}

/// Runs [`advance`] for solids that certainly do not touch before the time `earliest`. A contact at
/// the start is returned even if it is not an impact.
pub(crate) fn begin<N: Space<D>, const D: usize>(
    start: &Pair<'_, N, D>,
    path: &Path<N, D>,
    earliest: N,
) -> Beginning<N, D> {
    let tolerance = N::lit(8.0) * N::EPSILON * size(start);
    // A lower bound within rounding error does not exclude a contact at the start.
    let is_apart = earliest * max_component(&path.velocity) > tolerance;
    let from = if is_apart { earliest - earliest * N::lit(8.0) * N::EPSILON } else { N::ZERO };
    let limit = path.limit(from, tolerance);
    let found = separation(&path.moved(start, from), limit).filter(|_| path.end >= N::ZERO);
    let Some(found) = found else { return Beginning::Apart(None) };
    let gap = found.distance - path.target;
    if !is_apart && gap <= tolerance {
        let arrival = Arrival::in_contact(N::ZERO, found, gap, path.slack(tolerance));
        let counts = path.counts_at_start(&found.normal, gap, tolerance)
            && path.counts_soon(start, &found, tolerance);
        return Beginning::InContact { arrival, counts };
    }
    if gap > tolerance
        && let Some(arrival) = arrival_of_balls(start, path, tolerance)
    {
        return Beginning::Apart(Some(arrival));
    }
    Beginning::Apart(by_steps(start, path, from, found, tolerance))
}

/// Runs conservative advancement from the configuration at time `along`, in which the separation is
/// `found`. `None` if the solids do not touch up to the end of the path.
fn by_steps<N: Space<D>, const D: usize>(
    start: &Pair<'_, N, D>,
    path: &Path<N, D>,
    mut along: N,
    mut found: Separation<N, D>,
    tolerance: N,
) -> Option<Arrival<N, D>> {
    let mut pair = *start;
    for _ in 0..MAX_STEPS {
        let (gap, closing) = (found.distance - path.target, path.closing(&found.normal));
        if gap <= tolerance {
            return Some(Arrival::reached(along, found));
        }
        let later = along + gap / closing;
        let in_time = closing > path.rounding_error() && later <= path.end;
        if !in_time {
            return None;
        }
        if later <= along {
            return Some(Arrival::reached(along, found));
        }
        let step = path.velocity * (later - along);
        along = later;
        pair.pose12.translation = path.position_at(start, along);
        if let Some(touch) = touching(&pair, &found, &step, path.target, tolerance) {
            return Some(Arrival::reached(along, touch));
        }
        found = separation(&pair, path.limit(along, tolerance))?;
    }
    Some(Arrival { along, separation: found, status: ImpactStatus::StepsSpent })
}

/// Returns the impact of two separated balls, from a quadratic equation and verified by their
/// separation at that time. `None` leaves the decision to the iteration.
///
/// The foot is the point of the second centre's path nearest to the first centre. A right triangle
/// leads from the foot back to the position of contact. Lengths are divided by a power of two, so
/// that squares neither overflow nor underflow.
fn arrival_of_balls<N: Space<D>, const D: usize>(
    start: &Pair<'_, N, D>,
    path: &Path<N, D>,
    tolerance: N,
) -> Option<Arrival<N, D>> {
    let (Kind::Ball(ball1), Kind::Ball(ball2)) = (start.first, start.second) else { return None };
    let (velocity, contact_distance) =
        (&path.velocity, ball1.radius() + ball2.radius() + path.target);
    let scale =
        max(max_component(&start.pose12.translation), contact_distance).power_of_two_below();
    let (middle, contact_distance) = (start.pose12.translation / scale, contact_distance / scale);
    let squared = velocity.norm_squared();
    let foot = -middle.dot(velocity) / squared;
    let across = middle + velocity * foot;
    let leg = ((contact_distance * contact_distance - across.norm_squared()) / squared).sqrt();
    let along = (foot - leg) * scale;
    // The root is NaN for balls that pass each other, and the comparison is false for NaN: these
    // balls are also left to the iteration.
    let is_in_time = along > N::ZERO && along <= path.end;
    if !is_in_time {
        return None;
    }
    let found = separation(&path.moved(start, along), N::INFINITY)?;
    let is_there = (found.distance - path.target).abs() <= tolerance;
    is_there.then(|| Arrival::reached(along, found))
}

/// Returns the separation at the end of a step that used up the gap along the normal
/// `before.normal`. `None` unless one of the nearest points of `before` proves that this normal is
/// still valid.
///
/// Planes perpendicular to that normal still separate the solids by `target`. So `target` is the
/// distance of the solids if the nearest point of one solid, which lies on its plane, has that
/// distance from the other solid. The normal is unchanged if the other solid has the same normal
/// towards that point. For curved solids the normal has rotated during the step, by about the
/// square root of the error that the step removed. A half-space needs no proof, as its normal is
/// constant.
fn touching<N: Space<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    before: &Separation<N, D>,
    step: &Vector<N, D>,
    target: N,
    tolerance: N,
) -> Option<Separation<N, D>> {
    let Pair { first, second, pose12 } = pair;
    let (normal, point1, point2) = (before.normal, before.point1, before.point2 + step);
    if let Kind::Plane(_) = second {
        let point2 = point1 + normal * target;
        return Some(Separation { distance: target, normal, point1, point2 });
    }
    if let Kind::Plane(_) = first {
        let point1 = point2 - normal * target;
        return Some(Separation { distance: target, normal, point1, point2 });
    }
    // For balls a full separation costs no more than the proof. For support maps the nearest points
    // rarely stay the same.
    if let Kind::Ball(_) | Kind::SupportMap(_) = first {
        return None;
    }
    let is_touch = |distance: N, outward: Vector<N, D>| {
        let deviation = max_component(&(outward - normal));
        (distance - target).abs() <= tolerance && deviation <= N::lit(8.0) * N::EPSILON
    };
    let project =
        |kind: Kind<'_, N, D>, point: &Point<N, D>| <N::Algorithms>::project_on_solid(kind, point);
    let projected = project(*first, &point2);
    if let Some(projected) =
        projected.filter(|projected| is_touch(projected.distance, projected.outward))
    {
        let (distance, point1) = (projected.distance, point2 - normal * projected.distance);
        return Some(Separation { distance, normal, point1, point2 });
    }
    let projected = project(*second, &pose12.inverse_point(&point1))?;
    let point2 = point1 + normal * projected.distance;
    let is_proved = is_touch(projected.distance, -pose12.vector(&projected.outward));
    is_proved.then_some(Separation { distance: projected.distance, normal, point1, point2 })
}

/// Returns the length to which tolerances are proportional: the bounding radii of both solids, zero
/// for those without a support map, plus the largest component of the translation between them.
pub(crate) fn size<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> N {
    let bounding_radius = |geometry: Geometry<'_, N, D>| {
        geometry.as_support_map().map_or(N::ZERO, |map| map.reach() + map.rounding())
    };
    let apart = max_component(&pair.pose12.translation);
    apart + bounding_radius(Geometry(pair.first)) + bounding_radius(Geometry(pair.second))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collide::separation::hulls::tests::Random;
    use crate::shape::{Ball, Shape};

    /// Checks, for random balls that hit or miss each other, that an impact from the equation
    /// agrees with the iteration, and that the equation finds more than 98 % of the impacts of the
    /// iteration.
    fn fly<N: Space<3>>(size: f64) {
        let random = &mut Random(3);
        let (mut met, mut count) = (0, 0);
        for round in 0..4000_u32 {
            let balls = [random.vector::<N>(), random.vector::<N>()]
                .map(|v| Ball::new(v.x.abs() * N::lit(size)));
            let [first, second] = balls.each_ref().map(|ball| Shape::<N, 3>::geometry(ball).0);
            let translation = random.vector::<N>() * N::lit(4.0 * size);
            let pose12 = Pose::from_translation(translation);
            let aim = random.vector::<N>() * N::lit(size * f64::from(round % 8) * 0.25);
            let velocity = (aim - translation) / max_component(&(aim - translation));
            let target = [N::ZERO, N::lit(size * 0.1)][usize::from(round % 3 == 0)];
            let (start, path) = (
                Pair { first, second, pose12 },
                Path {
                    velocity,
                    end: N::INFINITY,
                    target,
                    rounding: N::ZERO,
                    contact_at_start: false,
                    mirrored: false,
                },
            );
            let tolerance = N::lit(8.0) * N::EPSILON * super::size(&start);
            let found = separation(&start, N::INFINITY).expect("finite");
            if found.distance - target <= tolerance {
                continue;
            }
            let expected = by_steps(&start, &path, N::ZERO, found, tolerance);
            count += usize::from(expected.is_some());
            let Some(arrival) = arrival_of_balls(&start, &path, tolerance) else { continue };
            met += 1;
            let expected = expected.expect("they touch by steps too");
            // Balls that graze each other are within the tolerance for a longer time.
            let closing = path.closing(&arrival.separation.normal);
            let late = (arrival.along - expected.along) * closing;
            assert!(late.abs() <= N::lit(4.0) * tolerance, "{late} late in round {round}");
        }
        assert!(met * 100 > count * 98, "{met} of {count} by the equation");
    }

    #[test]
    fn balls_meet_when_steps_say() {
        for size in [1.0, 1e-9, 1e9] {
            fly::<f32>(size);
            fly::<f64>(size);
        }
    }
}
