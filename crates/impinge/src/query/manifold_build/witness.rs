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

/// The frame of a witness that nothing else is asked of.
pub(super) fn frame<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    tangents: [Vector<N, D>; 2],
) -> Frame<N, D> {
    let request = ManifoldRequest::new(separation.distance, N::ZERO, 1);
    Frame::new(pair, separation, &request, tangents)
}

/// As a manifold would name them: each is the smallest part of what a core shows along the normal that
/// holds the point.
fn features<N: Real, const D: usize>(
    pair: &Pair<'_, N, D>,
    separation: &Separation<N, D>,
    tangents: [Vector<N, D>; 2],
) -> [FeatureId; 2] {
    let known = match pair.first {
        Kind::Ball(_) => ball::known_part(pair, separation),
        _ => None,
    };
    if let Some(touched) = known {
        return [FeatureId::Face(0), touched];
    }
    let frame = frame(pair, separation, tangents);
    [(pair.first, Which::First), (pair.second, Which::Second)].map(|(kind, which)| {
        // A ball's only feature, and a half-space's.
        if let Kind::Ball(_) | Kind::Plane(_) | Kind::Composite(_) = kind {
            return FeatureId::Face(0);
        }
        let mut facet = Facet::boundary(which);
        let pose = matches!(which, Which::Second).then_some(&pair.pose12);
        face(&mut facet, kind, pose, &frame);
        at_witness(&facet, &frame)
    })
}
