//! The normals that a segment of a 2D chain admits, computed from the ends of the segment and of
//! adjacent segments.

use smallvec::SmallVec;

use crate::math::{Point, Real, Vector, perp, unit};
use crate::shape::composite::polyline_parts::across;
use crate::shape::surface::own_surface::OwnSurface;
use crate::shape::surface::seam::{Seam, slack};
use crate::shape::{FeatureId, Surface, SurfaceAccess};

/// The properties shared by all segments of a chain. With these, contacts need not call the surface
/// for each segment. Polylines and 2D height fields have them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Sidedness {
    /// Whether the front is on the left of a segment, looking from its first end to its second.
    pub(in crate::shape) is_left: bool,
    pub(in crate::shape) is_one_sided: bool,
    /// Selects how the side of a vector is chosen. If true, the sign of the component along the
    /// front decides, and zero counts as the front. If false, the vector's own perpendicular
    /// component decides, which may be too small to give a side.
    pub(in crate::shape) follows_front: bool,
    pub(in crate::shape) keeps_internal_edges: bool,
    pub(in crate::shape) joining: Joining,
}

/// The rule by which segments with ends at one position are joined.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(in crate::shape) enum Joining {
    /// All segments with an end at the position are joined.
    All,
    /// The second end of each segment is joined to the first end of the segment with the next
    /// index, and to no other.
    InRow,
    /// The cached segments cannot decide: the surface is queried.
    Unknown,
}

/// A set of segments of a chain that contains all segments in some box.
pub(crate) trait KnownSegments<N: Real>: Sync {
    /// Returns whether the set contains all segments with an end at `point`.
    fn are_all_at(&self, point: &Point<N, 2>) -> bool;

    /// Calls `visit` with the index and both ends of each segment that has an end at `point`, in
    /// ascending order of index.
    fn each_ending_at(&self, point: &Point<N, 2>, visit: &mut dyn FnMut(u32, [Point<N, 2>; 2]));
}

impl Sidedness {
    /// Returns the unit normal on the front of a segment with the unit direction `along`.
    fn front<N: Real>(self, along: &Vector<N, 2>) -> Vector<N, 2> {
        let left = perp(along);
        if self.is_left { left } else { -left }
    }

    /// Returns the component of a vector along the front of a segment; 0 for a chain with two sides
    /// or a segment without length.
    fn height_over<N: Real>(self, along: Option<&Vector<N, 2>>, vector: &Vector<N, 2>) -> N {
        let along = along.filter(|_| self.is_one_sided);
        along.map_or(N::ZERO, |along| self.front(along).dot(vector))
    }

    /// Implements [`Surface::snapped`].
    fn snapped<N: Real>(self, along: &Vector<N, 2>, normal: &Vector<N, 2>) -> Option<Vector<N, 2>> {
        if !(self.is_one_sided || self.follows_front) {
            return across(along, normal);
        }
        let front = self.front(along);
        let is_front = self.is_one_sided || front.dot(normal) >= N::ZERO;
        Some(if is_front { front } else { -front })
    }
}

/// A segment of a chain as a surface. The ends of the segment and of its neighbours decide if they
/// can, else the surface of the chain decides.
pub(crate) struct KnownSegment<'a, N: Real> {
    surface: SurfaceAccess<'a, N, 2>,
    sidedness: Option<Sidedness>,
    /// The segments of the chain near this one, including the adjacent ones.
    others: &'a dyn KnownSegments<N>,
    ends: [Point<N, 2>; 2],
    /// The unit vector from the first end to the second; `None` for a segment without length.
    along: Option<Vector<N, 2>>,
}

impl<'a, N: Real> KnownSegment<'a, N> {
    /// Returns a segment by its ends. Their coordinates must exactly equal the coordinates in the
    /// surface.
    pub(crate) fn new(
        surface: SurfaceAccess<'a, N, 2>,
        sidedness: Option<Sidedness>,
        others: &'a dyn KnownSegments<N>,
        ends: [Point<N, 2>; 2],
    ) -> Self {
        let along = unit(&(ends[1] - ends[0])).map(|(along, _)| along);
        Self { surface, sidedness, others, ends, along }
    }

    /// Returns the segments joined to this segment at one of its ends; `None` if not all of them
    /// are known.
    fn joined(&self, sidedness: Sidedness, part: u32, end: u32) -> Option<Joined<N>> {
        let at = self.ends.get(end as usize)?;
        if sidedness.joining == Joining::Unknown || !self.others.are_all_at(at) {
            return None;
        }
        let mut joined = Joined::new();
        self.others.each_ending_at(at, &mut |other, [a, b]| {
            let starts_here = a == *at;
            let is_joined = sidedness.joining == Joining::All
                || other == if starts_here { part + end } else { (part + end).wrapping_sub(1) };
            if let (true, Some((along, _))) = (is_joined, unit(&(b - a))) {
                joined.push((along, starts_here));
            }
        });
        Some(joined)
    }

    /// Returns whether the rule of [`Seam`] admits a normal at an end where the segments `joined`
    /// meet.
    fn seam_admits(&self, sidedness: Sidedness, joined: &Joined<N>, normal: &Vector<N, 2>) -> bool {
        let own = self.along.unwrap_or_else(Vector::<N, 2>::zeros);
        let mut seam = Seam::of_segments(own, normal);
        for (along, starts_here) in joined {
            let away = if *starts_here { *along } else { -along };
            seam.add_segment(&away, sidedness.height_over(Some(along), normal));
        }
        seam.admits(sidedness.is_one_sided)
    }

    /// Returns whether a normal is perpendicular to the segment within rounding; `None` if the
    /// segment has no length.
    fn is_own(&self, normal: &Vector<N, 2>) -> Option<bool> {
        self.along.map(|along| along.dot(normal).abs() <= slack())
    }
}

/// The segments at one point: the unit vectors from their first ends to their second, and whether
/// the first end is at the point.
type Joined<N> = SmallVec<[(Vector<N, 2>, bool); 4]>;

impl<N: Real> Surface<N, 2> for KnownSegment<'_, N> {
    fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<N, 2>) -> bool {
        let Some(sidedness) = self.sidedness else {
            return self.surface.admits(part, feature, normal);
        };
        let height = sidedness.height_over(self.along.as_ref(), normal);
        if sidedness.keeps_internal_edges {
            return height >= -slack::<N>();
        }
        let own = self.is_own(normal);
        match feature {
            FeatureId::Vertex(end) if own != Some(true) => {
                let known = self.joined(sidedness, part, end);
                let known = known.map(|joined| self.seam_admits(sidedness, &joined, normal));
                known.unwrap_or_else(|| self.surface.admits(part, feature, normal))
            }
            _ => own.is_none_or(|own| own) && height >= N::ZERO,
        }
    }

    fn snapped(&self, part: u32, normal: &Vector<N, 2>) -> Option<Vector<N, 2>> {
        match self.sidedness {
            Some(sidedness) => sidedness.snapped(&self.along?, normal),
            None => self.surface.snapped(part, normal),
        }
    }

    fn faces(&self, part: u32, center: &Point<N, 2>) -> bool {
        match self.sidedness {
            Some(sidedness) => {
                sidedness.height_over(self.along.as_ref(), &(center - self.ends[0])) >= N::ZERO
            }
            None => self.surface.faces(part, center),
        }
    }
}

impl<N: Real> OwnSurface<N, 2> for KnownSegment<'_, N> {
    fn admits_in_turn(
        &self,
        part: u32,
        feature: FeatureId,
        [first, second]: [&Vector<N, 2>; 2],
    ) -> [bool; 2] {
        // Callers normally query an end only for normals other than the two normals of the segment.
        if let (Some(sidedness), FeatureId::Vertex(end)) = (self.sidedness, feature)
            && !sidedness.keeps_internal_edges
            && self.is_own(first) != Some(true)
            && self.is_own(second) != Some(true)
            && let Some(joined) = self.joined(sidedness, part, end)
        {
            let is_first = self.seam_admits(sidedness, &joined, first);
            return [is_first, !is_first && self.seam_admits(sidedness, &joined, second)];
        }
        let is_first = self.admits(part, feature, first);
        [is_first, !is_first && self.admits(part, feature, second)]
    }
}
