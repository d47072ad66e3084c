//! Options for reading files: root folders and limits.

use core::fmt;
use std::path::{Path, PathBuf};

/// Options for reading a scene and the files that it names.
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
    /// Creates the default options: no package folders, the default limits, and as the root the
    /// folder of the file that is read first. For a URDF file in a ROS package, the root is the
    /// folder of the package.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Sets the root: named files may lie anywhere in this folder, instead of in the folder of the
    /// file that is read first. Paths are compared after symbolic links are resolved.
    #[must_use]
    pub fn with_root(self, folder: impl Into<PathBuf>) -> Self {
        Self { root: Some(folder.into()), ..self }
    }

    /// Adds a folder in which `package://` paths are searched, and from which files may be read.
    #[must_use]
    pub fn with_packages(mut self, folder: impl AsRef<Path>) -> Self {
        self.packages.push(folder.as_ref().to_owned());
        self
    }

    /// Sets the limits.
    #[must_use]
    pub fn with_limits(self, limits: Limits) -> Self {
        Self { limits, ..self }
    }
}

/// Limits of a scene, so that small files cannot make the reader allocate much memory. A value
/// above a limit is the error [`Problem::Limit`](crate::Problem::Limit); a value equal to it is
/// accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The maximum total size of all files, in bytes.
    pub bytes: usize,
    /// The maximum number of elements that reading may create: vertices and triangle corners of
    /// glTF meshes and of mesh shapes. glTF files also count the bytes of part names, and three
    /// corners for each index of a strip or fan. A mesh counts once for each glTF node that uses
    /// it, and once for each shape with a different part, scale or kind. If the files have more
    /// bytes than this limit, the limit is their number of bytes.
    pub elements: usize,
    /// The maximum number of corners of a polygon of a mesh file. Triangulation may take time
    /// proportional to the square of the number of corners.
    pub corners: usize,
    /// The maximum number of objects of a scene.
    pub objects: usize,
    /// The maximum total size of the names of all objects, in bytes. If the files have more bytes
    /// than this limit, the limit is their number of bytes.
    pub names: usize,
}

impl Default for Limits {
    /// Returns 256 MiB of files, 4 194 304 elements, 4096 corners, 131 072 objects, and 16 MiB of
    /// names.
    fn default() -> Self {
        let (bytes, elements, corners) = (1 << 28, 1 << 22, 1 << 12);
        Self { bytes, elements, corners, objects: 1 << 17, names: 1 << 24 }
    }
}

/// The name of a limit: a field of [`Limits`].
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Limit {
    /// The limit [`Limits::bytes`].
    Bytes,
    /// The limit [`Limits::elements`].
    Elements,
    /// The limit [`Limits::corners`].
    Corners,
    /// The limit [`Limits::objects`].
    Objects,
    /// The limit [`Limits::names`].
    Names,
}

impl Limit {
    /// Returns the name of the field of [`Limits`].
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

/// Writes the kind of item that the limit counts, in the plural.
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
