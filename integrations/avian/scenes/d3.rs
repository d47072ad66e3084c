//! Scenes in 3D for either back end.

use avian_impinge::d3;
use avian3d::prelude::*;
use bevy_app::prelude::*;
use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec3};
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

/// The collision back end of a scene: its plugins and constructors of shapes.
pub(crate) trait Backend: 'static {
    type Collider: Component<Mutability = Mutable> + Clone;
    const NAME: &'static str;

    fn plugins(app: &mut App);
    fn sphere(radius: f32) -> Self::Collider;
    fn cuboid(x: f32, y: f32, z: f32) -> Self::Collider;
    fn capsule(radius: f32, length: f32) -> Self::Collider;
    /// Creates the half-space below the origin.
    fn half_space() -> Self::Collider;
    fn cylinder(radius: f32, height: f32) -> Self::Collider;
    fn convex_hull(points: Vec<Vec3>) -> Option<Self::Collider>;
    fn trimesh(vertices: Vec<Vec3>, indices: Vec<[u32; 3]>) -> Self::Collider;
}

pub(crate) struct Impinge;

impl Backend for Impinge {
    type Collider = d3::Collider;
    const NAME: &'static str = "impinge";

    fn plugins(app: &mut App) {
        let avian = PhysicsPlugins::default().build();
        // Avian's schedule does not allow two back ends: see the documentation of the crate.
        #[cfg(feature = "parry")]
        let avian = avian
            .disable::<ColliderBackendPlugin<Collider>>()
            .disable::<ColliderTreePlugin<Collider>>()
            .disable::<NarrowPhasePlugin<Collider>>();
        app.add_plugins((avian, d3::ImpingeColliderPlugin::default()));
    }

    fn sphere(radius: f32) -> d3::Collider {
        d3::Collider::sphere(radius)
    }

    fn cuboid(x: f32, y: f32, z: f32) -> d3::Collider {
        d3::Collider::cuboid(x, y, z)
    }

    fn capsule(radius: f32, length: f32) -> d3::Collider {
        d3::Collider::capsule(radius, length)
    }

    fn half_space() -> d3::Collider {
        d3::Collider::half_space(Vec3::Y)
    }

    fn cylinder(radius: f32, height: f32) -> d3::Collider {
        d3::Collider::cylinder(radius, height)
    }

    fn convex_hull(points: Vec<Vec3>) -> Option<d3::Collider> {
        d3::Collider::convex_hull(points)
    }

    fn trimesh(vertices: Vec<Vec3>, indices: Vec<[u32; 3]>) -> d3::Collider {
        d3::Collider::trimesh(vertices, indices)
    }
}

/// Avian's own back end, parry.
#[cfg(feature = "parry")]
pub(crate) struct Parry;

#[cfg(feature = "parry")]
impl Backend for Parry {
    type Collider = Collider;
    const NAME: &'static str = "parry";

    fn plugins(app: &mut App) {
        app.add_plugins(PhysicsPlugins::default());
    }

    fn sphere(radius: f32) -> Collider {
        Collider::sphere(radius)
    }

    fn cuboid(x: f32, y: f32, z: f32) -> Collider {
        Collider::cuboid(x, y, z)
    }

    fn capsule(radius: f32, length: f32) -> Collider {
        Collider::capsule(radius, length)
    }

    fn half_space() -> Collider {
        Collider::half_space(Vec3::Y)
    }

    fn cylinder(radius: f32, height: f32) -> Collider {
        Collider::cylinder(radius, height)
    }

    fn convex_hull(points: Vec<Vec3>) -> Option<Collider> {
        Collider::convex_hull(points)
    }

    fn trimesh(vertices: Vec<Vec3>, indices: Vec<[u32; 3]>) -> Collider {
        Collider::trimesh_with_config(vertices, indices, TrimeshFlags::FIX_INTERNAL_EDGES)
    }
}

/// Creates an app without a window that makes one step of 1/64 s per update.
pub(crate) fn app<B: Backend>() -> App {
    let mut app = App::new();
    app.add_plugins((TaskPoolPlugin::default(), TransformPlugin, TimePlugin));
    app.insert_resource(TimeUpdateStrategy::FixedTimesteps(1));
    B::plugins(&mut app);
    app.finish();
    app.cleanup();
    app
}

pub(crate) fn steps(app: &mut App, count: usize) {
    (0..count).for_each(|_| app.update());
}

pub(crate) fn place(app: &App, entity: Entity) -> Vec3 {
    app.world().get::<Position>(entity).expect("it is a body").0
}

pub(crate) fn velocity(app: &App, entity: Entity) -> Vec3 {
    app.world().get::<LinearVelocity>(entity).expect("it is a body").0
}

/// Adds a static body.
pub(crate) fn fixed<B: Backend>(app: &mut App, collider: B::Collider, at: Vec3) -> Entity {
    let body = (RigidBody::Static, collider, Transform::from_translation(at));
    app.world_mut().spawn(body).id()
}

/// Adds a dynamic body that does not sleep.
pub(crate) fn dynamic<B: Backend>(app: &mut App, collider: B::Collider, at: Vec3) -> Entity {
    let body = (RigidBody::Dynamic, collider, Transform::from_translation(at), SleepingDisabled);
    app.world_mut().spawn(body).id()
}

pub(crate) fn floor<B: Backend>(app: &mut App) -> Entity {
    fixed::<B>(app, B::cuboid(100.0, 2.0, 100.0), Vec3::new(0.0, -1.0, 0.0))
}

/// Adds a stack of cubes of side 1.
pub(crate) fn stack<B: Backend>(app: &mut App, at: Vec3, count: usize) -> Vec<Entity> {
    let cube = B::cuboid(1.0, 1.0, 1.0);
    let middle = |level: usize| at + Vec3::Y * (level as f32 + 0.5);
    (0..count).map(|level| dynamic::<B>(app, cube.clone(), middle(level))).collect()
}

/// Adds a wall of bricks in the shape of a triangle.
pub(crate) fn pyramid<B: Backend>(app: &mut App, base: usize) -> Vec<(Entity, Vec3)> {
    let cube = B::cuboid(1.0, 1.0, 1.0);
    let middle = move |row: usize, index: usize| {
        let width = (base - row) as f32 * 1.05;
        Vec3::new(index as f32 * 1.05 - width / 2.0, row as f32 + 0.5, 0.0)
    };
    let places = (0..base).flat_map(move |row| (0..base - row).map(move |i| middle(row, i)));
    places.map(|at| (dynamic::<B>(app, cube.clone(), at), at)).collect()
}

/// Adds capsules that hang from a fixed point, each joined to the previous one.
pub(crate) fn chain<B: Backend>(app: &mut App, at: Vec3, count: usize) -> Vec<Entity> {
    let (link, length) = (B::capsule(0.1, 0.4), 0.6);
    let hook = fixed::<B>(app, B::sphere(0.1), at);
    let (mut links, mut last, mut anchor) = (Vec::new(), hook, Vec3::ZERO);
    let lying = Quat::from_rotation_z(core::f32::consts::FRAC_PI_2);
    for index in 0..count {
        let middle = at + Vec3::X * (length * (index as f32 + 0.5));
        let place = Transform::from_translation(middle).with_rotation(lying);
        let next = (RigidBody::Dynamic, link.clone(), place, SleepingDisabled);
        let next = app.world_mut().spawn(next).id();
        // The y axis of each link points along -x.
        let joint = SphericalJoint::new(last, next)
            .with_local_anchor1(anchor)
            .with_local_anchor2(Vec3::Y * (length / 2.0));
        app.world_mut().spawn((joint, JointCollisionDisabled));
        (last, anchor) = (next, Vec3::NEG_Y * (length / 2.0));
        links.push(next);
    }
    links
}

/// The vertices and triangles of a surface.
pub(crate) type Surface = (Vec<Vec3>, Vec<[u32; 3]>);

/// Returns a grid of `cells` by `cells` squares, each of two triangles, with heights as a function
/// of x and z.
pub(crate) fn grid(cells: u32, side: f32, height: impl Fn(f32, f32) -> f32) -> Surface {
    let half = side * cells as f32 / 2.0;
    let at = |index: u32| index as f32 * side - half;
    let vertex = |i: u32, j: u32| Vec3::new(at(i), height(at(i), at(j)), at(j));
    let vertices = (0..=cells).flat_map(|i| (0..=cells).map(move |j| (i, j)));
    let vertices = vertices.map(|(i, j)| vertex(i, j)).collect();
    let index = |i: u32, j: u32| i * (cells + 1) + j;
    let cell = |i: u32, j: u32| {
        let corners = [(i, j), (i, j + 1), (i + 1, j + 1), (i + 1, j)];
        let [a, b, c, d] = corners.map(|(i, j)| index(i, j));
        [[a, b, c], [a, c, d]]
    };
    let squares = (0..cells).flat_map(|i| (0..cells).map(move |j| (i, j)));
    (vertices, squares.flat_map(|(i, j)| cell(i, j)).collect())
}

/// Returns a mesh with the vertices and triangles of [`grid`].
pub(crate) fn sheet<B: Backend>(
    cells: u32,
    side: f32,
    height: impl Fn(f32, f32) -> f32,
) -> B::Collider {
    let (vertices, triangles) = grid(cells, side, height);
    B::trimesh(vertices, triangles)
}

/// Adds solids of five kinds in columns above the floor.
pub(crate) fn pile<B: Backend>(
    app: &mut App,
    side: usize,
    layers: usize,
    above: f32,
) -> Vec<Entity> {
    let corners = |k: usize| Vec3::new((k & 1) as f32, (k >> 1 & 1) as f32, (k >> 2) as f32);
    let cut: Vec<_> = (0..7).map(|k| (corners(k) - 0.5) * Vec3::new(1.1, 0.9, 1.0)).collect();
    let hull = B::convex_hull(cut).expect("points in space");
    let cylinder = B::cylinder(0.4, 0.9);
    let kinds = [B::cuboid(0.9, 0.8, 1.0), B::sphere(0.5), B::capsule(0.3, 0.6), hull, cylinder];
    let mut bodies = Vec::new();
    for layer in 0..layers {
        for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
            let shift = 0.13 * ((7 * i + 5 * j + 3 * layer) % 5) as f32;
            let [x, z] = [i, j].map(|k| 1.3 * (k as f32 - side as f32 / 2.0) + shift);
            let at = Vec3::new(x, above + 1.3 * layer as f32, z);
            let kind = (i + 2 * j + 3 * layer) % kinds.len();
            bodies.push(dynamic::<B>(app, kinds[kind].clone(), at));
        }
    }
    bodies
}
