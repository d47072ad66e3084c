//! Two solids of the plane with up to eight corners, rounded or not, in one go.
//!
//! As [`super::stretch`], which is the definition but for rounding: what separates them
//! ([`meeting`]) names the corners that are nearest, each solid shows the side at its corner that leans less,
//! or the corner alone, and the contact points are the ends of what the two sides share. What lies within
//! rounding of something else that would have another name, or is no usual number, is left to that.

mod facing;
mod part;

use self::facing::Facing;
use self::part::{Names, Part};
use super::frame::rounding;
use super::{ManifoldRequest, Pair, RawManifold};
use crate::math::lanes::with_lanes;
use crate::math::simd::{Level, Simd};
use crate::math::{Real, Wide};
use crate::query::separation::bare;
use crate::query::separation::meeting::Meeting;
use crate::shape::{Geometry, Kind};

/// Builds the manifold of two solids; answers whether it did.
pub(super) fn build<N: Real>(
    pair: &Pair<'_, N, 2>,
    request: &ManifoldRequest<N>,
    out: &mut RawManifold<N, 2>,
) -> bool {
    if request.sine > N::ZERO || request.max_points < 2 {
        return false;
    }
    let (Some(names1), Some(names2)) = (Names::of(&pair.first), Names::of(&pair.second)) else {
        return false;
    };
    let tolerance = rounding(pair);
    // Two segments have lanes of their own, which give the bits of the general way.
    let are_segments = names1 == Names::Segment && names2 == Names::Segment;
    // So have two boxes their own separating axis, of which the last digit is another.
    let are_boxes = names1 == Names::Box && names2 == Names::Box;
    if are_segments || are_boxes || is_out_of_order(pair) || !tolerance.is_finite_number() {
        return false;
    }
    let shown = ([names1, names2], tolerance);
    with_lanes!(Level::new(), simd => {
        build_in_lanes::<_, N, N::Lanes<_>>(simd, pair, shown, (request.prediction, out))
    })
}

/// How they meet is told by vectors, and what they show and share from corner to corner.
#[inline(always)]
fn build_in_lanes<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    pair: &Pair<'_, N, 2>,
    (names, tolerance): ([Names; 2], N),
    (prediction, out): (N, &mut RawManifold<N, 2>),
) -> bool {
    let (kinds, noise) = ([&pair.first, &pair.second], N::lit(4.0) * tolerance);
    let meeting = &mut Meeting::unknown();
    if !meeting.find::<S, V>(simd, kinds, &pair.pose12, noise) {
        return false;
    }
    let distance = meeting.gap - meeting.radii[0] - meeting.radii[1];
    if distance > prediction {
        out.points.clear();
        return true;
    }
    let part1 = Part::of(meeting, 0, (names[0], tolerance));
    let part2 = Part::of(meeting, 1, (names[1], tolerance));
    let facing = Facing { meeting, parts: [&part1, &part2], distance, tolerance };
    facing.build(prediction, out)
}

/// Rounded solids are parted as what is within them is, whose order may be the opposite: of that the last digit
/// is another.
fn is_out_of_order<N: Real>(pair: &Pair<'_, N, 2>) -> bool {
    let [first, second] = [pair.first, pair.second].map(|kind| Geometry(bare(kind).0).kind());
    matches!(pair.second, Kind::Rounded(_)) && first > second
}
