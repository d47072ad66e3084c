//! Convex hulls and boxes in space, of so few parts that all of them can be looked at.
//!
//! No iteration, and nothing that depends on where a search begins: the answer is that of named
//! features. The separating axis test asks every face of both solids, eight at a time, how far the other
//! solid lies above it ([`cloud`]). The highest face is the answer where the solids face each other
//! there ([`face`]). If not, edges decide ([`edges`]), and only those whose vertices lie within reach
//! of the face: where the solids overlap, pairs of edges that are a face of their Minkowski difference
//! (the Gauss map test of D. Gregorius, "The Separating Axis Test between Convex Polyhedra", GDC 2013);
//! where they are apart, the nearest points of edges. What is not proved in the end, by points that
//! lie as far apart as a pair of supporting planes, is left to the general algorithm.
//!
//! A pair that is asked again and again keeps a [`Certificate`]: which of all these parts can decide while
//! the pose stays near where it was. The same formulae are then applied to these parts alone, so that
//! the answer has the bits of one from nothing.

mod certificate;
mod cloud;
mod edges;
mod face;
mod guide;
mod pool;
pub(super) mod segment;
mod solid;
#[cfg(test)]
pub(in crate::query) mod tests;

use core::cell::Cell;

pub(crate) use self::certificate::Certificate;
use self::cloud::{Cloud, Place};
use self::face::{Meeting, Side};
use self::guide::Guide;
use self::pool::{Pool, Reached};
use self::solid::{BoxParts, Flat};
use super::{general, wrong_kinds};
use crate::convex::{Separation, Units};
use crate::math::lanes::with_lanes;
use crate::math::simd::{Level, Simd};
use crate::math::{Point, Pose, Real, Vector, Wide};
use crate::query::Pair;
use crate::shape::{Cuboid, Kind, SupportMap};

/// How many vertices, faces or edges are treated at once.
const LANES: usize = 8;
/// Room for 32 vertices, and for the 60 faces that as many vertices may have.
const BLOCKS: usize = 4;
const PLANE_BLOCKS: usize = 8;

/// The separation of a convex hull or a box from a convex hull.
///
/// Equal faces: those of the first solid come before those of the second, in their order, and all
/// before edges; of equal pairs of edges that of the lower numbers counts. Cost: the product of the
/// numbers of vertices and faces, by eights; larger hulls are left to the general algorithm.
pub(super) fn separation<N: Real>(pair: &Pair<'_, N, 3>, limit: N) -> Option<Separation<N, 3>> {
    answered(pair, limit, (None, &mut [0; 2]))
}

/// [`separation`], with a face of each solid that it likely shows the other. For a pair that is asked again
/// and again, to the bit: what is clear of it is kept, and need not be found anew while the solids have
/// hardly moved.
pub(in crate::query) fn separation_again<N: Real>(
    pair: &Pair<'_, N, 3>,
    limit: N,
    certificate: Option<&mut Certificate<N, 3>>,
) -> Option<(Separation<N, 3>, [u32; 2])> {
    let mut likely = [0; 2];
    let separation = answered(pair, limit, (certificate, &mut likely))?;
    Some((separation, likely))
}

/// Whether [`separation_again`] is for these kinds.
pub(in crate::query) const fn treats<N: Real>(pair: &Pair<'_, N, 3>) -> bool {
    matches!((&pair.first, &pair.second), (Kind::Polytope(_) | Kind::Cuboid(_), Kind::Polytope(_)))
}

fn answered<N: Real>(
    pair: &Pair<'_, N, 3>,
    limit: N,
    known: (Option<&mut Certificate<N, 3>>, &mut [u32; 2]),
) -> Option<Separation<N, 3>> {
    let Kind::Polytope(second) = pair.second else { wrong_kinds(pair) };
    let question = (&pair.pose12, limit);
    let found = match (pair.first, Flat::of_polytope(second)) {
        (_, None) => Verdict::Undecided,
        (Kind::Polytope(first), Some(second)) => Flat::of_polytope(first)
            .map_or(Verdict::Undecided, |first| between([&first, &second], question, known)),
        (Kind::Cuboid(first), Some(second)) if has_volume(first, second.reach) => {
            between([&BoxParts::new(first).flat(), &second], question, known)
        }
        (Kind::Cuboid(_), _) => Verdict::Undecided,
        _ => wrong_kinds(pair),
    };
    match found {
        Verdict::Beyond => None,
        Verdict::Found(found) => Some(found).filter(|found| found.distance <= limit),
        Verdict::Undecided => general::of_flat_cores(pair, limit),
    }
}

/// Whether no side of a box is as short as noise beside a solid of this reach: faces without width have
/// sides without direction.
fn has_volume<N: Real>(cuboid: &Cuboid<N, 3>, reach: N) -> bool {
    let least = noise::<N>() * (cuboid.reach() + reach);
    cuboid.half_extents().iter().all(|&half| half > least)
}

/// How the test ended.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Verdict<N: Real> {
    /// The solids are farther apart than the limit.
    Beyond,
    Found(Separation<N, 3>),
    Undecided,
}

/// What arithmetic cannot resolve, in units of the pair.
pub(super) fn noise<N: Real>() -> N {
    N::lit(8.0) * N::EPSILON
}

/// What a lower bound has to exceed to be out of reach, in units of the pair: a limit of the caller's, and
/// rounding.
pub(super) fn out_of_reach<N: Real>(units: &Units<N>, limit: N) -> N {
    let limit = limit * units.shrink;
    limit + N::lit(16.0) * noise::<N>() * (N::ONE + limit.abs())
}

fn between<N: Real>(
    solids: [&Flat<'_, N>; 2],
    (pose12, limit): (&Pose<N, 3>, N),
    (certificate, likely): (Option<&mut Certificate<N, 3>>, &mut [u32; 2]),
) -> Verdict<N> {
    if !pose12.is_finite() {
        return Verdict::Beyond;
    }
    let level = Level::new();
    let mut ask = |guide: &mut Guide<N>| {
        let verdict = at(level, solids, (pose12, limit), guide);
        *likely = guide.likely();
        verdict
    };
    match certificate {
        None => ask(&mut Guide::default()),
        Some(certificate) => certificate.asked(solids, pose12, ask),
    }
}

/// [`between`] with the vectors of an instruction set; the answers do not depend on it.
fn at<N: Real>(
    level: Level,
    solids: [&Flat<'_, N>; 2],
    question: (&Pose<N, 3>, N),
    guide: &mut Guide<N>,
) -> Verdict<N> {
    with_lanes!(level, simd => search::<_, N, N::Lanes<_>>(simd, solids, question, guide))
}

#[inline(always)]
fn search<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [first, second]: [&Flat<'_, N>; 2],
    (pose12, limit): (&Pose<N, 3>, N),
    guide: &mut Guide<N>,
) -> Verdict<N> {
    let units = Units::of(first.reach, second.reach, &pose12.translation);
    let shrink = units.shrink;
    let beyond = out_of_reach(&units, limit);
    let in_first = Place { rotation: pose12.rotation, translation: pose12.translation * shrink };
    let in_second = in_first.inverse();
    let own1 = Cloud::own::<S, V>(simd, (first.blocks, first.vertices), shrink);
    let own2 = Cloud::own::<S, V>(simd, (second.blocks, second.vertices), shrink);
    let (mut cloud1, mut cloud2) = (Cloud::empty(), Cloud::empty());
    if let Some((which, face)) = guide.first_look() {
        let (own, place) = if which == 0 { (&own2, &in_first) } else { (&own1, &in_second) };
        own.place::<S, V>(simd, place, &mut cloud1);
        let solid = if which == 0 { first } else { second };
        if cloud1.above::<S, V>(simd, (solid, face), shrink) > beyond {
            return Verdict::Beyond;
        }
        guide.has_missed = true;
    }
    if !guide.is_lower(0) {
        own2.place::<S, V>(simd, &in_first, &mut cloud2);
        if guide.measure::<S, V>(simd, (0, first), &cloud2, shrink) > beyond {
            return Verdict::Beyond;
        }
    }
    if !guide.is_lower(1) {
        own1.place::<S, V>(simd, &in_second, &mut cloud1);
        if guide.measure::<S, V>(simd, (1, second), &cloud1, shrink) > beyond {
            return Verdict::Beyond;
        }
    }
    // Seen from the solid whose face it is: the other one is placed in its frame.
    let is_second = guide.is_second();
    let clouds = [[&own1, &own2], [&cloud1, &cloud2]];
    let places = [in_first, in_second];
    let view = View { solids: [first, second], clouds, places, shrink };
    let mut meeting =
        view.meeting::<S, V>(simd, is_second, guide.best[usize::from(is_second)].face);
    meeting.pool = guide.pool.map(|pool| pool.seen_from(is_second));
    let found = meeting.resolve::<S, V>(simd);
    if meeting.pool.is_some_and(|pool| !pool.serves(meeting.asked.get())) {
        (guide.has_missed, guide.asked) = (true, meeting.asked.get());
    }
    if guide.is_drafting() && guide.has_known_faces() {
        meeting.expect(guide.asked);
        let pool = view.pool::<S, V>(simd, (&meeting, is_second), found.as_ref(), guide);
        guide.note_edges(pool, is_second);
    }
    let Some(found) = found else { return Verdict::Undecided };
    let restored = found.restored(units.scale);
    Verdict::Found(if is_second { in_first_frame(&restored, pose12) } else { restored })
}

/// Both solids, each in both frames.
struct View<'s, 'a, N: Real> {
    solids: [&'s Flat<'a, N>; 2],
    /// In their own frames, and in that of the other one.
    clouds: [[&'s Cloud<N>; 2]; 2],
    /// Where the second lies in the first, and the other way round.
    places: [Place<N>; 2],
    shrink: N,
}

impl<'s, 'a, N: Real> View<'s, 'a, N> {
    /// A face of the first or second solid, and what the other one shows it.
    #[inline(always)]
    fn meeting<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        is_second: bool,
        face: usize,
    ) -> Meeting<'s, 'a, N> {
        let (one, two) = (usize::from(is_second), usize::from(!is_second));
        let normal = self.solids[one].normal(face);
        let own = Side::new::<S, V>(simd, self.solids[one], self.clouds[0][one], &-normal);
        let other = Side::new::<S, V>(simd, self.solids[two], self.clouds[1][two], &normal);
        Meeting {
            own,
            other,
            place: self.places[one],
            face,
            normal,
            shrink: self.shrink,
            pool: None,
            asked: Cell::default(),
        }
    }

    /// The edges that may decide next time, whichever of the faces that may is the best then.
    #[inline(always)]
    fn pool<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        (meeting, is_second): (&Meeting<'_, '_, N>, bool),
        found: Option<&Found<N>>,
        guide: &Guide<N>,
    ) -> Option<Pool<N>> {
        let mut reached = Reached::default();
        if let Some(wide) = meeting.wide() {
            for (which, known) in guide.faces().into_iter().enumerate() {
                for face in known.faces() {
                    let other = self.meeting::<S, V>(simd, which == 1, face);
                    let edges = other.within_reach::<S, V>(simd, wide);
                    reached.add(edges, which != usize::from(is_second));
                }
            }
        }
        meeting.pool::<S, V>(simd, &reached, found)
    }
}

/// An answer in the frame of the solid that owns the face, from it to the other.
#[derive(Clone, Copy)]
struct Found<N: Real> {
    distance: N,
    normal: Vector<N, 3>,
    on_own: Vector<N, 3>,
    on_other: Vector<N, 3>,
}

impl<N: Real> Found<N> {
    /// In the caller's units.
    fn restored(&self, scale: N) -> Separation<N, 3> {
        Separation {
            distance: self.distance * scale,
            normal: self.normal,
            point1: Point::from(self.on_own * scale),
            point2: Point::from(self.on_other * scale),
        }
    }
}

/// An answer found in the frame of the second solid, in that of the first, at which it lies at
/// `pose12`.
pub(super) fn in_first_frame<N: Real>(
    found: &Separation<N, 3>,
    pose12: &Pose<N, 3>,
) -> Separation<N, 3> {
    Separation {
        distance: found.distance,
        normal: -pose12.vector(&found.normal),
        point1: pose12.point(&found.point2),
        point2: pose12.point(&found.point1),
    }
}
