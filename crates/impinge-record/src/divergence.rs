//! Differences between a replay and its recording.

/// The first difference between a replay and its recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Divergence {
    /// The number of updates before the call that differs.
    pub step: usize,
    /// The offset of the record of that call in bytes.
    pub offset: usize,
    /// The kind of difference.
    pub difference: Difference,
}

/// The kinds of differences between a replay and its recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Difference {
    /// An object after an update: the first by handle.
    Object {
        /// The index of its handle.
        index: usize,
        /// The field of the object.
        field: ObjectField,
    },
    /// The state after an update. The recording has no hashes of objects, since it was packed, or they all agree,
    /// since they have only 32 bits.
    State,
    /// The events of an update.
    Events,
    /// The result of a query.
    Answer,
}

/// A field of an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObjectField {
    /// Its position, groups or query type.
    Description,
    /// The pairs in which it is the first object, their contacts and proximities.
    Pairs,
}
