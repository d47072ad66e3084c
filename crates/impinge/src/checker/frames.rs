//! Trees of frames, and their poses.

use super::entries;
use core::ops::Range;

use super::CheckerError;
use super::chain::{LANES, LaneRow, Node, PoseRows, forward};
use super::joint::{Frame, Joint};
use super::rows::RowsOf;
use crate::batch::{BatchError, Control, Progress};
use crate::math::lanes::with_lanes;
use crate::math::simd::Level;
use crate::math::{Pose, Real, Space};

/// A tree of frames whose poses are determined by the numbers of a configuration.
///
/// A configuration is a row of `columns` numbers: radians or lengths, according to the joints. The
/// index of a frame is its position in the list of frames. A parent may come after its child.
///
/// The library computes sines and cosines by its own polynomials. The results are bitwise equal on
/// every machine, with an absolute error of at most 2 ε.
///
/// ```
/// use impinge::dim2::batch::{BatchError, Control};
/// use impinge::dim2::checker::{Frame, FrameTree, Joint};
/// use impinge::dim2::math::{Pose, Vector};
///
/// let ahead = Pose::from_translation(Vector::new(1.0_f64, 0.0));
/// let arm = [
///     Frame { parent: None, origin: Pose::identity(), joint: Joint::revolute(0) },
///     Frame { parent: Some(0), origin: ahead, joint: Joint::revolute(1) },
///     Frame { parent: Some(1), origin: ahead, joint: Joint::fixed() },
/// ];
/// let arm = FrameTree::try_new(&arm, 2).expect("a chain");
/// let quarter = std::f64::consts::FRAC_PI_2;
/// let mut poses = [Pose::identity(); 6];
/// arm.place(&[0.0, 0.0, quarter, -quarter], &Control::new(), &mut poses)?;
/// assert_eq!(poses[2].translation, Vector::new(2.0, 0.0), "stretched");
/// assert!((poses[5].translation - Vector::new(1.0, 1.0)).norm() < 1e-15, "up and to the right");
/// # Ok::<(), BatchError>(())
/// ```
#[derive(Clone, Debug)]
pub struct FrameTree<N: Real, const D: usize> {
    /// The moving frames, parents before children.
    pub(super) nodes: Vec<Node<N, D>>,
    /// The joint of each node.
    pub(super) joints: Vec<Joint<N, D>>,
    /// For each frame, the node that moves it and its constant pose on that node.
    pub(super) frames: Vec<OnNode<N, D>>,
    columns: usize,
}

/// A constant pose on a node. `node` is the index of the node's block of rows: 0 for the world,
/// else the node index plus one.
#[derive(Clone, Copy, Debug)]
pub(super) struct OnNode<N: Real, const D: usize> {
    pub(super) node: usize,
    /// The pose in the frame of the node; `None` for the identity.
    pub(super) pose: Option<Pose<N, D>>,
}

impl<N: Real, const D: usize> OnNode<N, D> {
    /// Returns the placement of an object that has the constant pose `inner` in this frame.
    pub(super) fn then(&self, inner: &Pose<N, D>) -> Self {
        let pose = self.pose.map_or(*inner, |outer| outer.compose(inner));
        Self { node: self.node, pose: Some(pose) }
    }

    /// Returns the pose in the world frame in lane `lane`.
    pub(super) fn at(&self, rows: &[PoseRows<N, D>], lane: usize) -> Pose<N, D> {
        let on_world = self.node == 0;
        match (&self.pose, on_world) {
            (Some(pose), true) => *pose,
            (Some(pose), false) => rows[self.node].pose(lane).compose(pose),
            (None, _) => rows[self.node].pose(lane),
        }
    }
}

impl<N: Space<D>, const D: usize> FrameTree<N, D> {
    /// Builds the tree of `frames` for configurations of `columns` numbers. A column need not drive
    /// any joint.
    ///
    /// # Errors
    /// [`CheckerError::Parent`], [`CheckerError::Loop`], [`CheckerError::Column`],
    /// [`CheckerError::Axis`], and [`CheckerError::NotFinite`] for an origin or a joint, each for
    /// the first faulty frame.
    pub fn try_new(frames: &[Frame<N, D>], columns: usize) -> Result<Self, CheckerError> {
        for (index, frame) in frames.iter().enumerate() {
            check(index, frame, [frames.len(), columns])?;
        }
        let world = OnNode { node: 0, pose: None };
        let mut tree = Self {
            nodes: Vec::new(),
            joints: Vec::new(),
            frames: vec![world; frames.len()],
            columns,
        };
        for index in parents_first(frames)? {
            let frame = &frames[index];
            let parent = frame.parent.map_or(world, |parent| tree.frames[parent]);
            tree.frames[index] = tree.with_frame(&parent.then(&frame.origin), frame);
        }
        Ok(tree)
    }

    /// Returns the placement of a frame whose joint is at `origin`. If the joint moves, appends a
    /// node for it; the frame is then the frame of that node. If the joint is fixed, returns
    /// `origin`.
    fn with_frame(&mut self, origin: &OnNode<N, D>, frame: &Frame<N, D>) -> OnNode<N, D> {
        let at = origin.pose.unwrap_or_else(Pose::identity);
        let Some(node) = Node::new(origin.node, &at, frame) else { return *origin };
        self.nodes.push(node);
        self.joints.push(frame.joint);
        OnNode { node: self.nodes.len(), pose: None }
    }

    /// Returns the number of frames.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.frames.len()
    }

    /// Returns `true` if there is no frame.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.frames.is_empty()
    }

    /// Returns the number of columns: the length of a configuration.
    #[inline]
    #[must_use]
    pub const fn columns(&self) -> usize {
        self.columns
    }

    /// Writes the poses of all frames for each configuration, row by row: `poses[configuration *
    /// len + frame]`.
    ///
    /// `configurations` has [`Self::columns`] numbers for each configuration, row by row. If a
    /// number is not finite, the poses that depend on it are not finite.
    ///
    /// # Errors
    /// [`BatchError::PartialRow`] if `configurations` ends within a row, or is not empty although
    /// there are no columns; [`BatchError::Length`] if `poses` does not have one pose for each
    /// frame of each configuration; [`BatchError::Cancelled`].
    pub fn place(
        &self,
        configurations: &[N],
        control: &Control<'_>,
        poses: &mut [Pose<N, D>],
    ) -> Result<(), BatchError> {
        let count = self.count_of(configurations, poses.len().checked_div(self.len()))?;
        let needed = count * self.len();
        if poses.len() != needed {
            return Err(BatchError::Length { argument: "poses", given: poses.len(), needed });
        }
        let rows = RowsOf::new(poses, self.len());
        entries::place((self, &self.frames), configurations, control, rows)
    }

    /// Returns the number of configurations. If there are no columns, returns `wanted`, or 0 if
    /// that is `None`.
    pub(super) fn count_of(
        &self,
        configurations: &[N],
        wanted: Option<usize>,
    ) -> Result<usize, BatchError> {
        let (given, width) = (configurations.len(), self.columns);
        match (given.checked_div(width), wanted) {
            (None, Some(count)) if given == 0 => Ok(count),
            (None, None) if given == 0 => Ok(0),
            (Some(count), _) if count * width == given => Ok(count),
            _ => Err(BatchError::PartialRow { argument: "configurations", given, width }),
        }
    }

    /// Reads the joint values of all nodes for the configurations in `range`, at most 8. The last
    /// configuration fills the remaining lanes.
    pub(super) fn numbers(
        &self,
        configurations: &[N],
        range: &Range<usize>,
        numbers: &mut [LaneRow<N>],
    ) {
        for (joint, row) in self.joints.iter().zip(numbers) {
            let column = joint.column().expect("a node has a joint that moves");
            for (lane, number) in row.iter_mut().enumerate() {
                let index = (range.start + lane).min(range.end - 1);
                *number = joint.value_at(configurations[index * self.columns + column]);
            }
        }
    }

    /// Computes the poses of all nodes from their joint values.
    pub(super) fn forward(&self, numbers: &[LaneRow<N>], rows: &mut [PoseRows<N, D>]) {
        let (level, nodes) = (Level::new(), &*self.nodes);
        with_lanes!(level, simd => forward::<_, N, N::Lanes<_>, D>(simd, nodes, numbers, rows));
    }
}

/// Implements [`FrameTree::place`] and [`Checker::place_bodies`](super::Checker::place_bodies):
/// writes the poses of objects on the nodes of a tree.
pub(super) fn place<N: Space<D>, const D: usize>(
    (tree, placed): (&FrameTree<N, D>, &[OnNode<N, D>]),
    configurations: &[N],
    control: &Control<'_>,
    poses: RowsOf<'_, Pose<N, D>>,
) -> Result<(), BatchError> {
    let (count, width) = (poses.rows(), placed.len());
    let work = |range: Range<usize>, poses: RowsOf<'_, Pose<N, D>>| {
        let mut numbers = vec![[N::ZERO; LANES]; tree.nodes.len()];
        let mut rows = vec![PoseRows::identity(); tree.nodes.len() + 1];
        for (batch, slots) in poses.into_slice().chunks_mut(LANES * width).enumerate() {
            let start = range.start + batch * LANES;
            let packet = start..range.end.min(start + LANES);
            tree.numbers(configurations, &packet, &mut numbers);
            tree.forward(&numbers, &mut rows);
            for (index, slot) in slots.iter_mut().enumerate() {
                *slot = placed[index % width].at(&rows, index / width);
            }
        }
    };
    Progress::new(control).run(count, poses, work)
}

/// Checks that the parent and the column of a frame exist, its numbers are finite, and its axis is
/// a unit vector.
fn check<N: Real, const D: usize>(
    index: usize,
    frame: &Frame<N, D>,
    [frames, columns]: [usize; 2],
) -> Result<(), CheckerError> {
    if let Some(parent) = frame.parent.filter(|&parent| parent >= frames) {
        return Err(CheckerError::Parent { frame: index, parent, frames });
    }
    if let Some(column) = frame.joint.column().filter(|&column| column >= columns) {
        return Err(CheckerError::Column { frame: index, column, columns });
    }
    if !frame.origin.is_finite() || !frame.joint.is_finite() {
        return Err(CheckerError::NotFinite { argument: "frames", index });
    }
    if !frame.joint.has_unit_axis() {
        return Err(CheckerError::Axis { frame: index });
    }
    Ok(())
}

/// Returns the indices of the frames sorted by the number of their ancestors, then by index.
fn parents_first<N: Real, const D: usize>(
    frames: &[Frame<N, D>],
) -> Result<Vec<usize>, CheckerError> {
    let depth = |frame: usize| {
        let mut above = frames[frame].parent;
        // A path to the root with as many steps as there are frames has a loop.
        for depth in 0..frames.len() {
            let Some(parent) = above else { return Ok(depth) };
            above = frames[parent].parent;
        }
        Err(CheckerError::Loop { frame })
    };
    let depths = (0..frames.len()).map(depth).collect::<Result<Vec<_>, _>>()?;
    let mut order: Vec<usize> = (0..frames.len()).collect();
    order.sort_by_key(|&frame| depths[frame]);
    Ok(order)
}
