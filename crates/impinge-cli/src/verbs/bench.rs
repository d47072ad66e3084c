//! `impinge bench`: measures the time of updates of a scene.

use core::fmt;
use std::time::{Duration, Instant};

use impinge::narrow_phase::CollisionObjectHandle;
use impinge::world::CollisionWorld;
use impinge_files::{Printable, SceneWorld};
use serde::Serialize;

use crate::args::{BenchArgs, KeyFrames, SceneArgs, Stepping};
use crate::error::CliError;
use crate::number::significant;
use crate::output::{FAINT, NAME, Outcome, Report, finish};
use crate::progress::Progress;
use crate::scene::Loaded;
use crate::space::{Kind, Stage, Task, run_in};
use crate::summary::touching_pairs;

/// The scenes that are part of the command, with their names.
const SCENES: [(&str, &str); 3] = [
    ("moving_stack", include_str!("../../bench/moving_stack.json")),
    ("spinning_capsules", include_str!("../../bench/spinning_capsules.json")),
    ("crossing_discs", include_str!("../../bench/crossing_discs.json")),
];

/// Runs the verb.
pub(crate) fn run(args: &BenchArgs) -> Result<Outcome, CliError> {
    let loaded = match &args.scene {
        Some(path) => {
            let (scene, reading) = (path.clone(), args.reading.clone());
            vec![Loaded::read(&SceneArgs { scene, reading })?]
        }
        None => {
            let reading = &args.reading;
            let scenes = SCENES.iter().map(|(name, text)| Loaded::of_text(name, text, reading));
            scenes.collect::<Result<_, _>>()?
        }
    };
    let scenes = loaded.iter().map(|loaded| run_in(loaded.kind, TimeUpdates { loaded, args }));
    let scenes = scenes.collect::<Result<_, _>>()?;
    finish(&BenchReport { scenes }, args.format)
}

/// The task that measures the updates of a scene.
struct TimeUpdates<'a> {
    loaded: &'a Loaded,
    args: &'a BenchArgs,
}

/// The report of the times of all scenes.
#[derive(Debug, Serialize)]
struct BenchReport {
    scenes: Vec<SceneTimes>,
}

/// The times of a scene in milliseconds: medians over all runs, and the quartiles of the updates.
#[derive(Debug, Serialize)]
struct SceneTimes {
    name: String,
    #[serde(flatten)]
    kind: Kind,
    objects: usize,
    /// The number of pairs that touch after the last step.
    pairs: usize,
    steps: u32,
    runs: u32,
    /// The time to create the shapes and objects. The first update then computes the boxes and
    /// pairs.
    build_ms: f64,
    first_update_ms: f64,
    lower_quartile_ms: f64,
    median_ms: f64,
    upper_quartile_ms: f64,
}

impl Task for TimeUpdates<'_> {
    type Answer = SceneTimes;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<SceneTimes, CliError> {
        let Self { loaded, args } = self;
        let Stepping { steps, time_step } = args.stepping;
        let (mut builds, mut firsts) = (Durations::default(), Durations::default());
        let (mut updates, mut pairs) = (Durations::default(), 0);
        let mut progress = Progress::new(args.runs as usize * steps as usize, "measuring");
        for _ in 0..args.runs {
            let mut world = builds.time(|| loaded.world::<N, D>())?;
            // A second world, `mover`, computes the positions. Its updates also write a recording,
            // and are not timed.
            let mut mover = loaded.moving::<N, D>(KeyFrames { every: None })?;
            loaded.step(&mut mover, 0.0)?;
            firsts.time(|| world.update());
            for _ in 0..steps {
                loaded.step(&mut mover, time_step.seconds.0)?;
                let moved = moved(&world, &mover);
                updates.time(|| {
                    world.set_positions(&moved);
                    world.update();
                });
                progress.step();
            }
            pairs = touching_pairs(&world).len();
        }
        Ok(SceneTimes {
            name: loaded.name(),
            kind: loaded.kind,
            objects: loaded.scene().names().len(),
            pairs,
            steps,
            runs: args.runs,
            build_ms: builds.quartile(2),
            first_update_ms: firsts.quartile(2),
            lower_quartile_ms: updates.quartile(1),
            median_ms: updates.quartile(2),
            upper_quartile_ms: updates.quartile(3),
        })
    }
}

/// Returns the objects whose positions differ from the positions in `mover`, with these new
/// positions. `mover` has the same objects in the same order.
fn moved<N: Stage<D>, const D: usize>(
    world: &CollisionWorld<N, D, String>,
    mover: &SceneWorld<N, D>,
) -> Vec<(CollisionObjectHandle, N::Isometry)> {
    let pairs = world.collision_objects().zip(mover.collision_objects());
    let moved = pairs.filter(|(own, ahead)| own.position() != ahead.position());
    moved.map(|(own, ahead)| (own.handle(), *ahead.position())).collect()
}

/// Measured durations of repeated work.
#[derive(Debug, Default)]
struct Durations(Vec<Duration>);

impl Durations {
    /// Runs some work, stores its duration, and returns the result of the work.
    fn time<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let begun = Instant::now();
        let done = work();
        self.0.push(begun.elapsed());
        done
    }

    /// Returns the quartile with index `quarters` in milliseconds: 1 is the lower quartile, 2 the
    /// median. Durations are not interpolated; if a quartile lies between two of them, the longer
    /// one is returned. Returns 0 if there are no durations.
    fn quartile(&mut self, quarters: usize) -> f64 {
        self.0.sort_unstable();
        let index = (self.0.len() * quarters / 4).min(self.0.len().saturating_sub(1));
        self.0.get(index).map_or(0.0, |time| time.as_secs_f64() * 1e3)
    }
}

impl fmt::Display for BenchReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.scenes.iter().try_for_each(|times| times.fmt(f))
    }
}

impl fmt::Display for SceneTimes {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { kind, objects, pairs, steps, runs, .. } = self;
        let name = Printable(&self.name);
        writeln!(
            f,
            "{NAME}{name}{NAME:#} {FAINT}({kind}){FAINT:#}: {objects} objects, {pairs} pairs touch at the end, \
             {steps} steps, {runs} runs"
        )?;
        // Clocks count nanoseconds, but times are reproducible to a tenth of a microsecond at best.
        let shown = |time: f64| format!("{} ms", significant((time * 1e4).round() / 1e4));
        let [build, first] = [self.build_ms, self.first_update_ms].map(shown);
        writeln!(f, "  shapes and objects made in {build}, first update {first}")?;
        let [low, high] = [self.lower_quartile_ms, self.upper_quartile_ms].map(shown);
        let median = shown(self.median_ms);
        writeln!(f, "  update {median} {FAINT}(half of them {low} to {high}){FAINT:#}")
    }
}

impl Report for BenchReport {}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_by_hand() {
        let times = [5, 1, 4, 2, 3].map(Duration::from_millis);
        let mut samples = Durations(times.to_vec());
        assert_eq!([1, 2, 3].map(|quarters| samples.quartile(quarters)), [2.0, 3.0, 4.0]);
        assert_eq!(Durations::default().quartile(2), 0.0);
    }
}
