//! Reads collision worlds from files: scenes in JSON, meshes in OBJ, STL, PLY and glTF, robots in
//! URDF.
//!
//! [`load`] reads a file of any of these formats as a [`Scene`]: objects with names, shapes and
//! motions. [`Scene::world`] creates a recorded world of the scene in a chosen scalar and
//! dimension, and [`Scene::collision_world`] a world without a recording. `SCENE.md` describes
//! scene files, and `scene.schema.json` is their JSON schema. [`MeshFile`] reads a mesh file
//! without a scene, with a [`MeshReport`] of its defects.
//!
//! ```
//! use impinge_files::Scene;
//!
//! let text = r#"{"dimension": 3, "objects": [
//!     {"name": "floor", "shape": {"half_space": {"normal": [0, 1, 0]}}},
//!     {"name": "box", "shape": {"cuboid": {"half_extents": [0.5, 0.5, 0.5]}},
//!      "position": {"translation": [0, 0.5, 0]},
//!      "repeat": {"count": [2, 3, 2], "spacing": [2, 1, 2]}}
//! ]}"#;
//! let scene = Scene::from_json("boxes.json", text)?;
//! assert_eq!(scene.names().len(), 13);
//! let mut world = scene.collision_world::<f64, 3>()?;
//! world.update();
//! assert_eq!(world.contact_events().len(), 12, "each box stands on the floor or on another");
//! # Ok::<(), impinge_files::FileError>(())
//! ```
//!
//! Files are treated as untrusted input. Errors are typed and name the file and, where known, the
//! line, the path in the document and the value. [`Printable`] escapes control characters of texts
//! from files. Other files that a file names are read only from its folder, or from the root and
//! package folders of the [`ReadOptions`]. Time and memory are bounded by the size of the files, up
//! to a logarithmic factor. Content that a few bytes can request without bound, such as grids of
//! objects, has [`Limits`].
#![forbid(unsafe_code)]

mod error;
mod files;
mod format;
mod mesh;
mod options;
mod robot;
mod scan;
mod scene;
mod source;
mod text;

pub use error::{FileError, Problem};
pub use format::{
    AngularVelocity, CastFile, ChildFile, DiagonalsFile, Dimension, GroupsFile, HeightFieldFile,
    MeshKind, MeshSource, MeshesFile, MotionFile, ObjectFile, PoseFile, QueryFile, QueryTypeFile,
    RayFile, RepeatFile, RobotFile, RotationFile, RotationOrder, ScalarFile, ScaleFile, SceneFile,
    ShapeFile, ShapeRef, UpAxis,
};
pub use mesh::{Defect, Defects, MAX_DEFECTS, MeshFile, MeshPart, MeshReport};
pub use options::{Limit, Limits, ReadOptions};
pub use robot::JointBeyondLimits;
pub use scene::{NamedQuery, Scene, SceneSpace, SceneWorld, load, load_with};
pub use text::Printable;
