//! The contender parry. Its crates for 2D and 3D differ only in their names, so both modules
//! include the same source.

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
