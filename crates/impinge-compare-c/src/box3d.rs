//! Box3D, used without dynamics. The adapter corresponds to that of `box2d`, with 3D shapes.

use std::marker::PhantomData;
use std::sync::{Mutex, MutexGuard, PoisonError};

use boxddd_sys::ffi;
use impinge_scenes::{Placement, Scene, SceneShape};

use crate::contacts::{ContactName, Contacts};
use crate::{Digest, Recycling, sorted};

/// The lock of Box3D's table of worlds, which the whole process shares.
static TABLE: Mutex<()> = Mutex::new(());

fn table() -> MutexGuard<'static, ()> {
    TABLE.lock().unwrap_or_else(PoisonError::into_inner)
}

/// The amount by which Box3D increases the depth of points on meshes and height fields.
const REST_OFFSET: f32 = 0.005;

/// A world of Box3D.
///
/// The bodies are dynamic and never sleep, since two bodies that are not dynamic never touch.
/// Terrain is static. A step first sets the transforms of moved objects. Then it makes a step of
/// time 0, which finds pairs and updates contacts, but solves and integrates nothing. The events
/// update the list of touching contacts.
///
/// The prediction is 0.02, and boxes are enlarged by up to 0.07: both are constants of Box3D.
/// Depths on terrain are larger by 0.005, another constant. The heights of its height fields have
/// 16 bits.
#[derive(Debug)]
pub struct Box3d {
    world: ffi::b3WorldId,
    bodies: Vec<ffi::b3BodyId>,
    /// For each object, the offset that is added to the separations of its points; see [`REST_OFFSET`].
    offsets: Vec<f32>,
    moved: Vec<(ffi::b3BodyId, ffi::b3Vec3, ffi::b3Quat)>,
    contacts: Contacts<ffi::b3ContactId>,
    meshes: Vec<*mut ffi::b3MeshData>,
    fields: Vec<*mut ffi::b3HeightFieldData>,
    /// Makes the type not `Send`: a world stays on its thread.
    thread: PhantomData<*const ()>,
}

impl ContactName for ffi::b3ContactId {
    fn index(self) -> usize {
        usize::try_from(self.index1).expect("names of contacts are positive")
    }

    fn generation(self) -> u32 {
        self.generation
    }
}

impl Box3d {
    /// Creates a world with the objects of a scene at step 0; `None` if the scene has a shape that
    /// this adapter does not support.
    #[must_use]
    pub fn new(scene: &Scene<3>, recycling: Recycling) -> Option<Self> {
        if !scene.objects.iter().all(|object| has(&object.shape)) {
            return None;
        }
        let lock = table();
        // SAFETY: definitions are plain data; the table of worlds is locked.
        let world = unsafe {
            let mut def = ffi::b3DefaultWorldDef();
            def.gravity = vector(&[0.0; 3]);
            def.enableSleep = false;
            def.workerCount = 1;
            ffi::b3CreateWorld(&raw const def)
        };
        drop(lock);
        if recycling == Recycling::Off {
            // SAFETY: the world was just created.
            unsafe { ffi::b3World_SetContactRecycleDistance(world, 0.0) };
        }
        let (bodies, offsets, moved) = (Vec::new(), Vec::new(), Vec::new());
        let (contacts, meshes, fields) = (Contacts::new(), Vec::new(), Vec::new());
        let thread = PhantomData;
        let mut made = Self { world, bodies, offsets, moved, contacts, meshes, fields, thread };
        (0..scene.objects.len()).for_each(|n| made.add(scene, n));
        Some(made)
    }

    fn add(&mut self, scene: &Scene<3>, index: usize) {
        let shape = &scene.objects[index].shape;
        let (mut position, mut rotation) = pose(&scene.placement(index, 0));
        if let SceneShape::HeightField { extents, .. } = shape {
            // Rotates the field by a quarter turn about y: so the diagonals of Box3D's cells become
            // those of the scene.
            let half = 0.5_f64.sqrt();
            rotation = ffi::b3Quat { v: vector(&[0.0, half, 0.0]), s: half as f32 };
            // The origin of Box3D's field is its first height; the height field of the scene is
            // centred.
            position.x -= 0.5 * extents[0] as f32;
            position.z += 0.5 * extents[2] as f32;
        }
        // SAFETY: the world exists; definitions are plain data, which the engine copies.
        let body = unsafe {
            let mut def = ffi::b3DefaultBodyDef();
            if !is_ground(shape) {
                def.type_ = ffi::b3BodyType_b3_dynamicBody;
            }
            (def.position, def.rotation) = (position, rotation);
            ffi::b3CreateBody(self.world, &raw const def)
        };
        self.add_shape(body, index, shape);
        self.bodies.push(body);
        self.offsets.push(if is_ground(shape) { REST_OFFSET } else { 0.0 });
    }

    /// Converts the new placements of the moved objects, and stores them for the next step.
    pub fn prepare(&mut self, moved: &[(usize, Placement<3>)]) {
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
                ffi::b3Body_SetTransform(*body, *position, *rotation);
            }
            ffi::b3World_Step(self.world, 0.0, 1);
            let events = ffi::b3World_GetContactEvents(self.world);
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
            for manifold in manifolds(self, contact).1 {
                for point in &manifold.points[..manifold.pointCount as usize] {
                    digest.points += 1;
                    digest.depth -= f64::from(point.separation);
                }
            }
        }
        digest
    }

    /// Returns the pairs with a contact point within `distance`, sorted, the smaller index first.
    /// The offset that Box3D adds to depths on terrain is removed.
    #[must_use]
    pub fn touching(&self, distance: f32) -> Vec<(usize, usize)> {
        let pairs = self.contacts.iter().filter_map(|contact| {
            let (data, manifolds) = manifolds(self, contact);
            // SAFETY: the shapes of a contact exist.
            let index = |shape| unsafe { ffi::b3Shape_GetUserData(shape) }.addr();
            let pair = (index(data.shapeIdA), index(data.shapeIdB));
            let offset = self.offsets[pair.0] + self.offsets[pair.1];
            let points = |manifold: &ffi::b3Manifold| {
                let points = &manifold.points[..manifold.pointCount as usize];
                points.iter().any(|point| point.separation + offset <= distance)
            };
            manifolds.iter().any(points).then_some(pair)
        });
        sorted(pairs.collect())
    }

    fn add_shape(&mut self, body: ffi::b3BodyId, index: usize, shape: &SceneShape<3>) {
        // SAFETY: the body exists; definitions and convex geometry are plain data that the engine
        // copies. The user data is an integer, never dereferenced.
        unsafe {
            let mut def = ffi::b3DefaultShapeDef();
            def.userData = std::ptr::without_provenance_mut(index);
            def.enableContactEvents = true;
            let def = &raw const def;
            match shape {
                SceneShape::Ball { radius } => {
                    let center = vector(&[0.0; 3]);
                    let sphere = ffi::b3Sphere { center, radius: *radius as f32 };
                    ffi::b3CreateSphereShape(body, def, &raw const sphere);
                }
                SceneShape::Cuboid { half_extents } => {
                    let [x, y, z] = half_extents.map(|x| x as f32);
                    let hull = ffi::b3MakeBoxHull(x, y, z);
                    // The arrays of the hull follow its base in memory, so the pointer must have
                    // the provenance of the whole hull.
                    ffi::b3CreateHullShape(body, def, (&raw const hull).cast());
                }
                SceneShape::Capsule { half_height, radius } => {
                    let ends = [-half_height, *half_height];
                    let [center1, center2] = ends.map(|y| vector(&[0.0, y, 0.0]));
                    let capsule = ffi::b3Capsule { center1, center2, radius: *radius as f32 };
                    ffi::b3CreateCapsuleShape(body, def, &raw const capsule);
                }
                SceneShape::Convex { points } => {
                    let points: Vec<_> = points.iter().map(vector).collect();
                    let count = points.len() as i32;
                    let hull = ffi::b3CreateHull(points.as_ptr(), count, count);
                    assert!(!hull.is_null(), "the points span space");
                    ffi::b3CreateHullShape(body, def, hull);
                    ffi::b3DestroyHull(hull);
                }
                SceneShape::TriMesh { vertices, triangles } => {
                    let mesh = mesh(vertices, triangles);
                    ffi::b3CreateMeshShape(body, def, mesh, vector(&[1.0; 3]));
                    self.meshes.push(mesh);
                }
                SceneShape::HeightField { counts, heights, extents } => {
                    let field = field(*counts, heights, extents);
                    ffi::b3CreateHeightFieldShape(body, def, field);
                    self.fields.push(field);
                }
                other => unreachable!("worlds with {other:?} are not made"),
            }
        }
    }
}

/// Returns the data of a contact, and its manifolds. The borrow of the world ensures that they are
/// not used after it changes.
fn manifolds(_: &Box3d, contact: ffi::b3ContactId) -> (ffi::b3ContactData, &[ffi::b3Manifold]) {
    // SAFETY: the contact has begun and not ended. Without manifolds the pointer may be null, and
    // is not read.
    unsafe {
        let data = ffi::b3Contact_GetData(contact);
        let count = data.manifoldCount as usize;
        let slice: &[_] =
            if count == 0 { &[] } else { std::slice::from_raw_parts(data.manifolds, count) };
        (data, slice)
    }
}

impl Drop for Box3d {
    fn drop(&mut self) {
        let _lock = table();
        // SAFETY: the world exists, and the table is locked. The data that its shapes point to is
        // freed after the world.
        unsafe {
            ffi::b3DestroyWorld(self.world);
            self.meshes.iter().for_each(|mesh| ffi::b3DestroyMesh(*mesh));
            self.fields.iter().for_each(|field| ffi::b3DestroyHeightField(*field));
        }
    }
}

/// Returns `true` if this adapter supports the shape. Cylinders and cones are not supported: those
/// of Box3D are hulls with flat sides.
const fn has(shape: &SceneShape<3>) -> bool {
    use SceneShape::{Ball, Capsule, Convex, Cuboid};
    matches!(shape, Ball { .. } | Cuboid { .. } | Capsule { .. } | Convex { .. })
        || is_ground(shape)
}

const fn is_ground(shape: &SceneShape<3>) -> bool {
    matches!(shape, SceneShape::TriMesh { .. } | SceneShape::HeightField { .. })
}

fn vector(v: &[f64; 3]) -> ffi::b3Vec3 {
    let [x, y, z] = v.map(|x| x as f32);
    ffi::b3Vec3 { x, y, z }
}

fn pose(placement: &Placement<3>) -> (ffi::b3Vec3, ffi::b3Quat) {
    let [i, j, k, w] = placement.quaternion();
    (vector(&placement.translation), ffi::b3Quat { v: vector(&[i, j, k]), s: w as f32 })
}

/// # Safety
/// All indices of the triangles are less than the number of vertices.
unsafe fn mesh(vertices: &[[f64; 3]], triangles: &[[u32; 3]]) -> *mut ffi::b3MeshData {
    let mut vertices: Vec<_> = vertices.iter().map(vector).collect();
    let mut indices: Vec<_> = triangles.iter().flatten().map(|n| *n as i32).collect();
    let mut materials = vec![0; triangles.len()];
    let def = ffi::b3MeshDef {
        vertices: vertices.as_mut_ptr(),
        indices: indices.as_mut_ptr(),
        materialIndices: materials.as_mut_ptr(),
        weldTolerance: 0.0,
        vertexCount: vertices.len() as i32,
        triangleCount: triangles.len() as i32,
        weldVertices: false,
        useMedianSplit: false,
        identifyEdges: true,
    };
    // SAFETY: the counts are those of the lists, which the engine copies.
    let mesh = unsafe { ffi::b3CreateMesh(&raw const def, std::ptr::null_mut(), 0) };
    assert!(!mesh.is_null(), "the mesh is sound");
    mesh
}

/// Returns the height field rotated by a quarter turn about y: its x axis is −z of the scene, its z
/// axis is x of the scene.
///
/// # Safety
/// `heights` has as many elements as the product of the counts.
unsafe fn field(
    [rows, columns]: [usize; 2],
    heights: &[f64],
    extents: &[f64; 3],
) -> *mut ffi::b3HeightFieldData {
    let height = |z: usize, x: usize| heights[(rows - 1 - x) * columns + z] as f32;
    let turned = (0..columns).flat_map(|z| (0..rows).map(move |x| height(z, x)));
    let mut heights: Vec<_> = turned.collect();
    let bounds = (f32::INFINITY, f32::NEG_INFINITY);
    let (low, high) = heights.iter().fold(bounds, |(low, high), h| (low.min(*h), high.max(*h)));
    let mut materials = vec![0; (rows - 1) * (columns - 1)];
    let width = |extent: f64, count: usize| extent / (count - 1) as f64;
    let def = ffi::b3HeightFieldDef {
        heights: heights.as_mut_ptr(),
        materialIndices: materials.as_mut_ptr(),
        scale: vector(&[width(extents[2], rows), extents[1], width(extents[0], columns)]),
        countX: rows as i32,
        countZ: columns as i32,
        globalMinimumHeight: low,
        globalMaximumHeight: high,
        clockwiseWinding: false,
    };
    // SAFETY: the counts are those of the lists, which the engine copies.
    let field = unsafe { ffi::b3CreateHeightField(&raw const def) };
    assert!(!field.is_null(), "the field is sound");
    field
}
