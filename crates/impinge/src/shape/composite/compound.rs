//! Compounds: unions of placed shapes.

use crate::bounding_volume::{Aabb, BoundingSphere, BoundingVolume};
use crate::math::{Matrix, Point, Pose, Real, Space, Vector, is_unit, max, max_component, min};
use crate::partitioning::BoxTree;
use crate::shape::composite::compound_search::search_box;
use crate::shape::error::{nesting, or_panic};
use crate::shape::scale::Scale;
use crate::shape::solids::segment::length_of;
use crate::shape::surface::own_surface::OwnSurface;
use crate::shape::{
    CompositeShape, EnclosedBody, FeatureId, Geometry, Part, PartPath, PartSearch, PartSolid,
    Revision, ScaleError, Shape, ShapeError, ShapeHandle, Surface, SurfaceAccess,
};

/// The union of shapes, its children, each placed in the compound's frame.
///
/// Children may be of any kind: convex solids, half-spaces, meshes, height fields, compounds. The
/// compound's parts are the parts of its children, indexed in order: first the parts of child 0,
/// then the parts of child 1, … A child that is not a composite is one part. The path to a part is
/// the index of the child, then the path within the child.
///
/// Seams are handled within the surface of a child, not between children. A search uses the tree
/// over the boxes of the children, then runs in each composite child that it finds, with the search
/// box transformed into the frame of that child.
///
/// Compounds nest up to [`MAX_NESTING`](crate::shape::MAX_NESTING) deep.
///
/// Cloning shares the shapes. Construction costs O(n log n) in the number of children.
///
/// ```
/// use impinge::dim3::math::{Isometry, Vector};
/// use impinge::dim3::shape::{Ball, Compound, Cuboid, ShapeHandle};
///
/// // A hammer, and a rack with two hammers.
/// let handle = ShapeHandle::new(Cuboid::new(Vector::new(0.5_f32, 0.1, 0.1)));
/// let head = ShapeHandle::new(Ball::new(0.25));
/// let hammer = ShapeHandle::new(Compound::new(vec![
///     (Isometry::identity(), handle),
///     (Isometry::translation(0.5, 0.0, 0.0), head),
/// ]));
/// let rack = ShapeHandle::new(Compound::new(vec![
///     (Isometry::identity(), hammer.clone()),
///     (Isometry::translation(0.0, 0.0, 2.0), hammer),
/// ]));
/// assert_eq!(rack.local_aabb().maxs().z, 2.25);
/// // Part 3 is the second solid of the second child.
/// assert_eq!(rack.path_to_part(3).as_slice(), [1, 1]);
/// ```
#[derive(Clone)]
pub struct Compound<N: Space<D>, const D: usize> {
    children: Vec<(N::Isometry, ShapeHandle<N, D>)>,
    pub(in crate::shape) poses: Vec<Pose<N, D>>,
    /// The index of the first part of each child, then the number of all parts.
    pub(in crate::shape) firsts: Vec<u32>,
    /// The nesting depth, at least 1 more than the depth of each child.
    depth: u32,
    /// The union of the boxes of the children.
    aabb: Aabb<N, D>,
    /// The tree over the boxes of the children. Each box is enlarged by the rounding errors of
    /// placing its child; see [`search_box`].
    pub(in crate::shape) tree: BoxTree<N, D>,
    sphere: BoundingSphere<N, D>,
    /// Whether any child is a composite whose parts form a surface ([`CompositeShape::surface`]).
    /// Contacts then follow the rule for seams.
    has_surface: bool,
    /// Whether any child encloses a solid region by a closed surface: has an [`EnclosedBody`].
    has_bodies: bool,
    /// Whether any child has ghost parts.
    has_ghosts: bool,
    revision: Revision,
}

/// With at most this many children, [`Shape::aabb`] of a compound returns the union of the boxes of
/// its children.
const FEW_CHILDREN: usize = 32;

impl<N: Space<D>, const D: usize> Compound<N, D> {
    /// Returns the union of the given shapes at their positions in the compound's frame.
    ///
    /// # Panics
    /// If [`Self::try_new`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn new(children: Vec<(N::Isometry, ShapeHandle<N, D>)>) -> Self {
        or_panic(Self::try_new(children))
    }

    /// Returns the union of the given shapes at their positions in the compound's frame.
    ///
    /// # Errors
    /// If there are no children, a position is not finite, a rotation is not of unit length, the
    /// parts do not fit 32-bit indices, or a child already has the nesting depth
    /// [`MAX_NESTING`](crate::shape::MAX_NESTING).
    pub fn try_new(children: Vec<(N::Isometry, ShapeHandle<N, D>)>) -> Result<Self, ShapeError> {
        if children.is_empty() {
            return Err(ShapeError::NoChildren);
        }
        let poses: Vec<_> = children.iter().map(|(position, _)| N::pose(position)).collect();
        if let Some(index) = poses.iter().position(|pose| !pose.is_finite()) {
            return Err(ShapeError::ChildPoseNotFinite { index });
        }
        for (index, (position, _)) in children.iter().enumerate() {
            let squared = N::squared_length_of_rotation(position);
            if !is_unit(squared) {
                let length = squared.as_f64().sqrt();
                return Err(ShapeError::ChildRotation { index, length });
            }
        }
        let depth = nesting(children.iter().map(|(_, shape)| shape.nesting()))?;
        let firsts = first_parts(&children)?;
        let placed = || children.iter().zip(&poses).map(|((_, shape), pose)| (&**shape, pose));
        let boxes = placed().map(|(shape, pose)| boxed(shape, pose));
        let aabb = boxes.reduce(|all, own| all.merged(&own)).unwrap_or_else(Aabb::unbounded);
        let searched: Vec<_> = placed().map(|(shape, pose)| search_box(shape, pose)).collect();
        let tree = BoxTree::from_boxes(&searched);
        let has_surface = children.iter().any(|(_, shape)| surface_of(shape).is_some());
        let has_bodies = children.iter().any(|(_, shape)| bodies_of(shape).is_some());
        let has_ghosts = children.iter().any(|(_, shape)| {
            shape.geometry().as_composite().is_some_and(CompositeShape::has_ghosts)
        });
        let sphere = sphere_around(&aabb, &children, &poses);
        let revision = Revision::new();
        Ok(Self {
            children,
            poses,
            firsts,
            depth,
            aabb,
            tree,
            sphere,
            has_surface,
            has_bodies,
            has_ghosts,
            revision,
        })
    }

    /// Returns the children: each shape with its position in the frame of the compound.
    #[must_use]
    pub fn children(&self) -> &[(N::Isometry, ShapeHandle<N, D>)] {
        &self.children
    }

    /// Returns the number of children, at least one.
    #[must_use]
    pub const fn num_children(&self) -> usize {
        self.children.len()
    }

    /// Returns the compound scaled by `scale` along the axes of its frame, about its origin; see
    /// [`Shape::scaled`].
    ///
    /// Each child is scaled in its own frame. Factors of equal magnitude allow any rotation of a
    /// child. Otherwise the child's rotation must map axes to axes, or have an axis such that the
    /// two factors across it have equal magnitudes: any other rotation would shear the child.
    ///
    /// # Errors
    /// If a factor is zero or not finite, a child would be sheared, a child does not support its
    /// factors, or a scaled position is not finite.
    pub fn try_scaled(&self, scale: &Vector<N, D>) -> Result<Self, ScaleError> {
        let scale = Scale::try_new(scale)?;
        let mut children = Vec::with_capacity(self.children.len());
        for (index, ((_, shape), pose)) in self.children.iter().zip(&self.poses).enumerate() {
            let refused = |_| ScaleError::Child { index };
            let (pose, factors) = scaled_pose(pose, scale).ok_or(ScaleError::Child { index })?;
            let shape = shape.scaled(&factors).map_err(refused)?;
            children.push((N::isometry(&pose), shape));
        }
        Ok(Self::try_new(children)?)
    }

    /// Returns the index of the first part of child `child`.
    pub(crate) fn first_part(&self, child: u32) -> u32 {
        self.firsts[child as usize]
    }

    /// Returns the index of the child that contains `part`, and the part's index within that child.
    ///
    /// # Panics
    /// If `part` is not below the number of parts.
    #[must_use]
    pub fn child_of_part(&self, part: u32) -> (usize, u32) {
        assert!(part < self.num_parts(), "there is no part {part}: they are {}", self.num_parts());
        // A child without parts has the same first index as the next child: the last child with an
        // index at or below `part` owns the part.
        let child = self.firsts.partition_point(|&first| first <= part) - 1;
        (child, part - self.firsts[child])
    }

    /// Returns child `child` as a composite; `None` for a single solid.
    pub(in crate::shape) fn composite(&self, child: usize) -> Option<&dyn CompositeShape<N, D>> {
        self.children[child].1.geometry().as_composite()
    }

    /// Returns the surface of the child that contains `part`, the child's pose, and the part's
    /// index within the child. `None` if the child has no surface.
    fn surface_at(&self, part: u32) -> Option<(SurfaceAccess<'_, N, D>, &Pose<N, D>, u32)> {
        let (child, own) = self.child_of_part(part);
        Some((self.composite(child)?.surface_access()?, &self.poses[child], own))
    }
}

/// Returns the pose of a child of the scaled compound, and the factors in the child's own frame;
/// `None` if the child would be sheared.
///
/// With M the signs and P the magnitudes of the factors, and R the child's rotation: `M P R = (M R
/// M) (M (Rᵀ P R))`. The product is a rotation after a scale if `Rᵀ P R` is diagonal.
fn scaled_pose<N: Real, const D: usize>(
    pose: &Pose<N, D>,
    scale: Scale<'_, N, D>,
) -> Option<(Pose<N, D>, Vector<N, D>)> {
    let signs = scale.signs();
    let mut rotation = pose.rotation;
    for (row, column) in (0..D).flat_map(|row| (0..D).map(move |column| (row, column))) {
        rotation[(row, column)] *= signs[row] * signs[column];
    }
    let own = match scale.uniform() {
        Ok(_) => scale.magnitudes(),
        Err(_) => own_factors(&pose.rotation, &scale.magnitudes())?,
    };
    let translation = scale.vector(&pose.translation);
    Some((Pose { rotation, translation }, own.component_mul(&signs)))
}

/// Returns the diagonal of `Rᵀ P R`; `None` if an off-diagonal element exceeds the rounding error.
///
/// An element within the rounding error of a magnitude is that magnitude, so that equal factors stay
/// equal: cylinders and cones need equal factors across their axis.
fn own_factors<N: Real, const D: usize>(
    rotation: &Matrix<N, D>,
    magnitudes: &Vector<N, D>,
) -> Option<Vector<N, D>> {
    let rotated = rotation.transpose() * Matrix::<N, D>::from_diagonal(magnitudes) * rotation;
    let tolerance = N::lit(16.0) * N::EPSILON * max_component(magnitudes);
    let is_beside = |at: (usize, usize)| at.0 != at.1 && rotated[at].abs() > tolerance;
    let mut all = (0..D).flat_map(|row| (0..D).map(move |column| (row, column)));
    let snapped = |x: N| {
        let near = magnitudes.iter().copied().filter(|own| (*own - x).abs() <= tolerance);
        let nearer = |a: N, b: N| if (b - x).abs() < (a - x).abs() { b } else { a };
        near.reduce(nearer).unwrap_or(x)
    };
    (!all.any(is_beside)).then(|| rotated.diagonal().map(snapped))
}

/// Computes [`Compound::firsts`]: the index of the first part of each child, then the number of
/// parts.
///
/// # Errors
/// If the parts do not fit 32-bit indices.
fn first_parts<N: Space<D>, const D: usize>(
    children: &[(N::Isometry, ShapeHandle<N, D>)],
) -> Result<Vec<u32>, ShapeError> {
    let parts_of = |shape: &ShapeHandle<N, D>| {
        shape.geometry().as_composite().map_or(1, |composite| u64::from(composite.num_parts()))
    };
    let needed = children.iter().map(|(_, shape)| parts_of(shape)).sum();
    let mut firsts = vec![0];
    let mut count = 0_u64;
    for (_, shape) in children {
        count += parts_of(shape);
        firsts.push(u32::try_from(count).map_err(|_| ShapeError::TooManyParts { needed })?);
    }
    Ok(firsts)
}

/// Returns the AABB of `shape` placed at `pose`; unbounded if arithmetic overflows.
pub(in crate::shape) fn boxed<N: Space<D>, const D: usize>(
    shape: &dyn Shape<N, D>,
    pose: &Pose<N, D>,
) -> Aabb<N, D> {
    let aabb = shape.aabb(pose);
    Aabb::try_new(*aabb.mins(), *aabb.maxs()).unwrap_or_else(|_| Aabb::unbounded())
}

/// Returns the smallest sphere about the centre of `aabb` that contains the bounding spheres of the
/// children, or the sphere around `aabb` if that is smaller.
fn sphere_around<N: Space<D>, const D: usize>(
    aabb: &Aabb<N, D>,
    children: &[(N::Isometry, ShapeHandle<N, D>)],
    poses: &[Pose<N, D>],
) -> BoundingSphere<N, D> {
    if !aabb.is_bounded() {
        return BoundingSphere::unbounded();
    }
    let around_box = BoundingSphere::around_box(aabb);
    let center = *around_box.center();
    let reach = children.iter().zip(poses).map(|((_, shape), pose)| {
        shape.local_bounding_sphere().transformed_by(pose).farthest_from(&center)
    });
    let radius = min(reach.fold(N::ZERO, max), around_box.radius());
    BoundingSphere::try_new(center, radius).unwrap_or(BoundingSphere::unbounded())
}

fn surface_of<N: Space<D>, const D: usize>(
    shape: &ShapeHandle<N, D>,
) -> Option<&dyn Surface<N, D>> {
    shape.geometry().as_composite()?.surface()
}

/// Returns the shape as a composite if its parts enclose solid regions ([`EnclosedBody`]), else
/// `None`.
fn bodies_of<N: Space<D>, const D: usize>(
    shape: &ShapeHandle<N, D>,
) -> Option<&dyn CompositeShape<N, D>> {
    shape.geometry().as_composite().filter(|composite| composite.has_bodies())
}

impl<N: Space<D>, const D: usize> CompositeShape<N, D> for Compound<N, D> {
    fn num_parts(&self) -> u32 {
        self.firsts[self.children.len()]
    }

    fn part(&self, part: u32) -> Part<'_, N, D> {
        let (child, own) = self.child_of_part(part);
        let pose = self.poses[child];
        match self.composite(child) {
            Some(composite) => {
                let inner = composite.part(own);
                Part { pose: pose.compose(&inner.pose), solid: inner.solid }
            }
            None => Part { pose, solid: PartSolid::Shape(&*self.children[child].1) },
        }
    }

    fn search(&self) -> &dyn PartSearch<N, D> {
        self
    }

    fn surface(&self) -> Option<&dyn Surface<N, D>> {
        self.has_surface.then_some(self as &dyn Surface<N, D>)
    }

    fn surface_access(&self) -> Option<SurfaceAccess<'_, N, D>> {
        self.surface().map(|_| SurfaceAccess::of_own(self))
    }

    fn revision(&self) -> Option<Revision> {
        Some(self.revision)
    }

    /// Visits the corner numbers that the child reports, with the index of the child's first part
    /// in the upper 32 bits.
    fn each_corner(&self, part: u32, visit: &mut dyn FnMut(u64)) {
        let (child, own) = self.child_of_part(part);
        if let Some(composite) = self.composite(child) {
            let first = u64::from(self.firsts[child]) << 32;
            composite.each_corner(own, &mut |corner| visit(first.wrapping_add(corner)));
        }
    }

    fn extend_path(&self, part: u32, path: &mut PartPath) {
        let (child, own) = self.child_of_part(part);
        path.push(u32::try_from(child).expect("a child has a part, and 32 bits number the parts"));
        if let Some(composite) = self.composite(child) {
            composite.extend_path(own, path);
        }
    }

    fn built_in(&self) -> Option<&dyn Shape<N, D>> {
        Some(self)
    }

    fn each_body(&self, visit: &mut dyn FnMut(&EnclosedBody<'_, N, D>)) {
        if !self.has_bodies {
            return;
        }
        for ((_, shape), (pose, &first)) in
            self.children.iter().zip(self.poses.iter().zip(&self.firsts))
        {
            if let Some(child) = bodies_of(shape) {
                child.each_body(&mut |body| visit(&body.of_child(pose, first)));
            }
        }
    }

    fn has_bodies(&self) -> bool {
        self.has_bodies
    }

    fn has_ghosts(&self) -> bool {
        self.has_ghosts
    }

    fn piece_of(&self, part: u32) -> u32 {
        let (child, own) = self.child_of_part(part);
        let within = self.composite(child).map_or(own, |composite| composite.piece_of(own));
        self.firsts[child] + within
    }
}

/// A part of a child without a surface is a separate solid: every normal is admitted.
impl<N: Space<D>, const D: usize> Surface<N, D> for Compound<N, D> {
    fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<N, D>) -> bool {
        self.surface_at(part).is_none_or(|(surface, pose, own)| {
            surface.admits(own, feature, &pose.inverse_vector(normal))
        })
    }

    fn snapped(&self, part: u32, normal: &Vector<N, D>) -> Option<Vector<N, D>> {
        let (surface, pose, own) = self.surface_at(part)?;
        let snapped = surface.snapped(own, &pose.inverse_vector(normal))?;
        Some(pose.vector(&snapped))
    }

    fn faces(&self, part: u32, center: &Point<N, D>) -> bool {
        self.surface_at(part)
            .is_none_or(|(surface, pose, own)| surface.faces(own, &pose.inverse_point(center)))
    }
}

impl<N: Space<D>, const D: usize> OwnSurface<N, D> for Compound<N, D> {
    fn admits_in_turn(
        &self,
        part: u32,
        feature: FeatureId,
        normals: [&Vector<N, D>; 2],
    ) -> [bool; 2] {
        let Some((surface, pose, own)) = self.surface_at(part) else { return [true, false] };
        let [first, second] = normals.map(|normal| pose.inverse_vector(normal));
        surface.admits_in_turn(own, feature, [&first, &second])
    }

    fn is_body(&self, part: u32) -> bool {
        self.has_bodies
            && self.surface_at(part).is_some_and(|(surface, _, own)| surface.is_body(own))
    }

    fn each_ghost_beside(&self, part: u32, visit: &mut dyn FnMut(u32)) {
        if let Some((surface, _, own)) = self.surface_at(part).filter(|_| self.has_ghosts) {
            surface.each_ghost_beside(own, &mut |ghost| visit(part - own + ghost));
        }
    }
}

impl<N: Space<D>, const D: usize> Shape<N, D> for Compound<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry::composite(self)
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        self.aabb
    }

    /// Returns the union of the boxes of the children, where the box of a composite child is the
    /// box around its rotated local box. If there are more than `FEW_CHILDREN`, returns the box
    /// around the rotated local box of the compound.
    fn aabb(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        if self.children.len() > FEW_CHILDREN {
            return self.local_aabb().transformed_by(pose);
        }
        let placed = self.children.iter().zip(&self.poses);
        // A child's position is rounded twice: in the child's own pose, and when `pose` rotates it.
        let turn = Pose { translation: Vector::<N, D>::zeros(), ..*pose };
        let boxes = placed.map(|((_, shape), own)| match shape.geometry().as_composite() {
            // No recursion into composites: nested compounds may share children, so the cost would
            // multiply.
            Some(_) => shape.local_aabb().transformed_by(&turn.compose(own)),
            None => boxed(&**shape, &turn.compose(own)),
        });
        let bounds = boxes.reduce(|all, aabb| all.merged(&aabb)).unwrap_or_else(Aabb::unbounded);
        let arms = self.poses.iter().map(|own| length_of(&own.translation)).fold(N::ZERO, max);
        let (low, high) = (bounds.mins().coords, bounds.maxs().coords);
        let finite = |x: N| if x.is_finite_number() { x.abs() } else { N::ZERO };
        let extent = low.zip_map(&high, |low, high| max(finite(low), finite(high)));
        // The rounding error is proportional to the distances of the children and the extent of the
        // box.
        Aabb::of_rotated(low, high, N::TWO * arms + length_of(&extent), pose)
    }

    /// Returns a sphere about the centre of the local box; no larger than the sphere around that
    /// box.
    fn local_bounding_sphere(&self) -> BoundingSphere<N, D> {
        self.sphere
    }

    fn nesting(&self) -> u32 {
        self.depth
    }

    fn scaled(&self, scale: &Vector<N, D>) -> Result<ShapeHandle<N, D>, ScaleError> {
        Ok(ShapeHandle::new(self.try_scaled(scale)?))
    }
}
