//! The parts around a solid, cached between updates.
//!
//! The cache is valid for one pair of shapes. If one of them changes, the cache must be replaced by
//! the [`Default`] one.
//!
//! ```text
//!  parts   p0 p1 p2 … p10                       ascending indices of parts
//!  tiles   [p0 … p7] [p8 p9 p10 p10 … p10]      corners of 8 parts, the last one repeated
//!  seams   one per part                         filled when a solid is near
//! ```

use smallvec::SmallVec;

use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::collide::packet::{LANES, PartPacket};
use crate::math::ones::Ones;
use crate::math::{Point, Pose, Real, Space, Vector, max};
use crate::shape::{CompositeShape, FaceSeams, Part, PartSolid, Segment, SupportMap, Triangle};

/// Margin by which the searched box exceeds the box that the solid needs, so that the cached parts
/// also serve later updates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) enum CacheMargin {
    /// The initial margin, used until the box with this margin overlaps too many parts: more than
    /// `most` in [`PartCache::covers_with`].
    #[default]
    Large,
    /// The margin used after the box with the large margin overlapped too many parts.
    Small,
    /// No margin, for a single update.
    None,
}

impl CacheMargin {
    /// Returns the margin relative to the largest half extent of the box.
    fn share(self) -> f64 {
        match self {
            Self::Large => 0.5,
            Self::Small => 0.25,
            Self::None => 0.0,
        }
    }
}

/// State of the cached seams of a triangle.
#[derive(Clone, Copy, Debug)]
enum KeptSeams<N: Real> {
    /// Not computed yet.
    Unasked,
    /// The surface does not provide the seams of this part, so the surface must be called for each
    /// contact.
    Unknown,
    Known(FaceSeams<N>),
}

/// Parts of a composite around a convex solid, found for a larger box than the solid needs. The
/// cache is not refilled as long as the solid stays in that box.
///
/// Corners of triangles and segments, in the frame of the composite, are copied into packets of 8
/// parts, in one block of memory; in the composite they are scattered. With `f32` the copy takes 36
/// bytes per triangle.
#[derive(Clone, Debug, Default)]
pub(super) struct PartCache<N: Real, const D: usize> {
    /// Box in the frame of the composite; all parts that overlap it are in the cache. `None` before
    /// the first search.
    within: Option<Aabb<N, D>>,
    /// Indices of all parts that overlap `within`, ascending.
    parts: SmallVec<[u32; 8]>,
    /// Corners of all parts; empty unless all parts have corners in the frame of the composite.
    tiles: Vec<PartPacket<N, D>>,
    /// Seams of all parts (the front normals of a triangle and of its neighbours), computed for the
    /// parts that a solid was near; empty if no solid needs them.
    seams: Vec<KeptSeams<N>>,
    /// Whether the parts in `tiles` are segments, else triangles.
    are_segments: bool,
    /// Half extents of the solid's core, in its own frame; `None` until first needed.
    half: Option<Vector<N, D>>,
    /// Margin of the next search; it may shrink but never grows.
    margin: CacheMargin,
}

#[cfg(feature = "serde")]
impl<N: Real, const D: usize> PartCache<N, D> {
    /// Returns the box whose parts are cached, and the margin of the next search.
    pub(super) const fn room(&self) -> (Option<&Aabb<N, D>>, CacheMargin) {
        (self.within.as_ref(), self.margin)
    }

    /// Sets the margin of the next search.
    pub(super) const fn set_room(&mut self, margin: CacheMargin) {
        self.margin = margin;
    }
}

impl<N: Real, const D: usize> PartCache<N, D> {
    /// Returns a cache for a single update, without a margin.
    pub(super) fn for_once() -> Self {
        Self { margin: CacheMargin::None, ..Self::default() }
    }
}

impl<N: Real, const D: usize> PartCache<N, D> {
    /// Reads a number of the first packet, to load its cache line; the returned value is
    /// meaningless.
    #[inline]
    pub(super) fn prefetch(&self) -> N {
        self.tiles.first().map_or(N::ZERO, |tiles| tiles.corners[0][0][0])
    }
}

impl<N: Space<D>, const D: usize> PartCache<N, D> {
    /// Refills the cache unless it holds all parts that overlap a box. Returns `false`, without a
    /// search, if the box is unbounded.
    pub(super) fn covers(
        &mut self,
        composite: &dyn CompositeShape<N, D>,
        aabb: &Aabb<N, D>,
    ) -> bool {
        self.covers_with(composite, aabb, LANES)
    }

    /// Refills the cache as [`Self::covers`] does, but keeps the large margin as long as the box
    /// with this margin overlaps at most `most` parts.
    pub(super) fn covers_with(
        &mut self,
        composite: &dyn CompositeShape<N, D>,
        aabb: &Aabb<N, D>,
        most: usize,
    ) -> bool {
        let is_known = self.within.as_ref().is_some_and(|within| within.contains(aabb));
        if !is_known {
            if !aabb.is_bounded() {
                return false;
            }
            self.fill(composite, aabb, most);
        }
        true
    }

    /// Returns whether the cache holds all parts that overlap a box.
    pub(super) fn holds(&self, aabb: &Aabb<N, D>) -> bool {
        self.within.as_ref().is_some_and(|within| within.contains(aabb))
    }

    /// Finds the parts that overlap a box loosened by the margin, and copies their corners. If the
    /// large margin gives more than `most` parts, this search and all later ones use the small
    /// margin.
    fn fill(&mut self, composite: &dyn CompositeShape<N, D>, aabb: &Aabb<N, D>, most: usize) {
        let half = aabb.half_extents().iter().fold(N::ZERO, |most, &half| max(most, half));
        let with_margin = |margin: CacheMargin| aabb.loosened(half * N::lit(margin.share()));
        let mut within = with_margin(self.margin);
        let before = if self.seams.is_empty() { SmallVec::new() } else { self.parts.clone() };
        self.search(composite, &within);
        if self.margin == CacheMargin::Large && self.parts.len() > most {
            self.margin = CacheMargin::Small;
            within = with_margin(self.margin);
            self.search(composite, &within);
        }
        self.keep_found(composite, within);
        self.keep_seams(&before);
    }

    /// Sorts the parts that the search in `within` found, and copies their corners.
    fn keep_found(&mut self, composite: &dyn CompositeShape<N, D>, within: Aabb<N, D>) {
        self.tiles.clear();
        self.parts.sort_unstable();
        self.within = Some(within);
        self.fill_tiles(composite);
    }

    /// Restores the cache of a saved world by a search of the parts that overlap its box `within`.
    #[cfg(feature = "serde")]
    pub(super) fn fill_again(&mut self, composite: &dyn CompositeShape<N, D>, within: Aabb<N, D>) {
        self.search(composite, &within);
        self.keep_found(composite, within);
    }

    /// Keeps the seams of parts that were cached before, and drops the seams of other parts.
    /// `before` holds the old part indices.
    fn keep_seams(&mut self, before: &[u32]) {
        if before.is_empty() {
            return self.seams.clear();
        }
        let (mut kept, mut at) = (Vec::with_capacity(self.parts.len()), 0);
        for part in &self.parts {
            while at < before.len() && before[at] < *part {
                at += 1;
            }
            let is_known = at < before.len() && before[at] == *part;
            kept.push(if is_known { self.seams[at] } else { KeptSeams::Unasked });
        }
        self.seams = kept;
    }

    /// Replaces the list of parts by the parts that overlap `within`, unsorted.
    fn search(&mut self, composite: &dyn CompositeShape<N, D>, within: &Aabb<N, D>) {
        self.parts.clear();
        composite.search().overlapping(within, &mut |part| self.parts.push(part));
    }

    /// Copies the corners of all parts; leaves `tiles` empty unless all parts are triangles, or all
    /// are segments, in the frame of the composite.
    fn fill_tiles(&mut self, composite: &dyn CompositeShape<N, D>) {
        // Exact capacity, because there is one such list per pair.
        self.tiles.reserve_exact(self.parts.len().div_ceil(LANES));
        for parts in self.parts.chunks(LANES) {
            let mut tiles = PartPacket::blank();
            for lane in 0..LANES {
                let part = composite.part(parts[lane.min(parts.len() - 1)]);
                let is_first = lane == 0 && self.tiles.is_empty();
                // Corners are cached only for parts in the frame of the composite.
                let corners = corners_of(&part).filter(|_| part.pose.is_same(&Pose::identity()));
                match corners {
                    Some((corners, is_segment)) if is_first || is_segment == self.are_segments => {
                        tiles.put(lane, &corners);
                        self.are_segments = is_segment;
                    }
                    _ => return self.tiles.clear(),
                }
            }
            self.tiles.push(tiles);
        }
    }

    /// Returns the indices of the cached parts, ascending.
    pub(super) fn parts(&self) -> &[u32] {
        &self.parts
    }

    /// Returns the corners of all parts in packets of 8; empty unless all parts are triangles, or
    /// all are segments, in the frame of the composite.
    pub(super) fn tiles(&self) -> &[PartPacket<N, D>] {
        &self.tiles
    }

    /// Computes the seams of triangles that are not cached yet, from the surface of the composite.
    /// `masks` selects, by a bit per part of each packet, the parts that need them.
    pub(super) fn learn_seams(&mut self, composite: &dyn CompositeShape<N, D>, masks: &[u8]) {
        let surface = composite.surface_access().filter(|_| self.has_triangles_alone());
        let Some(surface) = surface else { return };
        self.seams.resize(self.parts.len(), KeptSeams::Unasked);
        for (block, mask) in masks.iter().enumerate() {
            for lane in Ones::<LANES>((*mask).into()) {
                let index = block * LANES + lane;
                if let KeptSeams::Unasked = self.seams[index] {
                    let found = surface.face_seams(self.parts[index]);
                    self.seams[index] = found.map_or(KeptSeams::Unknown, KeptSeams::Known);
                }
            }
        }
    }

    /// Returns the seams of the part at `index` in [`Self::parts`]; `None` if they are not computed
    /// yet, or if the surface does not provide them.
    pub(super) fn seams(&self, index: usize) -> Option<&FaceSeams<N>> {
        match self.seams.get(index)? {
            KeptSeams::Known(seams) => Some(seams),
            _ => None,
        }
    }

    /// Returns whether all cached parts are segments with corners; true without parts.
    pub(super) fn has_segments_alone(&self) -> bool {
        self.parts.is_empty() || self.are_segments && !self.tiles.is_empty()
    }

    /// Returns whether all cached parts are triangles with corners; true without parts.
    pub(super) fn has_triangles_alone(&self) -> bool {
        self.parts.is_empty() || !(self.are_segments || self.tiles.is_empty())
    }

    /// Returns the half extents of the solid's core along its own axes, measured from its centre;
    /// computed at the first call.
    pub(super) fn half(&mut self, map: &dyn SupportMap<N, D>) -> Vector<N, D> {
        *self.half.get_or_insert_with(|| {
            let center = map.center();
            Vector::<N, D>::from_fn(|axis, _| {
                let extent = |sign| {
                    let mut direction = Vector::<N, D>::zeros();
                    direction[axis] = sign;
                    (map.core_support(&direction) - center)[axis].abs()
                };
                max(extent(N::ONE), extent(-N::ONE))
            })
        })
    }

    /// Returns a part from its cached corners; `None` if it is not cached, or if the cache holds no
    /// corners.
    pub(super) fn part(&self, part: u32) -> Option<Part<'static, N, D>> {
        if self.tiles.is_empty() {
            return None;
        }
        let at = self.parts.binary_search(&part).ok()?;
        let [a, b, c] = self.tiles[at / LANES].corners(at % LANES);
        let solid = if self.are_segments {
            PartSolid::Segment(Segment::of_finite(a, b))
        } else {
            PartSolid::Triangle(Triangle::of_finite([a, b, c]))
        };
        Some(Part { pose: Pose::identity(), solid })
    }
}

/// Returns the corners of a part in its own frame, and whether it is a segment, whose second end
/// occurs twice; `None` for other parts.
pub(super) fn corners_of<N: Real, const D: usize>(
    part: &Part<'_, N, D>,
) -> Option<([Point<N, D>; 3], bool)> {
    match &part.solid {
        PartSolid::Triangle(triangle) => Some((*triangle.corners(), false)),
        PartSolid::Segment(segment) => Some(([*segment.a(), *segment.b(), *segment.b()], true)),
        PartSolid::Shape(_) => None,
    }
}
