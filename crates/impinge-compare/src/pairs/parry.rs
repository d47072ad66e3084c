//! parry's answers: its two crates differ in nothing but their names, and so do the modules here.

/// parry in the plane.
pub mod plane {
    use ::parry2d as parry;
    include!("parry_plane.rs");
    include!("parry_common.rs");
}

/// parry in space.
pub mod space {
    use ::parry3d as parry;
    include!("parry_space.rs");
    include!("parry_common.rs");
}
