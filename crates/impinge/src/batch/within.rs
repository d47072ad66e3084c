//! All pairs of two sets of placed shapes, or of one set with itself, that are at most a distance
//! apart.
//!
//! A tree is built over the boxes of one set. For each element of the other set, the tree is
//! searched with the element's box, grown by the distance. For each pair whose boxes overlap,
//! [`proximity`](crate::query::proximity()) of the two shapes then decides.
//!
//! ```text
//!    +-------------+  the box of an element, rounded outwards and grown by 2¹⁰ ε times its extent
//!    |   shape     |
//!    +-------------+ <----- distance -----> |   the searched volume ends here
//! ```
//!
//! The errors of the pair algorithms are at most some hundred ε times the lengths of the pair (see
//! [`crate::collide::far`]). These lengths are the extents of both solids about their origins, and
//! the distance. So each box is grown by 2¹⁰ ε times the extent of its solid about its origin, and
//! the searched volume by 2¹⁰ ε times the distance.

use super::entries;
use core::ops::Range;

use super::control::Progress;
use super::side::PreparedSide;
use super::{BatchError, Control, Side, Tiles};
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::collide::Placing;
use crate::collide::parts::bounds::enclosing;
use crate::math::{Mapped, Real, Space, max};
use crate::partitioning::BoxTree;
use crate::query::distance_within;

/// The growth of a box, in units of ε times the length that causes the rounding error.
const ROUNDING_ERRORS: f64 = 1024.0;

/// Returns, in ascending order, the pairs `[i, j]` of an element `i` of the first side and an
/// element `j` of the second side that touch, overlap, or are at most `distance` apart.
///
/// The result for a pair is that of [`proximity`](crate::query::proximity()); `distance` is
/// inclusive. Elements with a pose that is not finite, and composites without parts, have no pairs.
///
/// The callback of `control` receives the number of finished elements of the larger side.
///
/// Cost: O((n + m) log n) for n and m elements, n ≤ m, plus the cost of
/// [`proximity`](crate::query::proximity()) for each pair whose boxes are within the distance.
/// Half-spaces that are not aligned with an axis are tested against every element of the other
/// side.
///
/// ```
/// use impinge::dim2::batch::{BatchError, Control, OnePose, Shapes, Side, pairs_within};
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::Ball;
///
/// let ball = Ball::new(1.0_f64);
/// let (low, high) = ([0.0, 3.0, 6.0].map(|x| Isometry::translation(x, 0.0)), OnePose(Isometry::translation(6.0, 3.0)));
/// let (low, high) = (Side::try_new(Shapes::One(&ball), &low)?, Side::try_new(Shapes::One(&ball), &high)?);
/// assert_eq!(pairs_within(&low, &high, 1.0, &Control::new())?, [[2, 0]]);
/// assert!(pairs_within(&low, &high, 0.5, &Control::new())?.is_empty());
/// # Ok::<(), BatchError>(())
/// ```
///
/// # Errors
/// [`BatchError::Distance`] if `distance` is negative or NaN, [`BatchError::TooMany`] if the number
/// of elements does not fit in 32 bits, [`BatchError::Cancelled`].
pub fn pairs_within<N: Space<D>, const D: usize>(
    side1: &Side<'_, N, D>,
    side2: &Side<'_, N, D>,
    distance: N,
    control: &Control<'_>,
) -> Result<Vec<[u32; 2]>, BatchError> {
    entries::pairs_within(side1, Some(side2), distance, control)
}

/// Returns, in ascending order, the pairs `[i, j]`, `i < j`, of elements of one side that touch,
/// overlap, or are at most `distance` apart. These are the results of [`pairs_within`] for the side
/// and itself, with each pair once and without self-pairs.
///
/// ```
/// use impinge::dim2::batch::{BatchError, Control, Shapes, Side, pairs_within_one};
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::Ball;
///
/// let (ball, places) = (Ball::new(1.0_f64), [0.0, 3.0, 6.5].map(|x| Isometry::translation(x, 0.0)));
/// let row = Side::try_new(Shapes::One(&ball), &places)?;
/// assert_eq!(pairs_within_one(&row, 1.0, &Control::new())?, [[0, 1]]);
/// # Ok::<(), BatchError>(())
/// ```
///
/// # Errors
/// [`BatchError::Distance`] if `distance` is negative or NaN, [`BatchError::TooMany`] if the number
/// of elements does not fit in 32 bits, [`BatchError::Cancelled`].
pub fn pairs_within_one<N: Space<D>, const D: usize>(
    side: &Side<'_, N, D>,
    distance: N,
    control: &Control<'_>,
) -> Result<Vec<[u32; 2]>, BatchError> {
    entries::pairs_within(side, None, distance, control)
}

/// Returns the box of each element of a side, grown by a bound of the rounding errors of its pairs.
/// The boxes are the input of [`tiles()`](super::tiles()) and [`Tiles::meeting`].
///
/// The box is `None` if the pose of the element is not finite, or the element is a composite
/// without parts. Half-spaces and other unbounded shapes have infinite faces. The boxes depend on
/// the shapes and poses alone.
///
/// ```
/// use impinge::dim2::batch::{BatchError, Control, Shapes, Side, boxes};
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::Ball;
///
/// let (ball, places) = (Ball::new(1.0_f64), [4.0, f64::NAN].map(|x| Isometry::translation(x, 0.0)));
/// let found = boxes(&Side::try_new(Shapes::One(&ball), &places)?, &Control::new())?;
/// let aabb = found[0].expect("it is somewhere");
/// assert!(aabb.mins().x < 3.0 && (aabb.mins().x - 3.0).abs() < 1e-12);
/// assert_eq!(found[1], None);
/// # Ok::<(), BatchError>(())
/// ```
///
/// # Errors
/// [`BatchError::TooMany`] if the number of elements does not fit in 32 bits,
/// [`BatchError::Cancelled`].
pub fn boxes<N: Space<D>, const D: usize>(
    side: &Side<'_, N, D>,
    control: &Control<'_>,
) -> Result<Vec<Option<Aabb<N, D>>>, BatchError> {
    entries::boxes(side, control)
}

/// A side with the grown box of each element, which a search compares with the boxes of the other
/// side.
struct BoxedSide<'a, N: Real, const D: usize> {
    side: PreparedSide<'a, N, D>,
    /// The grown box of each element; `None` if its pose is not finite or it has no finite point.
    boxes: Vec<Option<Aabb<N, D>>>,
}

/// Implements [`pairs_within`]; implements [`pairs_within_one`] if `side2` is `None`.
pub(super) fn pairs_of<N: Space<D>, const D: usize>(
    side1: &Side<'_, N, D>,
    side2: Option<&Side<'_, N, D>>,
    distance: N,
    control: &Control<'_>,
) -> Result<Vec<[u32; 2]>, BatchError> {
    is_distance(distance)?;
    let boxed1 = BoxedSide::new(side1, &Control::new())?;
    let mut pairs = match side2 {
        None => boxed1.pairs_with(&boxed1, distance, control, |walker, found| {
            (walker < found).then_some([walker, found])
        }),
        Some(side2) => {
            let boxed2 = BoxedSide::new(side2, &Control::new())?;
            if side1.len() < side2.len() {
                boxed2.pairs_with(&boxed1, distance, control, |walker, found| Some([found, walker]))
            } else {
                boxed1.pairs_with(&boxed2, distance, control, |walker, found| Some([walker, found]))
            }
        }
    }?;
    pairs.sort_unstable();
    Ok(pairs)
}

/// Implements [`pairs_in_tile`](super::pairs_in_tile), but returns pairs of indices `[i, j]`, i <
/// j, in no particular order.
pub(super) fn pairs_of_tile<N: Space<D>, const D: usize>(
    side: &Side<'_, N, D>,
    tiles: &Tiles<N, D>,
    tile: u32,
    control: &Control<'_>,
) -> Result<Vec<[u32; 2]>, BatchError> {
    let boxed = BoxedSide::new(side, &Control::new())?;
    let is_own = |walker: u32, found: u32| {
        let boxes = [walker, found].mapped(|element| &boxed.boxes[element as usize]);
        let [Some(box1), Some(box2)] = boxes else { return false };
        tiles.owner_of_pair(box1, box2) == tile
    };
    boxed.pairs_with(&boxed, tiles.clearance(), control, |walker, found| {
        (walker < found && is_own(walker, found)).then_some([walker, found])
    })
}

/// Implements [`boxes()`].
pub(super) fn boxes_of<N: Space<D>, const D: usize>(
    side: &Side<'_, N, D>,
    control: &Control<'_>,
) -> Result<Vec<Option<Aabb<N, D>>>, BatchError> {
    Ok(BoxedSide::new(side, control)?.boxes)
}

/// Returns [`BatchError::Distance`] if the distance limit `value` is negative or NaN.
pub(super) fn is_distance<N: Real>(value: N) -> Result<(), BatchError> {
    let is_usable = value >= N::ZERO;
    if is_usable { Ok(()) } else { Err(BatchError::Distance { value: value.as_f64() }) }
}

/// Returns `distance` plus its rounding errors: if one of two boxes grows by this margin, the boxes
/// overlap whenever their solids are within `distance`.
fn margin<N: Real>(distance: N) -> N {
    distance + distance * N::lit(ROUNDING_ERRORS) * N::EPSILON
}

/// Returns half of [`margin`], rounded up: if both boxes of a pair grow by this margin, the boxes
/// overlap whenever their solids are within `distance`. Rounding up matters where half of the
/// smallest positive number rounds to zero.
pub(super) fn half_margin<N: Real>(distance: N) -> N {
    let whole = margin(distance);
    let half = whole * N::HALF;
    if whole.is_finite_number() { max(half, whole - half) } else { whole }
}

impl<'a, N: Space<D>, const D: usize> BoxedSide<'a, N, D> {
    fn new(side: &Side<'a, N, D>, control: &Control<'_>) -> Result<Self, BatchError> {
        let given = side.len();
        // Indices are less than the length, so no index is `u32::MAX`.
        if u32::try_from(given).is_err() {
            return Err(BatchError::TooMany { given });
        }
        let (side, mut boxes) = (PreparedSide::new(side), vec![None; given]);
        let work = |range: Range<usize>, boxes: &mut [Option<Aabb<N, D>>]| {
            for (slot, element) in boxes.iter_mut().zip(range) {
                *slot = grown_box(&side, element);
            }
        };
        Progress::new(control).run(given, &mut boxes[..], work)?;
        Ok(Self { side, boxes })
    }

    /// Searches the tree of `other` with the box of each element of this side, and returns the
    /// pairs within `distance` in no particular order. `pair_of` receives the index of the element
    /// of this side and the index of the element of `other`. `pair_of` returns the pair to report,
    /// or `None` to leave the pair out.
    fn pairs_with(
        &self,
        other: &Self,
        distance: N,
        control: &Control<'_>,
        pair_of: impl Fn(u32, u32) -> Option<[u32; 2]> + Sync,
    ) -> Result<Vec<[u32; 2]>, BatchError> {
        let (numbers, tree) = other.tree()?;
        let margin = margin(distance);
        let near = |walker: usize, index: usize| {
            let pair = pair_of(number_of(walker), numbers[index])?;
            let (one, found) =
                (self.side.element(walker), other.side.element(numbers[index] as usize));
            let is_near = distance_within(&one, &found, distance).is_some();
            is_near.then_some(pair)
        };
        let search = |walker: usize, pairs: &mut Vec<[u32; 2]>| {
            let Some(aabb) = &self.boxes[walker] else { return };
            let around = aabb.loosened(margin);
            tree.visit_overlapping(&around, |index| pairs.extend(near(walker, index)));
        };
        let work = |range: Range<usize>, pairs: &mut Vec<[u32; 2]>| {
            range.for_each(|walker| search(walker, pairs));
        };
        let mut all = Vec::new();
        let progress = Progress::new(control);
        progress.collect(self.boxes.len(), work, |pairs| all.append(pairs))?;
        Ok(all)
    }

    /// Builds a tree over the boxes that are not `None`. Returns the element index of each box, and
    /// the tree.
    fn tree(&self) -> Result<(Vec<u32>, BoxTree<N, D>), BatchError> {
        let boxes = (0..).zip(&self.boxes);
        let (numbers, boxes): (Vec<u32>, Vec<_>) =
            boxes.filter_map(|(number, aabb)| Some((number, (*aabb)?))).unzip();
        let given = boxes.len();
        // The boxes are neither inverted nor NaN, so only their count can cause an error.
        let tree = BoxTree::try_from_vec(boxes).map_err(|_| BatchError::TooMany { given })?;
        Ok((numbers, tree))
    }
}

/// Converts the index of an element to `u32`. The length of the side has been checked.
fn number_of(element: usize) -> u32 {
    u32::try_from(element).expect("32 bits can number the elements")
}

/// Returns the box of an element, grown by a bound of the rounding errors of its pairs; `None` if
/// the pose is not finite or the element has no finite point.
fn grown_box<N: Space<D>, const D: usize>(
    side: &PreparedSide<'_, N, D>,
    element: usize,
) -> Option<Aabb<N, D>> {
    let pose = side.element(element).placed().pose;
    let aabb = side.shape(element).aabb(&pose);
    if !pose.is_finite() || !aabb.holds_finite_point() {
        return None;
    }
    let mut farthest = N::ZERO;
    for axis in 0..D {
        for face in [aabb.mins()[axis], aabb.maxs()[axis]] {
            let away = (face - pose.translation[axis]).abs();
            farthest = if away.is_finite_number() { max(away, farthest) } else { farthest };
        }
    }
    Some(enclosing(&aabb, &pose).loosened(farthest * N::lit(ROUNDING_ERRORS) * N::EPSILON))
}
