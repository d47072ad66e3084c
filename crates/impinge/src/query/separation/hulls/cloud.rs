//! Vertices in lanes, and how far they and planes lie from one another.

use super::solid::Flat;
use super::{BLOCKS, LANES, PLANE_BLOCKS};
use crate::math::lanes::{by_axis, dot, highest_lane, load, spread};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Matrix, Real, Vector, Wide};
use crate::shape::Planes;

/// The vertices of a solid in some frame, in units of the pair.
pub(super) struct Cloud<N: Real> {
    blocks: [[[N; LANES]; 3]; BLOCKS],
    used: usize,
    count: usize,
}

/// How far the vertices of a [`Cloud`] lie along a vector.
pub(super) struct Heights<N: Real> {
    numbers: [[N; LANES]; BLOCKS],
    used: usize,
    count: usize,
    pub(super) low: N,
}

impl<N: Real> Heights<N> {
    /// The vertices that are not higher than this, as the bits of a number.
    #[inline(always)]
    pub(super) fn up_to<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, most: N) -> u32 {
        let mut bits = 0;
        for (number, block) in self.numbers[..self.used].iter().enumerate() {
            let is_low = V::load(simd, block).simd_le(V::all(simd, most)).to_bitmask();
            bits |= is_low << (number * LANES);
        }
        // Beyond the last vertex are copies of it.
        low_half(bits & !(u64::MAX << self.count))
    }
}

/// The low half of a number.
#[inline(always)]
fn low_half(bits: u64) -> u32 {
    let [a, b, c, d, ..] = bits.to_le_bytes();
    u32::from_le_bytes([a, b, c, d])
}

/// Where one frame lies in another, in units of the pair: `x` of the first is at
/// `rotation · x + translation` of the second.
#[derive(Clone, Copy)]
pub(super) struct Place<N: Real> {
    pub(super) rotation: Matrix<N, 3>,
    pub(super) translation: Vector<N, 3>,
}

impl<N: Real> Place<N> {
    /// Eight vectors turned.
    #[inline(always)]
    pub(super) fn turned<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, v: &[V; 3]) -> [V; 3] {
        by_axis(
            #[inline(always)]
            |row| {
                let row = by_axis(
                    #[inline(always)]
                    |column| V::all(simd, self.rotation[(row, column)]),
                );
                dot(v, &row)
            },
        )
    }

    /// Where the second frame lies in the first.
    #[inline(always)]
    pub(super) fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        Self { rotation, translation: -(rotation * self.translation) }
    }
}

/// The face of a solid that the other one lies farthest above.
#[derive(Clone, Copy)]
pub(super) struct Best<N> {
    pub(super) face: usize,
    pub(super) height: N,
    /// The next best face with its height and the height of the third, if they were asked for.
    pub(super) next: (usize, N),
    pub(super) third: N,
}

impl<N: Real> Best<N> {
    /// One of which nothing more is known.
    pub(super) fn alone(face: usize, height: N) -> Self {
        Self { face, height, next: (face, -N::INFINITY), third: -N::INFINITY }
    }

    /// Finds the two faces that come after the best one.
    #[inline(always)]
    fn rank(&mut self, heights: &[N]) {
        for (index, &height) in heights.iter().enumerate() {
            if index == self.face || height <= self.third {
                continue;
            }
            if height > self.next.1 {
                (self.third, self.next) = (self.next.1, (index, height));
            } else {
                self.third = height;
            }
        }
    }
}

impl<N: Real> Cloud<N> {
    /// Vertices in their own frame.
    #[inline(always)]
    pub(super) fn own<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        (blocks, count): (&[[[N; LANES]; 3]], usize),
        shrink: N,
    ) -> Self {
        let mut cloud = Self { blocks: [[[N::ZERO; LANES]; 3]; BLOCKS], used: blocks.len(), count };
        let shrink = V::all(simd, shrink);
        for (block, out) in blocks.iter().zip(&mut cloud.blocks) {
            let local: [V; 3] = load(simd, block);
            for (axis, out) in out.iter_mut().enumerate() {
                (local[axis] * shrink).store(out);
            }
        }
        cloud
    }

    /// No vertices.
    #[inline(always)]
    pub(super) const fn empty() -> Self {
        Self { blocks: [[[N::ZERO; LANES]; 3]; BLOCKS], used: 0, count: 0 }
    }

    /// The vertices of a cloud in another frame, in place of those of `out`.
    #[inline(always)]
    pub(super) fn place<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        at: &Place<N>,
        out: &mut Self,
    ) {
        (out.used, out.count) = (self.used, self.count);
        let origin: [V; 3] = spread(simd, &at.translation);
        for (block, out) in self.blocks[..self.used].iter().zip(&mut out.blocks) {
            let turned = at.turned(simd, &load::<_, _, V, 3, LANES>(simd, block));
            for (axis, out) in out.iter_mut().enumerate() {
                (turned[axis] + origin[axis]).store(out);
            }
        }
    }

    #[inline(always)]
    pub(super) fn at(&self, vertex: usize) -> Vector<N, 3> {
        // The remainder spares the compiler a check: there are no more vertices.
        let (block, lane) = (&self.blocks[vertex / LANES % BLOCKS], vertex % LANES);
        Vector::<N, 3>::new(block[0][lane], block[1][lane], block[2][lane])
    }

    /// How far the vertices lie along a vector.
    #[inline(always)]
    pub(super) fn heights<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        along: &Vector<N, 3>,
    ) -> Heights<N> {
        let (along, used, count): ([V; 3], _, _) = (spread(simd, along), self.used, self.count);
        let mut numbers = [[N::ZERO; LANES]; BLOCKS];
        let mut low = V::all(simd, N::INFINITY);
        for (block, out) in self.blocks[..used].iter().zip(&mut numbers) {
            let height = dot(&load::<_, _, V, 3, LANES>(simd, block), &along);
            low = height.smaller(low);
            height.store(out);
        }
        Heights { numbers, used, count, low: -highest_lane(-low) }
    }

    /// How far along a vector the lowest vertex lies.
    #[inline(always)]
    pub(super) fn low<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, along: &Vector<N, 3>) -> N {
        let along: [V; 3] = spread(simd, along);
        let mut low = V::all(simd, N::INFINITY);
        for block in &self.blocks[..self.used] {
            low = dot(&load::<_, _, V, 3, LANES>(simd, block), &along).smaller(low);
        }
        -highest_lane(-low)
    }

    /// The plane that lies farthest below all vertices, the first of equals. Those of the `count` planes
    /// that come next are found if that is asked for.
    #[inline(always)]
    pub(super) fn farthest_plane<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        (planes, count): (&[Planes<N, 3>], usize),
        shrink: N,
        with_next: bool,
    ) -> Best<N> {
        let mut heights = [[N::ZERO; LANES]; PLANE_BLOCKS];
        let mut highest = V::all(simd, -N::INFINITY);
        for (block, out) in planes.iter().zip(&mut heights) {
            let normals: [V; 3] = load(simd, &block.normals);
            let offsets = V::load(simd, &block.offsets) * V::all(simd, shrink);
            let height = self.lowest_along(simd, &normals) - offsets;
            height.store(out);
            highest = height.larger(highest);
        }
        let (most, mut face) = (highest_lane(highest), 0);
        let all = V::all(simd, most);
        for (index, heights) in heights[..planes.len()].iter().enumerate() {
            let is_most = V::load(simd, heights).simd_eq(all).to_bitmask();
            if is_most != 0 {
                face = index * LANES + is_most.trailing_zeros() as usize;
                break;
            }
        }
        let mut best = Best::alone(face, most);
        if with_next {
            best.rank(&heights.as_flattened()[..count]);
        }
        best
    }

    /// How far the vertices lie above a plane, the number that [`Self::farthest_plane`] finds for it.
    #[inline(always)]
    pub(super) fn above<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        (solid, face): (&Flat<'_, N>, usize),
        shrink: N,
    ) -> N {
        self.low::<S, V>(simd, &solid.normal(face)) - solid.offset(face) * shrink
    }

    /// The least height of the vertices along each of eight vectors.
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

/// How far a point lies above the highest of some planes.
#[inline(always)]
pub(super) fn highest_over<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
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
