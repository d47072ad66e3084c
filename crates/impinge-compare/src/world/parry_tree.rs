//! parry's tree and parry's manifolds, and what one writes oneself to have a world of them.
//!
//! The tree is driven much as rapier drives it: leaves are loosened, the tree is refitted where boxes have
//! left theirs, improved a little where many have, and lists the pairs of which one box did. Pairs are in parry's map, with
//! manifolds and workspace, which parry wants back the next time. A pair of which neither object has moved
//! is left as it is; of two that moved, parry keeps the points as long as they have hardly slid. Pairs that
//! begin and end to touch are listed, as our events are.
//!
//! An object that asks for proximity has its pairs asked for intersection alone; its margin is not to be
//! had.

use impinge_scenes::{Placement, Scene, SceneQuery};

use super::contender::{Change, Contender, Reading};
use super::{PREDICTION, rapier};

/// parry in the plane.
pub mod plane {
    use super::rapier::plane::{DIM, builder, pose};
    use super::*;
    use ::parry2d as parry;
    include!("parry_common.rs");
}

/// parry in space.
pub mod space {
    use super::rapier::space::{DIM, builder, pose};
    use super::*;
    use ::parry3d as parry;
    include!("parry_common.rs");
}
