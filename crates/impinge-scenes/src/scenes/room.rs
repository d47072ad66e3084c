//! A ball that flies in a room with four coloured areas.

use crate::{Motion, Scene, SceneGroups, SceneObject, SceneQuery, SceneShape};

/// The room, and the data for a program that moves the ball.
///
/// The motion of the ball depends on its contacts, so that the ball is at rest in the scene. A
/// program moves it by `velocity · time_step` per step, and reflects the velocity where it touches
/// a plane.
#[derive(Clone, Debug)]
pub struct Room<const D: usize> {
    /// The ball, the planes and the areas.
    pub scene: Scene<D>,
    /// The index of the ball.
    pub ball: usize,
    /// The initial velocity of the ball.
    pub velocity: [f64; D],
    /// Seconds per step.
    pub time_step: f64,
    /// The areas.
    pub areas: [Area; 4],
}

/// A named area of the room.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Area {
    /// The index of the object.
    pub object: usize,
    /// The name: its colour.
    pub name: &'static str,
}

const BALL_GROUPS: SceneGroups = SceneGroups { membership: &[1], ..SceneGroups::EVERYBODY };
const ROOM_GROUPS: SceneGroups = SceneGroups { membership: &[2], whitelist: &[1], blacklist: &[] };
const TOUCH: SceneQuery = SceneQuery::Contacts { linear: 0.0, angular: 0.0 };

/// A ball of radius 0.5 at (5, 5) in a room of planes at ±10 in each direction. Around (±5, ±5) are
/// areas of half extents 4.9.
#[must_use]
pub fn room<const D: usize>() -> Room<D> {
    let mut objects = vec![SceneObject {
        groups: BALL_GROUPS,
        ..SceneObject::new(SceneShape::Ball { radius: 0.5 }, TOUCH, Motion::rest(flat(5.0, 5.0)))
    }];
    objects.extend((0..2 * D).map(plane));
    let areas =
        [("purple", -5.0, 5.0), ("blue", 5.0, 5.0), ("green", 5.0, -5.0), ("yellow", -5.0, -5.0)];
    let areas = areas.map(|(name, x, y)| {
        objects.push(area(flat(x, y)));
        Area { object: objects.len() - 1, name }
    });
    Room {
        scene: Scene { name: "room", margin: 0.02, objects, steps: 2000 },
        ball: 0,
        velocity: flat(10.0, 5.0),
        time_step: 0.016,
        areas,
    }
}

/// Returns a vector in the plane of the first two axes.
fn flat<const D: usize>(x: f64, y: f64) -> [f64; D] {
    std::array::from_fn(|axis| [x, y, 0.0][axis])
}

/// Returns a wall. Indices 0 and 1 bound the first axis below and above, 2 and 3 the second, and so
/// on.
fn plane<const D: usize>(index: usize) -> SceneObject<D> {
    let inward = if index.is_multiple_of(2) { 1.0 } else { -1.0 };
    let (mut normal, mut at) = ([0.0; D], [0.0; D]);
    normal[index / 2] = inward;
    at[index / 2] = -10.0 * inward;
    let plane = SceneObject::new(SceneShape::Plane { normal }, TOUCH, Motion::rest(at));
    SceneObject { groups: ROOM_GROUPS, ..plane }
}

fn area<const D: usize>(center: [f64; D]) -> SceneObject<D> {
    let half_extents = [crate::rounded(4.9); D];
    let query = SceneQuery::Proximity { margin: 0.0 };
    let area = SceneObject::new(SceneShape::Cuboid { half_extents }, query, Motion::rest(center));
    SceneObject { groups: ROOM_GROUPS, ..area }
}
