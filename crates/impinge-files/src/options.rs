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
    /// Returns the default options: the root is the folder of the first file, no other packages, the default limits.
    #[must_use]
    pub fn new() -> Self {
        Self::default()
    }

    /// Allows named files anywhere in this folder, instead of in the folder of the file that is read first. Paths
    /// are compared after symbolic links are resolved.
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

/// Limits of a scene, so that small files cannot request much memory. A value above a limit is the
/// error [`Problem::Limit`](crate::Problem::Limit); a value equal to it is accepted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Limits {
    /// The largest number of bytes of all files together.
    pub bytes: usize,
    /// Elements that reading may create: vertices and triangle corners of glTF meshes and of mesh
    /// shapes. glTF files also count the bytes of part names, and each index of a strip or fan as
    /// three corners. A mesh counts once for each glTF node that uses it, and once for each shape
    /// with another part, scale or kind. Files with more bytes than this may have as many elements
    /// as bytes.
    pub elements: usize,
    /// The largest number of corners of a polygon of a mesh file. Triangulation takes time
    /// proportional to the square of the number of corners.
    pub corners: usize,
    /// The largest number of objects of a scene.
    pub objects: usize,
    /// The largest number of bytes of the names of all objects. Files with more bytes than this may
    /// have as many bytes of names.
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
    /// The name of this member of [`Limits`].
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

/// Writes the kind of item that the limit counts.
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
