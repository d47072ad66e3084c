//! A user-defined composite shape: stairs of a hundred thousand treads that take a few bytes.
//! Formulas give the position of each tread, and the treads near a box, so no tree is built. Rays,
//! distances, contacts and worlds treat each tread as an ordinary box. The output shows how few
//! treads a query in the middle of the stairs visits.

#![allow(clippy::print_stdout, reason = "printing is what the program is for")]

use std::sync::atomic::{AtomicU32, Ordering};

use impinge::dim3::math::Pose;
use impinge::dim3::prelude::*;
use impinge::dim3::query::witness;
use impinge::dim3::shape::{CompositeShape, Geometry, Part, PartSearch, PartSolid};

/// Tread n extends along x from n · `RUN` to (n + 1) · `RUN`; its upper side is at the height (n +
/// 1) · `RISE`.
const RUN: f64 = 0.5;
const RISE: f64 = 0.25;
const COUNT: u32 = 100_000;

#[derive(Debug)]
struct Stairs {
    /// The shape of every tread, 0.125 thick and 2 wide.
    tread: Cuboid<f64>,
    /// The number of treads that queries have visited, for the output.
    visited: AtomicU32,
}

/// Returns the gap along x between tread n and an interval, which is a lower bound of the distance
/// of the tread from a box that covers this interval. Infinite if there is no tread n.
fn gap(n: i64, [mins, maxs]: [f64; 2]) -> f64 {
    let start = n as f64 * RUN;
    let is_there = (0..i64::from(COUNT)).contains(&n);
    if is_there { (start - maxs).max(mins - start - RUN).max(0.0) } else { f64::INFINITY }
}

/// Visits treads from the middle of an interval towards both ends of the stairs, in the order of
/// their gaps. Ends when the gap exceeds the limit, which each call of `visit` replaces.
#[allow(clippy::cast_possible_truncation, reason = "casts of floats saturate")]
fn outward(x: [f64; 2], mut limit: f64, visit: &mut dyn FnMut(u32, f64) -> f64) {
    let middle = ((x[0] / 2.0 + x[1] / 2.0) / RUN) as i64;
    let mut right = middle.clamp(0, i64::from(COUNT) - 1);
    let mut left = right - 1;
    loop {
        let (before, after) = (gap(left, x), gap(right, x));
        let nearer = before.min(after);
        let next = u32::try_from(if before < after { left } else { right });
        let Some(n) = next.ok().filter(|_| nearer.is_finite() && nearer <= limit) else { return };
        limit = visit(n, nearer);
        if before < after { left -= 1 } else { right += 1 }
    }
}

/// Returns the interval of x that a box covers.
fn along(aabb: &Aabb<f64>) -> [f64; 2] {
    [aabb.mins().x, aabb.maxs().x]
}

impl PartSearch<f64, 3> for Stairs {
    fn bounds(&self) -> Aabb<f64> {
        let (x, y) = (f64::from(COUNT) * RUN, f64::from(COUNT) * RISE);
        Aabb::new(Point::new(0.0, 0.0, -1.0), Point::new(x, y, 1.0))
    }

    fn overlapping(&self, aabb: &Aabb<f64>, visit: &mut dyn FnMut(u32)) {
        outward(along(aabb), 0.0, &mut |n, nearer| {
            visit(n);
            nearer // zero: the search goes on as long as the gap is zero
        });
    }

    fn nearest(&self, aabb: &Aabb<f64>, limit: f64, visit: &mut dyn FnMut(u32, f64) -> f64) {
        outward(along(aabb), limit, visit);
    }

    // A moving box closes a gap along x at its speed along x. Without speed along x it can only
    // meet treads with a gap of zero.
    fn cast(
        &self,
        aabb: &Aabb<f64>,
        velocity: &Vector<f64>,
        limit: f64,
        visit: &mut dyn FnMut(u32, f64) -> f64,
    ) {
        let speed = velocity.x.abs();
        let reach = if speed > 0.0 { limit * speed } else { 0.0 };
        outward(along(aabb), reach, &mut |n, gap| {
            let limit = visit(n, if speed > 0.0 { gap / speed } else { 0.0 });
            if speed > 0.0 { limit * speed } else { limit.min(0.0) }
        });
    }
}

impl CompositeShape<f64, 3> for Stairs {
    fn num_parts(&self) -> u32 {
        COUNT
    }

    fn part(&self, part: u32) -> Part<'_, f64> {
        self.visited.fetch_add(1, Ordering::Relaxed);
        let n = f64::from(part);
        let middle = Vector::new((n + 0.5) * RUN, (n + 1.0) * RISE - 0.0625, 0.0);
        Part { pose: Pose::from_translation(middle), solid: PartSolid::Shape(&self.tread) }
    }

    fn search(&self) -> &dyn PartSearch<f64, 3> {
        self
    }
}

impl Shape<f64, 3> for Stairs {
    fn geometry(&self) -> Geometry<'_, f64> {
        Geometry::composite(self)
    }

    fn local_aabb(&self) -> Aabb<f64> {
        self.bounds()
    }
}

fn main() {
    let tread = Cuboid::new(Vector::new(RUN / 2.0, 0.0625, 1.0));
    let stairs = Stairs { tread, visited: AtomicU32::new(0) };
    let (here, ball) = (Isometry::identity(), Ball::new(0.5));
    let visits = || stairs.visited.swap(0, Ordering::Relaxed);

    let down = Ray::new(Point::new(25_000.25, 20_000.0, 0.0), -Vector::y());
    let hit = stairs.toi_and_normal_with_ray(&here, &down, true).expect("tread 50000 is below");
    let for_ray = visits();
    // The upper side of the tread is at 50001 · 0.25.
    assert_eq!((hit.part, hit.toi), (50_000, 20_000.0 - 12_500.25), "by the formula");

    let place = Isometry::translation(25_000.25, 12_500.25 + 0.75, 0.0);
    let found = witness(&here, &stairs, &place, &ball, f64::INFINITY).expect("there is no limit");
    let for_distance = visits();
    // The ball is 0.25 above its own tread. The front edge of the next tread is 0.25 beside and 0.5
    // below the center of the ball.
    let by_hand = (0.25_f64 * 0.25 + 0.5 * 0.5).sqrt() - 0.5;
    assert!((found.distance - by_hand).abs() < 1e-9, "{}, by hand {by_hand}", found.distance);
    assert_eq!(found.part1, 50_001, "the next one is nearer");
    println!("ray: tread {}, {for_ray} visited", hit.part);
    println!("ball: {:.4} from tread {}, {for_distance} visited", found.distance, found.part1);
    assert!(for_ray <= 4 && for_distance <= 16, "of a hundred thousand treads");

    // In a world a ball on the slope is in contact with a tread at every position.
    let mut world = CollisionWorld::new(0.02);
    let (groups, query) = (CollisionGroups::new(), ContactQuery::default());
    world.add(here, ShapeHandle::new(stairs), groups, query, ());
    let ball = world.add(here, ShapeHandle::new(ball), groups, query, ());
    for along in (1_000..1_100_u16).map(f64::from) {
        world.set_position(ball, Isometry::translation(along, along / 2.0 + 0.5, 0.0));
        world.update();
        assert!(world.contact_manifolds().next().is_some(), "at {along}");
    }
}
