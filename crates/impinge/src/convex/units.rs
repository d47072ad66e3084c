//! A unit of length for two solids.

use crate::math::{Real, Vector, unit};

/// A unit of length in which a pair is about 1 large: a power of two, so that scaling is exact.
///
/// It is at most the sum of both reaches and of the distance of the origins, and more than half of
/// it.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Units<N> {
    /// The length of one unit.
    pub(crate) scale: N,
    /// 1 / `scale`, exactly.
    pub(crate) shrink: N,
}

impl<N: Real> Units<N> {
    /// Returns the unit of two solids with these reaches, the second at `translation`.
    pub(crate) fn of<const D: usize>(reach1: N, reach2: N, translation: &Vector<N, D>) -> Self {
        // A quarter of everything: the sum of finite lengths must not overflow.
        let quarter = N::HALF * N::HALF;
        let away = unit(&(translation * quarter)).map_or(N::ZERO, |(_, length)| length);
        let size = reach1 * quarter + reach2 * quarter + away;
        let scale = if size > N::ZERO { size.power_of_two_below() } else { N::ONE };
        Self { scale: scale / quarter, shrink: quarter / scale }
    }
}
