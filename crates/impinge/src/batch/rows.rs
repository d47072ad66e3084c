//! The contact points of many pairs in columns, with the range of each pair.

use core::ops::Range;

use crate::math::{Real, Space};
use crate::query::ManifoldView;
use crate::shape::FeatureId;

/// Contact points of many pairs, in columns. The points of pair `i` are in slots
/// `starts[i]..starts[i + 1]`, as in the compressed sparse row format of matrices.
///
/// ```text
///   starts      0        2  2           6            one more than there are pairs
///   depth     [ p p    ][  ][ p p  p p ]             pair 1 has no contact
///   manifold  [ 0 0    ][  ][ 0 0  1 1 ]             pair 2 has two manifolds of two points each
/// ```
///
/// Two convex solids have at most one manifold; composites have one manifold for each flat patch of
/// contact. The points of a manifold have equal normals.
///
/// ```
/// use impinge::dim2::batch::{BatchError, Control, ManifoldRows, OnePose, PairBatch, Shapes, Side};
/// use impinge::dim2::math::{Isometry, Pose, Vector};
/// use impinge::dim2::query::ContactPrediction;
/// use impinge::dim2::shape::Cuboid;
///
/// let (square, here) = (Cuboid::new(Vector::new(1.0_f64, 1.0)), OnePose(Pose::identity()));
/// let places = [1.75, 5.0].map(|y| Isometry::translation(0.0, y));
/// let one = Side::try_new(Shapes::One(&square), &here)?;
/// let batch = PairBatch::try_new(one, Side::try_new(Shapes::One(&square), &places)?)?;
/// let mut rows = ManifoldRows::new();
/// batch.manifolds(&ContactPrediction::new(0.0, 0.0, 0.0), None, &Control::new(), &mut rows)?;
/// assert_eq!(rows.starts, [0, 2, 2], "two points, and none");
/// assert_eq!(rows.depth, [0.25; 2]);
/// assert_eq!(rows.normal[rows.points_of(0)], [[0.0, 1.0]; 2]);
/// # Ok::<(), BatchError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct ManifoldRows<N: Real, const D: usize> {
    /// The offset of the first slot of each pair, followed by the total number of points.
    pub starts: Vec<usize>,
    /// For each point, the index of its manifold among the manifolds of its pair.
    pub manifold: Vec<u32>,
    /// The point on the surface of the first shape, in the world frame.
    pub point1: Vec<[N; D]>,
    /// The point on the surface of the second shape, in the world frame.
    pub point2: Vec<[N; D]>,
    /// The unit vector from the first shape to the second, in the world frame.
    pub normal: Vec<[N; D]>,
    /// The penetration at the point along the normal, or minus the distance if the shapes are
    /// disjoint there.
    pub depth: Vec<N>,
    /// The index of the part of the first shape; 0 for a convex solid.
    pub part1: Vec<u32>,
    /// The index of the part of the second shape; 0 for a convex solid.
    pub part2: Vec<u32>,
    /// The feature of the first shape's part on which `point1` lies.
    pub feature1: Vec<FeatureId>,
    /// The feature of the second shape's part on which `point2` lies.
    pub feature2: Vec<FeatureId>,
}

impl<N: Real, const D: usize> ManifoldRows<N, D> {
    /// Creates rows without pairs.
    #[must_use]
    pub fn new() -> Self {
        Self {
            starts: vec![0],
            manifold: Vec::new(),
            point1: Vec::new(),
            point2: Vec::new(),
            normal: Vec::new(),
            depth: Vec::new(),
            part1: Vec::new(),
            part2: Vec::new(),
            feature1: Vec::new(),
            feature2: Vec::new(),
        }
    }

    /// Returns the number of pairs.
    #[must_use]
    pub const fn num_pairs(&self) -> usize {
        self.starts.len().saturating_sub(1)
    }

    /// Returns the total number of points of all pairs.
    #[must_use]
    pub const fn num_points(&self) -> usize {
        self.depth.len()
    }

    /// Returns the slots of the points of pair `pair`.
    ///
    /// # Panics
    /// If `pair` is not less than [`Self::num_pairs`].
    #[must_use]
    pub fn points_of(&self, pair: usize) -> Range<usize> {
        self.starts[pair]..self.starts[pair + 1]
    }

    /// Removes all pairs and keeps the memory.
    pub fn clear(&mut self) {
        let Self { starts, manifold, point1, point2, normal, depth, .. } = self;
        starts.clear();
        starts.push(0);
        manifold.clear();
        [point1, point2, normal].into_iter().for_each(Vec::clear);
        depth.clear();
        [&mut self.part1, &mut self.part2].into_iter().for_each(Vec::clear);
        [&mut self.feature1, &mut self.feature2].into_iter().for_each(Vec::clear);
    }

    /// Appends the points of the manifold with index `manifold` to the current pair, which
    /// [`Self::end_pair`] ends.
    #[inline]
    pub(super) fn push(&mut self, manifold: u32, view: &ManifoldView<'_, N, D>)
    where
        N: Space<D>,
    {
        for point in view.contacts() {
            self.manifold.push(manifold);
            self.point1.push(point.contact.world1.coords.into());
            self.point2.push(point.contact.world2.coords.into());
            self.normal.push((*point.contact.normal).into());
            self.depth.push(point.contact.depth);
            self.part1.push(point.part1);
            self.part2.push(point.part2);
            self.feature1.push(point.feature1);
            self.feature2.push(point.feature2);
        }
    }

    /// Ends the current pair: points that are pushed later belong to the next pair.
    #[inline]
    pub(super) fn end_pair(&mut self) {
        self.starts.push(self.depth.len());
    }

    /// Appends all pairs of `other` to these rows, and clears `other`.
    pub(super) fn append(&mut self, other: &mut Self) {
        let before = self.depth.len();
        self.starts.extend(other.starts.iter().skip(1).map(|start| before + start));
        self.manifold.append(&mut other.manifold);
        self.point1.append(&mut other.point1);
        self.point2.append(&mut other.point2);
        self.normal.append(&mut other.normal);
        self.depth.append(&mut other.depth);
        self.part1.append(&mut other.part1);
        self.part2.append(&mut other.part2);
        self.feature1.append(&mut other.feature1);
        self.feature2.append(&mut other.feature2);
        other.clear();
    }
}

impl<N: Real, const D: usize> Default for ManifoldRows<N, D> {
    fn default() -> Self {
        Self::new()
    }
}
