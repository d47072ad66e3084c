//! The side of an outline that faces another, or the corner, and what they are called.

use crate::math::{Real, cross2, max, min};
use crate::query::separation::meeting::Meeting;
use crate::shape::{FACING_SINE_SQUARED, FeatureId, Kind};

/// The squared sine of the lean up to which a segment shows itself; see [`super::super::facet::LEAST_COSINE`].
const SEGMENT_SINE_SQUARED: f64 = 0.75;

/// How the corners and sides of an outline are named.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(super) enum Names {
    /// As they are numbered.
    Plain,
    /// Those of a triangle whose corners run clockwise.
    Clockwise,
    Box,
    Segment,
}

impl Names {
    /// `None` for solids without an outline, and for triangles that are hardly more than a line.
    pub(super) fn of<N: Real>(kind: &Kind<'_, N, 2>) -> Option<Self> {
        Some(match kind {
            Kind::Segment(_) | Kind::Capsule(_) => Self::Segment,
            Kind::Cuboid(_) => Self::Box,
            Kind::Polytope(_) => Self::Plain,
            Kind::Triangle(triangle) => {
                let [a, b, c] = triangle.corners();
                let (side1, side2) = (b - a, c - a);
                let area = cross2(&side1, &side2);
                let squares = side1.norm_squared() + side2.norm_squared();
                let is_thin = area.abs() <= N::lit(1024.0) * N::EPSILON * squares;
                return (!is_thin).then_some(if area < N::ZERO {
                    Self::Clockwise
                } else {
                    Self::Plain
                });
            }
            Kind::Rounded(solid) => match solid.inner().0 {
                Kind::Rounded(_) | Kind::Capsule(_) | Kind::Ball(_) => return None,
                inner => return Self::of(&inner),
            },
            _ => return None,
        })
    }

    #[inline(always)]
    fn corner(self, number: usize) -> FeatureId {
        const BOX: [u32; 4] = [0, 1, 3, 2];
        const CLOCKWISE: [u32; 4] = [0, 2, 1, 1];
        match self {
            Self::Plain | Self::Segment => FeatureId::Vertex(small(number)),
            Self::Box => FeatureId::Vertex(BOX[number & 3]),
            Self::Clockwise => FeatureId::Vertex(CLOCKWISE[number & 3]),
        }
    }

    #[inline(always)]
    fn side(self, number: usize) -> FeatureId {
        const BOX: [u32; 4] = [3, 0, 2, 1];
        const CLOCKWISE: [u32; 4] = [2, 1, 0, 0];
        match self {
            Self::Plain => FeatureId::Face(small(number)),
            Self::Segment => FeatureId::Edge(0),
            Self::Box => FeatureId::Face(BOX[number & 3]),
            Self::Clockwise => FeatureId::Face(CLOCKWISE[number & 3]),
        }
    }

    /// The squared sine of the lean up to which a side is shown.
    fn most_lean<N: Real>(self) -> N {
        N::lit(if self == Self::Segment { SEGMENT_SINE_SQUARED } else { FACING_SINE_SQUARED })
    }
}

/// A number below eight.
#[expect(clippy::cast_possible_truncation, reason = "three bits are left")]
const fn small(number: usize) -> u32 {
    (number & 7) as u32
}

/// What a solid shows of itself: a side, or the corner at both of its ends.
///
/// Its ends are seen along the normal: their places on the line of contact, and their heights above it, from
/// the farthest corner of the first solid.
pub(super) struct Part<N: Real> {
    names: Names,
    pub(super) id: FeatureId,
    pub(super) is_side: bool,
    /// The corners at its ends, in the order of the outline.
    pub(super) corners: [usize; 2],
    pub(super) places: [N; 2],
    pub(super) heights: [N; 2],
    /// The end that is nearest to the other solid.
    pub(super) near: usize,
}

impl<N: Real> Part<N> {
    #[inline(always)]
    pub(super) fn of(meeting: &Meeting<N>, which: usize, (names, tolerance): (Names, N)) -> Self {
        match meeting.best {
            Some((best, side)) if best == which => Self::best(meeting, which, side, names),
            _ => Self::beside(meeting, which, (names, tolerance)),
        }
    }

    /// The side that is the best, which is level.
    #[inline(always)]
    fn best(meeting: &Meeting<N>, which: usize, side: usize, names: Names) -> Self {
        let mut part = Self::side((meeting, names), which, (side, meeting.next(which, side)), 0);
        part.heights = [meeting.level(which); 2];
        part
    }

    /// The side at the nearest corner that leans less, or the corner.
    #[inline(always)]
    fn beside(meeting: &Meeting<N>, which: usize, (names, tolerance): (Names, N)) -> Self {
        let corner = meeting.corners[which & 1];
        let (next, before) = (meeting.next(which, corner), meeting.previous(which, corner));
        let (rise1, squared1) = meeting.tilt(which, corner, next);
        let (rise2, squared2) = meeting.tilt(which, corner, before);
        let (lean1, lean2) = (rise1 * squared2, rise2 * squared1);
        // Of equal sides that of the lower number counts.
        let is_next = if corner > 0 { lean1 < lean2 } else { lean1 <= lean2 };
        let (rise, squared) = if is_next { (rise1, squared1) } else { (rise2, squared2) };
        let is_side = rise <= names.most_lean::<N>() * squared;
        if !is_side {
            let mut part = Self::corner((meeting, names), which, corner);
            // A segment that is seen end on has no corner that is the nearest for certain.
            let across = meeting.place(which, next) - part.places[0];
            if names == Names::Segment && across.abs() <= tolerance {
                part.id = names.side(corner);
            }
            return part;
        }
        let (ends, near) = if is_next { ((corner, next), 0) } else { ((before, corner), 1) };
        let mut part = Self::side((meeting, names), which, ends, near);
        part.heights[part.near & 1] = meeting.level(which);
        part
    }

    #[inline(always)]
    fn corner((meeting, names): (&Meeting<N>, Names), which: usize, corner: usize) -> Self {
        let (place, height) = (meeting.place(which, corner), meeting.level(which));
        Self {
            names,
            id: names.corner(corner),
            is_side: false,
            corners: [corner; 2],
            places: [place; 2],
            heights: [height; 2],
            near: 0,
        }
    }

    /// A segment has its ends in one order, from whichever hand it is seen.
    #[inline(always)]
    fn side(
        (meeting, names): (&Meeting<N>, Names),
        which: usize,
        (start, end): (usize, usize),
        near: usize,
    ) -> Self {
        let is_turned = names == Names::Segment && start > 0;
        let (from, to) = if is_turned { (end, start) } else { (start, end) };
        Self {
            names,
            id: names.side(start),
            is_side: true,
            corners: [from, to],
            places: [meeting.place(which, from), meeting.place(which, to)],
            heights: [meeting.height(which, from), meeting.height(which, to)],
            near: if is_turned { 1 - near } else { near },
        }
    }

    /// The name of an end.
    #[inline(always)]
    pub(super) fn end(&self, end: usize) -> FeatureId {
        self.names.corner(self.corners[end & 1])
    }

    /// From the first end to the second.
    #[inline(always)]
    pub(super) fn length(&self) -> N {
        self.places[1] - self.places[0]
    }

    /// How much higher the second end is.
    #[inline(always)]
    pub(super) fn rise(&self) -> N {
        self.heights[1] - self.heights[0]
    }

    /// The index of the end with the smaller place.
    #[inline(always)]
    pub(super) fn low(&self) -> usize {
        usize::from(self.length() < N::ZERO)
    }

    /// How far along it a place is, from end to end.
    #[inline(always)]
    pub(super) fn share(&self, place: N) -> N {
        min(max((place - self.places[0]) / self.length(), N::ZERO), N::ONE)
    }

    /// The smallest part that holds a place.
    pub(super) fn named_at(&self, place: N, tolerance: N) -> FeatureId {
        let is_near = |&end: &usize| (self.places[end] - place).abs() <= N::TWO * tolerance;
        (0..2).find(is_near).filter(|_| self.is_side).map_or(self.id, |end| self.end(end))
    }
}
