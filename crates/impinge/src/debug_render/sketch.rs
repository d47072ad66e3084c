//! A mesh under construction, and the sketches of shapes whose algorithm is common to 2D and 3D.

use crate::tables::ByDimension;
use crate::tables::entries;
use std::collections::{BTreeMap, BTreeSet};

use super::{MeshOptions, ShapeMesh};
use crate::bounding_volume::Aabb;
use crate::math::{Point, Pose, Real, Space, filled};
use crate::shape::{CompositeShape, Geometry, Kind, Plane};

/// The number of marks between the centre of a half-space's square and its side, the mark on the
/// side included.
const MARKS: i32 = 2;

/// A mesh under construction. Equal points share one vertex. Lines and triangles with a point that
/// is not finite are left out.
pub(crate) struct Sketch<N: Real, const D: usize> {
    options: MeshOptions<N>,
    /// The pose, in the frame of the whole shape, of the part that is being added.
    pose: Pose<N, D>,
    mesh: ShapeMesh<N, D>,
    /// The index of each vertex, by the bits of its coordinates.
    numbers: BTreeMap<[u64; D], u32>,
    /// The lines added so far, each with the smaller vertex index first.
    lines: BTreeSet<[u32; 2]>,
}

impl<N: Real, const D: usize> Sketch<N, D> {
    pub(super) fn new(options: &MeshOptions<N>) -> Self {
        Self {
            options: *options,
            pose: Pose::identity(),
            mesh: ShapeMesh::default(),
            numbers: BTreeMap::new(),
            lines: BTreeSet::new(),
        }
    }

    /// Returns the mesh of everything that was added, with its id.
    pub(super) fn finish(mut self) -> ShapeMesh<N, D> {
        self.mesh.id = self.mesh.hash();
        self.mesh
    }

    /// Returns the number of segments of a full circle.
    pub(super) fn parts_of_turn(&self) -> u32 {
        self.options.parts_of_turn()
    }

    /// Returns the index of the vertex at a point in the frame of the current part, and appends the
    /// vertex if it is new. `None` if the point is not finite or 32 bits cannot number the
    /// vertices.
    fn vertex(&mut self, local: &Point<N, D>) -> Option<u32> {
        // Adding zero makes zeros positive, so that equal points have equal bits.
        let point = self.pose.point(local).map(|x| x + N::ZERO);
        let is_finite = point.iter().all(|x| x.is_finite_number());
        let next = u32::try_from(self.mesh.vertices.len()).ok().filter(|_| is_finite)?;
        let bits = filled(|axis| point[axis].bits());
        let number = *self.numbers.entry(bits).or_insert(next);
        if number == next {
            self.mesh.vertices.push(point);
        }
        Some(number)
    }

    /// Adds a line, unless its ends are equal or it has been added before.
    pub(super) fn line(&mut self, ends: [&Point<N, D>; 2]) {
        let [Some(a), Some(b)] = ends.map(|end| self.vertex(end)) else { return };
        if a != b && self.lines.insert([a.min(b), a.max(b)]) {
            self.mesh.lines.push([a, b]);
        }
    }

    /// Adds the lines from each point to the next, and from the last to the first.
    pub(super) fn ring(&mut self, points: &[Point<N, D>]) {
        let next = points.iter().cycle().skip(1);
        for (a, b) in points.iter().zip(next) {
            self.line([a, b]);
        }
    }

    /// Adds a triangle, unless two of its corners coincide.
    pub(super) fn triangle(&mut self, corners: [&Point<N, D>; 3]) {
        let [Some(a), Some(b), Some(c)] = corners.map(|corner| self.vertex(corner)) else { return };
        if a != b && b != c && c != a {
            self.mesh.triangles.push([a, b, c]);
        }
    }

    /// Adds a convex polygon with counter-clockwise corners as triangles that share its first
    /// corner.
    pub(super) fn fan(&mut self, points: &[Point<N, D>]) {
        let Some((first, others)) = points.split_first() else { return };
        for side in others.windows(2) {
            self.triangle([first, &side[0], &side[1]]);
        }
    }
}

impl<N: Space<D>, const D: usize> Sketch<N, D> {
    /// Adds a shape; see [`ShapeMesh::of`].
    pub(super) fn add(&mut self, geometry: Geometry<'_, N, D>) {
        match geometry.0 {
            Kind::Segment(segment) => self.line([segment.a(), segment.b()]),
            Kind::Plane(plane) => self.half_space(plane),
            Kind::Composite(composite) => self.composite(composite),
            solid => entries::sketch(solid, self),
        }
    }

    /// Adds the square (in 2D the line) around the origin that represents a half-space, with short
    /// lines into its solid side.
    fn half_space(&mut self, plane: &Plane<N, D>) {
        let extent = self.options.half_space_extent;
        let [u, v] = <N::Algorithms>::tangents(plane.normal()).map(|tangent| tangent * extent);
        // The corners are counter-clockwise seen from outside. In 2D the second tangent and the
        // length of two sides are zero.
        let corners = [u + v, v - u, -u - v, u - v].map(Point::from);
        self.ring(&corners);
        self.fan(&corners);
        let into = -plane.normal().into_inner() * (extent * N::lit(1.0 / 16.0));
        let step = |index: i32| N::lit(f64::from(index) / f64::from(MARKS));
        for row in -MARKS..=MARKS {
            for column in -MARKS..=MARKS {
                let start = Point::from(u * step(row) + v * step(column));
                self.line([&start, &(start + into)]);
            }
        }
    }

    /// Adds the parts that a search of the whole space finds. The holes and ghost parts of height
    /// fields are not among them.
    fn composite(&mut self, composite: &dyn CompositeShape<N, D>) {
        let (outer, mut parts) = (self.pose, Vec::new());
        composite.search().overlapping(&Aabb::unbounded(), &mut |part| parts.push(part));
        parts.sort_unstable();
        for index in parts {
            let part = composite.part(index);
            self.pose = outer.compose(&part.pose);
            let geometry = part.solid.geometry();
            // Parts must not be composites. A custom composite that violates this could cause an
            // endless recursion.
            if geometry.as_composite().is_none() {
                self.add(geometry);
            }
        }
        self.pose = outer;
    }
}
