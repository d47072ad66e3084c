//! Blocks of sixteen triangles, and the test of which triangles a line may cross.
//!
//! The test uses the signs of areas around the line (Woop, Benthin and Wald, "Watertight
//! Ray/Triangle Intersection", 2013), in `f32`, with a bound for all rounding errors here and in
//! the exact test that follows: a rejected triangle is certainly not crossed.

use super::LANES;
use super::kernel::{Scalar, WideBlock, low_half};
use crate::bounding_volume::{Aabb, Ray};
use crate::math::{Mapped, Real, max_component};
use fearless_simd::{Simd, SimdBase, f32x16};

/// Sixteen triangles in 3D as a structure of arrays: by corner, then by axis. Coordinates are
/// rounded to the nearest `f32`.
///
/// 576 bytes. The corners of an unused lane are zero, and the test may propose the lane.
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(C, align(64))]
pub(crate) struct Triangles {
    corners: [[[f32; LANES]; 3]; 3],
}

impl Triangles {
    /// Sixteen triangles whose corners are all at the origin.
    pub(crate) const EMPTY: Self = Self { corners: [[[0.0; LANES]; 3]; 3] };

    /// Writes the triangle of a lane.
    #[inline]
    pub(crate) fn set_lane(&mut self, lane: usize, corners: &[[f32; 3]; 3]) {
        for (own, corner) in self.corners.iter_mut().zip(corners) {
            for (axis, &x) in own.iter_mut().zip(corner) {
                axis[lane] = x;
            }
        }
    }

    /// Reads one value of each row, which prefetches all rows.
    #[inline(always)]
    pub(super) fn touch(&self) {
        for axis in self.corners.as_flattened() {
            core::hint::black_box(axis[0]);
        }
    }

    /// Returns the triangle in a lane.
    #[inline]
    pub(crate) fn lane(&self, lane: usize) -> [[f32; 3]; 3] {
        self.corners.each_ref().mapped(|corner| corner.each_ref().mapped(|axis| axis[lane]))
    }
}

/// A triangle: its object's id, and its block and lane.
#[derive(Clone, Copy, Debug)]
pub(crate) struct TriangleAt<'a> {
    pub(crate) id: u32,
    pub(crate) block: &'a Triangles,
    pub(crate) lane: usize,
}

/// Error bound of a corner's position relative to the line, in `f32` rounding units of the corner's
/// distance from the line's origin along and across the line.
///
/// In half units: 12 here and 16 in the exact test, for differences, shears and sums. These 28 for
/// each position make 112 in an area, the difference of two products of two positions. The exact
/// test also accepts the sides of a triangle seen edge on within a distance of 83, which raises the
/// bound to 235. The rest is a margin.
const NEAR: f32 = 256.0;

/// Error bound in `f32` rounding units of the largest coordinate: 8 for the conversion from `f64`,
/// and 40 because the exact test lets a ray that starts within 8 units of a triangle start on it.
const FAR: f32 = 64.0;

/// A line, prepared for tests after a shear that makes it parallel to its main axis.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ShearedLine {
    /// The two axes across the line, then the main axis: the one with the largest component of the
    /// line's direction.
    axes: [usize; 3],
    origin: [f32; 3],
    /// Displacement of the line along the first two axes per unit of length along the main axis.
    shear: [f32; 2],
    /// Time per unit of length along the main axis, of magnitude at most 1, in the units of
    /// [`Slabs`](super::Slabs).
    inverse: f32,
    /// Absolute part of the error bound, as a length.
    slack: f32,
}

impl ShearedLine {
    /// Prepares the line of a ray, which must be finite with a nonzero direction, for corners with
    /// coordinates of magnitude up to `size`. `around` is a box around the ray's origin that covers
    /// earlier rounding errors.
    #[inline(always)]
    pub(crate) fn new<N: Real>(ray: &Ray<N, 3>, around: &Aabb<N, 3>, size: f32) -> Self {
        let along = ray.dir.iamax();
        let axes = [(along + 1) % 3, (along + 2) % 3, along];
        let unit = max_component(&ray.dir).power_of_two_below();
        let origin = axes.mapped(|axis| ray.origin[axis].as_f32());
        let share = |axis: usize| (ray.dir[axis] / ray.dir[along]).as_f32();
        let farthest = max_component(&ray.origin.coords).as_f32();
        let blur = max_component(&(around.maxs() - around.mins())).as_f32();
        Self {
            axes,
            origin,
            shear: [share(axes[0]), share(axes[1])],
            inverse: (unit / ray.dir[along]).as_f32(),
            slack: FAR * f32::EPSILON * if farthest > size { farthest } else { size } + blur,
        }
    }
}

impl Scalar {
    /// Tests one lane after another; see [`Kernel::crossed`](super::kernel::Kernel::crossed).
    pub(super) fn crossed_triangles(
        self,
        triangles: &Triangles,
        line: &ShearedLine,
        limit: f32,
    ) -> u32 {
        let larger = |a: f32, b: f32| if a > b { a } else { b };
        let smaller = |a: f32, b: f32| if a < b { a } else { b };
        let mut mask = 0;
        for lane in 0..LANES {
            let sheared = triangles.lane(lane).mapped(|corner| {
                let at = |k: usize| corner[line.axes[k]] - line.origin[k];
                let depth = at(2);
                [at(0) - line.shear[0] * depth, at(1) - line.shear[1] * depth, depth]
            });
            let [a, b, c] = sheared;
            let area = |p: [f32; 3], q: [f32; 3]| p[0] * q[1] - p[1] * q[0];
            let areas = [area(b, c), area(c, a), area(a, b)];
            let wide = |p: [f32; 3]| larger(p[0].abs(), p[1].abs());
            let width = larger(larger(wide(a), wide(b)), wide(c));
            let depth = larger(larger(a[2].abs(), b[2].abs()), c[2].abs());
            let slack = (width + depth) * (NEAR * f32::EPSILON) + line.slack;
            let margin = (width + slack) * slack + f32::MIN_POSITIVE;
            let most = larger(larger(areas[0], areas[1]), areas[2]);
            let least = smaller(smaller(areas[0], areas[1]), areas[2]);
            let times = sheared.mapped(|corner| corner[2] * line.inverse);
            let first = smaller(smaller(times[0], times[1]), times[2]);
            let last = larger(larger(times[0], times[1]), times[2]);
            // Areas of both signs, beyond the error bound: the line passes beside the triangle.
            let beside = (most > margin) & (least < -margin);
            // All corners lie beyond the limit, or all behind the origin.
            let outside = (first - slack > limit) | (last + slack < 0.0);
            mask |= u32::from(!(beside | outside)) << lane;
        }
        mask
    }
}

impl<S: Simd> WideBlock<S> {
    /// Tests all lanes at once; see [`Kernel::crossed`](super::kernel::Kernel::crossed).
    #[inline(always)]
    pub(super) fn crossed_triangles(
        self,
        triangles: &Triangles,
        line: &ShearedLine,
        limit: f32,
    ) -> u32 {
        // Written out, since closures passed to `map` are not compiled for the instruction set.
        let [a, b, c] = &triangles.corners;
        let (a, b, c) =
            (sheared(self.0, a, line), sheared(self.0, b, line), sheared(self.0, c, line));
        let areas = [area(b, c), area(c, a), area(a, b)];
        let width = wide(a).max(wide(b)).max(wide(c));
        let depth = a[2].abs().max(b[2].abs()).max(c[2].abs());
        let slack = (width + depth) * (NEAR * f32::EPSILON) + line.slack;
        let margin = (width + slack) * slack + f32::MIN_POSITIVE;
        let most = areas[0].max(areas[1]).max(areas[2]);
        let least = areas[0].min(areas[1]).min(areas[2]);
        let [ta, tb, tc] = [a[2] * line.inverse, b[2] * line.inverse, c[2] * line.inverse];
        let (first, last) = (ta.min(tb).min(tc), ta.max(tb).max(tc));
        let beside = most.simd_gt(margin) & least.simd_lt(-margin);
        let outside = (first - slack).simd_gt(limit) | (last + slack).simd_lt(0.0);
        !low_half(fearless_simd::SimdMask::to_bitmask(beside | outside)) & 0xffff
    }
}

/// Returns, by lane, a corner in sheared coordinates relative to the line's origin: two across the
/// line, and one along the main axis.
#[inline(always)]
fn sheared<S: Simd>(simd: S, corner: &[[f32; LANES]; 3], line: &ShearedLine) -> [f32x16<S>; 3] {
    let [x, y, along] = line.axes;
    let depth = f32x16::load_array_ref(simd, &corner[along]) - line.origin[2];
    let x = f32x16::load_array_ref(simd, &corner[x]) - line.origin[0];
    let y = f32x16::load_array_ref(simd, &corner[y]) - line.origin[1];
    [x - depth * line.shear[0], y - depth * line.shear[1], depth]
}

/// Returns, by lane, the 2D cross product of two corners in the plane across the line.
#[inline(always)]
fn area<S: Simd>(p: [f32x16<S>; 3], q: [f32x16<S>; 3]) -> f32x16<S> {
    p[0] * q[1] - p[1] * q[0]
}

/// Returns, by lane, the larger of a corner's two distances from the line along the axes across it.
#[inline(always)]
fn wide<S: Simd>(p: [f32x16<S>; 3]) -> f32x16<S> {
    p[0].abs().max(p[1].abs())
}
