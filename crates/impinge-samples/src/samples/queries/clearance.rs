//! The clearance of a body along a path.

use crate::prelude::*;

/// The number of sections of the path, at whose ends the clearance is computed.
const PLACES: usize = 120;

/// A point of the path, and its clearance.
#[derive(Clone, Copy, Debug)]
struct Place<const D: usize> {
    /// The point.
    at: Point<f32, D>,
    /// The distance between the body at this point and the nearest obstacle; zero if they would
    /// touch.
    distance: f32,
}

/// A body on a wavy path between obstacles. The user can drag the obstacles.
#[derive(Debug, Default)]
pub(crate) struct Clearance<const D: usize> {
    /// The object that follows the path.
    body: Option<CollisionObjectHandle>,
    /// The points of the path with their clearances.
    places: Vec<Place<D>>,
    step: usize,
}

/// Returns a point of the path. `place` is from 0 (start) to [`PLACES`] (end).
fn path<const D: usize>(place: usize) -> Point<f32, D> {
    let share = number(place) / number(PLACES);
    let sine = impinge::math::Real::sine_cosine(2.0 * TAU * share).0;
    point([12.0 * share - 6.0, 1.5 * sine, 0.0])
}

/// Returns the colour of a distance, from red at 0 to green from `wanted` on.
fn color(distance: f32, wanted: f32) -> Color {
    let share = min(distance / wanted, 1.0);
    let shade = |from: f32, to: f32| {
        let level = from + (to - from) * share;
        (0..=u8::MAX).rev().find(|shade| f32::from(*shade) <= level).unwrap_or(0)
    };
    Color::rgb(shade(240.0, 60.0), shade(60.0, 210.0), 80)
}

impl<const D: usize> Sample<D> for Clearance<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new().number("radius", "Radius of the body", 0.3, [0.05, 1.0, 0.05]).number(
            "wanted",
            "Wanted distance",
            0.6,
            [0.1, 3.0, 0.1],
        )
    }

    /// Adds the body, and obstacles of several kinds on both sides of the path.
    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        let (groups, query) = (CollisionGroups::new(), ContactQuery::default());
        let body = ShapeHandle::new(Ball::new(panel.value("radius")));
        let start = f32::isometry(&Pose::from_translation(path(0).coords));
        self.body = Some(world.add(start, body, groups, query, "body".to_owned())?);
        for n in 0..7 {
            let side = if n % 2 == 0 { -1.0 } else { 1.2 };
            let position = turned([1.7 * number(n) - 5.0, side, 0.0], number(n));
            let shape = solid(f32::SOLIDS[n], 0.6);
            world.add(position, shape, groups, query, format!("obstacle {n}"))?;
        }
        Ok(())
    }

    /// Changes the radius of the body. A larger body has less clearance.
    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let Some(body) = self.body else { return Ok(()) };
        Ok(world.set_shape(body, ShapeHandle::new(Ball::new(panel.value("radius"))))?)
    }

    /// Moves the body to the next point of the path every three steps, and from the end to the
    /// start.
    fn advance(&mut self, world: &mut World<D>, _: &mut Panel) -> Result<(), SampleError> {
        self.step += 1;
        let Some(body) = self.body else { return Ok(()) };
        let place = path(self.step / 3 % (PLACES + 1));
        Ok(world.set_position(body, f32::isometry(&Pose::from_translation(place.coords)))?)
    }

    /// Computes the distance of the body from the nearest other object, for each point of the path.
    fn updated(&mut self, world: &mut World<D>, _: &Panel) -> Result<(), SampleError> {
        let found = self.body.and_then(|body| world.collision_object(body));
        let Some(body) = found else { return Ok(()) };
        let others = QueryFilter::new().exclude(body.handle());
        let measured = (0..=PLACES).map(|place| {
            let at = path(place);
            let position = f32::isometry(&Pose::from_translation(at.coords));
            // The limit of 100 exceeds all distances here. A smaller limit would be faster.
            let near = world.closest_object(&position, &**body.shape(), 100.0, &others);
            Place { at, distance: near.map_or(100.0, |near| near.distance) }
        });
        self.places = measured.collect();
        Ok(())
    }

    /// Draws each section of the path in the colour of its end with the smaller distance.
    fn draw(&self, _: &World<D>, panel: &Panel, canvas: &mut Canvas<'_, D>) {
        for pair in self.places.windows(2) {
            let least = min(pair[0].distance, pair[1].distance);
            canvas.line([pair[0].at, pair[1].at], color(least, panel.value("wanted")));
        }
    }

    fn readouts(&self, _: &World<D>, panel: &Panel) -> Vec<Readout> {
        let distances = self.places.iter().map(|place| place.distance);
        let narrow = distances.clone().filter(|distance| *distance < panel.value("wanted"));
        vec![
            Readout::number("Least distance", distances.clone().reduce(min).unwrap_or(0.0)),
            Readout::new("Places too near", narrow.count()),
        ]
    }
}
