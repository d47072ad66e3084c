//! Algorithms of meshes, and conversions of shapes for saved worlds, that differ between 2D and 3D.

use super::rays::RayBounds;
use super::{TriMesh, surface3};
use crate::bvh::Triangles;
#[cfg(feature = "serde")]
use crate::math::numbers::Damage;
use crate::math::{Point, Real, Vector};
use crate::partitioning::BoxTree;
#[cfg(feature = "serde")]
use crate::shape::composite::polyline::Front;
#[cfg(feature = "serde")]
use crate::shape::saved::{ShapeRecord, front2, front3, make2, make3, record2, record3};
use crate::shape::{FaceSeams, FeatureId, Part, Polyline};
#[cfg(feature = "serde")]
use crate::shape::{Shape, ShapeHandle};
use crate::tables::Here;

/// The algorithms of meshes that differ by dimension.
#[expect(unnameable_types, private_interfaces, reason = "for this crate alone")]
pub trait MeshByDimension<N: Real, const D: usize> {
    /// Returns the unit normal on the front of a triangle, zero for a triangle without area. `None`
    /// in 2D, where triangles have no front.
    fn mesh_normal(corners: &[Point<N, D>; 3]) -> Option<Vector<N, D>>;

    /// Implements [`Surface::admits`](crate::shape::Surface::admits).
    fn mesh_admits(
        mesh: &TriMesh<N, D>,
        part: u32,
        feature: FeatureId,
        normal: &Vector<N, D>,
    ) -> bool;

    /// Returns whether the mesh admits the first normal, and whether it rejects the first and
    /// admits the second.
    fn mesh_admits_in_turn(
        mesh: &TriMesh<N, D>,
        part: u32,
        feature: FeatureId,
        normals: [&Vector<N, D>; 2],
    ) -> [bool; 2];

    /// Runs [`Self::mesh_admits_in_turn`] at a corner, for normals that differ from the normal of
    /// the triangle. `corner` has the index of the corner, and whether another triangle at the
    /// corner is known not to be coplanar with this triangle.
    fn mesh_corner_admits_in_turn(
        mesh: &TriMesh<N, D>,
        part: u32,
        corner: (usize, bool),
        normals: [&Vector<N, D>; 2],
    ) -> [bool; 2];

    /// Returns the edge angles between a triangle and its neighbours; `None` in 2D, for a triangle
    /// without area, and if the mesh keeps its internal edges.
    fn mesh_face_seams(mesh: &TriMesh<N, D>, part: u32) -> Option<FaceSeams<N>>;

    /// Implements [`Surface::snapped`](crate::shape::Surface::snapped).
    fn mesh_snapped(mesh: &TriMesh<N, D>, part: u32, normal: &Vector<N, D>)
    -> Option<Vector<N, D>>;

    /// Implements [`CompositeShape::winds_around`](crate::shape::CompositeShape::winds_around) for
    /// a mesh.
    fn mesh_winds_around(mesh: &TriMesh<N, D>, point: &Point<N, D>) -> bool;

    /// Implements [`CompositeShape::winds_around`](crate::shape::CompositeShape::winds_around) for
    /// a polyline.
    fn line_winds_around(line: &Polyline<N, D>, point: &Point<N, D>) -> bool;

    /// Returns the blocks of triangle corners for ray tests, in the order of the tree; empty in 2D,
    /// where boxes suffice.
    fn mesh_packed(
        tree: &BoxTree<N, D>,
        vertices: &[Point<N, D>],
        triangles: &[[u32; 3]],
    ) -> Vec<Triangles>;

    /// Calls `visit` with the parts that a ray may hit; `visit` returns the new time limit.
    fn mesh_parts_along(
        mesh: &TriMesh<N, D>,
        bounds: &RayBounds<'_, N, D>,
        visit: &mut dyn FnMut(u32, Part<'_, N, D>) -> N,
    );

    /// Returns the record of a shape whose type exists in this dimension only; `None` for any other
    /// type.
    #[cfg(feature = "serde")]
    fn shape_record(shape: &dyn Shape<N, D>) -> Option<ShapeRecord<N>>;

    /// Restores the shape whose record [`Self::shape_record`] returned; an error for a damaged
    /// record or another kind.
    #[cfg(feature = "serde")]
    fn make_shape(record: &ShapeRecord<N>) -> Result<ShapeHandle<N, D>, Damage>;

    /// Returns the function that maps the direction of a segment to the normal on its front; `None`
    /// in 3D, where segments have no front.
    #[cfg(feature = "serde")]
    fn line_front() -> Option<Front<N, D>>;
}

#[expect(private_interfaces, reason = "for this crate alone")]
impl<N: Real> MeshByDimension<N, 2> for Here {
    fn mesh_normal(_: &[Point<N, 2>; 3]) -> Option<Vector<N, 2>> {
        None
    }

    fn mesh_admits(
        mesh: &TriMesh<N, 2>,
        part: u32,
        feature: FeatureId,
        normal: &Vector<N, 2>,
    ) -> bool {
        mesh.admits_2d(part, feature, normal)
    }

    fn mesh_admits_in_turn(
        mesh: &TriMesh<N, 2>,
        part: u32,
        feature: FeatureId,
        [first, second]: [&Vector<N, 2>; 2],
    ) -> [bool; 2] {
        let is_first = mesh.admits_2d(part, feature, first);
        [is_first, !is_first && mesh.admits_2d(part, feature, second)]
    }

    fn mesh_corner_admits_in_turn(
        mesh: &TriMesh<N, 2>,
        part: u32,
        (corner, _): (usize, bool),
        normals: [&Vector<N, 2>; 2],
    ) -> [bool; 2] {
        Self::mesh_admits_in_turn(mesh, part, FeatureId::Vertex([0, 1, 2][corner]), normals)
    }

    fn mesh_face_seams(_: &TriMesh<N, 2>, _: u32) -> Option<FaceSeams<N>> {
        None
    }

    fn mesh_snapped(
        mesh: &TriMesh<N, 2>,
        part: u32,
        normal: &Vector<N, 2>,
    ) -> Option<Vector<N, 2>> {
        mesh.snapped_2d(part, normal)
    }

    fn mesh_winds_around(_: &TriMesh<N, 2>, _: &Point<N, 2>) -> bool {
        false
    }

    fn line_winds_around(line: &Polyline<N, 2>, point: &Point<N, 2>) -> bool {
        line.winding_of(point, |_| true) != Some(0)
    }

    fn mesh_packed(_: &BoxTree<N, 2>, _: &[Point<N, 2>], _: &[[u32; 3]]) -> Vec<Triangles> {
        Vec::new()
    }

    fn mesh_parts_along(
        mesh: &TriMesh<N, 2>,
        bounds: &RayBounds<'_, N, 2>,
        visit: &mut dyn FnMut(u32, Part<'_, N, 2>) -> N,
    ) {
        mesh.boxes_along(bounds, visit);
    }

    #[cfg(feature = "serde")]
    fn shape_record(shape: &dyn Shape<N, 2>) -> Option<ShapeRecord<N>> {
        record2(shape)
    }

    #[cfg(feature = "serde")]
    fn make_shape(record: &ShapeRecord<N>) -> Result<ShapeHandle<N, 2>, Damage> {
        make2(record)
    }

    #[cfg(feature = "serde")]
    fn line_front() -> Option<Front<N, 2>> {
        front2()
    }
}

#[expect(private_interfaces, reason = "for this crate alone")]
impl<N: Real> MeshByDimension<N, 3> for Here {
    fn mesh_normal(corners: &[Point<N, 3>; 3]) -> Option<Vector<N, 3>> {
        Some(surface3::normal_of(corners))
    }

    fn mesh_admits(
        mesh: &TriMesh<N, 3>,
        part: u32,
        feature: FeatureId,
        normal: &Vector<N, 3>,
    ) -> bool {
        mesh.admits_3d(part, feature, normal)
    }

    fn mesh_admits_in_turn(
        mesh: &TriMesh<N, 3>,
        part: u32,
        feature: FeatureId,
        normals: [&Vector<N, 3>; 2],
    ) -> [bool; 2] {
        mesh.admits_in_turn_3d(part, feature, normals)
    }

    fn mesh_corner_admits_in_turn(
        mesh: &TriMesh<N, 3>,
        part: u32,
        corner: (usize, bool),
        [first, second]: [&Vector<N, 3>; 2],
    ) -> [bool; 2] {
        let is_first = mesh.vertex_admits(part, corner, first);
        [is_first, !is_first && mesh.vertex_admits(part, corner, second)]
    }

    fn mesh_face_seams(mesh: &TriMesh<N, 3>, part: u32) -> Option<FaceSeams<N>> {
        mesh.face_seams_3d(part)
    }

    fn mesh_snapped(
        mesh: &TriMesh<N, 3>,
        part: u32,
        normal: &Vector<N, 3>,
    ) -> Option<Vector<N, 3>> {
        mesh.snapped_3d(part, normal)
    }

    fn mesh_winds_around(mesh: &TriMesh<N, 3>, point: &Point<N, 3>) -> bool {
        mesh.winding_of(point, |_| true) != Some(0)
    }

    fn line_winds_around(_: &Polyline<N, 3>, _: &Point<N, 3>) -> bool {
        false
    }

    fn mesh_packed(
        tree: &BoxTree<N, 3>,
        vertices: &[Point<N, 3>],
        triangles: &[[u32; 3]],
    ) -> Vec<Triangles> {
        TriMesh::<N, 3>::packed(tree, vertices, triangles)
    }

    fn mesh_parts_along(
        mesh: &TriMesh<N, 3>,
        bounds: &RayBounds<'_, N, 3>,
        visit: &mut dyn FnMut(u32, Part<'_, N, 3>) -> N,
    ) {
        mesh.parts_on_ray(bounds, visit);
    }

    #[cfg(feature = "serde")]
    fn shape_record(shape: &dyn Shape<N, 3>) -> Option<ShapeRecord<N>> {
        record3(shape)
    }

    #[cfg(feature = "serde")]
    fn make_shape(record: &ShapeRecord<N>) -> Result<ShapeHandle<N, 3>, Damage> {
        make3(record)
    }

    #[cfg(feature = "serde")]
    fn line_front() -> Option<Front<N, 3>> {
        front3()
    }
}
