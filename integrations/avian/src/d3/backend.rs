//! The traits of `avian3d` that a collider implements.

use avian3d::prelude::{
    AabbContext, AnyCollider, ColliderAabb, ComputeMassProperties3d, ContactManifold,
    ContactManifoldContext, ContactPoint, MassProperties3d, Rotation, ScalableCollider,
};
use bevy_ecs::system::lifetimeless::SRes;
use bevy_impinge::Glam;
use bevy_math::{Isometry3d, Quat, Vec3};
use impinge::dim3::math::Isometry;
use impinge::dim3::query::MassProperties;

use super::{Collider, PairContacts};
use crate::manifolds::{Meeting, Touch};
use crate::pairs::PairState;

pub(super) fn isometry(position: Vec3, rotation: Rotation) -> Isometry<f32> {
    <f32 as Glam<3>>::isometry_of(&Isometry3d::new(position, rotation.0))
}

/// Two poses in a frame with the world's axes whose origin is the first position.
fn beside(positions: [Vec3; 2], rotations: [Rotation; 2]) -> [Isometry<f32>; 2] {
    let [from, to] = positions;
    [isometry(Vec3::ZERO, rotations[0]), isometry(to - from, rotations[1])]
}

impl Collider {
    /// The box around the shape at a pose.
    #[must_use]
    pub fn aabb(&self, position: Vec3, rotation: impl Into<Rotation>) -> ColliderAabb {
        let [min, max] = self.corners(&isometry(position, rotation.into()));
        ColliderAabb::from_min_max(min, max)
    }

    /// The contacts with another collider, without memory of earlier ones: the points are relative to the
    /// positions of the two.
    #[must_use]
    pub fn contact_manifolds(
        &self,
        other: &Self,
        [position1, position2]: [Vec3; 2],
        [rotation1, rotation2]: [Rotation; 2],
        prediction_distance: f32,
    ) -> Vec<ContactManifold> {
        let poses = beside([position1, position2], [rotation1, rotation2]);
        let meeting = Meeting { colliders: [self, other], poses, prediction: prediction_distance };
        let (mut state, mut manifolds) = (PairState::default(), Vec::new());
        rewrite(&meeting, &mut state, position1, &mut manifolds);
        manifolds
    }
}

impl AnyCollider for Collider {
    type Context = SRes<PairContacts>;

    fn aabb_with_context(
        &self,
        position: Vec3,
        rotation: impl Into<Rotation>,
        _: AabbContext<'_, '_, '_, Self::Context>,
    ) -> ColliderAabb {
        self.aabb(position, rotation)
    }

    fn contact_manifolds_with_context(
        &self,
        other: &Self,
        position1: Vec3,
        rotation1: impl Into<Rotation>,
        position2: Vec3,
        rotation2: impl Into<Rotation>,
        prediction_distance: f32,
        manifolds: &mut Vec<ContactManifold>,
        context: ContactManifoldContext<'_, '_, '_, Self::Context>,
    ) {
        let poses = beside([position1, position2], [rotation1.into(), rotation2.into()]);
        let meeting = Meeting { colliders: [self, other], poses, prediction: prediction_distance };
        let pair = (context.entity1, context.entity2);
        context.with(pair, |state| rewrite(&meeting, state, position1, manifolds));
    }
}

/// Brings a pair up to date, and writes its contacts over those of the last step.
fn rewrite(
    meeting: &Meeting<'_, 3>,
    state: &mut PairState<3>,
    position1: Vec3,
    manifolds: &mut Vec<ContactManifold>,
) {
    meeting.update(state, |found| {
        manifolds.resize_with(found.len(), || ContactManifold::new([], Vec3::ZERO));
        for (manifold, found) in manifolds.iter_mut().zip(found) {
            manifold.normal = Meeting::normal(found).unwrap_or_default();
            manifold.points.clear();
            manifold.points.extend(meeting.touches(found).map(|touch| point(&touch, position1)));
        }
    });
}

fn point(touch: &Touch<3>, position1: Vec3) -> ContactPoint {
    let ([anchor1, anchor2], [name1, name2]) = (touch.anchors, touch.name);
    let point = ContactPoint::new(anchor1, anchor2, position1 + anchor1, touch.penetration);
    point.with_feature_ids(name1.into(), name2.into())
}

impl ScalableCollider for Collider {
    fn scale(&self) -> Vec3 {
        self.scale()
    }

    fn set_scale(&mut self, scale: Vec3, detail: u32) {
        self.rescale(scale, detail);
    }
}

fn principal_frame(found: &MassProperties<f32>) -> Quat {
    let q = found.principal_frame().coords;
    Quat::from_xyzw(q.x, q.y, q.z, q.w)
}

impl ComputeMassProperties3d for Collider {
    fn mass(&self, density: f32) -> f32 {
        self.weighed(density).mass()
    }

    fn unit_principal_angular_inertia(&self) -> Vec3 {
        f32::vec(self.weighed_as_one().principal_moments())
    }

    fn local_inertial_frame(&self) -> Quat {
        principal_frame(&self.weighed(1.0))
    }

    fn center_of_mass(&self) -> Vec3 {
        f32::vec(&self.weighed(1.0).center_of_mass().coords)
    }

    fn mass_properties(&self, density: f32) -> MassProperties3d {
        let found = self.weighed(density);
        MassProperties3d {
            mass: found.mass(),
            principal_angular_inertia: f32::vec(found.principal_moments()),
            local_inertial_frame: principal_frame(&found),
            center_of_mass: f32::vec(&found.center_of_mass().coords),
        }
    }
}
