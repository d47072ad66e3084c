//! The contender parry. Its four crates (2D and 3D, `f32` and `f64`) differ only in their names. So
//! each module here includes the same source with the names of one crate.

use super::form::{Form, Outcome, Placement, Sample};

/// parry in 2D, in `f32`.
pub mod plane32 {
    use ::parry2d as parry;
    type Real = f32;
    include!("parry_plane.rs");
    include!("parry_common.rs");
}

/// parry in 2D, in `f64`.
pub mod plane64 {
    use ::parry2d_f64 as parry;
    type Real = f64;
    include!("parry_plane.rs");
    include!("parry_common.rs");
}

/// parry in 3D, in `f32`.
pub mod space32 {
    use ::parry3d as parry;
    type Real = f32;
    include!("parry_space.rs");
    include!("parry_common.rs");
}

/// parry in 3D, in `f64`.
pub mod space64 {
    use ::parry3d_f64 as parry;
    type Real = f64;
    include!("parry_space.rs");
    include!("parry_common.rs");
}
