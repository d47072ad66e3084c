//! The collider component.

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

/// The shape of an entity, for Avian's plugins. It replaces Avian's own `Collider`, which has
/// shapes of parry.
///
/// Cloning is cheap and shares the shape. [`d2`](crate::d2) and [`d3`](crate::d3) name the type
/// with its dimension, and have the constructors that exist in one dimension only.
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
    /// The shape with the scale applied.
    scaled: Result<ShapeHandle<f32, D>, ColliderError>,
    scale: Vec_<D>,
    /// The scale that was refused last. Avian asks for it again in each step of a moving body.
    refused: Option<Vec_<D>>,
}

impl<const D: usize> Collider<D>
where
    f32: Dimension<D>,
{
    /// Creates a collider of a solid of `bevy_math`, or of another value that converts to a
    /// collider of `bevy_impinge`.
    #[must_use]
    pub fn new(shape: impl Into<bevy_impinge::Collider<D>>) -> Self {
        Self::made(shape.into().shape().cloned())
    }

    /// Creates a collider of any shape of the library, or of one of your own.
    #[must_use]
    pub fn from_shape<S: Shape<f32, D>>(shape: S) -> Self {
        Self::made(Ok(ShapeHandle::new(shape)))
    }

    /// Creates a collider of a shared shape.
    #[must_use]
    pub fn from_handle(shape: ShapeHandle<f32, D>) -> Self {
        Self::made(Ok(shape))
    }

    pub(crate) fn made(shape: Result<ShapeHandle<f32, D>, ColliderError>) -> Self {
        let scale = f32::vec(&Vector::<f32, D>::repeat(1.0));
        Self { scaled: shape.clone(), shape, scale, refused: None }
    }

    /// Converts the result of a constructor of the library to a collider, which has the shape or
    /// the error.
    pub(crate) fn of<S: Shape<f32, D>, E: Into<ColliderError>>(shape: Result<S, E>) -> Self {
        Self::made(shape.map(ShapeHandle::new).map_err(Into::into))
    }

    /// Returns the error if a constructor of the library rejected its arguments; `None` if there is
    /// a shape.
    #[must_use]
    pub fn error(&self) -> Option<ColliderError> {
        self.shape.as_ref().err().copied()
    }

    /// Returns the library's shape, without the scale of the transform.
    ///
    /// # Errors
    /// See [`Self::error`].
    pub fn shape(&self) -> Result<&ShapeHandle<f32, D>, ColliderError> {
        self.shape.as_ref().map_err(|error| *error)
    }

    /// Returns the library's shape, with the scale of the transform.
    ///
    /// # Errors
    /// See [`Self::error`].
    pub fn shape_scaled(&self) -> Result<&ShapeHandle<f32, D>, ColliderError> {
        self.scaled.as_ref().map_err(|error| *error)
    }

    /// Replaces the shape, and applies the current scale to the new one.
    pub fn set_shape(&mut self, shape: ShapeHandle<f32, D>) {
        let scale = self.scale;
        *self = Self::made(Ok(shape));
        self.rescale(scale, DETAIL);
    }

    /// Returns the scale factors of the shape along the local axes.
    #[must_use]
    pub fn scale(&self) -> Vec_<D> {
        self.scale
    }

    /// Replaces the scale; see [`scaled`]. If the shape cannot be scaled by these factors, keeps the
    /// old scale and logs an error, once while the same factors are asked for. A collider with an
    /// error is unchanged.
    pub(crate) fn rescale(&mut self, scale: Vec_<D>, detail: u32) {
        let Ok(shape) = &self.shape else { return };
        let bits = |scale| f32::vector(scale).map(f32::to_bits);
        if scale == self.scale || self.refused.is_some_and(|refused| bits(refused) == bits(scale)) {
            return;
        }
        match scaled(shape, &f32::vector(scale), detail) {
            Ok(shape) => (self.scaled, self.scale, self.refused) = (Ok(shape), scale, None),
            Err(error) => {
                self.refused = Some(scale);
                log::error!("a collider keeps its scale: {error}");
            }
        }
    }

    /// Creates the segment between two points.
    #[must_use]
    pub fn segment(a: Vec_<D>, b: Vec_<D>) -> Self {
        Self::new(bevy_impinge::Collider::segment(a, b))
    }

    /// Creates a filled triangle; in 3D it has no thickness.
    #[must_use]
    pub fn triangle(a: Vec_<D>, b: Vec_<D>, c: Vec_<D>) -> Self {
        Self::new(bevy_impinge::Collider::triangle(a, b, c))
    }

    /// Creates a capsule: the points within `radius` of a segment of `length` along the y axis,
    /// centred at the origin.
    #[must_use]
    pub fn capsule(radius: f32, length: f32) -> Self {
        Self::new(bevy_impinge::Collider::capsule(radius, length))
    }

    /// Creates a capsule: the points within `radius` of the segment from `a` to `b`.
    #[must_use]
    pub fn capsule_endpoints(radius: f32, a: Vec_<D>, b: Vec_<D>) -> Self {
        Self::new(bevy_impinge::Collider::capsule_between(a, b, radius))
    }

    /// Creates segments between pairs of vertices; without `indices`, from each vertex to the next.
    #[must_use]
    pub fn polyline(vertices: Vec<Vec_<D>>, indices: Option<Vec<[u32; 2]>>) -> Self {
        let vertices = points(vertices);
        Self::of(match indices {
            Some(indices) => Polyline::try_new(vertices, indices),
            None => Polyline::try_open(vertices),
        })
    }

    /// Creates a mesh with three indices per triangle: in 2D an area, in 3D a surface. Shapes slide
    /// over its inner edges without bumps.
    #[must_use]
    pub fn trimesh(vertices: Vec<Vec_<D>>, indices: Vec<[u32; 3]>) -> Self {
        Self::of(TriMesh::try_new(points(vertices), indices))
    }

    /// Creates the mesh of [`Self::trimesh`], if the vertices and indices are valid.
    ///
    /// # Errors
    /// If a vertex is not finite, or an index has no vertex.
    pub fn try_trimesh(
        vertices: Vec<Vec_<D>>,
        indices: Vec<[u32; 3]>,
    ) -> Result<Self, ColliderError> {
        let collider = Self::trimesh(vertices, indices);
        collider.error().map_or(Ok(collider), Err)
    }

    /// Returns all points within `radius` of this convex shape: corners and edges become round.
    #[must_use]
    pub fn rounded(self, radius: f32) -> Self {
        let rounded = |shape| Ok(Rounded::try_from_handle(shape, radius)?);
        Self::of::<_, ColliderError>(self.scaled.and_then(rounded))
    }

    /// Creates a compound of colliders with their current scales, each at its pose in the frame of
    /// the compound.
    pub(crate) fn side_by_side(children: impl IntoIterator<Item = (Isometry<D>, Self)>) -> Self {
        let placed = |(pose, child): (_, Self)| Ok((pose, child.scaled?));
        let children: Result<Vec<_>, ColliderError> = children.into_iter().map(placed).collect();
        Self::of::<_, ColliderError>(children.and_then(|children| Ok(Compound::try_new(children)?)))
    }

    /// Returns the corners of the box around the shape at a pose. A collider with an error has a
    /// box of size zero at the position. Avian asserts that `min <= max`; therefore NaN is replaced
    /// by the position, and infinities are clamped.
    pub(crate) fn corners(&self, pose: &Isometry<D>) -> [Vec_<D>; 2] {
        let known = |x: f32| if x.is_nan() { 0.0 } else { x.clamp(-FAR, FAR) };
        let at = f32::translation(pose).map(known);
        let Ok(shape) = &self.scaled else { return [f32::vec(&at); 2] };
        let around = shape.aabb(&f32::pose(pose));
        let near = |x: f32, at: f32| if x.is_nan() { at } else { known(x) };
        [around.mins(), around.maxs()].map(|corner| f32::vec(&corner.coords.zip_map(&at, near)))
    }

    /// Returns mass, centre and inertia at a density; zero for a collider with an error and for a
    /// shape without volume.
    pub(crate) fn weighed(&self, density: f32) -> MassProperties<f32, D> {
        let Ok(shape) = &self.scaled else { return MassProperties::default() };
        mass_properties(&**shape, density).unwrap_or_default()
    }

    /// Returns mass, centre and inertia for a total mass of 1; zero if the shape has no mass.
    pub(crate) fn weighed_as_one(&self) -> MassProperties<f32, D> {
        let whole = self.weighed(1.0);
        if whole.mass() > 0.0 { whole.with_mass(1.0).unwrap_or_default() } else { whole }
    }
}

/// The number of subdivisions of an approximation, which is Avian's default.
const DETAIL: u32 = 10;

pub(crate) fn points<const D: usize>(vertices: Vec<Vec_<D>>) -> Vec<Point<f32, D>>
where
    f32: Dimension<D>,
{
    vertices.into_iter().map(|vertex| Point::from(f32::vector(vertex))).collect()
}
