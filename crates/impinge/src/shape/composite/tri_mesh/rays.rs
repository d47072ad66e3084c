//! Rays among the triangles of a mesh: sixteen at once are sorted out by their signs.

use super::TriMesh;
use super::build::box_of_corners;
use crate::bounding_volume::{Aabb, Ray};
use crate::bvh::{NONE, RayProbe, ShearedLine, Slabs, Triangles};
use crate::math::{Point, Pose, Real, Space, min};
use crate::partitioning::BoxTree;
use crate::shape::{Part, PartSearch, PartSolid, Triangle};

/// What is done with each part along a ray; see
/// [`CompositeShape::parts_along`](crate::shape::CompositeShape::parts_along).
type HitVisitor<'a, N, const D: usize> = &'a mut dyn FnMut(u32, Part<'_, N, D>) -> N;

/// Where a ray starts, in the frame of the mesh, with all that rounding makes of the place; and when it
/// ends.
#[derive(Clone, Copy, Debug)]
pub(super) struct RayBounds<'a, N: Real, const D: usize> {
    pub(super) ray: &'a Ray<N, D>,
    pub(super) around: &'a Aabb<N, D>,
    pub(super) limit: N,
}

impl<N: Space<D>, const D: usize> TriMesh<N, D> {
    /// Finds the parts by their boxes alone.
    pub(super) fn boxes_along(&self, bounds: &RayBounds<'_, N, D>, visit: HitVisitor<'_, N, D>) {
        let RayBounds { ray, around, limit } = *bounds;
        self.tree.cast(around, &ray.dir, limit, &mut |index, _| {
            visit(index, triangle_part(&self.corners(index)))
        });
    }
}

impl<N: Real> TriMesh<N, 3> {
    /// The triangles in the order of the tree, block by block.
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

    /// Finds the parts by their boxes, block by block, and by the signs of their areas around the ray.
    ///
    /// The box of a part is looked at last: where areas underflow their signs say nothing, nor do those
    /// of the test that decides.
    pub(super) fn triangles_along(
        &self,
        bounds: &RayBounds<'_, N, 3>,
        visit: HitVisitor<'_, N, 3>,
    ) {
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
        let tree = self.tree.packed();
        let size = tree.size();
        let slabs = Slabs::new(around, &ray.dir, size);
        let probe = RayProbe { slabs, line: ShearedLine::new(ray, around, size) };
        tree.visit_triangles(&self.packed, &probe, slabs.limit(limit), |index, block, lane| {
            slabs.limit(propose(index, &self.corners_in(index, block, lane)))
        });
    }

    /// The corners of a triangle: from the block at hand where it holds them exactly.
    #[inline]
    fn corners_in(&self, index: u32, block: &Triangles, lane: usize) -> [Point<N, 3>; 3] {
        let is_single = N::EPSILON.as_f64() >= f64::from(f32::EPSILON);
        if !is_single {
            return self.corners(index);
        }
        block.lane(lane).map(|corner| Point::from(corner.map(|x| N::lit(f64::from(x)))))
    }
}

fn triangle_part<'a, N: Real, const D: usize>(corners: &[Point<N, D>; 3]) -> Part<'a, N, D> {
    let [a, b, c] = *corners;
    Part { pose: Pose::identity(), solid: PartSolid::Triangle(Triangle::new(a, b, c)) }
}
