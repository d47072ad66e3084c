//! Random sequences of calls against a broad phase that tests all pairs.

mod broad_phase_model;

use broad_phase_model::{Plan, Reached, run};
use impinge::math::Space;

/// Runs plans of several sizes; the coordinates lie on a grid, so that touching is common.
fn check<N: Space<D>, const D: usize>(size: u32) -> Vec<Reached> {
    let small = (0..6).map(|seed| Plan {
        seed,
        objects: 40,
        updates: 160,
        size: size / 2,
        margin: u32::try_from(seed % 3).expect("small"),
    });
    let large = (10..12).map(|seed| Plan { seed, objects: 420, updates: 100, size, margin: 1 });
    let runs = small.chain(large).map(run::<N, D>).collect::<Vec<_>>();
    for reached in &runs {
        assert!(reached.started > 1000 && reached.stopped > 500, "{reached:?}");
        assert!(reached.refused > 100 && reached.removed_pairs > 50, "{reached:?}");
        assert!(reached.most_pairs > 30, "{reached:?}");
        assert!(reached.query_hits > 300 && reached.query_misses > 300, "{reached:?}");
    }
    runs
}

#[test]
fn plane_f32() {
    check::<f32, 2>(24);
}

#[test]
fn plane_f64() {
    check::<f64, 2>(24);
}

#[test]
fn space_f32() {
    check::<f32, 3>(8);
}

#[test]
fn space_f64() {
    check::<f64, 3>(8);
}
