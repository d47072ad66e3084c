//! Adjacency of the parts of a surface: the shapes of edges, the normals that a seam admits, and
//! the one-sidedness of 2D chains.

pub(crate) mod bend;
pub(crate) mod face_seams;
pub(crate) mod own_surface;
pub(crate) mod seam;
pub(crate) mod sidedness;
