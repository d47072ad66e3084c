//! rapier's `CollisionPipeline`: its two crates differ in their names and some constructors only, and so do
//! the modules here.
//!
//! Set up as in the tests of that pipeline: colliders without bodies, which cost less than kinematic ones,
//! all collision types active (colliders without bodies are fixed, and fixed ones would ignore each other),
//! the workspace kept between steps, no hooks and no events. Its boxes are enlarged by 0.04, as those of the
//! scenes are.

use impinge_scenes::{Placement, Scene, SceneQuery, SceneShape};

use super::PREDICTION;
use super::contender::{Change, Contender, Reading};

/// rapier in 2D.
pub mod plane {
    use super::*;
    use ::rapier2d::prelude::*;
    include!("rapier_plane.rs");
    include!("rapier_common.rs");
}

/// rapier in 3D.
pub mod space {
    use super::*;
    use ::rapier3d::prelude::*;
    include!("rapier_space.rs");
    include!("rapier_common.rs");
}
