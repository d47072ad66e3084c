//! Tests, in arithmetic with 31 digits, that bounding volumes contain their contents exactly and
//! exceed them by no more than rounding errors.

use impinge::bounding_volume::{Aabb, BoundingSphere, BoundingVolume};
use impinge::math::na::{Quaternion, UnitQuaternion};
use impinge::math::{Isometry2, Isometry3, Point, Pose, Real, Space, Vector};
use impinge::shape::{
    Ball, Capsule, Compound, Cone, ConvexHull, Cuboid, Cylinder, Ellipsoid, Plane, Rounded,
    Segment, Shape, ShapeHandle, TaperedCapsule, TriMesh, Triangle,
};
use impinge_reference::precise::Quad;
use impinge_reference::random::Random;

type Exact<const D: usize> = [Quad; D];

fn exact<N: Real>(x: N) -> Quad {
    Quad::new(x.as_f64())
}

fn exact_of<N: Real, const D: usize>(v: &Vector<N, D>) -> Exact<D> {
    std::array::from_fn(|axis| exact(v[axis]))
}

fn dot<const D: usize>(a: &Exact<D>, b: &Exact<D>) -> Quad {
    (0..D).fold(Quad::ZERO, |sum, axis| sum + a[axis] * b[axis])
}

fn norm<const D: usize>(a: &Exact<D>) -> Quad {
    dot(a, a).sqrt()
}

/// A piece of a solid, which is the convex hull of its pieces.
#[derive(Clone, Debug)]
enum Piece<const D: usize> {
    Ball([f64; D], f64),
    /// A disk perpendicular to the y axis: its height and its radius.
    Disk(f64, f64),
    Ellipsoid([f64; D]),
}

impl<const D: usize> Piece<D> {
    /// Returns the largest scalar product of a point of the piece with a direction.
    fn reach(&self, direction: &Exact<D>) -> Quad {
        match self {
            Self::Ball(center, radius) => {
                let along = dot(&center.map(Quad::new), direction);
                along + Quad::new(*radius)
            }
            Self::Disk(y, radius) => {
                let across = std::array::from_fn::<_, D, _>(|axis| {
                    if axis == 1 { Quad::ZERO } else { direction[axis] }
                });
                Quad::new(*y) * direction[1] + Quad::new(*radius) * norm(&across)
            }
            Self::Ellipsoid(half_axes) => {
                norm::<D>(&std::array::from_fn(|i| Quad::new(half_axes[i]) * direction[i]))
            }
        }
    }

    fn size(&self) -> f64 {
        let length = |v: &[f64; D]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
        match self {
            Self::Ball(center, radius) => length(center) + radius,
            Self::Disk(y, radius) => y.abs() + radius,
            Self::Ellipsoid(half_axes) => length(half_axes),
        }
    }
}

type Solid<N, const D: usize> = (ShapeHandle<N, D>, Vec<Piece<D>>);

/// Returns random numbers of magnitude up to `limit` that the scalar represents exactly, as `f64`.
fn numbers<N: Real, const K: usize>(random: &mut Random, limit: f64) -> [f64; K] {
    std::array::from_fn(|_| N::lit(random.range(-limit, limit)).as_f64())
}

fn lengths<N: Real, const K: usize>(random: &mut Random) -> [f64; K] {
    std::array::from_fn(|_| N::lit(random.magnitude(1e-3, 14)).as_f64())
}

fn point<N: Real, const D: usize>(p: &[f64; D]) -> Point<N, D> {
    Point::from(Vector::<N, D>::from_fn(|axis, _| N::lit(p[axis])))
}

/// Returns random solids that exist in both dimensions.
fn solids<N: Space<D>, const D: usize>(random: &mut Random) -> Vec<Solid<N, D>> {
    let [a, b, c]: [[f64; D]; 3] = [(); 3].map(|()| numbers::<N, D>(random, 20.0));
    let [r, s] = lengths::<N, 2>(random);
    let half = lengths::<N, D>(random);
    let dots = |points: &[[f64; D]]| points.iter().map(|p| Piece::Ball(*p, 0.0)).collect();
    let inflated = |points: &[[f64; D]], r| points.iter().map(|p| Piece::Ball(*p, r)).collect();
    let corners: Vec<[f64; D]> = (0..1_usize << D)
        .map(|bits| std::array::from_fn(|i| if bits >> i & 1 == 0 { half[i] } else { -half[i] }))
        .collect();
    let vector = Vector::<N, D>::from_fn(|axis, _| N::lit(half[axis]));
    let (pa, pb, pc) = (point::<N, D>(&a), point(&b), point(&c));
    let cuboid = ShapeHandle::new(Cuboid::new(vector));
    let mesh = TriMesh::new(vec![pa, pb, pc, Point::origin()], vec![[0, 1, 2], [0, 1, 3]]);
    let of_mesh = dots(&[a, b, c, [0.0; D]]);
    let rounded = Rounded::try_from_handle(cuboid.clone(), N::lit(r)).expect("a box has no radius");
    vec![
        (ShapeHandle::new(Ball::new(N::lit(r))), inflated(&[[0.0; D]], r)),
        (cuboid, dots(&corners)),
        (ShapeHandle::new(rounded), inflated(&corners, r)),
        (ShapeHandle::new(Segment::new(pa, pb)), dots(&[a, b])),
        (ShapeHandle::new(Triangle::new(pa, pb, pc)), dots(&[a, b, c])),
        (
            ShapeHandle::new(Capsule::try_from_ends(pa, pb, N::lit(r)).expect("finite")),
            inflated(&[a, b], r),
        ),
        (
            ShapeHandle::new(
                TaperedCapsule::try_from_ends(pa, pb, [N::lit(r), N::lit(s)]).expect("finite"),
            ),
            vec![Piece::Ball(a, r), Piece::Ball(b, s)],
        ),
        (ShapeHandle::new(Ellipsoid::new(vector)), vec![Piece::Ellipsoid(half)]),
        (ShapeHandle::new(mesh), of_mesh),
    ]
}

/// Returns random solids in 3D: those of both dimensions, and those that exist in 3D only.
fn solids3<N: Space<3>>(random: &mut Random) -> Vec<Solid<N, 3>> {
    let [r, h] = lengths::<N, 2>(random);
    let corners: [[f64; 3]; 9] = [(); 9].map(|()| numbers::<N, 3>(random, 20.0));
    let hull = ConvexHull::from_points(&corners.map(|corner| point::<N, 3>(&corner)));
    let dots = corners.iter().map(|corner| Piece::Ball(*corner, 0.0)).collect();
    let mut all = solids(random);
    all.push((ShapeHandle::new(hull), dots));
    let rims = vec![Piece::Disk(h, r), Piece::Disk(-h, r)];
    all.push((ShapeHandle::new(Cylinder::new(N::lit(h), N::lit(r))), rims));
    let cone = vec![Piece::Ball([0.0, h, 0.0], 0.0), Piece::Disk(-h, r)];
    all.push((ShapeHandle::new(Cone::new(N::lit(h), N::lit(r))), cone));
    all
}

/// Asserts that the box of a placed shape contains the shape, and is larger by no more than
/// rounding.
fn check_box<N: Space<D>, const D: usize>((shape, pieces): &Solid<N, D>, pose: &Pose<N, D>) {
    let aabb = shape.aabb(pose);
    let size = pieces.iter().map(Piece::size).fold(0.0, f64::max);
    for axis in 0..D {
        let row: Exact<D> = std::array::from_fn(|column| exact(pose.rotation[(axis, column)]));
        let back = row.map(|x| -x);
        let most = |direction| {
            pieces.iter().map(|piece| piece.reach(direction)).reduce(Quad::max).expect("a piece")
        };
        let at = exact(pose.translation[axis]);
        let room = [
            most(&row) - (exact(aabb.maxs()[axis]) - at),
            most(&back) - (at - exact(aabb.mins()[axis])),
        ];
        let allowed = N::EPSILON.as_f64() * (64.0 * size + 4.0 * at.to_f64().abs());
        for outside in room.map(Quad::to_f64) {
            assert!(outside <= 0.0, "{shape:?} at {pose:?}: {outside:e} outside of {aabb:?}");
            assert!(
                outside >= -allowed,
                "{shape:?} at {pose:?}: {outside:e} of {allowed:e} {aabb:?}"
            );
        }
    }
    check_sphere(shape, pieces, pose);
}

/// Asserts that the bounding sphere of a shape contains the balls among its pieces.
fn check_sphere<N: Space<D>, const D: usize>(
    shape: &ShapeHandle<N, D>,
    pieces: &[Piece<D>],
    pose: &Pose<N, D>,
) {
    let sphere = shape.local_bounding_sphere().transformed_by(pose);
    for piece in pieces {
        let Piece::Ball(center, radius) = piece else { continue };
        let local = center.map(Quad::new);
        let arm: Exact<D> = std::array::from_fn(|axis| {
            let row: Exact<D> = std::array::from_fn(|column| exact(pose.rotation[(axis, column)]));
            dot(&row, &local) + exact(pose.translation[axis]) - exact(sphere.center()[axis])
        });
        let outside = (norm(&arm) + Quad::new(*radius) - exact(sphere.radius())).to_f64();
        assert!(outside <= 0.0, "{shape:?} at {pose:?}: {outside:e} outside of {sphere:?}");
    }
}

/// Returns a random angle: zero, a quarter turn, a tiny one or an arbitrary one.
fn angle<N: Real>(random: &mut Random) -> N {
    let tilt = random.magnitude(1e-12, 40);
    N::lit(*random.pick(&[0.0, std::f64::consts::FRAC_PI_2, tilt, -tilt, random_angle(tilt)]))
}

fn random_angle(seed: f64) -> f64 {
    (seed * 1e13) % 6.0 - 3.0
}

fn translation<N: Real, const D: usize>(random: &mut Random) -> Vector<N, D> {
    let far = *random.pick(&[0.0, 1.0, 1e6]);
    Vector::<N, D>::from_fn(|_, _| N::lit(random.range(-far, far)))
}

fn pose3<N: Real>(random: &mut Random) -> Pose<N, 3> {
    let axis =
        *random.pick(&[[0.0, 1.0, 0.0], [1.0, 0.0, 0.0], [0.0, 0.6, 0.8], [0.3, -0.5, 0.81]]);
    let (sine, cosine) = (angle::<N>(random) * N::HALF).sine_cosine();
    let [i, j, k] = axis.map(|x| N::lit(x) * sine);
    let turn = UnitQuaternion::new_normalize(Quaternion::new(cosine, i, j, k));
    Pose::from_isometry(&Isometry3::from_parts(translation::<N, 3>(random).into(), turn))
}

fn pose2<N: Real>(random: &mut Random) -> Pose<N, 2> {
    let turned = Isometry2::new(translation(random), angle(random));
    Pose::from_isometry(&turned)
}

fn all_in_space<N: Space<3>>(seed: u64) {
    let mut random = Random::new(seed);
    for _ in 0..400 {
        for solid in solids3::<N>(&mut random) {
            check_box(&solid, &pose3(&mut random));
            check_box(&solid, &Pose::identity());
        }
    }
}

fn all_in_the_plane<N: Space<2>>(seed: u64) {
    let mut random = Random::new(seed);
    for _ in 0..400 {
        for solid in solids::<N, 2>(&mut random) {
            check_box(&solid, &pose2(&mut random));
            check_box(&solid, &Pose::identity());
        }
    }
}

#[test]
fn boxes_and_spheres_hold_the_shapes_in_space() {
    all_in_space::<f32>(1);
    all_in_space::<f64>(2);
}

#[test]
fn boxes_and_spheres_hold_the_shapes_in_the_plane() {
    all_in_the_plane::<f32>(3);
    all_in_the_plane::<f64>(4);
}

/// Asserts that the box of a compound contains its children, whose corners are transformed by two
/// poses in turn.
fn compounds<N: Space<3, Isometry = Isometry3<N>>>(seed: u64) {
    let mut random = Random::new(seed);
    for _ in 0..300 {
        let own: Vec<_> = (0..3)
            .map(|_| {
                let turn = UnitQuaternion::new_normalize(Quaternion::from(
                    random.quaternion().map(N::lit),
                ));
                Isometry3::from_parts(translation::<N, 3>(&mut random).into(), turn)
            })
            .collect();
        let corners = numbers::<N, 3>(&mut random, 20.0);
        let child = ShapeHandle::new(Segment::new(point::<N, 3>(&corners), Point::origin()));
        let compound = Compound::new(own.iter().map(|own| (*own, child.clone())).collect());
        let pose = pose3::<N>(&mut random);
        let aabb = compound.aabb(&pose);
        for own in own.iter().map(Pose::from_isometry) {
            for corner in [corners, [0.0; 3]] {
                let inner = placed(&own, &corner.map(Quad::new));
                let at = placed(&pose, &inner);
                for axis in 0..3 {
                    let (low, high) = (exact(aabb.mins()[axis]), exact(aabb.maxs()[axis]));
                    assert!(low <= at[axis] && at[axis] <= high, "{aabb:?} around {at:?}");
                }
            }
        }
    }
}

fn placed<N: Real, const D: usize>(pose: &Pose<N, D>, p: &Exact<D>) -> Exact<D> {
    std::array::from_fn(|axis| {
        let row: Exact<D> = std::array::from_fn(|column| exact(pose.rotation[(axis, column)]));
        dot(&row, p) + exact(pose.translation[axis])
    })
}

#[test]
fn boxes_of_compounds_hold_their_children() {
    compounds::<f32>(5);
    compounds::<f64>(6);
}

fn random_box<N: Real, const D: usize>(random: &mut Random) -> Aabb<N, D> {
    let center = translation::<N, D>(random);
    let half = lengths::<N, D>(random);
    Aabb::from_half_extents(Point::from(center), Vector::<N, D>::from_fn(|i, _| N::lit(half[i])))
}

/// Returns the corner with the greatest coordinate on the axes whose bits are set in `bits`, and
/// the least on the others.
fn corner_of<N: Real, const D: usize>(aabb: &Aabb<N, D>, bits: usize) -> Exact<D> {
    std::array::from_fn(|axis| {
        let ends = [aabb.mins()[axis], aabb.maxs()[axis]];
        exact(ends[bits >> axis & 1])
    })
}

/// Asserts that boxes derived from boxes (rotated, loosened, swept, ...) contain the exact result.
fn boxes<N: Space<D>, const D: usize>(seed: u64, pose: fn(&mut Random) -> Pose<N, D>) {
    let mut random = Random::new(seed);
    for _ in 0..3000 {
        let (one, pose) = (random_box::<N, D>(&mut random), pose(&mut random));
        let turned = one.transformed_by(&pose);
        let [margin, time] = lengths::<N, 2>(&mut random);
        let velocity = translation::<N, D>(&mut random);
        let (loose, swept) = (one.loosened(N::lit(margin)), one.swept(&velocity, N::lit(time)));
        for axis in 0..D {
            let (low, high) = (exact(one.mins()[axis]), exact(one.maxs()[axis]));
            let margin = Quad::new(margin);
            assert!(exact(loose.mins()[axis]) <= low - margin, "{one:?} {loose:?}");
            assert!(exact(loose.maxs()[axis]) >= high + margin, "{one:?} {loose:?}");
            let way = exact(velocity[axis]) * Quad::new(time);
            assert!(exact(swept.mins()[axis]) <= low.min(low + way), "{one:?} {swept:?}");
            assert!(exact(swept.maxs()[axis]) >= high.max(high + way), "{one:?} {swept:?}");
            for bits in 0..1 << D {
                let at = placed(&pose, &corner_of(&one, bits))[axis];
                assert!(exact(turned.mins()[axis]) <= at, "{one:?} at {pose:?}: {turned:?}");
                assert!(exact(turned.maxs()[axis]) >= at, "{one:?} at {pose:?}: {turned:?}");
            }
        }
    }
}

#[test]
fn boxes_round_outwards() {
    boxes::<f32, 2>(7, pose2);
    boxes::<f64, 2>(8, pose2);
    boxes::<f32, 3>(9, pose3);
    boxes::<f64, 3>(10, pose3);
}

/// Returns the distance by which the inner sphere, moved by `by`, extends beyond the outer one;
/// negative if it is inside.
fn outside<N: Real, const D: usize>(
    outer: &BoundingSphere<N, D>,
    inner: &BoundingSphere<N, D>,
    by: &Exact<D>,
) -> f64 {
    let arm: Exact<D> = std::array::from_fn(|axis| {
        exact(inner.center()[axis]) + by[axis] - exact(outer.center()[axis])
    });
    (norm(&arm) + exact(inner.radius()) - exact(outer.radius())).to_f64()
}

fn spheres<N: Space<D>, const D: usize>(seed: u64) {
    let mut random = Random::new(seed);
    let zero = [Quad::ZERO; D];
    for _ in 0..10_000 {
        let [r, s] = lengths::<N, 2>(&mut random).map(N::lit);
        let center = Point::from(translation::<N, D>(&mut random));
        let near = translation::<N, D>(&mut random) * N::lit(random.magnitude(1e-6, 20));
        let one = BoundingSphere::new(center, r);
        let two = BoundingSphere::new(center + near, s);
        let both = one.merged(&two);
        assert!(outside(&both, &one, &zero) <= 0.0, "{one:?} {two:?}: {both:?}");
        assert!(outside(&both, &two, &zero) <= 0.0, "{one:?} {two:?}: {both:?}");
        assert!(both.contains(&one) && both.contains(&two), "{one:?} {two:?}: {both:?}");
        let (least, apart) = (one.radius().as_f64().max(s.as_f64()), near.norm().as_f64());
        let smallest = least.max((apart + r.as_f64() + s.as_f64()) / 2.0);
        let scale = smallest + center.coords.norm().as_f64() + apart;
        let excess = both.radius().as_f64() - smallest;
        assert!(excess <= 32.0 * N::EPSILON.as_f64() * scale, "{one:?} {two:?}: {both:?}");
        let loose = one.loosened(s);
        assert!(exact(loose.radius()) >= exact(r) + exact(s), "{one:?} by {s}: {loose:?}");
        let swept = one.swept(&near, s);
        let way = exact_of(&near).map(|x| x * exact(s));
        for by in [zero, way] {
            let outside = outside(&swept, &one, &by);
            assert!(outside <= 0.0, "{outside:e}: {one:?} along {near:?} for {s}: {swept:?}");
        }
    }
}

#[test]
fn spheres_round_outwards() {
    spheres::<f32, 2>(11);
    spheres::<f64, 2>(12);
    spheres::<f32, 3>(13);
    spheres::<f64, 3>(14);
}

#[test]
fn exact_boxes_stay_exact() {
    let cube = Cuboid::new(Vector::<f32, 3>::new(1.0, 2.0, 3.0));
    let quarter = Isometry3::rotation(Vector::<f32, 3>::zeros());
    let mut pose = Pose::from_isometry(&quarter);
    pose.translation = Vector::<f32, 3>::new(10.0, 0.5, -1.0);
    let expected =
        Aabb::new(Point::<f32, 3>::new(9.0, -1.5, -4.0), Point::<f32, 3>::new(11.0, 2.5, 2.0));
    assert_eq!(cube.aabb(&pose), expected, "corners are numbers of the type");
    assert_eq!(cube.local_aabb().transformed_by(&pose), expected, "and of its box");
    let plane = Plane::new(impinge::math::Unit::new_normalize(Vector::<f32, 2>::new(0.6, 0.8)));
    let turn = Isometry2::rotation(0.8_f32.atan2(0.6) - std::f32::consts::FRAC_PI_2);
    let around = plane.aabb(&Pose::from_isometry(&turn.inverse()));
    assert!(!around.is_bounded(), "a normal that rounding leads to an axis: {around:?}");
}
