//! The scenes, by idea. Each is made for a number of objects and is the same for the same number.

mod drift;
mod mixed;
mod pile;
mod room;
mod terrain;

pub use drift::{few_moving, mixed_sizes, sparse_drift, spawn_and_despawn};
pub use mixed::mixed_shapes;
pub use pile::{pile, tower};
pub use room::{Area, Room, room};
pub use terrain::{terrain_field, terrain_mesh};

use crate::SceneQuery;

/// What most objects ask: the sum over a pair is 0.002.
const NEAR_CONTACTS: SceneQuery = SceneQuery::Contacts { linear: 0.001, angular: 0.0 };
/// The loosening that suits objects of size 1 which move a few percent of that per step.
const MARGIN: f64 = 0.04;
