//! Pairs among more objects than one machine can hold: space is cut into tiles, whose pairs are
//! computed separately.
//!
//! ```text
//!   cut 0 ──── below ──── cut 1 ── tile 0       ┌────┬────────┐
//!     │                     └───── tile 1       │ 1  │   3    │    an object is assigned to each tile that its box,
//!     └─ at or above ──── cut 2 ── tile 2       ├────┼────────┤    grown by half the clearance, overlaps
//!                           └───── tile 3       │ 0  │   2    │
//!                                               └────┴────────┘    a pair belongs to exactly one tile
//! ```
//!
//! The tiles are the leaves of a k-d tree (Bentley, "Multidimensional binary search trees used for
//! associative searching", 1975) over the boxes of a sample. So all tiles have about the same
//! number of objects, even if the density of the objects varies. The grown boxes of two near
//! objects overlap, and the pair belongs to the tile that contains the lowest corner of this
//! overlap: the reference point of Dittrich and Seeger ("Data redundancy and duplicate detection in
//! spatial join processing", 2000). Both grown boxes contain that point, so both objects are
//! assigned to that tile.
//!
//! A [`Tiles`] consists of the clearance and the cuts in preorder. A subtree of n tiles has n - 1
//! cuts: first its own cut, then the ⌊n/2⌋ - 1 cuts of the ⌊n/2⌋ tiles below it, then the cuts of
//! the tiles above it.

use super::entries;
use super::within::{half_margin, is_distance};
use super::{BatchError, Control, Side};
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::math::order::order_of;
use crate::math::{Mapped, Point, Real, Space, max};

/// A plane perpendicular to an axis. A point is below the plane if its coordinate on this axis is
/// less than `at`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TileCut<N> {
    /// The index of the axis: 0 for x.
    pub axis: u32,
    /// The position on the axis.
    pub at: N,
}

/// A division of space into tiles, and the clearance up to which pairs are found.
///
/// [`tiles()`] computes a division. A division is plain data: [`Tiles::try_from_cuts`] creates an equal value from
/// [`Tiles::cuts`] and [`Tiles::clearance`], on another machine too.
#[derive(Clone, Debug, PartialEq)]
pub struct Tiles<N: Real, const D: usize> {
    clearance: N,
    cuts: Vec<TileCut<N>>,
}

/// The tiles of many objects: the tiles of object `i` are `tiles[starts[i]..starts[i + 1]]`,
/// ascending.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct TileRows {
    /// The index in `tiles` of each object's first tile, followed by the length of `tiles`.
    pub starts: Vec<usize>,
    /// Indices of tiles.
    pub tiles: Vec<u32>,
}

/// Cuts space into `number` tiles with about the same number of objects each.
///
/// `boxes` are the boxes of the objects or of a sample of them, as [`boxes()`](super::boxes)
/// computes them; `None` is ignored. The tiles depend on the arguments alone. The objects that are
/// later assigned to them may differ from the sample: any tiles lead to the same pairs, and only
/// the balance of work differs. If there are more tiles than objects, or no boxes at all, some
/// tiles are empty.
///
/// Cost: O(n log n log t) for n boxes and t tiles.
///
/// ```
/// use impinge::dim2::batch::{BatchError, Control, Shapes, Side, boxes, pairs_in_tile, tiles};
/// use impinge::dim2::math::Isometry;
/// use impinge::dim2::shape::Ball;
///
/// let (ball, ids) = (Ball::new(1.0_f64), [70, 71, 72, 73]);
/// let places = [0.0, 2.5, 6.0, 8.5].map(|x| Isometry::translation(x, 0.0));
/// let row = Side::try_new(Shapes::One(&ball), &places)?;
/// let boxes = boxes(&row, &Control::new())?;
/// let tiles = tiles(&boxes, 2, 1.0)?;
/// let rows = tiles.meeting(&boxes);
/// assert_eq!((rows.starts, rows.tiles), (vec![0, 1, 2, 3, 4], vec![0, 0, 1, 1]), "two in each");
/// // Here each tile receives all objects; objects that do not overlap it only cost time.
/// assert_eq!(pairs_in_tile(&row, &ids, &tiles, 0, &Control::new())?, [[70, 71]]);
/// assert_eq!(pairs_in_tile(&row, &ids, &tiles, 1, &Control::new())?, [[72, 73]]);
/// # Ok::<(), BatchError>(())
/// ```
///
/// # Errors
/// [`BatchError::NoTile`] if `number` is zero, [`BatchError::Distance`] if `clearance` is negative
/// or NaN.
pub fn tiles<N: Real, const D: usize>(
    boxes: &[Option<Aabb<N, D>>],
    number: u32,
    clearance: N,
) -> Result<Tiles<N, D>, BatchError> {
    is_distance(clearance)?;
    if number == 0 {
        return Err(BatchError::NoTile { tile: 0, tiles: 0 });
    }
    let mut tiles = Tiles { clearance, cuts: Vec::with_capacity(number as usize - 1) };
    let grown = boxes.iter().flatten().map(|aabb| tiles.grown(aabb));
    let grown = grown.filter(Aabb::holds_finite_point).collect();
    tiles.divide(grown, &Aabb::unbounded(), number);
    Ok(tiles)
}

/// Returns the pairs of objects that belong to tile `tile` and that touch, overlap, or are apart by
/// at most the clearance of the tiles. Each result is a pair of ids, the lower id first; the list
/// is in ascending order.
///
/// `side` has the objects for which [`Tiles::meeting`] lists the tile, in any order; other objects
/// cost time but do not change the result. `ids` has a distinct id for each element of `side`. For
/// any tiles, the lists of all tiles together contain exactly once each pair that
/// [`pairs_within_one`](super::pairs_within_one) finds among all objects.
///
/// The cost is at most that of `pairs_within_one` for the objects in `side`; pairs of other tiles
/// are rejected before the exact test.
///
/// # Errors
/// [`BatchError::Length`] if `ids` is not as long as the side, [`BatchError::NoTile`] if `tile` is
/// not less than [`Tiles::number`], [`BatchError::TooMany`] if the number of elements does not fit
/// in 32 bits, [`BatchError::Cancelled`].
pub fn pairs_in_tile<N: Space<D>, const D: usize>(
    side: &Side<'_, N, D>,
    ids: &[u64],
    tiles: &Tiles<N, D>,
    tile: u32,
    control: &Control<'_>,
) -> Result<Vec<[u64; 2]>, BatchError> {
    if ids.len() != side.len() {
        return Err(BatchError::Length { argument: "ids", given: ids.len(), needed: side.len() });
    }
    if tile >= tiles.number() {
        return Err(BatchError::NoTile { tile, tiles: tiles.number() });
    }
    let pairs = entries::pairs_in_tile(side, tiles, tile, control)?;
    let id_pairs = pairs.into_iter().map(|pair| {
        let [one, other] = pair.mapped(|element| ids[element as usize]);
        [one.min(other), one.max(other)]
    });
    let mut id_pairs: Vec<[u64; 2]> = id_pairs.collect();
    id_pairs.sort_unstable();
    Ok(id_pairs)
}

impl TileRows {
    /// Returns the indices of the tiles of object `object`, ascending.
    ///
    /// # Panics
    /// If there is no object with this index.
    #[must_use]
    pub fn tiles_of(&self, object: usize) -> &[u32] {
        &self.tiles[self.starts[object]..self.starts[object + 1]]
    }
}

/// A subtree: the index of its first cut, the index of its first tile, and its number of tiles.
#[derive(Clone, Copy)]
struct Subtree {
    cut: usize,
    tile: u32,
    tiles: u32,
}

impl Subtree {
    /// Returns the subtrees below and above the first cut. The subtree must have at least two
    /// tiles.
    const fn halves(self) -> [Self; 2] {
        let below = self.tiles / 2;
        let next = self.cut + below as usize;
        [
            Self { cut: self.cut + 1, tiles: below, ..self },
            Self { cut: next, tile: self.tile + below, tiles: self.tiles - below },
        ]
    }
}

impl<N: Real, const D: usize> Tiles<N, D> {
    /// Creates the tiles with this clearance and these cuts, which must be in the order of
    /// [`Tiles::cuts`]. Without cuts there is a single tile.
    ///
    /// # Errors
    /// [`BatchError::Distance`] if the clearance is negative or NaN, [`BatchError::TileCut`] for
    /// the first cut whose axis does not exist or whose position is not finite or outside the
    /// region that it cuts, [`BatchError::TooMany`] if the number of tiles does not fit in 32 bits.
    pub fn try_from_cuts(clearance: N, cuts: Vec<TileCut<N>>) -> Result<Self, BatchError> {
        is_distance(clearance)?;
        if u32::try_from(cuts.len() + 1).is_err() {
            return Err(BatchError::TooMany { given: cuts.len() + 1 });
        }
        let is_cut = |cut: &TileCut<N>| (cut.axis as usize) < D && cut.at.is_finite_number();
        let wrong = cuts.iter().position(|cut| !is_cut(cut));
        let tiles = Self { clearance, cuts };
        let wrong = wrong.or_else(|| tiles.first_outside(tiles.root(), &Aabb::unbounded()));
        match wrong {
            None => Ok(tiles),
            Some(index) => {
                let TileCut { axis, at } = tiles.cuts[index];
                Err(BatchError::TileCut { index, axis, at: at.as_f64() })
            }
        }
    }

    /// Returns the number of tiles.
    #[must_use]
    pub fn number(&self) -> u32 {
        self.root().tiles
    }

    /// Returns the greatest distance at which two objects are a pair.
    #[must_use]
    pub const fn clearance(&self) -> N {
        self.clearance
    }

    /// Returns the cuts in preorder: a cut comes before the cuts of its subtree, and cuts below it
    /// come before cuts above it. There is one cut less than there are tiles.
    #[must_use]
    pub fn cuts(&self) -> &[TileCut<N>] {
        &self.cuts
    }

    /// Returns the region of each tile, by index; outer faces are infinite. A point on a cut lies
    /// in the tile above the cut.
    #[must_use]
    pub fn bounds(&self) -> Vec<Aabb<N, D>> {
        let mut all = Vec::with_capacity(self.cuts.len() + 1);
        self.list_bounds(self.root(), &Aabb::unbounded(), &mut all);
        all
    }

    /// Returns the index of the tile that contains a point. A NaN coordinate is above every cut.
    #[must_use]
    pub fn owner(&self, point: &Point<N, D>) -> u32 {
        let mut subtree = self.root();
        while subtree.tiles > 1 {
            let cut = &self.cuts[subtree.cut];
            let [below, above] = subtree.halves();
            subtree = if point[cut.axis as usize] < cut.at { below } else { above };
        }
        subtree.tile
    }

    /// Returns the tiles to which each object must be assigned: all tiles that overlap the object's
    /// box, grown by half the clearance.
    ///
    /// `boxes` are the boxes of all objects or of some of them, as [`boxes()`](super::boxes)
    /// computes them. An object without a box has no tile. An unbounded or huge box may overlap all
    /// tiles.
    ///
    /// The cost for each object is O(r log t), for t tiles of which r overlap the grown box.
    #[must_use]
    pub fn meeting(&self, boxes: &[Option<Aabb<N, D>>]) -> TileRows {
        let mut rows = TileRows { starts: vec![0], tiles: Vec::with_capacity(boxes.len()) };
        for aabb in boxes {
            if let Some(aabb) = aabb {
                self.list_meeting(self.root(), &self.grown(aabb), &mut rows.tiles);
            }
            rows.starts.push(rows.tiles.len());
        }
        rows
    }

    /// Returns the index of the tile to which a pair of objects with these boxes belongs.
    pub(super) fn owner_of_pair(&self, box1: &Aabb<N, D>, box2: &Aabb<N, D>) -> u32 {
        let [low1, low2] = [box1, box2].mapped(|aabb| *self.grown(aabb).mins());
        self.owner(&Point::from(low1.coords.zip_map(&low2.coords, max)))
    }

    /// Returns the box grown by half the clearance, so that the grown boxes of two near objects
    /// overlap.
    fn grown(&self, aabb: &Aabb<N, D>) -> Aabb<N, D> {
        aabb.loosened(half_margin(self.clearance))
    }

    fn root(&self) -> Subtree {
        let cuts = u32::try_from(self.cuts.len()).expect("32 bits can number the tiles");
        Subtree { cut: 0, tile: 0, tiles: cuts + 1 }
    }

    /// Cuts the region `bounds` into `tiles` tiles and appends the cuts; `boxes` are the boxes that
    /// overlap the region. The recursion depth is logarithmic in `tiles`.
    fn divide(&mut self, boxes: Vec<Aabb<N, D>>, bounds: &Aabb<N, D>, tiles: u32) {
        if tiles == 1 {
            return;
        }
        let cut = best_cut(&boxes, bounds, tiles);
        self.cuts.push(cut);
        let [bounds_below, bounds_above] = halves(bounds, &cut);
        let (axis, at) = (cut.axis as usize, cut.at);
        let below = boxes.iter().filter(|aabb| aabb.mins()[axis] < at).copied().collect();
        let above = boxes.iter().filter(|aabb| aabb.maxs()[axis] >= at).copied().collect();
        drop(boxes);
        self.divide(below, &bounds_below, tiles / 2);
        self.divide(above, &bounds_above, tiles - tiles / 2);
    }

    fn list_meeting(&self, subtree: Subtree, grown: &Aabb<N, D>, found: &mut Vec<u32>) {
        if subtree.tiles == 1 {
            found.push(subtree.tile);
            return;
        }
        let cut = &self.cuts[subtree.cut];
        let [below, above] = subtree.halves();
        if grown.mins()[cut.axis as usize] < cut.at {
            self.list_meeting(below, grown, found);
        }
        if grown.maxs()[cut.axis as usize] >= cut.at {
            self.list_meeting(above, grown, found);
        }
    }

    fn list_bounds(&self, subtree: Subtree, bounds: &Aabb<N, D>, all: &mut Vec<Aabb<N, D>>) {
        if subtree.tiles == 1 {
            all.push(*bounds);
            return;
        }
        let parts = halves(bounds, &self.cuts[subtree.cut]);
        for (half, part) in subtree.halves().into_iter().zip(&parts) {
            self.list_bounds(half, part, all);
        }
    }

    /// Returns the index of the first cut that lies outside the region that it divides; `None` if
    /// all cuts lie inside.
    fn first_outside(&self, subtree: Subtree, bounds: &Aabb<N, D>) -> Option<usize> {
        if subtree.tiles == 1 {
            return None;
        }
        let cut = &self.cuts[subtree.cut];
        let axis = cut.axis as usize;
        if cut.at < bounds.mins()[axis] || cut.at > bounds.maxs()[axis] {
            return Some(subtree.cut);
        }
        let ([below, above], [low, high]) = (subtree.halves(), halves(bounds, cut));
        self.first_outside(below, &low).or_else(|| self.first_outside(above, &high))
    }
}

/// Returns the parts of a box below and above a cut that lies inside it.
fn halves<N: Real, const D: usize>(bounds: &Aabb<N, D>, cut: &TileCut<N>) -> [Aabb<N, D>; 2] {
    let (mut below, mut above) = (*bounds.maxs(), *bounds.mins());
    below[cut.axis as usize] = cut.at;
    above[cut.axis as usize] = cut.at;
    [Aabb::new(*bounds.mins(), below), Aabb::new(above, *bounds.maxs())]
}

/// Cost of a cut, compared lexicographically: first the number of objects per tile on the side
/// where it is greater, times a factor common to all cuts; then the number of objects below plus
/// the number above, which counts an object on both sides twice.
type CutLoad = (u64, usize);

/// Returns the cut with the least cost. If [`Faces::even_cuts`] yields no candidate on any axis,
/// returns a cut perpendicular to the first axis: at the upper bound if that is finite, else at
/// zero.
fn best_cut<N: Real, const D: usize>(
    boxes: &[Aabb<N, D>],
    bounds: &Aabb<N, D>,
    tiles: u32,
) -> TileCut<N> {
    let mut best: Option<(CutLoad, TileCut<N>)> = None;
    for axis in 0..D {
        let faces = Faces::along(axis, boxes);
        for at in faces.even_cuts([bounds.mins()[axis], bounds.maxs()[axis]], tiles) {
            let load = faces.load(at, tiles);
            if best.is_none_or(|(least, _)| load < least) {
                let axis = u32::try_from(axis).expect("few dimensions");
                best = Some((load, TileCut { axis, at }));
            }
        }
    }
    let high = bounds.maxs()[0];
    let at = if high.is_finite_number() { high } else { N::ZERO };
    best.map_or(TileCut { axis: 0, at }, |(_, cut)| cut)
}

/// The coordinates of the boxes' lower and upper faces on one axis, each list in ascending order.
struct Faces<N> {
    lows: Vec<N>,
    highs: Vec<N>,
}

impl<N: Real> Faces<N> {
    fn along<const D: usize>(axis: usize, boxes: &[Aabb<N, D>]) -> Self {
        let sorted = |mut faces: Vec<N>| {
            faces.sort_unstable_by_key(|&face| order_of(face));
            faces
        };
        let lows = boxes.iter().map(|aabb| aabb.mins()[axis]);
        let highs = boxes.iter().map(|aabb| aabb.maxs()[axis]);
        Self { lows: sorted(lows.collect()), highs: sorted(highs.collect()) }
    }

    /// Returns up to four candidate positions: the lower bound of the region, the first lower face
    /// inside the region, and the two lower faces next to the position at which both sides have
    /// equally many objects per tile. A cut at the lower bound makes the region below it empty,
    /// which is best if all boxes overlap.
    fn even_cuts(&self, [low, high]: [N; 2], tiles: u32) -> impl Iterator<Item = N> {
        let begin = self.lows.partition_point(|&face| face <= low);
        let inside = &self.lows[begin..];
        let [below, above] = [u64::from(tiles / 2), u64::from(tiles - tiles / 2)];
        let is_light = |face: &N| {
            let [few, many] = self.counts(*face);
            (few as u64) * above < (many as u64) * below
        };
        let even = inside.partition_point(is_light);
        let cuts = [Some(&low), inside.first(), inside.get(even.wrapping_sub(1)), inside.get(even)];
        let cuts = cuts
            .mapped(|face| face.copied().filter(|face| face.is_finite_number() && *face <= high));
        cuts.into_iter().flatten()
    }

    /// Returns the number of boxes that extend below the position `at`, and the number of boxes
    /// that extend to it or above it.
    fn counts(&self, at: N) -> [usize; 2] {
        let before = |faces: &[N]| faces.partition_point(|&face| face < at);
        [before(&self.lows), self.highs.len() - before(&self.highs)]
    }

    fn load(&self, at: N, tiles: u32) -> CutLoad {
        let [below, above] = self.counts(at);
        let below_each = (below as u64) * u64::from(tiles - tiles / 2);
        let above_each = (above as u64) * u64::from(tiles / 2);
        (below_each.max(above_each), below + above)
    }
}
