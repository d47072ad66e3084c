//! Falling solids come to rest on terrain and on each other, and keep their contacts there.

use impinge_stacks::{Choices, Kind, Stack, Stage, stacks2, stacks3};

use super::{above, assert_none, played};

/// Number of steps, which take ten seconds. Energy is measured in the last two seconds, contacts in
/// the second half.
const STEPS: usize = 600;
/// Greatest kinetic energy per unit of mass: 1/10000 of the energy that lifts a solid by its size.
const AT_REST: f64 = 1e-3;
/// Greatest kinetic energy per unit of mass for capsules, which roll without resistance: 1/100 of
/// the energy that lifts a solid by its size.
const ROLLING: f64 = 0.1;

fn fall<N: Stage<D>, const D: usize>(stacks: &[Stack<D>]) {
    let mut faults = Vec::new();
    let mut count = 0;
    for stack in stacks.iter().filter(|stack| stack.kind == Kind::Fall) {
        let outcome = played::<N, D>(stack, Choices::default(), STEPS);
        let falling = stack.items.iter().filter(|item| item.density > 0.0);
        let mass: f64 = falling.clone().map(|item| N::mass_of(&item.solid).mass).sum();
        let highest = falling.map(|item| item.placement.translation[1]).fold(0.0, f64::max);
        let energy = if stack.name == "capsules in hollows" { ROLLING } else { AT_REST };
        let numbers = [
            ("energy", outcome.energy, energy * mass),
            ("fall", outcome.sunk, highest + 0.5),
            ("drift", outcome.drift, 4.0),
            ("share of new ids", outcome.counts.new_share(), 0.01),
        ];
        faults.extend(above(stack.name, numbers));
        if outcome.counts.points() < 1.0 {
            faults.push(format!("{}: nothing touches", stack.name));
        }
        count += 1;
    }
    assert!(count > 0, "some scenes fall");
    assert_none(&faults);
}

#[test]
fn in_2d() {
    fall::<f32, 2>(&stacks2());
    fall::<f64, 2>(&stacks2());
}

#[test]
fn in_3d_f32() {
    fall::<f32, 3>(&stacks3());
}

#[test]
fn in_3d_f64() {
    fall::<f64, 3>(&stacks3());
}
