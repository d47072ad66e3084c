//! Where the mesh files of a robot are.

use std::path::{Component, Path, PathBuf};

use crate::Problem;
use crate::files::Files;
use crate::format::RobotFile;

/// Folders in which packages are looked for, and the folder of relative paths.
#[derive(Debug)]
pub(super) struct Packages {
    /// The folder of the URDF file.
    own: PathBuf,
    folders: Vec<PathBuf>,
}

impl Packages {
    /// The folders that the user names, those that the scene names, and those that the URDF file is in; of the last
    /// two, only such from which files may be read.
    pub(super) fn new(file: &RobotFile, folder: &Path, urdf: &Path, files: &Files) -> Self {
        let absolute = std::path::absolute(urdf).unwrap_or_else(|_| urdf.to_owned());
        let own = absolute.parent().unwrap_or_else(|| Path::new("")).to_owned();
        let given = file.packages.iter().map(|package| folder.join(package));
        let above = own.ancestors().map(Path::to_owned);
        let readable = given.chain(above).filter(|folder| files.holds(folder));
        Self { folders: files.packages.iter().cloned().chain(readable).collect(), own }
    }

    /// The file of a `package://` path, of a `file://` path, or of one relative to the URDF file. It may still be one
    /// that may not be read.
    pub(super) fn find(&self, name: &str) -> Result<PathBuf, Problem> {
        if let Some(path) = name.strip_prefix("file://") {
            return Ok(PathBuf::from(path));
        }
        let Some(path) = name.strip_prefix("package://") else {
            return Ok(self.own.join(name));
        };
        let (package, rest) = path.split_once('/').unwrap_or((path, ""));
        let unknown = || Problem::UnknownPackage(package.to_owned());
        // The name is that of a folder, not a way to another one.
        let mut parts = Path::new(package).components();
        if !matches!((parts.next(), parts.next()), (Some(Component::Normal(_)), None)) {
            return Err(unknown());
        }
        // A folder is the package if it has its name, and holds it as a folder within otherwise.
        let found = self.folders.iter().find_map(|folder| {
            let inner = folder.join(package);
            if folder.file_name().is_some_and(|name| name == package) {
                Some(folder.join(rest))
            } else {
                inner.is_dir().then(|| inner.join(rest))
            }
        });
        found.ok_or_else(unknown)
    }
}
