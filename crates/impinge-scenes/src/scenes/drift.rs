//! Boxes that drift in random directions and are reflected at the walls of their space.

use super::pile::{axis, edge};
use super::{MARGIN, NEAR_CONTACTS};
use crate::random::Random;
use crate::{Motion, Scene, SceneObject, SceneQuery, SceneShape, Wave, rounded};

/// Boxes of half extents 0.35 to 0.65. All move by 0.01 to 0.09 per step and rotate slowly. The
/// axis-aligned box of each overlaps those of about 3 others.
#[must_use]
pub fn sparse_drift<const D: usize>(count: usize) -> Scene<D> {
    let random = &mut Random::new(2);
    let edge = edge::<D>(count, space_per_box::<D>());
    let objects = (0..count).map(|_| drifting(edge, random)).collect();
    Scene { name: "sparse drift", margin: MARGIN, objects, steps: 100 }
}

/// Returns the space per box at which the axis-aligned box of each overlaps those of 3 others on
/// average.
///
/// Two axis-aligned boxes overlap if their centres differ along each axis by at most the sum of
/// their half extents. This sum is 1 on average without rotation, and grows with the number of axes
/// of rotation. The constant 0.28 was found by counting overlaps, not derived.
fn space_per_box<const D: usize>() -> f64 {
    let width = 2.0 + 0.28 * D as f64;
    (0..D).fold(1.0 / 3.0, |space, _| space * width)
}

fn drifting<const D: usize>(edge: f64, random: &mut Random) -> SceneObject<D> {
    let speed = random.between(0.2, 1.8) * 0.05;
    let velocity = random.direction::<D>().map(|x| x * speed);
    let place = velocity.map(|v| Wave::new((0.0, edge), random.between(0.0, edge), v));
    let tangent = Wave::new((-1.0, 1.0), random.between(-1.0, 1.0), random.between(0.001, 0.01));
    let half_extents = [0.0; D].map(|_: f64| rounded(random.between(0.35, 0.65)));
    let motion = Motion { axis: axis::<D>(random), tangent, ..Motion::translation(place) };
    SceneObject::new(SceneShape::Cuboid { half_extents }, NEAR_CONTACTS, motion)
}

/// The scene of [`sparse_drift`], in which only every hundredth box moves.
#[must_use]
pub fn few_moving<const D: usize>(count: usize) -> Scene<D> {
    let mut scene = sparse_drift(count);
    freeze(&mut scene, |index| index.is_multiple_of(100));
    Scene { name: "1 % moving", ..scene }
}

/// The scene of [`sparse_drift`], in which only the first ten boxes move.
#[must_use]
pub fn ten_moving<const D: usize>(count: usize) -> Scene<D> {
    let mut scene = sparse_drift(count);
    freeze(&mut scene, |index| index < 10);
    Scene { name: "ten moving", ..scene }
}

/// Freezes the objects for whose index `moves` returns `false`.
pub(super) fn freeze<const D: usize>(scene: &mut Scene<D>, moves: impl Fn(usize) -> bool) {
    let frozen = scene.objects.iter_mut().enumerate().filter(|(index, _)| !moves(*index));
    frozen.for_each(|(_, object)| object.motion = object.motion.frozen());
}

/// The scene of [`sparse_drift`], in which every tenth object is a sensor: a ball of radius 1.5
/// with a proximity query. A sensor overlaps about seven other objects at a time.
#[must_use]
pub fn sensors<const D: usize>(count: usize) -> Scene<D> {
    let mut scene = sparse_drift(count);
    for object in scene.objects.iter_mut().step_by(10) {
        object.shape = SceneShape::Ball { radius: 1.5 };
        object.query = SceneQuery::Proximity { margin: 0.0 };
    }
    Scene { name: "sensors", ..scene }
}

/// A sparse drift in which a hundredth of the boxes is removed, and an equal number added, at each
/// step. At every step `count` boxes are alive, rounded up to a multiple of 100.
#[must_use]
pub fn spawn_and_despawn<const D: usize>(count: usize) -> Scene<D> {
    let random = &mut Random::new(3);
    let edge = edge::<D>(count, space_per_box::<D>());
    let (life, steps) = (100_u32, 100_u32);
    let churn = count.div_ceil(100);
    let mut objects = Vec::new();
    for death in 1..life + steps {
        // The boxes that are removed at steps 1 to 100 are alive from step 0. Each later box lives
        // for 100 steps.
        let alive = death.saturating_sub(life)..death;
        let born = || SceneObject { alive: alive.clone(), ..drifting::<D>(edge, random) };
        objects.extend(std::iter::repeat_with(born).take(churn));
    }
    Scene { name: "spawn and despawn", margin: MARGIN, objects, steps }
}

/// Boxes whose half extents range over four orders of magnitude, from about 0.001 to about 10, with
/// equally many in each octave. Each moves by a few percent of its own size per step.
#[must_use]
pub fn mixed_sizes<const D: usize>(count: usize) -> Scene<D> {
    let random = &mut Random::new(4);
    let edge = edge::<D>(count, space_per_mixed_box::<D>());
    let mut objects: Vec<_> = (0..count).map(|n| sized(n % OCTAVES, edge, random)).collect();
    random.shuffle(&mut objects);
    Scene { name: "mixed sizes", margin: 0.02, objects, steps: 100 }
}

const OCTAVES: usize = 14;

/// Returns the space per box. The largest boxes, a seventh of all, overlap each other and some of
/// the rest; at this density a box has a few neighbours on average.
fn space_per_mixed_box<const D: usize>() -> f64 {
    (0..D).fold(0.06, |space, _| space * 20.0)
}

fn sized<const D: usize>(octave: usize, edge: f64, random: &mut Random) -> SceneObject<D> {
    let size = (0..octave).fold(0.001, |size, _| 2.0 * size);
    let velocity = random.direction::<D>().map(|x| x * size * random.between(0.01, 0.09));
    let place = velocity.map(|v| Wave::new((0.0, edge), random.between(0.0, edge), v));
    let half_extents = [0.0; D].map(|_: f64| rounded(size * random.between(0.7, 1.4)));
    let shape = SceneShape::Cuboid { half_extents };
    SceneObject::new(shape, NEAR_CONTACTS, Motion::translation(place))
}
