//! Common imports of the samples: names of the library, and functions of this crate.

pub(crate) use impinge::debug_render::{Color, SweptShape};
pub(crate) use impinge::math::{Point, Pose, Space, Vector, max, min, unit, unit_or};
pub(crate) use impinge::narrow_phase::{CollisionObjectHandle, ContactQuery, ProximityQuery};
pub(crate) use impinge::query::{
    ClosestPoints, Contact, Impact, ImpactOptions, Moving, Proximity, contact, distance, impact,
};
pub(crate) use impinge::shape::{Ball, Capsule, Cuboid, Plane, ShapeHandle};
pub(crate) use impinge::world::{CollisionGroups, QueryFilter};

pub(crate) use crate::dimension::{Dimension, SurfaceKind, solid};
pub(crate) use crate::place::{
    TAU, at, isometry, number, point, pose_of, scattered, to_and_fro, turn, turned, up, vector,
};
pub(crate) use crate::{Canvas, Isometry, Panel, Readout, Sample, SampleError, TIME_STEP, World};

/// The colour of directions, and of items without collisions.
pub(crate) const GREEN: Color = Color::rgb(90, 200, 120);
/// The colour of hits.
pub(crate) const RED: Color = Color::rgb(240, 80, 70);
/// The colour of measurements.
pub(crate) const BLUE: Color = Color::rgb(80, 160, 250);
