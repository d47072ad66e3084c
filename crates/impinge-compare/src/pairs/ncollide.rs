//! The contender ncollide. Its crates for 2D and 3D differ only in their names, so both modules
//! include the same source. ncollide has no intersection test; its proximity query with a margin of
//! zero is used instead.

/// ncollide in 2D.
pub mod plane {
    use ::ncollide2d as ncollide;
    include!("ncollide_plane.rs");
    include!("ncollide_common.rs");
}

/// ncollide in 3D.
pub mod space {
    use ::ncollide3d as ncollide;
    include!("ncollide_space.rs");
    include!("ncollide_common.rs");
}
