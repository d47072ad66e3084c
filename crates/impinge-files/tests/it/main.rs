//! The public interface of impinge-files: formats, broken files, scenes, robots.

mod broken;
mod cube;
mod formats;
mod large;
mod reports;
mod robots;
mod scene_errors;
mod scenes;
