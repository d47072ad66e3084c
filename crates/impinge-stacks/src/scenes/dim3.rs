//! Stacks in 3D on half-spaces and boxes.

use impinge_scenes::{Placement, Random, SceneShape};

use super::build::{
    EIGHTH_TURN, TURN_03, cube, dodecahedron, flat_hull, half_space, spun, times, turned,
};
use crate::stack::{Item, Kind, Solid, Stack};

pub(super) fn stacks() -> Vec<Stack<3>> {
    let mut all = vec![aligned("cubes on a plane", half_space())];
    all.extend([crooked("crooked cubes 1", 1), crooked("crooked cubes 2", 2)]);
    all.extend([
        twisted("cubes turned by 0.3", TURN_03),
        twisted("cubes turned by a quarter of pi", EIGHTH_TURN),
        towers(),
        wall(),
        step_pyramid(),
        balls(),
        cylinders(),
        tower_of("cones", 1, SceneShape::Cone { half_height: 0.5, radius: 0.5 }, 1.0),
        tower_of("dodecahedra", 5, dodecahedron(), 1.0),
        hulls(),
        table(),
        over_an_edge(),
    ]);
    all
}

/// Ten cubes exactly above each other.
pub(super) fn aligned(name: &'static str, ground: SceneShape<3>) -> Stack<3> {
    let stack = Stack::new(name, Kind::Rest).fixed(ground, [0.0; 3]);
    (0..10).fold(stack, |stack, n| stack.with(cube(), Placement::at([0.0, n as f64 + 0.5, 0.0])))
}

/// Ten cubes, displaced by up to 0.03 and rotated about the vertical by up to 0.05 radians.
fn crooked(name: &'static str, seed: u64) -> Stack<3> {
    let mut random = Random::new(seed);
    let stack = Stack::new(name, Kind::Rest).fixed(half_space(), [0.0; 3]);
    (0..10).fold(stack, |stack, n| {
        let [x, z] = [0, 1].map(|_| random.between(-0.03, 0.03));
        stack.with(cube(), spun([x, n as f64 + 0.5, z], random.between(-0.025, 0.025)))
    })
}

/// Ten cubes, every other one rotated about the vertical.
fn twisted(name: &'static str, tangent: f64) -> Stack<3> {
    let stack = Stack::new(name, Kind::Rest).fixed(half_space(), [0.0; 3]);
    (0..10).fold(stack, |stack, n| {
        stack.with(cube(), spun([0.0, n as f64 + 0.5, 0.0], times(tangent, n % 2)))
    })
}

/// Nine towers of four cubes.
fn towers() -> Stack<3> {
    let stack = Stack::new("towers of 4", Kind::Rest).fixed(half_space(), [0.0; 3]);
    (0..36).fold(stack, |stack, n| {
        let [x, y, z] = [n % 3, n / 9, n / 3 % 3].map(|k| k as f64);
        stack.with(cube(), Placement::at([1.5 * x, y + 0.5, 1.5 * z]))
    })
}

/// A wall of rows of ten cubes, nine, and so on up to one.
fn wall() -> Stack<3> {
    let stack = Stack::new("wall of 55", Kind::Rest).fixed(half_space(), [0.0; 3]);
    let places = (0..10).flat_map(|row| (0..10 - row).map(move |n| (row as f64, n as f64)));
    places.fold(stack, |stack, (row, n)| {
        stack.with(cube(), Placement::at([1.05 * (n + 0.5 * row), row + 0.5, 0.0]))
    })
}

/// Layers of 25, 16, 9, 4 and 1 cubes.
fn step_pyramid() -> Stack<3> {
    let stack = Stack::new("step pyramid", Kind::Rest).fixed(half_space(), [0.0; 3]);
    let layers = (0..5).flat_map(|row| {
        let side = 5 - row;
        (0..side * side).map(move |n| [n % side, row, n / side].map(|k: usize| k as f64))
    });
    layers.fold(stack, |stack, [i, row, k]| {
        let [x, z] = [i, k].map(|n| 1.05 * (n + 0.5 * row));
        stack.with(cube(), Placement::at([x, row + 0.5, z]))
    })
}

/// Balls that fall into a box.
fn balls() -> Stack<3> {
    let mut random = Random::new(30);
    let mut stack = Stack::new("30 balls", Kind::Fall).fixed(half_space(), [0.0; 3]);
    let wall = |along: [f64; 3]| SceneShape::Cuboid { half_extents: along };
    for side in [-1.0, 1.0] {
        stack = stack.fixed(wall([0.5, 3.0, 2.0]), [2.0 * side, 3.0, 0.0]);
        stack = stack.fixed(wall([2.0, 3.0, 0.5]), [0.0, 3.0, 2.0 * side]);
    }
    (0..30).fold(stack, |stack, n| {
        let [i, j, k] = [n % 3, n / 9, n / 3 % 3].map(|k| k as f64);
        let [x, z] = [i, k].map(|n| 0.9 * (n - 1.0) + random.between(-0.02, 0.02));
        let radius = random.between(0.35, 0.45);
        stack.with(SceneShape::Ball { radius }, Placement::at([x, j + 0.6, z]))
    })
}

/// Six upright cylinders on top of each other.
fn cylinders() -> Stack<3> {
    tower_of("cylinders", 6, SceneShape::Cylinder { half_height: 0.5, radius: 0.5 }, 1.0)
}

/// Equal solids on top of each other on a half-space.
fn tower_of(name: &'static str, count: usize, shape: SceneShape<3>, height: f64) -> Stack<3> {
    let stack = Stack::new(name, Kind::Rest).fixed(half_space(), [0.0; 3]);
    (0..count).fold(stack, |stack, n| {
        stack.with(shape.clone(), Placement::at([0.0, height * (n as f64 + 0.5), 0.0]))
    })
}

/// Four random hulls with flat tops and bottoms.
fn hulls() -> Stack<3> {
    let mut random = Random::new(7);
    let stack = Stack::new("random hulls", Kind::Rest).fixed(half_space(), [0.0; 3]);
    (0..4).fold(stack, |stack, n| {
        let hull = flat_hull(&mut random, 12);
        stack.with(hull, Placement::at([0.0, 0.8 * n as f64 + 0.4, 0.0]))
    })
}

/// A table with a top and four legs, and a cube on it.
fn table() -> Stack<3> {
    let cuboid = |half_extents| SceneShape::Cuboid { half_extents };
    let mut parts = vec![(Placement::at([0.0, 0.5, 0.0]), cuboid([1.0, 0.1, 0.7]))];
    for [x, z] in [[-0.9, -0.6], [-0.9, 0.6], [0.9, -0.6], [0.9, 0.6]] {
        parts.push((Placement::at([x, -0.1, z]), cuboid([0.1, 0.5, 0.1])));
    }
    let solid = Solid::Compound(parts);
    let placement = Placement::at([0.0, 0.6, 0.0]);
    let table = Item { solid, placement, density: 1.0, velocity: [0.0; 3] };
    let stack = Stack::new("table of four legs", Kind::Rest).fixed(half_space(), [0.0; 3]);
    stack.item(table).with(cube(), spun([0.2, 1.7, 0.1], TURN_03))
}

/// A long box on a table. The centre of mass of the box is behind the table's edge, by a twentieth
/// of the length of the box.
fn over_an_edge() -> Stack<3> {
    let stack = Stack::new("box over an edge", Kind::Rest);
    let stack = stack.fixed(SceneShape::Cuboid { half_extents: [1.0, 0.5, 1.0] }, [0.0, 0.5, 0.0]);
    let long = SceneShape::Cuboid { half_extents: [1.0, 0.25, 0.4] };
    stack.with(long, turned([0.9, 1.25, 0.0], [0.0, 1.0, 0.0], 0.0))
}
