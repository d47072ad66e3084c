//! The dynamic tree of ncollide, over boxes only.
//!
//! Its crates for 2D and 3D differ only in their names, so both modules include the same source.

use super::race::Contender;
use super::scene::{Corners, Library, Questions, Scene};

/// ncollide in 2D.
pub mod plane {
    use super::*;
    use ::ncollide2d as ncollide;
    const DIM: usize = 2;
    include!("ncollide_common.rs");
}

/// ncollide in 3D.
pub mod space {
    use super::*;
    use ::ncollide3d as ncollide;
    const DIM: usize = 3;
    include!("ncollide_common.rs");
}
