//! A solver stands on the contacts: solids at rest, falling, sliding and shaken, in 2D and 3D, `f32` and `f64`. Scenes,
//! solver and measures are those of `impinge-stacks`. Bounds are in units of the scenes, whose solids have a size and
//! a density of about 1 under a gravity of 10.

mod fall;
mod rest;
mod shaken;
mod slide;

use impinge_stacks::{Choices, Impinge, Memory, Outcome, Solver, Stack, Stage, play};

/// Plays a scene with impulses found by ids alone.
fn played<N: Stage<D>, const D: usize>(
    stack: &Stack<D>,
    choices: Choices,
    steps: usize,
) -> Outcome {
    play(stack, &mut Impinge::<N, D>::new(stack, choices), Solver::new(Memory::by_ids()), steps)
}

/// Numbers above their bounds, in words.
fn above<const N: usize>(name: &str, numbers: [(&str, f64, f64); N]) -> Vec<String> {
    let is_above = |(_, number, bound): &(&str, f64, f64)| number > bound || number.is_nan();
    let faults = numbers.into_iter().filter(is_above);
    faults
        .map(|(what, number, bound)| format!("{name}: {what} {number:.3e} > {bound:.1e}"))
        .collect()
}

/// Fails with all faults.
fn assert_none(faults: &[String]) {
    assert!(faults.is_empty(), "{} faults:\n{}", faults.len(), faults.join("\n"));
}
