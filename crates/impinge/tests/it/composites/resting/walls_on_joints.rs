//! Walls of boxes exactly above the grid lines of a floor. Each wall only touches the triangles or
//! segments beside it, so the depth of the box follows from the normal of the floor alone.

use impinge::math::{AbstractRotation, Isometry, Isometry2, Isometry3, Point, Space, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::query::contact;
use impinge::shape::{Cuboid, HeightField, Polyline, Segment, ShapeHandle, TriMesh};
use impinge::world::{CollisionGroups, CollisionWorld};

/// Returns the depth and the normal of the deepest contact in a world, and the number of contacts.
/// The floor is at the origin.
fn deepest<N: Space<D>, R, const D: usize>(
    floor: &ShapeHandle<N, D>,
    solid: &ShapeHandle<N, D>,
    place: &Isometry<N, R, D>,
) -> (N, Vector<N, D>, usize)
where
    R: AbstractRotation<N, D> + Copy,
    Isometry<N, R, D>: Into<N::Isometry>,
{
    let query = GeometricQueryType::Contacts(N::ZERO, N::ZERO);
    let (mut world, groups) = (CollisionWorld::new(N::lit(0.02)), CollisionGroups::new());
    world.add(Isometry::<N, R, D>::identity().into(), floor.clone(), groups, query, ());
    world.add((*place).into(), solid.clone(), groups, query, ());
    world.update();
    let manifolds = world.contact_manifolds().map(|(_, _, manifold)| manifold);
    let contacts: Vec<_> = manifolds.flat_map(|manifold| manifold.contacts().to_vec()).collect();
    let all = contacts.iter().map(|tracked| &tracked.contact);
    let best = all.reduce(|best, next| if next.depth > best.depth { next } else { best });
    let best = best.expect("they overlap");
    (best.depth, best.normal.into_inner(), contacts.len())
}

/// Asserts that a solid that is `depth` below a floor has that depth, upwards, in a world and in a
/// query, at a place beside the grid of the floor by `aside`.
fn sinks<N: Space<D>, R, const D: usize>(
    floor: &ShapeHandle<N, D>,
    solid: &ShapeHandle<N, D>,
    place: [f64; D],
    depth: f64,
) -> usize
where
    R: AbstractRotation<N, D> + Copy,
    Isometry<N, R, D>: Into<N::Isometry>,
{
    let at = Vector::<N, D>::from(place.map(N::lit));
    let place = Isometry::<N, R, D>::from_parts(at.into(), R::identity());
    let (found, normal, count) = deepest(floor, solid, &place);
    let is_right = |found: N| (found - N::lit(depth)).abs() <= N::lit(64.0) * N::EPSILON;
    assert!(is_right(found), "{found} instead of {depth} at {at:?}: {solid:?} on {floor:?}");
    assert!(normal[1] > N::lit(0.999), "{normal:?} at {at:?}: {solid:?} on {floor:?}");
    let here = Isometry::<N, R, D>::identity();
    let found = contact(&here, &**floor, &place, &**solid, N::ZERO).expect("they overlap");
    assert!(is_right(found.depth), "{} instead of {depth} at {at:?}", found.depth);
    count
}

fn in_space<N: Space<3, Isometry = Isometry3<N>>>() {
    let scale = Vector::<N, 3>::from([4.0, 1.0, 4.0].map(N::lit));
    let field = HeightField::<N, 3>::new(5, 5, vec![N::ZERO; 25], scale);
    let grid = (0..25_u32).map(|at| [f64::from(at % 5) - 2.0, 0.0, f64::from(at / 5) - 2.0]);
    let vertices = grid.map(|at| Point::<N, 3>::from(at.map(N::lit))).collect();
    let cells = (0..20_u32).filter(|at| at % 5 < 4);
    let triangles = cells.flat_map(|at| [[at, at + 5, at + 1], [at + 1, at + 5, at + 6]]).collect();
    let floors = [ShapeHandle::new(TriMesh::new(vertices, triangles)), ShapeHandle::new(field)];
    let box_of = |half: [f64; 3]| Cuboid::new(Vector::<N, 3>::from(half.map(N::lit)));
    let surface = impinge::procedural::space::cuboid(&box_of([0.5; 3]));
    let mesh = || TriMesh::new(surface.vertices.clone(), surface.triangles.clone());
    // The least number of contacts: a mesh that is not solid has contacts of its walls alone.
    let solids = [
        (ShapeHandle::new(box_of([0.5; 3])), 4),
        (ShapeHandle::new(mesh()), 1),
        (ShapeHandle::new(mesh().one_sided()), 1),
        (ShapeHandle::new(mesh().solid()), 4),
    ];
    let places = [[0.5, 0.5], [-0.5, 0.5], [0.5, 0.0], [0.515_625, 0.507_812_5]];
    let pane = ShapeHandle::new(box_of([0.0, 0.5, 0.5]));
    for floor in &floors {
        for depth in [1.0 / 64.0, 1.0 / 8.0, 1.0 / 4.0] {
            for ([x, z], (solid, least)) in
                places.iter().flat_map(|place| solids.iter().map(move |solid| (place, solid)))
            {
                let count = sinks(floor, solid, [*x, 0.5 - depth, *z], depth);
                assert!(count >= *least, "{count} contacts of {solid:?} at {x}, {z}");
            }
            sinks(floor, &pane, [0.0, 0.5 - depth, 0.0], depth);
            sinks(floor, &pane, [1.0, 0.5 - depth, 0.5], depth);
        }
    }
}

fn in_plane<N: Space<2, Isometry = Isometry2<N>>>() {
    let point = |x: f64, y: f64| Point::<N, 2>::from([x, y].map(N::lit));
    let line = || Polyline::open((-2..=2).map(|x| point(f64::from(x), 0.0)).collect());
    let floors = [
        ShapeHandle::new(line()),
        ShapeHandle::new(HeightField::<N, 2>::new(
            vec![N::ZERO; 5],
            Vector::<N, 2>::from([4.0, 1.0].map(N::lit)),
        )),
    ];
    let corners = [(-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5)].map(|(x, y)| point(x, y));
    let solids = [
        ShapeHandle::new(Cuboid::new(Vector::<N, 2>::repeat(N::HALF))),
        ShapeHandle::new(Polyline::closed(corners.to_vec())),
        ShapeHandle::new(Polyline::closed(corners.to_vec()).solid()),
    ];
    let thin = [
        ShapeHandle::new(Segment::new(point(0.0, -0.5), point(0.0, 0.5))),
        ShapeHandle::new(Cuboid::new(Vector::<N, 2>::from([0.0, 0.5].map(N::lit)))),
    ];
    for floor in &floors {
        for depth in [1.0 / 64.0, 1.0 / 8.0, 1.0 / 4.0] {
            for x in [0.5, -0.5, 0.515_625] {
                solids.iter().for_each(|solid| {
                    sinks(floor, solid, [x, 0.5 - depth], depth);
                });
            }
            for x in [0.0, 1.0, 0.25] {
                thin.iter().for_each(|solid| {
                    sinks(floor, solid, [x, 0.5 - depth], depth);
                });
            }
        }
    }
}

#[test]
fn boxes_on_the_lines_of_a_floor() {
    in_space::<f64>();
    in_space::<f32>();
}

#[test]
fn boxes_on_the_vertices_of_a_chain() {
    in_plane::<f64>();
    in_plane::<f32>();
}
