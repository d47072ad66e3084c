//! A crowd of people, seen from above.

use super::pile::{edge, signed_speed};
use super::{MARGIN, NEAR_CONTACTS};
use crate::random::Random;
use crate::{Motion, Scene, SceneObject, SceneShape, Wave};

/// Capsules 0.9 wide and 0.4 deep, with an area of 1.2 for each, in two opposite streams. All walk
/// by 0.02 to 0.04 per step along the first axis, with their shoulders across it, sway, and are
/// reflected at the walls. The axis-aligned box of a person overlaps those of one to three others
/// on average.
#[must_use]
pub fn crowd(count: usize) -> Scene<2> {
    let random = &mut Random::new(10);
    let edge = edge::<2>(count, 1.2);
    let objects = (0..count).map(|_| walking(edge, random)).collect();
    Scene { name: "crowd", margin: MARGIN, objects, steps: 100 }
}

fn walking(edge: f64, random: &mut Random) -> SceneObject<2> {
    let velocity = [signed_speed(random, 0.02, 0.04), signed_speed(random, 0.0, 0.005)];
    let place = velocity.map(|v| Wave::new((0.0, edge), random.between(0.0, edge), v));
    let tangent = Wave::new((-0.1, 0.1), random.between(-0.1, 0.1), random.between(0.002, 0.01));
    let shape = SceneShape::Capsule { half_height: 0.25, radius: crate::rounded(0.2) };
    SceneObject::new(shape, NEAR_CONTACTS, Motion { tangent, ..Motion::translation(place) })
}
