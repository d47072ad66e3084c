//! Stacks in 3D on meshes and height fields, and what slides there.

use impinge_scenes::{Placement, Random, SceneShape};

use super::build::{
    QUARTER_TURN, TURN_03, cube, egg_box, field, flat_mesh, mesh, round_hull, spun, times, turned,
};
use super::space::aligned;
use crate::stack::{Item, Kind, Solid, Stack};

pub(super) fn stacks() -> Vec<Stack<3>> {
    vec![
        aligned("cubes on a mesh", mesh([12, 12], 0.7, |_, _| 0.0)),
        aligned("cubes on a field", field(12, 9.0, |_, _| 0.0)),
        winding(),
        upright(),
        lying(),
        cone(),
        capsules(),
        hulls_on_hills(),
        sliding(),
    ]
}

/// Ten cubes, each turned by 0.3 more than the one below.
fn winding() -> Stack<3> {
    let stack = Stack::new("winding cubes on a mesh", Kind::Rest).fixed(flat_mesh(), [0.0; 3]);
    (0..10).fold(stack, |stack, n| {
        stack.with(cube(), spun([0.2, n as f64 + 0.5, 0.1], times(TURN_03, n)))
    })
}

/// Six cylinders upright on each other.
fn upright() -> Stack<3> {
    let stack = Stack::new("cylinders on a mesh", Kind::Rest).fixed(flat_mesh(), [0.0; 3]);
    let shape = SceneShape::Cylinder { half_height: 0.5, radius: 0.5 };
    (0..6).fold(stack, |stack, n| {
        stack.with(shape.clone(), Placement::at([0.2, n as f64 + 0.5, 0.1]))
    })
}

/// Three cylinders lie beside each other, a board across them.
fn lying() -> Stack<3> {
    let shape = SceneShape::Cylinder { half_height: 1.0, radius: 0.4 };
    let stack = Stack::new("lying cylinders", Kind::Rest).fixed(flat_mesh(), [0.0; 3]);
    let stack = (0..3).fold(stack, |stack, n| {
        let at = [1.1 * (n as f64 - 1.0), 0.4, 0.1];
        stack.with(shape.clone(), turned(at, [1.0, 0.0, 0.0], QUARTER_TURN))
    });
    let board = SceneShape::Cuboid { half_extents: [1.5, 0.1, 0.5] };
    stack.with(board, Placement::at([0.0, 0.9, 0.1]))
}

/// A cone on its base.
fn cone() -> Stack<3> {
    let cone = SceneShape::Cone { half_height: 0.5, radius: 0.5 };
    let stack = Stack::new("cone on a mesh", Kind::Rest).fixed(flat_mesh(), [0.0; 3]);
    stack.with(cone, spun([0.2, 0.5, 0.1], TURN_03))
}

/// Capsules that fall into hollows.
fn capsules() -> Stack<3> {
    let mut random = Random::new(12);
    let ground = field(12, 9.6, egg_box(0.4));
    let stack = Stack::new("capsules on a field", Kind::Fall).fixed(ground, [0.0; 3]);
    (0..9).fold(stack, |stack, n| {
        let [x, z] = [n % 3, n / 3].map(|k| 1.6 * (k as f64 - 1.0) + random.between(-0.1, 0.1));
        let shape = SceneShape::Capsule { half_height: 0.3, radius: 0.2 };
        stack.with(shape, turned([x, 0.6, z], random.direction(), random.between(-1.0, 1.0)))
    })
}

/// Hulls that fall onto hills.
fn hulls_on_hills() -> Stack<3> {
    let mut random = Random::new(40);
    let mut heights = Random::new(41);
    let heights: Vec<f64> = (0..17 * 17).map(|_| heights.between(0.0, 0.5)).collect();
    let edge = |n: usize| n == 0 || n == 16;
    let hill = |i: usize, j: usize| {
        if edge(i) || edge(j) { 2.0 } else { heights[17 * j + i] }
    };
    let ground = field(16, 12.0, hill);
    let stack = Stack::new("40 hulls on hills", Kind::Fall).fixed(ground, [0.0; 3]);
    (0..40).fold(stack, |stack, n| {
        let [x, y, z] = [n % 5, n / 25, n / 5 % 5].map(|k| k as f64);
        let at = [1.6 * (x - 2.0), 1.5 + 1.3 * y, 1.6 * (z - 2.0)];
        let shape = round_hull(&mut random, 24, 0.5);
        stack.with(shape, turned(at, random.direction(), random.between(-1.0, 1.0)))
    })
}

/// A box that slides over a strip of 120 × 12 cells, 2880 triangles, at five units a second.
fn sliding() -> Stack<3> {
    let strip = mesh([120, 12], 0.5, |_, _| 0.0);
    let mut stack = Stack::new("sliding box", Kind::Slide).fixed(strip, [0.0; 3]);
    stack.friction = 0.0;
    stack.item(Item {
        solid: Solid::One(SceneShape::Cuboid { half_extents: [0.5, 0.25, 0.4] }),
        placement: spun([-28.0, 0.25, 0.13], 0.03),
        density: 1.0,
        velocity: [5.0, 0.0, 0.0],
    })
}
