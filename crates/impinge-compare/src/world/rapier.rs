//! The contender rapier, with its `CollisionPipeline`. Its crates for 2D and 3D differ only in
//! their names and some constructors, so both modules include the same source.
//!
//! It is set up as in the tests of that pipeline. Colliders have no bodies, which costs less than
//! kinematic bodies. All collision types are active: colliders without bodies are fixed, and fixed
//! ones would ignore each other. The workspace is kept between steps; there are no hooks and no
//! events. Boxes are enlarged by 0.04, as in the scenes.

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
