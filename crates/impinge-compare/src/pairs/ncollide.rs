//! Results of ncollide: its two crates differ in their names only, and so do the modules here. It
//! has no intersection test: its proximity is computed with a margin of zero.

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
