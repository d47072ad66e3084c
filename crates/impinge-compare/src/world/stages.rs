//! The scenes of the suite, and their sizes.

use impinge_scenes::{
    Motion, Scene, SceneQuery, SolidKind, aligned_pile, asteroids, few_asteroids_moving,
    few_moving, mixed_shapes, pile, plates, rain, sensors, shaken, solids, solids_on_plain,
    sparse_drift, spawn_and_despawn, ten_moving, terrain_field, terrain_mesh, tower,
    trembling_vehicles_field, trembling_vehicles_mesh, turned_pile, vehicles_field, vehicles_mesh,
};

/// The distance up to which two objects have contact points. It is the sum of the predictions of
/// both objects.
pub const PREDICTION: f32 = 0.002;

/// The limit of the random displacement of each object along each axis, for each step of a shaken
/// scene.
const SHAKE: f64 = 0.001;

/// A scene of the suite.
pub struct Stage<const D: usize> {
    /// The name in the table.
    pub name: &'static str,
    /// Creates the scene with a number of objects.
    make: fn(usize) -> Scene<D>,
    /// Returns the number of objects as a function of the requested number.
    count: fn(usize) -> usize,
    /// Whether proximity queries of the scene are kept; in other scenes all objects get contacts.
    has_sensors: bool,
}

impl<const D: usize> Stage<D> {
    /// Creates a stage with the requested number of objects, all with contacts.
    pub const fn new(name: &'static str, make: fn(usize) -> Scene<D>) -> Self {
        Self { name, make, count: |objects| objects, has_sensors: false }
    }

    /// Creates a stage with ten times the requested number of objects.
    const fn many(name: &'static str, make: fn(usize) -> Scene<D>) -> Self {
        Self { count: |objects| 10 * objects, ..Self::new(name, make) }
    }

    /// Creates a stage with a twentieth of the requested number of objects, at least one.
    const fn large(name: &'static str, make: fn(usize) -> Scene<D>) -> Self {
        Self { count: |objects| objects.div_ceil(20), ..Self::new(name, make) }
    }

    /// Creates a stage with a hundredth of the requested number of objects, at least one.
    const fn huge(name: &'static str, make: fn(usize) -> Scene<D>) -> Self {
        Self { count: |objects| objects.div_ceil(100), ..Self::new(name, make) }
    }

    /// Returns the number of objects for a requested number.
    pub fn count(&self, objects: usize) -> usize {
        (self.count)(objects)
    }

    /// Creates the scene for a requested number of objects. `angular` is the sum over a pair of the
    /// angular predictions, in radians.
    pub fn scene(&self, objects: usize, angular: f64) -> Scene<D> {
        let scene = (self.make)(self.count(objects));
        if self.has_sensors {
            predicting(scene, angular)
        } else {
            asking_for_contacts(scene, angular)
        }
    }
}

/// Returns the scenes that exist in both dimensions. All scenes have the same prediction, since
/// rapier has a single prediction for all objects.
pub fn stages<const D: usize>() -> Vec<Stage<D>> {
    let mut stages = vec![
        Stage::new("pile", pile),
        Stage::many("sparse drift", sparse_drift),
        Stage::new("1 % moving", few_moving),
        Stage::many("ten moving", ten_moving),
        Stage::new("mixed shapes", mixed_shapes),
        Stage::new("terrain mesh", terrain_mesh),
        Stage::new("terrain field", terrain_field),
        Stage::new("trembling pile", |count| trembling(pile(count))),
        Stage::new("trembling terrain", |count| trembling(terrain_mesh(count))),
        Stage::large("vehicles on mesh", vehicles_mesh),
        Stage::large("vehicles on field", vehicles_field),
        Stage::large("trembling vehicles on mesh", trembling_vehicles_mesh),
        Stage::large("trembling vehicles on field", trembling_vehicles_field),
        Stage::new("rain", rain),
        Stage::new("asteroids", asteroids),
        Stage::new("asteroids, 1 % moving", few_asteroids_moving),
        Stage { has_sensors: true, ..Stage::new("sensors", sensors) },
        Stage::new("churn", spawn_and_despawn),
        Stage::new("towers at rest", tower),
    ];
    stages.extend(shaken_stages());
    stages.extend(alone());
    stages.extend(on_plain());
    stages
}

/// Returns piles with other orientations of boxes, and shaken scenes: every step displaces every
/// object at random.
fn shaken_stages<const D: usize>() -> [Stage<D>; 8] {
    [
        Stage::new("aligned pile", aligned_pile),
        Stage::new("turned pile", turned_pile),
        Stage::new("shaken pile", |count| shaken(pile(count), SHAKE)),
        Stage::new("shaken terrain mesh", |count| shaken(terrain_mesh(count), SHAKE)),
        Stage::new("shaken terrain field", |count| shaken(terrain_field(count), SHAKE)),
        Stage::large("shaken vehicles on mesh", |count| shaken(vehicles_mesh(count), SHAKE)),
        Stage::large("shaken vehicles on field", |count| shaken(vehicles_field(count), SHAKE)),
        Stage::new("shaken towers", |count| shaken(tower(count), SHAKE)),
    ]
}

/// Returns solids in free space, of several kinds and of each kind alone.
fn alone<const D: usize>() -> [Stage<D>; 6] {
    use SolidKind::{Ball, Capsule, Cuboid, Hull};
    [
        Stage::new("dense solids", |count| solids(count, SolidKind::all::<D>(), 1.0)),
        Stage::new("loose solids", |count| solids(count, SolidKind::all::<D>(), 2.0)),
        Stage::new("balls alone", |count| solids(count, &[Ball], 1.3)),
        Stage::new("cuboids alone", |count| solids(count, &[Cuboid], 1.3)),
        Stage::new("capsules alone", |count| solids(count, &[Capsule], 1.3)),
        Stage::new("hulls of 12 alone", |count| solids(count, &[Hull], 1.3)),
    ]
}

/// Returns solids on a rough plain: plates with half extents from 0.5 to 8, some of them shaken,
/// and single kinds of solids.
fn on_plain<const D: usize>() -> [Stage<D>; 14] {
    use SolidKind::{Ball, Capsule, Cuboid, Hull};
    [
        Stage::huge("plates of 0.5", |count| plates(count, 0.5)),
        Stage::huge("plates of 1", |count| plates(count, 1.0)),
        Stage::huge("plates of 2", |count| plates(count, 2.0)),
        Stage::huge("plates of 4", |count| plates(count, 4.0)),
        Stage::huge("plates of 8", |count| plates(count, 8.0)),
        Stage::huge("shaken plates of 0.5", |count| shaken(plates(count, 0.5), SHAKE)),
        Stage::huge("shaken plates of 1", |count| shaken(plates(count, 1.0), SHAKE)),
        Stage::huge("shaken plates of 2", |count| shaken(plates(count, 2.0), SHAKE)),
        Stage::huge("shaken plates of 4", |count| shaken(plates(count, 4.0), SHAKE)),
        Stage::huge("shaken plates of 8", |count| shaken(plates(count, 8.0), SHAKE)),
        Stage::large("balls on field", |count| solids_on_plain(count, Ball)),
        Stage::large("cuboids on field", |count| solids_on_plain(count, Cuboid)),
        Stage::large("capsules on field", |count| solids_on_plain(count, Capsule)),
        Stage::large("hulls on field", |count| solids_on_plain(count, Hull)),
    ]
}

/// Returns the scenes that exist in 2D only.
pub fn plane_stages() -> [Stage<2>; 1] {
    [Stage::new("crowd", impinge_scenes::crowd)]
}

/// Returns the scenes that exist in 3D only.
pub fn space_stages() -> [Stage<3>; 1] {
    [Stage::new("cylinders alone", |count| solids(count, &[SolidKind::Cylinder], 1.3))]
}

/// Returns the scene slowed down by a factor of 100, to about the speed of objects that come to
/// rest.
fn trembling<const D: usize>(mut scene: Scene<D>) -> Scene<D> {
    for Motion { place, tangent, .. } in scene.objects.iter_mut().map(|object| &mut object.motion) {
        place.iter_mut().chain([tangent]).for_each(|wave| wave.speed /= 100.0);
    }
    scene
}

/// Returns the scene in which all objects have contacts, with the prediction of the suite and this
/// angular prediction.
pub fn asking_for_contacts<const D: usize>(mut scene: Scene<D>, angular: f64) -> Scene<D> {
    for object in &mut scene.objects {
        object.query = SceneQuery::Contacts { linear: 0.0, angular: 0.0 };
    }
    predicting(scene, angular)
}

/// Sets the predictions of objects with contacts, so that the sums over a pair are [`PREDICTION`]
/// and `angular` radians.
fn predicting<const D: usize>(mut scene: Scene<D>, angular: f64) -> Scene<D> {
    let linear = f64::from(PREDICTION) / 2.0;
    for object in &mut scene.objects {
        if matches!(object.query, SceneQuery::Contacts { .. }) {
            object.query = SceneQuery::Contacts { linear, angular: angular / 2.0 };
        }
    }
    scene
}
