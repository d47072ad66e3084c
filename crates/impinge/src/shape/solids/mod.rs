//! The convex solids, a file for each: what it is, how it is made and scaled, its support points, features and box.

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
