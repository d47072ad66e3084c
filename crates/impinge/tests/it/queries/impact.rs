//! Tests impacts of solids without rotation: values by hand, the policy for starts in contact, and
//! bad input.

use crate::support::query_support;

use impinge::math::{AbstractRotation, Isometry, Isometry2, Isometry3, Point, Space, Unit, Vector};
use impinge::query::{
    Impact, ImpactOptions, ImpactStatus, Moving, contact, impact, time_of_impact,
};
use impinge::shape::{
    Ball, Capsule, Cuboid, Cylinder, FeatureId, Plane, Segment, Shape, ShapeKind,
};
use query_support::random::Random;
use query_support::samples::{PLANE, SPACE, Sample, sample2, sample3};

type V2 = Vector<f64, 2>;
type V3 = Vector<f64, 3>;

fn at(x: f64, y: f64) -> Isometry2<f64> {
    Isometry2::translation(x, y)
}

fn floor() -> Plane<f64, 2> {
    Plane::new(Unit::new_unchecked(V2::y()))
}

/// Returns the impact of a moving shape with a shape that rests at the origin, if there is one.
fn onto(
    still: &dyn Shape<f64, 2>,
    place: Isometry2<f64>,
    v: V2,
    shape: &dyn Shape<f64, 2>,
) -> Option<Impact<f64, 2>> {
    onto_with(still, (place, v, shape), &ImpactOptions::new())
}

fn onto_with(
    still: &dyn Shape<f64, 2>,
    (place, v, shape): (Isometry2<f64>, V2, &dyn Shape<f64, 2>),
    options: &ImpactOptions<f64>,
) -> Option<Impact<f64, 2>> {
    let (still, moving) = (Moving::still(&at(0.0, 0.0), still), Moving::new(&place, &v, shape));
    impact(&still, &moving, options)
}

#[test]
fn an_impact_names_points_and_normal_in_the_world() {
    // The box is rotated by a quarter turn and moves too, so that the world frame is neither local
    // frame.
    let (cuboid, ball) = (Cuboid::new(V2::new(0.5, 2.0)), Ball::new(1.0));
    let quarter = Isometry2::new(V2::new(-1.0, 10.0), std::f64::consts::FRAC_PI_2);
    let cuboid = Moving::new(&quarter, &V2::new(1.0, -2.0), &cuboid);
    let ball = Moving::new(&at(-1.0, 20.5), &V2::new(1.0, -5.0), &ball);
    // Initially 20.5 - 1 - 10.5 = 9 apart, approaching with the speed 3.
    let found = impact(&cuboid, &ball, &ImpactOptions::new()).expect("from above");
    assert!((found.toi - 3.0).abs() < 1e-14, "{found:?}");
    let touch = V2::new(2.0, 4.5);
    assert!((found.world1.coords - touch).norm() < 1e-13, "{found:?}");
    assert!((found.world2.coords - touch).norm() < 1e-13, "{found:?}");
    assert!((found.normal.into_inner() - V2::y()).norm() < 1e-14, "{found:?}");
    assert_eq!((found.part1, found.part2, found.status), (0, 0, ImpactStatus::Reached));
    let swapped = impact(&ball, &cuboid, &ImpactOptions::new()).expect("the same");
    assert_eq!(swapped.flipped(), found, "the order does not matter");
}

#[test]
fn the_target_distance_is_where_it_ends() {
    let (ball, options) = (Ball::new(1.0), ImpactOptions::new().with_target_distance(0.5));
    let hit = onto_with(&ball, (at(0.0, 6.0), -V2::y(), &ball), &options).expect("straight on");
    assert_eq!(hit.toi, 3.5, "half a unit before they touch");
    assert_eq!((hit.world1.y, hit.world2.y), (1.0, 1.5), "where they are half a unit apart");
    // They pass at a distance of 0.25: the centres are 2.25 apart there, and 2.5 apart at the
    // target distance.
    let pass = (at(-10.0, 2.25), V2::x(), &ball as &dyn Shape<f64, 2>);
    assert_eq!(onto_with(&ball, pass, &ImpactOptions::new()), None, "past it");
    let near = onto_with(&ball, pass, &options).expect("within half a unit");
    assert!((near.toi - (10.0 - (2.5_f64 * 2.5 - 2.25 * 2.25).sqrt())).abs() < 1e-13, "{near:?}");
    for none in [-1.0, f64::NAN, 0.0] {
        let options = ImpactOptions::new().with_target_distance(none);
        let hit = onto_with(&ball, (at(0.0, 6.0), -V2::y(), &ball), &options);
        assert_eq!(hit.expect("straight on").toi, 4.0, "{none} counts as zero");
    }
    let all = ImpactOptions::new().with_target_distance(f64::INFINITY);
    assert_eq!(onto_with(&ball, (at(0.0, 6.0), V2::y(), &ball), &all).expect("near").toi, 0.0);
}

#[test]
fn the_longest_time_is_included() {
    let ball = Ball::new(1.0);
    let cast = |time| {
        let options = ImpactOptions::new().with_max_time(time);
        onto_with(&ball, (at(0.0, 6.0), -V2::y(), &ball), &options).map(|found| found.toi)
    };
    assert_eq!(cast(4.0), Some(4.0), "at the last moment");
    assert_eq!(cast(3.9999), None, "too late");
    assert_eq!((cast(0.0), cast(-1.0), cast(f64::NAN)), (None, None, None), "no time at all");
    let touching = |time| {
        let options = ImpactOptions::new().with_max_time(time);
        onto_with(&ball, (at(0.0, 2.0), -V2::y(), &ball), &options).map(|found| found.toi)
    };
    assert_eq!((touching(0.0), touching(-1.0)), (Some(0.0), None), "the start is a moment");
}

/// Asserts that a maximum time that is negative or NaN gives no impact, whatever the start and the
/// speed.
#[test]
fn there_is_no_time_before_the_start() {
    let ball = Ball::new(1.0_f64);
    for (x, speed) in [0.0, 1.5, 2.0, 3.0].into_iter().flat_map(|x| {
        let speeds = [0.0, f64::MIN_POSITIVE, 1e-300, 1.0, 1e300];
        speeds.map(|speed| (x, speed))
    }) {
        for time in [-f64::MIN_POSITIVE, -1e-300, -1.0, f64::NAN] {
            let options = ImpactOptions::new().with_max_time(time);
            let moving = (at(x, 0.0), V2::new(-speed, 0.0), &ball as &dyn Shape<f64, 2>);
            assert_eq!(onto_with(&ball, moving, &options), None, "{x} {speed} until {time}");
        }
    }
}

#[test]
fn starts_in_contact_count_by_their_velocities() {
    let (floor, half) = (floor(), ImpactOptions::new().with_target_distance(0.5));
    let none = ImpactOptions::new();
    let (square, ball, capsule) =
        (Cuboid::new(V2::new(1.0, 1.0)), Ball::new(1.0), Capsule::<f64, 2>::new(0.5, 0.5));
    let wide = Cuboid::new(V2::new(9.0, 1.0));
    // The table of the documentation: rows are starts in contact, columns are motions. Each start
    // has the resting shape, the height of the mover, the options, and whether the mover is deeper
    // than the target distance.
    let (low, wide): (&dyn Shape<f64, 2>, &dyn Shape<f64, 2>) = (&floor, &wide);
    let starts = [
        (low, 1.0, &none, false),
        (low, 0.75, &none, true),
        (low, 1.5, &half, false),
        (low, 1.25, &half, true),
        (low, 1.0, &half, true),
        (wide, 2.0, &none, false),
        (wide, 1.75, &none, true),
        (wide, 2.5, &half, false),
        (wide, 2.25, &half, true),
    ];
    let movers: [&dyn Shape<f64, 2>; 3] = [&square, &ball, &capsule];
    for ((still, height, options, deep), shape) in
        starts.into_iter().flat_map(|start| movers.map(|shape| (start, shape)))
    {
        let cast = |v: V2| onto_with(still, (at(3.0, height), v, shape), options).map(|i| i.toi);
        let what = format!("{shape:?} at {height} with {options:?}");
        assert_eq!(cast(-V2::y()), Some(0.0), "approaching {what}");
        assert_eq!(cast(V2::new(5.0, -1e-3)), Some(0.0), "sliding down {what}");
        assert_eq!(cast(V2::y()), None, "separating {what}");
        assert_eq!(cast(V2::new(5.0, 1e-3)), None, "sliding up {what}");
        let resting = deep.then_some(0.0);
        assert_eq!(cast(V2::x()), resting, "sliding {what}");
        assert_eq!(cast(V2::zeros()), resting, "at rest {what}");
        let always = options.with_contact_at_start(true);
        for v in [-V2::y(), V2::y(), V2::new(5.0, 1e-3), V2::x(), V2::zeros()] {
            let hit = onto_with(still, (at(3.0, height), v, shape), &always);
            let hit = hit.map(|hit| (hit.toi, hit.status));
            let status =
                if deep { ImpactStatus::PenetratingAtStart } else { ImpactStatus::TouchingAtStart };
            assert_eq!(hit, Some((0.0, status)), "{v} {what}, if every contact counts");
            let above = (at(3.0, height + 1e-3), V2::y(), shape);
            assert!(deep || onto_with(still, above, &always).is_none(), "none {what}");
        }
    }
}

#[test]
fn coincident_twins_only_move_apart() {
    let ball = Ball::new(1.0);
    assert_eq!(onto(&ball, at(0.0, 0.0), V2::x(), &ball), None, "to one side");
    assert_eq!(onto(&ball, at(0.0, 0.0), -V2::x(), &ball), None, "to the other");
    let rest = onto(&ball, at(0.0, 0.0), V2::zeros(), &ball).expect("they overlap");
    assert_eq!(rest.toi, 0.0, "and stay");
}

#[test]
fn half_spaces() {
    let (up, down) = (floor(), Plane::new(Unit::new_unchecked(-V2::y())));
    let fall = onto(&up, at(3.0, 6.0), V2::new(7.0, -2.0), &down).expect("the sky falls");
    assert_eq!((fall.toi, fall.normal.y), (3.0, 1.0), "six down");
    assert_eq!(onto(&up, at(3.0, 6.0), V2::x(), &down), None, "it passes by");
    let aside = Plane::new(Unit::new_unchecked(V2::x()));
    let without_bound = onto(&up, at(3.0, 6.0), V2::y(), &aside).expect("they overlap");
    assert_eq!(without_bound.toi, 0.0, "and always will");
    assert_eq!(without_bound.status, ImpactStatus::PenetratingAtStart, "without bound");
}

#[test]
fn what_is_not_finite_never_hits() {
    let ball = Ball::new(1.0);
    for bad in [f64::NAN, f64::INFINITY, -f64::INFINITY] {
        assert_eq!(onto(&ball, at(0.0, 6.0), V2::new(0.0, bad), &ball), None, "velocity {bad}");
        assert_eq!(onto(&ball, at(0.0, bad), -V2::y(), &ball), None, "place {bad}");
    }
    let (one, other) = (V2::new(0.0, f64::MAX), V2::new(0.0, -f64::MAX));
    let moving1 = Moving::new(&at(0.0, 0.0), &one, &ball);
    let moving2 = Moving::new(&at(0.0, 6.0), &other, &ball);
    assert_eq!(impact(&moving1, &moving2, &ImpactOptions::new()), None, "no difference");
}

/// Asserts that the impact is at the right time for speeds near the smallest and near the largest
/// number. At the smallest number of all, the time would overflow, so there is no impact.
#[test]
fn speeds_of_every_size() {
    let ball = Ball::new(1.0);
    for speed in [f64::MIN_POSITIVE * 4.0, 1e-300, 1e-9, 1.0, 1e9, 1e300, f64::MAX / 4.0] {
        let hit = onto(&ball, at(0.0, 6.0), V2::new(0.0, -speed), &ball).expect("straight on");
        assert!((hit.toi * speed - 4.0).abs() < 1e-14, "{hit:?} at {speed}");
        let bound = ImpactOptions::new().with_max_time(3.9 / speed);
        assert_eq!(onto_with(&ball, (at(0.0, 6.0), V2::new(0.0, -speed), &ball), &bound), None);
    }
    let least = f64::from_bits(1);
    assert_eq!(onto(&ball, at(0.0, 6.0), V2::new(0.0, -least), &ball), None, "after all times");
    assert_eq!(onto(&ball, at(0.0, 6.0), V2::new(least, 0.0), &ball), None, "sideways");
}

/// Asserts that neither a fast common motion nor a position far from the origin changes the time of
/// impact.
#[test]
fn only_differences_count() {
    let (cuboid, cylinder) =
        (Cuboid::new(Vector::<f32, 3>::new(1.0, 0.5, 2.0)), Cylinder::new(0.75_f32, 0.25));
    let cast = |offset: f32, common: f32| {
        let shift = Vector::<f32, 3>::repeat(offset);
        let place = |x: f32, y: f32| Isometry3::translation(x + shift.x, y + shift.y, shift.z);
        let speed = Vector::<f32, 3>::new(common, 0.0, 0.0);
        let fall = speed + Vector::<f32, 3>::new(0.0, -1.0, 0.0);
        time_of_impact(&place(0.0, 0.0), &speed, &cuboid, &place(0.5, 8.0), &fall, &cylinder)
    };
    assert_eq!(cast(0.0, 0.0), Some(6.75), "8 - 0.75 - 0.5");
    assert_eq!(cast(1_048_576.0, 0.0), Some(6.75), "far away");
    assert_eq!(cast(0.0, 1e6), Some(6.75), "both fast");
}

/// Asserts that a solid that narrowly passes has no impact, and that one that narrowly hits has its
/// impact at the right time.
#[test]
fn grazing_passes() {
    let (ball, square) = (Ball::new(1.0), Cuboid::new(V2::new(1.0, 1.0)));
    for miss in [1e-3, 1e-6, 1e-9, 1e-12] {
        let over = onto(&ball, at(-9.0, 2.0 + miss), V2::x(), &square);
        assert_eq!(over, None, "over it by {miss}");
        let into = onto(&ball, at(-9.0, 2.0 - miss), V2::x(), &square).expect("into it");
        // The lower leading corner hits the ball at the height 1 - miss. The distance decreases
        // slowly there, so its rounding error moves the time by a multiple.
        let slope = (1.0 - (1.0 - miss) * (1.0 - miss)).sqrt();
        let (toi, late) = (8.0 - slope, 1e-15 / slope);
        assert!(into.toi < toi + late && into.toi > toi - late * 64.0, "{into:?}, not {toi}");
    }
}

/// Tests all pairs of kinds that overlap at the start. A motion of the second solid along the
/// normal separates them, so there is no impact; a motion against the normal, or none, is an impact
/// at time 0 with the data of the contact. With `contact_at_start` all three are.
fn overlapping_starts<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    kinds: &[ShapeKind],
    sample: Sample<N, D>,
    turn: fn(&mut Random) -> R,
) {
    let mut tried = 0;
    for (kind1, kind2) in kinds.iter().flat_map(|k1| kinds.iter().map(move |k2| (*k1, *k2))) {
        for seed in 0..3 {
            let random = &mut Random(seed, false);
            let (shape1, shape2) = (sample(kind1, random, N::ONE), sample(kind2, random, N::ONE));
            let (here, there) = (random.vector::<N, D>(), random.vector::<N, D>() * N::lit(0.25));
            let m1 = Isometry::from_parts(here.into(), turn(random));
            let m2 = Isometry::from_parts((here + there).into(), turn(random));
            let Some(found) = contact(&m1, &*shape1, &m2, &*shape2, N::ZERO) else { continue };
            if found.depth < N::lit(1e-2) {
                continue;
            }
            tried += 1;
            let cast = |v: Vector<N, D>| {
                let (one, two) = (Moving::still(&m1, &*shape1), Moving::new(&m2, &v, &*shape2));
                impact(&one, &two, &ImpactOptions::new())
            };
            let normal = found.normal.into_inner();
            let hit = cast(-normal).expect("approaching");
            assert_eq!(hit.toi, N::ZERO, "{kind1:?} {kind2:?}");
            assert_eq!((hit.world1, hit.world2), (found.world1, found.world2), "the contact's");
            assert_eq!(hit.normal, found.normal, "{kind1:?} {kind2:?}");
            assert_eq!(hit.status, ImpactStatus::PenetratingAtStart, "{kind1:?} {kind2:?}");
            assert_eq!(cast(normal), None, "separating {kind1:?} {kind2:?}");
            assert_eq!(cast(Vector::<N, D>::zeros()), Some(hit), "at rest {kind1:?} {kind2:?}");
            let always = ImpactOptions::new().with_contact_at_start(true);
            for v in [normal, -normal, Vector::<N, D>::zeros()] {
                let (one, two) = (Moving::still(&m1, &*shape1), Moving::new(&m2, &v, &*shape2));
                assert_eq!(impact(&one, &two, &always), Some(hit), "{kind1:?} {kind2:?} by {v}");
                let swapped = impact(&two, &one, &always).map(|hit| hit.flipped());
                assert_eq!(swapped, Some(hit), "in either order");
            }
        }
    }
    assert!(tried > kinds.len() * kinds.len(), "{tried} overlapped");
}

#[test]
fn overlapping_starts_of_all_kinds() {
    overlapping_starts::<f32, _, 2>(&PLANE, sample2, Random::turn2);
    overlapping_starts::<f64, _, 2>(&PLANE, sample2, Random::turn2);
    overlapping_starts::<f32, _, 3>(&SPACE, sample3, Random::turn3);
    overlapping_starts::<f64, _, 3>(&SPACE, sample3, Random::turn3);
}

#[test]
fn in_space() {
    let (cuboid, ball) = (Cuboid::new(V3::new(1.0, 1.0, 1.0)), Ball::new(1.0));
    let still = Moving::still(&Isometry3::identity(), &cuboid);
    let diagonal = V3::new(-1.0, -1.0, -1.0);
    let moving = Moving::new(&Isometry3::translation(4.0, 4.0, 4.0), &diagonal, &ball);
    let hit = impact(&still, &moving, &ImpactOptions::new()).expect("onto the corner");
    // The centre is 3 √3 away from the corner, and at the impact 1.
    assert!((hit.toi - (3.0 - 1.0 / 3.0_f64.sqrt())).abs() < 1e-13, "{hit:?}");
    assert!((hit.world1.coords - V3::new(1.0, 1.0, 1.0)).norm() < 1e-13, "{hit:?}");
    assert!(matches!(hit.feature1, FeatureId::Vertex(_)), "the corner: {hit:?}");
    let down = Moving::new(&Isometry3::translation(0.5, 4.0, 0.25), &-V3::y(), &cuboid);
    let hit = impact(&down, &still, &ImpactOptions::new()).expect("onto the top");
    assert_eq!(hit.toi, 2.0, "four less two halves");
    let corners =
        Segment::new(Point::<f64, 3>::new(-0.5, 4.0, 0.0), Point::<f64, 3>::new(0.5, 4.5, 0.0));
    let down = Moving::new(&Isometry3::identity(), &-V3::y(), &corners);
    let hit = impact(&down, &still, &ImpactOptions::new()).expect("with its lower end");
    assert_eq!((hit.toi, hit.feature1), (3.0, FeatureId::Vertex(0)));
    assert!(matches!(hit.feature2, FeatureId::Face(_)), "the top: {hit:?}");
}
