//! A world made of the tree and the manifolds of parry, with the rest as a user would write it.
//!
//! The tree is used much as in rapier: leaves are enlarged, the tree is refitted where boxes have left their fat AABBs,
//! optimized a little where many have, and lists the pairs with such a box. Pairs are in a map of parry, with manifolds
//! and the workspace that parry requires for the next call. A pair of which neither object has moved is skipped; for
//! two that moved, parry keeps the points as long as they have hardly slid. Pairs that start and stop touching are
//! listed, as our events are.
//!
//! Pairs of an object with a proximity query are tested for intersection only; a margin is not supported.

use impinge_scenes::{Placement, Scene, SceneQuery};

use super::contender::{Change, Contender, Reading};
use super::{PREDICTION, rapier};

/// parry in 2D.
pub mod plane {
    use super::rapier::plane::{DIM, builder, pose};
    use super::*;
    use ::parry2d as parry;
    include!("parry_common.rs");
}

/// parry in 3D.
pub mod space {
    use super::rapier::space::{DIM, builder, pose};
    use super::*;
    use ::parry3d as parry;
    include!("parry_common.rs");
}
