//! How a contact moves with its solids, to first order and without a new query.

use crate::math::{Point, Real, Vector};
use crate::shape::FeatureId;

/// What the core of a solid looks like near a contact, in its local frame.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum NeighborhoodGeometry<N: Real, const D: usize> {
    /// A point that moves with the solid.
    Point,
    /// A line along this unit vector.
    Line(Vector<N, D>),
    /// A flat piece with this outward unit normal.
    Plane(Vector<N, D>),
}

/// What it takes to predict a contact for new poses of its two solids.
///
/// All in the local frames of the solids, on their cores; the rounding radii are added at the end.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ContactKinematic<N: Real, const D: usize> {
    pub(crate) feature1: FeatureId,
    pub(crate) feature2: FeatureId,
    pub(crate) local1: Point<N, D>,
    pub(crate) local2: Point<N, D>,
    pub(crate) geometry1: NeighborhoodGeometry<N, D>,
    pub(crate) geometry2: NeighborhoodGeometry<N, D>,
    pub(crate) rounding1: N,
    pub(crate) rounding2: N,
    /// The normal from the first solid to the second, in the frame of the first: used where the
    /// geometry defines none.
    pub(crate) normal1: Vector<N, D>,
}
