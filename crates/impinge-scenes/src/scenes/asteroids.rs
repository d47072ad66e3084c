//! Asteroids: convex solids that are mostly far from each other.

use super::drift::freeze;
use super::pile::{axis, edge};
use super::{MARGIN, NEAR_CONTACTS};
use crate::random::Random;
use crate::{Motion, Scene, SceneObject, SceneShape, Wave, rounded};

/// Convex solids of 12 to 19 points and of radii from 0.4 to 2, most of them small. They move by
/// 0.005 to 0.03 per step, rotate slowly and are reflected at the walls of their space. The box of
/// about every third solid overlaps that of another.
#[must_use]
pub fn asteroids<const D: usize>(count: usize) -> Scene<D> {
    let random = &mut Random::new(9);
    let edge = edge::<D>(count, (0..D).fold(1.0, |space, _| space * SPACING));
    let objects = (0..count).map(|_| floating(edge, random)).collect();
    Scene { name: "asteroids", margin: MARGIN, objects, steps: 100 }
}

/// The scene of [`asteroids`], in which only every hundredth asteroid moves.
#[must_use]
pub fn few_asteroids_moving<const D: usize>(count: usize) -> Scene<D> {
    let mut scene = asteroids(count);
    freeze(&mut scene, |index| index.is_multiple_of(100));
    Scene { name: "1 % of asteroids moving", ..scene }
}

/// The edge of a cube with the volume per asteroid: about 6.4 times the mean radius.
const SPACING: f64 = 6.0;

fn floating<const D: usize>(edge: f64, random: &mut Random) -> SceneObject<D> {
    // Squaring makes small radii more frequent.
    let share = random.unit();
    let radius = 0.4 + 1.6 * share * share;
    let speed = random.between(0.005, 0.03);
    let velocity = random.direction::<D>().map(|x| x * speed);
    let place = velocity.map(|v| Wave::new((0.0, edge), random.between(0.0, edge), v));
    let tangent = Wave::new((-1.0, 1.0), random.between(-1.0, 1.0), random.between(0.001, 0.01));
    let motion = Motion { axis: axis::<D>(random), tangent, ..Motion::translation(place) };
    let count = 12 + random.below(8);
    let shape = SceneShape::Convex { points: rock(count, radius, random) };
    SceneObject::new(shape, NEAR_CONTACTS, motion)
}

/// Returns the points of an asteroid: the tips of a cross along the axes, so that all dimensions
/// are spanned, and random points. Each is at 0.7 to 1 times the radius from the origin.
pub(super) fn rock<const D: usize>(
    count: usize,
    radius: f64,
    random: &mut Random,
) -> Vec<[f64; D]> {
    let points = (0..count).map(|n| {
        let distance = radius * random.between(0.7, 1.0);
        let direction = if n < 2 * D { tip(n) } else { random.direction() };
        direction.map(|x| rounded(x * distance))
    });
    points.collect()
}

/// Returns the `n`-th of the unit vectors along the axes, in the order +x, −x, +y and so on.
fn tip<const D: usize>(n: usize) -> [f64; D] {
    let mut tip = [0.0; D];
    tip[n / 2] = if n.is_multiple_of(2) { 1.0 } else { -1.0 };
    tip
}
