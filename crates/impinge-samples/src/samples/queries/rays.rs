//! A fan of rays in a moving scene.

use impinge::bounding_volume::Ray;
use impinge::query::RayIntersection;
use impinge_record::{Detail, Query, Question, RayQuestion};
use impinge_scenes::asteroids;

use crate::prelude::*;
use crate::scene::Play;

/// A ray and its first hit.
#[derive(Debug)]
struct Shot<const D: usize>
where
    f32: Space<D>,
{
    ray: Ray<f32, D>,
    hit: Option<RayIntersection<f32, D>>,
}

/// Rays from the centre of a field of asteroids in all directions of the xy plane, like those of a
/// scanner.
#[derive(Debug, Default)]
pub(crate) struct Rays<const D: usize>
where
    f32: Space<D>,
{
    /// The scene with the asteroids.
    play: Play<D>,
    /// The origin of all rays.
    eye: Point<f32, D>,
    /// The rays of the last update with their hits.
    shots: Vec<Shot<D>>,
    /// The direction of the first ray, in radians from x to y.
    angle: f32,
}

impl<const D: usize> Rays<D>
where
    f32: Dimension<D>,
{
    /// Casts a ray of length `reach` at the angle `direction`, in radians from x to y. The recorder
    /// runs the query, so the recording contains the query and the hash of its result.
    fn shoot(
        &self,
        world: &mut World<D>,
        direction: f32,
        reach: f32,
    ) -> Result<Shot<D>, SampleError> {
        let direction = turn::<D>([0, 1], direction) * vector::<D>([1.0, 0.0, 0.0]);
        let ray = Ray::new(self.eye, direction);
        // The direction has length 1, so times are lengths. A ray that starts inside a solid hits
        // it at time zero.
        let asked = RayQuestion { ray, max_time: reach, solid: true };
        let answer = world.ask(&Query::new(Question::FirstRayHit(asked)))?;
        let hit = answer.first().and_then(|found| match found.detail {
            Detail::Ray(hit) => Some(hit),
            _ => None,
        });
        Ok(Shot { ray, hit })
    }
}

impl<const D: usize> Sample<D> for Rays<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new().number("count", "Rays", 72.0, [1.0, 360.0, 1.0]).number(
            "reach",
            "Their length",
            12.0,
            [1.0, 50.0, 1.0],
        )
    }

    /// Adds the asteroids. The origin of the rays is the mean of their positions.
    fn build(&mut self, world: &mut World<D>, _: &Panel) -> Result<(), SampleError> {
        let play = Play::start(asteroids(60), world)?;
        let places = play.handles().iter().map(|object| pose_of(world, *object).translation);
        let sum = places.fold(Vector::<f32, D>::zeros(), |sum, place| sum + place);
        self.eye = Point::from(sum / number(play.handles().len()));
        self.play = play;
        Ok(())
    }

    fn advance(&mut self, world: &mut World<D>, _: &mut Panel) -> Result<(), SampleError> {
        self.angle += 0.002;
        self.play.advance(world)
    }

    /// Casts the rays after the update, when the asteroids are at their new positions.
    fn updated(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let (count, reach) = (panel.count("count"), panel.value("reach"));
        let directions = (0..count).map(|n| self.angle + TAU * number(n) / number(count));
        let shots = directions.map(|direction| self.shoot(world, direction, reach));
        self.shots = shots.collect::<Result<_, _>>()?;
        Ok(())
    }

    /// Draws each ray up to its hit, or with its full length.
    fn draw(&self, _: &World<D>, panel: &Panel, canvas: &mut Canvas<'_, D>) {
        for Shot { ray, hit } in &self.shots {
            let end = hit.map_or(panel.value("reach"), |hit| hit.toi);
            canvas.drawing.ray(ray, end, hit.as_slice(), canvas.renderer);
        }
    }

    fn readouts(&self, _: &World<D>, _: &Panel) -> Vec<Readout> {
        let times = self.shots.iter().filter_map(|shot| shot.hit).map(|hit| hit.toi);
        vec![
            Readout::new("Rays that hit", times.clone().count()),
            Readout::number("Nearest hit", times.reduce(min).unwrap_or(0.0)),
        ]
    }
}
