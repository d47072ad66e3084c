//! Tests that calls that cannot be recorded return an error with the reason, and change nothing.

use impinge::bounding_volume::Aabb;
use impinge::dim2::math::{Isometry, Point};
use impinge::dim2::shape::{Geometry, Polyline, Rounded, ShapeError, ShapeHandle, TriMesh};
use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
use impinge::shape::{Ball, Shape};
use impinge_record::{Problem, RecordError, Recorder, Registry, Replay, validate};

/// A shape of a user-defined type.
#[derive(Debug)]
struct Coin(Ball<f64>);

impl Shape<f64, 2> for Coin {
    fn geometry(&self) -> Geometry<'_, f64> {
        Shape::<f64, 2>::geometry(&self.0)
    }

    fn local_aabb(&self) -> Aabb<f64, 2> {
        self.0.local_aabb()
    }
}

type Own = Recorder<f64, 2, u32>;

fn add(recorder: &mut Own, shape: ShapeHandle<f64>) -> Result<(), RecordError> {
    let query = GeometricQueryType::Contacts(0.0, 0.0);
    let added = recorder.add(Isometry::identity(), shape, CollisionGroups::new(), query, 0);
    added.map(|_| ())
}

#[test]
fn own_shapes_need_a_name() {
    let coin = ShapeHandle::new(Coin(Ball::new(1.0)));
    let mut recorder = Own::new(0.02, Registry::new()).expect("a usable margin");
    let refused = add(&mut recorder, coin.clone());
    assert_eq!(refused, Err(RecordError::UnknownShape { shape: format!("{:?}", &*coin) }));
    assert!(recorder.is_empty(), "nothing was added");

    let registry = Registry::new().with_shape("coin", coin.clone());
    let mut recorder = Own::new(0.02, registry.clone()).expect("a usable margin");
    add(&mut recorder, coin.clone()).expect("it has a name");
    add(&mut recorder, coin).expect("it has a name");
    recorder.update();
    assert_eq!(recorder.contact_events().len(), 1, "they overlap");
    let bytes = recorder.finish().bytes;
    assert_eq!(validate(&bytes, &registry), Ok(None));
    let error = Replay::<f64, 2, u32>::open(bytes, &Registry::new()).map(|_| ());
    let problem = error.expect_err("the name is not known").problem;
    assert_eq!(problem, Problem::UnknownShape("coin".to_owned()));
}

#[test]
fn meshes_whose_joints_moved_apart_are_refused() {
    let corners = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0], [1.0, 0.0], [0.0, 1.0], [1.0, 1.0]];
    let mut corners = corners.map(Point::from).to_vec();
    let mut mesh = TriMesh::<f64>::new(corners.clone(), vec![[0, 1, 2], [3, 5, 4]]);
    let mut line = Polyline::<f64>::new(corners.clone(), vec![[0, 1], [3, 5]]);
    corners[3].x = 3.0;
    mesh.set_vertices(&corners);
    line.set_vertices(&corners);
    let mut recorder = Own::new(0.02, Registry::new()).expect("a usable margin");
    for shape in [ShapeHandle::new(mesh), ShapeHandle::new(line)] {
        let refused = add(&mut recorder, shape);
        assert!(matches!(refused, Err(RecordError::Deformed { .. })), "{refused:?}");
    }
    let moved: Vec<_> = corners.iter().map(|corner| corner * 2.0).collect();
    let mut line = Polyline::<f64>::open(corners);
    line.set_vertices(&moved);
    add(&mut recorder, ShapeHandle::new(line)).expect("nothing came apart");
}

#[test]
fn shapes_that_nest_too_deep_are_refused() {
    let mut recorder = Own::new(0.02, Registry::new()).expect("a usable margin");
    let mut shape = ShapeHandle::<f64>::new(Ball::new(1.0));
    for _ in 0..impinge_record::MAX_DEPTH {
        let rounded = Rounded::try_from_handle(shape, 0.5).expect("a ball is convex");
        shape = ShapeHandle::new(rounded);
    }
    add(&mut recorder, shape.clone()).expect("just so deep");
    let deeper = Rounded::try_from_handle(shape, 0.5).expect_err("the library takes no more");
    assert_eq!(deeper, ShapeError::TooDeep { depth: impinge_record::MAX_DEPTH + 1 });
}

#[test]
fn worlds_with_unknown_filters_come_back() {
    type Object = impinge::dim2::world::CollisionObject<f64, u32>;
    let mut world = CollisionWorld::<f64, u32>::new(0.02);
    world.register_broad_phase_pair_filter("odd", |a: &Object, b: &Object| a.data() != b.data());
    let query = GeometricQueryType::Proximity(0.0);
    let ball = ShapeHandle::new(Ball::new(1.0));
    world.add(Isometry::identity(), ball, CollisionGroups::new(), query, 5);
    let refused = Own::of_world(world, 0.02, Registry::new()).map(|_| ());
    let refused = refused.expect_err("no filter is known");
    assert_eq!(refused.error, RecordError::UnknownFilter("odd".to_owned()));
    assert_eq!(refused.world.len(), 1, "the world is back");
    let refused = Own::of_world(*refused.world, f64::NAN, Registry::new()).map(|_| ());
    let error = refused.expect_err("no margin").error;
    assert!(matches!(error, RecordError::World(_)), "{error:?}");
}

#[test]
fn stale_handles_are_refused() {
    let mut recorder = Own::new(0.02, Registry::new()).expect("a usable margin");
    add(&mut recorder, ShapeHandle::new(Ball::new(1.0))).expect("a ball");
    let handle = recorder.collision_objects().next().expect("it is there").handle();
    recorder.remove(&[handle]).expect("it is there");
    let calls = [
        recorder.remove(&[handle]),
        recorder.set_position(handle, Isometry::identity()),
        recorder.set_data(handle, 3),
        recorder.set_collision_groups(handle, CollisionGroups::new()),
        recorder.set_query_type(handle, GeometricQueryType::Proximity(1.0)),
        recorder.set_shape(handle, ShapeHandle::new(Ball::new(2.0))),
    ];
    assert!(calls.iter().all(|call| matches!(call, Err(RecordError::World(_)))), "{calls:?}");
    recorder.update();
    assert_eq!(validate(&recorder.finish().bytes, &Registry::<f64, 2, u32>::new()), Ok(None));
}
