//! The scenes, by subject. Each constructor takes the number of objects; the same arguments give
//! the same scene.

mod asteroids;
mod crowd;
mod drift;
mod mixed;
mod pile;
mod plain;
mod rain;
mod room;
mod shaken;
mod solids;
mod terrain;
mod vehicles;

pub use asteroids::{asteroids, few_asteroids_moving};
pub use crowd::crowd;
pub use drift::{few_moving, mixed_sizes, sensors, sparse_drift, spawn_and_despawn, ten_moving};
pub use mixed::mixed_shapes;
pub use pile::{aligned_pile, pile, tower, turned_pile};
pub use plain::{plates, solids_on_plain};
pub use rain::rain;
pub use room::{Area, Room, room};
pub use shaken::shaken;
pub use solids::{SolidKind, solids};
pub use terrain::{terrain_field, terrain_mesh};
pub use vehicles::{
    trembling_vehicles_field, trembling_vehicles_mesh, vehicles_field, vehicles_mesh,
};

use crate::SceneQuery;

/// The query type of most objects. The prediction of a pair is the sum of both predictions, 0.002.
const NEAR_CONTACTS: SceneQuery = SceneQuery::Contacts { linear: 0.001, angular: 0.0 };
/// The margin for objects of size 1 that move a few percent of their size per step.
const MARGIN: f64 = 0.04;
