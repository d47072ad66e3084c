//! In what a replay differs from its recording.

/// In what a replay first differs from its recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Divergence {
    /// The number of updates before the call that differs.
    pub step: usize,
    /// The offset of its record in bytes.
    pub offset: usize,
    /// What differs.
    pub difference: Difference,
}

/// What differs between a replay and its recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Difference {
    /// An object after an update: the first in order of the handles.
    Object {
        /// The index of its handle.
        index: usize,
        /// What of it.
        field: ObjectField,
    },
    /// The state after an update. The recording has no hashes of objects, since it was packed, or they all agree,
    /// since they have 32 bits only.
    State,
    /// The events of an update.
    Events,
    /// The answer of a query.
    Answer,
}

/// What of an object differs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObjectField {
    /// Its position, groups or query type.
    Description,
    /// The pairs in which it is the first, their contacts and proximities.
    Pairs,
}
