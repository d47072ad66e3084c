//! Results of parry: its two crates differ in their names only, and so do the modules here.

/// parry in 2D.
pub mod plane {
    use ::parry2d as parry;
    include!("parry_plane.rs");
    include!("parry_common.rs");
}

/// parry in 3D.
pub mod space {
    use ::parry3d as parry;
    include!("parry_space.rs");
    include!("parry_common.rs");
}
