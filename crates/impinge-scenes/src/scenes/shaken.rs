//! Objects that shake.

use super::pile::axis;
use crate::random::Random;
use crate::{Motion, Scene, SceneShape, Wave};

/// Returns the scene with each object shaking around its start. At each step an object is within
/// `reach` of its start along each axis, and is rotated by up to about `reach` radians in either
/// direction. Planes, meshes, polylines and height fields do not move.
///
/// Positions are rounded to `f32`, so that `reach` should be much larger than the spacing of `f32`
/// at the positions.
#[must_use]
pub fn shaken<const D: usize>(mut scene: Scene<D>, reach: f64) -> Scene<D> {
    let random = &mut Random::new(12);
    for object in scene.objects.iter_mut().filter(|object| !is_ground(&object.shape)) {
        object.motion = trembling(&object.motion, reach, random);
    }
    scene
}

const fn is_ground<const D: usize>(shape: &SceneShape<D>) -> bool {
    use SceneShape::{HeightField, Plane, Polyline, TriMesh};
    matches!(shape, Plane { .. } | TriMesh { .. } | Polyline { .. } | HeightField { .. })
}

fn trembling<const D: usize>(motion: &Motion<D>, reach: f64, random: &mut Random) -> Motion<D> {
    let place = motion.place.each_ref().map(|wave| hopping(wave.start, reach, random));
    // The tangent of half the angle changes by half of a small change of the angle, and by more at
    // a large angle. So the angle changes by at most `reach`.
    let tangent = hopping(motion.tangent.start, 0.5 * reach, random);
    let is_turned = motion.tangent.start != 0.0;
    let axis = if is_turned { motion.axis } else { axis::<D>(random) };
    Motion { place, axis, tangent }
}

/// Returns a wave whose speed per step is 0.4 to 1.6 times its width. Its values are a folded Weyl
/// sequence: evenly distributed between the bounds, and different for each object.
fn hopping(at: f64, reach: f64, random: &mut Random) -> Wave {
    let (low, high) = (at - reach, at + reach);
    Wave::new((low, high), at, reach * random.between(0.8, 3.2))
}
