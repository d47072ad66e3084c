//! The tests of this folder in 2D.

use impinge::dim2 as dim;

#[path = "brute_force.rs"]
mod brute_force;
#[path = "detectors.rs"]
mod detectors;
#[path = "generators.rs"]
mod generators;
#[path = "own_shapes.rs"]
mod own_shapes;
#[path = "plain_narrow_phase.rs"]
mod plain_narrow_phase;
#[path = "standalone.rs"]
mod standalone;
#[path = "twins.rs"]
mod twins;
