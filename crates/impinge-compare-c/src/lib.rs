//! Rivals in C and C++ behind safe types, for `impinge-compare`.
//!
//! Coal answers questions about two shapes. The others are engines with dynamics, driven so that as little of it runs as can be; what each does
//! between two readings is said there. All run on the calling thread alone.

#[cfg(feature = "box2d")]
mod box2d;
#[cfg(feature = "box3d")]
mod box3d;
#[cfg(feature = "coal")]
mod coal;
#[cfg(any(feature = "box2d", feature = "box3d"))]
mod contacts;
#[cfg(feature = "jolt")]
mod jolt;

#[cfg(feature = "box2d")]
pub use box2d::Box2d;
#[cfg(feature = "box3d")]
pub use box3d::Box3d;
#[cfg(feature = "coal")]
pub use coal::{CoalPairs, CoalPose, CoalSolid};
#[cfg(feature = "jolt")]
pub use jolt::Jolt;

/// A digest of all contact points.
#[derive(Clone, Copy, Debug, Default)]
pub struct Digest {
    /// How many points there are.
    pub points: usize,
    /// The sum of their depths.
    pub depth: f64,
}

/// Whether contacts are computed anew at every step, or as the engine does by default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recycling {
    /// A contact is computed anew wherever the pair has moved.
    Off,
    /// As by default: until a pair has moved by 0.05 against one another, the points stay where they
    /// were on each object, and only their depths follow.
    On,
}

#[cfg(any(feature = "box2d", feature = "box3d", feature = "jolt"))]
/// The pairs in order, each once.
fn sorted(mut pairs: Vec<(usize, usize)>) -> Vec<(usize, usize)> {
    for pair in &mut pairs {
        *pair = (pair.0.min(pair.1), pair.0.max(pair.1));
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}
