//! Shapes made of parts: the interface between composites and queries.
//!
//! Parts are indexed from 0. The parts of nested composites are numbered consecutively, so that one
//! index identifies a part at any depth; `path_to_part` on `dyn Shape` converts an index to a path.
//! A query of a composite with another shape searches for candidate parts ([`PartSearch`]) and
//! processes each as a separate solid.

pub(crate) mod body;
pub(crate) mod compound;
pub(crate) mod compound_search;
pub(crate) mod height_field;
pub(crate) mod joints;
pub(crate) mod mesh_error;
pub(crate) mod part_search;
pub(crate) mod polyline;
pub(crate) mod polyline_parts;
pub(crate) mod tri_mesh;

use smallvec::SmallVec;

use crate::bounding_volume::{Aabb, Ray};
use crate::math::{Point, Pose, Real, Vector};
use crate::partitioning::BoxTree;
use crate::shape::{
    EnclosedBody, FeatureId, Geometry, Revision, Segment, Shape, SurfaceAccess, TriMesh, Triangle,
};

/// The path to a part: the index of the child, then of the child's child, …, and last the index of
/// the part in the innermost composite.
pub type PartPath = SmallVec<[u32; 4]>;

/// A shape that is the union of simple solids, its parts.
///
/// To define your own composite, implement this trait, and [`Shape::geometry`] by
/// [`Geometry::composite`]. Keep a [`BoxTree`](crate::partitioning::BoxTree) over the boxes of the
/// parts and return it as the search. All coordinates are in the frame of the composite.
///
/// ```
/// use impinge::dim2::math::Point;
/// use impinge::dim2::shape::{CompositeShape, PartSolid, Polyline};
///
/// let line: Polyline<f32> = Polyline::open([0.0, 1.0, 2.0].map(|x| Point::new(x, 0.0)).to_vec());
/// assert_eq!(line.num_parts(), 2);
/// let PartSolid::Segment(last) = line.part(1).solid else { panic!("parts are segments") };
/// assert_eq!(last.b().x, 2.0);
/// assert!(line.are_adjacent(0, 1));
/// ```
#[diagnostic::on_unimplemented(
    message = "`{Self}` is not made of parts in {D} dimensions with the scalar `{N}`",
    label = "not a `CompositeShape<{N}, {D}>`",
    note = "composites are `TriMesh`, `Polyline`, `HeightField`, `Compound`, and types of your own that implement \
            `CompositeShape`"
)]
pub trait CompositeShape<N: Real, const D: usize>: Send + Sync {
    /// Returns the number of parts; their indices start at 0.
    fn num_parts(&self) -> u32;

    /// Returns one part: a solid that is not a composite, and its pose in the frame of the
    /// composite.
    ///
    /// # Panics
    /// If `part` is not below [`Self::num_parts`].
    fn part(&self, part: u32) -> Part<'_, N, D>;

    /// Returns the search structure over the parts.
    fn search(&self) -> &dyn PartSearch<N, D>;

    /// Calls `visit` with the index and the geometry of each part that the ray may hit at a time up
    /// to `limit`, inclusive. Every part that the ray hits must be visited, each part at most once.
    /// `visit` returns the new limit, which never grows; a negative limit ends the search. Visiting
    /// near parts first is faster, but no order is required.
    ///
    /// `around` is a box that contains the ray's origin with its rounding error. The default uses
    /// [`Self::search`]; override it in a composite whose test is tighter than boxes.
    fn parts_along(
        &self,
        ray: &Ray<N, D>,
        around: &Aabb<N, D>,
        limit: N,
        visit: &mut dyn FnMut(u32, Part<'_, N, D>) -> N,
    ) {
        self.search().cast(around, &ray.dir, limit, &mut |part, _| visit(part, self.part(part)));
    }

    /// Returns the surface that the parts form, so that contacts do not catch on the seams between
    /// parts. `None` if the parts are separate solids.
    fn surface(&self) -> Option<&dyn Surface<N, D>> {
        None
    }

    /// Returns the surface with the methods that the library's own composites implement in addition
    /// to [`Surface`]; `None` if [`Self::surface`] returns `None`.
    #[doc(hidden)]
    fn surface_access(&self) -> Option<SurfaceAccess<'_, N, D>> {
        self.surface().map(SurfaceAccess::of_any)
    }

    /// Calls `visit` with a number for each corner of a part that other parts may share. Two parts
    /// are adjacent if they have a number in common; the number need not be a vertex index. The
    /// default visits none, for separate solids.
    ///
    /// In a triangle mesh or polyline the numbers are vertex indices, with coinciding positions
    /// merged. In a height field they are the indices of grid points. A compound adds a multiple of
    /// 2³² to the numbers of each child, so the numbers of different children differ if the
    /// children use numbers below 2³².
    fn each_corner(&self, part: u32, visit: &mut dyn FnMut(u64)) {
        let _ = (part, visit);
    }

    /// Returns whether two different parts share a corner and therefore always touch. Tests of a
    /// shape against itself skip such pairs. The default uses [`Self::each_corner`].
    fn are_adjacent(&self, part1: u32, part2: u32) -> bool {
        let (mut corners, mut is_shared) = (SmallVec::<[u64; 4]>::new(), false);
        self.each_corner(part1, &mut |corner| corners.push(corner));
        self.each_corner(part2, &mut |corner| is_shared |= corners.contains(&corner));
        is_shared
    }

    /// Appends to `path` the indices that lead to a part.
    fn extend_path(&self, part: u32, path: &mut PartPath) {
        path.push(part);
    }

    /// Returns the composite as a built-in shape, for algorithms that have a method of their own
    /// for it, such as mass properties. `None` for a user's composite.
    #[doc(hidden)]
    fn built_in(&self) -> Option<&dyn Shape<N, D>> {
        None
    }

    /// Returns the composite as a triangle mesh; `None` if the composite is of another type.
    #[doc(hidden)]
    fn as_mesh(&self) -> Option<&TriMesh<N, D>> {
        None
    }

    /// Returns the cache key of the composite's state; `None` for a user's composite, which may
    /// change without notice.
    #[doc(hidden)]
    fn revision(&self) -> Option<Revision> {
        None
    }

    /// Calls `visit` with an [`EnclosedBody`] for each solid region that parts of the composite
    /// enclose as a closed surface.
    #[doc(hidden)]
    fn each_body(&self, visit: &mut dyn FnMut(&EnclosedBody<'_, N, D>)) {
        let _ = visit;
    }

    /// Returns whether [`Self::each_body`] calls `visit` at least once. O(1).
    #[doc(hidden)]
    fn has_bodies(&self) -> bool {
        false
    }

    /// Returns whether the composite has ghosts: parts that continue the surface across seams, but
    /// that no query finds. O(1).
    #[doc(hidden)]
    fn has_ghosts(&self) -> bool {
        false
    }

    /// Returns whether the composite, as a closed boundary, winds around `point`. For a point on a
    /// part either result is allowed.
    #[doc(hidden)]
    fn winds_around(&self, point: &Point<N, D>) -> bool {
        let _ = point;
        false
    }

    /// Returns the index of the connected piece that a part belongs to. By default a surface is one
    /// piece, and each separate solid is a piece of its own.
    #[doc(hidden)]
    fn piece_of(&self, part: u32) -> u32 {
        if self.surface().is_some() { 0 } else { part }
    }
}

/// A part of a composite: a convex solid or a half-space, and its pose.
///
/// ```
/// use impinge::dim3::math::Isometry;
/// use impinge::dim3::shape::{Ball, CompositeShape, Compound, ShapeHandle};
///
/// let ball = ShapeHandle::new(Ball::new(0.5_f32));
/// let pair = Compound::new([-1.0, 1.0].map(|x| (Isometry::translation(x, 0.0, 0.0), ball.clone())).to_vec());
/// let part = pair.part(1);
/// assert_eq!(part.pose.translation.x, 1.0);
/// assert_eq!(part.solid.as_shape().local_aabb().maxs().x, 0.5, "in its own frame");
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Part<'a, N: Real, const D: usize> {
    /// The pose of the solid in the frame of the composite.
    pub pose: Pose<N, D>,
    /// The solid, in its own frame.
    pub solid: PartSolid<'a, N, D>,
}

/// The solid of a part: made on the fly, or stored in the composite.
///
/// ```
/// use impinge::dim3::math::Point;
/// use impinge::dim3::shape::{CompositeShape, PartSolid, TriMesh};
///
/// let corners = [[0.0, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]].map(Point::<f32>::from);
/// let mesh = TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]);
/// let PartSolid::Triangle(triangle) = mesh.part(0).solid else { panic!("parts are triangles") };
/// assert_eq!(triangle.corners(), &corners);
/// ```
#[derive(Clone, Copy, Debug)]
pub enum PartSolid<'a, N: Real, const D: usize> {
    /// A triangle.
    Triangle(Triangle<N, D>),
    /// A segment.
    Segment(Segment<N, D>),
    /// Any solid that is not a composite.
    Shape(&'a dyn Shape<N, D>),
}

impl<N: Real, const D: usize> PartSolid<'_, N, D> {
    /// Returns the solid as a shape.
    #[must_use]
    pub fn as_shape(&self) -> &dyn Shape<N, D> {
        match self {
            Self::Triangle(triangle) => triangle,
            Self::Segment(segment) => segment,
            Self::Shape(shape) => *shape,
        }
    }

    /// Returns the kind of the solid on which queries dispatch, with a reference to the solid.
    #[must_use]
    pub fn geometry(&self) -> Geometry<'_, N, D> {
        self.as_shape().geometry()
    }
}

/// A search structure over the parts of a composite, by their boxes.
///
/// A box may be larger than its part: callers test each reported part. Each part is reported at
/// most once; near parts first is faster, but no order is required. A search with a NaN argument or
/// an infinite velocity reports no parts. Faces of the box, and the limit, may be infinite.
///
/// ```
/// use impinge::dim2::bounding_volume::Aabb;
/// use impinge::dim2::math::{Point, Vector};
/// use impinge::dim2::shape::{CompositeShape, Polyline};
///
/// let line: Polyline<f32> = Polyline::open((0..10).map(|x| Point::new(x as f32, 0.0)).collect());
/// let mut found = Vec::new();
/// let place = Aabb::from_half_extents(Point::new(4.5, 0.0), Vector::repeat(0.25));
/// line.search().overlapping(&place, &mut |part| found.push(part));
/// assert_eq!(found, [4]);
/// ```
pub trait PartSearch<N: Real, const D: usize>: Send + Sync {
    /// Returns a box around all parts, as small as is cheap to compute: every query reads it.
    ///
    /// The default is unbounded, which is always valid. A query of two composites then tests every
    /// part of the smaller one, however far apart the composites are.
    fn bounds(&self) -> Aabb<N, D> {
        Aabb::unbounded()
    }

    /// Returns the tree that implements the search, if each box in the tree has the index of its
    /// part. Two composites with such trees are traversed together, which is much faster than a
    /// search for each part. Every search except [`BoxTree`] returns `None` (the default).
    fn as_tree(&self) -> Option<&BoxTree<N, D>> {
        None
    }

    /// Calls `visit` with each part whose box overlaps or touches `aabb`.
    fn overlapping(&self, aabb: &Aabb<N, D>, visit: &mut dyn FnMut(u32));

    /// Calls `visit` with each part whose box is at most `limit` from `aabb`, and with a lower
    /// bound of that distance. `visit` returns the new limit, which never grows; a search for the
    /// nearest part returns the smallest distance so far. A negative limit ends the search.
    fn nearest(&self, aabb: &Aabb<N, D>, limit: N, visit: &mut dyn FnMut(u32, N) -> N);

    /// Calls `visit` with each part whose box is hit by `aabb`, moving with `velocity`, at a time
    /// up to `limit`, inclusive, and with a lower bound of that time. `visit` returns the new
    /// limit, which never grows; a negative limit ends the search. A ray is a box without extent.
    fn cast(
        &self,
        aabb: &Aabb<N, D>,
        velocity: &Vector<N, D>,
        limit: N,
        visit: &mut dyn FnMut(u32, N) -> N,
    );
}

/// The rule for the contact normals of parts that form one surface. It lets solids slide over the
/// seams between parts.
///
/// Without this rule, the edges between the triangles of a floor would stop a sliding box. All
/// vectors are in the frame of the composite.
///
/// ```
/// use impinge::dim2::math::{Point, Vector};
/// use impinge::dim2::shape::{CompositeShape, FeatureId, Polyline};
///
/// let flat: Polyline<f32> = Polyline::open([0.0, 1.0, 2.0].map(|x| Point::new(x, 0.0)).to_vec());
/// let surface = flat.surface().expect("its segments are one line");
/// let (seam, slanted) = (FeatureId::Vertex(1), Vector::new(0.6, 0.8));
/// assert!(surface.admits(0, seam, &Vector::y()));
/// assert!(!surface.admits(0, seam, &slanted), "there is no corner to catch on");
/// assert_eq!(surface.snapped(0, &slanted), Some(Vector::y()));
/// ```
pub trait Surface<N: Real, const D: usize>: Send + Sync {
    /// Returns whether the whole surface admits `normal`, a unit vector that points away from the
    /// part, at the feature of the part. At a face only the face normal is admitted; at a convex
    /// seam any normal between the two face normals; at a flat or concave seam only the face
    /// normals. The test has a tolerance for rounding.
    fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<N, D>) -> bool;

    /// Returns the normal that replaces `normal`, which [`Self::admits`] rejected: the face normal
    /// of the part, on the side of `normal` if the surface has two sides. `None` if the part has no
    /// normal, such as a triangle without area, or does not lie on the border of the surface, such
    /// as a piece inside a filled shape.
    fn snapped(&self, part: u32, normal: &Vector<N, D>) -> Option<Vector<N, D>>;

    /// Returns whether the part can touch a solid whose centre is `center`. False if the surface is
    /// one-sided and the centre is behind the part.
    fn faces(&self, part: u32, center: &Point<N, D>) -> bool;
}
