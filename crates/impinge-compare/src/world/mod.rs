//! The suite of whole worlds: every contender is told the new poses of what moved, updates, and reads
//! every contact point; only this is timed. Looking up the poses and converting them is not. On every
//! tenth step the touching pairs of all are compared: a time for another answer is no time.
//!
//! All sides use `f32`, the same prediction and as good as the same loosening of boxes, as far as they
//! let one choose. Two objects touch here if they have a contact point not farther apart than that.
//!
//! # Scenes
//! In the plane and in space: a pile in which all boxes overlap their neighbours and move, ten times as
//! many boxes drifting apart, boxes of which one in a hundred moves, all kinds of shapes above a plane,
//! and solids on a ground of 100 triangles (in the plane 10 segments) each, given as a mesh and as a
//! height field. Their size follows `--objects`. The pile and the mesh come a second time, trembling: all
//! move, by a hundredth of that.
//!
//! Then boxes, hulls and capsules as large as vehicles, a twentieth of `--objects`, each on dozens of the
//! triangles of a mesh or a height field, driving slowly or trembling in place by 0.001; a rain of solids;
//! rocks that float far apart; sensors, which ask for proximity, among boxes that drift; churn, where a
//! hundredth of the boxes is removed and as many are added at each step; and, in the plane, a crowd.
//!
//! `--angular` has all ask for contacts with an angular prediction. The rivals have none: they answer
//! what they always do.
//!
//! Everything is computed anew in "impinge". In "impinge reusing" pairs keep their contacts until they have
//! moved by half of the prediction.
//!
//! # Rivals
//! rapier's `CollisionPipeline`, made for the same purpose as our world, runs everywhere, and so does
//! parry's tree with a map of pairs and parry's manifolds, as one would write it oneself.
//!
//! The rest are engines with dynamics, each behind a feature of its name, all of them behind `c`.
//! `impinge-compare-c` says how each is driven and what of its dynamics is left: of Box2D and Box3D
//! nothing but their lists of islands and constraints, of Jolt two passes over the bodies. They lack
//! planes, single triangles or segments and are absent from the mixed shapes, and they are not driven
//! through sensors and churn.
//!
//! - Box2D and Box3D (through `boxdd-sys`, `boxddd-sys`): compiled with `-O3 -DNDEBUG`. They run twice:
//!   computing each contact anew, as we do, and, called recycling, as by default, where the points of a
//!   pair stay as they are on both objects until these have moved by 0.05 against one another. Their
//!   prediction is ten times ours, and there is no rest but sleep, which is off: where few objects move,
//!   they look at all contacts still. A pose that is set from outside takes the box out of the tree and
//!   puts it in anew if it has left its loosened box; what the solver moves only has its box enlarged, and
//!   the tree mended at once. So the scenes in which all drift show them slower than they are in a game.
//! - Jolt (through `oxijolt-sys`): its own build asks for AVX2, also where we do not. Its contacts are
//!   read in a callback, so its reading is part of the step. All of its bodies stay awake, likewise. It
//!   runs twice: with the edges of the scene, and rounded by 0.05, as by default, where it has another
//!   answer but need not search for depths as often.
//!
//! # Rivals left out
//! `joltc-sys`, another way to Jolt, has no listener of contacts: no point could be read. The safe crates
//! above `boxdd-sys` and `boxddd-sys` look up each name in registries of their own, which would be
//! charged to the engines. `box3d-sys` needs libclang, and has what `boxddd-sys` has.
pub mod contender;
#[cfg(any(feature = "box2d", feature = "box3d", feature = "jolt"))]
mod engines;
pub mod ours;
mod parry_tree;
pub mod rapier;

#[cfg(feature = "jolt")]
use impinge_compare_c::Jolt;
#[cfg(any(feature = "box2d", feature = "box3d"))]
use impinge_compare_c::Recycling;

use contender::{Contender, Entrant, KINDS, race};
use impinge_scenes::{
    Motion, Scene, SceneQuery, asteroids, crowd, few_moving, mixed_shapes, pile, rain, sensors,
    sparse_drift, spawn_and_despawn, terrain_field, terrain_mesh, trembling_vehicles_field,
    trembling_vehicles_mesh, vehicles_field, vehicles_mesh,
};

use crate::Arguments;
use crate::table::Table;

/// Two objects whose distance is at most this have contact points: the sum of what the objects of
/// the scenes ask for.
pub const PREDICTION: f32 = 0.002;

/// Makes a world with the objects of a scene as they are at step 0; none where it lacks a shape.
type Maker<const D: usize> = fn(&Scene<D>) -> Option<Box<dyn Contender<D>>>;

/// A scene of the suite.
struct Stage<const D: usize> {
    name: &'static str,
    /// Makes it, of so many objects.
    make: fn(usize) -> Scene<D>,
    /// How many objects it has where so many are asked for.
    count: fn(usize) -> usize,
    /// Whether those of its objects that ask for proximity still do; elsewhere all ask for contacts.
    has_sensors: bool,
}

impl<const D: usize> Stage<D> {
    /// As many objects as are asked for, all of which ask for contacts.
    const fn new(name: &'static str, make: fn(usize) -> Scene<D>) -> Self {
        Self { name, make, count: |objects| objects, has_sensors: false }
    }

    /// A twentieth of the objects that are asked for, at least one.
    const fn large(name: &'static str, make: fn(usize) -> Scene<D>) -> Self {
        Self { count: |objects| objects.div_ceil(20), ..Self::new(name, make) }
    }
}

/// Runs all scenes.
pub fn run(arguments: &Arguments) -> Vec<Table> {
    let mut table = Table::new("world", "ms");
    let plane: &[(&str, Maker<2>)] = &[
        ("impinge", |scene| Some(Box::new(ours::plane(scene)))),
        ("impinge reusing", |scene| Some(Box::new(ours::plane(scene).reusing()))),
        ("rapier", |scene| Some(Box::new(rapier::plane::Rapier::new(scene)))),
        ("parry+tree", |scene| Some(Box::new(parry_tree::plane::ParryTree::new(scene)))),
        #[cfg(feature = "box2d")]
        ("box2d", |scene| engines::box2d(scene, Recycling::Off)),
        #[cfg(feature = "box2d")]
        ("box2d recycling", |scene| engines::box2d(scene, Recycling::On)),
    ];
    let space: &[(&str, Maker<3>)] = &[
        ("impinge", |scene| Some(Box::new(ours::space(scene)))),
        ("impinge reusing", |scene| Some(Box::new(ours::space(scene).reusing()))),
        ("rapier", |scene| Some(Box::new(rapier::space::Rapier::new(scene)))),
        ("parry+tree", |scene| Some(Box::new(parry_tree::space::ParryTree::new(scene)))),
        #[cfg(feature = "box3d")]
        ("box3d", |scene| engines::box3d(scene, Recycling::Off)),
        #[cfg(feature = "box3d")]
        ("box3d recycling", |scene| engines::box3d(scene, Recycling::On)),
        #[cfg(feature = "jolt")]
        ("jolt", |scene| engines::jolt(scene, 0.0)),
        #[cfg(feature = "jolt")]
        ("jolt rounded", |scene| engines::jolt(scene, Jolt::CONVEX_RADIUS)),
    ];
    run_stages(plane, &stages(), arguments, &mut table);
    run_stages(plane, &[Stage::new("crowd", crowd)], arguments, &mut table);
    run_stages(space, &stages(), arguments, &mut table);
    vec![table]
}

/// The scenes, all of which ask for contacts with the same prediction: rapier has one for all.
fn stages<const D: usize>() -> [Stage<D>; 16] {
    [
        Stage::new("pile", pile),
        Stage { count: |objects| 10 * objects, ..Stage::new("sparse drift", sparse_drift) },
        Stage::new("1 % moving", few_moving),
        Stage::new("mixed shapes", mixed_shapes),
        Stage::new("terrain mesh", terrain_mesh),
        Stage::new("terrain field", terrain_field),
        Stage::new("trembling pile", |count| trembling(pile(count))),
        Stage::new("trembling terrain", |count| trembling(terrain_mesh(count))),
        Stage::large("vehicles on mesh", vehicles_mesh),
        Stage::large("vehicles on field", vehicles_field),
        Stage::large("trembling vehicles on mesh", trembling_vehicles_mesh),
        Stage::large("trembling vehicles on field", trembling_vehicles_field),
        Stage::new("rain", rain),
        Stage::new("asteroids", asteroids),
        Stage { has_sensors: true, ..Stage::new("sensors", sensors) },
        Stage::new("churn", spawn_and_despawn),
    ]
}

/// The same scene a hundred times as slow, about as things move that come to rest.
fn trembling<const D: usize>(mut scene: Scene<D>) -> Scene<D> {
    for Motion { place, tangent, .. } in scene.objects.iter_mut().map(|object| &mut object.motion) {
        place.iter_mut().chain([tangent]).for_each(|wave| wave.speed /= 100.0);
    }
    scene
}

fn run_stages<const D: usize>(
    makers: &[(&'static str, Maker<D>)],
    stages: &[Stage<D>],
    arguments: &Arguments,
    table: &mut Table,
) {
    let angular = arguments.angular;
    let angle = if angular == 0.0 { String::new() } else { format!(", {angular} rad") };
    for Stage { name, make, count, has_sensors } in stages {
        let count = count(arguments.objects);
        let cases = KINDS.map(|kind| format!("{name} {D}D, {count}{angle}: {kind}"));
        if !cases.iter().any(|case| arguments.wants_case(case)) {
            continue;
        }
        let scene = make(count);
        let scene = if *has_sensors {
            predicting(scene, angular)
        } else {
            asking_for_contacts(scene, angular)
        };
        let wanted = makers.iter().filter(|(name, _)| arguments.wants_contender(name));
        let made = wanted.filter_map(|(name, make)| Some(Entrant { name, world: make(&scene)? }));
        let mut rows = race(&scene, made.collect(), arguments.steps, &cases);
        rows.retain(|row| arguments.wants_case(&row.case));
        table.add(rows);
    }
}

/// The same scene, all of whose objects ask for contacts, with these predictions.
pub fn asking_for_contacts<const D: usize>(mut scene: Scene<D>, angular: f64) -> Scene<D> {
    for object in &mut scene.objects {
        object.query = SceneQuery::Contacts { linear: 0.0, angular: 0.0 };
    }
    predicting(scene, angular)
}

/// The same scene, in which the sums over a pair of what is asked for are the prediction and an angle in
/// radians, where contacts are asked for.
fn predicting<const D: usize>(mut scene: Scene<D>, angular: f64) -> Scene<D> {
    let linear = f64::from(PREDICTION) / 2.0;
    for object in &mut scene.objects {
        if matches!(object.query, SceneQuery::Contacts { .. }) {
            object.query = SceneQuery::Contacts { linear, angular: angular / 2.0 };
        }
    }
    scene
}
