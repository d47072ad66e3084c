//! Scenes as data, shared by tests, examples and benchmarks.
//!
//! A scene is a list of objects, each with a motion that is a pure function of the step number. So
//! a test can compute step 57 without any earlier step, and two worlds that are stepped alternately
//! get the same input.
//!
//! Everything is computed in `f64` with `+ − × ÷ √` and rounding alone, so that a scene is the same
//! on every platform. Positions and sizes are then rounded to `f32`, so that worlds of both scalars
//! get equal numbers. A rotation is stored as an axis and a tangent (see [`Placement`]), from which
//! each program that runs the scene computes the rotation in the precision of its own scalar.
//!
//! This crate does not depend on the library: shapes and groups are plain numbers.

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

/// A scene: objects and their motions.
#[derive(Clone, Debug, Default)]
pub struct Scene<const D: usize> {
    /// The name, one or two words, for tables and messages.
    pub name: &'static str,
    /// The margin of the broad phase that suits the scene.
    pub margin: f64,
    /// The objects, including those that are not alive yet.
    pub objects: Vec<SceneObject<D>>,
    /// The number of steps of a run. Motions are defined for later steps too.
    pub steps: u32,
}

/// One object of a scene.
#[derive(Clone, Debug)]
pub struct SceneObject<const D: usize> {
    /// The shape, in its local frame.
    pub shape: SceneShape<D>,
    /// The query type of its pairs.
    pub query: SceneQuery,
    /// The collision groups.
    pub groups: SceneGroups,
    /// The motion: the placement at each step.
    pub motion: Motion<D>,
    /// The steps at which the object is alive, that is, part of the world.
    pub alive: Range<u32>,
}

/// The query type of the pairs of an object.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum SceneQuery {
    /// Contact points.
    Contacts {
        /// The prediction as a distance.
        linear: f64,
        /// The prediction as an angle in radians.
        angular: f64,
    },
    /// The proximity to other objects.
    Proximity {
        /// The margin: objects farther apart are disjoint.
        margin: f64,
    },
}

/// Collision groups as lists of indices from 0 to 29.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct SceneGroups {
    /// The groups that the object belongs to.
    pub membership: &'static [usize],
    /// The groups with which the object interacts.
    pub whitelist: &'static [usize],
    /// The groups with which the object does not interact; it overrides the whitelist.
    pub blacklist: &'static [usize],
}

/// The indices of all groups.
const ALL: [usize; 30] = [
    0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18, 19, 20, 21, 22, 23, 24, 25,
    26, 27, 28, 29,
];

impl SceneGroups {
    /// A member of all groups, which whitelists all groups and blacklists none.
    pub const EVERYBODY: Self = Self { membership: &ALL, whitelist: &ALL, blacklist: &[] };
}

impl<const D: usize> SceneObject<D> {
    /// Creates an object that interacts with every object and is alive at all steps.
    fn new(shape: SceneShape<D>, query: SceneQuery, motion: Motion<D>) -> Self {
        Self { shape, query, groups: SceneGroups::EVERYBODY, motion, alive: 0..u32::MAX }
    }
}

impl<const D: usize> Scene<D> {
    /// Returns the placement of an object at a step: a pure function of the arguments.
    ///
    /// # Panics
    /// If there is no object of this index.
    #[must_use]
    pub fn placement(&self, object: usize, step: u32) -> Placement<D> {
        self.objects[object].motion.at(step)
    }

    /// Whether an object is alive at a step.
    ///
    /// # Panics
    /// If there is no object of this index.
    #[must_use]
    pub fn is_alive(&self, object: usize, step: u32) -> bool {
        self.objects[object].alive.contains(&step)
    }

    /// Returns the least and the greatest corner of a box around an object at a step; `None` for a
    /// plane.
    ///
    /// # Panics
    /// If there is no object of this index.
    #[must_use]
    pub fn aabb(&self, object: usize, step: u32) -> Option<([f64; D], [f64; D])> {
        self.objects[object].shape.aabb(&self.placement(object, step))
    }
}

/// Rounds a value to `f32`, so that worlds of both scalars get equal numbers.
#[expect(clippy::cast_possible_truncation, reason = "rounds to nearest, as documented")]
fn rounded(value: f64) -> f64 {
    f64::from(value as f32)
}
