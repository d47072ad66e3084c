//! Reads scenes of the command from scene files, meshes and robots.

use std::io;
use std::path::{Path, PathBuf};

use impinge::dim3::math::Vector;
use impinge::world::{CollisionObject, CollisionWorld};
use impinge_files::{Scene, SceneWorld, UpAxis};

use crate::args::{KeyFrames, Reading, SceneArgs, is_stdin};
use crate::error::CliError;
use crate::input;
use crate::near::check_pairs;
use crate::output::Subject;
use crate::space::{Kind, Stage};

/// A scene, and the scalar and dimension of the computation.
#[derive(Debug)]
pub(crate) struct Loaded {
    path: PathBuf,
    scene: Scene,
    pub(crate) kind: Kind,
    max_pairs: usize,
}

/// The name of the file in reports and errors about standard input.
const STDIN: &str = "stdin";

/// Two names are similar if their edit distance is at most the number of characters of the searched
/// name divided by this number.
const SIMILAR: usize = 3;

/// The maximum length of compared names in bytes. Comparing takes time proportional to the product
/// of the lengths.
const LONG: usize = 256;

impl Loaded {
    /// Reads a scene from a file or from standard input.
    pub(crate) fn read(args: &SceneArgs) -> Result<Self, CliError> {
        let SceneArgs { scene: path, reading } = args;
        if is_stdin(path) {
            return Self::of_stdin(input::stdin(reading.limits.of_files().bytes)?, reading);
        }
        let scene = impinge_files::load_with(path, &reading.options())?;
        Ok(Self::new(path.clone(), scene, reading))
    }

    /// Reads a scene from the bytes of standard input.
    pub(crate) fn of_stdin(bytes: Vec<u8>, reading: &Reading) -> Result<Self, CliError> {
        let invalid = |error| io::Error::new(io::ErrorKind::InvalidData, error);
        let text = String::from_utf8(bytes).map_err(invalid);
        Self::of_text(STDIN, &text.map_err(CliError::reading(Path::new(STDIN)))?, reading)
    }

    /// Parses a scene in JSON that is not in a file. `name` stands for the file in reports.
    pub(crate) fn of_text(name: &str, text: &str, reading: &Reading) -> Result<Self, CliError> {
        let scene = Scene::from_json_with(name, text, &reading.options())?;
        Ok(Self::new(name.into(), scene, reading))
    }

    fn new(path: PathBuf, scene: Scene, reading: &Reading) -> Self {
        let scalar = reading.scalar.unwrap_or(scene.scalar());
        let kind = Kind { dimension: scene.dimension(), scalar };
        Self { path, scene, kind, max_pairs: reading.limits.max_pairs }
    }

    /// Returns the name of the file for reports.
    pub(crate) fn name(&self) -> String {
        self.path.display().to_string()
    }

    /// Returns the first fields of a report about the scene.
    pub(crate) fn subject(&self) -> Subject {
        Subject { file: self.name(), kind: self.kind }
    }

    /// Returns the scene.
    pub(crate) const fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Creates a world with the objects of the scene. The world is not updated yet.
    pub(crate) fn world<N: Stage<D>, const D: usize>(
        &self,
    ) -> Result<CollisionWorld<N, D, String>, CliError> {
        Ok(self.scene.collision_world()?)
    }

    /// Creates an updated world for queries about its objects. All objects are fixed, so that no
    /// contacts between them are computed.
    pub(crate) fn world_without_pairs<N: Stage<D>, const D: usize>(
        &self,
    ) -> Result<CollisionWorld<N, D, String>, CliError> {
        let mut world = self.world()?;
        let handles: Vec<_> = world.collision_objects().map(CollisionObject::handle).collect();
        for handle in handles {
            // Fixed objects have no pairs with each other, but queries find them.
            let fixed = world.try_set_fixed(handle, true);
            fixed.map_err(|error| CliError::Objects(error.to_string()))?;
        }
        // The broad phase stores overlapping boxes even for fixed objects.
        self.check_pairs(&world)?;
        world.update();
        Ok(world)
    }

    /// Returns an error if the next update of a world of this scene would store more pairs than the
    /// limit.
    pub(crate) fn check_pairs<N: Stage<D>, const D: usize>(
        &self,
        world: &CollisionWorld<N, D, String>,
    ) -> Result<(), CliError> {
        check_pairs(world, self.scene.file().margin, self.max_pairs)
    }

    /// Moves the objects of a world of this scene, checks the number of pairs, and updates the
    /// world; see [`SceneWorld::step`].
    pub(crate) fn step<N: Stage<D>, const D: usize>(
        &self,
        world: &mut SceneWorld<N, D>,
        seconds: f64,
    ) -> Result<(), CliError> {
        world.move_objects(seconds)?;
        self.check_pairs(world)?;
        world.recorder_mut().update();
        Ok(())
    }

    /// Returns the maximum number of pairs of objects that are near each other.
    pub(crate) const fn max_pairs(&self) -> usize {
        self.max_pairs
    }

    /// Creates a recorded world with moving objects, and with a key frame every `key_frames.every`
    /// updates; without key frames if that is `None`.
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

    /// Returns the upward direction of pictures, a unit vector.
    pub(crate) fn up(&self) -> Vector<f64> {
        match self.scene.up() {
            UpAxis::X => Vector::x(),
            UpAxis::Y => Vector::y(),
            UpAxis::Z => Vector::z(),
        }
    }

    /// Returns the object with this name. The error contains the most similar name of an object, if
    /// one is similar.
    pub(crate) fn object<'a, N: Stage<D>, const D: usize>(
        &self,
        world: &'a CollisionWorld<N, D, String>,
        name: &str,
    ) -> Result<&'a CollisionObject<N, D, String>, CliError> {
        let found = world.collision_objects().find(|object| object.data() == name);
        found.ok_or_else(|| {
            let known = self.scene.names().filter(|known| known.len().max(name.len()) <= LONG);
            let known = known.map(|known| (edits(known, name), known));
            let nearest = known.min().filter(|(edits, _)| edits * SIMILAR <= name.chars().count());
            let similar = nearest.map(|(_, known)| known.to_owned());
            CliError::NoObject { path: self.path.clone(), name: name.to_owned(), similar }
        })
    }
}

/// Returns the edit distance of two texts: the minimum number of characters to add, remove or
/// change (Levenshtein, "Binary codes capable of correcting deletions, insertions, and reversals",
/// 1966).
fn edits(one: &str, other: &str) -> usize {
    let other: Vec<char> = other.chars().collect();
    // Row `row` of the usual table, which is overwritten from left to right: the distances from the
    // first `row` characters of `one` to every prefix of `other`. `diagonal` is the value above and
    // to the left of the current one.
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
