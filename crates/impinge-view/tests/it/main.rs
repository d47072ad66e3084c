//! Pictures of known scenes: silhouettes by arithmetic, documents that parse, golden images.
#![forbid(unsafe_code)]

mod gallery;
mod goldens;
mod robust;
mod rounded;
mod scenes;
mod silhouettes;
mod svg;
mod texts;
