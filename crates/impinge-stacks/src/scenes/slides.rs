//! Solids that slide in 3D without friction over thousands of triangles, at a speed of 5.

use impinge_scenes::{Placement, Random, SceneShape};

use super::build::{QUARTER_TURN, field, flat_hull, mesh, spun, turned};
use crate::stack::{Item, Kind, Solid, Stack};

pub(super) fn stacks() -> Vec<Stack<3>> {
    let cuboid = SceneShape::Cuboid { half_extents: [0.5, 0.25, 0.4] };
    let cylinder = SceneShape::Cylinder { half_height: 0.3, radius: 0.5 };
    let capsule = SceneShape::Capsule { half_height: 0.5, radius: 0.3 };
    let strip = || mesh([120, 12], 0.5, |_, _| 0.0);
    let strip_of_heights = field([120, 12], [60.0, 6.0], |_, _| 0.0);
    let begin = |height: f64| [-28.0, height, 0.13];
    let straight = [5.0, 0.0, 0.0];
    vec![
        slide("sliding box", strip(), cuboid.clone(), spun(begin(0.25), 0.03), straight),
        slide(
            "sliding box askew",
            strip(),
            cuboid.clone(),
            spun([-28.0, 0.25, -2.0], 0.3),
            [5.0, 0.0, 0.35],
        ),
        slide(
            "sliding box on a field",
            strip_of_heights,
            cuboid,
            spun(begin(0.25), 0.03),
            straight,
        ),
        slide("sliding cylinder", strip(), cylinder, spun(begin(0.3), 0.0), straight),
        slide(
            "sliding hull",
            strip(),
            flat_hull(&mut Random::new(9), 8),
            spun(begin(0.4), 0.1),
            straight,
        ),
        slide(
            "sliding capsule",
            strip(),
            capsule,
            turned(begin(0.3), [1.0, 0.0, 0.0], QUARTER_TURN),
            straight,
        ),
    ]
}

/// Returns a scene with one solid on `ground`, without friction and with an initial velocity.
fn slide(
    name: &'static str,
    ground: SceneShape<3>,
    shape: SceneShape<3>,
    placement: Placement<3>,
    velocity: [f64; 3],
) -> Stack<3> {
    let mut stack = Stack::new(name, Kind::Slide).fixed(ground, [0.0; 3]);
    stack.friction = 0.0;
    stack.item(Item { solid: Solid::One(shape), placement, density: 1.0, velocity })
}
