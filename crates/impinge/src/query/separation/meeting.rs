//! How two outlines of the plane meet: a corner above a side, or two corners.
//!
//! Of all directions the normal of a side leaves the largest gap, unless the nearest points are two corners
//! (see [`polygon_polygon`](super::polygon_polygon)). So if the farthest corner of one outline lies beside the
//! best side of the other, nothing else needs to be looked at; and two corners of which each lies in front of
//! both sides of the other are the nearest points, however they were found. What is neither, within rounding,
//! is left to others.

use super::polygon_lanes::{LANES, Outline, Row, gaps};
use crate::math::lanes::{dot, highest_lane, minus};
use crate::math::simd::{Simd, SimdMask};
use crate::math::{Point, Pose, Real, Vector, Wide, cross2, unit};
use crate::shape::{Kind, Polytope, Segment, Triangle};

/// How the cores of two solids meet, in the frame of the first.
pub(in crate::query) struct Meeting<N: Real> {
    /// Unit, from the first to the second.
    pub(in crate::query) normal: Vector<N, 2>,
    /// How far apart they are along it: their distance, or their depth below zero.
    pub(in crate::query) gap: N,
    /// The solid of which a side is the best, and that side; none where two corners are the nearest points.
    pub(in crate::query) best: Option<(usize, usize)>,
    /// The corner of each solid that is farthest along the normal; of the best side that which it starts from.
    pub(in crate::query) corners: [usize; 2],
    /// The corners of both, counter-clockwise; the last one fills the rest.
    pub(in crate::query) rows: [[Row<N>; 2]; 2],
    /// The same corners as seen along the normal; see [`Self::place`] and [`Self::height`].
    seen: [[Row<N>; 2]; 2],
    pub(in crate::query) counts: [usize; 2],
    /// The radii by which the cores are swollen.
    pub(in crate::query) radii: [N; 2],
}

/// The largest gap that the normal of a side leaves to another outline, and that side, the first of equals.
#[inline(always)]
fn best_side<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    own: &Outline<N, V>,
    other: &Outline<N, V>,
) -> (N, usize) {
    if own.count < 2 {
        return (-N::INFINITY, 0);
    }
    farthest(simd, gaps(simd, own, other, &own.normals))
}

/// The greatest of eight numbers, and the first lane that has it.
#[inline(always)]
fn farthest<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, numbers: V) -> (N, usize) {
    let mut lanes = [N::ZERO; LANES];
    numbers.store(&mut lanes);
    let is_most = numbers.simd_ge(V::all(simd, highest_lane(numbers))).to_bitmask();
    let lane = (is_most.trailing_zeros() as usize).min(LANES - 1);
    (lanes[lane], lane)
}

impl<N: Real> Meeting<N> {
    /// Nothing is known yet.
    pub(in crate::query) fn unknown() -> Self {
        Self {
            normal: Vector::<N, 2>::zeros(),
            gap: N::ZERO,
            best: None,
            corners: [0; 2],
            rows: [[[N::ZERO; LANES]; 2]; 2],
            seen: [[[N::ZERO; LANES]; 2]; 2],
            counts: [0; 2],
            radii: [N::ZERO; 2],
        }
    }

    /// Finds how two solids meet that have outlines of up to eight corners; answers
    /// false for others and where lengths up to `noise` would decide.
    #[inline(always)]
    pub(in crate::query) fn find<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        [kind1, kind2]: [&Kind<'_, N, 2>; 2],
        pose12: &Pose<N, 2>,
        noise: N,
    ) -> bool {
        let Some(own) = outline::<S, N, V>(simd, kind1) else { return false };
        let Some(other) = outline::<S, N, V>(simd, kind2) else { return false };
        let other = other.placed(simd, pose12);
        self.rows = [own.rows, other.rows];
        self.counts = [own.count, other.count];
        self.radii = [own.rounding, other.rounding];
        let (gap1, side1) = best_side(simd, &own, &other);
        let (gap2, side2) = best_side(simd, &other, &own);
        if gap2 > gap1 {
            self.settle(simd, 1, side2, gap2, [&other, &own]);
            self.normal = -self.normal;
        } else {
            self.settle(simd, 0, side1, gap1, [&own, &other]);
        }
        if !self.is_settled(noise) {
            return false;
        }
        self.see::<S, V>(simd, [&own, &other]);
        true
    }

    /// Notes the best side, of a given solid, its normal, and the corner of the other one.
    #[inline(always)]
    fn settle<S: Simd, V: Wide<S, Scalar = N>>(
        &mut self,
        simd: S,
        which: usize,
        side: usize,
        gap: N,
        [own, other]: [&Outline<N, V>; 2],
    ) {
        let mut normals = [[N::ZERO; LANES]; 2];
        own.normals[0].store(&mut normals[0]);
        own.normals[1].store(&mut normals[1]);
        let lane = side & (LANES - 1);
        let outward = Vector::<N, 2>::new(normals[0][lane], normals[1][lane]);
        let back = [V::all(simd, -outward.x), V::all(simd, -outward.y)];
        let (_, corner) = farthest(simd, dot(&back, &other.vertices));
        (self.best, self.gap, self.normal) = (Some((which, side)), gap, outward);
        self.corners = if which == 0 { [side, corner] } else { [corner, side] };
    }

    /// A corner, in the frame of the first solid.
    #[inline(always)]
    pub(in crate::query) fn corner(&self, which: usize, corner: usize) -> Point<N, 2> {
        let [xs, ys] = &self.rows[which & 1];
        Point::<N, 2>::new(xs[corner & (LANES - 1)], ys[corner & (LANES - 1)])
    }

    /// How far a corner is along the line of contact, from the nearest corner of the first solid.
    #[inline(always)]
    pub(in crate::query) fn place(&self, which: usize, corner: usize) -> N {
        self.seen[which & 1][0][corner & (LANES - 1)]
    }

    /// How far a corner is along the normal, from the nearest corner of the first solid.
    #[inline(always)]
    pub(in crate::query) fn height(&self, which: usize, corner: usize) -> N {
        self.seen[which & 1][1][corner & (LANES - 1)]
    }

    /// The height of the nearest corner of a solid.
    #[inline(always)]
    pub(in crate::query) fn level(&self, which: usize) -> N {
        if which == 0 { N::ZERO } else { self.gap }
    }

    /// Of the way from one corner to another the square of what it rises along the normal, and of its length.
    #[inline(always)]
    pub(in crate::query) fn tilt(&self, which: usize, from: usize, to: usize) -> (N, N) {
        let way = self.corner(which, to) - self.corner(which, from);
        let rise = way.dot(&self.normal);
        (rise * rise, way.norm_squared())
    }

    /// Looks at all corners along the normal.
    #[inline(always)]
    fn see<S: Simd, V: Wide<S, Scalar = N>>(&mut self, simd: S, outlines: [&Outline<N, V>; 2]) {
        let (from, normal) = (self.corner(0, self.corners[0]), self.normal);
        let from = [V::all(simd, from.x), V::all(simd, from.y)];
        let up = [V::all(simd, normal.x), V::all(simd, normal.y)];
        let along = [up[1], V::all(simd, -normal.x)];
        for (seen, outline) in self.seen.iter_mut().zip(outlines) {
            let arm = minus(&outline.vertices, &from);
            dot(&along, &arm).store(&mut seen[0]);
            dot(&up, &arm).store(&mut seen[1]);
        }
    }

    #[inline(always)]
    pub(in crate::query) fn next(&self, which: usize, corner: usize) -> usize {
        if corner + 1 < self.counts[which & 1] { corner + 1 } else { 0 }
    }

    #[inline(always)]
    pub(in crate::query) fn previous(&self, which: usize, corner: usize) -> usize {
        if corner > 0 { corner - 1 } else { self.counts[which & 1] - 1 }
    }

    /// The best side is settled: either it is the one, or the corners next to each other are the nearest.
    #[inline(always)]
    fn is_settled(&mut self, noise: N) -> bool {
        let Some((which, side)) = self.best else { return false };
        if !self.gap.is_finite_number() {
            return false;
        }
        let (from, to) = (self.corner(which, side), self.corner(which, self.next(which, side)));
        let above = self.corner(1 - which, self.corners[1 - which]);
        let along = to - from;
        let is_after = (above - from).dot(&along) > N::ZERO;
        if is_after && (to - above).dot(&along) > N::ZERO {
            return true;
        }
        let end = if is_after { self.next(which, side) } else { side };
        self.are_corners_nearest(which, end, noise) || self.gap < -noise
    }

    /// Whether the end of the best side that is next to the corner of the other solid, and that corner, are
    /// the nearest points; if so, they are what is settled.
    #[inline(never)]
    fn are_corners_nearest(&mut self, which: usize, end: usize, noise: N) -> bool {
        let mut ends = self.corners;
        ends[which & 1] = end;
        let places = [self.corner(0, ends[0]), self.corner(1, ends[1])];
        let between = places[1] - places[0];
        let is_behind = |solid: usize, toward: &Vector<N, 2>| {
            let (at, end) = (&places[solid], ends[solid]);
            let before = at - self.corner(solid, self.previous(solid, end));
            let after = self.corner(solid, self.next(solid, end)) - at;
            toward.dot(&before) >= N::ZERO && toward.dot(&after) <= N::ZERO
        };
        if !(is_behind(0, &between) && is_behind(1, &-between)) {
            return false;
        }
        match unit(&between).filter(|(_, length)| *length > noise) {
            Some((normal, length)) => {
                (self.normal, self.gap, self.best, self.corners) = (normal, length, None, ends);
                true
            }
            None => false,
        }
    }
}

/// The outline of a solid in its own frame; `None` of other kinds, and where a length is no usual number.
#[inline(always)]
fn outline<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    kind: &Kind<'_, N, 2>,
) -> Option<Outline<N, V>> {
    match kind {
        Kind::Rounded(solid) => {
            let mut inner = bare(simd, &solid.inner().0)?;
            inner.rounding += solid.swelling();
            Some(inner)
        }
        _ => bare(simd, kind),
    }
}

#[inline(always)]
fn bare<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    kind: &Kind<'_, N, 2>,
) -> Option<Outline<N, V>> {
    match kind {
        Kind::Segment(segment) => of_segment(simd, segment, N::ZERO),
        Kind::Capsule(capsule) => of_segment(simd, capsule.segment(), capsule.radius()),
        Kind::Triangle(triangle) => of_triangle(simd, triangle),
        Kind::Cuboid(cuboid) => Some(of_box(simd, cuboid.half_extents())),
        Kind::Polytope(polygon) => of_polytope(simd, polygon),
        _ => None,
    }
}

/// All lanes but the first, and all but the first two.
#[inline(always)]
fn later_lanes<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S) -> [V::Mask; 2] {
    let (no, yes) = (N::ZERO, N::ONE);
    let zero = V::all(simd, no);
    [
        V::load(simd, &[no, yes, yes, yes, yes, yes, yes, yes]).simd_gt(zero),
        V::load(simd, &[no, no, yes, yes, yes, yes, yes, yes]).simd_gt(zero),
    ]
}

#[inline(always)]
fn of_segment<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    segment: &Segment<N, 2>,
    rounding: N,
) -> Option<Outline<N, V>> {
    let [is_last, _] = later_lanes::<S, N, V>(simd);
    let (a, b) = (segment.a(), segment.b());
    let a = [V::all(simd, a.x), V::all(simd, a.y)];
    let b = [V::all(simd, b.x), V::all(simd, b.y)];
    let vertices = [is_last.select(b[0], a[0]), is_last.select(b[1], a[1])];
    let ends = [is_last.select(a[0], b[0]), is_last.select(a[1], b[1])];
    Outline::of_ends(simd, vertices, ends, 2, rounding)
}

#[inline(always)]
fn of_triangle<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    triangle: &Triangle<N, 2>,
) -> Option<Outline<N, V>> {
    let [a, b, c] = triangle.corners();
    let is_clockwise = cross2(&(b - a), &(c - a)) < N::ZERO;
    let (b, c) = if is_clockwise { (c, b) } else { (b, c) };
    let [is_later, is_last] = later_lanes::<S, N, V>(simd);
    let [a, b, c] = [[a.x, a.y], [b.x, b.y], [c.x, c.y]];
    let (mut vertices, mut ends) = ([V::all(simd, N::ZERO); 2], [V::all(simd, N::ZERO); 2]);
    for axis in 0..2 {
        let (a, b, c) = (V::all(simd, a[axis]), V::all(simd, b[axis]), V::all(simd, c[axis]));
        vertices[axis] = is_last.select(c, is_later.select(b, a));
        ends[axis] = is_last.select(a, is_later.select(c, b));
    }
    Outline::of_ends(simd, vertices, ends, 3, N::ZERO)
}

#[inline(always)]
fn of_box<S: Simd, N: Real, V: Wide<S, Scalar = N>>(simd: S, half: &Vector<N, 2>) -> Outline<N, V> {
    let (no, yes) = (N::ZERO, N::ONE);
    let xs = V::load(simd, &[-yes, yes, yes, -yes, -yes, -yes, -yes, -yes]);
    let ys = V::load(simd, &[-yes, -yes, yes, yes, yes, yes, yes, yes]);
    let normals = [
        V::load(simd, &[-no, yes, no, -yes, -yes, -yes, -yes, -yes]),
        V::load(simd, &[-yes, no, yes, -no, -no, -no, -no, -no]),
    ];
    let vertices = [xs * V::all(simd, half.x), ys * V::all(simd, half.y)];
    Outline::of_sides(vertices, normals, 4, N::ZERO)
}

#[inline(always)]
fn of_polytope<S: Simd, N: Real, V: Wide<S, Scalar = N>>(
    simd: S,
    polygon: &Polytope<N, 2>,
) -> Option<Outline<N, V>> {
    let ([vertices], [planes]) = (polygon.blocks(), polygon.planes()) else { return None };
    let normals = [V::load(simd, &planes.normals[0]), V::load(simd, &planes.normals[1])];
    let corners = [V::load(simd, &vertices[0]), V::load(simd, &vertices[1])];
    Some(Outline::of_sides(corners, normals, polygon.vertices().len(), N::ZERO))
}
