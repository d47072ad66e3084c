//! Tests, by closed forms, that the points of a separation lie on the two solids.

use super::super::{Separation, Simplicial, separation};
use super::generator::{Generator, Sample};
use super::solids::Own;
use super::surface::off;
use crate::math::{Point, Real};
use crate::samples::samples;

const KINDS: [&str; 6] = ["segment", "capsule_y", "triangle", "cuboid", "cylinder_y", "cone_y"];
/// Target distances, for solids of a size of about 1: far, near, touching, shallow and increasingly
/// deep.
const TARGETS: [f64; 10] = [1.0, 1e-2, 1e-5, 0.0, -1e-5, -1e-3, -1e-2, -0.1, -0.3, -0.8];

/// Returns the errors of a separation's points: their distances from the surfaces of the two
/// solids, and the mismatch between their offset and the distance along the normal.
fn errors<N: Simplicial<3> + Own<3>>(sample: &Sample<3>, found: &Separation<N, 3>) -> [f64; 3] {
    let [point1, point2] =
        [found.point1, found.point2].map(|p| Point::from(p.coords.map(Real::as_f64)));
    let local2 = sample.pose12.inverse_point(&point2);
    let across = found.point1 + found.normal * found.distance - found.point2;
    [
        off(&sample.shapes[0], &point1.coords).abs(),
        off(&sample.shapes[1], &local2.coords).abs(),
        across.norm().as_f64(),
    ]
}

/// Asserts that the errors of separations, for random samples of every pair of [`KINDS`], are at
/// most `allowed`, relative to [`Sample::scale`].
fn check<N>(rounds: usize, allowed: f64)
where
    N: Simplicial<3> + Own<3>,
    f64: Simplicial<3> + Own<3>,
{
    let mut generator = Generator(11);
    let (mut failures, mut count, mut deep) = (Vec::new(), 0, 0);
    for round in 0..rounds {
        for (first, kind1) in KINDS.into_iter().enumerate() {
            for kind2 in &KINDS[..=first] {
                let target = TARGETS[round % TARGETS.len()];
                let shapes = [kind1, kind2].map(|kind| generator.shape::<3>(kind, 1.0, false));
                let sample = Sample::new(shapes, target, &mut generator).representable::<N>();
                let ([a, b], pose12) = (sample.solids::<N>(), sample.pose::<N>());
                let found = separation(&*a, &*b, &pose12, N::INFINITY).expect("no limit");
                let errors = errors(&sample, &found).map(|error| error / sample.scale);
                count += 1;
                deep += usize::from(found.distance < N::ZERO);
                if !errors.iter().all(|error| *error <= allowed) {
                    failures
                        .push(format!("{kind1} {kind2} {target} {:?}: {errors:?}", found.distance));
                }
            }
        }
    }
    assert!(failures.is_empty(), "{} of {count}:\n{}", failures.len(), failures.join("\n"));
    assert!(deep * 10 > count * 3 && deep * 10 < count * 8, "{deep} of {count} overlap");
}

#[test]
fn points_lie_on_both_solids() {
    check::<f32>(samples(40), 1e-4);
    check::<f64>(samples(40), 1e-8);
}
