//! Compares ray casts, shape casts, overlaps and nearest points with results computed by hand.

use avian_impinge::d3::{Collider, ShapeCastConfig, SpatialQuery};
use avian3d::prelude::{CollisionLayers, SpatialQueryFilter};
use bevy_app::App;
use bevy_ecs::prelude::*;
use bevy_ecs::system::RunSystemOnce;
use bevy_math::{Dir3, Quat, Vec3};

use crate::scenes3::{Backend, Impinge, app, dynamic, fixed, floor, steps};

/// Returns an app with a floor, a ball on it at x = 0, and a box at x = 4.
fn scene() -> (App, [Entity; 3]) {
    let mut app = app::<Impinge>();
    let floor = floor::<Impinge>(&mut app);
    let ball = dynamic::<Impinge>(&mut app, Impinge::sphere(0.5), Vec3::Y * 0.5);
    let cube = fixed::<Impinge>(&mut app, Impinge::cuboid(1.0, 1.0, 1.0), Vec3::new(4.0, 0.5, 0.0));
    app.world_mut().entity_mut(cube).insert(CollisionLayers::new(0b10, 0b11));
    steps(&mut app, 30);
    (app, [floor, ball, cube])
}

fn ask<T: 'static>(
    app: &mut App,
    question: impl Fn(&SpatialQuery<'_, '_>) -> T + Send + Sync + 'static,
) -> T {
    let asked = move |spatial: SpatialQuery<'_, '_>| question(&spatial);
    app.world_mut().run_system_once(asked).expect("it has what it reads")
}

#[test]
fn rays() {
    let (mut app, [floor, ball, cube]) = scene();
    let from = Vec3::new(-5.0, 0.5, 0.0);
    let all = SpatialQueryFilter::default();
    let hit = ask(&mut app, move |spatial| spatial.cast_ray(from, Dir3::X, 100.0, true, &all));
    let hit = hit.expect("the ball");
    assert_eq!(hit.entity, ball);
    assert!((hit.distance - 4.5).abs() < 0.01 && hit.normal.x < -0.99, "{hit:?}");
    let all = SpatialQueryFilter::default();
    let hits = ask(&mut app, move |spatial| spatial.ray_hits(from, Dir3::X, 100.0, 9, true, &all));
    assert_eq!(hits.iter().map(|hit| hit.entity).collect::<Vec<_>>(), [ball, cube]);
    let layer = SpatialQueryFilter::from_mask(0b10);
    let hit = ask(&mut app, move |spatial| spatial.cast_ray(from, Dir3::X, 100.0, true, &layer));
    assert_eq!(hit.map(|hit| hit.entity), Some(cube));
    let all = SpatialQueryFilter::default();
    let none = ask(&mut app, move |spatial| spatial.cast_ray(from, Dir3::X, 4.0, true, &all));
    assert!(none.is_none(), "{none:?}");
    let above = SpatialQueryFilter::from_excluded_entities([ball]);
    let down = ask(&mut app, move |spatial| {
        let not_cube = |entity| entity != cube;
        spatial.cast_ray_predicate(Vec3::Y * 5.0, Dir3::NEG_Y, 100.0, true, &above, &not_cube)
    });
    assert_eq!(down.map(|hit| (hit.entity, hit.distance)), Some((floor, 5.0)));
}

#[test]
fn shapes_are_cast() {
    let (mut app, [_, _, cube]) = scene();
    let hit = ask(&mut app, move |spatial| {
        let (ball, config) = (Collider::sphere(0.25), ShapeCastConfig::default());
        let filter = SpatialQueryFilter::from_mask(0b10);
        let from = Vec3::new(-5.0, 0.5, 0.0);
        spatial.cast_shape(&ball, from, Quat::IDENTITY, Dir3::X, &config, &filter)
    });
    let hit = hit.expect("the box");
    assert_eq!(hit.entity, cube);
    assert!((hit.distance - 8.25).abs() < 1e-4, "{hit:?}");
    assert!((hit.point1 - Vec3::new(3.5, 0.5, 0.0)).length() < 1e-4, "{hit:?}");
    assert_eq!((hit.normal1, hit.normal2), (Vec3::NEG_X, Vec3::X));
}

#[test]
fn points_and_overlaps() {
    let (mut app, [floor, ball, cube]) = scene();
    let nearest = ask(&mut app, |spatial| {
        spatial.project_point(Vec3::new(4.0, 3.0, 0.0), true, &SpatialQueryFilter::default())
    });
    let nearest = nearest.expect("the box");
    assert_eq!((nearest.entity, nearest.is_inside), (cube, false));
    assert!((nearest.point - Vec3::new(4.0, 1.0, 0.0)).length() < 1e-5);
    let inside = ask(&mut app, |spatial| {
        spatial.point_intersections(Vec3::new(4.0, 0.5, 0.0), &SpatialQueryFilter::default())
    });
    assert_eq!(inside, [cube]);
    let overlapped = ask(&mut app, |spatial| {
        let (shape, at) = (Collider::cuboid(1.0, 1.0, 1.0), Vec3::new(0.2, 0.4, 0.0));
        spatial.shape_intersections(&shape, at, Quat::IDENTITY, &SpatialQueryFilter::default())
    });
    let mut wanted = [floor, ball];
    wanted.sort();
    assert_eq!(overlapped, wanted);
}
