//! Lower bounds of the distances of the parts of a surface from a convex solid.
//!
//! Most parts whose boxes are near are not near themselves. A plane between the solid and a part says
//! so for the price of a few products: the one across the shortest way from the part to the solid's
//! middle. Any plane gives a lower bound of the distance, so no case needs care but for rounding.

use super::cull_lanes::LowerBoundQuery;
use super::part_cache::PartCache;
use crate::bounding_volume::{Aabb, BoundingVolume};
use crate::collide::Pair;
use crate::collide::parts::between::Between;
use crate::math::{Mapped, Point, Pose, Real, Space, Vector, max, max_component, min};
use crate::shape::{CompositeShape, Geometry, Kind, Part, PartSolid, SupportMap};

/// Bounds are loosened by so many rounding units of all lengths, or by what is left where the search
/// for the distance of curved solids stops, whichever is more.
const ROUNDING: f64 = 128.0;
const CURVED: f64 = 1.0e-10;

/// The slack of bounds, as a share of all lengths.
#[inline]
pub(super) fn relative_slack<N: Real>() -> N {
    max(N::lit(ROUNDING) * N::EPSILON, N::lit(CURVED))
}

/// What is shorter has lost digits.
#[inline]
pub(super) fn least_length<N: Real>() -> N {
    N::MIN_POSITIVE / N::EPSILON
}

/// A convex first shape, as the second sees it.
pub(super) struct CullProbe<'a, N: Real, const D: usize> {
    map: &'a dyn SupportMap<N, D>,
    /// Its core is the middle alone.
    is_ball: bool,
    pose21: &'a Pose<N, D>,
    center: Point<N, D>,
    /// Parts beyond this are of no interest.
    reach: N,
    /// The size of the solid, its place and the reach.
    size: N,
}

/// What a probe finds of a part.
pub(super) struct Bound<N> {
    /// The part is at least so far from the middle of the solid; zero if that is not known.
    pub(super) from_middle: N,
    /// The part is out of reach.
    pub(super) is_beyond: bool,
}

impl<'a, N: Space<D>, const D: usize> CullProbe<'a, N, D> {
    /// `None` of two composites and of half-spaces.
    pub(super) fn new(between: &'a Between<'a, N, D>, reach: N) -> Option<Self> {
        let Pair { first, .. } = between.pair;
        let map = Geometry(first).as_support_map()?;
        let (is_ball, pose21) = (matches!(first, Kind::Ball(_)), &between.pose21);
        let center = pose21.point(&map.center());
        let own = if is_ball { map.rounding() } else { map.reach() + map.rounding() };
        let size = own + reach + max_component(&pose21.translation);
        Some(Self { map, is_ball, pose21, center, reach, size })
    }

    /// The middle of the solid.
    pub(super) const fn center(&self) -> &Point<N, D> {
        &self.center
    }

    /// The query of parts that are kept by their corners, in a box.
    pub(super) fn lower_bound_query(
        &self,
        around: &mut PartCache<N, D>,
        within: &Aabb<N, D>,
    ) -> LowerBoundQuery<N, D> {
        LowerBoundQuery {
            center: self.center.coords,
            turn: self.pose21.rotation,
            half: around.half(self.map),
            rounding: self.map.rounding(),
            reach: self.reach,
            low: within.mins().coords,
            high: within.maxs().coords,
            size: self.size,
        }
    }

    /// What is known of a part of a composite; nothing of one that is not given by its corners. `None`
    /// if it is found to lie outside a box.
    pub(super) fn bound(
        &self,
        parts: &dyn CompositeShape<N, D>,
        part: u32,
        within: Option<&Aabb<N, D>>,
    ) -> Option<Bound<N>> {
        let Part { pose, solid } = parts.part(part);
        // Most composites that are given by corners give them in their own frame.
        let is_own = pose.is_same(&Pose::identity());
        let placed = |corner: &Point<N, D>| if is_own { *corner } else { pose.point(corner) };
        match solid {
            PartSolid::Triangle(triangle) => {
                let [a, b, c] = triangle.corners();
                let corners = [placed(a), placed(b), placed(c)];
                is_in(&corners, within)
                    .then(|| self.of_corners(&corners, &to_triangle(&corners, &self.center)))
            }
            PartSolid::Segment(segment) => {
                let corners = [placed(segment.a()), placed(segment.b())];
                is_in(&corners, within)
                    .then(|| self.of_corners(&corners, &to_segment(&corners, &self.center)))
            }
            PartSolid::Shape(shape) => {
                let is_in = |within: &Aabb<N, D>| within.intersects(&shape.aabb(&pose));
                within.is_none_or(is_in).then_some(Bound { from_middle: N::ZERO, is_beyond: false })
            }
        }
    }

    /// What the planes across a direction from the part to the middle say.
    fn of_corners<const K: usize>(
        &self,
        corners: &[Point<N, D>; K],
        toward: &Vector<N, D>,
    ) -> Bound<N> {
        let (mut least, mut farthest) = (N::INFINITY, N::ZERO);
        for corner in corners {
            let arm = self.center - corner;
            least = min(least, toward.dot(&arm));
            farthest = max(farthest, arm.norm_squared());
        }
        let length = toward.norm();
        let slack = relative_slack::<N>() * (farthest.sqrt() + self.size);
        // NaN bounds nothing, nor what has lost digits by being small.
        let is_bound = length > slack && least > least_length();
        if !is_bound {
            return Bound { from_middle: N::ZERO, is_beyond: false };
        }
        let from_middle = least / length - slack;
        let own = if self.is_ball { self.map.rounding() } else { self.extent(toward, length) };
        Bound { from_middle, is_beyond: from_middle - own - slack > self.reach }
    }

    /// How far the solid reaches from its middle against a direction of a given length.
    fn extent(&self, toward: &Vector<N, D>, length: N) -> N {
        let local = -self.pose21.inverse_vector(toward);
        let farthest = self.map.core_support(&local) - self.map.center();
        local.dot(&farthest) / length + self.map.rounding()
    }
}

/// The box of some corners overlaps a box, if one is given.
#[inline]
fn is_in<N: Real, const D: usize, const K: usize>(
    corners: &[Point<N, D>; K],
    within: Option<&Aabb<N, D>>,
) -> bool {
    let Some(within) = within else { return true };
    (0..D).all(|axis| {
        let (mut low, mut high) = (corners[0][axis], corners[0][axis]);
        for corner in &corners[1..] {
            (low, high) = (min(low, corner[axis]), max(high, corner[axis]));
        }
        low <= within.maxs()[axis] && high >= within.mins()[axis]
    })
}

/// From the point of a segment nearest to a point, to that.
fn to_segment<N: Real, const D: usize>(ends: &[Point<N, D>; 2], p: &Point<N, D>) -> Vector<N, D> {
    let (along, arm) = (ends[1] - ends[0], p - ends[0]);
    let share = along.dot(&arm) / along.norm_squared();
    let share = if share > N::ZERO { min(share, N::ONE) } else { N::ZERO };
    arm - along * share
}

/// From the point of a triangle nearest to a point, to that: in the middle by its shares of the
/// corners, else the nearest of the sides. In any dimension.
fn to_triangle<N: Real, const D: usize>(
    corners: &[Point<N, D>; 3],
    p: &Point<N, D>,
) -> Vector<N, D> {
    let [a, b, c] = corners;
    let (ab, ac, ap) = (b - a, c - a, p - a);
    let (d1, d2) = (ab.dot(&ap), ac.dot(&ap));
    let (bb, bc, cc) = (ab.norm_squared(), ab.dot(&ac), ac.norm_squared());
    // The shares of two corners, times four squared areas.
    let (at_b, at_c) = (d1 * cc - d2 * bc, d2 * bb - d1 * bc);
    let area = bb * cc - bc * bc;
    if at_b >= N::ZERO && at_c >= N::ZERO && at_b + at_c <= area && area > N::ZERO {
        return ap - ab * (at_b / area) - ac * (at_c / area);
    }
    let sides = [[*a, *b], [*b, *c], [*c, *a]].mapped(|side| to_segment(&side, p));
    let nearer = |x: Vector<N, D>, y: Vector<N, D>| {
        if y.norm_squared() < x.norm_squared() { y } else { x }
    };
    sides.into_iter().reduce(nearer).unwrap_or(ap)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::collide::parts::Between;
    use crate::shape::{Ball, Cuboid, Shape, TriMesh};

    type P3 = Point<f64, 3>;

    /// Numbers from -1 to 1.
    fn noise(state: &mut u64) -> f64 {
        *state ^= *state << 13;
        *state ^= *state >> 7;
        *state ^= *state << 17;
        (*state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }

    /// The least distance from a point to places all over a triangle: never below the true one.
    fn sampled([a, b, c]: &[P3; 3], p: &P3) -> f64 {
        const STEPS: u32 = 48;
        let shares = (0..=STEPS).flat_map(|v| (0..=STEPS - v).map(move |w| (v, w)));
        let distance = |(v, w): (u32, u32)| {
            let [v, w] = [v, w].mapped(|share| f64::from(share) / f64::from(STEPS));
            (a + (b - a) * v + (c - a) * w - p).norm()
        };
        shares.map(distance).fold(f64::INFINITY, f64::min)
    }

    /// The bounds that a solid at the origin has of a mesh of one triangle: that of the triangle alone,
    /// and that of eight side by side.
    fn bounds(solid: &dyn Shape<f64, 3>, corners: [P3; 3], reach: f64) -> [Bound<f64>; 2] {
        let mesh = TriMesh::new(corners.to_vec(), vec![[0, 1, 2]]);
        let geometries = (solid.geometry(), mesh.geometry());
        let pose12 = Pose::identity();
        let pair = Pair { first: geometries.0.0, second: geometries.1.0, pose12 };
        let between = Between::of_pair(&pair);
        let probe = CullProbe::new(&between, reach).expect("a convex solid");
        let everywhere = Aabb::new(P3::from([-9.0; 3]), P3::from([9.0; 3]));
        let mut around = PartCache::default();
        assert!(around.reaches(&mesh, &everywhere), "one triangle is kept");
        let query = probe.lower_bound_query(&mut around, &everywhere);
        let found = query.bounds(&around.tiles()[0]);
        let is_beyond = found.near & 1 == 0;
        assert_eq!(found.near == u8::MAX, !is_beyond, "the one stands for all eight");
        let together = Bound { from_middle: found.from_middle, is_beyond };
        [probe.bound(&mesh, 0, None).expect("no box is given"), together]
    }

    #[test]
    fn bounds_are_below_the_distance_and_close_to_it() {
        let (mut state, mut close, origin) = (1_u64, 0, P3::origin());
        for round in 0..400 {
            // Every other one is a sliver.
            let thin = if round % 2 == 0 { 1.0 } else { 1e-9 };
            let mut corner = || P3::from([0, 1, 2].mapped(|_| 2.0 * noise(&mut state)));
            let [a, b, mut c] = [corner(), corner(), corner()];
            c = a + (b - a) * 0.3 + (c - a) * thin;
            let truth = sampled(&[a, b, c], &origin);
            for found in bounds(&Ball::new(0.25), [a, b, c], 0.1) {
                let bound = found.from_middle;
                assert!(bound <= truth, "{a} {b} {c}: {bound} {truth}");
                assert!(!found.is_beyond || truth > 0.35, "{a} {b} {c}: {truth}");
                close += u32::from(bound > 0.95 * truth && found.is_beyond == (truth > 0.36));
            }
        }
        assert!(close > 700, "close in {close} cases of 800");
    }

    #[test]
    fn a_box_is_separated_from_triangles_below_it() {
        let below = |y: f64| [P3::new(-3.0, y, -3.0), P3::new(3.0, y, -3.0), P3::new(0.0, y, 4.0)];
        let cuboid = Cuboid::new(Vector::<f64, 3>::new(0.5, 0.5, 0.5));
        for near in bounds(&cuboid, below(-0.6), 0.2) {
            assert!(!near.is_beyond && (near.from_middle - 0.6).abs() < 1e-6, "within reach");
        }
        for far in bounds(&cuboid, below(-0.8), 0.2) {
            assert!(far.is_beyond, "out of reach");
        }
        for through in bounds(&cuboid, below(0.0), 0.2) {
            assert!(!through.is_beyond && through.from_middle == 0.0, "through the middle");
        }
    }
}
