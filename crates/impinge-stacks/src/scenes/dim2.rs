//! Scenes in 2D.

use impinge_scenes::{Placement, Random, SceneShape};

use super::build::{cube, half_space, turned};
use crate::stack::{Item, Kind, Solid, Stack};

/// Returns all scenes in 2D.
#[must_use]
pub fn stacks2() -> Vec<Stack<2>> {
    vec![
        tower("20 boxes", half_space()),
        tower("20 boxes on a polyline", line(|_| 0.0)),
        pyramid(),
        polygons(),
        capsules(),
        sliding(),
    ]
}

/// Returns a polyline of 41 vertices, half a unit apart, from right to left: its front side faces
/// up.
fn line(height: impl Fn(usize) -> f64) -> SceneShape<2> {
    let vertices = (0..41).map(|n| [10.0 - 0.5 * n as f64, height(n)]);
    SceneShape::Polyline { vertices: vertices.collect() }
}

fn tower(name: &'static str, ground: SceneShape<2>) -> Stack<2> {
    let mut stack = Stack::new(name, Kind::Rest).fixed(ground, [0.0; 2]);
    stack.iterations = 30;
    (0..20).fold(stack, |stack, n| stack.with(cube(), Placement::at([0.1, n as f64 + 0.5])))
}

fn pyramid() -> Stack<2> {
    let stack = Stack::new("pyramid of 45", Kind::Rest).fixed(half_space(), [0.0; 2]);
    let places = (0..9).flat_map(|row| (0..9 - row).map(move |n| (row as f64, n as f64)));
    places.fold(stack, |stack, (row, n)| {
        stack.with(cube(), Placement::at([1.05 * (n + 0.5 * row), row + 0.5]))
    })
}

/// Octagons of height 1 that lie on their sides. The corner coordinates are 0.5 and 0.5 · tan(π/8).
fn polygons() -> Stack<2> {
    let stack = Stack::new("8 octagons", Kind::Rest).fixed(line(|_| 0.0), [0.0; 2]);
    let near = 0.5 * (2.0_f64.sqrt() - 1.0);
    let mut points = Vec::new();
    for [a, b] in [[-1.0, -1.0], [-1.0, 1.0], [1.0, -1.0], [1.0, 1.0]] {
        points.extend([[a * near, b * 0.5], [a * 0.5, b * near]]);
    }
    (0..8).fold(stack, |stack, n| {
        let shape = SceneShape::Convex { points: points.clone() };
        stack.with(shape, Placement::at([0.1, n as f64 + 0.5]))
    })
}

/// Capsules that fall into the hollows of a polyline.
fn capsules() -> Stack<2> {
    let mut random = Random::new(5);
    let ground = line(|n| if n % 4 == 0 { 0.5 } else { 0.0 });
    let stack = Stack::new("capsules on a polyline", Kind::Fall).fixed(ground, [0.0; 2]);
    (0..8).fold(stack, |stack, n| {
        let x = 2.0 * (n as f64 - 3.5) + random.between(-0.2, 0.2);
        let shape = SceneShape::Capsule { half_height: 0.3, radius: 0.2 };
        stack.with(shape, turned([x, 1.5], [0.0, 0.0, 1.0], random.between(-1.0, 1.0)))
    })
}

/// A box that slides on a polyline of 120 segments.
fn sliding() -> Stack<2> {
    let vertices = (0..121).map(|n| [30.0 - 0.5 * n as f64, 0.0]);
    let ground = SceneShape::Polyline { vertices: vertices.collect() };
    let mut stack = Stack::new("sliding box 2D", Kind::Slide).fixed(ground, [0.0; 2]);
    stack.friction = 0.0;
    stack.item(Item {
        solid: Solid::One(SceneShape::Cuboid { half_extents: [0.5, 0.25] }),
        placement: Placement::at([-28.0, 0.25]),
        density: 1.0,
        velocity: [5.0, 0.0],
    })
}
