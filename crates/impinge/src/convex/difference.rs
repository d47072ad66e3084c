//! Difference of two cores as one convex set, in units in which its size is about 1.

use super::peak::{Peak, Peaks};
use super::{Separation, Units};
use crate::math::{Matrix, Point, Pose, Real, Vector, max, max_component, unit_or};
use crate::shape::SupportMap;

/// Returns the bound of arithmetic rounding errors, in units of the pair.
pub(super) fn rounding_error<N: Real>() -> N {
    N::lit(8.0) * N::EPSILON
}

/// Returns the largest difference of the upper and the lower bound of the distance, in units of the
/// pair, at which Newton's method may refine a normal: 2⁻²⁰ in `f32`, 2⁻⁴⁰ in `f64`.
///
/// Only curved cores leave such a gap: searches of flat-faced cores end after finitely many steps,
/// with a gap of rounding error.
pub(super) fn tolerance<N: Real>() -> N {
    max(rounding_error(), N::lit(1.0 / 1_099_511_627_776.0))
}

/// A point of the difference, and the points of the two cores that it comes from.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Vertex<N: Real, const D: usize> {
    /// `on2 − on1`.
    pub(super) point: Vector<N, D>,
    pub(super) on1: Vector<N, D>,
    pub(super) on2: Vector<N, D>,
}

impl<N: Real, const D: usize> Vertex<N, D> {
    /// Returns the vertex at the origin, as a placeholder in arrays.
    pub(super) fn zero() -> Self {
        let zero = Vector::<N, D>::zeros();
        Self { point: zero, on1: zero, on2: zero }
    }
}

/// A point of one core that is extreme along a normal, and the derivative of this point with
/// respect to the normal.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Branch<N: Real, const D: usize> {
    pub(super) is_second: bool,
    pub(super) on: Vector<N, D>,
    /// Derivative of `on` with respect to the outward normal of the core, in units of the pair;
    /// `None` for a corner, which does not move.
    pub(super) bend: Option<Matrix<N, D>>,
}

/// A convex set of differences `b − a`, given by its support points.
pub(crate) trait Difference<N: Real, const D: usize> {
    /// Returns the point of the set that is lowest along the unit vector `normal`.
    fn lowest(&self, normal: &Vector<N, D>) -> Vertex<N, D>;

    /// Returns whether both cores are hulls of points. There are then no round faces, and no branch
    /// has a `bend`.
    fn is_flat(&self) -> bool;

    /// Returns whether neither core has edges or rims, except that one may be a segment. Then local
    /// maxima of the height are far apart.
    fn is_smooth(&self) -> bool {
        false
    }

    /// Returns, for each core, the normal of its flat round face that may be close to `normal`, as
    /// a direction from the first core to the second; `None` for a core without such a face.
    fn round_faces(&self, normal: &Vector<N, D>) -> [Option<Vector<N, D>>; 2];

    /// Returns, for each core, the axis of its round side and the component of the side's normals
    /// along the axis, as directions from the first core to the second; `None` for a core without a
    /// round side.
    fn round_sides(&self) -> [Option<(Vector<N, D>, N)>; 2] {
        [None, None]
    }

    /// Returns the extreme point on the part of one core that contains `on`: the highest point
    /// along the unit vector `normal` for the first core, the lowest for the second.
    fn branch(&self, is_second: bool, on: &Vector<N, D>, normal: &Vector<N, D>) -> Branch<N, D>;

    /// Returns the best normal of a difference that contains the origin; `None` if no [`Peaks`] are
    /// known, or if they leave the choice to a search.
    fn peak(&self) -> Option<Peak<N, D>> {
        None
    }
}

/// The cores of two solids, in the frame of the first, in their common [`Units`].
pub(super) struct CorePair<'a, N: Real, A: ?Sized, B: ?Sized, const D: usize> {
    solid1: &'a A,
    solid2: &'a B,
    rotation: Matrix<N, D>,
    translation: Vector<N, D>,
    scale: N,
    /// 1 / `scale`, exactly.
    shrink: N,
    is_flat: bool,
    is_smooth: bool,
    peaks: Option<&'a dyn Peaks<N, D>>,
}

/// Returns a solid's bounding radius around its origin. If its square overflows or underflows,
/// returns the largest absolute coordinate of the support points along the axes instead.
pub(crate) fn safe_reach<N: Real, S: SupportMap<N, D> + ?Sized, const D: usize>(solid: &S) -> N {
    let reach = solid.reach();
    if reach.is_finite_number() && reach * reach > N::MIN_POSITIVE {
        return reach;
    }
    let mut largest = N::ZERO;
    for axis in 0..D {
        let mut direction = Vector::<N, D>::zeros();
        direction[axis] = N::ONE;
        largest = max(max_component(&solid.core_support(&direction).coords), largest);
        largest = max(max_component(&solid.core_support(&-direction).coords), largest);
    }
    largest
}

impl<'a, N, A, B, const D: usize> CorePair<'a, N, A, B, D>
where
    N: Real,
    A: SupportMap<N, D> + ?Sized,
    B: SupportMap<N, D> + ?Sized,
{
    /// Creates the pair of cores; `None` if the pose is not finite.
    pub(super) fn new(solid1: &'a A, solid2: &'a B, pose12: &Pose<N, D>) -> Option<Self> {
        if !pose12.is_finite() {
            return None;
        }
        let reaches = (safe_reach(solid1), safe_reach(solid2));
        let Units { scale, shrink } = Units::of(reaches.0, reaches.1, &pose12.translation);
        Some(Self {
            solid1,
            solid2,
            rotation: pose12.rotation,
            translation: pose12.translation * shrink,
            scale,
            shrink,
            is_flat: false,
            is_smooth: false,
            peaks: None,
        })
    }

    /// Declares that both cores are hulls of points.
    pub(super) fn between_flat_cores(self) -> Self {
        Self { is_flat: true, ..self }
    }

    /// Declares that the cores have neither edges nor rims, except that one may be a segment.
    pub(super) fn between_smooth_cores(self) -> Self {
        Self { is_smooth: true, ..self }
    }

    /// Adds a known set of possible normals, which is used if the cores overlap.
    pub(super) fn with_peaks(self, peaks: &'a dyn Peaks<N, D>) -> Self {
        Self { peaks: Some(peaks), ..self }
    }

    /// Returns the length of one unit, in the units of the caller.
    pub(super) fn scale(&self) -> N {
        self.scale
    }

    /// Returns a first guess of the normal: from the centre of the first core to the centre of the
    /// second, or the first axis if both coincide.
    pub(super) fn start(&self) -> Vector<N, D> {
        let middle2 = self.rotation * (self.solid2.center().coords * self.shrink);
        let away = middle2 + self.translation - self.solid1.center().coords * self.shrink;
        let mut first_axis = Vector::<N, D>::zeros();
        first_axis[0] = N::ONE;
        unit_or(&away, first_axis)
    }

    /// Converts a separation from units of the pair to units of the caller.
    pub(super) fn restored(&self, found: &Separation<N, D>) -> Separation<N, D> {
        found.scaled(self.scale)
    }
}

impl<N, A, B, const D: usize> Difference<N, D> for CorePair<'_, N, A, B, D>
where
    N: Real,
    A: SupportMap<N, D> + ?Sized,
    B: SupportMap<N, D> + ?Sized,
{
    #[inline]
    fn lowest(&self, normal: &Vector<N, D>) -> Vertex<N, D> {
        let on1 = self.solid1.core_support(normal).coords * self.shrink;
        let toward1 = self.rotation.tr_mul(&-normal);
        let local2 = self.solid2.core_support(&toward1).coords * self.shrink;
        let on2 = self.rotation * local2 + self.translation;
        Vertex { point: on2 - on1, on1, on2 }
    }

    fn is_flat(&self) -> bool {
        self.is_flat
    }

    fn is_smooth(&self) -> bool {
        self.is_smooth
    }

    fn round_faces(&self, normal: &Vector<N, D>) -> [Option<Vector<N, D>>; 2] {
        let toward1 = self.rotation.tr_mul(&-normal);
        let face2 = self.solid2.round_face(&toward1);
        [self.solid1.round_face(normal), face2.map(|face| -(self.rotation * face))]
    }

    fn round_sides(&self) -> [Option<(Vector<N, D>, N)>; 2] {
        let side2 = self.solid2.round_side();
        [self.solid1.round_side(), side2.map(|(axis, rise)| (-(self.rotation * axis), rise))]
    }

    fn branch(&self, is_second: bool, on: &Vector<N, D>, normal: &Vector<N, D>) -> Branch<N, D> {
        let corner = Branch { is_second, on: *on, bend: None };
        if is_second {
            let local = self.rotation.tr_mul(&(on - self.translation)) * self.scale;
            let toward1 = self.rotation.tr_mul(&-normal);
            let curved = self.solid2.curved_support(&Point::from(local), &toward1);
            return curved.map_or(corner, |found| {
                let bend = rotated_symmetric(&self.rotation, &(found.bend * self.shrink));
                let on = self.rotation * (found.point.coords * self.shrink) + self.translation;
                Branch { on, bend: Some(bend), ..corner }
            });
        }
        let local = Point::from(on * self.scale);
        let curved = self.solid1.curved_support(&local, normal);
        curved.map_or(corner, |found| Branch {
            on: found.point.coords * self.shrink,
            bend: Some(found.bend * self.shrink),
            ..corner
        })
    }

    fn peak(&self) -> Option<Peak<N, D>> {
        self.peaks?.best(self.shrink, rounding_error())
    }
}

/// Rotates a symmetric matrix: `R S Rᵀ`.
///
/// Written as loops, since products of small matrices are not inlined.
fn rotated_symmetric<N: Real, const D: usize>(
    rotation: &Matrix<N, D>,
    symmetric: &Matrix<N, D>,
) -> Matrix<N, D> {
    let product = |a: &Matrix<N, D>, i: usize, b: &Matrix<N, D>, j: usize| {
        (0..D).fold(N::ZERO, |sum, k| sum + a[(i, k)] * b[(j, k)])
    };
    let half = Matrix::<N, D>::from_fn(|i, j| product(rotation, i, symmetric, j));
    Matrix::<N, D>::from_fn(|i, j| product(&half, i, rotation, j))
}

/// A difference translated by `by`; the points of the cores are not moved.
pub(super) struct Moved<'a, N: Real, const D: usize> {
    pub(super) inner: &'a dyn Difference<N, D>,
    pub(super) by: Vector<N, D>,
}

impl<N: Real, const D: usize> Difference<N, D> for Moved<'_, N, D> {
    fn lowest(&self, normal: &Vector<N, D>) -> Vertex<N, D> {
        let vertex = self.inner.lowest(normal);
        Vertex { point: vertex.point + self.by, ..vertex }
    }

    fn is_flat(&self) -> bool {
        self.inner.is_flat()
    }

    fn round_faces(&self, normal: &Vector<N, D>) -> [Option<Vector<N, D>>; 2] {
        self.inner.round_faces(normal)
    }

    fn branch(&self, is_second: bool, on: &Vector<N, D>, normal: &Vector<N, D>) -> Branch<N, D> {
        self.inner.branch(is_second, on, normal)
    }
}
