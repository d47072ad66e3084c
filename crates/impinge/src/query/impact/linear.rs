//! The first touch of two solids that do not rotate: the kernel, on one pair.
//!
//! Two separated balls meet at the root of a quadratic equation, which their separation then
//! proves. A half-space is hit after one step. All other pairs advance by the gap that certainly
//! separates them. The last step may be proved by a touching point instead of a separation, if the
//! normal has not changed on the way.

use super::ImpactStatus;
use crate::collide::Pair;
use crate::collide::separation::separation;
use crate::convex::Separation;
use crate::math::{Point, Pose, Real, Space, Vector, max, max_component};
use crate::shape::{FeatureId, Geometry, Kind};
use crate::tables::ByDimension;

/// The maximum number of steps.
const MAX_STEPS: usize = 128;

/// The motion of the second solid of a pair in the frame of the first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Path<N: Real, const D: usize> {
    /// The displacement per unit of time; no component exceeds two.
    pub(crate) velocity: Vector<N, D>,
    /// The latest time that counts, inclusive.
    pub(crate) end: N,
    /// The distance at which the solids touch; zero or more.
    pub(crate) target: N,
    /// A contact at the start counts, whatever the velocity.
    pub(crate) contact_at_start: bool,
    /// The solids are the same at the same pose: every normal is as good as its opposite.
    pub(crate) mirrored: bool,
}

/// The end of the path of a pair.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival<N: Real, const D: usize> {
    /// The time, in the unit of the path.
    pub(crate) along: N,
    /// The separation at that time, in the frame of the first.
    pub(crate) separation: Separation<N, D>,
    pub(crate) status: ImpactStatus,
}

impl<N: Real, const D: usize> Path<N, D> {
    /// The position of the second solid at a later time, for a pair that starts at `start`.
    #[inline]
    fn place(&self, start: &Pair<'_, N, D>, along: N) -> Vector<N, D> {
        start.pose12.translation + self.velocity * along
    }

    /// The pair `start` at a later time.
    pub(crate) fn moved<'a>(&self, start: &Pair<'a, N, D>, along: N) -> Pair<'a, N, D> {
        let pose12 = Pose { translation: self.place(start, along), ..start.pose12 };
        Pair { pose12, ..*start }
    }

    /// The largest distance, at the time `along`, from which the solids may still come within the
    /// target.
    fn limit(&self, along: N, tolerance: N) -> N {
        if !self.end.is_finite_number() {
            return N::INFINITY;
        }
        self.target + self.velocity.norm() * (self.end - along) + tolerance
    }

    /// The speed at which the solids approach along a normal.
    fn closing(&self, normal: &Vector<N, D>) -> N {
        let closing = -normal.dot(&self.velocity);
        if self.mirrored { -closing.abs() } else { closing }
    }

    /// The largest speed along a normal that counts as rounding error.
    fn noise(&self) -> N {
        N::lit(8.0) * N::EPSILON * max_component(&self.velocity)
    }

    /// Whether a contact at the start counts.
    pub(crate) fn counts_at_start(&self, normal: &Vector<N, D>, gap: N, tolerance: N) -> bool {
        self.contact_at_start || is_hit_at_start(gap, self.closing(normal), tolerance, self.noise())
    }
}

impl<N: Space<D>, const D: usize> Arrival<N, D> {
    const fn reached(along: N, separation: Separation<N, D>) -> Self {
        Self { along, separation, status: ImpactStatus::Reached }
    }

    /// The arrival of solids in contact at a time; a `gap` within the tolerance of zero counts as
    /// touching.
    pub(crate) fn in_contact(along: N, separation: Separation<N, D>, gap: N, tolerance: N) -> Self {
        let is_start = along <= N::ZERO;
        let at_start = ImpactStatus::at_start(gap, tolerance);
        let status = if is_start { at_start } else { ImpactStatus::Reached };
        Self { along, separation, status }
    }

    /// The features on which the points of the pair lie at its arrival.
    pub(crate) fn features(&self, start: &Pair<'_, N, D>, path: &Path<N, D>) -> [FeatureId; 2] {
        <N::Algorithms>::witness_features(&path.moved(start, self.along), &self.separation)
    }
}

/// Whether a contact at the start is a hit without
/// [`ImpactOptions::contact_at_start`](super::ImpactOptions): one that gets deeper is, a deep one
/// that does not separate is, any other is not. An unbounded overlap always is.
///
/// A gap within the tolerance and a closing speed within the noise count as zero.
pub(super) fn is_hit_at_start<N: Real>(gap: N, closing: N, tolerance: N, noise: N) -> bool {
    let deep = gap < -tolerance;
    closing > noise || (deep && closing >= -noise) || gap == -N::INFINITY
}

/// The start of the path of two solids.
pub(crate) enum Beginning<N: Real, const D: usize> {
    /// They are in contact at the start; `counts` is whether their normal makes that a hit.
    InContact { arrival: Arrival<N, D>, counts: bool },
    /// They are apart; the arrival, if there is one.
    Apart(Option<Arrival<N, D>>),
}

/// Returns the first time on a path at which two solids are at the target distance.
///
/// Conservative advancement (Mirtich, "Impulse-based dynamic simulation", 1996): the solids stay
/// apart at least until the gap along the normal between the nearest points is used up at the speed
/// of approach along that normal. If they do not approach along it, they stay apart for ever. The
/// signed distance of convex solids is a convex function of time, and this is Newton's method on
/// it, from the left: it never passes the first touch.
pub(crate) fn advance<N: Space<D>, const D: usize>(
    start: &Pair<'_, N, D>,
    path: &Path<N, D>,
) -> Option<Arrival<N, D>> {
    match begin(start, path, N::ZERO) {
        Beginning::InContact { arrival, counts } => counts.then_some(arrival),
        Beginning::Apart(arrival) => arrival,
    }
}

/// [`advance`] for solids that certainly do not meet before the time `earliest`; reports a contact
/// at the start without deciding whether it counts.
pub(crate) fn begin<N: Space<D>, const D: usize>(
    start: &Pair<'_, N, D>,
    path: &Path<N, D>,
    earliest: N,
) -> Beginning<N, D> {
    let tolerance = N::lit(8.0) * N::EPSILON * size(start);
    // A bound within rounding error does not exclude a contact at the start.
    let is_apart = earliest * max_component(&path.velocity) > tolerance;
    let from = if is_apart { earliest - earliest * N::lit(8.0) * N::EPSILON } else { N::ZERO };
    let limit = path.limit(from, tolerance);
    let found = separation(&path.moved(start, from), limit).filter(|_| path.end >= N::ZERO);
    let Some(found) = found else { return Beginning::Apart(None) };
    let gap = found.distance - path.target;
    if !is_apart && gap <= tolerance {
        let arrival = Arrival::in_contact(N::ZERO, found, gap, tolerance);
        let counts = path.counts_at_start(&found.normal, gap, tolerance);
        return Beginning::InContact { arrival, counts };
    }
    if gap > tolerance
        && let Some(arrival) = meeting_of_balls(start, path, tolerance)
    {
        return Beginning::Apart(Some(arrival));
    }
    Beginning::Apart(by_steps(start, path, from, found, tolerance))
}

/// Conservative advancement from the configuration at time `along`.
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
        let in_time = closing > path.noise() && later <= path.end;
        if !in_time {
            return None;
        }
        if later <= along {
            return Some(Arrival::reached(along, found));
        }
        let step = path.velocity * (later - along);
        along = later;
        pair.pose12.translation = path.place(start, along);
        if let Some(touch) = touching(&pair, &found, &step, path.target, tolerance) {
            return Some(Arrival::reached(along, touch));
        }
        found = separation(&pair, path.limit(along, tolerance))?;
    }
    Some(Arrival { along, separation: found, status: ImpactStatus::StepsSpent })
}

/// The time at which two separated balls meet, from a quadratic equation and proved by their
/// separation then. `None` leaves the decision to the steps.
///
/// The foot is the point of the second centre's path nearest to the first centre: a right triangle
/// leads from it back to the point of contact. Lengths are divided by a power of two, so that
/// squares neither overflow nor underflow.
fn meeting_of_balls<N: Space<D>, const D: usize>(
    start: &Pair<'_, N, D>,
    path: &Path<N, D>,
    tolerance: N,
) -> Option<Arrival<N, D>> {
    let (Kind::Ball(ball1), Kind::Ball(ball2)) = (start.first, start.second) else { return None };
    let (velocity, reach) = (&path.velocity, ball1.radius() + ball2.radius() + path.target);
    let scale = max(max_component(&start.pose12.translation), reach).power_of_two_below();
    let (middle, reach) = (start.pose12.translation / scale, reach / scale);
    let squared = velocity.norm_squared();
    let foot = -middle.dot(velocity) / squared;
    let across = middle + velocity * foot;
    let leg = ((reach * reach - across.norm_squared()) / squared).sqrt();
    let along = (foot - leg) * scale;
    // Written so that NaN, from balls that pass each other, is left to the steps too.
    let is_way = along > N::ZERO && along <= path.end;
    if !is_way {
        return None;
    }
    let found = separation(&path.moved(start, along), N::INFINITY)?;
    let is_there = (found.distance - path.target).abs() <= tolerance;
    is_there.then(|| Arrival::reached(along, found))
}

/// The separation at the end of a step that used up the gap along the normal at its beginning, if
/// that still is the normal and one of the nearest points from then proves it; else `None`.
///
/// Planes across that normal still separate the solids by the target distance. So this is their
/// distance if the point of one, on its plane, has that distance from the other solid; and the
/// normal is unchanged if the other solid has the same normal towards that point. For curved solids
/// it has rotated on the way, by about the square root of the error that the step removed. The
/// plane of a half-space needs no proof.
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
    // For balls the separation costs no more, and the nearest points of support maps rarely stay.
    if let Kind::Ball(_) | Kind::SupportMap(_) = first {
        return None;
    }
    let is_touch = |distance: N, outward: Vector<N, D>| {
        let turned = max_component(&(outward - normal));
        (distance - target).abs() <= tolerance && turned <= N::lit(8.0) * N::EPSILON
    };
    let seen_from = |kind: Kind<'_, N, D>, point: &Point<N, D>| <N::Algorithms>::seen(kind, point);
    let seen = seen_from(*first, &point2);
    if let Some(seen) = seen.filter(|seen| is_touch(seen.distance, seen.outward)) {
        let (distance, point1) = (seen.distance, point2 - normal * seen.distance);
        return Some(Separation { distance, normal, point1, point2 });
    }
    let seen = seen_from(*second, &pose12.inverse_point(&point1))?;
    let point2 = point1 + normal * seen.distance;
    let is_proved = is_touch(seen.distance, -pose12.vector(&seen.outward));
    is_proved.then_some(Separation { distance: seen.distance, normal, point1, point2 })
}

/// The length that tolerances are proportional to: the sizes of the solids plus their distance.
pub(crate) fn size<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> N {
    let reach = |geometry: Geometry<'_, N, D>| {
        geometry.as_support_map().map_or(N::ZERO, |map| map.reach() + map.rounding())
    };
    let apart = max_component(&pair.pose12.translation);
    apart + reach(Geometry(pair.first)) + reach(Geometry(pair.second))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collide::separation::hulls::tests::Random;
    use crate::shape::{Ball, Shape};

    /// Balls that fly past each other at all distances: the equation finds a hit exactly when steps
    /// do.
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
            let Some(arrival) = meeting_of_balls(&start, &path, tolerance) else { continue };
            met += 1;
            let expected = expected.expect("they meet by steps too");
            // If they graze each other, they are within the tolerance for a longer time.
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
