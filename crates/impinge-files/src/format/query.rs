//! Queries in a scene file.

use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{PoseFile, ShapeRef};

/// A query: an object with one member, whose name is the kind.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(rename_all = "snake_case")]
pub enum QueryFile {
    /// The objects that a ray hits.
    Ray(RayFile),
    /// The objects that a moving shape hits.
    Cast(CastFile),
}

/// A ray.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct RayFile {
    /// The origin.
    pub origin: Vec<f64>,
    /// The direction; times are multiples of its length.
    pub direction: Vec<f64>,
    /// The maximum time of a hit; without, there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_time: Option<f64>,
    /// Whether all hits are returned, not only the first.
    #[serde(default)]
    pub all: bool,
}

/// A shape that moves along a straight line.
#[derive(Clone, Debug, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct CastFile {
    /// The shape.
    pub shape: ShapeRef,
    /// The position at time zero.
    #[serde(default)]
    pub position: PoseFile,
    /// Its velocity.
    pub velocity: Vec<f64>,
    /// The maximum time of an impact; without, there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub max_time: Option<f64>,
    /// Whether all impacts are returned, not only the first.
    #[serde(default)]
    pub all: bool,
}
