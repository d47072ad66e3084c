//! Tests of pictures of known scenes: computed silhouettes, well-formed documents, golden images.
#![forbid(unsafe_code)]

mod gallery;
mod goldens;
mod robust;
mod rounded;
mod scenes;
mod silhouettes;
mod svg;
mod texts;
