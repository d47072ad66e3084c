//! Responses to the page as data. `PROTOCOL.md` describes their members.
//!
//! Points, vectors and boxes have three coordinates; the last is 0 in 2D. Numbers that are not
//! finite become `null` in JSON.

use impinge_samples::{Control, Entry, Readout};
use serde::Serialize;

/// The corner of a box with the least coordinates and the corner with the greatest coordinates;
/// `None` for an unbounded box.
pub type Ends = Option<[[f64; 3]; 2]>;

/// The response to a request for the samples.
#[derive(Clone, Debug, Serialize)]
pub struct Gallery {
    /// The samples in order.
    pub samples: &'static [Entry],
}

/// The description of a stage. Members that do not apply to a kind of stage are empty, zero,
/// `false` or `None`.
#[derive(Clone, Debug, Default, Serialize)]
pub struct Info {
    /// `recording`, `stream` or `sample`.
    pub kind: &'static str,
    /// The current step.
    pub step: usize,
    /// Sentences for readers about stand-ins and about lost parts of a recording.
    pub notes: Vec<String>,
    /// The dimension of the world: 2 or 3.
    pub dimension: usize,
    /// The scalar of the world: `f32` or `f64`.
    pub scalar: String,
    /// The name of a sample.
    pub name: String,
    /// The heading of a sample.
    pub title: String,
    /// The description of a sample.
    pub about: String,
    /// The program that wrote a recording.
    pub written_by: String,
    /// The number of updates of a recording so far; `None` for a sample.
    pub steps: Option<usize>,
    /// Whether the record that ends a recording was read. A stream has no such record before its
    /// end, and a recording has none if its program crashed.
    pub complete: bool,
    /// The time between two steps in seconds, at the normal speed of the page. Recordings have the
    /// value of samples, since they contain no time step.
    pub time_step: f64,
    /// A box around all bounded objects at the current step, for the camera.
    pub bounds: [[f64; 3]; 2],
    /// The axis that points up on the screen.
    pub up: [f64; 3],
    /// The changes at steps, in order of the steps.
    pub marks: Vec<StepMark>,
    /// The controls of a sample.
    pub controls: Vec<Control>,
}

/// The changes at a step. If there would be too many marks, the changes of several consecutive
/// steps are added up at the first of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize)]
pub struct StepMark {
    /// The step.
    pub step: usize,
    /// The number of pairs that started touching.
    pub started: u32,
    /// The number of pairs that stopped touching.
    pub stopped: u32,
    /// The number of pairs whose proximity changed.
    pub proximities: u32,
    /// The number of objects that were added.
    pub added: u32,
    /// The number of objects that were removed.
    pub removed: u32,
    /// The number of other changes: of shapes, groups, query types, data, filters, skins and fixed
    /// flags, and requests to filter again.
    pub changed: u32,
    /// The number of queries.
    pub queries: u32,
}

/// The state at a step.
#[derive(Clone, Debug, Serialize)]
pub struct Status {
    /// The step.
    pub step: usize,
    /// The number of objects.
    pub objects: usize,
    /// The number of pairs of the narrow phase.
    pub pairs: usize,
    /// The number of contact points.
    pub contacts: usize,
    /// The difference of a replay from its recording, as a text to be shown on the page; `None` if
    /// they agree.
    pub diverged: Option<String>,
    /// All notes of a recording (see [`Info::notes`]), if there are more than the page has; else
    /// empty.
    pub notes: Vec<String>,
    /// The events of the last update, up to a limit.
    pub events: Vec<StatusEvent>,
    /// The number of all events of the last update.
    pub event_count: usize,
    /// All controls of a sample, if their values differ from those that the page has; else empty.
    pub controls: Vec<Control>,
    /// The readouts of a sample.
    pub readouts: Vec<Readout>,
}

/// An event of an update.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum StatusEvent {
    /// Two objects started or stopped touching.
    Contact {
        /// `true` if the objects started touching, `false` if they stopped.
        started: bool,
        /// The index of the object with the smaller handle.
        a: usize,
        /// The index of the object with the larger handle.
        b: usize,
    },
    /// The proximity of two objects changed.
    Proximity {
        /// The index of the object with the smaller handle.
        a: usize,
        /// The index of the object with the larger handle.
        b: usize,
        /// The proximity before the update.
        before: &'static str,
        /// The proximity now.
        after: &'static str,
    },
}

/// A description of a shape.
#[derive(Clone, Debug, Serialize)]
pub struct ShapeText {
    /// The kind as a word.
    pub kind: &'static str,
    /// The kind and the sizes, as a text to be shown on the page.
    pub text: String,
}

/// A list of groups, or the word `all` for all 30 groups.
#[derive(Clone, Debug, PartialEq, Eq, Serialize)]
#[serde(untagged)]
pub enum GroupNumbers {
    /// The word `all`.
    All(&'static str),
    /// The indices of the groups.
    Some(Vec<usize>),
}

/// The groups of an object.
#[derive(Clone, Debug, Serialize)]
pub struct ShownGroups {
    /// The groups that the object is in.
    pub membership: GroupNumbers,
    /// The groups with which the object interacts.
    pub whitelist: GroupNumbers,
    /// The groups with which the object does not interact, even if they are in the whitelist.
    pub blacklist: GroupNumbers,
    /// Whether the object interacts with itself.
    pub self_collision: bool,
}

/// The query type of an object.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum ShownQuery {
    /// The query of the object is for contact points.
    Contacts {
        /// The object's share of the prediction.
        linear: f64,
        /// The object's share of the angular prediction, in radians.
        angular: f64,
    },
    /// The query of the object is for proximity.
    Proximity {
        /// The object's share of the proximity margin.
        margin: f64,
    },
}

/// A pair of the described object with another object, or with itself if it is tested against
/// itself.
#[derive(Clone, Copy, Debug, Serialize)]
#[serde(tag = "kind", rename_all = "lowercase")]
pub enum ShownPair {
    /// The contacts of the pair, as of the last update.
    Contacts {
        /// The index of the other object of the pair; the described object's own index in a pair
        /// with itself.
        object: usize,
        /// The number of contact points.
        contacts: usize,
        /// The depth of the deepest contact; negative if the objects are apart.
        depth: f64,
        /// Whether the pair has a contact point.
        touching: bool,
    },
    /// The proximity of the pair, as of the last update.
    Proximity {
        /// The index of the other object of the pair; the described object's own index in a pair
        /// with itself.
        object: usize,
        /// The proximity: `intersecting` or `within margin`.
        status: &'static str,
    },
}

/// The description of an object.
#[derive(Clone, Debug, Serialize)]
pub struct ObjectAnswer {
    /// The index of the object's handle.
    pub object: usize,
    /// The description of the object's shape.
    pub shape: ShapeText,
    /// The object's data as text.
    pub label: String,
    /// The position of the object's origin.
    pub translation: [f64; 3],
    /// The rotation, as a unit quaternion x, y, z, w.
    pub rotation: [f64; 4],
    /// The object's groups.
    pub groups: ShownGroups,
    /// The object's query type.
    pub query: ShownQuery,
    /// The object's AABB at its current position.
    pub tight_box: Ends,
    /// The object's fat AABB in the broad phase, as of the last update; also `None` before the
    /// first update.
    pub loosened_box: Ends,
    /// The object's pairs with contacts, or with a proximity other than `disjoint`, sorted by the
    /// handles of the other objects. Includes the object's pair with itself, if it has one.
    pub pairs: Vec<ShownPair>,
}

/// A contact of two shapes.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct ShownContact {
    /// The point on the first shape.
    pub a: [f64; 3],
    /// The point on the second shape.
    pub b: [f64; 3],
    /// The unit normal from the first shape to the second.
    pub normal: [f64; 3],
    /// The depth; positive if the shapes overlap.
    pub depth: f64,
}

/// A contact point of a manifold.
#[derive(Clone, Debug, Serialize)]
pub struct ManifoldPoint {
    /// The contact.
    #[serde(flatten)]
    pub contact: ShownContact,
    /// The features of both shapes that the contact belongs to, as text.
    pub features: String,
}

/// A manifold.
#[derive(Clone, Debug, Serialize)]
pub struct ShownManifold {
    /// The contact points of the manifold.
    pub contacts: Vec<ManifoldPoint>,
}

/// The result of one of the conditions for two objects to touch.
#[derive(Clone, Debug, Serialize)]
pub struct Test {
    /// The name of the condition: `groups`, `filter`, `boxes` or `distance`.
    pub name: &'static str,
    /// Whether the condition is satisfied.
    pub passes: bool,
    /// The explanation of the result.
    pub text: String,
}

/// The reason why two objects touch or do not touch.
#[derive(Clone, Debug, Serialize)]
pub struct Why {
    /// Whether the objects touch in the world, as of the last update.
    pub touch: bool,
    /// The reason, as a sentence to be shown on the page.
    pub text: String,
    /// The results of all conditions, in the order in which a world tests them.
    pub tests: Vec<Test>,
}

/// The description of a pair of objects.
#[derive(Clone, Debug, Serialize)]
pub struct PairAnswer {
    /// The index of the first object.
    pub a: usize,
    /// The index of the second object.
    pub b: usize,
    /// The distance between the objects; 0 if they touch or overlap.
    pub distance: f64,
    /// The closest points of the objects; `None` if the objects touch or overlap.
    pub points: Option<[[f64; 3]; 2]>,
    /// The contact of the objects; `None` if their distance exceeds the prediction.
    pub contact: Option<ShownContact>,
    /// The proximity as a word. Objects are within the margin up to the sum of the margins of those
    /// that have proximity queries, or up to the sum of their predictions and skins if neither has.
    pub proximity: &'static str,
    /// The manifolds of the pair in the world, as of the last update.
    pub manifolds: Vec<ShownManifold>,
    /// The reason why the objects touch or do not touch.
    pub why: Why,
}

/// The object at a point on the screen.
#[derive(Clone, Copy, Debug, Default, Serialize)]
pub struct Picked {
    /// The index of the object; `None` if there is none at the point. The other members are then
    /// zero.
    pub object: Option<usize>,
    /// The hit point; in 2D the point of the object nearest to the requested point.
    pub point: [f64; 3],
    /// The outward normal at the hit point; zero in 2D.
    pub normal: [f64; 3],
    /// The time of the hit: the distance divided by the length of the direction; zero in 2D.
    pub time: f64,
}

/// An object that a ray hits.
#[derive(Clone, Debug, Serialize)]
pub struct RayHit {
    /// The index of the object.
    pub object: usize,
    /// The hit point.
    pub point: [f64; 3],
    /// The outward normal at the hit point; zero if the ray begins inside the object.
    pub normal: [f64; 3],
    /// The time of the hit: the distance divided by the length of the direction.
    pub time: f64,
    /// The feature of the shape that is hit, as text.
    pub feature: String,
}

/// The hits of a ray.
#[derive(Clone, Debug, Serialize)]
pub struct RayAnswer {
    /// The hits in order of time.
    pub hits: Vec<RayHit>,
}

/// An object near a point.
#[derive(Clone, Copy, Debug, Serialize)]
pub struct NearObject {
    /// The index of the object.
    pub object: usize,
    /// The distance from the requested point; 0 if the object contains it.
    pub distance: f64,
    /// The point of the object nearest to the requested point.
    pub point: [f64; 3],
}

/// The objects near a point.
#[derive(Clone, Debug, Serialize)]
pub struct NearestAnswer {
    /// The objects in order of distance.
    pub nearest: Vec<NearObject>,
}

/// The response to a request for a frame: a text, and the bytes to which the text refers.
#[derive(Clone, Debug)]
pub struct Frame {
    /// The JSON text.
    pub text: String,
    /// The bytes of all sections.
    pub payload: Vec<u8>,
}
