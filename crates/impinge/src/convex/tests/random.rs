//! Tests results for random pairs by certificates: heights of normals, which are lower bounds of
//! the signed distance.
//!
//! The signed distance is the largest height over all unit vectors. So a separation is right if the
//! height of its own normal is its distance, if no other direction has a larger height, and if its
//! points lie on the solids at that distance.

use super::super::{Simplicial, separation};
use super::generator::{Generator, Sample};
use super::solids::{Own, height, outside};
use crate::math::{Point, Real, Vector};
use crate::shape::SupportMap;

const KINDS: [&str; 9] = [
    "ball",
    "segment",
    "capsule_y",
    "triangle",
    "cuboid",
    "round_cuboid",
    "convex_hull",
    "cylinder_y",
    "cone_y",
];
/// Number of kinds with a flat-faced core: those before the last two.
const FLAT: usize = 7;
/// Target distances in units of the solids' size: far, near, touching from both sides, shallow and
/// deep.
const TARGETS: [f64; 6] = [1.5, 1e-2, 1e-6, -1e-6, -1e-2, -0.4];
/// Sizes of the solids, and the argument `thin` of [`Generator::shape`].
const SIZES: [(f64, bool); 4] = [(1.0, false), (1e-3, false), (1e3, false), (1.0, true)];

/// Runs `check` on pairs of the first `kinds` of [`KINDS`], for all sizes and distances. Its second
/// argument is whether one of the solids has a curved core.
fn each_sample<N: Real, const D: usize>(kinds: usize, mut check: impl FnMut(&Sample<D>, bool))
where
    f64: Simplicial<D> + Own<D>,
{
    let mut generator = Generator(7);
    for (first, kind1) in KINDS[..kinds].iter().enumerate() {
        for (second, kind2) in KINDS[..=first].iter().enumerate() {
            for (size, thin) in SIZES {
                for target in TARGETS {
                    let shapes = [kind1, kind2].map(|kind| generator.shape::<D>(kind, size, thin));
                    let sample =
                        Sample::new(shapes, target * size, &mut generator).representable::<N>();
                    check(&sample, first.max(second) >= FLAT);
                }
            }
        }
    }
}

/// Returns the largest height along 60 sampled directions: some all around, the others increasingly
/// dense near the normal.
fn sampled<const D: usize>(
    solids: [&dyn SupportMap<f64, D>; 2],
    sample: &Sample<D>,
    normal: &Vector<f64, D>,
    generator: &mut Generator,
) -> f64 {
    let mut best = f64::NEG_INFINITY;
    for round in 0..60 {
        let spread = [1e3, 1.0, 0.1, 1e-2, 1e-3, 1e-4][round % 6];
        let direction = normal + generator.direction::<D>() * spread;
        best = best.max(height(solids, &sample.pose12, &direction));
    }
    best
}

#[derive(Default)]
struct Tally {
    /// Largest error of each sample's distance: against the height of its normal, the largest
    /// height found, and the offset of its points.
    errors: Vec<f64>,
    /// The larger of the distances of each sample's two points from the surfaces of their solids.
    astray: Vec<f64>,
    overlaps: usize,
    worst: [f64; 5],
}

fn check_sample<N, const D: usize>(sample: &Sample<D>, generator: &mut Generator, tally: &mut Tally)
where
    N: Simplicial<D> + Own<D>,
    f64: Simplicial<D> + Own<D>,
{
    let [a, b] = sample.solids::<N>();
    let found = separation(&*a, &*b, &sample.pose::<N>(), N::INFINITY).expect("no limit");
    let [a, b] = sample.solids::<f64>();
    let (distance, normal) = (found.distance.as_f64(), found.normal.map(Real::as_f64));
    let [point1, point2] =
        [found.point1, found.point2].map(|p| Point::from(p.coords.map(Real::as_f64)));
    let exact = separation(&*a, &*b, &sample.pose12, f64::INFINITY).expect("no limit");
    let proven = height([&*a, &*b], &sample.pose12, &normal);
    let best = sampled([&*a, &*b], sample, &normal, generator).max(exact.distance);
    let errors = [
        (proven - distance).abs(),
        best - distance,
        (point2 - point1 - normal * distance).norm(),
        outside(&*a, &point1).abs(),
        outside(&*b, &sample.pose12.inverse_point(&point2)).abs(),
    ]
    .map(|error| error / sample.scale);
    assert!((normal.norm() - 1.0).abs() < 4.0 * N::EPSILON.as_f64(), "unit: {normal}");
    tally.overlaps += usize::from(distance < 0.0);
    tally.errors.push(errors[..3].iter().copied().fold(0.0, f64::max));
    tally.astray.push(errors[3].max(errors[4]));
    for (worst, error) in tally.worst.iter_mut().zip(errors) {
        *worst = worst.max(error);
    }
}

/// Returns the largest error and the 99th percentile.
fn summary(errors: &mut [f64]) -> [f64; 2] {
    errors.sort_by(f64::total_cmp);
    let count = errors.len();
    [errors[count - 1], errors[count - 1 - count / 100]]
}

/// Bounds of the errors relative to the scale: the largest error and the 99th percentile, of
/// distances, then of points.
type Bounds = [[f64; 2]; 2];

fn lower_bounds<N, const D: usize>(kinds: usize, bounds: [Bounds; 2])
where
    N: Simplicial<D> + Own<D>,
    f64: Simplicial<D> + Own<D>,
{
    let mut generator = Generator(1);
    let mut tallies = [Tally::default(), Tally::default()];
    each_sample::<N, D>(kinds, |sample, curved| {
        check_sample::<N, D>(sample, &mut generator, &mut tallies[usize::from(curved)]);
    });
    for (tally, bounds) in tallies.iter_mut().zip(bounds) {
        if tally.errors.is_empty() {
            continue;
        }
        let overlaps = tally.overlaps * 100 / tally.errors.len();
        assert!((30..70).contains(&overlaps), "{overlaps} % overlap");
        let found = [summary(&mut tally.errors), summary(&mut tally.astray)];
        let within = found.as_flattened().iter().zip(bounds.as_flattened()).all(|(a, b)| a < b);
        assert!(within, "{found:?}, but {bounds:?}; {:?}", tally.worst);
    }
}

const NONE: Bounds = [[0.0; 2]; 2];

#[test]
fn lower_bounds_2d() {
    lower_bounds::<f32, 2>(FLAT, [[[1e-5, 2e-6], [1e-5, 2e-6]], NONE]);
    lower_bounds::<f64, 2>(FLAT, [[[1e-14, 4e-15], [1e-14, 4e-15]], NONE]);
}

#[test]
fn lower_bounds_3d() {
    let flat = [[1e-5, 2e-6], [1e-5, 2e-6]];
    lower_bounds::<f32, 3>(KINDS.len(), [flat, [[1e-3, 1e-5], [1e-3, 1e-4]]]);
    let flat = [[1e-14, 4e-15], [1e-14, 4e-15]];
    lower_bounds::<f64, 3>(KINDS.len(), [flat, [[1e-10, 1e-11], [1e-7, 1e-8]]]);
}

/// Asserts that swapping the solids keeps the distance. `tolerance` has the largest error for
/// flat-faced cores and the largest error for curved cores, relative to [`Sample::scale`].
fn swapped<N, const D: usize>(kinds: usize, tolerance: [f64; 2])
where
    N: Simplicial<D> + Own<D>,
    f64: Simplicial<D> + Own<D>,
{
    each_sample::<N, D>(kinds, |sample, curved| {
        let ([a, b], pose12) = (sample.solids::<N>(), sample.pose::<N>());
        let found = separation(&*a, &*b, &pose12, N::INFINITY).expect("no limit");
        let other = separation(&*b, &*a, &pose12.inverse(), N::INFINITY).expect("no limit");
        let error = (found.distance - other.distance).abs().as_f64();
        let allowed = tolerance[usize::from(curved)] * sample.scale;
        assert!(error < allowed, "{error}, {allowed}, {:?}", sample.shapes);
    });
}

#[test]
fn swapping_flips() {
    swapped::<f32, 2>(FLAT, [1e-5, 0.0]);
    swapped::<f32, 3>(KINDS.len(), [1e-5, 1e-4]);
    swapped::<f64, 3>(KINDS.len(), [1e-14, 1e-10]);
}

/// Returns a shape with all its numbers multiplied by `factor`.
fn scaled(shape: &serde_json::Value, factor: f64) -> serde_json::Value {
    use serde_json::Value;
    match shape {
        Value::Number(number) => (number.as_f64().expect("a number") * factor).into(),
        Value::Array(list) => list.iter().map(|value| scaled(value, factor)).collect(),
        Value::Object(map) => {
            map.iter().map(|(key, value)| (key.clone(), scaled(value, factor))).collect()
        }
        other => other.clone(),
    }
}

/// Asserts that scaling all lengths by 2^`exponent` scales all results, bit for bit.
fn scales_exactly<N, const D: usize>(kinds: usize, exponent: i32)
where
    N: Simplicial<D> + Own<D>,
    f64: Simplicial<D> + Own<D>,
{
    let factor = f64::from(exponent).exp2();
    each_sample::<N, D>(kinds, |sample, _| {
        let ([a, b], pose12) = (sample.solids::<N>(), sample.pose::<N>());
        let found = separation(&*a, &*b, &pose12, N::INFINITY).expect("no limit");
        let shapes = [0, 1].map(|index| scaled(&sample.shapes[index], factor));
        let mut large = Sample { shapes, ..*sample };
        large.pose12.translation *= factor;
        let ([a, b], pose12) = (large.solids::<N>(), large.pose::<N>());
        let other = separation(&*a, &*b, &pose12, N::INFINITY).expect("no limit");
        let factor = N::lit(factor);
        assert_eq!(other.distance.bits(), (found.distance * factor).bits(), "distance");
        assert_eq!(other.normal, found.normal, "normal of {:?}", sample.shapes);
        assert_eq!(other.point1, found.point1 * factor, "point 1 of {:?}", sample.shapes);
        assert_eq!(other.point2, found.point2 * factor, "point 2 of {:?}", sample.shapes);
    });
}

#[test]
fn scaling_by_powers_of_two_is_exact() {
    for exponent in [-20, 20] {
        scales_exactly::<f32, 2>(FLAT, exponent);
        scales_exactly::<f32, 3>(KINDS.len(), exponent);
        scales_exactly::<f64, 2>(FLAT, exponent);
        scales_exactly::<f64, 3>(KINDS.len(), exponent);
    }
}

/// Asserts that [`separation`] returns `Some` if the distance is at most the limit, and `None` if
/// it exceeds the limit by a small margin.
#[test]
fn limits() {
    let (mut within, mut beyond) = (0, 0);
    each_sample::<f32, 3>(KINDS.len(), |sample, _| {
        let ([a, b], pose12) = (sample.solids::<f32>(), sample.pose::<f32>());
        let exact = separation(&*a, &*b, &pose12, f32::INFINITY).expect("no limit").distance;
        let margin = sample.scale.as_f32() * 2e-3;
        assert!(separation(&*a, &*b, &pose12, exact.max(0.0)).is_some(), "at the limit");
        assert!(separation(&*a, &*b, &pose12, exact.max(0.0) + margin).is_some(), "within");
        within += 1;
        if exact > 2.0 * margin {
            assert!(separation(&*a, &*b, &pose12, exact - margin).is_none(), "beyond");
            beyond += 1;
        }
    });
    assert!(beyond * 10 > within * 2, "{beyond} of {within} were beyond a limit");
}
