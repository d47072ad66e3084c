//! Scenes in 2D for either back end.

use avian_impinge::d2;
use avian2d::prelude::*;
use bevy_app::prelude::*;
use bevy_ecs::component::Mutable;
use bevy_ecs::prelude::*;
use bevy_math::{Quat, Vec2};
use bevy_time::{TimePlugin, TimeUpdateStrategy};
use bevy_transform::prelude::*;

/// The collision back end of a scene: its plugins and constructors of shapes.
pub(crate) trait Backend: 'static {
    type Collider: Component<Mutability = Mutable> + Clone;
    const NAME: &'static str;

    fn plugins(app: &mut App);
    fn circle(radius: f32) -> Self::Collider;
    fn rectangle(x: f32, y: f32) -> Self::Collider;
    fn capsule(radius: f32, length: f32) -> Self::Collider;
    /// Creates the half-space below the origin.
    fn half_space() -> Self::Collider;
    fn regular_polygon(radius: f32, sides: u32) -> Self::Collider;
    fn polyline(vertices: Vec<Vec2>) -> Self::Collider;
    fn trimesh(vertices: Vec<Vec2>, indices: Vec<[u32; 3]>) -> Self::Collider;
}

pub(crate) struct Impinge;

impl Backend for Impinge {
    type Collider = d2::Collider;
    const NAME: &'static str = "impinge";

    fn plugins(app: &mut App) {
        let avian = PhysicsPlugins::default().build();
        // Avian's schedule does not allow two back ends: see the documentation of the crate.
        #[cfg(feature = "parry")]
        let avian = avian
            .disable::<ColliderBackendPlugin<Collider>>()
            .disable::<ColliderTreePlugin<Collider>>()
            .disable::<NarrowPhasePlugin<Collider>>();
        app.add_plugins((avian, d2::ImpingeColliderPlugin::default()));
    }

    fn circle(radius: f32) -> d2::Collider {
        d2::Collider::circle(radius)
    }

    fn rectangle(x: f32, y: f32) -> d2::Collider {
        d2::Collider::rectangle(x, y)
    }

    fn capsule(radius: f32, length: f32) -> d2::Collider {
        d2::Collider::capsule(radius, length)
    }

    fn half_space() -> d2::Collider {
        d2::Collider::half_space(Vec2::Y)
    }

    fn regular_polygon(radius: f32, sides: u32) -> d2::Collider {
        d2::Collider::regular_polygon(radius, sides)
    }

    fn polyline(vertices: Vec<Vec2>) -> d2::Collider {
        d2::Collider::polyline(vertices, None)
    }

    fn trimesh(vertices: Vec<Vec2>, indices: Vec<[u32; 3]>) -> d2::Collider {
        d2::Collider::trimesh(vertices, indices)
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

    fn circle(radius: f32) -> Collider {
        Collider::circle(radius)
    }

    fn rectangle(x: f32, y: f32) -> Collider {
        Collider::rectangle(x, y)
    }

    fn capsule(radius: f32, length: f32) -> Collider {
        Collider::capsule(radius, length)
    }

    fn half_space() -> Collider {
        Collider::half_space(Vec2::Y)
    }

    fn regular_polygon(radius: f32, sides: u32) -> Collider {
        Collider::regular_polygon(radius, sides)
    }

    fn polyline(vertices: Vec<Vec2>) -> Collider {
        Collider::polyline(vertices, None)
    }

    fn trimesh(vertices: Vec<Vec2>, indices: Vec<[u32; 3]>) -> Collider {
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

pub(crate) fn place(app: &App, entity: Entity) -> Vec2 {
    app.world().get::<Position>(entity).expect("it is a body").0
}

pub(crate) fn velocity(app: &App, entity: Entity) -> Vec2 {
    app.world().get::<LinearVelocity>(entity).expect("it is a body").0
}

/// Adds a static body.
pub(crate) fn fixed<B: Backend>(app: &mut App, collider: B::Collider, at: Vec2) -> Entity {
    let body = (RigidBody::Static, collider, Transform::from_translation(at.extend(0.0)));
    app.world_mut().spawn(body).id()
}

/// Adds a dynamic body that does not sleep.
pub(crate) fn dynamic<B: Backend>(app: &mut App, collider: B::Collider, at: Vec2) -> Entity {
    let at = Transform::from_translation(at.extend(0.0));
    app.world_mut().spawn((RigidBody::Dynamic, collider, at, SleepingDisabled)).id()
}

pub(crate) fn floor<B: Backend>(app: &mut App) -> Entity {
    fixed::<B>(app, B::rectangle(100.0, 2.0), Vec2::new(0.0, -1.0))
}

/// Adds a stack of squares of side 1.
pub(crate) fn stack<B: Backend>(app: &mut App, at: Vec2, count: usize) -> Vec<Entity> {
    let square = B::rectangle(1.0, 1.0);
    let middle = |level: usize| at + Vec2::Y * (level as f32 + 0.5);
    (0..count).map(|level| dynamic::<B>(app, square.clone(), middle(level))).collect()
}

/// Adds bricks in the shape of a triangle.
pub(crate) fn pyramid<B: Backend>(app: &mut App, base: usize) -> Vec<(Entity, Vec2)> {
    let square = B::rectangle(1.0, 1.0);
    let middle = move |row: usize, index: usize| {
        let width = (base - row) as f32 * 1.05;
        Vec2::new(index as f32 * 1.05 - width / 2.0, row as f32 + 0.5)
    };
    let places = (0..base).flat_map(move |row| (0..base - row).map(move |i| middle(row, i)));
    places.map(|at| (dynamic::<B>(app, square.clone(), at), at)).collect()
}

/// Adds capsules that hang from a fixed point, each joined to the previous one.
pub(crate) fn chain<B: Backend>(app: &mut App, at: Vec2, count: usize) -> Vec<Entity> {
    let (link, length) = (B::capsule(0.1, 0.4), 0.6);
    let hook = fixed::<B>(app, B::circle(0.1), at);
    let (mut links, mut last, mut anchor) = (Vec::new(), hook, Vec2::ZERO);
    // The y axis of each link points along -x.
    let lying = Quat::from_rotation_z(core::f32::consts::FRAC_PI_2);
    for index in 0..count {
        let middle = at + Vec2::X * (length * (index as f32 + 0.5));
        let place = Transform::from_translation(middle.extend(0.0)).with_rotation(lying);
        let next = (RigidBody::Dynamic, link.clone(), place, SleepingDisabled);
        let next = app.world_mut().spawn(next).id();
        let joint = RevoluteJoint::new(last, next)
            .with_local_anchor1(anchor)
            .with_local_anchor2(Vec2::Y * (length / 2.0));
        app.world_mut().spawn((joint, JointCollisionDisabled));
        (last, anchor) = (next, Vec2::NEG_Y * (length / 2.0));
        links.push(next);
    }
    links
}

/// Returns a polyline of `cells` segments with heights as a function of x.
pub(crate) fn line<B: Backend>(cells: u32, side: f32, height: impl Fn(f32) -> f32) -> B::Collider {
    let at = |index: u32| index as f32 * side - side * cells as f32 / 2.0;
    B::polyline((0..=cells).map(|index| Vec2::new(at(index), height(at(index)))).collect())
}

/// Returns a strip of height 1 of `cells` rectangles, each of two triangles, with its upper side at
/// y = 0.
pub(crate) fn strip<B: Backend>(cells: u32, side: f32) -> B::Collider {
    let at = |index: u32| index as f32 * side - side * cells as f32 / 2.0;
    let corners = (0..=cells).flat_map(|i| [Vec2::new(at(i), -1.0), Vec2::new(at(i), 0.0)]);
    let cell = |i: u32| {
        let [a, b, c, d] = [2 * i, 2 * i + 2, 2 * i + 3, 2 * i + 1];
        [[a, b, c], [a, c, d]]
    };
    B::trimesh(corners.collect(), (0..cells).flat_map(cell).collect())
}

/// Adds solids of four kinds in columns above the floor.
pub(crate) fn pile<B: Backend>(
    app: &mut App,
    side: usize,
    layers: usize,
    above: f32,
) -> Vec<Entity> {
    let (rectangle, polygon) = (B::rectangle(0.9, 0.8), B::regular_polygon(0.5, 5));
    let kinds = [rectangle, B::circle(0.45), B::capsule(0.3, 0.4), polygon];
    let mut bodies = Vec::new();
    for layer in 0..layers {
        for i in 0..side {
            let shift = 0.13 * ((7 * i + 3 * layer) % 5) as f32;
            let x = 1.3 * (i as f32 - side as f32 / 2.0) + shift;
            let at = Vec2::new(x, above + 1.3 * layer as f32);
            let kind = (i + 3 * layer) % kinds.len();
            bodies.push(dynamic::<B>(app, kinds[kind].clone(), at));
        }
    }
    bodies
}
