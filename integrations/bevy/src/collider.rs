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

/// The key of a world, a type of yours: `#[derive(Clone, Copy, Debug, Default, PartialEq)] struct Ghosts;`.
///
/// Implemented for every type with these traits. Each key has its own plugin, [`Collider`], [`Collisions`] and events;
/// an entity may have a collider in several worlds.
pub trait WorldKey: Copy + Debug + Default + PartialEq + Send + Sync + 'static {}

impl<T: Copy + Debug + Default + PartialEq + Send + Sync + 'static> WorldKey for T {}

/// The key of the world that is meant if none is named.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct DefaultWorld;

/// The shape of an entity, in the entity's own frame: makes it an object of a collision world.
///
/// Cloning is cheap and shares the shape. The component may be replaced or assigned at any time; the entity follows its
/// transform, parents included. A scale of the transform is applied where the library has the scaled shape exactly.
///
/// Constructors take full lengths. One with a size that is negative or NaN makes a collider with an
/// [error](Self::error), which the plugin reports on the entity; it does not panic. Every solid of `bevy_math` that the
/// library has exactly becomes a collider by `into()`.
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

/// The object leaves the world with the component: queries no longer find it, its pairs end at the next step.
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
    /// Why there is no shape, if a constructor was given what makes none.
    #[must_use]
    pub fn error(&self) -> Option<ColliderError> {
        self.shape.as_ref().err().copied()
    }

    /// The library's shape.
    ///
    /// # Errors
    /// Those of [`Self::error`].
    pub fn shape(&self) -> Result<&ShapeHandle<f32, D>, ColliderError> {
        self.shape.as_ref().map_err(|error| *error)
    }

    /// The same shape in the world of another key.
    #[must_use]
    pub fn in_world<V: WorldKey>(self) -> Collider<D, V> {
        Collider { shape: self.shape, world: PhantomData }
    }

    /// The shape scaled along the entity's axes; the shape itself if all factors are 1.
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
    /// Any shape of the library, or one of your own.
    #[must_use]
    pub fn new<S: Shape<f32, D>>(shape: S) -> Self {
        Self::from_shape(Ok(ShapeHandle::new(shape)))
    }

    /// A shape that is shared with others.
    #[must_use]
    pub fn from_handle(shape: ShapeHandle<f32, D>) -> Self {
        Self::from_shape(Ok(shape))
    }

    pub(crate) fn from_shape(shape: Result<ShapeHandle<f32, D>, ColliderError>) -> Self {
        Self { shape, world: PhantomData }
    }

    /// The collider of what a constructor of the library returned.
    pub(crate) fn made<S: Shape<f32, D>, E: Into<ColliderError>>(shape: Result<S, E>) -> Self {
        Self::from_shape(shape.map(ShapeHandle::new).map_err(Into::into))
    }

    pub(crate) fn ball(radius: f32) -> Self {
        Self::made(Ball::try_new(radius))
    }

    /// The points within `radius` of a segment of `length` along the y axis, with its middle at the origin: the whole is
    /// `length + 2 * radius` long.
    #[must_use]
    pub fn capsule(radius: f32, length: f32) -> Self {
        Self::made(Capsule::try_new(length / 2.0, radius))
    }

    /// The points within `radius` of a segment.
    #[must_use]
    pub fn capsule_between(a: Vec_<D>, b: Vec_<D>, radius: f32) -> Self {
        Self::made(Capsule::try_from_ends(point(a), point(b), radius))
    }

    /// The hull of a ball of `radius_bottom` and one of `radius_top` at `length` above it along the y axis, with the
    /// middle of their centres at the origin.
    #[must_use]
    pub fn tapered_capsule(radius_bottom: f32, radius_top: f32, length: f32) -> Self {
        Self::made(TaperedCapsule::try_new(length / 2.0, radius_bottom, radius_top))
    }

    /// A straight line between two points.
    #[must_use]
    pub fn segment(a: Vec_<D>, b: Vec_<D>) -> Self {
        Self::made(Segment::try_new(point(a), point(b)))
    }

    /// A filled triangle; in 3D it has no thickness.
    #[must_use]
    pub fn triangle(a: Vec_<D>, b: Vec_<D>, c: Vec_<D>) -> Self {
        Self::made(Triangle::try_new(point(a), point(b), point(c)))
    }

    /// A chain of segments, open at its ends.
    #[must_use]
    pub fn polyline(vertices: impl IntoIterator<Item = Vec_<D>>) -> Self {
        Self::made(Polyline::try_open(points(vertices)))
    }

    /// A chain of segments whose last vertex is joined to the first.
    #[must_use]
    pub fn closed_polyline(vertices: impl IntoIterator<Item = Vec_<D>>) -> Self {
        Self::made(Polyline::try_closed(points(vertices)))
    }

    /// Triangles of three indices each: in 2D an area, in 3D a surface without an interior.
    #[must_use]
    pub fn trimesh(vertices: impl IntoIterator<Item = Vec_<D>>, triangles: Vec<[u32; 3]>) -> Self {
        Self::made(TriMesh::try_new(points(vertices), triangles))
    }

    /// Colliders side by side, each at its pose in the frame of the whole.
    #[must_use]
    pub fn compound<P: Into<Pose<D>>>(children: impl IntoIterator<Item = (P, Self)>) -> Self {
        let placed = |(pose, child): (P, Self)| Ok((f32::isometry_of(&pose.into()), child.shape?));
        let children: Result<Vec<_>, ColliderError> = children.into_iter().map(placed).collect();
        Self::made(children.and_then(|children| Ok(Compound::try_new(children)?)))
    }

    /// All points within `radius` of this convex shape: corners and edges become round.
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
