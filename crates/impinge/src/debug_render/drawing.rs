//! The cache of shape meshes, and common drawing helpers.

use core::fmt;
use std::collections::BTreeMap;

use super::{Color, DebugOptions, DebugRender, Drawn, ShapeMesh, Style};
use crate::bounding_volume::Aabb;
use crate::math::{Point, Real, Space, Vector};
use crate::narrow_phase::CollisionObjectHandle;
use crate::shape::ShapeHandle;

/// A function that returns the colour of an object; `None` selects the colour of the style.
type ObjectColor = dyn Fn(CollisionObjectHandle) -> Option<Color> + Send + Sync;

/// The front end of debug drawing: draws worlds, shapes and queries with a back end, and caches the
/// meshes of the shapes.
///
/// The mesh of each shape is built when the shape is first drawn. It is shared by all handles of
/// the shape, and [`Self::world`] removes it after all other handles have been dropped. Positions
/// are world coordinates. Objects are drawn in the order of their handles, so equal worlds give
/// equal pictures. Boxes, rays and hits with a coordinate that is not finite, such as the box of a
/// half-space, are not drawn. This type does not begin or end the frames of a back end, since a
/// frame may contain several drawings.
///
/// ```
/// use impinge::debug_render::{Color, DebugDrawing, DebugOptions, DebugRender, Drawn};
/// use impinge::dim2::prelude::*;
///
/// /// Keeps the ends of all lines of contacts.
/// struct Normals(Vec<[Point<f32>; 2]>);
///
/// impl DebugRender<f32, 2> for Normals {
///     fn line(&mut self, ends: [Point<f32>; 2], _: Color, what: Drawn) {
///         self.0.extend((what == Drawn::ContactNormal).then_some(ends));
///     }
/// }
///
/// let mut world = CollisionWorld::new(0.02_f32);
/// let ball = ShapeHandle::new(Ball::new(1.0));
/// for x in [0.0, 1.5] {
///     let at = Isometry::translation(x, 0.0);
///     world.add(at, ball.clone(), CollisionGroups::new(), ContactQuery::default(), ());
/// }
/// world.update();
/// let (mut drawing, mut normals) = (DebugDrawing::new(DebugOptions::all()), Normals(Vec::new()));
/// drawing.world(&world, &mut normals);
/// let depth = [Point::new(1.0, 0.0), Point::new(0.5, 0.0)];
/// assert!(normals.0.contains(&depth), "from a ball to the other: {:?}", normals.0);
/// ```
pub struct DebugDrawing<N: Space<D>, const D: usize> {
    pub(super) options: DebugOptions<N>,
    object_color: Option<Box<ObjectColor>>,
    /// The meshes, by the address of the shape, which is stable while the handle is kept.
    meshes: BTreeMap<usize, KeptMesh<N, D>>,
}

/// The cached mesh of a shape, with a handle that keeps the shape alive.
struct KeptMesh<N: Real, const D: usize> {
    shape: ShapeHandle<N, D>,
    mesh: ShapeMesh<N, D>,
}

impl<N: Space<D>, const D: usize> fmt::Debug for DebugDrawing<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("DebugDrawing")
            .field("options", &self.options)
            .field("num_meshes", &self.meshes.len())
            .finish_non_exhaustive()
    }
}

impl<N: Space<D>, const D: usize> Default for DebugDrawing<N, D> {
    fn default() -> Self {
        Self::new(DebugOptions::default())
    }
}

impl<N: Space<D>, const D: usize> DebugDrawing<N, D> {
    /// Creates a drawing with these options and without cached meshes.
    #[must_use]
    pub fn new(options: DebugOptions<N>) -> Self {
        Self { options, object_color: None, meshes: BTreeMap::new() }
    }

    /// Returns the drawing with the function `color`, which returns the colour of an object from
    /// its handle. If `color` returns `None`, the object has the colour of the style.
    ///
    /// ```
    /// use impinge::debug_render::{Color, DebugDrawing, DebugOptions};
    ///
    /// let even = Color::rgb(0, 128, 255);
    /// let drawing = DebugDrawing::<f32, 3>::new(DebugOptions::default())
    ///     .with_object_color(move |handle| (handle.uid() % 2 == 0).then_some(even));
    /// assert!(drawing.options().object.is_some(), "else nothing is coloured");
    /// ```
    #[must_use]
    pub fn with_object_color<F>(self, color: F) -> Self
    where
        F: Fn(CollisionObjectHandle) -> Option<Color> + Send + Sync + 'static,
    {
        Self { object_color: Some(Box::new(color)), ..self }
    }

    /// Returns the options.
    #[must_use]
    pub const fn options(&self) -> &DebugOptions<N> {
        &self.options
    }

    /// Replaces the options. Clears the cached meshes if [`DebugOptions::mesh`] changes.
    pub fn set_options(&mut self, options: DebugOptions<N>) {
        if self.options.mesh != options.mesh {
            self.meshes.clear();
        }
        self.options = options;
    }

    /// Returns the mesh of a shape, which is built on the first call; see [`ShapeMesh::of`].
    pub fn mesh(&mut self, shape: &ShapeHandle<N, D>) -> &ShapeMesh<N, D> {
        let options = self.options.mesh;
        let address = core::ptr::from_ref(&**shape).addr();
        let make = || KeptMesh { shape: shape.clone(), mesh: ShapeMesh::of(&**shape, &options) };
        &self.meshes.entry(address).or_insert_with(make).mesh
    }

    /// Removes the meshes of shapes that have no other handle.
    pub(super) fn forget_dropped(&mut self) {
        self.meshes.retain(|_, kept| !kept.shape.is_sole());
    }

    /// Returns the style of an object; `None` if objects are not drawn.
    pub(super) fn object_style(&self, handle: CollisionObjectHandle) -> Option<Style<N>> {
        let style = self.options.object?;
        let own = self.object_color.as_ref().and_then(|color| color(handle));
        Some(Style { color: own.unwrap_or(style.color), ..style })
    }

    /// Draws a shape at a position in the style of objects.
    ///
    /// ```
    /// use impinge::debug_render::{Color, DebugDrawing, DebugRender, Drawn};
    /// use impinge::dim2::prelude::*;
    ///
    /// struct Length(f64);
    ///
    /// impl DebugRender<f64, 2> for Length {
    ///     fn line(&mut self, [a, b]: [Point<f64>; 2], _: Color, _: Drawn) {
    ///         self.0 += (b - a).norm();
    ///     }
    /// }
    ///
    /// let square = ShapeHandle::new(Cuboid::new(Vector::new(1.0, 1.0)));
    /// let (mut drawing, mut length) = (DebugDrawing::default(), Length(0.0));
    /// drawing.shape(&square, &Isometry::translation(3.0, 4.0), &mut length);
    /// assert_eq!(length.0, 8.0, "the circumference");
    /// ```
    pub fn shape(
        &mut self,
        shape: &ShapeHandle<N, D>,
        position: &N::Isometry,
        renderer: &mut dyn DebugRender<N, D>,
    ) {
        if let Some(style) = self.options.object
            && N::pose(position).is_finite()
        {
            renderer.mesh(self.mesh(shape), position, style.color, Drawn::Object);
        }
    }
}

/// Draws the edges of a box; nothing if a coordinate is not finite.
pub(super) fn draw_box<N: Space<D>, const D: usize>(
    aabb: &Aabb<N, D>,
    style: &Style<N>,
    what: Drawn,
    renderer: &mut dyn DebugRender<N, D>,
) {
    if !are_finite([aabb.mins(), aabb.maxs()]) {
        return;
    }
    // Bit `axis` of a corner's index selects the maximum on that axis.
    let corner = |number: usize| {
        let at = |axis, _| {
            let side = if number >> axis & 1 == 0 { aabb.mins() } else { aabb.maxs() };
            side[axis]
        };
        Point::from(Vector::<N, D>::from_fn(at))
    };
    for axis in 0..D {
        for start in (0..1 << D).filter(|start| start >> axis & 1 == 0) {
            renderer.line([corner(start), corner(start | 1 << axis)], style.color, what);
        }
    }
}

/// Returns whether all coordinates of two points are finite.
pub(super) fn are_finite<N: Real, const D: usize>(points: [&Point<N, D>; 2]) -> bool {
    points.into_iter().flat_map(Point::iter).all(|x| x.is_finite_number())
}
