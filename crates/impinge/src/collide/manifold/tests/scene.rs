//! Pairs of solids in 2D and 3D, in `f32` and `f64`, for tests.

use super::super::{build2, build3};
use crate::collide::{ManifoldRequest, Pair, RawManifold};
use crate::convex::{self, Separation, Simplicial};
use crate::math::{Isometry2, Isometry3, Point, Pose, Real, Unit, Vector};
use crate::shape::{
    Ball, Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Geometry, Kind, Plane,
    Segment, Shape, Triangle,
};

/// A scalar type, for the dimension `D`, with the functions that tests of manifolds need in both
/// dimensions.
pub(crate) trait Scene<const D: usize>: Simplicial<D> {
    fn build(
        pair: &Pair<'_, Self, D>,
        separation: &Separation<Self, D>,
        request: &ManifoldRequest<Self>,
        out: &mut RawManifold<Self, D>,
    );

    /// Returns the pose with this translation and the rotation vector `turn`, axis times angle in
    /// radians. In 2D the last component is the angle.
    fn pose(translation: Vector<Self, D>, turn: [f64; 3]) -> Pose<Self, D>;

    /// Returns a random polytope, and a random solid of each kind that exists in this dimension
    /// only, in the order of kinds.
    fn own(scale: f64, random: &mut Random) -> Vec<Box<dyn Shape<Self, D>>>;
}

impl<N: Real> Scene<2> for N {
    fn build(
        pair: &Pair<'_, N, 2>,
        separation: &Separation<N, 2>,
        request: &ManifoldRequest<N>,
        out: &mut RawManifold<N, 2>,
    ) {
        build2(pair, separation, request, out);
    }

    fn pose(translation: Vector<N, 2>, turn: [f64; 3]) -> Pose<N, 2> {
        Pose::from_isometry(&Isometry2::new(translation, N::lit(turn[2])))
    }

    fn own(scale: f64, random: &mut Random) -> Vec<Box<dyn Shape<N, 2>>> {
        vec![Box::new(ConvexPolygon::from_points(&cloud(scale, random)))]
    }
}

impl<N: Real> Scene<3> for N {
    fn build(
        pair: &Pair<'_, N, 3>,
        separation: &Separation<N, 3>,
        request: &ManifoldRequest<N>,
        out: &mut RawManifold<N, 3>,
    ) {
        build3(pair, separation, request, out);
    }

    fn pose(translation: Vector<N, 3>, turn: [f64; 3]) -> Pose<N, 3> {
        Pose::from_isometry(&Isometry3::new(translation, turn.map(N::lit).into()))
    }

    fn own(scale: f64, random: &mut Random) -> Vec<Box<dyn Shape<N, 3>>> {
        let hull = ConvexHull::from_points(&cloud(scale, random));
        let mut length = || N::lit(random.between(0.3, 1.2) * scale);
        vec![
            Box::new(hull),
            Box::new(Cylinder::new(length(), length())),
            Box::new(Cone::new(length(), length())),
        ]
    }
}

/// Returns twelve random points in a cube (in 2D a square) around the origin.
fn cloud<N: Real, const D: usize>(scale: f64, random: &mut Random) -> Vec<Point<N, D>> {
    let mut position = || random.vector::<f64, D>(1.0).map(|x| N::lit(x * scale));
    (0..12).map(|_| Point::from(position())).collect()
}

/// A small linear congruential generator (Knuth's MMIX constants).
pub(crate) struct Random(pub(crate) u64);

impl Random {
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        self.0 =
            self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        let bits = u32::try_from(self.0 >> 40).expect("24 bits are left");
        low + (high - low) * f64::from(bits) / f64::from(1 << 24)
    }

    pub(crate) fn vector<N: Real, const D: usize>(&mut self, size: f64) -> Vector<N, D> {
        Vector::<N, D>::from_fn(|_, _| N::lit(self.between(-size, size)))
    }

    pub(crate) fn turn(&mut self) -> [f64; 3] {
        [self.between(-2.0, 2.0), self.between(-2.0, 2.0), self.between(-3.0, 3.0)]
    }
}

/// Returns a random solid of each of several kinds, in the order of kinds, with sizes of about
/// `scale`; the half-space is last.
pub(crate) fn solids<N: Scene<D>, const D: usize>(
    scale: f64,
    random: &mut Random,
) -> Vec<Box<dyn Shape<N, D>>> {
    let length = |random: &mut Random| N::lit(random.between(0.3, 1.2) * scale);
    let corner =
        |random: &mut Random| Point::from(random.vector::<f64, D>(1.0).map(|x| N::lit(x * scale)));
    let extents = Vector::<N, D>::from_fn(|_, _| length(random));
    let up = Unit::new_normalize(random.vector::<N, D>(1.0));
    let mut all: Vec<Box<dyn Shape<N, D>>> = vec![
        Box::new(Ball::new(length(random))),
        Box::new(Segment::new(corner(random), corner(random))),
        Box::new(Capsule::new(length(random), length(random))),
        Box::new(Triangle::new(corner(random), corner(random), corner(random))),
        Box::new(Cuboid::new(extents)),
    ];
    all.extend(N::own(scale, random));
    all.push(Box::new(Plane::new(up)));
    all
}

/// Returns the separation of a pair by the general algorithm; with a half-space as second solid,
/// from the support point of the first.
pub(crate) fn fact<N: Scene<D>, const D: usize>(pair: &Pair<'_, N, D>) -> Separation<N, D> {
    let first = Geometry(pair.first).as_support_map().expect("the first is no half-space");
    let Kind::Plane(plane) = pair.second else {
        let second = Geometry(pair.second).as_support_map().expect("nor is this one");
        return convex::separation(first, second, &pair.pose12, N::INFINITY).expect("finite");
    };
    let normal = -pair.pose12.vector(&plane.normal().into_inner());
    let point1 = first.support_point(&normal);
    let distance = -normal.dot(&(point1.coords - pair.pose12.translation));
    Separation { distance, normal, point1, point2: point1 + normal * distance }
}

/// Returns the signed distance of a point from the surface of a solid, in the solid's frame.
pub(crate) fn off_surface<N: Scene<D>, const D: usize>(
    kind: Kind<'_, N, D>,
    point: &Point<N, D>,
) -> N {
    if let Kind::Plane(plane) = kind {
        return plane.normal().dot(&point.coords);
    }
    let solid = Geometry(kind).as_support_map().expect("not a half-space");
    let at = Pose::from_translation(point.coords);
    convex::separation(solid, &Ball::new(N::ZERO), &at, N::INFINITY).expect("finite").distance
}

/// Computes the separation of a pair and builds its manifold, without a previous manifold.
pub(crate) fn manifold<N: Scene<D>, const D: usize>(
    pair: &Pair<'_, N, D>,
    request: &ManifoldRequest<N>,
) -> (Separation<N, D>, RawManifold<N, D>) {
    let (separation, mut out) = (fact(pair), RawManifold::default());
    N::build(pair, &separation, request, &mut out);
    (separation, out)
}

pub(crate) fn request<N: Real>(prediction: f64, sine: f64) -> ManifoldRequest<N> {
    ManifoldRequest { prediction: N::lit(prediction), sine: N::lit(sine), max_points: 4 }
}

/// Returns a pose of the second solid at which the distance of the solids is a random number
/// between `low * scale` and `high * scale`, only approximately if they overlap. The second solid
/// is placed apart and moved along the normal.
pub(crate) fn near_pose<N: Scene<D>, const D: usize>(
    solids: [Kind<'_, N, D>; 2],
    (scale, low, high): (f64, f64, f64),
    random: &mut Random,
) -> Pose<N, D> {
    let mut direction = random.vector::<N, D>(1.0);
    direction *= N::lit(6.0 * scale) / direction.norm();
    let mut pose12 = N::pose(direction, random.turn());
    let pair = Pair { first: solids[0], second: solids[1], pose12 };
    let apart = fact(&pair);
    let target = N::lit(random.between(low, high) * scale);
    pose12.translation -= apart.normal * (apart.distance - target);
    pose12
}

/// Calls `check` with every pair of kinds, for `count` sets of random solids, each pair at a random
/// pose. The signed distance of each pair is between -0.1 and 0.1 times `scale`, approximately if
/// the solids overlap. The half-space is always second.
pub(crate) fn for_all_pairs<N: Scene<D>, const D: usize>(
    count: u64,
    scale: f64,
    mut check: impl FnMut(&Pair<'_, N, D>),
) {
    for seed in 0..count {
        let mut random = Random(seed);
        let all = solids::<N, D>(scale, &mut random);
        for (index, first) in all[..all.len() - 1].iter().enumerate() {
            for second in &all[index..] {
                let kinds = [first.geometry().0, second.geometry().0];
                let pose12 = near_pose(kinds, (scale, -0.1, 0.1), &mut random);
                check(&Pair { first: kinds[0], second: kinds[1], pose12 });
            }
        }
    }
}

pub(crate) fn describe<N: Real, const D: usize>(pair: &Pair<'_, N, D>) -> String {
    let kinds = [pair.first, pair.second].map(|kind| Geometry(kind).kind());
    format!("{kinds:?} at {:?}", pair.pose12)
}
