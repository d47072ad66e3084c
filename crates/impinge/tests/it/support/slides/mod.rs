//! Floors of many parts, and the contacts of a solid that slides over them.

#![allow(dead_code, unreachable_pub, reason = "each test takes what it needs")]

use impinge::math::{AbstractRotation, Isometry, Isometry3, Point, Pose, Real, Space, Vector};
use impinge::narrow_phase::{
    ContactManifoldGenerator, ContactPrediction, DefaultContactDispatcher, IdAllocator,
    PairManifoldGenerator,
};
use impinge::query::{ContactManifold, contact};
use impinge::shape::{
    Ball, Capsule, Cone, ConvexHull, Cuboid, Cylinder, HeightField, Shape, ShapeHandle, TriMesh,
};

/// A linear congruential generator with the constants of Knuth's MMIX; only the upper bits are
/// used.
pub struct Random(u64);

impl Random {
    pub fn new(seed: u64) -> Self {
        Self(seed)
    }

    pub fn below(&mut self, n: u32) -> u32 {
        self.0 = self.0.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
        u32::try_from((self.0 >> 33) % u64::from(n)).expect("below")
    }

    /// Returns a random number from -1 to 1.
    pub fn unit(&mut self) -> f64 {
        f64::from(self.below(1 << 20)) / f64::from(1 << 19) - 1.0
    }
}

/// Division of the cells of a floor into triangles.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pattern {
    Slash,
    Backslash,
    Zigzag,
    /// Inner vertices displaced from the grid, and random diagonals.
    Random,
    /// Every triangle has its own vertices.
    Soup,
}

pub const PATTERNS: [Pattern; 5] =
    [Pattern::Slash, Pattern::Backslash, Pattern::Zigzag, Pattern::Random, Pattern::Soup];

/// Returns a floor of `2 n²` triangles: a square of `n` × `n` cells of size `cell`, centred at
/// `center`. `height` returns the y coordinate of each vertex.
pub fn grid<N: Real + Space<3>>(
    n: u32,
    cell: f64,
    center: [f64; 3],
    pattern: Pattern,
    height: impl Fn(f64, f64) -> f64,
) -> TriMesh<N, 3> {
    let mut random = Random::new(7);
    let (mut vertices, mut triangles) = (Vec::new(), Vec::new());
    let half = f64::from(n) * cell / 2.0;
    for i in 0..=n {
        for j in 0..=n {
            let is_inner = i > 0 && j > 0 && i < n && j < n;
            let mut off = || {
                if pattern == Pattern::Random && is_inner {
                    0.3 * cell * random.unit()
                } else {
                    0.0
                }
            };
            let (x, z) = (f64::from(i) * cell - half + off(), f64::from(j) * cell - half + off());
            let at = [x + center[0], height(x, z) + center[1], z + center[2]];
            vertices.push(Point::<N, 3>::from(at.map(N::lit)));
        }
    }
    for i in 0..n {
        for j in 0..n {
            let at = |di: u32, dj: u32| (i + di) * (n + 1) + j + dj;
            let [a, b, c, d] = [at(0, 0), at(0, 1), at(1, 1), at(1, 0)];
            let is_slash = match pattern {
                Pattern::Slash | Pattern::Soup => true,
                Pattern::Backslash => false,
                Pattern::Zigzag => (i + j) % 2 == 0,
                Pattern::Random => random.below(2) == 0,
            };
            if is_slash {
                triangles.extend([[a, b, c], [a, c, d]]);
            } else {
                triangles.extend([[a, b, d], [b, c, d]]);
            }
        }
    }
    if pattern == Pattern::Soup {
        let corners: Vec<u32> = triangles.iter().flatten().copied().collect();
        vertices = corners.iter().map(|&corner| vertices[corner as usize]).collect();
        triangles = (0..).step_by(3).map(|a| [a, a + 1, a + 2]).take(triangles.len()).collect();
    }
    TriMesh::new(vertices, triangles)
}

/// Returns a flat height field as large as the floor of [`grid`], around the origin.
pub fn field<N: Real>(n: usize, cell: f64) -> HeightField<N, 3> {
    let size = N::lit(n as f64 * cell);
    let heights = vec![N::ZERO; (n + 1) * (n + 1)];
    HeightField::<N, 3>::new(n + 1, n + 1, heights, Vector::<N, 3>::new(size, N::ONE, size))
}

/// Returns the solids that slide in 3D.
pub fn solids3<N: Real>() -> Vec<(&'static str, ShapeHandle<N, 3>)> {
    let v = |x: f64, y: f64, z: f64| Vector::<N, 3>::new(N::lit(x), N::lit(y), N::lit(z));
    let mut random = Random::new(3);
    let points: Vec<Point<N, 3>> = (0..24)
        .map(|_| Point::from(v(random.unit(), random.unit(), random.unit()) * N::lit(0.5)))
        .collect();
    vec![
        ("ball", ShapeHandle::new(Ball::new(N::lit(0.37)))),
        ("cuboid", ShapeHandle::new(Cuboid::new(v(0.31, 0.23, 0.42)))),
        ("large cuboid", ShapeHandle::new(Cuboid::new(v(1.31, 0.23, 1.7)))),
        ("capsule", ShapeHandle::new(Capsule::<N, 3>::new(N::lit(0.4), N::lit(0.2)))),
        ("hull", ShapeHandle::new(ConvexHull::try_from_points(&points).expect("a hull"))),
        ("cylinder", ShapeHandle::new(Cylinder::new(N::lit(0.3), N::lit(0.4)))),
        ("cone", ShapeHandle::new(Cone::new(N::lit(0.3), N::lit(0.4)))),
    ]
}

/// Properties that every contact on the path must have.
pub struct Expected<N: Real, const D: usize> {
    /// From the floor to the solid, in world coordinates.
    pub normal: Vector<N, D>,
    pub normal_tolerance: N,
    pub depth: N,
    pub depth_tolerance: N,
    pub manifolds: usize,
}

/// A generator with its source of contact ids.
pub struct Sliding<N: Space<D>, const D: usize> {
    generator: PairManifoldGenerator<N, D>,
    ids: IdAllocator,
}

impl<N: Space<D>, const D: usize> Sliding<N, D> {
    pub fn new() -> Self {
        Self { generator: PairManifoldGenerator::default(), ids: IdAllocator::new() }
    }

    /// Updates the generator, which keeps its state between calls, and returns the manifolds of the
    /// two placed shapes.
    pub fn update(
        &mut self,
        (m1, g1): (&N::Isometry, &dyn Shape<N, D>),
        (m2, g2): (&N::Isometry, &dyn Shape<N, D>),
        prediction: N,
    ) -> Vec<&ContactManifold<N, D>> {
        let dispatcher = DefaultContactDispatcher::<D>::new();
        let prediction = ContactPrediction::new(prediction, N::ZERO, N::ZERO);
        let able = self.generator.update(&dispatcher, m1, g1, m2, g2, &prediction, &mut self.ids);
        assert!(able, "composites are served");
        let mut out = Vec::new();
        self.generator.contacts(&mut out);
        out
    }
}

/// Slides a solid along the poses of `way` and compares every contact with `expected`.
pub fn slide<N, R, const D: usize>(
    name: &str,
    (floor_pose, floor): (&Isometry<N, R, D>, &dyn Shape<N, D>),
    solid: &dyn Shape<N, D>,
    way: impl Iterator<Item = Isometry<N, R, D>>,
    expected: &Expected<N, D>,
) where
    N: Space<D, Isometry = Isometry<N, R, D>>,
    R: AbstractRotation<N, D> + std::fmt::Debug,
{
    let mut sliding = Sliding::<N, D>::new();
    let mut steps = 0;
    for (step, pose) in way.enumerate() {
        steps += 1;
        let manifolds = sliding.update((floor_pose, floor), (&pose, solid), N::lit(0.02));
        assert!(!manifolds.is_empty(), "{name}, step {step}: no contact at {pose:?}");
        let mut deepest = -N::INFINITY;
        for tracked in manifolds.iter().flat_map(|manifold| manifold.contacts()) {
            let off = (tracked.contact.normal.into_inner() - expected.normal).norm();
            assert!(
                off <= expected.normal_tolerance,
                "{name}, step {step}: {tracked:?} at {pose:?}, {manifolds:#?}"
            );
            deepest = if tracked.contact.depth > deepest { tracked.contact.depth } else { deepest };
        }
        let off = (deepest - expected.depth).abs();
        assert!(
            off <= expected.depth_tolerance,
            "{name}, step {step}: depth {deepest}, not {} at {pose:?} {manifolds:#?}",
            expected.depth
        );
        assert_eq!(manifolds.len(), expected.manifolds, "{name}, step {step}: {manifolds:#?}");
        let single = contact(floor_pose, floor, &pose, solid, N::lit(0.02)).expect("a contact");
        let off = (single.depth - deepest).abs();
        assert!(off <= expected.depth_tolerance, "{name}, step {step}: {single:?}, {deepest}");
        let off = (single.normal.into_inner() - expected.normal).norm();
        assert!(off <= expected.normal_tolerance, "{name}, step {step}: {off} {single:?}");
    }
    assert!(steps > 0, "{name}: slid");
}

/// Returns the height of the lowest point of a solid at a pose.
pub fn lowest<N: Real>(solid: &dyn Shape<N, 3>, turned: &Isometry3<N>) -> N {
    let pose = Pose::from_isometry(turned);
    let geometry = solid.geometry();
    let map = geometry.as_support_map().expect("a convex solid");
    let down = Vector::<N, 3>::new(N::ZERO, -N::ONE, N::ZERO);
    pose.point(&map.support_point(&pose.inverse_vector(&down))).y
}
