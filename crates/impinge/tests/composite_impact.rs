//! Moving composites: the first impact of two parts, in both orders to the bit.

mod composite_support;
mod query_support;

use composite_support::Pieces;
use composite_support::scenes::{Maker, Scene};
use impinge::math::{AbstractRotation, Isometry, Isometry3, Point, Space, Vector};
use impinge::query::{Impact, ImpactOptions, Moving, distance, impact};
use impinge::shape::{Cuboid, Shape};
use query_support::random::Random;
use query_support::samples::{PLANE, SPACE, sample2, sample3};

/// A placed shape with its velocity.
type Mover<'a, N, R, const D: usize> = (&'a Isometry<N, R, D>, Vector<N, D>, &'a dyn Shape<N, D>);

fn hit<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    one: &Mover<'_, N, R, D>,
    two: &Mover<'_, N, R, D>,
    options: &ImpactOptions<N>,
) -> Option<Impact<N, D>> {
    impact(&Moving::new(one.0, &one.1, one.2), &Moving::new(two.0, &two.1, two.2), options)
}

/// The first impact of all parts with a solid.
fn brute<N: Space<D>, R: AbstractRotation<N, D>, const D: usize>(
    scene: &Scene<N, R, D>,
    (m1, velocity): (&Isometry<N, R, D>, Vector<N, D>),
    two: &Mover<'_, N, R, D>,
    options: &ImpactOptions<N>,
) -> N {
    let one = |part: usize| {
        let place = m1 * &scene.places[part];
        let mover = (&place, velocity, scene.fast.parts[part].1.as_shape());
        hit(&mover, two, options).map_or(N::INFINITY, |found| found.toi)
    };
    (0..scene.places.len()).map(one).fold(N::INFINITY, |a, b| if b < a { b } else { a })
}

struct Counts {
    hits: u32,
    later: u32,
}

fn against_convex<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    maker: &Maker<N, R, D>,
    counts: &mut Counts,
) {
    for seed in 0..120 {
        let random = &mut Random(seed, false);
        let scene = maker.scene(random, 1 + usize::try_from(seed % 17).expect("few"), N::ONE);
        let solid = maker.solid(random, N::lit([0.5, 0.1, 2.0][(seed % 3) as usize]));
        let (m1, m2) = (maker.place(random, N::lit(8.0)), maker.place(random, N::lit(8.0)));
        let toward = (m1.translation.vector - m2.translation.vector) * N::HALF;
        let (v1, v2) = (random.vector::<N, D>(), toward + random.vector::<N, D>());
        let target = if seed % 4 == 0 { N::lit(0.25) } else { N::ZERO };
        let options = ImpactOptions::new().with_target_distance(target);
        let (one, two) = ((&m1, v1, &scene.fast as &dyn Shape<N, D>), (&m2, v2, &*solid));
        let found = hit(&one, &two, &options);
        let swapped = hit(&two, &one, &options).map(|found| found.flipped());
        assert_eq!(found, swapped, "{seed}");
        let slow = hit(&(&m1, v1, &scene.slow as &dyn Shape<N, D>), &two, &options);
        assert_eq!(found, slow, "whatever the search proposes {seed}");
        let expected = brute(&scene, (&m1, v1), &two, &options);
        let toi = found.map_or(N::INFINITY, |found| found.toi);
        let noise = N::EPSILON.sqrt() * N::lit(16.0) + N::lit(1e-6);
        // What grazes may count as touching or not.
        let both = toi.is_finite_number() && expected.is_finite_number();
        assert!(!both || (toi - expected).abs() <= noise, "{seed} {toi:?} {expected:?}");
        if both != (toi.is_finite_number() || expected.is_finite_number()) {
            let at = if toi.is_finite_number() { toi } else { expected };
            let (p1, p2) = (moved(&m1, v1 * at), moved(&m2, v2 * at));
            let apart = distance(&p1, &scene.fast, &p2, &*solid);
            assert!((apart - target).abs() <= noise, "{seed} {toi:?} {expected:?} {apart:?}");
        }
        if let Some(found) = found {
            stepped(&one, &two, (found.toi, target));
            counts.hits += 1;
            counts.later += u32::from(found.toi > N::ZERO);
        }
    }
}

fn moved<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    m: &Isometry<N, R, D>,
    by: Vector<N, D>,
) -> Isometry<N, R, D> {
    let mut m = m.clone();
    m.translation.vector += by;
    m
}

/// Until an impact the shapes are farther apart than the target, at it they are there.
fn stepped<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    one: &Mover<'_, N, R, D>,
    two: &Mover<'_, N, R, D>,
    (toi, target): (N, N),
) {
    let noise = N::EPSILON * N::lit(4096.0) + N::lit(1e-9);
    let at =
        |time: N| distance(&moved(one.0, one.1 * time), one.2, &moved(two.0, two.1 * time), two.2);
    assert!(at(toi) <= target + noise, "they touch at {toi:?}: {:?}", at(toi));
    // What touches at the start and parts again does not count; so only what starts apart.
    if at(N::ZERO) > target + noise {
        for step in 0..16 {
            let time = toi * N::lit(f64::from(step) / 16.0);
            assert!(at(time) >= target - noise, "{time:?} of {toi:?}: {:?}", at(time));
        }
    }
}

#[test]
fn against_convex_solids() {
    let mut counts = Counts { hits: 0, later: 0 };
    let c = &mut counts;
    against_convex(&Maker::<f32, _, 2> { kinds: &PLANE, sample: sample2, turn: Random::turn2 }, c);
    against_convex(&Maker::<f32, _, 3> { kinds: &SPACE, sample: sample3, turn: Random::turn3 }, c);
    against_convex(&Maker::<f64, _, 2> { kinds: &PLANE, sample: sample2, turn: Random::turn2 }, c);
    against_convex(&Maker::<f64, _, 3> { kinds: &SPACE, sample: sample3, turn: Random::turn3 }, c);
    assert!(counts.later > 150 && counts.hits < 460, "{} of {}", counts.later, counts.hits);
}

fn against_composites<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    maker: &Maker<N, R, D>,
) -> u32 {
    let mut later = 0;
    for seed in 0..60 {
        let random = &mut Random(seed, false);
        let scene1 = maker.scene(random, 1 + usize::try_from(seed % 7).expect("few"), N::ONE);
        let scene2 = maker.scene(random, 1 + usize::try_from(seed % 5).expect("few"), N::ONE);
        let (m1, m2) = (maker.place(random, N::lit(9.0)), maker.place(random, N::lit(9.0)));
        let toward = (m1.translation.vector - m2.translation.vector) * N::HALF;
        let (v1, v2) = (random.vector::<N, D>(), toward + random.vector::<N, D>());
        let options = ImpactOptions::new();
        let one = (&m1, v1, &scene1.fast as &dyn Shape<N, D>);
        let two = (&m2, v2, &scene2.fast as &dyn Shape<N, D>);
        let found = hit(&one, &two, &options);
        assert_eq!(found, hit(&two, &one, &options).map(|found| found.flipped()), "{seed}");
        let slow1 = (&m1, v1, &scene1.slow as &dyn Shape<N, D>);
        let slow2 = (&m2, v2, &scene2.slow as &dyn Shape<N, D>);
        assert_eq!(found, hit(&slow1, &slow2, &options), "whatever the searches propose {seed}");
        if let Some(found) = found {
            stepped(&one, &two, (found.toi, N::ZERO));
            later += u32::from(found.toi > N::ZERO);
        }
        // With itself, at one place and with two velocities.
        let twin = (&m1, v2, &scene1.fast as &dyn Shape<N, D>);
        let found = hit(&one, &twin, &options);
        let swapped = hit(&twin, &one, &options).map(|found| found.flipped());
        assert_eq!(found, swapped, "with itself {seed}");
    }
    later
}

#[test]
fn against_each_other() {
    let later = [
        against_composites(&Maker::<f32, _, 2> {
            kinds: &PLANE,
            sample: sample2,
            turn: Random::turn2,
        }),
        against_composites(&Maker::<f32, _, 3> {
            kinds: &SPACE,
            sample: sample3,
            turn: Random::turn3,
        }),
        against_composites(&Maker::<f64, _, 2> {
            kinds: &PLANE,
            sample: sample2,
            turn: Random::turn2,
        }),
        against_composites(&Maker::<f64, _, 3> {
            kinds: &SPACE,
            sample: sample3,
            turn: Random::turn3,
        }),
    ];
    assert!(later.iter().sum::<u32>() > 40, "{later:?}");
}

#[test]
fn what_slides_over_the_floor_meets_the_wall() {
    let p = Point::<f64, 3>::new;
    let points = [
        p(-4.0, 0.0, -4.0),
        p(4.0, 0.0, -4.0),
        p(4.0, 0.0, 4.0),
        p(-4.0, 0.0, 4.0),
        p(4.0, 3.0, -4.0),
        p(4.0, 3.0, 4.0),
    ];
    let room = Pieces::mesh(&points, &[[0, 2, 1], [0, 3, 2], [1, 2, 5], [1, 5, 4]]);
    let cube = Cuboid::new(Vector::<f64, 3>::new(0.5, 0.5, 0.5));
    let (here, place) = (Isometry3::identity(), Isometry3::translation(0.0, 0.5, 1.0));
    let slide = Moving::new(&place, &Vector::<f64, 3>::new(0.5, 0.0, 0.0), &cube);
    let still = Moving::still(&here, &room);
    let found = impact(&still, &slide, &ImpactOptions::new()).expect("the wall");
    assert_eq!((found.toi, found.part1, found.normal.x), (7.0, 2, -1.0), "a triangle of the wall");
    let away = Moving::new(&place, &Vector::<f64, 3>::new(-0.5, 0.0, 0.0), &cube);
    assert_eq!(impact(&still, &away, &ImpactOptions::new()), None, "nothing on that side");
    let short = ImpactOptions::new().with_max_time(6.5);
    assert_eq!(impact(&still, &slide, &short), None, "too late");
}
