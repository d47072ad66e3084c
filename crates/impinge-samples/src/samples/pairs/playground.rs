//! Two shapes of any kind, and the results of the library's queries on two shapes.

use impinge::query::{closest_points, proximity};

use crate::prelude::*;

/// The limit of three queries: the prediction of the contact, the largest distance of the closest
/// points, and the maximum time of the cast.
const MARGIN: f32 = 10.0;

/// Two shapes. The second shape moves past the first until the user drags it.
#[derive(Debug, Default)]
pub(crate) struct Playground {
    /// The objects of the first and the second shape.
    objects: Vec<CollisionObjectHandle>,
    /// The position of the second shape on its path. A cycle back and forth has length 1.
    phase: f32,
    /// `true` after the user has dragged an object.
    is_held: bool,
}

/// A shape and its pose.
struct Placed<const D: usize> {
    shape: ShapeHandle<f32, D>,
    pose: Pose<f32, D>,
}

impl Playground {
    /// Returns both shapes with their poses; `None` if an object was removed.
    fn placed<const D: usize>(&self, world: &World<D>) -> Option<[Placed<D>; 2]>
    where
        f32: Dimension<D>,
    {
        let placed = |object: CollisionObjectHandle| {
            let shape = world.collision_object(object)?.shape().clone();
            Some(Placed { shape, pose: pose_of(world, object) })
        };
        let &[first, second] = self.objects.as_slice() else { return None };
        Some([placed(first)?, placed(second)?])
    }

    /// Returns the position of the second shape on its path: a horizontal line above the centre of
    /// the first shape, so low that the shapes touch with the initial controls.
    fn path<const D: usize>(&self, panel: &Panel) -> Isometry<D>
    where
        f32: Dimension<D>,
    {
        let x = 6.0 * to_and_fro(self.phase) - 3.0;
        turned([x, 1.2, 0.0], panel.value("angle"))
    }
}

/// Returns the velocity of the second shape in the cast, a unit vector.
fn velocity<const D: usize>(panel: &Panel) -> Vector<f32, D>
where
    f32: Dimension<D>,
{
    turn::<D>([0, 1], panel.value("direction")) * vector::<D>([1.0, 0.0, 0.0])
}

/// Returns the earliest impact of the second shape with the first; `None` if there is none up to
/// the time [`MARGIN`].
fn time_of_impact<const D: usize>(
    [first, second]: &[Placed<D>; 2],
    panel: &Panel,
) -> Option<Impact<f32, D>>
where
    f32: Dimension<D>,
{
    let still = Moving::still(&isometry(&first.pose), &*first.shape);
    let moving = Moving::new(&isometry(&second.pose), &velocity(panel), &*second.shape);
    impact(&still, &moving, &ImpactOptions::new().with_max_time(MARGIN))
}

/// Returns the contact of both shapes, whose depth is negative if the shapes are apart; `None` if
/// their distance exceeds [`MARGIN`].
fn nearest_contact<const D: usize>([first, second]: &[Placed<D>; 2]) -> Option<Contact<f32, D>>
where
    f32: Dimension<D>,
{
    let poses = [&first.pose, &second.pose].map(isometry);
    contact(&poses[0], &*first.shape, &poses[1], &*second.shape, MARGIN)
}

impl<const D: usize> Sample<D> for Playground
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        let angle = [-3.2, 3.2, 0.01];
        Panel::new()
            .choice("first", "First shape", "box", f32::SOLIDS)
            .number("size", "Its size", 1.0, [0.25, 2.0, 0.01])
            .choice("second", "Second shape", "capsule", f32::SOLIDS)
            .number("size2", "Its size", 0.8, [0.25, 2.0, 0.01])
            .number("angle", "Angle of the second", 0.4, angle)
            .number("direction", "Direction of the cast", -1.6, angle)
            .number("prediction", "Contacts up to", 0.1, [0.0, 1.0, 0.01])
    }

    /// Adds both shapes to the world, which computes their manifolds. The queries need no world.
    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        let (groups, query) =
            (CollisionGroups::new(), ContactQuery::new(panel.value("prediction")));
        let first = solid::<D>(panel.chosen("first"), panel.value("size"));
        let second = solid::<D>(panel.chosen("second"), panel.value("size2"));
        self.objects = vec![
            world.add(at([0.0; 3]), first, groups, query, "first".to_owned())?,
            world.add(self.path(panel), second, groups, query, "second".to_owned())?,
        ];
        Ok(())
    }

    /// Replaces the shapes and query types of the objects, and the angle of the second. Their
    /// handles stay valid.
    fn changed(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let &[first, second] = self.objects.as_slice() else { return Ok(()) };
        // Both shapes are set for a change of any control. An equal shape has equal contacts.
        world.set_shape(first, solid(panel.chosen("first"), panel.value("size")))?;
        world.set_shape(second, solid(panel.chosen("second"), panel.value("size2")))?;
        let pose = Pose {
            rotation: turn([0, 1], panel.value("angle")),
            translation: pose_of(world, second).translation,
        };
        world.set_position(second, f32::isometry(&pose))?;
        for object in [first, second] {
            world.set_query_type(object, ContactQuery::new(panel.value("prediction")))?;
        }
        Ok(())
    }

    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError> {
        let &[_, second] = self.objects.as_slice() else { return Ok(()) };
        if !self.is_held {
            self.phase += 1.0 / 600.0;
            world.set_position(second, self.path(panel))?;
        }
        Ok(())
    }

    /// Moves the dragged object. From then on, the second shape no longer moves by itself.
    fn dragged(
        &mut self,
        world: &mut World<D>,
        object: CollisionObjectHandle,
        to: &Isometry<D>,
    ) -> Result<(), SampleError> {
        world.set_position(object, *to)?;
        self.is_held = true;
        Ok(())
    }

    /// Draws the closest points, the contact, and the path of the cast with its impact.
    fn draw(&self, world: &World<D>, panel: &Panel, canvas: &mut Canvas<'_, D>) {
        let Some(pair) = self.placed(world) else { return };
        let [first, second] = &pair;
        let poses = [&first.pose, &second.pose].map(isometry);
        let nearest = closest_points(&poses[0], &*first.shape, &poses[1], &*second.shape, MARGIN);
        canvas.drawing.closest_points(&nearest, canvas.renderer);
        canvas.drawing.contacts(nearest_contact(&pair), canvas.renderer);
        // The drawing shows the shape at the start, at the impact and at the end of the path.
        let sweep = SweptShape {
            shape: &second.shape,
            position: f32::isometry(&second.pose),
            velocity: velocity(panel),
            max_time: 4.0,
        };
        canvas.drawing.cast(&sweep, time_of_impact(&pair, panel).as_ref(), canvas.renderer);
    }

    /// Returns the results of the queries on the two shapes, and the number of contact points in
    /// the world.
    fn readouts(&self, world: &World<D>, panel: &Panel) -> Vec<Readout> {
        let Some(pair) = self.placed(world) else { return Vec::new() };
        let [first, second] = &pair;
        let poses = [&first.pose, &second.pose].map(isometry);
        let (shape1, shape2) = (&*first.shape, &*second.shape);
        let margin = panel.value("prediction");
        let mut readouts = vec![
            Readout::number("Distance", distance(&poses[0], shape1, &poses[1], shape2)),
            Readout::new(
                "Proximity",
                format!("{:?}", proximity(&poses[0], shape1, &poses[1], shape2, margin)),
            ),
        ];
        if let Some(contact) = nearest_contact(&pair) {
            readouts.push(Readout::number("Depth", contact.depth));
            readouts.push(Readout::new("Normal", format!("{:.3?}", contact.normal.as_slice())));
            let points = [contact.world1, contact.world2].map(|point| point.coords);
            readouts.push(Readout::new("Point 1", format!("{:.3?}", points[0].as_slice())));
            readouts.push(Readout::new("Point 2", format!("{:.3?}", points[1].as_slice())));
        }
        // A manifold of the world may have several points, for instance for two parallel sides. The
        // query above returns a single contact.
        let contacts = world.contact_views().map(|(_, _, manifold)| manifold.len()).sum::<usize>();
        readouts.push(Readout::new("Contact points", contacts));
        let time = time_of_impact(&pair, panel).map(|hit| hit.toi);
        readouts.push(Readout::optional("Time of impact", time));
        readouts
    }
}
