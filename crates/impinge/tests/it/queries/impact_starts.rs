//! Tests impacts of rotating bodies that start in contact, searches without end, and bad input.

use crate::support::samples::samples;

use super::impact_turning::{
    FOR_EVER, Opaque, V2, V3, assert_near, at, both, half_plane, rod, spins, toi, turned, until,
};

use std::f64::consts::{FRAC_PI_3, TAU};

use impinge::dim2::query::ConstantVelocities as Turning2;
use impinge::dim3::query::ConstantVelocities as Turning3;
use impinge::math::{Isometry2, Isometry3};
use impinge::query::{ImpactStatus, RigidMotion};
use impinge::shape::{Ball, Cuboid, Cylinder, Shape};

#[test]
fn what_rests_rolls_or_spins_on_a_floor_does_not_hit_it() {
    let (floor, ball) = (half_plane(0.0, 1.0), Ball::new(1.0));
    let still = Turning2::still(at(0.0, 0.0));
    for (speed, turn) in [(0.0, 0.0), (2.0, -2.0), (0.0, 7.0), (5.0, 0.0)] {
        let rolls = Turning2::<f64>::new(at(0.0, 1.0), V2::new(speed, 0.0), turn);
        assert_eq!(both((&rolls, &ball), (&still, &floor), &FOR_EVER), None, "{speed} {turn}");
    }
    let floor = Cuboid::new(V3::new(50.0, 1.0, 50.0));
    let still = Turning3::still(Isometry3::identity());
    let solids: [&dyn Shape<f64, 3>; 2] =
        [&Cuboid::new(V3::new(1.0, 1.0, 2.0)), &Cylinder::new(1.0, 0.5)];
    for solid in solids {
        let spins =
            Turning3::<f64>::new(Isometry3::translation(0.0, 2.0, 0.0), V3::x(), V3::y() * 3.0);
        assert_eq!(both((&spins, solid), (&still, &floor), &until(5.0)), None, "{solid:?}");
        let sinks = Turning3::<f64>::new(
            Isometry3::translation(0.0, 2.0, 0.0),
            V3::new(1.0, -1e-6, 0.0),
            V3::y() * 3.0,
        );
        assert_eq!(toi((&sinks, solid), (&still, &floor), &until(5.0)), 0.0, "{solid:?}");
    }
}

#[test]
fn starts_in_contact_count_by_the_motion_of_the_points() {
    // The end of a segment that is rotated by 60 degrees touches a half-plane.
    let (rod, wall) = (rod(0.0, 2.0), half_plane(-1.0, 0.0));
    let still = Turning2::still(at(1.0, 0.0));
    let swings = |angular| spins(turned(0.0, 0.0, FRAC_PI_3), angular);
    assert_eq!(toi((&swings(-1.0), &rod), (&still, &wall), &FOR_EVER), 0.0, "into the wall");
    // A segment that rotates away from the half-plane reaches it again from below.
    let back = toi((&swings(1.0), &rod), (&still, &wall), &FOR_EVER);
    assert_near(back, 2.0 * TAU / 3.0);
    assert_eq!(both((&swings(1.0), &rod), (&still, &wall), &until(4.0)), None, "not yet");
    // At a right angle to the half-plane the end only slides, and touches again after a full turn.
    let straight = Turning2::still(at(2.0, 0.0));
    let back = toi((&spins(at(0.0, 0.0), 1.0), &rod), (&straight, &wall), &FOR_EVER);
    assert!(back <= TAU + 1e-9 && back > TAU - 1e-6, "{back}");
    // A motion that only gives its bounds has the same result.
    let hit = toi((&Opaque(swings(-1.0)), &rod), (&still, &wall), &FOR_EVER);
    assert_eq!(hit, 0.0, "into the wall");
    assert_eq!(both((&Opaque(swings(1.0)), &rod), (&still, &wall), &until(0.5)), None, "away");
}

#[test]
fn overlapping_starts() {
    let (ball, still) = (Ball::new(1.0), Turning2::still(at(0.0, 0.0)));
    let cast = |v: V2, end| {
        let motion = Turning2::<f64>::new(at(1.5, 0.0), v, 3.0);
        both((&motion, &ball), (&still, &ball), &until(end)).map(|found| found.toi)
    };
    assert_eq!(cast(-V2::x(), 9.0), Some(0.0), "approaching");
    assert_eq!(cast(V2::zeros(), 9.0), Some(0.0), "at rest");
    assert_eq!(cast(V2::y(), 9.0), Some(0.0), "sliding");
    assert_eq!(cast(V2::x(), 9.0), None, "separating");
    for (x, v) in [(1.5, V2::x()), (1.5, V2::zeros()), (2.0, V2::x()), (2.0, V2::y())] {
        let motion = Turning2::<f64>::new(at(x, 0.0), v, 3.0);
        let always = until(9.0).with_contact_at_start(true);
        let hit = both((&motion, &ball), (&still, &ball), &always);
        let status =
            if x == 2.0 { ImpactStatus::TouchingAtStart } else { ImpactStatus::PenetratingAtStart };
        let hit = hit.map(|found| (found.toi, found.status));
        assert_eq!(hit, Some((0.0, status)), "by {v} at {x}, if every contact counts");
    }
    let twins = Turning2::<f64>::new(at(0.0, 0.0), V2::x(), 0.0);
    assert_eq!(both((&twins, &ball), (&still, &ball), &until(9.0)), None, "apart from its twin");
}

#[test]
fn an_overlap_that_ends_and_begins_again_is_an_impact() {
    // The ball circles a point 1.75 beside the other ball, at a distance of 0.375. From 0.47 deep,
    // it is apart between 1.58 and 3.41648.
    let swing = Turning2::<f64>::new(at(1.45, -0.225), V2::zeros(), 1.0)
        .with_local_center([0.3, 0.225].into());
    let (still, ball) = (Turning2::still(at(0.0, 0.0)), Ball::new(1.0));
    let expected = (0.796_875_f64 / 1.3125).acos() + 2.498_091_544_796_509;
    for (motion, end) in [(&swing as &dyn RigidMotion<f64, 2>, 9.0), (&Opaque(swing), 4.0)] {
        let back = toi((motion, &ball), (&still, &ball), &until(end));
        assert!(back <= expected + 1e-9 && back > expected - 1e-6, "{back} before {end}");
    }
    assert_eq!(both((&swing, &ball), (&still, &ball), &until(3.4)), None, "apart until then");
    // Random circles: the distance of the centres is known at all times.
    let mut state = 1_u32;
    let mut random = move || {
        state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        f64::from(state >> 8) / f64::from(1 << 24)
    };
    let mut hits = 0;
    for case in 0..samples(400) {
        let (far, arm, angle) = (1.6 + 0.5 * random(), 0.1 + 0.5 * random(), TAU * random());
        let gap = |time: f64| {
            let (sine, cosine) = ((angle + time).sin(), (angle + time).cos());
            (far + arm * cosine).hypot(arm * sine) - 2.0
        };
        // Distances of centres are least half a turn from the greatest, at the angle 0.
        let turns = TAU - angle;
        if gap(0.0) > -0.1 || gap(turns) < 0.1 {
            continue;
        }
        let (mut early, mut late) = (turns, turns + TAU / 2.0);
        for _ in 0..60 {
            let middle = (early + late) / 2.0;
            if gap(middle) > 0.0 { early = middle } else { late = middle }
        }
        let start = at(far + arm * angle.cos(), arm * angle.sin());
        let center = [-arm * angle.cos(), -arm * angle.sin()].into();
        let circle = Turning2::<f64>::new(start, V2::zeros(), 1.0).with_local_center(center);
        let found = toi((&circle, &ball), (&still, &ball), &until(20.0));
        // Balls that approach at the start hit then.
        let approaches = found == 0.0;
        let is_right = found <= late + 1e-9 && found > late - 1e-6;
        assert!(approaches || is_right, "case {case}: {found} instead of {late}");
        hits += usize::from(!approaches);
    }
    assert!(hits > samples(40), "{hits} of the balls separated first");
}

#[test]
fn a_search_without_end_says_so() {
    // The segment circles the ball without touching it.
    let (rod, ball) = (rod(1.0, 2.0), Ball::new(0.5));
    let (turns, still) = (spins(at(0.0, 0.0), 1.0), Turning2::still(at(0.0, 0.0)));
    assert_eq!(both((&turns, &rod), (&still, &ball), &until(20.0)), None, "three times round");
    let found = both((&turns, &rod), (&still, &ball), &FOR_EVER).expect("it goes on and on");
    assert_eq!(found.status, ImpactStatus::StepsSpent, "not known");
    assert!(found.toi > 100.0, "certainly not before: {}", found.toi);
}

#[test]
fn what_is_not_finite_never_hits() {
    let (ball, still) = (Ball::new(1.0), Turning2::still(at(0.0, 5.0)));
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
        let motions = [
            Turning2::<f64>::new(at(bad, 0.0), V2::y(), 1.0),
            Turning2::<f64>::new(at(0.0, 0.0), V2::new(0.0, bad), 1.0),
            Turning2::<f64>::new(at(0.0, 0.0), V2::y(), bad),
        ];
        for motion in motions {
            assert_eq!(both((&motion, &ball), (&still, &ball), &FOR_EVER), None, "{motion:?}");
        }
        let motion = Turning3::<f64>::new(Isometry3::identity(), V3::y(), V3::new(0.0, bad, 1.0));
        let above = Turning3::still(Isometry3::translation(0.0, 5.0, 0.0));
        assert_eq!(both((&motion, &ball), (&above, &ball), &FOR_EVER), None, "{bad}");
    }
}

/// A motion whose speed bound is NaN, infinite or negative.
struct Unbounded(f64);

impl RigidMotion<f64, 2> for Unbounded {
    fn position_at(&self, time: f64) -> Isometry2<f64> {
        at(0.0, time)
    }

    fn speed_bound(&self, _: f64, _: f64) -> f64 {
        self.0
    }

    fn turn_bound(&self, _: f64, _: f64) -> f64 {
        0.0
    }
}

#[test]
fn bounds_that_are_none_are_never_trusted() {
    let (ball, still) = (Ball::new(1.0), Turning2::still(at(0.0, 5.0)));
    for bad in [f64::NAN, f64::INFINITY, -1.0] {
        let found = both((&Unbounded(bad), &ball), (&still, &ball), &until(9.0));
        let found = found.expect("it may be anywhere at once");
        assert_eq!((found.toi, found.status), (0.0, ImpactStatus::StepsSpent), "{bad}");
    }
}
