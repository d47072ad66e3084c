//! A tree over a user's boxes.

use super::entries;
use core::fmt;

use super::boxes::{around, check, count, packed};
use super::{Best, BoxTreeError, Search, Sweep};
use crate::bounding_volume::{Aabb, Ray};
use crate::bvh::{Bounds, Lanes, Tree};
use crate::math::{Point, Real, Space, Vector, max};

/// A tree over boxes that are static, or that all move at once; a box is identified by its index.
///
/// All tests are closed: boxes that only touch overlap. Results are exact for the boxes as given, and equal on every
/// machine. Boxes may coincide, be flat, or be unbounded. A box with a face beyond the range of `f32` is treated as
/// unbounded. Each search tests all unbounded boxes one by one, so there should be few.
///
/// Building costs O(n log n). A search opens O(log n) blocks of sixteen boxes plus the blocks of its results, unless
/// boxes overlap heavily. In addition to its box, each object takes about 60 bytes in 2D and 85 in 3D, at most twice
/// that with spare capacity.
///
/// ```
/// use impinge::bounding_volume::{Aabb, Ray};
/// use impinge::math::{Point, Vector};
/// use impinge::partitioning::BoxTree;
///
/// // Unit squares at x = 0, 10, 20, …
/// let square = |i: u8| {
///     let corner = Point::<f32, 2>::new(10.0 * f32::from(i), 0.0);
///     Aabb::new(corner, corner + Vector::<f32, 2>::new(1.0, 1.0))
/// };
/// let tree = BoxTree::from_boxes(&(0..100).map(square).collect::<Vec<_>>());
///
/// let strip = Aabb::new(Point::<f32, 2>::new(15.0, 0.5), Point::<f32, 2>::new(40.0, 0.5));
/// assert_eq!(tree.overlapping(&strip), [2, 3, 4]);
/// assert_eq!(tree.containing(&Point::<f32, 2>::new(41.0, 1.0)), [4]);
///
/// let ray = Ray::new(Point::<f32, 2>::new(55.0, 0.5), Vector::<f32, 2>::new(2.0, 0.0));
/// assert_eq!(tree.first_hit(&ray, f32::INFINITY), Some((6, 2.5)));
/// assert_eq!(tree.nearest(&Point::<f32, 2>::new(27.0, 1.0), f32::INFINITY), Some((3, 3.0)));
/// ```
#[derive(Clone)]
pub struct BoxTree<N: Real, const D: usize> {
    boxes: Vec<Aabb<N, D>>,
    /// Union of all boxes; `None` if there are none.
    bounds: Option<Aabb<N, D>>,
    tree: Tree<D>,
    /// Boxes that no finite `f32` box encloses, ascending.
    unbounded: Vec<u32>,
    lanes: Lanes,
}

impl<N: Real, const D: usize> fmt::Debug for BoxTree<N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("BoxTree").field("boxes", &self.boxes).finish()
    }
}

/// A search whose results have no order.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Question<'a, N: Real, const D: usize> {
    Overlapping(&'a Aabb<N, D>),
    Containing(&'a Point<N, D>),
    HitBy(&'a Ray<N, D>),
}

impl<N: Space<D>, const D: usize> BoxTree<N, D> {
    /// Builds a tree over `boxes`, which may be empty; each is identified by its index.
    ///
    /// # Panics
    /// Where [`Self::try_from_boxes`] returns an error.
    #[must_use]
    #[track_caller]
    pub fn from_boxes(boxes: &[Aabb<N, D>]) -> Self {
        match Self::try_from_boxes(boxes) {
            Ok(tree) => tree,
            Err(error) => panic!("{error}"),
        }
    }

    /// Builds a tree over `boxes`, which may be empty; each is identified by its index.
    ///
    /// # Errors
    /// If a box is inverted or has a NaN, or if there are more than 2³² − 2 boxes. [`Aabb`] rejects such boxes,
    /// but arithmetic on boxes can produce them.
    pub fn try_from_boxes(boxes: &[Aabb<N, D>]) -> Result<Self, BoxTreeError> {
        Self::try_from_vec(boxes.to_vec())
    }

    /// Builds a tree over `boxes` without copying them; see [`Self::try_from_boxes`] for the errors.
    pub(crate) fn try_from_vec(boxes: Vec<Aabb<N, D>>) -> Result<Self, BoxTreeError> {
        entries::build(boxes)
    }

    /// Replaces all boxes; see [`Self::try_refit`].
    ///
    /// # Panics
    /// Where [`Self::try_refit`] returns an error.
    #[track_caller]
    pub fn refit(&mut self, boxes: &[Aabb<N, D>]) {
        if let Err(error) = self.try_refit(boxes) {
            panic!("{error}");
        }
    }

    /// Replaces all boxes, in the order of [`Self::boxes`]. On an error nothing has changed.
    ///
    /// Results equal those of a new tree. The order of the tree stays and its upper layers are refitted: O(n), without
    /// a sort. When the total surface of the blocks has grown by a fifth, the order is renewed over several calls of
    /// O(n) each; until then searches are slower.
    ///
    /// ```
    /// use impinge::bounding_volume::Aabb;
    /// use impinge::math::Point;
    /// use impinge::partitioning::BoxTree;
    ///
    /// let strip = |x: f32| Aabb::new(Point::<f32, 2>::new(x, 0.0), Point::<f32, 2>::new(x + 1.0, 1.0));
    /// let mut tree = BoxTree::from_boxes(&[strip(0.0), strip(5.0)]);
    /// tree.refit(&[strip(0.0), strip(9.0)]);
    /// assert_eq!(tree.containing(&Point::<f32, 2>::new(9.5, 0.5)), [1]);
    /// ```
    ///
    /// # Errors
    /// If a box is inverted or has a NaN, or the number of boxes differs from [`Self::len`].
    pub fn try_refit(&mut self, boxes: &[Aabb<N, D>]) -> Result<(), BoxTreeError> {
        entries::refit(self, boxes)
    }

    /// Returns the indices of the boxes that overlap `aabb`, ascending.
    #[must_use]
    pub fn overlapping(&self, aabb: &Aabb<N, D>) -> Vec<usize> {
        self.collect(&Question::Overlapping(aabb))
    }

    /// Returns the indices of the boxes that contain the point, ascending.
    #[must_use]
    pub fn containing(&self, point: &Point<N, D>) -> Vec<usize> {
        self.collect(&Question::Containing(point))
    }

    /// Returns the indices of the boxes that the ray meets, ascending. A ray that is not finite meets nothing.
    #[must_use]
    pub fn hit_by(&self, ray: &Ray<N, D>) -> Vec<usize> {
        self.collect(&Question::HitBy(ray))
    }

    /// Calls `visit` with the index of each box that overlaps `aabb`, without allocating. The order is unspecified but
    /// deterministic.
    pub fn visit_overlapping(&self, aabb: &Aabb<N, D>, visit: impl FnMut(usize)) {
        self.each(&Question::Overlapping(aabb), visit);
    }

    /// Calls `visit` with the index of each box that contains the point, without allocating. The order is unspecified
    /// but deterministic.
    pub fn visit_containing(&self, point: &Point<N, D>, visit: impl FnMut(usize)) {
        self.each(&Question::Containing(point), visit);
    }

    /// Calls `visit` with the index of each box that the ray meets, without allocating. The order is unspecified but
    /// deterministic. A ray that is not finite meets nothing.
    pub fn visit_hit_by(&self, ray: &Ray<N, D>, visit: impl FnMut(usize)) {
        self.each(&Question::HitBy(ray), visit);
    }

    /// Calls `visit` with the index of each box that the ray enters at or before `max_time`, and the time of entry, in
    /// ascending order of (time, index). At time `t` the ray is at `origin + t * dir`.
    ///
    /// `visit` returns the new `max_time`, which must not increase. Return the time of the best hit so far to find the
    /// first object that the ray meets, the unchanged `max_time` to visit all boxes, or a negative time to stop. A ray
    /// that starts in a box enters it at time zero. A ray that is not finite meets nothing.
    ///
    /// ```
    /// use impinge::bounding_volume::{Aabb, Ray};
    /// use impinge::math::{Point, Vector};
    /// use impinge::partitioning::BoxTree;
    ///
    /// // Disks of radius 1 on a line, and the first of them that a ray meets.
    /// let centers = [2.0_f32, 5.0, 8.0].map(|x| Point::<f32, 2>::new(x, 0.0));
    /// let reach = Vector::<f32, 2>::new(1.0, 1.0);
    /// let tree = BoxTree::from_boxes(&centers.map(|c| Aabb::new(c - reach, c + reach)));
    /// let ray = Ray::new(Point::<f32, 2>::new(0.0, 1.0), Vector::<f32, 2>::new(1.0, -0.25));
    /// let (mut first, mut looked_at) = (None, 0);
    /// tree.visit_ray(&ray, f32::INFINITY, |index, _| {
    ///     looked_at += 1;
    ///     let closest = (centers[index] - ray.origin).dot(&ray.dir) / ray.dir.norm_squared();
    ///     if (ray.point_at(closest) - centers[index]).norm() <= 1.0 {
    ///         first = first.or(Some(index));
    ///     }
    ///     if first.is_some() { -1.0 } else { f32::INFINITY }
    /// });
    /// assert_eq!((first, looked_at), (Some(0), 1));
    /// ```
    pub fn visit_ray(&self, ray: &Ray<N, D>, max_time: N, mut visit: impl FnMut(usize, N) -> N) {
        let mut found = |id: u32, time: N| visit(id as usize, time);
        entries::by_time(self, &Sweep::along(ray), max_time, &mut found);
    }

    /// Calls `visit` with the index of each box that `aabb`, moving with `velocity`, touches at or before `max_time`,
    /// and the first time of contact, in ascending order of (time, index).
    ///
    /// `visit` returns the new `max_time`, which must not increase; a negative one stops the search. Boxes that overlap
    /// `aabb` are touched at time zero, for any velocity; with a velocity of zero only these are found. `aabb` may be
    /// unbounded. If the velocity is not finite or `aabb` has no finite point, nothing is touched.
    ///
    /// A solid in the moving box touches a solid in a box of the tree no earlier than the boxes touch. So in a search
    /// for the first impact, `visit` returns the time of the best impact so far.
    ///
    /// ```
    /// use impinge::bounding_volume::Aabb;
    /// use impinge::math::{Point, Vector};
    /// use impinge::partitioning::BoxTree;
    ///
    /// let square = |x: f32, y: f32| {
    ///     let corner = Point::<f32, 2>::new(x, y);
    ///     Aabb::new(corner, corner + Vector::<f32, 2>::new(1.0, 1.0))
    /// };
    /// let tree = BoxTree::from_boxes(&[square(6.0, 0.0), square(3.0, 1.0), square(3.0, 1.5)]);
    /// let mut touched = Vec::new();
    /// let velocity = Vector::<f32, 2>::new(2.0, 0.0);
    /// tree.visit_cast(&square(0.0, 0.0), &velocity, f32::INFINITY, |index, time| {
    ///     touched.push((index, time));
    ///     f32::INFINITY
    /// });
    /// assert_eq!(touched, [(1, 1.0), (0, 2.5)], "the third is passed by half a unit");
    /// ```
    pub fn visit_cast(
        &self,
        aabb: &Aabb<N, D>,
        velocity: &Vector<N, D>,
        max_time: N,
        mut visit: impl FnMut(usize, N) -> N,
    ) {
        let mut found = |id: u32, time: N| visit(id as usize, time);
        let sweep = Sweep { aabb: *aabb, velocity: *velocity };
        entries::by_time(self, &sweep, max_time, &mut found);
    }

    /// Calls `visit` with the index of each box at most `max_distance` from the point, and its distance, in ascending
    /// order of (distance, index). Boxes that contain the point have distance zero.
    ///
    /// `visit` returns the new `max_distance`, which must not increase. Return the distance of the best object so far
    /// to find the nearest, the unchanged `max_distance` to visit all boxes, or a negative distance to stop. A point
    /// that is not finite is near nothing. Distances whose squares underflow in `N` become zero.
    pub fn visit_nearest(
        &self,
        point: &Point<N, D>,
        max_distance: N,
        visit: impl FnMut(usize, N) -> N,
    ) {
        self.visit_nearest_to_box(&Aabb::at(*point), max_distance, visit);
    }

    /// Calls `visit` with the index of each box at most `max_distance` from `aabb`, and its distance, in ascending
    /// order of (distance, index). Boxes that overlap `aabb` have distance zero.
    ///
    /// `visit` returns the new `max_distance`, which must not increase; a negative one stops the search. `aabb` may be
    /// unbounded. A box without a finite point, or with a NaN from arithmetic, is near nothing.
    ///
    /// The distance between a solid in `aabb` and a solid in a box of the tree is never less than the distance between
    /// the boxes. So in a search for the nearest solid, `visit` returns the distance of the nearest solid so far.
    ///
    /// ```
    /// use impinge::bounding_volume::Aabb;
    /// use impinge::math::{Point, Vector};
    /// use impinge::partitioning::BoxTree;
    ///
    /// let square = |x: f32, y: f32| {
    ///     let corner = Point::<f32, 2>::new(x, y);
    ///     Aabb::new(corner, corner + Vector::<f32, 2>::new(1.0, 1.0))
    /// };
    /// let tree = BoxTree::from_boxes(&[square(4.0, 5.0), square(-3.0, 0.5), square(1.0, 1.0)]);
    /// let mut found = Vec::new();
    /// tree.visit_nearest_to_box(&square(0.0, 0.0), 3.0, |index, distance| {
    ///     found.push((index, distance));
    ///     3.0
    /// });
    /// assert_eq!(found, [(2, 0.0), (1, 2.0)], "the first is 5 away, corner to corner");
    /// ```
    pub fn visit_nearest_to_box(
        &self,
        aabb: &Aabb<N, D>,
        max_distance: N,
        mut visit: impl FnMut(usize, N) -> N,
    ) {
        let mut found = |id: u32, distance: N| visit(id as usize, distance);
        entries::by_distance(self, aabb, max_distance, &mut found);
    }

    /// Returns the index of the box that the ray enters first, and the time of entry; at equal times the lowest index.
    /// `None` if the ray enters no box at or before `max_time`.
    #[must_use]
    pub fn first_hit(&self, ray: &Ray<N, D>, max_time: N) -> Option<(usize, N)> {
        let (mut first, sweep) = (Best::none(max_time), Sweep::along(ray));
        entries::near_first(self, &sweep, max_time, &mut |id, time| first.offer(id, time));
        first.of
    }

    /// Returns the index of the box nearest to the point, and its distance; at equal distances the lowest index. `None`
    /// if no box is at most `max_distance` away.
    #[must_use]
    pub fn nearest(&self, point: &Point<N, D>, max_distance: N) -> Option<(usize, N)> {
        let mut nearest = Best::none(max_distance);
        let mut found = |id: u32, distance: N| nearest.offer(id, distance);
        let at = Aabb::at(*point);
        entries::nearest_first(self, &at, max_distance, &mut found);
        nearest.of
    }

    fn collect(&self, question: &Question<'_, N, D>) -> Vec<usize> {
        let mut found = Vec::new();
        self.each(question, |index| found.push(index));
        found.sort_unstable();
        found
    }

    fn each(&self, question: &Question<'_, N, D>, mut visit: impl FnMut(usize)) {
        entries::each(self, question, &mut |id| visit(id as usize));
    }
}

impl<N: Real, const D: usize> BoxTree<N, D> {
    /// Returns the number of boxes.
    #[must_use]
    pub const fn len(&self) -> usize {
        self.boxes.len()
    }

    /// Returns `true` if there is no box.
    #[must_use]
    pub const fn is_empty(&self) -> bool {
        self.boxes.is_empty()
    }

    /// Returns the boxes, by index.
    #[must_use]
    pub fn boxes(&self) -> &[Aabb<N, D>] {
        &self.boxes
    }

    /// Returns the smallest box around all boxes; `None` if there are none.
    #[must_use]
    pub const fn bounds(&self) -> Option<&Aabb<N, D>> {
        self.bounds.as_ref()
    }

    /// Checks every invariant; for tests.
    ///
    /// # Errors
    /// Returns a sentence that names the violated invariant.
    pub fn validate(&self) -> Result<(), String> {
        self.tree.validate()?;
        if self.tree.len() + self.unbounded.len() != self.boxes.len() {
            return Err(format!("{} boxes of {}", self.tree.len(), self.boxes.len()));
        }
        for (id, aabb) in (0..).zip(&self.boxes) {
            let tight = Bounds::enclosing(aabb);
            let is_listed = self.unbounded.binary_search(&id).is_ok();
            let is_kept = self.tree.bounds(id) == Some(tight).filter(Bounds::is_finite);
            if is_listed == tight.is_finite() || !is_kept {
                return Err(format!("box {id} is not where it belongs"));
            }
        }
        Ok(())
    }

    /// Implements [`Self::try_from_boxes`].
    pub(crate) fn build(boxes: Vec<Aabb<N, D>>) -> Result<Self, BoxTreeError> {
        let count = count(boxes.len())?;
        check(&boxes)?;
        let lanes = Lanes::detect();
        let (tree, unbounded) = packed(lanes, (0..count).zip(boxes.iter().copied()));
        Ok(Self { bounds: around(&boxes), boxes, tree, unbounded, lanes })
    }

    /// Implements [`Self::try_refit`].
    pub(crate) fn refit_to(&mut self, boxes: &[Aabb<N, D>]) -> Result<(), BoxTreeError> {
        let (given, needed) = (boxes.len(), self.boxes.len());
        if given != needed {
            return Err(BoxTreeError::WrongCount { given, needed });
        }
        check(boxes)?;
        self.tree.drop_slabs();
        self.unbounded.clear();
        for (id, aabb) in (0..count(given)?).zip(boxes) {
            let (tight, kept) = (Bounds::enclosing(aabb), self.tree.bounds(id));
            let is_listed = !tight.is_finite();
            match kept {
                Some(_) if is_listed => self.tree.remove(id),
                Some(kept) if kept != tight => self.tree.set_still(id, &tight),
                None if !is_listed => _ = self.tree.insert_still(id, &tight),
                _ => (),
            }
            if is_listed {
                self.unbounded.push(id);
            }
        }
        self.tree.refit();
        self.tree.commit_boxes();
        self.tree.maintain();
        self.boxes.copy_from_slice(boxes);
        self.bounds = around(boxes);
        Ok(())
    }

    /// Returns an upper bound of the extent of all objects along `direction`. The bound exceeds the maximum of
    /// `extent_of(id)` by at most a few `f32` rounding units of the coordinates. Minus infinity if there are no
    /// objects. Calls `extent_of` for O(log n) objects on curved surfaces, and for more where many are almost equally
    /// extreme.
    pub(crate) fn extent_along(
        &self,
        direction: Vector<N, D>,
        mut extent_of: impl FnMut(u32) -> N,
    ) -> N {
        let extent = self.tree.extent_along(direction, &mut extent_of);
        self.unbounded.iter().fold(extent, |extent, &id| max(extent_of(id), extent))
    }

    /// Calls `found` with the id of each box that matches `question`, in no particular order.
    pub(crate) fn answer(&self, question: &Question<'_, N, D>, found: &mut dyn FnMut(u32)) {
        match question {
            Question::Overlapping(aabb) => self.search().each_overlapping(aabb, found),
            Question::Containing(point) => self.search().each_containing(point, found),
            Question::HitBy(ray) => self.search().each_hit(ray, found),
        }
    }

    /// Calls `found` with each box that `sweep` touches at or before `max_time`, in ascending order of (time, id).
    /// `found` returns the new maximum time.
    pub(crate) fn by_time(
        &self,
        sweep: &Sweep<N, D>,
        max_time: N,
        found: &mut dyn FnMut(u32, N) -> N,
    ) {
        self.search().by_time(sweep, max_time, found);
    }

    /// Calls `found` with each box that `sweep` touches at or before `max_time`, roughly by ascending time: faster than
    /// [`Self::by_time`]. `found` returns the new maximum time.
    pub(crate) fn near_first(
        &self,
        sweep: &Sweep<N, D>,
        max_time: N,
        found: &mut dyn FnMut(u32, N) -> N,
    ) {
        self.search().near_first(sweep, max_time, found);
    }

    /// Computes slabs around the faces in each block, which speed up searches for near pairs of faces until the next
    /// refit. `normals` and `corners` are by id; nothing is computed unless there is a normal for each box.
    pub(crate) fn add_slabs<F: Fn(u32) -> [Point<N, D>; 3]>(
        &mut self,
        normals: &[Vector<N, D>],
        corners: F,
    ) {
        if normals.len() == self.boxes.len() {
            self.tree.add_slabs(normals, corners);
        }
    }

    pub(crate) const fn packed(&self) -> &Tree<D> {
        &self.tree
    }

    /// Returns the packed tree if it contains all boxes; `None` if some are unbounded.
    pub(crate) fn packed_whole(&self) -> Option<&Tree<D>> {
        self.unbounded.is_empty().then_some(&self.tree)
    }

    pub(crate) fn unbounded(&self) -> &[u32] {
        &self.unbounded
    }

    /// Calls `found` with each box at most `max_distance` from `aabb`, in ascending order of (distance, id). `found`
    /// returns the new maximum distance.
    pub(crate) fn by_distance(
        &self,
        aabb: &Aabb<N, D>,
        max_distance: N,
        found: &mut dyn FnMut(u32, N) -> N,
    ) {
        self.search().by_distance(aabb, max_distance, found);
    }

    /// Calls `found` with each box at most `max_distance` from `aabb`, roughly by ascending distance: faster than
    /// [`Self::by_distance`]. `found` returns the new maximum distance.
    pub(crate) fn nearest_first(
        &self,
        aabb: &Aabb<N, D>,
        max_distance: N,
        found: &mut dyn FnMut(u32, N) -> N,
    ) {
        self.search().nearest_first(aabb, max_distance, found);
    }

    fn search(&self) -> Search<'_, N, D, 1> {
        let (exact, trees) = (self.boxes.as_slice(), [&self.tree]);
        Search { exact, trees, unbounded: &self.unbounded, lanes: self.lanes }
    }
}
