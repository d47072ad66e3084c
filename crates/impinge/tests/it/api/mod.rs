//! Tests of the public interface: chapters of the specification, messages, memory, rules for the
//! sources.

mod allocations;
mod architecture;
mod chapter2;
mod chapter3;
mod coming_from;
mod custom_algorithms;
mod debug_render;
mod dim2;
mod dim3;
mod floors;
mod memory;
mod messages;
mod prose;
mod public_face;
mod values;
