//! Polylines: chains and networks of segments.

use std::sync::OnceLock;

use crate::bounding_volume::Aabb;
use crate::math::{Point, Real, Space, Vector, max, max_component};
use crate::partitioning::{BoxTree, BoxTreeError};
use crate::shape::composite::body::{check_fronts, pieces, samples_of};
use crate::shape::composite::joints::Joints;
use crate::shape::composite::mesh_error::{
    MeshError, check_moved, check_parts, check_scale, check_vertices, or_panic,
};
use crate::shape::composite::polyline_parts;
use crate::shape::{Revision, Segment};

/// Segments that share ends: one or several lines, open or closed, or a network.
///
/// Parts are the segments, in the order given. Each has the vertices 0 and 1 and the edge 0 of
/// [`Segment`]; all coordinates are in the frame of the line. Segments join where the positions of
/// their ends are equal, regardless of vertex indices.
///
/// **Sides.** For most queries a line has no inside. In 2D `encloses` and `signed_distance` test
/// points against the area that a closed line encloses, and `solid` makes this area part of the
/// shape. In 2D contacts arise on both sides, or only on the right after `one_sided`. The left is
/// then the solid side, as for an outline that runs counter-clockwise.
///
/// **Seams.** Contacts treat the line as one surface (see [`Surface`](crate::shape::Surface)): at a
/// joint only normals of the whole line are admitted, so that solids do not catch on the joints of
/// a floor. Segments whose directions differ by less than 0.57 degrees (a sine of 0.01) count as
/// straight. [`Self::with_internal_edges_kept`] disables this.
///
/// **Degenerate segments.** A segment without length is kept, so that part indices do not change:
/// it acts as a point, and its neighbours join through it.
///
/// Construction costs O(n log n), a search O(log n + results).
///
/// ```
/// use impinge::dim2::math::Point;
/// use impinge::dim2::shape::{CompositeShape, Polyline};
///
/// let corners = [[0.0_f32, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
/// let room = Polyline::closed(corners.map(Point::from).to_vec());
/// assert_eq!(room.num_parts(), 4);
/// assert_eq!(room.segments()[3], [3, 0]);
/// assert!(room.are_adjacent(0, 3) && !room.are_adjacent(0, 2));
/// ```
#[derive(Clone)]
pub struct Polyline<N: Real, const D: usize> {
    pub(in crate::shape) vertices: Vec<Point<N, D>>,
    pub(in crate::shape) segments: Vec<[u32; 2]>,
    pub(in crate::shape) joints: Joints,
    pub(in crate::shape) tree: BoxTree<N, D>,
    /// Whether as many segments start as end at each joint, and the vertices of each joint still
    /// coincide.
    is_cycle: bool,
    /// Whether vertices have moved since the joints were computed.
    pub(in crate::shape) is_moved: bool,
    /// Maps the direction of a segment to the normal on its front. `None` for a line with two
    /// sides, and always in 3D.
    pub(in crate::shape) front: Option<Front<N, D>>,
    /// Whether `solid` was called; has an effect only while [`Self::is_cycle`] is true.
    pub(in crate::shape) is_solid: bool,
    pub(in crate::shape) keeps_internal_edges: bool,
    /// For each segment, the first segment of its connected piece; computed on first use.
    pieces: OnceLock<Vec<u32>>,
    /// The cache key of the geometry; the options, which are set later, are not included.
    pub(in crate::shape) revision: Revision,
}

/// Maps the direction of a segment to the normal on its front.
pub(crate) type Front<N, const D: usize> = fn(&Vector<N, D>) -> Vector<N, D>;

impl<N: Space<D>, const D: usize> Polyline<N, D> {
    /// Returns the open line through the vertices in order.
    ///
    /// # Panics
    /// If [`Self::try_open`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn open(vertices: Vec<Point<N, D>>) -> Self {
        or_panic(Self::try_open(vertices))
    }

    /// Returns the open line through the vertices in order.
    ///
    /// # Errors
    /// If a coordinate is not finite, there are fewer than two vertices, or the vertices do not fit
    /// 32-bit indices.
    pub fn try_open(vertices: Vec<Point<N, D>>) -> Result<Self, MeshError> {
        let segments = chain(vertices.len())?;
        Self::try_new(vertices, segments)
    }

    /// Returns the closed line through the vertices in order, and from the last back to the first.
    ///
    /// # Panics
    /// If [`Self::try_closed`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn closed(vertices: Vec<Point<N, D>>) -> Self {
        or_panic(Self::try_closed(vertices))
    }

    /// Returns the closed line through the vertices in order, and from the last back to the first.
    ///
    /// # Errors
    /// If a coordinate is not finite, there are fewer than two vertices, or the vertices do not fit
    /// 32-bit indices.
    pub fn try_closed(vertices: Vec<Point<N, D>>) -> Result<Self, MeshError> {
        let mut segments = chain(vertices.len())?;
        if let Some(&[_, last]) = segments.last() {
            segments.push([last, 0]);
        }
        Self::try_new(vertices, segments)
    }

    /// Returns the union of segments, each given by the indices of its two vertices, in any order.
    ///
    /// # Panics
    /// If [`Self::try_new`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn new(vertices: Vec<Point<N, D>>, segments: Vec<[u32; 2]>) -> Self {
        or_panic(Self::try_new(vertices, segments))
    }

    /// Returns the union of segments, each given by the indices of its two vertices, in any order.
    ///
    /// # Errors
    /// If a coordinate is not finite, a segment refers to a vertex that does not exist, there are
    /// no segments, or the ends do not fit 32-bit indices.
    pub fn try_new(vertices: Vec<Point<N, D>>, segments: Vec<[u32; 2]>) -> Result<Self, MeshError> {
        check_vertices(&vertices)?;
        check_parts(&segments, vertices.len())?;
        let joints = Joints::new(&vertices, &segments);
        let tree = BoxTree::try_from_boxes(&boxes_of(&vertices, &segments)).map_err(refused)?;
        let is_cycle = is_cycle(vertices.len(), &segments, &joints);
        let (is_moved, front, is_solid, keeps_internal_edges) = (false, None, false, false);
        Ok(Self {
            vertices,
            segments,
            joints,
            tree,
            is_cycle,
            is_moved,
            front,
            is_solid,
            keeps_internal_edges,
            pieces: OnceLock::new(),
            revision: Revision::new(),
        })
    }

    /// Returns the line scaled along the axes of its frame, about its origin. A mirroring scale
    /// also reverses each segment, so that the solid side stays solid.
    ///
    /// # Errors
    /// If a factor of the scale is zero or not finite, or a coordinate becomes infinite.
    pub fn try_scaled(&self, scale: &Vector<N, D>) -> Result<Self, MeshError> {
        check_scale(scale)?;
        let scaled = |point: &Point<N, D>| Point::from(point.coords.component_mul(scale));
        let vertices: Vec<_> = self.vertices.iter().map(scaled).collect();
        let is_mirrored = scale.iter().filter(|&&x| x < N::ZERO).count() % 2 == 1;
        let reversed = |&[a, b]: &[u32; 2]| if is_mirrored { [b, a] } else { [a, b] };
        let mut made = Self::try_new(vertices, self.segments.iter().map(reversed).collect())?;
        if self.is_moved {
            made.move_joints(self.joints.of_vertices_in_order());
        }
        let Self { front, is_solid, keeps_internal_edges, .. } = *self;
        Ok(Self { front, is_solid, keeps_internal_edges, ..made })
    }

    /// Moves the vertices; see [`Self::try_set_vertices`].
    ///
    /// # Panics
    /// If [`Self::try_set_vertices`] returns an error.
    #[track_caller]
    pub fn set_vertices(&mut self, vertices: &[Point<N, D>]) {
        or_panic(self.try_set_vertices(vertices));
    }

    /// Moves all vertices of a deforming line; `vertices` has the order of [`Self::vertices`].
    ///
    /// Segments that were joined stay joined, even if their ends are now apart, also in lines that
    /// are scaled from this one. The tree is refitted, not rebuilt: O(n). On an error the line is
    /// unchanged.
    ///
    /// # Errors
    /// If a coordinate is not finite or the number of vertices differs.
    pub fn try_set_vertices(&mut self, vertices: &[Point<N, D>]) -> Result<(), MeshError> {
        check_moved(vertices, self.vertices.len())?;
        self.tree.try_refit(&boxes_of(vertices, &self.segments)).map_err(refused)?;
        self.vertices.copy_from_slice(vertices);
        self.is_moved = true;
        self.revision = Revision::new();
        self.pieces = OnceLock::new();
        let is_whole = self.joints.are_together(vertices, &self.segments);
        self.is_cycle = is_whole && is_cycle(vertices.len(), &self.segments, &self.joints);
        Ok(())
    }
}

impl<N: Real, const D: usize> Polyline<N, D> {
    /// Replaces the joints by those of a line whose vertices were moved after construction, so that
    /// positions no longer determine them. `of_vertex` is the joint of each vertex.
    pub(in crate::shape) fn move_joints(&mut self, of_vertex: &[u32]) {
        let joints = Joints::of_vertices(of_vertex.to_vec(), &self.segments);
        let is_whole = joints.are_together(&self.vertices, &self.segments);
        self.is_cycle = is_whole && is_cycle(self.vertices.len(), &self.segments, &joints);
        (self.joints, self.is_moved) = (joints, true);
    }
}

impl<N: Real, const D: usize> Polyline<N, D> {
    /// Returns the vertices, as given; some may belong to no segment.
    #[must_use]
    pub fn vertices(&self) -> &[Point<N, D>] {
        &self.vertices
    }

    /// Returns the vertex indices of each segment.
    #[must_use]
    pub fn segments(&self) -> &[[u32; 2]] {
        &self.segments
    }

    /// Returns the number of segments.
    #[must_use]
    pub const fn num_segments(&self) -> usize {
        self.segments.len()
    }

    /// Returns the segment with the index `index`.
    ///
    /// # Panics
    /// If `index` is not below the number of segments.
    #[must_use]
    pub fn segment(&self, index: u32) -> Segment<N, D> {
        let [a, b] = self.ends(index);
        Segment::new(a, b)
    }

    /// Returns the segments joined to end 0 or 1 of a segment, including the segment itself, in
    /// ascending order.
    ///
    /// # Panics
    /// If there is no such segment or end.
    #[must_use]
    pub fn joined(&self, segment: u32, end: u32) -> &[u32] {
        self.joints.parts(self.joints.of(self.segments[segment as usize][end as usize]))
    }

    /// Returns whether both ends of every segment are joined to another segment. O(n).
    #[must_use]
    pub fn is_closed(&self) -> bool {
        let joint = |&vertex: &u32| self.joints.parts(self.joints.of(vertex));
        self.segments.iter().flatten().all(|vertex| joint(vertex).len() > 1)
    }

    /// Returns the tree over the boxes of the segments.
    #[must_use]
    pub const fn tree(&self) -> &BoxTree<N, D> {
        &self.tree
    }

    /// Returns whether the line is one-sided: no contact arises on its left.
    #[must_use]
    pub const fn is_one_sided(&self) -> bool {
        self.front.is_some()
    }

    /// Returns whether the enclosed area belongs to the shape: `solid` was called, and no joined
    /// vertices are apart after a move. Always false in 3D.
    #[must_use]
    pub const fn is_solid(&self) -> bool {
        self.is_solid && self.is_cycle
    }

    /// Returns for each segment the first segment of its piece; segments that share ends belong to
    /// one piece.
    pub(in crate::shape) fn pieces(&self) -> &[u32] {
        self.pieces.get_or_init(|| {
            let are_together =
                !self.is_moved || self.joints.are_together(&self.vertices, &self.segments);
            let number = |vertex| if are_together { self.joints.of(vertex) } else { vertex };
            pieces(&self.segments, self.vertices.len(), number)
        })
    }

    /// Returns whether contacts treat each segment as a separate solid; see
    /// [`Self::with_internal_edges_kept`].
    #[must_use]
    pub const fn keeps_internal_edges(&self) -> bool {
        self.keeps_internal_edges
    }

    /// Makes contacts treat each segment as a separate solid, with both its ends, as if it had no
    /// neighbours.
    #[must_use]
    pub const fn with_internal_edges_kept(mut self) -> Self {
        self.keeps_internal_edges = true;
        self
    }

    pub(in crate::shape) fn ends(&self, segment: u32) -> [Point<N, D>; 2] {
        self.segments[segment as usize].map(|vertex| self.vertices[vertex as usize])
    }
}

impl<N: Real> Polyline<N, 2> {
    /// Returns whether the line is the outline of one or several areas: at each joint as many
    /// segments end as start, as in every [closed](Self::closed) line. O(1).
    ///
    /// If [`Self::set_vertices`] moves joined vertices apart, the line is no longer an outline.
    /// [`Self::encloses`] and [`Self::signed_distance`] test whether a point lies inside.
    #[must_use]
    pub const fn is_outline(&self) -> bool {
        self.is_cycle
    }

    /// Makes the line one-sided: no contact arises on its left, the solid side, as for an outline
    /// that runs counter-clockwise.
    #[must_use]
    pub const fn one_sided(mut self) -> Self {
        self.front = Some(polyline_parts::right_of);
        self
    }

    /// Makes the area inside a closed line part of the shape; see [`Self::try_solid`].
    ///
    /// # Panics
    /// If [`Self::try_solid`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn solid(self) -> Self {
        or_panic(self.try_solid())
    }

    /// Makes the line solid: the area that it [encloses](Self::encloses) belongs to the shape.
    ///
    /// `TriMesh::try_solid` describes the effect on each query, for meshes in 3D. The enclosed area
    /// lies on the left of the segments; an outline that runs clockwise is a hole in another
    /// outline.
    ///
    /// # Errors
    /// - [`MeshError::NotClosed`] or [`MeshError::NotOriented`] if the line is not an
    ///   [outline](Self::is_outline), with the first vertex at fault.
    /// - [`MeshError::InsideOut`] if an outline runs clockwise and lies in no other outline, with
    ///   the first segment of that outline.
    ///
    /// ```
    /// use impinge::dim2::math::{Isometry, Point, Vector};
    /// use impinge::dim2::query::{contact, distance};
    /// use impinge::dim2::shape::{Ball, MeshError, Polyline};
    ///
    /// let corners = [[0.0_f64, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]].map(Point::from);
    /// let block = Polyline::closed(corners.to_vec()).solid();
    /// let (here, ball, there) = (Isometry::identity(), Ball::new(0.25), Isometry::translation(3.0, 2.0));
    /// assert_eq!(distance(&here, &block, &there, &ball), 0.0);
    /// let way_out = contact(&here, &block, &there, &ball, 0.0).expect("it is inside");
    /// assert_eq!((way_out.depth, *way_out.normal), (1.25, Vector::x()));
    ///
    /// let open = Polyline::open(corners.to_vec()).try_solid();
    /// assert_eq!(open.err(), Some(MeshError::NotClosed { part: 0, edge: [0, 0] }));
    /// ```
    pub fn try_solid(mut self) -> Result<Self, MeshError> {
        if !self.is_cycle {
            return Err(self.opening());
        }
        let (pieces, scale) = (self.pieces(), self.scale());
        let cone = |part: u32| {
            let apex = self.ends(pieces[part as usize])[0];
            let [a, b] = self.ends(part).map(|end| (end - apex).map(|x| x.as_f64() / scale));
            a.perp(&b)
        };
        let winding = |part: u32| {
            let is_other = |other: u32| pieces[other as usize] != pieces[part as usize];
            samples_of(self.ends(part)).find_map(|point| self.winding_beside(&point, is_other))
        };
        check_fronts(pieces, cone, winding)?;
        self.is_solid = true;
        Ok(self.one_sided())
    }

    /// Returns a power of two near the largest magnitude of a coordinate. Coordinates are divided
    /// by it so that areas neither overflow nor underflow.
    fn scale(&self) -> f64 {
        let corners = self.tree.bounds().map(|bounds| [*bounds.mins(), *bounds.maxs()]);
        let largest = |corner: &Point<N, 2>| max_component(&corner.coords);
        let size = corners.map_or(N::ONE, |[low, high]| max(largest(&low), largest(&high)));
        size.power_of_two_below().as_f64()
    }

    /// Returns the error for the first vertex at which the numbers of starting and ending segments
    /// differ.
    fn opening(&self) -> MeshError {
        let joints = Joints::new(&self.vertices, &self.segments);
        for (part, vertex) in
            (0..).zip(&self.segments).flat_map(|(part, ends)| ends.map(|end| (part, end)))
        {
            let (joint, mut counts) = (joints.of(vertex), [0_usize; 2]);
            for &other in joints.parts(joint) {
                let ends = self.segments[other as usize].map(|end| joints.of(end) == joint);
                (counts[0], counts[1]) =
                    (counts[0] + usize::from(ends[0]), counts[1] + usize::from(ends[1]));
            }
            match counts {
                [starts, ends] if starts == ends => {}
                [1, 0] | [0, 1] => return MeshError::NotClosed { part, edge: [vertex; 2] },
                _ => return MeshError::NotOriented { part, edge: [vertex; 2] },
            }
        }
        // The ends balance by position, but not by the joints of construction: vertices that were
        // moved to one position do not join.
        MeshError::NotClosed { part: 0, edge: [self.segments[0][0]; 2] }
    }
}

/// Returns whether at each joint as many segments end as start.
fn is_cycle(vertices: usize, segments: &[[u32; 2]], joints: &Joints) -> bool {
    let mut surplus = vec![0_i64; vertices];
    for &[from, to] in segments {
        surplus[joints.of(from) as usize] += 1;
        surplus[joints.of(to) as usize] -= 1;
    }
    surplus.iter().all(|&starts| starts == 0)
}

/// Returns the segments from each vertex to the next; a later check rejects too many vertices.
///
/// # Errors
/// If there are fewer than two vertices.
fn chain(vertices: usize) -> Result<Vec<[u32; 2]>, MeshError> {
    if vertices < 2 {
        return Err(MeshError::TooFewVertices { given: vertices });
    }
    Ok((1..).take(vertices - 1).map(|next| [next - 1, next]).collect())
}

/// Returns the boxes of the segments, in the order of the segments.
fn boxes_of<N: Real, const D: usize>(
    vertices: &[Point<N, D>],
    segments: &[[u32; 2]],
) -> Vec<Aabb<N, D>> {
    let ends = |ends: &[u32; 2]| ends.map(|end| vertices[end as usize]);
    let one = |part: &[u32; 2]| Aabb::from_points(&ends(part)).unwrap_or_else(Aabb::unbounded);
    segments.iter().map(one).collect()
}

/// Converts an error of the tree. All boxes are around finite points, so only their count can be
/// invalid.
pub(in crate::shape) fn refused(error: BoxTreeError) -> MeshError {
    match error {
        BoxTreeError::BadBox { index, .. } => MeshError::VertexNotFinite { vertex: index },
        BoxTreeError::WrongCount { given, needed } => MeshError::WrongCount { given, needed },
        BoxTreeError::TooMany { given } => MeshError::TooMany { given },
    }
}
