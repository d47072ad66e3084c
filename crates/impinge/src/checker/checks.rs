//! The configuration checker: construction, obstacles and queries.

use super::entries;
use super::filter::{Other, RobotFilter, Surroundings};
use super::frames::OnNode;
use super::hulls::BodyHulls;
use super::rows::RowsOf;
use super::{Body, CheckerError, FrameTree, NearestColumns, Obstacle};
use crate::batch::{BatchError, Control};
use crate::math::{Pose, Real, Space};

/// The entry of [`Checker::first_pairs`] and [`Checker::nearest`] for a configuration without a
/// pair.
pub const NO_PAIR: [u32; 2] = [u32::MAX; 2];

/// A robot of bodies on moving frames, the pairs of bodies that must not touch, and obstacles.
///
/// Bodies and obstacles share one numbering: obstacle `i` has the index `bodies + i`. The lower
/// index of a pair comes first, and pairs are ordered by both indices: first all pairs of body 0
/// with other bodies and then with obstacles, then all pairs of body 1, and so on.
///
/// A configuration is free if no pair touches, or, with a clearance, if all pairs are farther apart
/// than the clearance. If the pose of a frame is not finite, the configuration is not free, has no
/// pair, and its distance is NaN.
///
/// ```
/// use impinge::dim2::batch::{BatchError, Control};
/// use impinge::dim2::checker::{Body, Checker, Frame, FrameTree, Joint, NearestColumns, Obstacle};
/// use impinge::dim2::math::{Pose, Vector};
/// use impinge::dim2::shape::{Ball, Cuboid, ShapeHandle};
///
/// // An arm of two links of length 1, a ball at the end of each, and a wall above x = 2.5.
/// let at = |x: f64, y: f64| Pose::from_translation(Vector::new(x, y));
/// let frames = [
///     Frame { parent: None, origin: Pose::identity(), joint: Joint::revolute(0) },
///     Frame { parent: Some(0), origin: at(1.0, 0.0), joint: Joint::revolute(1) },
/// ];
/// let ball = ShapeHandle::new(Ball::new(0.25));
/// let bodies = [0, 1].map(|frame| Body { frame, shape: ball.clone(), pose: at(1.0, 0.0) });
/// let mut arm = Checker::try_new(FrameTree::try_new(&frames, 2)?, bodies.into(), &[[0, 1]])?;
/// let wall = ShapeHandle::new(Cuboid::new(Vector::new(0.5, 4.0)));
/// arm.try_set_obstacles(vec![Obstacle { shape: wall, pose: at(3.0, 0.0) }], &[])?;
///
/// // Stretched along x, along y, and folded back onto itself.
/// let half = std::f64::consts::PI;
/// let configurations = [0.0, 0.0, half / 2.0, 0.0, half / 2.0, half];
/// let mut free = [false; 3];
/// arm.are_free(&configurations, 0.0, &Control::new(), &mut free)?;
/// assert_eq!(free, [true, true, true]);
/// arm.are_free(&configurations, 0.3, &Control::new(), &mut free)?;
/// assert_eq!(free, [false, true, true], "the wall is 0.25 away");
///
/// let (mut distance, mut pair) = ([0.0; 3], [[0; 2]; 3]);
/// let out = NearestColumns { distance: &mut distance, pair: &mut pair };
/// arm.nearest(&configurations, f64::INFINITY, &Control::new(), out)?;
/// assert_eq!((distance[0], pair[0]), (0.25, [1, 2]), "the second ball and the wall");
/// assert_eq!(pair[1], [0, 1], "the two balls");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct Checker<N: Real, const D: usize> {
    pub(super) tree: FrameTree<N, D>,
    pub(super) bodies: Vec<Body<N, D>>,
    /// For each body, the node that moves it and its pose relative to that node.
    pub(super) on_nodes: Vec<OnNode<N, D>>,
    /// The pairs of body indices in ascending order, the lower index first.
    pairs: Vec<[u32; 2]>,
    pub(super) obstacles: Vec<Obstacle<N, D>>,
    pub(super) hulls: BodyHulls<N, D>,
    pub(super) robot: RobotFilter<D>,
    pub(super) surroundings: Surroundings<D>,
    /// The pairs `[body, obstacle]` that may touch, in ascending order. No query tests them.
    ignored: Vec<[u32; 2]>,
}

impl<N: Space<D>, const D: usize> Checker<N, D> {
    /// Builds a checker from bodies on the frames of a tree and the pairs of bodies that must not
    /// touch, in any order. The checker has no obstacles yet.
    ///
    /// The cost is O(n log n) for n bodies and pairs.
    ///
    /// # Errors
    /// [`CheckerError::BodyFrame`], [`CheckerError::NotFinite`], [`CheckerError::Pair`] or
    /// [`CheckerError::TooMany`], for the first fault.
    pub fn try_new(
        tree: FrameTree<N, D>,
        bodies: Vec<Body<N, D>>,
        pairs: &[[u32; 2]],
    ) -> Result<Self, CheckerError> {
        check_bodies(&bodies, tree.len())?;
        let is_pair =
            |&[one, other]: &[u32; 2]| one != other && (one.max(other) as usize) < bodies.len();
        check_pairs("pairs", pairs, is_pair)?;
        let mut pairs: Vec<_> = pairs.iter().map(|&[a, b]| [a.min(b), a.max(b)]).collect();
        pairs.sort_unstable();
        pairs.dedup();
        let on_nodes = bodies.iter().map(|body| tree.frames[body.frame].then(&body.pose)).collect();
        let robot = entries::robot(&tree, &bodies, &pairs);
        let surroundings = entries::surroundings(&tree, &robot, &[], &[]);
        let hulls = BodyHulls::new(bodies.len());
        Ok(Self {
            tree,
            bodies,
            hulls,
            on_nodes,
            pairs,
            obstacles: Vec::new(),
            robot,
            surroundings,
            ignored: Vec::new(),
        })
    }

    /// Replaces all obstacles; `ignored` has the pairs `[body, obstacle]` that may touch, with both
    /// indices starting at zero.
    ///
    /// The bodies are covered by groups of at most 8 balls. The cost is one distance query of a
    /// point and an obstacle for each group and each obstacle.
    ///
    /// # Errors
    /// [`CheckerError::NotFinite`], [`CheckerError::Pair`] or [`CheckerError::TooMany`], for the
    /// first fault; the obstacles are then unchanged.
    pub fn try_set_obstacles(
        &mut self,
        obstacles: Vec<Obstacle<N, D>>,
        ignored: &[[u32; 2]],
    ) -> Result<(), CheckerError> {
        let given = self.bodies.len() + obstacles.len();
        if u32::try_from(given).is_err() {
            return Err(CheckerError::TooMany { given });
        }
        if let Some(index) = obstacles.iter().position(|obstacle| !obstacle.pose.is_finite()) {
            return Err(CheckerError::NotFinite { argument: "obstacles", index });
        }
        let is_pair = |&[body, obstacle]: &[u32; 2]| {
            (body as usize) < self.bodies.len() && (obstacle as usize) < obstacles.len()
        };
        check_pairs("ignored", ignored, is_pair)?;
        self.surroundings = entries::surroundings(&self.tree, &self.robot, &obstacles, ignored);
        self.obstacles = obstacles;
        self.ignored = ignored.to_vec();
        self.ignored.sort_unstable();
        Ok(())
    }

    /// Returns the tree of frames.
    #[must_use]
    pub const fn frames(&self) -> &FrameTree<N, D> {
        &self.tree
    }

    /// Returns the bodies.
    #[must_use]
    pub fn bodies(&self) -> &[Body<N, D>] {
        &self.bodies
    }

    /// Returns the pairs of bodies that must not touch, in ascending order, the lower index first.
    #[must_use]
    pub fn pairs(&self) -> &[[u32; 2]] {
        &self.pairs
    }

    /// Returns the obstacles.
    #[must_use]
    pub fn obstacles(&self) -> &[Obstacle<N, D>] {
        &self.obstacles
    }

    /// Writes the poses of all bodies for each configuration, row by row: `poses[configuration *
    /// bodies + body]`.
    ///
    /// # Errors
    /// [`BatchError::PartialRow`], [`BatchError::Length`] or [`BatchError::Cancelled`], as for
    /// [`FrameTree::place`].
    pub fn place_bodies(
        &self,
        configurations: &[N],
        control: &Control<'_>,
        poses: &mut [Pose<N, D>],
    ) -> Result<(), BatchError> {
        let width = self.bodies.len();
        let count = self.tree.count_of(configurations, poses.len().checked_div(width))?;
        let needed = count * width;
        if poses.len() != needed {
            return Err(BatchError::Length { argument: "poses", given: poses.len(), needed });
        }
        entries::place(
            (&self.tree, &self.on_nodes),
            configurations,
            control,
            RowsOf::new(poses, width),
        )
    }

    /// Writes whether each configuration is free: all pairs are farther apart than `clearance`, or,
    /// if `clearance` is zero, no pair touches.
    ///
    /// `configurations` has a number for each column of the tree, row by row. A `clearance` that is
    /// negative or NaN is treated as zero.
    ///
    /// The cost is some microseconds for 8 configurations of a robot of about 50 balls among 10
    /// obstacles. For a robot of meshes it is some tens of microseconds for each configuration,
    /// most of it for pairs whose convex hulls touch. The hull of a mesh is computed once, in O(n
    /// log n) for n vertices, after it was needed for some configurations.
    ///
    /// # Errors
    /// [`BatchError::PartialRow`] or [`BatchError::Length`] if `configurations` does not have as
    /// many rows as `out` has slots; [`BatchError::Cancelled`].
    pub fn are_free(
        &self,
        configurations: &[N],
        clearance: N,
        control: &Control<'_>,
        out: &mut [bool],
    ) -> Result<(), BatchError> {
        self.check("out", configurations, out.len())?;
        entries::are_free(self, (configurations, clearance), control, out)
    }

    /// Writes the first pair of each configuration that touches or is within `clearance`, which is
    /// treated as in [`Self::are_free`]; [`NO_PAIR`] if the configuration is free or not finite.
    ///
    /// # Errors
    /// [`BatchError::PartialRow`] or [`BatchError::Length`] if `configurations` does not have as
    /// many rows as `out` has slots; [`BatchError::Cancelled`].
    pub fn first_pairs(
        &self,
        configurations: &[N],
        clearance: N,
        control: &Control<'_>,
        out: &mut [[u32; 2]],
    ) -> Result<(), BatchError> {
        self.check("out", configurations, out.len())?;
        entries::first_pairs(self, (configurations, clearance), control, out)
    }

    /// Writes the nearest pair of each configuration and its distance, if this is at most `limit`.
    /// The first of several equally near pairs is written.
    ///
    /// A `limit` that is negative or NaN is treated as zero. The limit never changes a distance,
    /// only whether a pair is reported; a low limit saves time.
    ///
    /// # Errors
    /// [`BatchError::PartialRow`] or [`BatchError::Length`] if `configurations` does not have as
    /// many rows as each non-empty column has slots; [`BatchError::Cancelled`].
    pub fn nearest(
        &self,
        configurations: &[N],
        limit: N,
        control: &Control<'_>,
        out: NearestColumns<'_, N>,
    ) -> Result<(), BatchError> {
        let count = out.distance.len().max(out.pair.len());
        out.check(count)?;
        self.check("distance", configurations, count)?;
        entries::nearest(self, (configurations, limit, count), control, out)
    }

    /// Checks that there are as many configurations as output slots.
    fn check(
        &self,
        argument: &'static str,
        configurations: &[N],
        given: usize,
    ) -> Result<(), BatchError> {
        let needed = self.tree.count_of(configurations, Some(given))?;
        if given == needed { Ok(()) } else { Err(BatchError::Length { argument, given, needed }) }
    }

    /// Converts a pair to indices in the shared numbering of bodies and obstacles.
    pub(super) fn numbers_of(&self, (body, other): (u32, Other)) -> [u32; 2] {
        let bodies = u32::try_from(self.bodies.len()).expect("32 bits can number the bodies");
        match other {
            Other::Body(other) => [body, other],
            Other::Obstacle(obstacle) => [body, bodies + obstacle],
        }
    }

    /// Returns the pairs of bodies in ascending order, followed by the pairs of a body and an
    /// obstacle that must not touch, in ascending order.
    pub(super) fn pairs_in_order(&self) -> impl Iterator<Item = (u32, Other)> + '_ {
        let pairs = self.pairs.iter().map(|&[one, other]| (one, Other::Body(other)));
        let bodies = 0..u32::try_from(self.bodies.len()).expect("32 bits can number the bodies");
        let obstacles =
            0..u32::try_from(self.obstacles.len()).expect("32 bits can number the obstacles");
        let beside =
            bodies.flat_map(move |body| obstacles.clone().map(move |obstacle| [body, obstacle]));
        let beside = beside.filter(|pair| self.ignored.binary_search(pair).is_err());
        pairs.chain(beside.map(|[body, obstacle]| (body, Other::Obstacle(obstacle))))
    }
}

/// Builds the filter of [`Checker::try_new`].
pub(super) fn robot<N: Space<D>, const D: usize>(
    tree: &FrameTree<N, D>,
    bodies: &[Body<N, D>],
    pairs: &[[u32; 2]],
) -> RobotFilter<D> {
    let placed = bodies.iter().map(|body| {
        let on_node = tree.frames[body.frame].then(&body.pose);
        (&*body.shape, on_node)
    });
    RobotFilter::new(tree, placed, pairs)
}

/// Checks that the number of bodies fits in 32 bits, and that each body is on an existing frame and
/// has a finite pose.
fn check_bodies<N: Real, const D: usize>(
    bodies: &[Body<N, D>],
    frames: usize,
) -> Result<(), CheckerError> {
    let given = bodies.len();
    if u32::try_from(given).is_err() {
        return Err(CheckerError::TooMany { given });
    }
    for (index, body) in bodies.iter().enumerate() {
        if body.frame >= frames {
            return Err(CheckerError::BodyFrame { body: index, frame: body.frame, frames });
        }
        if !body.pose.is_finite() {
            return Err(CheckerError::NotFinite { argument: "bodies", index });
        }
    }
    Ok(())
}

/// Checks that `is_pair` is true for all pairs; `argument` names the list in the error.
fn check_pairs(
    argument: &'static str,
    pairs: &[[u32; 2]],
    is_pair: impl Fn(&[u32; 2]) -> bool,
) -> Result<(), CheckerError> {
    match pairs.iter().position(|pair| !is_pair(pair)) {
        None => Ok(()),
        Some(index) => Err(CheckerError::Pair { argument, index, pair: pairs[index] }),
    }
}
