//! Length unit of a pair of solids.

use crate::math::{Real, Vector, unit};

/// Unit of length in which the size of a pair is about 1: a power of two, so that scaling is exact.
///
/// The unit is at most the sum of both bounding radii and the distance of the origins, and more
/// than half of that sum. If the sum is zero, the unit is 4.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Units<N> {
    /// The length of one unit.
    pub(crate) scale: N,
    /// 1 / `scale`, exactly.
    pub(crate) shrink: N,
}

impl<N: Real> Units<N> {
    /// Returns the unit of two solids with the bounding radii `reach1` and `reach2`. `translation`
    /// is the vector from the origin of the first to the origin of the second.
    pub(crate) fn of<const D: usize>(reach1: N, reach2: N, translation: &Vector<N, D>) -> Self {
        // All lengths are divided by 4, because the sum of finite lengths must not overflow.
        let quarter = N::HALF * N::HALF;
        let away = unit(&(translation * quarter)).map_or(N::ZERO, |(_, length)| length);
        let size = reach1 * quarter + reach2 * quarter + away;
        let scale = if size > N::ZERO { size.power_of_two_below() } else { N::ONE };
        Self { scale: scale / quarter, shrink: quarter / scale }
    }
}
