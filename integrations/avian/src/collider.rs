//! The component that gives an entity a shape.

use bevy_ecs::prelude::Component;
use bevy_impinge::{ColliderError, Glam};
use impinge::math::{Point, Space, Vector};
use impinge::query::{MassProperties, mass_properties};
use impinge::shape::{Compound, Polyline, Rounded, Shape, ShapeHandle, TriMesh};

use crate::scaling::{Dimension, scaled};

/// `Vec2` or `Vec3`.
pub(crate) type Vec_<const D: usize> = <f32 as Glam<D>>::Vec;
/// The library's isometry.
pub(crate) type Isometry<const D: usize> = <f32 as Space<D>>::Isometry;

/// The coordinate that replaces infinity in boxes: the largest for which `FAR - (-FAR)` is finite.
const FAR: f32 = f32::MAX / 2.0;

/// The shape of an entity, for Avian's plugins: what Avian's own `Collider` is for parry.
///
/// Cloning is cheap and shares the shape. The dimension is filled in by [`d2`](crate::d2) and [`d3`](crate::d3), which
/// have the constructors that one dimension alone has.
///
/// ```
/// use avian_impinge::d3::Collider;
/// use bevy_math::primitives::Cuboid;
///
/// assert_eq!(Collider::cuboid(1.0, 2.0, 1.0).error(), None);
/// assert_eq!(Collider::new(Cuboid::new(1.0, 2.0, 1.0)).error(), None);
/// assert!(Collider::sphere(-1.0).error().is_some());
/// ```
#[derive(Component, Clone, Debug)]
pub struct Collider<const D: usize>
where
    f32: Dimension<D>,
{
    shape: Result<ShapeHandle<f32, D>, ColliderError>,
    /// With the scale applied.
    scaled: Result<ShapeHandle<f32, D>, ColliderError>,
    scale: Vec_<D>,
}

impl<const D: usize> Collider<D>
where
    f32: Dimension<D>,
{
    /// The collider of a solid of `bevy_math`, or of whatever else a collider of `bevy_impinge` is made of.
    #[must_use]
    pub fn new(shape: impl Into<bevy_impinge::Collider<D>>) -> Self {
        Self::made(shape.into().shape().cloned())
    }

    /// Any shape of the library, or one of your own.
    #[must_use]
    pub fn from_shape<S: Shape<f32, D>>(shape: S) -> Self {
        Self::made(Ok(ShapeHandle::new(shape)))
    }

    /// A shape that is shared with others.
    #[must_use]
    pub fn from_handle(shape: ShapeHandle<f32, D>) -> Self {
        Self::made(Ok(shape))
    }

    pub(crate) fn made(shape: Result<ShapeHandle<f32, D>, ColliderError>) -> Self {
        Self { scaled: shape.clone(), shape, scale: f32::vec(&Vector::<f32, D>::repeat(1.0)) }
    }

    /// The collider of what a constructor of the library returned.
    pub(crate) fn of<S: Shape<f32, D>, E: Into<ColliderError>>(shape: Result<S, E>) -> Self {
        Self::made(shape.map(ShapeHandle::new).map_err(Into::into))
    }

    /// Returns the collider with the shape, or with the error if a constructor of the library
    /// rejected its arguments.
    #[must_use]
    pub fn error(&self) -> Option<ColliderError> {
        self.shape.as_ref().err().copied()
    }

    /// The library's shape, without the scale of the transform.
    ///
    /// # Errors
    /// See [`Self::error`].
    pub fn shape(&self) -> Result<&ShapeHandle<f32, D>, ColliderError> {
        self.shape.as_ref().map_err(|error| *error)
    }

    /// The library's shape, with the scale of the transform.
    ///
    /// # Errors
    /// See [`Self::error`].
    pub fn shape_scaled(&self) -> Result<&ShapeHandle<f32, D>, ColliderError> {
        self.scaled.as_ref().map_err(|error| *error)
    }

    /// Takes another shape; the scale stays, and is applied to it.
    pub fn set_shape(&mut self, shape: ShapeHandle<f32, D>) {
        let scale = self.scale;
        *self = Self::made(Ok(shape));
        self.rescale(scale, DETAIL);
    }

    /// The factors along the axes that are applied to the shape.
    #[must_use]
    pub fn scale(&self) -> Vec_<D> {
        self.scale
    }

    /// Replaces the scale; see [`scaled`]. If the shape cannot be scaled so, the old scale stays.
    pub(crate) fn rescale(&mut self, scale: Vec_<D>, detail: u32) {
        let Ok(shape) = &self.shape else { return };
        if scale == self.scale {
            return;
        }
        match scaled(shape, &f32::vector(scale), detail) {
            Ok(shape) => (self.scaled, self.scale) = (Ok(shape), scale),
            Err(error) => log::error!("a collider keeps its scale: {error}"),
        }
    }

    /// A segment between two points.
    #[must_use]
    pub fn segment(a: Vec_<D>, b: Vec_<D>) -> Self {
        Self::new(bevy_impinge::Collider::segment(a, b))
    }

    /// A filled triangle; in 3D it has no thickness.
    #[must_use]
    pub fn triangle(a: Vec_<D>, b: Vec_<D>, c: Vec_<D>) -> Self {
        Self::new(bevy_impinge::Collider::triangle(a, b, c))
    }

    /// The points within `radius` of a segment of `length` along the y axis, with its middle at the origin.
    #[must_use]
    pub fn capsule(radius: f32, length: f32) -> Self {
        Self::new(bevy_impinge::Collider::capsule(radius, length))
    }

    /// The points within `radius` of a segment.
    #[must_use]
    pub fn capsule_endpoints(radius: f32, a: Vec_<D>, b: Vec_<D>) -> Self {
        Self::new(bevy_impinge::Collider::capsule_between(a, b, radius))
    }

    /// Segments between pairs of vertices; without indices from each vertex to the next.
    #[must_use]
    pub fn polyline(vertices: Vec<Vec_<D>>, indices: Option<Vec<[u32; 2]>>) -> Self {
        let vertices = points(vertices);
        Self::of(match indices {
            Some(indices) => Polyline::try_new(vertices, indices),
            None => Polyline::try_open(vertices),
        })
    }

    /// Triangles of three indices each: in 2D an area, in 3D a surface. Shapes slide over its inner edges without
    /// a bump.
    #[must_use]
    pub fn trimesh(vertices: Vec<Vec_<D>>, indices: Vec<[u32; 3]>) -> Self {
        Self::of(TriMesh::try_new(points(vertices), indices))
    }

    /// [`Self::trimesh`], if the vertices and indices make one.
    ///
    /// # Errors
    /// If a vertex is not finite, or an index names none.
    pub fn try_trimesh(
        vertices: Vec<Vec_<D>>,
        indices: Vec<[u32; 3]>,
    ) -> Result<Self, ColliderError> {
        let collider = Self::trimesh(vertices, indices);
        collider.error().map_or(Ok(collider), Err)
    }

    /// All points within `radius` of this convex shape: corners and edges become round.
    #[must_use]
    pub fn rounded(self, radius: f32) -> Self {
        let rounded = |shape| Ok(Rounded::try_from_handle(shape, radius)?);
        Self::of::<_, ColliderError>(self.scaled.and_then(rounded))
    }

    /// Colliders side by side, each at its pose in the frame of the whole, with the scale that it has now.
    pub(crate) fn side_by_side(children: impl IntoIterator<Item = (Isometry<D>, Self)>) -> Self {
        let placed = |(pose, child): (_, Self)| Ok((pose, child.scaled?));
        let children: Result<Vec<_>, ColliderError> = children.into_iter().map(placed).collect();
        Self::of::<_, ColliderError>(children.and_then(|children| Ok(Compound::try_new(children)?)))
    }

    /// The corners of the box around the shape at a pose; a collider in error has a box of size zero there. Avian asserts
    /// that `min <= max`, so NaN is replaced and infinity clamped.
    pub(crate) fn corners(&self, pose: &Isometry<D>) -> [Vec_<D>; 2] {
        let known = |x: f32| if x.is_nan() { 0.0 } else { x.clamp(-FAR, FAR) };
        let at = f32::translation(pose).map(known);
        let Ok(shape) = &self.scaled else { return [f32::vec(&at); 2] };
        let around = shape.aabb(&f32::pose(pose));
        let near = |x: f32, at: f32| if x.is_nan() { at } else { known(x) };
        [around.mins(), around.maxs()].map(|corner| f32::vec(&corner.coords.zip_map(&at, near)))
    }

    /// Mass, centre and inertia at a density; zero for a collider in error and for a shape without volume.
    pub(crate) fn weighed(&self, density: f32) -> MassProperties<f32, D> {
        let Ok(shape) = &self.scaled else { return MassProperties::default() };
        mass_properties(&**shape, density).unwrap_or_default()
    }

    /// Mass, centre and inertia for a total mass of 1; zero if the shape has no mass.
    pub(crate) fn weighed_as_one(&self) -> MassProperties<f32, D> {
        let whole = self.weighed(1.0);
        if whole.mass() > 0.0 { whole.with_mass(1.0).unwrap_or_default() } else { whole }
    }
}

/// Subdivisions of an approximation; Avian's own default.
const DETAIL: u32 = 10;

pub(crate) fn points<const D: usize>(vertices: Vec<Vec_<D>>) -> Vec<Point<f32, D>>
where
    f32: Dimension<D>,
{
    vertices.into_iter().map(|vertex| Point::from(f32::vector(vertex))).collect()
}
