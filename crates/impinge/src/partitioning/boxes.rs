//! Boxes as a user gives them: checked, counted, and one around all.

use super::BoxTreeError;
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::math::Real;

/// No box is inverted or holds a NaN.
pub(super) fn check<N: Real, const D: usize>(boxes: &[Aabb<N, D>]) -> Result<(), BoxTreeError> {
    for (index, aabb) in boxes.iter().enumerate() {
        Aabb::try_new(*aabb.mins(), *aabb.maxs())
            .map_err(|error| BoxTreeError::BadBox { index, error })?;
    }
    Ok(())
}

/// The smallest box around some boxes.
pub(super) fn around<N: Real, const D: usize>(boxes: &[Aabb<N, D>]) -> Option<Aabb<N, D>> {
    boxes.iter().copied().reduce(|all, aabb| all.merged(&aabb))
}

/// The number of boxes as the tree counts them, which keeps one number for "none".
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
