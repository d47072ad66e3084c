//! Functions on the boxes of a user: validation, checked count, union, and the construction of a
//! packed tree.

use super::BoxTreeError;
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::bvh::{Bounds, Lanes, Tree};
use crate::math::Real;

/// Builds a tree from boxes with distinct ids. The tree leaves out the boxes that no finite `f32`
/// box encloses; their ids are returned, too, in input order.
pub(crate) fn packed<N: Real, const D: usize>(
    lanes: Lanes,
    boxes: impl Iterator<Item = (u32, Aabb<N, D>)>,
) -> (Tree<D>, Vec<u32>) {
    let mut unbounded = Vec::new();
    let bounded = boxes.filter_map(|(id, aabb)| {
        let tight = Bounds::enclosing(&aabb);
        if !tight.is_finite() {
            unbounded.push(id);
        }
        tight.is_finite().then_some((id, tight))
    });
    (Tree::of_still(lanes, bounded), unbounded)
}

/// Returns an error for the first box that is inverted or has a NaN.
pub(super) fn check<N: Real, const D: usize>(boxes: &[Aabb<N, D>]) -> Result<(), BoxTreeError> {
    for (index, aabb) in boxes.iter().enumerate() {
        Aabb::try_new(*aabb.mins(), *aabb.maxs())
            .map_err(|error| BoxTreeError::BadBox { index, error })?;
    }
    Ok(())
}

/// Returns the smallest box around all of `boxes`; `None` if there are none.
pub(super) fn around<N: Real, const D: usize>(boxes: &[Aabb<N, D>]) -> Option<Aabb<N, D>> {
    boxes.iter().copied().reduce(|all, aabb| all.merged(&aabb))
}

/// Converts the number of boxes to `u32`. Returns an error for `u32::MAX` or more boxes: the tree
/// reserves the id `u32::MAX` for "none".
pub(super) fn count(given: usize) -> Result<u32, BoxTreeError> {
    let count = u32::try_from(given).ok().filter(|&count| count < u32::MAX);
    count.ok_or(BoxTreeError::TooMany { given })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn more_boxes_than_numbers_are_refused() {
        assert_eq!(count(7), Ok(7), "few");
        let given = u32::MAX as usize;
        assert_eq!(count(given), Err(BoxTreeError::TooMany { given }), "too many");
    }
}
