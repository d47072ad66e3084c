//! Errors of a tree of boxes.

use core::fmt;

use crate::bounding_volume::AabbError;

/// The reason why a [`BoxTree`](super::BoxTree) rejected its boxes.
///
/// ```
/// use impinge::dim2::bounding_volume::Aabb;
/// use impinge::dim2::math::Point;
/// use impinge::dim2::partitioning::{BoxTree, BoxTreeError};
///
/// let boxes = [Aabb::new(Point::origin(), Point::new(1.0_f32, 1.0))];
/// let refused = BoxTree::from_boxes(&boxes).try_refit(&[]);
/// assert_eq!(refused, Err(BoxTreeError::WrongCount { given: 0, needed: 1 }));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum BoxTreeError {
    /// A box is inverted or has a NaN, as arithmetic on valid boxes can yield.
    BadBox {
        /// The index of the box.
        index: usize,
        /// The reason.
        error: AabbError,
    },
    /// There are more than 2³² − 2 boxes: an index has 32 bits, and `u32::MAX` is reserved.
    TooMany {
        /// The number of boxes that the caller passed.
        given: usize,
    },
    /// The number of boxes of a refit differs from the number in the tree.
    WrongCount {
        /// The number of boxes that the caller passed.
        given: usize,
        /// The number of boxes in the tree.
        needed: usize,
    },
}

impl fmt::Display for BoxTreeError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::BadBox { index, error } => write!(f, "box {index} is unusable: {error}"),
            Self::TooMany { given } => write!(f, "{given} boxes are more than 32 bits can number"),
            Self::WrongCount { given, needed } => {
                write!(f, "{given} boxes were given for {needed}")
            }
        }
    }
}

impl std::error::Error for BoxTreeError {}
