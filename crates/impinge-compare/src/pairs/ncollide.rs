//! ncollide's answers: its two crates differ in nothing but their names, and so do the modules here.
//! It has no intersection test of its own: its proximity is asked with a margin of zero.

/// ncollide in the plane.
pub mod plane {
    use ::ncollide2d as ncollide;
    include!("ncollide_plane.rs");
    include!("ncollide_common.rs");
}

/// ncollide in space.
pub mod space {
    use ::ncollide3d as ncollide;
    include!("ncollide_space.rs");
    include!("ncollide_common.rs");
}
