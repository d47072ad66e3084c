//! Two solids and how one lies to the other: what every pair algorithm is given.

use crate::math::{Pose, Real};
use crate::shape::Kind;

/// Two solids, the first at the origin of the frame that the answer is given in.
///
/// The kinds are in the fixed order of [`crate::shape::ShapeKind`]: `first ≤ second`.
#[derive(Clone, Copy)]
pub(crate) struct Pair<'a, N: Real, const D: usize> {
    pub(crate) first: Kind<'a, N, D>,
    pub(crate) second: Kind<'a, N, D>,
    /// The pose of the second solid in the frame of the first.
    pub(crate) pose12: Pose<N, D>,
}
