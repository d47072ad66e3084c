//! The engines of `impinge-compare-c` as contenders.

use impinge_scenes::{Scene, SceneQuery};

use super::PREDICTION;
use super::contender::{Change, Contender, Reading};

/// Creates a world of Box2D; `None` if it does not support the scene.
#[cfg(feature = "box2d")]
pub fn box2d(
    scene: &Scene<2>,
    recycling: impinge_compare_c::Recycling,
) -> Option<Box<dyn Contender<2>>> {
    if !is_played(scene) {
        return None;
    }
    Some(Box::new(impinge_compare_c::Box2d::new(scene, recycling)?))
}

/// Creates a world of Box3D; `None` if it does not support the scene.
#[cfg(feature = "box3d")]
pub fn box3d(
    scene: &Scene<3>,
    recycling: impinge_compare_c::Recycling,
) -> Option<Box<dyn Contender<3>>> {
    if !is_played(scene) {
        return None;
    }
    Some(Box::new(impinge_compare_c::Box3d::new(scene, recycling)?))
}

/// Creates a world of Jolt, with edges rounded by `convex_radius`; `None` if it does not support
/// the scene.
#[cfg(feature = "jolt")]
pub fn jolt(scene: &Scene<3>, convex_radius: f32) -> Option<Box<dyn Contender<3>>> {
    if !is_played(scene) {
        return None;
    }
    Some(Box::new(impinge_compare_c::Jolt::new(scene, PREDICTION, convex_radius)?))
}

/// Returns `true` if no object of the scene is added or removed and all objects query contacts. The
/// engines run only such scenes.
fn is_played<const D: usize>(scene: &Scene<D>) -> bool {
    scene.objects.iter().all(|object| {
        object.alive == (0..u32::MAX) && matches!(object.query, SceneQuery::Contacts { .. })
    })
}

/// Implements `Contender` for an engine; all engines have methods of the same names.
macro_rules! contender {
    ($engine:ident, $feature:literal, $dimension:literal) => {
        #[cfg(feature = $feature)]
        impl Contender<$dimension> for impinge_compare_c::$engine {
            fn prepare(&mut self, change: &Change<$dimension>) {
                self.prepare(&change.moved);
            }

            fn step(&mut self) {
                self.step();
            }

            fn read(&mut self) -> Reading {
                let digest = self.read();
                Reading { points: digest.points, depth: digest.depth }
            }

            fn touching(&self) -> Vec<(usize, usize)> {
                self.touching(PREDICTION)
            }
        }
    };
}

contender!(Box2d, "box2d", 2);
contender!(Box3d, "box3d", 3);
contender!(Jolt, "jolt", 3);
