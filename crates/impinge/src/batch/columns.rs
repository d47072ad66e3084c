//! Output columns: one column for each component of a result, in the caller's memory.

use super::BatchError;
use crate::chunks::Cut;
use crate::convex::Separation;
use crate::math::{Point, Real, Vector};
use crate::query::{
    Contact, Impact, ImpactStatus, PointLocation, PointProjection, RayIntersection, Witness,
};
use crate::shape::FeatureId;

/// The feature that is written for an element without a result.
pub const NO_FEATURE: FeatureId = FeatureId::Face(u32::MAX);

/// The part index that is written for an element without a result.
const NO_PART: u32 = u32::MAX;

/// Output columns of a batch that can be split into chunks.
pub(super) trait AnswerColumns: Cut {
    /// Returns [`BatchError::Length`] unless each column has `len` slots; an optional column may
    /// also be empty.
    fn check(&self, len: usize) -> Result<(), BatchError>;
}

/// The column of a query that computes one value for each element. It is not optional: it must have
/// a slot for each element.
impl<T: Send> AnswerColumns for &mut [T] {
    fn check(&self, len: usize) -> Result<(), BatchError> {
        as_long_as(len, "out", self)
    }
}

/// Returns [`BatchError::Length`] with the name `argument` unless `array` has `needed` elements.
pub(super) const fn as_long_as<T>(
    needed: usize,
    argument: &'static str,
    array: &[T],
) -> Result<(), BatchError> {
    let given = array.len();
    if given == needed { Ok(()) } else { Err(BatchError::Length { argument, given, needed }) }
}

/// Implements [`Cut`] and [`AnswerColumns`] for a struct of columns, each of which may be empty.
macro_rules! columns {
    ($name:ident<$($parameter:ident),+> [$($generics:tt)+]: $($field:ident),+) => {
        impl<'a, $($generics)+> Cut for $name<'a, $($parameter),+> {
            #[inline]
            fn cut(self, at: usize) -> (Self, Self) {
                $(let $field = self.$field.cut(at);)+
                (Self { $($field: $field.0),+ }, Self { $($field: $field.1),+ })
            }
        }

        impl<$($generics)+> AnswerColumns for $name<'_, $($parameter),+> {
            fn check(&self, len: usize) -> Result<(), BatchError> {
                $(if !self.$field.is_empty() {
                    as_long_as(len, stringify!($field), self.$field)?;
                })+
                Ok(())
            }
        }
    };
}

/// Output columns of [`PairBatch::closest_points`](super::PairBatch::closest_points).
///
/// Points lie on the surfaces of the solids and are in the world frame.
///
/// ```
/// use impinge::dim2::batch::ClosestColumns;
///
/// let mut distance = vec![0.0_f32; 100];
/// let wanted = ClosestColumns { distance: &mut distance, ..Default::default() };
/// assert!(wanted.point1.is_empty(), "not wanted");
/// ```
#[derive(Debug, Default)]
pub struct ClosestColumns<'a, N: Real, const D: usize> {
    /// The distance of the solids: zero if they touch or overlap, infinite beyond the maximum
    /// distance.
    pub distance: &'a mut [N],
    /// The nearest point of the first solid; NaN if the solids touch, overlap, or are beyond the
    /// maximum distance.
    pub point1: &'a mut [[N; D]],
    /// The nearest point of the second solid; NaN if the solids touch, overlap, or are beyond the
    /// maximum distance.
    pub point2: &'a mut [[N; D]],
}

columns!(ClosestColumns<N, D> [N: Real, const D: usize]: distance, point1, point2);

impl<N: Real, const D: usize> ClosestColumns<'_, N, D> {
    #[inline]
    pub(super) fn put(&mut self, slot: usize, found: Option<&Separation<N, D>>) {
        let apart = found.filter(|found| found.distance > N::ZERO);
        let distance = apart.map_or(N::ZERO, |found| found.distance);
        put(self.distance, slot, if found.is_some() { distance } else { N::INFINITY });
        put(self.point1, slot, array(apart.map(|found| found.point1)));
        put(self.point2, slot, array(apart.map(|found| found.point2)));
    }
}

/// Output columns of [`PairBatch::witnesses`](super::PairBatch::witnesses).
///
/// ```
/// use impinge::dim3::batch::WitnessColumns;
///
/// let (mut distance, mut part2) = (vec![0.0_f64; 8], vec![0; 8]);
/// let wanted = WitnessColumns { distance: &mut distance, part2: &mut part2, ..Default::default() };
/// assert!(wanted.normal.is_empty(), "not wanted");
/// ```
#[derive(Debug, Default)]
pub struct WitnessColumns<'a, N: Real, const D: usize> {
    /// The signed distance of the shapes, negative where they overlap; infinite beyond the maximum
    /// distance.
    pub distance: &'a mut [N],
    /// The nearest or deepest point of the first shape, on its surface and in the world frame.
    pub point1: &'a mut [[N; D]],
    /// The nearest or deepest point of the second shape, on its surface and in the world frame.
    pub point2: &'a mut [[N; D]],
    /// The unit vector from the first shape to the second, in the world frame.
    pub normal: &'a mut [[N; D]],
    /// The index of the part of the first shape; 0 for a convex solid.
    pub part1: &'a mut [u32],
    /// The index of the part of the second shape; 0 for a convex solid.
    pub part2: &'a mut [u32],
    /// The feature of the first shape's part on which `point1` lies.
    pub feature1: &'a mut [FeatureId],
    /// The feature of the second shape's part on which `point2` lies.
    pub feature2: &'a mut [FeatureId],
}

columns!(
    WitnessColumns<N, D> [N: Real, const D: usize]:
    distance, point1, point2, normal, part1, part2, feature1, feature2
);

impl<N: Real, const D: usize> WitnessColumns<'_, N, D> {
    #[inline]
    pub(super) fn put(&mut self, slot: usize, found: Option<&Witness<N, D>>) {
        put(self.distance, slot, found.map_or(N::INFINITY, |found| found.distance));
        put(self.point1, slot, array(found.map(|found| found.point1)));
        put(self.point2, slot, array(found.map(|found| found.point2)));
        put(self.normal, slot, array(found.map(|found| Point::from(*found.normal))));
        put(self.part1, slot, found.map_or(NO_PART, |found| found.part1));
        put(self.part2, slot, found.map_or(NO_PART, |found| found.part2));
        put(self.feature1, slot, found.map_or(NO_FEATURE, |found| found.feature1));
        put(self.feature2, slot, found.map_or(NO_FEATURE, |found| found.feature2));
    }
}

/// Output columns of [`PairBatch::contacts`](super::PairBatch::contacts).
///
/// ```
/// use impinge::dim3::batch::ContactColumns;
///
/// let mut depth = vec![0.0_f64; 8];
/// let wanted = ContactColumns { depth: &mut depth, ..Default::default() };
/// assert!(wanted.normal.is_empty(), "not wanted");
/// ```
#[derive(Debug, Default)]
pub struct ContactColumns<'a, N: Real, const D: usize> {
    /// The penetration along the normal, or minus the distance if the solids are disjoint; minus
    /// infinity without a contact.
    pub depth: &'a mut [N],
    /// The unit vector from the first solid to the second, in the world frame.
    pub normal: &'a mut [[N; D]],
    /// The point on the surface of the first solid, in the world frame.
    pub point1: &'a mut [[N; D]],
    /// The point on the surface of the second solid, in the world frame.
    pub point2: &'a mut [[N; D]],
}

columns!(ContactColumns<N, D> [N: Real, const D: usize]: depth, normal, point1, point2);

impl<N: Real, const D: usize> ContactColumns<'_, N, D> {
    #[inline]
    pub(super) fn put(&mut self, slot: usize, found: Option<&Contact<N, D>>) {
        put(self.depth, slot, found.map_or(-N::INFINITY, |found| found.depth));
        put(self.normal, slot, array(found.map(|found| Point::from(*found.normal))));
        put(self.point1, slot, array(found.map(|found| found.world1)));
        put(self.point2, slot, array(found.map(|found| found.world2)));
    }
}

/// Output columns of [`PairBatch::impacts`](super::PairBatch::impacts).
///
/// ```
/// use impinge::dim2::batch::ImpactColumns;
///
/// let (mut time, mut status) = (vec![0.0_f64; 8], vec![None; 8]);
/// let wanted = ImpactColumns { time: &mut time, status: &mut status, ..Default::default() };
/// assert!(wanted.normal.is_empty(), "not wanted");
/// ```
#[derive(Debug, Default)]
pub struct ImpactColumns<'a, N: Real, const D: usize> {
    /// The time at which the solids first touch, or reach the target distance of the options; zero
    /// or more, infinite without an impact.
    pub time: &'a mut [N],
    /// The unit vector from the first solid to the second at that time, in the world frame.
    pub normal: &'a mut [[N; D]],
    /// The point on the surface of the first solid at that time, in the world frame.
    pub point1: &'a mut [[N; D]],
    /// The point on the surface of the second solid at that time, in the world frame.
    pub point2: &'a mut [[N; D]],
    /// The index of the first shape's part that touches the second shape; 0 for a convex solid.
    pub part1: &'a mut [u32],
    /// The index of the second shape's part that touches the first shape; 0 for a convex solid.
    pub part2: &'a mut [u32],
    /// The reliability of the impact; `None` without an impact.
    pub status: &'a mut [Option<ImpactStatus>],
}

columns!(
    ImpactColumns<N, D> [N: Real, const D: usize]:
    time, normal, point1, point2, part1, part2, status
);

impl<N: Real, const D: usize> ImpactColumns<'_, N, D> {
    #[inline]
    pub(super) fn put(&mut self, slot: usize, found: Option<&Impact<N, D>>) {
        put(self.time, slot, found.map_or(N::INFINITY, |found| found.toi));
        put(self.normal, slot, array(found.map(|found| Point::from(*found.normal))));
        put(self.point1, slot, array(found.map(|found| found.world1)));
        put(self.point2, slot, array(found.map(|found| found.world2)));
        put(self.part1, slot, found.map_or(NO_PART, |found| found.part1));
        put(self.part2, slot, found.map_or(NO_PART, |found| found.part2));
        put(self.status, slot, found.map(|found| found.status));
    }
}

/// Output columns of [`PointBatch::project`](super::PointBatch::project).
///
/// ```
/// use impinge::dim3::batch::ProjectionColumns;
///
/// let mut is_inside = vec![false; 8];
/// let wanted = ProjectionColumns::<f32> { is_inside: &mut is_inside, ..Default::default() };
/// assert!(wanted.point.is_empty(), "not wanted");
/// ```
#[derive(Debug, Default)]
pub struct ProjectionColumns<'a, N: Real, const D: usize> {
    /// The projection of the query point onto the shape, or onto its boundary, in the world frame.
    pub point: &'a mut [[N; D]],
    /// Whether the query point lies in the shape or on its boundary; `false` without a result.
    pub is_inside: &'a mut [bool],
    /// The index of the composite's part on which the nearest point lies; 0 for a convex solid.
    pub part: &'a mut [u32],
    /// The feature of the part on which the nearest point lies.
    pub feature: &'a mut [FeatureId],
}

columns!(ProjectionColumns<N, D> [N: Real, const D: usize]: point, is_inside, part, feature);

impl<N: Real, const D: usize> ProjectionColumns<'_, N, D> {
    #[inline]
    pub(super) fn put(
        &mut self,
        slot: usize,
        found: Option<&(PointProjection<N, D>, PointLocation<N>)>,
    ) {
        put(self.point, slot, array(found.map(|(nearest, _)| nearest.point)));
        put(self.is_inside, slot, found.is_some_and(|(nearest, _)| nearest.is_inside));
        put(self.part, slot, found.map_or(NO_PART, |(_, location)| location.part));
        put(self.feature, slot, found.map_or(NO_FEATURE, |(_, location)| location.feature));
    }
}

/// Output columns of [`RayColumns::cast`](super::RayColumns::cast).
///
/// ```
/// use impinge::dim3::batch::HitColumns;
///
/// let mut time = vec![0.0_f32; 8];
/// let wanted = HitColumns { time: &mut time, ..Default::default() };
/// assert!(wanted.normal.is_empty(), "not wanted");
/// ```
#[derive(Debug, Default)]
pub struct HitColumns<'a, N: Real, const D: usize> {
    /// The time `t` of the hit, at the point `origin + t * direction` of the ray; infinite without
    /// a hit.
    pub time: &'a mut [N],
    /// The outward unit normal of the shape at the hit, in the world frame; zero if shapes count as
    /// solid and the ray starts inside, NaN without a hit.
    pub normal: &'a mut [[N; D]],
    /// The index of the composite's part that is hit; 0 for a convex solid.
    pub part: &'a mut [u32],
    /// The feature of the hit part that contains the point of the hit.
    pub feature: &'a mut [FeatureId],
}

columns!(HitColumns<N, D> [N: Real, const D: usize]: time, normal, part, feature);

impl<N: Real, const D: usize> HitColumns<'_, N, D> {
    #[inline]
    pub(super) fn put(&mut self, slot: usize, found: Option<&RayIntersection<N, D>>) {
        put(self.time, slot, found.map_or(N::INFINITY, |found| found.toi));
        put(self.normal, slot, array(found.map(|found| Point::from(found.normal))));
        put(self.part, slot, found.map_or(NO_PART, |found| found.part));
        put(self.feature, slot, found.map_or(NO_FEATURE, |found| found.feature));
    }
}

/// Writes `value` to a slot; does nothing if the column is empty.
#[inline]
fn put<T>(column: &mut [T], slot: usize, value: T) {
    if let Some(element) = column.get_mut(slot) {
        *element = value;
    }
}

/// Returns the coordinates of a point as an array; NaN for `None`.
#[inline]
fn array<N: Real, const D: usize>(point: Option<Point<N, D>>) -> [N; D] {
    let nowhere = || Vector::<N, D>::repeat(N::lit(f64::NAN));
    point.map_or_else(nowhere, |point| point.coords).into()
}
