//! Tests in 3D.

mod bodies;
mod mass;
mod queries;
mod scenes;
mod shapes;
mod surfaces;
