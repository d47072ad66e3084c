//! Measures the overhead of the plugin over the update of its world: 10 000 moving entities,
//! compared with a world of the library with the same poses. Both step alternately in one process;
//! the best of several runs counts for each step.
//!
//! ```sh
//! cargo bench --bench overhead
//! ```

use std::time::Instant;

use bevy_app::prelude::*;
use bevy_ecs::prelude::*;
use bevy_ecs::schedule::ScheduleLabel;
use bevy_impinge::d3::prelude::*;
use bevy_impinge::impinge::dim3::math::{Isometry, Translation};
use bevy_impinge::impinge::dim3::na::{Quaternion, UnitQuaternion};
use bevy_impinge::impinge::dim3::world::{
    CollisionGroups, CollisionObjectHandle, CollisionWorld, ContactQuery,
};
use bevy_math::{Quat, Vec3};
use bevy_transform::prelude::*;

const COUNT: usize = 10_000;
const STEPS: usize = 60;
const RUNS: usize = 5;
/// Half the side of the cube in which the entities move; at this size each has about one contact.
const HALF: f32 = 24.0;

#[derive(ScheduleLabel, Clone, Debug, PartialEq, Eq, Hash)]
struct Step;

#[derive(Clone, Copy)]
struct Mover {
    start: Vec3,
    velocity: Vec3,
    axis: Vec3,
}

impl Mover {
    /// Returns the position at a step, as a function of the step alone: back and forth within the cube.
    fn at(&self, step: usize) -> Transform {
        let time = step as f32;
        let fold = |x: f32| HALF - ((x + HALF).rem_euclid(4.0 * HALF) - 2.0 * HALF).abs();
        let place = self.start + self.velocity * time;
        let translation = Vec3::new(fold(place.x), fold(place.y), fold(place.z));
        let rotation = Quat::from_axis_angle(self.axis, 0.05 * time);
        Transform::from_translation(translation).with_rotation(rotation)
    }
}

/// Returns a number from -1 to 1.
fn random(state: &mut u32) -> f32 {
    *state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
    (*state >> 8) as f32 / (1 << 23) as f32 - 1.0
}

fn movers() -> Vec<Mover> {
    let seed = &mut 7;
    let mut vector = || Vec3::new(random(seed), random(seed), random(seed));
    let mover = |_| Mover {
        start: vector() * HALF,
        velocity: vector() * 0.05,
        axis: (vector() + Vec3::splat(1e-3)).normalize(),
    };
    (0..COUNT).map(mover).collect()
}

fn isometry(at: &Transform) -> Isometry<f32> {
    let (t, q) = (at.translation, at.rotation);
    let rotation = UnitQuaternion::new_unchecked(Quaternion::new(q.w, q.x, q.y, q.z));
    Isometry::from_parts(Translation::new(t.x, t.y, t.z), rotation)
}

type Bare = (CollisionWorld<f32, usize>, Vec<CollisionObjectHandle>);

fn bare(movers: &[Mover], cube: &Collider) -> Bare {
    let mut world = CollisionWorld::new(0.02);
    let shape = cube.shape().expect("a good cube").clone();
    let (groups, query) = (CollisionGroups::new(), ContactQuery::default());
    let add = |(n, mover): (usize, &Mover)| {
        world.add(isometry(&mover.at(0)), shape.clone(), groups, query, n)
    };
    let handles = movers.iter().enumerate().map(add).collect();
    (world, handles)
}

fn app(movers: &[Mover], cube: &Collider) -> (App, Vec<Entity>) {
    let mut app = App::new();
    app.init_schedule(Step).add_plugins(ImpingePlugin::default().in_schedule(Step));
    let spawn = |mover: &Mover| app.world_mut().spawn((cube.clone(), mover.at(0))).id();
    let entities = movers.iter().map(spawn).collect();
    (app, entities)
}

/// Microseconds of a step: moving and updating the bare world, its update alone, and the schedule of the plugin.
type Times = [f64; 3];

fn run(movers: &[Mover]) -> (Vec<Times>, usize) {
    let cube = Collider::cuboid(0.9, 0.9, 0.9);
    let (mut world, handles) = bare(movers, &cube);
    let (mut app, entities) = app(movers, &cube);
    let micros = |since: Instant| since.elapsed().as_secs_f64() * 1e6;
    let mut times = Vec::new();
    for step in 0..STEPS {
        let transforms: Vec<Transform> = movers.iter().map(|mover| mover.at(step)).collect();
        for (&entity, transform) in entities.iter().zip(&transforms) {
            *app.world_mut().get_mut::<Transform>(entity).expect("it has one") = *transform;
        }
        let start = Instant::now();
        for (&handle, transform) in handles.iter().zip(&transforms) {
            world.set_position(handle, isometry(transform));
        }
        let start_of_update = Instant::now();
        world.update();
        let (moved, updated) = (micros(start), micros(start_of_update));
        let start = Instant::now();
        app.world_mut().run_schedule(Step);
        times.push([moved, updated, micros(start)]);
        app.world_mut().clear_trackers();
    }
    let pairs = world.contact_pairs().count();
    assert_eq!(pairs, app.world().resource::<Collisions>().world().contact_pairs().count());
    (times, pairs)
}

fn main() {
    let movers = movers();
    let (mut best, mut pairs) = (vec![[f64::INFINITY; 3]; STEPS], 0);
    for _ in 0..RUNS {
        let (times, found) = run(&movers);
        pairs = found;
        for (best, time) in best.iter_mut().zip(times) {
            *best = [0, 1, 2].map(|n: usize| best[n].min(time[n]));
        }
    }
    // The first step inserts everything.
    let sum = |n: usize| best[1..].iter().map(|times| times[n]).sum::<f64>() / (STEPS - 1) as f64;
    let [moved, updated, plugin] = [0, 1, 2].map(sum);
    println!("{COUNT} moving boxes, {pairs} pairs in contact, µs per step, best of {RUNS}:");
    println!("  the world alone: {moved:.0}, of which its update {updated:.0}");
    println!("  the plugin's schedule: {plugin:.0}, {:.1} % more", (plugin / moved - 1.0) * 100.0);
}
