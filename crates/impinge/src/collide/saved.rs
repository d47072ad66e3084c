//! Serialized form of the contact manifolds in saved worlds.

use serde::{Deserialize, Serialize};

use super::{PairIds, RawManifold, RawPoint};
use crate::math::Real;
use crate::math::numbers::{Damage, NumberSource, Numbers};
use crate::shape::FeatureId;

/// Features, id and code of a contact point. Its coordinates and distance are in the manifold's
/// list of numbers.
#[derive(Clone, Copy, Debug, Serialize, Deserialize)]
pub(crate) struct PointRecord {
    features: [FeatureId; 2],
    id: u32,
    code: u32,
}

impl PointRecord {
    /// Returns the record of a point, and appends its position and distance to `numbers`.
    pub(super) fn of<N: Real, const D: usize>(
        point: &RawPoint<N, D>,
        numbers: &mut Numbers<N>,
    ) -> Self {
        numbers.extend(&point.point1.coords);
        numbers.extend(&[point.distance]);
        let RawPoint { feature1, feature2, id, code, .. } = *point;
        Self { features: [feature1, feature2], id, code }
    }

    pub(super) fn restore<N: Real, const D: usize>(
        &self,
        numbers: &mut NumberSource<'_, N>,
    ) -> Result<RawPoint<N, D>, Damage> {
        let Self { features: [feature1, feature2], id, code } = *self;
        let (point1, distance) = (numbers.point()?, numbers.number()?);
        Ok(RawPoint { point1, distance, feature1, feature2, id, code })
    }
}

/// Serialized form of a [`RawManifold`].
#[derive(Debug, Serialize, Deserialize)]
#[serde(bound = "")]
pub(crate) struct ManifoldRecord<N: Real> {
    ids: PairIds,
    /// The normal, then the position and distance of each point, then the pose if `has_pose` is
    /// true.
    numbers: Numbers<N>,
    points: Vec<PointRecord>,
    has_pose: bool,
}

impl<N: Real, const D: usize> RawManifold<N, D> {
    /// Returns the serialized form of the manifold.
    pub(crate) fn record(&self) -> ManifoldRecord<N> {
        let Self { normal, ids, points, pose12 } = self;
        let mut numbers = Numbers::of(normal.iter().copied());
        let points = points.iter().map(|point| PointRecord::of(point, &mut numbers)).collect();
        pose12.iter().for_each(|pose| numbers.extend_pose(pose));
        ManifoldRecord { ids: *ids, numbers, points, has_pose: pose12.is_some() }
    }
}

impl<N: Real> ManifoldRecord<N> {
    /// Rebuilds the manifold; fails if there are too few or too many numbers.
    pub(crate) fn restore<const D: usize>(&self) -> Result<RawManifold<N, D>, Damage> {
        self.numbers.all(|numbers| {
            let normal = numbers.vector()?;
            let points = self.points.iter().map(|point| point.restore(numbers));
            let points = points.collect::<Result<_, _>>()?;
            let pose12 = if self.has_pose { Some(numbers.pose()?) } else { None };
            Ok(RawManifold { normal, ids: self.ids, points, pose12 })
        })
    }
}
