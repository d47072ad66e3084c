//! Measures the cost of contacts between large solids and shapes with many parts by the number of
//! calls to the shapes, which unlike time is the same on every machine.

use std::fmt::Debug;
use std::sync::atomic::{AtomicUsize, Ordering};

use impinge::bounding_volume::Aabb;
use impinge::dim3::shape::Compound as Compound3;
use impinge::math::{Isometry3, Point, Pose, Space, Vector};
use impinge::shape::{
    CompositeShape, Cuboid, FeatureId, Geometry, HeightField, Part, PartSearch, Polyline, Shape,
    ShapeHandle, SupportMap, Surface, TriMesh,
};

use crate::support::slides::{Random, Sliding};

/// A shape that counts calls: for a composite the calls about its parts, for a box the calls for
/// support points.
#[derive(Debug)]
struct Counted<S> {
    shape: S,
    asked: AtomicUsize,
}

impl<S> Counted<S> {
    fn new(shape: S) -> Self {
        Self { shape, asked: AtomicUsize::new(0) }
    }

    fn asked(&self) -> &S {
        self.asked.fetch_add(1, Ordering::Relaxed);
        &self.shape
    }
}

impl<S: CompositeShape<f64, D> + Debug, const D: usize> CompositeShape<f64, D> for Counted<S> {
    fn num_parts(&self) -> u32 {
        self.shape.num_parts()
    }

    fn part(&self, part: u32) -> Part<'_, f64, D> {
        self.asked().part(part)
    }

    fn search(&self) -> &dyn PartSearch<f64, D> {
        self.shape.search()
    }

    fn surface(&self) -> Option<&dyn Surface<f64, D>> {
        self.shape.surface().map(|_| self as &dyn Surface<f64, D>)
    }

    fn each_corner(&self, part: u32, visit: &mut dyn FnMut(u64)) {
        self.asked().each_corner(part, visit);
    }

    fn are_adjacent(&self, part1: u32, part2: u32) -> bool {
        self.asked().are_adjacent(part1, part2)
    }
}

impl<S: CompositeShape<f64, D> + Debug, const D: usize> Surface<f64, D> for Counted<S> {
    fn admits(&self, part: u32, feature: FeatureId, normal: &Vector<f64, D>) -> bool {
        self.asked().surface().expect("one").admits(part, feature, normal)
    }

    fn snapped(&self, part: u32, normal: &Vector<f64, D>) -> Option<Vector<f64, D>> {
        self.asked().surface()?.snapped(part, normal)
    }

    fn faces(&self, part: u32, center: &Point<f64, D>) -> bool {
        self.asked().surface().expect("one").faces(part, center)
    }
}

/// A shape whose geometry is a composite that counts calls.
#[derive(Debug)]
struct Ground<S>(Counted<S>);

impl<S, const D: usize> Shape<f64, D> for Ground<S>
where
    f64: Space<D>,
    S: CompositeShape<f64, D> + Shape<f64, D>,
{
    fn geometry(&self) -> Geometry<'_, f64, D> {
        Geometry::composite(&self.0)
    }

    fn local_aabb(&self) -> Aabb<f64, D> {
        self.0.shape.local_aabb()
    }
}

/// A box that queries know only by its support points.
#[derive(Debug)]
struct Crate<const D: usize>(Counted<Cuboid<f64, D>>);

impl<const D: usize> SupportMap<f64, D> for Crate<D> {
    fn core_support(&self, direction: &Vector<f64, D>) -> Point<f64, D> {
        self.0.asked().core_support(direction)
    }
}

impl<const D: usize> Shape<f64, D> for Crate<D>
where
    f64: Space<D>,
{
    fn geometry(&self) -> Geometry<'_, f64, D> {
        Geometry::support_map(self)
    }

    fn local_aabb(&self) -> Aabb<f64, D> {
        self.0.shape.local_aabb()
    }
}

/// Returns random heights of a rough surface.
fn heights(random: &mut Random, count: u32) -> Vec<f64> {
    (0..count).map(|_| 0.3 * random.unit()).collect()
}

/// Returns the number of unit cells along a surface that extends two cells beyond a plate of half
/// extent `half` on each side.
fn cells(half: u32) -> u32 {
    2 * half + 4
}

fn mesh(half: u32) -> TriMesh<f64, 3> {
    let (mut random, n) = (Random::new(96), cells(half));
    let heights = heights(&mut random, (n + 1) * (n + 1));
    let middle = f64::from(n) / 2.0;
    let place = |at: u32| {
        let [x, z] = [at % (n + 1), at / (n + 1)].map(|at| f64::from(at) - middle);
        Point::<f64, 3>::new(x, heights[at as usize], z)
    };
    let first = (0..n * (n + 1)).filter(|at| at % (n + 1) < n);
    let triangles = first.flat_map(|a| [[a, a + n + 1, a + 1], [a + 1, a + n + 1, a + n + 2]]);
    TriMesh::new((0..(n + 1) * (n + 1)).map(place).collect(), triangles.collect())
}

fn field(half: u32) -> HeightField<f64, 3> {
    let (mut random, n) = (Random::new(97), cells(half));
    let (heights, points) = (heights(&mut random, (n + 1) * (n + 1)), n as usize + 1);
    let extent = f64::from(n);
    HeightField::<f64, 3>::new(points, points, heights, Vector::<f64, 3>::new(extent, 1.0, extent))
}

/// Returns a fan of `8 half²` triangles around one corner, on the surface of a flat cone.
fn fan(half: u32) -> TriMesh<f64, 3> {
    let count = 8 * half * half;
    let place = |at: u32| {
        let angle = std::f64::consts::TAU * f64::from(at) / f64::from(count);
        Point::<f64, 3>::new(angle.cos(), 0.0, angle.sin())
    };
    let mut vertices: Vec<_> = (0..count).map(place).collect();
    vertices.push(Point::<f64, 3>::new(0.0, 0.4, 0.0));
    let triangles = (0..count).map(|at| [count, (at + 1) % count, at]);
    TriMesh::new(vertices, triangles.collect())
}

fn boxes(half: u32) -> Compound3<f64> {
    let (mut random, n) = (Random::new(98), cells(half));
    let heights = heights(&mut random, n * n);
    let one = ShapeHandle::<f64, 3>::new(Cuboid::new(Vector::<f64, 3>::repeat(0.45)));
    let place = |at: u32| {
        let [x, z] = [at % n, at / n].map(|at| f64::from(at) + 0.5 - f64::from(n) / 2.0);
        let turn = 0.1 * Vector::<f64, 3>::repeat(heights[at as usize]);
        Isometry3::new(Vector::<f64, 3>::new(x, heights[at as usize] - 0.45, z), turn)
    };
    Compound3::new((0..n * n).map(|at| (place(at), one.clone())).collect())
}

fn line(half: u32) -> Polyline<f64, 2> {
    let (mut random, n) = (Random::new(99), cells(half));
    let heights = heights(&mut random, n + 1);
    let place = |(at, &y): (u32, &f64)| Point::<f64, 2>::new(f64::from(at) - f64::from(n) / 2.0, y);
    Polyline::open((0..).zip(&heights).map(place).collect())
}

fn field2(half: u32) -> HeightField<f64, 2> {
    let (mut random, n) = (Random::new(100), cells(half));
    let extents = Vector::<f64, 2>::new(f64::from(n), 1.0);
    HeightField::<f64, 2>::new(heights(&mut random, n + 1), extents)
}

/// Returns the number of calls per part of the surface while a large box moves over it: for a
/// built-in box, and for a box known only by its support points.
fn asked_for_each_part<S, const D: usize>(ground: S, half: u32) -> [f64; 2]
where
    f64: Space<D>,
    S: CompositeShape<f64, D> + Shape<f64, D>,
{
    let ground = Ground(Counted::new(ground));
    let mut extents = Vector::<f64, D>::repeat(f64::from(half));
    extents[1] = 0.25;
    let (cuboid, unknown) = (Cuboid::new(extents), Crate(Counted::new(Cuboid::new(extents))));
    let (solids, unmoved) = ([&cuboid as &dyn Shape<f64, D>, &unknown], Pose::identity());
    solids.map(|solid| {
        let mut sliding = Sliding::<f64, D>::new();
        let mut found = 0;
        for step in 0..3 {
            let mut translation = Vector::<f64, D>::repeat(0.1 * f64::from(step));
            translation[1] = 0.25 + 0.2 - 0.03 * f64::from(step);
            let pose = f64::isometry(&Pose { translation, ..unmoved });
            let under = f64::isometry(&unmoved);
            found += sliding.update((&under, &ground), (&pose, solid), 0.02).len();
        }
        assert!(found > 0, "they touch");
        let asked =
            [&ground.0.asked, &unknown.0.asked].map(|asked| asked.swap(0, Ordering::Relaxed));
        (asked[0] + asked[1]) as f64 / f64::from(ground.0.shape.num_parts())
    })
}

/// Asserts that the number of calls per part does not grow: at the largest size it is at most 1.5
/// times the larger of the numbers at the two smaller sizes.
fn check_growth<S, const D: usize>(label: &str, halves: [u32; 3], make: impl Fn(u32) -> S)
where
    f64: Space<D>,
    S: CompositeShape<f64, D> + Shape<f64, D>,
{
    let [few, some, many] = halves.map(|half| asked_for_each_part(make(half), half));
    for solid in 0..2 {
        let [few, some, many] = [few, some, many].map(|asked| asked[solid]);
        let most = 1.5 * few.max(some);
        assert!(many <= most, "{label}, solid {solid}: for each part {few}, {some}, {many}");
    }
}

#[test]
fn contacts_of_a_large_solid_cost_no_more_for_each_part_than_those_of_a_small_one() {
    check_growth("mesh", [4, 8, 24], mesh);
    check_growth("field", [4, 8, 24], field);
    check_growth("fan", [2, 4, 12], fan);
    check_growth("compound", [4, 8, 24], boxes);
    check_growth("polyline", [16, 64, 512], line);
    check_growth("field in the plane", [16, 64, 512], field2);
}
