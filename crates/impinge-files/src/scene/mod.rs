//! Scenes: documents whose files have been read and whose objects have been placed.

mod groups;
mod meshes;
mod placed;
mod pose;
mod queries;
mod read;
mod shapes;
mod space;
mod world;

use std::path::{Path, PathBuf};

use impinge::world::CollisionGroups;

pub use queries::NamedQuery;
pub use space::SceneSpace;
pub use world::SceneWorld;

pub(crate) use meshes::MeshTable;
pub(crate) use pose::{Placement, about, unit};

use self::pose::Motion;
use crate::files::{Files, extension};
use crate::format::{QueryTypeFile, ShapeRef};
use crate::source::Source;
use crate::text::without_mark;
use crate::{
    Dimension, FileError, JointBeyondLimits, MeshFile, MeshesFile, Problem, ReadOptions, RobotFile,
    ScalarFile, SceneFile, UpAxis,
};

/// A scene: its named objects, and the mesh files that they use. The library validates shapes and
/// objects when a world is created: [`Self::world`] and [`Self::collision_world`] return an error
/// if a shape or object is invalid.
///
/// ```
/// use impinge_files::Scene;
///
/// let text = r#"{"dimension": 2, "objects": [
///     {"name": "floor", "shape": {"half_space": {"normal": [0, 1]}}},
///     {"name": "ball", "shape": {"ball": {"radius": 0.5}}, "position": {"translation": [0, 0.4]}}
/// ]}"#;
/// let scene = Scene::from_json("pile.json", text)?;
/// assert_eq!(scene.names().collect::<Vec<_>>(), ["floor", "ball"]);
///
/// let mut world = scene.world::<f64, 2>()?;
/// world.step(0.0)?;
/// let (_, ball, manifold) = world.contact_manifolds().next().expect("they touch");
/// assert_eq!(ball.data(), "ball");
/// assert!((manifold.deepest_contact().expect("a contact").contact.depth - 0.1).abs() < 1e-15);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Scene {
    source: Source,
    file: SceneFile,
    /// The shapes of objects, each with its path in the document. The objects of a grid share one
    /// entry.
    forms: Vec<Form>,
    objects: Vec<SceneObject>,
    meshes: MeshTable,
    joints_beyond_limits: Vec<JointBeyondLimits>,
}

/// A shape, with the path of the entry of the document that contains it.
#[derive(Clone, Debug)]
struct Form {
    shape: ShapeRef,
    path: String,
    /// The member of the entry that contains the shape; empty for shapes of meshes and robots.
    member: &'static str,
}

/// An object before a world is created.
#[derive(Clone, Debug)]
struct SceneObject {
    name: String,
    /// The index of its shape in `forms`.
    form: usize,
    start: Placement,
    motion: Option<Motion>,
    groups: CollisionGroups,
    query: QueryTypeFile,
}

/// Reads a file as a scene: a scene file (.json), a mesh file (.obj, .stl, .ply, .gltf, .glb), each
/// of whose parts becomes an object, or a robot (.urdf) with all joints at 0, each of whose links
/// with collision elements becomes an object.
///
/// ```
/// let error = impinge_files::load("pile.scene".as_ref()).expect_err("no such format");
/// assert_eq!(error.to_string(), "pile.scene: no format with the ending \"scene\" can be read");
/// ```
///
/// # Errors
/// As [`Scene::read`], and for an unknown extension.
pub fn load(path: &Path) -> Result<Scene, FileError> {
    load_with(path, &ReadOptions::new())
}

/// Reads a file like [`load`], with options for the root folder, packages and limits.
///
/// If the URDF file of a robot is in a ROS package, the default root is the folder of the package.
/// Otherwise the default root is the folder of `path`.
///
/// # Errors
/// As [`load`].
pub fn load_with(path: &Path, options: &ReadOptions) -> Result<Scene, FileError> {
    let extension = extension(path);
    let mut file = SceneFile::new(Dimension::Three);
    let meshes = MeshTable::new(Path::new(""), Files::beside(path, options));
    match extension.as_str() {
        "json" => return Scene::read_with(path, options),
        "urdf" => file.robots.push(RobotFile::new(path)),
        mesh if MeshFile::has_format(mesh) => file.meshes.push(MeshesFile::new(path)),
        _ => return Err(FileError::whole(path, Problem::UnknownFormat { extension })),
    }
    Scene::resolve(Source::without_text(path.to_owned()), file, meshes)
}

impl SceneFile {
    /// Resolves the scene: reads the files that it names. Paths are relative to `folder`.
    ///
    /// # Errors
    /// As [`Scene::read`], but errors in the document have no line and no column.
    pub fn resolve(self, folder: &Path) -> Result<Scene, FileError> {
        self.resolve_with(folder, &ReadOptions::new())
    }

    /// Resolves the scene like [`Self::resolve`], with options for the root folder, packages and
    /// limits.
    ///
    /// # Errors
    /// As [`Self::resolve`].
    pub fn resolve_with(self, folder: &Path, options: &ReadOptions) -> Result<Scene, FileError> {
        let meshes = MeshTable::new(folder, Files::within(folder, options));
        Scene::resolve(Source::without_text(folder.join("scene")), self, meshes)
    }
}

impl Scene {
    /// Reads a scene file, and the mesh and robot files that it names.
    ///
    /// # Errors
    /// If a file cannot be read, is not of its format, or is outside of the folder of the scene; if
    /// the scene has unknown members, exceeds the default [`Limits`](crate::Limits), or gives two
    /// objects the same name. An error in the document has the line, the column and the path.
    pub fn read(path: &Path) -> Result<Self, FileError> {
        Self::read_with(path, &ReadOptions::new())
    }

    /// Reads a scene file like [`Self::read`], with options for the root folder, packages and
    /// limits.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn read_with(path: &Path, options: &ReadOptions) -> Result<Self, FileError> {
        let mut files = Files::beside(path, options);
        let bytes = files.read_named(path)?;
        Self::of_bytes(path.to_owned(), &bytes, files)
    }

    /// Parses a document. Errors contain `path`. The files that the document names are relative to
    /// the folder of `path`.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn from_json(path: impl Into<PathBuf>, text: &str) -> Result<Self, FileError> {
        Self::from_json_with(path, text, &ReadOptions::new())
    }

    /// Parses a document like [`Self::from_json`], with options for the root folder, packages and
    /// limits.
    ///
    /// # Errors
    /// As [`Self::read`].
    pub fn from_json_with(
        path: impl Into<PathBuf>,
        text: &str,
        options: &ReadOptions,
    ) -> Result<Self, FileError> {
        let path = path.into();
        let mut files = Files::beside(&path, options);
        files.count_bytes(text.len()).map_err(|problem| FileError::whole(&path, problem))?;
        Self::of_bytes(path, text.as_bytes(), files)
    }

    fn of_bytes(path: PathBuf, bytes: &[u8], files: Files) -> Result<Self, FileError> {
        let text = String::from_utf8_lossy(without_mark(bytes)).into_owned();
        let source = Source::new(path, text);
        let file = source.parse()?;
        let meshes = MeshTable::new(source.folder(), files);
        Self::resolve(source, file, meshes)
    }

    /// Returns the document.
    #[must_use]
    pub const fn file(&self) -> &SceneFile {
        &self.file
    }

    /// Returns the number of dimensions.
    #[must_use]
    pub const fn dimension(&self) -> Dimension {
        self.file.dimension
    }

    /// Returns the scalar of the document. A world may be created with another scalar.
    #[must_use]
    pub const fn scalar(&self) -> ScalarFile {
        self.file.scalar
    }

    /// Returns the axis that points up in pictures.
    #[must_use]
    pub const fn up(&self) -> UpAxis {
        self.file.up
    }

    /// Returns the names of the objects in the order in which worlds contain them: `objects` first,
    /// then the parts of `meshes`, then the links of `robots`.
    pub fn names(&self) -> impl ExactSizeIterator<Item = &str> {
        self.objects.iter().map(|object| object.name.as_str())
    }

    /// Returns the mesh files that were read, with their paths. Their parts contain the reports of
    /// defects.
    pub fn mesh_files(&self) -> impl Iterator<Item = (&Path, &MeshFile)> {
        self.meshes.iter()
    }

    /// Returns the joints of robots whose values are outside the limits of their URDF files. Such a
    /// scene is still valid.
    #[must_use]
    pub fn joints_beyond_limits(&self) -> &[JointBeyondLimits] {
        &self.joints_beyond_limits
    }

    /// Returns `true` if at least one object moves.
    #[must_use]
    pub fn has_motion(&self) -> bool {
        self.objects.iter().any(|object| object.motion.is_some())
    }
}
