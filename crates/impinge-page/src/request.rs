//! Requests of the page as data. `PROTOCOL.md` describes their members.

use serde::Deserialize;
use serde_json::Value;

/// A request of the page. The member `do` selects the variant.
#[derive(Debug, Deserialize)]
#[serde(tag = "do", rename_all = "lowercase")]
pub(crate) enum Request {
    Samples,
    Open(Opening),
    Push,
    Seek {
        step: u64,
    },
    Advance {
        #[serde(default = "one")]
        steps: u64,
    },
    Reset,
    Control {
        name: String,
        #[serde(default)]
        value: Value,
    },
    Frame(FrameRequest),
    Object {
        object: u32,
    },
    Pair {
        a: u32,
        b: u32,
    },
    Pick(PickRequest),
    Ray(RayRequest),
    Nearest(NearestRequest),
    Drag(DragRequest),
}

const fn one() -> u64 {
    1
}

/// The kind of stage to open.
#[derive(Debug, Deserialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub(crate) enum Opening {
    Recording,
    Stream,
    Sample { name: String },
}

/// A request for a frame: the layers and the selected objects that it shows.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
pub struct FrameRequest {
    /// The names of the visible layers.
    pub layers: Vec<String>,
    /// The indices of the selected objects. Their boxes and contacts are drawn even if the layers
    /// of boxes and contacts are invisible.
    pub selected: Vec<u32>,
    /// The number of mesh ids that the page has received. Meshes with smaller ids are not sent
    /// again.
    pub known: u32,
}

/// A request for the object at a point on the screen. The point is given in 3D by the ray through
/// it, in 2D by its coordinates.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct PickRequest {
    /// The origin of the ray; in 2D the point.
    pub from: [f64; 3],
    /// The direction of the ray, of any length; ignored in 2D.
    #[serde(default)]
    pub direction: [f64; 3],
    /// In 2D, the maximum distance of an object that does not contain the point.
    #[serde(default)]
    pub reach: f64,
}

/// A ray whose points are `from + time * direction`.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct RayRequest {
    /// The origin of the ray.
    pub from: [f64; 3],
    /// The direction of the ray, of any length.
    pub direction: [f64; 3],
    /// The maximum time; without it the ray is unbounded.
    #[serde(default)]
    pub longest: Option<f64>,
}

/// A request for the objects nearest to a point.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct NearestRequest {
    /// The point.
    pub point: [f64; 3],
    #[serde(default = "one")]
    /// The maximum number of objects.
    pub count: u64,
}

/// A request to move an object by hand.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct DragRequest {
    /// The index of the object.
    pub object: u32,
    /// The new position of the object's origin.
    pub translation: [f64; 3],
    /// The new rotation: a quaternion x, y, z, w of any length but zero. If it is `None`, the
    /// object keeps its rotation.
    #[serde(default)]
    pub rotation: Option<[f64; 4]>,
}
