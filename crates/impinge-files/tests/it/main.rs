//! Tests of the public interface of impinge-files: formats, broken files, scenes and robots.

mod broken;
mod cube;
mod formats;
mod large;
mod limits;
mod linear;
mod reports;
mod robots;
mod roots;
mod scene_errors;
mod scenes;
