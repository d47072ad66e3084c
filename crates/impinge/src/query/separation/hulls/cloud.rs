//! Vertices in lanes, and how far they and planes lie from one another.

use fearless_simd::{Simd, SimdMask};

use super::{BLOCKS, LANES, PLANE_BLOCKS};
use crate::math::{Matrix, Real, Vector, Wide, max};
use crate::shape::Planes;

/// The vertices of a solid in some frame, in units of the pair.
pub(super) struct Cloud<N: Real> {
    blocks: [[[N; LANES]; 3]; BLOCKS],
    used: usize,
    count: usize,
}

/// A number for each vertex of a [`Cloud`].
pub(super) struct Heights<N: Real>([[N; LANES]; BLOCKS]);

impl<N: Real> Heights<N> {
    #[inline(always)]
    pub(super) fn at(&self, vertex: usize) -> N {
        self.0[vertex / LANES][vertex % LANES]
    }
}

/// Where one frame lies in another, in units of the pair: `x` of the first is at
/// `rotation · x + translation` of the second.
pub(super) struct Place<N: Real> {
    pub(super) rotation: Matrix<N, 3>,
    pub(super) translation: Vector<N, 3>,
}

/// The scalar product of vectors in lanes.
#[inline(always)]
pub(super) fn dot<S: Simd, V: Wide<S>>(a: &[V; 3], b: &[V; 3]) -> V {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The same vector in all lanes.
#[inline(always)]
pub(super) fn spread<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    v: &Vector<N, 3>,
) -> [V; 3] {
    [V::all(simd, v.x), V::all(simd, v.y), V::all(simd, v.z)]
}

/// Eight vectors.
#[inline(always)]
pub(super) fn load<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    block: &[[N; LANES]; 3],
) -> [V; 3] {
    [V::load(simd, &block[0]), V::load(simd, &block[1]), V::load(simd, &block[2])]
}

impl<N: Real> Place<N> {
    /// Eight vectors turned.
    #[inline(always)]
    pub(super) fn turned<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, v: &[V; 3]) -> [V; 3] {
        let rows: [[V; 3]; 3] = [0, 1, 2].map(
            #[inline(always)]
            |row: usize| {
                [0, 1, 2].map(
                    #[inline(always)]
                    |column: usize| V::all(simd, self.rotation[(row, column)]),
                )
            },
        );
        [dot(v, &rows[0]), dot(v, &rows[1]), dot(v, &rows[2])]
    }

    /// Where the second frame lies in the first.
    #[inline(always)]
    pub(super) fn inverse(&self) -> Self {
        let rotation = self.rotation.transpose();
        Self { rotation, translation: -(rotation * self.translation) }
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

    /// The vertices of a cloud in another frame.
    #[inline(always)]
    pub(super) fn placed<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, at: &Place<N>) -> Self {
        let mut cloud = Self { blocks: [[[N::ZERO; LANES]; 3]; BLOCKS], ..*self };
        let origin: [V; 3] = spread(simd, &at.translation);
        for (block, out) in self.blocks[..self.used].iter().zip(&mut cloud.blocks) {
            let turned = at.turned(simd, &load::<S, N, V>(simd, block));
            for (axis, out) in out.iter_mut().enumerate() {
                (turned[axis] + origin[axis]).store(out);
            }
        }
        cloud
    }

    #[inline(always)]
    pub(super) fn at(&self, vertex: usize) -> Vector<N, 3> {
        let (block, lane) = (&self.blocks[vertex / LANES], vertex % LANES);
        Vector::<N, 3>::new(block[0][lane], block[1][lane], block[2][lane])
    }

    /// How far the vertices lie along a vector, and the least of it.
    #[inline(always)]
    pub(super) fn heights<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        along: &Vector<N, 3>,
    ) -> (Heights<N>, N) {
        let along: [V; 3] = spread(simd, along);
        let mut heights = Heights([[N::ZERO; LANES]; BLOCKS]);
        let mut low = V::all(simd, N::INFINITY);
        for (block, out) in self.blocks[..self.used].iter().zip(&mut heights.0) {
            let height = dot(&load::<S, N, V>(simd, block), &along);
            low = height.smaller(low);
            height.store(out);
        }
        (heights, -highest_lane(-low))
    }

    /// The plane that lies farthest below all vertices, the first of equals, and how far.
    #[inline(always)]
    pub(super) fn farthest_plane<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        planes: &[Planes<N, 3>],
        shrink: N,
    ) -> (usize, N) {
        let mut heights = [[N::ZERO; LANES]; PLANE_BLOCKS];
        let mut highest = V::all(simd, -N::INFINITY);
        for (block, out) in planes.iter().zip(&mut heights) {
            let normals: [V; 3] = load(simd, &block.normals);
            let offsets = V::load(simd, &block.offsets) * V::all(simd, shrink);
            let height = self.lowest_along(simd, &normals) - offsets;
            height.store(out);
            highest = height.larger(highest);
        }
        let most = highest_lane(highest);
        let all = V::all(simd, most);
        for (index, heights) in heights[..planes.len()].iter().enumerate() {
            let is_most = V::load(simd, heights).simd_eq(all).to_bitmask();
            if is_most != 0 {
                return (index * LANES + is_most.trailing_zeros() as usize, most);
            }
        }
        (0, most)
    }

    /// The least height of the vertices along each of eight vectors.
    #[inline(always)]
    fn lowest_along<S: Simd, V: Wide<S, Scalar = N>>(&self, simd: S, along: &[V; 3]) -> V {
        let mut low = V::all(simd, N::INFINITY);
        for (number, block) in self.blocks[..self.used].iter().enumerate() {
            let rest = self.count - number * LANES;
            for lane in 0..if rest < LANES { rest } else { LANES } {
                let vertex = [0, 1, 2].map(
                    #[inline(always)]
                    |axis: usize| V::all(simd, block[axis][lane]),
                );
                low = dot(along, &vertex).smaller(low);
            }
        }
        low
    }
}

/// The greatest of eight numbers.
#[inline(always)]
pub(super) fn highest_lane<S: Simd, N: Real, V: Wide<S, Scalar = N>>(numbers: V) -> N {
    let mut lanes = [N::ZERO; LANES];
    numbers.store(&mut lanes);
    let four = [0, 1, 2, 3].map(|lane: usize| max(lanes[lane], lanes[lane + 4]));
    max(max(four[0], four[2]), max(four[1], four[3]))
}
