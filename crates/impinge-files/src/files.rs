//! Reads regular files from the permitted folders of a scene, within its limits.

use std::fs::{self, File};
use std::io::Read as _;
use std::path::{Component, Path, PathBuf};

use crate::{FileError, Limit, Limits, Problem, ReadOptions};

/// The file that marks a folder as a ROS package.
const MANIFEST: &str = "package.xml";

/// Reads the files of one scene, and counts their bytes and elements against the limits.
#[derive(Clone, Debug)]
pub(crate) struct Files {
    roots: Vec<Root>,
    /// The absolute path of the file that the caller names; it may lie outside all roots.
    first: Option<PathBuf>,
    pub(crate) packages: Vec<PathBuf>,
    pub(crate) limits: Limits,
    /// The number of bytes read so far.
    bytes: usize,
    /// The number of elements counted so far; see [`Limits::elements`].
    elements: usize,
}

/// A folder from which files are read.
#[derive(Clone, Debug)]
struct Root {
    /// The absolute path, without `.` and `..`, before symbolic links are resolved.
    named: PathBuf,
    /// The path without symbolic links; equal to `named` if it cannot be resolved.
    real: PathBuf,
}

impl Files {
    /// Creates a reader for the file at `path` and the files that it names. The named files are
    /// read from the root of `options`; without a root, from the folder of `path`. For a URDF file
    /// in a ROS package the default root is the folder of the package, since the meshes usually lie
    /// beside the folder of the URDF file.
    pub(crate) fn beside(path: &Path, options: &ReadOptions) -> Self {
        let own = path.parent().unwrap_or_else(|| Path::new(""));
        let package = || if extension(path) == "urdf" { package_of(own) } else { None };
        let given = options.root.clone().or_else(package);
        let first = Some(absolute(path));
        Self { first, ..Self::within(given.as_deref().unwrap_or(own), options) }
    }

    /// Creates a reader of files in `folder`, or in the root of `options` if it has one.
    pub(crate) fn within(folder: &Path, options: &ReadOptions) -> Self {
        let folder = options.root.as_deref().unwrap_or(folder);
        let packages = options.packages.clone();
        let roots = core::iter::once(folder).chain(packages.iter().map(PathBuf::as_path));
        let roots = roots.map(Root::new).collect();
        Self { roots, first: None, packages, limits: options.limits, bytes: 0, elements: 0 }
    }

    /// Returns the bytes of a file.
    pub(crate) fn read(&mut self, path: &Path) -> Result<Vec<u8>, Problem> {
        self.take(&self.locate(path)?)
    }

    /// Returns the bytes of a file; the error contains the path.
    pub(crate) fn read_named(&mut self, path: &Path) -> Result<Vec<u8>, FileError> {
        self.read(path).map_err(|problem| FileError::whole(path, problem))
    }

    /// Returns the path without symbolic links; an error unless it lies in a root folder or is the
    /// first file.
    ///
    /// A path that lies outside before symbolic links are resolved is rejected before the disk is
    /// accessed, so that errors do not reveal which files exist.
    pub(crate) fn locate(&self, path: &Path) -> Result<PathBuf, Problem> {
        if !self.holds(path) {
            return Err(self.outside(path));
        }
        let real = fs::canonicalize(path).map_err(|error| Problem::io(&error))?;
        let has_real = |root: &Root| real.starts_with(&root.real);
        if self.roots.iter().any(has_real) || self.is_first(path) || self.is_first(&real) {
            Ok(real)
        } else {
            Err(self.outside(path))
        }
    }

    /// Returns `true` if the path as written, before symbolic links are resolved, lies in a root
    /// folder or is the first file.
    pub(crate) fn holds(&self, path: &Path) -> bool {
        let plain = absolute(path);
        let has = |root: &Root| plain.starts_with(&root.named) || plain.starts_with(&root.real);
        self.roots.iter().any(has) || self.is_first(path)
    }

    fn is_first(&self, path: &Path) -> bool {
        self.first.as_ref() == Some(&absolute(path))
    }

    fn outside(&self, path: &Path) -> Problem {
        let root = self.roots.first().map(|root| root.named.clone()).unwrap_or_default();
        Problem::Outside { path: path.to_owned(), root }
    }

    /// Reads a regular file. Devices and pipes are rejected, since reading them may never end.
    fn take(&mut self, path: &Path) -> Result<Vec<u8>, Problem> {
        let wrong = |error| Problem::io(&error);
        if !fs::metadata(path).map_err(wrong)?.is_file() {
            return Err(Problem::NotAFile);
        }
        let file = File::open(path).map_err(wrong)?;
        let length = file.metadata().map_err(wrong)?.len();
        self.count_bytes(usize::try_from(length).unwrap_or(usize::MAX))?;
        let mut bytes = Vec::new();
        // The file may grow while it is read: only the counted bytes are read.
        file.take(length).read_to_end(&mut bytes).map_err(wrong)?;
        Ok(bytes)
    }

    /// Adds `count` to the number of bytes read; an error if the sum exceeds the limit.
    pub(crate) fn count_bytes(&mut self, count: usize) -> Result<(), Problem> {
        let total = self.bytes.saturating_add(count);
        check(Limit::Bytes, total, self.limits.bytes)?;
        self.bytes = total;
        Ok(())
    }

    /// Adds `count` to the number of elements. Called before the elements are created; an error if
    /// the sum exceeds the limit.
    pub(crate) fn count_elements(&mut self, count: usize) -> Result<(), Problem> {
        let total = self.elements.saturating_add(count);
        check(Limit::Elements, total, self.allowed(self.limits.elements))?;
        self.elements = total;
        Ok(())
    }

    /// Returns the larger of `limit` and the number of bytes read, since a large file may have as
    /// many elements as bytes.
    pub(crate) fn allowed(&self, limit: usize) -> usize {
        limit.max(self.bytes)
    }
}

/// Returns an error if `given` exceeds `allowed`.
pub(crate) fn check(limit: Limit, given: usize, allowed: usize) -> Result<(), Problem> {
    if given > allowed { Err(Problem::Limit { limit, allowed }) } else { Ok(()) }
}

impl Root {
    fn new(folder: &Path) -> Self {
        let named = absolute(folder);
        let real = fs::canonicalize(&named).unwrap_or_else(|_| named.clone());
        Self { named, real }
    }
}

/// Returns the absolute path, with `.` and `..` resolved in the text of the path.
fn absolute(path: &Path) -> PathBuf {
    // An empty path stands for the current folder, but has no absolute form.
    let path = if path.as_os_str().is_empty() { Path::new(".") } else { path };
    let absolute = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    let mut plain = PathBuf::new();
    for component in absolute.components() {
        match component {
            Component::CurDir => {}
            Component::ParentDir => {
                plain.pop();
            }
            other => plain.push(other),
        }
    }
    plain
}

/// Returns the nearest folder with a package manifest among this folder and its ancestors; `None`
/// if there is none.
fn package_of(folder: &Path) -> Option<PathBuf> {
    let folder = absolute(folder);
    let found = folder.ancestors().find(|folder| folder.join(MANIFEST).is_file());
    found.map(Path::to_owned)
}

/// Returns the extension of a path in lower case, without its dot; empty if there is none.
pub(crate) fn extension(path: &Path) -> String {
    let extension = path.extension().and_then(|extension| extension.to_str());
    extension.unwrap_or_default().to_ascii_lowercase()
}
