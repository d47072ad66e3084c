//! All contacts of a world in two dense lists. Each contact has its index in the lists of the
//! previous fill.
//!
//! ```text
//! manifolds   [pair 7 | 0..4]  [pair 9 | 4..6]  [pair 3 | 6..10] ...         in memory order
//! points       7 7 7 7  9 9  3 3 3 3 ...        world1 | depth | number | previous
//!                       │ │
//! old points   7 7 7 7  │ │  3 3 3 3 ...        the lists of the previous fill
//!                       └─┴── previous is None: pair 9 is new
//! ```
//!
//! Memory order changes little between updates, so a pair is searched among the [`WINDOW`] old
//! pairs behind the last match. A pair that is not among them, such as a pair that filled the gap
//! of a removed pair, is searched in a sorted list of the old pairs without a match. If all pairs
//! are found among the [`WINDOW`] next pairs, a fill takes linear time.

use core::num::NonZeroU32;
use core::ops::Range;

use crate::math::{Point, Real, Space, Unit, Vector};
use crate::narrow_phase::CollisionObjectHandle;
use crate::query::{ContactId, ManifoldView};

/// Number of old pairs, from the one behind the last match, among which a pair is searched.
const WINDOW: usize = 16;

/// A contact point in a [`ContactStream`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamPoint<N: Real, const D: usize> {
    /// The point on the surface of the first solid, in the world frame. The point on the second
    /// solid is `world1 - depth * normal`, with the normal of the manifold.
    pub world1: Point<N, D>,
    /// The penetration depth along the normal; minus the distance if the solids are apart.
    pub depth: N,
    /// The part of the contact's id that is unique within the pair.
    number: u32,
    /// One more than the index of the contact in the points of the previous fill; `None` for a new
    /// contact.
    previous: Option<NonZeroU32>,
}

impl<N: Real, const D: usize> StreamPoint<N, D> {
    /// Returns the index of this contact in the points of the previous fill; `None` if that fill
    /// did not have the contact.
    #[inline]
    #[must_use]
    pub const fn previous(&self) -> Option<usize> {
        match self.previous {
            Some(next) => Some(next.get() as usize - 1),
            None => None,
        }
    }
}

/// A manifold in a [`ContactStream`]: two objects, a normal and a range of points.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct StreamManifold<N: Real, const D: usize> {
    /// The object with the smaller handle.
    pub object1: CollisionObjectHandle,
    /// The object with the larger handle.
    pub object2: CollisionObjectHandle,
    /// The unit contact normal in the world frame; it points from the first object to the second.
    pub normal: Unit<Vector<N, D>>,
    /// The part of the contact ids that identifies the pair; equal for all points of the manifold.
    pair: u64,
    start: u32,
    end: u32,
}

impl<N: Real, const D: usize> StreamManifold<N, D> {
    /// Returns the range of the manifold's points in [`ContactStream::points`]; never empty.
    #[inline]
    #[must_use]
    pub const fn range(&self) -> Range<usize> {
        self.start as usize..self.end as usize
    }

    /// Returns the id of a point of this manifold.
    #[must_use]
    pub const fn id(&self, point: &StreamPoint<N, D>) -> ContactId {
        ContactId::new(self.pair, point.number)
    }
}

/// All contacts of a world in two dense lists, for readers of all of them: solvers, recorders.
///
/// [`CollisionWorld::read_contacts`] fills the stream after an update. Each point has its index in
/// the points of the previous fill. So a solver can keep its impulses in a list parallel to
/// [`Self::points`], and start from the old impulses without a hash map. For a pile of 9261 boxes
/// in 3D with 435 440 contacts, filling, reading and fetching the old impulses takes 12 ms, where
/// [`CollisionWorld::contact_views`] with a `HashMap` by id takes 60 to 90 ms. Without ids, the
/// views alone are read in 7 ms. A stream keeps its memory between fills.
///
/// Features, parts and kinematics are not in the stream: read them by
/// [`CollisionWorld::contact_pair`].
///
/// After [`CollisionWorld::rewind`], or to read another world, call [`Self::clear`]: contact ids
/// are unique only within one world, and only until it is rewound.
///
/// ```
/// use impinge::dim2::math::{Isometry, Vector};
/// use impinge::dim2::shape::{Cuboid, ShapeHandle};
/// use impinge::dim2::narrow_phase::{ContactStream, StreamPoint};
/// use impinge::dim2::world::{CollisionGroups, CollisionWorld, GeometricQueryType};
///
/// let mut world = CollisionWorld::<f32, ()>::new(0.02);
/// let square = ShapeHandle::new(Cuboid::new(Vector::new(1.0, 1.0)));
/// let (groups, contacts) = (CollisionGroups::new(), GeometricQueryType::Contacts(0.0, 0.0));
/// for y in [0.0, 1.75] {
///     world.add(Isometry::translation(0.0, y), square.clone(), groups, contacts, ());
/// }
///
/// let (mut stream, mut impulses) = (ContactStream::new(), Vec::<f32>::new());
/// for step in 0..2 {
///     world.update();
///     world.read_contacts(&mut stream);
///     // The impulse of the previous step, or zero for a new contact.
///     let old = |point: &StreamPoint<f32>| point.previous().map_or(0.0, |index| impulses[index]);
///     let mut now: Vec<_> = stream.points().iter().map(old).collect();
///     for manifold in stream.manifolds() {
///         assert_eq!((manifold.object1.uid(), manifold.object2.uid()), (0, 1));
///         for (point, impulse) in stream.points()[manifold.range()].iter().zip(&mut now) {
///             assert_eq!((point.depth, *manifold.normal), (0.25, Vector::y()));
///             assert_eq!(*impulse, 2.5 * step as f32, "kept from step 0");
///             *impulse += 2.5;
///         }
///     }
///     impulses = now;
/// }
/// assert_eq!(impulses, [5.0, 5.0]);
/// ```
///
/// [`CollisionWorld::read_contacts`]: crate::world::CollisionWorld::read_contacts
/// [`CollisionWorld::contact_views`]: crate::world::CollisionWorld::contact_views
/// [`CollisionWorld::contact_pair`]: crate::world::CollisionWorld::contact_pair
/// [`CollisionWorld::rewind`]: crate::world::CollisionWorld::rewind
#[derive(Clone, Debug)]
pub struct ContactStream<N: Real, const D: usize> {
    now: Lists<N, D>,
    old: Lists<N, D>,
    /// Scratch of a fill: the pairs of this fill that have no match in the window.
    missed: Vec<PairRange>,
    /// Scratch of a fill: the pairs of the previous fill that have no match yet, sorted by id.
    left: Vec<PairRange>,
}

/// The handles of two objects and a manifold of their pair.
type NamedView<'a, N, const D: usize> =
    (CollisionObjectHandle, CollisionObjectHandle, ManifoldView<'a, N, D>);

/// The manifolds and points of one fill of a [`ContactStream`].
#[derive(Clone, Debug)]
struct Lists<N: Real, const D: usize> {
    manifolds: Vec<StreamManifold<N, D>>,
    points: Vec<StreamPoint<N, D>>,
}

/// A pair in [`Lists`]: its id, which all its contact ids contain, and the range of its points. The
/// manifolds of a pair are consecutive, and so are its points.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
struct PairRange {
    pair: u64,
    start: u32,
    end: u32,
}

impl<N: Real, const D: usize> Default for Lists<N, D> {
    fn default() -> Self {
        Self { manifolds: Vec::new(), points: Vec::new() }
    }
}

impl<N: Real, const D: usize> Default for ContactStream<N, D> {
    fn default() -> Self {
        Self::new()
    }
}

impl<N: Real, const D: usize> ContactStream<N, D> {
    /// Creates a stream without contacts.
    #[must_use]
    pub fn new() -> Self {
        let (now, old) = (Lists::default(), Lists::default());
        Self { now, old, missed: Vec::new(), left: Vec::new() }
    }

    /// Returns the manifolds; those of a pair are consecutive. The order of the pairs is
    /// unspecified, but the same calls on a world lead to the same order on every machine.
    #[must_use]
    pub fn manifolds(&self) -> &[StreamManifold<N, D>] {
        &self.now.manifolds
    }

    /// Returns the contact points, in the order of their manifolds.
    #[must_use]
    pub fn points(&self) -> &[StreamPoint<N, D>] {
        &self.now.points
    }

    /// Removes all contacts. For the next fill, every contact is new.
    pub fn clear(&mut self) {
        for lists in [&mut self.now, &mut self.old] {
            lists.manifolds.clear();
            lists.points.clear();
        }
    }
}

impl<N: Space<D>, const D: usize> ContactStream<N, D> {
    /// Replaces the contacts by those of `views`.
    #[inline]
    pub(crate) fn fill<'a>(&mut self, views: impl Iterator<Item = NamedView<'a, N, D>>) {
        core::mem::swap(&mut self.now, &mut self.old);
        self.now.manifolds.clear();
        self.now.points.clear();
        // Not a `for` loop: chains are faster to fold than to step.
        views.for_each(|(object1, object2, view)| self.now.push([object1, object2], &view));
        self.connect();
    }

    /// Sets [`StreamPoint::previous`] of all points.
    fn connect(&mut self) {
        let Self { now, old, missed, left } = self;
        missed.clear();
        let (mut next, mut next_old) = (0, 0);
        while let Some(pair) = now.pair_at(&mut next) {
            match old.take(pair.pair, &mut next_old) {
                Some(before) => link(pair, before, &mut now.points, &old.points),
                None => missed.push(pair),
            }
        }
        if missed.is_empty() {
            return;
        }
        left.clear();
        left.extend(old.pairs().filter(|pair| pair.pair != TAKEN));
        left.sort_unstable();
        for pair in missed {
            if let Ok(found) = left.binary_search_by_key(&pair.pair, |before| before.pair) {
                link(*pair, left[found], &mut now.points, &old.points);
            }
        }
    }
}

/// The value that replaces the id of an old pair once the pair has a match. It is the id of no
/// pair.
const TAKEN: u64 = ContactId::NULL.pair;

impl<N: Space<D>, const D: usize> Lists<N, D> {
    /// Appends a manifold. A manifold of a custom algorithm may have contacts with different pair
    /// ids; it is split where the pair id changes.
    #[inline(always)]
    fn push(
        &mut self,
        [object1, object2]: [CollisionObjectHandle; 2],
        view: &ManifoldView<'_, N, D>,
    ) {
        let Self { manifolds, points } = self;
        let (normal, start) = (view.normal(), position(points.len()));
        let mut manifold =
            StreamManifold { object1, object2, normal, pair: TAKEN, start, end: start };
        view.each_placed(|id, world1, depth| {
            if id.pair != manifold.pair {
                if manifold.start < manifold.end {
                    manifolds.push(manifold);
                }
                (manifold.pair, manifold.start) = (id.pair, manifold.end);
            }
            points.push(StreamPoint { world1, depth, number: id.number, previous: None });
            manifold.end += 1;
        });
        manifolds.push(manifold);
    }
}

impl<N: Real, const D: usize> Lists<N, D> {
    /// Returns the pair whose manifolds begin at index `next`, and advances `next` behind them;
    /// `None` at the end of the manifolds.
    #[inline]
    fn pair_at(&self, next: &mut usize) -> Option<PairRange> {
        let first = self.manifolds.get(*next)?;
        let mut range = PairRange { pair: first.pair, start: first.start, end: first.end };
        *next += 1;
        while let Some(manifold) = self.manifolds.get(*next).filter(|more| more.pair == range.pair)
        {
            range.end = manifold.end;
            *next += 1;
        }
        Some(range)
    }

    /// Iterates over all pairs, in the order of their manifolds.
    fn pairs(&self) -> impl Iterator<Item = PairRange> {
        let mut next = 0;
        core::iter::from_fn(move || self.pair_at(&mut next))
    }

    /// Searches the pair with the id `pair` among [`WINDOW`] pairs, the first of which begins at
    /// manifold `next`. If the pair is there, marks it as [`TAKEN`], advances `next` behind it and
    /// returns it; else returns `None`.
    #[inline]
    fn take(&mut self, pair: u64, next: &mut usize) -> Option<PairRange> {
        let mut after = *next;
        for _ in 0..WINDOW {
            let first = after;
            let found = self.pair_at(&mut after)?;
            if found.pair == pair {
                self.manifolds[first..after].iter_mut().for_each(|manifold| manifold.pair = TAKEN);
                *next = after;
                return Some(found);
            }
        }
        None
    }
}

/// Converts an index to the type in which [`Lists`] store it.
fn position(index: usize) -> u32 {
    u32::try_from(index).expect("fewer than 2^32 contacts fit in memory")
}

/// Sets [`StreamPoint::previous`] of the points of `pair`. `before` is this pair in the previous
/// fill, and `old` has all points of that fill.
///
/// The search begins behind the last match, since contacts mostly keep their order. New contacts
/// get increasing numbers, so a point with a larger number than all old points of the pair is new.
#[inline]
fn link<N: Real, const D: usize>(
    pair: PairRange,
    before: PairRange,
    points: &mut [StreamPoint<N, D>],
    old: &[StreamPoint<N, D>],
) {
    let old = &old[before.start as usize..before.end as usize];
    let largest = old.iter().fold(0, |most, point| most.max(point.number));
    let mut expected = 0;
    for point in &mut points[pair.start as usize..pair.end as usize] {
        if point.number > largest {
            continue;
        }
        let mut order = (expected..old.len()).chain(0..expected.min(old.len()));
        if let Some(found) = order.find(|&index| old[index].number == point.number) {
            point.previous = NonZeroU32::new(before.start + position(found) + 1);
            expected = found + 1;
        }
    }
}
