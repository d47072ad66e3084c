//! Contacts of parry as input of the solver, in 2D and in 3D.

use impinge::math::{Isometry2, Isometry3};
use impinge_stacks::{Body, Contact, ContactSource, PREDICTION, Solid, Stack};

use crate::world::rapier;

/// parry in 2D.
pub mod plane {
    use super::rapier::plane::{DIM, builder, pose};
    use super::*;
    use ::parry2d as parry;
    include!("parry_common.rs");

    fn pose_of(isometry: &Isometry2<f32>) -> Pose {
        let [x, y] = isometry.translation.vector.into();
        let turn = Rotation::from_cos_sin_unchecked(isometry.rotation.re, isometry.rotation.im);
        Pose::from_parts(Vector::new(x, y), turn)
    }
}

/// parry in 3D.
pub mod space {
    use super::rapier::space::{DIM, builder, pose};
    use super::*;
    use ::parry3d as parry;
    include!("parry_common.rs");

    fn pose_of(isometry: &Isometry3<f32>) -> Pose {
        let [x, y, z] = isometry.translation.vector.into();
        let [i, j, k, w] = isometry.rotation.coords.into();
        Pose::from_parts(Vector::new(x, y, z), Rotation::from_xyzw(i, j, k, w))
    }
}
