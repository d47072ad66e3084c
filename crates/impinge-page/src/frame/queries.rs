//! Draws the recorded queries, each with its result in the replayed world. Methods of
//! [`DebugDrawing`] draw rays, casts and boxes; the pen draws points, shapes and projections.

use core::fmt;

use impinge::debug_render::{DebugDrawing, DebugRender, Drawn, SweptShape};
use impinge::math::{Point, Space};
use impinge::query::{ClosestPoints, Impact, RayIntersection};
use impinge_record::{Asked, CastQuestion, Detail, PlacedShape, Question};

/// Draws queries: the drawing has the styles, and the renderer takes the elements.
pub(crate) struct QueryPen<'a, N: Space<D>, const D: usize> {
    pub(crate) drawing: &'a mut DebugDrawing<N, D>,
    pub(crate) renderer: &'a mut dyn DebugRender<N, D>,
}

impl<N: Space<D>, const D: usize> fmt::Debug for QueryPen<'_, N, D> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("QueryPen").field("drawing", &self.drawing).finish_non_exhaustive()
    }
}

impl<N: Space<D>, const D: usize> QueryPen<'_, N, D> {
    /// Draws a query, and the hits, projections or closest points of its result. Objects that a
    /// query finds at a point, in a box or overlapping a shape are not marked.
    pub(crate) fn draw(&mut self, asked: &Asked<N, D>) {
        // All details of a query have the variant that belongs to the kind of the query.
        let details = asked.answer.iter().map(|found| &found.detail);
        match &asked.query.question {
            Question::FirstRayHit(ray) | Question::RayHits(ray) => {
                let hits: Vec<_> = details.filter_map(ray_hit).collect();
                self.drawing.ray(&ray.ray, ray.max_time, &hits, self.renderer);
            }
            Question::Containing(point) => self.point(point),
            Question::ProjectPoint { point, .. } => {
                self.point(point);
                details
                    .filter_map(|detail| projection(point, detail))
                    .for_each(|ends| self.found(ends));
            }
            Question::InAabb(aabb) => self.drawing.aabb(aabb, self.renderer),
            Question::Overlapping(placed) => self.shape(placed),
            Question::Nearest { from, .. } => {
                self.shape(from);
                details.filter_map(nearest).for_each(|ends| self.found(ends));
            }
            Question::CastShape(cast) | Question::CastShapeAll(cast) => {
                self.cast(cast, details.filter_map(impact));
            }
        }
    }

    /// Draws the point of a query.
    fn point(&mut self, at: &Point<N, D>) {
        if let Some(style) = self.drawing.options().query {
            self.renderer.point(at, style.size, style.color, Drawn::Query);
        }
    }

    /// Draws the shape of a query. A shape whose pose is not finite is omitted; queries are
    /// recorded with any arguments.
    fn shape(&mut self, placed: &PlacedShape<N, D>) {
        let style = self.drawing.options().query;
        if let Some(style) = style.filter(|_| N::pose(&placed.position).is_finite()) {
            let mesh = self.drawing.mesh(&placed.shape);
            self.renderer.mesh(mesh, &placed.position, style.color, Drawn::Query);
        }
    }

    /// Draws a line between the two points of a result, and the second of them as a point.
    fn found(&mut self, ends: [Point<N, D>; 2]) {
        if let Some(style) = self.drawing.options().query_hit {
            self.renderer.line(ends, style.color, Drawn::QueryHit);
            self.renderer.point(&ends[1], style.size * N::HALF, style.color, Drawn::QueryHit);
        }
    }

    /// Draws the sweep of a shape and its first hit. For each later hit, draws a line between the
    /// points in contact.
    fn cast<'a>(
        &mut self,
        cast: &CastQuestion<N, D>,
        mut hits: impl Iterator<Item = &'a Impact<N, D>>,
    ) {
        let CastQuestion { start, velocity, options } = cast;
        let PlacedShape { position, shape } = start;
        let (position, velocity, max_time) = (*position, *velocity, options.max_time);
        let sweep = SweptShape { shape, position, velocity, max_time };
        self.drawing.cast(&sweep, hits.next(), self.renderer);
        hits.for_each(|hit| self.found([hit.world1, hit.world2]));
    }
}

const fn ray_hit<N: Space<D>, const D: usize>(
    detail: &Detail<N, D>,
) -> Option<RayIntersection<N, D>> {
    if let Detail::Ray(hit) = detail { Some(*hit) } else { None }
}

const fn impact<N: Space<D>, const D: usize>(detail: &Detail<N, D>) -> Option<&Impact<N, D>> {
    if let Detail::Impact(hit) = detail { Some(hit) } else { None }
}

const fn projection<N: Space<D>, const D: usize>(
    from: &Point<N, D>,
    detail: &Detail<N, D>,
) -> Option<[Point<N, D>; 2]> {
    if let Detail::Projection(found) = detail { Some([*from, found.point]) } else { None }
}

const fn nearest<N: Space<D>, const D: usize>(detail: &Detail<N, D>) -> Option<[Point<N, D>; 2]> {
    match detail {
        Detail::Near { points: ClosestPoints::WithinMargin(one, two), .. } => Some([*one, *two]),
        _ => None,
    }
}
