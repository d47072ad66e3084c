//! Resolves the paths of the mesh files of a robot.

use std::path::{Component, Path, PathBuf};

use crate::Problem;
use crate::files::Files;
use crate::format::RobotFile;

/// The folders that are searched for packages, and the folder of relative paths.
#[derive(Debug)]
pub(super) struct Packages {
    /// The folder of the URDF file.
    own: PathBuf,
    folders: Vec<PathBuf>,
}

impl Packages {
    /// Collects the searched folders: the package folders of the options, the package folders of
    /// the scene, and the ancestors of the URDF file. Folders of the last two kinds are kept only
    /// if files may be read from them.
    pub(super) fn new(file: &RobotFile, folder: &Path, urdf: &Path, files: &Files) -> Self {
        let absolute = std::path::absolute(urdf).unwrap_or_else(|_| urdf.to_owned());
        let own = absolute.parent().unwrap_or_else(|| Path::new("")).to_owned();
        let given = file.packages.iter().map(|package| folder.join(package));
        let above = own.ancestors().map(Path::to_owned);
        let readable = given.chain(above).filter(|folder| files.holds(folder));
        Self { folders: files.packages.iter().cloned().chain(readable).collect(), own }
    }

    /// Returns the path for a `package://` name, a `file://` name, or a name relative to the URDF
    /// file. The result may lie outside the root, which is checked when the file is read.
    pub(super) fn find(&self, name: &str) -> Result<PathBuf, Problem> {
        if let Some(path) = name.strip_prefix("file://") {
            return Ok(PathBuf::from(path));
        }
        let Some(path) = name.strip_prefix("package://") else {
            return Ok(self.own.join(name));
        };
        let (package, rest) = path.split_once('/').unwrap_or((path, ""));
        let unknown = || Problem::UnknownPackage(package.to_owned());
        // The package must be a single folder name, not a path with several components.
        let mut parts = Path::new(package).components();
        if !matches!((parts.next(), parts.next()), (Some(Component::Normal(_)), None)) {
            return Err(unknown());
        }
        // A searched folder with the name of the package is the package itself. In any other
        // searched folder, the package is the subfolder with this name, if there is one.
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
