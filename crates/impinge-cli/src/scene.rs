//! Scenes as the command reads them: scene files, meshes, robots.

use std::io;
use std::path::{Path, PathBuf};

use impinge::dim3::math::Vector;
use impinge::world::{CollisionObject, CollisionWorld};
use impinge_files::{Dimension, RobotFile, ScalarFile, Scene, SceneFile, SceneWorld, UpAxis};

use crate::args::{KeyFrames, Reading, SceneArgs, is_stdin};
use crate::error::CliError;
use crate::input;
use crate::output::Subject;
use crate::space::{Kind, Stage};

/// A scene, and the scalar and dimension in which the command computes with it.
#[derive(Debug)]
pub(crate) struct Loaded {
    path: PathBuf,
    scene: Scene,
    pub(crate) kind: Kind,
}

/// The name of a scene from standard input.
const STDIN: &str = "stdin";

/// A name is similar to one with at most a third as many edits as it has characters.
const SIMILAR: usize = 3;

impl Loaded {
    /// Reads a scene from a file or from standard input.
    pub(crate) fn read(args: &SceneArgs) -> Result<Self, CliError> {
        let SceneArgs { scene: path, reading: Reading { scalar, packages } } = args;
        if is_stdin(path) {
            return Self::of_stdin(input::read(path)?, &args.reading);
        }
        let scene = if !packages.is_empty() && is_robot(path) {
            robot(path, packages)?
        } else {
            impinge_files::load(path)?
        };
        Ok(Self::new(path.clone(), scene, *scalar))
    }

    /// The scene that standard input has.
    pub(crate) fn of_stdin(bytes: Vec<u8>, reading: &Reading) -> Result<Self, CliError> {
        let invalid = |error| io::Error::new(io::ErrorKind::InvalidData, error);
        let text = String::from_utf8(bytes).map_err(invalid);
        Self::of_text(STDIN, &text.map_err(CliError::reading(Path::new(STDIN)))?, reading.scalar)
    }

    /// A scene in JSON that is no file.
    pub(crate) fn of_text(
        name: &str,
        text: &str,
        scalar: Option<ScalarFile>,
    ) -> Result<Self, CliError> {
        Ok(Self::new(name.into(), Scene::from_json(name, text)?, scalar))
    }

    fn new(path: PathBuf, scene: Scene, scalar: Option<ScalarFile>) -> Self {
        let scalar = scalar.unwrap_or(scene.scalar());
        let kind = Kind { dimension: scene.dimension(), scalar };
        Self { path, scene, kind }
    }

    /// The file, as reports name it.
    pub(crate) fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// With what a report on the scene begins.
    pub(crate) fn subject(&self) -> Subject {
        Subject { file: self.name(), kind: self.kind }
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

    /// A world whose objects move and are recorded, with these key frames.
    pub(crate) fn moving<N: Stage<D>, const D: usize>(
        &self,
        key_frames: KeyFrames,
    ) -> Result<SceneWorld<N, D>, CliError> {
        let world = self.scene.world()?;
        Ok(match key_frames.every {
            Some(updates) => world.with_key_frames(updates),
            None => world,
        })
    }

    /// The direction that points up in pictures.
    pub(crate) fn up(&self) -> Vector<f64> {
        match self.scene.up() {
            UpAxis::X => Vector::x(),
            UpAxis::Y => Vector::y(),
            UpAxis::Z => Vector::z(),
        }
    }

    /// The object of a name; the error has the most similar name, if one is similar.
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
    // A scene of this robot alone, since `load` takes no folders.
    let mut file = SceneFile::new(Dimension::Three);
    file.robots.push(RobotFile { packages: packages.to_vec(), ..RobotFile::new(path) });
    Ok(file.resolve(Path::new(""))?)
}

/// The edit distance: how many characters have to be added, removed or changed (Levenshtein, "Binary codes capable
/// of correcting deletions, insertions, and reversals", 1966).
fn edits(one: &str, other: &str) -> usize {
    let other: Vec<char> = other.chars().collect();
    // The distances of the first `row` characters of `one` to every prefix of `other`: a row of the usual table,
    // overwritten from left to right, with what stood above and to the left in `diagonal`.
    let mut distances: Vec<usize> = (0..=other.len()).collect();
    for (row, letter) in one.chars().enumerate() {
        let mut diagonal = distances[0];
        distances[0] = row + 1;
        for (column, own) in other.iter().enumerate() {
            let changed = diagonal + usize::from(letter != *own);
            diagonal = distances[column + 1];
            distances[column + 1] = changed.min(diagonal + 1).min(distances[column] + 1);
        }
    }
    distances[other.len()]
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
