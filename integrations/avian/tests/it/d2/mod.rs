//! Tests in 2D.

mod bodies;
mod scenes;
mod shapes;
mod surfaces;
