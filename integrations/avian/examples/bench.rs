//! Compares steps of Avian with its own colliders (parry) and with those of impinge, in equal
//! scenes. Both apps step alternately, in one process, on one thread; the printed times are medians
//! over the steps.
//!
//! ```sh
//! cargo run --release --example bench --features parry            # all scenes
//! cargo run --release --example bench --features parry -- mesh    # scenes with this word in the name
//! ```

use std::time::{Duration, Instant};

use bevy_app::App;

#[allow(dead_code, reason = "tests have more scenes")]
#[path = "../scenes/d2.rs"]
mod scenes2;
#[allow(dead_code, reason = "tests have more scenes")]
#[path = "../scenes/d3.rs"]
mod scenes3;

const STEPS: usize = 300;

/// The duration of one step, and of its narrow phase as measured by Avian.
#[derive(Clone, Copy, Default)]
struct Step {
    whole: Duration,
    narrow: Duration,
    /// The number of touching pairs.
    touching: usize,
}

fn timed(app: &mut App, read: fn(&App) -> (Duration, usize)) -> Step {
    let start = Instant::now();
    app.update();
    let whole = start.elapsed();
    let (narrow, touching) = read(app);
    Step { whole, narrow, touching }
}

fn median(steps: &[Step], of: impl Fn(&Step) -> Duration) -> f64 {
    let mut times: Vec<_> = steps.iter().map(of).collect();
    times.sort();
    times[times.len() / 2].as_secs_f64() * 1e3
}

fn row(name: &str, apps: [fn() -> App; 2], read: fn(&App) -> (Duration, usize)) {
    let wanted = std::env::args().nth(1).unwrap_or_default();
    if !name.contains(&wanted) {
        return;
    }
    let (mut apps, mut steps) = (apps.map(|app| app()), [Vec::new(), Vec::new()]);
    for _ in 0..STEPS {
        for (app, steps) in apps.iter_mut().zip(&mut steps) {
            steps.push(timed(app, read));
        }
    }
    let whole = steps.each_ref().map(|steps| median(steps, |step| step.whole));
    let narrow = steps.each_ref().map(|steps| median(steps, |step| step.narrow));
    let touching = steps.each_ref().map(|steps| steps[STEPS - 1].touching);
    println!(
        "| {name} | {:.3} | {:.3} | {:.2} | {:.3} | {:.3} | {:.2} | {} / {} |",
        whole[0],
        whole[1],
        whole[0] / whole[1],
        narrow[0],
        narrow[1],
        narrow[0] / narrow[1],
        touching[0],
        touching[1]
    );
}

mod space {
    use avian3d::collision::CollisionDiagnostics;
    use avian3d::prelude::ContactGraph;
    use bevy_math::Vec3;

    use super::*;
    use crate::scenes3::{Backend, Impinge, Parry, app, fixed, floor, pile, pyramid, sheet, stack};

    fn read(app: &App) -> (Duration, usize) {
        let touching = app.world().resource::<ContactGraph>().iter_active_touching().count();
        (app.world().resource::<CollisionDiagnostics>().narrow_phase, touching)
    }

    fn stacks<B: Backend>() -> App {
        let mut app = app::<B>();
        floor::<B>(&mut app);
        for place in 0..40 {
            let at = Vec3::new(3.0 * (place % 8) as f32, 0.0, 3.0 * (place / 8) as f32);
            stack::<B>(&mut app, at, 10);
        }
        app
    }

    fn wall<B: Backend>() -> App {
        let mut app = app::<B>();
        floor::<B>(&mut app);
        pyramid::<B>(&mut app, 25);
        app
    }

    fn heap<B: Backend>() -> App {
        let mut app = app::<B>();
        floor::<B>(&mut app);
        pile::<B>(&mut app, 8, 8, 1.0);
        app
    }

    fn hills<B: Backend>() -> App {
        let mut app = app::<B>();
        let height = |x: f32, z: f32| (0.7 * x).sin() * 0.5 + (0.9 * z).cos() * 0.5;
        fixed::<B>(&mut app, sheet::<B>(96, 0.25, height), Vec3::ZERO);
        pile::<B>(&mut app, 12, 3, 2.0);
        app
    }

    pub(super) fn rows() {
        row("3D, 40 stacks of 10 boxes", [stacks::<Parry>, stacks::<Impinge>], read);
        row("3D, a pyramid of 325 boxes", [wall::<Parry>, wall::<Impinge>], read);
        row("3D, a pile of 512 solids of 5 kinds", [heap::<Parry>, heap::<Impinge>], read);
        row("3D, 432 solids on a mesh of 18 432", [hills::<Parry>, hills::<Impinge>], read);
    }
}

mod plane {
    use avian2d::collision::CollisionDiagnostics;
    use avian2d::prelude::ContactGraph;
    use bevy_math::Vec2;

    use super::*;
    use crate::scenes2::{Backend, Impinge, Parry, app, fixed, floor, line, pile, pyramid};

    fn read(app: &App) -> (Duration, usize) {
        let touching = app.world().resource::<ContactGraph>().iter_active_touching().count();
        (app.world().resource::<CollisionDiagnostics>().narrow_phase, touching)
    }

    fn wall<B: Backend>() -> App {
        let mut app = app::<B>();
        floor::<B>(&mut app);
        pyramid::<B>(&mut app, 40);
        app
    }

    fn heap<B: Backend>() -> App {
        let mut app = app::<B>();
        floor::<B>(&mut app);
        pile::<B>(&mut app, 40, 20, 1.0);
        app
    }

    fn hills<B: Backend>() -> App {
        let mut app = app::<B>();
        let ground = line::<B>(400, 0.25, |x| (0.7 * x).sin() * 0.5);
        fixed::<B>(&mut app, ground, Vec2::ZERO);
        pile::<B>(&mut app, 60, 5, 2.0);
        app
    }

    pub(super) fn rows() {
        row("2D, a pyramid of 820 squares", [wall::<Parry>, wall::<Impinge>], read);
        row("2D, a pile of 800 solids of 4 kinds", [heap::<Parry>, heap::<Impinge>], read);
        row("2D, 300 solids on a line of 400", [hills::<Parry>, hills::<Impinge>], read);
    }
}

fn main() {
    println!(
        "| scene | step, parry, ms | impinge | ratio | narrow phase, parry, ms | impinge | ratio | touching |"
    );
    println!("|---|---|---|---|---|---|---|---|");
    space::rows();
    plane::rows();
}
