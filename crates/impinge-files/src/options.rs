//! From where files are read, and how much of them.

use core::fmt;
use std::path::{Path, PathBuf};

/// How a scene and the files that it names are read.
///
/// ```
/// use impinge_files::{Limits, ReadOptions, load_with};
///
/// let limits = Limits { objects: 1_000_000, ..Limits::default() };
/// let options = ReadOptions::new().with_root("robots").with_limits(limits);
/// let error = load_with("robots/arm.urdf".as_ref(), &options).expect_err("no such file");
/// assert!(error.to_string().starts_with("robots/arm.urdf: "));
/// ```
#[derive(Clone, Debug, Default)]
pub struct ReadOptions {
    pub(crate) root: Option<PathBuf>,
    pub(crate) packages: Vec<PathBuf>,
    pub(crate) limits: Limits,
}

impl ReadOptions {
    /// The folder of the file that is read first, no packages elsewhere, the default limits.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Files that other files name may lie anywhere in this folder, instead of in the folder of the file that is
    /// read first. Symbolic links are followed before they are compared with it.
    #[must_use]
    pub fn with_root(self, folder: impl Into<PathBuf>) -> Self {
        Self { root: Some(folder.into()), ..self }
    }

    /// Adds a folder in which `package://` paths are looked for, and from which files may be read.
    #[must_use]
    pub fn with_packages(mut self, folder: impl AsRef<Path>) -> Self {
        self.packages.push(folder.as_ref().to_owned());
        self
    }

    /// Bounds what is read.
    #[must_use]
    pub fn with_limits(self, limits: Limits) -> Self {
        Self { limits, ..self }
    }
}

/// What a scene may take, so that small files do not ask for much memory. Beyond a limit reading fails with
/// [`Problem::Limit`](crate::Problem::Limit).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The bytes of all files together.
    pub bytes: usize,
    /// Vertices, and corners of triangles, of all meshes: those of a mesh that several nodes of a glTF file have,
    /// or several shapes, count for each. Files with more bytes than this may have as many as they have bytes.
    pub elements: usize,
    /// The corners of a polygon of a mesh file: cutting it into triangles takes a time that grows with their square.
    pub corners: usize,
    /// The objects of a scene.
    pub objects: usize,
    /// The bytes of the names of all objects. Files with more bytes than this may have as many.
    pub names: usize,
}

impl Default for Limits {
    /// 256 MiB of files, 4 194 304 elements, 4096 corners, 131 072 objects, 16 MiB of names.
    fn default() -> Self {
        let (bytes, elements, corners) = (1 << 28, 1 << 22, 1 << 12);
        Self { bytes, elements, corners, objects: 1 << 17, names: 1 << 24 }
    }
}

/// One of the [`Limits`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// [`Limits::bytes`].
    Bytes,
    /// [`Limits::elements`].
    Elements,
    /// [`Limits::corners`].
    Corners,
    /// [`Limits::objects`].
    Objects,
    /// [`Limits::names`].
    Names,
}

impl Limit {
    /// The name of its member of [`Limits`].
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bytes => "bytes",
            Self::Elements => "elements",
            Self::Corners => "corners",
            Self::Objects => "objects",
            Self::Names => "names",
        }
    }
}

/// What the limit counts.
impl fmt::Display for Limit {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::Bytes => "bytes of files",
            Self::Elements => "vertices and corners of triangles",
            Self::Corners => "corners of a polygon",
            Self::Objects => "objects",
            Self::Names => "bytes of names of objects",
        })
    }
}
