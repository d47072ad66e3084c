//! Tests of contacts under a solver: solids at rest, falling, sliding and shaken, in 2D and 3D,
//! with `f32` and `f64`. Scenes, solver and measures come from `impinge-stacks`. Bounds are in
//! units of the scenes, whose solids have a size and a density of about 1 under a gravity of 10.

mod fall;
mod rest;
mod shaken;
mod slide;

use impinge_stacks::{Choices, Impinge, Memory, Outcome, Solver, Stack, Stage, play};

/// Runs a scene with a solver that looks up the impulses of the last step by contact ids only.
fn played<N: Stage<D>, const D: usize>(
    stack: &Stack<D>,
    choices: Choices,
    steps: usize,
) -> Outcome {
    play(stack, &mut Impinge::<N, D>::new(stack, choices), Solver::new(Memory::by_ids()), steps)
}

/// Returns a description of each number above its bound.
fn above<const N: usize>(name: &str, numbers: [(&str, f64, f64); N]) -> Vec<String> {
    let is_above = |(_, number, bound): &(&str, f64, f64)| number > bound || number.is_nan();
    let faults = numbers.into_iter().filter(is_above);
    faults
        .map(|(what, number, bound)| format!("{name}: {what} {number:.3e} > {bound:.1e}"))
        .collect()
}

/// Asserts that there are no faults, and prints all of them otherwise.
fn assert_none(faults: &[String]) {
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}
