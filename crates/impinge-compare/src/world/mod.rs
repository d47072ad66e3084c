//! The suite of whole worlds: every contender is told the new poses of what moved, updates, and reads
//! every contact point; only this is timed. Looking up the poses and converting them is not. On every
//! tenth step the touching pairs of all are compared: a time for another answer is no time.
//!
//! All sides use `f32`, the same prediction and as good as the same loosening of boxes.

mod contender;
mod ours;
mod rapier2;
mod rapier3;

use contender::{Contender, race};
use impinge_scenes::{Scene, SceneQuery, few_moving, mixed_shapes, pile, sparse_drift};

use crate::Arguments;
use crate::table::Table;

/// Two objects whose distance is at most this have contact points: the sum of what the objects of
/// the scenes ask for.
const PREDICTION: f32 = 0.002;

/// Runs all scenes.
pub fn run(arguments: &Arguments) -> Vec<Table> {
    let mut table = Table::new("world", "ms");
    let objects = arguments.objects;
    for scene in scenes::<2>(objects) {
        let rival = rapier2::Rapier::new(&scene);
        run_scene(&scene, ours::plane(&scene), rival, arguments, &mut table);
    }
    for scene in scenes::<3>(objects) {
        let rival = rapier3::Rapier::new(&scene);
        run_scene(&scene, ours::space(&scene), rival, arguments, &mut table);
    }
    vec![table]
}

/// The scenes, all of which ask for contacts with the same prediction: rapier has one for all.
fn scenes<const D: usize>(n: usize) -> [Scene<D>; 4] {
    let linear = f64::from(PREDICTION) / 2.0;
    let mut scenes = [pile(n), sparse_drift(n), few_moving(n), mixed_shapes(n)];
    for object in scenes.iter_mut().flat_map(|scene| &mut scene.objects) {
        object.query = SceneQuery::Contacts { linear, angular: 0.0 };
    }
    scenes
}

fn run_scene<const D: usize>(
    scene: &Scene<D>,
    mut ours: impl Contender<D>,
    mut rival: impl Contender<D>,
    arguments: &Arguments,
    table: &mut Table,
) {
    table.add(race(scene, &mut [&mut ours, &mut rival], arguments.steps));
}
