//! Tests impacts of rotating bodies: values by hand, brute force, custom motions, composites and
//! tolerances.

use crate::support::query_support;

use std::f64::consts::{FRAC_PI_3, FRAC_PI_4, PI};

use impinge::dim2::query::ConstantVelocities as Turning2;
use impinge::dim3::query::ConstantVelocities as Turning3;
use impinge::math::{Isometry2, Isometry3, Point, Pose, Real, Space, Unit, Vector};
use impinge::query::{
    Impact, ImpactOptions, ImpactStatus, RigidMotion, distance, nonlinear_time_of_impact,
};
use impinge::shape::{
    Ball, Capsule, Compound, Cuboid, FeatureId, Plane, Segment, Shape, ShapeHandle, Triangle,
};
use query_support::corpus::{placed2, regression};

pub(super) type V2 = Vector<f64, 2>;
pub(super) type V3 = Vector<f64, 3>;

pub(super) const FOR_EVER: ImpactOptions<f64> = ImpactOptions::new();

pub(super) fn until(time: f64) -> ImpactOptions<f64> {
    ImpactOptions::new().with_max_time(time)
}

pub(super) fn at(x: f64, y: f64) -> Isometry2<f64> {
    Isometry2::translation(x, y)
}

pub(super) fn turned(x: f64, y: f64, angle: f64) -> Isometry2<f64> {
    Isometry2::from_parts(V2::new(x, y).into(), impinge::math::na::UnitComplex::new(angle))
}

pub(super) fn spins(place: Isometry2<f64>, angular: f64) -> Turning2<f64> {
    Turning2::<f64>::new(place, V2::zeros(), angular)
}

/// Returns the half-plane with the outward normal (x, y), whose boundary contains the origin of its
/// frame.
pub(super) fn half_plane(x: f64, y: f64) -> Plane<f64, 2> {
    Plane::new(Unit::new_unchecked(V2::new(x, y)))
}

pub(super) fn rod(from: f64, to: f64) -> Segment<f64, 2> {
    Segment::new(Point::<f64, 2>::new(from, 0.0), Point::<f64, 2>::new(to, 0.0))
}

/// The motion and the shape of a body.
pub(super) type Body<'a, N, const D: usize> = (&'a dyn RigidMotion<N, D>, &'a dyn Shape<N, D>);

/// Returns the impact, if there is one; asserts that exchanging the bodies flips it.
pub(super) fn both<N: Space<D>, const D: usize>(
    one: Body<'_, N, D>,
    two: Body<'_, N, D>,
    options: &ImpactOptions<N>,
) -> Option<Impact<N, D>> {
    let found = nonlinear_time_of_impact(one.0, one.1, two.0, two.1, options);
    let swapped = nonlinear_time_of_impact(two.0, two.1, one.0, one.1, options);
    assert_eq!(swapped.map(|swapped| swapped.flipped()), found, "swapped");
    found
}

pub(super) fn toi<const D: usize>(
    one: Body<'_, f64, D>,
    two: Body<'_, f64, D>,
    options: &ImpactOptions<f64>,
) -> f64
where
    f64: Space<D>,
{
    let found = both(one, two, options).expect("they meet");
    assert_ne!(found.status, ImpactStatus::StepsSpent, "{found:?}");
    assert!(!found.status.is_at_start() || found.toi == 0.0, "{found:?}");
    found.toi
}

pub(super) fn assert_near(found: f64, expected: f64) {
    assert!((found - expected).abs() < 1e-12, "{found}, not {expected}");
}

#[test]
fn a_rod_swings_against_a_wall() {
    let (rod, wall) = (rod(0.0, 2.0), half_plane(0.0, -1.0));
    let found = both(
        (&spins(at(0.0, 0.0), 1.0), &rod),
        (&Turning2::still(at(7.0, 2.0_f64.sqrt())), &wall),
        &FOR_EVER,
    )
    .expect("its end rises to two");
    assert_near(found.toi, FRAC_PI_4);
    let touch = Point::<f64, 2>::new(2.0_f64.sqrt(), 2.0_f64.sqrt());
    assert!((found.world1 - touch).norm() < 1e-12, "{found:?}");
    assert!((found.normal.into_inner() - V2::y()).norm() < 1e-12, "{found:?}");
    assert_eq!((found.feature1, found.feature2), (FeatureId::Vertex(1), FeatureId::Face(0)));
    // The rotation in the other direction takes half a turn more.
    let found = toi(
        (&spins(at(0.0, 0.0), -1.0), &rod),
        (&Turning2::still(at(7.0, 2.0_f64.sqrt())), &wall),
        &FOR_EVER,
    );
    assert_near(found, PI + FRAC_PI_4);
}

#[test]
fn the_centre_of_a_turn_may_be_anywhere() {
    // One segment in two frames: with its midpoint at the origin, and far away from the origin.
    let wall = half_plane(0.0, -1.0);
    let wall = (&Turning2::still(at(7.0, 2.0_f64.sqrt())) as &dyn RigidMotion<f64, 2>, &wall as _);
    for shift in [1.0, -40.0] {
        let rod = rod(-shift, 2.0 - shift);
        let motion =
            spins(at(shift, 0.0), 1.0).with_local_center(Point::<f64, 2>::new(-shift, 0.0));
        assert_near(toi((&motion, &rod), wall, &FOR_EVER), FRAC_PI_4);
    }
}

#[test]
fn a_half_plane_turns_against_a_ball() {
    let (plane, ball) = (half_plane(0.0, 1.0), Ball::new(0.5));
    let still = Turning2::still(at(3.0, 2.0));
    let found = toi((&spins(at(0.0, 0.0), 1.0), &plane), (&still, &ball), &FOR_EVER);
    // The height of the ball's centre above the plane is 2 cos t - 3 sin t.
    assert_near(found, (0.5 / 13.0_f64.sqrt()).acos() - 1.5_f64.atan());
    // In the frame of the plane, the ball moves on a circle and rotates in the other direction.
    let motion = spins(at(3.0, 2.0), -1.0).with_local_center(Point::<f64, 2>::new(-3.0, -2.0));
    let round = toi((&Turning2::still(at(0.0, 0.0)), &plane), (&motion, &ball), &FOR_EVER);
    assert_near(round, found);
}

#[test]
fn a_half_plane_turns_and_a_box_flies() {
    let (plane, cuboid) = (half_plane(0.0, 1.0), Cuboid::new(V2::new(0.5, 0.25)));
    let (turns, flies) =
        (spins(at(0.0, 0.0), 0.25), Turning2::<f64>::new(at(40.0, 30.0), V2::new(-2.0, -1.0), 3.0));
    let found = toi((&turns, &plane), (&flies, &cuboid), &FOR_EVER);
    assert_near(found, first_touch((&turns, &plane), (&flies, &cuboid), 10.0));
}

/// Returns the first time of contact: a dense scan finds an interval, and bisection refines it.
fn first_touch(one: Body<'_, f64, 2>, two: Body<'_, f64, 2>, end: f64) -> f64 {
    let touch = |time: f64| {
        distance(&one.0.position_at(time), one.1, &two.0.position_at(time), two.1) <= 0.0
    };
    let looks = 100_000;
    let time = |look: i32| end * f64::from(look) / f64::from(looks);
    let first = (0..=looks).find(|&look| touch(time(look))).expect("they touch");
    let (mut before, mut after) = (time(first - 1), time(first));
    for _ in 0..60 {
        let middle = 0.5 * (before + after);
        if touch(middle) { after = middle } else { before = middle }
    }
    after
}

#[test]
fn a_rod_that_whirls_a_thousand_times_on_its_way() {
    // The segment has no thickness, and rotates by 0.1 radians while it moves by 0.0001.
    let (rod, ball) = (rod(-1.0, 1.0), Ball::new(0.01));
    let whirls = Turning2::<f64>::new(turned(3.0, 0.3, 0.7), V2::new(-1.0, 0.0), 1000.0);
    let still = Turning2::still(at(0.0, 0.0));
    let found = both((&whirls, &rod), (&still, &ball), &FOR_EVER).expect("it sweeps over it");
    assert_eq!(found.status, ImpactStatus::Reached, "{found:?}");
    let expected = first_touch((&whirls, &rod), (&still, &ball), 2.1);
    assert!((found.toi - expected).abs() < 1e-9, "{found:?}, not {expected}");
}

#[test]
fn in_space() {
    // An arm along x swings about y, towards -z, and hits a ball at 60 degrees.
    let (arm, ball) = (
        Capsule::<f64, 3>::try_from_ends(
            Point::origin(),
            Point::<f64, 3>::new(3.0, 0.0, 0.0),
            0.25,
        )
        .expect("finite"),
        Ball::new(0.5),
    );
    let swings = Turning3::<f64>::new(Isometry3::identity(), V3::zeros(), V3::y() * 0.5);
    let place = Isometry3::translation(2.0 * FRAC_PI_3.cos(), 0.0, -2.0 * FRAC_PI_3.sin());
    let found = toi((&swings, &arm), (&Turning3::still(place), &ball), &FOR_EVER);
    assert_near(found, 2.0 * (FRAC_PI_3 - (0.75_f64 / 2.0).asin()));
    // A half-space rotates about z towards a box and first hits its lower right edge.
    let plane = Plane::new(Unit::new_unchecked(V3::y()));
    let cuboid = Cuboid::new(V3::new(1.0, 1.0, 1.0));
    let turns = Turning3::<f64>::new(Isometry3::identity(), V3::zeros(), V3::z());
    let still = Turning3::still(Isometry3::translation(2.0, 4.0, 0.0));
    assert_near(toi((&turns, &plane), (&still, &cuboid), &FOR_EVER), FRAC_PI_4);
    // Spinning about its own normal and sliding within its surface change nothing.
    let spins = Turning3::<f64>::new(Isometry3::identity(), V3::new(3.0, 0.0, 0.0), V3::y() * 9.0);
    assert_eq!(both((&spins, &plane), (&still, &cuboid), &FOR_EVER), None);
}

/// A body that falls without rotation; its speed has no bound over an infinite time.
struct Falls {
    height: f64,
    gravity: f64,
}

impl RigidMotion<f64, 2> for Falls {
    fn position_at(&self, time: f64) -> Isometry2<f64> {
        at(0.0, self.height - 0.5 * self.gravity * time * time)
    }

    fn speed_bound(&self, _: f64, to: f64) -> f64 {
        self.gravity * to
    }

    fn turn_bound(&self, _: f64, _: f64) -> f64 {
        0.0
    }
}

#[test]
fn a_fall_gets_faster() {
    let (floor, ball) = (half_plane(0.0, 1.0), Ball::new(1.0));
    let still = Turning2::still(at(0.0, 0.0));
    for (height, gravity) in [(10.0, 9.81), (1e9, 1e-9), (1.001, 1e6)] {
        let falls = Falls { height, gravity };
        let expected = (2.0 * (height - 1.0) / gravity).sqrt();
        for options in [FOR_EVER, until(expected * 1e6), until(expected * 1.001)] {
            let found = toi((&falls, &ball), (&still, &floor), &options);
            assert!((found / expected - 1.0).abs() < 1e-11, "{found}, not {expected}");
        }
        assert_eq!(both((&falls, &ball), (&still, &floor), &until(expected * 0.999)), None);
    }
}

/// Any motion reduced to the required methods of the trait.
pub(super) struct Opaque<M>(pub(super) M);

impl<M: RigidMotion<f64, 2>> RigidMotion<f64, 2> for Opaque<M> {
    fn position_at(&self, time: f64) -> Isometry2<f64> {
        self.0.position_at(time)
    }

    fn speed_bound(&self, from: f64, to: f64) -> f64 {
        self.0.speed_bound(from, to)
    }

    fn turn_bound(&self, from: f64, to: f64) -> f64 {
        self.0.turn_bound(from, to)
    }

    fn local_center(&self) -> Point<f64, 2> {
        self.0.local_center()
    }
}

#[test]
fn bounds_alone_give_the_same_times() {
    let (rod, capsule) = (rod(-2.0, 2.0), Capsule::<f64, 2>::new(1.0, 0.25));
    let floor = half_plane(0.6, 0.8);
    let mut hits = 0;
    for turn in [-3.0, -0.5, 0.25, 1.5] {
        let flies = Turning2::<f64>::new(turned(4.0, 4.0, 1.0), V2::new(-1.0, -0.75), turn);
        let turns =
            Turning2::<f64>::new(turned(-3.0, 1.0, 0.5), V2::new(0.125, 0.0), -turn * 0.125)
                .with_local_center(Point::<f64, 2>::new(0.5, 0.5));
        let others: [&dyn Shape<f64, 2>; 2] = [&capsule, &floor];
        for other in others {
            let known = both((&flies, &rod), (&turns, other), &until(20.0));
            let told = both((&Opaque(flies), &rod), (&Opaque(turns), other), &until(20.0));
            let half = both((&Opaque(flies), &rod), (&turns, other), &until(20.0));
            for found in [told, half] {
                assert_eq!(found.is_some(), known.is_some(), "{found:?} {known:?}");
                let (Some(found), Some(known)) = (found, known) else { continue };
                assert_eq!(found.status, ImpactStatus::Reached, "{found:?}");
                assert!((found.toi - known.toi).abs() < 1e-10, "{found:?} {known:?}");
                hits += 1;
            }
        }
    }
    assert!(hits >= 8, "{hits}");
}

#[test]
fn the_target_distance_is_where_it_ends() {
    let (ball, still) = (Ball::new(1.0), Turning2::still(at(0.0, 5.0)));
    let motion = Turning2::<f64>::new(at(0.0, 0.0), V2::y(), 40.0);
    let options = FOR_EVER.with_target_distance(0.5);
    let found = both((&motion, &ball), (&still, &ball), &options).expect("straight on");
    assert_near(found.toi, 2.5);
    assert!((found.world2.y - found.world1.y - 0.5).abs() < 1e-12, "{found:?}");
    assert_eq!(both((&motion, &ball), (&still, &ball), &options.with_max_time(2.4)), None);
    assert_eq!(both((&motion, &ball), (&still, &ball), &until(f64::NAN)), None, "no time");
    assert_eq!(both((&motion, &ball), (&still, &ball), &until(-1.0)), None, "no time");
}

/// one radian per `time` about one end, reaches a half-plane at the distance `size`.
/// Returns the time, in units of `time`, at which a segment of length `2 * size`, which rotates by
fn scaled<N: Space<2, Isometry = Isometry2<N>>>(size: N, time: N, offset: N) -> N {
    let rod = Segment::new(Point::<N, 2>::origin(), Point::<N, 2>::new(N::TWO * size, N::ZERO));
    let wall = Plane::new(Unit::new_unchecked(-Vector::<N, 2>::y()));
    let place = |y: N| Isometry2::translation(offset, offset + y * size);
    let still = impinge::query::ConstantVelocities::<N, 2>::still(place(N::ONE));
    let zero = Vector::<N, 2>::zeros();
    let swings =
        impinge::query::ConstantVelocities::<N, 2>::new(place(N::ZERO), zero, N::ONE / time);
    let found = both((&swings, &rod), (&still, &wall), &ImpactOptions::new()).expect("it swings");
    assert_eq!(found.status, ImpactStatus::Reached, "{found:?}");
    found.toi / time
}

#[test]
fn sizes_and_times_of_every_order() {
    for size in [1e-100, 1e-6, 1.0, 1e6, 1e100] {
        for time in [1e-150, 1e-9, 1.0, 1e9, 1e150] {
            assert_near(scaled::<f64>(size, time, 0.0), std::f64::consts::FRAC_PI_6);
        }
    }
    for size in [1e-15, 1e-3, 1.0, 1e15] {
        for time in [1e-20, 1.0, 1e20] {
            let found = scaled::<f32>(size, time, 0.0).as_f64();
            assert!((found - std::f64::consts::FRAC_PI_6).abs() < 1e-5, "{found} {size} {time}");
        }
    }
    let far = scaled::<f32>(1.0, 1.0, 1_048_576.0);
    assert_eq!(far, scaled::<f32>(1.0, 1.0, 0.0), "far from the origin it is the same");
}

/// Tests the case of box2d#115, where a sweep that only comes near another body was reported as a
/// hit.
#[test]
fn box2d_115_sweep() {
    let corpus = regression();
    let case = corpus.iter().find(|case| case["query"] == "nonlinear_cast").expect("there");
    let one = placed2::<f64>(&case["shape1"], &case["pose1"]).expect("a box");
    let two = placed2::<f64>(&case["shape2"], &case["pose2"]).expect("a box");
    let end = placed2::<f64>(&case["shape2"], &case["params"]["end_pose2"]).expect("a box");
    let way = end.pose.translation.vector - two.pose.translation.vector;
    let turn = two.pose.rotation.angle_to(&end.pose.rotation);
    let still = Turning2::still(one.pose);
    let (shape1, shape2) = (&*one.shape, &*two.shape);
    // The second start is the same pose, given by an angle of many turns.
    for start in [two.pose, turned(two.pose.translation.x, two.pose.translation.y, 513.366_76)] {
        let sweep = Turning2::<f64>::new(start, way, turn);
        assert_eq!(both((&still, shape1), (&sweep, shape2), &until(1.0)), None, "it only nears");
    }
    // The case gives the least distance. With a slightly larger target distance there is an impact,
    // at the end.
    let least = case["expected"]["min_signed_distance"].as_f64().expect("a number");
    let sweep = Turning2::<f64>::new(two.pose, way, turn);
    let near = |distance| {
        let options = until(1.0).with_target_distance(distance);
        both((&still, shape1), (&sweep, shape2), &options).map(|found| found.toi)
    };
    assert_eq!(near(least - 1e-6), None, "not so near");
    assert!(near(least + 1e-6).expect("so near") > 0.999, "at the end");
}

/// Asserts that the impact of a composite is the earliest impact of its parts, and that the result
/// reports the index of that part.
#[test]
fn composites() {
    let parts = [
        (at(-2.0, 0.25), ShapeHandle::new(Ball::new(0.5))),
        (at(1.0, 0.0), ShapeHandle::new(Cuboid::new(V2::new(1.5, 0.25)))),
        (turned(0.0, 1.0, 0.5), ShapeHandle::new(Capsule::<f64, 2>::new(0.75, 0.125))),
    ];
    let compound = Compound::new(parts.to_vec());
    let (floor, post) = (half_plane(0.0, 1.0), Ball::new(0.25));
    let (still, pivots) = (Turning2::still(at(0.0, 0.0)), spins(at(0.0, 0.0), -0.0625));
    let others: [(&dyn RigidMotion<f64, 2>, &dyn Shape<f64, 2>); 3] =
        [(&still, &floor), (&still, &post), (&pivots, &floor)];
    let mut named = [false; 3];
    for (turn, other) in [-2.0, -0.75, 0.5, 1.5].iter().flat_map(|t| others.map(|o| (*t, o))) {
        let start = turned(-4.0, 5.0, turn);
        let motion = Turning2::<f64>::new(start, V2::new(1.0, -1.25), turn);
        let found = both((&motion, &compound), other, &until(20.0)).expect("it falls on it");
        assert_eq!(found.status, ImpactStatus::Reached, "{found:?}");
        let of_part = |(place, shape): &(Isometry2<f64>, ShapeHandle<f64, 2>)| {
            // The part alone, rotating about the origin of the compound.
            let center = place.inverse_transform_point(&Point::origin());
            let motion = Turning2::<f64>::new(start * place, V2::new(1.0, -1.25), turn)
                .with_local_center(center);
            both((&motion, &**shape), other, &until(20.0)).map_or(f64::INFINITY, |hit| hit.toi)
        };
        let times = [0, 1, 2].map(|index| of_part(&parts[index]));
        let part = usize::try_from(found.part1).expect("small");
        assert_near(found.toi, times[part]);
        assert!(times.iter().all(|&time| time > found.toi - 1e-12), "{times:?} {found:?}");
        named[part] = true;
    }
    assert!(named.iter().filter(|&&named| named).count() > 1, "{named:?}");
}

/// Asserts the impacts of a composite of half-planes, which is unbounded, as it rotates and as it
/// moves.
#[test]
fn unbounded_composites() {
    let half = |x, y| ShapeHandle::new(half_plane(x, y));
    let wedge =
        Compound::new(vec![(at(0.0, 0.0), half(0.0, 1.0)), (at(9.0, 0.0), half(-1.0, 0.0))]);
    let (ball, still) = (Ball::new(0.5), Turning2::still(at(3.0, 2.0)));
    let found = toi((&spins(at(0.0, 0.0), 1.0), &wedge), (&still, &ball), &FOR_EVER);
    assert_near(found, (0.5 / 13.0_f64.sqrt()).acos() - 1.5_f64.atan());
    let moves = Turning2::<f64>::new(at(0.0, 0.0), V2::new(-1.0, 0.0), 0.0);
    let found = both((&moves, &wedge), (&still, &ball), &FOR_EVER).expect("the wall comes");
    assert_eq!((found.toi, found.part1), (5.5, 1));
}

/// Asserts that the default `pose_about` returns the pose of `position_at` relative to its first
/// argument.
#[test]
fn poses_follow_positions() {
    let falls = Falls { height: 10.0, gravity: 2.0 };
    let pose = falls.pose_about(&V2::new(1.0, 4.0), 2.0);
    assert_eq!(pose, Pose::from_translation(V2::new(-1.0, 2.0)), "10 - 4 - 4 high");
}

#[test]
fn within_the_tolerance_bodies_count_as_touching() {
    let (rod, floor, ball) = (rod(0.0, 2.0), half_plane(0.0, 1.0), Ball::new(1.0));
    let wall = half_plane(0.0, -1.0);
    let still = Turning2::still(at(7.0, 2.0_f64.sqrt()));
    let swings = |tolerance: Option<f64>| {
        let options = tolerance.map_or(FOR_EVER, |length| FOR_EVER.with_tolerance(length));
        toi((&spins(at(0.0, 0.0), 1.0), &rod), (&still, &wall), &options)
    };
    let exact = swings(None);
    for none in [0.0, -1.0, f64::NAN, 1e-20] {
        assert_eq!(swings(Some(none)), exact, "{none} counts as rounding");
    }
    for tolerance in [0.125, 1e-3] {
        let early = swings(Some(tolerance));
        let gap = 2.0_f64.sqrt() - 2.0 * early.sin();
        assert!(early < exact && gap > 0.0 && gap <= tolerance, "{early}, {gap} of {tolerance}");
    }
    // The start is within the tolerance, so the solids touch.
    let still = Turning2::still(at(0.0, 0.0));
    let options = FOR_EVER.with_tolerance(0.125);
    let cast = |v: V2| {
        let motion = Turning2::<f64>::new(at(0.0, 1.0625), v, 3.0);
        both((&motion, &ball), (&still, &floor), &options).map(|found| found.toi)
    };
    assert_eq!(cast(-V2::y()), Some(0.0), "approaching");
    assert_eq!(cast(V2::x()), None, "sliding");
    assert_eq!(cast(V2::y()), None, "separating");
}

/// Asserts that the end of a segment that passes a half-plane at a tiny distance counts as
/// touching, with the default tolerance of about a millionth of the size. Only bounds of the speed
/// are known.
#[test]
fn what_grazes_within_a_millionth_touches() {
    let (rod, wall) = (rod(0.0, 2.0), half_plane(0.0, -1.0));
    for gap in [1e-7, 1e-9, 1e-12] {
        let still = Turning2::still(at(7.0, 2.0 + gap));
        let found = toi((&Opaque(spins(at(0.0, 0.0), 1.0)), &rod), (&still, &wall), &FOR_EVER);
        let left = 2.0 + gap - 2.0 * found.sin();
        assert!(left > 0.0 && left < 16.0 / 1_048_576.0, "{left} at {found}, of {gap}");
    }
}

/// Asserts that exchanging two equal bodies at one pose with different motions flips the result:
/// for maximum times so short that the motions are equal up to rounding, and for a longer one.
#[test]
fn equal_bodies_that_part_after_the_longest_time_have_one_order() {
    let triangle = Triangle::new(
        Point::<f64, 2>::new(0.0, 0.0),
        Point::<f64, 2>::new(1.0, 0.0),
        Point::<f64, 2>::new(0.25, 0.75),
    );
    let cube = Cuboid::new(V3::new(0.5, 0.25, 0.125));
    for time in [0.0, 1e-300, 1.0] {
        let motions =
            [1.0, -1.0].map(|turn| Turning2::<f64>::new(at(3.0, 4.0), V2::new(turn, 2.0), turn));
        both((&motions[0], &triangle), (&motions[1], &triangle), &until(time));

        let motions = [1.0, -1.0].map(|turn| {
            let place = Isometry3::translation(3.0, 4.0, 5.0);
            Turning3::<f64>::new(place, V3::new(turn, 2.0, 0.0), V3::new(0.0, 0.0, turn))
        });
        both((&motions[0], &cube), (&motions[1], &cube), &until(time));
    }
}
