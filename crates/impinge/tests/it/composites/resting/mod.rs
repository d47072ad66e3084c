//! Solids and meshes as people place them: parallel to each other, flush, slightly tilted or sunk, at
//! grid lines, borders and corners.

mod beside_borders;
mod boxes_on_a_grid;
mod meshes_on_surfaces;
mod valleys;
mod walls_on_joints;
