//! Shapes made of parts: the interface of composites to the queries.
//!
//! Parts are numbered from 0; those of nested composites follow each other, so that one number
//! identifies a part at any depth, and `path_to_part` on `dyn Shape` converts it to a path.
//! Algorithms never treat a composite as a whole: they search for the parts that may matter
//! ([`PartSearch`]) and treat each as a solid of its own.

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

/// The path to a part: the index of the child, of its child, …, of the part in the last.
pub type PartPath = SmallVec<[u32; 4]>;

/// A shape that is the union of simple solids, its parts.
///
/// Implement it, and [`Shape::geometry`] by [`Geometry::composite`], for a composite of your own: keep
/// a [`BoxTree`](crate::partitioning::BoxTree) over the boxes of the parts and give it as the search.
/// All is in the frame of the composite.
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
    /// How many parts there are; they are numbered from 0.
    fn num_parts(&self) -> u32;

    /// Returns one part: a solid that is not a composite, and its pose.
    ///
    /// # Panics
    /// If there is no such part.
    fn part(&self, part: u32) -> Part<'_, N, D>;

    /// The search structure over the parts.
    fn search(&self) -> &dyn PartSearch<N, D>;

    /// Calls `visit` with each part that a ray may hit at or before the time `limit`, and its
    /// number: every part that it hits, each at most once. `visit` returns the new limit, which
    /// never grows; a negative one ends the search. Near parts first is better, but no order is
    /// promised.
    ///
    /// `around` is a box around the ray's origin that contains its rounding error. The default uses
    /// [`Self::search`]; a composite with a sharper test than boxes may override it.
    fn parts_along(
        &self,
        ray: &Ray<N, D>,
        around: &Aabb<N, D>,
        limit: N,
        visit: &mut dyn FnMut(u32, Part<'_, N, D>) -> N,
    ) {
        self.search().cast(around, &ray.dir, limit, &mut |part, _| visit(part, self.part(part)));
    }

    /// The surface that the parts are pieces of, so that contacts do not catch on the seams between
    /// them. `None` for solids side by side.
    fn surface(&self) -> Option<&dyn Surface<N, D>> {
        None
    }

    /// The surface as the library's algorithms see it; the library's own composites provide more of
    /// it.
    #[doc(hidden)]
    fn surface_access(&self) -> Option<SurfaceAccess<'_, N, D>> {
        self.surface().map(SurfaceAccess::of_any)
    }

    /// Calls `visit` with the number of each corner of a part that other parts may share: two parts
    /// are adjacent if they have a number in common, which need not be a vertex index. The default
    /// visits none, for solids side by side.
    ///
    /// In a triangle mesh or polyline the numbers are its vertices, with coinciding positions
    /// merged; in a height field the points of its grid; in a compound those of its children, kept
    /// apart as long as they are below 2³².
    fn each_corner(&self, part: u32, visit: &mut dyn FnMut(u64)) {
        let _ = (part, visit);
    }

    /// Whether two different parts share a corner, so that they touch trivially: such pairs are
    /// skipped when the shape is tested against itself. The default uses [`Self::each_corner`].
    fn are_adjacent(&self, part1: u32, part2: u32) -> bool {
        let (mut corners, mut is_shared) = (SmallVec::<[u64; 4]>::new(), false);
        self.each_corner(part1, &mut |corner| corners.push(corner));
        self.each_corner(part2, &mut |corner| is_shared |= corners.contains(&corner));
        is_shared
    }

    /// Appends the path to a part.
    fn extend_path(&self, part: u32, path: &mut PartPath) {
        path.push(part);
    }

    /// The composite as a shape of the library, which can compute what it encloses; `None` for a
    /// user's composite.
    #[doc(hidden)]
    fn built_in(&self) -> Option<&dyn Shape<N, D>> {
        None
    }

    /// The composite as a mesh, if it is one.
    #[doc(hidden)]
    fn as_mesh(&self) -> Option<&TriMesh<N, D>> {
        None
    }

    /// The cache key of the composite's state; `None` for a user's composite, which may change
    /// unnoticed.
    #[doc(hidden)]
    fn revision(&self) -> Option<Revision> {
        None
    }

    /// Calls `visit` with each closed surface among the parts that bounds an [`EnclosedBody`].
    #[doc(hidden)]
    fn each_body(&self, visit: &mut dyn FnMut(&EnclosedBody<'_, N, D>)) {
        let _ = visit;
    }

    /// Whether [`Self::each_body`] visits any. O(1).
    #[doc(hidden)]
    fn has_bodies(&self) -> bool {
        false
    }

    /// Whether the composite, as a boundary, winds around a point; either result is allowed for a
    /// point on a part.
    #[doc(hidden)]
    fn winds_around(&self, point: &Point<N, D>) -> bool {
        let _ = point;
        false
    }

    /// The number of the connected piece that a part belongs to. By default a surface is one piece,
    /// and each of the solids side by side is one.
    #[doc(hidden)]
    fn piece_of(&self, part: u32) -> u32 {
        if self.surface().is_some() { 0 } else { part }
    }
}

/// One of the solids that a composite is made of.
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
    /// Its pose in the frame of the composite.
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
    /// The part as a shape.
    #[must_use]
    pub fn as_shape(&self) -> &dyn Shape<N, D> {
        match self {
            Self::Triangle(triangle) => triangle,
            Self::Segment(segment) => segment,
            Self::Shape(shape) => *shape,
        }
    }

    /// How queries see the part.
    #[must_use]
    pub fn geometry(&self) -> Geometry<'_, N, D> {
        self.as_shape().geometry()
    }
}

/// Searches of the parts of a composite by their boxes.
///
/// A box may be larger than its part: callers test each proposed part. Each part is proposed at
/// most once; near ones first is better, but no order is promised. Input that is not finite finds
/// nothing, except for the infinite faces of an unbounded box.
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
    /// A box around all parts, as small as is cheap: every query reads it.
    ///
    /// The default is unbounded, which is always right; two composites are then tested part by part
    /// of the smaller one, however far apart they are.
    fn bounds(&self) -> Aabb<N, D> {
        Aabb::unbounded()
    }

    /// The tree behind the search, if its boxes are those of the parts in the order of their
    /// numbers. Two composites with a tree each are searched together, which is many times as fast
    /// as part by part. `None` (the default) for every search but [`BoxTree`].
    fn as_tree(&self) -> Option<&BoxTree<N, D>> {
        None
    }

    /// Calls `visit` with each part whose box overlaps or touches `aabb`.
    fn overlapping(&self, aabb: &Aabb<N, D>, visit: &mut dyn FnMut(u32));

    /// Calls `visit` with each part whose box is at most `limit` from `aabb`, and a lower bound of
    /// that distance. `visit` returns the new limit, which never grows: the distance of the nearest
    /// part so far, to find the nearest. A negative one ends the search.
    fn nearest(&self, aabb: &Aabb<N, D>, limit: N, visit: &mut dyn FnMut(u32, N) -> N);

    /// Calls `visit` with each part whose box is hit, at or before the time `limit`, by `aabb`
    /// moving with `velocity`, and a lower bound of the time. `visit` returns the new limit, as for
    /// [`Self::nearest`]. A ray is a box without extent.
    fn cast(
        &self,
        aabb: &Aabb<N, D>,
        velocity: &Vector<N, D>,
        limit: N,
        visit: &mut dyn FnMut(u32, N) -> N,
    );
}

/// The normals that parts have as pieces of one surface, so that solids slide over seams.
///
/// On their own, the triangles of a floor have edges that a sliding box would catch on. All is in
/// the frame of the composite.
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
    /// Whether the whole surface has the unit vector `normal`, away from the part, at the feature
    /// of the part: at a face its own normal; at a convex seam a normal between those of the two
    /// faces; at a flat or concave seam only the normals of the faces. Within a tolerance for
    /// rounding.
    fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<N, D>) -> bool;

    /// Returns the normal of the whole surface on the part that replaces `normal`, which
    /// [`Self::admits`] rejected: the face's, on the side of `normal` if the surface has two sides.
    /// `None` if the part is no border of the surface, such as a piece inside a filled shape.
    fn snapped(&self, part: u32, normal: &Vector<N, D>) -> Option<Vector<N, D>>;

    /// Whether the part can touch a solid whose centre is `center`: false behind a surface with one
    /// side.
    fn faces(&self, part: u32, center: &Point<N, D>) -> bool;
}
