//! A world made of parry's tree and manifolds; the rest is written as a user of parry would do it.
//!
//! The tree is used much as in rapier. Leaves are enlarged. The tree is refitted where boxes have
//! left their fat AABBs, optimized incrementally if many have, and lists the pairs with such a box.
//! Pairs are in a hash map of parry, with the manifolds and the workspace that parry requires for
//! the next call. A pair of which neither object has moved is skipped; for the others parry keeps
//! the points as long as they have hardly slid. Pairs that start or stop touching are listed, as
//! events of impinge are.
//!
//! Pairs with a proximity query are tested for intersection only; a margin is not supported.

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
