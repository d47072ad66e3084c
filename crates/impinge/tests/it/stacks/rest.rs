//! Solids at rest stay at their positions and keep their contacts.

use impinge_stacks::{Choices, Kind, Outcome, Stack, Stage, stacks2, stacks3};

use super::{above, assert_none, played};

/// Number of steps, which take five seconds. Energy is measured in the last two seconds, contacts
/// in the second half.
const STEPS: usize = 300;
/// Greatest kinetic energy per unit of mass: 1/10000 of the energy that lifts a solid by its size,
/// since high stacks still sway.
const ENERGY: f64 = 1e-3;
/// Greatest drift: a tenth of the size of a solid.
const DRIFT: f64 = 0.1;
/// Greatest sinking: the solver leaves an overlap of 0.005 per contact, so 0.05 in a stack of ten,
/// plus a margin.
const SINKING: f64 = 0.06;
/// Greatest share of contacts with new ids, and of contacts that lost their ids or jumped.
const NEW: f64 = 0.005;

fn faults<const D: usize>(stack: &Stack<D>, outcome: &Outcome, mass: f64) -> Vec<String> {
    let Outcome { energy, drift, sunk, counts, parted, .. } = *outcome;
    let mut faults = above(
        stack.name,
        [
            ("energy", energy, ENERGY * mass),
            ("drift", drift, DRIFT),
            ("sinking", sunk, SINKING),
            ("share of new ids", counts.new_share(), NEW),
            ("share of lost ids", counts.lost_share(), NEW),
            ("share of jumps", counts.jump_share(), NEW),
            ("pairs that parted", parted as f64, 0.0),
        ],
    );
    if counts.contacts == 0 {
        faults.push(format!("{}: nothing touches", stack.name));
    }
    faults
}

fn rest<N: Stage<D>, const D: usize>(stacks: &[Stack<D>], choices: Choices) {
    let standing = stacks.iter().filter(|stack| stack.kind == Kind::Rest);
    let faults = standing.flat_map(|stack| {
        let masses = stack.items.iter().filter(|item| item.density > 0.0);
        let mass = masses.map(|item| item.density * N::mass_of(&item.solid).mass).sum();
        faults(stack, &played::<N, D>(stack, choices, STEPS), mass)
    });
    assert_none(&faults.collect::<Vec<_>>());
}

/// Returns every second scene, for choices other than the defaults.
fn some<const D: usize>(stacks: Vec<Stack<D>>) -> Vec<Stack<D>> {
    stacks.into_iter().step_by(2).collect()
}

#[test]
fn in_2d_f32() {
    rest::<f32, 2>(&stacks2(), Choices::default());
}

#[test]
fn in_2d_f64() {
    rest::<f64, 2>(&stacks2(), Choices::default());
}

#[test]
fn in_3d_f32() {
    rest::<f32, 3>(&stacks3(), Choices::default());
}

#[test]
fn in_3d_f64() {
    rest::<f64, 3>(&stacks3(), Choices::default());
}

#[test]
fn with_more_points() {
    let choices = Choices { max_points: Some(16), ..Choices::default() };
    rest::<f32, 2>(&some(stacks2()), choices);
    rest::<f32, 3>(&some(stacks3()), choices);
}

#[test]
fn where_pairs_keep_their_contacts() {
    let choices = Choices { reuse: Some(0.002), ..Choices::default() };
    rest::<f32, 2>(&some(stacks2()), choices);
    rest::<f32, 3>(&some(stacks3()), choices);
}
