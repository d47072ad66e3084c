//! Convex outlines in 2D: the common form of points, segments, triangles, boxes and polygons.
//!
//! ```text
//!       3 ---n2--- 2      vertex v: lane v % 8 of block v / 8, counter-clockwise
//!       |          |      normals[v]: outward unit normal of the side from v to v + 1
//!      n3          n1     a segment has two sides, there and back
//!       |          |      the last vertex and normal fill the rest of a block
//!       0 ---n0--- 1
//! ```

use smallvec::{SmallVec, smallvec};

use crate::collide::separation::segments::segment_lanes::is_square_in_range;
use crate::math::lanes::{LanePose, dot, either, highest_lane, load, spread};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Point, Pose, Real, Vector, Wide, cross2, max};
use crate::shape::{Kind, Polytope, Segment, Triangle};

/// Number of vertices in a block; equal to the lane count of [`Polytope`]'s blocks, which are
/// copied.
pub(in crate::collide::separation) const LANES: usize = 8;

/// Largest number of blocks; outlines with more go to the general algorithm.
const MAX_BLOCKS: usize = 4;

/// One value for each of 8 vertices.
pub(in crate::collide::separation) type Row<N> = [N; LANES];

/// A convex polygon with a radius, in some frame.
///
/// The vertices are in counter-clockwise order. Points, segments (there and back) and flat
/// triangles are outlines, too.
pub(in crate::collide::separation) struct PolygonOutline<N: Real> {
    blocks: SmallVec<[OutlineBlock<N>; MAX_BLOCKS]>,
    /// Number of vertices.
    pub(in crate::collide::separation) count: usize,
    /// Radius around the outline.
    pub(in crate::collide::separation) rounding: N,
}

/// Eight vertices; copies of the last one fill the last block.
#[derive(Clone, Copy)]
pub(in crate::collide::separation) struct OutlineBlock<N> {
    pub(in crate::collide::separation) vertices: [Row<N>; 2],
    /// Outward unit normals of the sides that start at the vertices; unspecified for a point.
    pub(in crate::collide::separation) normals: [Row<N>; 2],
}

impl<N: Real> PolygonOutline<N> {
    /// Returns the outline of a solid in its own frame. `None` for kinds other than ball, segment,
    /// capsule, triangle, box and polygon, for polygons of more than 32 vertices, and if the
    /// squared length of a segment's or triangle's side is close to underflow or overflow.
    #[inline(always)]
    pub(in crate::collide::separation) fn of<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        kind: &Kind<'_, N, 2>,
    ) -> Option<Self> {
        match kind {
            Kind::Ball(ball) => Some(Self::of_point(&Point::origin(), ball.radius())),
            Kind::Segment(segment) => Self::of_segment::<S, V>(simd, segment, N::ZERO),
            Kind::Capsule(capsule) => {
                Self::of_segment::<S, V>(simd, capsule.segment(), capsule.radius())
            }
            Kind::Triangle(triangle) => Self::of_triangle::<S, V>(simd, triangle),
            Kind::Cuboid(cuboid) => Some(Self::of_box(cuboid.half_extents())),
            Kind::Polytope(polygon) => Self::of_polygon(polygon),
            _ => None,
        }
    }

    #[inline(always)]
    fn of_block(vertices: [Row<N>; 2], normals: [Row<N>; 2], count: usize, rounding: N) -> Self {
        Self { blocks: smallvec![OutlineBlock { vertices, normals }], count, rounding }
    }

    #[inline(always)]
    fn of_point(point: &Point<N, 2>, radius: N) -> Self {
        Self::of_block([[point.x; LANES], [point.y; LANES]], [[N::ZERO; LANES]; 2], 1, radius)
    }

    /// Returns the outline of a segment, or of a point if both ends are equal. `None` if the
    /// squared length is close to underflow or overflow.
    #[inline(always)]
    pub(in crate::collide::separation) fn of_segment<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        segment: &Segment<N, 2>,
        radius: N,
    ) -> Option<Self> {
        if segment.a() == segment.b() {
            return Some(Self::of_point(segment.a(), radius));
        }
        let [is_last, _] = later_lanes::<S, N, V>(simd);
        let a: [V; 2] = spread(simd, &segment.a().coords);
        let b: [V; 2] = spread(simd, &segment.b().coords);
        let (vertices, ends) = (either(is_last, &b, &a), either(is_last, &a, &b));
        Self::of_ends(simd, &vertices, &ends, 2, radius)
    }

    /// Returns the outline of a triangle, whose corners may be in either order; equal corners are
    /// merged. `None` if the squared length of a side is close to underflow or overflow.
    #[inline(always)]
    fn of_triangle<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        triangle: &Triangle<N, 2>,
    ) -> Option<Self> {
        let [a, b, c] = triangle.corners();
        if a == b || b == c || c == a {
            let other = if a == b { c } else { b };
            return Self::of_segment::<S, V>(simd, &Segment::of_finite(*a, *other), N::ZERO);
        }
        let is_clockwise = cross2(&(b - a), &(c - a)) < N::ZERO;
        let (b, c) = if is_clockwise { (c, b) } else { (b, c) };
        let [is_later, is_last] = later_lanes::<S, N, V>(simd);
        let a: [V; 2] = spread(simd, &a.coords);
        let b: [V; 2] = spread(simd, &b.coords);
        let c: [V; 2] = spread(simd, &c.coords);
        let vertices = either(is_last, &c, &either(is_later, &b, &a));
        let ends = either(is_last, &a, &either(is_later, &c, &b));
        Self::of_ends(simd, &vertices, &ends, 3, N::ZERO)
    }

    #[inline(always)]
    fn of_box(half: &Vector<N, 2>) -> Self {
        let ([x, y], no, yes) = ([half.x, half.y], N::ZERO, N::ONE);
        let vertices = [[-x, x, x, -x, -x, -x, -x, -x], [-y, -y, y, y, y, y, y, y]];
        let normals = [
            [-no, yes, no, -yes, -yes, -yes, -yes, -yes],
            [-yes, no, yes, -no, -no, -no, -no, -no],
        ];
        Self::of_block(vertices, normals, 4, N::ZERO)
    }

    #[inline(always)]
    fn of_polygon(polygon: &Polytope<N, 2>) -> Option<Self> {
        let (vertices, planes) = (polygon.blocks(), polygon.planes());
        if vertices.len() > MAX_BLOCKS {
            return None;
        }
        let blocks = vertices.iter().zip(planes);
        let blocks = blocks.map(|(vertices, planes)| OutlineBlock {
            vertices: *vertices,
            normals: planes.normals,
        });
        Some(Self { blocks: blocks.collect(), count: polygon.vertices().len(), rounding: N::ZERO })
    }

    /// Returns the outline of `vertices` whose sides end at `ends`; `None` if a squared length is
    /// close to underflow or overflow.
    #[inline(always)]
    fn of_ends<S: Simd, V: Wide<S, Scalar = N>>(
        simd: S,
        vertices: &[V; 2],
        ends: &[V; 2],
        count: usize,
        radius: N,
    ) -> Option<Self> {
        let side = [ends[0] - vertices[0], ends[1] - vertices[1]];
        let squared = dot(&side, &side);
        if !is_square_in_range(simd, squared).all_true() {
            return None;
        }
        let length = squared.sqrt();
        let normals = [side[1] / length, -(side[0] / length)];
        Some(Self::of_block(stored(vertices), stored(&normals), count, radius))
    }

    /// Transforms the outline by `pose`.
    #[inline(always)]
    pub(in crate::collide::separation) fn placed<S: Simd, V: Wide<S, Scalar = N>>(
        mut self,
        simd: S,
        pose: &Pose<N, 2>,
    ) -> Self {
        let pose: LanePose<V, 2> = LanePose::of(simd, pose);
        for block in &mut self.blocks {
            block.vertices = stored(&pose.point(&load(simd, &block.vertices)));
            block.normals = stored(&pose.vector(&load(simd, &block.normals)));
        }
        self
    }

    #[inline(always)]
    pub(in crate::collide::separation) fn at(&self, vertex: usize) -> Point<N, 2> {
        let [xs, ys] = &self.blocks[vertex / LANES].vertices;
        Point::<N, 2>::new(xs[vertex % LANES], ys[vertex % LANES])
    }

    /// Returns the outward unit normal of the side that starts at a vertex.
    #[inline(always)]
    pub(in crate::collide::separation) fn normal(&self, vertex: usize) -> Vector<N, 2> {
        let [xs, ys] = &self.blocks[vertex / LANES].normals;
        Vector::<N, 2>::new(xs[vertex % LANES], ys[vertex % LANES])
    }

    #[inline(always)]
    pub(in crate::collide::separation) const fn next(&self, vertex: usize) -> usize {
        if vertex + 1 < self.count { vertex + 1 } else { 0 }
    }

    #[inline(always)]
    pub(in crate::collide::separation) const fn previous(&self, vertex: usize) -> usize {
        if vertex > 0 { vertex - 1 } else { self.count - 1 }
    }

    #[inline(always)]
    pub(in crate::collide::separation) const fn is_point(&self) -> bool {
        self.count < 2
    }

    /// Returns an upper bound of the distance of all vertices from the origin, at most twice the
    /// largest distance.
    #[inline(always)]
    pub(in crate::collide::separation) fn size<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
    ) -> N {
        let size = |block: &OutlineBlock<N>| {
            let [xs, ys]: [V; 2] = load(simd, &block.vertices);
            highest_lane(xs.abs() + ys.abs())
        };
        self.blocks.iter().fold(N::ZERO, |most, block| max(size(block), most))
    }

    /// Returns the largest coordinate along a direction and the first vertex that has it.
    #[inline(always)]
    pub(in crate::collide::separation) fn top<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        direction: &Vector<N, 2>,
    ) -> (N, usize) {
        let direction: [V; 2] = spread(simd, direction);
        let (mut most, mut vertex) = (-N::INFINITY, 0);
        for (number, block) in self.blocks.iter().enumerate() {
            let along: V = dot(&direction, &load(simd, &block.vertices));
            let (high, lane) = highest(simd, along);
            if high > most {
                (most, vertex) = (high, number * LANES + lane);
            }
        }
        (most, vertex)
    }

    /// Returns the largest coordinate of the vertices along each of 8 directions.
    #[inline(always)]
    pub(in crate::collide::separation) fn extent<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        directions: &[V; 2],
    ) -> V {
        let mut most = V::all(simd, -N::INFINITY);
        for (number, block) in self.blocks.iter().enumerate() {
            let [xs, ys] = &block.vertices;
            // The lanes after the last vertex hold copies of it, so the second half of a block with
            // at most four vertices is skipped.
            let halves = if self.count - number * LANES > LANES / 2 { 2 } else { 1 };
            for half in 0..halves {
                for lane in 0..LANES / 2 {
                    let lane = (half * LANES / 2 + lane) & (LANES - 1);
                    let at = [V::all(simd, xs[lane]), V::all(simd, ys[lane])];
                    most = dot(directions, &at).larger(most);
                }
            }
        }
        most
    }

    /// Returns all vertices, with the normals of the sides that start there, 8 per block.
    #[inline(always)]
    pub(in crate::collide::separation) fn blocks(&self) -> &[OutlineBlock<N>] {
        &self.blocks
    }

    /// Returns the tips of a block: the directions halfway between the normals beside each vertex.
    /// The mask has the lanes where a tip is needed, which are the corners sharper than a right
    /// angle.
    ///
    /// Normals of sides alone would leave gaps of more than a right angle between directions, and
    /// flat outlines that point at each other would count as overlapping.
    #[inline(always)]
    pub(in crate::collide::separation) fn tips<S: Simd, V: Wide<S, Scalar = N>>(
        &self,
        simd: S,
        block: usize,
    ) -> ([V; 2], V::Mask) {
        let normals = &self.blocks[block].normals;
        let last = self.normal(self.previous(block * LANES));
        let [mut xs, mut ys] = [[last.x; LANES], [last.y; LANES]];
        xs[1..].copy_from_slice(&normals[0][..LANES - 1]);
        ys[1..].copy_from_slice(&normals[1][..LANES - 1]);
        let (before, after): ([V; 2], [V; 2]) = (load(simd, &[xs, ys]), load(simd, normals));
        let is_tip = dot(&before, &after).simd_lt(V::all(simd, N::ZERO));
        // Rotating a normal by a right angle gives the direction of its side. The tip is the
        // difference of the directions of both sides.
        let tip = [-before[1] - -after[1], before[0] - after[0]];
        let length = dot(&tip, &tip).sqrt();
        ([tip[0] / length, tip[1] / length], is_tip)
    }
}

#[inline(always)]
fn stored<S: Simd, N: Real, V: Wide<S, Scalar = N>>(vectors: &[V; 2]) -> [Row<N>; 2] {
    let mut rows = [[N::ZERO; LANES]; 2];
    vectors[0].store(&mut rows[0]);
    vectors[1].store(&mut rows[1]);
    rows
}

/// Returns the mask of all lanes but the first, and of all but the first two.
#[inline(always)]
fn later_lanes<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S) -> [V::Mask; 2] {
    let (no, yes) = (N::ZERO, N::ONE);
    let zero = V::all(simd, no);
    [
        V::load(simd, &[no, yes, yes, yes, yes, yes, yes, yes]).simd_gt(zero),
        V::load(simd, &[no, no, yes, yes, yes, yes, yes, yes]).simd_gt(zero),
    ]
}

/// Returns the largest of 8 values, and the first lane that has it.
#[inline(always)]
pub(in crate::collide::separation) fn highest<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    numbers: V,
) -> (N, usize) {
    let mut lanes = [N::ZERO; LANES];
    numbers.store(&mut lanes);
    let [a, b, c, d, e, f, g, h] = lanes;
    let most = max(max(max(a, e), max(c, g)), max(max(b, f), max(d, h)));
    let is_most = numbers.simd_eq(V::all(simd, most)).to_bitmask();
    (most, (is_most.trailing_zeros() as usize).min(LANES - 1))
}

/// Returns the vector in a lane, as a point.
#[inline(always)]
pub(in crate::collide::separation) fn lane<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    vectors: &[V; 2],
    lane: usize,
) -> Point<N, 2> {
    let mut rows = [[N::ZERO; LANES]; 2];
    vectors[0].store(&mut rows[0]);
    vectors[1].store(&mut rows[1]);
    Point::<N, 2>::new(rows[0][lane], rows[1][lane])
}
