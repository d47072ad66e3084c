//! Scene files as data: the members of the JSON document, as `SCENE.md` describes them.
//!
//! The doc comments of these types become the descriptions of the JSON schema.

mod map;
mod numbers;
mod object;
mod query;
mod robot;
mod shape;

use std::collections::BTreeMap;

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

pub use object::{
    AngularVelocity, GroupsFile, MeshesFile, MotionFile, ObjectFile, PoseFile, QueryTypeFile,
    RepeatFile, RotationFile, RotationOrder,
};
pub use query::{CastFile, QueryFile, RayFile};
pub use robot::RobotFile;
pub use shape::{
    ChildFile, DiagonalsFile, HeightFieldFile, MeshKind, MeshSource, ScaleFile, ShapeFile, ShapeRef,
};

use map::unique_keys;

/// A scene: shapes, the objects that use them, and their motions.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// The path of the schema, for editors; ignored by the loader.
    #[serde(rename = "$schema", default, skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// The number of dimensions: 2 or 3.
    pub dimension: Dimension,
    /// The scalar of the world.
    #[serde(default)]
    pub scalar: ScalarFile,
    /// The margin by which the boxes of objects are enlarged: a length, finite and not negative.
    #[serde(default = "default_margin")]
    pub margin: f64,
    /// The axis that points up in pictures; ignored by the world.
    #[serde(default)]
    pub up: UpAxis,
    /// Shapes by name, for objects and for shapes within shapes.
    #[serde(default, deserialize_with = "unique_keys", skip_serializing_if = "BTreeMap::is_empty")]
    pub shapes: BTreeMap<String, ShapeFile>,
    /// The objects.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub objects: Vec<ObjectFile>,
    /// Mesh files, each of whose parts becomes an object.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub meshes: Vec<MeshesFile>,
    /// Robots, each of whose links with collision elements becomes an object.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub robots: Vec<RobotFile>,
    /// Queries by name.
    #[serde(default, deserialize_with = "unique_keys", skip_serializing_if = "BTreeMap::is_empty")]
    pub queries: BTreeMap<String, QueryFile>,
}

const fn default_margin() -> f64 {
    0.02
}

/// The number of dimensions: 2 or 3.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(try_from = "u64", into = "u64")]
#[schemars(extend("enum" = [2, 3]))]
pub enum Dimension {
    /// 2D.
    Two,
    /// 3D.
    Three,
}

impl Dimension {
    /// Returns the number of dimensions as an integer.
    #[must_use]
    pub const fn number(self) -> usize {
        match self {
            Self::Two => 2,
            Self::Three => 3,
        }
    }
}

impl TryFrom<u64> for Dimension {
    type Error = String;

    fn try_from(number: u64) -> Result<Self, String> {
        match number {
            2 => Ok(Self::Two),
            3 => Ok(Self::Three),
            _ => Err(format!("the dimension is {number}: it must be 2 or 3")),
        }
    }
}

impl From<Dimension> for u64 {
    fn from(dimension: Dimension) -> Self {
        dimension.number() as Self
    }
}

/// The scalar of a world.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum ScalarFile {
    /// 32 bits.
    F32,
    /// 64 bits.
    #[default]
    F64,
}

/// An axis that points up.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
pub enum UpAxis {
    /// The x axis.
    X,
    /// The y axis.
    #[default]
    Y,
    /// The z axis.
    Z,
}

impl SceneFile {
    /// Returns a scene of this dimension without objects: `f64`, a margin of 0.02, y upwards.
    #[must_use]
    pub const fn new(dimension: Dimension) -> Self {
        Self {
            schema: None,
            dimension,
            scalar: ScalarFile::F64,
            margin: default_margin(),
            up: UpAxis::Y,
            shapes: BTreeMap::new(),
            objects: Vec::new(),
            meshes: Vec::new(),
            robots: Vec::new(),
            queries: BTreeMap::new(),
        }
    }

    /// Returns the JSON schema of scene files, which `scene.schema.json` contains.
    ///
    /// ```
    /// let schema = impinge_files::SceneFile::schema();
    /// assert!(schema.contains("\"dimension\"") && schema.ends_with("}\n"));
    /// ```
    #[must_use]
    pub fn schema() -> String {
        let schema = schemars::schema_for!(Self);
        format!("{:#}\n", schema.as_value())
    }
}
