//! Scenes as data, shared by tests, examples and benchmarks.
//!
//! A scene is a list of objects and, for each, a motion that is a pure function of the number of the
//! step: a test can look at step 57 without the 56 before it, and two worlds that are stepped
//! alternately see the same thing.
//!
//! Everything is computed in `f64` with `+ − × ÷ √` and rounding alone, so that a scene is the same
//! on every platform. Positions and sizes are then rounded to `f32`: worlds of either scalar see the
//! same numbers. Turns are given by a direction and a tangent (see [`Placement`]), from which each
//! reader computes the rotation to the precision of its own scalar.
//!
//! Nothing here knows the library: shapes and groups are plain numbers.

#![forbid(unsafe_code)]

mod motion;
mod placement;
mod random;
mod scenes;
mod shape;

use std::ops::Range;

pub use motion::{Motion, Wave};
pub use placement::Placement;
pub use random::Random;
pub use scenes::{
    Area, Room, SolidKind, aligned_pile, asteroids, crowd, few_asteroids_moving, few_moving,
    mixed_shapes, mixed_sizes, pile, plates, rain, room, sensors, shaken, solids, solids_on_plain,
    sparse_drift, spawn_and_despawn, ten_moving, terrain_field, terrain_mesh, tower,
    trembling_vehicles_field, trembling_vehicles_mesh, turned_pile, vehicles_field, vehicles_mesh,
};
pub use shape::SceneShape;

/// Objects and how they move.
#[derive(Clone, Debug, Default)]
pub struct Scene<const D: usize> {
    /// One or two words, for tables and messages.
    pub name: &'static str,
    /// The loosening of bounding volumes that suits the scene.
    pub margin: f64,
    /// The objects; those not alive yet are among them.
    pub objects: Vec<SceneObject<D>>,
    /// How many steps make a run. Motions are defined beyond.
    pub steps: u32,
}

/// One object of a scene.
#[derive(Clone, Debug)]
pub struct SceneObject<const D: usize> {
    /// What it is.
    pub shape: SceneShape<D>,
    /// What is asked of its pairs.
    pub query: SceneQuery,
    /// With whom it interacts.
    pub groups: SceneGroups,
    /// Where it is at each step.
    pub motion: Motion<D>,
    /// The steps at which it exists.
    pub alive: Range<u32>,
}

/// What is asked of the pairs of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SceneQuery {
    /// Contact points.
    Contacts {
        /// The prediction as a distance.
        linear: f64,
        /// The prediction as an angle in radians.
        angular: f64,
    },
    /// How near others are.
    Proximity {
        /// Farther apart is disjoint.
        margin: f64,
    },
}

/// Lists of group numbers from 0 to 29.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneGroups {
    /// The groups that the object belongs to.
    pub membership: &'static [usize],
    /// The groups with which it interacts.
    pub whitelist: &'static [usize],
    /// The groups with which it does not; wins over the whitelist.
    pub blacklist: &'static [usize],
}

/// All groups that exist.
const ALL: [usize; 30] = [
    0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25,
    26, 27, 28, 29,
];

impl SceneGroups {
    /// Member of all, whitelists all, blacklists none.
    pub const EVERYBODY: Self = Self { membership: &ALL, whitelist: &ALL, blacklist: &[] };
}

impl<const D: usize> SceneObject<D> {
    /// An object that interacts with everybody, at all steps.
    fn new(shape: SceneShape<D>, query: SceneQuery, motion: Motion<D>) -> Self {
        Self { shape, query, groups: SceneGroups::EVERYBODY, motion, alive: 0..u32::MAX }
    }
}

impl<const D: usize> Scene<D> {
    /// Where an object is at a step; the same answer for the same arguments, always.
    ///
    /// # Panics
    /// If there is no object of this index.
    #[must_use]
    pub fn placement(&self, object: usize, step: u32) -> Placement<D> {
        self.objects[object].motion.at(step)
    }

    /// Whether an object exists at a step.
    ///
    /// # Panics
    /// If there is no object of this index.
    #[must_use]
    pub fn is_alive(&self, object: usize, step: u32) -> bool {
        self.objects[object].alive.contains(&step)
    }

    /// The least and the greatest corner of a box around an object at a step; `None` for a plane.
    ///
    /// # Panics
    /// If there is no object of this index.
    #[must_use]
    pub fn aabb(&self, object: usize, step: u32) -> Option<([f64; D], [f64; D])> {
        self.objects[object].shape.aabb(&self.placement(object, step))
    }
}

/// The value rounded to `f32`, as every world will see it.
#[expect(clippy::cast_possible_truncation, reason = "rounds to nearest, as documented")]
fn rounded(value: f64) -> f64 {
    f64::from(value as f32)
}
