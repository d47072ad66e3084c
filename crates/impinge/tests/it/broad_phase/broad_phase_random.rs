//! Compares the broad phase with one that tests all pairs, over random sequences of calls.

use crate::support::broad_phase_model;
use crate::support::samples::{samples, stride};

use broad_phase_model::{Plan, Reached, run};
use impinge::math::Space;

/// Compares the broad phase with the model in random plans of several sizes: by default a small
/// plan for each of three margins, and a large one. Asserts that enough pairs began, ended and were
/// refused, as a share of the pairs of objects in all updates. All coordinates lie on a grid, so
/// that touching is common.
fn check<N: Space<D>, const D: usize>(size: u32) {
    let small = (0..samples(3) as u64).map(|seed| Plan {
        seed,
        objects: 40,
        updates: 160,
        size: size / 2,
        margin: u32::try_from(seed % 3).expect("small"),
    });
    // The time of the model is quadratic in the number of objects. All updates are needed: nearly
    // all objects are still only after update 40, and at rest 32 updates later.
    let objects = 420 / u32::try_from(stride(2)).expect("small");
    let large = (10..10 + samples(1).div_ceil(5) as u64).map(|seed| Plan {
        seed,
        objects,
        updates: 100,
        size,
        margin: 1,
    });
    let plans = small.chain(large).collect::<Vec<_>>();
    let pairs_of = |plan: &Plan| plan.objects as usize * plan.objects as usize / 2;
    let pairs: usize = plans.iter().map(|plan| pairs_of(plan) * plan.updates as usize).sum();
    let runs = plans.into_iter().map(run::<N, D>).collect::<Vec<_>>();
    let total = |count: fn(&Reached) -> usize| runs.iter().map(count).sum::<usize>();
    assert!(total(|reached| reached.started) > pairs / 2000, "{pairs}: {runs:?}");
    assert!(total(|reached| reached.stopped) > pairs / 4000, "{pairs}: {runs:?}");
    assert!(total(|reached| reached.refused) > pairs / 4000, "{pairs}: {runs:?}");
    assert!(total(|reached| reached.removed_pairs) > pairs / 20_000, "{pairs}: {runs:?}");
    let (hits, misses) =
        (total(|reached| reached.query_hits), total(|reached| reached.query_misses));
    assert!(hits * 4 > misses && misses * 4 > hits, "{hits} rays hit, {misses} missed");
    assert!(runs.iter().all(|reached| reached.most_pairs > 20), "{runs:?}");
}

#[test]
fn plane_f32() {
    check::<f32, 2>(16);
}

#[test]
fn plane_f64() {
    check::<f64, 2>(16);
}

#[test]
fn space_f32() {
    check::<f32, 3>(8);
}

#[test]
fn space_f64() {
    check::<f64, 3>(8);
}
