//! Messages of the page as data: the members of `PROTOCOL.md`.

use serde::Deserialize;
use serde_json::Value;

/// A request of the page; each variant is a value of `do`.
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

/// The content of a frame.
#[derive(Clone, Debug, Default, Deserialize)]
#[serde(default)]
pub struct FrameRequest {
    /// Names of layers.
    pub layers: Vec<String>,
    /// Objects whose boxes and contacts are drawn whatever the layers are.
    pub selected: Vec<u32>,
    /// The number of mesh ids that the page has received: meshes with smaller ids are not sent
    /// again.
    pub known: u32,
}

/// A point on the screen: in 3D the ray through it, in 2D the point `from`.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct PickRequest {
    /// The origin of the ray; in 2D the point.
    pub from: [f64; 3],
    /// Its direction, of any length; ignored in 2D.
    #[serde(default)]
    pub direction: [f64; 3],
    /// In 2D: the largest distance of an object that does not contain the point.
    #[serde(default)]
    pub reach: f64,
}

/// A ray whose points are `from + time * direction`.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct RayRequest {
    /// Its origin.
    pub from: [f64; 3],
    /// Its direction, of any length.
    pub direction: [f64; 3],
    /// The maximum time; without it the ray is unbounded.
    #[serde(default)]
    pub longest: Option<f64>,
}

/// The objects nearest to a point.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct NearestRequest {
    /// The point.
    pub point: [f64; 3],
    #[serde(default = "one")]
    /// The largest number of objects.
    pub count: u64,
}

/// A request to move an object by hand.
#[derive(Clone, Copy, Debug, Deserialize)]
pub struct DragRequest {
    /// The object.
    pub object: u32,
    /// The new position of its origin.
    pub translation: [f64; 3],
    /// A quaternion x, y, z, w of any length but zero; without it the object keeps its rotation.
    #[serde(default)]
    pub rotation: Option<[f64; 4]>,
}
