//! The suite of queries: rays, moving solids, points and boxes against many objects, and rays
//! against one mesh.
//!
//! There are two scenes, each in 2D and 3D: a dense one with short rays, and one with a fifth of
//! the density and unbounded rays. Queries about solids run on a whole world, or on a tree of boxes
//! with parry's solids at its leaves. Queries about boxes run on trees of boxes alone.
//!
//! All contenders get the same queries, converted to their own types before the clock starts.
//! Rivals use their best build (`medium` of `obvhs`) and, where their authors recommend it,
//! primitives sorted in the order of the tree. Where a result has a normal, all contenders compute
//! it.

mod mesh;
mod ncollide;
mod obvhs_trees;
mod ours;
mod parry;
mod race;
mod scene;
mod trees;

use race::{Contender, Rule, race};
use scene::{Library, Questions, Scene};

use crate::Arguments;
use crate::table::Table;

/// The relative tolerance of times and distances.
const TOLERANCE: f32 = 1e-4;

/// The relative tolerance of times of moving solids. They are computed by iterations, whose
/// tolerance differs between the libraries.
const CAST_TOLERANCE: f32 = 1e-3;

/// The edges of the meshes in cells; a mesh has two triangles per cell.
const MESHES: [usize; 2] = [100, 708];

/// Runs all cases. The larger mesh needs more than 50,000 requested objects.
pub fn run(arguments: &Arguments) -> Vec<Table> {
    let mut table = Table::new("queries", "ns");
    let objects = arguments.objects;
    for scene in scenes::<3>(objects) {
        space(&scene, arguments, &mut table);
    }
    between_updates(arguments, &mut table);
    for edge in MESHES.into_iter().filter(|edge| edge * edge < 10 * objects) {
        table.add(mesh::run(edge, arguments));
    }
    for scene in scenes::<2>(objects) {
        plane(&scene, arguments, &mut table);
    }
    vec![table]
}

/// Returns the number of rounds: a tenth of the requested steps, at least one.
fn rounds(arguments: &Arguments) -> usize {
    (arguments.steps as usize / 10).max(1)
}

fn scenes<const D: usize>(objects: usize) -> [Scene<D>; 2] {
    [Scene::new("dense", objects, 0.375, 8.0), Scene::new("sparse", objects, 0.075, f32::MAX)]
}

fn space(scene: &Scene<3>, arguments: &Arguments, table: &mut Table) {
    let (ours, rapier) = (ours::space(scene), parry::space::Rapier::new(scene));
    let parry = parry::space::Parry::new(scene);
    let (obvhs, bvh) = (obvhs_trees::Obvhs::new(scene, &parry), trees::BvhTree::new(scene));
    let (rstar, ncollide) = (trees::RstarTree::new(scene), ncollide::space::Ncollide::new(scene));
    let all: [&dyn Library<3>; 7] = [&ours, &rapier, &parry, &obvhs, &bvh, &rstar, &ncollide];
    ask_all(scene, &all, arguments, table);
}

/// Times queries of a world of 2000 objects after 0, 100 or 1500 of them have moved since the last
/// update.
fn between_updates(arguments: &Arguments, table: &mut Table) {
    let scene = Scene::<3>::new("moved", 2000, 0.075, f32::MAX);
    let counts = [("none moved", 0), ("100 moved", 100), ("1500 moved", 1500)];
    let worlds = counts.map(|(name, count)| ours::moved(name, &scene, count));
    let worlds = worlds.each_ref().map(|world| world as &dyn Library<3>);
    let is_solid = |questions: &Questions<3>| {
        use Questions::{Casts, Containing, Nearest, Overlapping, Rays};
        matches!(questions, Rays(..) | Casts(..) | Nearest(_) | Containing(_) | Overlapping(_))
    };
    let questions = scene.questions(scene.objects.len());
    for (what, questions) in questions.iter().filter(|(_, questions)| is_solid(questions)) {
        let case = format!("{} 3D: {what}", scene.name);
        if arguments.wants_case(&case) {
            let all = worlds.iter().flat_map(|world| world.contenders(questions));
            let (rule, count) = rule(questions);
            table.add(race(&case, rule, count, rounds(arguments), all.collect()));
        }
    }
}

fn plane(scene: &Scene<2>, arguments: &Arguments, table: &mut Table) {
    let (ours, rapier) = (ours::plane(scene), parry::plane::Rapier::new(scene));
    let parry = parry::plane::Parry::new(scene);
    let (bvh, rstar) = (trees::BvhTree::new(scene), trees::RstarTree::new(scene));
    let ncollide = ncollide::plane::Ncollide::new(scene);
    let all: [&dyn Library<2>; 6] = [&ours, &rapier, &parry, &bvh, &rstar, &ncollide];
    ask_all(scene, &all, arguments, table);
}

/// Runs all contenders, for one kind of query after another.
fn ask_all<const D: usize>(
    scene: &Scene<D>,
    libraries: &[&dyn Library<D>],
    arguments: &Arguments,
    table: &mut Table,
) where
    f32: impinge::math::Space<D>,
{
    let objects = scene.objects.len();
    for (what, questions) in scene.questions(objects) {
        let case = format!("{} {D}D: {what}", scene.name);
        if arguments.wants_case(&case) {
            let all = libraries.iter().flat_map(|library| library.contenders(&questions));
            let (rule, count) = rule(&questions);
            table.add(race(&case, rule, count, rounds(arguments), wanted(all, arguments)));
        }
    }
}

/// Returns the contenders that the arguments select.
fn wanted<'a>(
    contenders: impl IntoIterator<Item = Contender<'a>>,
    arguments: &Arguments,
) -> Vec<Contender<'a>> {
    let is_wanted = |contender: &Contender| arguments.wants_contender(contender.name());
    contenders.into_iter().filter(is_wanted).collect()
}

/// Returns the rule for comparing results, and the number of queries.
fn rule<const D: usize>(questions: &Questions<D>) -> (Rule, usize) {
    match questions {
        Questions::Rays(rays, _) | Questions::BoxRays(rays, _) => {
            (Rule::Best(TOLERANCE), rays.len())
        }
        Questions::Casts(casts, _) => (Rule::Best(CAST_TOLERANCE), casts.len()),
        Questions::Nearest(points) | Questions::BoxNearest(points) => {
            (Rule::Best(TOLERANCE), points.len())
        }
        Questions::Containing(points) | Questions::BoxContaining(points) => {
            (Rule::All, points.len())
        }
        Questions::Overlapping(solids) => (Rule::All, solids.len()),
        Questions::BoxOverlapping(boxes) => (Rule::All, boxes.len()),
    }
}
