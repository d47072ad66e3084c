//! Results of parry: its four crates differ in their names only, and so do the modules here.

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
