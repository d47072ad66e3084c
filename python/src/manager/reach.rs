//! Bounding balls of objects, and a box around all of them: they reject distant objects without a search.

use impinge::bounding_volume::{Aabb, BoundingVolume};
use impinge::math::{Isometry3, Point, Vector};
use impinge::shape::{Shape, bounding_sphere};

/// The bounding ball of an object.
#[derive(Clone, Copy, Debug)]
struct Ball {
    /// The centre in the local frame of the shape.
    local: Point<f64, 3>,
    /// The centre in the world frame.
    center: Point<f64, 3>,
    radius: f64,
}

/// The balls of the objects, by index, and a box around them.
#[derive(Debug, Default)]
pub(super) struct Reach {
    balls: Vec<Option<Ball>>,
    count: usize,
    around: Option<Aabb<f64, 3>>,
    /// The number of objects that were added or moved since the box was computed from all balls;
    /// each may have enlarged it. The box is computed again when this number exceeds the number of
    /// objects.
    grown: usize,
}

impl Reach {
    /// Adds the ball of an object.
    pub(super) fn add(&mut self, index: u32, shape: &dyn Shape<f64, 3>, position: &Isometry3<f64>) {
        let sphere = bounding_sphere(shape, &Isometry3::identity());
        let local = *sphere.center();
        let index = index as usize;
        if self.balls.len() <= index {
            self.balls.resize(index + 1, None);
        }
        self.balls[index] = Some(Ball { local, center: local, radius: sphere.radius() });
        self.count += 1;
        self.place(index, position);
    }

    pub(super) fn remove(&mut self, index: u32) {
        self.balls[index as usize] = None;
        self.count -= 1;
    }

    /// Moves the ball of an object.
    pub(super) fn place(&mut self, index: usize, position: &Isometry3<f64>) {
        let Some(ball) = &mut self.balls[index] else { return };
        ball.center = position * ball.local;
        let own = aabb_of(ball);
        self.grown += 1;
        if self.grown > self.count {
            let all = self.balls.iter().flatten().map(aabb_of);
            (self.around, self.grown) = (all.reduce(|one, other| one.merged(&other)), 0);
        } else {
            self.around = Some(self.around.map_or(own, |around| around.merged(&own)));
        }
    }

    /// Returns a box that contains all objects, not always the smallest one; `None` before the
    /// first object.
    pub(super) const fn around(&self) -> Option<&Aabb<f64, 3>> {
        self.around.as_ref()
    }

    /// Whether the object with this index may touch the box; `false` if it was removed.
    pub(super) fn may_meet(&self, index: u32, aabb: &Aabb<f64, 3>) -> bool {
        self.balls[index as usize].is_some_and(|ball| distance_to(&ball, aabb) <= 0.0)
    }

    /// Whether two objects may be less than `limit` apart; `false` if one was removed.
    pub(super) fn may_be_within(&self, one: u32, other: u32, limit: f64) -> bool {
        let (Some(ball1), Some(ball2)) = (self.balls[one as usize], self.balls[other as usize])
        else {
            return false;
        };
        (ball1.center - ball2.center).norm() < limit + roomy(&ball1) + roomy(&ball2)
    }

    /// Returns the objects whose lower bound of the distance from the box is at most `limit`, with
    /// the bounds in ascending order.
    pub(super) fn within(&self, aabb: &Aabb<f64, 3>, limit: f64) -> Vec<(f64, u32)> {
        let mut found: Vec<_> = self.distances(aabb).filter(|(far, _)| *far <= limit).collect();
        found.sort_unstable_by(|one, other| one.0.total_cmp(&other.0).then(one.1.cmp(&other.1)));
        found
    }

    /// Returns the object with the smallest lower bound of its distance from the box; `None` if
    /// there is no object.
    pub(super) fn first(&self, aabb: &Aabb<f64, 3>) -> Option<u32> {
        let nearer = |one: &(f64, u32), other: &(f64, u32)| one.0.total_cmp(&other.0);
        self.distances(aabb).min_by(nearer).map(|(_, index)| index)
    }

    /// Returns for each object a lower bound of its distance from the box.
    fn distances(&self, aabb: &Aabb<f64, 3>) -> impl Iterator<Item = (f64, u32)> {
        let balls = (0..).zip(&self.balls);
        balls.filter_map(|(index, ball)| Some((distance_to(&(*ball)?, aabb), index)))
    }
}

/// Returns a lower bound of the distance from the box to the object in the ball.
fn distance_to(ball: &Ball, aabb: &Aabb<f64, 3>) -> f64 {
    (aabb.distance_to_point(&ball.center) - roomy(ball)).max(0.0)
}

/// Returns the radius plus a bound of the rounding error of the centre.
fn roomy(ball: &Ball) -> f64 {
    ball.radius + 1e-12 * (ball.radius + ball.center.coords.amax())
}

fn aabb_of(ball: &Ball) -> Aabb<f64, 3> {
    Aabb::from_half_extents(ball.center, Vector::<f64, 3>::repeat(roomy(ball)))
}
