//! Tests of bounding volumes, trees and broad phases.

mod bounding_volumes;
mod broad_phase_random;
mod broad_phase_semantics;
mod broad_phase_timing;
mod partitioning;
mod partitioning_of_boxes;
