//! Answers to the page as data: the members of `PROTOCOL.md`.
//!
//! Points, vectors and boxes have three coordinates, of which the last is 0 in 2D. Numbers that are not finite become
//! `null` in JSON.

use impinge_samples::{Control, Entry, Readout};
use serde::Serialize;

/// The ends of a box: its least and its greatest coordinates. `None` for one with no end.
pub type Ends = Option<[[f64; 3]; 2]>;

/// The gallery.
#[derive(Clone, Debug, Serialize)]
pub struct Gallery {
    /// The samples in order.
    pub samples: &'static [Entry],
}

/// What a stage is. Members that a kind of stage has no value for are empty or zero.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Info {
    /// `recording`, `stream` or `sample`.
    pub kind: &'static str,
    /// The step that it stands at.
    pub step: usize,
    /// Sentences for people: stand-ins, and what of a recording was lost.
    pub notes: Vec<String>,
    /// 2 or 3.
    pub dimension: usize,
    /// `f32` or `f64`.
    pub scalar: String,
    /// The name of a sample.
    pub name: String,
    /// The heading.
    pub title: String,
    /// What to see.
    pub about: String,
    /// The program that wrote a recording.
    pub written_by: String,
    /// How many updates a recording has so far.
    pub steps: Option<usize>,
    /// The last record of a recording was read. A stream lacks it until it ends, a recording if its program died.
    pub complete: bool,
    /// Seconds from a step to the next, where nothing else is known of it.
    pub time_step: f64,
    /// A box of what there is, for the camera.
    pub bounds: [[f64; 3]; 2],
    /// The axis that points up on the screen.
    pub up: [f64; 3],
    /// What happened, in order of the steps.
    pub marks: Vec<StepMark>,
    /// The controls of a sample.
    pub controls: Vec<Control>,
}

/// What happened at a step; or in some steps from this one on, where there would be too many marks.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct StepMark {
    /// The step.
    pub step: usize,
    /// Pairs that began to touch.
    pub started: u32,
    /// Pairs that ceased to touch.
    pub stopped: u32,
    /// Pairs whose proximity changed.
    pub proximities: u32,
    /// Objects added.
    pub added: u32,
    /// Objects removed.
    pub removed: u32,
    /// Other shapes, groups, query types, data or filters.
    pub changed: u32,
    /// Queries asked.
    pub queries: u32,
}

/// How things are at a step.
#[derive(Clone, Debug, Serialize)]
pub struct Status {
    /// The step.
    pub step: usize,
    /// How many objects there are.
    pub objects: usize,
    /// How many pairs the narrow phase has.
    pub pairs: usize,
    /// How many contact points there are.
    pub contacts: usize,
    /// In what a replay differs from its recording, for people.
    pub diverged: Option<String>,
    /// The first events of the update.
    pub events: Vec<StatusEvent>,
    /// How many events the update had.
    pub event_count: usize,
    /// Controls, if some changed by themselves.
    pub controls: Vec<Control>,
    /// What a sample says.
    pub readouts: Vec<Readout>,
}

/// An event of an update.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum StatusEvent {
    /// Two objects began or ceased to touch.
    Contact {
        /// They began to.
        started: bool,
        /// The object whose handle comes first.
        a: usize,
        /// The other.
        b: usize,
    },
    /// The proximity of two objects changed.
    Proximity {
        /// The object whose handle comes first.
        a: usize,
        /// The other.
        b: usize,
        /// The proximity before the update.
        before: &'static str,
        /// The proximity now.
        after: &'static str,
    },
}

/// A shape in words.
#[derive(Clone, Debug, Serialize)]
pub struct ShapeText {
    /// A word.
    pub kind: &'static str,
    /// The word and the sizes.
    pub text: String,
}

/// Groups: some, or all 30.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum GroupNumbers {
    /// The word `all`.
    All(&'static str),
    /// Their numbers.
    Some(Vec<usize>),
}

/// The groups of an object.
#[derive(Clone, Debug, Serialize)]
pub struct ShownGroups {
    /// Those that the object is in.
    pub membership: GroupNumbers,
    /// Those that it interacts with.
    pub whitelist: GroupNumbers,
    /// Those that it does not interact with.
    pub blacklist: GroupNumbers,
    /// It is tested against itself.
    pub self_collision: bool,
}

/// What is asked of the pairs of an object.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum ShownQuery {
    /// Contact points.
    Contacts {
        /// The share of the distance up to which there are contacts.
        linear: f64,
        /// The share of the angle, in radians.
        angular: f64,
    },
    /// Proximity.
    Proximity {
        /// The share of the distance up to which objects are near.
        margin: f64,
    },
}

/// A pair of an object.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum ShownPair {
    /// Contacts, as of the last update.
    Contacts {
        /// The other object.
        object: usize,
        /// How many contact points there are.
        contacts: usize,
        /// The depth of the deepest.
        depth: f64,
        /// There is a contact point.
        touching: bool,
    },
    /// Proximity, as of the last update.
    Proximity {
        /// The other object.
        object: usize,
        /// In words.
        status: &'static str,
    },
}

/// All about an object.
#[derive(Clone, Debug, Serialize)]
pub struct ObjectAnswer {
    /// The index of its handle.
    pub object: usize,
    /// Its shape.
    pub shape: ShapeText,
    /// Its data as text.
    pub label: String,
    /// Where its origin is.
    pub translation: [f64; 3],
    /// A quaternion x, y, z, w.
    pub rotation: [f64; 4],
    /// Its groups.
    pub groups: ShownGroups,
    /// What is asked of its pairs.
    pub query: ShownQuery,
    /// The box around it, there and then.
    pub tight_box: Ends,
    /// The box of the broad phase, as of the last update.
    pub loosened_box: Ends,
    /// Its pairs that touch or are near, in order of the other objects.
    pub pairs: Vec<ShownPair>,
}

/// A contact of two shapes.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ShownContact {
    /// The point on the first.
    pub a: [f64; 3],
    /// The point on the second.
    pub b: [f64; 3],
    /// From the first to the second.
    pub normal: [f64; 3],
    /// Positive where they overlap.
    pub depth: f64,
}

/// A contact point of a manifold.
#[derive(Clone, Debug, Serialize)]
pub struct ManifoldPoint {
    /// The contact.
    #[serde(flatten)]
    pub contact: ShownContact,
    /// The features of both that meet.
    pub features: String,
}

/// A manifold.
#[derive(Clone, Debug, Serialize)]
pub struct ShownManifold {
    /// Its points.
    pub contacts: Vec<ManifoldPoint>,
}

/// One of the reasons for which two objects touch, or do not.
#[derive(Clone, Debug, Serialize)]
pub struct Test {
    /// `groups`, `filter`, `boxes` or `distance`.
    pub name: &'static str,
    /// By this reason alone they might touch.
    pub passes: bool,
    /// Why.
    pub text: String,
}

/// Why two objects touch, or do not.
#[derive(Clone, Debug, Serialize)]
pub struct Why {
    /// What the world has.
    pub touch: bool,
    /// The reason, for people.
    pub text: String,
    /// All reasons, in the order in which a world asks them.
    pub tests: Vec<Test>,
}

/// All about two objects.
#[derive(Clone, Debug, Serialize)]
pub struct PairAnswer {
    /// The first object.
    pub a: usize,
    /// The second.
    pub b: usize,
    /// How far apart they are; 0 if they touch or overlap.
    pub distance: f64,
    /// The nearest points on both; `None` if they touch or overlap.
    pub points: Option<[[f64; 3]; 2]>,
    /// Their contact up to the prediction.
    pub contact: Option<ShownContact>,
    /// In words, by the margins of both.
    pub proximity: &'static str,
    /// The manifolds of the world, as of the last update.
    pub manifolds: Vec<ShownManifold>,
    /// Why they touch, or do not.
    pub why: Why,
}

/// The object at a point on the screen.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Picked {
    /// The object.
    pub object: Option<usize>,
    /// Where it is hit; in 2D its nearest point.
    pub point: [f64; 3],
    /// The outward normal there; zero in 2D.
    pub normal: [f64; 3],
    /// The time of the ray.
    pub time: f64,
}

/// An object that a ray hits.
#[derive(Clone, Debug, Serialize)]
pub struct RayHit {
    /// The object.
    pub object: usize,
    /// Where.
    pub point: [f64; 3],
    /// The outward normal there.
    pub normal: [f64; 3],
    /// The time of the ray.
    pub time: f64,
    /// What of the object is hit.
    pub feature: String,
}

/// What a ray hits.
#[derive(Clone, Debug, Serialize)]
pub struct RayAnswer {
    /// The hits in order of time.
    pub hits: Vec<RayHit>,
}

/// An object near a point.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct NearObject {
    /// The object.
    pub object: usize,
    /// How far it is; 0 if it holds the point.
    pub distance: f64,
    /// Its point that is nearest.
    pub point: [f64; 3],
}

/// What is near a point.
#[derive(Clone, Debug, Serialize)]
pub struct NearestAnswer {
    /// The objects in order of distance.
    pub nearest: Vec<NearObject>,
}

/// An answer and the bytes that it names.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The JSON text.
    pub text: String,
    /// The sections.
    pub payload: Vec<u8>,
}
