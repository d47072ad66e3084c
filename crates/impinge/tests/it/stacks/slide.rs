//! Solids that slide without friction over thousands of triangles move as on a plane, and keep
//! their contacts.

use impinge_stacks::{Choices, Kind, Stack, Stage, stacks2, stacks3};

use super::{above, assert_none, played};

/// Number of steps, which take ten seconds. At five units per second a solid passes a hundred
/// cells.
const STEPS: usize = 600;
/// Greatest change of velocity: a thousandth of the speed, so bumps and braking are detected.
const BUMP: f64 = 5e-3;
/// Greatest fraction of contacts with new ids: one in 500 over the whole run.
const NEW: f64 = 0.002;

fn slide<N: Stage<D>, const D: usize>(stacks: &[Stack<D>]) {
    let mut faults = Vec::new();
    let mut count = 0;
    for stack in stacks.iter().filter(|stack| stack.kind == Kind::Slide) {
        let outcome = played::<N, D>(stack, Choices::default(), STEPS);
        let counts = outcome.counts;
        let numbers = [
            ("change of velocity", outcome.max_speed, BUMP),
            ("drift", outcome.drift, 0.01),
            ("sinking", outcome.sunk, 0.01),
            ("share of new ids", counts.new_share(), NEW),
            ("share of lost ids", counts.lost_share(), NEW),
            ("pairs that parted", outcome.parted as f64, 0.0),
        ];
        faults.extend(above(stack.name, numbers));
        if counts.contacts < STEPS - 1 {
            faults.push(format!("{}: {} contacts in all", stack.name, counts.contacts));
        }
        count += 1;
    }
    assert!(count > 0, "some scenes slide");
    assert_none(&faults);
}

#[test]
fn in_2d() {
    slide::<f32, 2>(&stacks2());
    slide::<f64, 2>(&stacks2());
}

#[test]
fn in_3d_f32() {
    slide::<f32, 3>(&stacks3());
}

#[test]
fn in_3d_f64() {
    slide::<f64, 3>(&stacks3());
}
