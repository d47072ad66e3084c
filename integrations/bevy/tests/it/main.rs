//! Tests of the public interface of the plugin: apps of Bevy without windows.

mod bodies;
mod errors;
mod events;
#[cfg(feature = "gizmos")]
mod gizmos;
#[cfg(feature = "mesh")]
mod meshes;
mod order;
mod queries;
mod shapes;
mod slide;
mod support;
mod transforms;
