//! The plane of contact: the frame in which all points of one manifold are measured.
//!
//! ```text
//!          second solid
//!         ______o______         ^ normal: unit, from the first solid to the second
//!               : distance      |
//!         ------o------------>  tangents: coordinates `flat`, zero at the witness' `point1`
//!          first solid          height of a point: normal · (point - witness.point1)
//! ```

use smallvec::SmallVec;

use super::ids::Inherited;
use crate::collide::{ManifoldRequest, Pair, RawPoint};
use crate::convex::Separation;
use crate::math::{Point, Real, Vector, max, max_component, min};
use crate::shape::{FeatureId, Geometry, Kind, SupportMap};

/// Rounding tolerance of lengths, in units of epsilon times the size of the pair: the sum of the
/// bounding radii of both solids and the distance of their origins.
pub(in crate::collide) const ROUNDING_ERRORS: f64 = 16.0;

/// Cosine of 60°. A feature that is tilted against the contact plane by a larger angle is reduced
/// to its corner nearest to the other solid.
pub(in crate::collide) const MIN_COSINE: f64 = 0.5;

/// Candidates of a manifold.
pub(in crate::collide) type Candidates<N, const D: usize> = SmallVec<[Candidate<N, D>; 8]>;

/// One of the two solids of a pair.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(in crate::collide) enum Which {
    First,
    Second,
}

impl Which {
    /// Returns the outward direction of this solid: towards the other solid, along the normal.
    #[inline(always)]
    pub(in crate::collide) fn outward<N: Real, const D: usize>(
        self,
        frame: &ContactFrame<N, D>,
    ) -> Vector<N, D> {
        match self {
            Self::First => frame.normal(),
            Self::Second => -frame.normal(),
        }
    }

    /// Returns the depth of a point below the solid's supporting plane: the plane perpendicular to
    /// the normal through the solid's witness point.
    #[inline]
    pub(in crate::collide) fn below_witness<N: Real, const D: usize>(
        self,
        point: &Point<N, D>,
        frame: &ContactFrame<N, D>,
    ) -> N {
        let height = frame.height(point);
        match self {
            Self::First => -height,
            Self::Second => height - frame.witness.distance,
        }
    }
}

/// Returns the height of a rounded surface above a point of its core's flat feature, along the
/// normal. The surface is at distance `radius` from the feature.
///
/// `cosine` is the cosine of the feature's tilt against the contact plane. `depth` and `top` are
/// the depths, below the supporting plane, of the point and of the feature's corner nearest to the
/// other solid; `away_squared` is the squared distance between the point and that corner,
/// perpendicular to the normal. Above the flat part the height is `radius / cosine`; above the
/// corner it is the height of the ball around the corner; nothing rises above the supporting plane.
/// Exact for capsules, and where the surface is parallel to the feature. For a tilted polygon it is
/// approximate beside the sides, whose rounding is not considered.
#[inline]
pub(in crate::collide) fn lifted<N: Real>(
    radius: N,
    cosine: N,
    depth: N,
    top: N,
    away_squared: N,
) -> N {
    // Squared distance from the corner at which its ball meets the flat part of the surface.
    let turns_squared = radius * radius * (N::ONE - cosine * cosine);
    let lift = if away_squared < turns_squared {
        depth - top + (radius * radius - away_squared).sqrt()
    } else {
        radius / cosine
    };
    max(min(lift, depth), N::ZERO)
}

/// The plane through the witness perpendicular to the normal, with the limits of the request, in
/// the frame of the first solid.
///
/// `flat` coordinates are along the tangents, zero at the witness point of the first solid; in 2D
/// the second coordinate is always zero.
pub(in crate::collide) struct ContactFrame<N: Real, const D: usize> {
    /// Nearest points, normal and signed distance of the pair.
    pub(in crate::collide) witness: Separation<N, D>,
    tangents: [Vector<N, D>; 2],
    /// Largest length that counts as a rounding error.
    pub(in crate::collide) tolerance: N,
    /// Largest distance of a contact point; rotation may admit farther points ([`Self::admit`]).
    prediction: N,
    /// Sine of the largest angle by which the solids may rotate; zero if rotation is not
    /// considered.
    pub(in crate::collide) sine: N,
}

/// A possible contact point, from which the points of the manifold are chosen.
#[derive(Clone, Copy)]
pub(in crate::collide) struct Candidate<N: Real, const D: usize> {
    /// Point on the surface of the first solid, in its frame.
    pub(in crate::collide) point1: Point<N, D>,
    /// Signed distance along the normal to the second solid.
    pub(in crate::collide) distance: N,
    /// Coordinates along the tangents of the frame.
    pub(in crate::collide) flat: Vector<N, 2>,
    /// The feature of each solid that the point lies on.
    pub(in crate::collide) features: [FeatureId; 2],
    /// Id inherited from the previous manifold; `None` for a new point.
    pub(in crate::collide) kept: Option<Inherited>,
}

impl<N: Real, const D: usize> Candidate<N, D> {
    /// Creates the candidate of the nearest points, which lie on the given features.
    pub(in crate::collide) fn alone(witness: &Separation<N, D>, features: [FeatureId; 2]) -> Self {
        let (point1, distance) = (witness.point1, witness.distance);
        Self { point1, distance, flat: Vector::<N, 2>::zeros(), features, kept: None }
    }

    /// Returns whether the candidate continues a point of the previous manifold that is near it.
    pub(in crate::collide) fn is_old(&self) -> bool {
        self.kept.is_some_and(|kept| kept.is_old)
    }

    pub(in crate::collide) fn with_id(&self, id: u32) -> RawPoint<N, D> {
        let [feature1, feature2] = self.features;
        RawPoint { point1: self.point1, distance: self.distance, feature1, feature2, id, code: 0 }
    }
}

impl<N: Real, const D: usize> ContactFrame<N, D> {
    /// Creates a frame. `tangents` complete the witness' normal to a right-handed basis; in 2D the
    /// second tangent is zero.
    pub(in crate::collide) fn new(
        pair: &Pair<'_, N, D>,
        witness: &Separation<N, D>,
        request: &ManifoldRequest<N>,
        tangents: [Vector<N, D>; 2],
    ) -> Self {
        Self {
            witness: *witness,
            tangents,
            tolerance: rounding(pair),
            prediction: request.prediction,
            sine: request.sine,
        }
    }

    /// Creates a frame for a request without rotation, with a tolerance that the caller has
    /// computed.
    #[inline]
    pub(in crate::collide) fn known(
        witness: &Separation<N, D>,
        tangents: [Vector<N, D>; 2],
        tolerance: N,
        prediction: N,
    ) -> Self {
        Self { witness: *witness, tangents, tolerance, prediction, sine: N::ZERO }
    }

    #[inline]
    pub(in crate::collide) fn normal(&self) -> Vector<N, D> {
        self.witness.normal
    }

    /// Returns the axes of the `flat` coordinates.
    #[inline(always)]
    pub(in crate::collide) const fn tangents(&self) -> &[Vector<N, D>; 2] {
        &self.tangents
    }

    /// Returns the tangent coordinates of a point.
    #[inline]
    pub(in crate::collide) fn flat(&self, point: &Point<N, D>) -> Vector<N, 2> {
        let arm = point - self.witness.point1;
        Vector::<N, 2>::new(self.tangents[0].dot(&arm), self.tangents[1].dot(&arm))
    }

    /// Returns the height of a point along the normal, above the witness point of the first solid.
    #[inline]
    pub(in crate::collide) fn height(&self, point: &Point<N, D>) -> N {
        self.normal().dot(&(point - self.witness.point1))
    }

    /// Returns the distance to store for a pair of points with the tangent coordinates `flat`;
    /// `None` if the request excludes the pair.
    ///
    /// The witness has the smallest distance, so a smaller one is a rounding error and is raised to
    /// it. A distance that exceeds the prediction by no more than the tolerance is lowered to the
    /// prediction. A point beyond the prediction is admitted if a rotation about the witness brings
    /// it within the prediction.
    #[inline]
    pub(in crate::collide) fn admit(&self, distance: N, flat: &Vector<N, 2>) -> Option<N> {
        let distance = max(distance, self.witness.distance);
        if distance <= self.prediction {
            return Some(distance);
        }
        if distance <= self.prediction + self.tolerance {
            return Some(self.prediction);
        }
        (distance <= self.prediction + self.sine * flat.norm()).then_some(distance)
    }

    /// Returns an upper bound of the distances that [`Self::admit`] accepts; infinite if the solids
    /// may rotate.
    #[inline]
    pub(in crate::collide) fn most(&self) -> N {
        if self.sine > N::ZERO { N::INFINITY } else { self.prediction + self.tolerance }
    }

    /// Returns the candidate at a surface point of the first solid; `None` if [`Self::admit`]
    /// rejects it.
    #[inline]
    pub(in crate::collide) fn candidate(
        &self,
        point1: Point<N, D>,
        distance: N,
        features: [FeatureId; 2],
    ) -> Option<Candidate<N, D>> {
        let flat = self.flat(&point1);
        let distance = self.admit(distance, &flat)?;
        Some(Candidate { point1, distance, flat, features, kept: None })
    }

    /// Adds the candidate that [`Self::candidate`] returns, if any, unless it is a duplicate: a
    /// candidate in `out` has the same features and is within four tolerances of it in tangent
    /// coordinates. Corners that coincide are found twice, once from each solid.
    #[inline]
    pub(in crate::collide) fn push_new(
        &self,
        point1: Point<N, D>,
        distance: N,
        features: [FeatureId; 2],
        out: &mut Candidates<N, D>,
    ) {
        let Some(found) = self.candidate(point1, distance, features) else { return };
        let near = N::lit(4.0) * self.tolerance;
        let is_new = |old: &Candidate<N, D>| {
            let away = old.flat - found.flat;
            old.features != found.features || max_component(&away) > near || away.norm() > near
        };
        if out.iter().all(is_new) {
            out.push(found);
        }
    }
}

/// Returns the part of a segment at the coordinate `along`, measured from its first end: an end
/// within `tolerance`, the last end if both are, else the segment. `None` beyond an end by more
/// than `tolerance`.
#[inline]
pub(in crate::collide) fn part_beside<N: Real>(
    along: N,
    length: N,
    tolerance: N,
    ends: [FeatureId; 2],
    segment: FeatureId,
) -> Option<FeatureId> {
    if along < -tolerance || along > length + tolerance {
        return None;
    }
    let nearest = if along <= tolerance { ends[0] } else { segment };
    Some(if along >= length - tolerance { ends[1] } else { nearest })
}

/// Returns the length up to which differences are rounding errors for a pair: [`ROUNDING_ERRORS`]
/// epsilons of its size.
#[inline]
pub(in crate::collide) fn rounding<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> N {
    let size = size(pair.first) + size(pair.second) + pair.pose12.translation.norm();
    N::lit(ROUNDING_ERRORS) * N::EPSILON * size
}

/// Returns the bounding radius of a solid around its origin, including its rounding radius; zero
/// for kinds without a support map, such as half-spaces.
#[inline]
fn size<N: Real, const D: usize>(kind: Kind<'_, N, D>) -> N {
    match kind {
        Kind::Ball(ball) => ball.radius(),
        Kind::Segment(segment) => segment.reach(),
        Kind::Capsule(capsule) => capsule.reach() + capsule.radius(),
        Kind::Triangle(triangle) => triangle.reach(),
        Kind::Cuboid(cuboid) => cuboid.reach(),
        Kind::Polytope(polytope) => polytope.reach(),
        _ => Geometry(kind).as_support_map().map_or(N::ZERO, |map| map.reach() + map.rounding()),
    }
}
