//! Where the mesh files of a robot are.

use std::path::{Path, PathBuf};

use crate::Problem;
use crate::format::RobotFile;

/// Folders in which packages are looked for, and the folder of relative paths.
#[derive(Debug)]
pub(super) struct Packages {
    /// The folder of the URDF file.
    own: PathBuf,
    folders: Vec<PathBuf>,
}

impl Packages {
    /// The folders that the scene names, then those that the URDF file is in.
    pub(super) fn new(file: &RobotFile, folder: &Path, urdf: &Path) -> Self {
        let absolute = std::path::absolute(urdf).unwrap_or_else(|_| urdf.to_owned());
        let own = absolute.parent().unwrap_or_else(|| Path::new("")).to_owned();
        let given = file.packages.iter().map(|package| folder.join(package));
        let folders = given.chain(own.ancestors().map(Path::to_owned)).collect();
        Self { own, folders }
    }

    /// The file of a `package://` path, of a `file://` path, or of one relative to the URDF file.
    pub(super) fn find(&self, name: &str) -> Result<PathBuf, Problem> {
        if let Some(path) = name.strip_prefix("file://") {
            return Ok(PathBuf::from(path));
        }
        let Some(path) = name.strip_prefix("package://") else {
            return Ok(self.own.join(name));
        };
        let (package, rest) = path.split_once('/').unwrap_or((path, ""));
        // A folder is the package if it has its name, and holds it as a folder within otherwise.
        let found = self.folders.iter().find_map(|folder| {
            let is_package = folder.file_name().is_some_and(|name| name == package);
            let inner = folder.join(package);
            if is_package {
                Some(folder.join(rest))
            } else {
                inner.is_dir().then(|| inner.join(rest))
            }
        });
        found.ok_or_else(|| Problem::UnknownPackage(package.to_owned()))
    }
}
