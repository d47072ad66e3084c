//! Convex hulls of bodies made of triangles or segments. Two bodies are at least as far apart as
//! their hulls.
//!
//! The separation of two hulls takes one query, while two meshes take a traversal of their trees.
//! The hulls of a robot's meshes rarely touch where the meshes do not, so nearly all remaining
//! traversals find a contact.

use std::sync::OnceLock;
use std::sync::atomic::{AtomicU32, Ordering};

use crate::collide::Placed;
use crate::math::{Point, Real, Space};
use crate::query::distance_within;
use crate::shape::{CompositeShape, Geometry, PartSolid, ShapeHandle, TriMesh};
use crate::tables::ByDimension;

/// The margin by which hulls must be farther apart than the limit, in units of ε times the sum of
/// all lengths. The corners of a mesh are outside its hull by at most 32 of these units, and the
/// pair algorithms have an error of a few hundred.
const ROUNDING_ERRORS: f64 = 1024.0;

/// The number of requests for a hull before it is computed. A hull costs as much as some
/// traversals, so a query of a single configuration should not wait for it.
const REQUESTS_BEFORE: u32 = 16;

/// The hulls of a robot's bodies. Each is computed after [`REQUESTS_BEFORE`] requests. The hulls
/// never change a result.
#[derive(Clone, Debug)]
pub(super) struct BodyHulls<N: Real, const D: usize>(Vec<LazyHull<N, D>>);

#[derive(Debug)]
struct LazyHull<N: Real, const D: usize> {
    requests: AtomicU32,
    /// The hull, if it has been computed. The inner `None` is for a body that does not consist of
    /// triangles and segments, or whose hull has no volume.
    made: OnceLock<Option<ShapeHandle<N, D>>>,
}

impl<N: Space<D>, const D: usize> BodyHulls<N, D> {
    pub(super) fn new(bodies: usize) -> Self {
        let hull = |_| LazyHull { requests: AtomicU32::new(0), made: OnceLock::new() };
        Self((0..bodies).map(hull).collect())
    }

    /// Returns whether the hulls of two solids prove that the solids are farther apart than
    /// `limit`. Each solid comes with the index of its body; `None` for an obstacle, which has no
    /// hull.
    pub(super) fn are_beyond(
        &self,
        solids: [(&Placed<'_, N, D>, Option<u32>); 2],
        limit: N,
    ) -> bool {
        let [(one, number1), (other, number2)] = solids;
        let [hull1, hull2] = [self.of(one, number1), self.of(other, number2)];
        if hull1.is_none() && hull2.is_none() {
            return false;
        }
        let [one, other] = [hull1.unwrap_or(*one), hull2.unwrap_or(*other)];
        let between = (other.pose.translation - one.pose.translation).norm();
        let lengths = bounding_radius(&one.shape) + bounding_radius(&other.shape) + between + limit;
        let slack = lengths * N::lit(ROUNDING_ERRORS) * N::EPSILON;
        slack.is_finite_number() && distance_within(&one, &other, limit + slack).is_none()
    }

    /// Returns the hull of a body at the body's pose; `None` if the solid is not a composite or is
    /// an obstacle, if the body has no hull, and if its hull has not been computed yet.
    fn of<'a>(&'a self, body: &Placed<'_, N, D>, number: Option<u32>) -> Option<Placed<'a, N, D>> {
        let parts = body.shape.as_composite()?;
        let hull = self.0[number? as usize].get(parts)?;
        Some(Placed { pose: body.pose, shape: hull.geometry() })
    }
}

impl<N: Space<D>, const D: usize> LazyHull<N, D> {
    fn get(&self, parts: &dyn CompositeShape<N, D>) -> Option<&ShapeHandle<N, D>> {
        if self.made.get().is_none()
            && self.requests.fetch_add(1, Ordering::Relaxed) < REQUESTS_BEFORE
        {
            return None;
        }
        self.made.get_or_init(|| hull_of(parts)).as_ref()
    }
}

impl<N: Real, const D: usize> Clone for LazyHull<N, D> {
    fn clone(&self) -> Self {
        let requests = AtomicU32::new(self.requests.load(Ordering::Relaxed));
        Self { requests, made: self.made.clone() }
    }
}

/// Returns an upper bound of the distance of a solid's points from the origin of its frame.
fn bounding_radius<N: Real, const D: usize>(shape: &Geometry<'_, N, D>) -> N {
    let Some(parts) = shape.as_composite() else { return shape.extent() };
    let bounds = parts.search().bounds();
    (bounds.center().coords.abs() + bounds.half_extents()).norm()
}

/// Returns the convex hull of a composite that consists of triangles and segments; `None` for other
/// composites, and if the hull has no volume.
fn hull_of<N: Space<D>, const D: usize>(
    parts: &dyn CompositeShape<N, D>,
) -> Option<ShapeHandle<N, D>> {
    if let Some(mesh) = parts.built_in().and_then(|shape| shape.as_shape::<TriMesh<N, D>>()) {
        return <N::Algorithms>::hull(mesh.vertices());
    }
    let mut points = Vec::new();
    for part in 0..parts.num_parts() {
        let part = parts.part(part);
        let corners: &[Point<N, D>] = match &part.solid {
            PartSolid::Triangle(triangle) => triangle.corners(),
            PartSolid::Segment(segment) => &[*segment.a(), *segment.b()],
            PartSolid::Shape(_) => return None,
        };
        points.extend(corners.iter().map(|corner| part.pose.point(corner)));
    }
    <N::Algorithms>::hull(&points)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::{Mapped, Pose};
    use crate::shape::{Ball, Polyline, Shape, TriMesh};

    fn at<'a, const D: usize>(
        position: [f64; D],
        shape: &'a dyn Shape<f64, D>,
    ) -> Placed<'a, f64, D> {
        Placed { pose: Pose::from_translation(position.into()), shape: shape.geometry() }
    }

    /// Calls [`BodyHulls::are_beyond`] until the hulls have been computed, and returns the result
    /// of the last call.
    fn last_of<const D: usize>(
        hulls: &BodyHulls<f64, D>,
        solids: [(&Placed<'_, f64, D>, Option<u32>); 2],
        limit: f64,
    ) -> bool
    where
        f64: Space<D>,
    {
        (0..=REQUESTS_BEFORE).fold(false, |_, _| hulls.are_beyond(solids, limit))
    }

    #[test]
    fn a_mesh_is_as_far_as_its_hull_at_least() {
        let corners = [[0.0; 3], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        let corners = corners.mapped(Point::<f64, 3>::from).to_vec();
        // The opposite face is missing, so the hull is nearer to the ball than the mesh.
        let flat = TriMesh::new(corners[..3].to_vec(), vec![[0, 2, 1]]);
        let mesh = TriMesh::new(corners, vec![[0, 2, 1], [0, 3, 2], [0, 1, 3]]);
        let ball = Ball::new(0.5);
        let hulls = BodyHulls::new(3);
        let [mesh, flat] = [at([0.0; 3], &mesh), at([0.0; 3], &flat)];
        let ball = at([3.0; 3], &ball);
        let distance = 8.0 / 3.0_f64.sqrt() - 0.5;
        for (share, expected) in [(0.0, true), (1.0 - 1e-11, true), (1.0, false), (2.0, false)] {
            let limit = distance * share;
            let pairs = [[(&mesh, Some(1)), (&ball, None)], [(&ball, Some(2)), (&mesh, Some(1))]];
            let found = pairs.mapped(|solids| last_of(&hulls, solids, limit));
            assert_eq!(found, [expected; 2], "{share} of the distance");
        }
        let mesh_and_ball = [(&mesh, Some(1)), (&ball, None)];
        assert!(!hulls.are_beyond(mesh_and_ball, f64::INFINITY), "no limit");
        assert!(!last_of(&hulls, [(&flat, Some(0)), (&ball, None)], 0.0), "it has no volume");
        let made: Vec<_> =
            hulls.0.iter().map(|hull| hull.made.get().map(Option::is_some)).collect();
        assert_eq!(made, [Some(false), Some(true), None], "after enough requests");
    }

    #[test]
    fn a_line_of_the_plane_has_a_hull() {
        let corners = [[0.0, 0.0], [2.0, 0.0], [0.0, 2.0]].mapped(Point::<f64, 2>::from);
        let line = Polyline::open(corners.to_vec());
        let (ball, hulls) = (Ball::new(0.5), BodyHulls::new(1));
        let (line, ball) = (at([0.0; 2], &line), at([0.0, -1.0], &ball));
        let are_beyond = |limit| last_of(&hulls, [(&line, Some(0)), (&ball, None)], limit);
        assert_eq!([0.49, 0.5].mapped(are_beyond), [true, false]);
    }
}
