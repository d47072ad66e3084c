//! Jolt, used without its solver.

use std::ffi::c_void;
use std::marker::PhantomData;
use std::ptr;
use std::sync::OnceLock;

use impinge_scenes::{Placement, Scene, SceneShape};
use oxijolt_sys::*;

use crate::{Digest, sorted};

/// The duration of a step in seconds. With 0 Jolt detects no collisions. The value does not move
/// bodies, because none has a velocity.
const STEP: f32 = 1.0 / 60.0;
/// The number of object layers, and of broad-phase layers: one layer contains all bodies.
const LAYERS: u32 = 1;

/// A world of Jolt.
///
/// Its bodies are kinematic, have no velocity and never sleep. By an option of each body, kinematic
/// bodies collide with each other and with static ones. Terrain is static. A step sets the poses of
/// moved objects and makes a step of the engine with the job system that runs on the calling
/// thread. Pairs without a dynamic body are passed to the contact listener but not to the solver.
/// The dynamics that remain are a pass over the bodies, which moves none of them, and a pass that
/// updates their boxes.
///
/// Contacts can only be read in the listener. So the listener stores each point, its depth, and the
/// pair.
#[derive(Debug)]
pub struct Jolt {
    system: *mut JPH_PhysicsSystem,
    interface: *mut JPH_BodyInterface,
    listener: *mut JPH_ContactListener,
    jobs: *mut JPH_JobSystem,
    memory: *mut JPH_TempAllocator,
    bodies: Vec<JPH_BodyID>,
    moved: Vec<(JPH_BodyID, JPH_Vec3, JPH_Quat)>,
    /// The buffer of the listener. The listener writes through the same pointer, so there is no
    /// reference to the buffer while the engine runs.
    heard: *mut Heard,
    /// Makes the type not `Send`: a world stays on its thread.
    thread: PhantomData<*const ()>,
}

/// The contacts of a step, stored by the listener.
#[derive(Debug, Default)]
struct Heard {
    /// For each manifold, the pair of indices and the end of its points in `points`.
    pairs: Vec<([u64; 2], usize)>,
    /// The position of a point on the first body, and its depth.
    points: Vec<(JPH_Vec3, f32)>,
}

/// Initializes the engine, once per process.
fn engine() {
    static ENGINE: OnceLock<()> = OnceLock::new();
    static PROCS: JPH_ContactListener_Procs = JPH_ContactListener_Procs {
        OnContactValidate: None,
        OnContactAdded: Some(hear),
        OnContactPersisted: Some(hear),
        OnContactRemoved: None,
    };
    ENGINE.get_or_init(|| {
        // SAFETY: this is the first call, made once. The procedures have a static lifetime.
        unsafe {
            assert!(JPH_Init(), "Jolt could not be started");
            JPH_ContactListener_SetProcs(&raw const PROCS);
        }
    });
}

/// The callback of the contact listener: stores the points of a manifold.
///
/// # Safety
/// The engine calls it only while `Jolt::step` runs, and `heard` is the pointer that `Jolt::new`
/// passed to it.
unsafe extern "C" fn hear(
    heard: *mut c_void,
    body1: *const JPH_Body,
    body2: *const JPH_Body,
    manifold: *const JPH_ContactManifold,
    _settings: *mut JPH_ContactSettings,
) {
    // SAFETY: the pointer is that of the buffer of the world, to which no other reference exists
    // now. The arguments of the engine are valid until this function returns.
    unsafe {
        let heard = &mut *heard.cast::<Heard>();
        let mut normal = JPH_Vec3 { x: 0.0, y: 0.0, z: 0.0 };
        JPH_ContactManifold_GetWorldSpaceNormal(manifold, &raw mut normal);
        for n in 0..JPH_ContactManifold_GetPointCount(manifold) {
            let (mut a, mut b) = (normal, normal);
            JPH_ContactManifold_GetWorldSpaceContactPointOn1(manifold, n, &raw mut a);
            JPH_ContactManifold_GetWorldSpaceContactPointOn2(manifold, n, &raw mut b);
            let depth = normal.x * (a.x - b.x) + normal.y * (a.y - b.y) + normal.z * (a.z - b.z);
            heard.points.push((a, depth));
        }
        let indices = [body1, body2].map(|body| JPH_Body_GetUserData(body.cast_mut()));
        heard.pairs.push((indices, heard.points.len()));
    }
}

impl Jolt {
    /// The default convex radius of Jolt.
    pub const CONVEX_RADIUS: f32 = 0.05;

    /// Creates a world with the objects of a scene at step 0. Contacts are computed up to the
    /// distance `prediction`. Returns `None` if the scene has a shape that this adapter does not
    /// support: it supports balls, boxes, capsules, convex hulls, meshes and height fields.
    ///
    /// Edges of boxes and hulls are rounded by `convex_radius`, by default [`Self::CONVEX_RADIUS`].
    /// Within this radius Jolt needs only the closest points of the inner shapes. With 0 boxes and
    /// hulls have the exact shape of the scene.
    #[must_use]
    pub fn new(scene: &Scene<3>, prediction: f32, convex_radius: f32) -> Option<Self> {
        if !scene.objects.iter().all(|object| has(&object.shape)) {
            return None;
        }
        engine();
        let heard = Box::into_raw(Box::<Heard>::default());
        // SAFETY: the engine is initialized; the world owns the objects created here until it is
        // dropped.
        let mut made = unsafe {
            let system = system(scene.objects.len(), prediction);
            let listener = JPH_ContactListener_Create(heard.cast());
            JPH_PhysicsSystem_SetContactListener(system, listener);
            Self {
                system,
                interface: JPH_PhysicsSystem_GetBodyInterfaceNoLock(system),
                listener,
                jobs: JPH_JobSystemSingleThreaded_Create(0),
                memory: JPH_TempAllocator_Create(1 << 28),
                bodies: Vec::new(),
                moved: Vec::new(),
                heard,
                thread: PhantomData,
            }
        };
        (0..scene.objects.len()).for_each(|n| made.add(scene, n, convex_radius));
        // SAFETY: the world exists. Jolt recommends this call once after many bodies were added.
        unsafe { JPH_PhysicsSystem_OptimizeBroadPhase(made.system) };
        Some(made)
    }

    fn add(&mut self, scene: &Scene<3>, index: usize, convex_radius: f32) {
        let shape = &scene.objects[index].shape;
        let (position, rotation) = pose(&scene.placement(index, 0));
        let (motion, activation) = if is_ground(shape) {
            (JPH_MotionType_Static, JPH_Activation_DontActivate)
        } else {
            (JPH_MotionType_Kinematic, JPH_Activation_Activate)
        };
        // SAFETY: the world exists. The body shares ownership of its shape, so this reference to it
        // can be released.
        let body = unsafe {
            let shape = shape_of(shape, convex_radius);
            assert!(!shape.is_null(), "object {index} has no shape");
            let settings = JPH_BodyCreationSettings_Create3(
                shape,
                &raw const position,
                &raw const rotation,
                motion,
                0,
            );
            JPH_BodyCreationSettings_SetUserData(settings, index as u64);
            JPH_BodyCreationSettings_SetAllowSleeping(settings, false);
            JPH_BodyCreationSettings_SetCollideKinematicVsNonDynamic(settings, true);
            let body = JPH_BodyInterface_CreateAndAddBody(self.interface, settings, activation);
            JPH_BodyCreationSettings_Destroy(settings);
            JPH_Shape_Destroy(shape);
            body
        };
        self.bodies.push(body);
    }

    /// Converts the new placements of the moved objects, and stores them for the next step.
    pub fn prepare(&mut self, moved: &[(usize, Placement<3>)]) {
        self.moved.clear();
        self.moved.extend(moved.iter().map(|(index, placement)| {
            let (position, rotation) = pose(placement);
            (self.bodies[*index], position, rotation)
        }));
    }

    /// Sets the new poses and updates; the listener stores the contacts.
    pub fn step(&mut self) {
        // SAFETY: the world and its bodies exist. The reference to the buffer ends before the
        // engine runs and the listener writes to it.
        let error = unsafe {
            let heard = &mut *self.heard;
            heard.pairs.clear();
            heard.points.clear();
            for (body, position, rotation) in &self.moved {
                JPH_BodyInterface_SetPositionAndRotation(
                    self.interface,
                    *body,
                    position,
                    rotation,
                    JPH_Activation_Activate,
                );
            }
            JPH_PhysicsSystem_Update2(self.system, STEP, 1, self.memory, self.jobs)
        };
        assert_eq!(error, JPH_PhysicsUpdateError_None, "a buffer was too small");
    }

    fn heard(&self) -> &Heard {
        // SAFETY: the listener runs only in `step`, which borrows the world mutably.
        unsafe { &*self.heard }
    }

    /// Reads every contact point that the listener has stored.
    #[must_use]
    pub fn read(&self) -> Digest {
        let points = &self.heard().points;
        let depth = points.iter().map(|(_, depth)| f64::from(*depth)).sum();
        Digest { points: points.len(), depth }
    }

    /// Returns the pairs with a contact point within `distance`, sorted, the smaller index first.
    #[must_use]
    pub fn touching(&self, distance: f32) -> Vec<(usize, usize)> {
        let Heard { pairs, points } = self.heard();
        let mut start = 0;
        let near = pairs.iter().filter_map(|(pair, end)| {
            let of_pair = &points[start..*end];
            start = *end;
            let is_near = of_pair.iter().any(|(_, depth)| -depth <= distance);
            is_near.then_some((pair[0] as usize, pair[1] as usize))
        });
        sorted(near.collect())
    }
}

impl Drop for Jolt {
    fn drop(&mut self) {
        // SAFETY: the world owns all of these objects, and does not use them afterwards.
        unsafe {
            JPH_PhysicsSystem_Destroy(self.system);
            JPH_ContactListener_Destroy(self.listener);
            JPH_TempAllocator_Destroy(self.memory);
            JPH_JobSystem_Destroy(self.jobs);
            drop(Box::from_raw(self.heard));
        }
    }
}

/// Creates a physics system with one layer and no gravity.
///
/// # Safety
/// The engine is initialized.
unsafe fn system(objects: usize, prediction: f32) -> *mut JPH_PhysicsSystem {
    let objects = u32::try_from(objects).expect("fewer than 32 bits number");
    // SAFETY: the system takes ownership of the tables, which have one layer that collides with
    // itself.
    unsafe {
        let layers = JPH_BroadPhaseLayerInterfaceTable_Create(LAYERS, LAYERS);
        JPH_BroadPhaseLayerInterfaceTable_MapObjectToBroadPhaseLayer(layers, 0, 0);
        let pairs = JPH_ObjectLayerPairFilterTable_Create(LAYERS);
        JPH_ObjectLayerPairFilterTable_EnableCollision(pairs, 0, 0);
        let filter = JPH_ObjectVsBroadPhaseLayerFilterTable_Create(layers, LAYERS, pairs, LAYERS);
        let settings = JPH_PhysicsSystemSettings {
            maxBodies: objects + 16,
            numBodyMutexes: 0,
            maxBodyPairs: 32 * objects + 1024,
            maxContactConstraints: 32 * objects + 1024,
            _padding: 0,
            broadPhaseLayerInterface: layers,
            objectLayerPairFilter: pairs,
            objectVsBroadPhaseLayerFilter: filter,
        };
        let system = JPH_PhysicsSystem_Create(&raw const settings);
        JPH_PhysicsSystem_SetGravity(system, &raw const NO_GRAVITY);
        let mut physics = std::mem::MaybeUninit::<JPH_PhysicsSettings>::zeroed();
        JPH_PhysicsSystem_GetPhysicsSettings(system, physics.as_mut_ptr());
        let mut physics = physics.assume_init();
        physics.speculativeContactDistance = prediction;
        JPH_PhysicsSystem_SetPhysicsSettings(system, &raw mut physics);
        system
    }
}

static NO_GRAVITY: JPH_Vec3 = JPH_Vec3 { x: 0.0, y: 0.0, z: 0.0 };

/// Returns `true` if this adapter supports the shape. Half-spaces of Jolt are bounded and its
/// segments have a radius, so neither is supported. Cylinders and cones are not supported either.
const fn has(shape: &SceneShape<3>) -> bool {
    use SceneShape::{Ball, Capsule, Convex, Cuboid};
    matches!(shape, Ball { .. } | Cuboid { .. } | Capsule { .. } | Convex { .. })
        || is_ground(shape)
}

const fn is_ground(shape: &SceneShape<3>) -> bool {
    matches!(shape, SceneShape::TriMesh { .. } | SceneShape::HeightField { .. })
}

fn vector(v: &[f64; 3]) -> JPH_Vec3 {
    let [x, y, z] = v.map(|x| x as f32);
    JPH_Vec3 { x, y, z }
}

fn pose(placement: &Placement<3>) -> (JPH_Vec3, JPH_Quat) {
    let [x, y, z, w] = placement.quaternion().map(|x| x as f32);
    (vector(&placement.translation), JPH_Quat { x, y, z, w })
}

/// Creates a shape of the engine.
///
/// # Safety
/// The engine is initialized.
unsafe fn shape_of(shape: &SceneShape<3>, convex_radius: f32) -> *mut JPH_Shape {
    // SAFETY: the engine copies the data that the arguments point to.
    unsafe {
        match shape {
            SceneShape::Ball { radius } => JPH_SphereShape_Create(*radius as f32).cast(),
            SceneShape::Cuboid { half_extents } => {
                let half_extents = vector(half_extents);
                JPH_BoxShape_Create(&raw const half_extents, convex_radius).cast()
            }
            SceneShape::Capsule { half_height, radius } => {
                JPH_CapsuleShape_Create(*half_height as f32, *radius as f32).cast()
            }
            SceneShape::Convex { points } => {
                let points: Vec<_> = points.iter().map(vector).collect();
                let count = points.len() as u32;
                let hull =
                    JPH_ConvexHullShapeSettings_Create(points.as_ptr(), count, convex_radius);
                let shape = JPH_ConvexHullShapeSettings_CreateShape(hull).cast();
                JPH_ShapeSettings_Destroy(hull.cast());
                shape
            }
            SceneShape::TriMesh { vertices, triangles } => mesh(vertices, triangles),
            SceneShape::HeightField { counts, heights, extents } => {
                field(*counts, heights, extents)
            }
            other => unreachable!("worlds with {other:?} are not made"),
        }
    }
}

/// # Safety
/// The engine is initialized, and all indices of the triangles are less than the number of
/// vertices.
unsafe fn mesh(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> *mut JPH_Shape {
    let vertices: Vec<_> = vertices.iter().map(vector).collect();
    let triangle = |&[i1, i2, i3]: &[u32; 3]| JPH_IndexedTriangle {
        i1,
        i2,
        i3,
        materialIndex: 0,
        userData: 0,
    };
    let triangles: Vec<_> = triangles.iter().map(triangle).collect();
    let counts = [vertices.len(), triangles.len()].map(|count| count as u32);
    // SAFETY: the counts are those of the lists, which the engine copies.
    unsafe {
        let settings = JPH_MeshShapeSettings_Create2(
            vertices.as_ptr(),
            counts[0],
            triangles.as_ptr(),
            counts[1],
        );
        let shape = JPH_MeshShapeSettings_CreateShape(settings).cast();
        JPH_ShapeSettings_Destroy(settings.cast());
        shape
    }
}

/// # Safety
/// The engine is initialized, and `heights` has as many elements as the product of the counts.
unsafe fn field(
    [rows, columns]: [usize; 2],
    heights: &[f64],
    extents: &[f64; 3],
) -> *mut JPH_Shape {
    assert_eq!(rows, columns, "Jolt's fields are square");
    let heights: Vec<_> = heights.iter().map(|height| *height as f32).collect();
    let width = |extent: f64| extent / (columns - 1) as f64;
    let offset = vector(&[-0.5 * extents[0], 0.0, -0.5 * extents[2]]);
    let scale = vector(&[width(extents[0]), extents[1], width(extents[2])]);
    // SAFETY: the count is that of the heights in a row; the field is square. The engine copies the
    // heights.
    unsafe {
        let settings = JPH_HeightFieldShapeSettings_Create(
            heights.as_ptr(),
            &raw const offset,
            &raw const scale,
            columns as u32,
            ptr::null(),
        );
        let shape = JPH_HeightFieldShapeSettings_CreateShape(settings).cast();
        JPH_ShapeSettings_Destroy(settings.cast());
        shape
    }
}
