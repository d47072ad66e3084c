//! Tests of collision worlds: rules, events and queries, also against models.

mod contact_stream;
mod extremes_of_worlds;
mod saved_worlds;
mod world_ball_in_room;
mod world_corpus;
mod world_engines;
mod world_events;
mod world_input;
mod world_model;
mod world_queries;
mod world_rules;
mod world_substeps;
mod worlds_and_generators;
