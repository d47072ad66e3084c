//! Compares the impact of moving composites with the earliest impact of any two of their parts.
//! Swapping the composites must give the same bits.

use crate::support::composite_support;
use crate::support::query_support;
use crate::support::samples::{samples, stride};

use composite_support::Pieces;
use composite_support::scenes::{Maker, Scene};
use std::f64::consts::TAU;
use std::sync::atomic::{AtomicU32, Ordering};

use impinge::bounding_volume::Aabb;
use impinge::math::{AbstractRotation, Isometry, Isometry2, Isometry3, Point, Space, Vector};
use impinge::query::{
    ConstantVelocities, Impact, ImpactOptions, ImpactStatus, Moving, RigidMotion, distance, impact,
    nonlinear_time_of_impact,
};
use impinge::shape::{CompositeShape, Cuboid, Geometry, Part, PartSearch, Shape};
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

/// Returns the earliest time of impact of any part with a solid, by a query of each part; infinity
/// if no part has an impact.
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
        // For shapes that graze each other, rounding decides whether they touch.
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

/// Asserts that the distance of the shapes is at least the target distance before the impact, and
/// at most the target distance at the impact.
fn stepped<N: Space<D>, R: AbstractRotation<N, D> + Clone, const D: usize>(
    one: &Mover<'_, N, R, D>,
    two: &Mover<'_, N, R, D>,
    (toi, target): (N, N),
) {
    let noise = N::EPSILON * N::lit(4096.0) + N::lit(1e-9);
    let at =
        |time: N| distance(&moved(one.0, one.1 * time), one.2, &moved(two.0, two.1 * time), two.2);
    assert!(at(toi) <= target + noise, "they touch at {toi:?}: {:?}", at(toi));
    // Shapes that touch at the start and then separate have no impact, so only pairs that are
    // disjoint at the start are checked.
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
        // Tests the composite against itself at the same pose, with two different velocities.
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

/// Computes the impact of a moving shape with a shape that rests at the origin. Asserts that
/// nothing touches before the impact, and that the gap is at most 2⁻¹⁵ at the impact. Returns
/// whether there is an impact.
fn slides<N, R, const D: usize>(
    motion: ConstantVelocities<N, D>,
    mover: &dyn Shape<N, D>,
    stays: &dyn Shape<N, D>,
    options: &ImpactOptions<N>,
) -> bool
where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + Copy + std::fmt::Debug,
    ConstantVelocities<N, D>: RigidMotion<N, D>,
{
    let still = ConstantVelocities::<N, D>::still(Isometry::identity());
    let found = nonlinear_time_of_impact(&motion, mover, &still, stays, options);
    let end = found.map_or(options.max_time, |found| found.toi);
    let gap = |time: N| distance(&motion.position_at(time), mover, &Isometry::identity(), stays);
    for look in (0..12).step_by(stride(3)) {
        let share = N::lit(f64::from(look) / 12.0);
        // Samples the whole path, and more densely near its end.
        for time in [end * share, end * (N::ONE - share * share * share)] {
            assert!(gap(time) > N::ZERO, "{time} is before {found:?} {motion:?}");
        }
    }
    let Some(found) = found else { return false };
    assert_eq!(found.status, ImpactStatus::Reached, "{found:?} {motion:?}");
    let (last, near) = (gap(end), N::lit(32.0 / 1_048_576.0));
    assert!(last <= near, "{last} at the end {found:?} {motion:?}");
    true
}

/// Returns the surface of a screw thread of pitch 1 around the y axis: its crest, at `radius +
/// 0.25`, and its groove, at `radius - 0.25`, are helices.
fn thread<N: Space<3>>(radius: f64, pitches: u32) -> Pieces<N, 3> {
    let (around, rows) = (24, 8 * pitches);
    let mut points = Vec::new();
    for (row, corner) in (0..=rows).flat_map(|row| (0..around).map(move |corner| (row, corner))) {
        let height = f64::from(row) / 8.0 - f64::from(pitches) / 2.0;
        let angle = TAU * f64::from(corner) / f64::from(around);
        let out = radius + 0.25 * (angle - TAU * height).cos();
        points
            .push(Point::<N, 3>::from([angle.sin() * out, height, angle.cos() * out].map(N::lit)));
    }
    let index = |row, corner| row * around + corner % around;
    let cell = |row, corner| {
        let [a, b] = [index(row, corner), index(row, corner + 1)];
        let [c, d] = [index(row + 1, corner), index(row + 1, corner + 1)];
        [[a, b, c], [b, d, c]]
    };
    let cells = (0..rows).flat_map(|row| (0..around).map(move |corner| (row, corner)));
    let triangles: Vec<_> = cells.flat_map(|(row, corner)| cell(row, corner)).collect();
    Pieces::mesh(&points, &triangles)
}

/// Tests with [`slides`] a screw that rotates in its nut and rises by approximately one pitch per
/// turn, so that flanks slide along flanks. By default only every fifth round is tested, of which
/// `first` chooses the first. Returns the number of impacts and the number of rounds.
fn screw_in_nut<N: Space<3, Isometry = Isometry3<N>>>(first: usize) -> [u32; 2]
where
    ConstantVelocities<N, 3>: RigidMotion<N, 3>,
{
    let (screw, nut) = (thread::<N>(1.0, 2), thread::<N>(1.125, 1));
    let (random, mut hits, mut rounds) = (&mut Random(8, false), 0, 0);
    for round in 0..6 {
        let loose = N::lit([0.9, 0.3, 0.03][round % 3]);
        let rise = N::lit(1.0 / TAU);
        let linear = (Vector::<N, 3>::y() + random.vector::<N, 3>() * loose) * rise;
        let angular = Vector::<N, 3>::y() + random.vector::<N, 3>() * (loose * N::lit(0.25));
        if round % stride(5) != first % stride(5) {
            continue;
        }
        let motion = ConstantVelocities::<N, 3>::new(Isometry3::identity(), linear, angular);
        let options = ImpactOptions::new().with_max_time(N::lit(3.0));
        hits += u32::from(slides(motion, &screw, &nut, &options));
        rounds += 1;
    }
    [hits, rounds]
}

/// Tests with [`slides`] a round outline of segments that spins within a slightly larger outline,
/// and drifts toward it much more slowly. By default every second speed is tested, beginning with
/// `first`.
fn spins_in_ring<N: Space<2, Isometry = Isometry2<N>>>(first: usize)
where
    ConstantVelocities<N, 2>: RigidMotion<N, 2>,
{
    let outline = |radius: f64| {
        let angle = |corner: i32| TAU * f64::from(corner) / 48.0;
        let point = |corner| {
            let (x, y) = (angle(corner).cos() * radius, angle(corner).sin() * radius);
            Point::<N, 2>::new(N::lit(x), N::lit(y))
        };
        Pieces::chain(&(0..=48).map(point).collect::<Vec<_>>())
    };
    let (wheel, ring) = (outline(1.0), outline(1.0625));
    let speeds = [(0.5, 10.0), (0.1, 5.0), (0.1, -1.0), (0.01, 0.25)];
    for (drift, spin) in speeds.into_iter().skip(first % stride(2)).step_by(stride(2)) {
        let linear = Vector::<N, 2>::new(N::lit(0.6 * drift), N::lit(-0.8 * drift));
        let motion = ConstantVelocities::<N, 2>::new(Isometry2::identity(), linear, N::lit(spin));
        assert!(slides(motion, &wheel, &ring, &ImpactOptions::new()), "it drifts on to the ring");
    }
}

/// A composite that counts how often a part is requested.
#[derive(Debug)]
struct Asked(Pieces<f64, 3>, AtomicU32);

impl CompositeShape<f64, 3> for Asked {
    fn num_parts(&self) -> u32 {
        self.0.num_parts()
    }

    fn part(&self, part: u32) -> Part<'_, f64, 3> {
        self.1.fetch_add(1, Ordering::Relaxed);
        self.0.part(part)
    }

    fn search(&self) -> &dyn PartSearch<f64, 3> {
        self.0.search()
    }
}

impl Shape<f64, 3> for Asked {
    fn geometry(&self) -> Geometry<'_, f64, 3> {
        Geometry::composite(self)
    }

    fn local_aabb(&self) -> Aabb<f64, 3> {
        self.0.local_aabb()
    }
}

/// Asserts a bound for the impact of a screw in its nut: the requests for parts of a shape, divided
/// by the number of parts of both shapes, are at most `most`. One search over all parts for each
/// small step of the sliding flanks would exceed this.
#[test]
fn screws_are_looked_at_a_few_times() {
    let [screw, nut] =
        [thread(1.0, 4), thread(1.0625, 2)].map(|pieces| Asked(pieces, AtomicU32::new(0)));
    let still = ConstantVelocities::<f64, 3>::still(Isometry3::identity());
    for (rise, most) in [(0.5, 200), (-0.5, 90)] {
        let (linear, angular) = (Vector::<f64, 3>::y() * (rise / TAU), Vector::<f64, 3>::y());
        let motion = ConstantVelocities::<f64, 3>::new(Isometry3::identity(), linear, angular);
        let found = nonlinear_time_of_impact(&motion, &screw, &still, &nut, &ImpactOptions::new());
        let found = found.expect("flank on flank");
        assert_eq!(found.status, ImpactStatus::Reached, "{found:?}");
        for shape in [&screw, &nut] {
            let times = shape.1.swap(0, Ordering::Relaxed) / (screw.num_parts() + nut.num_parts());
            assert!(times <= most, "{times} times each part for {rise}: {found:?}");
        }
    }
}

/// Asserts that the time of impact of two composites equals, within 1/1000, the earliest time of
/// impact of any two parts, each advanced as a separate solid. All parts have the identity as their
/// pose. Returns `true` if there is an impact.
fn both_turn<N: Space<D>, const D: usize>(
    motions: &[ConstantVelocities<N, D>; 2],
    shapes: &[Pieces<N, D>; 2],
) -> bool
where
    ConstantVelocities<N, D>: RigidMotion<N, D>,
{
    let options = ImpactOptions::new().with_max_time(N::ONE);
    let hit = |one: &dyn Shape<N, D>, two: &dyn Shape<N, D>| {
        let found = nonlinear_time_of_impact(&motions[0], one, &motions[1], two, &options);
        found.map_or(N::INFINITY, |found| found.toi)
    };
    let found = hit(&shapes[0], &shapes[1]);
    let [parts1, parts2] = shapes.each_ref().map(|pieces| &pieces.parts);
    let pairs = parts1.iter().flat_map(|one| parts2.iter().map(move |two| (one, two)));
    let times = pairs.map(|(one, two)| hit(one.1.as_shape(), two.1.as_shape()));
    let first = times.fold(N::INFINITY, |a, b| if b < a { b } else { a });
    let is_same = found == first || (found - first).abs() <= N::lit(1e-3);
    assert!(is_same, "{found} and {first}, {motions:?}");
    found.is_finite_number()
}

/// Tests with [`both_turn`] two patches in 3D, and two chains in 2D, that lie close to each other.
/// Both bodies move and rotate, each about its own centre, or only the first body moves.
fn patches_that_turn<N: Space<2, Isometry = Isometry2<N>> + Space<3, Isometry = Isometry3<N>>>() {
    // Each of the three speeds occurs at least twice in eight rounds.
    let (random, mut hits, rounds) = (&mut Random(31, false), [0, 0], samples(4).max(8));
    for round in 0..rounds {
        let speed = N::lit([4.0, 0.5, 0.0][round % 3]);
        let turns = [N::ONE, speed];
        let bumps: Vec<_> = (0..32).map(|_| random.vector::<N, 3>() * N::lit(0.06)).collect();
        let at = |index: usize, height: f64| {
            let flat = [index % 4, index / 4 % 4].map(|place| N::lit(place as f64 - 1.5));
            Vector::<N, 3>::new(flat[0], N::lit(height), flat[1]) + bumps[index]
        };
        let corner = |index: u32| [index, index + 1, index + 5, index + 4];
        let cells = [0, 1, 2, 4, 5, 6, 8, 9, 10].map(corner);
        let faces: Vec<_> = cells.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
        let patch = |first: usize, height: f64| {
            let points = (first..first + 16).map(|index| Point::from(at(index, height)));
            Pieces::mesh(&points.collect::<Vec<_>>(), &faces)
        };
        let motions = turns.map(|turn| {
            let [linear, angular, center] =
                [0.5, 1.0, 2.0].map(|x| random.vector::<N, 3>() * N::lit(x));
            ConstantVelocities::<N, 3>::new(Isometry3::identity(), linear * turn, angular * turn)
                .with_local_center(center.into())
        });
        hits[0] += usize::from(both_turn(&motions, &[patch(0, 0.0), patch(16, 0.15)]));

        let chain = |first: usize, height: f64| {
            let place = |index: usize| {
                let x = N::lit((index - first) as f64 * 0.25 - 2.0);
                Point::<N, 2>::new(x + bumps[index].x, N::lit(height) + bumps[index].y)
            };
            Pieces::chain(&(first..first + 16).map(place).collect::<Vec<_>>())
        };
        let motions = turns.map(|turn| {
            let [linear, center] = [0.5, 2.0].map(|x| random.vector::<N, 2>() * N::lit(x));
            let spin = random.vector::<N, 2>().x * turn;
            ConstantVelocities::<N, 2>::new(Isometry2::identity(), linear * turn, spin)
                .with_local_center(center.into())
        });
        hits[1] += usize::from(both_turn(&motions, &[chain(0, 0.0), chain(16, 0.15)]));
    }
    // In few rounds all pairs may hit.
    let some = rounds / 4..rounds.max(40);
    assert!(hits.iter().all(|hits| some.contains(hits)), "{hits:?} of {rounds}");
}

#[test]
fn composites_that_turn_meet_by_their_parts() {
    patches_that_turn::<f32>();
    patches_that_turn::<f64>();
}

#[test]
fn surfaces_that_slide_on_each_other() {
    // By default a loose and a tight screw, and one in between.
    let [one, two] = [screw_in_nut::<f32>(0), screw_in_nut::<f64>(1)];
    let [hits, rounds] = [one[0] + two[0], one[1] + two[1]];
    assert!(3 * hits >= rounds, "{hits} of {rounds}");
    spins_in_ring::<f32>(0);
    spins_in_ring::<f64>(1);
}
