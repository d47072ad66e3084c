//! Simulates scenes of `impinge-scenes` in a world.

use impinge::math::{Point, Real, Unit, Vector};
use impinge::narrow_phase::{CollisionObjectHandle, GeometricQueryType};
use impinge::shape::{
    Ball, Capsule, Cuboid, Plane, Polyline, Segment, ShapeHandle, TriMesh, Triangle,
};
use impinge::world::CollisionGroups;
use impinge_record::{Recordable, ShapeData};
use impinge_scenes::{Scene, SceneObject, SceneQuery, SceneShape};

use crate::dimension::Dimension;
use crate::{SampleError, World};

/// A scene and its objects in a world. Each position is a function of the step.
#[derive(Clone, Debug, Default)]
pub(crate) struct Play<const D: usize> {
    /// The scene, with the motions of its objects.
    scene: Scene<D>,
    /// The handles of the objects, in the order of the scene.
    handles: Vec<CollisionObjectHandle>,
    /// The step to which the positions in the world belong.
    step: u32,
}

impl<const D: usize> Play<D>
where
    f32: Dimension<D>,
{
    /// Adds the objects of a scene to a world, at their positions of step 0.
    pub(crate) fn start(scene: Scene<D>, world: &mut World<D>) -> Result<Self, SampleError> {
        let mut handles = Vec::with_capacity(scene.objects.len());
        for (index, object) in scene.objects.iter().enumerate() {
            let position = f32::placed(&scene.placement(index, 0));
            let (shape, label) = (shape_of(&object.shape), format!("object {index}"));
            let (groups, query) = (groups_of(object), query_of(object.query));
            handles.push(world.add(position, shape, groups, query, label)?);
        }
        Ok(Self { scene, handles, step: 0 })
    }

    /// Moves the objects to their positions of the next step. Objects that do not move are skipped.
    pub(crate) fn advance(&mut self, world: &mut World<D>) -> Result<(), SampleError> {
        self.step += 1;
        let (scene, step) = (&self.scene, self.step);
        let moved = self.handles.iter().enumerate().filter_map(|(index, handle)| {
            let (before, now) = (scene.placement(index, step - 1), scene.placement(index, step));
            // Unchanged positions need no call.
            (before != now).then(|| (*handle, f32::placed(&now)))
        });
        Ok(world.set_positions(&moved.collect::<Vec<_>>())?)
    }

    /// Returns the handles of the objects, in the order of the scene.
    pub(crate) fn handles(&self) -> &[CollisionObjectHandle] {
        &self.handles
    }
}

/// Converts a shape of a scene. The numbers are passed to the constructors of the library
/// unchanged, apart from rounding to `f32`; normals of planes are normalized again.
fn shape_of<const D: usize>(shape: &SceneShape<D>) -> ShapeHandle<f32, D>
where
    f32: Dimension<D>,
{
    let vector = |xyz: &[f64; D]| Vector::<f32, D>::from_fn(|axis, _| f32::lit(xyz[axis]));
    let point = |xyz: &[f64; D]| Point::from(vector(xyz));
    let points = |list: &[[f64; D]]| list.iter().map(point).collect::<Vec<_>>();
    // Solids that exist in one dimension only are built from the data with which recordings store
    // them.
    let own = |data: &ShapeData<f32, D>| {
        f32::own_shape(data).expect("a scene has valid solids of its own dimension")
    };
    match shape {
        SceneShape::Ball { radius } => ShapeHandle::new(Ball::new(f32::lit(*radius))),
        SceneShape::Cuboid { half_extents } => ShapeHandle::new(Cuboid::new(vector(half_extents))),
        SceneShape::Plane { normal } => {
            ShapeHandle::new(Plane::new(Unit::new_normalize(vector(normal))))
        }
        SceneShape::Capsule { half_height, radius } => {
            ShapeHandle::new(Capsule::new(f32::lit(*half_height), f32::lit(*radius)))
        }
        SceneShape::Segment { ends: [a, b] } => ShapeHandle::new(Segment::new(point(a), point(b))),
        SceneShape::Triangle { corners: [a, b, c] } => {
            ShapeHandle::new(Triangle::new(point(a), point(b), point(c)))
        }
        SceneShape::Convex { points: corners } => f32::hull(&points(corners)),
        SceneShape::Cylinder { half_height, radius } => {
            own(&ShapeData::Cylinder([half_height, radius].map(|length| f32::lit(*length))))
        }
        SceneShape::Cone { half_height, radius } => {
            own(&ShapeData::Cone([half_height, radius].map(|length| f32::lit(*length))))
        }
        SceneShape::Polyline { vertices } => ShapeHandle::new(Polyline::open(points(vertices))),
        SceneShape::TriMesh { vertices, triangles } => {
            ShapeHandle::new(TriMesh::new(points(vertices), triangles.clone()))
        }
        SceneShape::HeightField { .. } => {
            unreachable!("no scene of the gallery has a height field")
        }
    }
}

/// Converts the collision groups of an object of a scene.
fn groups_of<const D: usize>(object: &SceneObject<D>) -> CollisionGroups {
    let mut groups = CollisionGroups::new();
    groups.set_membership(object.groups.membership);
    groups.set_whitelist(object.groups.whitelist);
    groups.set_blacklist(object.groups.blacklist);
    groups
}

/// Converts the query type of an object of a scene.
fn query_of(query: SceneQuery) -> GeometricQueryType<f32> {
    match query {
        SceneQuery::Contacts { linear, angular } => {
            GeometricQueryType::Contacts(f32::lit(linear), f32::lit(angular))
        }
        SceneQuery::Proximity { margin } => GeometricQueryType::Proximity(f32::lit(margin)),
    }
}
