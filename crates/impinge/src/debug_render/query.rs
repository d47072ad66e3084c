//! Drawing of queries and their results: contacts, closest points, boxes, rays, moving shapes.

use super::drawing::{are_finite, draw_box};
use super::{DebugDrawing, DebugRender, Drawn};
use crate::bounding_volume::{Aabb, Ray};
use crate::math::{Point, Pose, Real, Space, Vector, centroid, max};
use crate::query::{ClosestPoints, Contact, Impact, RayIntersection};
use crate::shape::ShapeHandle;
use crate::tables::ByDimension;

/// A shape that moves along a straight line without rotating: the input of a shape cast.
///
/// ```
/// use impinge::debug_render::SweptShape;
/// use impinge::dim2::prelude::*;
///
/// let ball = ShapeHandle::new(Ball::new(0.5_f32));
/// let sweep: SweptShape<'_, f32, 2> = SweptShape {
///     shape: &ball,
///     position: Isometry::identity(),
///     velocity: Vector::new(2.0, 0.0),
///     max_time: 3.0,
/// };
/// assert_eq!(sweep.position_at(2.0).translation.x, 4.0);
/// ```
#[derive(Clone, Copy, Debug)]
pub struct SweptShape<'a, N: Space<D>, const D: usize> {
    /// The moving shape.
    pub shape: &'a ShapeHandle<N, D>,
    /// The position of the shape at time zero.
    pub position: N::Isometry,
    /// The velocity of the shape in the world frame: its displacement per unit of time.
    pub velocity: Vector<N, D>,
    /// The time at which the motion ends; may be infinite.
    pub max_time: N,
}

impl<N: Space<D>, const D: usize> SweptShape<'_, N, D> {
    /// Returns the position of the shape at a time.
    #[must_use]
    pub fn position_at(&self, time: N) -> N::Isometry {
        let start = N::pose(&self.position);
        N::isometry(&Pose { translation: start.translation + self.velocity * time, ..start })
    }
}

impl<N: Space<D>, const D: usize> DebugDrawing<N, D> {
    /// Draws the contacts of one manifold: points, normals, depths and, for at least three
    /// contacts, the area between them.
    ///
    /// ```
    /// use impinge::debug_render::{Color, DebugDrawing, DebugRender, Drawn};
    /// use impinge::dim2::prelude::*;
    ///
    /// struct Points(Vec<Point<f64>>);
    ///
    /// impl DebugRender<f64, 2> for Points {
    ///     fn line(&mut self, _: [Point<f64>; 2], _: Color, _: Drawn) {}
    ///
    ///     fn point(&mut self, at: &Point<f64>, _: f64, _: Color, _: Drawn) {
    ///         self.0.push(*at);
    ///     }
    /// }
    ///
    /// let (ball, there) = (Ball::new(1.0), Isometry::translation(1.5, 0.0));
    /// let found = contact(&Isometry::identity(), &ball, &there, &ball, 0.0);
    /// let mut points = Points(Vec::new());
    /// DebugDrawing::default().contacts(found, &mut points);
    /// assert_eq!(points.0, [Point::new(1.0, 0.0), Point::new(0.5, 0.0)]);
    /// // For a manifold view: `drawing.contacts(view.contacts().map(|point| point.contact), …)`.
    /// ```
    pub fn contacts(
        &self,
        contacts: impl IntoIterator<Item = Contact<N, D>>,
        renderer: &mut dyn DebugRender<N, D>,
    ) {
        let contacts: Vec<_> = contacts.into_iter().collect();
        self.area(&contacts, renderer);
        for contact in &contacts {
            if let Some(style) = self.options.contact_point {
                for point in [&contact.world1, &contact.world2] {
                    renderer.point(point, style.size, style.color, Drawn::ContactPoint);
                }
            }
            if let Some(style) = self.options.contact_normal {
                let (from, what) = (&contact.world1, Drawn::ContactNormal);
                let tip = from + contact.normal.into_inner() * style.size;
                renderer.line([*from, contact.world2], style.color, what);
                renderer.arrow(from, &tip, style.color, what);
                renderer.text(from, &shortened(contact.depth), style.color, what);
            }
        }
    }

    /// Draws the area of a manifold as triangles. Each triangle has the mean of the points and two
    /// neighbouring points as its corners; a point is midway between the two points of a contact,
    /// and the points are sorted by their angle around the first normal. Does nothing for fewer
    /// than three contacts.
    fn area(&self, contacts: &[Contact<N, D>], renderer: &mut dyn DebugRender<N, D>) {
        let (Some(style), [first, _, _, ..]) = (self.options.manifold, contacts) else { return };
        let between =
            |contact: &Contact<N, D>| contact.world1 + (contact.world2 - contact.world1) * N::HALF;
        let mut points: Vec<_> = contacts.iter().map(between).collect();
        let (middle, axes) = (centroid(&points), <N::Algorithms>::tangents(&first.normal));
        let angle = |point: &Point<N, D>| {
            let [x, y] = axes.map(|axis| axis.dot(&(point - middle)));
            diamond_angle(x, y)
        };
        points.sort_by(|a, b| angle(a).as_f64().total_cmp(&angle(b).as_f64()));
        let next = points.iter().cycle().skip(1);
        for (a, b) in points.iter().zip(next) {
            renderer.triangle([middle, *a, *b], style.color, Drawn::Manifold);
        }
    }

    /// Draws closest points and a line between them; draws nothing if the solids touch or are
    /// farther apart than the margin.
    pub fn closest_points(
        &self,
        found: &ClosestPoints<N, D>,
        renderer: &mut dyn DebugRender<N, D>,
    ) {
        let ClosestPoints::WithinMargin(point1, point2) = found else { return };
        if let Some(style) = self.options.proximity {
            renderer.line([*point1, *point2], style.color, Drawn::Proximity);
            for point in [point1, point2] {
                renderer.point(point, style.size, style.color, Drawn::Proximity);
            }
        }
    }

    /// Draws the box of a query.
    pub fn aabb(&self, aabb: &Aabb<N, D>, renderer: &mut dyn DebugRender<N, D>) {
        if let Some(style) = &self.options.query {
            draw_box(aabb, style, Drawn::Query, renderer);
        }
    }

    /// Draws a ray up to `max_time`, and its hits with their normals.
    ///
    /// If `max_time` is not finite, the ray is drawn to its last hit or, without hits, for one unit
    /// of time. A ray that is not finite is not drawn.
    pub fn ray(
        &self,
        ray: &Ray<N, D>,
        max_time: N,
        hits: &[RayIntersection<N, D>],
        renderer: &mut dyn DebugRender<N, D>,
    ) {
        let last = hits.iter().map(|hit| hit.toi).reduce(max).unwrap_or(N::ONE);
        let end = max(if max_time.is_finite_number() { max_time } else { last }, N::ZERO);
        let ends = [ray.origin, ray.point_at(end)];
        if let Some(style) = self.options.query.filter(|_| are_finite(ends.each_ref())) {
            renderer.line(ends, style.color, Drawn::Query);
        }
        for hit in hits {
            self.hit(&ray.point_at(hit.toi), &hit.normal, renderer);
        }
    }

    /// Draws a moving shape at the start, at the hit and at the end of its path, an arrow along the
    /// path, and the impact with its normal. If the path is infinite, its end is not drawn, and the
    /// arrow ends at the hit; without a hit there is then no arrow.
    pub fn cast(
        &mut self,
        sweep: &SweptShape<'_, N, D>,
        hit: Option<&Impact<N, D>>,
        renderer: &mut dyn DebugRender<N, D>,
    ) {
        let end = Some(sweep.max_time).filter(|time| time.is_finite_number());
        let impact = hit.map(|hit| hit.toi);
        if let Some(style) = self.options.query {
            let mesh = self.mesh(sweep.shape);
            let times = [Some(N::ZERO), impact, end].into_iter().flatten();
            let positions = times.map(|time| sweep.position_at(time));
            for position in positions.filter(|position| N::pose(position).is_finite()) {
                renderer.mesh(mesh, &position, style.color, Drawn::Query);
            }
            let start = Point::from(N::translation(&sweep.position));
            let tip = start + sweep.velocity * end.or(impact).unwrap_or(N::ZERO);
            if tip != start && are_finite([&start, &tip]) {
                renderer.arrow(&start, &tip, style.color, Drawn::Query);
            }
        }
        if let Some(hit) = hit {
            self.hit(&hit.world1, &hit.normal, renderer);
        }
    }

    /// Draws the point of a hit, and the normal there unless it is zero.
    fn hit(&self, at: &Point<N, D>, normal: &Vector<N, D>, renderer: &mut dyn DebugRender<N, D>) {
        let Some(style) = self.options.query_hit else { return };
        if !are_finite([at, &(at + normal)]) {
            return;
        }
        renderer.point(at, style.size * N::HALF, style.color, Drawn::QueryHit);
        if *normal != Vector::<N, D>::zeros() {
            renderer.arrow(at, &(at + normal * style.size), style.color, Drawn::QueryHit);
        }
    }
}

/// Formats a length with four significant digits.
fn shortened<N: Real>(length: N) -> String {
    let length = length.as_f64();
    // Parsing the text again removes trailing zeros. Adding zero makes a zero positive.
    let rounded = format!("{length:.3e}").parse().unwrap_or(length) + 0.0;
    let is_tiny = rounded != 0.0 && rounded.abs() < 1e-4;
    if is_tiny { format!("{rounded:e}") } else { rounded.to_string() }
}

/// Returns a number from 0 to 4 that grows with the angle of (x, y), counter-clockwise from the x
/// axis. It is the position along the square `|x| + |y| = 1`, and zero for the zero vector.
fn diamond_angle<N: Real>(x: N, y: N) -> N {
    let sum = x.abs() + y.abs();
    let part = if sum > N::ZERO { y / sum } else { N::ZERO };
    match (x < N::ZERO, y < N::ZERO) {
        (false, false) => part,
        (true, _) => N::TWO - part,
        (false, true) => N::TWO + N::TWO + part,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn depths_are_short() {
        assert_eq!(shortened(0.019_999_999_999_574_f64), "0.02");
        assert_eq!(shortened(0.1_f32 + 0.2), "0.3");
        assert_eq!(shortened(-1234.56_f64), "-1235", "four digits");
        assert_eq!(shortened(4.44e-16_f64), "4.44e-16", "not a row of zeros");
        assert_eq!(shortened(-0.0_f32), "0");
    }
}
