//! Bug: a solid deep in a valley beside ghosts had no contact with any tile: each tile left the
//! contact to its neighbour, also where the solid did not reach the ghost.

use impinge::math::{Isometry2, Isometry3, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::shape::{Capsule, Cuboid, HeightField, ShapeHandle};
use impinge::world::{CollisionGroups, CollisionWorld};

/// Returns the number of contacts of a capsule at `(x, y)` with two tiles, whose heights are a valley
/// at `valley`; the seam of the tiles is at 0.
fn contacts(valley: f64, [x, y]: [f64; 2], radius: f64, is_one_sided: bool) -> usize {
    let height = |x: f64| 0.25 * (x - valley).abs().min(1.0);
    let tile = |from: i32| {
        let heights = (from - 1..from + 6).map(|x| height(x.into())).collect();
        let field = HeightField::<f64, 2>::new(heights, Vector::<f64, 2>::new(6.0, 1.0));
        let field = field.with_ghost_border();
        ShapeHandle::new(if is_one_sided { field.one_sided() } else { field })
    };
    let query = GeometricQueryType::Contacts(0.0, 0.0);
    let (mut world, groups) = (CollisionWorld::new(0.02), CollisionGroups::new());
    world.add(Isometry2::translation(-2.0, 0.0), tile(-4), groups, query, ());
    world.add(Isometry2::translation(2.0, 0.0), tile(0), groups, query, ());
    let solid = ShapeHandle::new(Capsule::<f64, 2>::new(1.0, radius));
    let body = world.add(Isometry2::translation(x, y), solid, groups, query, ());
    world.update();
    world.contacts_with(body).count()
}

#[test]
fn capsules_deep_in_a_valley() {
    for valley in [-1.0, 0.0, 1.0, 2.0] {
        for y in [1.0, 0.95, 0.8] {
            for (radius, is_one_sided) in [(0.25, false), (0.5, false), (0.25, true)] {
                let count = contacts(valley, [valley, y], radius, is_one_sided);
                assert!(count > 0, "at {valley}, {y}: radius {radius}, one side {is_one_sided}");
            }
        }
    }
}

#[test]
fn boxes_over_the_cells_of_one_tile() {
    // A tile of 4 x 4 cells between ghosts, with rough heights.
    let rows = [
        [0.0, -0.5, 0.0, -0.5, 0.0, 0.0],
        [0.25, -0.5, 0.5, 0.25, -0.5, 0.25],
        [1.0, 0.25, 0.25, 0.25, 0.25, 0.5],
        [1.0, 0.25, 0.0, 0.25, 0.0, 0.0],
        [-0.5, 0.5, 0.0, 0.5, -0.5, 0.0],
        [0.0, 0.5, 0.0, -0.5, 0.5, 0.0],
    ];
    let scale = Vector::<f64, 3>::new(5.0, 1.0, 5.0);
    let field = || HeightField::<f64, 3>::new(6, 6, rows.concat(), scale);
    let tiles = [field(), field().with_ghost_border()].map(ShapeHandle::new);
    let query = GeometricQueryType::Contacts(0.0, 0.0);
    for [x, y, z] in [[2.75, 0.125, 1.0], [2.6, 0.125, 1.1], [2.7, 0.125, 1.0], [2.75, 0.0, 1.0]] {
        for (number, tile) in tiles.iter().enumerate() {
            let (mut world, groups) = (CollisionWorld::new(0.02), CollisionGroups::new());
            world.add(Isometry3::translation(2.5, 0.0, 1.5), tile.clone(), groups, query, ());
            let solid = ShapeHandle::new(Cuboid::new(Vector::<f64, 3>::repeat(0.5)));
            let body = world.add(Isometry3::translation(x, y, z), solid, groups, query, ());
            world.update();
            let count = world.contacts_with(body).count();
            assert!(count > 0, "tile {number} at {x}, {y}, {z}");
        }
    }
}
