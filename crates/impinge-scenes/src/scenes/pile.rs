//! Boxes that touch each other.

use super::{MARGIN, NEAR_CONTACTS};
use crate::random::{Random, root};
use crate::{Motion, Scene, SceneObject, SceneQuery, SceneShape, Wave, rounded};

/// Boxes of half extents 0.55 on a grid of spacing 1, which shake and rotate slightly at every
/// step. Each overlaps all its neighbours, diagonal ones included: 8 in 2D and 26 in 3D, fewer at
/// the border. 10 000 boxes in 3D make about 117 000 touching pairs.
///
/// The shaking is at most 0.02 along each axis, and 2·atan(0.01) in angle, so that no pair ever
/// separates: a corner moves by 0.02 + 0.02 · √3 · 0.55 < 0.04 along an axis, and boxes overlap by
/// 0.1.
#[must_use]
pub fn pile<const D: usize>(count: usize) -> Scene<D> {
    let random = &mut Random::new(1);
    let side = 1 + (1_usize..).take_while(|side| side.pow(dimension::<D>()) < count).count();
    let mut objects: Vec<_> = (0..count).map(|n| shaking(cell(n, side), random)).collect();
    random.shuffle(&mut objects);
    Scene { name: "pile", margin: MARGIN, objects, steps: 100 }
}

/// The scene of [`pile`] without rotations.
#[must_use]
pub fn aligned_pile<const D: usize>(count: usize) -> Scene<D> {
    let mut scene = pile(count);
    for object in &mut scene.objects {
        object.motion = Motion::translation(object.motion.place);
    }
    Scene { name: "aligned pile", ..scene }
}

/// The scene of [`pile`] with random rotations of up to a quarter turn in either direction. Boxes
/// still overlap their neighbours along the axes, but not all diagonal neighbours.
#[must_use]
pub fn turned_pile<const D: usize>(count: usize) -> Scene<D> {
    let random = &mut Random::new(15);
    let mut scene = pile(count);
    for object in &mut scene.objects {
        let (middle, wave) = (random.between(-0.99, 0.99), &mut object.motion.tangent);
        *wave = Wave::new((middle - 0.01, middle + 0.01), middle, wave.speed);
    }
    Scene { name: "turned pile", ..scene }
}

fn dimension<const D: usize>() -> u32 {
    u32::try_from(D).expect("2 or 3")
}

/// Returns the `n`-th cell of a grid, row by row.
fn cell<const D: usize>(n: usize, side: usize) -> [f64; D] {
    let mut rest = n;
    std::array::from_fn(|_| {
        let coordinate = rest % side;
        rest /= side;
        coordinate as f64
    })
}

fn shaking<const D: usize>(at: [f64; D], random: &mut Random) -> SceneObject<D> {
    let place = at.map(|x| {
        let shift = random.between(-0.02, 0.02);
        Wave::new((x - 0.02, x + 0.02), x + shift, signed_speed(random, 0.002, 0.01))
    });
    let tangent =
        Wave::new((-0.01, 0.01), random.between(-0.01, 0.01), random.between(0.001, 0.004));
    let motion = Motion { axis: axis::<D>(random), tangent, ..Motion::translation(place) };
    let shape = SceneShape::Cuboid { half_extents: [rounded(0.55); D] };
    SceneObject::new(shape, NEAR_CONTACTS, motion)
}

/// Returns a random speed of either sign, whose magnitude is between `low` and `high`.
pub(super) fn signed_speed(random: &mut Random, low: f64, high: f64) -> f64 {
    let speed = random.between(low, high);
    if random.below(2) == 0 { speed } else { -speed }
}

/// Returns a random axis in 3D, the third axis in 2D.
pub(super) fn axis<const D: usize>(random: &mut Random) -> [f64; 3] {
    if dimension::<D>() < 3 { [0.0, 0.0, 1.0] } else { random.direction() }
}

/// Boxes of half extents 0.5 in towers of ten, at rest on a plane: each touches the box below and
/// the box above with a distance of exactly zero. The plane is the first object.
#[must_use]
pub fn tower<const D: usize>(count: usize) -> Scene<D> {
    let touch = SceneQuery::Contacts { linear: 0.0, angular: 0.0 };
    let mut normal = [0.0; D];
    normal[1] = 1.0;
    let plane = SceneObject::new(SceneShape::Plane { normal }, touch, Motion::rest([0.0; D]));
    let half_extents = [0.5; D];
    let stacked = (0..count).map(|n| {
        let mut at = [0.0; D];
        (at[0], at[1]) = (2.0 * (n / 10) as f64, 0.5 + (n % 10) as f64);
        SceneObject::new(SceneShape::Cuboid { half_extents }, touch, Motion::rest(at))
    });
    let objects = std::iter::once(plane).chain(stacked).collect();
    Scene { name: "tower", margin: MARGIN, objects, steps: 100 }
}

/// Returns the edge of a cube that contains `count` objects with the volume `space` for each.
pub(super) fn edge<const D: usize>(count: usize, space: f64) -> f64 {
    root::<D>(count as f64 * space)
}
