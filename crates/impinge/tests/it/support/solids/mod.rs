//! Shapes with a slow and simple description: a convex level function that is zero on the boundary.
//!
//! The function is negative inside and positive outside. It is computed in `f64` from numbers that
//! `f32` represents exactly.

#![allow(dead_code, reason = "each of the tests that share this file uses its part")]

use impinge::math::{AbstractRotation, Isometry, Point, Pose, Real, Unit, Vector};
use impinge::shape::{
    self, Ball, Capsule, Cone, ConvexHull, ConvexPolygon, Cuboid, Cylinder, Geometry, Plane,
    Segment, Shape, ShapeHandle, SupportMap, Triangle,
};

/// A small deterministic generator (Steele, Lea and Flood, `SplitMix`, 2014).
#[derive(Debug)]
pub(crate) struct Rng {
    state: u64,
    scale: f64,
}

impl Rng {
    pub(crate) fn new(seed: u64) -> Self {
        Self::scaled(seed, 1.0)
    }

    /// Returns a generator whose lengths are the lengths of `new` times `scale`, a power of two.
    pub(crate) fn scaled(seed: u64, scale: f64) -> Self {
        Self { state: seed, scale }
    }

    pub(crate) fn bits(&mut self) -> u64 {
        self.state = self.state.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.state;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// Returns a multiple of 1/1024 between `low` and `high`, times the scale: exact in `f32`.
    pub(crate) fn between(&mut self, low: f64, high: f64) -> f64 {
        let fraction = (self.bits() >> 11) as f64 / (1_u64 << 53) as f64;
        ((low + (high - low) * fraction) * 1024.0).round() / 1024.0 * self.scale
    }

    pub(crate) fn vector<const D: usize>(&mut self, reach: f64) -> Vector<f64, D> {
        Vector::<f64, D>::from_fn(|_, _| self.between(-reach, reach))
    }
}

pub(crate) fn narrow<N: Real, const D: usize>(v: &Vector<f64, D>) -> Vector<N, D> {
    v.map(N::lit)
}

pub(crate) fn wide<N: Real, const D: usize>(v: &Vector<N, D>) -> Vector<f64, D> {
    v.map(N::as_f64)
}

/// Converts a world point to the local frame of `m`, in `f64`.
pub(crate) fn local<N: Real, R: AbstractRotation<N, D>, const D: usize>(
    m: &Isometry<N, R, D>,
    point: &Vector<f64, D>,
) -> Vector<f64, D> {
    let pose = Pose::from_isometry(m);
    pose.rotation.map(N::as_f64).tr_mul(&(point - wide(&pose.translation)))
}

/// Converts a world direction to the local frame of `m`, in `f64`.
pub(crate) fn turned_back<N: Real, R: AbstractRotation<N, D>, const D: usize>(
    m: &Isometry<N, R, D>,
    direction: &Vector<N, D>,
) -> Vector<f64, D> {
    Pose::from_isometry(m).rotation.map(N::as_f64).tr_mul(&wide(direction))
}

pub(crate) type Level<const D: usize> = Box<dyn Fn(&Vector<f64, D>) -> f64>;

#[derive(Debug)]
pub(crate) struct Solid<N: Real, const D: usize> {
    pub(crate) name: &'static str,
    pub(crate) shape: ShapeHandle<N, D>,
    pub(crate) level: Debugless<D>,
    /// A point inside.
    pub(crate) center: Vector<f64, D>,
    /// Largest distance of the points of the solid from the local origin. For a half-space, the
    /// scale of the points at which rays aim.
    pub(crate) size: f64,
}

pub(crate) struct Debugless<const D: usize>(pub(crate) Level<D>);

impl<const D: usize> std::fmt::Debug for Debugless<D> {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str("level")
    }
}

impl<N: Real, const D: usize> Solid<N, D> {
    fn new<S: Shape<N, D>>(name: &'static str, shape: S, size: f64, level: Level<D>) -> Self {
        let center = Vector::<f64, D>::zeros();
        Self { name, shape: ShapeHandle::new(shape), level: Debugless(level), center, size }
    }

    pub(crate) fn at(&self, point: &Vector<f64, D>) -> f64 {
        (self.level.0)(point)
    }

    /// Returns the point at which the boundary is crossed from the centre along a direction; `None`
    /// if the solid extends farther than four times its size in that direction.
    pub(crate) fn boundary(&self, direction: &Vector<f64, D>) -> Option<Vector<f64, D>> {
        let (mut low, mut high) = (0.0, 4.0 * self.size / direction.norm());
        if self.at(&(self.center + direction * high)) < 0.0 {
            return None;
        }
        for _ in 0..80 {
            let middle = 0.5 * (low + high);
            let inside = self.at(&(self.center + direction * middle)) < 0.0;
            *(if inside { &mut low } else { &mut high }) = middle;
        }
        Some(self.center + direction * low)
    }
}

fn to_segment<const D: usize>(p: &Vector<f64, D>, a: &Vector<f64, D>, b: &Vector<f64, D>) -> f64 {
    let t = (p - a).dot(&(b - a)) / (b - a).norm_squared().max(f64::MIN_POSITIVE);
    (p - (a + (b - a) * t.clamp(0.0, 1.0))).norm()
}

/// An ellipsoid (in 2D an ellipse) that queries know only by its support points.
#[derive(Debug)]
pub(crate) struct Ellipsoid<N: Real, const D: usize>(pub(crate) Vector<N, D>);

impl<N: Real, const D: usize> SupportMap<N, D> for Ellipsoid<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        let scaled = self.0.component_mul(direction);
        let length = scaled.norm();
        if length == N::ZERO {
            return Point::origin();
        }
        Point::from(self.0.component_mul(&(scaled / length)))
    }
}

impl<N: Real, const D: usize> Shape<N, D> for Ellipsoid<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry::support_map(self)
    }

    fn local_aabb(&self) -> impinge::bounding_volume::Aabb<N, D> {
        impinge::bounding_volume::Aabb::new(Point::from(-self.0), Point::from(self.0))
    }
}

/// A box with rounded edges that queries know only by its support points and its radius.
#[derive(Debug)]
pub(crate) struct RoundBox<N: Real, const D: usize>(pub(crate) Cuboid<N, D>, pub(crate) N);

impl<N: Real, const D: usize> SupportMap<N, D> for RoundBox<N, D> {
    fn core_support(&self, direction: &Vector<N, D>) -> Point<N, D> {
        self.0.core_support(direction)
    }

    fn rounding(&self) -> N {
        self.1
    }
}

impl<N: Real, const D: usize> Shape<N, D> for RoundBox<N, D> {
    fn geometry(&self) -> Geometry<'_, N, D> {
        Geometry::support_map(self)
    }

    fn local_aabb(&self) -> impinge::bounding_volume::Aabb<N, D> {
        let reach = self.0.half_extents() + Vector::<N, D>::repeat(self.1);
        impinge::bounding_volume::Aabb::new(Point::from(-reach), Point::from(reach))
    }
}

fn beyond<const D: usize>(p: &Vector<f64, D>, half: &Vector<f64, D>) -> Vector<f64, D> {
    p.abs() - half
}

/// Returns solids of random sizes that exist in every dimension.
pub(crate) fn common<N: Real, const D: usize>(rng: &mut Rng) -> Vec<Solid<N, D>> {
    let radius = rng.between(0.25, 2.0);
    let half = Vector::<f64, D>::from_fn(|_, _| rng.between(0.25, 2.0));
    let (a, b) = (rng.vector::<D>(2.0), rng.vector::<D>(2.0));
    let thickness = rng.between(0.25, 1.0);
    let mut normal = Vector::<f64, D>::zeros();
    normal[(rng.bits() % 2) as usize] = 1.0;
    let capsule =
        Capsule::try_from_ends(Point::from(narrow(&a)), Point::from(narrow(&b)), N::lit(thickness))
            .expect("good numbers");
    let round = RoundBox(Cuboid::new(narrow(&half)), N::lit(thickness));
    let mut solids = vec![
        Solid::new("ball", Ball::new(N::lit(radius)), radius, {
            Box::new(move |p: &Vector<f64, D>| p.norm() - radius)
        }),
        Solid::new("cuboid", Cuboid::new(narrow(&half)), half.norm(), {
            Box::new(move |p| beyond(p, &half).max())
        }),
        Solid::new("capsule", capsule, a.norm().max(b.norm()) + thickness, {
            Box::new(move |p| to_segment(p, &a, &b) - thickness)
        }),
        Solid::new("plane", Plane::new(Unit::new_unchecked(narrow(&normal))), 2.0, {
            Box::new(move |p| normal.dot(p))
        }),
        Solid::new("ellipsoid", Ellipsoid(narrow(&half)), half.norm(), {
            Box::new(move |p| (p.component_div(&half).norm() - 1.0) * half.min())
        }),
        Solid::new("round box", round, half.norm() + thickness, {
            Box::new(move |p| {
                let out = beyond(p, &half);
                out.map(|x| x.max(0.0)).norm() + out.max().min(0.0) - thickness
            })
        }),
    ];
    let pebble = move |p: &Vector<f64, D>| (p.component_div(&half).norm() - 1.0) * half.min();
    let pebble_of = shape::Ellipsoid::new(narrow(&half));
    solids.push(Solid::new("pebble", pebble_of, half.norm(), Box::new(pebble)));
    let inflated = shape::Rounded::<N, D>::new(Cuboid::new(narrow(&half)), N::lit(thickness));
    let level = move |p: &Vector<f64, D>| {
        let out = beyond(p, &half);
        out.map(|x| x.max(0.0)).norm() + out.max().min(0.0) - thickness
    };
    solids.push(Solid::new("rounded box", inflated, half.norm() + thickness, Box::new(level)));
    solids.push(club(rng));
    solids[2].center = (a + b) * 0.5;
    solids[3].center = -normal;
    solids
}

/// Returns a tapered capsule: the union of balls whose centres and radii change linearly.
fn club<N: Real, const D: usize>(rng: &mut Rng) -> Solid<N, D> {
    let (a, b) = (rng.vector::<D>(2.0), rng.vector::<D>(2.0));
    let (first, second) = (rng.between(0.25, 1.0), rng.between(0.25, 1.0));
    let (ends, radii) = ([a, b].map(|end| Point::from(narrow(&end))), [first, second].map(N::lit));
    let shape = shape::TaperedCapsule::try_from_ends(ends[0], ends[1], radii).expect("numbers");
    let level = move |p: &Vector<f64, D>| {
        let (axis, growth) = (b - a, second - first);
        let length = axis.norm();
        let along = (p - a).dot(&axis) / length;
        let aside = (p - a - axis * (along / length)).norm();
        let lean = (length * length - growth * growth).max(0.0).sqrt();
        let ball = |share: f64| (p - a - axis * share).norm() - first - growth * share;
        if lean == 0.0 {
            return ball(0.0).min(ball(1.0));
        }
        ball(((along + aside * growth / lean) / length).clamp(0.0, 1.0))
    };
    let size = a.norm().max(b.norm()) + first.max(second);
    let mut solid = Solid::new("tapered capsule", shape, size, Box::new(level));
    solid.center = (a + b) * 0.5;
    solid
}

pub(crate) fn plane_solids<N: Real>(rng: &mut Rng) -> Vec<Solid<N, 2>> {
    let mut solids = common::<N, 2>(rng);
    let corners = loop {
        let corners = [rng.vector::<2>(2.0), rng.vector::<2>(2.0), rng.vector::<2>(2.0)];
        if (corners[1] - corners[0]).perp(&(corners[2] - corners[0])).abs() > rng.scale * rng.scale
        {
            break corners;
        }
    };
    let [a, b, c] = corners.map(|corner| Point::from(narrow(&corner)));
    let sign = (corners[1] - corners[0]).perp(&(corners[2] - corners[0])).signum();
    let level = move |p: &Vector<f64, 2>| {
        (0..3).fold(f64::NEG_INFINITY, |level, i| {
            let side = corners[(i + 1) % 3] - corners[i];
            level.max(-sign * side.normalize().perp(&(p - corners[i])))
        })
    };
    let mut triangle = Solid::new("triangle", Triangle::new(a, b, c), 3.0, Box::new(level));
    triangle.center = (corners[0] + corners[1] + corners[2]) / 3.0;
    solids.push(triangle);
    let corners = hull_corners::<2>(rng);
    let points: Vec<_> = corners.iter().map(|corner| Point::from(narrow(corner))).collect();
    let size = corners.iter().map(Vector::<f64, 2>::norm).fold(0.0, f64::max);
    let level = hull_level(corners, |c, i| {
        let side = c[i[1]] - c[i[0]];
        Vector::<f64, 2>::new(-side.y, side.x)
    });
    solids.push(Solid::new("polygon", ConvexPolygon::from_points(&points), size, level));
    solids
}

/// Returns eight random corners, and one on each half axis, so that the hull contains the origin.
fn hull_corners<const D: usize>(rng: &mut Rng) -> Vec<Vector<f64, D>> {
    let mut corners: Vec<_> = (0..8).map(|_| rng.vector::<D>(2.0)).collect();
    for axis in 0..D {
        for sign in [-1.0, 1.0] {
            let mut corner = Vector::<f64, D>::zeros();
            corner[axis] = sign * rng.between(0.5, 2.0);
            corners.push(corner);
        }
    }
    corners
}

/// Returns the level function of the hull of `corners`: the largest height of a point above the
/// planes of the hull's faces. These are the planes through `D` corners that have all corners on
/// one side.
fn hull_level<const D: usize>(
    corners: Vec<Vector<f64, D>>,
    normal: impl Fn(&[Vector<f64, D>], [usize; D]) -> Vector<f64, D>,
) -> Level<D> {
    let (count, mut planes) = (corners.len(), Vec::new());
    let choices: usize = [count; D].iter().product();
    for choice in 0..choices {
        let mut rest = choice;
        let picked: [usize; D] = std::array::from_fn(|_| {
            let digit = rest % count;
            rest /= count;
            digit
        });
        let across = normal(&corners, picked);
        let length = across.norm();
        if length == 0.0 {
            continue;
        }
        let unit = across / length;
        let offset = unit.dot(&corners[picked[0]]);
        if corners.iter().all(|corner| unit.dot(corner) <= offset + 1e-12 * offset.abs()) {
            planes.push((unit, offset));
        }
    }
    Box::new(move |p| planes.iter().map(|(n, o)| n.dot(p) - o).fold(f64::NEG_INFINITY, f64::max))
}

pub(crate) fn space_solids<N: Real>(rng: &mut Rng) -> Vec<Solid<N, 3>> {
    let mut solids = common::<N, 3>(rng);
    let (h, r) = (rng.between(0.25, 2.0), rng.between(0.25, 2.0));
    let size = h.hypot(r);
    solids.push(Solid::new("cylinder", Cylinder::new(N::lit(h), N::lit(r)), size, {
        Box::new(move |p| (p.x.hypot(p.z) - r).max(p.y.abs() - h))
    }));
    let slant = (2.0 * h).hypot(r);
    solids.push(Solid::new("cone", Cone::new(N::lit(h), N::lit(r)), size, {
        Box::new(move |p| ((p.x.hypot(p.z) * 2.0 * h + r * (p.y - h)) / slant).max(-p.y - h))
    }));
    let corners = hull_corners::<3>(rng);
    let points: Vec<_> = corners.iter().map(|corner| Point::from(narrow(corner))).collect();
    let size = corners.iter().map(Vector::<f64, 3>::norm).fold(0.0, f64::max);
    let level = hull_level(corners, |c, i| (c[i[1]] - c[i[0]]).cross(&(c[i[2]] - c[i[0]])));
    solids.push(spike(rng));
    solids.push(Solid::new("hull", ConvexHull::from_points(&points), size, level));
    solids
}

/// Returns a tetrahedron around the origin.
fn spike<N: Real>(rng: &mut Rng) -> Solid<N, 3> {
    let mut near = |x: f64, y: f64, z: f64| Vector::<f64, 3>::new(x, y, z) * rng.between(0.5, 2.0);
    let corners =
        [near(1.0, 1.0, 1.0), near(1.0, -1.0, -1.0), near(-1.0, 1.0, -1.0), near(-1.0, -1.0, 1.0)];
    let shape = shape::Tetrahedron::new(corners.map(|corner| Point::from(narrow(&corner))));
    let size = corners.iter().map(Vector::<f64, 3>::norm).fold(0.0, f64::max);
    let level =
        hull_level(corners.to_vec(), |c, i| (c[i[1]] - c[i[0]]).cross(&(c[i[2]] - c[i[0]])));
    Solid::new("tetrahedron", shape, size, level)
}

/// A shape without thickness, and the corners of which it is the hull.
#[derive(Debug)]
pub(crate) struct Flat<N: Real, const D: usize> {
    pub(crate) shape: ShapeHandle<N, D>,
    pub(crate) corners: Vec<Vector<f64, D>>,
}

pub(crate) fn random_segment<N: Real, const D: usize>(rng: &mut Rng) -> Flat<N, D> {
    let corners = vec![rng.vector::<D>(2.0), rng.vector::<D>(2.0)];
    let [a, b] = [0, 1].map(|i: usize| Point::from(narrow(&corners[i])));
    Flat { shape: ShapeHandle::new(Segment::new(a, b)), corners }
}

pub(crate) fn random_triangle<N: Real>(rng: &mut Rng) -> Flat<N, 3> {
    let corners = vec![rng.vector::<3>(2.0), rng.vector::<3>(2.0), rng.vector::<3>(2.0)];
    let [a, b, c] = [0, 1, 2].map(|i: usize| Point::from(narrow(&corners[i])));
    Flat { shape: ShapeHandle::new(Triangle::new(a, b, c)), corners }
}
