//! The convex solids, one file each, with construction, scaling, support points, features and
//! boxes.

pub(crate) mod ball;
pub(crate) mod capsule;
pub(crate) mod cone;
pub(crate) mod cuboid;
pub(crate) mod cylinder;
pub(crate) mod ellipsoid;
pub(crate) mod plane;
pub(crate) mod round;
pub(crate) mod rounded;
pub(crate) mod segment;
pub(crate) mod tapered_capsule;
pub(crate) mod tetrahedron;
pub(crate) mod tetrahedron_flat;
pub(crate) mod triangle;
pub(crate) mod triangle_feature;
