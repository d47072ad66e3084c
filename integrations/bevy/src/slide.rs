//! Character motion that stops at obstacles and continues along them.

use impinge::math::Vector;

use crate::glam::{Glam, Pose, Vec_};
use crate::{Collider, Collisions, ShapeHit, SpatialFilter, WorldKey};

/// The settings of [`Collisions::move_and_slide`].
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SlideSettings {
    /// The distance kept from all obstacles: about a hundredth of the size of the character. 0.01 by default.
    pub skin: f32,
    /// The largest number of obstacles that the motion may hit. With 1 the motion is straight and
    /// ends at the first obstacle; 6 by default.
    pub max_hits: usize,
}

impl Default for SlideSettings {
    fn default() -> Self {
        Self { skin: 0.01, max_hits: 6 }
    }
}

impl SlideSettings {
    /// Returns the default settings with another skin.
    #[must_use]
    pub fn with_skin(skin: f32) -> Self {
        Self { skin, ..Self::default() }
    }
}

/// The result of a character motion.
#[derive(Clone, Debug, PartialEq)]
pub struct Slide<const D: usize>
where
    f32: Glam<D>,
{
    /// The possible motion: add it to the translation.
    pub motion: Vec_<D>,
    /// The unused part of the motion, without its component into the obstacles hit last; zero if
    /// all was used. The velocity for the next step is the sum of `motion` and `rest`, divided by
    /// the time step.
    pub rest: Vec_<D>,
    /// The hits in order, without those at which the motion is almost along the obstacle. The
    /// `fraction` of a hit is relative to the motion that remained before it.
    pub hits: Vec<ShapeHit<D>>,
}

/// A motion counts as along a wall if its component into the wall is at most this fraction of its
/// length. The normal of a wall at the distance of the skin has a rounding error of about this
/// size.
const GRAZE: f32 = 1e-3;
/// A motion along a wall gets a component away from the wall of this fraction of its length.
/// Otherwise rounding could lead it into the wall, and the next cast would end at its start.
const LIFT: f32 = 1e-5;
/// The number of casts in addition to `max_hits`: hits at which the motion is almost along the wall
/// do not count as hits.
const MAX_GRAZES: usize = 4;

impl<const D: usize, W: WorldKey> Collisions<D, W>
where
    f32: Glam<D>,
{
    /// Moves a shape by `motion`, at most until its distance from an obstacle is `skin`. The rest
    /// of the motion continues along the obstacle, in 3D between two obstacles along their edge.
    /// Sensors are no obstacles. A motion along a wall gets a component away from it of 1e-5 of its
    /// length, which exceeds rounding errors. The shape does not rotate. It is not pushed out of
    /// obstacles that it overlaps at the start, but moves no deeper. A shape with an error does not
    /// move.
    ///
    /// Exclude the character itself by the filter. The entities are at their poses of the last step.
    ///
    /// ```
    /// use bevy_app::prelude::*;
    /// use bevy_impinge::d2::prelude::*;
    /// use bevy_math::{Isometry2d, Vec2};
    ///
    /// let mut app = App::new();
    /// app.add_plugins(ImpingePlugin::default().in_schedule(Update));
    /// app.world_mut().spawn(Collider::half_plane(Vec2::Y));
    /// app.update();
    /// let (ball, at) = (Collider::circle(0.5), Isometry2d::from_xy(0.0, 1.0));
    /// let settings = SlideSettings::with_skin(0.25);
    /// let collisions = app.world().resource::<Collisions>();
    /// let slide = collisions.move_and_slide(&ball, at, Vec2::new(2.0, -1.0), &settings, &SpatialFilter::new());
    /// let expected = Vec2::new(2.0, -0.25);
    /// assert!(slide.motion.abs_diff_eq(expected, 1e-4), "the floor stops the fall alone");
    /// ```
    #[must_use]
    pub fn move_and_slide<V: WorldKey>(
        &self,
        shape: &Collider<D, V>,
        pose: impl Into<Pose<D>>,
        motion: Vec_<D>,
        settings: &SlideSettings,
        filter: &SpatialFilter<'_>,
    ) -> Slide<D> {
        let mut slide = Slide { motion: Vec_::<D>::default(), rest: motion, hits: Vec::new() };
        let Ok(shape) = shape.shape() else { return slide };
        let start = pose.into();
        let filter = filter.clone().without_sensors();
        let (mut done, mut rest) = (Vector::<f32, D>::zeros(), f32::vector(motion));
        let mut walls: Vec<Vector<f32, D>> = Vec::new();
        for _ in 0..settings.max_hits.saturating_add(MAX_GRAZES) {
            if rest == Vector::<f32, D>::zeros() || slide.hits.len() >= settings.max_hits {
                break;
            }
            let here = moved(&start, &done);
            let skin = settings.skin;
            let hit = self.cast_with_skin(shape, &here, f32::vec(&rest), skin, &filter);
            let Some(hit) = hit else {
                done += rest;
                rest = Vector::zeros();
                break;
            };
            done += rest * hit.fraction;
            // After a motion of positive length, earlier walls do not restrict the motion any more.
            if hit.fraction > 0.0 {
                walls.clear();
            }
            let normal = f32::vector(hit.normal);
            let is_graze = rest.dot(&normal) >= -GRAZE * rest.norm();
            walls.push(normal);
            rest = off(along(&(rest * (1.0 - hit.fraction)), &walls), &walls);
            if !is_graze {
                slide.hits.push(hit);
            }
        }
        Slide { motion: f32::vec(&done), rest: f32::vec(&rest), ..slide }
    }
}

fn moved<const D: usize>(pose: &Pose<D>, by: &Vector<f32, D>) -> Pose<D>
where
    f32: Glam<D>,
{
    let mut isometry = f32::isometry_of(pose);
    f32::translate(&mut isometry, by);
    f32::pose_of(&isometry)
}

/// Adds to a motion along walls a component away from each wall, of [`LIFT`] times the length of
/// the motion.
fn off<const D: usize>(motion: Vector<f32, D>, walls: &[Vector<f32, D>]) -> Vector<f32, D> {
    let lift = LIFT * motion.norm();
    walls.iter().fold(motion, |motion, wall| motion + wall * lift)
}

/// Returns the part of a motion that leads into none of the walls, whose normals point towards the
/// character. It is the first of these that leads into no wall: the projection on the last wall,
/// the projection on the edge between the last wall and an earlier one, zero.
fn along<const D: usize>(motion: &Vector<f32, D>, walls: &[Vector<f32, D>]) -> Vector<f32, D> {
    let zero = Vector::zeros();
    let Some((last, others)) = walls.split_last() else { return *motion };
    // The rounding error of a product of unit vectors, times the length of the motion.
    let rounding = 1e-6 * motion.norm();
    let is_free = |v: &Vector<f32, D>| walls.iter().all(|wall| v.dot(wall) >= -rounding);
    let without = |v: &Vector<f32, D>, wall: &Vector<f32, D>| v - wall * v.dot(wall);
    let flat = without(motion, last);
    if is_free(&flat) {
        return flat;
    }
    let edge = |other: &Vector<f32, D>| {
        // The normal of the other wall, projected on the last wall.
        let across = without(other, last).try_normalize(1e-6)?;
        Some(without(&flat, &across)).filter(is_free)
    };
    others.iter().rev().find_map(edge).unwrap_or(zero)
}
