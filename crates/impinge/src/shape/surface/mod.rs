//! What holds the parts of a surface together: how its edges are bent, which normals a seam of faces has, and the
//! sides of chains.

pub(crate) mod bend;
pub(crate) mod face_seams;
pub(crate) mod own_surface;
pub(crate) mod seam;
pub(crate) mod sidedness;
