//! The objects and the queries of the suite, as plain data.

use impinge::bounding_volume::Aabb;
use impinge::math::{Point, Space};
use impinge::partitioning::BoxTree;
use impinge_scenes::{Placement, SceneShape};

/// Half of the average edge of an object.
const HALF: f64 = 0.5;

/// Balls and rotated boxes in a cube. One of fifty is three times as large as the others.
#[derive(Clone, Debug)]
pub struct Scene<const D: usize> {
    /// The name in the table.
    pub name: &'static str,
    /// The objects and their placements.
    pub objects: Vec<(SceneShape<D>, Placement<D>)>,
    /// The AABBs of the objects; trees of boxes contain only these.
    pub boxes: Vec<Corners<D>>,
    /// The edge of the cube.
    edge: f64,
    /// The maximum length of rays and shape casts.
    pub reach: f32,
}

/// The corners of a box with the least and the greatest coordinates.
pub type Corners<const D: usize> = ([f32; D], [f32; D]);

/// The origin and the unit direction of a ray.
pub type Ray<const D: usize> = ([f32; D], [f32; D]);

/// A solid with its placement.
pub type Solid<const D: usize> = (SceneShape<D>, Placement<D>);

/// The queries of one case. `Rays` to `Overlapping` are about solids, the others about boxes only.
#[derive(Clone, Debug)]
pub enum Questions<const D: usize> {
    /// The first solid that a ray hits, and the time. No ray starts in the box of a solid.
    Rays(Vec<Ray<D>>, f32),
    /// The first solid that a moving solid hits, and the time. The moving solid starts apart from
    /// all boxes and moves along the unit vector.
    Casts(Vec<(Solid<D>, [f32; D])>, f32),
    /// The solid nearest to a point, and its distance; no point is in a box.
    Nearest(Vec<[f32; D]>),
    /// The solids that contain a point.
    Containing(Vec<[f32; D]>),
    /// The solids that touch a solid.
    Overlapping(Vec<Solid<D>>),
    /// The first box that a ray hits, and the time.
    BoxRays(Vec<Ray<D>>, f32),
    /// The box nearest to a point, and its distance.
    BoxNearest(Vec<[f32; D]>),
    /// The boxes that contain a point.
    BoxContaining(Vec<[f32; D]>),
    /// The boxes that overlap a box.
    BoxOverlapping(Vec<Corners<D>>),
}

/// A library that supports some kinds of queries, each in one or more ways.
pub trait Library<const D: usize> {
    /// Returns the contenders for the queries, with the queries already converted to the library's
    /// types. Empty if the library does not support this kind.
    fn contenders<'a>(&'a self, questions: &Questions<D>) -> Vec<super::race::Contender<'a>>;
}

impl<const D: usize> Scene<D> {
    /// Creates a scene of `objects` objects. The cube is so large that as many cubes of edge 1
    /// would fill the fraction `share` of it.
    pub fn new(name: &'static str, objects: usize, share: f64, reach: f32) -> Self {
        let mut random = Random(0x5eed + D as u64);
        let edge = (objects as f64 / share).powf(1.0 / D as f64) * 2.0 * HALF;
        let objects: Vec<_> =
            (0..objects).map(|n| random.solid(edge, if n % 50 == 0 { 3.0 } else { 1.0 })).collect();
        let boxes = objects.iter().map(|(shape, placement)| corners(shape, placement)).collect();
        Self { name, objects, boxes, edge, reach }
    }

    /// Returns the queries of each kind: `count / 5` shape casts and overlaps of solids, which are
    /// expensive, and `count` of each other kind.
    pub fn questions(&self, count: usize) -> Vec<(&'static str, Questions<D>)>
    where
        f32: Space<D>,
    {
        let mut random = Random(0x0a5c);
        let taken = BoxTree::from_boxes(&self.boxes.iter().map(aabb).collect::<Vec<_>>());
        let is_free = |corners: &Corners<D>| taken.overlapping(&aabb(corners)).is_empty();
        let outside = random.many(count, |random| random.point(self.edge), |&p| is_free(&(p, p)));
        let rays: Vec<Ray<D>> = outside.iter().map(|&from| (from, random.heading())).collect();
        let anywhere: Vec<_> = (0..count).map(|_| random.point(self.edge)).collect();
        let solids: Vec<_> = (0..count / 5).map(|_| random.solid(self.edge, 1.0)).collect();
        let small = |random: &mut Random| random.solid(self.edge, 0.5);
        let casts = random.many(count / 5, small, |(shape, place)| is_free(&corners(shape, place)));
        let casts = casts.into_iter().map(|solid| (solid, random.heading())).collect();
        let boxes = anywhere.iter().map(|&at| (at, at.map(|x| x + 2.0 * HALF as f32))).collect();
        vec![
            ("first on a ray", Questions::Rays(rays.clone(), self.reach)),
            ("first in the way of a solid", Questions::Casts(casts, self.reach)),
            ("nearest to a point", Questions::Nearest(outside.clone())),
            ("holding a point", Questions::Containing(anywhere.clone())),
            ("touching a solid", Questions::Overlapping(solids)),
            ("first box on a ray", Questions::BoxRays(rays, self.reach)),
            ("box nearest to a point", Questions::BoxNearest(outside)),
            ("boxes holding a point", Questions::BoxContaining(anywhere)),
            ("boxes meeting a box", Questions::BoxOverlapping(boxes)),
        ]
    }
}

fn corners<const D: usize>(shape: &SceneShape<D>, placement: &Placement<D>) -> Corners<D> {
    let (low, high) = shape.aabb(placement).expect("balls and boxes are bounded");
    (low.map(|x| x as f32), high.map(|x| x as f32))
}

fn aabb<const D: usize>((low, high): &Corners<D>) -> Aabb<f32, D> {
    Aabb::new(Point::from(*low), Point::from(*high))
}

/// The generator `SplitMix64`: Steele, Lea, Flood, "Fast Splittable Pseudorandom Number Generators"
/// (2014).
#[derive(Clone, Debug)]
pub struct Random(pub u64);

impl Random {
    fn bits(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mixed = (self.0 ^ (self.0 >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        let mixed = (mixed ^ (mixed >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        mixed ^ (mixed >> 31)
    }

    /// Returns a random number from `low` to `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        let unit = (self.bits() >> 11) as f64 / (1_u64 << 53) as f64;
        low + (high - low) * unit
    }

    /// Returns a random integer less than `bound`.
    pub fn below(&mut self, bound: usize) -> usize {
        (self.bits() % bound as u64) as usize
    }

    fn point<const D: usize>(&mut self, edge: f64) -> [f32; D] {
        std::array::from_fn(|_| self.between(0.0, edge) as f32)
    }

    /// Returns a uniformly distributed unit vector, by rejection of points outside the unit ball.
    pub fn direction<const D: usize>(&mut self) -> [f64; D] {
        loop {
            let v: [f64; D] = std::array::from_fn(|_| self.between(-1.0, 1.0));
            let squared: f64 = v.iter().map(|x| x * x).sum();
            if (1e-4..1.0).contains(&squared) {
                return v.map(|x| x / squared.sqrt());
            }
        }
    }

    /// Returns a random unit vector in `f32`.
    fn heading<const D: usize>(&mut self) -> [f32; D] {
        self.direction().map(|x| x as f32)
    }

    /// Draws until `count` values are accepted, and returns these.
    fn many<T>(
        &mut self,
        count: usize,
        draw: impl Fn(&mut Self) -> T,
        is_wanted: impl Fn(&T) -> bool,
    ) -> Vec<T> {
        std::iter::repeat_with(|| draw(self)).filter(is_wanted).take(count).collect()
    }

    /// Returns a ball or a rotated box at a random position in the cube. Its radius or half extents
    /// are 0.3 to 0.7 times `scale`.
    fn solid<const D: usize>(&mut self, edge: f64, scale: f64) -> Solid<D> {
        let mut half = || scale * self.between(0.6 * HALF, 1.4 * HALF);
        let (radius, half_extents) = (half(), std::array::from_fn(|_| half()));
        let at = std::array::from_fn(|_| self.between(0.0, edge));
        let placement = Placement::at(at);
        if self.below(2) == 0 {
            return (SceneShape::Ball { radius }, placement);
        }
        let axis = if D == 3 { self.direction() } else { placement.axis };
        let tangent = self.between(-1.0, 1.0);
        (SceneShape::Cuboid { half_extents }, Placement { axis, tangent, ..placement })
    }
}
