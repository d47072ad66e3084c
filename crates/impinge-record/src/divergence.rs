//! Differences between a replay and its recording.

/// The first difference between a replay and its recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Divergence {
    /// The number of updates before the call whose result differs.
    pub step: usize,
    /// The offset of the record of this call, in bytes.
    pub offset: usize,
    /// The kind of difference.
    pub difference: Difference,
}

/// The kinds of difference between a replay and its recording.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Difference {
    /// An object differs after an update: the first such object in the order of handles.
    Object {
        /// The index of the object's handle.
        index: usize,
        /// The field of the object.
        field: ObjectField,
    },
    /// The state after an update differs, but no single object is known to differ. Either the
    /// recording was packed and has no hashes of objects, or all 32-bit hashes of objects agree by
    /// chance.
    State,
    /// The events of an update differ.
    Events,
    /// The result of a query differs.
    Answer,
}

/// A field of an object.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ObjectField {
    /// The state that calls have set: position, groups, query type, fixed flag, skin and predicted
    /// position.
    Description,
    /// The contacts and proximities of the pairs in which it is the first object.
    Pairs,
}
