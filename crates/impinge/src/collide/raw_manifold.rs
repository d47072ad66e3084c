//! Contact manifolds in the form stored by the narrow phase: compact, in the frame of the first
//! solid.
//!
//! ```text
//!   RawManifold  normal | ids | points: [RawPoint; 4 inline] ...      sorted by id
//!   RawPoint     point1 | distance | feature1, feature2 | id | code
//!                point2 = point1 + normal · distance
//! ```
//!
//! The `code` of a point of a box pair identifies its features and its slot in a batch
//! (`collide/batch/boxes/choose.rs`). A code of 0 means that both are unknown. A function that
//! creates a point of a convex pair, or changes its features, must set `code` to 0, because the
//! batch kernels rely on it. Points of composite pieces (`mesh/scene.rs`) may keep a code that does
//! not match their features; no kernel reads these codes.

use smallvec::SmallVec;

use crate::math::{Point, Pose, Real, Vector};
use crate::shape::FeatureId;

/// Parameters of the computation of a manifold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct ManifoldRequest<N: Real> {
    /// Largest distance of a contact point, zero or more. Farther points are dropped unless `sine`
    /// admits them.
    pub(crate) prediction: N,
    /// Sine of the angle by which the solids may rotate. A point is also kept if a rotation by that
    /// angle about the nearest point would bring it within `prediction`.
    pub(crate) sine: N,
    /// Largest number of points.
    pub(crate) max_points: usize,
}

impl<N: Real> ManifoldRequest<N> {
    /// Makes the request for solids that may rotate by `angle` radians. Angles above a right angle
    /// count as a right angle, where the sine is largest; a negative angle or NaN counts as zero.
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

/// A contact point: `point1` on the first solid, `point1 + normal · distance` on the second.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct RawPoint<N: Real, const D: usize> {
    pub(crate) point1: Point<N, D>,
    /// Signed distance along the manifold's normal: negative for an overlap.
    pub(crate) distance: N,
    pub(crate) feature1: FeatureId,
    pub(crate) feature2: FeatureId,
    /// Id of the contact within its pair of solids; constant while the contact lasts.
    pub(crate) id: u32,
    /// Code of the point's features for the batch kernels of boxes; 0 for points of other builders.
    pub(crate) code: u32,
}

/// Points of many manifolds in one list; each manifold has a range of indices.
pub(crate) type RawPoints<N, const D: usize> = SmallVec<[RawPoint<N, D>; 32]>;

impl<N: Real, const D: usize> RawPoint<N, D> {
    /// Swaps the solids: sets `point1` to the contact point on the second solid, in the frame of
    /// the second solid, swaps the features and clears the code. `pose21` is the pose of the first
    /// solid in that frame; `normal` still points from the first solid to the second.
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

/// Contact points with a common normal, in the frame of the first solid. The order of the fields is
/// fixed, so that the normal, the ids and the first points are adjacent in memory.
#[derive(Debug, PartialEq)]
#[repr(C)]
pub(crate) struct RawManifold<N: Real, const D: usize> {
    /// Unit vector from the first solid to the second.
    pub(crate) normal: Vector<N, D>,
    /// Source of the ids of new points.
    pub(crate) ids: PairIds,
    /// Contact points, sorted by id. Empty if the solids are farther apart than the prediction.
    pub(crate) points: SmallVec<[RawPoint<N, D>; 4]>,
    /// Pose of the second solid in the frame of the first when the points were computed; it gives
    /// the positions of old points on the second solid. `None` for pairs of balls, boxes, segments
    /// and capsules, whose kernels store no pose, and for a manifold that has only the nearest
    /// points.
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

/// Counter that assigns the ids of the contacts of one pair.
///
/// The counter outlives the contacts: a contact that ended and comes back gets a new id. A pair
/// with several manifolds passes one counter through all of them.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub(crate) struct PairIds {
    given: u32,
}

impl PairIds {
    /// Returns the next id; ids repeat after 2³² calls.
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
    /// Sorts the points by id, by insertion: there are few points, and they are mostly sorted.
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

    /// Swaps the solids; `pose21` is the current pose of the first in the frame of the second. The
    /// points are transformed by the inverse of `pose12`, or by `pose21` if `pose12` is `None`.
    pub(crate) fn flip(&mut self, pose21: &Pose<N, D>) {
        let Self { normal, pose12, points, .. } = self;
        let old21 = pose12.as_ref().map_or(*pose21, Pose::inverse);
        points.iter_mut().for_each(|point| point.flip(&old21, normal));
        *normal = -old21.vector(normal);
        *pose12 = pose12.map(|_| old21);
    }

    /// Returns the index of the deepest point, the first in a tie; 0 for an empty manifold.
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
