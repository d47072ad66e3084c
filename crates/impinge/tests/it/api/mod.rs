//! The public interface: chapters of the specification, messages, memory, the rules of the house.

mod allocations;
mod architecture;
mod chapter2;
mod chapter3;
mod coming_from;
mod custom_algorithms;
mod dim2;
mod dim3;
mod floors;
mod memory;
mod messages;
mod public_face;
mod values;
