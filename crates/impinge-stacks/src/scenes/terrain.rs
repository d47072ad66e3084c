//! Stacks in 3D on meshes and height fields.

use impinge_scenes::{Placement, Random, SceneShape};

use super::build::{
    QUARTER_TURN, TURN_03, cube, egg_box, field, flat_mesh, mesh, round_hull, spun, times, turned,
};
use super::dim3::aligned;
use crate::stack::{Kind, Stack};

pub(super) fn stacks() -> Vec<Stack<3>> {
    vec![
        aligned("cubes on a mesh", mesh([12, 12], 0.7, |_, _| 0.0)),
        aligned("cubes on a field", field([12; 2], [9.0; 2], |_, _| 0.0)),
        winding(),
        upright(),
        lying(),
        cone(),
        capsules(),
        rolling(),
        hulls_on_hills(),
    ]
}

/// Ten cubes, each rotated by 0.3 radians relative to the one below.
fn winding() -> Stack<3> {
    let stack = Stack::new("winding cubes on a mesh", Kind::Rest).fixed(flat_mesh(), [0.0; 3]);
    (0..10).fold(stack, |stack, n| {
        stack.with(cube(), spun([0.2, n as f64 + 0.5, 0.1], times(TURN_03, n)))
    })
}

/// Six upright cylinders on top of each other.
fn upright() -> Stack<3> {
    let stack = Stack::new("cylinders on a mesh", Kind::Rest).fixed(flat_mesh(), [0.0; 3]);
    let shape = SceneShape::Cylinder { half_height: 0.5, radius: 0.5 };
    (0..6).fold(stack, |stack, n| {
        stack.with(shape.clone(), Placement::at([0.2, n as f64 + 0.5, 0.1]))
    })
}

/// Three cylinders that lie beside each other, with a board across them.
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

/// Capsules that lie in grooves, whose sides fall by 0.3 over a width of 0.8.
fn capsules() -> Stack<3> {
    let ground = field([12; 2], [9.6; 2], |_, row| if row % 2 == 1 { -0.3 } else { 0.0 });
    let shape = SceneShape::Capsule { half_height: 0.5, radius: 0.2 };
    let stack = Stack::new("capsules on a field", Kind::Rest).fixed(ground, [0.0; 3]);
    // The height of the axis above the bottom is the radius divided by the cosine of the slope.
    let height = 0.2 * (1.0 + 0.375_f64 * 0.375).sqrt() - 0.3;
    (0..6).fold(stack, |stack, n| {
        let at = [0.3 * n as f64 - 1.1, height, 1.6 * n as f64 - 4.0];
        stack.with(shape.clone(), turned(at, [0.0, 0.0, 1.0], QUARTER_TURN))
    })
}

/// Capsules that fall into hollows, in which nothing prevents them from rolling.
fn rolling() -> Stack<3> {
    let mut random = Random::new(12);
    let ground = field([12; 2], [9.6; 2], egg_box(0.4));
    let stack = Stack::new("capsules in hollows", Kind::Fall).fixed(ground, [0.0; 3]);
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
    let ground = field([16; 2], [12.0; 2], hill);
    let stack = Stack::new("40 hulls on hills", Kind::Fall).fixed(ground, [0.0; 3]);
    (0..40).fold(stack, |stack, n| {
        let [x, y, z] = [n % 5, n / 25, n / 5 % 5].map(|k| k as f64);
        let at = [1.6 * (x - 2.0), 1.5 + 1.3 * y, 1.6 * (z - 2.0)];
        let shape = round_hull(&mut random, 24, 0.5);
        stack.with(shape, turned(at, random.direction(), random.between(-1.0, 1.0)))
    })
}
