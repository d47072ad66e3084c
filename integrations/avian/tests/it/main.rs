//! Tests of the plugin through its public interface: apps without windows.

#[path = "../../scenes/d2.rs"]
mod scenes2;
#[path = "../../scenes/d3.rs"]
mod scenes3;

mod d2;
mod d3;
