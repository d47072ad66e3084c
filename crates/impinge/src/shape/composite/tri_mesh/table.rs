//! What a mesh does differently in 2D and 3D.

use core::fmt;

use super::TriMesh;
use super::rays::RayBounds;
use crate::bvh::Triangles;
use crate::math::{Point, Real, Vector};
use crate::partitioning::BoxTree;
use crate::shape::{FeatureId, Part};

/// Function pointers for one dimension.
#[derive(Clone, Copy)]
pub(crate) struct MeshTable<N: Real, const D: usize> {
    /// The unit normal on the front of a triangle, zero without area; `None` where triangles have
    /// no front.
    pub(super) normal: Option<NormalFn<N, D>>,
    pub(super) admits: AdmitsFn<N, D>,
    pub(super) admits_in_turn: InTurnFn<N, D>,
    pub(super) snapped: SnappedFn<N, D>,
    /// The triangles as rays look at them, in the order of the tree; none where boxes are enough.
    pub(super) packed: PackedFn<N, D>,
    pub(super) parts_along: AlongFn<N, D>,
}

type PackedFn<N, const D: usize> =
    fn(&BoxTree<N, D>, &[Point<N, D>], &[[u32; 3]]) -> Vec<Triangles>;
type AlongFn<N, const D: usize> =
    fn(&TriMesh<N, D>, &RayBounds<'_, N, D>, &mut dyn FnMut(u32, Part<'_, N, D>) -> N);

type NormalFn<N, const D: usize> = fn(&[Point<N, D>; 3]) -> Vector<N, D>;
type AdmitsFn<N, const D: usize> = fn(&TriMesh<N, D>, u32, FeatureId, &Vector<N, D>) -> bool;
type InTurnFn<N, const D: usize> =
    fn(&TriMesh<N, D>, u32, FeatureId, [&Vector<N, D>; 2]) -> [bool; 2];
type SnappedFn<N, const D: usize> = fn(&TriMesh<N, D>, u32, &Vector<N, D>) -> Option<Vector<N, D>>;

impl<N: Real> MeshTable<N, 2> {
    pub(crate) const IN_PLANE: Self = Self {
        normal: None,
        admits: TriMesh::<N, 2>::admits_in_plane,
        admits_in_turn: |mesh, part, feature, [first, second]| {
            let is_first = mesh.admits_in_plane(part, feature, first);
            [is_first, !is_first && mesh.admits_in_plane(part, feature, second)]
        },
        snapped: TriMesh::<N, 2>::snapped_in_plane,
        packed: |_, _, _| Vec::new(),
        parts_along: TriMesh::<N, 2>::boxes_along,
    };
}

impl<N: Real> MeshTable<N, 3> {
    pub(crate) const IN_SPACE: Self = Self {
        normal: Some(super::surface3::normal_of),
        admits: TriMesh::<N, 3>::admits_in_space,
        admits_in_turn: TriMesh::<N, 3>::admits_in_turn_in_space,
        snapped: TriMesh::<N, 3>::snapped_in_space,
        packed: TriMesh::<N, 3>::packed,
        parts_along: TriMesh::<N, 3>::triangles_along,
    };
}

impl<N: Real, const D: usize> fmt::Debug for MeshTable<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("MeshTable").finish_non_exhaustive()
    }
}
