//! Which normals a segment of a chain in the plane has that are not those of a joint: told by its ends.

use super::polyline_parts::across;
use super::seam::slack;
use super::{FeatureId, Surface};
use crate::math::{Point, Real, Vector, perp, unit};

/// Which sides the segments of a chain have: what a [`Surface`] in the plane says so that contacts need not
/// ask it about each segment. Chains of this library have one.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Siding {
    /// The front is on the left of a segment, seen from its first end to its second.
    pub(super) is_left: bool,
    pub(super) is_one_sided: bool,
    /// Of two sides the one that a vector points to is told by the front, else by the vector itself.
    pub(super) is_told_by_front: bool,
    pub(super) keeps_internal_edges: bool,
}

impl Siding {
    fn front<N: Real>(self, along: &Vector<N, 2>) -> Vector<N, 2> {
        let left = perp(along);
        if self.is_left { left } else { -left }
    }

    /// How far a vector leads in front of a segment; zero where there is no front and back.
    fn height_over<N: Real>(self, along: Option<&Vector<N, 2>>, vector: &Vector<N, 2>) -> N {
        let along = along.filter(|_| self.is_one_sided);
        along.map_or(N::ZERO, |along| self.front(along).dot(vector))
    }

    /// As [`Surface::snapped`].
    fn snapped<N: Real>(self, along: &Vector<N, 2>, normal: &Vector<N, 2>) -> Option<Vector<N, 2>> {
        if !(self.is_one_sided || self.is_told_by_front) {
            return across(along, normal);
        }
        let front = self.front(along);
        let is_front = self.is_one_sided || front.dot(normal) >= N::ZERO;
        Some(if is_front { front } else { -front })
    }
}

/// A segment of a chain, with what its ends tell; what lies at joints the surface is asked.
pub(crate) struct KnownSegment<'a, N: Real> {
    surface: &'a dyn Surface<N, 2>,
    siding: Option<Siding>,
    from: Point<N, 2>,
    /// Unit, from the first end to the second; `None` without length.
    along: Option<Vector<N, 2>>,
}

impl<'a, N: Real> KnownSegment<'a, N> {
    /// A segment by its ends, as its surface has them.
    pub(crate) fn new(
        surface: &'a dyn Surface<N, 2>,
        siding: Option<Siding>,
        [a, b]: [Point<N, 2>; 2],
    ) -> Self {
        Self { surface, siding, from: a, along: unit(&(b - a)).map(|(along, _)| along) }
    }
}

impl<N: Real> Surface<N, 2> for KnownSegment<'_, N> {
    fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<N, 2>) -> bool {
        let Some(siding) = self.siding else { return self.surface.admits(part, feature, normal) };
        let height = siding.height_over(self.along.as_ref(), normal);
        if siding.keeps_internal_edges {
            return height >= -slack::<N>();
        }
        let own = self.along.map(|along| along.dot(normal).abs() <= slack());
        match feature {
            FeatureId::Vertex(_) if own != Some(true) => self.surface.admits(part, feature, normal),
            _ => own.is_none_or(|own| own) && height >= N::ZERO,
        }
    }

    fn snapped(&self, part: u32, normal: &Vector<N, 2>) -> Option<Vector<N, 2>> {
        match self.siding {
            Some(siding) => siding.snapped(&self.along?, normal),
            None => self.surface.snapped(part, normal),
        }
    }

    fn faces(&self, part: u32, center: &Point<N, 2>) -> bool {
        match self.siding {
            Some(siding) => {
                siding.height_over(self.along.as_ref(), &(center - self.from)) >= N::ZERO
            }
            None => self.surface.faces(part, center),
        }
    }
}
