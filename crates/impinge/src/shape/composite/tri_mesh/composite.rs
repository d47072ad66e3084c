//! Implementation of [`CompositeShape`] for meshes: the triangles and the seams between them.

use super::MeshByDimension;
use super::rays::RayBounds;
use super::{TriMesh, entries};
use crate::bounding_volume::{Aabb, BoundingSphere, Ray};
use crate::math::{Point, Pose, Real, Space, Vector, max};
use crate::partitioning::BoxTree;
use crate::shape::solids::segment::length_of;
use crate::shape::surface::own_surface::OwnSurface;
use crate::shape::{
    CompositeShape, EnclosedBody, FaceSeams, FeatureId, Geometry, Kind, Part, PartSearch,
    PartSolid, Revision, ScaleError, Shape, ShapeHandle, Surface, SurfaceAccess,
};

impl<N: Space<D>, const D: usize> CompositeShape<N, D> for TriMesh<N, D> {
    fn num_parts(&self) -> u32 {
        u32::try_from(self.num_triangles()).expect("32 bits number the triangles")
    }

    fn part(&self, part: u32) -> Part<'_, N, D> {
        Part { pose: Pose::identity(), solid: PartSolid::Triangle(self.triangle(part)) }
    }

    fn search(&self) -> &dyn PartSearch<N, D> {
        &self.tree
    }

    fn parts_along(
        &self,
        ray: &Ray<N, D>,
        around: &Aabb<N, D>,
        limit: N,
        visit: &mut dyn FnMut(u32, Part<'_, N, D>) -> N,
    ) {
        entries::parts_along(self, &RayBounds { ray, around, limit }, visit);
    }

    fn surface(&self) -> Option<&dyn Surface<N, D>> {
        (self.is_one_sided || !self.keeps_internal_edges).then_some(self)
    }

    fn surface_access(&self) -> Option<SurfaceAccess<'_, N, D>> {
        self.surface().map(|_| SurfaceAccess::of_own(self))
    }

    fn each_corner(&self, part: u32, visit: &mut dyn FnMut(u64)) {
        let corners = &self.triangles[part as usize];
        corners.iter().for_each(|&vertex| visit(self.topology.joints.of(vertex).into()));
    }

    fn built_in(&self) -> Option<&dyn Shape<N, D>> {
        Some(self)
    }

    fn as_mesh(&self) -> Option<&Self> {
        Some(self)
    }

    fn revision(&self) -> Option<Revision> {
        let options = [self.is_one_sided, self.is_solid, self.keeps_internal_edges];
        Some(self.revision.with(&options))
    }

    fn each_body(&self, visit: &mut dyn FnMut(&EnclosedBody<'_, N, D>)) {
        if self.is_solid() {
            visit(&EnclosedBody::within(self));
        }
    }

    fn has_bodies(&self) -> bool {
        self.is_solid()
    }

    fn has_ghosts(&self) -> bool {
        self.ghosts > 0
    }

    fn winds_around(&self, point: &Point<N, D>) -> bool {
        <N::Algorithms>::mesh_winds_around(self, point)
    }

    fn piece_of(&self, part: u32) -> u32 {
        self.pieces()[part as usize]
    }
}

impl<N: Space<D>, const D: usize> Surface<N, D> for TriMesh<N, D> {
    fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<N, D>) -> bool {
        entries::admits(self, part, feature, normal)
    }

    fn snapped(&self, part: u32, normal: &Vector<N, D>) -> Option<Vector<N, D>> {
        entries::snapped(self, part, normal)
    }

    fn faces(&self, part: u32, center: &Point<N, D>) -> bool {
        // A triangle without area has a zero normal; contacts arise on both its sides.
        let is_behind = || {
            let corner = self.vertices[self.triangles[part as usize][0] as usize];
            self.normals[part as usize].dot(&(center - corner)) < N::ZERO
        };
        !(self.is_one_sided && is_behind())
    }
}

impl<N: Space<D>, const D: usize> OwnSurface<N, D> for TriMesh<N, D> {
    fn admits_in_turn(
        &self,
        part: u32,
        feature: FeatureId,
        normals: [&Vector<N, D>; 2],
    ) -> [bool; 2] {
        entries::admits_in_turn(self, part, feature, normals)
    }

    fn corner_admits_in_turn(
        &self,
        part: u32,
        corner: usize,
        known: &FaceSeams<N>,
        normals: [&Vector<N, D>; 2],
    ) -> [bool; 2] {
        entries::corner_admits_in_turn(self, part, (corner, known.is_bent_at(corner)), normals)
    }

    fn face_seams(&self, part: u32) -> Option<FaceSeams<N>> {
        entries::face_seams(self, part)
    }

    fn is_body(&self, _: u32) -> bool {
        self.is_solid()
    }

    fn each_ghost_beside(&self, part: u32, visit: &mut dyn FnMut(u32)) {
        if self.ghosts == 0 {
            return;
        }
        let around = (0..3).flat_map(|at| self.topology.joints.parts(self.joint_at(part, at)));
        let is_ghost = |other: &&u32| **other as usize >= self.num_triangles();
        around.filter(is_ghost).for_each(|ghost| visit(*ghost));
    }

    fn has_regular_seams(&self) -> bool {
        !(self.keeps_internal_edges || self.topology.is_moved)
    }
}

impl<N: Space<D>, const D: usize> Shape<N, D> for TriMesh<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry(Kind::Composite(self))
    }

    /// Returns the smallest box around the triangles. O(1).
    fn local_aabb(&self) -> Aabb<N, D> {
        self.tree.bounds().copied().unwrap_or_else(Aabb::unbounded)
    }

    /// Returns the smallest box around the triangles placed at `pose`, up to rounding. O(log n) for
    /// a nearly convex mesh, up to O(n) if many triangles extend almost equally far along an axis.
    fn aabb(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        aabb_at(pose, self.triangles(), &self.vertices, &self.tree)
    }

    /// Returns the sphere about the centre of the local box through the farthest vertex. O(n).
    fn local_bounding_sphere(&self) -> BoundingSphere<N, D> {
        sphere_around(&self.local_aabb(), self.triangles().as_flattened().iter(), &self.vertices)
    }

    fn scaled(&self, scale: &Vector<N, D>) -> Result<ShapeHandle<N, D>, ScaleError> {
        Ok(ShapeHandle::new(self.try_scaled(scale)?))
    }
}

/// Meshes with at most this many corners are placed corner by corner to compute their box.
const MAX_PLACED: usize = 192;

/// Returns the box around the vertices of parts placed at `pose`. Uses all vertices if there are
/// few, else the extreme vertices that the tree finds.
pub(in crate::shape) fn aabb_at<N: Space<D>, const D: usize, const K: usize>(
    pose: &Pose<N, D>,
    parts: &[[u32; K]],
    vertices: &[Point<N, D>],
    tree: &BoxTree<N, D>,
) -> Aabb<N, D> {
    let Some(bounds) = tree.bounds() else { return Aabb::unbounded() };
    let size = BoundingSphere::around_box(bounds).farthest_from(&Point::origin());
    let corner = |&vertex: &u32| vertices[vertex as usize].coords;
    if parts.len() * K <= MAX_PLACED {
        let rotated = Aabb::around_all(
            parts.as_flattened().iter().map(|vertex| Point::from(pose.vector(&corner(vertex)))),
        );
        // `None` if a rotated coordinate is NaN, as for a rotation with NaN. The result is then
        // unbounded.
        return rotated.map_or_else(Aabb::unbounded, |rotated| {
            Aabb::of_rotated(rotated.mins().coords, rotated.maxs().coords, size, pose)
        });
    }
    let extent = |direction: Vector<N, D>| {
        tree.extent_along(direction, |part| {
            let along = parts[part as usize].iter().map(|vertex| corner(vertex).dot(&direction));
            along.fold(-N::INFINITY, max)
        })
    };
    let (mut low, mut high) = (Vector::<N, D>::zeros(), Vector::<N, D>::zeros());
    for axis in 0..D {
        let direction = pose.rotation.row(axis).transpose();
        (low[axis], high[axis]) = (-extent(-direction), extent(direction));
    }
    Aabb::of_rotated(low, high, size, pose)
}

/// Returns the sphere about the centre of `aabb` that contains the vertices in `used`. Its radius
/// exceeds the distance of the farthest of these vertices by a bound of the rounding error. All of
/// space if the radius overflows.
pub(in crate::shape) fn sphere_around<'a, N: Real, const D: usize>(
    aabb: &Aabb<N, D>,
    used: impl Iterator<Item = &'a u32>,
    vertices: &[Point<N, D>],
) -> BoundingSphere<N, D> {
    let center = aabb.center();
    let distances = used.map(|&vertex| length_of(&(vertices[vertex as usize] - center)));
    let radius = distances.fold(N::ZERO, max) * (N::ONE + N::lit(4.0) * N::EPSILON);
    BoundingSphere::try_new(center, radius).unwrap_or(BoundingSphere::unbounded())
}
