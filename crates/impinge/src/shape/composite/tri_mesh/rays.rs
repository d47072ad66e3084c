//! Ray tests against the triangles of a mesh. The signs of areas cull the triangles of a leaf block
//! in one step.

use core::hint::black_box;

use super::TriMesh;
use super::build::box_of_corners;
use crate::bounding_volume::{Aabb, Ray};
use crate::bvh::{NONE, RayProbe, RayVisitor, ShearedLine, Slabs, TriangleAt, Triangles, Walk};
use crate::math::{Mapped, Point, Pose, Real, Space, min};
use crate::partitioning::BoxTree;
use crate::shape::{Part, PartSearch, PartSolid, Triangle};

/// The callback for each part along a ray; see
/// [`CompositeShape::parts_along`](crate::shape::CompositeShape::parts_along).
type HitVisitor<'a, N, const D: usize> = &'a mut dyn FnMut(u32, Part<'_, N, D>) -> N;

/// A ray in the frame of the mesh: `around` is a box around the ray's origin that contains its
/// rounding error, `limit` the latest time of a hit.
#[derive(Clone, Copy, Debug)]
pub(super) struct RayBounds<'a, N: Real, const D: usize> {
    pub(super) ray: &'a Ray<N, D>,
    pub(super) around: &'a Aabb<N, D>,
    pub(super) limit: N,
}

impl<N: Space<D>, const D: usize> TriMesh<N, D> {
    /// Moves the box `bounds.around` along the ray, and calls `visit` with each part whose box it
    /// hits up to the limit.
    pub(super) fn boxes_along(&self, bounds: &RayBounds<'_, N, D>, visit: HitVisitor<'_, N, D>) {
        let RayBounds { ray, around, limit } = *bounds;
        self.tree.cast(around, &ray.dir, limit, &mut |index, _| {
            visit(index, triangle_part(&self.corners(index)))
        });
    }
}

impl<N: Real> TriMesh<N, 3> {
    /// Returns the corners of the triangles in the order of the tree, one block per leaf block.
    pub(super) fn packed(
        tree: &BoxTree<N, 3>,
        vertices: &[Point<N, 3>],
        triangles: &[[u32; 3]],
    ) -> Vec<Triangles> {
        let block = |ids: &[u32; crate::bvh::LANES]| {
            let mut block = Triangles::EMPTY;
            for (lane, &id) in ids.iter().enumerate().filter(|&(_, &id)| id != NONE) {
                let corner = |vertex: u32| vertices[vertex as usize].coords.map(N::as_f32).into();
                block.set_lane(lane, &triangles[id as usize].map(corner));
            }
            block
        };
        tree.packed().leaves().iter().map(block).collect()
    }

    /// Calls `visit` with the parts that pass two tests: the box, and the signs of the areas that
    /// the sides span with the ray. If the direction is zero, only the box is tested.
    ///
    /// The box of a part is tested last. Where areas underflow, their signs are meaningless here
    /// and in the exact test, and only the box rejects the part.
    pub(super) fn parts_on_ray(&self, bounds: &RayBounds<'_, N, 3>, visit: HitVisitor<'_, N, 3>) {
        let RayBounds { ray, around, limit } = *bounds;
        if ray.dir.iter().all(|&x| x == N::ZERO) {
            return self.boxes_along(bounds, visit);
        }
        let mut lowest = limit;
        let mut propose = |index: u32, corners: &[Point<N, 3>; 3]| {
            let enter = box_of_corners(corners).sweep_interval(around, &ray.dir);
            if enter.is_some_and(|(enter, _)| enter <= lowest) {
                lowest = min(lowest, visit(index, triangle_part(corners)));
            }
            lowest
        };
        let unbounded = self.tree.unbounded().iter();
        let limit = unbounded.fold(limit, |_, &index| propose(index, &self.corners(index)));
        let probe = self.ray_probe(ray, around);
        self.visit_triangles(&probe, probe.slabs.limit(limit), |index, corners| {
            probe.slabs.limit(propose(index, corners))
        });
    }

    /// Returns the per-ray data of the block tests; the direction of the ray must not be zero.
    /// `around` is as in [`RayBounds`].
    #[inline(always)]
    pub(crate) fn ray_probe(&self, ray: &Ray<N, 3>, around: &Aabb<N, 3>) -> RayProbe {
        let size = self.tree.packed().size();
        let slabs = Slabs::new(around, &ray.dir, size);
        RayProbe { slabs, line: ShearedLine::new(ray, around, size) }
    }

    /// Calls `visit` with the triangles that the ray may hit before `limit`; `visit` returns the
    /// new limit. Limits are times in the unit of the probe. Ghosts are not visited.
    #[inline(always)]
    pub(crate) fn visit_triangles(
        &self,
        probe: &RayProbe,
        limit: f32,
        mut visit: impl FnMut(u32, &[Point<N, 3>; 3]) -> f32,
    ) {
        let tree = self.tree.packed();
        tree.visit_triangles(&self.packed, probe, limit, |at| visit(at.id, &self.corners_in(&at)));
    }

    /// Runs [`Self::visit_triangles`] for many rays at once.
    pub(crate) fn visit_triangles_of_many(
        &self,
        walks: &mut [Walk],
        visitor: &mut impl RayVisitor,
    ) {
        let tree = self.tree.packed();
        if !tree.is_empty() {
            tree.visit_triangles_of_many(&self.packed, walks, visitor);
        }
    }

    /// Prefetches the corners of a triangle that [`Self::corners_in`] will read: loads one
    /// coordinate of each. Does nothing if the blocks hold the corners.
    #[inline(always)]
    pub(crate) fn touch_corners(&self, index: u32) {
        let triangle = self.triangles.get(index as usize).filter(|_| !holds_all::<N>());
        black_box(triangle.map(|corners| corners.mapped(|at| self.vertices[at as usize][0])));
    }

    /// Returns the corners of a triangle: from its block if `f32` represents the scalar `N`
    /// exactly, else from the vertices.
    #[inline(always)]
    pub(crate) fn corners_in(&self, at: &TriangleAt<'_>) -> [Point<N, 3>; 3] {
        if !holds_all::<N>() {
            return self.corners(at.id);
        }
        at.block.lane(at.lane).map(|corner| Point::from(corner.map(|x| N::lit(f64::from(x)))))
    }
}

/// Returns whether blocks, which store `f32`, hold corners of the scalar `N` exactly.
fn holds_all<N: Real>() -> bool {
    N::EPSILON.as_f64() >= f64::from(f32::EPSILON)
}

fn triangle_part<'a, N: Real, const D: usize>(corners: &[Point<N, D>; 3]) -> Part<'a, N, D> {
    let [a, b, c] = *corners;
    Part { pose: Pose::identity(), solid: PartSolid::Triangle(Triangle::new(a, b, c)) }
}
