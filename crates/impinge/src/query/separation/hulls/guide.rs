//! What is known beforehand of the parts that may decide, and what is found out for the next time.

use super::cloud::{Best, Cloud};
use super::noise;
use super::pool::{Asked, Pool, Pools};
use super::solid::Flat;
use crate::math::simd::Simd;
use crate::math::{Real, Wide};

/// How far the solids may move before what is noted of them means nothing, in units of the pair.
pub(super) const ROOM: f64 = 1.0 / 256.0;

/// What is known of the faces of a solid.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Known {
    /// Nothing.
    Any,
    /// Some face of the other solid is higher than all of them, of which this one was the best.
    Lower(usize),
    /// This one is the highest.
    Is(usize),
    /// One of these two is, the first of equals; they are ascending.
    Either(usize, usize),
}

impl Known {
    /// The faces that may be the best, where they are known.
    pub(super) fn faces(self) -> impl Iterator<Item = usize> {
        let [one, other] = match self {
            Self::Any | Self::Lower(_) => [None, None],
            Self::Is(face) => [Some(face), None],
            Self::Either(face, other) => [Some(face), Some(other)],
        };
        one.into_iter().chain(other)
    }
}

/// How a search may be cut short, what it found on its way, and what the next one may go by.
pub(super) struct Guide<N: Real> {
    known: [Known; 2],
    /// A face of the first or second solid that may part the two by more than the limit.
    parting: Option<(usize, usize)>,
    pub(super) pool: Option<Pools<N>>,
    /// The best face of each solid.
    pub(super) best: [Best<N>; 2],
    /// What is known is to be noted.
    is_drafting: bool,
    noted: Option<Pools<N>>,
    /// What was known did not do.
    pub(super) has_missed: bool,
    /// What was asked about edges then; where everything is to be noted, what is likely to be asked.
    pub(super) asked: Asked<N>,
}

impl<N: Real> Default for Guide<N> {
    fn default() -> Self {
        let none = Best::alone(0, -N::INFINITY);
        Self {
            known: [Known::Any; 2],
            parting: None,
            pool: None,
            best: [none; 2],
            is_drafting: false,
            noted: None,
            has_missed: false,
            asked: Asked::default(),
        }
    }
}

impl<N: Real> Guide<N> {
    /// Nothing is known, and everything is to be noted.
    pub(super) fn drafting(asked: Asked<N>) -> Self {
        Self { is_drafting: true, asked, ..Self::default() }
    }

    /// So much is known.
    pub(super) fn knowing(known: [Known; 2], pool: Option<Pools<N>>) -> Self {
        Self { known, pool, ..Self::default() }
    }

    /// A face of one of the solids that parted them before.
    pub(super) fn parting(which: usize, face: usize) -> Self {
        Self { parting: Some((which, face)), ..Self::default() }
    }

    /// The face that is worth a look before all others.
    pub(super) const fn first_look(&self) -> Option<(usize, usize)> {
        self.parting
    }

    pub(super) const fn is_drafting(&self) -> bool {
        self.is_drafting
    }

    /// No face of the solid can be the best.
    pub(super) fn is_lower(&self, which: usize) -> bool {
        matches!(self.known[which], Known::Lower(_))
    }

    /// Finds the best face of the first or second solid over the vertices of the other one, and how high
    /// these are.
    #[inline(always)]
    pub(super) fn measure<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        (which, solid): (usize, &Flat<'_, N>),
        cloud: &Cloud<N>,
        shrink: N,
    ) -> N {
        let best = match self.known[which] {
            Known::Is(face) => Best::alone(face, cloud.above::<S, V>(simd, (solid, face), shrink)),
            Known::Either(face, other) => {
                let height = cloud.above::<S, V>(simd, (solid, face), shrink);
                let second = cloud.above::<S, V>(simd, (solid, other), shrink);
                if second > height { Best::alone(other, second) } else { Best::alone(face, height) }
            }
            Known::Any | Known::Lower(_) => {
                let planes = (solid.planes, solid.faces());
                cloud.farthest_plane::<S, V>(simd, planes, shrink, self.is_drafting)
            }
        };
        self.best[which] = best;
        best.height
    }

    /// A face of each solid that it likely shows the other.
    pub(super) fn likely(&self) -> [u32; 2] {
        let mut likely = [0; 2];
        for (which, face) in likely.iter_mut().enumerate() {
            let index = match self.known[which] {
                Known::Lower(index) => index,
                _ => self.best[which].face,
            };
            // No solid that is treated here has more than 64 faces.
            *face = u32::try_from(index).unwrap_or(0);
        }
        likely
    }

    /// The best face is one of the second solid.
    pub(super) fn is_second(&self) -> bool {
        self.best[1].height > self.best[0].height + noise()
    }

    /// What will be known of the faces while the solids move no farther than the room: each height
    /// changes by no more than a point of a solid moves in the frame of the other.
    pub(super) fn faces(&self) -> [Known; 2] {
        let winner = usize::from(self.is_second());
        let (best, other) = (&self.best[winner], &self.best[1 - winner]);
        let clear = N::TWO * N::lit(ROOM) + N::lit(16.0) * noise();
        let is = |one: &Best<N>| match one {
            one if one.height - one.next.1 > clear => Known::Is(one.face),
            one if one.height - one.third > clear && one.face < one.next.0 => {
                Known::Either(one.face, one.next.0)
            }
            one if one.height - one.third > clear => Known::Either(one.next.0, one.face),
            _ => Known::Any,
        };
        let rival =
            if best.height - other.height > clear { Known::Lower(other.face) } else { is(other) };
        if winner == 1 { [rival, is(best)] } else { [is(best), rival] }
    }

    /// The edges that may decide can be told: it is known whose plane they are measured from.
    pub(super) fn has_known_faces(&self) -> bool {
        !self.faces().contains(&Known::Any)
    }

    /// Notes the edges that may decide, as seen from the first or second solid.
    pub(super) fn note_edges(&mut self, pool: Option<Pool<N>>, is_second: bool) {
        self.noted = pool.map(|pool| pool.by_solid(is_second));
    }

    /// The edges noted.
    pub(super) const fn noted(&self) -> Option<Pools<N>> {
        self.noted
    }
}
