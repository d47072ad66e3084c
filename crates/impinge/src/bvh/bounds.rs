//! The boxes of trees: `f32`, rounded outwards.

use crate::bounding_volume::Aabb;
use crate::math::{Mapped, Point, Real, Vector, filled};

/// A box of the tree: the points with `lo ≤ x ≤ hi` on every axis.
///
/// It encloses a box with coordinates of type `N`: each face is rounded outwards to an `f32`. So
/// the enclosures of touching boxes touch. A face of a box in a tree is never NaN.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Bounds<const D: usize> {
    /// The least coordinate, by axis.
    pub lo: [f32; D],
    /// The greatest coordinate, by axis.
    pub hi: [f32; D],
}

impl<const D: usize> Bounds<D> {
    /// The empty set: overlaps no bounded box, and is neutral in unions.
    pub const EMPTY: Self = Self { lo: [f32::INFINITY; D], hi: [f32::NEG_INFINITY; D] };

    /// A box that overlaps nothing, not even an unbounded box: the old box of a new object.
    pub const NOWHERE: Self = Self { lo: [f32::NAN; D], hi: [f32::NAN; D] };

    /// Returns the smallest `f32` box around a box with coordinates of type `N`. Zeros lose their
    /// sign.
    #[inline]
    #[must_use]
    pub fn enclosing<N: Real>(aabb: &Aabb<N, D>) -> Self {
        Self {
            lo: filled(|axis| aabb.mins()[axis].as_f32_below()),
            hi: filled(|axis| aabb.maxs()[axis].as_f32_above()),
        }
    }

    /// Returns the smallest `f32` box around a point.
    #[must_use]
    pub fn enclosing_point<N: Real>(point: &Point<N, D>) -> Self {
        Self {
            lo: filled(|axis| point[axis].as_f32_below()),
            hi: filled(|axis| point[axis].as_f32_above()),
        }
    }

    /// Returns the box with coordinates in `N`; `None` if a coordinate is NaN or `lo > hi` on an
    /// axis.
    #[cfg(feature = "debug_render")]
    pub(crate) fn to_aabb<N: Real>(self) -> Option<Aabb<N, D>> {
        let [lo, hi] = [self.lo, self.hi].mapped(|side| side.mapped(|x| N::lit(f64::from(x))));
        Aabb::try_new(lo.into(), hi.into()).ok()
    }

    /// Returns `true` if the boxes have a common point, as boxes that only touch do. Wrongly `true`
    /// for an empty and an unbounded box, whose infinities compare equal: callers clamp the
    /// unbounded one.
    #[inline]
    #[must_use]
    pub fn overlaps(&self, other: &Self) -> bool {
        let mut all = true;
        for axis in 0..D {
            all &= (self.lo[axis] <= other.hi[axis]) & (other.lo[axis] <= self.hi[axis]);
        }
        all
    }

    /// Returns `true` if every point of `other` is in this box.
    #[inline]
    #[must_use]
    pub fn contains(&self, other: &Self) -> bool {
        let mut all = true;
        for axis in 0..D {
            all &= (self.lo[axis] <= other.lo[axis]) & (other.hi[axis] <= self.hi[axis]);
        }
        all
    }

    /// Returns the smallest box around both.
    #[must_use]
    pub fn merged(&self, other: &Self) -> Self {
        let smaller = |a: f32, b: f32| if a < b { a } else { b };
        let larger = |a: f32, b: f32| if a > b { a } else { b };
        Self {
            lo: filled(|axis| smaller(self.lo[axis], other.lo[axis])),
            hi: filled(|axis| larger(self.hi[axis], other.hi[axis])),
        }
    }

    /// Returns `true` if every face is finite.
    #[inline]
    #[must_use]
    pub fn is_finite(&self) -> bool {
        let mut all = true;
        for axis in 0..D {
            all &= self.lo[axis].is_finite() & self.hi[axis].is_finite();
        }
        all
    }

    /// Returns the largest magnitude of a coordinate; zero if a face is not finite.
    #[inline]
    pub(super) fn size(&self) -> f32 {
        let larger = |a: f32, b: f32| if a > b { a } else { b };
        let most = (0..D)
            .fold(0.0, |most, axis| larger(larger(self.lo[axis].abs(), self.hi[axis].abs()), most));
        if self.is_finite() { most } else { 0.0 }
    }

    /// Returns the box with infinite faces replaced by `±f32::MAX`. As a query the result is
    /// equivalent to this box, since boxes in a tree are finite.
    ///
    /// A NaN or inverted box becomes empty.
    #[must_use]
    pub fn clamped(&self) -> Self {
        let above = |x: f32| if x > -f32::MAX { x } else { -f32::MAX };
        let below = |x: f32| if x < f32::MAX { x } else { f32::MAX };
        if self.lo.iter().zip(&self.hi).any(|(lo, hi)| lo.is_nan() || hi.is_nan() || lo > hi) {
            return Self::EMPTY;
        }
        Self { lo: self.lo.mapped(above), hi: self.hi.mapped(below) }
    }

    /// Returns half the surface area (in 2D half the perimeter). The expected cost of a node in
    /// searches is proportional to it (Goldsmith and Salmon 1987). Unlike the volume, the area is
    /// not zero for flat boxes.
    ///
    /// The result is an `f64`, which no box with finite faces overflows; 0 for an empty box.
    #[must_use]
    pub fn half_surface(&self) -> f64 {
        let extent = |axis: usize| f64::from(self.hi[axis]) - f64::from(self.lo[axis]);
        if self.lo[0] > self.hi[0] {
            return 0.0;
        }
        let face =
            |across: usize| -> f64 { (0..D).filter(|&axis| axis != across).map(extent).product() };
        (0..D).map(face).sum()
    }

    /// Returns the box with coordinates in `N`, exactly. The box must not be empty.
    pub(super) fn as_aabb<N: Real>(&self) -> Aabb<N, D> {
        let corner =
            |faces: &[f32; D]| Point::from(Vector::from_fn(|axis, _| N::lit(faces[axis].into())));
        Aabb::new(corner(&self.lo), corner(&self.hi))
    }

    /// Returns the greatest dot product of `along` with a point of the box.
    pub(super) fn extent<N: Real>(&self, along: &Vector<N, D>) -> N {
        (0..D).fold(N::ZERO, |sum, axis| {
            let corner = if along[axis] < N::ZERO { self.lo[axis] } else { self.hi[axis] };
            sum + along[axis] * N::lit(f64::from(corner))
        })
    }

    /// Returns the centre. Coordinates are halved before they are added, so the sum does not
    /// overflow.
    #[inline]
    #[must_use]
    pub fn center(&self) -> [f32; D] {
        filled(|axis| self.lo[axis] * 0.5 + self.hi[axis] * 0.5)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn surfaces_of_flat_and_solid_boxes() {
        let solid = Bounds { lo: [0.0, 0.0, 0.0], hi: [1.0, 2.0, 3.0] };
        assert_eq!(solid.half_surface(), 2.0 + 3.0 + 6.0, "three faces");
        let flat = Bounds { lo: [0.0, 5.0, 0.0], hi: [2.0, 5.0, 3.0] };
        assert_eq!(flat.half_surface(), 6.0, "a flat box has a face");
        let plane = Bounds { lo: [0.0, 0.0], hi: [1.0, 2.0] };
        assert_eq!(plane.half_surface(), 3.0, "half the perimeter");
        assert_eq!(Bounds::<3>::EMPTY.half_surface(), 0.0, "nothing");
    }

    #[test]
    fn what_overlaps_nothing() {
        let all = Bounds { lo: [f32::NEG_INFINITY; 2], hi: [f32::INFINITY; 2] };
        assert!(!all.overlaps(&Bounds::NOWHERE), "not even everything overlaps nowhere");
        assert!(!all.clamped().overlaps(&Bounds::EMPTY), "clamped, it misses the empty box");
        assert_eq!(Bounds::<2>::NOWHERE.clamped(), Bounds::EMPTY, "nowhere becomes empty");
    }
}
