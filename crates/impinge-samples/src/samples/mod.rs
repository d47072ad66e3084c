//! The samples, one to a file, by what they show.

pub(crate) mod motion;
pub(crate) mod pairs;
pub(crate) mod queries;
pub(crate) mod worlds;
