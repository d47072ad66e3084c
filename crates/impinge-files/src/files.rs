//! Files as bytes: from the folders of a scene, regular ones alone, within its limits.

use std::fs::{self, File};
use std::io::Read as _;
use std::path::{Component, Path, PathBuf};

use crate::{FileError, Limit, Limits, Problem, ReadOptions};

/// The file that marks the folder of a ROS package.
const MANIFEST: &str = "package.xml";

/// Reads the files of one scene, and counts what is made of them.
#[derive(Clone, Debug)]
pub(crate) struct Files {
    roots: Vec<Root>,
    /// The file that the user names, which may lie anywhere: absolute.
    first: Option<PathBuf>,
    pub(crate) packages: Vec<PathBuf>,
    pub(crate) limits: Limits,
    /// Read so far.
    bytes: usize,
    /// Made so far.
    elements: usize,
}

/// A folder from which files are read.
#[derive(Clone, Debug)]
struct Root {
    /// Absolute, as it was named.
    named: PathBuf,
    /// Without symbolic links; as it was named, if there is no such folder.
    real: PathBuf,
}

impl Files {
    /// Reads the file that the user names, and others from its folder, or from that of the options. For a robot in a ROS package the folder of the
    /// package takes the place of its own: the URDF files of packages name meshes in folders beside theirs.
    pub(crate) fn beside(path: &Path, options: &ReadOptions) -> Self {
        let own = path.parent().unwrap_or_else(|| Path::new(""));
        let package = || if extension(path) == "urdf" { package_of(own) } else { None };
        let given = options.root.clone().or_else(package);
        let first = Some(absolute(path));
        Self { first, ..Self::within(given.as_deref().unwrap_or(own), options) }
    }

    /// Reads from a folder, unless the options name another one.
    pub(crate) fn within(folder: &Path, options: &ReadOptions) -> Self {
        let folder = options.root.as_deref().unwrap_or(folder);
        let packages = options.packages.clone();
        let roots = core::iter::once(folder).chain(packages.iter().map(PathBuf::as_path));
        let roots = roots.map(Root::new).collect();
        Self { roots, first: None, packages, limits: options.limits, bytes: 0, elements: 0 }
    }

    /// The bytes of a file.
    pub(crate) fn read(&mut self, path: &Path) -> Result<Vec<u8>, Problem> {
        self.take(&self.locate(path)?)
    }

    /// As [`Self::read`], with the path in the error.
    pub(crate) fn read_named(&mut self, path: &Path) -> Result<Vec<u8>, FileError> {
        self.read(path).map_err(|problem| FileError::whole(path, problem))
    }

    /// The path without symbolic links, if it lies in one of the folders.
    ///
    /// A path that leads outside is refused before the disk is asked, so that errors do not reveal which files exist.
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

    /// The path lies in one of the folders as it is written.
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

    /// Reads a regular file. Devices and pipes have no end.
    fn take(&mut self, path: &Path) -> Result<Vec<u8>, Problem> {
        let wrong = |error| Problem::io(&error);
        if !fs::metadata(path).map_err(wrong)?.is_file() {
            return Err(Problem::NotAFile);
        }
        let file = File::open(path).map_err(wrong)?;
        let length = file.metadata().map_err(wrong)?.len();
        self.count_bytes(usize::try_from(length).unwrap_or(usize::MAX))?;
        let mut bytes = Vec::new();
        // A file may grow meanwhile.
        file.take(length).read_to_end(&mut bytes).map_err(wrong)?;
        Ok(bytes)
    }

    /// Counts bytes of a file.
    pub(crate) fn count_bytes(&mut self, count: usize) -> Result<(), Problem> {
        let total = self.bytes.saturating_add(count);
        check(Limit::Bytes, total, self.limits.bytes)?;
        self.bytes = total;
        Ok(())
    }

    /// Counts vertices and corners of triangles before they are made.
    pub(crate) fn count_elements(&mut self, count: usize) -> Result<(), Problem> {
        let total = self.elements.saturating_add(count);
        check(Limit::Elements, total, self.allowed(self.limits.elements))?;
        self.elements = total;
        Ok(())
    }

    /// The larger of a limit and the bytes that were read.
    pub(crate) fn allowed(&self, limit: usize) -> usize {
        limit.max(self.bytes)
    }
}

/// There are at most so many.
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

/// An absolute path without `.` and `..`.
fn absolute(path: &Path) -> PathBuf {
    // An empty path has no absolute one: it is the current folder.
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

/// The nearest folder from this one upwards that is a ROS package.
fn package_of(folder: &Path) -> Option<PathBuf> {
    let folder = absolute(folder);
    let found = folder.ancestors().find(|folder| folder.join(MANIFEST).is_file());
    found.map(Path::to_owned)
}

/// The ending of a name in lower case, without its dot; empty if there is none.
pub(crate) fn extension(path: &Path) -> String {
    let extension = path.extension().and_then(|extension| extension.to_str());
    extension.unwrap_or_default().to_ascii_lowercase()
}
