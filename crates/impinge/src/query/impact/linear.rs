//! The first touch of two solids that do not turn: the kernel, on one pair.
//!
//! Balls that are apart meet where a quadratic equation says and their separation then proves it; a half-space is
//! met after one step; all other pairs advance by what certainly separates them. The last step may be told by a
//! point that touches, where that proves it and the normal has not turned on the way.

use super::ImpactStatus;
use crate::collide::Pair;
use crate::collide::separation::separation;
use crate::convex::Separation;
use crate::math::{Point, Pose, Real, Space, Vector, max, max_component};
use crate::shape::{FeatureId, Geometry, Kind};
use crate::tables::ByDimension;

/// At most so many steps are made.
const MAX_STEPS: usize = 128;

/// How the second solid of a pair moves in the frame of the first.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Path<N: Real, const D: usize> {
    /// Its way per unit of time; no component exceeds two.
    pub(crate) velocity: Vector<N, D>,
    /// The last time that counts.
    pub(crate) end: N,
    /// The distance at which the solids touch; zero or more.
    pub(crate) target: N,
    /// A contact at the start counts, whatever the velocity.
    pub(crate) contact_at_start: bool,
    /// The solids are the same at the same place: every normal is as good as its opposite.
    pub(crate) mirrored: bool,
}

/// Where the path of a pair comes to its end.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Arrival<N: Real, const D: usize> {
    /// The time, in the unit of the path.
    pub(crate) along: N,
    /// How the solids lie then, in the frame of the first.
    pub(crate) separation: Separation<N, D>,
    pub(crate) status: ImpactStatus,
}

impl<N: Real, const D: usize> Path<N, D> {
    /// Where the second solid of the pair that begins so is at a later time.
    #[inline]
    fn place(&self, start: &Pair<'_, N, D>, along: N) -> Vector<N, D> {
        start.pose12.translation + self.velocity * along
    }

    /// The pair that begins so, at a later time.
    pub(crate) fn moved<'a>(&self, start: &Pair<'a, N, D>, along: N) -> Pair<'a, N, D> {
        let pose12 = Pose { translation: self.place(start, along), ..start.pose12 };
        Pair { pose12, ..*start }
    }

    /// The largest distance at a time from which the solids may still come as near as the target.
    fn limit(&self, along: N, tolerance: N) -> N {
        if !self.end.is_finite_number() {
            return N::INFINITY;
        }
        self.target + self.velocity.norm() * (self.end - along) + tolerance
    }

    /// How fast the solids approach along a normal.
    fn closing(&self, normal: &Vector<N, D>) -> N {
        let closing = -normal.dot(&self.velocity);
        if self.mirrored { -closing.abs() } else { closing }
    }

    /// The speed along a normal that rounding makes of none.
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

    /// The arrival of solids that are in contact at a time, with this gap, of which up to the tolerance counts as none.
    pub(crate) fn in_contact(along: N, separation: Separation<N, D>, gap: N, tolerance: N) -> Self {
        let is_start = along <= N::ZERO;
        let at_start = ImpactStatus::at_start(gap, tolerance);
        let status = if is_start { at_start } else { ImpactStatus::Reached };
        Self { along, separation, status }
    }

    /// What the points of the pair that begins so lie on when it arrives.
    pub(crate) fn features(&self, start: &Pair<'_, N, D>, path: &Path<N, D>) -> [FeatureId; 2] {
        <N::Algorithms>::witness_features(&path.moved(start, self.along), &self.separation)
    }
}

/// Whether a contact at the start is a hit that is not asked for: one that gets deeper is; one that is neither deep
/// nor gets deeper, or gets less deep, is none. What overlaps without bound is never parted.
///
/// Up to the tolerance the gap, and up to the noise the speed at which it closes, is none.
pub(super) fn is_hit_at_start<N: Real>(gap: N, closing: N, tolerance: N, noise: N) -> bool {
    let deep = gap < -tolerance;
    closing > noise || (deep && closing >= -noise) || gap == -N::INFINITY
}

/// How the path of two solids begins.
pub(crate) enum Beginning<N: Real, const D: usize> {
    /// They are in contact at the start. `counts` says whether that is a hit by the normal of the two.
    InContact { arrival: Arrival<N, D>, counts: bool },
    /// They are apart, and arrive there, if they do.
    Apart(Option<Arrival<N, D>>),
}

/// The first time on a path at which two solids are at the target distance.
///
/// Conservative advancement (Mirtich, "Impulse-based dynamic simulation", 1996): with the gap along
/// the normal between the nearest points, and the speed at which that normal sees it closing, the
/// solids stay apart until the gap is used up. If the normal does not see it closing, they stay apart
/// for ever. The signed distance of convex solids is a convex function of the time, and this is
/// Newton's method on it, from the left: it never passes the first touch.
pub(crate) fn advance<N: Space<D>, const D: usize>(
    start: &Pair<'_, N, D>,
    path: &Path<N, D>,
) -> Option<Arrival<N, D>> {
    match begin(start, path, N::ZERO) {
        Beginning::InContact { arrival, counts } => counts.then_some(arrival),
        Beginning::Apart(arrival) => arrival,
    }
}

/// [`advance`] of solids that certainly do not meet before a time, which does not decide about a contact at the
/// start.
pub(crate) fn begin<N: Space<D>, const D: usize>(
    start: &Pair<'_, N, D>,
    path: &Path<N, D>,
    earliest: N,
) -> Beginning<N, D> {
    let tolerance = N::lit(8.0) * N::EPSILON * size(start);
    // What is apart by rounding alone says nothing of a contact at the start.
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

/// The arrival by steps from where the solids lie at a time.
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

/// When two balls meet that are apart, by a quadratic equation: where it is proved by their separation then. What
/// rounding decides is left to the steps.
///
/// The way of the second middle has a foot, which is nearest to the first: from there it is the leg of a right
/// triangle back to where they meet. Lengths are divided by a power of two, so that squares are numbers.
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
    // Written so that NaN, as of balls that pass each other, is left to the steps too.
    let is_way = along > N::ZERO && along <= path.end;
    if !is_way {
        return None;
    }
    let found = separation(&path.moved(start, along), N::INFINITY)?;
    let is_there = (found.distance - path.target).abs() <= tolerance;
    is_there.then(|| Arrival::reached(along, found))
}

/// The separation at the end of a step which used up the gap along the normal of its beginning, where it has
/// that normal still and one of the nearest points from then proves it; `None` says nothing.
///
/// Planes across that normal still hold the solids apart by the target distance. So they are that far from
/// each other if the point of one, on its plane, is that far from the other solid; and the normal is that of
/// now if it is also the one that the other solid has towards that point. Of curved solids it has turned on
/// the way, by about the square root of the error that the step removed. The plane of a half-space needs no
/// proof.
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
    // Of balls the separation costs no more, and the points of others are hardly ever the same.
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

/// The length that tolerances are in proportion to: the sizes of the solids and how far they are.
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

    /// Balls that fly past each other at all distances: those that meet do when steps find that they do.
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
            // Where they graze each other, when they are near enough is a longer while.
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
