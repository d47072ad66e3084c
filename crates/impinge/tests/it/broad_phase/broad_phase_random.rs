//! Compares the broad phase with one that tests all pairs, over random sequences of calls.

use crate::support::broad_phase_model;

use broad_phase_model::{Plan, Reached, run};
use impinge::math::Space;

/// Compares the broad phase with the model in random plans of several sizes. Asserts that enough
/// pairs began, ended and were refused. All coordinates lie on a grid, so that touching is common.
fn check<N: Space<D>, const D: usize>(size: u32) {
    let small = (0..6).map(|seed| Plan {
        seed,
        objects: 40,
        updates: 160,
        size: size / 2,
        margin: u32::try_from(seed % 3).expect("small"),
    });
    let large = (10..12).map(|seed| Plan { seed, objects: 420, updates: 100, size, margin: 1 });
    let runs = small.chain(large).map(run::<N, D>).collect::<Vec<_>>();
    let total = |count: fn(&Reached) -> usize| runs.iter().map(count).sum::<usize>();
    assert!(total(|reached| reached.started) > 10_000, "{runs:?}");
    assert!(total(|reached| reached.stopped) > 5000, "{runs:?}");
    assert!(total(|reached| reached.refused) > 5000, "{runs:?}");
    assert!(total(|reached| reached.removed_pairs) > 1000, "{runs:?}");
    let (hits, misses) =
        (total(|reached| reached.query_hits), total(|reached| reached.query_misses));
    assert!(hits * 3 > misses && misses * 3 > hits, "{hits} rays hit, {misses} missed");
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
