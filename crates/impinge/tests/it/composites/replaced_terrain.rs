//! Bug: when the shape of a terrain was replaced, solids kept the point that decided on which side of
//! the old terrain they were. Raised together with the terrain, they were pushed below it for ever.

use impinge::math::{Isometry2, Isometry3, Point, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::shape::{Ball, Capsule, Cuboid, HeightField, Polyline, ShapeHandle, TriMesh};
use impinge::world::{CollisionGroups, CollisionWorld};

type Flat2 = fn(f64) -> ShapeHandle<f64, 2>;
type Flat3 = fn(f64) -> ShapeHandle<f64, 3>;

const FLOORS2: [Flat2; 4] = [
    |h| ShapeHandle::new(Polyline::open(vec![[-5.0, h].into(), [5.0, h].into()])),
    |h| ShapeHandle::new(Polyline::open(vec![[5.0, h].into(), [-5.0, h].into()]).one_sided()),
    |h| ShapeHandle::new(HeightField::<f64, 2>::new(vec![h; 6], Vector::<f64, 2>::new(10.0, 1.0))),
    |h| {
        let field = HeightField::<f64, 2>::new(vec![h; 6], Vector::<f64, 2>::new(10.0, 1.0));
        ShapeHandle::new(field.one_sided())
    },
];

const FLOORS3: [Flat3; 3] = [
    |h| {
        let corners = [[-5.0, h, -5.0], [5.0, h, -5.0], [5.0, h, 5.0], [-5.0, h, 5.0]];
        let corners = corners.map(Point::<f64, 3>::from).to_vec();
        ShapeHandle::new(TriMesh::new(corners, vec![[0, 2, 1], [0, 3, 2]]))
    },
    |h| {
        let scale = Vector::<f64, 3>::new(10.0, 1.0, 10.0);
        ShapeHandle::new(HeightField::<f64, 3>::new(6, 6, vec![h; 36], scale))
    },
    |h| {
        let scale = Vector::<f64, 3>::new(10.0, 1.0, 10.0);
        ShapeHandle::new(HeightField::<f64, 3>::new(6, 6, vec![h; 36], scale).one_sided())
    },
];

#[test]
fn raised_with_the_terrain_in_the_plane() {
    let solids = [
        ShapeHandle::new(Ball::new(1.0)),
        ShapeHandle::new(Cuboid::new(Vector::<f64, 2>::new(1.0, 1.0))),
        ShapeHandle::new(Capsule::<f64, 2>::new(0.5, 0.5)),
    ];
    let at = |y: f64| Isometry2::translation(0.3, y);
    let query = GeometricQueryType::Contacts(0.01, 0.0);
    for (number, floor) in FLOORS2.iter().enumerate() {
        for solid in &solids {
            let (mut world, groups) = (CollisionWorld::new(0.02), CollisionGroups::new());
            let terrain = world.add(Isometry2::identity(), floor(0.0), groups, query, ());
            let body = world.add(at(0.9), solid.clone(), groups, query, ());
            world.update();
            world.set_shape(terrain, floor(1.0));
            world.set_position(body, at(1.9));
            for _ in 0..3 {
                world.update();
                let depths = world.contacts_with(body).map(|(_, point)| point.contact.depth);
                let deepest = depths.reduce(f64::max).expect("a contact");
                assert!((deepest - 0.1).abs() < 1e-12, "{deepest}: {solid:?} on floor {number}");
            }
        }
    }
}

#[test]
fn raised_with_the_terrain_in_space() {
    let solids = [
        (ShapeHandle::new(Ball::new(1.0)), 0.9),
        (ShapeHandle::new(Cuboid::new(Vector::<f64, 3>::new(1.0, 1.0, 1.0))), 0.9),
        (ShapeHandle::new(Capsule::<f64, 3>::new(0.5, 0.5)), 0.9),
        (ShapeHandle::new(Cuboid::new(Vector::<f64, 3>::new(1.0, 0.0625, 1.0))), 0.0546875),
    ];
    let query = GeometricQueryType::Contacts(0.001, 0.0);
    for (number, floor) in FLOORS3.iter().enumerate() {
        for (solid, height) in &solids {
            let rise = if *height < 0.5 { 0.0625 } else { 1.0 };
            let at = |y: f64| Isometry3::translation(0.3, y, 0.2);
            let (mut world, groups) = (CollisionWorld::new(0.02), CollisionGroups::new());
            let terrain = world.add(Isometry3::identity(), floor(0.0), groups, query, ());
            let body = world.add(at(*height), solid.clone(), groups, query, ());
            world.update();
            let depth = |world: &CollisionWorld<f64, 3, ()>| {
                let depths = world.contacts_with(body).map(|(_, point)| point.contact.depth);
                depths.reduce(f64::max).expect("a contact")
            };
            let expected = depth(&world);
            world.set_shape(terrain, floor(rise));
            world.set_position(body, at(height + rise));
            for _ in 0..3 {
                world.update();
                let found = depth(&world);
                assert!((found - expected).abs() < 1e-12, "{found}: {solid:?} on floor {number}");
            }
        }
    }
}
