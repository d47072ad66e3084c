//! Collision detection for the plane and for space.
