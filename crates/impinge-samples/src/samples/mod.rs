//! The samples, one per file, by subject.

pub(crate) mod motion;
pub(crate) mod pairs;
pub(crate) mod queries;
pub(crate) mod worlds;
