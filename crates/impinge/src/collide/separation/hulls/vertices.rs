//! Vertices of a solid in lanes, and their heights along directions.
//!
//! ```text
//!   vertex  0..8      block 0   x[8] y[8] z[8]      bit v of a `u32` stands for vertex v:
//!   vertex  8..16     block 1   x[8] y[8] z[8]      block v / 8, lane v % 8
//!   ...                                             `count` vertices in `used` blocks; the last
//!   vertex 24..32     block 3   x[8] y[8] z[8]      vertex fills the rest of its block
//! ```

use super::polyhedral::Polyhedral;
use super::{BLOCKS, LANES, PLANE_BLOCKS};
use crate::math::lanes::{LanePose, dot, highest_lane, load, spread};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Pose, Real, Vector, Wide};
use crate::shape::Planes;

/// Vertices of a solid in some frame, in units of the pair.
pub(super) struct Vertices<N: Real> {
    blocks: [[[N; LANES]; 3]; BLOCKS],
    /// Number of blocks that hold vertices.
    used: usize,
    /// Number of vertices.
    count: usize,
}

/// Heights of [`Vertices`] along a direction, in the same layout.
pub(super) struct Heights<N: Real> {
    blocks: [[N; LANES]; BLOCKS],
    used: usize,
    count: usize,
    /// Smallest of the heights.
    pub(super) low: N,
}

impl<N: Real> Heights<N> {
    /// Returns the bits of the vertices with a height of at most `most`.
    #[inline(always)]
    pub(super) fn up_to<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, most: N) -> u32 {
        let mut bits = 0;
        for (number, block) in self.blocks[..self.used].iter().enumerate() {
            let is_low = V::load(simd, block).simd_le(V::all(simd, most)).to_bitmask();
            bits |= is_low << (number * LANES);
        }
        // Copies of the last vertex fill the rest of its block.
        low_half(bits & !(u64::MAX << self.count))
    }
}

/// Returns the low 32 bits of a mask.
#[inline(always)]
fn low_half(bits: u64) -> u32 {
    let [a, b, c, d, ..] = bits.to_le_bytes();
    u32::from_le_bytes([a, b, c, d])
}

/// Result of a face query: the face with the largest signed height of the other solid above it.
#[derive(Clone, Copy)]
pub(super) struct FaceQuery<N> {
    pub(super) index: usize,
    /// Signed height of the other solid's lowest vertex above the plane of the face.
    pub(super) separation: N,
}

impl<N: Real> Vertices<N> {
    /// Returns the vertices of a solid in its own frame, scaled to units of the pair.
    #[inline(always)]
    pub(super) fn in_own_frame<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        solid: &Polyhedral<'_, N>,
        shrink: N,
    ) -> Self {
        let blocks = [[[N::ZERO; LANES]; 3]; BLOCKS];
        let mut vertices = Self { blocks, used: solid.blocks.len(), count: solid.vertices };
        let shrink = V::all(simd, shrink);
        for (block, out) in solid.blocks.iter().zip(&mut vertices.blocks) {
            let local: [V; 3] = load(simd, block);
            for (axis, out) in out.iter_mut().enumerate() {
                (local[axis] * shrink).store(out);
            }
        }
        vertices
    }

    /// Returns the vertices transformed by `pose`.
    #[inline(always)]
    pub(super) fn placed<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        pose: &Pose<N, 3>,
    ) -> Self {
        let blocks = [[[N::ZERO; LANES]; 3]; BLOCKS];
        let mut placed = Self { blocks, used: self.used, count: self.count };
        let pose: LanePose<V, 3> = LanePose::of(simd, pose);
        for (block, out) in self.blocks[..self.used].iter().zip(&mut placed.blocks) {
            let points = pose.point(&load(simd, block));
            for (axis, out) in out.iter_mut().enumerate() {
                points[axis].store(out);
            }
        }
        placed
    }

    #[inline(always)]
    pub(super) fn at(&self, vertex: usize) -> Vector<N, 3> {
        // The remainder avoids a bounds check: there are at most `BLOCKS` blocks.
        let (block, lane) = (&self.blocks[vertex / LANES % BLOCKS], vertex % LANES);
        Vector::<N, 3>::new(block[0][lane], block[1][lane], block[2][lane])
    }

    /// Returns the heights of the vertices along a vector, times its length.
    #[inline(always)]
    pub(super) fn heights<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        along: &Vector<N, 3>,
    ) -> Heights<N> {
        let (along, used, count): ([V; 3], _, _) = (spread(simd, along), self.used, self.count);
        let mut blocks = [[N::ZERO; LANES]; BLOCKS];
        let mut low = V::all(simd, N::INFINITY);
        for (block, out) in self.blocks[..used].iter().zip(&mut blocks) {
            let height = dot(&load::<_, _, V, 3, LANES>(simd, block), &along);
            low = height.smaller(low);
            height.store(out);
        }
        Heights { blocks, used, count, low: -highest_lane(-low) }
    }

    /// Returns the smallest height of the vertices along a vector, times its length.
    #[inline(always)]
    pub(super) fn low<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, along: &Vector<N, 3>) -> N {
        let along: [V; 3] = spread(simd, along);
        let mut low = V::all(simd, N::INFINITY);
        for block in &self.blocks[..self.used] {
            low = dot(&load::<_, _, V, 3, LANES>(simd, block), &along).smaller(low);
        }
        -highest_lane(-low)
    }

    /// Queries the face directions of the other solid: returns the face with the largest signed
    /// height of these vertices above its plane. The first face wins a tie.
    #[inline(always)]
    pub(super) fn query_faces<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        planes: &[Planes<N, 3>],
        shrink: N,
    ) -> FaceQuery<N> {
        let mut separations = [[N::ZERO; LANES]; PLANE_BLOCKS];
        let mut largest = V::all(simd, -N::INFINITY);
        for (block, out) in planes.iter().zip(&mut separations) {
            let normals: [V; 3] = load(simd, &block.normals);
            let offsets = V::load(simd, &block.offsets) * V::all(simd, shrink);
            let separation = self.lowest_along(simd, &normals) - offsets;
            separation.store(out);
            largest = separation.larger(largest);
        }
        let (separation, mut index) = (highest_lane(largest), 0);
        for (number, separations) in separations[..planes.len()].iter().enumerate() {
            let separations = V::load(simd, separations);
            let is_largest = separations.simd_eq(V::all(simd, separation)).to_bitmask();
            if is_largest != 0 {
                index = number * LANES + is_largest.trailing_zeros() as usize;
                break;
            }
        }
        FaceQuery { index, separation }
    }

    /// Returns the smallest height of the vertices along each of 8 vectors.
    #[inline(always)]
    fn lowest_along<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, along: &[V; 3]) -> V {
        let mut low = V::all(simd, N::INFINITY);
        for (number, block) in self.blocks[..self.used].iter().enumerate() {
            let rest = self.count - number * LANES;
            for lane in 0..if rest < LANES { rest } else { LANES } {
                let [x, y, z] = block;
                let vertex = [V::all(simd, x[lane]), V::all(simd, y[lane]), V::all(simd, z[lane])];
                low = dot(along, &vertex).smaller(low);
            }
        }
        low
    }
}

/// Returns the largest signed height of a point above the planes, in units of the pair; negative
/// inside the solid. `shrink` scales the planes to these units.
#[inline(always)]
pub(super) fn height_above<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    planes: &[Planes<N, 3>],
    shrink: N,
    point: &Vector<N, 3>,
) -> N {
    let point: [V; 3] = spread(simd, point);
    let mut highest = V::all(simd, -N::INFINITY);
    for block in planes {
        let normals: [V; 3] = load(simd, &block.normals);
        let offsets = V::load(simd, &block.offsets) * V::all(simd, shrink);
        highest = (dot(&normals, &point) - offsets).larger(highest);
    }
    highest_lane(highest)
}
