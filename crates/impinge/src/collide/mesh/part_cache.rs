//! The parts around a solid, kept from update to update.
//!
//! The parts are those of the shape that the last update saw: a new shape forgets them.

use smallvec::SmallVec;

use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::collide::packet::{LANES, PartPacket};
use crate::math::ones::Ones;
use crate::math::{Point, Pose, Real, Space, Vector, max};
use crate::shape::{CompositeShape, FaceSeams, Part, PartSolid, Segment, SupportMap, Triangle};

/// The room that is searched around a box to find parts for later.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
enum CacheRoom {
    /// Where it holds no more parts than are looked at side by side.
    #[default]
    Large,
    /// There were too many in a large room.
    Small,
    /// There is no later.
    None,
}

impl CacheRoom {
    /// As a share of the half extents of the box.
    fn share(self) -> f64 {
        match self {
            Self::Large => 0.5,
            Self::Small => 0.25,
            Self::None => 0.0,
        }
    }
}

/// What is kept of the seams of a triangle.
#[derive(Clone, Copy, Debug)]
enum KeptSeams<N: Real> {
    /// Nobody asked.
    Unasked,
    /// The surface has to be asked each time.
    Unknown,
    Known(FaceSeams<N>),
}

/// The parts around a convex solid, found for a larger box than it needs: they serve for as long as it
/// stays in that.
///
/// Parts that are given by their corners, in the frame of the composite, are kept with these: eight side
/// by side, in one place of memory, whereas the composite has them wherever its vertices lie. That is 36 bytes for
/// each triangle around the solid with `f32`.
#[derive(Clone, Debug, Default)]
pub(super) struct PartCache<N: Real, const D: usize> {
    within: Option<Aabb<N, D>>,
    /// In order.
    parts: SmallVec<[u32; 8]>,
    /// Of all parts, or of none.
    tiles: Vec<PartPacket<N, D>>,
    /// Of all parts, as far as they were near to a solid that asks for it, or of none.
    seams: Vec<KeptSeams<N>>,
    are_segments: bool,
    /// Half the extents of the solid's core, in its own frame.
    half: Option<Vector<N, D>>,
    room: CacheRoom,
}

impl<N: Real, const D: usize> PartCache<N, D> {
    /// For one update alone.
    pub(super) fn for_once() -> Self {
        Self { room: CacheRoom::None, ..Self::default() }
    }
}

impl<N: Real, const D: usize> PartCache<N, D> {
    /// A number of the first corner that is kept, of no meaning.
    #[inline]
    pub(super) fn prefetch(&self) -> N {
        self.tiles.first().map_or(N::ZERO, |tiles| tiles.corners[0][0][0])
    }
}

impl<N: Space<D>, const D: usize> PartCache<N, D> {
    /// Makes sure that the parts are among those kept that overlap a box; answers whether they are.
    pub(super) fn reaches(
        &mut self,
        composite: &dyn CompositeShape<N, D>,
        aabb: &Aabb<N, D>,
    ) -> bool {
        self.reaches_with(composite, aabb, LANES)
    }

    /// [`Self::reaches`] with the large room where that holds no more parts than `most`.
    pub(super) fn reaches_with(
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

    /// The parts that are kept are all that overlap a box.
    pub(super) fn holds(&self, aabb: &Aabb<N, D>) -> bool {
        self.within.as_ref().is_some_and(|within| within.contains(aabb))
    }

    fn fill(&mut self, composite: &dyn CompositeShape<N, D>, aabb: &Aabb<N, D>, most: usize) {
        let half = aabb.half_extents().iter().fold(N::ZERO, |most, &half| max(most, half));
        let with_room = |room: CacheRoom| aabb.loosened(half * N::lit(room.share()));
        let mut within = with_room(self.room);
        let before = if self.seams.is_empty() { SmallVec::new() } else { self.parts.clone() };
        self.search(composite, &within);
        if self.room == CacheRoom::Large && self.parts.len() > most {
            self.room = CacheRoom::Small;
            within = with_room(self.room);
            self.search(composite, &within);
        }
        self.tiles.clear();
        self.parts.sort_unstable();
        self.within = Some(within);
        self.fill_tiles(composite);
        self.keep_seams(&before);
    }

    /// Keeps what is known of the seams of parts that were kept before, and forgets the rest.
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

    fn search(&mut self, composite: &dyn CompositeShape<N, D>, within: &Aabb<N, D>) {
        self.parts.clear();
        composite.search().overlapping(within, &mut |part| self.parts.push(part));
    }

    /// Copies the corners of all parts, if all have corners.
    fn fill_tiles(&mut self, composite: &dyn CompositeShape<N, D>) {
        // Not a byte more than that: there are as many of these as pairs.
        self.tiles.reserve_exact(self.parts.len().div_ceil(LANES));
        for parts in self.parts.chunks(LANES) {
            let mut tiles = PartPacket::blank();
            for lane in 0..LANES {
                let part = composite.part(parts[lane.min(parts.len() - 1)]);
                let is_first = lane == 0 && self.tiles.is_empty();
                // Only what lies in the frame of its composite.
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

    /// The parts, in order.
    pub(super) fn parts(&self) -> &[u32] {
        &self.parts
    }

    /// The corners of all parts in packets of eight; empty if they are not kept.
    pub(super) fn tiles(&self) -> &[PartPacket<N, D>] {
        &self.tiles
    }

    /// Asks the surface of a composite for the seams of those of its triangles that are near, given a bit for each part
    /// of each tile.
    pub(super) fn learn_seams(&mut self, composite: &dyn CompositeShape<N, D>, near: &[u8]) {
        let surface = composite.surface_access().filter(|_| self.has_triangles_alone());
        let Some(surface) = surface else { return };
        self.seams.resize(self.parts.len(), KeptSeams::Unasked);
        for (block, near) in near.iter().enumerate() {
            for lane in Ones::<LANES>((*near).into()) {
                let place = block * LANES + lane;
                if let KeptSeams::Unasked = self.seams[place] {
                    let found = surface.face_seams(self.parts[place]);
                    self.seams[place] = found.map_or(KeptSeams::Unknown, KeptSeams::Known);
                }
            }
        }
    }

    /// What is kept of the seams of a triangle.
    pub(super) fn seams(&self, place: usize) -> Option<&FaceSeams<N>> {
        match self.seams.get(place)? {
            KeptSeams::Known(seams) => Some(seams),
            _ => None,
        }
    }

    /// All parts are segments that are kept by their corners.
    pub(super) fn has_segments_alone(&self) -> bool {
        self.parts.is_empty() || self.are_segments && !self.tiles.is_empty()
    }

    /// All parts are triangles that are kept by their corners.
    pub(super) fn has_triangles_alone(&self) -> bool {
        self.parts.is_empty() || !(self.are_segments || self.tiles.is_empty())
    }

    /// Half the extents of the core of the solid that this is about.
    pub(super) fn half(&mut self, map: &dyn SupportMap<N, D>) -> Vector<N, D> {
        *self.half.get_or_insert_with(|| {
            let center = map.center();
            Vector::<N, D>::from_fn(|axis, _| {
                let reach = |sign| {
                    let mut way = Vector::<N, D>::zeros();
                    way[axis] = sign;
                    (map.core_support(&way) - center)[axis].abs()
                };
                max(reach(N::ONE), reach(-N::ONE))
            })
        })
    }

    /// A part from what is kept of it.
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

/// The corners of a part in its own frame, those of a segment with the second twice, and whether it is one.
pub(super) fn corners_of<N: Real, const D: usize>(
    part: &Part<'_, N, D>,
) -> Option<([Point<N, D>; 3], bool)> {
    match &part.solid {
        PartSolid::Triangle(triangle) => Some((*triangle.corners(), false)),
        PartSolid::Segment(segment) => Some(([*segment.a(), *segment.b(), *segment.b()], true)),
        PartSolid::Shape(_) => None,
    }
}
