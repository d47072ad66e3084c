//! Objects in a scene file: positions, groups, query types and motions.

use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Deserializer, Serialize};

use super::numbers::OneOrThree;
use super::{MeshKind, ScaleFile, ShapeRef};

/// An object, or a grid of objects.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct ObjectFile {
    /// The name, which must be unique. With `repeat`, indices in brackets follow: `box[2,0,1]`.
    pub name: String,
    /// The shape.
    pub shape: ShapeRef,
    /// The initial position.
    #[serde(default)]
    pub position: PoseFile,
    /// Its collision groups.
    #[serde(default)]
    pub groups: GroupsFile,
    /// The query type of its pairs: contacts or proximity.
    #[serde(default)]
    pub query: QueryTypeFile,
    /// The motion.
    #[serde(default)]
    pub motion: MotionFile,
    /// Makes a grid of copies of the object.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub repeat: Option<RepeatFile>,
}

/// A mesh file, each of whose parts (groups and objects of an OBJ file, meshes of the nodes of a glTF file) becomes
/// an object named `NAME/PART`. 3D only.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MeshesFile {
    /// The prefix of the names of the objects; without, the names are those of the parts.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The file: .obj, .stl, .ply, .gltf or .glb, relative to the folder of the scene.
    pub path: PathBuf,
    /// A factor for all coordinates, or one for each axis; not 0.
    #[serde(default)]
    pub scale: ScaleFile,
    /// The kind of shape that is made of the triangles.
    #[serde(default, rename = "as")]
    pub kind: MeshKind,
    /// The position of the frame of the file.
    #[serde(default)]
    pub position: PoseFile,
    /// The collision groups of the objects.
    #[serde(default)]
    pub groups: GroupsFile,
    /// The query type of their pairs: contacts or proximity.
    #[serde(default)]
    pub query: QueryTypeFile,
    /// The motion of the objects.
    #[serde(default)]
    pub motion: MotionFile,
}

impl MeshesFile {
    /// Creates the entry for all parts of the file at `path`: unscaled, at the origin, at rest, and
    /// in all groups.
    #[must_use]
    pub fn new(path: &Path) -> Self {
        Self {
            name: None,
            path: path.to_owned(),
            scale: ScaleFile::default(),
            kind: MeshKind::default(),
            position: PoseFile::default(),
            groups: GroupsFile::default(),
            query: QueryTypeFile::default(),
            motion: MotionFile::default(),
        }
    }
}

/// A position: first the rotation, then the translation.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct PoseFile {
    /// The translation; without, zero.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub translation: Option<Vec<f64>>,
    /// The rotation; without, the identity.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub rotation: Option<RotationFile>,
}

/// A rotation: an object with one member. `degrees` and `radians` are for 2D, the others for 3D.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum RotationFile {
    /// A quaternion x, y, z, w of any length but 0.
    Quaternion([f64; 4]),
    /// Three rotations about the axes.
    Euler {
        /// The axes in the order of the rotations: lower case for the fixed axes of the parent, upper case for the
        /// rotated axes. Roll, pitch and yaw are `xyz`.
        order: RotationOrder,
        /// The angles, in that order.
        degrees: [f64; 3],
    },
    /// A rotation about an axis.
    AxisAngle {
        /// The axis, of any length but 0.
        axis: [f64; 3],
        /// The angle, counter-clockwise seen against the axis.
        degrees: f64,
    },
    /// In 2D, counter-clockwise.
    Degrees(f64),
    /// In 2D, counter-clockwise.
    Radians(f64),
}

/// An order of rotations about axes.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "lowercase")]
#[expect(missing_docs, reason = "the names are the axes")]
pub enum RotationOrder {
    Xyz,
    Xzy,
    Yxz,
    Yzx,
    Zxy,
    Zyx,
    #[serde(rename = "XYZ")]
    OwnXyz,
    #[serde(rename = "XZY")]
    OwnXzy,
    #[serde(rename = "YXZ")]
    OwnYxz,
    #[serde(rename = "YZX")]
    OwnYzx,
    #[serde(rename = "ZXY")]
    OwnZxy,
    #[serde(rename = "ZYX")]
    OwnZyx,
}

impl RotationOrder {
    /// Returns the axes in the order of equivalent rotations about fixed axes. The flag is `true`
    /// if this order is the reverse of the written one.
    #[must_use]
    pub const fn fixed_axes(self) -> ([usize; 3], bool) {
        match self {
            Self::Xyz => ([0, 1, 2], false),
            Self::Xzy => ([0, 2, 1], false),
            Self::Yxz => ([1, 0, 2], false),
            Self::Yzx => ([1, 2, 0], false),
            Self::Zxy => ([2, 0, 1], false),
            Self::Zyx => ([2, 1, 0], false),
            Self::OwnXyz => ([2, 1, 0], true),
            Self::OwnXzy => ([1, 2, 0], true),
            Self::OwnYxz => ([2, 0, 1], true),
            Self::OwnYzx => ([0, 2, 1], true),
            Self::OwnZxy => ([1, 0, 2], true),
            Self::OwnZyx => ([0, 1, 2], true),
        }
    }
}

/// The collision groups of an object, numbered 0 to 29. Two objects interact if each is a member of a group that the
/// other whitelists, and neither is a member of a group that the other blacklists.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct GroupsFile {
    /// The groups that the object is a member of; without, all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub membership: Option<Vec<usize>>,
    /// The groups that the object interacts with; without, all.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub whitelist: Option<Vec<usize>>,
    /// The groups that the object does not interact with.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub blacklist: Vec<usize>,
    /// Whether the object is tested against itself.
    #[serde(default)]
    pub self_collision: bool,
}

/// The query type of the pairs of an object.
#[derive(Clone, Copy, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
pub enum QueryTypeFile {
    /// Contacts.
    Contacts {
        /// The object's share of the prediction, the distance up to which there are contact points.
        #[serde(default)]
        linear: f64,
        /// The object's share of the angular prediction, in radians: contact points also exist where a rotation of the
        /// solids by this angle would bring them within the prediction.
        #[serde(default)]
        angular: f64,
    },
    /// Proximity instead of contacts: the object's share of the margin.
    Proximity(f64),
}

impl Default for QueryTypeFile {
    fn default() -> Self {
        Self::Contacts { linear: 0.0, angular: 0.0 }
    }
}

/// Constant velocities, in the frame of the world.
#[derive(Clone, Debug, Default, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct MotionFile {
    /// The velocity of the origin of the object, in lengths per second.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub velocity: Option<Vec<f64>>,
    /// The angular velocity about the origin of the object, in radians per second.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub angular_velocity: Option<AngularVelocity>,
}

/// An angular velocity in radians per second: a number in 2D, a vector along the axis in 3D.
#[derive(Clone, Debug, PartialEq, Serialize, JsonSchema)]
#[serde(untagged)]
pub enum AngularVelocity {
    /// In 2D, counter-clockwise.
    Two(f64),
    /// In 3D.
    Three([f64; 3]),
}

impl<'de> Deserialize<'de> for AngularVelocity {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Ok(match OneOrThree::deserialize(deserializer)? {
            OneOrThree::One(speed) => Self::Two(speed),
            OneOrThree::Three(speed) => Self::Three(speed),
        })
    }
}

/// A grid of objects.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RepeatFile {
    /// The number of objects along each axis, 1 or more.
    pub count: Vec<usize>,
    /// The distance between neighbours along each axis of the world.
    pub spacing: Vec<f64>,
}
