//! Box2D, used without dynamics.

use std::marker::PhantomData;
use std::sync::{Mutex, MutexGuard, PoisonError};

use boxdd_sys::ffi;
use impinge_scenes::{Placement, Scene, SceneShape};

use crate::contacts::{ContactName, Contacts};
use crate::{Digest, Recycling, sorted};

/// The lock of Box2D's table of worlds, which the whole process shares.
static TABLE: Mutex<()> = Mutex::new(());

fn table() -> MutexGuard<'static, ()> {
    TABLE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A world of Box2D.
///
/// The bodies are dynamic and never sleep, since two bodies that are not dynamic never touch.
/// Terrain is a static chain. A step first sets the transforms of moved objects. Then it makes a
/// step of time 0, which finds pairs and updates contacts, but solves and integrates nothing. The
/// events update the list of touching contacts.
///
/// The prediction is 0.02, and boxes are enlarged by up to 0.07: both are constants of Box2D.
#[derive(Debug)]
pub struct Box2d {
    world: ffi::b2WorldId,
    bodies: Vec<ffi::b2BodyId>,
    moved: Vec<(ffi::b2BodyId, ffi::b2Vec2, ffi::b2Rot)>,
    contacts: Contacts<ffi::b2ContactId>,
    /// Makes the type not `Send`: a world stays on its thread.
    thread: PhantomData<*const ()>,
}

impl ContactName for ffi::b2ContactId {
    fn index(self) -> usize {
        usize::try_from(self.index1).expect("names of contacts are positive")
    }

    fn generation(self) -> u32 {
        self.generation
    }
}

impl Box2d {
    /// Creates a world with the objects of a scene at step 0; `None` if the scene has a shape that
    /// this adapter does not support.
    #[must_use]
    pub fn new(scene: &Scene<2>, recycling: Recycling) -> Option<Self> {
        if !scene.objects.iter().all(|object| has(&object.shape)) {
            return None;
        }
        let lock = table();
        // SAFETY: definitions are plain data; the table of worlds is locked.
        let world = unsafe {
            let mut def = ffi::b2DefaultWorldDef();
            def.gravity = ffi::b2Vec2 { x: 0.0, y: 0.0 };
            def.enableSleep = false;
            def.workerCount = 1;
            ffi::b2CreateWorld(&raw const def)
        };
        drop(lock);
        if recycling == Recycling::Off {
            // SAFETY: the world was just created.
            unsafe { ffi::b2World_SetContactRecycleDistance(world, 0.0) };
        }
        let (bodies, moved, contacts) = (Vec::new(), Vec::new(), Contacts::new());
        let mut made = Self { world, bodies, moved, contacts, thread: PhantomData };
        (0..scene.objects.len()).for_each(|n| made.add(scene, n));
        Some(made)
    }

    fn add(&mut self, scene: &Scene<2>, index: usize) {
        let shape = &scene.objects[index].shape;
        let (position, rotation) = pose(&scene.placement(index, 0));
        // SAFETY: the world exists; definitions are plain data, which the engine copies.
        let body = unsafe {
            let mut def = ffi::b2DefaultBodyDef();
            if !is_ground(shape) {
                def.type_ = ffi::b2BodyType_b2_dynamicBody;
            }
            (def.position, def.rotation) = (position, rotation);
            ffi::b2CreateBody(self.world, &raw const def)
        };
        add_shape(body, index, shape);
        self.bodies.push(body);
    }

    /// Converts the new placements of the moved objects, and stores them for the next step.
    pub fn prepare(&mut self, moved: &[(usize, Placement<2>)]) {
        self.moved.clear();
        self.moved.extend(moved.iter().map(|(index, placement)| {
            let (position, rotation) = pose(placement);
            (self.bodies[*index], position, rotation)
        }));
    }

    /// Sets the new poses, updates the contacts, and processes the events.
    pub fn step(&mut self) {
        // SAFETY: the world and its bodies exist. The events are read before the world changes
        // again. With a count of 0 the pointer to the events is not read.
        unsafe {
            for (body, position, rotation) in &self.moved {
                ffi::b2Body_SetTransform(*body, *position, *rotation);
            }
            ffi::b2World_Step(self.world, 0.0, 1);
            let events = ffi::b2World_GetContactEvents(self.world);
            for n in 0..events.endCount as usize {
                self.contacts.end((*events.endEvents.add(n)).contactId);
            }
            for n in 0..events.beginCount as usize {
                self.contacts.begin((*events.beginEvents.add(n)).contactId);
            }
        }
    }

    /// Reads every contact point.
    #[must_use]
    pub fn read(&self) -> Digest {
        let mut digest = Digest::default();
        for contact in self.contacts.iter() {
            // SAFETY: the contact has begun and not ended.
            let manifold = unsafe { ffi::b2Contact_GetData(contact) }.manifold;
            for point in &manifold.points[..manifold.pointCount as usize] {
                digest.points += 1;
                digest.depth -= f64::from(point.separation);
            }
        }
        digest
    }

    /// Returns the pairs with a contact point within `distance`, sorted, the smaller index first.
    #[must_use]
    pub fn touching(&self, distance: f32) -> Vec<(usize, usize)> {
        let pairs = self.contacts.iter().filter_map(|contact| {
            // SAFETY: the contact has begun and not ended, so its shapes exist.
            let (data, [a, b]) = unsafe {
                let data = ffi::b2Contact_GetData(contact);
                let index = |shape| ffi::b2Shape_GetUserData(shape).addr();
                (data, [data.shapeIdA, data.shapeIdB].map(index))
            };
            let points = &data.manifold.points[..data.manifold.pointCount as usize];
            points.iter().any(|point| point.separation <= distance).then_some((a, b))
        });
        sorted(pairs.collect())
    }
}

impl Drop for Box2d {
    fn drop(&mut self) {
        let _lock = table();
        // SAFETY: the world exists, and the table is locked.
        unsafe { ffi::b2DestroyWorld(self.world) };
    }
}

/// Returns `true` if this adapter supports the shape. Box2D's hulls have at most 8 corners, and it
/// has no half-spaces. Segments are not supported here.
fn has(shape: &SceneShape<2>) -> bool {
    match shape {
        SceneShape::Convex { points } => points.len() <= 8,
        SceneShape::Plane { .. } | SceneShape::Segment { .. } => false,
        _ => true,
    }
}

const fn is_ground(shape: &SceneShape<2>) -> bool {
    matches!(shape, SceneShape::Polyline { .. } | SceneShape::HeightField { .. })
}

fn vector(v: &[f64; 2]) -> ffi::b2Vec2 {
    let [x, y] = v.map(|x| x as f32);
    ffi::b2Vec2 { x, y }
}

fn pose(placement: &Placement<2>) -> (ffi::b2Vec2, ffi::b2Rot) {
    let [c, s] = placement.complex().map(|x| x as f32);
    (vector(&placement.translation), ffi::b2Rot { c, s })
}

fn add_shape(body: ffi::b2BodyId, index: usize, shape: &SceneShape<2>) {
    // SAFETY: the body exists; definitions and geometry are plain data that the engine copies. The
    // user data is an integer, never dereferenced.
    unsafe {
        let mut def = ffi::b2DefaultShapeDef();
        def.userData = std::ptr::without_provenance_mut(index);
        def.enableContactEvents = true;
        let def = &raw const def;
        match shape {
            SceneShape::Ball { radius } => {
                let center = vector(&[0.0; 2]);
                let circle = ffi::b2Circle { center, radius: *radius as f32 };
                ffi::b2CreateCircleShape(body, def, &raw const circle);
            }
            SceneShape::Cuboid { half_extents: [x, y] } => {
                let polygon = ffi::b2MakeBox(*x as f32, *y as f32);
                ffi::b2CreatePolygonShape(body, def, &raw const polygon);
            }
            SceneShape::Capsule { half_height, radius } => {
                let [center1, center2] = [-half_height, *half_height].map(|y| vector(&[0.0, y]));
                let capsule = ffi::b2Capsule { center1, center2, radius: *radius as f32 };
                ffi::b2CreateCapsuleShape(body, def, &raw const capsule);
            }
            SceneShape::Triangle { corners } => add_polygon(body, def, corners),
            SceneShape::Convex { points } => add_polygon(body, def, points),
            SceneShape::Polyline { vertices } => add_chain(body, index, vertices),
            SceneShape::HeightField { heights, extents, .. } => {
                add_chain(body, index, &line(heights, extents));
            }
            other => unreachable!("worlds with {other:?} are not made"),
        }
    }
}

/// # Safety
/// The body exists, and `def` points to the definition of a shape.
unsafe fn add_polygon(body: ffi::b2BodyId, def: *const ffi::b2ShapeDef, points: &[[f64; 2]]) {
    let points: Vec<_> = points.iter().map(vector).collect();
    // SAFETY: the count is that of the points, at most 8; the engine copies them.
    unsafe {
        let hull = ffi::b2ComputeHull(points.as_ptr(), points.len() as i32);
        assert!(hull.count > 2, "the points span the plane");
        let polygon = ffi::b2MakePolygon(&raw const hull, 0.0);
        ffi::b2CreatePolygonShape(body, def, &raw const polygon);
    }
}

/// Returns the vertices of a 2D height field, from left to right.
fn line(heights: &[f64], extents: &[f64; 2]) -> Vec<[f64; 2]> {
    let last = (heights.len() - 1) as f64;
    let vertex =
        |(n, height): (usize, &f64)| [(n as f64 / last - 0.5) * extents[0], height * extents[1]];
    heights.iter().enumerate().map(vertex).collect()
}

/// Adds a chain. A chain collides only on the right side of its direction, which is above here,
/// since the vertices are reversed. Its first and last segments do not collide; no object is near
/// those.
fn add_chain(body: ffi::b2BodyId, index: usize, vertices: &[[f64; 2]]) {
    let points: Vec<_> = vertices.iter().rev().map(vector).collect();
    // SAFETY: the body exists; the count is that of the points, which the engine copies.
    unsafe {
        let mut def = ffi::b2DefaultChainDef();
        def.userData = std::ptr::without_provenance_mut(index);
        (def.points, def.count) = (points.as_ptr(), points.len() as i32);
        ffi::b2CreateChain(body, &raw const def);
    }
}
