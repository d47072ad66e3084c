//! ncollide's dynamic tree over nothing but boxes.
//!
//! The crates for the plane and for space differ in nothing but their names, and so do the modules here.

use super::race::Contender;
use super::scene::{Corners, Library, Questions, Scene};

/// In the plane.
pub mod plane {
    use super::*;
    use ::ncollide2d as ncollide;
    const DIM: usize = 2;
    include!("ncollide_common.rs");
}

/// In space.
pub mod space {
    use super::*;
    use ::ncollide3d as ncollide;
    const DIM: usize = 3;
    include!("ncollide_common.rs");
}
