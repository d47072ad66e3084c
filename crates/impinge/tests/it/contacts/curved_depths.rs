//! Compares the depths of segments, capsules and solids with flat faces in cylinders and cones with
//! a reference that searches the whole sphere of directions and shares no code with the library.
//!
//! Sizes are ordinary, zero or tiny; solids are aligned, nearly aligned or arbitrarily rotated;
//! positions are the origin, near it, on the axis, on a grid, or arbitrary.

use crate::support::samples::samples;
use impinge::math::na::{Quaternion, Translation, UnitQuaternion};
use impinge::math::{Isometry3, Point, Real, Space, Vector};
use impinge::query::contact;
use impinge::shape::{Capsule, Cone, ConvexHull, Cuboid, Cylinder, Segment, ShapeHandle, Triangle};
use impinge_reference::geometry::vector::{norm, scale};
use impinge_reference::geometry::{Pose, Solid, separation_along, signed_distance};
use impinge_reference::random::Random;

/// A solid for the library and for the reference.
type Solids<N> = (ShapeHandle<N, 3>, Solid<3>);

/// The sizes, before scaling, of needles, disks and other thin solids.
const THIN: [f64; 10] = [0.0, 1e-14, 1e-10, 1e-8, 1e-7, 1e-5, 1e-4, 1e-3, 1e-2, 0.1];
/// Number of kinds of the first solid: segments, capsules, triangles, boxes, hulls.
const KINDS: usize = 5;

/// Number of pairs that are tested.
fn rounds() -> u64 {
    samples(30) as u64
}

/// Returns `x` rounded to the scalar type.
fn single<N: Space<3>>(x: f64) -> f64 {
    N::lit(x).as_f64()
}

fn point<N: Space<3>>(p: [f64; 3]) -> Point<N, 3> {
    Point::from(p.map(N::lit))
}

/// Random source and parameters of a scene.
struct Maker {
    random: Random,
    /// One in `thin` sizes is taken from [`THIN`].
    thin: usize,
    /// Factor of all lengths.
    scale: f64,
}

impl Maker {
    fn new(seed: u64) -> Self {
        let mut random = Random::new(seed);
        let thin = *random.pick(&[2, 4, 1000]);
        let scale = *random.pick(&[1.0, 1.0, 1e-6, 1e6]);
        Self { random, thin, scale }
    }

    /// Returns a random size that the scalar represents exactly.
    fn size<N: Space<3>>(&mut self) -> f64 {
        let is_thin = self.random.below(self.thin) == 0;
        let size = if is_thin { *self.random.pick(&THIN) } else { self.random.range(0.1, 1.0) };
        single::<N>(size * self.scale)
    }

    fn sizes<N: Space<3>>(&mut self) -> [f64; 3] {
        std::array::from_fn(|_| self.size::<N>())
    }

    fn corner<N: Space<3>>(&mut self) -> [f64; 3] {
        let (share, sizes) = (self.random.vector::<3>(1.0), self.sizes::<N>());
        std::array::from_fn(|axis| single::<N>(share[axis] * sizes[axis]))
    }

    fn flat<N: Space<3>>(&mut self, kind: usize) -> Solids<N> {
        match kind {
            0 => {
                let [a, b] = [(); 2].map(|()| self.corner::<N>());
                (ShapeHandle::new(Segment::new(point(a), point(b))), Solid::segment(a, b))
            }
            1 => {
                let [half, radius, _] = self.sizes::<N>();
                let capsule = Capsule::<N, 3>::new(N::lit(half), N::lit(radius));
                let solid = Solid::capsule([0.0, -half, 0.0], [0.0, half, 0.0], radius);
                (ShapeHandle::new(capsule), solid)
            }
            2 => {
                let [a, b, c] = [(); 3].map(|()| self.corner::<N>());
                let triangle = Triangle::new(point(a), point(b), point(c));
                (ShapeHandle::new(triangle), Solid::triangle(a, b, c))
            }
            3 => {
                let sizes = self.sizes::<N>();
                let cuboid = Cuboid::new(Vector::<N, 3>::from(sizes.map(N::lit)));
                (ShapeHandle::new(cuboid), Solid::cuboid(sizes))
            }
            _ => self.hull(),
        }
    }

    /// Returns a hull of random points, of points on an ellipsoid, on a grid or on a prism; some
    /// hulls are nearly flat.
    fn hull<N: Space<3>>(&mut self) -> Solids<N> {
        loop {
            let sizes = self.sizes::<N>();
            let (count, layout) = (4 + self.random.below(16), self.random.below(4));
            let corners = (0..count).map(|index| {
                let corner = self.share_of_hull(index, layout);
                let at = std::array::from_fn(|axis| single::<N>(corner[axis] * sizes[axis]));
                point::<N>(at)
            });
            let Ok(hull) = ConvexHull::try_from_points(&corners.collect::<Vec<_>>()) else {
                continue;
            };
            let vertices = hull.vertices().iter().map(|p| p.coords.map(Real::as_f64).into());
            let solid = Solid::polytope(vertices.collect());
            return (ShapeHandle::new(hull), solid);
        }
    }

    fn share_of_hull(&mut self, index: usize, layout: usize) -> [f64; 3] {
        match layout {
            0 => self.random.vector(1.0),
            1 => self.random.unit_vector(),
            2 => std::array::from_fn(|_| self.random.grid(1, 0)),
            _ => {
                let corner = u32::try_from(index / 2).expect("few corners");
                let (sine, cosine) = f64::sine_cosine(f64::from(corner) * 0.7);
                [cosine, if index.is_multiple_of(2) { 1.0 } else { -1.0 }, sine]
            }
        }
    }

    fn round<N: Space<3>>(&mut self) -> Solids<N> {
        let (half_height, radius) = (self.size::<N>(), self.size::<N>());
        let (half, wide) = (N::lit(half_height), N::lit(radius));
        if self.random.chance(0.5) {
            (ShapeHandle::new(Cone::new(half, wide)), Solid::Cone { half_height, radius })
        } else {
            (ShapeHandle::new(Cylinder::new(half, wide)), Solid::Cylinder { half_height, radius })
        }
    }

    /// Returns a random unit quaternion that is aligned, nearly aligned or arbitrary. Its
    /// components are rounded to the scalar, so its length is 1 only up to rounding.
    fn turn<N: Space<3>>(&mut self) -> [f64; 4] {
        const STRAIGHT: [[f64; 4]; 5] = [
            [0.0, 0.0, 0.0, 1.0],
            [1.0, 0.0, 0.0, 0.0],
            [1.0, 0.0, 0.0, 1.0],
            [0.0, 0.0, 1.0, 1.0],
            [1.0, 1.0, 1.0, 1.0],
        ];
        let (any, straight) = (self.random.quaternion(), *self.random.pick(&STRAIGHT));
        let lean = match self.random.below(3) {
            0 => 0.0,
            1 => self.random.magnitude(1e-2, 40),
            _ => 1e6,
        };
        let mixed: [f64; 4] = std::array::from_fn(|i| straight[i] + any[i] * lean);
        let length = mixed.iter().map(|x| x * x).sum::<f64>().sqrt();
        mixed.map(|x| single::<N>(x / length))
    }

    /// Returns a position at which solids with the bounding radius `reach` probably overlap.
    fn place<N: Space<3>>(&mut self, reach: f64) -> [f64; 3] {
        let at = match self.random.below(5) {
            0 => [0.0; 3],
            1 => scale(&[0.0, 1.0, 0.0], reach * self.random.range(-1.0, 1.0)),
            2 => self.random.vector(reach * 1e-7),
            3 => std::array::from_fn(|_| self.random.grid(1, 1) * reach),
            _ => self.random.vector(reach),
        };
        at.map(single::<N>)
    }
}

/// Returns a pose for the library and for the reference.
fn placed<N: Space<3>>(at: [f64; 3], turn: [f64; 4]) -> (Isometry3<N>, Pose<3>) {
    let [i, j, k, w] = turn.map(N::lit);
    let quaternion = UnitQuaternion::new_normalize(Quaternion::new(w, i, j, k));
    let isometry = Isometry3::from_parts(Translation::from(at.map(N::lit)), quaternion);
    (isometry, Pose::from_quaternion(at, turn))
}

/// Returns the error relative to the size of the pair, the error allowed, and a description; `None`
/// unless the cores overlap. The error is the larger of two: that of the depth against the
/// reference, and the difference between the depth and the separation along the normal.
fn error<N: Space<3>>(seed: u64, kind: usize, accuracy: f64) -> Option<(f64, f64, String)> {
    let mut maker = Maker::new(seed);
    let ((shape1, solid1), (shape2, solid2)) = (maker.flat::<N>(kind), maker.round::<N>());
    let reach = solid1.bounding_radius().min(solid2.bounding_radius());
    let at = maker.place::<N>(reach.max(1e-9 * maker.scale));
    let (m1, pose1) = placed::<N>([0.0; 3], maker.turn::<N>());
    let (m2, pose2) = placed::<N>(at, maker.turn::<N>());
    let truth = signed_distance(&solid1, &pose1, &solid2, &pose2);
    let size = solid1.bounding_radius() + solid2.bounding_radius() + norm(&at);
    if truth.lower + solid1.radius() > -1e-13 * size {
        return None;
    }
    let found = contact(&m1, &*shape1, &m2, &*shape2, N::INFINITY).expect("they overlap");
    let distance = -found.depth.as_f64();
    let normal = found.normal.into_inner().map(Real::as_f64).into();
    let own = separation_along(&solid1, &pose1, &solid2, &pose2, &normal);
    let error = truth.error_of(distance).max((own - distance).abs()) / size;
    // If the separation is nearly the same along a circle of normals, the general search may stop
    // before it converges. It also handles needles and disks.
    let is_ring = truth.upper - truth.lower > 1e-10 * size;
    let is_thin = matches!(solid2, Solid::Cylinder { half_height, radius }
        | Solid::Cone { half_height, radius } if half_height.min(radius) < 1e-6 * size);
    let allowed = if is_ring { 1e-7 } else { 0.0 } + accuracy * if is_thin { 5.0 } else { 1.0 };
    let what = format!(
        "{distance} and {own}, not {truth:?}: {solid1:?} at {m1:?} in {solid2:?} at {m2:?}"
    );
    Some((error, allowed, what))
}

fn check<N: Space<3>>(seed: u64, accuracy: f64) {
    let (mut deep, mut all) = (0, 0);
    for (round, kind) in (0..rounds()).zip((0..KINDS).cycle()) {
        all += 1;
        let Some((error, allowed, what)) = error::<N>(seed + round, kind, accuracy) else {
            continue;
        };
        deep += 1;
        assert!(error <= allowed, "seed {}, kind {kind}: off by {error}: {what}", seed + round);
    }
    assert!(deep * 2 > all, "{deep} of {all} overlap");
}

#[test]
fn depths_in_double_precision() {
    check::<f64>(1 << 32, 1e-11);
}

#[test]
fn depths_in_single_precision() {
    check::<f32>(2 << 32, 2e-6);
}
