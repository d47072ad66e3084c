//! The dynamic tree of ncollide over boxes only.
//!
//! The crates for 2D and 3D differ in their names only, and so do the modules here.

use super::race::Contender;
use super::scene::{Corners, Library, Questions, Scene};

/// 2D.
pub mod plane {
    use super::*;
    use ::ncollide2d as ncollide;
    const DIM: usize = 2;
    include!("ncollide_common.rs");
}

/// 3D.
pub mod space {
    use super::*;
    use ::ncollide3d as ncollide;
    const DIM: usize = 3;
    include!("ncollide_common.rs");
}
