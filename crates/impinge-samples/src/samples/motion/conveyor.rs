//! Light barriers over a conveyor belt, which count passing pieces.

use impinge::narrow_phase::ProximityEvent;

use crate::prelude::*;

/// Half the length of the belt.
const BELT: f32 = 7.0;
/// The kinds of pieces. Pieces of kind n are members of group n.
const KINDS: [&str; 3] = ["box", "ball", "capsule"];

/// Pieces on a belt, and a sensor for each kind of piece.
#[derive(Debug, Default)]
pub(crate) struct Conveyor {
    /// The pieces in the order on the belt.
    goods: Vec<CollisionObjectHandle>,
    /// The sensors in the order of [`KINDS`].
    sensors: Vec<CollisionObjectHandle>,
    /// For each kind, the number of times that a piece has entered the sensor for this kind.
    entered: [usize; KINDS.len()],
    /// The number of pairs of a sensor and a piece in it, as of the last update.
    within: usize,
    /// The distance that the belt has moved.
    way: f32,
}

impl Conveyor {
    /// Returns the position of the piece with this index. A piece that passes the end of the belt
    /// moves to the start.
    fn position<const D: usize>(&self, index: usize) -> Isometry<D>
    where
        f32: Dimension<D>,
    {
        let way = (self.way + 1.3 * number(index)) / (2.0 * BELT);
        at([2.0 * BELT * (way - way.floor()) - BELT, 0.5, 0.0])
    }

    fn add_goods<const D: usize>(&mut self, world: &mut World<D>) -> Result<(), SampleError>
    where
        f32: Dimension<D>,
    {
        for index in 0..10 {
            let kind = index * 7 % KINDS.len();
            // The piece is a member of the group of its kind, and may interact with every group.
            let mut groups = CollisionGroups::new();
            groups.set_membership(&[kind]);
            let (position, query) = (self.position(index), ContactQuery::default());
            let shape = solid(KINDS[kind], 0.4);
            self.goods.push(world.add(position, shape, groups, query, KINDS[kind].to_owned())?);
        }
        Ok(())
    }

    /// Adds a sensor for each kind. Sensors report proximity without contact points.
    fn add_sensors<const D: usize>(&mut self, world: &mut World<D>) -> Result<(), SampleError>
    where
        f32: Dimension<D>,
    {
        for (kind, name) in KINDS.iter().enumerate() {
            let mut groups = CollisionGroups::new();
            groups.set_membership(&[KINDS.len()]);
            // The whitelist of the sensor excludes pieces of other kinds. Pieces exclude nothing.
            groups.set_whitelist(&[kind]);
            let gate = ShapeHandle::new(Cuboid::new(vector([0.1, 1.0, 1.0])));
            let (position, query) =
                (at([4.0 * number(kind) - 4.0, 1.0, 0.0]), ProximityQuery::default());
            let label = format!("sensor for a {name}");
            self.sensors.push(world.add(position, gate, groups, query, label)?);
        }
        Ok(())
    }

    /// Returns the index of the sensor of an event; `None` if no sensor is involved.
    fn sensor(&self, event: &ProximityEvent) -> Option<usize> {
        let objects = [event.collider1, event.collider2];
        self.sensors.iter().position(|sensor| objects.contains(sensor))
    }
}

impl<const D: usize> Sample<D> for Conveyor
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new().number("speed", "Speed of the belt", 2.0, [0.0, 10.0, 0.1])
    }

    fn build(&mut self, world: &mut World<D>, _: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        self.add_goods(world)?;
        self.add_sensors(world)
    }

    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError> {
        self.way += panel.value("speed") * TIME_STEP;
        for (index, piece) in self.goods.iter().enumerate() {
            world.set_position(*piece, self.position(index))?;
        }
        Ok(())
    }

    /// Counts the entries into sensors. Each entry has one event, in the update in which the pair
    /// begins to intersect.
    fn updated(&mut self, world: &mut World<D>, _: &Panel) -> Result<(), SampleError> {
        for event in world.proximity_events() {
            if let Some(sensor) = self.sensor(event)
                && event.new_status == Proximity::Intersecting
            {
                self.entered[sensor] += 1;
            }
        }
        let sensors = self.sensors.iter();
        self.within = sensors.map(|sensor| world.proximities_with(*sensor).count()).sum();
        Ok(())
    }

    fn readouts(&self, _: &World<D>, _: &Panel) -> Vec<Readout> {
        let [boxes, balls, capsules] = self.entered;
        vec![
            Readout::new("Boxes that entered", boxes),
            Readout::new("Balls that entered", balls),
            Readout::new("Capsules that entered", capsules),
            Readout::new("Within a sensor now", self.within),
        ]
    }
}
