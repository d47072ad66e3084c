//! Robots in a scene file.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::map::unique_keys;
use super::{GroupsFile, MeshKind, PoseFile, QueryTypeFile};

/// A robot from a URDF file: each link with collision elements becomes an object named `NAME/LINK`. 3D only.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RobotFile {
    /// The prefix of the names of the objects; without, the name of the robot in the file.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The URDF file, relative to the folder of the scene.
    pub urdf: PathBuf,
    /// An SRDF file: its `disable_collisions` pairs of links have no contacts, and neither have links that a joint connects.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub srdf: Option<PathBuf>,
    /// Folders in which the packages of `package://` paths are searched, relative to the folder of the scene.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub packages: Vec<PathBuf>,
    /// The values of joints by name, in radians or lengths; others are 0. Values beyond the limits of a joint are no
    /// error.
    #[serde(default, deserialize_with = "unique_keys", skip_serializing_if = "BTreeMap::is_empty")]
    pub joints: BTreeMap<String, f64>,
    /// The position of the root link.
    #[serde(default)]
    pub position: PoseFile,
    /// The kind of shape that is made of the triangles of its meshes.
    #[serde(default, rename = "as")]
    pub kind: MeshKind,
    /// The collision groups of the links, for other objects; pairs of links are disabled by additional groups.
    #[serde(default)]
    pub groups: GroupsFile,
    /// The query type of their pairs: contacts or proximity.
    #[serde(default)]
    pub query: QueryTypeFile,
}

impl RobotFile {
    /// Returns the robot of a URDF file at the origin, with all joints at 0 and in all groups.
    #[must_use]
    pub fn new(urdf: &Path) -> Self {
        Self {
            name: None,
            urdf: urdf.to_owned(),
            srdf: None,
            packages: Vec::new(),
            joints: BTreeMap::new(),
            position: PoseFile::default(),
            kind: MeshKind::default(),
            groups: GroupsFile::default(),
            query: QueryTypeFile::default(),
        }
    }
}
