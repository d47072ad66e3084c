//! The sides of outlines with few vertices, eight at a time.

use fearless_simd::{Level, Simd, SimdMask};

use super::outline::Outline;
use crate::math::{Real, Vector, Wide, max};

/// How many sides are looked at side by side.
const LANES: usize = 8;

/// The vertices and normals of an outline, coordinate by coordinate; the last ones fill the rest.
struct Lanes<N: Real> {
    vertices: [[N; LANES]; 2],
    normals: [[N; LANES]; 2],
    count: usize,
}

impl<N: Real> Lanes<N> {
    /// `None` if there are more vertices than lanes, sides of no length, or tips: angles that are
    /// sharper than a right one.
    fn of(outline: &Outline<N>) -> Option<Self> {
        let (vertices, normals) = (outline.vertices.as_slice(), outline.normals.as_slice());
        if vertices.len() > LANES || vertices.len() < 3 {
            return None;
        }
        let zero = [[N::ZERO; LANES]; 2];
        let mut lanes = Self { vertices: zero, normals: zero, count: vertices.len() };
        let (mut before, mut vertex) = ((*normals.last()?)?, *vertices.last()?);
        for lane in 0..LANES {
            if lane < lanes.count {
                let normal = normals[lane]?;
                let is_tip = before.dot(&normal) < N::ZERO;
                if is_tip {
                    return None;
                }
                (before, vertex) = (normal, vertices[lane]);
            }
            for axis in 0..2 {
                lanes.vertices[axis][lane] = vertex[axis];
                lanes.normals[axis][lane] = before[axis];
            }
        }
        Some(lanes)
    }

    /// How far the vertices reach along each of eight directions.
    #[inline(always)]
    fn reach<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, x: V, y: V) -> V {
        let mut most = V::all(simd, -N::INFINITY);
        for lane in 0..self.count {
            let along =
                x * V::all(simd, self.vertices[0][lane]) + y * V::all(simd, self.vertices[1][lane]);
            most = along.larger(most);
        }
        most
    }

    /// The first side whose normal leaves the largest gap to another outline, and the gap.
    #[inline(always)]
    fn best_side<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, other: &Self) -> (usize, N) {
        let (x, y) = (V::load(simd, &self.normals[0]), V::load(simd, &self.normals[1]));
        let gaps = -other.reach(simd, -x, -y) - self.reach(simd, x, y);
        let mut numbers = [N::ZERO; LANES];
        gaps.store(&mut numbers);
        let most = numbers[1..].iter().fold(numbers[0], |most, &gap| max(gap, most));
        let is_most = gaps.simd_eq(V::all(simd, most)).to_bitmask();
        ((is_most.trailing_zeros() as usize).min(LANES - 1), most)
    }
}

/// The gap and the direction, from the first to the second outline, of the largest gap among the normals
/// of all sides: those of the first come before those of the second. `None` for outlines that lanes
/// are not for.
pub(super) fn best_side<N: Real>(
    outline1: &Outline<N>,
    outline2: &Outline<N>,
) -> Option<(N, Vector<N, 2>)> {
    let lanes = [Lanes::of(outline1)?, Lanes::of(outline2)?];
    let [(side1, gap1), (side2, gap2)] = best_sides(Level::new(), &lanes);
    Some(if gap2 > gap1 {
        (gap2, -outline2.normals[side2]?)
    } else {
        (gap1, outline1.normals[side1]?)
    })
}

/// The best side of each outline, with the vectors of an instruction set; the numbers do not depend
/// on it.
fn best_sides<N: Real>(level: Level, lanes: &[Lanes<N>; 2]) -> [(usize, N); 2] {
    #[cfg(target_arch = "x86_64")]
    if let Some(simd) = level.as_avx2() {
        return simd.vectorize(
            #[inline(always)]
            || both::<_, N, N::Lanes<_>>(simd, lanes),
        );
    }
    fearless_simd::dispatch!(level, simd => both::<_, N, N::Lanes<_>>(simd, lanes))
}

#[inline(always)]
fn both<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    [lanes1, lanes2]: &[Lanes<N>; 2],
) -> [(usize, N); 2] {
    [lanes1.best_side::<S, V>(simd, lanes2), lanes2.best_side::<S, V>(simd, lanes1)]
}
