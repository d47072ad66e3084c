//! Scenes as the command reads them: scene files, meshes, robots.

use std::path::{Path, PathBuf};

use impinge::dim3::math::Vector;
use impinge::world::{CollisionObject, CollisionWorld};
use impinge_files::{Dimension, RobotFile, ScalarFile, Scene, SceneFile, SceneWorld, UpAxis};

use crate::args::{ScalarName, SceneArgs, is_stdin};
use crate::error::CliError;
use crate::output;
use crate::space::{Kind, Stage};

/// A scene, and the scalar and dimension in which it is looked at.
#[derive(Debug)]
pub(crate) struct Loaded {
    path: PathBuf,
    scene: Scene,
    pub(crate) kind: Kind,
}

/// Names with more edits than a third of their length are not similar.
const SIMILAR: usize = 3;

impl Loaded {
    /// Reads a scene from a file or from standard input.
    pub(crate) fn read(args: &SceneArgs) -> Result<Self, CliError> {
        let path = args.scene.clone();
        let scene = if is_stdin(&path) {
            let bytes = output::read(&path)?;
            Scene::from_json("stdin", &String::from_utf8_lossy(&bytes))?
        } else if !args.packages.is_empty() && is_robot(&path) {
            robot(&path, &args.packages)?
        } else {
            impinge_files::load(&path)?
        };
        Ok(Self::new(path, scene, args.scalar))
    }

    /// A scene that the command has.
    pub(crate) fn of_text(
        name: &str,
        text: &str,
        scalar: Option<ScalarName>,
    ) -> Result<Self, CliError> {
        Ok(Self::new(name.into(), Scene::from_json(name, text)?, scalar))
    }

    fn new(path: PathBuf, scene: Scene, scalar: Option<ScalarName>) -> Self {
        let own = match scene.scalar() {
            ScalarFile::F32 => ScalarName::F32,
            ScalarFile::F64 => ScalarName::F64,
        };
        let kind = Kind { scalar: scalar.unwrap_or(own), dimension: scene.dimension() };
        Self { path, scene, kind }
    }

    /// The file, as reports name it.
    pub(crate) fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// The scene.
    pub(crate) const fn scene(&self) -> &Scene {
        &self.scene
    }

    /// A world with the objects, not updated yet.
    pub(crate) fn world<N: Stage<D>, const D: usize>(
        &self,
    ) -> Result<CollisionWorld<N, D, String>, CliError> {
        Ok(self.scene.collision_world()?)
    }

    /// A world whose objects move and are recorded.
    pub(crate) fn moving<N: Stage<D>, const D: usize>(&self) -> Result<SceneWorld<N, D>, CliError> {
        Ok(self.scene.world()?)
    }

    /// The direction that points up in pictures.
    pub(crate) fn up(&self) -> Vector<f64> {
        match self.scene.up() {
            UpAxis::X => Vector::x(),
            UpAxis::Y => Vector::y(),
            UpAxis::Z => Vector::z(),
        }
    }

    /// The object of a name; the error has the name that is most similar.
    pub(crate) fn object<'a, N: Stage<D>, const D: usize>(
        &self,
        world: &'a CollisionWorld<N, D, String>,
        name: &str,
    ) -> Result<&'a CollisionObject<N, D, String>, CliError> {
        let found = world.collision_objects().find(|object| object.data() == name);
        found.ok_or_else(|| {
            let known = self.scene.names().map(|known| (edits(known, name), known));
            let nearest = known.min().filter(|(edits, _)| edits * SIMILAR <= name.chars().count());
            let similar = nearest.map(|(_, known)| known.to_owned());
            CliError::NoObject { path: self.path.clone(), name: name.to_owned(), similar }
        })
    }
}

fn is_robot(path: &Path) -> bool {
    path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("urdf"))
}

/// A robot whose packages are in folders that the user names.
fn robot(path: &Path, packages: &[PathBuf]) -> Result<Scene, CliError> {
    let mut file = SceneFile::new(Dimension::Three);
    file.robots.push(RobotFile { packages: packages.to_vec(), ..RobotFile::new(path) });
    Ok(file.resolve(Path::new(""))?)
}

/// How many characters have to be added, removed or changed (Levenshtein, "Binary codes capable of
/// correcting deletions, insertions, and reversals", 1966).
fn edits(one: &str, other: &str) -> usize {
    let other: Vec<char> = other.chars().collect();
    let mut row: Vec<usize> = (0..=other.len()).collect();
    for (index, letter) in one.chars().enumerate() {
        let mut diagonal = row[0];
        row[0] = index + 1;
        for (place, own) in other.iter().enumerate() {
            let changed = diagonal + usize::from(letter != *own);
            diagonal = row[place + 1];
            row[place + 1] = changed.min(diagonal + 1).min(row[place] + 1);
        }
    }
    row[other.len()]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn edits_by_hand() {
        assert_eq!(edits("left", "left"), 0);
        assert_eq!(edits("left", "lefd"), 1);
        assert_eq!(edits("kitten", "sitting"), 3);
        assert_eq!(edits("", "abc"), 3);
    }
}
