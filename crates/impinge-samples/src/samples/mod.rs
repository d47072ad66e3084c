//! The samples by subject, one in each file.

pub(crate) mod motion;
pub(crate) mod pairs;
pub(crate) mod queries;
pub(crate) mod worlds;
