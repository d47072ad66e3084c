//! Objects that tremble.

use super::pile::axis;
use crate::random::Random;
use crate::{Motion, Scene, SceneShape, Wave};

/// The scene, each object of which trembles where it starts: each step puts it anywhere within `reach` to
/// either side along each axis, and turns it by any angle up to about `reach` in radians to either side.
/// Planes, meshes, lines and height fields stay as they are.
///
/// Positions are rounded to `f32`, so `reach` should be much more than the spacing of its numbers there.
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
    // The tangent of half the angle: twice the change for a small angle, less for a greater one.
    let tangent = hopping(motion.tangent.start, 0.5 * reach, random);
    let is_turned = motion.tangent.start != 0.0;
    let axis = if is_turned { motion.axis } else { axis::<D>(random) };
    Motion { place, axis, tangent }
}

/// A wave whose steps are about as long as it is wide. Its values are those of a Weyl sequence, folded:
/// spread evenly between the bounds, and without a pattern that two objects share.
fn hopping(at: f64, reach: f64, random: &mut Random) -> Wave {
    let (low, high) = (at - reach, at + reach);
    Wave::new((low, high), at, reach * random.between(0.8, 3.2))
}
