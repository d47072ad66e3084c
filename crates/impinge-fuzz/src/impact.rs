//! Impacts of two moving shapes.

use impinge::math::{Isometry, Pose, Real, Space, Vector, max};
use impinge::query::{self, Impact, ImpactOptions, ImpactStatus, Moving};

use crate::pair::Pair;
use crate::place::Dimension;
use crate::shapes::parts_of;
use crate::{Bytes, Task, dispatch};

struct Straight;
struct Turning;

/// Fuzzes [`query::impact`] and [`query::time_of_impact`].
pub fn time_of_impact(data: &[u8]) {
    dispatch(Straight, data);
}

/// Fuzzes [`query::nonlinear_time_of_impact`].
pub fn nonlinear_time_of_impact(data: &[u8]) {
    dispatch(Turning, data);
}

fn options<N: Real>(bytes: &mut Bytes<'_>) -> ImpactOptions<N> {
    let mut options = ImpactOptions::new();
    if bytes.coin() {
        options = options.with_max_time(bytes.number());
    }
    if bytes.coin() {
        options = options.with_target_distance(bytes.number());
    }
    options
}

type Found<N, const D: usize> = Option<Impact<N, D>>;

impl Task for Straight {
    fn run<N: Space<D>, M: Dimension<N, D>, const D: usize>(self, bytes: &mut Bytes<'_>) {
        let pair = Pair::<N, M::Turn, D>::from_bytes::<M>(bytes);
        let (v1, v2) = (bytes.vector(), bytes.vector());
        let options = options(bytes);
        let one = Moving::new(&pair.m1, &v1, &*pair.g1);
        let other = Moving::new(&pair.m2, &v2, &*pair.g2);
        let found = query::impact(&one, &other, &options);
        let swapped = query::impact(&other, &one, &options);
        check(&pair, &options, [found, swapped], v1 != v2);
        let plain = query::impact(&one, &other, &ImpactOptions::new()).map(|found| found.toi);
        let (g1, g2) = (&*pair.g1, &*pair.g2);
        let toi = query::time_of_impact(&pair.m1, &v1, g1, &pair.m2, &v2, g2);
        assert_eq!(plain, toi, "{pair:?}");
        if let Some(found) = found {
            check_meeting(&pair, &found, [v1, v2], max(options.target_distance, N::ZERO));
        }
    }
}

impl Task for Turning {
    fn run<N: Space<D>, M: Dimension<N, D>, const D: usize>(self, bytes: &mut Bytes<'_>) {
        let pair = Pair::<N, M::Turn, D>::from_bytes::<M>(bytes);
        let (motion1, motion2) = (M::motion(pair.m1, bytes), M::motion(pair.m2, bytes));
        let options = options(bytes);
        let (g1, g2) = (&*pair.g1, &*pair.g2);
        let found = query::nonlinear_time_of_impact(&*motion1, g1, &*motion2, g2, &options);
        let swapped = query::nonlinear_time_of_impact(&*motion2, g2, &*motion1, g1, &options);
        check(&pair, &options, [found, swapped], true);
    }
}

/// Checks that an impact is within the limits of its options and parts, and that swapped arguments
/// give the flipped impact. `_told_apart` is unused.
fn check<N: Space<D>, R, const D: usize>(
    pair: &Pair<N, R, D>,
    options: &ImpactOptions<N>,
    [found, swapped]: [Found<N, D>; 2],
    _told_apart: bool,
) where
    R: impinge::math::AbstractRotation<N, D> + Copy,
{
    pair.check_flip(&found, &swapped, |other| other.map(|impact| impact.flipped()));
    let Some(found) = found else { return };
    assert!(pair.is_placed(), "{found:?} of\n{pair:?}");
    assert!(found.toi >= N::ZERO && found.toi <= options.max_time, "{found:?} of\n{pair:?}");
    assert!(found.toi.is_finite_number(), "{found:?} of\n{pair:?}");
    assert!(!found.status.is_at_start() || found.toi == N::ZERO, "{found:?} of\n{pair:?}");
    assert!(found.part1 < parts_of(&*pair.g1).unwrap_or(1), "{found:?} of\n{pair:?}");
    assert!(found.part2 < parts_of(&*pair.g2).unwrap_or(1), "{found:?} of\n{pair:?}");
    let length = found.normal.norm();
    if pair.is_moderate {
        assert!((length - N::ONE).abs() <= N::EPSILON * N::lit(64.0), "{found:?} of\n{pair:?}");
    }
}

/// Checks that the distance at the time of impact is at most the target distance, up to rounding
/// errors. Checks nothing if the numbers are not moderate or the solver has used all its steps.
fn check_meeting<N: Space<D>, R, const D: usize>(
    pair: &Pair<N, R, D>,
    found: &Impact<N, D>,
    velocities: [Vector<N, D>; 2],
    target: N,
) where
    R: impinge::math::AbstractRotation<N, D> + Copy,
{
    if !pair.is_moderate || found.status == ImpactStatus::StepsSpent {
        return;
    }
    let moved = |m: &Isometry<N, R, D>, velocity: Vector<N, D>| {
        let mut moved = *m;
        moved.translation.vector += velocity * found.toi;
        moved
    };
    let mut later = pair.swapped().swapped();
    later.m1 = moved(&pair.m1, velocities[0]);
    later.m2 = moved(&pair.m2, velocities[1]);
    let distance = later.distance();
    let tolerance = (pair.tolerance() + later.tolerance()) * N::lit(4.0);
    let gap = distance - target;
    assert!(
        gap <= tolerance,
        "{gap} at {:?}: {found:?} {velocities:?} of\n{pair:?}",
        Pose::from_isometry(&later.m2)
    );
}
