//! One side of a batch: shapes and their poses.

use core::fmt;
use core::ops::Range;

use super::{BatchError, PoseSource};
use crate::collide::{Placed, Placing};
use crate::math::{Pose, Real, Space, Vector};
use crate::shape::{Geometry, Shape, ShapeHandle};

/// The shapes of one side of a batch.
///
/// ```
/// use impinge::dim3::batch::Shapes;
/// use impinge::dim3::shape::{Ball, ShapeHandle};
///
/// let (large, small) = (ShapeHandle::new(Ball::new(2.0_f32)), ShapeHandle::new(Ball::new(1.0)));
/// let all: Shapes<'_, f32> = Shapes::One(&*large);
/// assert_eq!(all.len(), 1);
/// let kinds = [large, small];
/// let mixed: Shapes<'_, f32> = Shapes::Picked { shapes: &kinds, picks: &[0, 1, 1, 0, 1] };
/// assert_eq!(mixed.len(), 5);
/// ```
#[derive(Clone, Copy, Debug)]
pub enum Shapes<'a, N: Real, const D: usize> {
    /// One shape for all elements.
    One(&'a dyn Shape<N, D>),
    /// A shape for each element; a single shape is used for all elements.
    Each(&'a [ShapeHandle<N, D>]),
    /// An index into `shapes` for each element; a single index is used for all elements.
    Picked {
        /// The shapes to which `picks` refers.
        shapes: &'a [ShapeHandle<N, D>],
        /// For each element, the index of its shape.
        picks: &'a [u32],
    },
}

impl<'a, N: Real, const D: usize> Shapes<'a, N, D> {
    /// Returns the number of shapes or picks; 1 if all elements share one shape.
    #[must_use]
    pub const fn len(&self) -> usize {
        match self {
            Self::One(_) => 1,
            Self::Each(shapes) => shapes.len(),
            Self::Picked { picks, .. } => picks.len(),
        }
    }

    /// Returns `true` if no element has a shape.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the shape of element `index`, which is less than the length.
    #[inline]
    fn at(&self, index: usize) -> &'a dyn Shape<N, D> {
        match *self {
            Self::One(shape) => shape,
            Self::Each(shapes) => &*shapes[index],
            Self::Picked { shapes, picks } => &*shapes[picks[index] as usize],
        }
    }

    fn check(&self) -> Result<(), BatchError> {
        let Self::Picked { shapes, picks } = *self else { return Ok(()) };
        match picks.iter().position(|&pick| pick as usize >= shapes.len()) {
            None => Ok(()),
            Some(index) => {
                let (pick, shapes) = (picks[index], shapes.len());
                Err(BatchError::Pick { index, pick, shapes })
            }
        }
    }
}

/// Shapes and their poses: element `i` is shape `i` at pose `i`. If there is a single shape or a
/// single pose, all elements have it.
///
/// ```
/// use impinge::dim3::batch::{OnePose, Shapes, Side};
/// use impinge::dim3::math::{Isometry, Pose};
/// use impinge::dim3::shape::Ball;
///
/// let ball = Ball::new(1.0_f64);
/// let places = [0.0, 4.0, 8.0].map(|x| Isometry::translation(x, 0.0, 0.0));
/// assert_eq!(Side::try_new(Shapes::One(&ball), &places)?.len(), 3, "one ball at three places");
/// let here = OnePose(Pose::identity());
/// assert_eq!(Side::try_new(Shapes::One(&ball), &here)?.len(), 1, "one ball");
/// # Ok::<(), impinge::batch::BatchError>(())
/// ```
#[derive(Clone, Copy)]
pub struct Side<'a, N: Real, const D: usize> {
    shapes: Shapes<'a, N, D>,
    poses: &'a dyn PoseSource<N, D>,
    len: usize,
}

impl<'a, N: Real, const D: usize> Side<'a, N, D> {
    /// Combines as many shapes as poses, or a single shape with many poses, or a single pose with
    /// many shapes.
    ///
    /// # Errors
    /// [`BatchError::Length`] if the lengths differ and neither is one, [`BatchError::Pick`] for
    /// the first element whose shape index is out of range.
    pub fn try_new(
        shapes: Shapes<'a, N, D>,
        poses: &'a dyn PoseSource<N, D>,
    ) -> Result<Self, BatchError> {
        shapes.check()?;
        let len = common_length(shapes.len(), ("poses", poses.len()))?;
        Ok(Self { shapes, poses, len })
    }

    /// Returns the number of elements. A side of one element is paired with any number of elements.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.len
    }

    /// Returns `true` if there is no element.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.len == 0
    }

    /// Returns element 0, for a side of a single element, without building a [`PreparedSide`].
    #[inline]
    pub(super) fn alone(&self) -> Element<'a, 'a, N, D> {
        Element { poses: self.poses, only: None, shape: self.shapes.at(0).geometry(), pose: 0 }
    }
}

impl<N: Real, const D: usize> fmt::Debug for Side<'_, N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let poses = self.poses.len();
        f.debug_struct("Side").field("shapes", &self.shapes).field("poses", &poses).finish()
    }
}

/// Returns the number of elements of two lists that belong together: the length of the second list
/// if the first has length 1 and vice versa, else their equal length. Returns
/// [`BatchError::Length`] if the lengths differ and neither is 1.
pub(super) fn common_length(
    needed: usize,
    (argument, given): (&'static str, usize),
) -> Result<usize, BatchError> {
    match (needed, given) {
        (1, count) | (count, 1) => Ok(count),
        _ if needed == given => Ok(needed),
        _ => Err(BatchError::Length { argument, given, needed }),
    }
}

/// Returns the index of the entry of element `element` in a list of `len` entries. A list of length
/// 1 has one entry for all elements.
#[inline]
pub(super) const fn index_in(len: usize, element: usize) -> usize {
    if len == 1 { 0 } else { element }
}

/// A side together with data that is computed once for all of its elements.
pub(super) struct PreparedSide<'a, N: Real, const D: usize> {
    side: Side<'a, N, D>,
    /// The number of poses: 1 if all elements share a pose.
    poses: usize,
    /// The shape if all elements share it; else `None`.
    shape: Option<(&'a dyn Shape<N, D>, Geometry<'a, N, D>)>,
    /// The pose and the placed shape if all elements share both; else `None`. The placed shape of a
    /// ball lacks the rotation, which only the pose has.
    only: Option<(Pose<N, D>, Placed<'a, N, D>)>,
}

impl<'a, N: Space<D>, const D: usize> PreparedSide<'a, N, D> {
    pub(super) fn new(side: &Side<'a, N, D>) -> Self {
        let shape = (side.shapes.len() == 1).then(|| side.shapes.at(0));
        let shape = shape.map(|shape| (shape, shape.geometry()));
        let unique = shape.filter(|_| side.poses.len() == 1);
        let only = unique.map(|(_, geometry)| {
            let shape = geometry;
            let unturned = || side.poses.unturned(0);
            let pose = side.poses.pose(0);
            let placed = Placed { pose: if shape.turns() { pose } else { unturned() }, shape };
            (pose, placed)
        });
        Self { side: *side, poses: side.poses.len(), shape, only }
    }

    /// Returns the shape and the pose, including the rotation of a ball, if all elements share
    /// both; else `None`.
    pub(super) fn alone(&self) -> Option<(Geometry<'a, N, D>, Pose<N, D>)> {
        self.shape.zip(self.only.as_ref()).map(|((_, geometry), (pose, _))| (geometry, *pose))
    }

    /// Returns the shape of element `element`.
    #[inline]
    pub(super) fn shape(&self, element: usize) -> &'a dyn Shape<N, D> {
        match self.shape {
            Some((shape, _)) => shape,
            None => self.side.shapes.at(element),
        }
    }

    /// Returns the pose of element `element`, including the rotation of a ball.
    #[inline]
    pub(super) fn pose(&self, element: usize) -> Pose<N, D> {
        match &self.only {
            Some((pose, _)) => *pose,
            None => self.side.poses.pose(index_in(self.poses, element)),
        }
    }

    /// Returns the placed shapes of the elements in a range.
    pub(super) fn placed(&self, range: Range<usize>) -> PlacedSide<'a, N, D> {
        let mut found = PlacedSide { shapes: Vec::new(), poses: Vec::new() };
        match (&self.only, &self.shape) {
            (Some((_, placed)), _) => found.push(placed),
            (_, Some((_, shape))) if self.poses > 1 => {
                found.shapes.push(*shape);
                if shape.turns() {
                    self.side.poses.append(range, &mut found.poses);
                } else {
                    self.side.poses.append_unturned(range, &mut found.poses);
                }
            }
            _ => range.for_each(|element| found.push(&self.element(element).placed())),
        }
        found
    }

    /// Returns element `element` without reading its pose. A query reads the pose only if the
    /// translation does not reject the element.
    #[inline]
    pub(super) fn element(&self, element: usize) -> Element<'_, 'a, N, D> {
        let shape = match self.shape {
            Some((_, shape)) => shape,
            None => self.side.shapes.at(element).geometry(),
        };
        let (poses, only) = (self.side.poses, self.only.as_ref());
        Element { poses, only, shape, pose: index_in(self.poses, element) }
    }
}

/// Placed elements of a side, in the order in which they were added.
pub(super) struct PlacedSide<'a, N: Real, const D: usize> {
    /// A shape for each element, or one for all.
    shapes: Vec<Geometry<'a, N, D>>,
    /// A pose for each element, or one for all. The pose of a ball may lack its rotation.
    poses: Vec<Pose<N, D>>,
}

impl<'a, N: Real, const D: usize> PlacedSide<'a, N, D> {
    /// Creates an empty list with capacity for `len` elements.
    pub(super) fn with_capacity(len: usize) -> Self {
        Self { shapes: Vec::with_capacity(len), poses: Vec::with_capacity(len) }
    }

    #[inline]
    pub(super) fn push(&mut self, placed: &Placed<'a, N, D>) {
        self.shapes.push(placed.shape);
        self.poses.push(placed.pose);
    }

    #[inline]
    pub(super) fn shape(&self, number: usize) -> Geometry<'a, N, D> {
        self.shapes[index_in(self.shapes.len(), number)]
    }

    #[inline]
    pub(super) fn pose(&self, number: usize) -> &Pose<N, D> {
        &self.poses[index_in(self.poses.len(), number)]
    }

    #[inline]
    pub(super) fn placed(&self, number: usize) -> Placed<'a, N, D> {
        Placed { pose: *self.pose(number), shape: self.shape(number) }
    }
}

/// Returns the two elements of pair `index`. A closure over both sides would not always be inlined.
#[inline]
pub(super) fn pair_at<'s, 'a, N: Space<D>, const D: usize>(
    sides: &'s [PreparedSide<'a, N, D>; 2],
    index: usize,
) -> [Element<'s, 'a, N, D>; 2] {
    [sides[0].element(index), sides[1].element(index)]
}

/// An element of a side; its pose is read on request.
pub(super) struct Element<'s, 'a, N: Real, const D: usize> {
    poses: &'a dyn PoseSource<N, D>,
    /// The pose and the placed shape if all elements of the side share both; else `None`.
    only: Option<&'s (Pose<N, D>, Placed<'a, N, D>)>,
    shape: Geometry<'a, N, D>,
    /// The index of the element's pose in `poses`.
    pose: usize,
}

impl<'a, N: Space<D>, const D: usize> Placing<'a, N, D> for Element<'_, 'a, N, D> {
    #[inline]
    fn shape(&self) -> Geometry<'a, N, D> {
        self.shape
    }

    #[inline]
    fn translation(&self) -> Vector<N, D> {
        match self.only {
            Some((pose, _)) => pose.translation,
            None => self.poses.translation(self.pose),
        }
    }

    #[inline]
    fn placed(&self) -> Placed<'a, N, D> {
        if let Some((_, placed)) = self.only {
            return *placed;
        }
        let (poses, shape) = (self.poses, self.shape);
        let pose = if shape.turns() { poses.pose(self.pose) } else { poses.unturned(self.pose) };
        Placed { pose, shape }
    }
}
