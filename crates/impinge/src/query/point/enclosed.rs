//! Signed distance and containment of closed meshes and polylines.
//!
//! The sign of a distance follows from the winding number, which [`crossing`](super::crossing)
//! computes exactly. Signs from the normal at the nearest feature (Bærentzen and Aanæs, "Signed
//! distance computation using the angle weighted pseudonormal", 2005) need a manifold, and in
//! floating point fail at needles; the tests compare both methods.

use super::crossing::{RayDirection, of_segment, of_triangle};
use super::holds;
use crate::bounding_volume::Aabb;
use crate::math::{Point, Real, Space, max, max_component};
use crate::partitioning::BoxTree;
use crate::shape::{CompositeShape, Polyline, TriMesh};
use crate::tables::entries;

impl<N: Real> TriMesh<N, 3> {
    /// Returns whether the point, in the frame of the mesh, lies in the volume that the mesh
    /// bounds, or on the mesh; `None` if the mesh [does not bound a volume](Self::is_volume).
    ///
    /// True if and only if [`Self::signed_distance`], which defines the inside, is zero or
    /// negative. A point that is not finite is never inside. The cost is O(log n), plus a test of
    /// each triangle whose box is crossed by the ray from the point to the nearest face of the
    /// overall box.
    #[must_use]
    pub fn encloses(&self, point: &Point<N, 3>) -> Option<bool> {
        self.is_volume().then(|| {
            let winding = self.winding(point);
            winding != Some(0) || touches(self, point)
        })
    }

    /// Returns the distance from the point, in the frame of the mesh, to the nearest triangle:
    /// negative in the volume that the mesh bounds, zero on the mesh; `None` if the mesh [does not
    /// bound a volume](Self::is_volume).
    ///
    /// The inside is the set of points around which the mesh winds, in either direction: an overlap
    /// of bodies is inside both, the cavity within a reversed inner surface is outside. The winding
    /// number decides the sign and is exact for the given coordinates: no crack, needle or corner
    /// in line with the point makes it wrong. (This assumes that the magnitudes of the coordinates
    /// are within a factor of 1e90 of each other.) As for all sets without thickness, a point
    /// within rounding of a triangle lies on it.
    ///
    /// All other queries, also those of [`PointQuery`](crate::query::PointQuery), treat the mesh as
    /// a surface, unless it is [solid](Self::solid). A point that is not finite is infinitely far
    /// away. The cost is a search for the nearest triangle, plus the cost of [`Self::encloses`].
    ///
    /// ```
    /// use impinge::dim3::math::Point;
    /// use impinge::dim3::procedural;
    /// use impinge::dim3::shape::{Cuboid, TriMesh};
    ///
    /// let surface = procedural::cuboid(&Cuboid::new([1.0_f32, 2.0, 3.0].into()));
    /// let mesh = TriMesh::new(surface.vertices, surface.triangles);
    /// assert_eq!(mesh.signed_distance(&Point::new(0.0, 0.0, 2.5)), Some(-0.5));
    /// assert_eq!(mesh.signed_distance(&Point::new(4.0, 2.0, 7.0)), Some(5.0));
    /// assert_eq!(mesh.encloses(&Point::new(1.0, 2.0, 3.0)), Some(true), "a corner");
    /// ```
    #[must_use]
    pub fn signed_distance(&self, point: &Point<N, 3>) -> Option<N> {
        self.is_volume().then(|| signed(self, point, || self.winding(point)))
    }

    /// Returns the winding number of the mesh around the point; `None` only for a point on the
    /// mesh. A point on the mesh may instead get the number of a point beside it.
    fn winding(&self, point: &Point<N, 3>) -> Option<i64> {
        self.winding_of(point, |_| true)
    }

    /// Returns the winding number, around the point, of the triangles for which `counts` returns
    /// `true`; `None` if the point lies on one of these triangles, up to rounding.
    pub(crate) fn winding_beside(
        &self,
        point: &Point<N, 3>,
        counts: impl Fn(u32) -> bool,
    ) -> Option<i64> {
        let is_on = lies_on(self, self.tree(), point, &counts);
        if is_on { None } else { self.winding_of(point, counts) }
    }

    /// Returns the winding number, around the point, of the triangles for which `counts` returns
    /// `true`; `None` only if the point lies on one of these triangles.
    pub(crate) fn winding_of(
        &self,
        point: &Point<N, 3>,
        counts: impl Fn(u32) -> bool,
    ) -> Option<i64> {
        let (tree, (scale, at)) = (self.tree(), scaled(self.tree(), point));
        winding(tree, point, |part, direction| {
            if !counts(part) {
                return Some(0);
            }
            let corners = self.triangle(part).corners().map(|corner| lifted(&corner, scale));
            of_triangle(corners, &at, direction)
        })
    }
}

impl<N: Real> Polyline<N, 2> {
    /// Returns whether the point, in the frame of the line, lies in the area that the line bounds,
    /// or on the line; `None` if the line [does not bound an area](Self::is_outline).
    ///
    /// True if and only if [`Self::signed_distance`], which defines the inside, is zero or
    /// negative. A point that is not finite is never inside. The cost is O(log n), plus a test of
    /// each segment whose box is crossed by the ray from the point to the nearest side of the
    /// overall box.
    #[must_use]
    pub fn encloses(&self, point: &Point<N, 2>) -> Option<bool> {
        self.is_outline().then(|| {
            let winding = self.winding(point);
            winding != Some(0) || touches(self, point)
        })
    }

    /// Returns the distance from the point, in the frame of the line, to the nearest segment:
    /// negative in the area that the line bounds, zero on the line; `None` if the line [does not
    /// bound an area](Self::is_outline).
    ///
    /// As for closed meshes in 3D ([`TriMesh::signed_distance`]), the inside is the set of points
    /// around which the line winds, in either direction, and is decided exactly.
    ///
    /// ```
    /// use impinge::dim2::math::Point;
    /// use impinge::dim2::shape::Polyline;
    ///
    /// let corners = [[0.0_f32, 0.0], [4.0, 0.0], [4.0, 4.0], [0.0, 4.0]];
    /// let room = Polyline::closed(corners.map(Point::from).to_vec());
    /// assert_eq!(room.signed_distance(&Point::new(3.5, 2.0)), Some(-0.5));
    /// assert_eq!(room.signed_distance(&Point::new(7.0, 8.0)), Some(5.0));
    /// ```
    #[must_use]
    pub fn signed_distance(&self, point: &Point<N, 2>) -> Option<N> {
        self.is_outline().then(|| signed(self, point, || self.winding(point)))
    }

    /// Returns the winding number of the line around the point; `None` only for a point on the
    /// line. A point on the line may instead get the number of a point beside it.
    fn winding(&self, point: &Point<N, 2>) -> Option<i64> {
        self.winding_of(point, |_| true)
    }

    /// Returns the winding number, around the point, of the segments for which `counts` returns
    /// `true`; `None` if the point lies on one of these segments, up to rounding.
    pub(crate) fn winding_beside(
        &self,
        point: &Point<N, 2>,
        counts: impl Fn(u32) -> bool,
    ) -> Option<i64> {
        let is_on = lies_on(self, self.tree(), point, &counts);
        if is_on { None } else { self.winding_of(point, counts) }
    }

    /// Returns the winding number, around the point, of the segments for which `counts` returns
    /// `true`; `None` only if the point lies on one of these segments.
    pub(crate) fn winding_of(
        &self,
        point: &Point<N, 2>,
        counts: impl Fn(u32) -> bool,
    ) -> Option<i64> {
        let (tree, (scale, at)) = (self.tree(), scaled(self.tree(), point));
        winding(tree, point, |part, direction| {
            if !counts(part) {
                return Some(0);
            }
            let segment = self.segment(part);
            let ends = [segment.a(), segment.b()].map(|end| lifted(end, scale));
            of_segment(ends, &at, direction)
        })
    }
}

fn touches<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    point: &Point<N, D>,
) -> bool {
    entries::nearest_part(parts, point, true).is_some()
}

/// Returns whether the point lies, up to rounding, on a part for which `counts` returns `true`.
fn lies_on<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    tree: &BoxTree<N, D>,
    point: &Point<N, D>,
    counts: &impl Fn(u32) -> bool,
) -> bool {
    tree.containing(point).into_iter().any(|part| {
        let part = u32::try_from(part).expect("a tree has fewer than 2^32 boxes");
        counts(part) && holds(parts.part(part).solid.geometry(), point)
    })
}

/// Returns the distance to the nearest part: positive if the winding number is zero, else negative;
/// zero on a part, and infinite if there is no nearest part.
fn signed<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
    point: &Point<N, D>,
    winding: impl FnOnce() -> Option<i64>,
) -> N {
    let Some(nearest) = entries::nearest_part(parts, point, false) else {
        return N::INFINITY;
    };
    // The parts have no thickness, but the distance from a part is negative inside a body.
    let distance = nearest.distance.abs();
    match winding() {
        Some(0) => distance,
        Some(_) => N::ZERO - distance,
        None => N::ZERO,
    }
}

/// Sums the contributions of the parts between a point and the nearest face of the overall box; 0
/// for a point outside that box. `None` only for a point on a part.
fn winding<N: Space<D>, const D: usize>(
    tree: &BoxTree<N, D>,
    point: &Point<N, D>,
    mut added: impl FnMut(u32, RayDirection) -> Option<i64>,
) -> Option<i64> {
    let Some((direction, probe)) = tree.bounds().and_then(|bounds| shortest_exit(bounds, point))
    else {
        return Some(0);
    };
    let mut sum = Some(0);
    tree.visit_overlapping(&probe, |part| {
        let part = u32::try_from(part).expect("a tree has fewer than 2^32 boxes");
        sum = sum.and_then(|sum| Some(sum + added(part, direction)?));
    });
    sum
}

/// Returns the axis-parallel ray from the point to the nearest face of the box: its direction, and
/// a box without width that covers it. `None` for a point outside the box, and for a point that is
/// not finite.
fn shortest_exit<N: Real, const D: usize>(
    bounds: &Aabb<N, D>,
    point: &Point<N, D>,
) -> Option<(RayDirection, Aabb<N, D>)> {
    let (mins, maxs) = (bounds.mins(), bounds.maxs());
    let is_within = (0..D).all(|axis| mins[axis] <= point[axis] && point[axis] <= maxs[axis]);
    if !is_within {
        return None;
    }
    let length = |direction: &RayDirection| match direction.is_ascending {
        true => maxs[direction.axis] - point[direction.axis],
        false => point[direction.axis] - mins[direction.axis],
    };
    let all = (0..D)
        .flat_map(|axis| [true, false].map(|is_ascending| RayDirection { axis, is_ascending }));
    let direction =
        all.reduce(
            |best, direction| if length(&direction) < length(&best) { direction } else { best },
        )?;
    let mut end = *point;
    end[direction.axis] =
        if direction.is_ascending { maxs[direction.axis] } else { mins[direction.axis] };
    let (low, high) = if direction.is_ascending { (*point, end) } else { (end, *point) };
    Some((direction, Aabb::try_new(low, high).ok()?))
}

/// Returns a power of two near the largest coordinate, and the point divided by it. Products of
/// three divided coordinates neither overflow nor underflow.
fn scaled<N: Space<D>, const D: usize>(
    tree: &BoxTree<N, D>,
    point: &Point<N, D>,
) -> (f64, Point<f64, D>) {
    let corners = tree.bounds().map_or([*point; 2], |bounds| [*bounds.mins(), *bounds.maxs()]);
    let largest = corners.iter().map(|corner| max_component(&corner.coords)).fold(N::ZERO, max);
    let scale = largest.power_of_two_below().as_f64();
    (scale, lifted(point, scale))
}

/// Returns a point in doubles, divided by a power of two; exact unless a coordinate underflows.
fn lifted<N: Real, const D: usize>(point: &Point<N, D>, scale: f64) -> Point<f64, D> {
    Point::from(point.coords.map(|x| x.as_f64() / scale))
}
