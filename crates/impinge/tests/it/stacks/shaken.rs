//! Two solids that rest on each other keep the ids and the positions of their contacts under small
//! random displacements.

use impinge_stacks::{Choices, Impinge, Stack, Stage, pairs2, pairs3, shake};

use super::{above, assert_none};

/// Number of random displacements of a solid.
const STEPS: usize = 250;

fn shaken<N: Stage<D>, const D: usize>(pairs: &[Stack<D>], choices: Choices) {
    let mut faults = Vec::new();
    for pair in pairs {
        for way in [1e-5, 1e-4, 1e-3] {
            let counts = shake(pair, &mut Impinge::<N, D>::new(pair, choices), way, STEPS);
            let numbers = [
                ("share of new ids", counts.new_share(), 0.005),
                ("share of lost ids", counts.lost_share(), 0.005),
                ("share of jumps", counts.jump_share(), 0.01),
                ("pairs that parted", counts.parted as f64, 0.0),
            ];
            faults.extend(above(&format!("{} shaken by {way:.0e}", pair.name), numbers));
            assert!(counts.contacts >= STEPS, "{} touches all along", pair.name);
        }
    }
    assert_none(&faults);
}

#[test]
fn in_2d() {
    shaken::<f32, 2>(&pairs2(), Choices::default());
    shaken::<f64, 2>(&pairs2(), Choices::default());
}

#[test]
fn in_3d_f32() {
    shaken::<f32, 3>(&pairs3(), Choices::default());
}

#[test]
fn in_3d_f64() {
    shaken::<f64, 3>(&pairs3(), Choices::default());
}

#[test]
fn with_more_points() {
    let choices = Choices { max_points: Some(16), ..Choices::default() };
    shaken::<f32, 2>(&pairs2(), choices);
    shaken::<f32, 3>(&pairs3(), choices);
}

#[test]
fn where_pairs_keep_their_contacts() {
    let choices = Choices { reuse: Some(0.002), ..Choices::default() };
    shaken::<f32, 2>(&pairs2(), choices);
    shaken::<f32, 3>(&pairs3(), choices);
}
