//! Shapes made of parts: what a composite offers to the queries.
//!
//! Parts are numbered from 0, those of nested composites in a row, so that one number names a part
//! however deep it lies; `path_to_part` on `dyn Shape` spells it out. Algorithms never see
//! a composite as a whole: they ask for the parts that may matter ([`PartSearch`]) and treat each as
//! a solid of its own.

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

/// The way to a part: the index of the child, of its child, … of the part in the last.
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

    /// One part: a solid, itself not a composite, and where it lies.
    ///
    /// # Panics
    /// If there is no such part.
    fn part(&self, part: u32) -> Part<'_, N, D>;

    /// Where to look for parts.
    fn search(&self) -> &dyn PartSearch<N, D>;

    /// Calls `visit` with the parts that a ray may hit at or before the time `limit`, and their numbers:
    /// none is left out that it hits, and each comes once at most. `visit` returns the new limit, which
    /// never grows; a negative one ends the search. Near parts first is better, but no order is promised.
    ///
    /// `around` is a box around the ray's origin that holds what rounding has made of it. The default
    /// asks [`Self::search`]; a composite that can tell more than by boxes may do so.
    fn parts_along(
        &self,
        ray: &Ray<N, D>,
        around: &Aabb<N, D>,
        limit: N,
        visit: &mut dyn FnMut(u32, Part<'_, N, D>) -> N,
    ) {
        self.search().cast(around, &ray.dir, limit, &mut |part, _| visit(part, self.part(part)));
    }

    /// What holds the parts together, where they are pieces of one surface: so that the seams
    /// between them are not taken for edges. `None` for solids side by side.
    fn surface(&self) -> Option<&dyn Surface<N, D>> {
        None
    }

    /// The surface as the library's algorithms see it; the library's own composites give more of it.
    #[doc(hidden)]
    fn surface_access(&self) -> Option<SurfaceAccess<'_, N, D>> {
        self.surface().map(SurfaceAccess::of_any)
    }

    /// Calls `visit` with the number of each corner of a part that others may share: two parts are adjacent
    /// if they have a number in common, which need not be that of a vertex. None, the default, of solids side
    /// by side.
    ///
    /// Of a triangle mesh or polyline these are its vertices, of which those at one position are one; of a
    /// height field the points of its grid; of a compound those of its children, kept apart, where these are
    /// below 2³².
    fn each_corner(&self, part: u32, visit: &mut dyn FnMut(u64)) {
        let _ = (part, visit);
    }

    /// Two different parts share a corner, so that their touching says nothing: such parts are left
    /// out when the shape is tested against itself. The default asks [`Self::each_corner`].
    fn are_adjacent(&self, part1: u32, part2: u32) -> bool {
        let (mut corners, mut is_shared) = (SmallVec::<[u64; 4]>::new(), false);
        self.each_corner(part1, &mut |corner| corners.push(corner));
        self.each_corner(part2, &mut |corner| is_shared |= corners.contains(&corner));
        is_shared
    }

    /// Appends the way to a part.
    fn extend_path(&self, part: u32, path: &mut PartPath) {
        path.push(part);
    }

    /// The composite as a shape of the library, of which it is told what it encloses; `None` for one of the user's.
    #[doc(hidden)]
    fn built_in(&self) -> Option<&dyn Shape<N, D>> {
        None
    }

    /// The composite as a mesh.
    #[doc(hidden)]
    fn as_mesh(&self) -> Option<&TriMesh<N, D>> {
        None
    }

    /// Names the state of a composite of the library; `None` for one of the user's, which may change unnoticed.
    #[doc(hidden)]
    fn revision(&self) -> Option<Revision> {
        None
    }

    /// Calls `visit` with each closed surface among the parts that is the boundary of a [`EnclosedBody`].
    #[doc(hidden)]
    fn each_body(&self, visit: &mut dyn FnMut(&EnclosedBody<'_, N, D>)) {
        let _ = visit;
    }

    /// [`Self::each_body`] visits any. O(1).
    #[doc(hidden)]
    fn has_bodies(&self) -> bool {
        false
    }

    /// The composite as a boundary winds around a point; the point may count either way where it lies on a part.
    #[doc(hidden)]
    fn winds_around(&self, point: &Point<N, D>) -> bool {
        let _ = point;
        false
    }

    /// The number of the connected piece that a part belongs to. The default takes a surface for one piece, and solids
    /// side by side for one each.
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
    /// Where it lies in the frame of the composite.
    pub pose: Pose<N, D>,
    /// What it is, in its own frame.
    pub solid: PartSolid<'a, N, D>,
}

/// What a part is: made on the fly, or kept by the composite.
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

/// Finding the parts of a composite by their boxes.
///
/// Parts are proposed by their boxes, which may be larger than they are: whoever asks looks at each.
/// Each part is proposed at most once; near ones first is better, but no order is promised. What is
/// not finite, except for the faces of an unbounded box, is near nothing.
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
    /// A box around all parts, as small as is cheap: it is asked for in every query.
    ///
    /// The default is unbounded, which is always right; two composites are then held against each
    /// other part by part of the smaller one, however far apart they are.
    fn bounds(&self) -> Aabb<N, D> {
        Aabb::unbounded()
    }

    /// The tree that the search is, where its boxes are those of the parts in the order of their numbers: two
    /// composites that have one each are searched together, which is many times as fast as part by part. `None`,
    /// the default, of all but [`BoxTree`].
    fn as_tree(&self) -> Option<&BoxTree<N, D>> {
        None
    }

    /// Calls `visit` with each part whose box meets or touches `aabb`.
    fn overlapping(&self, aabb: &Aabb<N, D>, visit: &mut dyn FnMut(u32));

    /// Calls `visit` with each part whose box is at most `limit` from `aabb`, and a lower bound of
    /// that distance. `visit` returns the new limit, which never grows: the distance of the nearest
    /// part so far, to find the nearest. A negative one ends the search.
    fn nearest(&self, aabb: &Aabb<N, D>, limit: N, visit: &mut dyn FnMut(u32, N) -> N);

    /// Calls `visit` with each part whose box is met, at or before the time `limit`, by `aabb` moving
    /// with `velocity`, and a lower bound of the time; as [`Self::nearest`]. A ray is a box of no
    /// extent.
    fn cast(
        &self,
        aabb: &Aabb<N, D>,
        velocity: &Vector<N, D>,
        limit: N,
        visit: &mut dyn FnMut(u32, N) -> N,
    );
}

/// How the parts of one surface hang together: what contacts need to slide over seams.
///
/// Seen one by one, triangles of a floor have edges that a sliding box would catch on. A surface
/// knows which normals its parts have as pieces of the whole. All is in the frame of the composite.
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
    /// The unit vector `normal`, away from the part, is one that the whole surface has at the
    /// feature of the part: the face's own; at a seam where the surface bends outwards, one between
    /// those of the two faces; at a seam that is flat or bends inwards, none but the faces' own. With
    /// a tolerance for rounding.
    fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<N, D>) -> bool;

    /// The normal that the whole surface has on the part and that stands for `normal`, which it does
    /// not admit: that of the face, on the side that `normal` points to for a surface with two
    /// sides. `None` if the part has no surface of its own, as a piece inside a filled shape.
    fn snapped(&self, part: u32, normal: &Vector<N, D>) -> Option<Vector<N, D>>;

    /// The part can touch a solid whose middle is `center`: false on the back of a surface with one
    /// side.
    fn faces(&self, part: u32, center: &Point<N, D>) -> bool;
}
