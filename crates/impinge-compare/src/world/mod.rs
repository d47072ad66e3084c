//! The suite of whole worlds. Every contender gets the new poses of moved objects, updates, and
//! reads every contact point; only this is timed. Looking up the poses and converting them is not.
//! On every tenth step the touching pairs of all contenders are compared, since times of different
//! results cannot be compared.
//!
//! All contenders use `f32`, the same prediction and almost the same margin of boxes, as far as
//! they can be set. Two objects touch here if they have a contact point within the prediction.
//!
//! # Scenes
//! The scenes in 2D and in 3D, with sizes that follow `--objects`:
//!
//! - a pile in which all boxes overlap their neighbours and move; boxes that drift freely, ten
//!   times as many; boxes of which one in a hundred moves; all kinds of shapes above a half-space;
//! - solids on a terrain, with 100 triangles (in 2D 10 segments) for each solid, as a mesh and as a
//!   height field; the pile and the mesh also with all motions slowed down to a hundredth
//!   ("trembling");
//! - boxes, hulls and capsules as large as vehicles, a twentieth of `--objects`, each on dozens of
//!   triangles of a mesh or a height field, driving slowly or trembling by 0.001;
//! - a rain of solids; distant floating rocks, all or one in a hundred of which move; sensors with
//!   proximity queries among drifting boxes; churn, in which each step removes a hundredth of the
//!   boxes and adds as many; ten times as many boxes of which ten move; towers at rest; in 2D, a
//!   crowd;
//! - boxes in a pile that are aligned, or rotated at random; solids of several kinds in free space,
//!   dense and loose, and of each kind alone;
//! - on a rough plain, plates that each cover up to 512 triangles, a hundredth of `--objects`, and
//!   other solids that move by 0.1 at each step, a twentieth of `--objects`;
//! - shaken scenes, in which each step displaces every object at random by up to 0.001.
//!
//! `--angular` adds an angular prediction to all contacts. The rivals have none and compute their
//! usual results.
//!
//! "impinge" recomputes everything. "impinge stream" does, too, but its contacts are read through a
//! `ContactStream`. In "impinge reusing" each pair keeps its contacts until it has moved by half of
//! the prediction.
//!
//! # Rivals
//! rapier's `CollisionPipeline`, which has the same purpose as the world of impinge, runs in all
//! scenes. So does the tree of parry with a map of pairs and manifolds of parry, as a user would
//! write it.
//!
//! The other rivals are engines with dynamics, each behind a feature of its name, all of them
//! behind `c`. `impinge-compare-c` describes how each is used and which part of its dynamics still
//! runs: for Box2D and Box3D only their lists of islands and constraints, for Jolt two passes over
//! the bodies. They lack half-spaces, single triangles or segments, and so do not run the mixed
//! shapes. They do not run sensors and churn.
//!
//! - Box2D and Box3D (through `boxdd-sys`, `boxddd-sys`) are compiled with `-O3 -DNDEBUG`. Each
//!   runs twice: recomputing each contact, as impinge does, and with its default recycling, where
//!   the points of a pair stay fixed on both objects until these have moved by 0.05 relative to
//!   each other. Their prediction is ten times that of impinge. Sleep, their only way to skip
//!   objects at rest, is off: where few objects move, they still visit all contacts. A pose that is
//!   set from outside removes the box from the tree and inserts it again if it has left its fat
//!   AABB; a box that the solver moves is only enlarged, and the tree is repaired later. So in
//!   scenes in which all objects drift they are slower here than in a game.
//! - Jolt (through `oxijolt-sys`): its own build uses AVX2, even where impinge does not. Its
//!   contacts are read in a callback, so its reading is part of the step. All of its bodies stay
//!   awake, too. It runs twice: with the exact edges of the scene, and with its default rounding of
//!   0.05, with which it has other results but computes depths less often.
//!
//! # Omitted rivals
//! `joltc-sys`, another binding of Jolt, has no contact listener, so that points cannot be read.
//! The safe crates above `boxdd-sys` and `boxddd-sys` look up each handle in registries of their
//! own, which would count as time of the engines. `box3d-sys` needs libclang, and has the same
//! content as `boxddd-sys`.
pub mod contender;
#[cfg(any(feature = "box2d", feature = "box3d", feature = "jolt"))]
mod engines;
pub mod ours;
mod parry_tree;
pub mod rapier;
pub mod stages;
mod streaming;

#[cfg(feature = "jolt")]
use impinge_compare_c::Jolt;
#[cfg(any(feature = "box2d", feature = "box3d"))]
use impinge_compare_c::Recycling;

use ::impinge;
use contender::{Contender, Entrant, KINDS, race};
use impinge_scenes::Scene;
pub use stages::PREDICTION;
use stages::{Stage, plane_stages, space_stages, stages};
use streaming::Streaming;

use crate::Arguments;
use crate::table::Table;

/// A function that creates a world with the objects of a scene at step 0; `None` if the contender
/// lacks a shape.
type Maker<const D: usize> = fn(&Scene<D>) -> Option<Box<dyn Contender<D>>>;

/// Runs all scenes.
pub fn run(arguments: &Arguments) -> Vec<Table> {
    let mut table = Table::new("world", "ms");
    let plane: &[(&str, Maker<2>)] = &[
        ("impinge", |scene| Some(Box::new(ours::plane(scene)))),
        ("impinge stream", |scene| Some(Box::new(Streaming::new(ours::plane(scene))))),
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
        ("impinge stream", |scene| Some(Box::new(Streaming::new(ours::space(scene))))),
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
    run_stages(plane, &plane_stages(), arguments, &mut table);
    run_stages(space, &stages(), arguments, &mut table);
    run_stages(space, &space_stages(), arguments, &mut table);
    vec![table]
}

fn run_stages<const D: usize>(
    makers: &[(&'static str, Maker<D>)],
    stages: &[Stage<D>],
    arguments: &Arguments,
    table: &mut Table,
) {
    let angular = arguments.angular;
    let angle = if angular == 0.0 { String::new() } else { format!(", {angular} rad") };
    for stage in stages {
        let (name, count) = (stage.name, stage.count(arguments.objects));
        let cases = KINDS.map(|kind| format!("{name} {D}D, {count}{angle}: {kind}"));
        if !cases.iter().any(|case| arguments.wants_case(case)) {
            continue;
        }
        let scene = stage.scene(arguments.objects, angular);
        let wanted = makers.iter().filter(|(name, _)| arguments.wants_contender(name));
        let made = wanted.filter_map(|(name, make)| Some(Entrant { name, world: make(&scene)? }));
        let mut rows = race(&scene, made.collect(), arguments.steps, &cases);
        rows.retain(|row| arguments.wants_case(&row.case));
        table.add(rows);
    }
}
