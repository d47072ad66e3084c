//! Shows circling balls in a browser while they move: `cargo run -p impinge-html --features page
//! --example live`. The optional argument is the number of seconds after which the program ends;
//! without it the program ends after an hour.

use std::thread::sleep;
use std::time::Duration;

use impinge::dim3::math::Isometry;
use impinge::dim3::shape::{Ball, ShapeHandle};
use impinge::dim3::world::{CollisionGroups, GeometricQueryType};
use impinge_html::{Assets, Live};
use impinge_record::{Recorder, Registry};

/// Returns the position of a ball on a circle of radius 3 at `time` seconds. The angular speed
/// increases with the number of the ball.
fn place(ball: u8, time: f32) -> Isometry<f32> {
    let angle = time * (0.5 + f32::from(ball) / 10.0);
    Isometry::translation(3.0 * angle.cos(), 3.0 * angle.sin(), 0.0)
}

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let seconds = std::env::args().nth(1).map_or(Ok(3600), |argument| argument.parse::<u32>())?;
    let mut recorder = Recorder::<f32, 3, String>::new(0.02, Registry::new())?;
    let (shape, groups) = (ShapeHandle::new(Ball::new(0.5)), CollisionGroups::new());
    let contacts = GeometricQueryType::Contacts(0.0, 0.0);
    let mut balls = Vec::new();
    for ball in 0..8 {
        let name = format!("ball {ball}");
        balls.push(recorder.add(place(ball, 0.0), shape.clone(), groups, contacts, name)?);
    }

    let live = Live::start(&Assets::embedded(), "Balls that circle", 0)?;
    eprintln!("watch {}", live.url());
    let mut time = 0.0;
    for _ in 0..seconds * 60 {
        time += 1.0 / 60.0;
        let poses = balls.iter().zip(0..).map(|(handle, ball)| (*handle, place(ball, time)));
        recorder.set_positions(&poses.collect::<Vec<_>>())?;
        recorder.update();
        live.send(&recorder.take_bytes());
        sleep(Duration::from_millis(16));
    }
    live.send(&recorder.finish().bytes);
    Ok(())
}
