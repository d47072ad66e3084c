//! Pairs of solids, of which the upper one is shaken.

use impinge_scenes::{Placement, SceneShape};

use super::build::{
    EIGHTH_TURN, QUARTER_TURN, TURN_03, cube, field, flat_mesh, half_space, spun, turned,
};
use crate::stack::{Kind, Stack};

/// The penetration of the upper solid into the lower one: more than the shaking can separate.
const DEPTH: f64 = 0.002;

/// Returns all pairs in 3D: a fixed solid, and one of extent 1 or 2 that lies on it.
#[must_use]
pub fn pairs3() -> Vec<Stack<3>> {
    let cylinder = SceneShape::Cylinder { half_height: 0.5, radius: 0.5 };
    let lying = |at| turned(at, [1.0, 0.0, 0.0], QUARTER_TURN);
    let below = [0.0, -0.5, 0.0];
    let up = 0.5 - DEPTH;
    let pair = |name, lower, at, upper, placement| {
        Stack::new(name, Kind::Rest).fixed(lower, at).with(upper, placement)
    };
    let on_cube = |name, tangent| pair(name, cube(), below, cube(), spun([0.0, up, 0.0], tangent));
    let (ground, on_diagonal) = ([0.0; 3], [0.75, up, 0.75]);
    vec![
        on_cube("cube on an equal cube", 0.0),
        on_cube("cube turned by pi/4", EIGHTH_TURN),
        on_cube("cube turned by 0.3", TURN_03),
        pair("cube on a plane", half_space(), ground, cube(), spun([0.0, up, 0.0], TURN_03)),
        pair("cube on a flat mesh", flat_mesh(), ground, cube(), Placement::at(on_diagonal)),
        pair(
            "cube on a field",
            field([12; 2], [12.0; 2], |_, _| 0.0),
            ground,
            cube(),
            spun(on_diagonal, TURN_03),
        ),
        pair(
            "cylinder on a plane",
            half_space(),
            ground,
            cylinder.clone(),
            spun([0.0, up, 0.0], 0.0),
        ),
        pair("cylinder on a cube", cube(), below, cylinder.clone(), spun([0.0, up, 0.0], 0.0)),
        pair(
            "cylinder on a cylinder",
            cylinder.clone(),
            below,
            cylinder.clone(),
            spun([0.0, up, 0.0], 0.0),
        ),
        pair(
            "cylinder on a mesh",
            flat_mesh(),
            ground,
            cylinder.clone(),
            spun([0.2, up, 0.1], 0.0),
        ),
        pair("lying cylinder on a plane", half_space(), ground, cylinder, lying([0.0, up, 0.0])),
        pair(
            "cone on a plane",
            half_space(),
            ground,
            SceneShape::Cone { half_height: 0.5, radius: 0.5 },
            spun([0.0, up, 0.0], 0.0),
        ),
        pair(
            "capsule on a mesh",
            flat_mesh(),
            ground,
            SceneShape::Capsule { half_height: 0.5, radius: 0.5 },
            lying([0.2, up, 0.1]),
        ),
    ]
}

/// Returns all pairs in 2D: a fixed solid, and one that lies on it.
#[must_use]
pub fn pairs2() -> Vec<Stack<2>> {
    let up = 0.5 - DEPTH;
    let line = SceneShape::Polyline { vertices: (0..13).map(|n| [6.0 - n as f64, 0.0]).collect() };
    let pair = |name, lower, at, x: f64| {
        Stack::new(name, Kind::Rest).fixed(lower, at).with(cube(), Placement::at([x, up]))
    };
    vec![
        pair("box on an equal box", cube(), [0.0, -0.5], 0.0),
        pair("box on a line", line, [0.0; 2], 0.5),
        pair("box on a half-plane", half_space(), [0.0; 2], 0.0),
    ]
}
