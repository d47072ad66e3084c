//! A pair in a batch of any size has the bits of a batch of one, on every instruction set.

use super::super::tests::scene::Random;
use super::{BoxJob, Eights, plane, space, update_at};
use crate::math::simd::Level;
use crate::math::{Isometry2, Isometry3, Matrix, Pose, Real, Vector};
use crate::query::{ManifoldRequest, RawManifold};
use crate::shape::Cuboid;

/// The dimensions: how boxes are treated there, and how they turn.
trait Turning<N: Real, const D: usize>: Eights<N, D> {
    /// A rotation by the components of a vector, each at most `lean`.
    fn turn(random: &mut Random, lean: f64) -> Matrix<f64, D>;
}

impl<N: Real> Turning<N, 2> for plane::Found<N> {
    fn turn(random: &mut Random, lean: f64) -> Matrix<f64, 2> {
        Pose::from_isometry(&Isometry2::rotation(random.between(-lean, lean))).rotation
    }
}

impl<N: Real> Turning<N, 3> for space::Found<N> {
    fn turn(random: &mut Random, lean: f64) -> Matrix<f64, 3> {
        let turn = Vector::<f64, 3>::from_fn(|_, _| random.between(-lean, lean));
        Pose::from_isometry(&Isometry3::rotation(turn)).rotation
    }
}

struct Case<N: Real, const D: usize> {
    poses: [Pose<N, D>; 2],
    cuboids: [Cuboid<N, D>; 2],
    request: ManifoldRequest<N>,
}

/// Numbers as bits, but for NaN, which has many.
fn bits<N: Real>(value: N) -> u64 {
    if value.partial_cmp(&value).is_some() { value.bits() } else { u64::MAX }
}

/// All that a manifold says.
pub(in crate::query::manifold_build) fn facts<N: Real, const D: usize>(
    raw: &RawManifold<N, D>,
) -> Vec<u64> {
    let mut facts: Vec<u64> = Vec::new();
    for point in &raw.points {
        facts.extend(point.point1.coords.iter().map(|&x| bits(x)));
        facts.extend([bits(point.distance), u64::from(point.id)]);
        for feature in [point.feature1, point.feature2] {
            facts.extend(format!("{feature:?}").bytes().map(u64::from));
        }
    }
    if !raw.points.is_empty() {
        facts.extend(raw.normal.iter().map(|&x| bits(x)));
    }
    facts
}

fn jobs<'a, N: Real, const D: usize>(
    cases: &'a [Case<N, D>],
    raws: &'a mut [RawManifold<N, D>],
) -> Vec<BoxJob<'a, N, D>> {
    let mut jobs = Vec::new();
    for (case, raw) in cases.iter().zip(raws) {
        let (poses, cuboids) = (case.poses.each_ref(), case.cuboids.each_ref());
        jobs.push(BoxJob { poses, cuboids, request: &case.request, raw });
    }
    jobs
}

/// Some steps of the same pairs, so that names are inherited; answers how many points there were.
fn compare<N: Real, E: Eights<N, D>, const D: usize>(
    steps: &[Vec<Case<N, D>>],
    what: &str,
) -> usize {
    let mut points = 0;
    for level in Level::available() {
        let fresh = || vec![RawManifold::<N, D>::default(); steps[0].len()];
        let (mut expected, mut found) = (fresh(), fresh());
        for (step, cases) in steps.iter().enumerate() {
            for job in jobs(cases, &mut expected) {
                update_at::<N, E, D>(Level::new(), &mut [job]);
            }
            update_at::<N, E, D>(level, &mut jobs(cases, &mut found));
            for (index, (one, other)) in expected.iter().zip(&found).enumerate() {
                assert_eq!(
                    facts(one),
                    facts(other),
                    "{what}, {level:?}, {step}, {index}: {one:?} {other:?}"
                );
                points += one.points.len();
            }
        }
    }
    points / Level::available().len()
}

/// A draw of two boxes near each other.
struct Draw<const D: usize> {
    halves: [Vector<f64, D>; 2],
    at: [Pose<f64, D>; 2],
}

impl<const D: usize> Draw<D> {
    /// `snapped` boxes have sides and places on a grid and no turn; `lean` is the angle of others.
    fn new<N: Real, E: Turning<N, D>>(random: &mut Random, snapped: bool, lean: f64) -> Self {
        let snap = |x: f64| if snapped { (x * 2.0).round() / 2.0 } else { x };
        let mut half = || Vector::<f64, D>::from_fn(|_, _| snap(random.between(0.2, 1.3)));
        let halves = [half(), half()];
        let lean = if snapped { 0.0 } else { lean };
        let turns = [E::turn(random, lean), E::turn(random, lean)];
        let mut shift = Vector::<f64, D>::from_fn(|_, _| snap(random.between(-1.2, 1.2)));
        let axis = usize::from(random.between(0.0, 1.0) < 0.5);
        let side = if random.between(0.0, 1.0) < 0.5 { -1.0 } else { 1.0 };
        shift[axis] = side * (halves[0][axis] + halves[1][axis] - snap(random.between(-0.1, 0.2)));
        let place = Vector::<f64, D>::from_fn(|_, _| random.between(-9.0, 9.0).round());
        let [rotation, other] = turns;
        let first = Pose { rotation, translation: place };
        let second = Pose { rotation: other, translation: place + shift };
        Self { halves, at: [first, second] }
    }

    /// The same, shaken a little.
    fn shaken<N: Real, E: Turning<N, D>>(&self, random: &mut Random, by: f64) -> Self {
        let at = self.at.map(|at| {
            let translation = Vector::<f64, D>::from_fn(|_, _| random.between(-by, by));
            at.compose(&Pose { rotation: E::turn(random, by), translation })
        });
        Self { halves: self.halves, at }
    }

    /// In another unit of length.
    fn case<N: Real>(&self, unit: f64, request: &ManifoldRequest<N>) -> Case<N, D> {
        let pose = |at: &Pose<f64, D>| {
            let translation = at.translation.map(|x| N::lit(x * unit));
            Pose { rotation: at.rotation.map(N::lit), translation }
        };
        let request = ManifoldRequest { prediction: request.prediction * N::lit(unit), ..*request };
        Case {
            poses: [pose(&self.at[0]), pose(&self.at[1])],
            cuboids: self.halves.map(|half| Cuboid::new(half.map(|x| N::lit(x * unit)))),
            request,
        }
    }
}

fn request<N: Real>(max_points: usize, sine: f64) -> ManifoldRequest<N> {
    ManifoldRequest { prediction: N::lit(0.05), sine: N::lit(sine), max_points }
}

/// 203 pairs of a kind, in three steps.
fn drawn<N: Real, E: Turning<N, D>, const D: usize>(
    seed: u64,
    unit: f64,
    points: usize,
    lean: f64,
) -> Vec<Vec<Case<N, D>>> {
    let mut random = Random(seed);
    let snaps: Vec<bool> = (0..203).map(|index| index % 3 == 0).collect();
    let mut draws: Vec<_> =
        snaps.iter().map(|&snap| Draw::new::<N, E>(&mut random, snap, lean)).collect();
    let mut steps = Vec::new();
    for _ in 0..3 {
        let sine = |index: usize| if index.is_multiple_of(4) { 0.05 } else { 0.0 };
        let case =
            |(index, draw): (usize, &Draw<D>)| draw.case(unit, &request(points, sine(index)));
        steps.push(draws.iter().enumerate().map(case).collect());
        draws = draws.iter().map(|draw| draw.shaken::<N, E>(&mut random, 0.002)).collect();
    }
    steps
}

fn ordinary<N: Real, E: Turning<N, D>, const D: usize>() {
    for (seed, points) in [(1, 4), (2, 4), (3, 1), (4, 2), (5, 3), (6, 16)] {
        for lean in [0.005, 0.1, 3.0] {
            let steps = drawn::<N, E, D>(seed, 1.0, points, lean);
            let found = compare::<N, E, D>(&steps, "drawn");
            assert!(found > 200, "{found} points, {points} at most, lean {lean}");
        }
    }
    for unit in [1e-30, 1e-15, 1e12, 1e18, 1e30] {
        compare::<N, E, D>(&drawn::<N, E, D>(7, unit, 4, 0.02), "in another unit");
    }
}

#[test]
fn eight_pairs_are_as_one() {
    ordinary::<f32, plane::Found<f32>, 2>();
    ordinary::<f32, space::Found<f32>, 3>();
    #[cfg(feature = "f64")]
    {
        ordinary::<f64, plane::Found<f64>, 2>();
        ordinary::<f64, space::Found<f64>, 3>();
    }
}

/// Boxes without height, width or any size; poses that are no numbers, no rotations or far away.
fn spoiled<N: Real, const D: usize>(case: &mut Case<N, D>, number: usize) {
    let strange = [N::lit(f64::NAN), N::INFINITY, -N::INFINITY, N::MAX, N::ZERO, N::MIN_POSITIVE];
    let value = strange[number / 7 % strange.len()];
    let (which, axis) = (number % 2, number / 2 % D);
    match number % 7 {
        0 => case.poses[which].translation[axis] = value,
        1 => case.poses[which].rotation[(axis, number / 6 % D)] = value,
        2 => case.poses[which].rotation *= N::ZERO,
        3 => {
            let mut half = *case.cuboids[which].half_extents();
            half[axis] = if value.is_finite_number() && value >= N::ZERO { value } else { N::ZERO };
            case.cuboids[which] = Cuboid::new(half);
        }
        4 => case.cuboids[which] = Cuboid::new(Vector::<N, D>::zeros()),
        5 => case.poses[1] = case.poses[0],
        _ => {
            case.request.prediction = [N::ZERO, N::INFINITY, N::MAX][number / 7 % 3];
            case.request.sine = if number.is_multiple_of(4) { N::HALF } else { N::ZERO };
        }
    }
}

fn strange<N: Real, E: Turning<N, D>, const D: usize>() {
    for seed in 11..15 {
        let mut steps = drawn::<N, E, D>(seed, 1.0, 4, 0.05);
        for cases in &mut steps {
            for (number, case) in cases.iter_mut().enumerate() {
                spoiled(case, number + usize::try_from(seed).expect("small"));
            }
        }
        compare::<N, E, D>(&steps, "spoiled");
    }
}

#[test]
fn strange_numbers_are_treated_as_one_by_one() {
    strange::<f32, plane::Found<f32>, 2>();
    strange::<f32, space::Found<f32>, 3>();
    #[cfg(feature = "f64")]
    {
        strange::<f64, plane::Found<f64>, 2>();
        strange::<f64, space::Found<f64>, 3>();
    }
}

fn counted<E: Turning<f32, D>, const D: usize>() {
    let steps = drawn::<f32, E, D>(21, 1.0, 4, 0.02);
    for count in 0..20 {
        let some: Vec<Vec<Case<f32, D>>> = steps
            .iter()
            .map(|cases| cases.iter().take(count).map(|case| Case { ..*case }).collect())
            .collect();
        compare::<f32, E, D>(&some, "some");
    }
}

#[test]
fn any_number_of_pairs() {
    counted::<plane::Found<f32>, 2>();
    counted::<space::Found<f32>, 3>();
}
