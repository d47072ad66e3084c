//! Samples of worlds with many objects, and of surfaces.

pub(crate) mod broad_phase;
pub(crate) mod groups;
pub(crate) mod one_sided;
pub(crate) mod scaling;
pub(crate) mod scenery;
pub(crate) mod slide;
pub(crate) mod waves;
