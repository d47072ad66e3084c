//! The query pipeline of rapier, and the tree of parry alone, with parry's solids or over boxes
//! only.
//!
//! The crates for 2D and 3D differ only in their names, so both modules include the same source.

use super::race::Contender;
use super::scene::{Corners, Library, Questions, Scene, Solid};
use impinge_scenes::{Placement, SceneShape};

/// parry and rapier in 2D.
pub mod plane {
    use super::*;
    use ::rapier2d as rapier;
    const DIM: usize = 2;

    fn pose(placement: &Placement<2>) -> Pose {
        let [x, y] = placement.translation.map(|x| x as f32);
        let [cosine, sine] = placement.complex().map(|x| x as f32);
        Pose::from_parts(Vector::new(x, y), Rotation::from_cos_sin_unchecked(cosine, sine))
    }

    include!("parry_common.rs");
}

/// parry and rapier in 3D.
pub mod space {
    use super::*;
    use ::rapier3d as rapier;
    const DIM: usize = 3;

    fn pose(placement: &Placement<3>) -> Pose {
        let [x, y, z] = placement.translation.map(|x| x as f32);
        let [i, j, k, w] = placement.quaternion().map(|x| x as f32);
        Pose::from_parts(Vector::new(x, y, z), Rotation::from_xyzw(i, j, k, w))
    }

    include!("parry_common.rs");
}
