//! The core of a segment or capsule in the frame of a solid with flat faces: what the closed forms for
//! boxes and triangles share.

use super::wrong_kinds;
use crate::convex::Separation;
use crate::math::{Point, Pose, Real, Vector, max, max_component, min};
use crate::query::Pair;
use crate::shape::Kind;

/// A segment in the frame of a solid, in units in which neither of the two, nor the way between their
/// origins, is larger than 2.
pub(super) struct Rod<'a, N: Real> {
    pub(super) ends: [Vector<N, 3>; 2],
    /// From the first end to the second.
    pub(super) along: Vector<N, 3>,
    pose12: &'a Pose<N, 3>,
    scale: N,
    /// 1 / `scale`, exactly.
    pub(super) shrink: N,
}

/// How the two are parted, or how deep the one is in the other, in the frame and the units of a [`Rod`].
#[derive(Clone, Copy, Debug)]
pub(super) struct Parting<N: Real> {
    /// Unit, from the solid to the segment.
    pub(super) outward: Vector<N, 3>,
    pub(super) on_rod: Vector<N, 3>,
    pub(super) on_solid: Vector<N, 3>,
    pub(super) distance: N,
}

/// What is known of a pair.
pub(super) enum Verdict<N: Real> {
    /// The core is farther from the solid than was asked for.
    Beyond,
    Parted(Parting<N>),
    Undecided,
}

/// What arithmetic on numbers of size 2 cannot resolve.
pub(super) fn noise<N: Real>() -> N {
    N::lit(16.0) * N::EPSILON
}

/// The separation of a segment or capsule, the first of a pair, from a solid of a given bounding radius, by the
/// verdict of `solve` on the core, which is also given what a gap of the core must exceed to be too large; where
/// that is undecided, by `fall_back`.
pub(super) fn settled<N: Real>(
    pair: &Pair<'_, N, 3>,
    bounding_radius: N,
    limit: N,
    solve: impl FnOnce(&Rod<'_, N>, N) -> Verdict<N>,
    fall_back: impl FnOnce() -> Option<Separation<N, 3>>,
) -> Option<Separation<N, 3>> {
    let (ends, radius) = match pair.first {
        Kind::Segment(segment) => ([segment.a(), segment.b()], N::ZERO),
        Kind::Capsule(capsule) => {
            ([capsule.segment().a(), capsule.segment().b()], capsule.radius())
        }
        _ => wrong_kinds(pair),
    };
    let Some(rod) = Rod::new(ends, &pair.pose12, bounding_radius) else { return fall_back() };
    let most = (limit + radius) * rod.shrink;
    match solve(&rod, most + N::lit(16.0) * noise() * (N::ONE + most.abs())) {
        Verdict::Beyond => None,
        Verdict::Parted(parting) => {
            let found = rod.restored(&parting).rounded(radius, N::ZERO);
            (found.distance <= limit).then_some(found)
        }
        Verdict::Undecided => fall_back(),
    }
}

impl<'a, N: Real> Rod<'a, N> {
    /// `None` where the numbers end.
    fn new(ends: [&Point<N, 3>; 2], pose12: &'a Pose<N, 3>, reach: N) -> Option<Self> {
        let of_ends = max(max_component(&ends[0].coords), max_component(&ends[1].coords));
        let size = max(max(reach, max_component(&pose12.translation)), of_ends);
        let scale = size.power_of_two_below();
        let shrink = N::ONE / scale;
        let is_plain = size > N::ZERO && size.is_finite_number() && shrink.is_finite_number();
        if !(is_plain && pose12.is_finite()) {
            return None;
        }
        let place = |end: &Point<N, 3>| {
            pose12.rotation.tr_mul(&((end.coords - pose12.translation) * shrink))
        };
        // From the ends as given, which loses nothing to the way between the origins.
        let along = pose12.rotation.tr_mul(&((ends[1] - ends[0]) * shrink));
        Some(Self { ends: [place(ends[0]), place(ends[1])], along, pose12, scale, shrink })
    }

    /// The point at a share of the way, measured from the nearer end.
    pub(super) fn at(&self, share: N) -> Vector<N, 3> {
        if share <= N::HALF {
            self.ends[0] + self.along * share
        } else {
            self.ends[1] - self.along * (N::ONE - share)
        }
    }

    /// How far along a vector the end lies that is farthest against it.
    pub(super) fn low(&self, along: &Vector<N, 3>) -> N {
        min(along.dot(&self.ends[0]), along.dot(&self.ends[1]))
    }

    /// Two points along a unit vector, if they lie across from each other as far apart as supporting planes;
    /// `level` is how far along it the solid reaches.
    pub(super) fn proved(
        &self,
        outward: Vector<N, 3>,
        level: N,
        [on_rod, on_solid]: [Vector<N, 3>; 2],
    ) -> Option<Parting<N>> {
        let distance = self.low(&outward) - level;
        let aside = on_rod - on_solid - outward * distance;
        let is_proved = aside.norm_squared() <= noise::<N>() * noise();
        is_proved.then_some(Parting { outward, on_rod, on_solid, distance })
    }

    /// In the frame of the segment and the caller's units, without any radius.
    fn restored(&self, found: &Parting<N>) -> Separation<N, 3> {
        let placed = |point: Vector<N, 3>| self.pose12.point(&Point::from(point * self.scale));
        Separation {
            distance: found.distance * self.scale,
            normal: -self.pose12.vector(&found.outward),
            point1: placed(found.on_rod),
            point2: placed(found.on_solid),
        }
    }
}
