//! Tests that closed meshes and polylines that were made solid are solid in a replay.

use impinge::dim2::math::Isometry as Isometry2;
use impinge::dim3::math::Isometry as Isometry3;
use impinge::math::{Point, Vector};
use impinge::narrow_phase::GeometricQueryType;
use impinge::procedural::space;
use impinge::shape::{Ball, Cuboid, Polyline, ShapeHandle, TriMesh};
use impinge::world::CollisionGroups;
use impinge_record::{Recorder, Registry, Replay, validate};

const CONTACTS: GeometricQueryType<f32> = GeometricQueryType::Contacts(0.0, 0.0);

#[test]
fn a_ball_in_a_solid_mesh() {
    let surface = space::cuboid(&Cuboid::new(Vector::<f32, 3>::repeat(2.0)));
    let block = ShapeHandle::new(TriMesh::new(surface.vertices, surface.triangles).solid());
    let mut recorder = Recorder::<f32, 3, u32>::new(0.02, Registry::new()).expect("usable");
    let (groups, ball) = (CollisionGroups::new(), ShapeHandle::new(Ball::new(0.25)));
    recorder.add(Isometry3::identity(), block, groups, CONTACTS, 0).expect("usable");
    recorder.add(Isometry3::translation(1.0, 0.0, 0.0), ball, groups, CONTACTS, 1).expect("usable");
    recorder.update();
    let (bytes, registry) = (recorder.finish().bytes, Registry::new());
    assert_eq!(validate::<f32, 3, u32>(&bytes, &registry), Ok(None));
    let mut replay = Replay::<f32, 3, u32>::open(bytes, &registry).expect("a recording");
    replay.seek(1).expect("an update");
    assert_eq!(replay.world().contact_views().count(), 1, "inside");
}

#[test]
fn a_ball_in_a_solid_line() {
    let corners = [[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]].map(Point::<f32, 2>::from);
    let block = ShapeHandle::new(Polyline::closed(corners.to_vec()).solid());
    let mut recorder = Recorder::<f32, 2, u32>::new(0.02, Registry::new()).expect("usable");
    let (groups, ball) = (CollisionGroups::new(), ShapeHandle::new(Ball::new(0.25)));
    recorder.add(Isometry2::identity(), block, groups, CONTACTS, 0).expect("usable");
    recorder.add(Isometry2::translation(1.0, 0.0), ball, groups, CONTACTS, 1).expect("usable");
    recorder.update();
    let (bytes, registry) = (recorder.finish().bytes, Registry::new());
    assert_eq!(validate::<f32, 2, u32>(&bytes, &registry), Ok(None));
    let mut replay = Replay::<f32, 2, u32>::open(bytes, &registry).expect("a recording");
    replay.seek(1).expect("an update");
    assert_eq!(replay.world().contact_views().count(), 1, "inside");
}
