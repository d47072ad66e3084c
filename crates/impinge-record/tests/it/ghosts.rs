//! Tests that a replay has the ghosts of the recorded meshes and height fields.

use impinge::math::{Point, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::shape::{HeightField, Polyline, ShapeHandle, TriMesh};
use impinge::world::CollisionGroups;
use impinge_record::{Recorder, Registry, Replay, validate};

const CONTACTS: GeometricQueryType<f32> = GeometricQueryType::Contacts(0.0, 0.0);

#[test]
fn tiles_have_their_ghosts() {
    let corners = [[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]];
    let corners = corners.map(|[x, z]| Point::<f32, 3>::new(x, 0.0, z));
    let mesh = TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]).with_ghosts(&[[2, 1, 3]]);
    let field = HeightField::<f32, 3>::new(4, 4, vec![0.0; 16], Vector::<f32, 3>::repeat(3.0));
    let mut field = field.with_ghost_border();
    field.set_hole(1, 1, true);
    let mut recorder = Recorder::<f32, 3, u32>::new(0.02, Registry::new()).expect("usable");
    for shape in [ShapeHandle::new(mesh.one_sided()), ShapeHandle::new(field)] {
        let (origin, groups) = (Default::default(), CollisionGroups::new());
        recorder.add(origin, shape, groups, CONTACTS, 0).expect("usable");
    }
    recorder.update();
    let (bytes, registry) = (recorder.finish().bytes, Registry::new());
    assert_eq!(validate::<f32, 3, u32>(&bytes, &registry), Ok(None));
    let mut replay = Replay::<f32, 3, u32>::open(bytes, &registry).expect("a recording");
    replay.seek(1).expect("an update");
    let shapes: Vec<_> =
        replay.world().collision_objects().map(|object| object.shape().clone()).collect();
    let mesh = shapes.iter().find_map(|shape| shape.as_shape::<TriMesh<f32, 3>>());
    let mesh = mesh.expect("the mesh");
    assert_eq!((mesh.triangles(), mesh.ghosts()), (&[[0, 1, 2]][..], &[[2, 1, 3]][..]));
    assert!(mesh.is_one_sided());
    let field = shapes.iter().find_map(|shape| shape.as_shape::<HeightField<f32, 3>>());
    let field = field.expect("the field");
    let ghosts = (0..18).filter(|&part| field.is_ghost(part)).count();
    assert_eq!((ghosts, field.is_hole(8), field.is_hole(0)), (16, true, false));
}

#[test]
fn a_line_has_its_ghosts_and_a_polyline_none() {
    let field = HeightField::<f32, 2>::new(vec![0.0; 4], Vector::<f32, 2>::repeat(3.0));
    let ends = [Point::<f32, 2>::origin(), Point::<f32, 2>::new(1.0, 0.0)];
    let mut recorder = Recorder::<f32, 2, u32>::new(0.02, Registry::new()).expect("usable");
    let shapes = [
        ShapeHandle::new(field.with_ghost_border()),
        ShapeHandle::new(Polyline::open(ends.to_vec())),
    ];
    for shape in shapes {
        let (origin, groups) = (Default::default(), CollisionGroups::new());
        recorder.add(origin, shape, groups, CONTACTS, 0).expect("usable");
    }
    recorder.update();
    let (bytes, registry) = (recorder.finish().bytes, Registry::new());
    let mut replay = Replay::<f32, 2, u32>::open(bytes, &registry).expect("a recording");
    replay.seek(1).expect("an update");
    let shapes: Vec<_> =
        replay.world().collision_objects().map(|object| object.shape().clone()).collect();
    let field = shapes.iter().find_map(|shape| shape.as_shape::<HeightField<f32, 2>>());
    let field = field.expect("the field");
    assert_eq!([0, 1, 2].map(|part| field.is_ghost(part)), [true, false, true]);
}
