//! A robot arm that collides with itself and with obstacles, or avoids these collisions.

use impinge::math::Real;
use impinge::world::{BroadPhasePairFilter, CollisionObject};
use impinge_record::Registry;

use crate::prelude::*;

/// The number of links. Each link is a capsule whose axis has length 1. The axis begins at a joint
/// and ends at the next joint; the axis of the last link ends freely.
const LINKS: usize = 5;
const RADIUS: f32 = 0.15;

/// The arm, and its current collisions.
#[derive(Debug, Default)]
pub(crate) struct Arm<const D: usize> {
    /// The links in the order from the base.
    links: Vec<CollisionObjectHandle>,
    /// The parameter of the motion, on which the angles of all joints depend.
    phase: f32,
    /// `true` while the phase decreases.
    is_back: bool,
    /// The labels of both objects of each pair that has contacts and contains a link.
    hits: Vec<[String; 2]>,
}

/// Returns the index of a link from its label; `None` for an obstacle.
fn link(label: &str) -> Option<usize> {
    label.strip_prefix("link ")?.parse().ok()
}

/// A pair filter that rejects links with a common joint, since they always touch there.
#[derive(Clone, Copy, Debug)]
struct Joints;

impl<const D: usize> BroadPhasePairFilter<f32, D, String> for Joints
where
    f32: Space<D>,
{
    fn is_pair_valid(
        &self,
        one: &CollisionObject<f32, D, String>,
        two: &CollisionObject<f32, D, String>,
    ) -> bool {
        match [link(one.data()), link(two.data())] {
            [Some(one), Some(two)] => one.abs_diff(two) > 1,
            _ => true,
        }
    }
}

/// Returns the poses of the links at a phase. Each joint oscillates with its own frequency.
fn poses<const D: usize>(phase: f32) -> [Pose<f32, D>; LINKS] {
    // Each joint rotates in the frame of the previous joint.
    let mut joint = Pose::<f32, D>::identity();
    std::array::from_fn(|n| {
        let angle = 1.4 * Real::sine_cosine(phase * (1.0 + 0.37 * number(n)) + number(n)).0;
        let turned = Pose { rotation: turn([0, 1], angle), translation: vector([0.0; 3]) };
        joint = joint.compose(&turned);
        let middle = joint.compose(&Pose::from_translation(vector([0.0, 0.5, 0.0])));
        joint = joint.compose(&Pose::from_translation(vector([0.0, 1.0, 0.0])));
        middle
    })
}

impl<const D: usize> Arm<D>
where
    f32: Dimension<D>,
{
    /// Returns `true` if the arm would collide at a phase, with an obstacle or with itself.
    /// Obstacles are found by a query of the world, without moving the arm.
    fn would_hit(&self, world: &World<D>, phase: f32) -> bool {
        let (capsule, poses) = (Capsule::new(0.5, RADIUS), poses::<D>(phase));
        let is_obstacle = |object: &CollisionObject<f32, D, String>| link(object.data()).is_none();
        let obstacles = QueryFilter::new().predicate(&is_obstacle);
        let hits_obstacle =
            poses.iter().any(|pose| world.overlaps_any(&f32::isometry(pose), &capsule, &obstacles));
        // Links with a common joint are excluded, as by the pair filter of the world.
        let touch = |a: usize, b: usize| {
            distance(&isometry(&poses[a]), &capsule, &isometry(&poses[b]), &capsule) <= 0.0
        };
        hits_obstacle || (0..LINKS).any(|a| (a + 2..LINKS).any(|b| touch(a, b)))
    }
}

impl<const D: usize> Sample<D> for Arm<D>
where
    f32: Dimension<D>,
{
    fn panel(&self) -> Panel {
        Panel::new()
            .choice("when", "Where it would hit", "it goes on", &["it goes on", "it turns back"])
            .number("speed", "Speed", 1.0, [0.0, 5.0, 0.1])
    }

    fn registry(&self) -> Registry<f32, D, String> {
        Registry::new().with_filter("joints", Joints)
    }

    fn build(&mut self, world: &mut World<D>, _: &Panel) -> Result<(), SampleError> {
        *self = Self::default();
        // The registry contains the filter under this name, so the recording can be replayed.
        world.register_broad_phase_pair_filter("joints")?;
        let (groups, query) = (CollisionGroups::new(), ContactQuery::default());
        for (n, place) in
            [[2.2, 1.5, 0.0], [-2.4, 2.2, 0.0], [0.4, 4.6, 0.0]].into_iter().enumerate()
        {
            let shape = solid(f32::SOLIDS[n], 0.5);
            world.add(at(place), shape, groups, query, format!("obstacle {n}"))?;
        }
        let capsule = ShapeHandle::new(Capsule::new(0.5, RADIUS));
        for (n, pose) in poses::<D>(0.0).iter().enumerate() {
            let (position, label) = (f32::isometry(pose), format!("link {n}"));
            self.links.push(world.add(position, capsule.clone(), groups, query, label)?);
        }
        Ok(())
    }

    /// Moves the arm to its next pose. With "it turns back", the arm reverses its motion instead if
    /// it would collide there.
    fn advance(&mut self, world: &mut World<D>, panel: &mut Panel) -> Result<(), SampleError> {
        let pace = panel.value("speed") * TIME_STEP;
        let next = self.phase + if self.is_back { -pace } else { pace };
        if panel.chosen("when") == "it turns back" && self.would_hit(world, next) {
            self.is_back = !self.is_back;
            return Ok(());
        }
        self.phase = next;
        let moved = self.links.iter().zip(poses(next));
        let moved: Vec<_> = moved.map(|(link, pose)| (*link, f32::isometry(&pose))).collect();
        Ok(world.set_positions(&moved)?)
    }

    /// Collects the pairs that have contacts, except pairs of two obstacles. A pair may have
    /// several manifolds, which are consecutive, but is listed once.
    fn updated(&mut self, world: &mut World<D>, _: &Panel) -> Result<(), SampleError> {
        let hits = world.contact_views().map(|(one, two, _)| [one, two].map(|o| o.data().clone()));
        self.hits =
            hits.filter(|labels| labels.iter().any(|label| link(label).is_some())).collect();
        self.hits.dedup();
        Ok(())
    }

    /// Draws the axis of each link: red if the link collides, otherwise green.
    fn draw(&self, world: &World<D>, _: &Panel, canvas: &mut Canvas<'_, D>) {
        for handle in &self.links {
            let found = world.collision_object(*handle);
            let is_hit =
                found.is_some_and(|link| self.hits.iter().flatten().any(|hit| hit == link.data()));
            let pose = pose_of(world, *handle);
            let ends = [-0.5, 0.5].map(|y| pose.point(&point([0.0, y, 0.0])));
            canvas.line(ends, if is_hit { RED } else { GREEN });
        }
    }

    fn readouts(&self, _: &World<D>, _: &Panel) -> Vec<Readout> {
        let hits: Vec<_> = self.hits.iter().map(|[one, two]| format!("{one} and {two}")).collect();
        vec![Readout::new(
            "Collisions",
            if hits.is_empty() { "none".to_owned() } else { hits.join(", ") },
        )]
    }
}
