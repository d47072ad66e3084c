//! Manifolds as the narrow phase keeps them: small, flat, in the frame of the first solid.
//!
//! The code of a point names its features and its slot in a batch, or is 0: whoever makes or renames a point
//! otherwise sets it to 0.

use smallvec::SmallVec;

use crate::math::{Point, Pose, Real, Vector};
use crate::shape::FeatureId;

/// Which points a manifold shall hold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ManifoldRequest<N: Real> {
    /// Points farther apart than this are left out; zero or more.
    pub(crate) prediction: N,
    /// The sine of the angle by which the solids may turn: a point is also kept if turning about the
    /// nearest point by that angle would bring it within `prediction`.
    pub(crate) sine: N,
    /// At most this many points are kept.
    pub(crate) max_points: usize,
}

impl<N: Real> ManifoldRequest<N> {
    /// For solids that may turn by `angle` radians: above a right angle no point comes nearer than
    /// at a right angle, and a negative angle or NaN counts as zero.
    pub(crate) fn new(prediction: N, angle: N, max_points: usize) -> Self {
        let sine = if angle > N::frac_pi_2() {
            N::ONE
        } else if angle > N::ZERO {
            angle.sine_cosine().0
        } else {
            N::ZERO
        };
        Self { prediction, sine, max_points }
    }
}

/// One point of a manifold: `point1` on the first solid, `point1 + normal · distance` on the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RawPoint<N: Real, const D: usize> {
    pub(crate) point1: Point<N, D>,
    /// Signed, along the manifold's normal: negative when penetrating.
    pub(crate) distance: N,
    pub(crate) feature1: FeatureId,
    pub(crate) feature2: FeatureId,
    /// The number of the contact within its pair; kept while it lasts.
    pub(crate) id: u32,
    /// What the builder that made the point knows its features again by; 0 for most.
    pub(crate) code: u32,
}

/// The points of many manifolds, one after the other.
pub(crate) type RawPoints<N, const D: usize> = SmallVec<[RawPoint<N, D>; 32]>;

impl<N: Real, const D: usize> RawPoint<N, D> {
    /// The same contact with the second solid first, in the frame of which the first one lies.
    pub(crate) fn flip(&mut self, pose21: &Pose<N, D>, normal: &Vector<N, D>) {
        self.point1 = pose21.point(&(self.point1 + normal * self.distance));
        core::mem::swap(&mut self.feature1, &mut self.feature2);
        self.code = 0;
    }
}

impl<N: Real, const D: usize> Default for RawPoint<N, D> {
    fn default() -> Self {
        let (feature1, feature2) = (FeatureId::Vertex(0), FeatureId::Vertex(0));
        Self { point1: Point::origin(), distance: N::ZERO, feature1, feature2, id: 0, code: 0 }
    }
}

/// A set of points with one normal, in the frame of the first solid. The points stand behind what readers need: who
/// reads few of them reads one piece of memory.
#[derive(Debug, PartialEq)]
#[repr(C)]
pub(crate) struct RawManifold<N: Real, const D: usize> {
    /// Unit, from the first solid to the second.
    pub(crate) normal: Vector<N, D>,
    /// Where the numbers of new points come from.
    pub(crate) ids: PairIds,
    /// No point means that the solids are farther apart than the prediction.
    pub(crate) points: SmallVec<[RawPoint<N, D>; 4]>,
    /// The second solid in the frame of the first when the points were found, by which they are found again on the
    /// second. `None` where that is not kept: of boxes, balls and segments, whose vertices are known by their ids.
    pub(crate) pose12: Option<Pose<N, D>>,
}

impl<N: Real, const D: usize> Clone for RawManifold<N, D> {
    fn clone(&self) -> Self {
        let Self { normal, ids, pose12, .. } = *self;
        Self { normal, ids, points: SmallVec::from_slice(&self.points), pose12 }
    }

    fn clone_from(&mut self, source: &Self) {
        (self.normal, self.ids, self.pose12) = (source.normal, source.ids, source.pose12);
        self.points.clear();
        self.points.extend_from_slice(&source.points);
    }
}

/// The numbers given to the contacts of one pair, each once.
///
/// It outlives the contacts: a contact that ended and comes back gets a new number. A pair that owns
/// several manifolds passes one counter through all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct PairIds {
    given: u32,
}

impl PairIds {
    /// A number not given before. After four billion numbers they start again.
    pub(crate) fn next(&mut self) -> u32 {
        let number = self.given;
        self.given = number.wrapping_add(1);
        number
    }
}

impl<N: Real, const D: usize> Default for RawManifold<N, D> {
    fn default() -> Self {
        let (normal, points) = (Vector::<N, D>::zeros(), SmallVec::new());
        Self { normal, points, ids: PairIds::default(), pose12: None }
    }
}

impl<N: Real, const D: usize> RawManifold<N, D> {
    /// Puts the points in the order of their numbers: few, and most are.
    #[inline(never)]
    pub(crate) fn sort_points(&mut self) {
        for next in 1..self.points.len() {
            let mut at = next;
            while at > 0 && self.points[at].id < self.points[at - 1].id {
                self.points.swap(at - 1, at);
                at -= 1;
            }
        }
    }

    /// The same contacts with the second solid first; `pose21` is how the solids lie now, the first in the frame of the
    /// second. Where the old pose is not kept, the points stay where they are on the first solid.
    pub(crate) fn flip(&mut self, pose21: &Pose<N, D>) {
        let Self { normal, pose12, points, .. } = self;
        let old21 = pose12.as_ref().map_or(*pose21, Pose::inverse);
        points.iter_mut().for_each(|point| point.flip(&old21, normal));
        *normal = -old21.vector(normal);
        *pose12 = pose12.map(|_| old21);
    }

    /// The index of the deepest point, the first of equals; 0 for an empty manifold.
    #[cfg(test)]
    pub(crate) fn deepest(&self) -> usize {
        let mut deepest = 0;
        for (index, point) in self.points.iter().enumerate() {
            if point.distance < self.points[deepest].distance {
                deepest = index;
            }
        }
        deepest
    }
}
