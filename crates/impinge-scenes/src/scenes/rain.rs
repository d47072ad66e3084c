//! Solids that fall on hilly ground.

use super::pile::{axis, signed_speed};
use super::terrain::{Ground, solid};
use super::{MARGIN, NEAR_CONTACTS};
use crate::random::Random;
use crate::{Motion, Scene, SceneObject, Wave};

/// From how high above the ground solids fall.
const HEIGHT: f64 = 12.0;
/// How far a solid dips into the ground before it goes up again.
const DIP: f64 = 0.1;

/// `count` balls, boxes, capsules and convex solids of size 1, as many of each, that fall from up to 12
/// above a hilly ground of triangles by 0.05 to 0.15 per step, turning, each at its own speed, and go
/// up again from the ground. The ground is the first object and has 25 triangles for each; in the plane
/// it is a line of 5 segments for every two.
///
/// At any time a few percent of them touch the ground, and as many one another.
#[must_use]
pub fn rain<const D: usize>(count: usize) -> Scene<D> {
    let random = &mut Random::new(11);
    let ground = Ground::<D>::new(count.div_ceil(4), random);
    let mesh = SceneObject::new(ground.mesh(), NEAR_CONTACTS, Motion::rest([0.0; D]));
    let drops = (0..count).map(|n| falling(n % 4, &ground, random));
    let objects = std::iter::once(mesh).chain(drops).collect();
    Scene { name: "rain", margin: MARGIN, objects, steps: 100 }
}

fn falling<const D: usize>(kind: usize, ground: &Ground<D>, random: &mut Random) -> SceneObject<D> {
    let shape = solid(kind, random);
    let at = ground.somewhere(random);
    // The height of the centre at which the solid, as it is not turned, is as deep as it goes.
    let resting = shape.aabb(&crate::Placement::at(at)).map_or(0.0, |(low, _)| at[1] - low[1]);
    let lowest = at[1] + resting - DIP;
    let place = std::array::from_fn(|i| {
        if i == 1 {
            let start = lowest + random.between(0.0, HEIGHT);
            Wave::new((lowest, lowest + HEIGHT), start, -random.between(0.05, 0.15))
        } else {
            Wave::new((at[i] - 0.5, at[i] + 0.5), at[i], signed_speed(random, 0.0, 0.01))
        }
    });
    let tangent = Wave::new((-0.5, 0.5), random.between(-0.5, 0.5), random.between(0.002, 0.02));
    SceneObject::new(shape, NEAR_CONTACTS, Motion { place, axis: axis::<D>(random), tangent })
}
