//! `impinge bench`: how long updates of a scene take.

use core::fmt::Write as _;
use std::time::{Duration, Instant};

use impinge::world::CollisionWorld;
use impinge_files::SceneWorld;
use serde::Serialize;

use crate::args::{BenchArgs, SceneArgs};
use crate::error::CliError;
use crate::number::significant;
use crate::output::{FAINT, NAME, Outcome, Report, finish};
use crate::progress::Progress;
use crate::scene::Loaded;
use crate::space::{KindFields, Stage, Task, run_in};
use crate::summary::summary;

/// The scenes of the command, by name.
const SCENES: [(&str, &str); 3] = [
    ("moving_stack", include_str!("../bench/moving_stack.json")),
    ("spinning_capsules", include_str!("../bench/spinning_capsules.json")),
    ("crossing_discs", include_str!("../bench/crossing_discs.json")),
];

/// Runs the verb.
pub(crate) fn run(args: &BenchArgs) -> Result<Outcome, CliError> {
    let loaded = match &args.scene {
        Some(path) => {
            let (scene, scalar, packages) = (path.clone(), args.scalar, Vec::new());
            vec![Loaded::read(&SceneArgs { scene, scalar, packages })?]
        }
        None => {
            let scenes = SCENES.iter().map(|(name, text)| Loaded::of_text(name, text, args.scalar));
            scenes.collect::<Result<_, _>>()?
        }
    };
    let scenes = loaded.iter().map(|loaded| run_in(loaded.kind, Measure { loaded, args }));
    let scenes = scenes.collect::<Result<_, _>>()?;
    finish(&Bench { scenes }, args.format)
}

/// Measures the updates of a scene.
struct Measure<'a> {
    loaded: &'a Loaded,
    args: &'a BenchArgs,
}

/// The times of some scenes.
#[derive(Debug, Serialize)]
struct Bench {
    scenes: Vec<Times>,
}

/// The times of one, in milliseconds: medians over all runs, and the quartiles of updates.
#[derive(Debug, Serialize)]
struct Times {
    name: String,
    #[serde(flatten)]
    kind: KindFields,
    objects: usize,
    /// That touch after the last step.
    pairs: usize,
    steps: u32,
    runs: u32,
    build_ms: f64,
    first_update_ms: f64,
    lower_quartile_ms: f64,
    median_ms: f64,
    upper_quartile_ms: f64,
}

impl Task for Measure<'_> {
    type Answer = Times;

    fn run<N: Stage<D>, const D: usize>(self) -> Result<Times, CliError> {
        let Measure { loaded, args } = self;
        let (mut builds, mut firsts) = (Samples::default(), Samples::default());
        let (mut updates, mut last) = (Samples::default(), None);
        let mut progress = Progress::new((args.runs * args.steps) as usize, "measuring");
        for _ in 0..args.runs {
            let mut world = builds.time(|| loaded.world::<N, D>())?;
            // It computes the positions; its own updates are not measured.
            let mut mover = loaded.moving::<N, D>()?;
            mover.step(0.0)?;
            firsts.time(|| world.update());
            for _ in 0..args.steps {
                mover.step(args.dt.0)?;
                let moved = moved(&world, &mover);
                updates.time(|| {
                    world.set_positions(&moved);
                    world.update();
                });
                progress.step();
            }
            last = Some(summary(&world, args.steps as usize));
        }
        let last = last.map(|last| (last.objects, last.touching));
        let (objects, pairs) = last.unwrap_or_default();
        Ok(Times {
            name: loaded.name(),
            kind: loaded.kind.fields(),
            objects,
            pairs,
            steps: args.steps,
            runs: args.runs,
            build_ms: builds.quartile(2),
            first_update_ms: firsts.quartile(2),
            lower_quartile_ms: updates.quartile(1),
            median_ms: updates.quartile(2),
            upper_quartile_ms: updates.quartile(3),
        })
    }
}

/// The objects that stand elsewhere in the mover, which has the same objects in the same order.
fn moved<N: Stage<D>, const D: usize>(
    world: &CollisionWorld<N, D, String>,
    mover: &SceneWorld<N, D>,
) -> Vec<(impinge::narrow_phase::CollisionObjectHandle, N::Isometry)> {
    let pairs = world.collision_objects().zip(mover.collision_objects());
    let moved = pairs.filter(|(own, ahead)| own.position() != ahead.position());
    moved.map(|(own, ahead)| (own.handle(), *ahead.position())).collect()
}

/// Durations.
#[derive(Debug, Default)]
struct Samples(Vec<Duration>);

impl Samples {
    /// Does something and keeps how long it took.
    fn time<T>(&mut self, work: impl FnOnce() -> T) -> T {
        let begun = Instant::now();
        let done = work();
        self.0.push(begun.elapsed());
        done
    }

    /// So many quarters of the samples are shorter, in milliseconds.
    fn quartile(&mut self, quarters: usize) -> f64 {
        self.0.sort_unstable();
        let index = (self.0.len() * quarters / 4).min(self.0.len().saturating_sub(1));
        self.0.get(index).map_or(0.0, |time| time.as_secs_f64() * 1e3)
    }
}

impl Report for Bench {
    fn text(&self) -> String {
        let mut text = String::new();
        for times in &self.scenes {
            let Times { name, kind, objects, pairs, steps, runs, .. } = times;
            let _ = writeln!(
                text,
                "{NAME}{name}{NAME:#} {FAINT}({kind}){FAINT:#}: {objects} objects, {pairs} pairs touch at \
                 the end, {steps} steps, {runs} runs"
            );
            let [build, first, low, median, high] = [
                times.build_ms,
                times.first_update_ms,
                times.lower_quartile_ms,
                times.median_ms,
                times.upper_quartile_ms,
            ]
            .map(|time| format!("{} ms", significant((time * 1e4).round() / 1e4)));
            let _ = writeln!(text, "  shapes and objects made in {build}, first update {first}");
            let _ =
                writeln!(text, "  update {median} {FAINT}(half of them {low} to {high}){FAINT:#}");
        }
        text
    }

    fn outcome(&self) -> Outcome {
        Outcome::Clear
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quartiles_by_hand() {
        let times = [5, 1, 4, 2, 3].map(Duration::from_millis);
        let mut samples = Samples(times.to_vec());
        assert_eq!([1, 2, 3].map(|quarters| samples.quartile(quarters)), [2.0, 3.0, 4.0]);
        assert_eq!(Samples::default().quartile(2), 0.0);
    }
}
