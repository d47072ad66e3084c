//! The traits of `avian2d` that a collider implements.

use avian2d::collision::contact_types::PackedFeatureId;
use avian2d::prelude::{
    AabbContext, AnyCollider, ColliderAabb, ComputeMassProperties2d, ContactManifold,
    ContactManifoldContext, ContactPoint, MassProperties2d, NarrowPhaseConfig, Rotation,
    ScalableCollider,
};
use bevy_ecs::system::lifetimeless::SRes;
use bevy_impinge::Glam;
use bevy_math::{Isometry2d, Rot2, Vec2};
use impinge::dim2::math::Isometry;
use impinge::dim2::query::ManifoldView;

use super::{Collider, PairContacts};
use crate::manifolds::{Meeting, Touch};

pub(super) fn isometry(position: Vec2, rotation: Rotation) -> Isometry<f32> {
    <f32 as Glam<2>>::isometry_of(&Isometry2d::new(
        position,
        Rot2 { cos: rotation.cos, sin: rotation.sin },
    ))
}

/// Returns two poses in a frame with the axes of the global frame and its origin at the first
/// position.
fn beside(positions: [Vec2; 2], rotations: [Rotation; 2]) -> [Isometry<f32>; 2] {
    let [from, to] = positions;
    [isometry(Vec2::ZERO, rotations[0]), isometry(to - from, rotations[1])]
}

impl Collider {
    /// Returns the box around the shape at a pose.
    #[must_use]
    pub fn aabb(&self, position: Vec2, rotation: impl Into<Rotation>) -> ColliderAabb {
        let [min, max] = self.corners(&isometry(position, rotation.into()));
        ColliderAabb::from_min_max(min, max)
    }

    /// Computes the contacts with another collider, without the state of earlier steps. The points
    /// are relative to the positions of the two colliders.
    #[must_use]
    pub fn contact_manifolds(
        &self,
        other: &Self,
        [position1, position2]: [Vec2; 2],
        [rotation1, rotation2]: [Rotation; 2],
        prediction_distance: f32,
    ) -> Vec<ContactManifold> {
        let poses = beside([position1, position2], [rotation1, rotation2]);
        let (meeting, mut manifolds) = (Meeting::new([self, other], poses), Vec::new());
        let mut rewriting = Rewriting::new(position1, &mut manifolds);
        meeting.contacts(prediction_distance, |found| rewriting.add(&meeting, found));
        rewriting.end();
        manifolds
    }
}

impl AnyCollider for Collider {
    type Context = (SRes<PairContacts>, SRes<NarrowPhaseConfig>);

    fn aabb_with_context(
        &self,
        position: Vec2,
        rotation: impl Into<Rotation>,
        _: AabbContext<'_, '_, '_, Self::Context>,
    ) -> ColliderAabb {
        self.aabb(position, rotation)
    }

    fn contact_manifolds_with_context(
        &self,
        other: &Self,
        position1: Vec2,
        rotation1: impl Into<Rotation>,
        position2: Vec2,
        rotation2: impl Into<Rotation>,
        prediction_distance: f32,
        manifolds: &mut Vec<ContactManifold>,
        context: ContactManifoldContext<'_, '_, '_, Self::Context>,
    ) {
        let poses = beside([position1, position2], [rotation1.into(), rotation2.into()]);
        let (meeting, margin) = (Meeting::new([self, other], poses), prediction_distance);
        if !meeting.has_parts() {
            let mut rewriting = Rewriting::new(position1, manifolds);
            meeting.contacts(margin, |found| rewriting.add(&meeting, found));
            return rewriting.end();
        }
        let old = warmth(manifolds);
        let mut rewriting = Rewriting::new(position1, manifolds);
        context.0.with((context.entity1, context.entity2), |state| {
            meeting.update(state, margin, |found| rewriting.add(&meeting, found));
        });
        rewriting.end();
        if context.1.match_contacts && manifolds.len() > MATCHED {
            warm(manifolds, &old);
        }
    }
}

/// The largest number of manifolds of a pair whose points Avian itself matches.
const MATCHED: usize = 4;

/// The feature ids of a point, and its normal and tangential impulse for warm starting.
type Warmth = ([PackedFeatureId; 2], f32, f32);

/// Returns the ids and impulses of the points of a pair. Avian does not match the points of a pair
/// that has more than [`MATCHED`] manifolds after the update.
fn warmth(manifolds: &[ContactManifold]) -> Vec<Warmth> {
    let points = manifolds.iter().flat_map(|manifold| &manifold.points);
    let of = |point: &ContactPoint| {
        let name = [point.feature_id1, point.feature_id2];
        (name, point.warm_start_normal_impulse, point.warm_start_tangent_impulse)
    };
    points.map(of).collect()
}

/// Copies the impulses of old points to new points with equal feature ids.
fn warm(manifolds: &mut [ContactManifold], old: &[Warmth]) {
    for point in manifolds.iter_mut().flat_map(|manifold| &mut manifold.points) {
        let name = [point.feature_id1, point.feature_id2];
        if let Some((_, normal, tangent)) = old.iter().find(|old| old.0 == name) {
            (point.warm_start_normal_impulse, point.warm_start_tangent_impulse) =
                (*normal, *tangent);
        }
    }
}

/// Replaces the manifolds of a pair by those of this step, and reuses the memory of the old
/// manifolds.
struct Rewriting<'m> {
    position1: Vec2,
    manifolds: &'m mut Vec<ContactManifold>,
    count: usize,
}

impl<'m> Rewriting<'m> {
    fn new(position1: Vec2, manifolds: &'m mut Vec<ContactManifold>) -> Self {
        Self { position1, manifolds, count: 0 }
    }

    fn add(&mut self, meeting: &Meeting<'_, 2>, found: ManifoldView<'_, f32>) {
        if self.count == self.manifolds.len() {
            self.manifolds.push(ContactManifold::new([], Vec2::ZERO));
        }
        let manifold = &mut self.manifolds[self.count];
        self.count += 1;
        manifold.normal = f32::vec(&found.normal());
        manifold.points.clear();
        let touches = meeting.touches(found);
        manifold.points.extend(touches.map(|touch| point(&touch, self.position1)));
    }

    /// Removes the old manifolds that were not replaced.
    fn end(self) {
        self.manifolds.truncate(self.count);
    }
}

fn point(touch: &Touch<2>, position1: Vec2) -> ContactPoint {
    let ([anchor1, anchor2], [name1, name2]) = (touch.anchors, touch.name);
    let point = ContactPoint::new(anchor1, anchor2, position1 + anchor1, touch.penetration);
    point.with_feature_ids(name1.into(), name2.into())
}

impl ScalableCollider for Collider {
    fn scale(&self) -> Vec2 {
        self.scale()
    }

    fn set_scale(&mut self, scale: Vec2, detail: u32) {
        self.rescale(scale, detail);
    }
}

impl ComputeMassProperties2d for Collider {
    fn mass(&self, density: f32) -> f32 {
        self.weighed(density).mass()
    }

    fn unit_angular_inertia(&self) -> f32 {
        self.weighed_as_one().inertia()
    }

    fn center_of_mass(&self) -> Vec2 {
        f32::vec(&self.weighed(1.0).center_of_mass().coords)
    }

    fn mass_properties(&self, density: f32) -> MassProperties2d {
        let found = self.weighed(density);
        MassProperties2d {
            mass: found.mass(),
            angular_inertia: found.inertia(),
            center_of_mass: f32::vec(&found.center_of_mass().coords),
        }
    }
}
