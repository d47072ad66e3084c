//! Shapes of user types: a convex shape with a support map, and a composite.

use impinge::bounding_volume::Aabb;
use impinge::math::Real;
use impinge::partitioning::BoxTree;
use impinge::shape::{CompositeShape, Geometry, Part, PartSearch, PartSolid, Shape, SupportMap};
use impinge_record::Registry;

use crate::prelude::*;

/// A lens: the intersection of two balls of equal radius around `(0, −offset)` and `(0, offset)`.
#[derive(Debug)]
struct Lens {
    /// The radius of both balls.
    radius: f32,
    /// The distance of the centres of the balls from the centre of the lens.
    offset: f32,
}

impl Lens {
    /// Returns the radius of the rim, where the two balls intersect.
    fn rim(&self) -> f32 {
        (self.radius * self.radius - self.offset * self.offset).sqrt()
    }
}

impl<const D: usize> SupportMap<f32, D> for Lens
where
    f32: Space<D>,
{
    /// Returns the support point for a direction, on one of the two curved sides or on the rim; the
    /// centre of the lens for a direction of length zero.
    fn core_support(&self, direction: &Vector<f32, D>) -> Point<f32, D> {
        let Some((toward, _)) = unit(direction) else { return Point::origin() };
        // The upper side belongs to the lower ball, and the lower side to the upper ball.
        let center: Vector<f32, D> = vector([0.0, -self.offset.copysign(toward[1]), 0.0]);
        if toward[1].abs() * self.radius > self.offset {
            return Point::from(center + toward * self.radius);
        }
        let mut outward = toward;
        outward[1] = 0.0;
        Point::from(unit_or(&outward, Vector::<f32, D>::zeros()) * self.rim())
    }
}

impl<const D: usize> Shape<f32, D> for Lens
where
    f32: Space<D>,
{
    /// Returns the support map as the geometry, through which queries use the shape.
    fn geometry(&self) -> Geometry<'_, f32, D> {
        Geometry::support_map(self)
    }

    /// Returns the bounding box in the local frame.
    fn local_aabb(&self) -> Aabb<f32, D> {
        let (rim, half) = (self.rim(), self.radius - self.offset);
        Aabb::from_half_extents(Point::origin(), vector([rim, half, rim]))
    }
}

/// Balls of equal radius.
#[derive(Debug)]
struct Beads<const D: usize> {
    /// The shape of each bead.
    bead: Ball<f32>,
    /// The centres of the beads.
    centers: Vec<Point<f32, D>>,
    /// A tree of the bounding boxes of the beads.
    tree: BoxTree<f32, D>,
}

impl<const D: usize> Beads<D>
where
    f32: Space<D>,
{
    fn new(radius: f32, centers: Vec<Point<f32, D>>) -> Self {
        let half = Vector::<f32, D>::repeat(radius);
        let boxes = centers.iter().map(|center| Aabb::from_half_extents(*center, half));
        let tree = BoxTree::from_boxes(&boxes.collect::<Vec<_>>());
        Self { bead: Ball::new(radius), centers, tree }
    }
}

impl<const D: usize> CompositeShape<f32, D> for Beads<D>
where
    f32: Space<D>,
{
    fn num_parts(&self) -> u32 {
        u32::try_from(self.centers.len()).expect("a few beads")
    }

    /// Returns a part: its solid, and its pose in the frame of the composite.
    fn part(&self, part: u32) -> Part<'_, f32, D> {
        let pose = Pose::from_translation(self.centers[part as usize].coords);
        Part { pose, solid: PartSolid::Shape(&self.bead) }
    }

    /// Returns the tree, by which queries find the parts. A composite may also implement a search
    /// of its own.
    fn search(&self) -> &dyn PartSearch<f32, D> {
        &self.tree
    }
}

impl<const D: usize> Shape<f32, D> for Beads<D>
where
    f32: Space<D>,
{
    fn geometry(&self) -> Geometry<'_, f32, D> {
        Geometry::composite(self)
    }

    fn local_aabb(&self) -> Aabb<f32, D> {
        self.tree.bounds().copied().unwrap_or_else(Aabb::unbounded)
    }
}

/// A lens that rolls over a ring of beads.
#[derive(Debug)]
pub(crate) struct OwnShapes<const D: usize>
where
    f32: Space<D>,
{
    /// The handles are kept, since the registry contains names for these handles and their clones.
    lens: ShapeHandle<f32, D>,
    beads: ShapeHandle<f32, D>,
    objects: Vec<CollisionObjectHandle>,
    phase: f32,
}

impl<const D: usize> Default for OwnShapes<D>
where
    f32: Space<D>,
{
    fn default() -> Self {
        let center = |n: u8| {
            let angle = TAU * f32::from(n) / 40.0;
            let (sine, cosine) = Real::sine_cosine(angle);
            point([3.0 * cosine, 0.3 * sine, sine])
        };
        Self {
            lens: ShapeHandle::new(Lens { radius: 1.25, offset: 0.75 }),
            beads: ShapeHandle::new(Beads::new(0.2, (0..40).map(center).collect())),
            objects: Vec::new(),
            phase: 0.0,
        }
    }
}

impl<const D: usize> Sample<D> for OwnShapes<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new().number("height", "Height of the lens", 0.9, [-2.0, 3.0, 0.05]).number(
            "speed",
            "Speed",
            1.0,
            [0.0, 4.0, 0.1],
        )
    }

    /// Returns the registry with names for both shapes, since a recording cannot contain shapes
    /// that are code.
    fn registry(&self) -> Registry<f32, D, String> {
        Registry::new()
            .with_shape("lens", self.lens.clone())
            .with_shape("beads", self.beads.clone())
    }

    fn build(&mut self, world: &mut World<D>, panel: &Panel) -> Result<(), SampleError> {
        let (groups, query) = (CollisionGroups::new(), ContactQuery::new(0.02));
        let above = at([0.0, panel.value("height"), 0.0]);
        self.objects = vec![
            world.add(at([0.0; 3]), self.beads.clone(), groups, query, "beads".to_owned())?,
            world.add(above, self.lens.clone(), groups, query, "lens".to_owned())?,
        ];
        self.phase = 0.0;
        Ok(())
    }

    /// Rolls the lens back and forth over the beads.
    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError> {
        self.phase += panel.value("speed") / 480.0;
        let x = 6.0 * to_and_fro(self.phase + 0.25) - 3.0;
        let &[_, lens] = self.objects.as_slice() else { return Ok(()) };
        let position = turned([x, panel.value("height"), 0.0], -2.0 * x);
        Ok(world.set_position(lens, position)?)
    }

    /// Returns the index of the bead for each contact. A contact of a composite contains the index
    /// of the part that it belongs to.
    fn readouts(&self, world: &World<D>, _: &Panel) -> Vec<Readout> {
        let &[beads, _] = self.objects.as_slice() else { return Vec::new() };
        let touched: Vec<_> =
            world.contacts_with(beads).map(|(_, point)| point.part1.to_string()).collect();
        vec![Readout::new("Beads that touch", touched.join(", "))]
    }
}
