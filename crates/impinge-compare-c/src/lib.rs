//! Rivals in C and C++ behind safe types, for `impinge-compare`.
//!
//! Coal runs queries for pairs of shapes. The others are engines with dynamics, used so that as
//! little as possible of the dynamics runs; the documentation of each type describes the work that
//! remains in a step. All of them run only on the calling thread.

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
    /// The number of points.
    pub points: usize,
    /// The sum of their depths.
    pub depth: f64,
}

/// Whether contacts are recomputed at every step, or recycled as the engine does by default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Recycling {
    /// A contact is recomputed whenever the pair has moved.
    Off,
    /// The default of the engine: until the objects of a pair have moved by 0.05 relative to each
    /// other, the points stay fixed on each object, and only their depths change.
    On,
}

#[cfg(any(feature = "box2d", feature = "box3d", feature = "jolt"))]
/// Returns the pairs sorted and without duplicates, the smaller index of each first.
fn sorted(mut pairs: Vec<(usize, usize)>) -> Vec<(usize, usize)> {
    for pair in &mut pairs {
        *pair = (pair.0.min(pair.1), pair.0.max(pair.1));
    }
    pairs.sort_unstable();
    pairs.dedup();
    pairs
}
