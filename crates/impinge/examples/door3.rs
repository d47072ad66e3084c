//! A door swings open: at which angle does it hit a post in its way, fixed or moving? Rotating
//! bodies have a time of impact too. This time is found by conservative advancement, not by
//! stepping through the motion, so thin or fast bodies are not missed. The output is the angle at
//! which the door stops, for several positions of the post.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use std::f64::consts::FRAC_PI_2;

use impinge::dim3::prelude::*;
use impinge::dim3::query::{ConstantVelocities, nonlinear_time_of_impact};

/// The door is 1 wide, 2 high and 0.125 thick. It rotates by a right angle in a second.
const HALF: [f64; 3] = [0.5, 1.0, 0.0625];
const POST: f64 = 0.1875;

/// Returns the motion of the door. Closed, it lies along the x axis, with its hinge at the origin
/// along y.
fn door() -> ConstantVelocities<f64> {
    let closed = Isometry::translation(HALF[0], 0.0, 0.0);
    let hinge = Point::new(-HALF[0], 0.0, 0.0);
    ConstantVelocities::new(closed, Vector::zeros(), Vector::y() * -FRAC_PI_2)
        .with_local_center(hinge)
}

/// Returns the angle in degrees at which the door hits a post with this velocity; `None` if the
/// door opens completely.
fn stops_at(post: Point<f64>, velocity: Vector<f64>) -> Option<f64> {
    let (leaf, cylinder) = (Cuboid::new(Vector::from(HALF)), Cylinder::new(1.0, POST));
    let place = Isometry::from(post.coords);
    let moving = ConstantVelocities::new(place, velocity, Vector::zeros());
    // In one second the door rotates by a quarter turn.
    let options = ImpactOptions::new().with_max_time(1.0);
    let hit = nonlinear_time_of_impact(&door(), &leaf, &moving, &cylinder, &options);
    hit.map(|impact| impact.toi * 90.0)
}

fn main() {
    let still = Vector::zeros();
    let places = [
        ("at the end of the swing", Point::new(0.0, 0.0, 0.5), still),
        ("beside the swing", Point::new(1.0, 0.0, 1.0), still),
        ("too low to be in the way", Point::new(0.0, -2.125, 0.5), still),
        ("a post that rolls away", Point::new(0.0, 0.0, 0.5), Vector::x() * -2.0),
    ];
    let mut angles = Vec::new();
    for (name, post, velocity) in places {
        let angle = stops_at(post, velocity);
        match angle {
            Some(angle) => println!("{name:26} stops at {angle:.3}°"),
            None => println!("{name:26} opens"),
        }
        angles.push(angle);
    }

    // The axis of the post is 0.5 from the hinge. Door and post touch when this axis is 0.0625 +
    // 0.1875 from the middle plane of the door: asin(0.25 / 0.5) = 30° before the end of the swing.
    let angle = angles[0].expect("the post is in the way");
    assert!((angle - 60.0).abs() < 1e-4, "{angle}");
    // The edge of the door comes no nearer than √2 − 1 to the axis of the second post, which is
    // more than the radius.
    assert_eq!(angles[1..], [None, None, None], "nothing is in the way");
    // A post that moves faster towards the swing is hit earlier.
    let comes =
        [0.0, 0.25, 0.5].map(|speed| stops_at(Point::new(0.0, 0.0, 0.5), Vector::x() * speed));
    let [slow, medium, fast] = comes.map(|angle| angle.expect("it comes closer"));
    assert!(fast < medium && medium < slow, "{fast} < {medium} < {slow}");
}
