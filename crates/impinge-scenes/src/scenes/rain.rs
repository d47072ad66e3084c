//! Solids that fall onto hilly terrain.

use super::pile::{axis, signed_speed};
use super::terrain::{Ground, solid};
use super::{MARGIN, NEAR_CONTACTS};
use crate::random::Random;
use crate::{Motion, Scene, SceneObject, Wave};

/// The distance between the lowest and the highest position of a solid.
const HEIGHT: f64 = 12.0;
/// The depth to which a solid penetrates level terrain, if it is not rotated, before it rises
/// again.
const DIP: f64 = 0.1;

/// `count` balls, boxes, capsules and convex solids of size 1, equally many of each. They fall from
/// up to 12 above a hilly mesh by 0.05 to 0.15 per step, each at its own speed, rotate, and rise
/// again from the terrain. The mesh is the first object and has 25 triangles per solid; in 2D it is
/// a polyline of 5 segments for every two solids.
///
/// At any time a few percent of the solids touch the terrain, and a few percent touch each other.
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
    // The height of the centre of the solid, without rotation, above level ground that it touches.
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
