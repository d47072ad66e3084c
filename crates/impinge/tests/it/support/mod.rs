//! Helpers that several tests share.

pub(crate) mod broad_phase_model;
pub(crate) mod composite_support;
pub(crate) mod growth;
pub(crate) mod part_search;
pub(crate) mod query_support;
pub(crate) mod samples;
pub(crate) mod scene_stage;
pub(crate) mod shape_table;
pub(crate) mod slides;
pub(crate) mod solids;
#[macro_use]
pub(crate) mod world_stage;
