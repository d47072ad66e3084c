//! The search of a compound: first among the boxes of its children, then within each composite
//! child.
//!
//! A nested search gets a box that contains the search box, so the lower bounds that it reports are
//! also lower bounds for the compound.

use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::math::outward::slack_of;
use crate::math::{Pose, Real, Space, Vector, max, min};
use crate::shape::composite::compound::boxed;
use crate::shape::{CompositeShape, Compound, PartSearch, Shape};

impl<N: Space<D>, const D: usize> PartSearch<N, D> for Compound<N, D> {
    fn bounds(&self) -> Aabb<N, D> {
        PartSearch::bounds(&self.tree)
    }

    fn overlapping(&self, aabb: &Aabb<N, D>, visit: &mut dyn FnMut(u32)) {
        self.tree.visit_overlapping(aabb, |child| {
            let first = self.firsts[child];
            match self.nested(child, aabb) {
                Some((composite, local)) => {
                    composite.search().overlapping(&local, &mut |part| visit(first + part));
                }
                None => visit(first),
            }
        });
    }

    fn nearest(&self, aabb: &Aabb<N, D>, limit: N, visit: &mut dyn FnMut(u32, N) -> N) {
        let mut lowest = limit;
        PartSearch::nearest(&self.tree, aabb, limit, &mut |child, distance| {
            let child = child as usize;
            let first = self.firsts[child];
            let Some((composite, local)) = self.nested(child, aabb) else {
                lowest = min(lowest, visit(first, distance));
                return lowest;
            };
            composite.search().nearest(&local, lowest, &mut |part, own| {
                lowest = min(lowest, visit(first + part, max(own, distance)));
                lowest
            });
            lowest
        });
    }

    fn cast(
        &self,
        aabb: &Aabb<N, D>,
        velocity: &Vector<N, D>,
        limit: N,
        visit: &mut dyn FnMut(u32, N) -> N,
    ) {
        let mut lowest = limit;
        self.tree.cast(aabb, velocity, limit, &mut |child, time| {
            let child = child as usize;
            let first = self.firsts[child];
            let Some((composite, local)) = self.nested(child, aabb) else {
                lowest = min(lowest, visit(first, time));
                return lowest;
            };
            let local_velocity = self.poses[child].inverse_vector(velocity);
            composite.search().cast(&local, &local_velocity, lowest, &mut |part, own| {
                lowest = min(lowest, visit(first + part, max(own, time)));
                lowest
            });
            lowest
        });
    }
}

impl<N: Space<D>, const D: usize> Compound<N, D> {
    /// Returns child `child` as a composite, and a box in the child's frame around `aabb`; `None`
    /// if the child is a single solid.
    fn nested(
        &self,
        child: usize,
        aabb: &Aabb<N, D>,
    ) -> Option<(&dyn CompositeShape<N, D>, Aabb<N, D>)> {
        let composite = self.composite(child)?;
        let local = within(aabb, &self.poses[child], self.tree.boxes().get(child)?);
        Some((composite, local))
    }
}

/// Returns the box by which the search finds a child. The box is enlarged by the rounding errors of
/// the child in the frames in which the pair algorithms place it. These errors are proportional to
/// the child's own coordinates and to its position, which may be much larger than the coordinates
/// of the placed box.
pub(in crate::shape) fn search_box<N: Space<D>, const D: usize>(
    shape: &dyn Shape<N, D>,
    pose: &Pose<N, D>,
) -> Aabb<N, D> {
    let local = shape.local_aabb();
    let parts = shape.geometry().as_composite();
    let searched = parts.map_or(local, |parts| parts.search().bounds());
    let of_parts = largest((searched.maxs() - local.maxs()).iter());
    let ends = local.mins().iter().chain(local.maxs().iter()).chain(pose.translation.iter());
    let aabb = boxed(shape, pose);
    aabb.loosened(N::TWO * of_parts + rounding(largest(ends)))
}

/// Returns the box around `aabb` in the child's frame. It is enlarged by the rounding error of
/// testing `aabb`, at rest or moving, against the child's box `own`.
///
/// A rotated point, or the velocity times the time of impact with `own`, has an error of a few
/// epsilon times the coordinates involved.
fn within<N: Real, const D: usize>(
    aabb: &Aabb<N, D>,
    pose: &Pose<N, D>,
    own: &Aabb<N, D>,
) -> Aabb<N, D> {
    let corners = [aabb.mins(), aabb.maxs(), own.mins(), own.maxs()];
    let ends = corners.iter().flat_map(|corner| corner.iter()).chain(pose.translation.iter());
    aabb.transformed_by(&pose.inverse()).loosened(rounding(largest(ends)))
}

/// Returns the largest magnitude among the finite numbers; 0 if there are none.
fn largest<'a, N: Real>(numbers: impl Iterator<Item = &'a N>) -> N {
    let finite = numbers.filter(|x| x.is_finite_number());
    finite.fold(N::ZERO, |largest, x| max(largest, x.abs()))
}

/// Returns the margin added to boxes with coordinates up to `size`. It covers the rounding of
/// points that the search and the pair algorithm transform into a frame and back.
fn rounding<N: Real>(size: N) -> N {
    N::lit(4.0) * slack_of(size)
}
