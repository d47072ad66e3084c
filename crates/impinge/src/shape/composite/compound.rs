//! Compounds: shapes side by side, as one.

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
/// Children may be of any kind: convex solids, half-spaces, meshes, height fields, compounds. Its
/// parts are theirs, numbered in order: first those of child 0, then those of child 1, … A child
/// that is no composite is one part. The path to a part is the index of the child, then the child's
/// own path.
///
/// Seams are handled within the surface of a child, not between children. A search uses the tree
/// over the boxes of the children, then searches each composite that it finds: parts of a child are
/// found by their boxes in the frame of the child.
///
/// Compounds nest up to [`MAX_NESTING`](crate::shape::MAX_NESTING) deep.
///
/// Cloning shares the shapes. Making it costs O(n log n) in the number of children.
///
/// ```
/// use impinge::dim3::math::{Isometry, Vector};
/// use impinge::dim3::shape::{Ball, Compound, Cuboid, ShapeHandle};
///
/// // A hammer, and a rack of two.
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
    /// The number of the first part of each child, then the number of all parts.
    pub(in crate::shape) firsts: Vec<u32>,
    /// The nesting depth.
    depth: u32,
    /// The union of the boxes of the children.
    aabb: Aabb<N, D>,
    /// Over the boxes of the children, loosened by the rounding errors of placing them.
    pub(in crate::shape) tree: BoxTree<N, D>,
    sphere: BoundingSphere<N, D>,
    /// Whether a child has a surface with seams.
    has_surface: bool,
    /// Whether a child has a body within a closed surface.
    has_bodies: bool,
    revision: Revision,
}

/// Up to this many children, the box of a placed compound is the union of the boxes of its
/// children.
const FEW_CHILDREN: usize = 32;

impl<N: Space<D>, const D: usize> Compound<N, D> {
    /// The compound of the given shapes at their positions.
    ///
    /// # Panics
    /// Where [`Self::try_new`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn new(children: Vec<(N::Isometry, ShapeHandle<N, D>)>) -> Self {
        or_panic(Self::try_new(children))
    }

    /// The compound of the given shapes at their positions.
    ///
    /// # Errors
    /// If there is no shape, a position is not finite or its rotation has no length of 1, the parts
    /// are more than 32 bits can number, or a child has the nesting depth
    /// [`MAX_NESTING`](crate::shape::MAX_NESTING) already.
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
            revision,
        })
    }

    /// The shapes and their positions in the frame of the compound.
    #[must_use]
    pub fn children(&self) -> &[(N::Isometry, ShapeHandle<N, D>)] {
        &self.children
    }

    /// The number of children, at least one.
    #[must_use]
    pub const fn num_children(&self) -> usize {
        self.children.len()
    }

    /// The compound scaled along the axes of its frame, about its origin; see [`Shape::scaled`].
    ///
    /// Each child is scaled in place. Factors of one magnitude put no condition on its position;
    /// otherwise its rotation must map axes to axes, or be about an axis across which the factors
    /// have one magnitude: else the child would be sheared.
    ///
    /// # Errors
    /// If a factor is zero or not finite, a child would be sheared or cannot be scaled by these
    /// factors, or numbers leave their range.
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

    /// The number of the first part of a child.
    pub(crate) fn first_part(&self, child: u32) -> u32 {
        self.firsts[child as usize]
    }

    /// Returns the child that a part belongs to, and the part's number within the child.
    ///
    /// # Panics
    /// If there is no such part.
    #[must_use]
    pub fn child_of_part(&self, part: u32) -> (usize, u32) {
        assert!(part < self.num_parts(), "there is no part {part}: they are {}", self.num_parts());
        // Children without parts share their start with the next: the last child that starts here
        // owns the part.
        let child = self.firsts.partition_point(|&first| first <= part) - 1;
        (child, part - self.firsts[child])
    }

    /// Child `child` as a composite, if it is one.
    pub(in crate::shape) fn composite(&self, child: usize) -> Option<&dyn CompositeShape<N, D>> {
        self.children[child].1.geometry().as_composite()
    }

    /// Returns the surface of the child that a part belongs to, the child's pose, and the part's
    /// number within the child.
    fn surface_at(&self, part: u32) -> Option<(SurfaceAccess<'_, N, D>, &Pose<N, D>, u32)> {
        let (child, own) = self.child_of_part(part);
        Some((self.composite(child)?.surface_access()?, &self.poses[child], own))
    }
}

/// Returns the pose of a child of a scaled compound, and its own factors; `None` if it would be
/// sheared.
///
/// With the signs M and the magnitudes P of the factors, rotation R:
/// `M P R = (M R M) (M (Rᵀ P R))`, a rotation after a scale if `Rᵀ P R` is diagonal.
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

/// Returns the diagonal of `Rᵀ P R`; `None` if an element off the diagonal exceeds rounding error.
fn own_factors<N: Real, const D: usize>(
    rotation: &Matrix<N, D>,
    magnitudes: &Vector<N, D>,
) -> Option<Vector<N, D>> {
    let turned = rotation.transpose() * Matrix::<N, D>::from_diagonal(magnitudes) * rotation;
    let noise = N::lit(16.0) * N::EPSILON * max_component(magnitudes);
    let is_beside = |at: (usize, usize)| at.0 != at.1 && turned[at].abs() > noise;
    let mut all = (0..D).flat_map(|row| (0..D).map(move |column| (row, column)));
    (!all.any(is_beside)).then(|| turned.diagonal())
}

/// See [`Compound::firsts`].
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

/// The box of a shape placed at `pose`; unbounded if arithmetic overflows.
pub(in crate::shape) fn boxed<N: Space<D>, const D: usize>(
    shape: &dyn Shape<N, D>,
    pose: &Pose<N, D>,
) -> Aabb<N, D> {
    let aabb = shape.aabb(pose);
    Aabb::try_new(*aabb.mins(), *aabb.maxs()).unwrap_or_else(|_| Aabb::unbounded())
}

/// The sphere around the centre of the box that contains the spheres of the children; no larger
/// than the sphere around the box.
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

/// A shape as a composite, if it has bodies among its parts.
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

    /// Visits the corners of the innermost composite, with the number of its first part in the
    /// upper 32 bits.
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

    fn piece_of(&self, part: u32) -> u32 {
        let (child, own) = self.child_of_part(part);
        let within = self.composite(child).map_or(own, |composite| composite.piece_of(own));
        self.firsts[child] + within
    }
}

/// A part of a child without a surface is a solid of its own: it admits every normal.
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
}

impl<N: Space<D>, const D: usize> Shape<N, D> for Compound<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry::composite(self)
    }

    fn local_aabb(&self) -> Aabb<N, D> {
        self.aabb
    }

    /// With more than `FEW_CHILDREN` children the box is that of the rotated local box, as for a
    /// composite child.
    fn aabb(&self, pose: &Pose<N, D>) -> Aabb<N, D> {
        if self.children.len() > FEW_CHILDREN {
            return self.local_aabb().transformed_by(pose);
        }
        let placed = self.children.iter().zip(&self.poses);
        // A child is placed twice, and rounded twice: its position by the first pose is rotated by
        // the second.
        let turn = Pose { translation: Vector::<N, D>::zeros(), ..*pose };
        let boxes = placed.map(|((_, shape), own)| match shape.geometry().as_composite() {
            // No recursion into composites: nested compounds may share children, so the cost would
            // multiply.
            Some(_) => shape.local_aabb().transformed_by(&turn.compose(own)),
            None => boxed(&**shape, &turn.compose(own)),
        });
        let turned = boxes.reduce(|all, aabb| all.merged(&aabb)).unwrap_or_else(Aabb::unbounded);
        let arms = self.poses.iter().map(|own| length_of(&own.translation)).fold(N::ZERO, max);
        let (low, high) = (turned.mins().coords, turned.maxs().coords);
        let finite = |x: N| if x.is_finite_number() { x.abs() } else { N::ZERO };
        let extent = low.zip_map(&high, |low, high| max(finite(low), finite(high)));
        // Rounding is proportional to the positions of the children and the extent of the box.
        Aabb::of_turned(low, high, N::TWO * arms + length_of(&extent), pose)
    }

    /// About the centre of the box; no larger than the sphere around the box.
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
