//! The component that makes an entity an object of a collision world.

use core::fmt::Debug;
use core::marker::PhantomData;

use bevy_ecs::lifecycle::HookContext;
use bevy_ecs::prelude::Component;
use bevy_ecs::world::DeferredWorld;
use bevy_transform::components::Transform;
use impinge::math::{Point, Vector};
use impinge::shape::{
    Ball, Capsule, Compound, Polyline, Rounded, Segment, Shape, ShapeHandle, TaperedCapsule,
    TriMesh, Triangle,
};

use crate::glam::{Glam, Pose, Vec_};
use crate::{ColliderError, ColliderProblem, Collisions};

/// The key of a world, a type of the user: `#[derive(Clone, Copy, Debug, Default, PartialEq)] struct Ghosts;`.
///
/// Implemented for every type with these traits. Each key has its own plugin, [`Collider`], [`Collisions`] and events;
/// an entity may have a collider in several worlds.
pub trait WorldKey: Copy + Debug + Default + PartialEq + Send + Sync + 'static {}

impl<T: Copy + Debug + Default + PartialEq + Send + Sync + 'static> WorldKey for T {}

/// The key of the world that is used if no other key is given.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DefaultWorld;

/// The shape of an entity, in the entity's local frame: makes it an object of a collision world.
///
/// Cloning is cheap and shares the shape. The component may be replaced or assigned at any time.
/// The object follows the transform of the entity, parents included. A scale of the transform is
/// applied if the library can represent the scaled shape exactly.
///
/// Constructors take full lengths. A size that is negative or NaN makes a collider with an [error](Self::error), which
/// the plugin reports on the entity; the constructor does not panic. Every solid of `bevy_math` that the library can
/// represent exactly converts to a collider by `into()`.
///
/// ```
/// use bevy_impinge::d3::Collider;
/// use bevy_math::primitives::Cuboid;
///
/// let crate_of_wood = Collider::cuboid(1.0, 2.0, 1.0);
/// assert_eq!(crate_of_wood.error(), None);
/// assert_eq!(Collider::from(Cuboid::new(1.0, 2.0, 1.0)).error(), None);
/// assert!(Collider::sphere(-1.0).error().is_some());
/// ```
#[derive(Component, Clone, Debug)]
#[require(Transform)]
#[component(on_remove = forget::<D, W>)]
pub struct Collider<const D: usize, W: WorldKey = DefaultWorld>
where
    f32: Glam<D>,
{
    shape: Result<ShapeHandle<f32, D>, ColliderError>,
    world: PhantomData<W>,
}

/// When the component is removed, removes the object from the world: queries no longer find it, and
/// its pairs end at the next step.
fn forget<const D: usize, W: WorldKey>(mut world: DeferredWorld<'_>, context: HookContext)
where
    f32: Glam<D>,
{
    let collisions = world.get_resource_mut::<Collisions<D, W>>();
    let has_problem = collisions.is_some_and(|mut all| all.forget(context.entity));
    if has_problem {
        world.commands().entity(context.entity).try_remove::<ColliderProblem<D, W>>();
    }
}

impl<const D: usize, W: WorldKey> Collider<D, W>
where
    f32: Glam<D>,
{
    /// Returns the error if the arguments of a constructor were invalid; `None` if there is a
    /// shape.
    #[must_use]
    pub fn error(&self) -> Option<ColliderError> {
        self.shape.as_ref().err().copied()
    }

    /// Returns the library's shape.
    ///
    /// # Errors
    /// The error of [`Self::error`].
    pub fn shape(&self) -> Result<&ShapeHandle<f32, D>, ColliderError> {
        self.shape.as_ref().map_err(|error| *error)
    }

    /// Returns a collider with this shape for the world of another key.
    #[must_use]
    pub fn in_world<V: WorldKey>(self) -> Collider<D, V> {
        Collider { shape: self.shape, world: PhantomData }
    }

    /// Returns the shape scaled along the entity's axes; the shape itself if all factors are 1.
    pub(crate) fn scaled(
        &self,
        scale: &Vector<f32, D>,
    ) -> Result<ShapeHandle<f32, D>, ColliderError> {
        let shape = self.shape()?;
        if scale.iter().all(|&factor| factor == 1.0) {
            return Ok(shape.clone());
        }
        Ok(shape.scaled(scale)?)
    }
}

impl<const D: usize> Collider<D>
where
    f32: Glam<D>,
{
    /// Creates a collider of any shape of the library, or one of your own.
    #[must_use]
    pub fn new<S: Shape<f32, D>>(shape: S) -> Self {
        Self::from_shape(Ok(ShapeHandle::new(shape)))
    }

    /// Creates a collider of a shared shape.
    #[must_use]
    pub fn from_handle(shape: ShapeHandle<f32, D>) -> Self {
        Self::from_shape(Ok(shape))
    }

    pub(crate) fn from_shape(shape: Result<ShapeHandle<f32, D>, ColliderError>) -> Self {
        Self { shape, world: PhantomData }
    }

    /// Converts the result of a constructor of the library to a collider.
    pub(crate) fn made<S: Shape<f32, D>, E: Into<ColliderError>>(shape: Result<S, E>) -> Self {
        Self::from_shape(shape.map(ShapeHandle::new).map_err(Into::into))
    }

    pub(crate) fn ball(radius: f32) -> Self {
        Self::made(Ball::try_new(radius))
    }

    /// Creates a capsule: the points within `radius` of a segment of `length` along the y axis, with its centre at the
    /// origin. Its full length is `length + 2 * radius`.
    #[must_use]
    pub fn capsule(radius: f32, length: f32) -> Self {
        Self::made(Capsule::try_new(length / 2.0, radius))
    }

    /// Creates a capsule: the points within `radius` of the segment from `a` to `b`.
    #[must_use]
    pub fn capsule_between(a: Vec_<D>, b: Vec_<D>, radius: f32) -> Self {
        Self::made(Capsule::try_from_ends(point(a), point(b), radius))
    }

    /// Creates the hull of a ball of `radius_bottom` and one of `radius_top` at `length` above it along the y axis; the
    /// midpoint of their centres is at the origin.
    #[must_use]
    pub fn tapered_capsule(radius_bottom: f32, radius_top: f32, length: f32) -> Self {
        Self::made(TaperedCapsule::try_new(length / 2.0, radius_bottom, radius_top))
    }

    /// Creates the segment between two points.
    #[must_use]
    pub fn segment(a: Vec_<D>, b: Vec_<D>) -> Self {
        Self::made(Segment::try_new(point(a), point(b)))
    }

    /// Creates a filled triangle; in 3D it has no thickness.
    #[must_use]
    pub fn triangle(a: Vec_<D>, b: Vec_<D>, c: Vec_<D>) -> Self {
        Self::made(Triangle::try_new(point(a), point(b), point(c)))
    }

    /// Creates a chain of segments, open at its ends.
    #[must_use]
    pub fn polyline(vertices: impl IntoIterator<Item = Vec_<D>>) -> Self {
        Self::made(Polyline::try_open(points(vertices)))
    }

    /// Creates a chain of segments whose last vertex is connected to the first.
    #[must_use]
    pub fn closed_polyline(vertices: impl IntoIterator<Item = Vec_<D>>) -> Self {
        Self::made(Polyline::try_closed(points(vertices)))
    }

    /// Creates a triangle mesh with three indices per triangle: in 2D an area, in 3D a surface without an interior.
    #[must_use]
    pub fn trimesh(vertices: impl IntoIterator<Item = Vec_<D>>, triangles: Vec<[u32; 3]>) -> Self {
        Self::made(TriMesh::try_new(points(vertices), triangles))
    }

    /// Creates a compound of colliders, each at its pose in the frame of the compound.
    #[must_use]
    pub fn compound<P: Into<Pose<D>>>(children: impl IntoIterator<Item = (P, Self)>) -> Self {
        let placed = |(pose, child): (P, Self)| Ok((f32::isometry_of(&pose.into()), child.shape?));
        let children: Result<Vec<_>, ColliderError> = children.into_iter().map(placed).collect();
        Self::made(children.and_then(|children| Ok(Compound::try_new(children)?)))
    }

    /// Returns a collider of all points within `radius` of this convex shape, whose corners and
    /// edges become round.
    #[must_use]
    pub fn rounded(self, radius: f32) -> Self {
        Self::made(self.shape.and_then(|shape| Ok(Rounded::try_from_handle(shape, radius)?)))
    }
}

pub(crate) fn point<const D: usize>(vec: Vec_<D>) -> Point<f32, D>
where
    f32: Glam<D>,
{
    Point::from(f32::vector(vec))
}

pub(crate) fn points<const D: usize>(
    vertices: impl IntoIterator<Item = Vec_<D>>,
) -> Vec<Point<f32, D>>
where
    f32: Glam<D>,
{
    vertices.into_iter().map(point::<D>).collect()
}
