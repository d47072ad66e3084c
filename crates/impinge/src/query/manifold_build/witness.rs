//! What the nearest points of two convex solids lie on.

use super::facet::{Facet, Which};
use super::frame::Frame;
use super::{ManifoldRequest, Pair, at_witness, ball, face, tangents2, tangents3};
use crate::convex::Separation;
use crate::math::{Real, Vector};
use crate::shape::{FeatureId, Kind};

/// The features of two solids of the plane that the points of their separation lie on.
pub(crate) fn features2<N: Real>(
    pair: &Pair<'_, N, 2>,
    separation: &Separation<N, 2>,
) -> [FeatureId; 2] {
    features(pair, separation, tangents2(&separation.normal))
}

/// The features of two solids of space that the points of their separation lie on.
pub(crate) fn features3<N: Real>(
    pair: &Pair<'_, N, 3>,
    separation: &Separation<N, 3>,
) -> [FeatureId; 2] {
    features(pair, separation, tangents3(&separation.normal))
}

/// The feature of one of two solids of the plane, the first or the second: one of [`features2`].
pub(crate) fn feature2<N: Real>(
    pair: &Pair<'_, N, 2>,
    known: (&Separation<N, 2>, N),
    is_second: bool,
) -> FeatureId {
    feature(pair, known, tangents2, is_second)
}

/// The feature of one of two solids of space, the first or the second: one of [`features3`].
pub(crate) fn feature3<N: Real>(
    pair: &Pair<'_, N, 3>,
    known: (&Separation<N, 3>, N),
    is_second: bool,
) -> FeatureId {
    feature(pair, known, tangents3, is_second)
}

/// The frame of a witness that nothing else is asked of.
pub(super) fn frame<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    tangents: [Vector<N, D>; 2],
) -> Frame<N, D> {
    let request = ManifoldRequest::new(separation.distance, N::ZERO, 1);
    Frame::new(pair, separation, &request, tangents)
}

fn features<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    tangents: [Vector<N, D>; 2],
) -> [FeatureId; 2] {
    if let Some(touched) = known(pair, separation) {
        return [FeatureId::Face(0), touched];
    }
    let frame = frame(pair, separation, tangents);
    [false, true].map(|is_second| shown(pair, &frame, is_second))
}

fn feature<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    (separation, noise): (&Separation<N, D>, N),
    tangents: fn(&Vector<N, D>) -> [Vector<N, D>; 2],
    is_second: bool,
) -> FeatureId {
    match known(pair, separation) {
        Some(touched) if is_second => return touched,
        Some(_) => return FeatureId::Face(0),
        None => {}
    }
    let seam = on_seam(pair, separation, noise, is_second);
    seam.unwrap_or_else(|| {
        shown(pair, &frame(pair, separation, tangents(&separation.normal)), is_second)
    })
}

/// The side or corner of a triangle that a solid with flat faces touches, or the core of a capsule: the points
/// of these are exact, so that the place tells.
fn on_seam<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    noise: N,
    is_second: bool,
) -> Option<FeatureId> {
    let (triangle, point, toward) = match (&pair.first, &pair.second) {
        (Kind::Triangle(triangle), Kind::Cuboid(_) | Kind::Polytope(_)) if !is_second => {
            (triangle, separation.point1, separation.normal)
        }
        (Kind::Segment(_) | Kind::Capsule(_), Kind::Triangle(triangle)) if is_second => {
            let point = pair.pose12.inverse_point(&separation.point2);
            (triangle, point, pair.pose12.inverse_vector(&-separation.normal))
        }
        _ => return None,
    };
    let part = triangle.part_at(&point, &toward, noise);
    part.filter(|part| !matches!(part, FeatureId::Face(_)))
}

/// What a ball, the first solid, touches, where that is known at once.
fn known<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
) -> Option<FeatureId> {
    match pair.first {
        Kind::Ball(_) => ball::known_part(pair, separation),
        _ => None,
    }
}

/// As a manifold would name it: the smallest part of what a core shows along the normal that holds
/// the point.
fn shown<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    frame: &Frame<N, D>,
    is_second: bool,
) -> FeatureId {
    let (kind, which) =
        if is_second { (pair.second, Which::Second) } else { (pair.first, Which::First) };
    // A ball's only feature, and a half-space's.
    if let Kind::Ball(_) | Kind::Plane(_) | Kind::Composite(_) = kind {
        return FeatureId::Face(0);
    }
    let mut facet = Facet::boundary(which);
    face(&mut facet, kind, is_second.then_some(&pair.pose12), frame);
    at_witness(&facet, frame)
}
