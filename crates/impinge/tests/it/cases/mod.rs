//! Regression tests: inputs for which this or another library once gave wrong results.

mod angular_prediction;
mod boxes_without_numbers;
mod children_beside_meshes;
mod flat_cones;
mod flat_outlines;
mod height_fields;
mod leaning_cylinders;
mod manifolds;
mod overlooked_overlap;
mod strips_far_from_origin;
mod sweeps;
mod touching;
