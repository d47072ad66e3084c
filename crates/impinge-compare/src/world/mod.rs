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
//! rocks that float far apart, all or one in a hundred of which move; sensors, which ask for proximity,
//! among boxes that drift; churn, where a hundredth of the boxes is removed and as many are added at each
//! step; ten times as many boxes of which ten move; towers at rest; and, in the plane, a crowd.
//!
//! Boxes in a pile that are aligned, or turned at random; solids of several kinds in free space, dense and
//! loose, and of each kind alone; on a rough plain, a hundredth of `--objects` of plates that each cover up to
//! 512 triangles, and a twentieth of other solids that move by 0.1 at each step. Shaken scenes displace every
//! object by up to 0.001 at random at each step.
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
pub mod stages;

#[cfg(feature = "jolt")]
use impinge_compare_c::Jolt;
#[cfg(any(feature = "box2d", feature = "box3d"))]
use impinge_compare_c::Recycling;

use ::impinge;
use contender::{Contender, Entrant, KINDS, race};
use impinge_scenes::Scene;
pub use stages::PREDICTION;
use stages::{Stage, plane_stages, space_stages, stages};

use crate::Arguments;
use crate::table::Table;

/// Makes a world with the objects of a scene as they are at step 0; none where it lacks a shape.
type Maker<const D: usize> = fn(&Scene<D>) -> Option<Box<dyn Contender<D>>>;

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
