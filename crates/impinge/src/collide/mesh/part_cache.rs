//! The parts around a solid, cached between updates.
//!
//! The cache belongs to the shape of the last update: a new shape clears it.
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

/// The margin around a box in which parts are cached for later updates.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(super) enum CacheMargin {
    /// Until it holds more parts than one packet, or another given number.
    #[default]
    Large,
    /// The large margin held too many parts.
    Small,
    /// No later update: only the box itself.
    None,
}

impl CacheMargin {
    /// The margin relative to the largest half extent of the box.
    fn share(self) -> f64 {
        match self {
            Self::Large => 0.5,
            Self::Small => 0.25,
            Self::None => 0.0,
        }
    }
}

/// The cached seams of a triangle.
#[derive(Clone, Copy, Debug)]
enum KeptSeams<N: Real> {
    /// Not computed yet.
    Unasked,
    /// The surface must be called each time.
    Unknown,
    Known(FaceSeams<N>),
}

/// The parts around a convex solid, found for a larger box than it needs. They serve as long as the
/// solid stays in that box.
///
/// Corners of triangles and segments in the frame of the composite are copied, 8 parts side by
/// side, in one block of memory; in the composite they lie wherever its vertices are. That takes 36
/// bytes for each triangle around the solid with `f32`.
/// each triangle around the solid with `f32`.
#[derive(Clone, Debug, Default)]
pub(super) struct PartCache<N: Real, const D: usize> {
    /// The box with all its parts in the cache; `None` before the first search.
    within: Option<Aabb<N, D>>,
    /// The indices of all parts that overlap `within`, ascending.
    parts: SmallVec<[u32; 8]>,
    /// The corners of all parts; empty unless all have corners in the frame of the composite.
    tiles: Vec<PartPacket<N, D>>,
    /// The seams of all parts, filled where a solid was near; empty if no solid needs them.
    seams: Vec<KeptSeams<N>>,
    /// Whether the corners in `tiles` are those of segments.
    are_segments: bool,
    /// Half the extents of the solid's core, in its own frame.
    half: Option<Vector<N, D>>,
    /// The margin of the next search; it never grows.
    margin: CacheMargin,
}

#[cfg(feature = "serde")]
impl<N: Real, const D: usize> PartCache<N, D> {
    /// The box whose parts are cached, and the margin of the next search.
    pub(super) const fn room(&self) -> (Option<&Aabb<N, D>>, CacheMargin) {
        (self.within.as_ref(), self.margin)
    }

    /// Sets the margin of the next search.
    pub(super) const fn set_room(&mut self, margin: CacheMargin) {
        self.margin = margin;
    }
}

impl<N: Real, const D: usize> PartCache<N, D> {
    /// A cache for a single update, without a margin.
    pub(super) fn for_once() -> Self {
        Self { margin: CacheMargin::None, ..Self::default() }
    }
}

impl<N: Real, const D: usize> PartCache<N, D> {
    /// A meaningless number from the first packet, to load its cache line.
    #[inline]
    pub(super) fn prefetch(&self) -> N {
        self.tiles.first().map_or(N::ZERO, |tiles| tiles.corners[0][0][0])
    }
}

impl<N: Space<D>, const D: usize> PartCache<N, D> {
    /// Makes sure that the cache holds all parts that overlap a box; false if the box is unbounded.
    pub(super) fn covers(
        &mut self,
        composite: &dyn CompositeShape<N, D>,
        aabb: &Aabb<N, D>,
    ) -> bool {
        self.covers_with(composite, aabb, LANES)
    }

    /// [`Self::covers`], with the large margin as long as this holds at most `most` parts.
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

    /// Whether the cache holds all parts that overlap a box.
    pub(super) fn holds(&self, aabb: &Aabb<N, D>) -> bool {
        self.within.as_ref().is_some_and(|within| within.contains(aabb))
    }

    /// Searches the parts around a box with a margin and copies their corners. Once the large
    /// margin holds more than `most` parts, the small one is used from then on.
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

    /// Caches the parts that the search in a box found.
    fn keep_found(&mut self, composite: &dyn CompositeShape<N, D>, within: Aabb<N, D>) {
        self.tiles.clear();
        self.parts.sort_unstable();
        self.within = Some(within);
        self.fill_tiles(composite);
    }

    /// Restores the cache of a saved world: the parts in its box.
    #[cfg(feature = "serde")]
    pub(super) fn fill_again(&mut self, composite: &dyn CompositeShape<N, D>, within: Aabb<N, D>) {
        self.search(composite, &within);
        self.keep_found(composite, within);
    }

    /// Keeps the seams of parts that were cached before, and drops the rest.
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

    /// Replaces the list of parts by those that overlap `within`, unsorted.
    fn search(&mut self, composite: &dyn CompositeShape<N, D>, within: &Aabb<N, D>) {
        self.parts.clear();
        composite.search().overlapping(within, &mut |part| self.parts.push(part));
    }

    /// Copies the corners of all parts, if all have corners.
    fn fill_tiles(&mut self, composite: &dyn CompositeShape<N, D>) {
        // Exact capacity: there are as many of these lists as pairs.
        self.tiles.reserve_exact(self.parts.len().div_ceil(LANES));
        for parts in self.parts.chunks(LANES) {
            let mut tiles = PartPacket::blank();
            for lane in 0..LANES {
                let part = composite.part(parts[lane.min(parts.len() - 1)]);
                let is_first = lane == 0 && self.tiles.is_empty();
                // Corners are only kept for parts in the frame of the composite.
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

    /// The cached parts, ascending.
    pub(super) fn parts(&self) -> &[u32] {
        &self.parts
    }

    /// The corners of all parts in packets of 8; empty if some part has none.
    pub(super) fn tiles(&self) -> &[PartPacket<N, D>] {
        &self.tiles
    }

    /// Gets the seams of triangles from the surface of the composite; `masks` has a bit for each
    /// part of each packet that needs them.
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

    /// The seams of the part at an index in [`Self::parts`]; `None` if unknown.
    pub(super) fn seams(&self, index: usize) -> Option<&FaceSeams<N>> {
        match self.seams.get(index)? {
            KeptSeams::Known(seams) => Some(seams),
            _ => None,
        }
    }

    /// Whether all parts are segments with cached corners.
    pub(super) fn has_segments_alone(&self) -> bool {
        self.parts.is_empty() || self.are_segments && !self.tiles.is_empty()
    }

    /// Whether all parts are triangles with cached corners.
    pub(super) fn has_triangles_alone(&self) -> bool {
        self.parts.is_empty() || !(self.are_segments || self.tiles.is_empty())
    }

    /// Half the extents of the core of the solid, along its own axes.
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

    /// Returns a part from its cached corners.
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

/// Returns the corners of a part in its own frame, the second end of a segment twice, and whether
/// it is a segment; `None` for other parts.
pub(super) fn corners_of<N: Real, const D: usize>(
    part: &Part<'_, N, D>,
) -> Option<([Point<N, D>; 3], bool)> {
    match &part.solid {
        PartSolid::Triangle(triangle) => Some((*triangle.corners(), false)),
        PartSolid::Segment(segment) => Some(([*segment.a(), *segment.b(), *segment.b()], true)),
        PartSolid::Shape(_) => None,
    }
}
