//! How near two solids are, in three words.

/// Whether two solids touch, are near, or are neither.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub enum Proximity {
    /// They touch or penetrate: their distance is zero.
    Intersecting,
    /// They are apart, by the margin at most.
    WithinMargin,
    /// They are farther apart than the margin.
    Disjoint,
}
