//! Contenders that build convex hulls of random points on a sphere. All of these points are
//! vertices of the hull.

use impinge::math::Point;
use impinge::shape::ConvexHull;
use impinge_reference::random::Random;
use parry3d::math::Vector;
use parry3d::shape::ConvexPolyhedron;

use super::measure::{Answer, Maker};

/// The number of points of a case, summed over all of its hulls.
const POINTS: usize = 20_000;

/// Sets of points on the unit sphere.
pub struct Clouds(Vec<Vec<[f32; 3]>>);

impl Clouds {
    /// Creates sets of `count` points each, `POINTS / count` of them.
    pub fn new(count: usize) -> Self {
        let mut random = Random::new(11);
        let mut point = || random.unit_vector::<3>().map(|x| x as f32);
        Self((0..POINTS / count).map(|_| (0..count).map(|_| point()).collect()).collect())
    }

    /// Returns the number of sets.
    pub const fn len(&self) -> usize {
        self.0.len()
    }
}

/// Returns the contenders. Each builds the hulls of all sets, one after the other; the results are
/// the vertices.
pub fn makers(clouds: &Clouds) -> Vec<Maker<'_>> {
    let (ours, theirs) = (clouds.0.iter().map(|cloud| points(cloud)), clouds.0.iter());
    let (ours, theirs): (Vec<_>, Vec<_>) =
        (ours.collect(), theirs.map(|cloud| vectors(cloud)).collect());
    let again = theirs.clone();
    vec![
        Maker::new("impinge ConvexHull", move || answer(made(&ours))),
        Maker::new("parry ConvexPolyhedron", move || answer(polyhedra(&theirs))),
        Maker::new("parry convex_hull", move || answer(corners(&again))),
    ]
}

fn points(cloud: &[[f32; 3]]) -> Vec<Point<f32, 3>> {
    cloud.iter().map(|point| Point::from(*point)).collect()
}

fn vectors(cloud: &[[f32; 3]]) -> Vec<Vector> {
    cloud.iter().map(|point| Vector::from_array(*point)).collect()
}

/// The bits of the coordinates of the vertices of all hulls.
type Corners = Vec<[u32; 3]>;

fn made(clouds: &[Vec<Point<f32, 3>>]) -> Corners {
    let hulls = clouds.iter().map(|cloud| ConvexHull::from_points(cloud));
    let hulls: Vec<_> = hulls.collect();
    let corners = hulls.iter().flat_map(|hull| hull.vertices().to_vec());
    corners.map(|point| [point.x, point.y, point.z].map(f32::to_bits)).collect()
}

fn polyhedra(clouds: &[Vec<Vector>]) -> Corners {
    let hulls = clouds.iter().filter_map(|cloud| ConvexPolyhedron::from_convex_hull(cloud));
    let hulls: Vec<_> = hulls.collect();
    hulls.iter().flat_map(|hull| bits(hull.points())).collect()
}

fn corners(clouds: &[Vec<Vector>]) -> Corners {
    let hulls =
        clouds.iter().filter_map(|cloud| parry3d::transformation::try_convex_hull(cloud).ok());
    hulls.flat_map(|(corners, _)| bits(&corners)).collect()
}

fn bits(points: &[Vector]) -> Corners {
    points.iter().map(|point| point.to_array().map(f32::to_bits)).collect()
}

fn answer<'a>(corners: Corners) -> Answer<'a> {
    Box::new(move || {
        corners
            .iter()
            .map(|[x, y, z]| u64::from(x ^ z.rotate_left(9)) << 32 | u64::from(*y))
            .collect()
    })
}
